//! What is refused, by its line.

use super::try_flat;

/// Lines 1 to 3 put the tool beside (0, 0), going up; it is on the left, radius 2.
fn refused(behind: &str) -> (usize, String) {
    let text = format!("G21 G90 F100\nG0 X0 Y-20 Z5\nG41.1 D4 G1 X0 Y0\n{behind}\nG40\nM2\n");
    match try_flat(&text) {
        Err(error) => {
            assert!(!error.remedy.is_empty(), "{text}");
            (error.line, error.reason)
        }
        Ok(flat) => panic!("{text}\n{}", String::from_utf8_lossy(flat.program.bytes())),
    }
}

#[test]
fn the_tool_cannot_be_where_it_would_cut_the_contour() {
    for (behind, line, reason) in [
        // A slot of 3 mm for a tool of 4.
        ("Y10\nX-3\nY0", 6, "cannot be reached"),
        // An arc of 1 mm from inside, and one of 2 mm.
        ("Y10\nG3 X-2 I-1 J0", 5, "the tool inside it"),
        ("Y10\nG3 X-4 I-2 J0", 5, "the tool inside it"),
        // A step of 1 mm, in an arc.
        ("Y10\nX-1\nG3 X-2 Y11 R1", 6, "inside"),
        // The circle is not tangent to the last digit.
        (
            "Y10\nX0.000001 Y20\nG3 X0.000001 Y20 I-10 J0",
            7,
            "full circle",
        ),
        // Two circles about one centre.
        (
            "Y10\nG3 X-20 Y10 I-10 J0\nG2 X0 Y10 I10 J0",
            6,
            "same centre",
        ),
    ] {
        let (found, said) = refused(behind);
        assert!(said.contains(reason), "{behind}: {said}");
        assert_eq!(found, line, "{behind}: {said}");
    }
}

#[test]
fn an_entry_is_longer_than_the_radius() {
    for (entry, reason) in [
        ("G1 X0 Y-18.5", "longer than the tool's radius"),
        ("G1 Z0", "longer than the tool's radius"),
        ("G3 X0 Y-18 I0 J1", "longer than the tool's radius"),
        ("G3 X0 Y-17 I0 J1.5", "the tool inside it"),
        ("G3 X0 Y-15 R20", "no arc leads"),
    ] {
        let text = format!("G21 G90 F100\nG0 X0 Y-20 Z5\nG41.1 D4\n{entry}\nG40\nM2\n");
        let error = try_flat(&text).unwrap_err();
        assert_eq!(error.line, 4, "{error}");
        assert!(error.reason.contains(reason), "{error}");
    }
}

#[test]
fn what_asks_for_the_place_or_changes_it_waits_until_the_contour_ends() {
    for code in [
        "G18",
        "G19",
        "G54",
        "G92 X0",
        "G43 H1",
        "G49",
        "G61",
        "G64",
        "G98",
        "G99",
        "G93 F2",
        "M6",
        "M48",
        "M62 P1",
        "M66 P0",
        "G41.1 D4",
        "G42.1 D4",
        "G1 A5",
        "G81 X5 R2 Z0",
        "#1 = #5420",
        "G1 X[#<_x> + 1]",
    ] {
        let (line, reason) = refused(&format!("Y10\n{code}"));
        assert_eq!(line, 5, "{code}: {reason}");
    }
    // These are allowed.
    for code in [
        "G17", "G90", "G91", "G80", "M3 S100", "M5", "M7", "M8", "M9", "G4 P1", "F20", "T3", "M0",
        "M1", "(words)", "#1 = 5",
    ] {
        let text = format!(
            "G21 G90 F100\nG0 X0 Y-20 Z5\nG41.1 D4 G1 X0 Y0\nY10\n{code}\nG1 Y30\nG40\nM2\n"
        );
        assert!(try_flat(&text).is_ok(), "{code}: {:?}", try_flat(&text));
    }
}

