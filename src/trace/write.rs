//! Write: commands in, the text of a trace out, which reads back as the same commands.
//!
//! Numbers are the shortest decimals that read back as the same bits. The writer checks nothing but
//! the length of a line: the reader does.

use super::command::{Attributes, Command, Draw, FanEncoding, Frame, Header};
use super::command::{Points, Primitive, Range, Tessellation};
use super::lines::LINE_BYTES_MAX;
use super::points::PointSource;
use crate::attribute::Attribute;
use rtl_model::level::Criterion;
use rtl_model::patch::Depth;
use std::io::{self, Write};

/// Writes commands as lines of text. Unbuffered: give it a `BufWriter` where that matters.
#[derive(Debug)]
pub struct Writer<W> {
    output: W,
    line: String,
}

impl<W: Write> Writer<W> {
    /// Writes to `output`.
    pub fn new(output: W) -> Self {
        Self { output, line: String::new() }
    }

    /// Writes a command, which gets a line of its own.
    ///
    /// # Errors
    /// Those of the output. [`io::ErrorKind::InvalidInput`] for a line that is longer than readers
    /// take.
    pub fn write(&mut self, command: &Command) -> io::Result<()> {
        self.line.clear();
        let line = &mut self.line;
        match command {
            Command::Header(c) => header(line, c),
            Command::Frame(c) => frame(line, c),
            Command::Points(c) => points(line, c),
            Command::Attributes(c) => attributes(line, c),
            Command::Tessellation(c) => tessellation(line, c),
            Command::Draw(c) => draw(line, c),
            Command::End => line.push_str(r#"{"end":{}}"#),
        }
        if line.len() > LINE_BYTES_MAX {
            let message = format!(
                "a line of {} bytes is more than the {} MiB of text that a line may have; put \
                 large points into a file of their own, or use the binary form",
                line.len(),
                LINE_BYTES_MAX >> 20
            );
            return Err(io::Error::new(io::ErrorKind::InvalidInput, message));
        }
        line.push('\n');
        self.output.write_all(line.as_bytes())
    }

    /// The output, with all that was written.
    pub fn into_inner(self) -> W {
        self.output
    }
}

fn header(line: &mut String, header: &Header) {
    line.push_str(r#"{"tessim":"#);
    line.push_str(&super::parse::VERSION.to_string());
    let Header { title, source, licence } = header;
    for (name, text) in [("title", title), ("source", source), ("licence", licence)] {
        if !text.is_empty() {
            line.push_str(&format!(r#","{name}":{}"#, quoted(text)));
        }
    }
    line.push('}');
}

fn frame(line: &mut String, frame: &Frame) {
    let [width, height] = frame.viewport;
    line.push_str(&format!(r#"{{"frame":{{"viewport":[{width},{height}],"view":"#));
    numbers(line, &frame.view);
    line.push_str(r#","projection":"#);
    numbers(line, &frame.projection);
    if frame.depth == Depth::MinusOneToOne {
        line.push_str(r#","depth":"minus_one_to_one""#);
    }
    if frame.range != Range::default() {
        line.push_str(r#","range":{"#);
        let mut comma = "";
        for (name, log2) in [("clip", frame.range.clip), ("object", frame.range.object)] {
            if let Some(log2) = log2 {
                line.push_str(&format!(r#"{comma}"{name}":"#));
                real64(line, 2f64.powi(log2));
                comma = ",";
            }
        }
        line.push('}');
    }
    line.push_str("}}");
}

fn points(line: &mut String, points: &Points) {
    line.push_str(&format!(r#"{{"points":{{"id":{}"#, points.id));
    if points.resident {
        line.push_str(r#","resident":true"#);
    }
    match &*points.source {
        PointSource::Xyz(list) => rows(line, "xyz", list.iter().map(<[f32; 3]>::as_slice)),
        PointSource::Xyzw(list) => rows(line, "xyzw", list.iter().map(<[f32; 4]>::as_slice)),
        PointSource::File(file) => {
            let (name, layout) = (quoted(&file.data().name), file.layout().name());
            let count = points.source.len();
            line.push_str(&format!(r#","file":{name},"layout":"{layout}","count":{count}"#));
        }
    }
    line.push_str("}}");
}

fn attributes(line: &mut String, attributes: &Attributes) {
    line.push_str(&format!(r#"{{"attributes":{{"id":{}"#, attributes.id));
    if attributes.resident {
        line.push_str(r#","resident":true"#);
    }
    let attribute =
        |a: &Attribute| format!(r#"{{"name":"{}","format":"{}"}}"#, a.name, a.format.name());
    let layout: Vec<String> = attributes.table.layout.iter().map(attribute).collect();
    line.push_str(&format!(r#","layout":[{}]"#, layout.join(",")));
    rows(line, "values", attributes.table.values.chunks_exact(attributes.table.components()));
    line.push_str("}}");
}

fn tessellation(line: &mut String, state: &Tessellation) {
    let (name, key, fx16) = match state.criterion {
        Criterion::Flatness { pixels } => ("flatness", "pixels", pixels),
        Criterion::EdgeLength { pixels } => ("edge_length", "pixels", pixels),
        Criterion::Fixed { level } => ("fixed", "level", level.fx16()),
    };
    line.push_str(&format!(r#"{{"tessellation":{{"criterion":"{name}""#));
    let values = [(key, fx16), ("min_level", state.min_level), ("max_level", state.max_level)];
    for (name, fx16) in values {
        line.push_str(&format!(r#","{name}":"#));
        real64(line, f64::from(fx16) / 65536.0);
    }
    line.push_str("}}");
}

fn draw(line: &mut String, draw: &Draw) {
    line.push_str(r#"{"draw":{"primitive":"#);
    line.push_str(&match draw.primitive {
        Primitive::Patches { count } => {
            format!(r#""patches","points":{},"count":{count}"#, draw.points)
        }
        Primitive::Strip { count } => {
            format!(r#""strip","points":{},"count":{count}"#, draw.points)
        }
        Primitive::Fan { count, encoding } => {
            let encoding = match encoding {
                FanEncoding::Compact => "",
                FanEncoding::Full => r#","encoding":"full""#,
            };
            format!(r#""fan","points":{},"count":{count}{encoding}"#, draw.points)
        }
        Primitive::Mesh { rows, columns } => {
            format!(r#""mesh","points":{},"rows":{rows},"columns":{columns}"#, draw.points)
        }
        Primitive::Indexed { .. } => format!(r#""indexed_mesh","points":{}"#, draw.points),
    });
    if draw.first != 0 {
        line.push_str(&format!(r#","first":{}"#, draw.first));
    }
    if let Some(indices) = &draw.indices {
        index_rows(line, "indices", &indices.points);
        line.push_str(&format!(r#","index_format":"{}""#, indices.format.name()));
        if !indices.corners.is_empty() {
            index_rows(line, "attribute_indices", &indices.corners);
        }
    }
    if let Some(attributes) = draw.attributes {
        line.push_str(&format!(r#","attributes":{attributes}"#));
    }
    match &draw.models[..] {
        _ if !draw.models_sent => {}
        [model] => {
            line.push_str(r#","model":"#);
            numbers(line, model);
        }
        models => rows(line, "instances", models.iter().map(<[f32; 16]>::as_slice)),
    }
    if draw.reversed {
        line.push_str(r#","front":"reversed""#);
    }
    if !draw.cull {
        line.push_str(r#","cull":false"#);
    }
    line.push_str("}}");
}

fn quoted(text: &str) -> String {
    serde_json::to_string(text).expect("a string is JSON")
}

fn index_rows<const N: usize>(line: &mut String, name: &str, rows: &[[u32; N]]) {
    let text = serde_json::to_string(&rows.iter().map(<[u32; N]>::as_slice).collect::<Vec<_>>());
    let text = text.expect("integers are JSON");
    line.push_str(&format!(r#","{name}":{text}"#));
}

fn rows<'a>(line: &mut String, name: &str, rows: impl Iterator<Item = &'a [f32]>) {
    line.push_str(&format!(r#","{name}":["#));
    for (i, row) in rows.enumerate() {
        if i > 0 {
            line.push(',');
        }
        numbers(line, row);
    }
    line.push(']');
}

fn numbers(line: &mut String, numbers: &[f32]) {
    let mut buffer = ryu::Buffer::new();
    for (i, number) in numbers.iter().enumerate() {
        line.push(if i == 0 { '[' } else { ',' });
        line.push_str(shortest(buffer.format_finite(*number)));
    }
    line.push(']');
}

fn real64(line: &mut String, number: f64) {
    line.push_str(shortest(ryu::Buffer::new().format_finite(number)));
}

/// `1` says the same as `1.0`.
fn shortest(decimal: &str) -> &str {
    decimal.strip_suffix(".0").unwrap_or(decimal)
}
