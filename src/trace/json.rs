//! Located JSON: the text of a line in, values that know their byte offset out, and faults that
//! name their place.
//!
//! `serde_json` does all the parsing. A value is taken as its raw text (`RawValue`), which borrows
//! from the line, so that its offset is known without a parser of our own. Only what is looked at
//! is parsed further.
//! A fault carries an offset and no path: the path is found from the offset ([`path_at`]) when a
//! fault is shown, so that reading a good trace never builds one.

use serde::Deserializer as _;
use serde::de::{Error as _, MapAccess, SeqAccess, Visitor};
use serde_json::value::RawValue;
use std::borrow::Cow;
use std::fmt;

/// The longest piece of input that a message quotes, in characters.
pub(crate) const SNIPPET_CHARS_MAX: usize = 200;

/// Something wrong at a byte of the line.
#[derive(Debug)]
pub(crate) struct Fault {
    /// Bytes from the start of the line, from 0.
    pub offset: usize,
    /// What is wrong, without the path.
    pub message: String,
    /// Whether the line can be descended to name the field.
    pub has_path: bool,
}

/// Results of looking into a line.
pub(crate) type Found<T> = Result<T, Fault>;

/// The raw text of a JSON value or key and where it stands in its line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Value<'a> {
    pub text: &'a str,
    pub offset: usize,
}

impl<'a> Value<'a> {
    /// The value that is the whole of a line, surrounding white space aside.
    pub(crate) fn line(line: &'a str) -> Self {
        const SPACE: [char; 4] = [' ', '\t', '\r', '\n'];
        let text = line.trim_start_matches(SPACE);
        Self { text: text.trim_end_matches(SPACE), offset: line.len() - text.len() }
    }

    /// A part of this value, which borrows from its text.
    fn part(self, raw: &'a RawValue) -> Self {
        let text = raw.get();
        Self { text, offset: self.offset + (text.as_ptr().addr() - self.text.as_ptr().addr()) }
    }

    /// The fault that this value is not what was expected.
    pub(crate) fn expected(self, what: impl fmt::Display) -> Fault {
        self.refuse(format!("found {}, expected {what}", snippet(self.text)))
    }

    /// A fault at this value, in words of its own.
    pub(crate) fn refuse(self, message: impl Into<String>) -> Fault {
        Fault { offset: self.offset, message: message.into(), has_path: true }
    }

    /// Hands every element to `f`, with its index.
    pub(crate) fn elements(
        self,
        expected: &str,
        f: impl FnMut(usize, Value<'a>) -> Found<()>,
    ) -> Found<()> {
        if !self.text.starts_with('[') {
            return Err(self.expected(expected));
        }
        let mut fault = None;
        let mut json = serde_json::Deserializer::from_str(self.text);
        let result = json.deserialize_seq(Elements { parent: self, f, fault: &mut fault });
        self.conclude(fault, result.and_then(|()| json.end()))
    }

    /// Hands every key and value to `f`, in the order of the text.
    pub(crate) fn entries(
        self,
        expected: &str,
        f: impl FnMut(Value<'a>, Value<'a>) -> Found<()>,
    ) -> Found<()> {
        if !self.text.starts_with('{') {
            return Err(self.expected(expected));
        }
        let mut fault = None;
        let mut json = serde_json::Deserializer::from_str(self.text);
        let result = json.deserialize_map(Entries { parent: self, f, fault: &mut fault });
        self.conclude(fault, result.and_then(|()| json.end()))
    }

    fn conclude(self, fault: Option<Fault>, result: serde_json::Result<()>) -> Found<()> {
        match (fault, result) {
            (Some(fault), _) => Err(fault),
            (None, Err(error)) => Err(self.syntax(&error)),
            (None, Ok(())) => Ok(()),
        }
    }

    /// The string that this value or key is.
    pub(crate) fn string(self, expected: &str) -> Found<Cow<'a, str>> {
        if !self.text.starts_with('"') {
            return Err(self.expected(expected));
        }
        match serde_json::from_str::<&str>(self.text) {
            Ok(plain) => Ok(Cow::Borrowed(plain)),
            Err(_) => serde_json::from_str(self.text).map(Cow::Owned).map_err(|e| self.syntax(&e)),
        }
    }

    /// Whether this value is a number. Numbers are the only values that begin so.
    pub(crate) fn is_number(self) -> bool {
        self.text.starts_with(|c: char| c == '-' || c.is_ascii_digit())
    }

