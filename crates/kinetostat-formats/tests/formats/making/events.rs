//! What stands beside the moves: notes with their lines, pauses that stay, and what is lost, named.

use kinetostat_formats::*;

use super::{cell, gcode, made, text_of};

const TEXT: &str = "G21 G90 (setup)\nS8000 M3\nG0 X0 Y0 Z5\nM8\nG1 Z-1 F300\nG4 X0.5\nG1 X10 M9\nM0\nG1 X20\nM117 hello\nM5\nM30\n";

#[test]
fn they_are_notes_at_their_places() {
    let text = text_of(&made(TEXT, &cell(), MakeLanguage::Krl), 0);
    let order = [
        "; line 1: (setup",
        "; line 2: S8000 M3",
        "PTP {",
        "; line 4: M8",
        "Z -1.0",
        "WAIT SEC 0.5",
        "X 10.0",
        "; line 7: M9",
        "HALT",
        "X 20.0",
        "; line 11: M5",
        "; line 12: M30",
    ];
    let mut at = 0;
    for words in order {
        let words = words.replace("(setup", "[setup]");
        let found = text[at..]
            .find(&words)
            .unwrap_or_else(|| panic!("{words} behind {at}: {text}"));
        at += found;
    }
    let rapid = text_of(&made(TEXT, &cell(), MakeLanguage::Rapid), 0);
    assert!(
        rapid.contains("WaitTime 0.5;\n") && rapid.contains("Stop;\n"),
        "{rapid}"
    );
    let ls = text_of(&made(TEXT, &cell(), MakeLanguage::FanucLs), 0);
    assert!(
        ls.contains("  WAIT   0.50(sec) ;\n") && ls.contains("  PAUSE ;\n"),
        "{ls}"
    );
}

#[test]
fn what_is_lost_is_named() {
    let made = made(TEXT, &cell(), MakeLanguage::Krl);
    let said = |words: &str| {
        made.findings
            .iter()
            .any(|finding| finding.message.contains(words))
    };
    assert!(
        said("spindle: 2 lines are notes now, and do nothing there (line 2: S8000 M3)"),
        "{:?}",
        made.findings
    );
    assert!(said(
        "coolant: 2 lines are notes now, and do nothing there (line 4: M8)"
    ));
    assert!(said("other statements: 1 line "));
    assert!(!said("dwells") && !said("stops: "));
    let table = super::made(TEXT, &cell(), MakeLanguage::Csv);
    assert!(
        table
            .findings
            .iter()
            .any(|f| f.message.contains("stops: 1 line "))
    );
}

#[test]
fn a_dwell_of_unknown_unit_is_a_note() {
    let made = made(
        "G21 G90\nG0 X0 Y0 Z0\nG4 P500\nG1 X5 F60\n",
        &cell(),
        MakeLanguage::Rapid,
    );
    let text = text_of(&made, 0);
    assert!(
        !text.contains("WaitTime") && text.contains("! line 3: G4 P500"),
        "{text}"
    );
    assert!(
        made.findings
            .iter()
            .any(|f| f.message.contains("dwells: 1 line "))
    );
}

#[test]
fn motions_before_a_pause_stop_exactly() {
    let text = text_of(&made(TEXT, &cell(), MakeLanguage::Krl), 0);
    let lines: Vec<&str> = text
        .lines()
        .filter(|line| line.starts_with("LIN"))
        .collect();
    // Before the dwell, before the stop, at the end.
    assert!(lines.iter().all(|line| !line.ends_with("C_DIS")), "{text}");
    let (_, path) = gcode("G21 G90\nG0 X0 Y0 Z5\nG1 Z0 F60\nG1 X5\nG1 X9\nG0 Z5\nG0 X0\n");
    let made = make(&path, &[], &cell(), MakeLanguage::Krl).unwrap();
    let text = text_of(&made, 0);
    let ends: Vec<bool> = text
        .lines()
        .filter(|l| l.starts_with("LIN"))
        .map(|l| l.ends_with(" C_DIS"))
        .collect();
    assert_eq!(ends, [true, true, false, true, false], "{text}");
}

#[test]
fn notes_end_no_comment_and_no_line() {
    let text = "G21 G90\nG0 X0 Y0 Z0\n(a \u{e4} \"q\")\n; b ) ; ! c\nG1 X5 F60\n";
    for language in [
        MakeLanguage::Krl,
        MakeLanguage::Rapid,
        MakeLanguage::FanucLs,
        MakeLanguage::Apt,
        MakeLanguage::Csv,
        MakeLanguage::Gcode,
    ] {
        let (program, path) = gcode(text);
        let mut events = events_of_gcode(&program, &path);
        events[0].text.push_str(" \u{1b}[31m\r\n END ");
        let made = make(&path, &events, &cell(), language).unwrap();
        assert_eq!(made.kept.motions, 2, "{language:?}");
        assert!(
            text_of(&made, 0)
                .bytes()
                .all(|byte| matches!(byte, b'\n' | b'\t' | b' '..=b'~'))
        );
    }
}

#[test]
fn a_block_that_a_switch_leaves_out_stops_nothing() {
    let made = made(
        "O100\nG21 G90\nG0 X0 Y0 Z0\n/M0\nG1 X5 F60\n",
        &cell(),
        MakeLanguage::Krl,
    );
    let text = text_of(&made, 0);
    assert!(
        !text.contains("HALT")
            && text.contains("; line 4: M0\n")
            && text.contains("; line 1: O100\n"),
        "{text}"
    );
}

/// What was compensated is known to be so in the other language, too.
#[test]
fn the_mark_of_a_compensated_program_stays_whole() {
    let text = format!(
        "({})\nG21 G90\nG0 X0 Y0 Z0\nG1 X5 F60\n",
        kinetostat_program::COMPENSATED_MARK
    );
    for (into, language) in super::ROBOTS {
        let made = made(&text, &cell(), into);
        assert!(
            text_of(&made, 0).contains(kinetostat_program::COMPENSATED_MARK),
            "{}",
            text_of(&made, 0)
        );
        let program = super::read_made(&made, language);
        let path = path_of(&program, &PathOptions::default()).unwrap();
        let robot = Correctable {
            program: &program,
            path: &path,
            reading: &ReadOptions::default(),
            making: &PathOptions::default(),
            writing: &WriteOptions::default(),
        };
        let writing = kinetostat_program::WriteOptions::default();
        let refused = kinetostat_program::MachineProgram::write(
            &robot,
            &kinetostat_program::NoCorrection,
            &writing,
            &kinetostat_program::Unwatched,
        );
        assert!(matches!(
            refused,
            Err(kinetostat_program::WriteError::AlreadyCompensated { .. })
        ));
    }
}
