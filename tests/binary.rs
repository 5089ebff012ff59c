//! The binary form of a trace: damage anywhere is found and located, one frame is found without
//! reading the others, and what was written once stays readable.

#[path = "support/commands.rs"]
#[allow(dead_code, reason = "other tests use the rest")]
mod commands;

use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::TestRunner;
use rtl_model::counter::Counter;
use rtl_model::level::Criterion;
use rtl_model::patch::Level;
use std::cell::Cell;
use std::io::{self, Cursor, Read, Seek, SeekFrom};
use std::path::Path;
use std::sync::Arc;
use tessim::config::{Config, Unit};
use tessim::error::{Error, Place, Result};
use tessim::report::Report;
use tessim::sink::NoMesh;
use tessim::trace::command::{Command, Draw, Header, Points, Primitive, Tessellation};
use tessim::trace::open::Trace;
use tessim::trace::points::PointSource;
use tessim::trace::read::Located;
use tessim::trace::scene::teacups::Teacups;
use tessim::trace::{binary, read};
use tessim::unit::simulate;

fn blocks(commands: &[Command]) -> Vec<u8> {
    let mut writer = binary::write::Writer::new(Vec::new()).expect("a compressor");
    for command in commands {
        writer.write(command).expect("memory takes all");
    }
    writer.into_inner()
}

fn read(bytes: &[u8]) -> Result<Vec<Command>> {
    let located = binary::read::Reader::new(bytes, "t.tsb", ".");
    located.map(|located| located.map(|located| located.command)).collect()
}

/// A trace with a command of every kind: several random ones, one after the other.
fn every_kind() -> Vec<Command> {
    let mut runner = TestRunner::deterministic();
    let mut all: Vec<Command> = Vec::new();
    let mut primitives = std::collections::HashSet::new();
    while primitives.len() < 5 {
        let tree = commands::trace().new_tree(&mut runner).expect("a trace");
        for command in tree.current() {
            match &command {
                Command::Header(_) if !all.is_empty() => continue,
                Command::End => continue,
                Command::Draw(draw) => {
                    primitives.insert(std::mem::discriminant(&draw.primitive));
                }
                _ => {}
            }
            all.push(command);
        }
    }
    all.push(Command::End);
    all
}

/// Where the blocks of a file and its trailer begin; the last is where it ends.
fn parts(bytes: &[u8]) -> Vec<u64> {
    let mut parts = vec![0, 8];
    let mut at = 8;
    while bytes[at] != 3 {
        let size = u32::from_le_bytes(bytes[at + 16..at + 20].try_into().expect("four bytes"));
        at += 28 + size as usize;
        parts.push(at as u64);
    }
    assert_eq!(bytes.len(), at + 56);
    parts.push(bytes.len() as u64);
    parts
}

fn place(error: &Error) -> u64 {
    match error {
        Error::Input { place: Place::Byte(byte), message, .. } => {
            assert!(message.contains("found ") && message.contains("expected "), "{error}");
            assert_eq!(error.exit_code(), 2, "{error}");
            *byte
        }
        other => panic!("no byte: {other}"),
    }
}

#[test]
fn every_flipped_bit_is_found_in_its_block() {
    let good = blocks(&every_kind());
    let parts = parts(&good);
    assert!(parts.len() >= 6, "preamble, header, commands, index, trailer");
    let mut flips = 0;
    let mut bytes = good.clone();
    for byte in 0..good.len() {
        for bit in 0..8 {
            bytes[byte] ^= 1 << bit;
            let error = read(&bytes).map(drop).expect_err("a flipped bit");
            let found = place(&error);
            let part = parts.iter().rposition(|start| *start <= byte as u64).expect("the first");
            // A damaged size is found before it is used, a damaged kind may make a trailer of a
            // block; either way it is the damaged part that is named.
            assert!((parts[part]..parts[part + 1]).contains(&found), "{byte}.{bit}: {error}");
            // It is still taken for what it is, by all ways to open it.
            assert!(binary::is_binary(&bytes));
            bytes[byte] ^= 1 << bit;
            flips += 1;
        }
    }
    assert!(flips == 8 * good.len() && flips > 10_000, "{flips}");
    assert!(read(&bytes).is_ok());
}

