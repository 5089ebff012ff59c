//! Lines of factors: the words of a line in, a request out, or what is wrong with it and where.

use super::lines::{self, Line, found};
use super::request::{Fault, Request};
use super::shape;
use clap::ValueEnum;
use std::io::Write;
use std::path::Path;
use tessim::error::Result;

/// Answers every line of the file at `path`, or of standard input for `-`.
pub(super) fn run(path: &Path, out: &mut impl Write) -> Result<()> {
    lines::run(path, out, request, |request, out| shape::write(request, out))
}

/// The request on a line.
fn request(line: Line<'_>) -> Result<Request, lines::Fault> {
    let mut words = line.words();
    let first = line.column(line.words().next());
    let domain = choice(words.next(), "a domain", line)?;
    let partitioning = choice(words.next(), "a partitioning", line)?;
    let topology = choice(words.next(), "a topology", line)?;
    let factors = words.clone();
    Request::new(domain, partitioning, topology, words).map_err(|Fault { factor, message }| {
        let column = factor.map_or(first, |number| line.column(factors.clone().nth(number)));
        (column, message)
    })
}

fn choice<T: ValueEnum>(word: Option<&str>, what: &str, line: Line<'_>) -> Result<T, lines::Fault> {
    if let Some(value) = word.and_then(|word| T::from_str(word, false).ok()) {
        return Ok(value);
    }
    let names = T::value_variants().iter().filter_map(ValueEnum::to_possible_value);
    let names: Vec<String> = names.map(|value| value.get_name().to_owned()).collect();
    let message = format!("found {}, expected {what}: {}", found(word), names.join(", "));
    Err((line.column(word), message))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn answer(input: &[u8], path: &Path, out: &mut Vec<u8>) -> Result<()> {
        lines::answer(input, path, out, request, |request, out| shape::write(request, out))
    }

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
