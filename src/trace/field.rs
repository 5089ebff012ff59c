//! Fields: located values in, numbers, choices and matrices out, each refused in words that say
//! what was expected.

use super::json::{Fault, Found, Value, snippet};
use glam::DMat4;

/// The fields of one object, all of them known and none twice.
pub(crate) struct Object<'a> {
    whole: Value<'a>,
    known: &'static [&'static str],
    found: Vec<(&'static str, Value<'a>, Value<'a>)>,
}

impl<'a> Object<'a> {
    /// Reads an object that may have the fields `known` and no others.
    pub(crate) fn read(whole: Value<'a>, known: &'static [&'static str]) -> Found<Self> {
        let mut found: Vec<(&'static str, Value<'a>, Value<'a>)> = Vec::new();
        whole.entries("an object", |key, value| {
            let text = key.string("a name")?;
            let Some(name) = known.iter().find(|k| **k == text) else {
                return Err(unknown("field", key, &text, known));
            };
            if found.iter().any(|(n, ..)| n == name) {
                return Err(key.refuse(format!("the field `{name}` is given twice, expected once")));
            }
            found.push((name, key, value));
            Ok(())
        })?;
        Ok(Self { whole, known, found })
    }

    /// A field that may be missing.
    pub(crate) fn get(&self, name: &str) -> Option<Value<'a>> {
        debug_assert!(self.known.contains(&name), "`{name}` is asked for but not known");
        self.found.iter().find(|(n, ..)| *n == name).map(|(.., value)| *value)
    }

    /// A field that must be there.
    pub(crate) fn require(&self, name: &str, what: &str) -> Found<Value<'a>> {
        self.get(name).ok_or_else(|| {
            let found = snippet(self.whole.text);
            self.whole.refuse(format!("`{name}` is missing, expected {what}; found {found}"))
        })
    }

    /// The key of a field.
    pub(crate) fn key(&self, name: &str) -> Option<Value<'a>> {
        self.found.iter().find(|(n, ..)| *n == name).map(|(_, key, _)| *key)
    }

    /// Refuses a field that has no place here.
    pub(crate) fn forbid(&self, name: &str, reason: &str) -> Found<()> {
        match self.key(name) {
            Some(key) => Err(key.refuse(format!("found `{name}`, {reason}"))),
            None => Ok(()),
        }
    }
}

/// The fault of a name that is not among the known ones.
pub(crate) fn unknown(kind: &str, key: Value<'_>, text: &str, known: &[&str]) -> Fault {
    let list = known.iter().map(|k| format!("`{k}`")).collect::<Vec<_>>().join(", ");
    let near = nearest(text, known);
    let hint = near.map(|n| format!(" (did you mean `{n}`?)")).unwrap_or_default();
    let found = snippet(key.text);
    key.refuse(format!("found the unknown {kind} {found}{hint}, expected one of {list}"))
}

/// The known name that `text` is most likely meant to be.
fn nearest<'k>(text: &str, known: &[&'k str]) -> Option<&'k str> {
    const SIMILAR: f64 = 0.5; // of 1; below this a hint confuses more than it helps
    if text.len() > 64 {
        return None; // the measure's cost is quadratic
    }
    let rated = known.iter().map(|k| (strsim::normalized_damerau_levenshtein(text, k), *k));
    let best = rated.max_by(|a, b| a.0.total_cmp(&b.0))?;
    (best.0 >= SIMILAR).then_some(best.1)
}

/// A finite number that fits 32 bits.
pub(crate) fn real32(value: Value<'_>) -> Found<f32> {
    const WHAT: &str = "a finite number within 32-bit floating point";
    if !value.is_number() {
        return Err(value.expected(WHAT));
    }
    match serde_json::from_str::<f32>(value.text) {
        Ok(number) if number.is_finite() => Ok(number),
        _ => Err(value.expected(WHAT)),
    }
}

/// A finite number for which `ok` holds.
pub(crate) fn real64(value: Value<'_>, what: &str, ok: impl Fn(f64) -> bool) -> Found<f64> {
    if !value.is_number() {
        return Err(value.expected(what));
    }
    match serde_json::from_str::<f64>(value.text) {
        Ok(number) if number.is_finite() && ok(number) => Ok(number),
        _ => Err(value.expected(what)),
    }
}

/// An integer from `least` to `most`.
pub(crate) fn integer(value: Value<'_>, least: u64, most: u64) -> Found<u64> {
    match serde_json::from_str::<u64>(value.text) {
        Ok(number) if (least..=most).contains(&number) => Ok(number),
        _ => Err(value.expected(format_args!("an integer from {least} to {most}"))),
    }
}

/// An integer of 32 bits, from `least` to `most`.
pub(crate) fn integer32(value: Value<'_>, least: u32, most: u32) -> Found<u32> {
    let number = integer(value, least.into(), most.into())?;
    Ok(u32::try_from(number).expect("the range is one of 32 bits"))
}

/// `true` or `false`.
pub(crate) fn flag(value: Value<'_>) -> Found<bool> {
    match value.text {
        "true" => Ok(true),
        "false" => Ok(false),
        _ => Err(value.expected("true or false")),
    }
}

/// One of a few names.
pub(crate) fn choice<T: Copy>(value: Value<'_>, choices: &[(&str, T)]) -> Found<T> {
    let names: Vec<&str> = choices.iter().map(|c| c.0).collect();
    let list = names.iter().map(|n| format!("\"{n}\"")).collect::<Vec<_>>().join(", ");
    let what = format!("one of {list}");
    let text = value.string(&what)?;
    if let Some((_, choice)) = choices.iter().find(|c| c.0 == text) {
        return Ok(*choice);
    }
    let hint = nearest(&text, &names).map(|n| format!(" (did you mean \"{n}\"?)"));
    Err(value.expected(what + &hint.unwrap_or_default()))
}

/// A 4 by 4 matrix of finite numbers, column-major.
pub(crate) fn matrix(value: Value<'_>) -> Found<[f32; 16]> {
    const WHAT: &str = "a matrix of 16 numbers, column-major";
    if let Ok(matrix) = serde_json::from_str(value.text) {
        return Ok(matrix); // f32 takes no numbers that are not finite
    }
    let mut matrix = [0.0; 16];
    let mut count = 0;
    value.elements(WHAT, |i, element| {
        count = i + 1;
        let entry = matrix
            .get_mut(i)
            .ok_or_else(|| element.expected("no more numbers, as a matrix has 16"))?;
        *entry = real32(element)?;
        Ok(())
    })?;
    if count < 16 {
        return Err(value.expected(format_args!("{WHAT}, not {count}")));
    }
    Ok(matrix)
}

/// Whether a matrix has an inverse: the determinant and the inverse are those of its numbers in 64
/// bits.
pub(crate) fn has_inverse(matrix: &[f32; 16]) -> bool {
    let wide = DMat4::from_cols_array(&matrix.map(f64::from));
    wide.determinant() != 0.0 && wide.inverse().is_finite()
}

/// A matrix that has an inverse.
pub(crate) fn invertible(value: Value<'_>) -> Found<[f32; 16]> {
    let matrix = matrix(value)?;
    if !has_inverse(&matrix) {
        return Err(value.expected("a matrix that has an inverse; this one is singular"));
    }
    Ok(matrix)
}
