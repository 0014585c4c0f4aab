//! Which way the spindle turns and how fast, block by block, and the feed in a turn of it.

// Helpers of tests, which clippy does not count as tests.
use kinetostat_program::*;
use proptest::prelude::*;

use SpindleRotation::{Clockwise, CounterClockwise, Stopped};

fn path(text: &str) -> Result<Path, ProgramError> {
    interpret(&Program::read(text)?, &ReadOptions::default())
}

/// Rotation and speed on each line of a program, from line 2.
fn states(text: &str) -> Vec<(SpindleRotation, Option<f64>)> {
    let path = path(text).unwrap_or_else(|error| panic!("{error}"));
    let lines = text.lines().count();
    (2..=lines)
        .map(|line| path.spindle_on(line))
        .map(|spindle| (spindle.rotation, spindle.speed))
        .collect()
}

#[test]
fn rotation_and_speed_hold_until_other_words() {
    let text = "G21 G90\nS500\nM3\nG0 X0 Y0 Z0\nG1 X1 F50 S700\nM5\nM4\nM0\nG1 X2\nM19 R90\nM3 S0\nM5\nM30\n";
    let (on, off) = (Some(700.0), Stopped);
    let expected = [
        (off, Some(500.0)),
        (Clockwise, Some(500.0)),
        (Clockwise, Some(500.0)),
        (Clockwise, on),
        (off, on),
        (CounterClockwise, on),
        // A pause stops the motion, not the spindle.
        (CounterClockwise, on),
        (CounterClockwise, on),
        (off, on),
        (Clockwise, Some(0.0)),
        (off, Some(0.0)),
        (off, Some(0.0)),
    ];
    assert_eq!(states(text), expected);
    // Before the first word, and without any.
    let none = path("G21 G90\nG0 X0 Y0 Z0\n").unwrap();
    assert_eq!(none.spindle_on(2), Spindle::default());
    assert!(none.spindle_changes.is_empty());
    assert_eq!(none.spindle_on(2).rpm(), Some(0.0));
    let unknown = path("G21\nM3\n").unwrap().spindle_on(2);
    assert_eq!((unknown.rotation, unknown.rpm()), (Clockwise, None));
}

/// LinuxCNC: S, then M6 (which stops the spindle), then M3 to M5, then the motion, then the end.
#[test]
fn words_of_one_block_are_taken_in_the_order_of_execution() {
    for (line, rotation, speed) in [
        ("M3 S900", Clockwise, 900.0),
        ("M13 S900", Clockwise, 900.0),
        ("S900 M14", CounterClockwise, 900.0),
        ("M5 S900", Stopped, 900.0),
        ("T2 M6", Stopped, 100.0),
        ("M6", Stopped, 100.0),
        ("M4 T2 M6 S900", CounterClockwise, 900.0),
        ("M6 M3", Clockwise, 100.0),
        // Said of a tool that is in the spindle already.
        ("M61 Q2", Clockwise, 100.0),
        ("T2", Clockwise, 100.0),
        ("M2", Stopped, 100.0),
        ("M30 S900", Stopped, 900.0),
        ("M60", Clockwise, 100.0),
        ("M1", Clockwise, 100.0),
        ("%", Clockwise, 100.0),
        // Speeds beside a dwell; without another word S is the dwell's.
        ("M4 S900 G4 P2", CounterClockwise, 900.0),
        ("G4 S2", Clockwise, 100.0),
        ("M19 S45", Stopped, 100.0),
        // Vendors' commands, whose S is their own.
        ("M104 S210", Clockwise, 100.0),
        ("M280 P0 S-90", Clockwise, 100.0),
        ("(M5 S3)", Clockwise, 100.0),
    ] {
        let text = format!("G21 G90\nT1 M6\nM3 S100\n{line}\n");
        let found = states(&text)[2];
        assert_eq!(found, (rotation, Some(speed)), "{text}");
    }
}

#[test]
fn the_end_of_the_program_stops_the_spindle_after_the_motion_of_its_block() {
    let text = "G21 G90\nM3 S100\nG0 X0 Y0 Z0\nG1 X5 F100 M2\nM3\n(note)\n";
    let path = path(text).unwrap();
    let rotation = |line| path.spindle_on(line).rotation;
    assert_eq!([4, 5, 6].map(rotation), [Clockwise, Stopped, Stopped]);
    // What follows the end is not executed, and one line has one state.
    let at_once = self::path("G21 G90\nM3 S100 M30\nM4 S5\n").unwrap();
    assert_eq!(at_once.spindle_changes.len(), 1);
    assert_eq!(at_once.spindle_on(2).rotation, Stopped);
    assert_eq!(at_once.spindle_on(3).speed, Some(100.0));
}

