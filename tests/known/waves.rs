//! Waves of unit `esc` by hand: what each patch takes is found by drawing it alone, part by part of
//! the program; what the waves of many draws take follows from that, lane by lane.

use super::random::Random;
use super::run::{Keep, camera, draw, points};
use super::{Config, Unit, esc};
use glam::Vec3;
use rtl_model::counter::{Block, Counter as C};
use tessim::config::{LevelPolicy, LevelScope, SurfaceCosts};
use tessim::report::Report;
use tessim::trace::command::{Command, Primitive};
use tessim::unit::simulate;

/// Parts of the program: the net, the tests, the points, the slots.
const PARTS: usize = 4;

/// What a patch takes, in instructions of each part.
#[derive(Clone, Copy, Debug)]
struct Patch {
    sections: u64,
    /// Of its longest section.
    most: [u64; PARTS],
    sum: [u64; PARTS],
}

/// Instructions of each part.
fn cost(surface: &mut SurfaceCosts, cost: [u32; PARTS]) {
    (surface.net, surface.test, surface.point, surface.slot) = cost.into();
}

fn patch(random: &mut Random) -> Vec<[f32; 3]> {
    let reach = random.octaves(0.1, 3.0) as f32;
    // One in six is far beside the screen.
    let aside = if random.integer(0, 5) == 0 { 300.0 } else { 0.0 };
    let centre = [aside, 0.0, 0.0].map(|at| at + random.single(-1.0, 1.0));
    let point = |k: usize| {
        let lattice = [(k % 4) as f32 / 3.0 - 0.5, (k / 4) as f32 / 3.0 - 0.5, 0.0];
        [0, 1, 2].map(|i| centre[i] + reach * (lattice[i] + random.single(-0.3, 0.3)))
    };
    (0..16).map(point).collect()
}

/// Draws, each of so many of the patches, one after another from patch `first` on.
fn run(list: &[Vec<[f32; 3]>], first: usize, draws: &[usize], config: &Config) -> Report {
    let mut commands =
        vec![Command::Frame(camera(Vec3::new(3.0, 2.0, 1.5), 0.5, 12.0)), points(0, list.concat())];
    let mut next = first as u64;
    for &count in draws {
        let count = count as u64;
        commands.push(Command::Draw(draw(Primitive::Patches { count }, 0, 16 * next)));
        next += count;
    }
    let report = simulate(commands.into_iter().map(Ok), config, &mut Keep::default());
    report.expect("the commands are well-formed")
}

/// What patch `k` takes, if it is seen. A wave of one lane is as long as its patch's longest
/// section, once for each.
fn alone(list: &[Vec<[f32; 3]>], k: usize, config: &Config) -> Option<Patch> {
    let mut config = config.clone();
    config.esc.width = 1;
    config.block.surface.costs.interval = 1;
    let mut patch = Patch { sections: 0, most: [0; PARTS], sum: [0; PARTS] };
    for part in 0..PARTS {
        let mut only = [0; PARTS];
        only[part] = 1;
        cost(&mut config.block.surface, only);
        let totals = run(list, k, &[1], &config).totals();
        patch.sections = totals.get(C::SurfaceInvocations);
        if patch.sections == 0 {
            return None;
        }
        patch.most[part] = totals.get(C::SurfaceLaneCycles) / patch.sections;
        patch.sum[part] = totals.get(C::SurfaceUsedCycles);
    }
    Some(patch)
}

/// Waves, invocations, rounds, idle lanes; cycles of all lanes, those that are used, those that are
/// not; cycles of a processor.
type Totals = [u64; 8];

