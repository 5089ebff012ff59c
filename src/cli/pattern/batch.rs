//! Lines of factors: the words of a line in, a request out, or what is wrong with it and where.

use super::lines::{self, Line, found};
use super::request::{Fault, Request, Unit};
use super::shape::Writer;
use clap::ValueEnum;
use std::io::Write;
use std::path::Path;
use tessim::error::Result;

/// Answers every line of the file at `path`, or of standard input for `-`.
pub(super) fn run(unit: Unit, path: &Path, out: &mut impl Write) -> Result<()> {
    let mut writer = Writer::default();
    lines::run(path, out, |line| request(unit, line), |request, out| writer.write(request, out))
}

/// The request on a line.
fn request(unit: Unit, line: Line<'_>) -> Result<Request, lines::Fault> {
    let columns: Vec<usize> = line.words().map(|word| line.column(Some(word))).collect();
    let mut words = line.words();
    let domain = choice(words.next(), "a domain", line)?;
    let partitioning = choice(words.next(), "a partitioning", line)?;
    let topology = choice(words.next(), "a topology", line)?;
    let shape = (domain, partitioning, topology);
    Request::new(unit, shape, words).map_err(|Fault { word, message }| {
        (columns.get(word).copied().unwrap_or_else(|| line.column(None)), message)
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

    fn answer(unit: Unit, input: &[u8], path: &Path, out: &mut Vec<u8>) -> Result<()> {
        let mut writer = Writer::default();
        let write = |request: &Request, out: &mut Vec<u8>| writer.write(request, out);
        lines::answer(input, path, out, |line| request(unit, line), write)
    }

    fn message(text: &[u8]) -> String {
        answer(Unit::Hybrid, text, Path::new("b.txt"), &mut Vec::new())
            .expect_err("refused")
            .to_string()
    }

    #[test]
    fn lines_are_answered_in_order() {
        let mut out = Vec::new();
        let input = "quad fractional ccw 1 1 1 1\r\n  quad  fractional\tpoint nan 1 1 1 2 2";
        answer(Unit::Hybrid, input.as_bytes(), Path::new("-"), &mut out).unwrap();
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

    #[test]
    fn a_tessellators_lines_are_held_against_their_domains() {
        let message = |text: &str| {
            let text = format!("tri odd cw 1 1 1 1\n{text}");
            let mut out = Vec::new();
            let error = answer(Unit::D3d11, text.as_bytes(), Path::new("b.txt"), &mut out);
            assert!(out.starts_with(b"{\"domain\":\"tri\"") && out.ends_with(b"[0,1,2]}\n"));
            error.expect_err("refused").to_string()
        };
        assert!(message("tri odd cw 1 1 1").starts_with("b.txt:2:17: found 3 factors, expected 4"));
        assert!(message("quad odd cw 1 2 3 4").contains("expected 6: Ueq0 Veq0 Ueq1 Veq1 InU InV"));
        assert!(message("isoline odd line 1 2 3").starts_with("b.txt:2:22: found 3 factors"));
        assert!(message("isoline odd ccw 1 2").starts_with("b.txt:2:13: found topology ccw"));
        assert!(message("quad fractional cw 1 1 1 1 1 1").starts_with("b.txt:2:6: found part"));
        assert!(message("quad odd cw 1 1 1 1 1 1,0").starts_with("b.txt:2:23: found \"1,0\""));
        assert!(message("quad odd").starts_with("b.txt:2:9: found nothing, expected a topology"));
    }
}
