//! Meshes of coarse triangles against the paper's rules: every insertion of the lower levels,
//! random ones of all.

use super::ledger::Ledger;
use super::random::Random;
use super::table::Quantity as Q;
use rtl_model::esc::{Insertion, LEVEL_MAX, Site};
use tessim::golden::esc::Coarse;

/// The greatest level all of whose insertions are compared: 4096 of them.
const WHOLE: u8 = 4;

/// All insertions of levels 0 to 4.
pub(crate) fn all(ledger: &mut Ledger) {
    for level in 0..=WHOLE {
        for bits in 0..1_u32 << (3 * level) {
            let edge = |k: u8| (bits >> (k * level) & ((1 << level) - 1)) << 1;
            compare(ledger, level, [0, 1, 2].map(|k| edge(k) as u16));
        }
    }
}

/// One insertion of any level: few candidates, half or most of them.
pub(crate) fn random(ledger: &mut Ledger, random: &mut Random) {
    let level = random.integer(0, LEVEL_MAX.into()) as u8;
    let masks = [0; 3].map(|_: u16| {
        let [a, b] = [0; 2].map(|_: u64| random.bits());
        let mask = [a & b, a, a | b][random.integer(0, 2) as usize];
        mask as u16 & ((1_u32 << (level + 1)) - 2) as u16
    });
    compare(ledger, level, masks);
}

fn compare(ledger: &mut Ledger, level: u8, masks: [u16; 3]) {
    let [left, right, bottom] = masks;
    let got = Insertion::new(level, left, right, bottom);
    let bits = |mask: u16| (1..=level).map(|p| mask >> p & 1 == 1).collect();
    let want = Coarse::new(&masks.map(bits));
    let number = |site: Site| usize::from(site.number());
    let vertices: Vec<usize> = got.vertices().map(number).collect();
    ledger.equal(
        Q::EscVertices,
        (vertices, got.boundary() as usize, got.interior() as usize),
        (want.vertices(), want.boundary(), want.vertices().len() - want.boundary()),
    );
    let lists: Vec<Vec<usize>> =
        got.strips().map(|strip| strip.list().map(number).collect()).collect();
    ledger.equal(Q::EscLists, lists, want.lists());
    let triangles = got.triangles().map(|triangle| {
        let mut triangle = triangle.map(number);
        let least = (0..3).min_by_key(|&k| triangle[k]).expect("three corners");
        triangle.rotate_left(least); // keeps the winding
        triangle
    });
    ledger.equal(Q::EscTriangles, triangles.collect::<Vec<_>>(), want.triangles());
}
