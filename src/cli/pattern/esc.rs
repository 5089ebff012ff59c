//! Patterns of unit esc: which candidates of a coarse triangle's edges are inserted in, its
//! triangles out.

use super::super::print;
use super::lines::{self, Line, found};
use rtl_model::esc::{Edge, Insertion, LEVEL_MAX, Site};
use serde::Serialize;
use std::io::{self, Write};
use std::path::Path;
use tessim::error::{Error, Result};

/// The edges in their order on a line, with the names that flags and output give them.
const EDGES: [(Edge, &str); 3] =
    [(Edge::Left, "left"), (Edge::Right, "right"), (Edge::Bottom, "bottom")];

#[derive(Debug, clap::Args)]
pub(super) struct CoarseArgs {
    /// Of unit esc: the level, 1 to 15
    #[arg(long, value_name = "L", allow_hyphen_values = true, conflicts_with = "batch")]
    level: Option<String>,
    /// Of unit esc: a bit for each position of the left edge, from the apex [default: all ones]
    #[arg(long, value_name = "BITS", conflicts_with = "batch")]
    left: Option<String>,
    /// The same of the right edge, from the apex [default: all ones]
    #[arg(long, value_name = "BITS", conflicts_with = "batch")]
    right: Option<String>,
    /// The same of the bottom edge, from the left [default: all ones]
    #[arg(long, value_name = "BITS", conflicts_with = "batch")]
    bottom: Option<String>,
}

