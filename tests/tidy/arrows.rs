//! The arrows of dependency: which part may import which. The table is the one of the design.
//!
//! Test code may look anywhere: what counts is what the parts are made of.

use crate::lexer::{self, Token, begins};

/// A part of `src`, and the parts that it may import besides itself and the leaves. Link sees
/// traces: what crosses it is their commands. A study draws scenes of its own and takes their
/// points through the shader.
const PARTS: [(&str, &[&str]); 9] = [
    ("trace", &[]),
    ("shader", &[]),
    ("link", &["trace"]),
    ("output", &[]),
    ("golden", &["trace"]),
    ("gpu", &["trace"]),
    ("unit", &["trace", "shader", "link"]),
    ("study", &["trace", "shader", "unit", "golden", "gpu", "output"]),
    ("cli", &["trace", "shader", "link", "output", "golden", "gpu", "unit", "study"]),
];

/// What every part may import, and what imports only its like.
const LEAVES: [&str; 5] = ["attribute", "config", "error", "sink", "report"];

/// Parts that may not see all of `rtl_model`, and what they may see.
const OF_HARDWARE: [(&str, &[&str]); 2] = [("golden", &["patch"]), ("gpu", &["number", "patch"])];

/// The engines of time, and what each may not name. Two engines that agree are believable as far as
/// they share nothing but the declarations in `time.rs`; the books of `account` are shared by those
/// that compute times, so the one that counts cycles keeps its own.
const APART: [(&str, &[&str]); 3] = [
    ("timed", &["stepped", "Stepped", "ordered", "Ordered"]),
    ("ordered", &["stepped", "Stepped", "timed", "Timed"]),
    ("stepped", &["timed", "Timed", "ordered", "Ordered", "account"]),
];

/// The modules that `lib.rs` of `rtl_model` lists, in its order: the order of the data.
pub(crate) fn module_order(lib: &str) -> Vec<String> {
    let tokens = lexer::tokens(lib);
    let modules = tokens.windows(2).filter(|pair| pair[0].text == "mod");
    modules.map(|pair| pair[1].text.to_owned()).collect()
}

/// Whether a part, the first, may import another.
type Allowed<'a> = Box<dyn Fn(&str, &str) -> bool + 'a>;

/// How many imports the file at `path` has, and which of them go against the arrows.
pub(crate) fn problems(path: &str, text: &str, order: &[String]) -> (usize, Vec<String>) {
    let tokens = lexer::without_tests(&lexer::tokens(text));
    let (folder, allowed): (_, Allowed<'_>) =
        if let Some(inside) = path.strip_prefix("rtl_model/src/") {
            (inside, Box::new(|from, to| hardware_may(order, from, to)))
        } else if let Some(inside) = path.strip_prefix("src/") {
            (inside, Box::new(may))
        } else {
            return (0, Vec::new());
        };
    let part = folder.split('/').next().unwrap_or(folder).trim_end_matches(".rs");
    if part == "lib" || part == "main" {
        return (0, Vec::new());
    }
    let mut imports = paths(&tokens, "crate");
    imports.extend(paths(&tokens, "tessim"));
    imports.extend(parents(&tokens, folder));
    let mut problems = Vec::new();
    for (to, line) in &imports {
        if !allowed(part, to) {
            problems.push(format!("{path}:{line}: {part} may not import {to}"));
        }
    }
    if let Some((_, seen)) = OF_HARDWARE.iter().find(|(name, _)| *name == part) {
        for (to, line) in paths(&tokens, "rtl_model") {
            if !seen.contains(&to) {
                problems.push(format!("{path}:{line}: {part} may not import rtl_model::{to}"));
            }
        }
    }
    (imports.len(), problems)
}

/// The engine whose file is at `path`, and where it names another.
pub(crate) fn engine(path: &str, text: &str) -> Option<(&'static str, Vec<String>)> {
    let inside = path.strip_prefix("rtl_model/src/time/")?;
    let stem = inside.split('/').next()?.trim_end_matches(".rs");
    let (engine, others) = APART.into_iter().find(|(name, _)| *name == stem)?;
    // The name is enough, however it was imported: a comment is no token.
    let tokens = lexer::without_tests(&lexer::tokens(text));
    let named = tokens.iter().filter(|token| others.contains(&token.text));
    let problem =
        |token: &Token<'_>| format!("{path}:{}: {engine} may not know {}", token.line, token.text);
    Some((engine, named.map(problem).collect()))
}

/// A part imports itself, the leaves, and what its row says. What the crate's root re-exports is a
/// name of no part: types in capitals and functions, which `cli` alone takes from there.
fn may(from: &str, to: &str) -> bool {
    let part = PARTS.iter().find(|(name, _)| *name == from);
    let known = LEAVES.contains(&to) || PARTS.iter().any(|(name, _)| *name == to);
    match part {
        _ if from == to || LEAVES.contains(&to) => part.is_some() || LEAVES.contains(&from),
        Some((name, row)) => row.contains(&to) || (*name == "cli" && !known),
        None => false,
    }
}

/// Inside `rtl_model` a file imports its own module and those listed above it.
fn hardware_may(order: &[String], from: &str, to: &str) -> bool {
    let place = |name: &str| order.iter().position(|module| module == name);
    match (place(from), place(to)) {
        (Some(from), Some(to)) => to <= from,
        _ => false,
    }
}

/// The modules that follow `root::`, in paths and in lists `root::{a::b, c}`, with their lines.
pub(crate) fn paths<'a>(tokens: &[Token<'a>], root: &str) -> Vec<(&'a str, usize)> {
    let mut found = Vec::new();
    for at in 0..tokens.len() {
        if begins(&tokens[at..], &[root, ":", ":"]) {
            heads(&tokens[at + 3..], &mut found);
        }
    }
    found
}

/// The first word of a path, or of each path of a list.
fn heads<'a>(tokens: &[Token<'a>], found: &mut Vec<(&'a str, usize)>) {
    let Some(first) = tokens.first() else { return };
    if first.text != "{" {
        return found.push((first.text, first.line));
    }
    let mut depth = 0;
    for pair in tokens.windows(2) {
        match pair[0].text {
            "{" => depth += 1,
            "}" => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            break;
        }
        if depth == 1 && matches!(pair[0].text, "{" | ",") && pair[1].text != "}" {
            found.push((pair[1].text, pair[1].line));
        }
    }
}

/// The modules that `super::` paths lead to from the file at `inside` (its path from the crate's
/// root), as far as they lead to the root; others stay in the part.
fn parents<'a>(tokens: &[Token<'a>], inside: &str) -> Vec<(&'a str, usize)> {
    let depth = inside.matches('/').count() + usize::from(!inside.ends_with("/mod.rs"));
    let mut found = Vec::new();
    let mut at = 0;
    while at < tokens.len() {
        let mut ups = 0;
        while begins(&tokens[at..], &["super", ":", ":"]) {
            ups += 1;
            at += 3;
        }
        if ups == depth && ups > 0 {
            heads(&tokens[at..], &mut found);
        }
        at += usize::from(ups == 0);
    }
    found
}
