//! One point: its trace through its unit, and the files of its result.

use super::plan::{Plan, Point};
use crate::error::{Error, Result};
use crate::output::result;
use crate::sink::NoMesh;
use crate::study::provenance::provenance;
use crate::trace::command::{Command, Header};
use crate::trace::open::Trace;
use crate::unit::simulate;
use rayon::ThreadPool;
use std::ffi::{OsStr, OsString};
use std::io;
use std::os::unix::ffi::{OsStrExt, OsStringExt};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Component, Path, PathBuf};

/// Files of a result under their names.
pub(super) type Files = Vec<(&'static str, Vec<u8>)>;

/// The file that says how to make the others again.
pub(super) const COMMAND: &str = "command.txt";

/// Computes a point in `pool`, for a result that will be in the folder `place`. In the inner
/// result, why there is none.
///
/// # Errors
/// What is the system's fault and not the point's; a trace that has changed since it was planned.
pub(super) fn compute(
    plan: &Plan,
    point: &Point,
    pool: &ThreadPool,
    place: &Path,
) -> Result<Result<Files, String>> {
    // Nothing is used again of what a panic leaves behind.
    let caught = catch_unwind(AssertUnwindSafe(|| pool.install(|| simulated(plan, point))));
    let trace = &plan.traces[point.trace].path;
    match caught {
        Ok(Ok(mut files)) => {
            files.push((COMMAND, command(trace, place)?));
            Ok(Ok(files))
        }
        Ok(Err(error @ (Error::System { .. } | Error::Device(_)))) => Err(error),
        Ok(Err(error)) => Ok(Err(error.to_string())),
        Err(panic) => {
            let said = panic.downcast_ref::<String>().map(String::as_str);
            let said = said.or_else(|| panic.downcast_ref::<&str>().copied());
            Ok(Err(format!("the simulator broke off: {}", said.unwrap_or("without a word"))))
        }
    }
}

fn simulated(plan: &Plan, point: &Point) -> Result<Files> {
    let config = plan.configuration(point)?;
    let trace = &plan.traces[point.trace];
    let mut reader = Trace::open(&trace.path)?;
    let mut header = Header::default();
    let commands = reader.by_ref().map(|located| {
        let command = located?.command;
        if let Command::Header(found) = &command {
            header = found.clone();
        }
        Ok(command)
    });
    let report = simulate(commands, &config, &mut NoMesh)?;
    let provenance = provenance(header, &reader)?;
    if provenance != trace.provenance {
        let changed = io::Error::other("it changed while the sweep was running");
        return Err(Error::system(&trace.path, changed));
    }
    Ok(result::files(&report, &provenance))
}

/// The command line that makes the result in `place` again, when it is given there; its paths are
/// relative, so that it holds where trace and sweep have been moved together.
fn command(trace: &Path, place: &Path) -> Result<Vec<u8>> {
    let real = |path: &Path| path.canonicalize().map_err(|error| Error::system(path, error));
    let above = place.parent().expect("points have a folder of their own");
    let name = place.file_name().expect("a hash is a name");
    let trace = relative(&real(trace)?, &real(above)?.join(name));
    let mut line = b"tessim run ".to_vec();
    line.extend(quoted(trace.as_os_str()).as_bytes());
    line.extend(b" --config config.toml --out again\n");
    Ok(line)
}

/// The way from one real folder to a file.
fn relative(file: &Path, folder: &Path) -> PathBuf {
    let common = file.components().zip(folder.components()).take_while(|(a, b)| a == b).count();
    let up = folder.components().skip(common).map(|_| Component::ParentDir);
    up.chain(file.components().skip(common)).collect()
}

/// A word that a shell takes as it is.
fn quoted(word: &OsStr) -> OsString {
    let bytes = word.as_bytes();
    let plain = |byte: &u8| byte.is_ascii_alphanumeric() || b"._-/+,@%".contains(byte);
    if bytes.iter().all(plain) {
        return word.to_owned();
    }
    let mut quoted = vec![b'\''];
    for &byte in bytes {
        match byte {
            b'\'' => quoted.extend(b"'\\''"),
            byte => quoted.push(byte),
        }
    }
    quoted.push(b'\'');
    OsString::from_vec(quoted)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ways_go_up_to_what_is_common_and_down_again() {
        let way = |file, folder| relative(Path::new(file), Path::new(folder));
        assert_eq!(way("/a/t/x.jsonl", "/a/s/points/h"), Path::new("../../../t/x.jsonl"));
        assert_eq!(way("/a/x.jsonl", "/a"), Path::new("x.jsonl"));
        assert_eq!(way("/x.jsonl", "/b/c"), Path::new("../../x.jsonl"));
    }

    #[test]
    fn what_a_shell_would_change_is_quoted() {
        let word = |text: &str| quoted(OsStr::new(text)).into_string().unwrap();
        assert_eq!(word("../traces/teapot.jsonl"), "../traces/teapot.jsonl");
        assert_eq!(word("my traces/a.jsonl"), "'my traces/a.jsonl'");
        assert_eq!(word("it's $HOME"), "'it'\\''s $HOME'");
    }
}
