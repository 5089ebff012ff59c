//! `mesh.svg`: the wireframe of the projected frame.
//!
//! Screen positions come in as the unit made them, sub-pixel integers, and go out as they are,
//! scaled by a transform: the picture shows the hardware's own rounding. Each distinct edge of a
//! patch is drawn once. Edges of back-facing triangles only are light and lie behind all others;
//! hidden parts are not removed. Triangles with a vertex that was not divided have no place on the
//! screen: they are left out and counted in a comment.

use super::edges::{self, FRONT};
use super::file::{AtomicFile, spool, unspool};
use crate::error::{Error, Result};
use crate::sink::{FrameInfo, PatchMesh};
use rtl_model::emit::Screen;
use rtl_model::patch::Triangle;
use std::fmt::Write as _;
use std::fs::File;
use std::io::{BufWriter, Write};

/// A picture under construction.
#[derive(Debug)]
pub struct Svg {
    out: AtomicFile,
    title: String,
    subpixel_bits: u32,
    viewport: [u32; 2],
    back: BufWriter<File>,
    front: BufWriter<File>,
    undivided: u64,
}

impl Svg {
    /// Begins a picture called `title`, of screen positions with `subpixel_bits` fraction bits.
    ///
    /// # Errors
    /// [`Error::System`] when it cannot be written there.
    pub fn create(out: AtomicFile, title: &str, subpixel_bits: u32) -> Result<Self> {
        let (back, front) = (spool(out.path())?, spool(out.path())?);
        let title = escaped(title);
        Ok(Self { out, title, subpixel_bits, viewport: [1, 1], back, front, undivided: 0 })
    }

    /// Takes the size of the picture.
    pub fn frame(&mut self, frame: &FrameInfo) {
        self.viewport = frame.view.viewport;
    }

    /// Appends a patch.
    ///
    /// # Errors
    /// [`Error::System`] when it cannot be written.
    pub fn patch(&mut self, frame: &FrameInfo, mesh: &PatchMesh<'_>) -> Result<()> {
        let facing = if mesh.reversed { -frame.view.facing } else { frame.view.facing };
        let side = |triangle: &Triangle| faces_front(mesh.screen, triangle, facing);
        self.undivided += mesh.triangles.iter().filter(|t| side(t).is_none()).count() as u64;
        let edges = edges::distinct(mesh.triangles, side);
        let drawn = |front: bool| {
            let of_side = edges.iter().filter(|(_, sides)| (sides & FRONT != 0) == front);
            path(&of_side.map(|(edge, _)| *edge).collect::<Vec<_>>(), mesh.screen)
        };
        self.back
            .write_all(drawn(false).as_bytes())
            .and_then(|()| self.front.write_all(drawn(true).as_bytes()))
            .map_err(|error| Error::system(self.out.path(), error))
    }

    /// Completes the picture.
    ///
    /// # Errors
    /// [`Error::System`] when it cannot be written.
    pub fn finish(self) -> Result<()> {
        let (head, tail) = (self.head(), self.tail());
        let Self { mut out, back, front, .. } = self;
        let path = out.path().to_owned();
        let failed = |error| Error::system(&path, error);
        out.write_all(head.as_bytes()).map_err(failed)?;
        unspool(back, &mut out, &path)?;
        out.write_all(b"</g>\n<g stroke=\"#12395c\">\n").map_err(failed)?;
        unspool(front, &mut out, &path)?;
        out.write_all(tail.as_bytes()).map_err(failed)?;
        out.commit()
    }

    fn head(&self) -> String {
        let ([width, height], title) = (self.viewport, &self.title);
        let one = 1u32 << self.subpixel_bits;
        // 0.6 pixels in a picture of 1000, and so in proportion, so that it prints the same at any
        // size.
        let stroke = f64::from(width.max(height)) / 1000.0 * 0.6 * f64::from(one);
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\">\n\
             <title>{title}</title>\n\
             <rect width=\"100%\" height=\"100%\" fill=\"#f7f9fb\"/>\n\
             <g transform=\"scale({})\" fill=\"none\" stroke-width=\"{stroke:.1}\" \
             stroke-linecap=\"round\" stroke-linejoin=\"round\">\n\
             <g stroke=\"#c3d3e0\">\n",
            1.0 / f64::from(one)
        )
    }

    fn tail(&self) -> String {
        let undivided = self.undivided;
        format!(
            "</g>\n</g>\n<!-- triangles not drawn, a vertex undivided: {undivided} -->\n</svg>\n"
        )
    }
}

