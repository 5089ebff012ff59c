//! Binary traces whose checksums are right and whose content is not: commands that no reader may
//! hand on, and files that do not hold together.

use std::collections::HashSet;
use std::sync::Arc;
use tessim::attribute::{Attribute, AttributeFormat, AttributeTable};
use tessim::error::{Error, Place};
use tessim::trace::binary::{CONTENT_BYTES_MAX, read, write};
use tessim::trace::command::{
    Attributes, Command, Draw, Frame, Header, IDENTITY, Points, Primitive, Range, Tessellation,
};
use tessim::trace::indices::{IndexFormat, Indices};
use tessim::trace::points::PointSource;

fn header() -> Command {
    Command::Header(Header::default())
}

fn frame() -> Frame {
    Frame {
        viewport: [640, 480],
        view: IDENTITY,
        projection: IDENTITY,
        depth: Default::default(),
        range: Range::default(),
    }
}

fn points(source: PointSource) -> Command {
    Command::Points(Points { id: 3, source: Arc::new(source), resident: false })
}

fn sixteen() -> Command {
    points(PointSource::Xyz(vec![[0.0; 3]; 16]))
}

fn table(layout: &[(&str, &str)], values: &[f32]) -> Command {
    let attribute = |(name, format): &(&str, &str)| Attribute {
        name: (*name).into(),
        format: AttributeFormat::named(format).expect("a format"),
    };
    let layout = layout.iter().map(attribute).collect();
    let table = Arc::new(AttributeTable { layout, values: values.to_vec() });
    Command::Attributes(Attributes { id: 5, table, resident: false })
}

fn patches(count: u64) -> Draw {
    Draw::new(Primitive::Patches { count }, 3)
}

fn indexed(points: Vec<[u32; 16]>, corners: Vec<[u32; 4]>, count: u64) -> Draw {
    let indices = Indices { format: IndexFormat::Uint16, points, corners };
    Draw { indices: Some(Arc::new(indices)), ..Draw::new(Primitive::Indexed { count }, 3) }
}

fn error(bytes: &[u8]) -> Option<Error> {
    read::Reader::new(bytes, "bad", ".").find_map(Result::err)
}

/// What the writer, which checks nothing, makes of commands.
fn blocks(commands: &[Command]) -> Vec<u8> {
    let mut writer = write::Writer::new(Vec::new()).expect("a compressor");
    for command in commands {
        writer.write(command).expect("memory takes all");
    }
    writer.into_inner()
}

#[track_caller]
fn check(name: &str, error: Option<Error>, byte: u64, wanted: &[&str]) {
    let Some(error) = error else { panic!("{name}: was accepted") };
    assert_eq!(error.exit_code(), 2, "{name}: {error}");
    let message = error.to_string();
    assert!(message.starts_with(&format!("bad: byte {byte}: ")), "{name}: {message}");
    assert!(matches!(error, Error::Input { place: Place::Byte(at), .. } if at == byte));
    for words in wanted {
        assert!(message.contains(words), "{name}: `{words}` is not in: {message}");
    }
    assert!(message.contains("found ") && message.contains("expected "), "{name}: {message}");
    assert!(message.chars().count() < 1000, "{name}: {} characters", message.len());
}

/// A name, the command after header, frame and sixteen points, and what the message says.
type Case<'a> = (&'a str, Command, &'a [&'a str]);

/// Each command is refused, in the block after the header's.
fn refuse(cases: Vec<Case<'_>>) {
    let names: HashSet<_> = cases.iter().map(|case| case.0).collect();
    assert_eq!(names.len(), cases.len(), "names are distinct");
    let second = second_block(&blocks(&[header()]));
    for (name, command, wanted) in cases {
        let before = [header(), Command::Frame(frame()), sixteen()];
        let all = [&before[..], &[command, Command::End]].concat();
        check(name, error(&blocks(&all)), second, wanted);
    }
}

/// Where the block after the header's begins.
fn second_block(bytes: &[u8]) -> u64 {
    36 + u64::from(u32::from_le_bytes(bytes[24..28].try_into().expect("four bytes")))
}

