//! Provenance: a reader that is through with its trace in, what the run was made of out.

use crate::error::Result;
use crate::output::summary::{DataFile, Provenance};
use crate::trace::command::Header;
use crate::trace::open::Trace;

/// What the trace says of itself, its hash, and those of the files that it names.
///
/// # Errors
/// A file that cannot be read any more.
pub fn provenance(header: Header, reader: &Trace) -> Result<Provenance> {
    let Header { title, source, licence } = header;
    let files = reader
        .data_files()
        .into_iter()
        .map(|file| Ok(DataFile { name: file.name.clone(), sha256: file.sha256()? }));
    let files = files.collect::<Result<_>>()?;
    Ok(Provenance { title, source, licence, sha256: reader.hash(), files })
}
