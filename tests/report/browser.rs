//! The page's script at work: a copy of the page with a driver behind it, in headless Chromium,
//! which prints what has become of the document.

use super::{Place, many_frames, teapot, values};
use std::fs;
use std::process::Command;

/// Clicks, types, and writes what it sees into the document.
const DRIVER: &str = r##"<script>
const seen = {};
const section = document.querySelector(".numbers");
const rows = () => Array.from(section.querySelectorAll("tbody tr")).filter((row) => !row.hidden);
const column = (k) => rows().map((row) => row.cells[k].textContent).join(" ");
const type = (selector, change) => {
    const input = section.querySelector(selector);
    change(input);
    input.dispatchEvent(new Event("input"));
};
seen.shown = rows().length;
type(".hide", (input) => { input.checked = false; });
seen.all = rows().length;
const heads = section.querySelectorAll("th");
heads[2].click();
seen.up = column(2);
heads[2].click();
seen.down = column(2);
heads[0].click();
seen.names = column(0);
type(".filter", (input) => { input.value = "EMIT. triangles"; });
seen.filtered = column(0);
seen.count = section.querySelector(".count").textContent;
type(".filter", (input) => { input.value = ""; });
const plot = document.querySelector(".frames");
seen.lines = plot ? plot.querySelectorAll("polyline").length : 0;
if (plot) {
    const select = plot.querySelector("select");
    const found = Array.from(select.options).find((option) => option.text === "emit.vertices");
    select.value = found.value;
    select.dispatchEvent(new Event("input"));
    seen.title = plot.querySelector("svg title").textContent;
    seen.points = plot.querySelector("polyline").getAttribute("points").split(" ").length;
}
seen.errors = errors.join("; ");
for (const key in seen) document.body.setAttribute("data-seen-" + key, seen[key]);
</script>"##;

/// What Chromium makes of a page, if `TESSIM_BROWSER` asks for it.
fn driven(place: &Place, page: &str) -> Option<String> {
    if std::env::var_os("TESSIM_BROWSER").is_none() {
        println!(
            "the page in a browser: only with TESSIM_BROWSER, which tests/all.sh --browser sets"
        );
        return None;
    }
    let browser = std::env::var("CHROMIUM").unwrap_or_else(|_| "chromium".to_owned());
    // What goes wrong in the page's own script is caught, too.
    let watch = "<head><script>const errors = []; \
                 window.onerror = (message) => { errors.push(message); };</script>";
    let page =
        page.replacen("<head>", watch, 1).replacen("</body>", &format!("{DRIVER}</body>"), 1);
    fs::write(place.path("driven.html"), page).unwrap();
    let mut command = Command::new(browser);
    command.args(["--headless", "--no-sandbox", "--disable-gpu", "--dump-dom"]);
    command.arg(format!("--user-data-dir={}", place.path("profile").display()));
    command.arg(format!("file://{}", place.path("driven.html").display()));
    let output = match command.output() {
        Ok(output) => output,
        Err(reason) => {
            println!("SKIPPED the page in a browser: no chromium: {reason}");
            return None;
        }
    };
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Some(String::from_utf8(output.stdout).unwrap())
}

/// What the driver saw under this name.
#[track_caller]
fn seen<'a>(dom: &'a str, key: &str) -> &'a str {
    let before = format!("data-seen-{key}=\"");
    let at = dom.find(&before).unwrap_or_else(|| panic!("no {key}")) + before.len();
    dom[at..].split('"').next().unwrap()
}

#[test]
fn tables_sort_as_numbers_and_filter_and_frames_are_drawn() {
    let place = Place::new();
    let zoom = teapot().replace("teapot", "zoom");
    let quick = ["--engine", "none", "--samples", "0", "--set", "level.pixels=16"];
    let units = ["--units", "hybrid,d3d11", "--out", "compared"];
    place.run(&[&["compare", &zoom][..], &quick, &units].concat());
    let page = place.page("compared");
    let Some(dom) = driven(&place, &page) else { return };
    assert_eq!(seen(&dom, "errors"), "");
    let all: usize = seen(&dom, "all").parse().unwrap();
    let zeros = page.matches("<tr class=\"zero\">").count();
    assert!(zeros > 0);
    assert_eq!(seen(&dom, "shown").parse::<usize>().unwrap() + zeros, all);
    assert_eq!(all, page.matches("<dt id=\"number-").count());
    let numbers = |key| -> Vec<f64> {
        seen(&dom, key).split_whitespace().map(|cell| cell.parse().unwrap()).collect()
    };
    let (up, down) = (numbers("up"), numbers("down"));
    assert!(up.len() > 100 && up.is_sorted(), "{up:?}");
    assert!(down.len() == up.len() && down.is_sorted_by(|a, b| a >= b), "{down:?}");
    // As text, 10 comes before 9.
    assert!(!seen(&dom, "up").split_whitespace().is_sorted());
    let names: Vec<_> = seen(&dom, "names").split_whitespace().collect();
    assert!(names.len() == all && names.is_sorted(), "{names:?}");
    let filtered: Vec<_> = seen(&dom, "filtered").split_whitespace().collect();
    let wanted = names.iter().filter(|n| n.contains("emit.") && n.contains("triangles"));
    assert_eq!(filtered, wanted.copied().collect::<Vec<_>>());
    assert!(!filtered.is_empty());
    assert_eq!(seen(&dom, "count"), format!("{} of {all} rows", filtered.len()));
    assert_eq!(seen(&dom, "lines"), "2", "a line a unit");
    assert_eq!(seen(&dom, "title"), "emit.vertices");
    let csv = fs::read_to_string(place.path("compared/frames.csv")).unwrap();
    let frames = csv.lines().filter(|l| l.starts_with("hybrid,") && l.contains(",emit,vertices,"));
    assert_eq!(seen(&dom, "points"), frames.count().to_string());
    assert!(values(&dom, "<option value=\"").count() > 50);
}

#[test]
fn many_frames_are_drawn() {
    let place = Place::new();
    many_frames(&place, 6, 1);
    let page = place.page("compared").replace("emit.n0", "emit.vertices");
    let Some(dom) = driven(&place, &page) else { return };
    assert_eq!(seen(&dom, "errors"), "");
    assert_eq!((seen(&dom, "lines"), seen(&dom, "points")), ("6", "30000"));
}