    /// `serde_json`'s syntax errors in our words. Its column is that of the last byte it looked at.
    fn syntax(self, error: &serde_json::Error) -> Fault {
        let text = error.to_string();
        let reason = text.split(" at line ").next().unwrap_or(&text);
        if let Some(inside) = reason.strip_prefix("EOF while parsing ") {
            let message = format!("not JSON: the line ends inside {inside}");
            return Fault { offset: self.offset + self.text.len(), message, has_path: false };
        }
        // It counts the bytes before a control character, but up to any other byte that is wrong.
        let counted = usize::from(!reason.starts_with("control character"));
        let mut at = error.column().saturating_sub(counted).min(self.text.len());
        while !self.text.is_char_boundary(at) {
            at -= 1;
        }
        let rest = &self.text[at..];
        let word = rest.split_inclusive([',', ' ', ']', '}']).next().unwrap_or(rest);
        let found = match snippet(word.trim_end_matches([',', ' '])) {
            empty if empty.is_empty() => snippet(word),
            some => some,
        };
        let message = match reason {
            "trailing characters" => {
                format!("found `{found}` after the command, expected the end of the line")
            }
            "expected value" if rest.starts_with([']', '}', ',']) => {
                format!("not JSON: found `{}`, expected a value", &rest[..1])
            }
            "expected value" => {
                format!("not JSON: found `{found}`, expected a value (JSON has no NaN or infinity)")
            }
            "key must be a string" if rest.starts_with('}') => {
                "not JSON: found `}` after a comma, expected another field".into()
            }
            "trailing comma" => {
                format!("not JSON: found `{found}` after a comma, expected another value")
            }
            "expected ident" => format!("not JSON: found `{found}`, expected a value"),
            _ => format!("not JSON: {reason}, found `{found}`"),
        };
        Fault { offset: self.offset + at, message, has_path: false }
    }
}

/// Calls `f` for each element and keeps the fault that it returns: `serde_json` could not carry it.
struct Elements<'a, 'f, F> {
    parent: Value<'a>,
    f: F,
    fault: &'f mut Option<Fault>,
}

impl<'a, F: FnMut(usize, Value<'a>) -> Found<()>> Visitor<'a> for Elements<'a, '_, F> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an array")
    }

    fn visit_seq<A: SeqAccess<'a>>(mut self, mut seq: A) -> Result<(), A::Error> {
        let mut index = 0;
        while let Some(raw) = seq.next_element::<&'a RawValue>()? {
            (self.f)(index, self.parent.part(raw)).map_err(|fault| {
                *self.fault = Some(fault);
                A::Error::custom("a fault")
            })?;
            index += 1;
        }
        Ok(())
    }
}

/// The same for the entries of an object.
struct Entries<'a, 'f, F> {
    parent: Value<'a>,
    f: F,
    fault: &'f mut Option<Fault>,
}

impl<'a, F: FnMut(Value<'a>, Value<'a>) -> Found<()>> Visitor<'a> for Entries<'a, '_, F> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object")
    }

    fn visit_map<A: MapAccess<'a>>(mut self, mut map: A) -> Result<(), A::Error> {
        while let Some((key, value)) = map.next_entry::<&'a RawValue, &'a RawValue>()? {
            (self.f)(self.parent.part(key), self.parent.part(value)).map_err(|fault| {
                *self.fault = Some(fault);
                A::Error::custom("a fault")
            })?;
        }
        Ok(())
    }
}

/// The first characters of `text`, as many as a message may quote.
pub(crate) fn snippet(text: &str) -> Cow<'_, str> {
    cut(text, SNIPPET_CHARS_MAX)
}

fn cut(text: &str, chars_max: usize) -> Cow<'_, str> {
    match text.char_indices().nth(chars_max) {
        Some((end, _)) => Cow::Owned(format!("{}…", &text[..end])),
        None => Cow::Borrowed(text),
    }
}

/// The path of the field at a byte of the line, such as `points.xyz[3][1]`; empty for the line
/// itself.
pub(crate) fn path_at(line: &str, offset: usize) -> String {
    const NAME_CHARS_MAX: usize = 40;
    let mut path = String::new();
    let mut here = Some(Value::line(line));
    while let Some(value) = here.take() {
        if offset <= value.offset {
            break;
        }
        // A visitor that has found its part stops there with a fault of its own, which is dropped.
        let found = |part: Value<'_>| (offset < part.offset + part.text.len()).then_some(());
        let _ = match value.text.as_bytes().first() {
            Some(b'{') => value.entries("", |key, part| {
                if found(part).is_none() {
                    return Ok(());
                }
                let name = key.string("").unwrap_or(Cow::Borrowed(key.text));
                let dot = if path.is_empty() { "" } else { "." };
                path.push_str(dot);
                path.push_str(&cut(&name, NAME_CHARS_MAX));
                here = (offset >= part.offset).then_some(part);
                Err(part.refuse(""))
            }),
            Some(b'[') => value.elements("", |index, part| {
                if found(part).is_none() {
                    return Ok(());
                }
                path.push_str(&format!("[{index}]"));
                here = Some(part);
                Err(part.refuse(""))
            }),
            _ => Ok(()),
        };
    }
    path
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_leads_to_the_byte() {
        let line = r#" {"points": {"id": 0, "xyz": [[1, 2], [3, 44]]}}"#;
        let at = |what: &str| path_at(line, line.find(what).unwrap());
        assert_eq!(at("{\"points"), "");
        assert_eq!(at("\"points"), "points");
        assert_eq!(at("0,"), "points.id");
        assert_eq!(at("[[1"), "points.xyz");
        assert_eq!(at("[3"), "points.xyz[1]");
        assert_eq!(at("44"), "points.xyz[1][1]");
        assert_eq!(path_at("", 7), "");
    }

    #[test]
    fn snippets_are_cut_at_a_character() {
        let long = "ä".repeat(300);
        assert_eq!(snippet(&long).chars().count(), SNIPPET_CHARS_MAX + 1);
        assert_eq!(snippet("short"), "short");
    }

    #[test]
    fn escaped_strings_are_decoded() {
        assert_eq!(Value::line(r#""a\u0062""#).string("").unwrap(), "ab");
    }
}
