//! Rows of text in, a table in Markdown out.

/// A table whose columns are as wide as their widest cell: the first `names` to the left, numbers
/// to the right. It ends with a line break.
pub(super) fn table<const N: usize>(
    columns: &[&str; N],
    names: usize,
    rows: &[[String; N]],
) -> String {
    let columns: Vec<String> = columns.iter().map(|&column| column.to_owned()).collect();
    of(&columns, names, rows)
}

/// The same with as many columns as there are, the first of names.
pub(super) fn wide(columns: &[String], rows: &[Vec<String>]) -> String {
    of(columns, 1, rows)
}

fn of<R: AsRef<[String]>>(columns: &[String], names: usize, rows: &[R]) -> String {
    let width = |k: usize| {
        let cells = rows.iter().map(|row| row.as_ref()[k].len());
        cells.chain([columns[k].len()]).max().unwrap_or(0)
    };
    let line = |cell: &dyn Fn(usize) -> String| {
        let cells: Vec<_> = (0..columns.len()).map(cell).collect();
        format!("| {} |\n", cells.join(" | "))
    };
    let aligned = |k: usize, cell: &str| {
        let width = width(k);
        if k < names { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
    };
    let rule =
        |k: usize| if k < names { "-".repeat(width(k)) } else { "-".repeat(width(k) - 1) + ":" };
    let head = line(&|k| aligned(k, &columns[k])) + &line(&rule);
    rows.iter().fold(head, |text, row| text + &line(&|k| aligned(k, &row.as_ref()[k])))
}
