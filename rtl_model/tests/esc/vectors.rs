//! Meshes that another implementation made, all of levels 1 to 3: triangle by triangle, in order.

use crate::support::{insertion, triangles};
use std::collections::HashSet;

#[test]
fn all_vectors_are_reproduced_triangle_by_triangle_in_order() {
    let text = include_str!("../../../tests/vectors/esc.txt");
    let mut seen = HashSet::new();
    let mut compared = 0;
    for line in text.lines().filter(|line| !line.starts_with('#')) {
        let (given, want) = line.split_once(" | ").unwrap();
        let (level, bits) = given.split_once(' ').unwrap();
        let insertion = insertion(level.parse().unwrap(), bits);
        let triangle = |text: &str| -> [u16; 3] {
            let numbers: Vec<u16> = text.split(',').map(|k| k.parse().unwrap()).collect();
            numbers.try_into().unwrap()
        };
        let want: Vec<[u16; 3]> = want.split(' ').map(triangle).collect();
        assert_eq!(triangles(insertion), want, "{given}");
        compared += want.len();
        seen.insert(insertion);
    }
    println!("compared {} meshes, {compared} triangles", seen.len());
    assert_eq!((seen.len(), compared), (8 + 64 + 512, 5492));
}