/// What the waves of draws of these patches take.
fn waves(draws: &[Vec<Patch>], width: u64, each: [u64; PARTS]) -> Totals {
    let mut waves: Vec<Vec<Patch>> = Vec::new();
    for draw in draws {
        waves.push(Vec::new()); // a wave is of one draw
        for &patch in draw {
            let wave = waves.last().expect("one was pushed");
            let lanes: u64 = wave.iter().map(|other| other.sections).sum();
            if !wave.is_empty() && lanes + patch.sections > width {
                waves.push(Vec::new());
            }
            waves.last_mut().expect("one was pushed").push(patch);
        }
    }
    let mut totals = [0; 8];
    for wave in waves.iter().filter(|wave| !wave.is_empty()) {
        let invocations: u64 = wave.iter().map(|patch| patch.sections).sum();
        let rounds = invocations.div_ceil(width);
        let longest = |part| wave.iter().map(|patch: &Patch| patch.most[part]).max().expect("some");
        let cycles = rounds * (0..PARTS).map(|part| each[part] * longest(part)).sum::<u64>();
        let busy = |patch: &Patch| (0..PARTS).map(|part| each[part] * patch.sum[part]).sum::<u64>();
        let used: u64 = wave.iter().map(busy).sum();
        let idle = rounds * width - invocations;
        let lanes = width * cycles;
        let of_wave = [1, invocations, rounds, idle, lanes, used, lanes - used, cycles];
        totals.iter_mut().zip(of_wave).for_each(|(sum, one)| *sum += one);
    }
    totals
}

/// What a run says of them.
fn said(report: &Report) -> Totals {
    let rows = report.rows(&report.whole());
    let used = rows.iter().find(|row| row.block == Block::Surface && row.name == "cycles.used");
    let [a, b, c, d, e, f, g] = [
        C::GroupWaves,
        C::GroupInvocations,
        C::GroupRounds,
        C::GroupIdle,
        C::SurfaceLaneCycles,
        C::SurfaceUsedCycles,
        C::SurfaceIdleCycles,
    ]
    .map(|counter| report.total(counter));
    [a, b, c, d, e, f, g, used.expect("it is timed").value]
}

#[test]
fn waves_take_what_their_patches_take_alone() {
    let mut random = Random::new(0x3a7e);
    let (mut compared, mut unseen, mut rounds) = (0, 0, 0);
    for _ in 0..super::run::scale(12, 200) {
        let mut config = Config { unit: Unit::Esc, ..Config::default() };
        esc::vary(&mut random, &mut config);
        config.esc.scope = LevelScope::Patch; // an object is all that its draw draws
        config.level.pixels = Some(random.octaves(0.1, 10.0));
        (config.esc.full_distance, config.esc.full_pixels) = (2.0, 300.0);
        config.esc.level_max = config.esc.level_max.min(7);
        config.esc.fixed_level = 0;
        if config.esc.level == LevelPolicy::Fixed {
            config.esc.level = LevelPolicy::Criterion;
        }
        let draws = [3, 1, 40, 0, 7, 25].map(|count| count + random.integer(1, 4) as usize);
        let list: Vec<_> = (0..draws.iter().sum()).map(|_| patch(&mut random)).collect();
        let mut next = 0..list.len();
        let taken = draws.map(|count| {
            let all: Vec<_> = (&mut next).take(count).map(|k| alone(&list, k, &config)).collect();
            unseen += all.iter().filter(|patch| patch.is_none()).count();
            all.into_iter().flatten().collect::<Vec<_>>()
        });
        for width in [1, 2, 5, 64, 1024] {
            let each = [(); PARTS].map(|()| random.integer(1, 90));
            config.esc.width = width;
            let interval = random.integer(1, 5);
            config.block.surface.costs.interval = interval;
            cost(&mut config.block.surface, each);
            let report = run(&list, 0, &draws, &config);
            let each = each.map(|cost| u64::from(cost * interval));
            let expected = waves(&taken, width.into(), each);
            assert_eq!(said(&report), expected, "width {width} under {config:?}");
            compared += expected[0];
            rounds += expected[2] - expected[0];
        }
    }
    println!(
        "compared {compared} waves; {rounds} rounds beside the first, {unseen} patches unseen"
    );
    assert!(compared > 2000 && rounds > 300 && unseen > 50);
}
