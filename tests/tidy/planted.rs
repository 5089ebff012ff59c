//! Violations planted for every rule: a rule that lets its own through is no rule.

use crate::{arrows, lexer, rules};

const HEAD: &str = "//! Head.\n";

/// The problems of `code` at `path`, which must be one and say `what`.
fn caught(path: &str, code: &str, what: &str) {
    let problems = rules::problems(path, &format!("{HEAD}{code}"));
    assert_eq!(problems.len(), 1, "{code}: {problems:?}");
    assert!(problems[0].contains(what), "{problems:?}");
}

fn passes(path: &str, code: &str) {
    assert_eq!(rules::problems(path, &format!("{HEAD}{code}")), Vec::<String>::new(), "{code}");
}

#[test]
fn shape_is_checked() {
    caught("src/a.rs", &"\n".repeat(500), "501 lines");
    passes("src/a.rs", &"\n".repeat(499));
    caught("src/a.rs", &format!("// {}", "x".repeat(98)), "src/a.rs:2: 101 columns");
    passes("src/a.rs", &format!("// {}", "é".repeat(97)));
    assert!(rules::problems("src/a.rs", "fn f() {}")[0].contains("`//!`"));
}

#[test]
fn forbidden_words_are_found_in_code_and_nowhere_else() {
    caught("src/a.rs", "fn f() { todo!() }", "src/a.rs:2: todo!");
    caught("src/a.rs", "fn f() { unimplemented !() }", "unimplemented!");
    caught("src/a.rs", "\n\nfn f() { dbg!(3) }", "src/a.rs:4: dbg!");
    caught("tests/a.rs", "#[test] #[ignore = \"slow\"] fn f() {}", "#[ignore");
    caught("rtl_model/src/a.rs", "fn f() { unsafe { g() } }", "unsafe");
    caught("rtl_model/tests/lockstep/main.rs", "fn f() { unsafe { g() } }", "unsafe");
    passes("rtl_model/tests/lockstep/verilated.rs", "fn f() { unsafe { g() } }");
    caught("tests/driver/main.rs", "fn f() { unsafe { g() } }", "unsafe");
    passes("tests/driver/gl.rs", "fn f() { unsafe { g() } }");
    caught("rtl_model/tests/lockstep/verilated.rs", "fn f() { todo!() }", "todo!");
    passes("src/a.rs", "// todo!()\n/* dbg!() /* unsafe */ unsafe */ fn f() {}");
    passes("src/a.rs", "const A: &str = \"todo!() \\\" unsafe\"; const B: char = '\"';");
    passes("src/a.rs", "const A: &str = r#\"a \" unsafe\"#; fn f<'a>(x: &'a str) {}");
    caught("src/a.rs", "const A: char = '\\''; fn f<'a>() { dbg!('a') }", "dbg!");
}

#[test]
fn the_hardware_has_no_floats_and_no_system() {
    let at = "rtl_model/src/clip.rs";
    caught(at, "fn f(x: f32) {}", "f32");
    caught(at, "const A: u32 = 1.5 as u32;", "1.5");
    caught(at, "const A: u32 = 1f64 as u32;", "1f64");
    caught(at, "use std::fs::File;", "std::fs");
    caught(at, "use std::{fmt, thread};", "std::thread");
    caught(at, "fn f() { std::process::exit(1) }", "std::process");
    passes(at, "const A: u32 = 0x1f32; fn f(x: (u8, (u8, u8))) -> u8 { x.1.0 }");
    passes(at, "use std::fmt; #[cfg(test)] mod tests { fn f(x: f64) { std::fs::read(\"\"); } }");
    passes("src/a.rs", "use std::fs; const X: f64 = 1.5;");
    // The item ends where its braces do.
    caught(at, "#[cfg(test)] mod t { fn f() {} } fn g(x: f64) {}", "f64");
    caught(at, "#[cfg(test)] mod t; fn g(x: f64) {}", "f64");
}

#[test]
fn the_table_of_counters_may_be_wide_and_nothing_else_in_its_file() {
    let wide = "x".repeat(120);
    let text = format!(
        "{HEAD}macro_rules! counters {{\n// {wide}\n/// How many counters there are.\n// {wide}\n"
    );
    assert_eq!(rules::problems("rtl_model/src/counter.rs", &text).len(), 1);
    assert_eq!(rules::problems("rtl_model/src/clip.rs", &text).len(), 2);
}

fn crossed(path: &str, code: &str) -> usize {
    let order = ["number", "patch", "clip", "level"].map(str::to_owned);
    arrows::problems(path, code, &order).1.len()
}

#[test]
fn imports_against_the_arrows_are_found_however_they_are_written() {
    assert_eq!(
        crossed("rtl_model/src/level.rs", "use crate::clip; use crate::{number, patch};"),
        0
    );
    assert_eq!(crossed("rtl_model/src/clip.rs", "use crate::level::Level;"), 1);
    assert_eq!(crossed("rtl_model/src/clip.rs", "use crate::{patch::{A, B}, level::Level};"), 1);
    assert_eq!(crossed("rtl_model/src/clip.rs", "fn f(x: crate::level::Level) {}"), 1);
    assert_eq!(crossed("rtl_model/src/clip.rs", "use super::level::Level;"), 1);
    assert_eq!(crossed("rtl_model/src/number/a.rs", "use super::b; use super::super::clip;"), 1);
    assert_eq!(crossed("rtl_model/src/number/mod.rs", "use super::clip;"), 1);
    assert_eq!(crossed("rtl_model/src/level.rs", "use crate::unheard_of;"), 1);
}