/// Whether a triangle shows the side where `Su x Sv` points; `None` when it has no place on the
/// screen. Without area it counts as back: at a collapsed edge of a hidden patch such triangles
/// would shine through, and where the patch is seen their neighbours draw the same edges.
fn faces_front(screen: &[Screen], triangle: &Triangle, facing: i64) -> Option<bool> {
    let corner = |index: u16| screen.get(usize::from(index)).filter(|s| s.divided);
    let (a, b, c) = (corner(triangle[0])?, corner(triangle[1])?, corner(triangle[2])?);
    let along = |p: &Screen| (i64::from(p.x - a.x), i64::from(p.y - a.y));
    let ((bx, by), (cx, cy)) = (along(b), along(c));
    // y points down on the screen, so counter-clockwise there is a negative area.
    Some(-(bx * cy - by * cx) * facing > 0)
}

/// One path through all `edges`, in runs as long as a walk from edge to edge makes them: the moves
/// between runs are half of the file otherwise.
fn path(edges: &[[u16; 2]], screen: &[Screen]) -> String {
    let mut at_vertex: Vec<Vec<usize>> = vec![Vec::new(); screen.len()];
    for (number, edge) in edges.iter().enumerate().rev() {
        edge.iter().for_each(|&vertex| at_vertex[usize::from(vertex)].push(number));
    }
    let mut drawn = vec![false; edges.len()];
    let mut data = String::new();
    let mut pen = Screen::default();
    for start in 0..edges.len() {
        if drawn[start] {
            continue;
        }
        let mut vertex = edges[start][0];
        step(&mut data, 'm', &mut pen, screen[usize::from(vertex)]);
        while let Some(edge) = next_edge(&mut at_vertex[usize::from(vertex)], &drawn) {
            drawn[edge] = true;
            vertex = edges[edge][usize::from(edges[edge][0] == vertex)];
            step(&mut data, 'l', &mut pen, screen[usize::from(vertex)]);
        }
    }
    if data.is_empty() { data } else { format!("<path d=\"{data}\"/>\n") }
}

fn next_edge(candidates: &mut Vec<usize>, drawn: &[bool]) -> Option<usize> {
    while let Some(edge) = candidates.pop() {
        if !drawn[edge] {
            return Some(edge);
        }
    }
    None
}

/// A relative move or line; lines after a move need no letter, and a minus sign no space.
fn step(data: &mut String, command: char, pen: &mut Screen, to: Screen) {
    let (dx, dy) = (to.x - pen.x, to.y - pen.y);
    let before_x = if command == 'm' {
        "m"
    } else if dx < 0 {
        ""
    } else {
        " "
    };
    let before_y = if dy < 0 { "" } else { " " };
    write!(data, "{before_x}{dx}{before_y}{dy}").expect("a String takes everything");
    *pen = to;
}

fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            // XML allows no other control characters, not even as references.
            c if c.is_control() => escaped.push(' '),
            c => escaped.push(c),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::super::space::tests::frame;
    use super::*;

    fn at(x: i32, y: i32) -> Screen {
        Screen { x, y, divided: true }
    }

    #[test]
    fn a_triangle_that_is_counter_clockwise_to_the_eye_shows_its_front() {
        let screen = [at(0, 100), at(100, 100), at(50, 0), Screen::default()];
        assert_eq!(faces_front(&screen, &[0, 1, 2], 1), Some(true));
        assert_eq!(faces_front(&screen, &[0, 2, 1], 1), Some(false));
        assert_eq!(faces_front(&screen, &[0, 1, 2], -1), Some(false));
        assert_eq!(faces_front(&screen, &[0, 1, 3], 1), None);
        assert_eq!(faces_front(&[], &[0, 1, 2], 1), None, "emit.divide is off");
    }

    #[test]
    fn a_path_draws_every_edge_once_in_long_runs() {
        let screen = [at(0, 0), at(10, 0), at(0, 10), at(10, 10)];
        let quad = [[0, 1], [1, 2], [2, 0], [1, 3], [3, 2]];
        // Five edges: a run of four lines and more, one move, and no edge twice.
        assert_eq!(path(&quad, &screen), "<path d=\"m0 0 10 0-10 10 0-10m10 0 0 10-10 0\"/>\n");
        assert_eq!(path(&[], &screen), "");
    }

    #[test]
    fn a_picture_is_well_formed_and_counts_what_it_cannot_draw() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("mesh.svg");
        let mut svg = Svg::create(AtomicFile::create(&path).unwrap(), "a < b & c", 8).unwrap();
        svg.frame(&frame());
        let screen = [at(0, 2560), at(2560, 2560), at(0, 0), Screen::default()];
        let triangles = &[[0, 1, 2], [2, 1, 3]];
        let mesh = PatchMesh { screen: &screen, triangles, ..PatchMesh::default() };
        svg.patch(&frame(), &mesh).unwrap();
        svg.finish().unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(text.contains("<title>a &lt; b &amp; c</title>"));
        assert!(text.contains("viewBox=\"0 0 640 480\""));
        assert!(text.contains("undivided: 1 "));
        assert_eq!(text.matches("<path").count(), 1);
        assert_eq!(text.matches("<g").count(), text.matches("</g>").count());
    }
}
