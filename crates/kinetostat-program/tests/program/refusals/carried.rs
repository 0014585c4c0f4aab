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

fn read(text: &str) -> Path {
    interpret(&Program::read(text).unwrap(), &ReadOptions::default()).unwrap()
}

fn warned(path: &Path, part: &str) -> Vec<usize> {
    let warnings = path.warnings.iter();
    let found = warnings.filter(|warning| warning.text.contains(part));
    found.map(|warning| warning.line).collect()
}

/// LinuxCNC, `interp_read.cc`: G80 gives way to another code of its group in the block, wherever it stands.
#[test]
fn g80_beside_a_move_is_the_move() {
    let path =
        read("G21\nG0 G17 G40 G49 G80 G90\nX1 Y2 Z3\nG80 G1 X9 F100\nY5\nG3 G80 X11 I1\nM30\n");
    let kinds: Vec<(MoveKind, bool)> = path
        .moves
        .iter()
        .map(|one| (one.kind, one.curve == Curve::Line))
        .collect();
    let (rapid, feed) = (MoveKind::Rapid, MoveKind::Feed);
    assert_eq!(
        kinds,
        [(rapid, true), (feed, true), (feed, true), (feed, false)]
    );
    assert_eq!(path.moves[3].end, Vector3::new(11.0, 5.0, 3.0));
}

#[test]
fn settings_of_look_ahead_are_carried_and_move_nothing() {
    let text = "G21 G90 G17\nG05.1 Q1\nG5.1 Q3 X0 Y0 Z0\nG05 P10000\nG187 P3 E0.05\nG103 P1\nG0 X0 Y0 Z10\nG1 X9 F100\nG103\nG05 P0\nG5.1 Q0\nM30\n";
    let path = read(text);
    let lines: Vec<usize> = path.moves.iter().map(|one| one.line).collect();
    assert_eq!(lines, [7, 8]);
    assert_eq!(warned(&path, "setting of look-ahead"), [2]);
    let program = Program::read(text).unwrap();
    let field = |_: &Request| Ok(Vector3::new(0.0, 0.0, 0.1));
    let mut writing = WriteOptions::default();
    writing.header = None;
    let written = write_corrected(&program, &path, &field, &writing, &Unwatched).unwrap();
    let output = String::from_utf8(written.bytes).unwrap();
    assert!(
        output.starts_with(
            "G21 G90 G17\nG05.1 Q1\nG5.1 Q3 X0 Y0 Z0\nG05 P10000\nG187 P3 E0.05\nG103 P1\n"
        ),
        "{output}"
    );
    assert!(output.ends_with("G103\nG05 P0\nG5.1 Q0\nM30\n"), "{output}");
}

#[test]
fn additional_work_systems_are_others_and_are_said_to_be_at_one_place() {
    let second = "a second work coordinate system";
    for (first, other) in [
        ("G54", "G54.1 P1"),
        ("G54.1 P1", "G54.1 P2"),
        ("G54.1 P7", "G154 P7"),
        ("G154 P1", "G154 P99"),
    ] {
        let path = read(&format!(
            "G21 G90\n{first} G0 X1 Y1 Z1\n{other}\nX2\n{first}\nX3\n"
        ));
        assert_eq!(path.moves[1].end.x, 2.0);
        assert_eq!(warned(&path, second), [4], "{first} {other}");
    }
    for one in ["G54.1 P300", "G154 P5"] {
        let path = read(&format!("G21 G90\n{one} G0 X1 Y1 Z1\n{one}\nX2\n"));
        assert!(path.warnings.is_empty(), "{:?}", path.warnings);
    }
    // With an origin for another one.
    let mut reading = ReadOptions::default();
    reading.work_offsets_mm[0] = Some(Vector3::new(100.0, 0.0, 0.0));
    let program = Program::read("G21 G90\nG0 X1 Y1 Z1\nG54.1 P2 X1\n").unwrap();
    let path = interpret(&program, &reading).unwrap();
    assert_eq!([path.moves[0].end.x, path.moves[1].end.x], [101.0, 1.0]);
    assert_eq!(warned(&path, "is not stated, that of another is"), [3]);
}

#[test]
fn lengths_before_any_unit_are_millimetres_and_it_is_said() {
    let part = "taken for millimetres";
    let path = read("G90\nG0 X1 Y2 Z3\nG1 X9 F100\nX12\nM30\n");
    assert_eq!(warned(&path, part), [2]);
    assert_eq!(path.moves[1].feed.unwrap().value, 100.0);
    assert_eq!(path.moves[2].end, Vector3::new(12.0, 2.0, 3.0));
    // F before the first motion, and a unit that says the same behind it.
    let path = read("F100\nG1 X9\nG21\nX12\nG20\nG0 X1\n");
    assert_eq!(warned(&path, part), [2]);
    assert_eq!(path.moves[2].end.x, 25.4);
    // Zero is zero in all units.
    for named in [
        "G21\nG0 X1\n",
        "G28 Z0\nG20\nG0 X1\n",
        "G53 G0 Z0\nG20\nG0 X1\n",
    ] {
        assert!(warned(&read(named), part).is_empty(), "{named}");
    }
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
