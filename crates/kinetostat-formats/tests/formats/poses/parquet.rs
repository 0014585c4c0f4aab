//! Tables that pyarrow 26 wrote, with types that text cannot say, nulls, numbers of all types, and all codecs.

use kinetostat_formats::*;
use nalgebra::Vector3;

use super::{place, read_with};

const SLOT: &[u8] = include_bytes!("../fixtures/slot.parquet");

/// `x_mm` int16 (LZ4), `y_mm` decimal128(9, 2) (Brotli), `z_mm` float16 (gzip), `speed_mm_per_s` uint16 (Snappy), `rapid` bool
/// (none), `note` string (zstd).
const NUMBERS: &[u8] = include_bytes!("../fixtures/numbers.parquet");

/// `x_mm` of strings, `z_mm` of timestamps.
const TEXTS: &[u8] = include_bytes!("../fixtures/texts.parquet");

/// A null in the second row of `y_mm`.
const HOLE: &[u8] = include_bytes!("../fixtures/hole.parquet");

#[test]
fn numbers_of_all_types_are_read_from_all_codecs_and_widened_where_they_must() {
    let text = String::from_utf8(table_of_parquet(NUMBERS).unwrap()).unwrap();
    assert_eq!(
        text,
        "x_mm,y_mm,z_mm,speed_mm_per_s,rapid,note,parquet_row\n0,0.00,20,20,1,above,0\n60,0.50,-1.5,20,0,slot,1\n30,-20.25,-1.5,25,0,,2\n0,0.00,20,25,1,up,3\n"
    );
    let program = read_with("n.parquet", text.as_bytes(), &ReadOptions::default()).unwrap();
    assert_eq!(place(&program, 2), [30.0, -20.25, -1.5]);
    assert_eq!(program.motions[2].speed.mm_per_s, Some(25.0));
    // Whole numbers stay whole numbers; others make the column one of the type double.
    let other = text.replace("\n60,0.50,-1.5,20,", "\n61,0.5,-1.5,19.875,");
    let made = parquet_of_table(NUMBERS, other.as_bytes()).unwrap();
    assert_eq!(made.widened, ["speed_mm_per_s"]);
    let again = String::from_utf8(table_of_parquet(&made.bytes).unwrap()).unwrap();
    assert_eq!(again, other.replace("0.5,", "0.50,"));
    let pieces = [Piece::to(1, Vector3::new(60.125, 0.25, -1.375))];
    let files = write(&program, &pieces, &WriteOptions::default()).unwrap();
    let made = parquet_of_table(NUMBERS, &files[0].1).unwrap();
    assert_eq!(made.widened, ["x_mm", "y_mm", "z_mm"]);
    let again = String::from_utf8(table_of_parquet(&made.bytes).unwrap()).unwrap();
    let rows: Vec<&str> = again.lines().collect();
    assert_eq!(rows[2], "60.125,0.25,-1.375,20,0,slot,1");
    assert_eq!(rows[3], "30,-20.25,-1.5,25,0,,2");
}

#[test]
fn what_is_no_number_is_named_with_its_column_and_type_or_with_its_row() {
    let said = table_of_parquet(TEXTS).unwrap_err();
    assert_eq!(
        said,
        "where numbers are needed it has the columns `x_mm` of the type BYTE_ARRAY (UTF8), `z_mm` of the type INT64 (TIMESTAMP_MICROS): write numbers there, of the type double"
    );
    let text = table_of_parquet(HOLE).unwrap();
    let errors = read_with("hole.parquet", &text, &ReadOptions::default()).unwrap_err();
    assert_eq!(errors.len(), 1);
    let said = errors[0].to_string();
    assert!(said.contains("(row 1, the first is 0)"), "{said}");
}

#[test]
fn a_table_is_read_corrected_and_written_with_its_columns() {
    let text = table_of_parquet(SLOT).unwrap();
    let shown = String::from_utf8(text.clone()).unwrap();
    assert!(shown.starts_with(
        "id,x_mm,y_mm,z_mm,qw,qx,qy,qz,speed_mm_per_s,rapid,note,when,cost,parquet_row\n"
    ));
    assert!(
        shown.contains("\n1,0,0,20,0,0,1,0,,1,\"above, \"\"it\"\"\",1,1.00,0\n"),
        "{shown}"
    );
    let program = read_with("slot.parquet", &text, &ReadOptions::default()).unwrap();
    assert_eq!(place(&program, 2), [60.0, 0.0, -1.0]);
    // Without a correction the file comes back byte for byte.
    assert_eq!(parquet_of_table(SLOT, &text).unwrap().bytes, SLOT);
    let pieces = [
        Piece::to(2, Vector3::new(30.0, 0.5, -0.75)),
        Piece::to(2, Vector3::new(60.0123, 0.0, -1.0)),
    ];
    let files = write(&program, &pieces, &WriteOptions::default()).unwrap();
    let marked = [b"# kinetostat: corrected\n".as_slice(), &files[0].1].concat();
    let made = parquet_of_table(SLOT, &marked).unwrap();
    assert_eq!(made.widened, [""; 0]);
    let again = table_of_parquet(&made.bytes).unwrap();
    let again = String::from_utf8(again).unwrap();
    let rows: Vec<&str> = again.lines().collect();
    assert_eq!(rows[0], "# kinetostat: corrected");
    // A further row has all other values of its own; the rows of the new file are counted anew.
    assert_eq!(rows[4], "3,30,0.5,-0.75,0,0,1,0,20,0,along,3,3.00,2");
    assert_eq!(rows[5], "3,60.012,0,-1,0,0,1,0,20,0,along,3,3.00,3");
    assert_eq!(rows.len(), 7);
}

#[test]
fn what_does_not_fit_is_refused_in_words() {
    let text = String::from_utf8(table_of_parquet(SLOT).unwrap()).unwrap();
    let said = parquet_of_table(SLOT, text.replace(",20,0,", ",20,2,").as_bytes()).unwrap_err();
    let needle = "its column `rapid` of the type BOOLEAN cannot hold 2: write it with";
    assert!(said.contains(needle), "{said}");
    for foreign in ["", "x_mm\n1\n", &text.replace(",3\n", ",9\n")] {
        let said = parquet_of_table(SLOT, foreign.as_bytes()).unwrap_err();
        assert!(said.contains("not of that file"), "{said}");
    }
    for broken in [&SLOT[..100], &SLOT[4..], b"PAR1PAR1"] {
        assert!(table_of_parquet(broken).unwrap_err().contains("no Parquet"));
    }
}

/// A broken file has no table, and never ends the program: each byte of the part that says where columns lie, changed.
#[test]
fn a_changed_byte_is_refused_or_read_and_never_panics() {
    let (mut read, mut refused) = (0, 0);
    for original in [SLOT, NUMBERS] {
        for at in original.len().saturating_sub(1500)..original.len() {
            for byte in [0, 131, 245, 255] {
                let mut broken = original.to_vec();
                broken[at] = byte;
                match table_of_parquet(&broken) {
                    Ok(_) => read += 1,
                    Err(words) => {
                        assert!(!words.is_empty());
                        refused += 1;
                    }
                }
            }
        }
    }
    assert!(read > 100 && refused > 100, "{read} {refused}");
}
