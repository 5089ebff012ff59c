//! The folder of a sweep: results of points under their hashes, and who is at work on which.
//!
//! ```text
//! study.toml            the study that the tables are of
//! points.csv sweep.csv  the tables, there only when every point is settled; with them sweep.svg
//! points/HASH/          the result of a point, as `run` writes it, and the command that repeats it
//! failed/HASH.txt       why a point failed
//! work/HASH.lock        held by the process that computes the point: a lock of the system's, which
//!                       ends with the process, however that ends
//! work/HASH             what that process is writing
//! ```
//!
//! Whatever is in `points` and `failed` was renamed there whole. What a killed process leaves in
//! `work` is overwritten by whoever takes up the point.

use crate::error::{Error, Result};
use std::fs::{self, File, TryLockError};
use std::io::{self, BufRead, BufReader, BufWriter, Write};
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};

/// What a sweep writes at the top of its folder; nothing else may be there.
const NAMES: [&str; 8] = [
    "points",
    "failed",
    "work",
    "study.toml",
    "points.csv",
    "sweep.csv",
    "sweep.parquet",
    "sweep.svg",
];

/// What becomes of the tables while points are open: they are not of this study any more.
const TABLES: [&str; 4] = ["points.csv", "sweep.csv", "sweep.parquet", "sweep.svg"];

/// Length of a hash in hexadecimal.
pub(super) const HASH_DIGITS: usize = 32;

/// Stands for the tables among hashes.
const OF_TABLES: &str = "tables";

/// The folder of a sweep.
#[derive(Clone, Debug)]
pub struct Store {
    root: PathBuf,
}

/// What has become of a point.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum State {
    /// Its result is there.
    Completed,
    /// It has none, for this reason.
    Failed(String),
    /// A process is at work on it.
    Running,
    /// None of these.
    NeverRun,
}

/// The right to compute a point, or to write the tables: held by one at a time, given back when it
/// is dropped.
#[derive(Debug)]
pub struct Claim {
    /// Keeps the lock.
    _file: File,
    lock: PathBuf,
    store: Store,
    name: String,
}

impl Store {
    /// The folder at `root`, which need not be there yet.
    ///
    /// # Errors
    /// [`Error::Usage`] for a folder with anything in it that no sweep wrote.
    pub fn at(root: &Path) -> Result<Self> {
        let store = Self { root: root.to_owned() };
        let entries = match fs::read_dir(root) {
            Ok(entries) => entries,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(store),
            Err(error) if error.kind() == io::ErrorKind::NotADirectory => {
                return Err(store.refuse("exists and is not a folder"));
            }
            Err(error) => return Err(Error::system(root, error)),
        };
        for entry in entries {
            let name = entry.map_err(|error| Error::system(root, error))?.file_name();
            if !name.to_str().is_some_and(|name| NAMES.contains(&name)) {
                let name = Path::new(&name).display();
                return Err(store.refuse(&format!("holds {name}, which no sweep wrote")));
            }
        }
        Ok(store)
    }

    fn refuse(&self, why: &str) -> Error {
        let root = self.root.display();
        Error::Usage(format!("{root}: {why}; expected the folder of a sweep, or none yet"))
    }

    /// Where it is.
    #[must_use]
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// Where the result of a point is, or will be.
    #[must_use]
    pub fn point(&self, hash: &str) -> PathBuf {
        self.root.join("points").join(hash)
    }

    fn failure(&self, hash: &str) -> PathBuf {
        self.root.join("failed").join(format!("{hash}.txt"))
    }

    fn work(&self, name: &str) -> PathBuf {
        self.root.join("work").join(name)
    }

    /// Completed or failed, where it is one of them.
    ///
    /// # Errors
    /// A folder that cannot be read.
    pub fn settled(&self, hash: &str) -> Result<Option<State>> {
        if self.point(hash).is_dir() {
            return Ok(Some(State::Completed));
        }
        let path = self.failure(hash);
        match fs::read_to_string(&path) {
            Ok(reason) => Ok(Some(State::Failed(reason))),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(Error::system(path, error)),
        }
    }

