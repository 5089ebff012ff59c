//! Points: where the control points of an id live, inline or in a file, and a range of them out.
//!
//! A file of points is raw little-endian f32, 3 or 4 a point, without a head. It is never read
//! whole, so a trace of a million patches needs no more memory than one that draws a teapot. Its
//! name is relative to the trace's folder and may not lead out of it: a trace from elsewhere must
//! not be able to name any file it likes.

use crate::error::{Error, Place, Result};
use sha2::{Digest, Sha256};
use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::path::{Component, Path, PathBuf};
use std::sync::Mutex;

/// Control points, checked: coordinates are finite and weights above 0. A file's are checked as
/// they are read.
#[derive(Debug, PartialEq)]
pub enum PointSource {
    /// Points in the trace, weight 1.
    Xyz(Vec<[f32; 3]>),
    /// Homogeneous points in the trace: x w, y w, z w, w.
    Xyzw(Vec<[f32; 4]>),
    /// Points in a file of their own.
    File(PointFile),
}

impl PointSource {
    /// How many points there are.
    #[must_use]
    pub fn len(&self) -> u64 {
        match self {
            Self::Xyz(points) => points.len() as u64,
            Self::Xyzw(points) => points.len() as u64,
            Self::File(file) => file.count,
        }
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Numbers of a point as it crosses the link, 4 bytes each: 3 or 4.
    #[must_use]
    pub fn components(&self) -> u32 {
        match self {
            Self::Xyz(_) => 3,
            Self::Xyzw(_) => 4,
            Self::File(file) => file.layout.components(),
        }
    }

    /// Replaces `out` by the `count` points from `first` on, points without a weight getting weight
    /// 1.
    ///
    /// # Errors
    /// A file that has become shorter or unreadable, or that holds a non-finite number or a weight
    /// that is not above 0.
    ///
    /// # Panics
    /// When the range goes beyond [`Self::len`]; a reader has checked that no draw does.
    pub fn read(&self, first: u64, count: usize, out: &mut Vec<[f32; 4]>) -> Result<()> {
        out.clear();
        let end = first.checked_add(count as u64);
        assert!(end.is_some_and(|e| e <= self.len()), "points {first} + {count} of {}", self.len());
        // Inline points are in memory, so their indices fit it.
        let range = first as usize..first as usize + count;
        match self {
            Self::Xyz(points) => out.extend(points[range].iter().map(|&[x, y, z]| [x, y, z, 1.0])),
            Self::Xyzw(points) => out.extend_from_slice(&points[range]),
            Self::File(file) => file.read(first, count, out)?,
        }
        Ok(())
    }

    /// The file, where the points are in one.
    #[must_use]
    pub fn file(&self) -> Option<&PointFile> {
        match self {
            Self::File(file) => Some(file),
            _ => None,
        }
    }
}

/// The numbers of a point in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// Three coordinates.
    Xyz,
    /// Homogeneous: x w, y w, z w, w.
    Xyzw,
}

impl Layout {
    /// The name in traces.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Xyz => "xyz",
            Self::Xyzw => "xyzw",
        }
    }

    const fn components(self) -> u32 {
        match self {
            Self::Xyz => 3,
            Self::Xyzw => 4,
        }
    }
}

/// A file that a trace names for data of its own.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DataFile {
    /// The name in the trace, relative to its folder.
    pub name: String,
    /// The path to open and to show.
    pub path: PathBuf,
}

impl DataFile {
    /// Finds the file `name` in `folder`.
    ///
    /// # Errors
    /// In words that follow "expected": the name is absolute or leads out of the folder, even by a
    /// symbolic link, or there is no such regular file.
    pub(crate) fn find(folder: &Path, name: &str) -> Result<Self, String> {
        let within = |c| matches!(c, Component::Normal(_) | Component::CurDir);
        if name.is_empty() || !Path::new(name).components().all(within) {
            return Err("a path within the trace's folder, relative and without `..`".into());
        }
        let missing = |e: io::Error| format!("the name of a file that can be read: {e}");
        let path = folder.join(name);
        let real = path.canonicalize().map_err(missing)?;
        if !real.starts_with(folder.canonicalize().map_err(missing)?) {
            return Err("a path within the trace's folder, which this symbolic link leaves".into());
        }
        if !real.metadata().map_err(missing)?.is_file() {
            return Err("the name of a regular file".into());
        }
        Ok(Self { name: name.into(), path })
    }

