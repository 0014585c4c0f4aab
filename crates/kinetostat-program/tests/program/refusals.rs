//! What is refused: each with the line, what stands there, the reason, and what to do.

// Helpers of tests, which clippy does not count as tests.
use kinetostat_program::*;
use nalgebra::Vector3;

fn refusal(text: &[u8], start_known: bool) -> Option<ProgramError> {
    let options = {
        let mut reading = ReadOptions::default();
        reading.start_position_mm = start_known.then(Vector3::zeros);
        reading
    };
    match Program::read(text) {
        Err(error) => Some(error),
        Ok(program) => interpret(&program, &options).err(),
    }
}

/// Program, line, a part of the reason, a part of the remedy.
const BAD: &[(&str, usize, &str, &str)] = &[
    // Not a program at all.
    ("", 1, "the file is empty", "at least one block"),
    ("G21\nG1 X1\0Y2", 2, "byte 0x00 is no text", "text file"),
    ("\u{1}\u{2}ELF", 1, "byte 0x01 is no text", "text file"),
    // Numbers.
    (
        "G21\nG1 X1.2.3",
        2,
        "a number has two points",
        "one fixed-point number",
    ),
    (
        "G21\nG1 X1e5",
        2,
        "a number with an exponent",
        "without an exponent",
    ),
    (
        "G21\nG1 X1e-5",
        2,
        "a number with an exponent",
        "without an exponent",
    ),
    (
        "G21\nG1 X1,5",
        2,
        "a comma",
        "write a point in decimal numbers",
    ),
    (
        "G21\nG1 XNaN",
        2,
        "has no number",
        "fixed-point number such as",
    ),
    (
        "G21\nG1 X--5",
        2,
        "X has no number",
        "fixed-point number such as",
    ),
    (
        "G21\nG1 X",
        2,
        "X has no number",
        "fixed-point number such as",
    ),
    (
        "G21\nG1 5",
        2,
        "a number has no letter",
        "a letter and a number",
    ),
    (
        "G21\nG1 X1 Y2 X3",
        2,
        "the letter X appears twice",
        "keep one",
    ),
    (
        "G21\nG0 X99999999",
        2,
        "X would be at 99999999 mm",
        "check the number and the units",
    ),
    // Comments and marks.
    (
        "G21 (open\nG1 X1",
        1,
        "opened with ( and not closed",
        "close the comment",
    ),
    (
        "G21 open)\nG1 X1",
        1,
        "OPEN is no word",
        "make the text a comment",
    ),
    (
        "G21)\nG1 X1",
        1,
        "a comment is closed that was not opened",
        "remove the )",
    ),
    (
        "G21\nG1 X1 % Y2",
        2,
        "a tape mark % appears among words",
        "line of its own",
    ),
    (
        "G21\nG1 X1 /Y2",
        2,
        "a / appears inside the block",
        "at its beginning",
    ),
    ("N1 G21*33", 1, "a checksum", "without checksums"),
    ("G21\nG1 X1 \u{e9}", 2, "outside ASCII", "into a comment"),
    // Dialects that are not read.
    (
        "G21\n#100=5",
        2,
        "variables and expressions",
        "plain numbers",
    ),
    (
        "G21\nG1 X[1+2]",
        2,
        "variables and expressions",
        "plain numbers",
    ),
    (
        "G21\nWHILE [#1 LT 5] DO1",
        2,
        "WHILE is a control structure",
        "plain numbers",
    ),
    (
        "G21\nIF [#1 EQ 0] GOTO 10",
        2,
        "IF is a control structure",
        "plain numbers",
    ),
    ("G21\nM98 P100", 2, "M98 is a subroutine", "flatten"),
    ("G21\nG1 X1 F1\nM99", 3, "M99 is a subroutine", "flatten"),
    (
        "G21\nG65 P9000 A1",
        2,
        "the macro call G65 is a subroutine",
        "flatten",
    ),
    (
        "O1\nG21\nO2",
        3,
        "a second program number (O word) is a subroutine",
        "flatten",
    ),
    (
        "G21\nO100 sub",
        2,
        "an O word with a keyword is a subroutine",
        "flatten",
    ),
    (
        "G21\nO<pocket> call [1]",
        2,
        "an O word is a subroutine",
        "flatten",
    ),
    ("G21\nL100 P2", 2, "a call L is a subroutine", "flatten"),
    ("G21\nG98 C1", 2, "the label G98", "flatten"),
    (
        "G21\nPRINT_START BED=60",
        2,
        "PRINT is no word",
        "write macros out",
    ),
    // Codes that move the tool in ways that are not followed, or change where it goes.
    (
        "G21\nG0 X0\nG41 D1 X1",
        3,
        "G41 (cutter radius compensation on)",
        "compensation in computer",
    ),
    (
        "G21\nG42.1 D3",
        2,
        "G42.1 (cutter radius compensation on)",
        "centre line of the tool",
    ),
    (
        "G21\nG81 X1 Y1 Z-5 R2 F100",
        2,
        "G81 (canned cycles)",
        "G0 and G1 to G3",
    ),
    (
        "G21\nG73 X1 Z-5 R2 Q1",
        2,
        "G73 (canned cycles)",
        "G0 and G1 to G3",
    ),
    ("G21\nG52 X5", 2, "G52 (local offset)", "G54 to G59"),
    (
        "G21\nG53 G1 Z0 F100",
        2,
        "a feed in machine coordinates",
        "part coordinates",
    ),
    (
        "G21 G91\nG53 G0 Z0",
        2,
        "G53 stands beside increments",
        "G90",
    ),
    ("G21\nG53 Z0", 2, "G53 without a motion word", "G53 G0"),
    (
        "G21\nG0 X0\nG43.1 Z5 G0",
        3,
        "beside G43.1 or G43.2 are lengths to some",
        "block of its own",
    ),
    (
        "G21\nG10 L2 P1 X0",
        2,
        "G10 (set offsets or tool data)",
        "--work-offset",
    ),
    (
        "G21\nG28.1",
        2,
        "G28.1 (homing, setting of reference points)",
        "by hand",
    ),
    (
        "G21\nG28 G1 X5 F100",
        2,
        "G28 and another code that may take the axis words",
        "two blocks",
    ),
    (
        "G21\nG30 G92 Z0",
        2,
        "G30 and another code that may take the axis words",
        "two blocks",
    ),
    ("G28 X5", 1, "before it names its units", "G21 (mm)"),
    (
        "G21\nG28 G30 Z0",
        2,
        "meets another code of its group",
        "two blocks",
    ),
    (
        "G21\nG0 X0 Y0 Z0\nG28 Z0\nX5 Y5\nG1 Z-1 F100",
        5,
        "line 3 sent the tool to a place of the machine, so where the tool is along Z is not known here, and this block cuts",
        "a rapid (G0) and an absolute Z word",
    ),
    (
        "G21\nG0 X0 Y0 Z0\nG53 G0 X0\nG3 X5 Y5 R5 F100",
        4,
        "line 3 sent the tool to a place of the machine, so where the tool is along X",
        "an absolute X word",
    ),
    (
        "G21\nG0 X0 Y0 Z0\nG43.1 X2 Z5\nG0 Z5\nG1 X5 F100",
        5,
        "line 3 changed the tool length, so where the tool is along X",
        "an absolute X word",
    ),
    (
        "G21\nG0 X0 Y0 Z0\nG30\nG92 Y5",
        4,
        "line 3 sent the tool to a place of the machine, so by how much G92 shifts the Y coordinates",
        "before G92",
    ),
    (
        "G21\nG68 X0 Y0 R45",
        2,
        "G68 (rotation of coordinates)",
        "turned coordinates",
    ),
    ("G21\nG51 X2", 2, "G51 (scaling, mirroring)", "full size"),
    (
        "G21\nG5 X1 Y1 I1 J1 P1 Q1",
        2,
        "G5 (spline",
        "G0 and G1 to G3",
    ),
    ("G21\nG33 Z-5 K1", 2, "G33 (threading", "not compensated"),
    ("G21\nG38.2 Z-5 F10", 2, "G38.2 (probing)", "by hand"),
    (
        "G21\nG43.4 H1",
        2,
        "G43.4 (tool length offset with tool point control",
        "G43 H with a Z word",
    ),
    (
        "G21\nG0 X0 Y0 Z0\nG43 H1\nG0 X5\nG1 X6 F9",
        5,
        "line 3 changed the tool length",
        "absolute Z word",
    ),
    (
        "G21\nG0 X0 Y0 Z0\nG43 H1 G1 Z5 F1",
        3,
        "line 3 changed the tool length",
        "absolute Z word",
    ),
    ("G21\nG16", 2, "G16 (polar coordinates on)", "Cartesian"),
    ("G21\nG7", 2, "G7 (lathe diameter mode)", "G8"),
    ("G21\nG777 X1", 2, "G777 is not known here", "remove it"),
    ("G21\nG1.7 X1", 2, "G1.7 is not known here", "remove it"),
    ("G21\nM72", 2, "M72 (restore modal state)", "as words"),
    ("G21\nM206 X5", 2, "M206 (home offsets)", "at the machine"),
    (
        "G21\nM290 Z0.1",
        2,
        "M290 (live shift of an axis)",
        "remove it",
    ),
    (
        "G21\nG0 X0\nM101 X5",
        3,
        "its parameter to printers and a motion to mills",
        "with G0 or G1",
    ),
    (
        "G21\nG0 X0\nM323 X5",
        3,
        "its parameter to printers and a motion to mills",
        "with G0 or G1",
    ),
    (
        "G21\nG54.1 P3",
        2,
        "an extended work coordinate system",
        "G54 to G59.3",
    ),
    // Modes and words that do not fit.
    (
        "G1 X1 F100",
        1,
        "before it names its units",
        "G21 (mm) or G20 (inch)",
    ),
    (
        "G21\nX1",
        2,
        "without a motion word",
        "write G0, G1, G2 or G3",
    ),
    (
        "G21\nG0 X1\nG80\nX2",
        4,
        "without a motion word",
        "after G80",
    ),
    (
        "G21\nG0 G1 X1",
        2,
        "meets another code of its group",
        "two blocks",
    ),
    (
        "G20 G21",
        1,
        "meets another code of its group",
        "two blocks",
    ),
    (
        "G21\nG1 X5 R2 F10",
        2,
        "R appears in a straight move",
        "remove the word",
    ),
    (
        "G21\nG1 X5 I2 F10",
        2,
        "I appears in a straight move",
        "remove the word",
    ),
    ("G21\nG4 X1 G1 Y5", 2, "a dwell and a motion", "two blocks"),
    ("G21\nG4 S5 G0 Y5", 2, "a dwell and a motion", "two blocks"),
    (
        "G21\nG4 P1 G2 X5 I2.5",
        2,
        "a dwell and a motion",
        "two blocks",
    ),
    (
        "G21\nG0 X0\nG4 P1 X5",
        3,
        "a dwell and a motion",
        "two blocks",
    ),
    (
        "G21\nG92",
        2,
        "G92 without an axis",
        "each axis with its coordinate",
    ),
    ("G21\nG92 X0 G1", 2, "G92 and a motion word", "two blocks"),
    (
        "G21\nG0 X0\nG92.1 X5",
        3,
        "an axis word appears in a block that clears",
        "a block of its own",
    ),
    (
        "G21\nG0 X10 Y0 Z5\nG92.3\nG0 Z50",
        4,
        "line 3 shifted the X coordinates by an offset that is not in the program",
        "begin with G92.1",
    ),
    ("G21\nG1 X5 F0", 2, "a feed of 0 is no feed", "above zero"),
    (
        "G21 G93\nG1 X5 F2\nX6",
        3,
        "every feed block needs its own F",
        "write F into the block",
    ),
    (
        "G21\nG1 X5 F100\nG20\nG1 X1",
        4,
        "the units were named after the F",
        "write F again",
    ),
    // LinuxCNC runs this at 10 mm/min, grbl at 254.
    (
        "G21\nG1 X5 F100\nG20 G1 X1 F10",
        3,
        "or changed in its block",
        "write F again in a block after",
    ),
    (
        "G21\nG0 X0 Y0\nM2\nG1 X1 F5",
        4,
        "follows the program's end on line 3",
        "remove the blocks",
    ),
    (
        "G21 G90 G17\nG0 X0 Y0 Z5\nG1 Z0 F300\n%\nG1 X50 Y60 Z3\nM2",
        5,
        "follows the closing tape mark % on line 4: some controllers run on, some stop",
        "remove the blocks after %, or the % before them",
    ),
    (
        "%\nG21\nG0 X0 Y0\nM30\n%\nO2\nN10 X5",
        7,
        "follows the closing tape mark % on line 5",
        "remove the blocks",
    ),
    // Arcs.
    (
        "G21\nG2 X10 Y0 F100",
        2,
        "neither a radius R nor a centre",
        "write I J K or R",
    ),
    (
        "G21\nG2 X10 Y0 I5 R5 F100",
        2,
        "a radius R and a centre",
        "keep one",
    ),
    (
        "G21\nG2 X10 Y0 I5 P2 F100",
        2,
        "P in an arc counts turns",
        "one block for each turn",
    ),
    (
        "G21\nG2 X10 Y0 I5.1 F100",
        2,
        "5.1000 mm at its start and 4.9000 mm at its end",
        "arc tolerance",
    ),
    (
        "G21\nG2 X10 Y0 R4 F100",
        2,
        "the radius 4.0000 mm is too small",
        "check R",
    ),
    (
        "G21\nG2 X0 Y0 R4 F100",
        2,
        "its centre could be anywhere",
        "full circles with I J K",
    ),
    (
        "G21\nG2 X10 Y0 I5 K3 F100",
        2,
        "K is not in the plane",
        "G17, G18 or G19",
    ),
    (
        "G21 G90.1\nG2 X10 Y0 I5 F100",
        2,
        "the centre needs both words, J is missing",
        "both coordinates",
    ),
    // LinuxCNC makes two turns of each.
    (
        "G21\nG0 X0 Y0\nG3 I5 F100 M3 P2",
        3,
        "P in an arc counts turns",
        "one block for each turn",
    ),
    (
        "G21\nG0 X0 Y0\nG64 P2 G3 I5 F100",
        3,
        "P in an arc counts turns",
        "one block for each turn",
    ),
    (
        "G21\nG2 I0 J0 F100",
        2,
        "the arc has a radius of 0 mm",
        "straight move",
    ),
    (
        "G21\nG3 X0 Y0.000001 I-5 F100",
        2,
        "controllers disagree whether this is a full circle",
        "exactly where it starts",
    ),
    // 8e-7 and 4e-7 rad: whole circles of 1 m by LinuxCNC's limit of 1e-6, the second by grbl's of 5e-7.
    (
        "G21\nG0 X1000 Y0\nG3 X1000 Y0.0008 I-1000 F100",
        3,
        "controllers disagree whether this is a full circle",
        "exactly where it starts",
    ),
    (
        "G21\nG0 X1000 Y0\nG3 X1000 Y0.0004 R1000 F100",
        3,
        "controllers disagree whether this is a full circle",
        "write a straight move",
    ),
];