#[test]
fn blocks_that_are_skipped_do_not_turn_the_spindle() {
    let text = "G21 G90\n/M3 S100\nM4 S50\n/M5\nG0 X0 Y0 Z0\n";
    let mut reading = ReadOptions::default();
    let program = Program::read(text).unwrap();
    let run = interpret(&program, &reading).unwrap();
    assert_eq!(run.spindle_on(2).rotation, Clockwise);
    assert_eq!(run.spindle_on(5).rotation, Stopped);
    reading.block_delete = BlockDelete::Skip;
    let skipped = interpret(&program, &reading).unwrap();
    assert_eq!(skipped.spindle_on(2), Spindle::default());
    assert_eq!(skipped.spindle_on(5).rotation, CounterClockwise);
}

#[test]
fn constant_surface_speed() {
    let metric = path("G21 G90\nG96 D2500 S180 M3\n").unwrap().spindle_on(2);
    let most = Some(2500.0);
    assert_eq!(metric.mode, SpeedMode::ConstantSurface { most_rpm: most });
    assert_eq!(metric.rpm(), None);
    // 600 feet/min are 182.88 m/min.
    let inches = path("G20 G90\nG96 S600 M4\n").unwrap().spindle_on(2);
    assert_eq!(inches.mode, SpeedMode::ConstantSurface { most_rpm: None });
    assert!((inches.speed.unwrap() - 182.88).abs() < 1e-12);
    // Metres stay metres when the units change; beside the change nobody can tell.
    let later = path("G21 G90\nG96 S100 M3\nG20\nG20 S300\nG21 S100\n").unwrap();
    let speed = |line| later.spindle_on(line).speed;
    assert_eq!(speed(3), Some(100.0));
    assert!((speed(4).unwrap() - 91.44).abs() < 1e-12);
    assert_eq!(speed(5), None);
    // An S of one mode is none of the other; standing still is known in both.
    let modes =
        path("G21\nS900 M3\nG96\nG97\nG97 S800\nG96 S80 M5\nG96 D900\nG97 D1 S1\n").unwrap();
    let states: Vec<_> = (2..=8).map(|line| modes.spindle_on(line)).collect();
    let speeds: Vec<_> = states.iter().map(|spindle| spindle.speed).collect();
    let wanted = [
        Some(900.0),
        None,
        None,
        Some(800.0),
        Some(80.0),
        Some(80.0),
        Some(1.0),
    ];
    assert_eq!(speeds, wanted);
    assert_eq!(
        states[5].mode,
        SpeedMode::ConstantSurface {
            most_rpm: Some(900.0)
        }
    );
    assert_eq!(states[3].rpm(), Some(800.0));
    // D0 is no largest speed.
    let zero = path("G21\nG96 S80 D0 M3\n").unwrap().spindle_on(2);
    assert_eq!(zero.mode, SpeedMode::ConstantSurface { most_rpm: None });
}

#[test]
fn speeds_that_are_none_are_refused_by_line() {
    for words in [
        "M3 S-1",
        "S-0.001",
        "S1000001",
        "G96 S50 D-3",
        "S",
        "M3 S",
        "G96 D",
        "G4 P1 S-2",
        "G1 X5 F9 S-7",
    ] {
        let text = format!("G21 G90\nG0 X0 Y0 Z0\n{words}\nM5\n");
        let error = path(&text).expect_err(&text);
        assert_eq!(error.line, 3, "{error}");
        assert_eq!(error.kind, ProgramErrorKind::Malformed, "{error}");
        assert_eq!(faults(text.as_bytes(), &ReadOptions::default()).len(), 1);
    }
    let error = path("G21\nM3 S-200\n").unwrap_err().to_string();
    assert!(
        error.contains("`M3 S-200`: -200 is not a speed of the spindle"),
        "{error}"
    );
}