    /// SHA-256 of the file as it is now, in hexadecimal.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn sha256(&self) -> Result<String> {
        let mut hash = Sha256::new();
        let mut buffer = vec![0; 1 << 16];
        let mut add_all = || -> io::Result<()> {
            let mut file = File::open(&self.path)?;
            loop {
                match file.read(&mut buffer)? {
                    0 => return Ok(()),
                    n => hash.update(&buffer[..n]),
                }
            }
        };
        add_all().map_err(|e| Error::system(&self.path, e))?;
        Ok(hex::encode(hash.finalize()))
    }
}

/// Points in a file of raw little-endian f32.
#[derive(Debug)]
pub struct PointFile {
    data: DataFile,
    layout: Layout,
    count: u64,
    open: Mutex<Position>,
}

/// An open file and where it stands, which `BufReader` does not tell without a system call.
#[derive(Debug)]
struct Position {
    file: BufReader<File>,
    byte: u64,
}

/// Files are equal where they are the same part of the same file.
impl PartialEq for PointFile {
    fn eq(&self, other: &Self) -> bool {
        (&self.data, self.layout, self.count) == (&other.data, other.layout, other.count)
    }
}

impl PointFile {
    /// Opens a file of at least `count` points.
    ///
    /// # Errors
    /// In words that follow "expected": the file is too short, or cannot be opened.
    pub(crate) fn open(data: DataFile, layout: Layout, count: u64) -> Result<Self, String> {
        let missing = |e: io::Error| format!("the name of a file that can be read: {e}");
        let file = File::open(&data.path).map_err(missing)?;
        let bytes = file.metadata().map_err(missing)?.len();
        let stride = 4 * u64::from(layout.components());
        match count.checked_mul(stride) {
            Some(needed) if needed <= bytes => {}
            needed => {
                let needed = needed.map_or("more than 2^64".into(), |n| n.to_string());
                return Err(format!(
                    "a file of at least {needed} bytes ({count} points of {stride} bytes), \
                     but it has {bytes}"
                ));
            }
        }
        let open = Mutex::new(Position { file: BufReader::with_capacity(1 << 16, file), byte: 0 });
        Ok(Self { data, layout, count, open })
    }

    /// The file's name and path.
    #[must_use]
    pub fn data(&self) -> &DataFile {
        &self.data
    }

    /// The numbers of a point.
    #[must_use]
    pub fn layout(&self) -> Layout {
        self.layout
    }

    fn read(&self, first: u64, count: usize, out: &mut Vec<[f32; 4]>) -> Result<()> {
        let components = self.layout.components() as usize;
        let mut byte = first * 4 * components as u64;
        let mut open = self.open.lock().unwrap_or_else(|poisoned| {
            // Only a panic elsewhere can do that; the position is set anew below.
            poisoned.into_inner()
        });
        open.seek(byte).map_err(|e| self.unreadable(e))?;
        out.reserve(count);
        for _ in 0..count {
            let mut point = [0.0, 0.0, 0.0, 1.0];
            for (i, number) in point.iter_mut().take(components).enumerate() {
                let mut bytes = [0; 4];
                open.take(&mut bytes).map_err(|e| self.unreadable(e))?;
                *number = f32::from_le_bytes(bytes);
                self.check(i, *number, byte)?;
                byte += 4;
            }
            out.push(point);
        }
        Ok(())
    }

    fn check(&self, component: usize, number: f32, byte: u64) -> Result<()> {
        let expected = match component {
            _ if !number.is_finite() => "a finite number",
            3 if number <= 0.0 => "a weight above 0",
            _ => return Ok(()),
        };
        let name = ["x", "y", "z", "w"][component];
        let point = byte / 4 / u64::from(self.layout.components());
        Err(Error::Input {
            file: self.data.path.display().to_string(),
            place: Place::Byte(byte),
            message: format!("{name} of point {point}: found {number}, expected {expected}"),
        })
    }