#[test]
fn behind_g40_the_next_move_is_straight_and_nothing_asks_for_the_place() {
    for code in [
        "G2 X5 Y5 I5 J0",
        "G92 X0",
        "G81 X5 Y5 R2 Z0 G99 F10",
        "G41.1 D4\nG3 X5 Y5 I0 J5",
    ] {
        let text =
            format!("G21 G90 F100\nG0 X0 Y-20 Z5\nG41.1 D4 G1 X0 Y0\nY10\nG40\n{code}\nM2\n");
        let error = try_flat(&text).unwrap_err();
        assert_eq!(error.line, 5 + code.lines().count(), "{error}");
    }
}

#[test]
fn what_a_controller_does_before_g40_is_not_written_beside_it() {
    for code in ["G18 G40", "G40 M6", "G40 M48"] {
        let (line, reason) = refused(&format!("Y10\n{code}"));
        assert_eq!(line, 5, "{code}: {reason}");
    }
    let text =
        "G21 G90 F100\nG0 X0 Y-20 Z5\nG21 G17 G41.1 D4 G1 X0 Y0\nY10\nG40 G49 G80 G54 M9\nM2\n";
    assert!(try_flat(text).is_ok(), "{:?}", try_flat(text));
}

#[test]
fn a_stop_in_an_inside_corner_has_cut_it_already() {
    for stop in ["M0", "M1", "M60"] {
        let (line, reason) = refused(&format!("Y10\n{stop}\nX-10"));
        assert_eq!(line, 6, "{reason}");
        assert!(reason.contains("stop"), "{reason}");
    }
}

#[test]
fn a_program_ends_its_compensation() {
    let text = "G21 G90 F100\nG0 X0 Y-20 Z5\nG41.1 D4 G1 X0 Y0\nY10\n";
    let error = try_flat(text).unwrap_err();
    assert!(error.reason.contains("ends while"), "{error}");
    for end in ["M2", "M30", "G40"] {
        assert!(try_flat(&format!("{text}{end}\n")).is_ok());
    }
}

#[test]
fn the_tool_s_radius_must_be_known() {
    for (switch, reason) in [
        ("G41", "which tool"),
        ("T20 M6\nG41", "tool 20"),
        ("G41 D20", "tool 20"),
        ("G41 D1.5", "no number of a tool"),
        ("G41.1", "diameter"),
        ("G41.1 D4 L1", "lathe"),
        ("G41.1 D100000", "diameter"),
        ("G41 G42 D1", "two codes"),
        ("G19\nG41 D1", "plane YZ"),
        ("G18 G41 D1", "in one block"),
        ("G20 G41.1 D1", "in one block"),
    ] {
        let text = format!("G21 G90 F100\nG0 X0 Y-20 Z5\n{switch}\nG1 X0 Y0\nG40\nM2\n");
        let error = try_flat(&text).unwrap_err();
        assert!(error.reason.contains(reason), "{switch}: {error}");
        assert_eq!(error.line, 2 + switch.lines().count(), "{error}");
    }
    let error = try_flat("G21 G90 F100\nG0 X0 Z5\nG41 D1\nG1 X0 Y30\nG40\nM2\n").unwrap_err();
    assert!(
        error.line == 3 && error.reason.contains("not known"),
        "{error}"
    );
}

#[test]
fn where_the_last_digit_would_decide_nothing_is_claimed() {
    // LinuxCNC takes corners below 0.05 rad for none.
    let (line, reason) = refused(&format!(
        "Y10\nX{:.16} Y{:.16}",
        5.0 * 0.05_f64.sin(),
        10.0 + 5.0 * 0.05_f64.cos()
    ));
    assert_eq!(line, 5);
    assert!(reason.contains("0.050 rad"), "{reason}");
    let (line, reason) = refused("Y10\nX0.0000000001");
    assert_eq!(line, 5);
    assert!(reason.contains("no direction"), "{reason}");
}