impl CoarseArgs {
    /// The flags, and whether each was given.
    pub(super) fn given(&self) -> [(&'static str, bool); 4] {
        let Self { level, left, right, bottom } = self;
        [("--level", level), ("--left", left), ("--right", right), ("--bottom", bottom)]
            .map(|(flag, value)| (flag, value.is_some()))
    }
}

/// What is printed of a coarse triangle.
#[derive(Serialize)]
struct Shape {
    #[serde(rename = "L")]
    level: u8,
    left: Vec<u8>,
    right: Vec<u8>,
    bottom: Vec<u8>,
    triangles: Vec<[u16; 3]>,
}

/// Answers the flags.
pub(super) fn one(args: &CoarseArgs, out: &mut impl Write) -> Result<()> {
    let wrong = |flag: &str, message: String| Error::Usage(format!("--{flag}: {message}"));
    let level = level(args.level.as_deref()).map_err(|message| wrong("level", message))?;
    let all = "1".repeat(level.into());
    let given = [&args.left, &args.right, &args.bottom];
    let mut masks = [0; 3];
    for ((mask, given), (_, name)) in masks.iter_mut().zip(given).zip(EDGES) {
        let bits = given.as_deref().unwrap_or(&all);
        *mask = edge(level, Some(bits), name).map_err(|message| wrong(name, message))?;
    }
    let [left, right, bottom] = masks;
    write(&Insertion::new(level, left, right, bottom), out).map_err(print::error)
}

/// Answers every line of the file at `path`, or of standard input for `-`.
pub(super) fn batch(path: &Path, out: &mut impl Write) -> Result<()> {
    lines::run(path, out, request, |insertion, out| write(insertion, out))
}

/// The request on a line: `esc L left right bottom`.
fn request(line: Line<'_>) -> Result<Insertion, lines::Fault> {
    let mut words = line.words();
    let first = words.next();
    if first != Some("esc") {
        return Err((line.column(first), format!("found {}, expected esc", found(first))));
    }
    let word = words.next();
    let level = level(word).map_err(|message| (line.column(word), message))?;
    let mut masks = [0; 3];
    for (mask, (_, name)) in masks.iter_mut().zip(EDGES) {
        let word = words.next();
        *mask = edge(level, word, name).map_err(|message| (line.column(word), message))?;
    }
    if let Some(word) = words.next() {
        let message = format!("found {word:?}, expected the line's end");
        return Err((line.column(Some(word)), message));
    }
    let [left, right, bottom] = masks;
    Ok(Insertion::new(level, left, right, bottom))
}

/// The level that a word says, or what is wrong with it.
fn level(word: Option<&str>) -> Result<u8, String> {
    let level = word.and_then(|word| word.parse().ok());
    level.filter(|level| (1..=LEVEL_MAX).contains(level)).ok_or_else(|| {
        format!("found {}, expected a level: an integer of 1 to {LEVEL_MAX}", short(word))
    })
}

/// The candidates that a word of bits says, or what is wrong with it.
fn edge(level: u8, word: Option<&str>, name: &str) -> Result<u16, String> {
    let bits = word.filter(|word| {
        word.len() == usize::from(level) && word.bytes().all(|bit| matches!(bit, b'0' | b'1'))
    });
    let mask = |bits: &str| {
        bits.bytes().zip(1..).map(|(bit, position)| u16::from(bit == b'1') << position).sum()
    };
    bits.map(mask).ok_or_else(|| {
        let found = short(word);
        format!("found {found}, expected a bit 0 or 1 for each position 1 to {level} of {name}")
    })
}

/// A word that may be long, as a message shows it.
fn short(word: Option<&str>) -> String {
    let word: Option<String> = word.map(|word| word.chars().take(200).collect());
    found(word.as_deref())
}

/// Writes the triangles of an insertion, and a newline.
fn write(insertion: &Insertion, out: &mut impl Write) -> io::Result<()> {
    let positions = 1..=insertion.level();
    let [left, right, bottom] = EDGES.map(|(edge, _)| {
        positions.clone().map(|position| (insertion.mask(edge) >> position & 1) as u8).collect()
    });
    let triangles = insertion.triangles().map(|triangle| triangle.map(Site::number)).collect();
    let shape = Shape { level: insertion.level(), left, right, bottom, triangles };
    serde_json::to_writer(&mut *out, &shape)?;
    out.write_all(b"\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn answer(text: &str, out: &mut Vec<u8>) -> Result<()> {
        let write = |insertion: &Insertion, out: &mut Vec<u8>| write(insertion, out);
        lines::answer(text.as_bytes(), Path::new("b.txt"), out, request, write)
    }

    #[test]
    fn lines_are_answered_in_order() {
        let mut out = Vec::new();
        answer("esc 1 0 1 0\r\n  esc  2\t11 10 11\n", &mut out).unwrap();
        let want = "{\"L\":1,\"left\":[0],\"right\":[1],\"bottom\":[0],\
                    \"triangles\":[[4,3,1],[4,6,3]]}\n\
                    {\"L\":2,\"left\":[1,1],\"right\":[1,0],\"bottom\":[1,1],\
                    \"triangles\":[[2,3,1],[4,5,2],[2,5,3],[5,10,3],[7,8,4],[4,8,5],[8,9,5],\
                    [5,9,10]]}\n";
        assert_eq!(String::from_utf8(out).unwrap(), want);
    }

    #[test]
    fn a_malformed_line_is_named_with_its_column() {
        let second = |text: &str| {
            let mut out = Vec::new();
            let error = answer(&format!("esc 1 0 0 0\n{text}"), &mut out).expect_err("refused");
            assert!(out.ends_with(b"[[4,6,1]]}\n"), "what was answered is answered");
            error.to_string()
        };
        assert!(second("\n").starts_with("b.txt:2:1: found nothing, expected esc"));
        assert!(second("quad 1 0 0 0").starts_with("b.txt:2:1: found \"quad\", expected esc"));
        for level in ["0", "16", "256", "-1", "1.5", "three"] {
            let message = second(&format!("esc {level} 0 0 0"));
            let start = format!("b.txt:2:5: found {level:?}, expected a level: an integer of 1");
            assert!(message.starts_with(&start), "{message}");
        }
        assert!(second("esc").starts_with("b.txt:2:4: found nothing, expected a level"));
        assert!(second("esc 2 1 00 00").starts_with("b.txt:2:7: found \"1\", expected a bit"));
        assert!(second("esc 2 11 012 00").ends_with("each position 1 to 2 of right"));
        assert!(second("esc 2 11 02 00").starts_with("b.txt:2:10: found \"02\""));
        assert!(second("esc 2 11 01").starts_with("b.txt:2:12: found nothing, expected a bit"));
        assert!(second("esc 1 1 1 1 1").starts_with("b.txt:2:13: found \"1\", expected the line"));
    }
}
