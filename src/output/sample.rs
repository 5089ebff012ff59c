//! A report of two timed frames, made up, for the tests of those who write reports.

use crate::config::Config;
use crate::report::{Frame, Report};
use rtl_model::counter::standard::{Ops, Stage, Work};
use rtl_model::counter::{Block, Counter, Counters};
use rtl_model::time::{FrameTimes, LaneOrder, Shape, StageTimes};

/// Two equal frames of 100 cycles: link, stitch, and a vertex shader of three lanes.
pub(crate) fn timed_report() -> Report {
    let stage = |block, lanes, shares_port| {
        let order = LaneOrder::FirstFree;
        Stage { block, shape: Shape { depth: 4, in_flight: 2, lanes, order, shares_port } }
    };
    let chain = vec![
        stage(Block::Link, 1, false),
        stage(Block::Stitch, 1, false),
        stage(Block::VertexShader, 3, true),
    ];
    let ops = Some(Ops::default().adds(4, 8).muls(2, 3, 5).compares(1, 8));
    let work = |tokens_in, tokens_out, ops| Work { tokens_in, tokens_out, ops };
    let works = vec![work(1, 1, None), work(1, 4, ops), work(4, 4, None)];
    // busy, starved, by port, blocked, by order
    let parts = [[10, 0, 0, 90, 0], [95, 4, 0, 1, 0], [120, 105, 15, 0, 60]];
    let used = [8, 94, 60];
    let peaks = [[0, 2, 1], [0, 1, 1]];
    let frame = |peaks: [u64; 3]| {
        let mut counters = Counters::default();
        counters.add(Counter::EmitTriangles, 4);
        let stages = (0..3).map(|k| {
            let [busy, starved, starved_by_port, blocked, blocked_by_order] = parts[k];
            StageTimes {
                busy,
                starved,
                starved_by_port,
                blocked,
                blocked_by_order,
                total: parts[k].iter().sum(),
                used: used[k],
                tokens_in: works[k].tokens_in,
                tokens_out: works[k].tokens_out,
                fifo_peak: peaks[k],
            }
        });
        let times = FrameTimes { elapsed: 100, stages: stages.collect() };
        Frame::new(&chain, counters, works.clone(), Some(times))
    };
    let frames = peaks.map(frame).to_vec();
    Report {
        config: Config::default(),
        blocks: &[Block::Link, Block::Stitch, Block::VertexShader],
        chain,
        frames,
        occupancy: vec![vec![], vec![50, 0, 150], vec![190, 10]],
        host_link_bytes: 0,
    }
}
