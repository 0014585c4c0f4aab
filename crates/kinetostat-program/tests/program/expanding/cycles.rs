//! Canned cycles, against their motions written out by hand from LinuxCNC's documentation.

#![allow(clippy::unwrap_used, reason = "a failing test may panic")]

use super::{flat, refused};

/// The flat blocks behind a start at X0 Y0 Z5.
fn blocks(text: &str) -> Vec<String> {
    let start = "G21 G90 G94\nM3 S1000\nG0 X0 Y0 Z5\n";
    let text = flat(&format!("{start}{text}\n"));
    text.lines().skip(3).map(str::to_owned).collect()
}

#[test]
fn drilling() {
    assert_eq!(
        blocks("G99 F100\nG81 X1 Y2 Z-3 R1\nX4\nG98 Y6 Z-4\nG80\nG0 Z9"),
        [
            "G99 F100", "G0 X1 Y2", "G0 Z1", "G1 Z-3", "G0 Z1", "G0 X4", "G1 Z-3", "G0 Z1", "G98",
            "G0 Y6 Z5", "G0 Z1", "G1 Z-4", "G0 Z5", "G80", "G0 Z9"
        ]
    );
}

#[test]
fn repeats_go_on_by_increments() {
    assert_eq!(
        blocks("G91 G99 F100\nG81 X2 Z-3 R-4 L3\nG80 G90"),
        [
            "G91 G99 F100",
            "G0 X2",
            "G0 Z-4",
            "G1 Z-3",
            "G0 Z3",
            "G0 X2",
            "G1 Z-3",
            "G0 Z3",
            "G0 X2",
            "G1 Z-3",
            "G0 Z3",
            "G80 G90"
        ]
    );
}

#[test]
fn each_cycle_has_its_motions() {
    let hole = |cycle: &str| blocks(&format!("G98 F100\n{cycle} X1 Y2 Z-2 R1\nG80"));
    let with = |middle: &[&'static str]| {
        let mut all: Vec<&'static str> = vec!["G98 F100", "G0 X1 Y2", "G0 Z1"];
        all.extend(middle);
        all.push("G80");
        all
    };
    assert_eq!(hole("G82 P0.5"), with(&["G1 Z-2", "G4 P0.5", "G0 Z5"]));
    assert_eq!(
        hole("G83 Q2"),
        with(&["G1 Z-1", "G0 Z1", "G0 Z-0.746", "G1 Z-2", "G0 Z5"])
    );
    assert_eq!(
        hole("G73 Q2"),
        with(&["G1 Z-1", "G0 Z-0.746", "G1 Z-2", "G0 Z5"])
    );
    assert_eq!(
        hole("G84"),
        with(&["G1 Z-2", "M5", "M4", "G1 Z5", "M5", "M3"])
    );
    assert_eq!(hole("G85"), with(&["G1 Z-2", "G1 Z1", "G0 Z5"]));
    assert_eq!(
        hole("G86 P1"),
        with(&["G1 Z-2", "G4 P1", "M5", "G0 Z5", "M3"])
    );
    assert_eq!(hole("G89 P1"), with(&["G1 Z-2", "G4 P1", "G1 Z5"]));
    assert_eq!(
        hole("G87 I0.5 J0 K-1"),
        with(&[
            "G0 X1.5", "M5", "M19", "G0 Z-2", "G0 X1", "M3", "G1 Z-1", "G1 Z-2", "M5", "M19",
            "G0 X1.5", "G0 Z5", "G0 X1", "M3"
        ])
    );
}

#[test]
fn other_planes_and_a_start_below_the_level() {
    assert_eq!(
        blocks("G19 G99 F100\nG81 Y1 Z2 X-3 R-1\nG80"),
        [
            "G19 G99 F100",
            "G0 Y1 Z2",
            "G0 X-1",
            "G1 X-3",
            "G0 X-1",
            "G80"
        ]
    );
    assert_eq!(
        blocks("G98 F100\nG81 X1 Z-3 R8\nX2\nG80"),
        [
            "G98 F100", "G0 Z8", "G0 X1", "G1 Z-3", "G0 Z8", "G0 X2", "G1 Z-3", "G0 Z8", "G80"
        ]
    );
}

#[test]
fn holes_on_a_circle() {
    let text = blocks("G0 X10\nG98 F100\nG91 G81 ^60 Z-3 R-4 L6\nG80 G90");
    assert_eq!(
        text.iter()
            .filter(|block| block.starts_with("G1 Z-3"))
            .count(),
        6
    );
}

#[test]
fn what_a_cycle_lacks_is_asked_for() {
    for (cycle, needle) in [
        ("G99 G81 X1 Z-3", "no retract level (R)"),
        ("G99 G81 X1 R1", "no depth (Z)"),
        ("G99 G82 X1 Z-3 R1", "no dwell (P)"),
        ("G99 G83 X1 Z-3 R1", "peck"),
        ("G99 G83 X1 Z-3 R1 Q-1", "peck"),
        ("G99 G83 X1 Z-3 R1 Q0.0000001", "100000 pecks"),
        ("G99 G81 X1 Z3 R1", "below its depth"),
        ("G99 G81 X1 Z-3 R1 L0", "repeated"),
        ("G81 X1 Z-3 R1", "G98"),
        ("G99 M5\nG86 X1 Z-3 R1 P1", "spindle that turns"),
        ("G99 G74 X1 Z-3 R1", "turn with M4"),
        ("G99 G76 X1 Z-3 R1", "thread"),
        ("G99 G88 X1 Z-3 R1 P1", "by hand"),
        ("G99 G87 X1 Z-3 R1", "no I, J and K"),
    ] {
        let error = refused(&format!("G21 G90\nM3 S1000\nG0 X0 Y0 Z5 F100\n{cycle}\n"));
        assert!(error.reason.contains(needle), "{needle}: {error}");
    }
    assert!(
        refused("G21 G0 X0 Y0\nG99 G81 X1 Z-3 R1 F10\n")
            .reason
            .contains("not known")
    );
}
