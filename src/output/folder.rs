//! A result folder: built beside its final place and renamed into it when it is complete.
//!
//! A folder that is already there is replaced only if everything in it is what a run writes, or the
//! same study, so that a mistyped `--out` cannot cost anybody their data.

use super::file;
use crate::error::{Error, Result};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use tempfile::{Builder, TempDir};

/// What every result holds: its mark.
pub const ALWAYS: [&str; 3] = ["config.toml", "counters.csv", "summary.json"];

/// What it may hold besides.
const SOMETIMES: [&str; 5] = ["occupancy.csv", "mesh.ply", "mesh.obj", "mesh.svg", "timeline.json"];

/// What a folder holds, and so what it may replace.
#[derive(Clone, Copy, Debug)]
enum Kind {
    /// The files of a run.
    Run,
    /// The files of a study, the first of them a CSV with this first line.
    Study {
        names: &'static [&'static str],
        sometimes: &'static [&'static str],
        header: &'static [&'static str],
    },
}

/// A result folder under construction.
#[derive(Debug)]
pub struct ResultFolder {
    target: PathBuf,
    kind: Kind,
    /// Holds `new`, and `old` for the moment of the exchange.
    workshop: TempDir,
}

impl ResultFolder {
    /// Begins the folder of a run that will be at `target`.
    ///
    /// # Errors
    /// [`Error::Usage`] when `target` exists and is no tessim result, [`Error::System`] when its
    /// parent does not exist or cannot be written.
    pub fn create(target: &Path) -> Result<Self> {
        Self::begin(target, Kind::Run)
    }

    /// Begins the folder of a study that will be at `target`, with files of these names in it, the
    /// first of them a CSV with those columns. It replaces only its like.
    ///
    /// # Errors
    /// As [`Self::create`].
    ///
    /// # Panics
    /// When there is no first name.
    pub fn of_study(
        target: &Path,
        names: &'static [&'static str],
        header: &'static [&'static str],
    ) -> Result<Self> {
        Self::of_study_with(target, names, &[], header)
    }

    /// As [`Self::of_study`]; files of the names `sometimes` may be in it too.
    ///
    /// # Errors
    /// As [`Self::create`].
    ///
    /// # Panics
    /// When there is no first name.
    pub fn of_study_with(
        target: &Path,
        names: &'static [&'static str],
        sometimes: &'static [&'static str],
        header: &'static [&'static str],
    ) -> Result<Self> {
        assert!(!names.is_empty(), "a study writes its CSV at least");
        Self::begin(target, Kind::Study { names, sometimes, header })
    }

    fn begin(target: &Path, kind: Kind) -> Result<Self> {
        // A link to a result stands for the result.
        let target = fs::canonicalize(target).unwrap_or_else(|_| target.to_owned());
        if target.symlink_metadata().is_ok() {
            replaceable(&target, kind)?;
        }
        let mut builder = Builder::new();
        builder.prefix(".tessim-").permissions(file::usual_permissions(0o777));
        let workshop = builder.tempdir_in(file::parent(&target));
        let workshop = workshop.map_err(|error| Error::system(&target, file::reason(&error)))?;
        let folder = Self { target, kind, workshop };
        fs::create_dir(folder.path()).map_err(|error| Error::system(&folder.target, error))?;
        Ok(folder)
    }

    /// Where its files are to be written.
    #[must_use]
    pub fn path(&self) -> PathBuf {
        self.workshop.path().join("new")
    }

    /// Writes one file of it.
    ///
    /// # Errors
    /// [`Error::System`] names the file under its final path.
    pub fn write(&self, name: &str, bytes: &[u8]) -> Result<()> {
        let written = fs::write(self.path().join(name), bytes);
        written.map_err(|error| Error::system(self.target.join(name), error))
    }

    /// Puts the complete folder in its place.
    ///
    /// # Errors
    /// [`Error::Usage`] when something that is no result has taken its place meanwhile,
    /// [`Error::System`] when a rename fails; what was there is then there again.
    pub fn commit(self) -> Result<()> {
        let old = self.workshop.path().join("old");
        let failed = |error: io::Error| Error::system(&self.target, error);
        let exists = self.target.symlink_metadata().is_ok();
        if exists {
            replaceable(&self.target, self.kind)?;
            fs::rename(&self.target, &old).map_err(failed)?;
        }
        if let Err(error) = fs::rename(self.path(), &self.target) {
            if exists {
                fs::rename(&old, &self.target).map_err(failed)?;
            }
            return Err(failed(error));
        }
        self.workshop.close().map_err(failed)
    }
}