#[test]
fn frames_points_and_state() {
    let singular = [0.0; 16];
    let mut unbounded = IDENTITY;
    unbounded[3] = f32::INFINITY;
    let range = Range { clip: Some(65), object: None };
    let state = Tessellation::default();
    let low = Tessellation { min_level: 0, ..state };
    let crossed = Tessellation { min_level: 3 << 16, max_level: 2 << 16, ..state };
    let flat = rtl_model::level::Criterion::Flatness { pixels: 0 };
    let still = Tessellation { criterion: flat, ..state };
    refuse(vec![
        (
            "no viewport",
            Command::Frame(Frame { viewport: [0, 1], ..frame() }),
            &["viewport: found 0"],
        ),
        (
            "singular",
            Command::Frame(Frame { view: singular, ..frame() }),
            &["view: found a singular"],
        ),
        (
            "infinite",
            Command::Frame(Frame { projection: unbounded, ..frame() }),
            &["projection: found inf as number 3"],
        ),
        ("range", Command::Frame(Frame { range, ..frame() }), &["range: found 2^65"]),
        ("no points", points(PointSource::Xyz(Vec::new())), &["points: found none"]),
        ("NaN", points(PointSource::Xyz(vec![[0.0, f32::NAN, 0.0]])), &["found NaN as number 1"]),
        (
            "weight",
            points(PointSource::Xyzw(vec![[0.0, 0.0, 0.0, -0.0]])),
            &["found the weight -0 of point 0"],
        ),
        ("level", Command::Tessellation(low), &["tessellation: found levels from 0 to 64"]),
        ("levels", Command::Tessellation(crossed), &["found levels from 3 to 2"]),
        ("pixels", Command::Tessellation(still), &["pixels: found 0"]),
        ("second header", header(), &["found header, expected it first and only there"]),
    ]);
}

#[test]
fn attributes() {
    let many: Vec<String> = (0..17).map(|k| format!("a{k}")).collect();
    let many: Vec<(&str, &str)> = many.iter().map(|name| (&**name, "float32x4")).collect();
    refuse(vec![
        ("no layout", table(&[("a", "unorm8")], &[]), &["values: found 0, expected 1"]),
        ("name", table(&[("9", "unorm8")], &[0.0]), &["layout: found the name \"9\""]),
        ("twice", table(&[("a", "unorm8"), ("a", "unorm8")], &[0.0, 0.0]), &["that no other"]),
        ("row", table(&[("a", "unorm8x2")], &[0.0; 3]), &["values: found 3, expected 2"]),
        ("between", table(&[("a", "unorm8")], &[0.5]), &["found 0.5 in corner 0", "of unorm8"]),
        ("beyond", table(&[("a", "snorm8")], &[-1.5]), &["found -1.5 in corner 0"]),
        ("not a number", table(&[("a", "float32")], &[f32::NAN]), &["found NaN in corner 0"]),
        ("components", table(&many, &[0.0; 68]), &["layout: found 68 components"]),
    ]);
}

#[test]
fn draws() {
    let mut infinite = IDENTITY;
    infinite[0] = f32::NEG_INFINITY;
    let models = |models, models_sent| Draw { models, models_sent, ..patches(1) };
    let row = vec![[15; 16]];
    let cases: Vec<(&str, Draw, &[&str])> = vec![
        ("none", patches(0), &["expected 1 to 16777216 patches"]),
        ("many", patches(u64::MAX), &["found 18446744073709551615 rows"]),
        (
            "mesh",
            Draw::new(Primitive::Mesh { rows: u32::MAX, columns: u32::MAX }, 3),
            &["found 4294967295 rows of 4294967295"],
        ),
        ("unknown points", Draw { points: 4, ..patches(1) }, &["points: found 4, expected the id"]),
        ("few points", patches(2), &["found 16 points under id 3, expected at least 32"]),
        ("first", Draw { first: u64::MAX, ..patches(1) }, &["expected at least 16 from point"]),
        ("attributes", Draw { attributes: Some(3), ..patches(1) }, &["id of attributes (none"]),
        ("no model", models(vec![], true), &["model: found none"]),
        ("model", models(vec![infinite], true), &["model: found -inf as number 0"]),
        ("index", indexed(vec![[16; 16]], vec![], 1), &["found 16 points", "for the index 16"]),
        ("wide index", indexed(vec![[65536; 16]], vec![], 1), &["at most 65535, as uint16 has"]),
        ("rows", indexed(row.clone(), vec![], 2), &["indices: found those of 1 patches"]),
        ("corners", indexed(row.clone(), vec![[0; 4]], 1), &["attribute_indices: found some"]),
        (
            "indices elsewhere",
            Draw { primitive: Primitive::Patches { count: 1 }, ..indexed(row, vec![], 1) },
            &["indices: found some, expected none"],
        ),
    ];
    let draw = |(name, draw, wanted)| (name, Command::Draw(draw), wanted);
    refuse(cases.into_iter().map(draw).collect());
}

