//! Counts by closed form, and what must be more or less than what.

use super::super::uniform_triangles;
use super::*;
use crate::config::preset::Preset;

fn run_of(levels: [u32; 2], cups: u32) -> (Vec<Row>, Options) {
    let options = Options { cups, levels, processors: vec![1, 20], prices: Prices::default() };
    (run(&options, &Preset::Hd5870.config()).unwrap(), options)
}

fn of(rows: &[Row], way: Way, level: u32) -> &Row {
    rows.iter().find(|row| row.way == way && row.level == level).unwrap()
}

/// Points of the uniform pattern: corners of the patch are copied, not evaluated.
fn points(level: u64) -> u64 {
    (3 * (level + 1) + 1).pow(2)
}

#[test]
fn counts_are_those_of_the_pattern() {
    let (rows, _) = run_of([1, 3], 1);
    for level in 1..=3 {
        let n = u64::from(level);
        let corners = (n + 2) * (n + 3) / 2; // of a coarse triangle
        for way in Way::ALL {
            let row = of(&rows, way, level);
            assert_eq!(row.triangles, 26 * uniform_triangles(level), "{way:?}");
            assert_eq!(row.patches, 26);
        }
        let patch = of(&rows, Way::Esc(Reuse::Patch), level);
        let triangle = of(&rows, Way::Esc(Reuse::CoarseTriangle), level);
        let none = of(&rows, Way::Esc(Reuse::None), level);
        assert_eq!((patch.evaluating, patch.control_points), (26, 26 * 16));
        assert_eq!(patch.evaluations, 26 * (points(n) - 4));
        assert_eq!(patch.vertices, 26 * points(n));
        // Six coarse triangles have a corner of the patch, two of these the same.
        assert_eq!(triangle.vertices, 26 * 18 * corners);
        assert_eq!(none.vertices, 26 * 18 * ((n + 1) * (n + 1) + 2 * (n + 1)));
        assert!(patch.evaluations < triangle.evaluations);
        assert!(triangle.evaluations < none.evaluations);
        for kind in [DomainKind::Naive, DomainKind::Basis] {
            let row = of(&rows, Way::D3d11(kind), level);
            assert_eq!(row.evaluating, 26 * points(n));
            let reads = if kind == DomainKind::Naive { row.evaluating } else { 26 };
            assert_eq!(row.control_points, 16 * reads, "{kind:?}");
        }
    }
    // L = 3, 8 values a vertex: a coarse triangle has 24 strip vertices, so 5 fit into 1024 values.
    assert_eq!(of(&rows, Way::EscLimited, 3).evaluating, 26 * 4);
}

#[test]
fn programs_and_processors_explain_the_cycles() {
    let (rows, _) = run_of([3, 3], 5);
    let naive = of(&rows, Way::D3d11(DomainKind::Naive), 3);
    // 130 patches of 169 points: three waves each of 64, 80 instructions of 4 cycles.
    assert_eq!(naive.shader_cycles, 130 * 3 * 80 * 4);
    // Three waves of up to 64 invocations, each as long as a patch's program.
    let esc = of(&rows, Way::Esc(Reuse::Patch), 3);
    // A corner that is copied takes the place of a point.
    let program = u64::from(program::NET) + 16 * 169 + 4 * 288;
    assert_eq!(esc.shader_cycles, 3 * 4 * program);
    for row in &rows {
        assert!(row.elapsed[0] >= row.shader_cycles, "one processor is no faster: {row:?}");
        assert!(row.elapsed[1] <= row.elapsed[0]);
        // A triangle a cycle, however many processors.
        assert!(row.elapsed[1] >= row.triangles, "{row:?}");
    }
}

#[test]
fn energy_is_the_sum_of_its_parts_and_naive_costs_more_than_once_a_patch() {
    let (rows, options) = run_of([2, 2], 1);
    for row in &rows {
        let e = row.energy;
        assert!((e.total() - (e.operations + e.chip + e.memory)).abs() < 1e-6);
        assert_eq!(e.chip, row.chip_bytes as f64 * options.prices.chip_byte);
        assert!(row.ops.add > 0 && e.operations > 0.0);
    }
    let energy = |way| of(&rows, way, 2).energy;
    let naive = energy(Way::D3d11(DomainKind::Naive));
    assert!(naive.in_singles > energy(Way::D3d11(DomainKind::Basis)).in_singles);
    assert!(naive.in_singles > energy(Way::Esc(Reuse::Patch)).in_singles);
    let dear = Options { prices: Prices { invocation: 1.0, ..options.prices }, ..options.clone() };
    let row =
        row(Way::ALL[0], 2, &Scene::Teacups(1).commands(1).unwrap(), &dear, &Config::default());
    let row = row.unwrap();
    assert_eq!(row.energy.invocations, row.invocations as f64);
}

#[test]
fn tables_say_where_esc_loses_and_csv_has_a_row_for_each_number_of_processors() {
    let (rows, options) = run_of([0, 1], 1);
    let text = text(&rows, &options);
    assert!(text.contains("nearest to 2.05 (HD 6970)") && text.contains("slower at L"), "{text}");
    let lost = text.lines().filter(|line| line.contains("| d3d11, basis | shaders alone"));
    let lost: Vec<_> = lost.filter(|line| line.contains("esc, no reuse")).collect();
    assert!(lost.len() == 1 && lost[0].contains(" 0 1 |"), "at both levels: {lost:?}");
    let csv = csv(&rows, &options);
    assert_eq!(csv.lines().count(), 1 + 2 * 6 * 2);
    for line in csv.lines().skip(1) {
        assert_eq!(line.split(',').count(), CSV_HEADER.len());
        assert!(line.split(',').skip(1).all(|n| n.parse::<u64>().is_ok()), "{line}");
    }
    assert!(svg(&rows, &options).unwrap().contains("HD 5870"));
}
