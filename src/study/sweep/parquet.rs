//! Parquet: the rows of `sweep.csv` once more, by column and with types; the same rows in the same
//! order give the same bytes.
//!
//! A key's column has the narrowest type that holds its values at all points: boolean, INT64,
//! DOUBLE, else a string. What is empty in the CSV is null.

use super::outcome::columns;
use super::plan::Plan;
use super::store::Store;
use super::table::{OF_A_COUNTER, each_counter};
use crate::error::{Error, Result};
use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::{ParquetError, Result as Written};
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter};
use parquet::schema::types::Type;
use std::io::{self, Write};
use std::sync::Arc;

/// Rows that are held in memory at a time: some ten million cells.
const ROWS_OF_A_GROUP: usize = 1 << 17;

/// Writes all rows of counters.
///
/// # Errors
/// A result that cannot be read, a table that cannot be written.
pub(super) fn write(plan: &Plan, store: &Store, out: impl Write + Send) -> Result<()> {
    let failed = |error: ParquetError| {
        Error::system(store.root().join("sweep.parquet"), io::Error::other(error))
    };
    let mut sheet = Sheet::begin(columns_of(plan), ROWS_OF_A_GROUP, out).map_err(failed)?;
    each_counter(plan, store, &mut |row| sheet.push(row).map_err(failed))?;
    sheet.end().map_err(failed)
}

/// A table that is being written.
struct Sheet<W: Write + Send> {
    columns: Vec<Column>,
    rows_of_a_group: usize,
    out: SerializedFileWriter<W>,
}

impl<W: Write + Send> Sheet<W> {
    fn begin(columns: Vec<Column>, rows_of_a_group: usize, out: W) -> Written<Self> {
        let fields = columns.iter().map(Column::field).collect::<Written<_>>()?;
        let schema = Type::group_type_builder("sweep").with_fields(fields).build()?;
        let properties = Arc::new(WriterProperties::builder().build());
        let out = SerializedFileWriter::new(out, Arc::new(schema), properties)?;
        Ok(Self { columns, rows_of_a_group, out })
    }

    fn push(&mut self, row: &[&str]) -> Written<()> {
        for (column, cell) in self.columns.iter_mut().zip(row) {
            column.push(cell);
        }
        if self.rows() == self.rows_of_a_group { self.put() } else { Ok(()) }
    }

    fn end(mut self) -> Written<()> {
        if self.rows() > 0 {
            self.put()?;
        }
        self.out.close().map(drop)
    }

    /// Rows that are held.
    fn rows(&self) -> usize {
        self.columns[0].levels.len()
    }

    /// Writes what the columns hold as a group of rows, and empties them.
    fn put(&mut self) -> Written<()> {
        let mut group = self.out.next_row_group()?;
        for column in &mut self.columns {
            let mut chunk = group.next_column()?.expect("the schema has these columns");
            column.values.put(&column.levels, &mut chunk)?;
            chunk.close()?;
            *column = Column::new(&column.name, column.values.kind());
        }
        group.close().map(drop)
    }
}

/// What a column holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Boolean,
    Integer,
    /// Unsigned, and annotated so.
    Count,
    Real,
    Text,
}

impl Kind {
    /// The narrowest for these cells.
    fn of(cells: &[&str]) -> Self {
        let all = |fits: fn(&str) -> bool| cells.iter().all(|cell| cell.is_empty() || fits(cell));
        if all(|cell| cell.parse::<bool>().is_ok()) {
            Self::Boolean
        } else if all(|cell| cell.parse::<i64>().is_ok()) {
            Self::Integer
        } else if all(|cell| cell.parse::<f64>().is_ok()) {
            Self::Real
        } else {
            Self::Text
        }
    }
}

fn columns_of(plan: &Plan) -> Vec<Column> {
    let first_key = columns(plan).len() - plan.keys.len();
    let column = |(at, name): (usize, &str)| {
        let kind = match (name, at.checked_sub(first_key)) {
            ("point" | "value", _) => Kind::Count,
            (_, Some(key)) if key < plan.keys.len() => {
                // A point without a configuration has no rows.
                let points = plan.points.iter().filter(|point| point.hash.is_ok());
                Kind::of(&points.map(|point| point.values[key].as_str()).collect::<Vec<_>>())
            }
            _ => Kind::Text,
        };
        Column::new(name, kind)
    };
    columns(plan).into_iter().chain(OF_A_COUNTER).enumerate().map(column).collect()
}

/// A column of the rows that are held.
#[derive(Debug)]
struct Column {
    name: String,
    /// Those that are not null.
    values: Values,
    /// For each row 1, or 0 for null.
    levels: Vec<i16>,
}

#[derive(Debug)]
enum Values {
    Boolean(Vec<bool>),
    Integer(Vec<i64>),
    /// The bits of unsigned ones.
    Count(Vec<i64>),
    Real(Vec<f64>),
    Text(Vec<ByteArray>),
}

