//! Patterns that another implementation made: points and indices, in order, bit for bit.

use rtl_model::d3d11::{Domain, Factors, Output, Partitioning, Tessellator};

fn domain(name: &str) -> Domain {
    match name {
        "quad" => Domain::Quad,
        "tri" => Domain::Tri,
        "isoline" => Domain::Isoline,
        other => panic!("domain {other}"),
    }
}

fn partitioning(name: &str) -> Partitioning {
    match name {
        "integer" => Partitioning::Integer,
        "pow2" => Partitioning::Pow2,
        "odd" => Partitioning::Odd,
        "even" => Partitioning::Even,
        other => panic!("partitioning {other}"),
    }
}

fn output(name: &str) -> Output {
    match name {
        "point" => Output::Point,
        "line" => Output::Line,
        "cw" => Output::Cw,
        "ccw" => Output::Ccw,
        other => panic!("output {other}"),
    }
}

/// A list of tuples, in which `.` stands for the number at the same place of the one before.
fn tuples(text: &str) -> Vec<u32> {
    let mut numbers: Vec<u32> = Vec::new();
    for tuple in text.split(' ').filter(|text| *text != "-") {
        let width = tuple.split(',').count();
        for number in tuple.split(',') {
            numbers.push(match number {
                "." => numbers[numbers.len() - width],
                digits => digits.parse().expect("a number"),
            });
        }
    }
    numbers
}

#[test]
fn all_vectors_are_reproduced_bit_for_bit_and_in_order() {
    let text = include_str!("../../../tests/vectors/d3d11.txt");
    let mut tessellator = Tessellator::default();
    let (mut patterns, mut culled, mut points, mut indices) = (0, 0, 0, 0);
    for line in text.lines().filter(|line| !line.starts_with('#')) {
        let fields: Vec<&str> = line.split(" | ").collect();
        let [shape, factors, want_points, want_indices] = fields.try_into().unwrap();
        let words: Vec<&str> = shape.split(' ').collect();
        let bits: Vec<u32> =
            factors.split(' ').map(|hex| u32::from_str_radix(hex, 16).unwrap()).collect();
        let (want_points, want_indices) = (tuples(want_points), tuples(want_indices));
        patterns += 1;
        let Some(factors) = Factors::process(domain(words[0]), partitioning(words[1]), &bits)
        else {
            culled += 1;
            assert!(want_points.is_empty() && want_indices.is_empty(), "culled: {line:.80}");
            continue;
        };
        tessellator.accept(&factors, output(words[2]));
        assert_eq!(tessellator.points().as_flattened(), want_points, "{line:.80}");
        let got: Vec<u32> = tessellator.indices().iter().map(|&k| k.into()).collect();
        assert_eq!(got, want_indices, "{line:.80}");
        points += tessellator.points().len();
        indices += got.len();
    }
    println!("compared {patterns} patterns, {culled} culled, {points} points, {indices} indices");
    assert_eq!((patterns, culled), (411, 5));
    assert!(points > 40_000 && indices > 150_000, "{points} points, {indices} indices");
}
