//! G51, G51.1, G52 and G68 against complex numbers and by hand.

use kinetostat_program::{Curve, Dialect, ExpandOptions, NoSubprograms, ProgramError, expand};

fn run(text: &str) -> Result<kinetostat_program::Expanded, ProgramError> {
    let mut options = ExpandOptions::default();
    options.dialect = Dialect::Fanuc;
    let begin = "G21 G90 G17 F200\nG0 X0 Y0 Z15\n";
    expand(format!("{begin}{text}"), &options, &NoSubprograms)
}

/// Ends of the moves behind the first.
fn ends(text: &str) -> Vec<[f64; 3]> {
    let made = run(text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    let moves = &made.path.moves[1..];
    moves.iter().map(|m| [m.end.x, m.end.y, m.end.z]).collect()
}

fn near(made: &[[f64; 3]], expected: &[[f64; 3]]) {
    assert_eq!(made.len(), expected.len(), "{made:?}");
    for (a, b) in made.iter().zip(expected) {
        for axis in 0..3 {
            assert!((a[axis] - b[axis]).abs() < 1e-9, "{made:?} {expected:?}");
        }
    }
}

#[test]
fn turned_coordinates_are_turned_about_their_centre() {
    let (sine, cosine) = 30.0_f64.to_radians().sin_cos();
    let about = |x: f64, y: f64| {
        let (a, b) = (x - 10.0, y - 5.0);
        [10.0 + cosine * a - sine * b, 5.0 + sine * a + cosine * b]
    };
    let made = ends("G68 X10 Y5 R30\nG0 X20 Y8\nG1 Z1\nG91 X-3\nG90 G3 X20 Y18 R6\nG69\nG0 X1\n");
    let [a, b, c] = [about(20.0, 8.0), about(17.0, 8.0), about(20.0, 18.0)];
    let at = |[x, y]: [f64; 2], z: f64| [x, y, z];
    near(
        &made,
        &[
            at(a, 15.0),
            at(a, 1.0),
            at(b, 1.0),
            at(c, 1.0),
            [1.0, c[1], 1.0],
        ],
    );
}

#[test]
fn scaled_and_mirrored_coordinates() {
    near(
        &ends("G51 X2 Y0 Z0 P2.\nG1 X4 Y4 Z1\nG50\nG1 X0\n"),
        &[[6.0, 8.0, 2.0], [0.0, 8.0, 2.0]],
    );
    near(
        &ends("G51 X0 Y0 I-1.0 J2.0\nG1 X4 Y4\n"),
        &[[-4.0, 8.0, 15.0]],
    );
    // A mirrored arc turns the other way.
    let made = run("G51.1 X1\nG1 X4 Y0\nG3 X8 Y0 I2 J0\nG50.1\nG1 X0\n").unwrap();
    near(&ends("G51.1 X1\nG1 X4 Y0\n"), &[[-2.0, 0.0, 15.0]]);
    let Curve::Arc(arc) = made.path.moves[2].curve else {
        panic!("no arc");
    };
    assert!(
        (arc.sweep + std::f64::consts::PI).abs() < 1e-12,
        "{}",
        arc.sweep
    );
    assert!((arc.centre.x + 4.0).abs() < 1e-12);
    // First scaled, then turned; the centre of the turn is scaled too.
    near(
        &ends("G51 X0 Y0 P2.\nG68 X1 Y0 R90\nG1 X3 Y0\nG69 G50\n"),
        &[[2.0, 4.0, 15.0]],
    );
}

#[test]
fn shifted_coordinates_and_the_radius_of_the_tool() {
    near(
        &ends("G52 X100 Z-5\nG1 X1 Y1\nG91 X1\nG90 Z0\nG52 X0 Z0\nG1 X0 Z0\n"),
        &[
            [101.0, 1.0, 15.0],
            [102.0, 1.0, 15.0],
            [102.0, 1.0, -5.0],
            [0.0, 1.0, 0.0],
        ],
    );
    // The tool is not scaled: 3 beside a contour of twice the size.
    let made = ends("G51 X0 Y0 P2.\nG0 X-10 Y10\nG41.1 D6\nG1 X0 Y10\nX20\nG40\nG0 Z20\nG50\n");
    assert!(
        made.iter()
            .any(|end| (end[0] - 40.0).abs() < 1e-9 && (end[1] - 23.0).abs() < 1e-9),
        "{made:?}"
    );
    // A cycle in turned coordinates.
    let made = ends("G68 X0 Y0 R90\nG0 X5 Y0\nG99 G81 X7 Z-3 R1\nG80\nG69\n");
    assert!(made.contains(&[0.0, 7.0, -3.0]), "{made:?}");
}

#[test]
fn coordinates_that_cannot_be_followed_are_refused() {
    for (text, needle) in [
        ("G51 X0 Y0 P2\nG1 X1 Y1\n", "decimal point"),
        ("G51 X0 Y0\n", "without a factor"),
        ("G51 P2. I1.\n", "with P and with I"),
        ("G51 P0.\n", "factor of zero"),
        (
            "G51 X0 Y0 I2. J3.\nG1 X1 Y1\nG2 X3 Y1 I1 J0\n",
            "no arc any more",
        ),
        ("G51 P2.\nG51 P3.\n", "already"),
        ("G68 X0 Y0 R30\nG1 X5\n", "does not state its place"),
        ("G68 X0 Y0 R30\nG91 G1 X5 Y5\n", "does not state its place"),
        ("G68 X0 Y0 R30\nG68 X0 Y0 R30\n", "already"),
        ("G68 X0 Y0\n", "no angle"),
        ("G68 R30\n", "without its centre"),
        ("G68 X0 Y0 R30 I1\n", "tilts"),
        ("G91 G68 X0 Y0 R30\n", "other words"),
        ("G91\nG68 X0 Y0 R30\n", "adds it"),
        ("G68 X0 Y0 R30\nG0 X1 Y1\nG28\n", "G28"),
        ("G68 X0 Y0 R30\nG0 X1 Y1\nG55\n", "G55"),
        ("G68 X0 Y0 R30\nG0 X1 Y1\nG18\n", "G18"),
        ("G52 X1\nG92 X0\n", "G92"),
        ("G51 X0 Y0 P2.\nG0 X1 Y1\nG81 X1 Z-1 R1\n", "cycle"),
        ("G68 X0 Y0 R30\nG81 X1 Y1 Z-1 R1\n", "cycle"),
        ("G1 X9 G41.1 D2\nX20\nG68 X0 Y0 R1\n", "radius compensation"),
        ("G50 S2000\n", "lathe"),
    ] {
        let error = run(text).unwrap_err();
        assert!(error.reason.contains(needle), "{text}: {error}");
    }
}

/// What ends coordinates is in other groups (11, 16, 22) than G2 and G3: the arc stays in force, in the program's own sense.
#[test]
fn an_arc_stays_in_force_behind_the_end_of_coordinates() {
    // Halves of circles along x, clockwise about z; where the coordinates are no others, the same moves without the codes between.
    let way = |text: &str| {
        let made = run(text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        let moves = &made.path.moves[1..];
        let middles = moves.iter().map(|m| [m.point(0.5), m.end]);
        middles.collect::<Vec<_>>()
    };
    let plain = way("G2 X10 Y0 R5\nX20 Y0 R5\nX30 R5\n");
    assert!((plain[2][0] - nalgebra::Vector3::new(25.0, 5.0, 15.0)).norm() < 1e-9);
    for (before, between) in [
        ("", "G50"),
        ("", "G50.1"),
        ("", "G50.1 X0"),
        ("", "G69"),
        ("", "G52 X0"),
        ("", "G15"),
        ("", "G40"),
        ("", "G49"),
        ("", "G54"),
        ("", "G98"),
        ("G51.1 Z0\nG0 Z-15\n", "G50.1 Z0"),
        ("G51.1 Z0\nG0 Z-15\n", "G50.1"),
        ("G51 X0 Y0 P1.\n", "G50"),
        ("G68 X0 Y0 R0\n", "G69"),
        ("G52 X0 Y0\n", "G52 X0 Y0"),
        ("G68 X0 Y0 R0\n", "G69\nM8\n(in force)"),
        ("G52 Z1\nG0 Z14\n", "G52 Z0"),
    ] {
        let text = format!("{before}G2 X10 Y0 R5\nX20 Y0 R5\n{between}\nN7 X30 R5\n");
        let made = way(&text);
        let last = made.len() - 3;
        for (made, plain) in made[last..].iter().zip(&plain) {
            for (a, b) in made.iter().zip(plain) {
                assert!((a - b).norm() < 1e-9, "{text}{made:?}");
            }
        }
    }
    // Codes that begin coordinates leave it as it is, too.
    for (begins, sense) in [
        ("G51.1 Y0", -1.0),
        ("G68 X0 Y0 R0", 1.0),
        ("G51 X0 Y0 P1.", 1.0),
    ] {
        let made = way(&format!("G2 X10 Y0 R5\n{begins}\nX20 Y0 R5\n"));
        assert!(
            (made[1][0].y - sense * 5.0).abs() < 1e-9,
            "{begins} {made:?}"
        );
    }
    // A mirrored arc is one the other way round, and behind the mirror it is the program's again: also where the next mirror begins.
    let mirrored = "G51.1 Y0\nG2 X10 Y0 R5\nG50.1 Y0\n";
    let made = way(&format!("{mirrored}X20 Y0 R5\n"));
    let heights = [made[0][0].y, made[1][0].y];
    assert!((heights[0] + 5.0).abs() < 1e-9 && (heights[1] - 5.0).abs() < 1e-9);
    let made = way(&format!(
        "{mirrored}G51.1 Y0\nX20 Y0 R5\nG50.1\nG1 X0\nX5\n"
    ));
    assert!((made[1][0].y + 5.0).abs() < 1e-9, "{made:?}");
    assert!((made[3][0] - nalgebra::Vector3::new(2.5, 0.0, 15.0)).norm() < 1e-9);
    // A motion that goes nowhere in them says what the next one is.
    let made = run("G0 X0 Y0\nG68 X0 Y0 R90\nG1 X0 Y0 F100\nG69\nX9\n").unwrap();
    assert_eq!(
        made.path.moves.last().unwrap().kind,
        kinetostat_program::MoveKind::Feed
    );
    // G80 is of another group on Fanuc, too; elsewhere it ends it.
    let text = "G51.1 Y0\nG2 X10 Y0 R5\nG80\nG50.1\nX20 Y0 R5\n";
    assert!((way(text)[1][0].y - 5.0).abs() < 1e-9);
    let text = format!("G21 G90 F9\nG0 X0 Y0 Z15\n{text}");
    let error = expand(text, &ExpandOptions::default(), &NoSubprograms).unwrap_err();
    assert!(error.reason.contains("without a motion word"), "{error}");
}
