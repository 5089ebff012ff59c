//! The text of a study: TOML in; strings, names and tables of keys out, each with its place, in the
//! order of the file.

use crate::config::keys::Key;
use crate::config::layers::{Placed, place, snippet};
use crate::error::{Error, Result, nearest};
use toml::de::{DeTable, DeValue};
use toml::{Spanned, Value};

/// A file's text under its name.
#[derive(Clone, Copy)]
pub(super) struct Text<'t> {
    pub(super) file: &'t str,
    pub(super) text: &'t str,
}

/// A value that is no table: its dotted path within its section, where its key stands, and it.
pub(super) struct Leaf<'v, 't> {
    pub(super) path: String,
    pub(super) start: usize,
    pub(super) value: &'v Spanned<DeValue<'t>>,
}

impl<'t> Text<'t> {
    /// Blames what stands at `offset`.
    pub(super) fn error(&self, offset: usize, message: String) -> Error {
        Error::Input { file: self.file.to_owned(), place: place(self.text, offset), message }
    }

    /// A name that nothing has at this place, and the one that was probably meant.
    pub(super) fn unknown(&self, offset: usize, found: &str, known: &[&str]) -> Error {
        let nearest = nearest(found, known).map_or("", |known| *known);
        let (found, all) = (snippet(found), known.join(", "));
        let message = format!("unknown `{found}`; did you mean `{nearest}`? (known: {all})");
        self.error(offset, message)
    }

    /// The whole text.
    pub(super) fn table(&self) -> Result<DeTable<'t>> {
        let table = DeTable::parse(self.text).map_err(|error| {
            let start = error.span().map_or(0, |span| span.start);
            self.error(start, error.message().to_owned())
        })?;
        Ok(table.into_inner())
    }

    /// What stands there, for a message.
    pub(super) fn found(&self, value: &Spanned<DeValue<'_>>) -> String {
        snippet(&self.text[value.span()])
    }

    /// Where the value of a name begins, or the file, where it is not in it.
    pub(super) fn start_of(&self, table: &DeTable<'_>, name: &str) -> usize {
        table.get(name).map_or(0, |value| value.span().start)
    }

    /// A value of a key.
    pub(super) fn placed(&self, key: &'static Key, value: &Spanned<DeValue<'_>>) -> Result<Placed> {
        let span = value.span();
        let parsed = self.text[span.clone()].parse::<Value>();
        let value = parsed.map_err(|error| self.error(span.start, error.message().to_owned()))?;
        Ok(Placed { key, value, place: place(self.text, span.start) })
    }

    /// A string that says something.
    pub(super) fn name(&self, value: &Spanned<DeValue<'_>>, what: &str) -> Result<String> {
        match value.get_ref().as_str().filter(|name| !name.is_empty()) {
            Some(name) => Ok(name.to_owned()),
            None => {
                let message = format!("{what}: found {}, expected a string", self.found(value));
                Err(self.error(value.span().start, message))
            }
        }
    }

    /// What a name stands for.
    pub(super) fn named<T>(
        &self,
        value: &Spanned<DeValue<'_>>,
        what: &str,
        named: impl Fn(&str) -> Option<T>,
        names: &[&str],
    ) -> Result<T> {
        let name = self.name(value, what)?;
        named(&name).ok_or_else(|| self.unknown(value.span().start, &name, names))
    }

    /// The string of a name at the top.
    pub(super) fn string(&self, table: &DeTable<'_>, name: &str) -> Result<Option<String>> {
        table.get(name).map(|value| self.name(value, name)).transpose()
    }

    /// The name of a trace, which is read more than once: no standard input.
    pub(super) fn trace(&self, value: &Spanned<DeValue<'_>>, what: &str) -> Result<String> {
        let name = self.name(value, what)?;
        if name == "-" {
            let message = format!("{what}: found standard input, expected the path of a file");
            return Err(self.error(value.span().start, message));
        }
        Ok(name)
    }

    /// The names of the traces at the top, if any.
    pub(super) fn traces(&self, table: &DeTable<'_>) -> Result<Vec<String>> {
        let names = self.each(table, "traces", |value| self.trace(value, "traces"))?;
        Ok(names.unwrap_or_default())
    }

    /// What the names of a list at the top stand for.
    pub(super) fn names<T>(
        &self,
        table: &DeTable<'_>,
        name: &str,
        named: fn(&str) -> Option<T>,
        names: &[&str],
    ) -> Result<Option<Vec<T>>> {
        self.each(table, name, |value| self.named(value, name, named, names))
    }

    fn each<T>(
        &self,
        table: &DeTable<'_>,
        name: &str,
        take: impl Fn(&Spanned<DeValue<'_>>) -> Result<T>,
    ) -> Result<Option<Vec<T>>> {
        let Some(value) = table.get(name) else { return Ok(None) };
        let Some(values) = value.get_ref().as_array().filter(|values| !values.is_empty()) else {
            let found = self.found(value);
            let message = format!("{name}: found {found}, expected a list of strings");
            return Err(self.error(value.span().start, message));
        };
        values.iter().map(take).collect::<Result<_>>().map(Some)
    }

    /// The leaves of a section, in the order of the file, none twice. Dotted keys and tables are
    /// the same: TOML says so of `a.b` and `[a] b`, and a quoted `"a.b"` is read alike.
    pub(super) fn leaves<'v>(
        &self,
        section: &str,
        value: &'v Spanned<DeValue<'t>>,
    ) -> Result<Vec<Leaf<'v, 't>>> {
        let Some(table) = value.get_ref().as_table() else {
            let found = self.found(value);
            let message = format!("{section}: found {found}, expected a table of keys");
            return Err(self.error(value.span().start, message));
        };
        let mut leaves = Vec::new();
        flatten(&mut leaves, "", table);
        leaves.sort_by_key(|leaf| leaf.start);
        for (at, leaf) in leaves.iter().enumerate() {
            if leaves[..at].iter().any(|before| before.path == leaf.path) {
                let message = format!("{section}: found {} twice", leaf.path);
                return Err(self.error(leaf.start, message));
            }
        }
        Ok(leaves)
    }
}

fn flatten<'v, 't>(leaves: &mut Vec<Leaf<'v, 't>>, prefix: &str, table: &'v DeTable<'t>) {
    for (key, value) in table {
        let path = format!("{prefix}{}", key.get_ref());
        match value.get_ref() {
            DeValue::Table(inner) => flatten(leaves, &format!("{path}."), inner),
            _ => leaves.push(Leaf { path, start: key.span().start, value }),
        }
    }
}
