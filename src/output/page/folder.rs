//! A result folder read again: its tables, texts and pictures, as they are in the files.

use crate::error::{Error, Place, Result};
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// What a folder is the result of, and the file that says so.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Of `compare`.
    Comparison,
    /// Of `precision`.
    Precision,
    /// Of `sweep`.
    Sweep,
    /// Of `run`.
    Run,
}

/// Each kind and its mark, looked for in this order.
const MARKS: [(Kind, &str); 4] = [
    (Kind::Comparison, "compare.csv"),
    (Kind::Precision, "precision.csv"),
    (Kind::Sweep, "points.csv"),
    (Kind::Run, "counters.csv"),
];

/// Columns with numbers in them, or nothing, in whichever file they are.
const NUMBERS: [&str; 5] = ["value", "first", "min", "median", "max"];

/// A CSV file.
#[derive(Debug)]
pub struct Csv {
    /// Its name in the folder.
    pub file: String,
    /// Where it is.
    pub path: PathBuf,
    /// The names of its columns.
    pub header: Vec<String>,
    /// Its rows, as long as the header.
    pub rows: Vec<Vec<String>>,
}

/// A picture, as an address that holds all of it.
#[derive(Debug)]
pub struct Image {
    /// Its name in the folder.
    pub file: String,
    /// `data:image/...`: a script inside a picture does not run.
    pub address: String,
}

/// A result folder.
#[derive(Debug)]
pub struct Folder {
    /// What it is the result of.
    pub kind: Kind,
    /// Its own name.
    pub name: String,
    /// `config.toml` and `study.toml`: name and text of those that are there.
    pub texts: Vec<(String, String)>,
    /// Every CSV, the one that marks the folder first, else by name.
    pub tables: Vec<Csv>,
    /// Every SVG and PNG, by name.
    pub images: Vec<Image>,
    /// `summary.json`; those of the points of a sweep, each once.
    pub summaries: Vec<Value>,
}

impl Folder {
    /// Reads the folder at `path`.
    ///
    /// # Errors
    /// [`Error::Usage`] when it is no result of `tessim`, [`Error::Input`] with file and line when
    /// a file in it is damaged, [`Error::System`] when one cannot be read.
    pub fn read(path: &Path) -> Result<Self> {
        let names = names(path)?;
        let Some((kind, mark)) = MARKS.into_iter().find(|(_, mark)| names.contains(*mark)) else {
            return Err(unknown(path, &names));
        };
        let with = |end: &'static str| names.iter().filter(move |name| name.ends_with(end));
        let rest = with(".csv").map(String::as_str).filter(|name| *name != mark);
        let tables = [mark].into_iter().chain(rest).map(|name| table(path, name));
        let tables: Vec<_> = tables.collect::<Result<_>>()?;
        let images = with(".svg").chain(with(".png")).map(|name| image(path, name));
        let wanted = ["study.toml", "config.toml"].into_iter().filter(|name| names.contains(*name));
        let texts = wanted.map(|name| Ok((name.to_owned(), text(&path.join(name))?)));
        let summaries = match kind {
            Kind::Sweep => of_points(path, &tables[0])?,
            _ => vec![summary(&path.join("summary.json"))?],
        };
        // The name as the user would call it, also of `.`.
        let whole = fs::canonicalize(path).map_err(|error| Error::system(path, error))?;
        let name = whole.file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned());
        let (images, texts) = (images.collect::<Result<_>>()?, texts.collect::<Result<_>>()?);
        Ok(Self { kind, name, texts, tables, images, summaries })
    }

    /// The table of this name.
    #[must_use]
    pub fn table(&self, file: &str) -> Option<&Csv> {
        self.tables.iter().find(|table| table.file == file)
    }
}

impl Csv {
    /// Where the column of this name is.
    #[must_use]
    pub fn column(&self, name: &str) -> Option<usize> {
        self.header.iter().position(|column| column == name)
    }

    /// Where all the columns of these names are.
    #[must_use]
    pub fn columns<const N: usize>(&self, names: [&str; N]) -> Option<[usize; N]> {
        let places = names.map(|name| self.column(name));
        places
            .iter()
            .all(Option::is_some)
            .then(|| places.map(|place| place.expect("all are there")))
    }
}

/// Says what a folder holds that is no result.
fn unknown(path: &Path, names: &BTreeSet<String>) -> Error {
    let marks = MARKS.map(|(_, mark)| mark).join(", ");
    let shown = 5;
    let mut found = names.iter().take(shown).cloned().collect::<Vec<_>>().join(", ");
    match names.len() {
        0 => found.push_str("nothing"),
        all if all > shown => found.push_str(&format!(" and {} more", all - shown)),
        _ => {}
    }
    let path = path.display();
    Error::Usage(format!(
        "{path}: no result of tessim: found {found}; expected a folder with one of {marks}"
    ))
}

/// The names of the files in the folder, in order.
fn names(path: &Path) -> Result<BTreeSet<String>> {
    let entries = fs::read_dir(path).map_err(|error| match error.kind() {
        ErrorKind::NotFound | ErrorKind::NotADirectory => {
            Error::Usage(format!("{}: not a folder; expected a result of tessim", path.display()))
        }
        _ => Error::system(path, error),
    })?;
    let names = entries.map(|entry| Ok(entry?.file_name().to_string_lossy().into_owned()));
    names.collect::<io::Result<_>>().map_err(|error| Error::system(path, error))
}

