//! A place for a sweep: a folder with a study and the traces that it names, and the command there.

use assert_cmd::Command;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// A folder that is gone when it is dropped.
pub(crate) struct Place {
    folder: TempDir,
}

/// Everything under a folder: paths with `/`, and bytes.
pub(crate) type Tree = BTreeMap<String, Vec<u8>>;

impl Place {
    /// With this study in it, and `fan.jsonl` and `mesh.jsonl` beside it.
    pub(crate) fn new(study: &str) -> Self {
        let place = Self { folder: tempfile::tempdir().unwrap() };
        for name in ["fan.jsonl", "mesh.jsonl"] {
            fs::copy(shipped(name), place.path(name)).unwrap();
        }
        place.study(study);
        place
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Another study under the same name.
    pub(crate) fn study(&self, text: &str) {
        fs::write(self.path("study.toml"), text).unwrap();
    }

    /// The command on the study, for the folder `out`.
    pub(crate) fn sweep(&self, out: &str) -> Command {
        let mut command = tessim();
        command.current_dir(self.folder.path());
        command.args(["sweep", "study.toml", "--out", out]);
        command
    }

    /// What the sweep prints, which succeeds.
    #[track_caller]
    pub(crate) fn swept(&self, out: &str) -> String {
        printed(&mut self.sweep(out))
    }

    pub(crate) fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    /// The rows of a CSV, each a cell by its column's name.
    pub(crate) fn rows(&self, name: &str) -> Vec<BTreeMap<String, String>> {
        let text = self.read(name);
        let mut csv = csv::Reader::from_reader(text.as_bytes());
        csv.deserialize().map(Result::unwrap).collect()
    }

    /// The hashes of the results that are there.
    pub(crate) fn points(&self, out: &str) -> Vec<String> {
        let entries = fs::read_dir(self.path(out).join("points"));
        let names = entries.into_iter().flatten().map(|e| e.unwrap().file_name());
        let mut names: Vec<_> = names.map(|name| name.into_string().unwrap()).collect();
        names.sort();
        names
    }

    pub(crate) fn tree(&self, name: &str) -> Tree {
        let mut tree = Tree::new();
        walk(&self.path(name), "", &mut tree);
        tree
    }
}

fn walk(folder: &Path, prefix: &str, tree: &mut Tree) {
    for entry in fs::read_dir(folder).unwrap() {
        let entry = entry.unwrap();
        let name = format!("{prefix}{}", entry.file_name().to_str().unwrap());
        if entry.path().is_dir() {
            walk(&entry.path(), &format!("{name}/"), tree);
        } else {
            tree.insert(name, fs::read(entry.path()).unwrap());
        }
    }
}

pub(crate) fn tessim() -> Command {
    Command::cargo_bin("tessim").expect("the command is built for its tests")
}

pub(crate) fn shipped(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("traces").join(name)
}

/// What a command prints, which succeeds and has nothing to complain of.
#[track_caller]
pub(crate) fn printed(command: &mut Command) -> String {
    let output = command.output().unwrap();
    assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
    String::from_utf8(output.stdout).unwrap()
}

/// What a command prints and says that fails with this code.
#[track_caller]
pub(crate) fn fails(code: i32, command: &mut Command) -> (String, String) {
    let output = command.output().unwrap();
    assert_eq!(output.status.code(), Some(code), "{output:?}");
    let [printed, said] = [output.stdout, output.stderr].map(|b| String::from_utf8(b).unwrap());
    (printed, said)
}

/// The number before a word of what a sweep prints: different points, computed, found.
#[track_caller]
pub(crate) fn count(printed: &str, word: &str) -> usize {
    let line = printed.lines().next().unwrap();
    let before = line.split(&format!(" {word}")).next().unwrap();
    let number = before.rsplit(' ').next().unwrap();
    number.parse().unwrap_or_else(|_| panic!("no number before {word}: {line}"))
}
