//! The engines of time: they agree on every token of thousands of random pipelines, on closed forms
//! and on tables worked by hand; and mistakes planted in one of them are found at once.

mod pipeline;
mod tables;

use pipeline::{Outcome, Pipeline, ordered, stepped, timed};
use rtl_model::time::timed::{Exact, Rules};
use rtl_model::time::{Hold, StageTimes};

/// Pipelines of a campaign: `TESSIM_LONG=1` asks for the long one.
fn pipelines() -> u64 {
    if std::env::var_os("TESSIM_LONG").is_some_and(|v| v == "1") { 100_000 } else { 3_000 }
}

fn assert_conserved((times, log): &Outcome, pipeline: &Pipeline) {
    let elapsed: u64 = times.frames.iter().map(|frame| frame.elapsed).sum();
    let mut expected = pipeline.frames.iter().map(Vec::len).sum::<usize>() as u64;
    for (k, (_, shape)) in pipeline.chain.iter().enumerate() {
        let sum = |of: fn(&StageTimes) -> u64| -> u64 {
            times.frames.iter().map(|frame| of(&frame.stages[k])).sum()
        };
        assert_eq!(sum(|s| s.tokens_in), expected, "tokens into stage {k}");
        expected = sum(|s| s.tokens_out);
        assert_eq!(expected, log.emitted[k].len() as u64);
        let parts = sum(|s| s.busy + s.starved + s.starved_by_port)
            + sum(|s| s.blocked + s.blocked_by_order);
        assert_eq!(parts, sum(|s| s.total));
        assert_eq!(log.held_up(k, Hold::Room), sum(|s| s.blocked));
        assert_eq!(log.held_up(k, Hold::Order), sum(|s| s.blocked_by_order));
        assert!(sum(|s| s.used) <= sum(|s| s.busy + s.blocked + s.blocked_by_order));
        assert_eq!(parts, elapsed * u64::from(shape.lanes), "lane-cycles of stage {k}");
        if k > 0 {
            let occupancy = &times.occupancy[k];
            assert_eq!(occupancy.iter().sum::<u64>(), elapsed, "cycles of FIFO {k}");
            assert_eq!(occupancy.len() as u32, shape.depth + 1);
        }
    }
}

#[test]
fn the_engines_agree_on_every_token_and_every_counter() {
    let (mut tokens, mut cycles) = (0, 0);
    // The last one is the first of a long campaign in which tokens of two frames leave a lane in
    // the run's last cycle.
    for seed in (0..pipelines()).chain([14069]) {
        let pipeline = Pipeline::random(seed, false);
        let plain = stepped(&pipeline);
        assert_eq!(timed::<Exact>(&pipeline), plain, "timed, pipeline {seed}: {pipeline:?}");
        assert_eq!(ordered(&pipeline), plain, "ordered, pipeline {seed}: {pipeline:?}");
        assert_conserved(&plain, &pipeline);
        tokens += plain.1.tokens();
        cycles += plain.0.frames.iter().map(|frame| frame.elapsed).sum::<u64>();
    }
    println!("compared {} pipelines, {tokens} tokens, {cycles} cycles", pipelines());
}

#[test]
fn the_engines_agree_where_stages_share_a_port() {
    let (mut tokens, mut waited) = (0, 0);
    for seed in (0..pipelines()).chain([16301]) {
        let mut pipeline = Pipeline::random(seed ^ 0x9057, true);
        // The topology that evaluation order gets wrong: the first stage and the last share it.
        for k in [0, pipeline.chain.len() - 1] {
            pipeline.chain[k].1.shares_port = true;
        }
        let plain = stepped(&pipeline);
        assert_eq!(ordered(&pipeline), plain, "pipeline {seed}: {pipeline:?}");
        assert_conserved(&plain, &pipeline);
        tokens += plain.1.tokens();
        let stages = plain.0.frames.iter().flat_map(|frame| &frame.stages);
        waited += stages.map(|stage| stage.starved_by_port).sum::<u64>();
    }
    assert!(waited > 10 * pipelines(), "the port binds: {waited} cycles");
    println!("compared {} pipelines, {tokens} tokens, {waited} waits", pipelines());
}

/// How many pipelines it takes until `stepped` shows a mistake in `timed`.
fn caught_after<R: Rules>(ports: bool) -> Option<u64> {
    (0..200).find(|&seed| {
        let pipeline = Pipeline::random(seed, ports);
        timed::<R>(&pipeline) != stepped(&pipeline)
    })
}

#[test]
fn planted_mistakes_are_caught() {
    struct CreditAtOnce;
    impl Rules for CreditAtOnce {
        const CREDIT: u64 = 0;
    }
    struct AnyNumberInFlight;
    impl Rules for AnyNumberInFlight {
        const SLOTS: bool = false;
    }
    struct OtherLane;
    impl Rules for OtherLane {
        const LANES: bool = false;
    }
    struct PortByEvaluation;
    impl Rules for PortByEvaluation {
        const PORT_BY_EVALUATION: bool = true;
    }
    let after = [
        ("credit without its cycle", caught_after::<CreditAtOnce>(false)),
        ("no limit of tokens in flight", caught_after::<AnyNumberInFlight>(false)),
        ("the wrong lane", caught_after::<OtherLane>(false)),
        ("the port in the order of evaluation", caught_after::<PortByEvaluation>(true)),
    ];
    for (mistake, after) in after {
        println!("{mistake}: caught after {after:?} pipelines");
        assert!(after.is_some(), "{mistake} is not caught within 200 pipelines");
    }
    assert_eq!(caught_after::<Exact>(false), None);
}
