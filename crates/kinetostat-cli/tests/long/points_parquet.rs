//! Points of a run in parts as Parquet, read back by the `parquet` crate's own reader.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::path::Path;
use std::process::{Child, Stdio};
use std::time::Duration;

use parquet::basic::Type;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;

use crate::common::command;
use crate::{PARTS, end, folder, place};

/// The command in these parts with this table of points.
fn start(here: &Path, command_name: &str, parts: &[&str], points: &str) -> Child {
    command(here)
        .args([command_name, "job.toml", "--points", points])
        .args(["--force-overwrite"])
        .args(parts)
        .env("SOURCE_DATE_EPOCH", "1764000000")
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the command starts")
}

/// A run that ends well and has nothing to say.
fn run(here: &Path, command_name: &str, parts: &[&str], points: &str) {
    let (code, said) = end(start(here, command_name, parts, points));
    assert_eq!((code, said.as_str()), (Some(0), ""), "{points}");
}

/// A table: names and types of its columns, what it says of itself, and its rows.
struct Table {
    columns: Vec<(String, Type)>,
    facts: BTreeMap<String, Option<String>>,
    rows: Vec<Vec<Field>>,
}

fn read(path: &Path) -> Table {
    let file = SerializedFileReader::new(File::open(path).expect("a file")).expect("Parquet");
    let about = file.metadata().file_metadata();
    let columns = about.schema_descr().columns().iter();
    let columns = columns.map(|c| (c.name().to_owned(), c.physical_type()));
    let facts = about.key_value_metadata().into_iter().flatten();
    let rows = file.get_row_iter(None).expect("rows");
    let fields = |row: parquet::record::Row| row.into_columns().into_iter().map(|(_, f)| f);
    Table {
        columns: columns.collect(),
        facts: facts.map(|f| (f.key.clone(), f.value.clone())).collect(),
        rows: rows
            .map(|row| fields(row.expect("a row")).collect())
            .collect(),
    }
}

#[test]
fn points_of_a_run_in_parts_are_those_of_its_csv() {
    for command_name in ["compensate", "deflect"] {
        let here = place(12);
        let here = here.path();
        run(here, command_name, &PARTS, "p.parquet");
        let found = read(&here.join("p.parquet"));
        command(here)
            .args([command_name, "job.toml", "--points", "p.csv"])
            .args(["--force-overwrite", "--all-points"])
            .args(PARTS)
            .output()
            .expect("the command starts");
        let text = fs::read_to_string(here.join("p.csv")).expect("a table");
        let mut lines = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
        let names: Vec<&str> = found
            .columns
            .iter()
            .map(|(name, _)| name.as_str())
            .collect();
        assert_eq!(lines.next().expect("a header"), names);
        let mut count = 0;
        for (row, cells) in found.rows.iter().zip(lines) {
            assert_eq!(row.len(), cells.len());
            for ((field, cell), name) in row.iter().zip(cells).zip(&names) {
                match field {
                    Field::Double(x) if cell.is_empty() => assert!(x.is_nan(), "{name}"),
                    Field::Double(x) => {
                        assert_eq!(x.to_string().parse(), cell.parse::<f64>(), "{name}")
                    }
                    Field::Str(word) => assert_eq!(word, cell, "{name}"),
                    other => panic!("{name}: {other:?}"),
                }
            }
            count += 1;
        }
        assert_eq!(count, found.rows.len());
        assert_eq!(count, text.lines().count() - 1);
        // Every cut of the surface and what leads to it.
        assert!(count > 12 * 51, "{count}");
        let unit = |name: &str| found.facts[&format!("unit.{name}")].clone();
        assert_eq!(unit("error_before_x_mm").as_deref(), Some("mm"));
        assert_eq!(found.facts["title"].as_deref(), Some("points of part.ngc"));
    }
}

#[test]
fn it_is_the_file_of_a_run_as_a_whole() {
    for command_name in ["compensate", "deflect"] {
        let [parts, whole] = [&PARTS[..], &[]].map(|parts| {
            let here = place(12);
            run(here.path(), command_name, parts, "p.parquet");
            fs::read(here.path().join("p.parquet")).expect("a file")
        });
        assert!(parts == whole, "another file, {command_name}");
    }
}

#[test]
fn a_killed_run_ends_with_the_same_file() {
    let whole = place(12);
    run(whole.path(), "compensate", &PARTS, "p.parquet");
    let wanted = fs::read(whole.path().join("p.parquet")).expect("a file");
    let here = place(12);
    let here = here.path();
    for state in ["state.json", "state-before.json"] {
        let mut child = start(here, "compensate", &PARTS, "p.parquet");
        while !folder(here).join(state).exists() {
            std::thread::sleep(Duration::from_millis(2));
            let ended = child.try_wait().expect("asked");
            assert!(ended.is_none(), "it ended before it kept anything");
        }
        child.kill().expect("killed");
        child.wait().expect("ends");
        assert!(!here.join("p.parquet").exists());
    }
    run(here, "compensate", &PARTS, "p.parquet");
    let found = fs::read(here.join("p.parquet")).expect("a file");
    assert!(
        found == wanted,
        "another file than that of a run that was not killed"
    );
    assert!(!folder(here).exists());
}

/// Rows that something else has changed are no table.
#[test]
fn rows_that_were_changed_meanwhile_are_refused() {
    let here = place(12);
    let here = here.path();
    let mut child = start(here, "compensate", &PARTS, "p.parquet");
    while !folder(here).join("state-before.json").exists() {
        std::thread::sleep(Duration::from_millis(2));
        assert!(child.try_wait().expect("asked").is_none());
    }
    // The first row, which is kept from the first part on.
    let path = folder(here).join("points");
    let text = fs::read(&path).expect("rows");
    let at = text.iter().position(|b| *b == b'\n').expect("a header") + 1;
    {
        use std::io::{Seek, SeekFrom, Write};
        let mut file = fs::OpenOptions::new()
            .write(true)
            .open(&path)
            .expect("rows");
        file.seek(SeekFrom::Start(at as u64)).expect("a place");
        file.write_all(b"9").expect("written");
    }
    let (code, said) = end(child);
    assert_eq!(code, Some(1), "{said}");
    assert!(said.contains("changed by something else"), "{said}");
    assert!(!here.join("p.parquet").exists());
}
