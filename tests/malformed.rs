//! Malformed traces and models: each must be refused at its place, in words that name what was
//! found and expected.

#[path = "malformed/binary.rs"]
mod binary;
#[path = "malformed/bpt.rs"]
mod bpt;
#[path = "malformed/files.rs"]
mod files;
#[path = "malformed/lines.rs"]
mod lines;
#[path = "malformed/surfaces.rs"]
mod surfaces;
#[path = "malformed/text.rs"]
mod text;

use std::collections::HashSet;
use tessim::error::Error;

/// One case: a name, the input, the line and column of its error, and what its message says.
pub(crate) type Case<'a> = (&'a str, &'a [u8], (u64, usize), &'a [&'a str]);

/// Checks the error of one case.
pub(crate) fn check(case: &Case<'_>, error: Option<Error>) {
    let (name, _, (line, column), wanted) = case;
    let Some(error) = error else { panic!("{name}: was accepted") };
    assert_eq!(error.exit_code(), 2, "{name}: {error}");
    let message = error.to_string();
    let place = format!("bad:{line}:{column}: ");
    assert!(message.starts_with(&place), "{name}: expected {place}, got {message}");
    assert!(!wanted.is_empty(), "{name}: a case says what its message must say");
    for words in *wanted {
        assert!(message.contains(words), "{name}: `{words}` is not in: {message}");
    }
    assert!(message.chars().count() < 1000, "{name}: {} characters", message.len());
    assert!(!message.contains("at line "), "{name}: the parser's own place shows: {message}");
}

/// Names of cases are distinct, so that a failure names one.
pub(crate) fn distinct(cases: &[Case<'_>]) {
    let names: HashSet<_> = cases.iter().map(|case| case.0).collect();
    assert_eq!(names.len(), cases.len());
}
