//! Windows of patches. What comes behind a patch cannot change what comes of it, so a trace that
//! ends with it says when the window does; and how many tokens come before it, where it begins.

use crate::runs::{self, set};
use crate::{UNITS, seen, watch, whole};
use std::ops::Range;
use tessim::config::Config;
use tessim::report::timeline::{Timeline, Wanted, Window};

fn window(text: &str, config: &Config, frame: u64, patches: Range<u32>) -> Timeline {
    watch(text, config, &Wanted { frame, window: Window::Patches(patches) }).1
}

/// The teapot's first patches only.
fn first(count: u32) -> String {
    let text = runs::shipped("teapot");
    let shorter = text.replace(r#""count":32}"#, &format!(r#""count":{count}}}"#));
    assert!(count == 32 || text != shorter);
    shorter
}

#[test]
fn it_ends_when_all_that_came_of_its_last_patch_has_left() {
    let mut compared = 0;
    // Where the host tessellates, a draw's indices follow all of its patches.
    for unit in UNITS.into_iter().filter(|unit| *unit != "triangles") {
        let text = runs::shipped("teapot");
        let config = set(&[&format!("unit={unit}"), "level.level=4"]);
        let elapsed = watch(&text, &config, &whole(0)).1.elapsed;
        for count in [1, 2, 7, 16, 31, 32] {
            let shorter = watch(&first(count), &config, &whole(0)).1;
            let part = window(&text, &config, 0, 0..count);
            if unit == "esc" && count < 32 {
                // A wave is shared with the patches that follow.
                assert!(part.window.end >= shorter.elapsed.min(elapsed), "{unit} {count}");
                continue;
            }
            // Where the host sends levels, a draw of fewer patches is sooner over the link.
            let begins = |text: &str| window(text, &config, 0, 0..1).window.start;
            let later = begins(&text) - begins(&first(count));
            let end = shorter.elapsed + 1 + later;
            assert_eq!(part.window.end, end.min(elapsed), "{unit} {count}");
            assert_eq!(part.elapsed, elapsed);
            compared += 1;
        }
    }
    assert!(compared > 20, "{compared}");
}

#[test]
fn it_begins_when_the_link_takes_its_first_patch() {
    let mut compared = 0;
    for unit in UNITS.into_iter().filter(|unit| *unit != "triangles") {
        let text = runs::shipped("teapot");
        let config = set(&[&format!("unit={unit}"), "level.level=2", "memory.fifo=4096"]);
        let all = watch(&text, &config, &whole(0)).1;
        let pushed = &all.tracks[1].queue.as_ref().unwrap().pushed;
        for patch in [0, 1, 8, 31] {
            // Nothing holds up the link; a patch's own token takes no time on it, but the command
            // before leaves in the cycle in which the first one comes.
            let tokens = pushed.len() as u32 - 32 + patch;
            let part = window(&text, &config, 0, patch..patch + 1);
            let Range { start, end } = part.window;
            assert_eq!(start + 1, pushed[tokens as usize], "{unit} {patch}");
            assert_eq!(seen(&part, &config), seen(&all, &config).cut(start, end));
            compared += 1;
        }
    }
    assert_eq!(compared, 20);
}

#[test]
fn windows_are_in_order_and_patches_that_pass_twice_are_seen_from_their_first_time() {
    for settings in [
        &["unit=sfarti", "level.union=primitive"][..],
        &["unit=triangles"],
        &["unit=hybrid", "memory.channels=shared", "vertex_shader.to_memory=true"],
    ] {
        let text = runs::shipped("mesh");
        for (frames, frame) in [("frames=drain", 1), ("frames=overlap", 1)] {
            let config = set(&[settings, &[frames, "level.level=4"]].concat());
            let all = seen(&watch(&text, &config, &whole(1)).1, &config);
            let mut last = 0..0;
            for patches in [0..4, 4..9, 9..10, 20..30, 40..48] {
                let part = window(&text, &config, frame, patches.clone());
                let Range { start, end } = part.window;
                assert!(start > last.start || patches.start == 0, "{patches:?} {settings:?}");
                assert!(end >= last.end && start < end, "{patches:?} {settings:?}");
                assert_eq!(seen(&part, &config), all.cut(start, end), "{patches:?}");
                last = start..end;
            }
            if settings.contains(&"level.union=primitive") {
                // All 48 patches are measured before the first is drawn.
                let alone = set(&["unit=sfarti", frames, "level.level=4"]);
                let [once, twice] = [&alone, &config]
                    .map(|config| window(&text, config, frame, 0..1).window)
                    .map(|cycles| cycles.end - cycles.start);
                assert!(twice > once + 48, "{twice} {once}");
            }
        }
    }
}
