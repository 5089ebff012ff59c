//! Open: a file or any bytes in, the commands of the trace out, whichever form it has: which is
//! told from its first bytes, never from its name.

use super::binary;
use super::only::OnlyFrame;
use super::points::DataFile;
use super::read::{Located, Reader};
use crate::error::{Error, Result};
use std::fs::File;
use std::io::{self, BufRead, BufReader, Cursor, Read, Seek};
use std::path::{Path, PathBuf};

/// Bytes asked of a file at a time.
const READ_BYTES: usize = 1 << 18;

/// Where the bytes of a trace come from.
type Input = Box<dyn BufRead + Send>;

/// An iterator over the commands of a trace, in the text or in the binary form.
pub struct Trace {
    form: Form,
    only: Option<OnlyFrame>,
}

enum Form {
    Text(Box<Reader<Input>>),
    Binary(Box<binary::read::Reader<Input>>),
    /// One frame of a binary trace, found by its index.
    Frame(Box<binary::seek::FrameReader<File>>),
}

impl Trace {
    /// Opens the trace at `path`, or standard input for `-`. Data files are looked for in the
    /// trace's folder; for standard input, in the current one.
    ///
    /// # Errors
    /// A file that cannot be opened or read.
    pub fn open(path: impl AsRef<Path>) -> Result<Self> {
        let path = path.as_ref();
        let input: Box<dyn Read + Send> = if path == Path::new("-") {
            Box::new(io::stdin())
        } else {
            Box::new(File::open(path).map_err(|e| Error::system(path, e))?)
        };
        Self::new(input, path.display().to_string(), folder(path))
    }

    /// Opens the trace at `path` as [`Self::open`] does, and of its commands takes those that frame
    /// `frame`, from 0, needs: the header, what is live where the frame begins, the frame, and an
    /// end. Of a file in the binary form nothing else is read; all else is read to its end.
    ///
    /// # Errors
    /// A file that cannot be opened or read. No such frame, which may show at the trace's end only.
    pub fn open_frame(path: impl AsRef<Path>, frame: u64) -> Result<Self> {
        let path = path.as_ref();
        if path != Path::new("-") {
            let system = |e| Error::system(path, e);
            let mut file = File::open(path).map_err(system)?;
            // A pipe that has a name cannot be read twice.
            if file.metadata().map_err(system)?.is_file() {
                let head = head(&mut file).map_err(system)?;
                file.rewind().map_err(system)?;
                if binary::is_binary(&head) {
                    let name = path.display().to_string();
                    let reader = binary::seek::FrameReader::new(file, name, folder(path), frame)?;
                    return Ok(Self { form: Form::Frame(Box::new(reader)), only: None });
                }
            }
        }
        Ok(Self { only: Some(OnlyFrame::new(frame)), ..Self::open(path)? })
    }

    /// Reads the trace `input`, which messages call `file`, with its data files in `folder`.
    ///
    /// # Errors
    /// An input that cannot be read.
    pub fn new(
        mut input: impl Read + Send + 'static,
        file: impl Into<String>,
        folder: impl Into<PathBuf>,
    ) -> Result<Self> {
        let (file, folder) = (file.into(), folder.into());
        let head = head(&mut input).map_err(|e| Error::system(&file, e))?;
        let is_binary = binary::is_binary(&head);
        let rest = BufReader::with_capacity(READ_BYTES, input);
        let whole: Input = Box::new(Cursor::new(head).chain(rest));
        let form = if is_binary {
            Form::Binary(Box::new(binary::read::Reader::new(whole, file, folder)))
        } else {
            Form::Text(Box::new(Reader::new(whole, file, folder)))
        };
        Ok(Self { form, only: None })
    }

    /// The hash by which the trace is known, in hexadecimal, once all commands have been read:
    /// SHA-256 of its text, or of all bytes of a binary trace before its trailer, the same whether
    /// all of it was read or one frame.
    #[must_use]
    pub fn hash(&self) -> String {
        match &self.form {
            Form::Text(reader) => reader.hash(),
            Form::Binary(reader) => reader.hash(),
            Form::Frame(reader) => reader.hash(),
        }
    }

    /// The data files named so far, sorted by name, none twice.
    #[must_use]
    pub fn data_files(&self) -> Vec<&DataFile> {
        match &self.form {
            Form::Text(reader) => reader.data_files().collect(),
            Form::Binary(reader) => reader.data_files().collect(),
            Form::Frame(reader) => reader.data_files().collect(),
        }
    }
}

impl Iterator for Form {
    type Item = Result<Located>;

    fn next(&mut self) -> Option<Self::Item> {
        match self {
            Self::Text(reader) => reader.next(),
            Self::Binary(reader) => reader.next(),
            Self::Frame(reader) => reader.next(),
        }
    }
}

impl Iterator for Trace {
    type Item = Result<Located>;

    fn next(&mut self) -> Option<Self::Item> {
        match &mut self.only {
            None => self.form.next(),
            Some(only) => only.next(&mut self.form),
        }
    }
}

/// The first bytes of an input: enough to tell its form, or all there are.
fn head(input: &mut impl Read) -> io::Result<Vec<u8>> {
    let mut head = Vec::new();
    input.take(binary::PREAMBLE.len() as u64).read_to_end(&mut head)?;
    Ok(head)
}

/// Where the data files of the trace at `path` are.
#[must_use]
pub fn folder(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if parent != Path::new("") => parent,
        _ => Path::new("."),
    }
}
