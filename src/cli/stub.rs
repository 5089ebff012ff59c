//! Stands in for the units until they are merged.
use rtl_model::counter::{Block, Counter, Counters};
use rtl_model::patch::Level;
use tessim::config::Config;
use tessim::error::Result;
use tessim::report::Report;
use tessim::sink::Sink;
use tessim::trace::command::Command;

pub(crate) fn simulate(
    commands: impl Iterator<Item = Result<Command>>,
    config: &Config,
    _sink: &mut dyn Sink,
) -> Result<Report> {
    let mut frames: Vec<Counters> = vec![];
    for command in commands {
        match command? {
            Command::Frame(_) => frames.push(Counters::default()),
            Command::Draw(d) => {
                if let Some(f) = frames.last_mut() {
                    f.add(Counter::TraceDraws, 1);
                    f.add(Counter::TracePatches, d.primitive.patches());
                }
            }
            _ => {}
        }
    }
    Ok(Report { config: config.clone(), blocks: &[Block::Trace, Block::Link], frames })
}

pub(crate) struct Pattern {
    pub points: Vec<[u32; 2]>,
    pub triangles: Vec<[u16; 3]>,
}

pub(crate) fn fractional_quad(_e: [Level; 4], _i: [Option<Level>; 2]) -> Pattern {
    let o = 65536;
    Pattern { points: vec![[0, 0], [o, 0], [o, o], [0, o]], triangles: vec![[0, 1, 2], [2, 3, 0]] }
}
