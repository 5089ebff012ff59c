//! What can go wrong, by whose fault it is: the input's, the user's, the system's. A leaf.

use std::path::PathBuf;

/// Where in a trace something is wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// Text: line and column, both from 1. Column 0: the line as a whole.
    Line {
        /// Line number from 1.
        line: u64,
        /// Column in bytes from 1.
        column: usize,
    },
    /// A byte offset from 0, in files that have no lines.
    Byte(u64),
}

/// Of known names the one that comes nearest to `name`: the first of equals, so that the answer
/// does not depend on how ties are broken. `None` where nothing is known.
#[must_use]
pub fn nearest<K: AsRef<str>>(name: &str, known: impl IntoIterator<Item = K>) -> Option<K> {
    let rated = known.into_iter().map(|known| (strsim::jaro_winkler(name, known.as_ref()), known));
    let nearest = rated.reduce(|best, next| if next.0 > best.0 { next } else { best });
    nearest.map(|(_, known)| known)
}

/// Every error of the library.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A malformed trace or imported file: begins `FILE:LINE:COLUMN:` or `FILE: byte N:`, names the
    /// field, what was found and what was expected.
    #[error("{}", located(file, place, message))]
    Input {
        /// The file as the user named it; `-` for standard input.
        file: String,
        /// The place.
        place: Place,
        /// Field, found, expected.
        message: String,
    },
    /// A configuration that cannot be used, or wrong usage.
    #[error("{0}")]
    Usage(String),
    /// A check failed: the tool disagrees with itself.
    #[error("{0}")]
    Check(String),
    /// The system failed: a file could not be opened, read or written.
    #[error("{}: {source}", path.display())]
    System {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
    /// A GPU is missing, or failed.
    #[error("{0}")]
    Device(String),
}

/// Results of the library.
pub type Result<T, E = Error> = std::result::Result<T, E>;

impl Error {
    /// The process exit code: 1 a check failed, 2 bad input or usage, 3 the system failed.
    #[must_use]
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Check(_) => 1,
            Self::Input { .. } | Self::Usage(_) => 2,
            Self::System { .. } | Self::Device(_) => 3,
        }
    }

    /// An error of the system on `path`.
    pub fn system(path: impl Into<PathBuf>, source: std::io::Error) -> Self {
        Self::System { path: path.into(), source }
    }
}

fn located(file: &str, place: &Place, message: &str) -> String {
    match place {
        Place::Line { line, column } => format!("{file}:{line}:{column}: {message}"),
        Place::Byte(byte) => format!("{file}: byte {byte}: {message}"),
    }
}
