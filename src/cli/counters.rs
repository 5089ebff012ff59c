//! `counters`: every number that a run reports, with its measure, meaning and conservation law.

use super::print;
use rtl_model::counter::{DECLARATIONS, Declaration};
use std::fmt::Write;
use tessim::error::{Error, Result};

/// Explain the counters: measure, meaning, conservation law
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  tessim counters stitch\n  tessim counters stitch.triangles")]
pub(crate) struct Args {
    /// A block (stitch), a counter (stitch.triangles), or a counter's own name (triangles)
    name: Option<String>,
}

pub(crate) fn run(args: &Args) -> Result<()> {
    let chosen: Vec<_> = match &args.name {
        None => DECLARATIONS.iter().collect(),
        Some(name) => DECLARATIONS.iter().filter(|d| matches(d, name)).collect(),
    };
    match (&args.name, chosen.is_empty()) {
        (Some(name), true) => Err(unknown(name)),
        _ => print::print(&text(&chosen)),
    }
}

fn full_name(declared: &Declaration) -> String {
    format!("{}.{}", declared.block.name(), declared.name)
}

/// A name stands for itself and for everything below it: `link.bytes` for `link.bytes.total`.
fn matches(declared: &Declaration, name: &str) -> bool {
    let below = |known: &str| {
        known.strip_prefix(name).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
    };
    below(&full_name(declared)) || below(declared.name)
}

fn unknown(name: &str) -> Error {
    let blocks = DECLARATIONS.iter().map(|d| d.block.name().to_owned());
    let own = DECLARATIONS.iter().map(|d| d.name.to_owned());
    let nearest = blocks
        .chain(DECLARATIONS.iter().map(full_name))
        .chain(own)
        .map(|known| (strsim::jaro_winkler(name, &known), known))
        .reduce(|best, next| if next.0 > best.0 { next } else { best })
        .map_or_else(String::new, |(_, known)| known);
    let name: String = name.chars().take(200).collect();
    Error::Usage(format!("unknown counter `{name}`; did you mean `{nearest}`?"))
}

fn text(declarations: &[&Declaration]) -> String {
    let width = declarations.iter().map(|d| full_name(d).len()).max().unwrap_or(0);
    let mut text = String::new();
    for declared in declarations {
        let measure = declared.measure.to_string();
        let (name, meaning) = (full_name(declared), declared.meaning);
        let mut line = |line: String| writeln!(text, "{line}").expect("a String takes everything");
        line(format!("{name:width$}  {measure:7}  {meaning}"));
        if !declared.law.is_empty() {
            line(format!("{:width$}  {:7}  law: {}", "", "", declared.law));
        }
    }
    text
}
