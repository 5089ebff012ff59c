//! `counters`: every number that a run reports, with its measure, meaning and conservation law.

use super::print;
use rtl_model::counter::standard::{self, ELAPSED, Quantity, Stage};
use rtl_model::counter::{Block, DECLARATIONS, Measure};
use std::fmt::Write;
use tessim::config::{Config, Unit};
use tessim::error::{Error, Result, nearest};
use tessim::output::page::Definition;
use tessim::unit::arithmetic::PIECES;
use tessim::unit::chain;

/// Explain the counters: measure, meaning, conservation law
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  tessim counters stitch\n  tessim counters evaluate.ops.mul")]
pub(crate) struct Args {
    /// A block (stitch), a counter (stitch.triangles), or a counter's own name (triangles)
    name: Option<String>,
}

/// What is to be said of a row.
struct Entry {
    block: Block,
    name: String,
    measure: Measure,
    meaning: &'static str,
    law: &'static str,
    /// Of arithmetic, the pieces that are counted.
    pieces: Vec<&'static str>,
}

pub(crate) fn run(args: &Args) -> Result<()> {
    let all = entries();
    let chosen: Vec<_> = match &args.name {
        None => all.iter().collect(),
        Some(name) => all.iter().filter(|entry| entry.matches(name)).collect(),
    };
    match (&args.name, chosen.is_empty()) {
        (Some(name), true) => Err(unknown(name, &all)),
        _ => print::print(&text(&chosen)),
    }
}

/// The same for a page.
pub(crate) fn definitions() -> Vec<Definition> {
    let definition = |entry: Entry| {
        let of = entry.pieces.iter().map(|piece| format!("; of {piece}"));
        Definition {
            name: entry.full_name(),
            measure: entry.measure.to_string(),
            meaning: entry.meaning.to_owned() + &of.collect::<String>(),
            law: entry.law.to_owned(),
        }
    };
    entries().into_iter().map(definition).collect()
}

/// Every row of every unit, in the order of reports.
fn entries() -> Vec<Entry> {
    let mut entries: Vec<_> = DECLARATIONS
        .iter()
        .map(|d| Entry {
            block: d.block,
            name: d.name.to_owned(),
            measure: d.measure,
            meaning: d.meaning,
            law: d.law,
            pieces: Vec::new(),
        })
        .collect();
    for unit in Unit::ALL {
        let mut chain = chain(&Config { unit, ..Config::default() });
        for stage in &mut chain {
            // Any block may have more than one lane.
            stage.shape.lanes = 2;
            stage.shape.shares_port = matches!(stage.block, Block::Memory | Block::VertexShader);
        }
        for k in 0..chain.len() {
            for entry in standard_entries(&chain, k) {
                // A row of both units is one; what differs is the neighbours.
                if !entries.iter().any(|e| (e.block, &e.name) == (entry.block, &entry.name)) {
                    entries.push(entry);
                }
            }
        }
    }
    entries.push(Entry {
        block: Block::Unit,
        name: ELAPSED.name.to_owned(),
        measure: ELAPSED.measure,
        meaning: ELAPSED.meaning,
        law: ELAPSED.law,
        pieces: Vec::new(),
    });
    entries.sort_by_key(|entry| entry.block); // keeps the order within a block
    entries
}

fn standard_entries(chain: &[Stage], k: usize) -> impl Iterator<Item = Entry> {
    let block = chain[k].block;
    let computes = PIECES.iter().any(|piece| piece.block == block);
    let rows = standard::rows(chain, k);
    rows.filter(move |(_, row)| computes || !row.quantity.is_arithmetic()).map(
        move |(name, row)| {
            let (measure, meaning, law) = (row.measure, row.meaning, row.law);
            Entry { block, name, measure, meaning, law, pieces: pieces(block, row.quantity) }
        },
    )
}

/// What of a block's arithmetic has operations of this kind.
fn pieces(block: Block, kind: Quantity) -> Vec<&'static str> {
    let config = Config::default();
    let has = |piece: &&tessim::unit::arithmetic::Piece| {
        let ops = piece.once(&config);
        let count = match kind {
            Quantity::Add => ops.add,
            Quantity::Mul => ops.mul,
            Quantity::Compare => ops.compare,
            _ => 0, // the bits are of the same pieces
        };
        piece.block == block && count > 0
    };
    PIECES.iter().filter(has).map(|piece| piece.meaning).collect()
}

impl Entry {
    fn full_name(&self) -> String {
        format!("{}.{}", self.block.name(), self.name)
    }

    /// A name stands for itself and for everything below it: `link.bytes` for `link.bytes.total`.
    fn matches(&self, name: &str) -> bool {
        let below = |known: &str| {
            known.strip_prefix(name).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
        };
        below(&self.full_name()) || below(&self.name)
    }
}

fn unknown(name: &str, entries: &[Entry]) -> Error {
    let blocks = entries.iter().map(|e| e.block.name().to_owned());
    let own = entries.iter().map(|e| e.name.clone());
    let known = blocks.chain(entries.iter().map(Entry::full_name)).chain(own);
    let nearest = nearest(name, known).unwrap_or_default();
    let name: String = name.chars().take(200).collect();
    Error::Usage(format!("unknown counter `{name}`; did you mean `{nearest}`?"))
}

fn text(entries: &[&Entry]) -> String {
    let width = entries.iter().map(|entry| entry.full_name().len()).max().unwrap_or(0);
    let mut text = String::new();
    for entry in entries {
        let (name, measure) = (entry.full_name(), entry.measure.to_string());
        let mut line = |line: String| writeln!(text, "{line}").expect("a String takes everything");
        line(format!("{name:width$}  {measure:7}  {}", entry.meaning));
        for piece in &entry.pieces {
            line(format!("{:width$}  {:7}  of {piece}", "", ""));
        }
        if !entry.law.is_empty() {
            line(format!("{:width$}  {:7}  law: {}", "", "", entry.law));
        }
    }
    text
}
