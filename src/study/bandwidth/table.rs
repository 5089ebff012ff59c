//! The rows as text and as CSV.

use super::closed::vertex;
use super::{Bytes, CORNERS, Form, Row, Size};
use std::fmt::Write;

/// The columns of `bandwidth.csv`: bytes by closed form, then as measured, which is empty where no
/// unit takes the form.
pub const CSV_HEADER: [&str; 20] = [
    "form",
    "corner_bytes",
    "level",
    "patches",
    "instances",
    "triangles",
    "closed_control_points",
    "closed_attributes",
    "closed_vertices",
    "closed_indices",
    "closed_bytes",
    "control_points",
    "attributes",
    "vertices",
    "indices",
    "bytes",
    "commands",
    "matrices",
    "framing",
    "total",
];

/// `bandwidth.csv`: integers only, beside the names of forms.
#[must_use]
pub fn csv(rows: &[Row]) -> String {
    let mut text = CSV_HEADER.join(",");
    text.push('\n');
    for row in rows {
        let Size { corner_bytes, level, instances, .. } = row.size;
        let (patches, triangles) = (row.size.patches(), row.size.triangles());
        let kinds = |b: &Bytes| [b.control_points, b.attributes, b.vertices, b.indices, b.total()];
        let mut numbers = vec![corner_bytes, level, patches, instances, triangles];
        numbers.extend(kinds(&row.closed));
        let mut fields = vec![row.form.name().replace(", ", "_").replace(' ', "_")];
        fields.extend(numbers.iter().map(u64::to_string));
        match &row.measured {
            None => fields.extend(std::iter::repeat_n(String::new(), 9)),
            Some(m) => {
                let rest = [m.commands, m.matrices, m.framing, m.total];
                fields.extend(kinds(&m.data).iter().chain(&rest).map(u64::to_string));
            }
        }
        line(&mut text, &fields.join(","));
    }
    text
}

/// The tables for people, in Markdown, at the levels that are powers of two, and what they say.
#[must_use]
pub fn text(rows: &[Row]) -> String {
    let mut text = String::new();
    for corner_bytes in CORNERS {
        let rows: Vec<&Row> = rows.iter().filter(|r| r.size.corner_bytes == corner_bytes).collect();
        let shown: Vec<&Row> =
            rows.iter().copied().filter(|row| row.size.level.is_power_of_two()).collect();
        let Some(first) = rows.first() else { continue };
        let what = match corner_bytes {
            0 => "nothing at the corners".to_owned(),
            bytes => format!("{bytes} bytes at a corner: colour and texture coordinates"),
        };
        let Size { rows: up, columns: along, instances, .. } = first.size;
        let plural = if instances == 1 { "" } else { "s" };
        let mesh = format!("a mesh of {up} x {along} patches, {instances} instance{plural}");
        line(&mut text, &format!("{what}; a vertex {} bytes; {mesh}\n", vertex(corner_bytes)));
        for quantity in [Quantity::Patch, Quantity::Triangle] {
            let forms = Form::ALL.map(|form| (form.name().to_owned(), form));
            table(&mut text, quantity.name(), &shown, &forms, &|row| quantity.of(row));
        }
        ratios(&mut text, &shown);
        break_even(&mut text, &rows);
        text.push('\n');
    }
    notes(&mut text, rows);
    text
}

#[derive(Clone, Copy)]
enum Quantity {
    Patch,
    Triangle,
}

impl Quantity {
    fn name(self) -> &'static str {
        match self {
            Self::Patch => "bytes a patch, at level",
            Self::Triangle => "bytes a triangle, at level",
        }
    }

    fn of(self, row: &Row) -> f64 {
        let per = match self {
            Self::Patch => row.size.patches() * row.size.instances,
            Self::Triangle => row.size.triangles(),
        };
        row.bytes() as f64 / per as f64
    }
}

