//! The five animated scenes are what they say, and unit and golden models agree on every frame of
//! them.

#[allow(dead_code, reason = "other tests use the rest")]
#[path = "support/run.rs"]
mod run;

use rtl_model::backface::{Method, Verdict, accept};
use rtl_model::level;
use rtl_model::patch::Level;
use run::Keep;
use tessim::config::{Config, Engine};
use tessim::golden::clip;
use tessim::study::motion::{self, Film};
use tessim::study::walk::{Drawn, Walk};
use tessim::trace::command::{Command, Draw, Tessellation};
use tessim::trace::read::Reader;
use tessim::trace::scene::motion::{Kind, Motion};
use tessim::unit::simulate;

fn scene(kind: Kind) -> Motion {
    Motion { kind, frames: Motion::FRAMES, tessellation: Tessellation::default() }
}

fn film(kind: Kind) -> Film {
    let film = motion::scene(scene(kind), &Config::default()).expect("a scene");
    assert_eq!(film.frames.len(), Motion::FRAMES as usize);
    film
}

/// Patches of a scene, frame by frame.
fn patches(kind: Kind) -> Vec<Vec<Drawn>> {
    let mut text = Vec::new();
    scene(kind).write(&mut text).expect("memory takes all");
    let config = Config::default();
    let (mut walk, mut frames) = (Walk::new(&config), Vec::<Vec<Drawn>>::new());
    for located in Reader::new(&text[..], "scene.jsonl", ".") {
        let command = located.expect("a whole trace").command;
        if let Command::Frame(_) = command {
            frames.push(Vec::new());
        }
        let mut show = |_: &Draw, drawn| frames.last_mut().expect("a frame before").push(drawn);
        walk.command(&command, &mut show).expect("inline points");
    }
    frames
}

/// On every frame of all five: no disagreement, and nothing that is in sight is removed.
#[test]
fn unit_and_golden_models_agree_on_every_frame_and_nothing_in_sight_is_removed() {
    let films = Kind::ALL.map(film);
    motion::check(&films).expect("they agree");
    println!("{}", motion::text(&films));
    for film in &films {
        let all = film.totals();
        let Film { name, .. } = film;
        assert!(all.patches >= 24 * 32, "{name}");
        assert_eq!((all.false_quantised, all.false_exact), (0, 0), "{name}");
        assert_eq!(all.clipped, all.clipped_exact, "{name}: rounding moves nothing across");
        assert!(all.culled > 0 && all.culled <= all.away && all.tessellated > 0, "{name}");
        assert!(all.clipped > 0 || *name == "turning", "{name}");
    }
}

#[test]
fn crossing_is_clipped_by_each_plane_alone_and_whole_in_view_in_each_pass() {
    let frames = patches(Kind::Crossing);
    let mut alone = [0; 6];
    let mut whole = Vec::new();
    for (number, frame) in frames.iter().enumerate() {
        let depth = frame[0].frame.view.depth;
        for drawn in frame {
            let distances = drawn.exact.map(|p| clip::inward(p, depth));
            let all_outside = |plane: usize| distances.iter().all(|d| d[plane] < 0.0);
            let planes: Vec<_> = (0..6).filter(|&plane| all_outside(plane)).collect();
            if let [plane] = planes[..] {
                alone[plane] += 1;
            }
        }
        if frame.iter().flat_map(|drawn| &drawn.exact).all(|&p| clip::inside(p, depth)) {
            whole.push(number);
        }
    }
    println!("patches outside one plane alone: {alone:?}; whole in frames {whole:?}");
    assert!(alone.iter().all(|&n| n >= 16), "{alone:?}");
    let passes = [0..8, 8..16, 16..24];
    for pass in passes {
        assert!(whole.iter().any(|n| pass.contains(n)), "{whole:?}");
        let clipped = |n: usize| clipped_of(&frames[n]);
        assert_eq!([clipped(pass.start), clipped(pass.end - 1)], [32, 32], "in and out again");
    }
}

fn clipped_of(frame: &[Drawn]) -> usize {
    frame.iter().filter(|d| clip::outside(&d.patch.points, d.frame.view.depth)).count()
}