fn replaceable(target: &Path, kind: Kind) -> Result<()> {
    let refuse = |why: String| {
        let target = target.display();
        Error::Usage(format!("{target}: {why}; only a tessim result is replaced"))
    };
    if !target.is_dir() {
        return Err(refuse("exists and is not a folder".to_owned()));
    }
    let entries = fs::read_dir(target).and_then(|entries| {
        entries.map(|entry| entry.map(|entry| entry.file_name())).collect::<io::Result<Vec<_>>>()
    });
    let entries = entries.map_err(|error| Error::system(target, error))?;
    let (always, sometimes): (&[&str], &[&str]) = match &kind {
        Kind::Run => (&ALWAYS, &SOMETIMES),
        Kind::Study { names, sometimes, .. } => (names, sometimes),
    };
    let ours = |name: &str| always.contains(&name) || sometimes.contains(&name);
    for name in always {
        if !entries.iter().any(|entry| entry == *name) {
            return Err(refuse(format!("exists without {name}")));
        }
    }
    for entry in &entries {
        if !entry.to_str().is_some_and(ours) {
            let entry = Path::new(entry).display();
            return Err(refuse(format!("holds {entry}, which no run wrote")));
        }
    }
    let (mark, is_ours) = match kind {
        Kind::Run => {
            let mark = "summary.json";
            (mark, super::summary::is_summary(&target.join(mark)))
        }
        Kind::Study { names, header, .. } => {
            let name = names[0];
            let text = fs::read_to_string(target.join(name)).unwrap_or_default();
            (name, text.lines().next() == Some(&header.join(",")))
        }
    };
    if is_ours { Ok(()) } else { Err(refuse(format!("its {mark} is not tessim's"))) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn write_result(target: &Path, config: &[u8]) -> Result<()> {
        let folder = ResultFolder::create(target)?;
        folder.write("config.toml", config)?;
        folder.write("counters.csv", b"")?;
        folder.write("summary.json", b"{\"tessim\": \"0.1.0\"}")?;
        assert!(config.is_empty() || target.join("config.toml").exists());
        folder.commit()
    }

    #[test]
    fn a_result_replaces_a_result_and_nothing_else() {
        let place = tempfile::tempdir().unwrap();
        let target = place.path().join("out");
        write_result(&target, b"").unwrap();
        write_result(&target, b"second").unwrap();
        assert_eq!(fs::read(target.join("config.toml")).unwrap(), b"second");
        assert_eq!(fs::read_dir(place.path()).unwrap().count(), 1, "nothing is left behind");

        fs::write(target.join("notes.txt"), "mine").unwrap();
        let error = write_result(&target, b"third").unwrap_err();
        assert_eq!(error.exit_code(), 2);
        assert!(error.to_string().contains("notes.txt"), "{error}");
        fs::remove_file(target.join("notes.txt")).unwrap();

        fs::write(target.join("summary.json"), "{}").unwrap();
        assert!(write_result(&target, b"fourth").is_err());
        fs::remove_file(target.join("summary.json")).unwrap();
        assert!(write_result(&target, b"fifth").unwrap_err().to_string().contains("summary"));
        assert_eq!(fs::read(target.join("config.toml")).unwrap(), b"second");
        assert_eq!(fs::read_dir(place.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_study_replaces_the_same_study_and_neither_a_run_nor_another() {
        let place = tempfile::tempdir().unwrap();
        let target = place.path().join("out");
        type Names = &'static [&'static str];
        let write_study = |names: Names, header: Names, rows: &str| {
            let folder = ResultFolder::of_study(&target, names, header)?;
            names[1..].iter().try_for_each(|name| folder.write(name, b""))?;
            folder.write(names[0], format!("{}\n{rows}", header.join(",")).as_bytes())?;
            folder.commit()
        };
        write_study(&["a.csv"], &["x", "y"], "1,2\n").unwrap();
        write_study(&["a.csv"], &["x", "y"], "3,4\n").unwrap();
        assert_eq!(fs::read_to_string(target.join("a.csv")).unwrap(), "x,y\n3,4\n");
        assert!(write_study(&["b.csv"], &["x", "y"], "").is_err());
        assert!(
            write_study(&["a.csv"], &["x", "z"], "").unwrap_err().to_string().contains("a.csv")
        );
        let both: Names = &["a.csv", "a.svg"];
        assert!(write_study(both, &["x", "y"], "").unwrap_err().to_string().contains("a.svg"));
        assert!(write_result(&target, b"").is_err());
        fs::write(target.join("notes.txt"), "mine").unwrap();
        assert!(
            write_study(&["a.csv"], &["x", "y"], "").unwrap_err().to_string().contains("notes")
        );
        fs::remove_dir_all(&target).unwrap();
        write_study(both, &["x", "y"], "1,2\n").unwrap();
        write_study(both, &["x", "y"], "3,4\n").unwrap();
        assert!(write_study(&["a.csv"], &["x", "y"], "").is_err());
        fs::remove_dir_all(&target).unwrap();
        write_result(&target, b"").unwrap();
        assert!(write_study(&["a.csv"], &["x", "y"], "").is_err());
        assert_eq!(fs::read_dir(place.path()).unwrap().count(), 1, "nothing is left behind");
    }

    #[test]
    fn files_and_missing_parents_are_refused_before_anything_is_done() {
        let place = tempfile::tempdir().unwrap();
        let file = place.path().join("file");
        fs::write(&file, "mine").unwrap();
        assert_eq!(ResultFolder::create(&file).unwrap_err().exit_code(), 2);
        let missing = place.path().join("no/such/out");
        let error = ResultFolder::create(&missing).unwrap_err();
        assert_eq!(error.exit_code(), 3);
        assert!(error.to_string().ends_with("does not exist"), "{error}");
    }
}