#[test]
fn every_truncation_is_found_where_it_is() {
    let good = blocks(&every_kind());
    for length in 0..good.len() {
        let error = read(&good[..length]).map(drop).expect_err("a truncated trace");
        assert_eq!(place(&error), length as u64, "{error}");
        assert!(error.to_string().contains("the trace is truncated: found the end of the file"));
        let seeking = binary::seek::FrameReader::new(Cursor::new(&good[..length]), "t", ".", 0);
        place(&seeking.err().expect("a truncated trace"));
    }
}

#[test]
fn blocks_can_be_neither_moved_nor_left_out_nor_added() {
    let good = blocks(&long());
    let parts: Vec<usize> = parts(&good).into_iter().map(|byte| byte as usize).collect();
    assert!(parts.len() > 8, "{}", parts.len());
    let block = |k: usize| &good[parts[k]..parts[k + 1]];
    let whole =
        |order: &[usize]| -> Vec<u8> { order.iter().flat_map(|k| block(*k)).copied().collect() };
    let order: Vec<usize> = (0..parts.len() - 1).collect();
    assert_eq!(whole(&order), good);
    for (name, at) in [("left out", 3), ("twice", 3), ("swapped", 3), ("index left out", 0)] {
        let mut order = order.clone();
        match name {
            "left out" => drop(order.remove(at)),
            "twice" => order.insert(at, at),
            "swapped" => order.swap(at, at + 1),
            _ => drop(order.remove(order.len() - 2)),
        }
        let error = read(&whole(&order)).map(drop).expect_err(name);
        assert!(place(&error) > 8, "{name}: {error}");
    }
    let more = [&good[..], &[0]].concat();
    let error = read(&more).map(drop).expect_err("a byte too many");
    assert_eq!(place(&error), good.len() as u64);
}

/// A trace of many frames, with points that are defined before the first and used in the last only,
/// points of each frame's own, and changes of state that outlive their frame.
fn long() -> Vec<Command> {
    let mut text = Vec::new();
    let criterion = Criterion::Fixed { level: Level::TWO };
    let tessellation = Tessellation { criterion, ..Tessellation::default() };
    Teacups { count: 2, frames: 3, tessellation }.write(&mut text).expect("memory takes all");
    let teacups = read::Reader::new(&text[..], "teacups", ".");
    let teacups: Vec<Command> = teacups.map(|c| c.expect("a scene").command).collect();
    let frame = teacups.iter().find(|c| matches!(c, Command::Frame(_))).expect("a frame");
    let cloud = |id: u32, seed: u32| {
        let number = |i: u32| {
            let hash = (seed + i).wrapping_mul(0x9e37_79b9) ^ i.wrapping_mul(0x85eb_ca6b);
            (hash >> 8) as f32 / 16777216.0
        };
        let point = |i: u32| [number(3 * i), number(3 * i + 1), number(3 * i + 2)];
        let source = Arc::new(PointSource::Xyz((0..4096).map(point).collect()));
        Command::Points(Points { id, source, resident: id == 7 })
    };
    let draw = |points, count| {
        Command::Draw(Draw { cull: false, ..Draw::new(Primitive::Patches { count }, points) })
    };
    let mut all = teacups[..teacups.len() - 1].to_vec();
    all.insert(1, cloud(7, 1));
    for k in 0..40 {
        all.extend([frame.clone(), cloud(9, 100 * k), cloud(9, 100 * k + 1), draw(9, 2)]);
        if k % 8 == 0 {
            all.push(Command::Tessellation(Tessellation {
                max_level: (k + 1) << 16,
                ..tessellation
            }));
        }
    }
    all.extend([frame.clone(), draw(7, 3), draw(9, 1), Command::End]);
    all
}

/// An input that counts the bytes that are read from it.
struct Counted<'a> {
    input: Cursor<&'a [u8]>,
    bytes: &'a Cell<usize>,
}

impl Read for Counted<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let read = self.input.read(buffer)?;
        self.bytes.set(self.bytes.get() + read);
        Ok(read)
    }
}

impl Seek for Counted<'_> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.input.seek(to)
    }
}

fn run(located: impl Iterator<Item = Result<Located>>, unit: Unit) -> Report {
    let commands = located.map(|located| Ok(located?.command));
    let config = Config { unit, ..Config::default() };
    simulate(commands, &config, &mut NoMesh).expect("the trace runs")
}

