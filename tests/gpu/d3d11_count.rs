//! What is counted of the tessellator's patterns, on vertices and triangles that no pattern has:
//! turned round, of no area, equal but for one word, out of order along an edge.

use crate::random::Random;
use crate::support;
use crate::table::Quantity;
use std::collections::VecDeque;
use tessim::config::Config;
use tessim::gpu::{Kernel, Settings, VERTEX};

/// Words of a pattern, of which 8 to 13 are segments, and of a row of counts.
const PATTERN: usize = 16;
const SEGMENTS: usize = 8;
const ROW: usize = 30;

/// A patch: its vertices' words, its triangles, its segments.
struct Drawn {
    vertices: Vec<[u32; VERTEX]>,
    triangles: Vec<[u32; 3]>,
    segments: [u32; 6],
    components: u32,
    bytes: u32,
}

fn draw(random: &mut Random) -> Drawn {
    let segments = [(); 6].map(|()| random.integer(0, 9));
    let ring: u32 = segments[..4].iter().sum();
    let count = ring + random.integer(0, 6);
    let mut vertices: Vec<[u32; VERTEX]> = Vec::new();
    for _ in 0..count {
        let mut words = [(); VERTEX].map(|()| random.bits() as u32);
        // Few parameters, so that some are equal; negative differences need all 17 bits.
        for site in &mut words[8..] {
            *site = random.of([0, 1, 21845, 43691, 65535, 65536]);
        }
        if let Some(before) = vertices.last()
            && random.integer(0, 2) > 0
        {
            words[..8].copy_from_slice(&before[..8]);
            if random.bits() & 1 == 0 {
                words[random.integer(0, 7) as usize] ^= 1 << random.integer(0, 31);
            }
        }
        vertices.push(words);
    }
    let triangles = if count == 0 { 0 } else { random.integer(0, 30) };
    // Of one in three, neighbours: equal ones are neighbours.
    let triangles = (0..triangles).map(|_| {
        let first = random.integer(0, count - 1);
        let near = random.integer(0, 2) == 0;
        let mut corner = |k| if near { (first + k) % count } else { random.integer(0, count - 1) };
        let mut corners = [corner(0), corner(1), corner(2)];
        corners.rotate_left(random.integer(0, 2) as usize);
        corners
    });
    let triangles = triangles.collect();
    Drawn {
        vertices,
        triangles,
        segments,
        components: random.integer(0, 9),
        bytes: random.integer(0, 99),
    }
}

/// The row of a patch, of which no other words are written.
fn row(drawn: &Drawn, entries: u32, wave: u32, burst: u32) -> [u32; ROW] {
    let mut row = [0; ROW];
    let site = |k: u32, axis: usize| i64::from(drawn.vertices[k as usize][8 + axis]);
    for &[a, b, c] in &drawn.triangles {
        let across = |axis: usize, p: u32| site(p, axis) - site(a, axis);
        let twice = across(0, b) * across(1, c) - across(1, b) * across(0, c);
        row[17] += u32::from(twice < 0);
        row[18] += u32::from(twice == 0);
        let mut positions = [a, b, c].map(|k| &drawn.vertices[k as usize][..8]);
        positions.sort_unstable();
        row[19] += u32::from(positions.windows(2).any(|pair| pair[0] == pair[1]));
    }
    // Down U = 0, along V = 0, up U = 1, back along V = 1.
    let ring: u32 = drawn.segments[..4].iter().sum();
    let mut at = 0;
    for (side, &segments) in drawn.segments[..4].iter().enumerate() {
        for k in at..at + segments {
            let step = site((k + 1) % ring, 1 - side % 2) - site(k, 1 - side % 2);
            row[15] += u32::from([-1, 1, 1, -1][side] * step < 0);
        }
        at += segments;
    }
    row[28] = drawn.bytes;
    row[29] = drawn.bytes.div_ceil(burst);
    if drawn.vertices.is_empty() {
        return row;
    }
    let mut cache = VecDeque::new();
    let mut shaded = 0;
    for &point in drawn.triangles.as_flattened() {
        if !cache.contains(&point) {
            shaded += 1;
            cache.push_back(point);
            if cache.len() > entries as usize {
                cache.pop_front();
            }
        }
    }
    row[13] = drawn.segments.iter().map(|segments| segments + 1).sum();
    row[14] = drawn.vertices.len() as u32;
    row[16] = drawn.triangles.len() as u32;
    row[20] = shaded;
    row[21] = shaded.div_ceil(wave);
    row[24] = shaded * drawn.components;
    row[25] = drawn.components;
    row[26] = drawn.bytes;
    row[27] = drawn.bytes.div_ceil(burst);
    row
}