/// A table with a row a form and a column a level.
fn table(
    text: &mut String,
    corner: &str,
    rows: &[&Row],
    forms: &[(String, Form)],
    value: &dyn Fn(&Row) -> f64,
) {
    let of = |form| rows.iter().filter(move |row| row.form == form);
    let mut cells = vec![vec![corner.to_owned()]];
    let levels = of(Form::Mesh).map(|row| row.size.level.to_string());
    cells[0].extend(levels);
    for (name, form) in forms {
        let mut line = vec![name.clone()];
        line.extend(of(*form).map(|row| digits(value(row))));
        cells.push(line);
    }
    let width = |k: usize| cells.iter().map(|line| line[k].len()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..cells[0].len()).map(width).collect();
    for (number, cell) in cells.iter().enumerate() {
        let padded = cell.iter().zip(&widths).enumerate().map(|(k, (cell, width))| match k {
            0 => format!("{cell:<width$}"),
            _ => format!("{cell:>width$}"),
        });
        line(text, &format!("| {} |", padded.collect::<Vec<_>>().join(" | ")));
        if number == 0 {
            let rule = widths.iter().enumerate().map(|(k, width)| match k {
                0 => "-".repeat(*width),
                _ => "-".repeat(width - 1) + ":",
            });
            line(text, &format!("| {} |", rule.collect::<Vec<_>>().join(" | ")));
        }
    }
    text.push('\n');
}

const TRIANGLES: [Form; 3] = [Form::TriangleStrips, Form::IndexedTriangles, Form::VerticesOnce];
const SURFACES: [Form; 2] = [Form::Strip, Form::Mesh];

/// The row of a form at the level of another.
fn beside<'a>(rows: &[&'a Row], form: Form, row: &Row) -> Option<&'a Row> {
    rows.iter().copied().find(|other| other.form == form && other.size.level == row.size.level)
}

/// How many times the bytes of strip and mesh each form of triangles has.
fn ratios(text: &mut String, rows: &[&Row]) {
    for surface in SURFACES {
        let names = TRIANGLES.map(|form| (form.name().to_owned(), form));
        let head = format!("times the bytes of the {}", surface.name());
        table(text, &head, rows, &names, &|row| {
            let surface = beside(rows, surface, row);
            surface.map_or(f64::NAN, |surface| row.bytes() as f64 / surface.bytes() as f64)
        });
    }
}

/// From which level on patches take less than triangles.
fn break_even(text: &mut String, rows: &[&Row]) {
    for triangles in TRIANGLES {
        let from = SURFACES.map(|surface| {
            let more = |row: &&&Row| {
                let other = beside(rows, triangles, row);
                row.form == surface && other.is_some_and(|other| other.bytes() <= row.bytes())
            };
            let last = rows.iter().filter(more).map(|row| row.size.level).max();
            let next = rows.iter().map(|row| row.size.level);
            let next = next.filter(|level| last.is_none_or(|last| *level > last)).min();
            let name = surface.name();
            match next {
                Some(level) => format!("a {name} from level {level} on"),
                None => format!("a {name} at no level here"),
            }
        });
        line(text, &format!("less than {}: {}", triangles.name(), from.join(", ")));
    }
}

/// What the numbers are.
fn notes(text: &mut String, rows: &[Row]) {
    let measured = rows.iter().filter(|row| row.measured.is_some());
    let (equal, other): (Vec<&Row>, Vec<&Row>) = measured.partition(|row| row.agrees());
    let all = equal.len() + other.len();
    line(
        text,
        &format!("closed form and measured bytes are equal in {} of {all} rows", equal.len()),
    );
    for note in [
        "immediate data: all of it crosses the link anew in each frame, and no cache saves any",
        "not here: command headers, matrices and framing, which bandwidth.csv has beside the rest",
        "levels: 1 and the even ones, which unit hybrid reaches; sfarti has powers of two only and",
        "  sends the same bytes, moreton 16 more a patch: the levels that its driver chose",
        "fan: as many patches as the mesh has; the triangles beside it are those of the mesh",
        "indexed triangles: what unit triangles sends, each patch's vertices once; indices have",
        "  4 bytes where the draw has more than 65536 vertices",
        "triangle strips: both rows of vertices of each strip of each patch; closed form only",
        "vertices once: each vertex of the whole mesh, and no byte that says which triangles they",
        "  make: a lower bound; closed form only",
    ] {
        line(text, note);
    }
}

/// Three digits that count.
fn digits(value: f64) -> String {
    match value {
        v if v >= 99.95 => format!("{v:.0}"),
        v if v >= 9.995 => format!("{v:.1}"),
        v if v >= 0.9995 => format!("{v:.2}"),
        v if v >= 0.09995 => format!("{v:.3}"),
        v => format!("{v:.4}"),
    }
}

fn line(text: &mut String, line: &str) {
    writeln!(text, "{line}").expect("a String takes everything");
}
