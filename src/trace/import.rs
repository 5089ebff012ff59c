//! Import: a model of bicubic Bézier patches as a BPT file in, a trace of one frame out.
//!
//! BPT is the plain text in which Newell's models are passed round: the number of patches, then for
//! each patch its degrees, `3 3`, and 16 points `x y z`. Its points are row-major, as a trace's
//! are, so they keep their order. It has no camera: the frame looks at the middle of the bounding
//! box from the front, a bit from the right and above, with z up, from where all of the model is
//! seen.

use super::command::{Command, Draw, Header, Points, Primitive, Tessellation};
use super::json::snippet;
use super::lines::{LINE_BYTES_MAX, Line, Lines};
use super::points::PointSource;
use super::scene::camera::Camera;
use super::write::Writer;
use crate::error::{Error, Place, Result};
use std::ffi::OsStr;
use std::fmt::Display;
use std::io::{BufRead, Write};
use std::path::Path;
use std::sync::Arc;

/// The most patches of a file.
const PATCHES_MAX: u64 = 1 << 24;
/// The largest coordinate: beyond it the frame's matrices would leave 32-bit floating point.
const COORDINATE_MAX: f32 = 1e18;
/// Patches of one draw: keeps a line of the trace at a few megabytes.
const PATCHES_A_DRAW: usize = 1 << 13;

/// Reads the BPT file `input`, which messages call `file_name`, and writes a trace of it.
///
/// # Errors
/// A malformed file, with line and column; what input and output say.
pub fn import_bpt(input: impl BufRead, file_name: &str, output: impl Write) -> Result<()> {
    let points = read_bpt(input, file_name)?;
    // Its own name only: a trace holds no path of the machine that it was made on.
    let name = Path::new(file_name).file_name().map_or(file_name.into(), OsStr::to_string_lossy);
    let title = format!("{} patches from {name}", points.len() / 16);
    write(&points, title, output).map_err(|e| Error::system("the imported trace", e))
}

fn write(points: &[[f32; 3]], title: String, output: impl Write) -> std::io::Result<()> {
    let mut writer = Writer::new(output);
    let source = "imported by tessim from BPT".into();
    writer.write(&Command::Header(Header { title, source, licence: String::new() }))?;
    writer.write(&Command::Frame(Camera::on(points, [0.45, -1.0, 0.5]).frame()))?;
    writer.write(&Command::Tessellation(Tessellation::default()))?;
    for chunk in points.chunks(16 * PATCHES_A_DRAW) {
        let source = Arc::new(PointSource::Xyz(chunk.to_vec()));
        writer.write(&Command::Points(Points { id: 0, source, resident: false }))?;
        writer.write(&Command::Draw(Draw::new(
            Primitive::Patches { count: (chunk.len() / 16) as u64 },
            0,
        )))?;
    }
    writer.write(&Command::End)
}

/// The control points of a BPT file, 16 a patch, row-major.
///
/// # Errors
/// A malformed file, with line and column.
pub fn read_bpt(input: impl BufRead, file_name: &str) -> Result<Vec<[f32; 3]>> {
    let mut words = Words { lines: Lines::new(input), file: file_name, column: 0, last: 0 };
    let count = words.integer("the number of patches")?;
    if !(1..=PATCHES_MAX).contains(&count) {
        let expected = format!("from 1 to {PATCHES_MAX} patches");
        return Err(words.error(format!("found {count} patches, expected {expected}")));
    }
    // Grows as points come: a count costs nothing until they do.
    let mut points = Vec::new();
    for patch in 0..count {
        for which in ["first", "second"] {
            let what = format!("patch {patch}: the {which} degree");
            let degree = words.integer(&what)?;
            if degree != 3 {
                let message =
                    format!("{what}: found {degree}, expected 3, as only bicubic patches are read");
                return Err(words.error(message));
            }
        }
        for point in 0..16 {
            let mut xyz = [0.0; 3];
            for (number, name) in xyz.iter_mut().zip(["x", "y", "z"]) {
                *number = words.real(&format_args!("patch {patch}, point {point}, {name}"))?;
            }
            points.push(xyz);
        }
    }
    match words.next()? {
        None => Ok(points),
        Some(word) => {
            let message = format!("found `{word}`, expected the end after {count} patches");
            Err(words.error(message))
        }
    }
}

