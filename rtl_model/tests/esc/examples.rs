//! What the paper prints, and what can be worked out by hand.

use crate::support::{insertion, lists, triangles};
use rtl_model::esc::{Edge, Insertion, LEVEL_MAX, Site};

/// Concheiro and others 2014, figure 5 and the text beside it, level 2.
#[test]
fn the_lists_of_figure_5_verbatim() {
    // Equation 10: nothing is missing.
    let uniform = [vec![2, 1, 3], vec![4, 2, 5, 3, 6], vec![7, 4, 8, 5, 9, 6, 10]];
    assert_eq!(lists(Insertion::all(2)), uniform);
    // 5a: vertex 6 is missing.
    let a = insertion(2, "11 10 11");
    assert_eq!(lists(a), [vec![2, 1, 3], vec![4, 2, 5, 3, 10], vec![7, 4, 8, 5, 9, 5, 10]]);
    // 5b: the row 4 5 6 is empty, the row above it complete.
    let b = insertion(2, "10 10 11");
    assert_eq!(lists(b), [vec![2, 1, 3], vec![7, 2, 8, 2, 9, 3, 10]]);
    // 5c: of the row above it vertex 2 is missing. The first strip has shrunk to an edge.
    let c = insertion(2, "00 10 11");
    assert_eq!(lists(c), [vec![1, 3], vec![7, 1, 8, 3, 9, 3, 10]]);
}

/// The triangles that the paper prints for figure 5a, each turned to its slot's beginning.
#[test]
fn the_triangles_of_figure_5a() {
    let printed = [[2, 1, 3], [4, 2, 5], [2, 5, 3], [5, 3, 10], [7, 4, 8], [4, 8, 5], [8, 5, 9]];
    let sorted = |triangles: &[[u16; 3]]| {
        let mut triangles = triangles.to_vec();
        triangles.iter_mut().for_each(|triangle| triangle.sort_unstable());
        triangles
    };
    let got = triangles(insertion(2, "11 10 11"));
    assert_eq!(sorted(&got), sorted(&[&printed[..], &[[9, 5, 10]]].concat()));
}

/// Rule 3 at the head of a list: what follows has the other parity, and the same winding.
#[test]
fn winding_comes_from_the_slot() {
    let shifted = insertion(1, "0 1 1");
    assert_eq!(lists(shifted), [vec![4, 1, 3], vec![4, 5, 3, 6]]);
    assert_eq!(triangles(shifted), [[4, 3, 1], [4, 5, 3], [5, 6, 3]]);
}

/// Rule 2: of a group of three, by distance 1, 2, 1 from its ends, the middle one goes down.
#[test]
fn the_middle_of_a_group_goes_to_the_lower_row() {
    let group = insertion(3, "000 111 111");
    let heads: Vec<u16> = lists(group).iter().map(|list| list[0]).collect();
    // Row 1 to the apex; row 2, between apex and bottom, and row 3 to the bottom.
    assert_eq!(heads, [1, 11, 11, 11]);
    assert_eq!(lists(group)[2], [11, 8, 5, 9, 6, 10], "11 stands for 7 and for 4");
}

/// Two empty rows, one after the other, below the apex: it is spread over all places.
#[test]
fn the_apex_is_spread_where_no_row_is_left_above() {
    let fan = insertion(2, "00 00 11");
    assert_eq!(lists(fan), [[7, 1, 8, 1, 9, 1, 10]]);
    assert_eq!(triangles(fan), [[7, 8, 1], [8, 9, 1], [9, 10, 1]]);
}

#[test]
fn the_uniform_pattern_has_its_triangles_and_the_bare_one_has_one() {
    for level in 0..=LEVEL_MAX {
        let all = Insertion::all(level);
        let squared = u32::from(level + 1).pow(2);
        assert_eq!((all.triangle_count(), all.slot_count()), (squared, squared));
        assert_eq!(all.triangles().count(), squared as usize);
        let last = Site { row: level + 1, place: level + 1 }.number();
        let bare = Insertion::new(level, 0, 0, 0);
        let bottom_left = Site { row: level + 1, place: 0 }.number();
        assert_eq!(triangles(bare), [[bottom_left, last, 1]], "level {level}");
        assert_eq!(bare.slot_count(), 2 * u32::from(level) + 1);
    }
    assert_eq!(Insertion::default(), Insertion::all(0));
}

#[test]
fn masks_are_kept_by_edge_and_sites_by_number() {
    let masks = Insertion::new(4, 0b10, 0b100, 0b11000);
    assert_eq!([Edge::Left, Edge::Right, Edge::Bottom].map(|e| masks.mask(e)), [2, 4, 24]);
    let numbers: Vec<u16> = masks.vertices().map(Site::number).collect();
    // Left 1 with row 1, right 2 with row 2's inner site, bottom 3 and 4.
    assert_eq!(numbers, [1, 2, 5, 6, 16, 19, 20, 21]);
    assert_eq!((masks.boundary(), masks.interior(), masks.triangle_count()), (7, 1, 7));
}

#[test]
#[should_panic(expected = "a level of at most 15")]
fn a_level_above_the_greatest_panics() {
    let _ = Insertion::new(16, 0, 0, 0);
}

#[test]
#[should_panic(expected = "bits of positions 1 to the level")]
fn a_corners_bit_panics() {
    let _ = Insertion::new(3, 0, 0, 1);
}

#[test]
#[should_panic(expected = "bits of positions 1 to the level")]
fn a_bit_beyond_the_level_panics() {
    let _ = Insertion::new(3, 0, 1 << 4, 0);
}