impl Column {
    fn new(name: &str, kind: Kind) -> Self {
        let values = match kind {
            Kind::Boolean => Values::Boolean(Vec::new()),
            Kind::Integer => Values::Integer(Vec::new()),
            Kind::Count => Values::Count(Vec::new()),
            Kind::Real => Values::Real(Vec::new()),
            Kind::Text => Values::Text(Vec::new()),
        };
        Self { name: name.to_owned(), values, levels: Vec::new() }
    }

    fn field(&self) -> Written<Arc<Type>> {
        let (physical, logical) = match self.values.kind() {
            Kind::Boolean => (Physical::BOOLEAN, None),
            Kind::Integer => (Physical::INT64, None),
            Kind::Count => (Physical::INT64, Some(LogicalType::integer(64, false))),
            Kind::Real => (Physical::DOUBLE, None),
            Kind::Text => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
        };
        let field = Type::primitive_type_builder(&self.name, physical);
        let field = field.with_repetition(Repetition::OPTIONAL).with_logical_type(logical);
        field.build().map(Arc::new)
    }

    fn push(&mut self, cell: &str) {
        self.levels.push(i16::from(!cell.is_empty()));
        if !cell.is_empty() {
            self.values.push(cell);
        }
    }
}

impl Values {
    fn kind(&self) -> Kind {
        match self {
            Self::Boolean(_) => Kind::Boolean,
            Self::Integer(_) => Kind::Integer,
            Self::Count(_) => Kind::Count,
            Self::Real(_) => Kind::Real,
            Self::Text(_) => Kind::Text,
        }
    }

    fn push(&mut self, cell: &str) {
        const FITS: &str = "the column's type was chosen to hold all of its cells";
        match self {
            Self::Boolean(values) => values.push(cell.parse().expect(FITS)),
            Self::Integer(values) => values.push(cell.parse().expect(FITS)),
            Self::Count(values) => values.push(cell.parse::<u64>().expect(FITS).cast_signed()),
            Self::Real(values) => values.push(cell.parse().expect(FITS)),
            Self::Text(values) => values.push(cell.into()),
        }
    }

    fn put(&self, levels: &[i16], out: &mut SerializedColumnWriter<'_>) -> Written<()> {
        let levels = Some(levels);
        let written = match self {
            Self::Boolean(values) => out.typed::<BoolType>().write_batch(values, levels, None),
            Self::Integer(values) | Self::Count(values) => {
                out.typed::<Int64Type>().write_batch(values, levels, None)
            }
            Self::Real(values) => out.typed::<DoubleType>().write_batch(values, levels, None),
            Self::Text(values) => out.typed::<ByteArrayType>().write_batch(values, levels, None),
        };
        written.map(drop)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use parquet::file::reader::{FileReader, SerializedFileReader};

    #[test]
    fn columns_are_as_narrow_as_their_cells_allow() {
        for (cells, kind) in [
            (["true", "", "false"], Kind::Boolean),
            (["-1", "", "12"], Kind::Integer),
            (["1", "0.5", "2"], Kind::Real),
            (["1", "true", ""], Kind::Text),
            (["agp4x", "", "2"], Kind::Text),
        ] {
            assert_eq!(Kind::of(&cells), kind, "{cells:?}");
        }
    }

    #[test]
    fn rows_come_back_from_groups_of_any_size() {
        let kinds = [Kind::Count, Kind::Boolean, Kind::Integer, Kind::Real, Kind::Text];
        let names = ["a", "b", "c", "d", "e"];
        let row = |n: u64| {
            let cells = [format!("{}", u64::MAX - n), "true".into(), format!("-{}", n + 1)];
            let nullable = if n.is_multiple_of(3) {
                [String::new(), String::new()]
            } else {
                ["0.5".into(), format!("x{n}")]
            };
            cells.into_iter().chain(nullable).collect::<Vec<_>>()
        };
        for rows_of_a_group in [1, 4, 5, 10, 11] {
            let columns = names.into_iter().zip(kinds).map(|(name, kind)| Column::new(name, kind));
            let file = tempfile::tempfile().unwrap();
            let mut sheet =
                Sheet::begin(columns.collect(), rows_of_a_group, file.try_clone().unwrap())
                    .unwrap();
            for n in 0..10 {
                let row = row(n);
                sheet.push(&row.iter().map(String::as_str).collect::<Vec<_>>()).unwrap();
            }
            sheet.end().unwrap();
            let reader = SerializedFileReader::new(file).unwrap();
            assert_eq!(reader.num_row_groups(), 10usize.div_ceil(rows_of_a_group));
            let found = reader.get_row_iter(None).unwrap().map(|row| row.unwrap().to_string());
            let told = |n| {
                let cells =
                    row(n).into_iter().zip(names).map(|(cell, name)| match (cell.as_str(), name) {
                        ("", _) => format!("{name}: null"),
                        (text, "e") => format!("{name}: \"{text}\""),
                        (text, _) => format!("{name}: {text}"),
                    });
                format!("{{{}}}", cells.collect::<Vec<_>>().join(", "))
            };
            assert!(found.eq((0..10).map(told)), "{rows_of_a_group} rows a group");
        }
    }
}
