//! P in G2 and G3 of LinuxCNC: begun turns of an arc.

use std::f64::consts::TAU;

use kinetostat_program::{Curve, Dialect, ExpandOptions, NoSubprograms, expand};

use super::fanuc::{BEGIN, run};

/// Ends, and turns by the right-hand rule, of the arcs.
fn arcs(text: &str) -> Vec<([f64; 3], f64)> {
    let mut options = ExpandOptions::default();
    options.dialect = Dialect::LinuxCnc;
    let made = expand(format!("{BEGIN}G0 Z0\n{text}"), &options, &NoSubprograms);
    let made = made.unwrap_or_else(|error| panic!("{error}\n{text}"));
    let arcs = made.path.moves.iter().filter_map(|one| match one.curve {
        Curve::Arc(arc) => Some(([one.end.x, one.end.y, one.end.z], arc.sweep / TAU)),
        Curve::Line => None,
    });
    arcs.collect()
}

fn near(made: &[([f64; 3], f64)], expected: &[([f64; 3], f64)]) {
    assert_eq!(made.len(), expected.len(), "{made:?}");
    for ((end, turns), (to, of)) in made.iter().zip(expected) {
        for axis in 0..3 {
            assert!((end[axis] - to[axis]).abs() < 1e-9, "{made:?}");
        }
        assert!((turns - of).abs() < 1e-9, "{made:?}");
    }
}

/// Half a turn and two before it: the rise is even over two and a half.
#[test]
fn turns_are_written_one_after_the_other() {
    let expected = [
        ([0.0, 0.0, 2.4], -1.0),
        ([0.0, 0.0, 4.8], -1.0),
        ([10.0, 0.0, 6.0], -0.5),
    ];
    near(&arcs("G2 X10 Y0 Z6 I5 J0 P3\n"), &expected);
    near(&arcs("G91 G2 X10 Y0 Z6 I5 J0 P3 F200\n"), &expected);
    near(&arcs("G90.1\nG2 X10 Y0 Z6 I5 J0 P3\n"), &expected);
    // A quarter against the clock; no rise.
    near(
        &arcs("G3 X5 Y5 I0 J5 P2\n"),
        &[([0.0, 0.0, 0.0], 1.0), ([5.0, 5.0, 0.0], 0.25)],
    );
    // The start is the end: whole turns.
    near(
        &arcs("G3 I5 Z4 P4\n"),
        &[
            ([0.0, 0.0, 1.0], 1.0),
            ([0.0, 0.0, 2.0], 1.0),
            ([0.0, 0.0, 3.0], 1.0),
            ([0.0, 0.0, 4.0], 1.0),
        ],
    );
    // One turn is what it is without P, also by its radius.
    near(&arcs("G2 X10 Y0 R5 P1\n"), &[([10.0, 0.0, 0.0], -0.5)]);
    // In the plane ZX the rise is along Y, which is the normal.
    near(
        &arcs("G18 G2 X10 Z0 Y3 I5 K0 P2\n"),
        &[([0.0, 2.0, 0.0], -1.0), ([10.0, 3.0, 0.0], -0.5)],
    );
}

#[test]
fn turns_that_are_none_are_refused() {
    for (block, needle) in [
        ("G2 X10 Y0 I5 J0 P0", "whole number of turns"),
        ("G2 X10 Y0 I5 J0 P1.5", "whole number of turns"),
        ("G2 X10 Y0 I5 J0 P-2", "whole number of turns"),
        ("G2 X10 Y0 I5 J0 P1000000", "whole number of turns"),
        ("G2 X10 Y0 R5 P2", "radius"),
        ("G4 P1 G2 X10 Y0 I5 J0", "beside words that have a P"),
        ("G2 X10 Y0 I5 J0 A5 P2", "other axes"),
    ] {
        let error = run(&format!("{block}\n"), Dialect::LinuxCnc).unwrap_err();
        assert!(error.reason.contains(needle), "{block}: {error}");
    }
    for dialect in [Dialect::Fanuc, Dialect::Undecided] {
        let error = run("G2 X10 Y0 I5 J0 P2\n", dialect).unwrap_err();
        assert!(error.reason.contains("controllers disagree"), "{error}");
    }
}
