//! Malformed text traces. A hand, `☞`, stands before the byte where the error must be; it is no
//! part of the input.

use super::lines::LINES;
use super::surfaces::{SURFACES, spelt};
use super::{Case, check, distinct};
use tessim::trace::read::Reader;

const HEAD: &str = r#"{"tessim":1}"#;
const ONE: &str = "[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]";

/// Traces from their first line on. `ONE` stands for an identity matrix.
const WHOLE: &[(&str, &str, &[&str])] = &[
    ("nothing", "☞", &["found nothing", "expected the header"]),
    ("blank first line", "☞\n", &["blank line", "expected a command"]),
    ("no header", r#"{☞"frame":{}}"#, &["found \"frame\"", "expected the header"]),
    ("not an object", "☞[1,2]", &["found [1,2]", "expected a command, which is an object"]),
    ("not JSON", "☞hello", &["found hello", "expected a command"]),
    ("a model in a foreign format", "☞32\n3 3\n", &["found 32", "expected a command"]),
    ("empty object", "☞{}", &["found {}", "expected an object with one command"]),
    ("future version", r#"{"tessim":☞2}"#, &["tessim: found 2", "expected 1, the only version"]),
    ("version as text", r#"{"tessim":☞"1"}"#, &["found \"1\"", "expected 1"]),
    ("fractional version", r#"{"tessim":☞1.5}"#, &["found 1.5", "expected 1"]),
    (
        "header without version",
        r#"☞{"title":"x"}"#,
        &["`tessim` is missing", "expected the version"],
    ),
    (
        "unknown header field",
        r#"{"tessim":1,☞"license":"MIT"}"#,
        &["license", "unknown field", "did you mean `licence`?", "`title`"],
    ),
    (
        "title of a wrong type",
        r#"{"tessim":1,"title":☞7}"#,
        &["title: found 7", "expected a string"],
    ),
    ("header only", r#"☞{"tessim":1}"#, &["truncated", "expected {\"end\":{}}"]),
    (
        "byte order mark",
        "☞\u{feff}{\"tessim\":1}\n",
        &["byte order mark", "expected UTF-8 without"],
    ),
    ("header cut short", r#"{"tessim":1☞"#, &["line ends inside an object"]),
    (
        "second header",
        "{\"tessim\":1}\n{☞\"tessim\":1}",
        &["found \"tessim\"", "first line and only there"],
    ),
    (
        "draw before any frame",
        "{\"tessim\":1}\n{\"draw\":☞{\"primitive\":\"patches\",\"points\":0,\"count\":1}}",
        &["draw: found a draw before any frame", "expected a frame"],
    ),
    ("no end", "{\"tessim\":1}\n☞{\"tessellation\":{}}\n", &["truncated", "last line"]),
    ("after the end", "{\"tessim\":1}\n{\"end\":{}}\n☞{\"end\":{}}", &["after the end", "nothing"]),
    ("blank after the end", "{\"tessim\":1}\n{\"end\":{}}\n☞\n", &["after the end"]),
    ("end with content", "{\"tessim\":1}\n{\"end\":{☞\"x\":1}}", &["end.x", "unknown field"]),
];

/// The input without the hand, and the line and column of the byte that it pointed at.
fn pointed(text: &str) -> (String, (u64, usize)) {
    let (before, after) = text.split_once('☞').expect("a case has a hand");
    assert!(!after.contains('☞'), "a case has one hand");
    let line = before.matches('\n').count() as u64 + 1;
    let column = before.rsplit('\n').next().unwrap_or_default().len() + 1;
    (format!("{before}{after}").replace("ONE", ONE), (line, column))
}

fn refuse(name: &str, text: &[u8], place: (u64, usize), wanted: &[&str]) {
    let error = Reader::new(text, "bad", ".").find_map(Result::err);
    check(&(name, text, place, wanted), error);
}

#[test]
fn whole_traces() {
    for (name, text, wanted) in WHOLE {
        let (text, place) = pointed(text);
        refuse(name, text.as_bytes(), place, wanted);
    }
}

#[test]
fn single_lines() {
    let points = ["[0,0.5,1]"; 16].join(",");
    let good = format!(
        "{HEAD}\n{{\"frame\":{{\"viewport\":[640,480],\"view\":{ONE},\"projection\":{ONE}}}}}\n\
         {{\"points\":{{\"id\":0,\"xyz\":[{points}]}}}}\n"
    );
    let whole = format!("{good}{{\"end\":{{}}}}\n");
    assert!(Reader::new(whole.as_bytes(), "good", ".").all(|c| c.is_ok()), "the frame is good");
    for (name, text, wanted) in LINES.iter().chain(SURFACES) {
        // Matrices that stand before the hand move it.
        let (line, (_, column)) = pointed(&spelt(text).replace("ONE", ONE));
        refuse(name, format!("{good}{line}\n").as_bytes(), (4, column), wanted);
    }
}

#[test]
fn bytes_that_are_no_text() {
    let cases: &[Case<'_>] = &[
        (
            "latin 1",
            b"{\"tessim\":1,\"title\":\"th\xe9\"}",
            (1, 24),
            &["byte 0xe9", "expected UTF-8"],
        ),
        ("binary", b"\x28\xb5\x2f\xfd", (1, 2), &["byte 0xb5", "UTF-8"]),
        ("nul", b"{\"tessim\":1}\n\0", (2, 1), &["expected a command"]),
        ("carriage return alone", b"{\"tessim\":1}\r{\"end\":{}}", (1, 14), &["after the command"]),
        (
            "control character",
            b"{\"tessim\":1,\"title\":\"a\x01\"}",
            (1, 23),
            &["control character"],
        ),
    ];
    distinct(cases);
    cases.iter().for_each(|(name, text, place, wanted)| refuse(name, text, *place, wanted));
}

#[test]
fn long_lines() {
    let long = format!("{HEAD}\n{{\"points\":{{\"id\":0,\"xyz\":[{}", "[0,0,0],".repeat(9 << 20));
    refuse("64 MiB", long.as_bytes(), (2, 1), &["more than 64 MiB", "a file of their own"]);
    let deep = format!("{HEAD}\n{{\"draw\":{}", "[".repeat(1 << 20));
    refuse("deep", deep.as_bytes(), (2, (1 << 20) + 9), &["line ends inside a list"]);
    let name = "ä".repeat(1000);
    let key = format!("{HEAD}\n{{\"{name}\":{{}}}}");
    refuse("long name", key.as_bytes(), (2, 2), &["unknown command", "…"]);
}

#[test]
fn names_of_cases_are_distinct() {
    let all = WHOLE.iter().chain(LINES).chain(SURFACES);
    let cases: Vec<Case<'_>> = all.map(|c| (c.0, c.1.as_bytes(), (1, 1), c.2)).collect();
    distinct(&cases);
    assert!(cases.len() >= 60, "{}", cases.len());
}
