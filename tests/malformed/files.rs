//! Traces whose points are in files: names that lead elsewhere, files that are missing, short or
//! wrong.

use super::{Case, check};
use std::path::Path;
use tempfile::TempDir;
use tessim::trace::command::Command;
use tessim::trace::read::Reader;

/// A folder with a trace's folder `inside`, and one point more than 16 in a file in each.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let inside = folder.path().join("inside");
    std::fs::create_dir(&inside).expect("a folder");
    let points: Vec<u8> = (0..17 * 3).flat_map(|i| (i as f32).to_le_bytes()).collect();
    for place in [folder.path(), &inside] {
        std::fs::write(place.join("p.f32"), &points).expect("a file");
    }
    folder
}

fn trace(fields: &str) -> String {
    format!("{{\"tessim\":1}}\n{{\"points\":{{\"id\":0,{fields}}}}}\n{{\"end\":{{}}}}\n")
}

fn refuse(name: &str, fields: &str, column: usize, wanted: &[&str]) {
    let folder = folder();
    let text = trace(fields);
    let inside = folder.path().join("inside");
    let error = Reader::new(text.as_bytes(), "bad", inside).find_map(Result::err);
    let case: Case<'_> = (name, text.as_bytes(), (2, column), wanted);
    check(&case, error);
}

#[test]
fn names() {
    let outside: &[&str] = &["points.file: found", "expected a path within the trace's folder"];
    let cases: &[(&str, &str, &[&str])] = &[
        ("missing file", "none.f32", &["points.file: found \"none.f32\"", "can be read"]),
        ("parent folder", "../p.f32", outside),
        ("parent in the middle", "a/../../p.f32", outside),
        ("absolute path", "/etc/hostname", outside),
        ("empty name", "", outside),
        ("folder", ".", &["points.file: found \".\"", "a regular file"]),
    ];
    for (name, file, wanted) in cases {
        refuse(name, &format!(r#""file":"{file}","layout":"xyz","count":1"#), 26, wanted);
    }
}

#[test]
fn sizes_and_fields() {
    let cases: &[(&str, &str, usize, &[&str])] = &[
        (
            "short file",
            r#""file":"p.f32","layout":"xyz","count":18"#,
            26,
            &["at least 216 bytes (18 points of 12 bytes)", "it has 204"],
        ),
        (
            "short for its layout",
            r#""file":"p.f32","layout":"xyzw","count":17"#,
            26,
            &["at least 272 bytes", "it has 204"],
        ),
        (
            "more bytes than there are",
            r#""file":"p.f32","layout":"xyz","count":18446744073709551615"#,
            26,
            &["more than 2^64 bytes", "it has 204"],
        ),
        ("no layout", r#""file":"p.f32","count":1"#, 11, &["`layout` is missing"]),
        ("no count", r#""file":"p.f32","layout":"xyz""#, 11, &["`count` is missing"]),
        (
            "count of 0",
            r#""file":"p.f32","layout":"xyz","count":0"#,
            57,
            &["points.count: found 0"],
        ),
        (
            "unknown layout",
            r#""file":"p.f32","layout":"xy","count":1"#,
            43,
            &["points.layout: found \"xy\"", "did you mean \"xyz\"?"],
        ),
        ("name of a wrong type", r#""file":7,"layout":"xyz","count":1"#, 26, &["file: found 7"]),
    ];
    for (name, fields, column, wanted) in cases {
        refuse(name, fields, *column, wanted);
    }
}

#[cfg(unix)]
#[test]
fn links_may_not_leave_the_folder() {
    let folder = folder();
    let inside = folder.path().join("inside");
    std::os::unix::fs::symlink("../p.f32", inside.join("out")).expect("a link");
    std::os::unix::fs::symlink("p.f32", inside.join("in")).expect("a link");
    let text = |name| trace(&format!(r#""file":"{name}","layout":"xyz","count":17"#));
    let read = |name| Reader::new(text(name).as_bytes(), "bad", &inside).find_map(Result::err);
    assert!(read("in").is_none());
    check(&("link", b"", (2, 26), &["points.file: found \"out\"", "symbolic link"]), read("out"));
}

fn points_of(folder: &Path, fields: &str) -> Result<Vec<[f32; 4]>, String> {
    let text = trace(fields);
    let mut reader = Reader::new(text.as_bytes(), "t", folder);
    let all: Vec<_> = reader.by_ref().collect::<Result<_, _>>().map_err(|e| e.to_string())?;
    assert_eq!(reader.data_files().count(), 1);
    let Command::Points(points) = &all[1].command else { panic!("{all:?}") };
    let mut out = Vec::new();
    let count = points.source.len() as usize;
    points.source.read(0, count, &mut out).map_err(|e| e.to_string())?;
    Ok(out)
}

#[test]
fn what_is_in_the_file() {
    let folder = folder();
    let layout = r#""file":"p.f32","layout":"xyz","count":17"#;
    let points = points_of(folder.path(), layout).expect("the file is good");
    assert_eq!((points.len(), points[16]), (17, [48.0, 49.0, 50.0, 1.0]));
    // Byte 12 is the weight of the first point, then 3; the file begins with 0 1 2 3.
    let path = folder.path().join("p.f32");
    let cases = [
        (f32::NAN, 20, "xyz", "byte 20: z of point 1: found NaN, expected a finite number"),
        (f32::INFINITY, 0, "xyz", "byte 0: x of point 0: found inf, expected a finite number"),
        (-1.0, 28, "xyzw", "byte 28: w of point 1: found -1, expected a weight above 0"),
        (0.0, 12, "xyzw", "byte 12: w of point 0: found 0, expected a weight above 0"),
    ];
    let good = std::fs::read(&path).expect("the file");
    for (number, byte, layout, wanted) in cases {
        let mut bad = good.clone();
        bad[byte..byte + 4].copy_from_slice(&number.to_le_bytes());
        std::fs::write(&path, bad).expect("the file");
        let fields = format!(r#""file":"p.f32","layout":"{layout}","count":12"#);
        let message = points_of(folder.path(), &fields).expect_err(wanted);
        assert_eq!(message, format!("{}: {wanted}", path.display()));
    }
}
