//! The table by columns says what the table by rows says.

use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;
use std::fs::File;

#[test]
fn parquet_has_the_rows_of_the_csv_with_types() {
    let place = super::place();
    place.swept("out");
    let file = File::open(place.path("out/sweep.parquet")).unwrap();
    let reader = SerializedFileReader::new(file).unwrap();
    let text = place.read("out/sweep.csv");
    let mut csv = csv::Reader::from_reader(text.as_bytes());
    let head = csv.headers().unwrap().clone();
    let mut rows = csv.records();
    let mut compared = 0;
    for row in reader.get_row_iter(None).unwrap() {
        let wanted = rows.next().expect("no more rows than in the CSV").unwrap();
        let columns = row.unwrap().into_columns();
        assert_eq!(columns.len(), head.len());
        for ((name, field), (column, cell)) in columns.iter().zip(head.iter().zip(&wanted)) {
            assert_eq!(name, column);
            let found = match (name.as_str(), field) {
                ("point" | "value", Field::ULong(value)) => value.to_string(),
                ("position.width", Field::Long(value)) => value.to_string(),
                ("point" | "value" | "position.width", other) => panic!("{name}: {other:?}"),
                (_, Field::Str(text)) => text.clone(),
                (_, Field::Null) => String::new(),
                (_, other) => panic!("{name}: {other:?}"),
            };
            assert_eq!(found, cell, "{name}");
        }
        compared += 1;
    }
    assert!(rows.next().is_none() && compared > 1000, "{compared} rows");
}
