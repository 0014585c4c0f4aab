//! Contours with RL and RR become the way of the tool's centre where the program states the tool's radius.

use kinetostat_testing::Worst;

use super::*;

fn program_of(tool: &str, contour: &str) -> String {
    format!(
        "0 BEGIN PGM RL MM\n1 TOOL DEF 1 L+0 R+5\n2 TOOL CALL 1 Z S2000{tool}\n3 L Z+50 R0 FMAX M3\n4 L X-20 Y-20 R0 FMAX\n5 L Z-5 F200\n{contour}20 END PGM RL MM\n"
    )
}

const SQUARE: &str = "7 L X+10 Y+10 RL F300 M8\n8 L Y+90 ; up\n9 L X+90\n10 L Y+10 F200\n11 L X+10 M9\n12 L X-20 R0\n13 L Z+50 FMAX M30\n";

#[test]
fn a_square_outside_has_arcs_at_its_corners_and_ends_square_to_it() {
    let flat = flat(&program_of("", SQUARE));
    let lines: Vec<&str> = flat.lines().skip(6).collect();
    assert_eq!(
        lines,
        [
            "6 L X+5.0000 Y+10.0000 F300 M8",
            "7 L X+5.0000 Y+90.0000 ; up",
            "8 CC X+10.0000 Y+90.0000",
            "9 C X+10.0000 Y+95.0000 DR-",
            "10 L X+90.0000 Y+95.0000",
            "11 CC X+90.0000 Y+90.0000",
            "12 C X+95.0000 Y+90.0000 DR- F200",
            "13 L X+95.0000 Y+10.0000",
            "14 CC X+90.0000 Y+10.0000",
            "15 C X+90.0000 Y+5.0000 DR-",
            "16 L X+10.0000 Y+5.0000 M9",
            "17 L Y+10.0000 X-20 R0",
            "18 L Z+50 FMAX M30",
            "19 END PGM RL MM"
        ],
        "{flat}"
    );
    assert_eq!(
        place(&program(&flat), program(&flat).motions.len() - 1),
        [-20.0, 10.0, 50.0]
    );
}

#[test]
fn inside_a_contour_the_tool_ends_where_it_touches_both_sides() {
    let inside = SQUARE
        .replace("RL", "RR")
        .replace("X-20 R0", "X+50 Y+50 R0");
    let flat = flat(&program_of(" DR+0.5", &inside));
    for part in [
        "L X+15.5000 Y+10.0000 F300",
        "Y+84.5000 ; up",
        "X+84.5000 Y+84.5000",
        "X+84.5000 Y+15.5000",
        "X+10.0000 Y+15.5000 M9",
    ] {
        assert!(flat.contains(part), "{part}: {flat}");
    }
    assert!(!flat.contains("DR-"), "{flat}");
}

/// A circle about a pole: radii of the contour and of the way differ by the tool's radius; a pole from before counts behind it.
#[test]
fn arcs_keep_their_centre() {
    for (side, wanted) in [("RL", 15.0), ("RR", 25.0)] {
        let contour = format!(
            "L Y+0 F200\nCC X+40 Y+0\nL X+20 Y+0 {side}\nC X+40 Y-20 DR+\nCP IPA+90 DR+\nL X+60 Y+40\nL X+100 Y+80 R0\nLP PR+30 PA+90\n"
        );
        let flat = flat(&program_of("", &contour));
        let program = program(&flat);
        let mut worst = Worst::new();
        let mut count = 0;
        for motion in &program.motions {
            if let MotionKind::Arc { centre_mm, .. } = &motion.kind {
                let end = motion.target.pose().unwrap().position_mm;
                if (centre_mm.xy() - nalgebra::Vector2::new(40.0, 0.0)).norm() < 1e-9 {
                    worst.add(((end - centre_mm).xy().norm() - wanted).abs());
                    count += 1;
                }
            }
        }
        assert_eq!(count, 2, "{flat}");
        assert!(worst.of(count) < 1e-4, "{flat}");
        assert_eq!(
            place(&program, program.motions.len() - 1)[..2],
            [40.0, 30.0],
            "{flat}"
        );
    }
}

#[test]
fn lines_say_where_they_are_from_and_a_note_names_the_radius() {
    let files = vec![SourceFile::new("a.h", program_of("", SQUARE))];
    let flat = expand_heidenhain(files, &ReadOptions::default()).unwrap();
    let lines: Vec<usize> = flat.origins.iter().map(|(_, line)| *line).collect();
    assert_eq!(
        lines,
        [
            1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 9, 10, 10, 10, 11, 11, 11, 12, 13, 14
        ]
    );
    let [finding] = &flat.findings[..] else {
        panic!("{:?}", flat.findings);
    };
    assert_eq!(finding.line, 7);
    assert!(
        finding
            .message
            .contains("its radius of 5 mm (TOOL DEF, DR)"),
        "{finding:?}"
    );
}

#[test]
fn what_is_not_followed_is_refused_by_its_line() {
    let fault = |contour: &str| {
        let files = vec![SourceFile::new("a.h", program_of("", contour))];
        expand_heidenhain(files, &ReadOptions::default()).unwrap_err()[0].to_string()
    };
    for (contour, part) in [
        (
            "L Z-6 RL F200\nL X+10 Y+10\nL Y+90\nL X+0 R0\n",
            "line 7: `L Z-6 RL F200`: the compensation begins without a way in the plane",
        ),
        (
            "L X+10 Y+10 RL F200\nL Y+90\nL Z+50 R0\n",
            "line 9: `L Z+50 R0`: the compensation ends in a block that is no line",
        ),
        (
            "L X+10 Y+10 RR F200\nL Y+12\nL X+12\nL Y+10\nL X+50 R0\n",
            "line ",
        ),
        (
            "L X+10 Y+10 RL F200\nL Y+90\nL X+90 RR\nL Y+9 R0\n",
            "line 9: `L X+90 RR`: the side or the tool's radius changes",
        ),
        (
            "L X+10 Y+10 RL F200\nL Y+90 M97\nL X+90\nL Y+9 R0\n",
            "M90, M97, M98",
        ),
        (
            "L X+10 Y+10 RL F200\nCYCL DEF 7.1 X+5\nL Y+90\nL X+90\nL Y+9 R0\n",
            "shifted along the contour",
        ),
    ] {
        let found = fault(contour);
        assert!(found.contains(part), "{contour}: {found}");
    }
    // Without a radius the control knows more than the program.
    let text = program_of("", SQUARE).replace("1 TOOL DEF 1 L+0 R+5\n", "");
    let found = read_with(flat(&text).as_bytes(), &ReadOptions::default()).unwrap_err();
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(
        found[0]
            .remedy
            .contains("TOOL DEF 1 L+0 R+5) and write it flat first (--expand)"),
        "{found:?}"
    );
    // Nor do APPR and DEP say what the tool does without it.
    let found = read_with(
        program_of("", "APPR LT X+10 Y+10 LEN15 RL F200\nDEP LT LEN15\n").as_bytes(),
        &ReadOptions::default(),
    )
    .unwrap_err();
    let lines: Vec<usize> = found.iter().map(|fault| fault.line).collect();
    assert_eq!(lines, [7, 8], "{found:?}");
}
