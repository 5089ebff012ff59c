//! Pages of result folders: what must be on them, what must not, and that they work in a browser.

#![expect(clippy::unwrap_used, reason = "all of it is test code, helpers too")]

mod browser;
mod refused;

use assert_cmd::Command;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// What a page says of a number or column that it cannot explain.
const UNKNOWN: &str = "not defined";

fn tessim() -> Command {
    Command::cargo_bin("tessim").unwrap()
}

fn teapot() -> String {
    format!("{}/traces/teapot.jsonl", env!("CARGO_MANIFEST_DIR"))
}

/// A folder to work in, with results of the commands in it.
struct Place(TempDir);

impl Place {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn run(&self, args: &[&str]) {
        tessim().current_dir(self.0.path()).arg("-q").args(args).assert().success();
    }

    /// A comparison of three units, as folder `compared`.
    fn compared(&self, trace: &str) {
        let quick = ["--engine", "none", "--samples", "2", "--set", "level.pixels=8"];
        let units = ["--units", "hybrid,triangles,d3d11", "--out", "compared"];
        self.run(&[&["compare", trace][..], &quick, &units].concat());
    }

    fn page(&self, folder: &str) -> String {
        self.run(&["report", folder]);
        fs::read_to_string(self.path(&format!("{folder}.html"))).unwrap()
    }

    /// Puts something else in a file's text, which must have been there.
    fn edit(&self, file: &str, from: &str, to: &str) {
        let path = self.path(file);
        let text = fs::read_to_string(&path).unwrap();
        assert!(text.contains(from), "{file}");
        fs::write(path, text.replacen(from, to, 1)).unwrap();
    }
}

/// What every page keeps: nothing is loaded from anywhere, everything is explained, every link in
/// it leads somewhere.
fn assert_sound(page: &str) {
    assert!(page.starts_with("<!DOCTYPE html>\n<html lang=\"en\">"), "no document");
    assert!(page.trim_end().ends_with("</html>"), "not whole");
    for (attribute, prefix) in [(" src=\"", "data:image/"), (" href=\"", "#number-")] {
        for rest in page.split(attribute).skip(1) {
            assert!(rest.starts_with(prefix), "{attribute}{}", &rest[..rest.len().min(60)]);
        }
    }
    assert!(!page.contains("url(") && !page.contains("@import"));
    assert!(
        page.contains(
            "http-equiv=\"Content-Security-Policy\" content=\"default-src &#39;none&#39;"
        )
    );
    assert!(!page.contains(UNKNOWN), "{}", around(page, UNKNOWN));
    let ids: BTreeSet<_> = values(page, " id=\"").collect();
    assert_eq!(ids.len(), values(page, " id=\"").count(), "an id twice");
    for to in values(page, " href=\"#") {
        assert!(ids.contains(to), "{to} leads nowhere");
    }
}

/// The values that follow `before`, up to the next quote.
fn values<'a>(page: &'a str, before: &'a str) -> impl Iterator<Item = &'a str> {
    page.split(before).skip(1).map(|rest| rest.split('"').next().unwrap())
}

fn around<'a>(page: &'a str, word: &str) -> &'a str {
    let at = page.find(word).unwrap_or(0);
    let from = page[..at].rfind("<dt").unwrap_or(0);
    &page[from..at]
}

/// What is between the marks.
fn plain(html: &str) -> String {
    let texts = html.split('<').map(|part| part.split_once('>').map_or("", |(_, text)| text));
    texts.collect::<String>().trim().to_owned()
}

/// The cells of the row of a page that links to this number, without their markup.
fn row(page: &str, number: &str) -> Vec<String> {
    let link = format!("<td><a href=\"#number-{number}\"");
    let at = page.find(&link).unwrap_or_else(|| panic!("no row of {number}"));
    let row = page[at..].split("</tr>").next().unwrap();
    row.split("</td>").map(plain).collect()
}

#[test]
fn a_comparison_has_a_row_a_number_and_defines_each() {
    let place = Place::new();
    place.compared(&teapot());
    let page = place.page("compared");
    assert_sound(&page);
    let csv = fs::read_to_string(place.path("compared/compare.csv")).unwrap();
    let mut names = BTreeSet::new();
    for line in csv.lines().skip(1) {
        let cells: Vec<_> = line.split(',').collect();
        names.insert(format!("{}.{}", cells[1], cells[2]));
    }
    assert!(names.len() > 200);
    let defined: BTreeSet<_> = values(&page, "<dt id=\"number-").map(ToOwned::to_owned).collect();
    assert_eq!(defined, names);
    let links = page.matches("<td><a href=\"#number-").count();
    assert_eq!(links, names.len(), "a row each");
    // The numbers are those of the file, and the ratio is theirs.
    let value = |unit: &str| {
        let line = format!("\n{unit},emit,triangles,");
        let at = csv.find(&line).unwrap() + line.len();
        csv[at..].split(',').next().unwrap()
    };
    let [hybrid, triangles, d3d11] = ["hybrid", "triangles", "d3d11"].map(value);
    let ratio =
        |of: &str| format!("{:.3}", of.parse::<f64>().unwrap() / hybrid.parse::<f64>().unwrap());
    let found = row(&page, "emit.triangles");
    let wanted = [hybrid, triangles, &ratio(triangles), d3d11, &ratio(d3d11)];
    assert_eq!(found[2..7], wanted, "{found:?}");
    for said in ["<dd>teapot</dd>", "hybrid, triangles, d3d11", "unit = &quot;hybrid&quot;"] {
        assert!(page.contains(said), "{said}");
    }
    assert!(page.contains("Textures and the frame buffer are not counted"));
    // One frame is no line.
    assert!(!page.contains("class=\"frames\""));
}

