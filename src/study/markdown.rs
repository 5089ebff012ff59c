//! Rows of text in, a table in Markdown out.

/// A table whose columns are as wide as their widest cell: the first `names` to the left, numbers
/// to the right. It ends with a line break.
pub(super) fn table<const N: usize>(
    columns: &[&str; N],
    names: usize,
    rows: &[[String; N]],
) -> String {
    let width = |k: usize| {
        let cells = rows.iter().map(|row| row[k].len());
        cells.chain([columns[k].len()]).max().unwrap_or(0)
    };
    let line = |cell: &dyn Fn(usize) -> String| {
        let cells: Vec<_> = (0..N).map(cell).collect();
        format!("| {} |\n", cells.join(" | "))
    };
    let aligned = |k: usize, cell: &str| {
        let width = width(k);
        if k < names { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
    };
    let rule =
        |k: usize| if k < names { "-".repeat(width(k)) } else { "-".repeat(width(k) - 1) + ":" };
    let head = line(&|k| aligned(k, columns[k])) + &line(&rule);
    rows.iter().fold(head, |text, row| text + &line(&|k| aligned(k, &row[k])))
}
