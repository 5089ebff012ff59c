//! Malformed BPT files.

use super::{Case, check, distinct};
use tessim::trace::import::import_bpt;

const HUGE: &[u8] = b"1\n3 3\n0 0 0\n0 2e18 0";

const CASES: &[Case<'_>] = &[
    ("nothing", b"", (1, 1), &["the file ends here", "the number of patches"]),
    ("blank lines only", b"\n\n  \n", (3, 1), &["the file ends here"]),
    ("no count", b"patches 3", (1, 1), &["number of patches: found `patches`", "an integer"]),
    ("negative count", b" -3\n", (1, 2), &["found `-3`", "an integer"]),
    ("fractional count", b"1.5", (1, 1), &["found `1.5`", "an integer"]),
    ("no patches", b"0\n", (1, 1), &["found 0 patches", "expected from 1 to 16777216"]),
    ("too many patches", b"16777217\n", (1, 1), &["found 16777217 patches", "16777216"]),
    ("count of 100 digits", &[b'9'; 100], (1, 1), &["an integer"]),
    ("no degrees", b"1\n", (1, 1), &["the file ends here", "patch 0: the first degree"]),
    ("quadratic", b"1\n2 3\n", (2, 1), &["the first degree: found 2", "only bicubic"]),
    ("biquartic", b"1\n3 4\n", (2, 3), &["the second degree: found 4", "expected 3"]),
    ("degree as text", b"1\n3\n\nthree", (4, 1), &["second degree: found `three`"]),
    ("cut short", b"1\n3 3\n0 0 0\n0 1", (4, 1), &["the file ends here", "patch 0, point 1, z"]),
    ("not a number", b"1\n3 3\n0 0 0\n0 NaN 0", (4, 3), &["point 1, y: found `NaN`", "a number"]),
    ("infinite", b"1\n3 3\n0 0 inf", (3, 5), &["point 0, z: found `inf`", "a number"]),
    ("overflow", b"1\n3 3\n1e39 0 0", (3, 1), &["point 0, x: found `1e39`", "up to 1e18"]),
    ("huge", HUGE, (4, 3), &["found `2e18`", "up to 1e18"]),
    ("comma", b"1\n3 3\n0, 0, 0", (3, 1), &["found `0,`", "a number"]),
    ("no text", b"1\n3 3\n\xff\xfe 0 0", (3, 1), &["point 0, x", "a number"]),
];

#[test]
fn models() {
    distinct(CASES);
    for case in CASES {
        let mut trace = Vec::new();
        let error = import_bpt(case.1, "bad", &mut trace).err();
        check(case, error);
        assert!(trace.is_empty(), "{}: something was written", case.0);
    }
}

#[test]
fn more_than_was_promised() {
    let text = format!("1\n3 3\n{}  junk here\n", "0 0 1\n".repeat(16));
    let error = import_bpt(text.as_bytes(), "bad", Vec::new()).err();
    let wanted: &[&str] = &["found `junk`", "the end after 1 patches"];
    check(&("surplus", text.as_bytes(), (19, 3), wanted), error);
}