#[test]
fn a_run_has_its_totals_its_frames_and_its_occupancy() {
    let place = Place::new();
    let zoom = teapot().replace("teapot", "zoom");
    place.run(&["run", &zoom, "--set", "level.pixels=16", "--out", "ran"]);
    let page = place.page("ran");
    assert_sound(&page);
    let summary = fs::read_to_string(place.path("ran/summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    let frames = summary["frames"].as_u64().unwrap();
    assert!(frames > 1);
    for (name, total) in summary["totals"].as_object().unwrap() {
        assert_eq!(row(&page, name)[2], total.to_string(), "{name}");
    }
    assert!(page.contains("<h2>occupancy.csv</h2>") && page.contains("<h2>counters.csv</h2>"));
    let data = page.split("class=\"data\">").nth(1).unwrap().split("</script>").next().unwrap();
    let data: serde_json::Value = serde_json::from_str(data).unwrap();
    let triangles = data["numbers"].as_array().unwrap();
    let triangles = triangles.iter().find(|n| n["name"] == "emit.triangles").unwrap();
    let drawn = triangles["values"][0].as_array().unwrap();
    assert_eq!(drawn.len() as u64, frames);
    let sum: u64 = drawn.iter().map(|value| value.as_u64().unwrap()).sum();
    assert_eq!(sum, summary["totals"]["emit.triangles"].as_u64().unwrap());
}

#[test]
fn long_tables_say_how_much_of_them_is_left_out() {
    let place = Place::new();
    let study = "traces = [\"teapot.jsonl\"]\nunits = [\"hybrid\", \"d3d11\"]\n\
                 [grid]\nengine = [\"none\"]\nlevel.level = [2, 3, 4, 5, 6, 7, 8, 9]\n";
    fs::write(place.path("study.toml"), study).unwrap();
    fs::copy(teapot(), place.path("teapot.jsonl")).unwrap();
    place.run(&["sweep", "study.toml", "--out", "swept"]);
    let page = place.page("swept");
    assert_sound(&page);
    let csv = fs::read_to_string(place.path("swept/sweep.csv")).unwrap();
    let rows = csv.lines().count() - 1;
    assert!(rows > 2000, "{rows}");
    let note = format!("The first 2000 rows; {} more are left out: sweep.csv.", rows - 2000);
    assert!(page.contains(&note));
    let table = page.split("<h2>sweep.csv</h2>").nth(1).unwrap();
    let table = table.split("</table>").next().unwrap();
    assert_eq!(table.matches("<tr>").count(), 2001);
    assert!(page.contains("<h2>sweep.svg</h2>"), "plots over what was changed");
    assert!(page.contains("<h2>points.csv</h2>") && page.contains("study.toml"));
    assert!(page.contains("<dd>teapot</dd>"), "what the points were made of");
    let header = page.split("</header>").next().unwrap();
    // All of them, not the first that says so.
    for fact in
        ["<dt>units</dt>\n<dd>d3d11, hybrid</dd>", "<dt>points</dt>\n<dd>16 (0 failed)</dd>"]
    {
        assert!(header.contains(fact), "{fact}");
    }
    assert!(!header.contains("<dt>unit</dt>") && !header.contains("<dt>frames</dt>"));
}

#[test]
fn numbers_are_in_threes_and_ratios_keep_their_digits() {
    let place = Place::new();
    place.compared(&teapot());
    let mut csv = "unit,block,counter,value,measure,first,min,median,max\n".to_owned();
    for (unit, value, part) in [("hybrid", "4000000", "2.5"), ("d3d11", "1", "12345.678")] {
        csv +=
            &format!("{unit},emit,triangles,{value},count,,,,\n{unit},unit,time,{part},ms,,,,\n");
    }
    fs::write(place.path("compared/compare.csv"), csv).unwrap();
    let page = place.page("compared");
    assert_eq!(row(&page, "emit.triangles")[2..5], ["4000000", "1", "0.000000250"]);
    assert_eq!(row(&page, "unit.time")[2..5], ["2.5", "12345.7", "4938.271"]);
    assert!(page.contains("<td class=\"number\">4<i>000</i><i>000</i></td>"));
    assert!(page.contains("<td class=\"number\" title=\"12345.678\">12<i>345</i>.7</td>"));
}

/// Frames beyond all that is in use: so many units and counters over 30,000 frames.
fn many_frames(place: &Place, units: usize, numbers: usize) {
    place.compared(&teapot());
    let mut csv = "unit,frame,block,counter,value,measure\n".to_owned();
    for frame in 0..30_000 {
        for at in 0..units * numbers {
            let (unit, number) = (at % units, at / units);
            csv += &format!("u{unit},{frame},emit,n{number},{},count\n", 1_000_000 + frame);
        }
    }
    fs::write(place.path("compared/frames.csv"), csv).unwrap();
}

#[test]
fn numbers_over_many_frames_have_room_for_two_mebibytes() {
    let place = Place::new();
    many_frames(&place, 1, 12);
    let page = place.page("compared");
    // Eight bytes a frame each.
    assert!(page.contains("<p class=\"note\">4 numbers are left out for size.</p>"));
    let data = page.split("class=\"data\">").nth(1).unwrap().split("</script>").next().unwrap();
    let data: serde_json::Value = serde_json::from_str(data).unwrap();
    let kept = data["numbers"].as_array().unwrap();
    assert_eq!(kept.len(), 8);
    assert_eq!(kept[7]["values"][0].as_array().unwrap().len(), 30_000);
    assert_eq!(data["frames"].as_array().unwrap().len(), 30_000);
}

#[test]
fn a_precision_study_has_its_plots_in_it() {
    let place = Place::new();
    let grid = ["--width", "12,16", "--guard", "8", "--reciprocal", "20", "--subpixel", "8"];
    let small = ["--samples", "2", "--evaluators", "--set", "level.level=4", "--out", "precise"];
    place.run(&[&["precision", &teapot()][..], &grid, &small].concat());
    let page = place.page("precise");
    assert_sound(&page);
    for file in ["precision.svg", "evaluators.svg"] {
        let after = page.split(&format!("<h2>{file}</h2>")).nth(1).unwrap();
        let data = after.split("base64,").nth(1).unwrap().split('"').next().unwrap();
        let svg = fs::metadata(place.path(&format!("precise/{file}"))).unwrap().len();
        assert_eq!(data.len() as u64, svg.div_ceil(3) * 4, "all of {file}");
    }
    let table = page.split("<h2>precision.csv</h2>").nth(1).unwrap();
    assert_eq!(table.split("</table>").next().unwrap().matches("<tr>").count(), 3);
}

#[test]
fn whatever_files_say_is_read_as_text() {
    let place = Place::new();
    let evil = "<script>alert(1)</script>";
    let text = fs::read_to_string(teapot()).unwrap();
    assert!(text.contains("\"title\":\"teapot\"") || text.contains("\"title\": \"teapot\""));
    let text = text.replacen("\"teapot\"", &format!("\"{evil}\""), 1);
    fs::write(place.path("evil.jsonl"), text).unwrap();
    place.compared("evil.jsonl");
    place.edit("compared/compare.csv", ",count,", ",<b onclick='x()'>\u{1b}[1m</b>,");
    place.edit("compared/config.toml", "\n", "\n# </pre><script>alert(2)</script>\n");
    let frames = "unit,frame,block,counter,value,measure\n<!--</script>,0,a,b,1,c\n\
                  <!--</script>,1,a,b,2,c\n";
    fs::write(place.path("compared/frames.csv"), frames).unwrap();
    let page = place.page("compared");
    assert!(!page.contains("alert(1)</script>") && !page.contains("alert(2)</script>"));
    assert!(page.contains("<dd>&lt;script&gt;alert(1)&lt;/script&gt;</dd>"));
    assert!(page.contains("&lt;/pre&gt;&lt;script&gt;alert(2)"));
    assert!(page.contains("&lt;b onclick=&#39;x()&#39;&gt;\u{fffd}[1m&lt;/b&gt;"));
    assert!(!page.contains("<b onclick") && !page.contains('\u{1b}') && !page.contains("<!--"));
    // The data of the frames and the page's own.
    assert_eq!(page.matches("</script>").count(), 2);
}

#[test]
fn the_same_folder_gives_the_same_bytes_wherever_they_go() {
    let place = Place::new();
    place.compared(&teapot());
    let first = place.page("compared");
    place.run(&["report", "compared/", "--out", "again.html"]);
    assert!(fs::read_to_string(place.path("again.html")).unwrap() == first);
    let mut inside = tessim();
    inside.current_dir(place.path("compared")).args(["report", ".", "--out", "-"]);
    let printed = inside.assert().success().get_output().stdout.clone();
    assert!(printed == first.as_bytes());
    fs::remove_file(place.path("compared.html")).unwrap();
    let mut inside = tessim();
    inside.current_dir(place.path("compared")).args(["report", "."]).assert().success();
    assert!(fs::read_to_string(place.path("compared.html")).unwrap() == first);
    assert!(Path::new(&place.path("compared/compare.csv")).is_file());
}