#[test]
fn every_bad_program_is_refused_with_line_reason_and_remedy() {
    for (text, line, reason, remedy) in BAD {
        let Some(error) = refusal(text.as_bytes(), true) else {
            panic!("{text:?} was taken")
        };
        let message = error.to_string();
        println!("{message}");
        assert_eq!(error.line, *line, "{text:?}: {message}");
        assert!(error.reason.contains(reason), "{text:?}: {message}");
        assert!(error.remedy.contains(remedy), "{text:?}: {message}");
        assert!(
            !message.contains("by option"),
            "the option has a name: {message}"
        );
        assert!(message.starts_with(&format!("line {line}: `")), "{message}");
        assert!(
            error.span.end <= text.len() && error.span.start <= error.span.end,
            "{text:?}: {:?}",
            error.span
        );
        if let Some(text_of_line) = text.lines().nth(line - 1)
            && text_of_line
                .chars()
                .all(|character| !character.is_control())
        {
            assert_eq!(error.found, text_of_line.trim());
        }
    }
}

#[test]
fn motion_from_an_unknown_place_is_refused_where_the_place_matters() {
    let cases = [
        (
            "G21 G91\nG1 X5 F100",
            2,
            "an incremental feed from a place whose X",
        ),
        (
            "G21\nG2 X5 Y5 R5 F100",
            2,
            "the arc starts at a place whose X",
        ),
        (
            "G21\nG0 X0\nG2 X5 Y5 I5 F100",
            3,
            "the arc starts at a place whose Y",
        ),
        // Where the tool stood before G92 only the machine knows, so afterwards X would be written in
        // other coordinates than those in force.
        (
            "G21\nG92 X10 Y0 Z5\nG1 X20 F300\nG92.1\nG0 Z50",
            5,
            "line 4 shifted the X coordinates by an offset that is not in the program",
        ),
        (
            "G21\nG92 X10 Y0 Z5\nG92.2\nG92 X4 Y4\nG0 X5",
            5,
            "line 4 shifted the Z coordinates",
        ),
        (
            "G21\nG0 X0 Y0\nG2 X5 Y5 Z1 I5 F100",
            3,
            "the arc starts at a place whose Z",
        ),
        (
            "G21\nG0 X0 Y0\nG2 X10 Y0 I5 F100\nG0 Z5",
            3,
            "before the program has stated all axes",
        ),
    ];
    for (text, line, reason) in cases {
        let error = refusal(text.as_bytes(), false).unwrap();
        assert_eq!(error.line, line, "{error}");
        assert!(error.reason.contains(reason), "{error}");
        assert!(error.remedy.contains("--start-position-mm"), "{error}");
    }
}

