//! HTML by hand: names of elements from the code, text from files in; a page out in which every
//! text is escaped.
//!
//! No templating library: `maud` needs a feature of `syn` that nothing else here asks for, and with
//! it every crate with derived code, naga and wgpu among them, is built anew. What a page needs is
//! elements that close and text that cannot become markup.

use std::fmt::Write;

/// A page under construction.
#[derive(Debug, Default)]
pub(super) struct Page {
    html: String,
}

impl Page {
    /// An element with what `inside` writes in it. Of `attributes`, values are escaped.
    pub(super) fn element(
        &mut self,
        name: &str,
        attributes: &[(&str, &str)],
        inside: impl FnOnce(&mut Self),
    ) {
        self.open(name, attributes);
        inside(self);
        write!(self.html, "</{name}>").expect("a String takes everything");
        // Between blocks a line's end means nothing; within a line it would be a space.
        if !matches!(name, "code" | "a" | "i" | "span" | "th" | "td" | "label" | "option" | "b") {
            self.html.push('\n');
        }
    }

    /// An element with nothing but text in it.
    pub(super) fn texts(&mut self, name: &str, attributes: &[(&str, &str)], text: &str) {
        self.element(name, attributes, |page| page.text(text));
    }

    /// The beginning of an element: all there is of those that hold nothing.
    pub(super) fn open(&mut self, name: &str, attributes: &[(&str, &str)]) {
        write!(self.html, "<{name}").expect("a String takes everything");
        for (key, value) in attributes {
            write!(self.html, " {key}=\"").expect("a String takes everything");
            self.text(value);
            self.html.push('"');
        }
        self.html.push('>');
    }

    /// Text: whatever is in it, it is read as text.
    pub(super) fn text(&mut self, text: &str) {
        for character in text.chars() {
            match character {
                '&' => self.html.push_str("&amp;"),
                '<' => self.html.push_str("&lt;"),
                '>' => self.html.push_str("&gt;"),
                '"' => self.html.push_str("&quot;"),
                '\'' => self.html.push_str("&#39;"),
                // What HTML has no way to say; a terminal's escapes are among them.
                c if c.is_control() && !matches!(c, '\n' | '\t') => self.html.push('\u{fffd}'),
                c => self.html.push(c),
            }
        }
    }

    /// The program's own style or script: code, no text.
    pub(super) fn code(&mut self, element: &str, code: &'static str) {
        write!(self.html, "<{element}>\n{code}</{element}>\n").expect("a String takes everything");
    }

    /// Data for the page's script.
    pub(super) fn data(&mut self, class: &str, value: &serde_json::Value) {
        // `</script` ends a script wherever it stands, and `<!--` changes how it ends.
        let json = value.to_string().replace('<', "\\u003c");
        self.open("script", &[("type", "application/json"), ("class", class)]);
        writeln!(self.html, "{json}</script>").expect("a String takes everything");
    }

    /// The whole, as a document.
    pub(super) fn finish(self) -> String {
        format!("<!DOCTYPE html>\n{}", self.html)
    }
}
