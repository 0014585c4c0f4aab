//! What is carried, beside what is refused.

use kinetostat_program::*;
use nalgebra::Vector3;

#[test]
fn harmless_words_of_vendors_pass_byte_for_byte() {
    let text = "M862.3 P \"MK3S\" ; printer model check\nM115 U3.10.1 ; firmware\nM117 Printing X5 now!\n\
                G21 G40 G49 G80 G94 G17\nT1 M6\nS12000 M3\nM104 S210\nM201 X9000 Y9000 Z500 E10000\nM92 X80 Y80\n\
                M204 P1250 R1250 T1250\nG61\nG64 P0.01\nG4 P0.5\nG4 X1.5\nG0 X0 Y0 Z5\nM221 S95\nM84 X Y E\n";
    let program = Program::read(text).unwrap();
    let path = interpret(&program, &ReadOptions::default()).unwrap();
    assert_eq!(path.moves.len(), 1);
    assert_eq!(path.moves[0].line, 15);
    let field = |_: &Request| Ok(Vector3::new(0.1, 0.0, 0.0));
    let writing = {
        let mut writing = WriteOptions::default();
        writing.header = None;
        writing
    };
    let written = write_corrected(&program, &path, &field, &writing, &Unwatched).unwrap();
    let expected = text.replace("G0 X0 Y0 Z5", "G0 X0.1000 Y0 Z5");
    assert_eq!(String::from_utf8(written.bytes).unwrap(), expected);
}

/// Behind the closing tape mark, wherever it stands, every block that a controller could run is refused, and
/// text for people is carried and said.
#[test]
fn no_block_is_carried_behind_a_closing_tape_mark() {
    use proptest::prelude::*;
    // A line, whether it is refused there, whether it is text.
    const LINES: [(&str, bool, bool); 14] = [
        ("G1 X50 Y60 Z3", true, false),
        ("X5", true, false),
        ("n20 y3.F100", true, false),
        ("/G0 X1", true, false),
        ("(lift) Z9", true, false),
        ("G2 I5", true, false),
        ("G1 X[3+4]", true, false),
        ("M98 P100", true, false),
        ("", false, false),
        ("(X9 was the stock)", false, false),
        ("; G1 X3", false, false),
        ("%", false, false),
        ("written for machine X9", false, true),
        ("--- end ---", false, true),
    ];
    proptest!(|(opens in any::<bool>(), ends in any::<bool>(), picks in proptest::collection::vec(0..LINES.len(), 0..12))| {
        let mut lines = vec!["G21 G90", "G0 X0 Y0 Z0"];
        if opens {
            lines.insert(0, "%");
        }
        if ends {
            lines.push("M30");
        }
        lines.push("%");
        let first = lines.len() + 1;
        lines.extend(picks.iter().map(|&pick| LINES[pick].0));
        let of = |which: fn(&(&str, bool, bool)) -> bool| -> Vec<usize> {
            picks.iter().enumerate().filter(|(_, pick)| which(&LINES[**pick])).map(|(k, _)| first + k).collect()
        };
        let text = lines.join("\n");
        let found: Vec<usize> = faults(text.as_str(), &ReadOptions::default()).iter().map(|fault| fault.line).collect();
        prop_assert_eq!(&found, &of(|line| line.1), "{}", text);
        if found.is_empty() {
            let path = interpret(&Program::read(text.as_str()).unwrap(), &ReadOptions::default()).unwrap();
            prop_assert_eq!(path.moves.len(), 1);
            let warned: Vec<usize> = path.warnings.iter().map(|warning| warning.line).collect();
            let reported: Vec<usize> = of(|line| line.2).into_iter().take(1).collect();
            prop_assert_eq!(warned, reported, "{}", text);
        }
    });
}
