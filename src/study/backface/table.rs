//! The rows as text and as CSV.

use super::{Place, Row, Score};
use crate::config::BackfaceMethod;
use crate::study::markdown;
use rtl_model::counter::standard::Ops;
use std::fmt::Write;

/// The columns of `backface.csv`. Operations are sums over the patches, with and without early out.
pub const CSV_HEADER: [&str; 17] = [
    "patches",
    "viewer",
    "method",
    "tested",
    "away",
    "away_culled",
    "culled",
    "false_culls_quantised",
    "false_culls_f32",
    "facets",
    "facets_tested",
    "ops_add",
    "ops_mul",
    "ops_compare",
    "early_out_add",
    "early_out_mul",
    "early_out_compare",
];

/// `backface.csv`: integers only.
#[must_use]
pub fn csv(rows: &[Row]) -> String {
    let mut text = CSV_HEADER.join(",");
    text.push('\n');
    for row in rows {
        let Row { source, place, method, score, ops, ops_early } = row;
        let Score { tested, away, away_culled, culled, false_quantised, false_f32, facets } = score;
        let names = [source.name(), place.name(), name(*method)];
        let all = tested * u64::from(method.facets());
        let counts = [*tested, *away, *away_culled, *culled, *false_quantised, *false_f32, all];
        let ops = [ops.add, ops.mul, ops.compare];
        let early = [ops_early.add, ops_early.mul, ops_early.compare];
        let numbers = counts.into_iter().chain([*facets]).chain(ops).chain(early);
        let fields = names.map(str::to_owned).into_iter().chain(numbers.map(|n| n.to_string()));
        line(&mut text, &fields.collect::<Vec<_>>().join(","));
    }
    text
}

/// The tables for people, in Markdown, and what there is to be read off them.
#[must_use]
pub fn text(rows: &[Row]) -> String {
    let mut text = String::new();
    for place in [Place::Outside, Place::Within] {
        let rows: Vec<_> = rows.iter().filter(|row| row.place == place).collect();
        let head = match place {
            Place::Outside => "viewers outside the hull of every patch",
            Place::Within => "a viewer within the hull of each patch",
        };
        line(&mut text, &format!("{head}\n"));
        let cells: Vec<_> = rows.iter().map(|row| cells(row)).collect();
        text.push_str(&markdown::table(&COLUMNS, 2, &cells));
        text.push('\n');
        verdict(&mut text, place, &rows);
        if place == Place::Outside {
            text.push('\n');
        }
    }
    text
}

const COLUMNS: [&str; 10] = [
    "patches",
    "test",
    "tested",
    "show no front",
    "of these culled",
    "false culls",
    "f32",
    "add / mul / compare",
    "facets looked at",
    "early out",
];

fn cells(row: &Row) -> [String; 10] {
    let Score { tested, away, away_culled, false_quantised, false_f32, facets, .. } = row.score;
    let share = |part: u64, of: u64| if of == 0 { 0.0 } else { part as f64 / of as f64 };
    let each = |ops: &Ops| {
        let mean = |n: u64| share(n, tested).round();
        format!("{} / {} / {}", mean(ops.add), mean(ops.mul), mean(ops.compare))
    };
    [
        row.source.name().to_owned(),
        name(row.method).to_owned(),
        tested.to_string(),
        away.to_string(),
        format!("{:.1} %", 100.0 * share(away_culled, away)),
        false_quantised.to_string(),
        false_f32.to_string(),
        each(&row.ops),
        format!("{:.1} of {}", share(facets, tested), row.method.facets()),
        each(&row.ops_early),
    ]
}

/// What the literal reading did, in words.
fn verdict(text: &mut String, place: Place, rows: &[&Row]) {
    let literal = rows.iter().filter(|row| row.method == BackfaceMethod::HullLiteral);
    let [tested, culled, wrong] = literal.fold([0; 3], |[a, b, c], row| {
        [a + row.score.tested, b + row.score.culled, c + row.score.false_quantised]
    });
    let says = match place {
        Place::Outside => "the hull is closed, so one of its facets faces whoever is outside it",
        Place::Within => "from within no facet faces the viewer, whatever the surface shows",
    };
    line(
        text,
        &format!(
            "hull_literal: of {tested} patches {culled} culled, {wrong} of them wrongly: {says}"
        ),
    );
}

/// As in the configuration.
fn name(method: BackfaceMethod) -> &'static str {
    match method {
        BackfaceMethod::Off => "off",
        BackfaceMethod::NetFacets => "net_facets",
        BackfaceMethod::TangentPlane => "tangent_plane",
        BackfaceMethod::NormalCone => "normal_cone",
        BackfaceMethod::HullLiteral => "hull_literal",
    }
}

fn line(text: &mut String, line: &str) {
    writeln!(text, "{line}").expect("a String takes everything");
}
