//! A table that pyarrow 26 wrote, with types that text cannot say, nulls, and zstd.

use kinetostat_formats::*;
use nalgebra::Vector3;

use super::{place, read_with};

const SLOT: &[u8] = include_bytes!("../fixtures/slot.parquet");

#[test]
fn a_table_is_read_corrected_and_written_with_its_columns() {
    let text = table_of_parquet(SLOT).unwrap();
    let shown = String::from_utf8(text.clone()).unwrap();
    assert!(shown.starts_with(
        "id,x_mm,y_mm,z_mm,qw,qx,qy,qz,speed_mm_per_s,rapid,note,when,cost,parquet_row\n"
    ));
    assert!(
        shown.contains("\n1,0,0,20,0,0,1,0,,1,\"above, \"\"it\"\"\",1,,0\n"),
        "{shown}"
    );
    let program = read_with("slot.parquet", &text, &ReadOptions::default()).unwrap();
    assert_eq!(place(&program, 2), [60.0, 0.0, -1.0]);
    // Without a correction the file comes back byte for byte.
    assert_eq!(parquet_of_table(SLOT, &text).unwrap(), SLOT);
    let pieces = [
        Piece::to(2, Vector3::new(30.0, 0.5, -0.75)),
        Piece::to(2, Vector3::new(60.0123, 0.0, -1.0)),
    ];
    let files = write(&program, &pieces, &WriteOptions::default()).unwrap();
    let marked = [b"# kinetostat: corrected\n".as_slice(), &files[0].1].concat();
    let made = parquet_of_table(SLOT, &marked).unwrap();
    let again = table_of_parquet(&made).unwrap();
    let again = String::from_utf8(again).unwrap();
    let rows: Vec<&str> = again.lines().collect();
    assert_eq!(rows[0], "# kinetostat: corrected");
    // A further row has all other values of its own; the rows of the new file are counted anew.
    assert_eq!(rows[4], "3,30,0.5,-0.75,0,0,1,0,20,0,along,3,,2");
    assert_eq!(rows[5], "3,60.012,0,-1,0,0,1,0,20,0,along,3,,3");
    assert_eq!(rows.len(), 7);
}

#[test]
fn what_does_not_fit_is_refused_in_words() {
    let text = String::from_utf8(table_of_parquet(SLOT).unwrap()).unwrap();
    let said = parquet_of_table(SLOT, text.replace("\n3,60", "\n3.5,60").as_bytes()).unwrap_err();
    assert!(said.contains("its column `id` cannot hold 3.5"), "{said}");
    for foreign in ["", "x_mm\n1\n", &text.replace(",3\n", ",9\n")] {
        let said = parquet_of_table(SLOT, foreign.as_bytes()).unwrap_err();
        assert!(said.contains("not of that file"), "{said}");
    }
    for broken in [&SLOT[..100], &SLOT[4..], b"PAR1PAR1"] {
        assert!(table_of_parquet(broken).unwrap_err().contains("no Parquet"));
    }
}