fn table(folder: &Path, name: &str) -> Result<Csv> {
    let path = folder.join(name);
    let wrong = |error: &csv::Error| {
        let line = error.position().map_or(1, csv::Position::line);
        input(&path, line, 0, csv_message(error))
    };
    let file = fs::File::open(&path).map_err(|error| Error::system(&path, error))?;
    let mut reader = csv::Reader::from_reader(file);
    let header: Vec<_> =
        reader.headers().map_err(|e| wrong(&e))?.iter().map(ToOwned::to_owned).collect();
    if header.is_empty() {
        return Err(input(&path, 1, 0, "expected the names of columns".to_owned()));
    }
    let numbers: Vec<_> =
        (0..header.len()).filter(|&at| NUMBERS.contains(&header[at].as_str())).collect();
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|error| wrong(&error))?;
        for &at in &numbers {
            let cell = &record[at];
            if !cell.is_empty() && !cell.parse().is_ok_and(f64::is_finite) {
                let line = record.position().map_or(1, csv::Position::line);
                let message = format!("{}: found {cell:?}, expected a number", header[at]);
                return Err(input(&path, line, 0, message));
            }
        }
        rows.push(record.iter().map(ToOwned::to_owned).collect());
    }
    Ok(Csv { file: name.to_owned(), path, header, rows })
}

/// Without the place, which goes in front.
fn csv_message(error: &csv::Error) -> String {
    match error.kind() {
        csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
            format!("found {len} cells, expected {expected_len}, one a column")
        }
        csv::ErrorKind::Utf8 { .. } => "found bytes that are no UTF-8, expected text".to_owned(),
        _ => format!("expected CSV: {error}"),
    }
}

fn image(folder: &Path, name: &str) -> Result<Image> {
    use base64::prelude::{BASE64_STANDARD, Engine};
    let path = folder.join(name);
    let bytes = fs::read(&path).map_err(|error| Error::system(&path, error))?;
    let (kind, whole, expected) = match name.ends_with(".png") {
        true => ("png", is_png(&bytes), "a whole PNG, from its signature to its chunk IEND"),
        false => ("svg+xml", is_svg(&bytes), "a whole SVG, from <svg or <?xml to </svg>"),
    };
    if !whole {
        let message =
            format!("found {} bytes that are something else; expected {expected}", bytes.len());
        return Err(Error::Input {
            file: path.display().to_string(),
            place: Place::Byte(0),
            message,
        });
    }
    let address = format!("data:image/{kind};base64,{}", BASE64_STANDARD.encode(bytes));
    Ok(Image { file: name.to_owned(), address })
}

/// Whether a file begins and ends as a PNG does.
fn is_png(bytes: &[u8]) -> bool {
    bytes.starts_with(b"\x89PNG\r\n\x1a\n") && bytes.ends_with(b"\0\0\0\0IEND\xae\x42\x60\x82")
}

/// Whether a file begins and ends as an SVG does.
fn is_svg(bytes: &[u8]) -> bool {
    let Ok(text) = str::from_utf8(bytes).map(str::trim) else { return false };
    (text.starts_with("<svg") || text.starts_with("<?xml")) && text.ends_with("</svg>")
}

fn text(path: &Path) -> Result<String> {
    let bytes = fs::read(path).map_err(|error| Error::system(path, error))?;
    String::from_utf8(bytes).map_err(|error| {
        let before = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        let line = 1 + before.iter().filter(|byte| **byte == b'\n').count() as u64;
        input(path, line, 0, "found bytes that are no UTF-8, expected text".to_owned())
    })
}

fn summary(path: &Path) -> Result<Value> {
    let text = text(path).map_err(|error| match error {
        Error::System { source, .. } if source.kind() == ErrorKind::NotFound => {
            input(path, 1, 0, "not there; expected the summary of the result".to_owned())
        }
        other => other,
    })?;
    let value: Value = serde_json::from_str(&text).map_err(|error| {
        // Its own words end in the place, which goes in front.
        let said = error.to_string();
        let reason = said.rsplit_once(" at line ").map_or(said.as_str(), |(reason, _)| reason);
        input(path, error.line() as u64, error.column(), format!("expected JSON: {reason}"))
    })?;
    let expected = "expected an object with `tessim`, the version that wrote it";
    match value.get("tessim").is_some_and(Value::is_string) {
        true => Ok(value),
        false => Err(input(path, 1, 0, expected.to_owned())),
    }
}

/// The summaries of the points that a sweep's table names and that came to an end: those that say
/// of another trace or version.
fn of_points(folder: &Path, points: &Csv) -> Result<Vec<Value>> {
    let mut found: Vec<Value> = Vec::new();
    let Some([state, hash]) = points.columns(["state", "hash"]) else { return Ok(found) };
    for row in &points.rows {
        // A hash, and no way out of the folder.
        let plain = !row[hash].is_empty() && row[hash].bytes().all(|b| b.is_ascii_hexdigit());
        let path: PathBuf = folder.join("points").join(&row[hash]).join("summary.json");
        if !plain || row[state] != "completed" {
            continue;
        }
        let summary = summary(&path)?;
        let said = |v: &Value| (v["tessim"].clone(), v["trace"].clone());
        if !found.iter().any(|other| said(other) == said(&summary)) {
            found.push(summary);
        }
    }
    Ok(found)
}

fn input(path: &Path, line: u64, column: usize, message: String) -> Error {
    let place = Place::Line { line, column };
    Error::Input { file: path.display().to_string(), place, message }
}
