//! FANUC TP programs and APT under a field of corrections: divided, written with a header, read again.

use kinetostat_formats::*;
use kinetostat_program::Request;
use nalgebra::{Isometry3, Vector3};

use crate::correcting::written_and_checked;

/// What is written of a program under a bend that grows along X.
fn bent(language: Language, text: &str) -> String {
    let mut options = ReadOptions::default();
    for frame in ["PART", "TOOL", "UF:2", "UT:1"] {
        options.frames.insert(frame.into(), Isometry3::identity());
    }
    let program = read(language, vec![SourceFile::new("a", text)], &options).unwrap();
    let making = PathOptions::default();
    let path = path_of(&program, &making).unwrap();
    let field = |request: &Request| {
        let x = request.position_mm.x / 100.0;
        Ok(Vector3::new(0.0, 0.0, 0.2 * x * x))
    };
    let mut writing = kinetostat_program::WriteOptions::default();
    if language == Language::Apt {
        // Feeds of APT stay as they are written.
        writing.max_feed_factor = 1.0;
    }
    let written =
        written_and_checked((&program, &path), (&options, &making), &field, &writing).unwrap();
    String::from_utf8(written.bytes).unwrap()
}

#[test]
fn a_bent_line_of_a_tp_program_has_more_lines_all_numbered() {
    let mut text = String::from(
        "/PROG  PART\n/ATTR\nLINE_COUNT\t= 3;\n/MN\n   1:  !groove ;\n   2:L P[1] 20mm/sec FINE ;\n   3:L P[2] 20mm/sec FINE ;\n/POS\n",
    );
    for (number, x) in [(1, 0.0), (2, 200.0)] {
        text += &format!(
            "P[{number}]{{\n   GP1:\n\tUF : 2, UT : 1,\tCONFIG : 'N U T, 0, 0, 0',\n\tX = {x:9.3}  mm,\tY =     0.000  mm,\tZ =     5.000  mm,\n\tW =   180.000 deg,\tP =     0.000 deg,\tR =     0.000 deg\n}};\n"
        );
    }
    text += "/END\n";
    let output = bent(Language::FanucLs, &text);
    let lines: Vec<&str> = output
        .lines()
        .skip_while(|line| *line != "/MN")
        .skip(1)
        .take_while(|line| *line != "/POS")
        .collect();
    assert!(lines.len() > 8, "{output}");
    for (index, line) in lines.iter().enumerate() {
        assert!(line.starts_with(&format!("{:4}:", index + 1)), "{line}");
    }
    assert!(output.contains(&format!("LINE_COUNT\t= {};", lines.len())));
    assert!(lines[0].contains("!") && lines[0].ends_with(" ;"));
}

#[test]
fn bent_arcs_of_apt_become_places_along_them() {
    let text = super::apt::nx();
    let output = bent(Language::Apt, text);
    assert!(
        output.matches("GOTO/").count() > text.matches("GOTO/").count() + 4,
        "{output}"
    );
    assert!(!output.contains("CIRCLE/"));
    assert!(output.contains("\n$$ kinetostat"), "{output}");
}