#[test]
fn one_frame_runs_the_same_from_either_form_and_reads_little() {
    let commands = long();
    let bytes = blocks(&commands);
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("t.jsonl");
    let mut text = tessim::trace::write::Writer::new(Vec::new());
    commands.iter().for_each(|command| text.write(command).expect("memory takes all"));
    std::fs::write(&path, text.into_inner()).expect("a file");
    let frames = commands.iter().filter(|c| matches!(c, Command::Frame(_))).count();
    assert_eq!(frames, 44);
    let whole = run(Trace::open(&path).expect("a file"), Unit::Hybrid);
    for frame in 0..frames {
        let read = Cell::new(0);
        let input = Counted { input: Cursor::new(&bytes), bytes: &read };
        let located = binary::seek::FrameReader::new(input, "t.tsb", ".", frame as u64);
        let binary = run(located.expect("there is such a frame"), Unit::Hybrid);
        let picked = run(Trace::open_frame(&path, frame as u64).expect("a file"), Unit::Hybrid);
        assert_eq!(binary.frames.len(), 1);
        let rows = |report: &Report| report.rows(&report.frames[0]);
        assert_eq!(rows(&binary), rows(&picked), "frame {frame}");
        // Beside what was defined before it, the frame is what it is in the whole.
        for counter in [Counter::EmitTriangles, Counter::TraceDraws, Counter::AssemblePatches] {
            let alone = binary.frames[0].counters.get(counter);
            assert_eq!(alone, whole.frames[frame].counters.get(counter), "frame {frame}");
        }
        let share = read.get() * 100 / bytes.len();
        assert!(share <= 12, "frame {frame}: {} of {} bytes", read.get(), bytes.len());
    }
}

#[test]
fn a_lie_of_the_index_is_found_by_whoever_reads_it() {
    let commands = long();
    let good = blocks(&commands);
    let parts = parts(&good);
    let index = parts[parts.len() - 3] as usize;
    // The index of another trace, in which the frames begin elsewhere, with right checksums.
    let mut shorter = commands.clone();
    shorter.remove(2);
    let other = blocks(&shorter);
    let other_parts = self::parts(&other);
    let foreign = &other[other_parts[other_parts.len() - 3] as usize..other.len() - 56];
    let mut bytes = good[..index].to_vec();
    let mut block = foreign.to_vec();
    block[4..12].copy_from_slice(&(index as u64).to_le_bytes());
    let sum = crc32fast::hash(&block[..24]);
    block[24..28].copy_from_slice(&sum.to_le_bytes());
    bytes.extend(block);
    let mut trailer = good[good.len() - 56..].to_vec();
    use sha2::Digest;
    trailer[4..36].copy_from_slice(&sha2::Sha256::digest(&bytes));
    let sum = crc32fast::hash(&trailer[..52]);
    trailer[52..].copy_from_slice(&sum.to_le_bytes());
    bytes.extend(trailer);
    let error = read(&bytes).map(drop).expect_err("a lie");
    assert!(error.to_string().contains("an index that is not the one of the commands"));
    assert_eq!(place(&error), index as u64);
    let lied = (0..44).filter(|frame| {
        let reader = binary::seek::FrameReader::new(Cursor::new(&bytes), "t", ".", *frame);
        reader.expect("an index").any(|located| located.is_err())
    });
    assert!(lied.count() > 30, "a place that holds something else is refused");
}

#[test]
fn a_long_command_has_a_block_of_its_own_up_to_the_limit() {
    let points = |count: usize| {
        let source = Arc::new(PointSource::Xyzw(vec![[0.0, 0.5, -0.0, 1.0]; count]));
        Command::Points(Points { id: 0, source, resident: false })
    };
    let header = Command::Header(Header::default());
    let most = (binary::CONTENT_BYTES_MAX - 64) / 16;
    // More than any line of text can say: "[0,0,0,1]," has ten bytes.
    assert!(most > (64 << 20) / 10);
    let commands = [header.clone(), points(most), points(1), Command::End];
    let bytes = blocks(&commands);
    assert!(bytes.len() < 100_000, "{}", bytes.len());
    assert_eq!(read(&bytes).expect("it is within the limit"), commands);
    let mut writer = binary::write::Writer::new(Vec::new()).expect("a compressor");
    writer.write(&header).expect("memory takes all");
    let error = writer.write(&points(most + 8)).expect_err("beyond the limit");
    assert_eq!(error.kind(), io::ErrorKind::InvalidInput);
}