#[test]
fn the_order_of_commands() {
    let second = second_block(&blocks(&[header()]));
    let early = blocks(&[header(), sixteen(), Command::Draw(patches(1)), Command::End]);
    check("no frame", error(&early), second, &["found a draw before any frame"]);
    let bare = blocks(&[sixteen(), Command::End]);
    check("no header", error(&bare), 8, &["found points, expected the header first"]);
    let mut open = blocks(&[header(), Command::End]);
    // The end's block left out: the trailer stands where it begins.
    open.drain(second as usize..open.len() - 56);
    check("no end", error(&open), second, &["found the trailer before the end, expected commands"]);
    let content = |bytes: &[u8]| write::file_of(bytes).expect("a compressor");
    let twice = [b"\0\0\0\0".as_slice(), &[6, 6]].concat();
    check("two ends", error(&content(&twice)), 8, &["found more in this block after the end"]);
    check(
        "no command",
        error(&content(&[0, 0, 0, 0, 7])),
        8,
        &["at 4", "bytes that are no command"],
    );
    check("cut short", error(&content(&[0, 9, b'x'])), 8, &["at 0", "bytes that are no command"]);
    check("not UTF-8", error(&content(&[0, 1, 0xff, 0, 0])), 8, &["bytes that are no command"]);
}

/// A file with one block of commands at byte 8, its head and payload as told.
fn block(kind: u32, at: u64, content: u32, payload: &[u8], stated: u32) -> Vec<u8> {
    let mut head = Vec::new();
    head.extend(kind.to_le_bytes());
    head.extend(at.to_le_bytes());
    for word in [content, stated, crc32fast::hash(payload)] {
        head.extend(word.to_le_bytes());
    }
    let sum = crc32fast::hash(&head);
    [b"tessim\0\x01", &head[..], &sum.to_le_bytes(), payload].concat()
}

#[test]
fn blocks_that_do_not_hold_together() {
    let zeros = vec![0; 300 << 20];
    let bomb = zstd::bulk::compress(&zeros, 1).expect("a compressor");
    drop(zeros);
    let good = zstd::bulk::compress(b"\0\0\0\0\x06", 3).expect("a compressor");
    let (size, long) = (good.len() as u32, bomb.len() as u32);
    let absurd = CONTENT_BYTES_MAX as u32 + 1;
    let cases: &[(&str, Vec<u8>, &[&str])] = &[
        ("kind", block(9, 8, 5, &good, size), &["found a block of kind 9"]),
        ("elsewhere", block(1, 9, 5, &good, size), &["found the block of byte 9"]),
        ("empty", block(1, 8, 0, &good, size), &["found a content of 0 bytes"]),
        ("absurd content", block(1, 8, absurd, &good, size), &["expected 1 to 135266304"]),
        ("absurd payload", block(1, 8, 5, &good, u32::MAX), &["a payload of 4294967295 bytes"]),
        ("long index", block(2, 8, 1 << 21, &good, size), &["expected 1 to 1048576"]),
        ("bomb", block(1, 8, 1 << 20, &bomb, long), &["states the size 314572800"]),
        ("not zstd", block(1, 8, 5, b"not zstd", 8), &["states the size none"]),
        ("another size", block(1, 8, 6, &good, size), &["states the size 5, expected 6"]),
        ("an index first", block(2, 8, 5, &good, size), &["found an index before the end"]),
    ];
    for (name, bytes, wanted) in cases {
        check(name, error(bytes), 8, wanted);
    }
    let version = [b"tessim\0\x02".as_slice(), &cases[0].1[8..]].concat();
    check("version", error(&version), 7, &["found version 2, expected 1"]);
    // The stated size is right, and the payload goes on: two zstd frames, or a broken one.
    let two = [&good[..], &good[..]].concat();
    check("two frames", error(&block(1, 8, 5, &two, 2 * size)), 8, &["zstd refuses"]);
    let mut broken = good.clone();
    broken.truncate(good.len() - 2);
    check("broken frame", error(&block(1, 8, 5, &broken, size - 2)), 8, &["zstd refuses"]);
}

#[test]
fn files_of_points() {
    // The name "../p" with layout xyz and count 1; then a file that is not there.
    for (name, wanted) in [("../p", "a path within the trace's folder"), ("none", "can be read")] {
        let mut content = vec![0, 0, 0, 0, 2, 3, 0, 2, 4];
        content.extend(name.as_bytes());
        content.extend([0, 1, 6]);
        let bytes = write::file_of(&content).expect("a compressor");
        let folder = tempfile::tempdir().expect("a folder");
        let error = read::Reader::new(&bytes[..], "bad", folder.path()).find_map(Result::err);
        let found = format!("points.file: found {name:?}");
        check(name, error, 8, &[&found, wanted]);
    }
}