    fn unreadable(&self, error: io::Error) -> Error {
        Error::system(&self.data.path, error)
    }
}

impl Position {
    /// Moves to a byte, keeping what is buffered where that is close.
    fn seek(&mut self, byte: u64) -> io::Result<()> {
        match i64::try_from(i128::from(byte) - i128::from(self.byte)) {
            Ok(distance) => self.file.seek_relative(distance)?,
            Err(_) => {
                self.file.seek(SeekFrom::Start(byte))?;
            }
        }
        self.byte = byte;
        Ok(())
    }

    fn take(&mut self, bytes: &mut [u8; 4]) -> io::Result<()> {
        let result = self.file.read_exact(bytes);
        // After a failure the file stands where nobody knows: start over at the next seek.
        self.byte = match result {
            Ok(()) => self.byte + 4,
            Err(_) => self.file.seek(SeekFrom::Start(0))?,
        };
        result
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(bytes: &[u8]) -> (tempfile::TempDir, DataFile) {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("p.f32"), bytes).unwrap();
        let data = DataFile::find(folder.path(), "p.f32").unwrap();
        (folder, data)
    }

    fn raw(numbers: impl IntoIterator<Item = f32>) -> Vec<u8> {
        numbers.into_iter().flat_map(f32::to_le_bytes).collect()
    }

    #[test]
    fn ranges_of_a_file_are_those_of_the_inline_points() {
        let points: Vec<[f32; 3]> = (0..20_000).map(|i| [i as f32, -1.5, 0.25]).collect();
        let (_folder, data) = file(&raw(points.iter().flatten().copied()));
        let filed = PointSource::File(PointFile::open(data, Layout::Xyz, 20_000).unwrap());
        let inline = PointSource::Xyz(points);
        let (mut a, mut b) = (Vec::new(), Vec::new());
        for (first, count) in [(0, 16), (16, 16), (19_984, 16), (3, 0), (5, 7000), (4, 16)] {
            filed.read(first, count, &mut a).unwrap();
            inline.read(first, count, &mut b).unwrap();
            assert_eq!(a, b);
            assert_eq!(a.len(), count);
        }
        assert_eq!((filed.len(), filed.components()), (inline.len(), inline.components()));
    }

    #[test]
    fn bad_numbers_are_refused_with_their_byte() {
        let numbers = [1.0, 2.0, 3.0, 1.0, 1.0, f32::NAN, 3.0, 1.0, 1.0, 2.0, 3.0, 0.0];
        let (_folder, data) = file(&raw(numbers));
        let source = PointSource::File(PointFile::open(data, Layout::Xyzw, 3).unwrap());
        let mut out = Vec::new();
        source.read(0, 1, &mut out).unwrap();
        let text = source.read(0, 2, &mut out).unwrap_err().to_string();
        assert!(
            text.ends_with("p.f32: byte 20: y of point 1: found NaN, expected a finite number")
        );
        let text = source.read(2, 1, &mut out).unwrap_err().to_string();
        assert!(text.ends_with("byte 44: w of point 2: found 0, expected a weight above 0"));
    }

    #[test]
    fn short_files_are_refused_with_both_lengths() {
        let (_folder, data) = file(&raw([0.0; 5]));
        let text = PointFile::open(data.clone(), Layout::Xyz, 2).unwrap_err();
        assert!(text.contains("24 bytes") && text.contains("has 20"), "{text}");
        assert!(PointFile::open(data, Layout::Xyz, u64::MAX).is_err());
    }

    #[test]
    fn names_stay_within_the_folder() {
        let (folder, _) = file(b"");
        let inside = folder.path().join("inside");
        std::fs::create_dir(&inside).unwrap();
        #[cfg(unix)]
        std::os::unix::fs::symlink("../p.f32", inside.join("link")).unwrap();
        for name in ["../p.f32", "/etc/passwd", "a/../../p.f32", "", "link", ".", "none", "a\0b"] {
            assert!(DataFile::find(&inside, name).is_err(), "{name:?}");
        }
        assert!(DataFile::find(folder.path(), "./p.f32").is_ok());
        assert!(DataFile::find(folder.path(), "inside/link").is_ok());
    }
}
