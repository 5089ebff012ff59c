//! Two columns, for facts that have a name each.

use std::fmt::Write;

/// `name  value` lines, the values aligned.
pub(crate) fn facts(rows: &[(&str, String)]) -> String {
    let width = rows.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    let mut text = String::new();
    for (name, value) in rows {
        writeln!(text, "{name:width$}  {value}").expect("a String takes everything");
    }
    text
}
