//! G5 to G5.3 against Bernstein's polynomials and a circle, and G33.1.

use kinetostat_program::{ExpandOptions, NoSubprograms, SpindleRotation, expand};

use super::{flat, refused};

/// Places in X and Y behind the first move.
fn places(text: &str) -> Vec<[f64; 2]> {
    let text = format!("G21 G90 G17 F200\nG0 X1 Y2 Z3\n{text}");
    let made = expand(text, &ExpandOptions::default(), &NoSubprograms);
    let made = made.unwrap_or_else(|error| panic!("{error}"));
    let moves = &made.path.moves[1..];
    moves
        .iter()
        .map(|motion| [motion.end.x, motion.end.y])
        .collect()
}

/// A Bezier curve of control points at a parameter from 0 to 1.
fn bernstein(points: &[[f64; 2]], t: f64) -> [f64; 2] {
    let degree = points.len() - 1;
    let mut sum = [0.0; 2];
    let mut choose = 1.0;
    for (k, point) in points.iter().enumerate() {
        let share = choose * t.powi(k as i32) * (1.0 - t).powi((degree - k) as i32);
        sum = [sum[0] + share * point[0], sum[1] + share * point[1]];
        choose = choose * (degree - k) as f64 / (k + 1) as f64;
    }
    sum
}

fn close(made: &[[f64; 2]], points: &[[f64; 2]]) {
    let count = 15 * points.len();
    assert!((count..=count + 1).contains(&made.len()), "{}", made.len());
    for (k, place) in made.iter().enumerate() {
        let t = (((k + 1) as f64) / count as f64).min(1.0);
        let expected = bernstein(points, t);
        for axis in 0..2 {
            assert!(
                (place[axis] - expected[axis]).abs() < 1e-9,
                "{k}: {place:?} {expected:?}"
            );
        }
    }
}

#[test]
fn cubic_and_quadratic_splines_are_chords_of_bezier_curves() {
    let cubic = [[1.0, 2.0], [4.0, 9.0], [15.0, 11.0], [20.0, 5.0]];
    close(&places("G5 X20 Y5 I3 J7 P-5 Q6\n"), &cubic);
    let quadratic = [[1.0, 2.0], [6.0, 32.0], [10.0, 4.0]];
    close(&places("G5.1 X10 Y4 I5 J30\n"), &quadratic);
    close(&places("G91\nG5.1 X9 Y2 I5 J30\n"), &quadratic);
    // A second G5 without I and J goes on smoothly.
    let made = places("G5 X20 Y5 I3 J7 P-5 Q6\nG5 X40 Y7 P1 Q2\n");
    let second = [[20.0, 5.0], [25.0, -1.0], [41.0, 9.0], [40.0, 7.0]];
    close(&made[made.len() - 60..], &second);
}

#[test]
fn a_quarter_circle_as_a_nurbs_lies_on_the_circle() {
    let weight = 0.5_f64.sqrt();
    let made = places(&format!(
        "G5.2 P1\nG5.2 X1 Y12 P{weight}\nG5.2 X11 Y12 P1\nG5.3\nG1 X0\n"
    ));
    assert_eq!(made.len(), 46);
    for [x, y] in &made[..45] {
        let radius = (x - 11.0).hypot(y - 2.0);
        assert!((radius - 10.0).abs() < 1e-12, "{x} {y}");
    }
    assert_eq!(made[44], [11.0, 12.0]);
}

#[test]
fn splines_that_cannot_be_run_are_refused() {
    for (text, line, needle) in [
        ("G5.1 X1 Y1 I2\n", 3, "needs I and J"),
        ("G5 X1 Y1 P1 Q1\n", 3, "needs I and J"),
        ("G5 X1 Y1 I1 J1 P1\n", 3, "needs P and Q"),
        ("G5.1 X1 Y1 Z1 I1 J1\n", 3, "does not move Z"),
        ("G18\nG5.1 X1 Y1 I1 J1\n", 4, "outside the plane XY"),
        ("G5.3\n", 3, "no G5.2 has begun"),
        ("G5.2 X1 Y1 P1\nG5.3\n", 4, "order 3"),
        ("G5.2 X1 Y1 P1\nG1 X5\n", 4, "not ended"),
        ("G5.2 X1 P1\n", 3, "X and Y"),
        ("G5.2 X1 Y1\n", 3, "weight"),
        ("G5.2 X1 Y1 P1 L200\n", 3, "order"),
        ("G41.1 D1\nG5.1 X9 Y1 I1 J1\n", 4, "radius compensation"),
        ("G5.1 X1 Y1 I1 J1\nX3 Y3 I1 J1\n", 4, "in each block"),
        ("G93 F1\nG5.1 X1 Y1 I1 J1\n", 4, "inverse time"),
    ] {
        let error = refused(&format!("G21 G90 F200\nG0 X0 Y0 Z0\n{text}"));
        assert_eq!(error.line, line, "{text}: {error}");
        assert!(error.reason.contains(needle), "{text}: {error}");
    }
}

#[test]
fn a_rigid_tap_is_a_feed_and_a_return_with_the_spindle_reversed() {
    let begin = "G21 G90 F100\nG0 X0 Y0 Z2\nM3 S300\n";
    let made = flat(&format!("{begin}G33.1 Z-8 K1.5\nG1 X1\n"));
    let expected = "G1 Z-8 F450\nM5\nM4\nG1 Z2 F450\nM5\nM3\nF100\nG80\nG1 X1\n";
    assert_eq!(made, format!("{begin}{expected}"));
    let text = format!("{begin}G33.1 Z-8 K1.5 I2\n");
    let made = expand(text, &ExpandOptions::default(), &NoSubprograms).unwrap();
    assert!(
        made.warnings.iter().any(|w| w.text.contains("float")),
        "{:?}",
        made.warnings
    );
    let last = made.path.moves.last().unwrap();
    assert_eq!(last.feed.unwrap().value, 900.0);
    assert_eq!(
        made.path.spindle_changes.last().unwrap().spindle.rotation,
        SpindleRotation::Clockwise
    );
    for (text, needle) in [
        ("G33.1 Z-1 K1\n", "needs a spindle"),
        ("M3 S100\nG33.1 Z-1\n", "pitch"),
        ("M3\nG33.1 Z-1 K1\n", "speed"),
        ("M3 S100\nG33.1 K1\n", "nowhere"),
        ("M3 S100\nG33 Z-1 K1\n", "tied to the spindle"),
        ("M3 S100\nG33.1 Z-1 K1\nX5\n", "without a motion word"),
    ] {
        let error = refused(&format!("G21 G90 F200\nG0 X0 Y0 Z0\n{text}"));
        assert!(error.reason.contains(needle), "{text}: {error}");
    }
}