#[test]
fn a_line_without_end_and_other_encodings_are_refused() {
    let long = [b"G1 X1 (".as_slice(), &vec![b'a'; 70_000], b")"].concat();
    let error = refusal(&long, true).unwrap();
    assert!(error.reason.contains("the line has 70008 bytes"), "{error}");
    assert!(error.found.len() < 100, "the excerpt is short");
    let error = refusal(b"\xff\xfeG\x002\x001\x00", true).unwrap();
    assert!(error.reason.contains("UTF-16"), "{error}");
}

#[test]
fn control_characters_of_a_comment_never_reach_the_terminal() {
    // A terminal escape in a comment is a control character, so the file is refused, and the message
    // shows its number instead.
    let error = refusal(b"G21\nG1 X1 (\x1b[2J)", true).unwrap();
    let message = error.to_string();
    assert!(message.contains("\\x1b[2J"), "{message:?}");
    assert!(!message.contains('\x1b'));
}

#[test]
fn no_bytes_make_the_reader_panic() {
    use proptest::prelude::*;
    let line = prop_oneof![
        proptest::collection::vec(any::<u8>(), 0..40),
        "[GXYZIJKRFMNOE0-9. +\\-()%;/#*]{0,30}".prop_map(String::into_bytes),
        "(G[0-9]{1,2} ?)?([XYZIJKRFE]-?[0-9]{1,3}(\\.[0-9]{1,5})? ?){0,5}"
            .prop_map(String::into_bytes),
    ];
    let program = proptest::collection::vec(line, 0..12)
        .prop_map(|lines| [b"G21\nG0X0Y0Z0\n".to_vec(), lines.join(&b'\n')].concat());
    proptest!(ProptestConfig::with_cases(2000), |(bytes in program)| {
        if let Ok(program) = Program::read(bytes.clone()) {
            prop_assert_eq!(program.bytes(), &bytes[..]);
            let reading = ReadOptions::default();
            if let Ok(path) = interpret(&program, &reading) {
                let writing = { let mut writing = WriteOptions::default(); writing.again = true; writing };
                let field = |request: &Request| Ok(0.01 * request.position_mm.map(|x| (x * 0.01).sin()));
                match write_corrected(&program, &path, &field, &writing, &Unwatched) {
                    Ok(written) => {
                        let checked = verify_written(&program, &path, &written, &reading, &writing);
                        prop_assert!(checked.is_ok(), "{:?}\n{}\n{}", checked, String::from_utf8_lossy(&bytes), String::from_utf8_lossy(&written.bytes));
                    }
                    Err(error) => prop_assert!(matches!(error, WriteError::ExtraAxis { .. } | WriteError::TooManyPieces { .. } | WriteError::LineTooLong { .. }), "{}", error),
                }
            }
        }
    });
}

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
