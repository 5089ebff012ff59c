//! A file that appears when it is complete: written under another name in the same folder, renamed
//! at the end, and gone if it never gets there.

use crate::error::{Error, Result};
use std::fs::{File, Permissions};
use std::io::{self, BufReader, BufWriter, Write};
use std::path::{Path, PathBuf};
use tempfile::{Builder, NamedTempFile};

/// A file under construction.
#[derive(Debug)]
pub struct AtomicFile {
    path: PathBuf,
    file: BufWriter<NamedTempFile>,
}

impl AtomicFile {
    /// Begins the file that will be at `path`, or where `path` leads as a symbolic link.
    ///
    /// # Errors
    /// [`Error::System`] when its folder does not exist or cannot be written, [`Error::Usage`] when
    /// there is something that is no file, such as a device: to rename over it would destroy it.
    pub fn create(path: impl Into<PathBuf>) -> Result<Self> {
        let mut path = path.into();
        if path.is_dir() {
            return Err(Error::system(path, io::ErrorKind::IsADirectory.into()));
        }
        if path.is_symlink() {
            path = path.canonicalize().map_err(|error| Error::system(&path, error))?;
        }
        if path.exists() && !path.is_file() {
            let path = path.display();
            return Err(Error::Usage(format!(
                "{path}: found something that is no file, expected a file or nothing there"
            )));
        }
        let mut builder = Builder::new();
        builder.prefix(".tessim-").permissions(usual_permissions(0o666));
        let file = builder.tempfile_in(parent(&path));
        let file = file.map_err(|error| Error::system(&path, reason(&error)))?;
        Ok(Self { path, file: BufWriter::new(file) })
    }

    /// Renames the complete file into place, over whatever file was there.
    ///
    /// # Errors
    /// [`Error::System`] when what is left cannot be written, or the file not be renamed.
    pub fn commit(self) -> Result<()> {
        let Self { path, file } = self;
        let file = file.into_inner().map_err(|error| Error::system(&path, error.into_error()))?;
        let done = file.persist(&path);
        done.map(drop).map_err(|error| Error::system(path, error.error))
    }

    /// Where it will be.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }
}

impl Write for AtomicFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

/// A file without a name in the folder of `path`, for data whose place in the result is not yet
/// known.
///
/// # Errors
/// [`Error::System`] when the folder cannot be written.
pub fn spool(path: &Path) -> Result<BufWriter<File>> {
    let file = tempfile::tempfile_in(parent(path));
    file.map(BufWriter::new).map_err(|error| Error::system(path, reason(&error)))
}

/// Everything in `spool`, to be read again from its start.
///
/// # Errors
/// [`Error::System`] on `path`.
pub(super) fn respool(spool: BufWriter<File>, path: &Path) -> Result<BufReader<File>> {
    use std::io::Seek;
    let file = spool.into_inner().map_err(io::IntoInnerError::into_error);
    let rewound = file.and_then(|mut file| file.rewind().map(|()| BufReader::new(file)));
    rewound.map_err(|error| Error::system(path, error))
}

/// Appends everything in `spool` to `out`.
///
/// # Errors
/// [`Error::System`] on `path`.
pub fn unspool(spool: BufWriter<File>, out: &mut impl Write, path: &Path) -> Result<()> {
    let mut spooled = respool(spool, path)?;
    io::copy(&mut spooled, out).map(drop).map_err(|error| Error::system(path, error))
}

/// The folder that holds `path`.
#[must_use]
pub fn parent(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

/// `tempfile` names its own random path in the error; the user's path is the one to name.
pub(super) fn reason(error: &io::Error) -> io::Error {
    match error.kind() {
        io::ErrorKind::NotFound => {
            io::Error::new(io::ErrorKind::NotFound, "the folder to write in does not exist")
        }
        kind => error.raw_os_error().map_or_else(|| kind.into(), io::Error::from_raw_os_error),
    }
}

/// What a plain `open` or `mkdir` would ask for; the umask applies.
pub(super) fn usual_permissions(mode: u32) -> Permissions {
    use std::os::unix::fs::PermissionsExt;
    Permissions::from_mode(mode)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn a_file_appears_when_it_is_complete_and_not_before() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        let mut file = AtomicFile::create(&path).unwrap();
        file.write_all(b"half").unwrap();
        file.flush().unwrap();
        assert!(!path.exists());
        drop(file);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0, "nothing is left behind");
        let mut file = AtomicFile::create(&path).unwrap();
        file.write_all(b"whole").unwrap();
        file.commit().unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"whole");
    }

    #[test]
    fn what_is_no_file_is_not_replaced_and_links_are_followed() {
        use std::os::unix::fs::symlink;
        use std::os::unix::net::UnixListener;
        let folder = tempfile::tempdir().unwrap();
        let [socket, link, target] = ["socket", "link", "target"].map(|n| folder.path().join(n));
        let _open = UnixListener::bind(&socket).unwrap();
        symlink(&socket, &link).unwrap();
        for path in [&socket, &link] {
            let error = AtomicFile::create(path).unwrap_err();
            assert_eq!(error.exit_code(), 2);
            assert!(
                error.to_string().contains("socket: found something that is no file"),
                "{error}"
            );
        }
        fs::remove_file(&link).unwrap();
        fs::write(&target, "old").unwrap();
        symlink(&target, &link).unwrap();
        let mut file = AtomicFile::create(&link).unwrap();
        file.write_all(b"new").unwrap();
        file.commit().unwrap();
        assert!(link.is_symlink() && fs::read(&target).unwrap() == b"new");
    }

    #[test]
    fn a_missing_folder_is_the_systems_failure_and_names_the_users_path() {
        let error = AtomicFile::create("/nonexistent/x/a.txt").unwrap_err();
        assert_eq!(error.exit_code(), 3);
        let message = error.to_string();
        assert_eq!(message, "/nonexistent/x/a.txt: the folder to write in does not exist");
    }
}
