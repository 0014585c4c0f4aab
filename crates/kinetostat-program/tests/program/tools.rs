//! Tools that change, axes that turn the part, and all faults of a program at once.

// Helpers of tests, which clippy does not count as tests.
use kinetostat_program::*;
use proptest::prelude::*;

fn path_with(text: &str, options: &ReadOptions) -> Result<Path, ProgramError> {
    interpret(&Program::read(text)?, options)
}

fn warned(path: &Path, text: &str) -> Vec<usize> {
    path.warnings
        .iter()
        .filter(|warning| warning.text.contains(text))
        .map(|warning| warning.line)
        .collect()
}

const TWO_TOOLS: &str = "G21 G90\nT1 M6\nG43 H1 G0 Z50\nG0 X0 Y0\nG1 X10 F100\nG0 Z50\nT2 M6\nG43 H2 G0 Z50\nG1 X0\nT1 M6\nG0 Z50\n";

#[test]
fn a_second_tool_is_warned_of_by_line() {
    let path = path_with(TWO_TOOLS, &ReadOptions::default()).unwrap();
    assert_eq!(warned(&path, "one tool length and one load"), [7]);
    let on = |line| path.tool_on(line);
    assert_eq!(
        [on(1), on(2), on(5), on(9), on(11)],
        [None, Some(1), Some(1), Some(2), Some(1)]
    );
    // Without M6 it is the T, without T the H.
    for (text, line) in [
        ("G21 G90\nT1\nG0 X0 Y0 Z0\nT2\nG1 X5 F9\n", 4),
        ("G21 G90\nG43 H1 G0 Z5\nG0 X0 Y0\nG43 H2 G0 Z5\n", 4),
        ("G21 G90\nT1 M6\nG0 X0 Y0 Z0\nM61 Q2\nG1 X5 F9\n", 4),
        ("G21 G90\nT1 M6\nT2 (ready)\nG0 X0 Y0 Z0\nM6\nG1 X5 F9\n", 5),
    ] {
        let path = path_with(text, &ReadOptions::default()).unwrap();
        assert_eq!(
            warned(&path, "one tool length and one load"),
            [line],
            "{text}"
        );
    }
    // What was cut before was cut with the tool in the spindle.
    for change in ["T2 M6", "M6 T7", "T2", "M6", "G43 H2 G0 Z5"] {
        let text = format!("G21 G90\nG0 X0 Y0 Z0\nG1 X5 F9\nG0 Z5\n{change}\nG1 X9 F9\n");
        let path = path_with(&text, &ReadOptions::default()).unwrap();
        assert_eq!(warned(&path, "one tool length and one load"), [5], "{text}");
        let first = text.replace("G1 X5 F9", "G0 X5");
        let path = path_with(&first, &ReadOptions::default()).unwrap();
        assert!(warned(&path, "one tool length").is_empty(), "{first}");
    }
    // One tool, whose length is set where it always is, and the next one only made ready.
    let one = "G21 G90 G49\nT1 M6\nT2\nG43 H1 G0 Z5\nG0 X0 Y0\nG1 X5 F9\nG49\nM2\n";
    let path = path_with(one, &ReadOptions::default()).unwrap();
    assert!(
        path.warnings
            .iter()
            .all(|warning| !warning.text.contains("one tool length")
                && !warning.text.contains("another tool")),
        "{:?}",
        path.warnings
    );
}

#[test]
fn the_length_of_another_tool_is_warned_of() {
    let text = TWO_TOOLS.replace("H2", "H7");
    let path = path_with(&text, &ReadOptions::default()).unwrap();
    assert_eq!(
        warned(&path, "G43 H7 takes the length of another tool than T2"),
        [8]
    );
}

#[test]
fn with_a_table_of_tools_an_unknown_tool_and_a_change_beside_a_motion_are_refused() {
    let with = |tools: &[u32]| {
        let mut reading = ReadOptions::default();
        reading.tools = Some(tools.to_vec());
        reading
    };
    let path = path_with(TWO_TOOLS, &with(&[1, 2])).unwrap();
    assert!(warned(&path, "one tool length").is_empty());
    let error = path_with(TWO_TOOLS, &with(&[1])).unwrap_err();
    assert!(
        error.line == 7 && error.reason.contains("tool 2 is not among"),
        "{error}"
    );
    let beside = "G21 G90\nT1 M6\nG0 X0 Y0 Z0\nT2 M6 G0 X5\n";
    let error = path_with(beside, &with(&[1, 2])).unwrap_err();
    assert!(
        error.line == 4 && error.reason.contains("beside a motion"),
        "{error}"
    );
    let path = path_with("G21 G90\nG0 X0 Y0 Z0\nT1 M6\nG0 X5\n", &with(&[1])).unwrap();
    assert_eq!(warned(&path, "before the program has named a tool"), [2]);
    // What cuts before that needs a tool that is known.
    let unnamed = {
        let mut reading = with(&[1]);
        reading.tool_before_first = false;
        reading
    };
    let path = path_with("G21 G90\nG0 X0 Y0 Z0\nT1 M6\nG1 X5 F9\n", &unnamed).unwrap();
    assert_eq!(warned(&path, "a tool without length"), [2]);
    let cuts = "G21 G90\nG0 X0 Y0 Z0\nG1 X5 F9\nT1 M6\nG1 X9\n";
    let error = path_with(cuts, &unnamed).unwrap_err();
    assert!(
        error.line == 3 && error.reason.contains("before the program has named a tool"),
        "{error}"
    );
    path_with(cuts, &with(&[1])).unwrap();
}