/// The words of a file, whatever white space is between them.
struct Words<'f, R> {
    lines: Lines<R>,
    file: &'f str,
    /// Where the next word may begin in the current line, in bytes from 0; the last word ends here.
    column: usize,
    /// Where the last word begins.
    last: usize,
}

impl<R: BufRead> Words<'_, R> {
    fn integer(&mut self, what: &str) -> Result<u64> {
        let word = self.word(&what)?;
        word.parse().map_err(|_| self.error(format!("{what}: found `{word}`, expected an integer")))
    }

    fn real(&mut self, what: &dyn Display) -> Result<f32> {
        let word = self.word(what)?;
        match word.parse::<f32>() {
            Ok(number) if number.abs() <= COORDINATE_MAX => Ok(number),
            _ => Err(self.error(format!(
                "{what}: found `{word}`, expected a number of magnitude up to {COORDINATE_MAX:e}"
            ))),
        }
    }

    fn word(&mut self, what: &dyn Display) -> Result<String> {
        let word = self.next()?;
        word.ok_or_else(|| self.error(format!("the file ends here, expected {what}")))
    }

    fn error(&self, message: String) -> Error {
        let place = Place::Line { line: self.lines.number().max(1), column: self.last + 1 };
        Error::Input { file: self.file.into(), place, message }
    }

    /// The next word, cut to what a message quotes: no number is that long.
    fn next(&mut self) -> Result<Option<String>> {
        loop {
            let rest = &self.lines.bytes()[self.column.min(self.lines.bytes().len())..];
            if let Some(gap) = rest.iter().position(|b| !b.is_ascii_whitespace()) {
                let word = &rest[gap..];
                let end = word.iter().position(u8::is_ascii_whitespace).unwrap_or(word.len());
                let text = snippet(&String::from_utf8_lossy(&word[..end])).into_owned();
                self.last = self.column + gap;
                self.column = self.last + end;
                return Ok(Some(text));
            }
            (self.column, self.last) = (0, 0);
            match self.lines.advance().map_err(|e| Error::system(self.file, e))? {
                Line::Read => {}
                Line::End => return Ok(None),
                Line::TooLong => {
                    let mib = LINE_BYTES_MAX >> 20;
                    return Err(self.error(format!("found a line of more than {mib} MiB")));
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::command::Command;
    use super::super::read::Reader;
    use super::*;

    fn patch() -> String {
        (0..16).map(|i| format!("{} {}\t0.5\n\n", i % 4, i / 4)).collect()
    }

    #[test]
    fn an_imported_model_is_a_trace_with_its_points_in_order() {
        let text = format!("\r\n 2\r\n3 3\n{0} 3\n3 {0}", patch());
        let mut trace = Vec::new();
        import_bpt(text.as_bytes(), "two.bpt", &mut trace).unwrap();
        let all: Result<Vec<_>> = Reader::new(&trace[..], "two.jsonl", ".").collect();
        let all = all.unwrap();
        let Command::Points(points) = &all[3].command else { panic!("{:?}", all[3]) };
        assert_eq!(points.source.len(), 32);
        let mut first = Vec::new();
        points.source.read(0, 6, &mut first).unwrap();
        assert_eq!(first[5], [1.0, 1.0, 0.5, 1.0]);
    }

    #[test]
    fn a_model_of_one_point_or_of_huge_size_still_has_a_camera() {
        for number in ["0", "1e-30", "1e18", "-1e18"] {
            let text = format!("1\n3 3\n{}", format!("{number} {number} {number}\n").repeat(16));
            let mut trace = Vec::new();
            import_bpt(text.as_bytes(), "dot.bpt", &mut trace).unwrap();
            for command in Reader::new(&trace[..], "dot.jsonl", ".") {
                command.unwrap();
            }
        }
    }
}