#[test]
fn the_parts_of_the_simulator_keep_their_places() {
    assert_eq!(crossed("src/unit/a.rs", "use crate::{trace, shader, link, config, sink};"), 0);
    assert_eq!(crossed("src/unit/a.rs", "use crate::golden::x; use crate::output::y;"), 2);
    assert_eq!(crossed("src/trace/a.rs", "use crate::unit::x; use super::super::link;"), 2);
    assert_eq!(crossed("src/trace/mod.rs", "use super::link;"), 1);
    assert_eq!(crossed("src/config.rs", "use crate::error::E; use crate::trace::T;"), 1);
    assert_eq!(crossed("src/config/a.rs", "use super::b; use super::super::trace;"), 1);
    assert_eq!(crossed("src/cli/a.rs", "use tessim::unit::x; use tessim::simulate;"), 0);
    assert_eq!(crossed("src/unit/a.rs", "use crate::simulate;"), 1);
    assert_eq!(crossed("src/golden/a.rs", "use rtl_model::patch::P; use rtl_model::clip;"), 1);
    assert_eq!(crossed("src/golden/a.rs", "use rtl_model::{patch, number};"), 1);
    assert_eq!(crossed("src/gpu/a.rs", "use rtl_model::{patch, number};"), 0);
    assert_eq!(crossed("src/stray/a.rs", "use crate::error;"), 1);
    let test = "#[cfg(test)] mod tests { use crate::golden; }";
    assert_eq!(crossed("src/trace/a.rs", test), 0);
}

#[test]
fn engines_that_know_each_other_are_found_however_they_are_imported() {
    let wrong = |name: &str, code: &str| {
        arrows::engine(&format!("rtl_model/src/time/{name}"), code).expect("an engine").1.len()
    };
    assert_eq!(wrong("timed.rs", "use super::account::Fifo; use super::{Block, Shape};"), 0);
    assert_eq!(wrong("timed.rs", "use super::stepped::Stepped;"), 2);
    assert_eq!(wrong("timed.rs", "use super::*; fn f(x: ordered::Event) {}"), 1);
    assert_eq!(wrong("timed/lane.rs", "use crate::time::{Shape, stepped};"), 1);
    assert_eq!(wrong("ordered.rs", "use super::account::Lanes;"), 0);
    assert_eq!(wrong("ordered.rs", "use super::{account::Lanes, timed};"), 1);
    assert_eq!(wrong("stepped.rs", "use crate::{time::account::Fifo};"), 1);
    assert_eq!(wrong("stepped.rs", "use super as t; type A = t::timed::Exact;"), 1);
    assert_eq!(
        wrong("stepped.rs", "//! As timed.\n#[cfg(test)] mod tests { use super::timed; }"),
        0
    );
    assert!(arrows::engine("rtl_model/src/time/account.rs", "").is_none());
    assert!(arrows::engine("src/timed.rs", "").is_none());
}

#[test]
fn paths_of_machines_are_found_and_addresses_are_not() {
    let home = ["/ho", "me/me/x"].concat();
    assert_eq!(
        rules::machine_paths("a", &format!("ok\n\"{home}\"")),
        ["a:2: a path under HOME".replace("HOME", &["/ho", "me/"].concat())]
    );
    assert_eq!(rules::machine_paths("a", &format!("https://example.org{home}")).len(), 0);
    assert_eq!(rules::machine_paths("a", &format!("cd {home}")).len(), 1);
}

#[test]
fn modules_are_listed_in_their_order() {
    let lib = "//! pub mod no;\npub mod number;\nmod clip;\n";
    assert_eq!(arrows::module_order(lib), ["number", "clip"]);
    assert_eq!(lexer::tokens("a::b \"c\" 1.5").len(), 5);
}

#[test]
fn a_kernel_with_floats_or_without_a_head_is_found() {
    let clean = "// Clip: what it does.\nfn f(a: vec2<u32>) -> i32 { return 1; } // f32 in words\n";
    assert!(rules::kernel_problems("src/gpu/clip.wgsl", clean).is_empty());
    for (text, says) in [
        ("fn f() {}\n", "begins without a comment"),
        ("// A.\nlet a: f32 = 1.0;\n", ":2: f32"),
        ("// A.\nlet a: vec2<f16>;\n", ":2: f16"),
        ("// A.\nlet a = 1li + i64(b);\n", ":2: i64"),
    ] {
        let found = rules::kernel_problems("src/gpu/clip.wgsl", text);
        assert!(found.len() == 1 && found[0].contains(says), "{text}: {found:?}");
    }
    assert!(rules::kernel_problems("src/gpu/render/a.wgsl", "// A.\nlet a: f32;\n").is_empty());
    let long = format!("// A.\n{}", "let a = 1u;\n".repeat(500));
    assert_eq!(rules::kernel_problems("src/gpu/clip.wgsl", &long).len(), 1);
}