fn starts(counts: impl Iterator<Item = usize>) -> Vec<u32> {
    let mut sum = 0;
    let mut starts = vec![0];
    starts.extend(counts.map(|count| {
        sum += count as u32;
        sum
    }));
    starts
}

#[test]
fn odd_vertices_and_triangles_are_counted_alike() {
    let Some(device) = support::device() else { return };
    let mut ledger = support::ledger();
    let mut random = Random::new(1110);
    let mut sums = [0; ROW];
    for _ in 0..24 * support::effort() {
        let patches: Vec<Drawn> = (0..40).map(|_| draw(&mut random)).collect();
        // The range of patches that buffers have.
        let from = random.integer(0, 12) as usize;
        let range = from..random.integer(from as u32 + 1, 40) as usize;
        let inside = &patches[range.clone()];
        let points = starts(patches.iter().map(|drawn| drawn.vertices.len()));
        let triangles = starts(patches.iter().map(|drawn| drawn.triangles.len()));
        let mut settings =
            Settings::new(&Config::default(), &support::view(32), support::view(32).position);
        let [entries, wave] = [random.of([0, 1, 4, 7, u32::MAX]), random.of([1, 4, 32])];
        let burst = random.of([1, 16, 32, 64]);
        settings.own[3] = patches.len() as u32;
        settings.own[12..15].copy_from_slice(&[entries, wave, burst]);
        settings.own[15] = points[range.start];
        let upload = |words: Vec<u32>| device.upload(&words).unwrap();
        let vertices = upload(inside.iter().flat_map(|d| d.vertices.concat()).collect());
        let indices = upload(inside.iter().flat_map(|d| d.triangles.concat()).collect());
        let rows = device.empty(ROW * patches.len()).unwrap();
        let patterns = upload(patches.iter().flat_map(pattern).collect());
        let of_patch = upload(patches.iter().flat_map(|d| [d.components, d.bytes]).collect());
        let [first_point, end_point] = [points[range.start], points[range.end]];
        let [first, end] = [triangles[range.start], triangles[range.end]];
        let brought = device.empty((end_point - first_point) as usize).unwrap();
        let (points, triangles) = (upload(points), upload(triangles));
        let run = |entry, first: u32, items: u32, buffers: &[_]| {
            let settings = Settings { first, ..settings }.of(items as usize);
            device.run(Kernel::D3d11Count, entry, &settings, buffers).unwrap();
        };
        let buffers = [&triangles, &vertices, &indices, &rows, &points];
        run("triangles", first, end - first, &buffers);
        let buffers = [&points, &patterns, &vertices, &rows];
        run("edges", first_point, end_point - first_point, &buffers);
        let buffers = [&triangles, &patterns, &indices, &rows, &points, &brought, &of_patch];
        run("cache", range.start as u32, range.len() as u32, &buffers);
        let got = device.read(&rows, 0, ROW * patches.len()).unwrap();
        for (k, (drawn, got)) in patches.iter().zip(got.chunks(ROW)).enumerate() {
            let want = if range.contains(&k) { row(drawn, entries, wave, burst) } else { [0; ROW] };
            let place = || format!("patch {k} of {range:?}, {entries} entries");
            let inputs = || format!("{:?} {:?}", drawn.segments, drawn.triangles);
            ledger.compare(("d3d11", "row"), &want, got, place, inputs);
            sums.iter_mut().zip(want).for_each(|(sum, count)| *sum += count);
        }
    }
    // Out of order, turned round, of no area, with two equal positions.
    assert!([15, 17, 18, 19].iter().all(|&column| sums[column] > 500), "{sums:?}");
    support::settle(&ledger, Quantity::KernelLookedAt);
}

fn pattern(drawn: &Drawn) -> [u32; PATTERN] {
    let mut words = [0; PATTERN];
    words[SEGMENTS..SEGMENTS + 6].copy_from_slice(&drawn.segments);
    words
}