/// Of the teapot's patches those of the rim (0 to 3), the handle (12 to 15) and the spout (16 to
/// 19) bend round by half a turn and show some front from everywhere.
#[test]
fn turning_takes_every_patch_from_front_to_back_but_those_that_bend_round() {
    let mut culled = [0; 32];
    for drawn in patches(Kind::Turning).iter().flatten() {
        let (verdict, _) = accept(&drawn.patch, &drawn.frame.view, Method::TangentPlane);
        culled[drawn.patch.id as usize] += u32::from(verdict == Verdict::Culled);
    }
    println!("frames of 24 in which each patch is culled: {culled:?}");
    for (patch, frames) in culled.into_iter().enumerate() {
        let bends = matches!(patch, 0..4 | 12..20);
        assert_eq!(frames == 0, bends, "patch {patch}");
        assert!(frames < 24, "patch {patch}");
    }
    let film = film(Kind::Turning);
    assert!(film.frames.iter().all(|frame| frame.clipped == 0), "it is seen whole");
}

/// The outer half of the tube lies on the torus's convex hull: whoever is within that sees its
/// inside alone. Of the draw as authored these are patches 0 to 3 and 12 to 15; the other draw has
/// them from 16 on.
#[test]
fn inside_a_closed_surface_its_wall_is_kept_where_it_is_reversed_and_else_removed() {
    let (mut wall, mut removed, mut either) = ([0; 8], 0, [0; 2]);
    for drawn in patches(Kind::Inside).iter().flatten() {
        let Drawn { patch, frame, .. } = drawn;
        if clip::outside(&patch.points, frame.view.depth) {
            continue;
        }
        let (verdict, _) = accept(patch, &frame.view, Method::TangentPlane);
        let own = patch.id % 16;
        if (4..12).contains(&own) {
            either[usize::from(verdict == Verdict::Culled)] += 1;
        } else if patch.reversed {
            assert_eq!(verdict, Verdict::Kept, "{}", patch.id);
            wall[own as usize % 8] += 1;
        } else {
            assert_eq!(verdict, Verdict::Culled, "{}", patch.id);
            removed += 1;
        }
    }
    println!("frames in which each of the wall is kept: {wall:?}; removed {removed}; {either:?}");
    assert!(wall.iter().all(|&n| n > 0) && wall.iter().any(|&n| n < 24), "{wall:?}");
    assert_eq!(removed, wall.iter().sum::<i32>(), "the same places, drawn twice");
    for frame in film(Kind::Inside).frames {
        assert!(frame.clipped > 0 && frame.culled > 0 && frame.tessellated > 0, "{frame:?}");
    }
}

#[test]
fn zoom_goes_from_level_1_everywhere_to_the_greatest() {
    let mut text = Vec::new();
    scene(Kind::Zoom).write(&mut text).expect("memory takes all");
    let commands = Reader::new(&text[..], "zoom.jsonl", ".").map(|l| Ok(l?.command));
    let config = Config { engine: Engine::None, ..Config::default() };
    let mut keep = Keep::default();
    simulate(commands, &config, &mut keep).expect("a scene");
    let most = |frame: u64| {
        let own = keep.meshes.iter().filter(|mesh| mesh.frame == frame);
        own.map(|mesh| mesh.triangles.len()).max().expect("some of it is always seen")
    };
    let most: Vec<_> = (0..24).map(most).collect();
    println!("most triangles of a patch, frame by frame: {most:?}");
    assert_eq!(most[0], 2, "one segment along every edge");
    assert!(most[23] > 2 * 63 * 63, "nearly all of some patch is as fine as it may be");
    assert!(most.is_sorted(), "{most:?}");
    let frames = patches(Kind::Zoom);
    let levels = |n: usize| {
        let of = |d: &Drawn| level::accept(&d.patch, &d.frame.view, &d.state).0;
        let all = frames[n].iter().map(of).flat_map(|l| l.edges.into_iter().chain(l.interior));
        all.collect::<Vec<_>>()
    };
    assert_eq!(levels(0).iter().max(), Some(&Level::MIN));
    let greatest = levels(23).iter().filter(|l| l.fx16() == 64 << 16).count();
    println!("of {} levels {greatest} are the greatest in the last frame", levels(23).len());
    assert!(greatest > 6, "those of more than a patch");
    let sizes = [0, 23].map(|n: usize| height(&frames[n]));
    println!("pixels high: {sizes:?}");
    assert!((0.4..1.0).contains(&sizes[0]) && sizes[1] > 1024.0, "{sizes:?}");
}

/// How many pixels high what is before the near plane is.
fn height(frame: &[Drawn]) -> f64 {
    let points = frame.iter().flat_map(|drawn| drawn.exact).filter(|[_, _, z, _]| *z > 0.0);
    let y: Vec<f64> = points.map(|[_, y, _, w]| 512.0 * y / w).collect();
    let of = |pick: fn(f64, f64) -> f64, start| y.iter().copied().fold(start, pick);
    of(f64::max, f64::MIN) - of(f64::min, f64::MAX)
}