    /// What has become of a point.
    ///
    /// # Errors
    /// A folder that cannot be read.
    pub fn state(&self, hash: &str) -> Result<State> {
        if let Some(settled) = self.settled(hash)? {
            return Ok(settled);
        }
        let path = self.work(&format!("{hash}.lock"));
        let file = match File::open(&path) {
            Ok(file) => file,
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                // It may have been settled since we looked.
                return Ok(self.settled(hash)?.unwrap_or(State::NeverRun));
            }
            Err(error) => return Err(Error::system(path, error)),
        };
        match file.try_lock_shared() {
            Ok(()) => Ok(self.settled(hash)?.unwrap_or(State::NeverRun)),
            Err(TryLockError::WouldBlock) => Ok(State::Running),
            Err(TryLockError::Error(error)) => Err(Error::system(path, error)),
        }
    }

    /// Makes the folder, where it is not there yet.
    ///
    /// # Errors
    /// A folder that cannot be made.
    pub fn make(&self) -> Result<()> {
        // One level only: a mistyped path must not come to be.
        match fs::create_dir(&self.root) {
            Err(error) if error.kind() != io::ErrorKind::AlreadyExists => {
                return Err(Error::system(&self.root, error));
            }
            _ => {}
        }
        for name in ["points", "failed", "work"] {
            let path = self.root.join(name);
            fs::create_dir_all(&path).map_err(|error| Error::system(path, error))?;
        }
        Ok(())
    }

    /// The right to compute a point; none when another process has it, unless it is to be waited
    /// for.
    ///
    /// # Errors
    /// A lock that cannot be made.
    pub fn claim(&self, name: &str, wait: bool) -> Result<Option<Claim>> {
        let lock = self.work(&format!("{name}.lock"));
        let failed = |error| Error::system(&lock, error);
        loop {
            let file = File::options().create(true).append(true).open(&lock).map_err(failed)?;
            if wait {
                file.lock().map_err(failed)?;
            } else {
                match file.try_lock() {
                    Ok(()) => {}
                    Err(TryLockError::WouldBlock) => return Ok(None),
                    Err(TryLockError::Error(error)) => return Err(failed(error)),
                }
            }
            // Whoever had it has removed the file: only a lock of the one that is there counts.
            let ours = file.metadata().map_err(failed)?;
            let there = fs::metadata(&lock).ok();
            if there.is_some_and(|there| (there.dev(), there.ino()) == (ours.dev(), ours.ino())) {
                let (store, name) = (self.clone(), name.to_owned());
                return Ok(Some(Claim { _file: file, lock, store, name }));
            }
        }
    }

    /// Removes what killed processes have left in `work`; what anybody is at work on stays.
    ///
    /// # Errors
    /// A folder that cannot be read, a file that cannot be removed.
    pub fn tidy(&self) -> Result<()> {
        let work = self.root.join("work");
        let failed = |error| Error::system(&work, error);
        for entry in fs::read_dir(&work).map_err(failed)? {
            let name = entry.map_err(failed)?.file_name();
            let stem = name.to_str().and_then(|name| name.split('.').next());
            let Some(hash) = stem.filter(|stem| stem.len() == HASH_DIGITS) else { continue };
            // Dropping the claim removes the lock.
            let Some(_claim) = self.claim(hash, false)? else { continue };
            absent(fs::remove_dir_all(self.work(hash)), ()).map_err(failed)?;
            absent(fs::remove_file(self.work(&format!("{hash}.txt"))), ()).map_err(failed)?;
        }
        Ok(())
    }

    /// The right to write the tables, waited for.
    ///
    /// # Errors
    /// As [`Self::claim`].
    pub fn claim_tables(&self) -> Result<Claim> {
        let claim = self.claim(OF_TABLES, true)?;
        Ok(claim.expect("what is waited for is got"))
    }
}

impl Claim {
    /// Puts the result of the point in its place.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn complete(&self, files: &[(&str, Vec<u8>)]) -> Result<()> {
        let work = self.store.work(&self.name);
        let target = self.store.point(&self.name);
        let failed = |error| Error::system(&target, error);
        absent(fs::remove_dir_all(&work), ()).map_err(failed)?;
        fs::create_dir(&work).map_err(failed)?;
        for (name, bytes) in files {
            let written = fs::write(work.join(name), bytes);
            written.map_err(|error| Error::system(target.join(name), error))?;
        }
        fs::rename(&work, &target).map_err(failed)
    }

    /// Says why the point has no result.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn fail(&self, reason: &str) -> Result<()> {
        let work = self.store.work(&format!("{}.txt", self.name));
        let target = self.store.failure(&self.name);
        let written = fs::write(&work, reason).and_then(|()| fs::rename(&work, &target));
        written.map_err(|error| Error::system(target, error))
    }

    /// Writes a file for the top of the folder, which is not there yet.
    ///
    /// # Errors
    /// Those of `write`, and a file that cannot be written.
    pub fn draft(
        &self,
        name: &str,
        write: impl FnOnce(&mut BufWriter<File>) -> Result<()>,
    ) -> Result<()> {
        let failed = |error| Error::system(self.store.root.join(name), error);
        let mut file = File::create(self.store.work(name)).map(BufWriter::new).map_err(failed)?;
        write(&mut file)?;
        file.flush().map_err(failed)
    }

    /// Puts drafts in their places, unless the same are there: so that whoever ends after another
    /// takes nothing away from its readers. No table is ever there with another study's.
    ///
    /// # Errors
    /// A file that cannot be read or renamed.
    pub fn publish(&self, names: &[&str]) -> Result<()> {
        let places = |name: &&str| (self.store.work(name), self.store.root.join(name));
        let mut old = false;
        for (draft, target) in names.iter().map(places) {
            let same = absent(same(&draft, &target), false);
            old |= !same.map_err(|error| Error::system(target, error))?;
        }
        if old {
            self.remove_tables()?;
        }
        for (draft, target) in names.iter().map(places) {
            let moved = if old { fs::rename(&draft, &target) } else { fs::remove_file(&draft) };
            moved.map_err(|error| Error::system(target, error))?;
        }
        Ok(())
    }

    /// Removes the tables.
    ///
    /// # Errors
    /// A file that cannot be removed.
    pub fn remove_tables(&self) -> Result<()> {
        for path in TABLES.map(|name| self.store.root.join(name)) {
            absent(fs::remove_file(&path), ()).map_err(|error| Error::system(path, error))?;
        }
        Ok(())
    }
}