#[test]
fn feed_in_a_turn_and_in_a_minute() {
    // 10 mm: 400 mm/min; two blocks a minute are 20 mm/min; 0.1 mm a turn; the same in inches.
    let text = "G21 G90\nS2000 M3\nG0 X0 Y0 Z0\nG1 X10 F400\nG93 X20 F2\nG95 X30 F0.1\nG94 X40\nG20 G94\nG1 X2 F4\nG95 X3 F0.01\nG0 X0\n";
    let path = path(text).unwrap();
    let on = |line: usize| path.moves.iter().find(|m| m.line == line).unwrap();
    let near = |found: Option<f64>, wanted: f64| (found.unwrap() - wanted).abs() < 1e-12;
    for (line, minute, turn) in [
        (4, 400.0, 0.2),
        (5, 20.0, 0.01),
        (6, 200.0, 0.1),
        (9, 101.6, 0.0508),
        (10, 508.0, 0.254),
    ] {
        assert!(
            near(on(line).feed_mm_per_minute(2000.0), minute),
            "line {line}"
        );
        assert!(
            near(on(line).feed_mm_per_revolution(2000.0), turn),
            "line {line}"
        );
    }
    // A rapid has none, nor a block before the F; a feed of time over no turn is none.
    for line in [3, 7, 11] {
        assert_eq!(on(line).feed_mm_per_minute(2000.0), None, "line {line}");
        assert_eq!(on(line).feed_mm_per_revolution(2000.0), None, "line {line}");
    }
    assert_eq!(on(4).feed_mm_per_revolution(0.0), None);
    assert_eq!(on(4).feed_mm_per_revolution(f64::NAN), None);
    assert!(near(on(6).feed_mm_per_revolution(0.0), 0.1));
    assert_eq!(on(6).feed_mm_per_minute(0.0), Some(0.0));
}

/// What a word does, in the order of execution: (rank, effect).
#[derive(Clone, Copy, Debug, PartialEq)]
enum Effect {
    Speed(f64),
    Change,
    Turn(SpindleRotation),
    Nothing,
}

/// Words, the rank at which LinuxCNC executes them, and what they do.
const WORDS: [(&str, u32, Effect); 9] = [
    ("S1200", 1, Effect::Speed(1200.0)),
    ("S37.5", 1, Effect::Speed(37.5)),
    ("T3 M6", 2, Effect::Change),
    ("M3", 3, Effect::Turn(Clockwise)),
    ("M04", 3, Effect::Turn(CounterClockwise)),
    ("M5", 3, Effect::Turn(Stopped)),
    ("M8", 4, Effect::Nothing),
    ("G17", 5, Effect::Nothing),
    ("G0 X5", 6, Effect::Nothing),
];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// A second reader of spindle words: any words in any order, one of a kind in a block.
    #[test]
    fn any_words_in_any_order(blocks in proptest::collection::vec(proptest::sample::subsequence((0..WORDS.len()).collect::<Vec<_>>(), 0..=4).prop_shuffle(), 0..30)) {
        let mut text = "G21 G90\n".to_owned();
        let mut wanted = Vec::new();
        let (mut turning, mut speed) = (Stopped, None);
        for block in &blocks {
            let mut picked: Vec<(&str, u32, Effect)> = Vec::new();
            for index in block {
                if picked.iter().all(|other| other.1 != WORDS[*index].1) {
                    picked.push(WORDS[*index]);
                }
            }
            text.push_str(&picked.iter().map(|word| word.0).collect::<Vec<_>>().join(" "));
            text.push('\n');
            for rank in 1..=6 {
                match picked.iter().find(|word| word.1 == rank).map(|word| word.2) {
                    Some(Effect::Speed(rpm)) => speed = Some(rpm),
                    Some(Effect::Change) => turning = Stopped,
                    Some(Effect::Turn(rotation)) => turning = rotation,
                    _ => {}
                }
            }
            wanted.push((turning, speed));
        }
        let path = path(&text).unwrap_or_else(|error| panic!("{text}{error}"));
        for (index, wanted) in wanted.iter().enumerate() {
            let found = path.spindle_on(index + 2);
            prop_assert_eq!((found.rotation, found.speed), *wanted, "line {} of\n{}", index + 2, text);
        }
        let lines: Vec<usize> = path.spindle_changes.iter().map(|change| change.line).collect();
        prop_assert!(lines.windows(2).all(|pair| pair[0] < pair[1]), "{:?}", lines);
    }
}
