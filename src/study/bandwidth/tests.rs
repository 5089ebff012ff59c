//! Closed forms against runs of random sizes, and against the numbers that are known.

use super::*;
use crate::study::random::Random;

fn size(rows: u64, columns: u64, corner_bytes: u64, level: u64) -> Size {
    Size { rows, columns, instances: 1, corner_bytes, level }
}

fn bytes(form: Form, size: &Size) -> u64 {
    closed::bytes(form, size).total()
}

#[test]
fn closed_forms_are_what_runs_measure_at_any_size() {
    let mut compared = 0;
    for case in 0..60 {
        let mut random = Random::of(0xba4d, case);
        let mut integer = |least: u64, most: u64| least + random.bits() % (most - least + 1);
        let size = Size {
            rows: integer(1, 7),
            columns: integer(1, 9),
            instances: integer(1, 3),
            corner_bytes: CORNERS[integer(0, 1) as usize],
            level: [1, 2 * integer(1, 16)][integer(0, 1) as usize],
        };
        for form in Form::ALL {
            let row = row(form, size).unwrap();
            let Some(measured) = row.measured else { continue };
            assert_eq!(measured.data, row.closed, "{form:?} of {size:?}");
            assert_eq!(measured.triangles, size.triangles(), "{form:?} of {size:?}");
            let sum = measured.data.total() + measured.commands + measured.matrices;
            assert_eq!(measured.total, sum + measured.framing, "{form:?} of {size:?}");
            compared += 1;
        }
    }
    assert_eq!(compared, 60 * 7);
}

/// Indices of four bytes where two are too few: by points in a mesh, by vertices in triangles.
#[test]
fn closed_forms_hold_where_indices_get_wider() {
    for (form, rows, columns, level, width) in [
        (Form::IndexedMesh, 84, 86, 1, 2), // 253 x 259 points are 65527
        (Form::IndexedMesh, 84, 87, 1, 4), // 253 x 262 are 66286
        (Form::IndexedTriangles, 1, 181, 18, 2), // 181 x 19 x 19 vertices are 65341
        (Form::IndexedTriangles, 2, 91, 18, 4), // 182 x 19 x 19 are 65702
    ] {
        let row = row(form, size(rows, columns, 12, level)).unwrap();
        assert!(row.agrees(), "{row:?}");
        let indices = match form {
            Form::IndexedMesh => 20 * row.size.patches(),
            _ => 3 * row.size.triangles(),
        };
        assert_eq!(row.closed.indices, width * indices, "{row:?}");
    }
}

/// One more patch of a strip is 168 bytes, one inside a mesh 120, and its grid of vertices, each
/// sent once and shared with the neighbours, 2048 at level 8 and 8192 at 16, of 32 bytes each.
#[test]
fn the_papers_argument_in_numbers() {
    let strip = |n| bytes(Form::Strip, &size(1, n, 12, 1));
    assert_eq!(strip(1), 16 * 12 + 4 * 12);
    assert_eq!([2, 9, 1000].map(|n| strip(n) - strip(n - 1)), [168; 3]);
    assert_eq!(
        [2, 9].map(|n| bytes(Form::Strip, &size(1, n, 0, 1))),
        [(4 * 7) * 12, (4 * 28) * 12]
    );
    // A patch within a mesh is what is left of the mesh without its row, its column and its anchor.
    let inner = |form: Form, corner_bytes, level| {
        let at = |m, n| bytes(form, &size(m, n, corner_bytes, level));
        at(5, 9) + at(4, 8) - at(4, 9) - at(5, 8)
    };
    assert_eq!(inner(Form::Mesh, 12, 1), 120);
    assert_eq!(inner(Form::Mesh, 0, 1), 108);
    assert_eq!([8, 16].map(|level| inner(Form::VerticesOnce, 0, level)), [2048, 8192]);
    // 12 and 17 times as many at 8, 49 and 68 at 16.
    let times = [2048 / 168, 2048 / 120, (8192 + 84) / 168, (8192 + 60) / 120];
    assert_eq!(times, [12, 17, 49, 68]);
    // Attributes at each of the 12 or 9 points, not at two corners or one, would be 71 % more in a
    // strip and 80 % more in a mesh.
    let every = [12, 9].map(|points| points * (12 + 12));
    assert_eq!([every[0] * 100 / 168 - 100, every[1] * 100 / 120 - 100], [71, 80]);
    let fan = |form| bytes(form, &size(1, 2, 12, 1)) - bytes(form, &size(1, 1, 12, 1));
    assert_eq!([fan(Form::FanCompact), fan(Form::FanFull)], [8 * 12 + 12, 9 * 12 + 12]);
}

/// Strips of a grid have its triangles: two less than its vertices each.
#[test]
fn triangle_strips_make_the_same_triangles() {
    for level in [1, 2, 7, 64] {
        let size = size(3, 5, 0, level);
        let vertices = bytes(Form::TriangleStrips, &size) / closed::vertex(0);
        let strips = size.patches() * level;
        assert_eq!(vertices - 2 * strips, size.triangles());
    }
}

#[test]
fn levels_are_those_that_have_as_many_segments_and_meshes_are_square() {
    assert_eq!(levels([1, 9]).collect::<Vec<_>>(), [1, 2, 4, 6, 8]);
    assert_eq!(levels([3, 3]).count(), 0);
    let shapes = [1, 7, 12, 64, 1000].map(shape);
    assert_eq!(shapes, [[1, 1], [1, 7], [3, 4], [8, 8], [25, 40]]);
}

#[test]
fn a_row_that_disagrees_is_told() {
    let mut rows = run(Options { levels: [1, 2], patches: 2, instances: 1 }).unwrap();
    assert!(text(&rows).contains("equal in 28 of 28 rows"));
    rows[5].closed.attributes += 1;
    assert!(text(&rows).contains("equal in 27 of 28 rows"));
}

#[test]
fn the_picture_has_a_line_a_form_and_its_text_is_text() {
    let rows = run(Options { levels: [1, 8], patches: 6, instances: 1 }).unwrap();
    let picture = svg(&rows).unwrap();
    assert_eq!(picture, svg(&rows).unwrap());
    for form in Form::ALL {
        assert!(picture.contains(form.name()), "{form:?}");
    }
    // Over the levels 1, 2, 4, 6 and 8.
    let points = |line: &str| line.split("points=\"").nth(1).map(|p| p.matches(',').count());
    let lines = picture.lines().filter(|line| line.starts_with("<polyline"));
    assert_eq!(lines.filter(|line| points(line) == Some(5)).count(), Form::ALL.len());
    assert!(picture.contains("bytes a triangle") && picture.contains("<text"));
    // One level is a picture too.
    assert!(svg(&run(Options { levels: [4, 4], patches: 1, instances: 2 }).unwrap()).is_ok());
}