impl Drop for Claim {
    fn drop(&mut self) {
        // While the lock is held, so that nobody can get it and lose its name. A file that stays
        // does no harm.
        let _ = fs::remove_file(&self.lock);
    }
}

/// What is to be said of what is not there.
fn absent<T>(found: io::Result<T>, none: T) -> io::Result<T> {
    found.or_else(|error| match error.kind() {
        io::ErrorKind::NotFound => Ok(none),
        _ => Err(error),
    })
}

/// Whether two files say the same.
fn same(one: &Path, other: &Path) -> io::Result<bool> {
    let open = |path| File::open(path).map(BufReader::new);
    let (mut one, mut other) = (open(one)?, open(other)?);
    loop {
        let (left, right) = (one.fill_buf()?, other.fill_buf()?);
        let count = left.len().min(right.len());
        if count == 0 || left[..count] != right[..count] {
            return Ok(left.is_empty() && right.is_empty());
        }
        one.consume(count);
        other.consume(count);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(store: &Store, files: &[(&str, &str)]) {
        let claim = store.claim_tables().unwrap();
        for (name, text) in files {
            let write = |file: &mut BufWriter<File>| {
                file.write_all(text.as_bytes()).map_err(|error| Error::system(name, error))
            };
            claim.draft(name, write).unwrap();
        }
        let names: Vec<_> = files.iter().map(|(name, _)| *name).collect();
        claim.publish(&names).unwrap();
    }

    #[test]
    fn tables_of_one_study_never_stand_beside_those_of_another() {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::at(folder.path()).unwrap();
        store.make().unwrap();
        let there = |name: &str| folder.path().join(name).exists();
        let (study, points) = (("study.toml", "one"), ("points.csv", "1"));
        written(&store, &[study, points, ("sweep.csv", "1")]);
        let before = fs::metadata(folder.path().join("sweep.csv")).unwrap().ino();
        written(&store, &[study, points, ("sweep.csv", "1")]);
        let after = fs::metadata(folder.path().join("sweep.csv")).unwrap().ino();
        assert_eq!(before, after, "the same tables stay where they are");
        assert_eq!(fs::read_dir(folder.path().join("work")).unwrap().count(), 0);
        // What is not written anew is of the old study.
        written(&store, &[study, ("points.csv", "2")]);
        assert!(there("points.csv") && !there("sweep.csv"));
        written(&store, &[("study.toml", "two")]);
        assert!(there("study.toml") && !there("points.csv"));
    }

    #[test]
    fn a_claim_is_of_one_at_a_time_and_ends_with_its_holder() {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::at(folder.path()).unwrap();
        store.make().unwrap();
        let hash = "0123456789abcdef0123456789abcdef";
        let claim = store.claim(hash, false).unwrap().expect("nobody has it");
        assert!(store.claim(hash, false).unwrap().is_none());
        assert_eq!(store.state(hash).unwrap(), State::Running);
        drop(claim);
        assert_eq!(store.state(hash).unwrap(), State::NeverRun);
        let claim = store.claim(hash, false).unwrap().expect("it was given back");
        claim.complete(&[("counters.csv", b"whole".to_vec())]).unwrap();
        drop(claim);
        assert_eq!(store.state(hash).unwrap(), State::Completed);
        assert_eq!(fs::read_dir(folder.path().join("work")).unwrap().count(), 0);
    }
}
