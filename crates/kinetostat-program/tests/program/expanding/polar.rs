//! Polar words: radius and angle about the origin.

#![allow(clippy::unwrap_used, reason = "a failing test may panic")]

use kinetostat_program::{ExpandOptions, NoSubprograms, expand};
use kinetostat_testing::Worst;

use super::refused;

#[test]
fn places_on_circles() {
    let text = "G21 G90\nG0 X0 Y0 Z0\n@10 ^30\n^120\n@5\nG91\n@1 ^60\nG1 ^-90 Z-2 F100\nG90\nX1 Y0\nG2 @2 ^90 I-0.5 J1\nM2\n";
    let expanded = expand(text, &ExpandOptions::default(), &NoSubprograms).unwrap();
    let mut worst = Worst::new();
    let expected = [
        (0.0, 0.0),
        (10.0, 30.0),
        (10.0, 120.0),
        (5.0, 120.0),
        (6.0, 180.0),
        (6.0, 90.0),
        (1.0, 0.0),
        (2.0, 90.0),
    ];
    assert_eq!(expanded.path.moves.len(), expected.len());
    for (motion, (radius, angle)) in expanded.path.moves.iter().zip(expected) {
        let (sine, cosine) = f64::to_radians(angle).sin_cos();
        let off = (motion.end.x - radius * cosine).hypot(motion.end.y - radius * sine);
        worst.add_at(off, || format!("line {}", motion.line));
    }
    assert!(worst.value() < 1e-12, "{worst:?}");
}

#[test]
fn what_has_no_place_is_refused() {
    for (text, needle) in [
        ("@3", "without an angle"),
        ("G91\n^30", "at the origin"),
        ("X1 ^30", "beside polar words"),
    ] {
        let error = refused(&format!("G21 G90\nG0 X0 Y0 Z0\n{text}\n"));
        assert!(error.reason.contains(needle), "{needle}: {error}");
    }
    assert!(refused("G21 G0 Z0\n@3 ^4\n").reason.contains("not known"));
}
