//! Insertions from bits as they are written, and meshes by number.

use rtl_model::esc::Insertion;

/// Positions 1 and on of an edge, as bits in their order.
pub(crate) fn mask(bits: &str) -> u16 {
    bits.bytes().zip(1..).map(|(bit, position)| u16::from(bit == b'1') << position).sum()
}

/// An insertion written `left right bottom`.
pub(crate) fn insertion(level: u8, bits: &str) -> Insertion {
    let words: Vec<&str> = bits.split(' ').collect();
    let [left, right, bottom] = words.try_into().unwrap();
    assert!([left, right, bottom].iter().all(|edge| edge.len() == usize::from(level)));
    Insertion::new(level, mask(left), mask(right), mask(bottom))
}

pub(crate) fn triangles(insertion: Insertion) -> Vec<[u16; 3]> {
    insertion.triangles().map(|triangle| triangle.map(|site| site.number())).collect()
}

/// The strips as the paper lists them.
pub(crate) fn lists(insertion: Insertion) -> Vec<Vec<u16>> {
    insertion.strips().map(|strip| strip.list().map(|site| site.number()).collect()).collect()
}
