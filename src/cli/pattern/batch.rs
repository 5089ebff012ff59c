//! Many requests: lines in, lines out, in order and as they come, whatever the length of the file.

use super::super::print;
use super::request::{Fault, Request};
use super::shape;
use clap::ValueEnum;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::path::Path;
use tessim::error::{Error, Place, Result};

/// Six factors of any reasonable number of digits fit many times over.
const LINE_BYTES_MAX: u64 = 4096;

/// Answers every line of the file at `path`, or of standard input for `-`.
pub(super) fn run(path: &Path, out: &mut impl Write) -> Result<()> {
    if path == Path::new("-") {
        return answer(io::stdin().lock(), path, out);
    }
    let file = File::open(path).map_err(|error| Error::system(path, error))?;
    answer(BufReader::new(file), path, out)
}

fn answer(mut input: impl BufRead, path: &Path, out: &mut impl Write) -> Result<()> {
    let mut line = Vec::new();
    for number in 1.. {
        line.clear();
        let read = input.by_ref().take(LINE_BYTES_MAX + 1).read_until(b'\n', &mut line);
        if read.map_err(|error| Error::system(path, error))? == 0 {
            break;
        }
        let request = request(&line).map_err(|(column, message)| {
            // What was answered is answered: the error comes after it.
            let _ = out.flush();
            let place = Place::Line { line: number, column };
            Error::Input { file: path.display().to_string(), place, message }
        })?;
        shape::write(&request, out).map_err(print::error)?;
    }
    Ok(())
}

/// The request on a line, or the column (from 1) of what is wrong with it and why.
fn request(line: &[u8]) -> Result<Request, (usize, String)> {
    if line.len() as u64 > LINE_BYTES_MAX {
        let message = format!("found a line of more than {LINE_BYTES_MAX} bytes, expected less");
        return Err((1, message));
    }
    let line = std::str::from_utf8(line)
        .map_err(|error| (error.valid_up_to() + 1, "expected UTF-8".to_owned()))?;
    let line = line.trim_end();
    // A word's place is its distance from the line's start, both being in the same text.
    let column = |word: &str| word.as_ptr() as usize - line.as_ptr() as usize + 1;
    let end = line.len() + 1;
    let mut words = line.split_ascii_whitespace();
    let first = words.clone().next().map_or(end, column);
    let domain = choice(words.next(), "a domain", end, column)?;
    let partitioning = choice(words.next(), "a partitioning", end, column)?;
    let topology = choice(words.next(), "a topology", end, column)?;
    let columns: Vec<usize> = words.clone().map(column).collect();
    Request::new(domain, partitioning, topology, words).map_err(|Fault { factor, message }| {
        let column = factor.map_or(first, |number| columns.get(number).copied().unwrap_or(end));
        (column, message)
    })
}

fn choice<T: ValueEnum>(
    word: Option<&str>,
    what: &str,
    end: usize,
    column: impl Fn(&str) -> usize,
) -> Result<T, (usize, String)> {
    if let Some(value) = word.and_then(|word| T::from_str(word, false).ok()) {
        return Ok(value);
    }
    let names = T::value_variants().iter().filter_map(ValueEnum::to_possible_value);
    let names: Vec<String> = names.map(|value| value.get_name().to_owned()).collect();
    let found = word.map_or_else(|| "nothing".to_owned(), |word| format!("{word:?}"));
    let message = format!("found {found}, expected {what}: {}", names.join(", "));
    Err((word.map_or(end, column), message))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(text: &[u8]) -> String {
        answer(text, Path::new("b.txt"), &mut Vec::new()).expect_err("refused").to_string()
    }

    #[test]
    fn lines_are_answered_in_order() {
        let mut out = Vec::new();
        let input = "quad fractional ccw 1 1 1 1\r\n  quad  fractional\tpoint nan 1 1 1 2 2";
        answer(input.as_bytes(), Path::new("-"), &mut out).unwrap();
        let lines: Vec<serde_json::Value> = String::from_utf8(out)
            .unwrap()
            .lines()
            .map(|line| serde_json::from_str(line).unwrap())
            .collect();
        assert_eq!(lines.len(), 2);
        assert_eq!(lines[0]["topology"], "ccw");
        assert_eq!(lines[1]["factors"][0], "nan");
    }

    #[test]
    fn a_malformed_line_is_named_with_its_column() {
        let good = b"quad fractional ccw 1 1 1 1\n".to_vec();
        let second = |text: &str| message(&[&good, text.as_bytes()].concat());
        assert!(second("squad fractional ccw 1").starts_with("b.txt:2:1: found \"squad\""));
        assert!(second("quad fractional cww 1").starts_with("b.txt:2:17: found \"cww\""));
        assert!(second("quad fractional ccw 1 1 one 1").starts_with("b.txt:2:25: found \"one\""));
        assert!(second("quad fractional ccw 1 1").starts_with("b.txt:2:24: found 2 factors"));
        assert!(second("quad fractional ccw 1 2 3 4 5 6 7").contains("found 7 factors"));
        assert!(second("\n").starts_with("b.txt:2:1: found nothing"));
        assert!(second("tri odd ccw 1 2 3 4").contains("expected what unit hybrid takes"));
        assert!(message(b"quad \xff").starts_with("b.txt:1:6: expected UTF-8"));
        assert!(message(&[b' '; 5000]).contains("4096"));
    }
}