#[test]
fn a_tool_that_is_no_number_is_refused() {
    for word in ["T2.5", "T-2", "T1e9"] {
        let text = format!("G21 G90\nT1 M6\nG0 X0 Y0 Z0\n{word} M6\nG1 X5 F9\n");
        let Err(error) = path_with(&text, &ReadOptions::default()) else {
            panic!("{text}");
        };
        assert_eq!(error.line, 4, "{text}{error}");
    }
}

#[test]
fn other_axes_are_refused_by_line_unless_they_are_said_to_stand_still() {
    let still = {
        let mut reading = ReadOptions::default();
        reading.other_axes = OtherAxes::StandStill;
        reading
    };
    for letter in "ABCUVW".chars() {
        for block in ["G0 X1 #0", "G1 #90 F100", "#-5.", "G92 #0"] {
            let text = format!(
                "G21 G90\nG0 X0 Y0 Z0\n{}\n",
                block.replace('#', &letter.to_string())
            );
            let error = path_with(&text, &ReadOptions::default()).unwrap_err();
            assert_eq!(error.line, 3, "{text}{error}");
            assert!(
                error.reason.contains(&format!("axis {letter} changes")),
                "{error}"
            );
            path_with(&text, &still).unwrap_or_else(|error| panic!("{text}{error}"));
        }
    }
    // The extruder of a printer is no axis that moves the tool.
    path_with(
        "G21 G90\nM82\nG0 X0 Y0 Z0\nG1 X1 E2 F100\n",
        &ReadOptions::default(),
    )
    .unwrap();
    let path = path_with(
        "G21 G90\nG0 X0 Y0 Z0 A0\nG1 X5 A0 F9\nG1 X6 A30\nG1 X7 A31\n",
        &still,
    )
    .unwrap();
    assert_eq!(warned(&path, "axis A moves from 0 to 30"), [4]);
    let path = path_with("G21 G90\nG0 X0 Y0 Z0 A0\nG1 X5 A0 F9\n", &still).unwrap();
    assert_eq!(
        warned(&path, "axis A is carried along and taken to stand still"),
        [2]
    );
}

/// Lines that are refused wherever they stand, and lines that are taken.
const BAD: [&str; 9] = [
    "G81 X1 Z-5 R2 F100",
    "G41 D1 X1",
    "G28.1",
    "G2.1 X5",
    "X[1+2]",
    "#100=5",
    "G1 X1.2.3",
    "G1 X5 R2 F10",
    "G1 A5 F100",
];
const GOOD: [&str; 6] = ["G1 X5 F100", "G0 Z5", "(note)", "M8", "X7 Y2", "G17"];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// Every bad line is named once, in order, and no other.
    #[test]
    fn all_faults_are_found_at_once_in_the_order_of_lines(picks in proptest::collection::vec((any::<bool>(), 0..18_usize), 0..40)) {
        let mut text = "G21 G90\nG0 X0 Y0 Z0\nG1 F100\n".to_owned();
        let mut wanted = Vec::new();
        for (index, (bad, pick)) in picks.iter().enumerate() {
            text.push_str(if *bad { BAD[pick % BAD.len()] } else { GOOD[pick % GOOD.len()] });
            text.push('\n');
            let is_variable = |line: &str| line.contains(['#', '[']);
            let again = is_variable(BAD[pick % BAD.len()])
                && text.lines().filter(|line| is_variable(line)).count() > 1;
            if *bad && !again {
                wanted.push(index + 4);
            }
        }
        let found = faults(text.as_bytes(), &ReadOptions::default());
        let lines: Vec<usize> = found.iter().map(|fault| fault.line).collect();
        prop_assert_eq!(&lines, &wanted, "{}\n{:?}", text, found);
        // The first is the one that reading ends with.
        let first = path_with(&text, &ReadOptions::default()).err();
        if let (Some(first), Some(found)) = (&first, found.first()) {
            // Reading looks at all lines before the first is interpreted.
            prop_assert!(first.line >= found.line);
        }
        prop_assert_eq!(first.is_some(), !wanted.is_empty());
    }

    /// No bytes make it panic, and it finds something exactly where reading does.
    #[test]
    fn faults_are_found_exactly_where_reading_refuses(bytes in proptest::collection::vec(prop_oneof![any::<u8>(), prop::sample::select(b"GXYZMF0123456789. \n\n%(".to_vec())], 0..200)) {
        let refused = Program::read(bytes.clone()).and_then(|program| interpret(&program, &ReadOptions::default())).is_err();
        prop_assert_eq!(faults(bytes, &ReadOptions::default()).is_empty(), !refused);
    }
}

#[test]
fn a_fault_of_the_whole_program_is_reported_once() {
    // No motion word, tool length: found in every block, reported in one.
    let no_word = faults("G21 F100\nX1\nX2\nX3\n".as_bytes(), &ReadOptions::default());
    assert_eq!(
        no_word.iter().map(|fault| fault.line).collect::<Vec<_>>(),
        [2]
    );
    let length = faults(
        "G21\nG0 X0 Y0 Z0\nG43 H1\nG0 X5\nG1 X6 F9\nX7\n".as_bytes(),
        &ReadOptions::default(),
    );
    assert_eq!(
        length.iter().map(|fault| fault.line).collect::<Vec<_>>(),
        [5]
    );
    assert!(faults(b"".as_slice(), &ReadOptions::default()).len() == 1);
}