/// A trace with every kind of command and of what it may hold, short enough to be looked at.
fn small() -> Vec<Command> {
    let identity = "[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]";
    let draw = |fields: &str| format!("{{\"draw\":{{\"primitive\":{fields}}}}}\n");
    let points = "[1,-0,1e-45],".repeat(27) + "[0.1,2,3]";
    let text = [
        "{\"tessim\":1,\"title\":\"t\",\"source\":\"s\",\"licence\":\"ä\"}\n".to_owned(),
        format!("{{\"points\":{{\"id\":300,\"xyz\":[{points}]}}}}\n"),
        "{\"points\":{\"id\":1,\"resident\":true,\"xyzw\":[[1,2,3,0.5]]}}\n".to_owned(),
        "{\"attributes\":{\"id\":2,\"layout\":[{\"name\":\"c\",\"format\":\"unorm8\"},\
         {\"name\":\"uv\",\"format\":\"float16x2\"}],\
         \"values\":[[0,1,2],[1,3,4],[1,5,6],[1,7,8]]}}\n"
            .to_owned(),
        format!(
            "{{\"frame\":{{\"viewport\":[640,480],\"view\":{identity},\"projection\":{identity},\
             \"depth\":\"minus_one_to_one\",\"range\":{{\"clip\":16,\"object\":0.25}}}}}}\n"
        ),
        "{\"tessellation\":{\"criterion\":\"edge_length\",\"pixels\":2}}\n".to_owned(),
        draw("\"patches\",\"points\":300,\"count\":1,\"attributes\":2"),
        draw(&format!("\"mesh\",\"points\":300,\"rows\":1,\"columns\":1,\"model\":{identity}")),
        "{\"tessellation\":{\"criterion\":\"fixed\",\"level\":2.5}}\n".to_owned(),
        draw("\"strip\",\"points\":300,\"count\":2,\"front\":\"reversed\""),
        format!(
            "{{\"frame\":{{\"viewport\":[1,1],\"view\":{identity},\
             \"projection\":{identity}}}}}\n"
        ),
        draw("\"fan\",\"points\":300,\"count\":1,\"cull\":false,\"first\":9"),
        draw("\"fan\",\"points\":300,\"count\":1,\"encoding\":\"full\""),
        "{\"tessellation\":{\"criterion\":\"flatness\",\"pixels\":0.5,\"max_level\":3}}\n"
            .to_owned(),
        draw(
            "\"indexed_mesh\",\"points\":300,\"attributes\":2,\
             \"indices\":[[0,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15]],\
             \"attribute_indices\":[[3,2,1,0]],\"index_format\":\"uint32\"",
        ),
        "{\"end\":{}}\n".to_owned(),
    ];
    let text = text.concat();
    let commands = read::Reader::new(text.as_bytes(), "small", ".");
    commands.map(|c| c.expect("it is well-formed").command).collect()
}

/// What the blocks of commands hold, one after the other.
fn content(bytes: &[u8]) -> Vec<u8> {
    let parts = parts(bytes);
    let starts = parts.iter().map(|at| *at as usize);
    let blocks = starts.filter(|at| bytes.get(*at) == Some(&1));
    let size = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().expect("four bytes"));
    let payload = |at: usize| &bytes[at + 28..at + 28 + size(at + 16) as usize];
    blocks.flat_map(|at| zstd::decode_all(payload(at)).expect("a frame of zstd")).collect()
}

/// The format does not change unless its version does: what was written before is read, and what is
/// written now has the same content. (What zstd makes of it may change with zstd.)
#[test]
fn the_format_is_what_it_was() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/vectors/binary_trace.txt");
    let commands = small();
    let file = blocks(&commands);
    let now = format!("{}\n{}\n", hex::encode(content(&file)), hex::encode(&file));
    if std::env::var_os("UPDATE_EXPECT").is_some_and(|v| v == "1") {
        std::fs::write(&path, &now).expect("the vector can be written");
    }
    let golden = std::fs::read_to_string(&path).expect("the vector");
    let lines: Vec<Vec<u8>> =
        golden.lines().map(|line| hex::decode(line).expect("hexadecimal")).collect();
    assert_eq!(lines.len(), 2);
    assert_eq!(hex::encode(content(&file)), hex::encode(&lines[0]));
    let before = read(&lines[1]).expect("it was well-formed");
    assert_eq!(format!("{before:?}"), format!("{commands:?}"));
}
