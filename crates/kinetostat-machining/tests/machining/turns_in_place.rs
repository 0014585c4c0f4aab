//! A feed that turns in place, and a circle that a table mills while the tool stands: the tip from the core at poses that are put
//! together by hand, all along the written blocks.

use kinetostat_program::Arcs;
use kinetostat_testing::Worst;
use nalgebra::{Vector3, vector};

use crate::five_axes::{Machine, TOLERANCE_MM, blocks};

const FORCE: Vector3<f64> = Vector3::new(300.0, -200.0, 400.0);

/// Places along every block, so many of each.
fn sampled(blocks: &[[[f64; 5]; 2]]) -> impl Iterator<Item = [f64; 5]> + '_ {
    blocks.iter().flat_map(|[from, to]| {
        (1..=40).map(|k| {
            let share = f64::from(k) / 40.0;
            [0, 1, 2, 3, 4].map(|axis| from[axis] + (to[axis] - from[axis]) * share)
        })
    })
}

/// Blocks of a text behind the one that reaches a place, in the part.
fn blocks_behind(text: &str, from: &[f64; 3]) -> Vec<[[f64; 5]; 2]> {
    let all = blocks(text);
    let near = |at: &[f64; 5]| (0..3).all(|k| (at[k] - from[k]).abs() < 3.0);
    let first = all
        .iter()
        .position(|block| near(&block[1]))
        .expect("the place");
    all[first + 1..].to_vec()
}

const TURN: &str = "G21 G90 G94\nG0 A0 C0\nG0 X40 Y10 Z40\nG43.4 H1 Z40\nG1 Z0 F600\nC180 F360\nA15 C150\nX41 F500\nG0 Z40\nG49\nM30\n";

#[test]
fn a_turn_in_place_is_divided_by_its_angle() {
    for machine in [Machine::arm_with_table(), Machine::portal_with_head()] {
        let place = vector![40.0, 10.0, 0.0];
        let at_place = |blocks: Vec<[[f64; 5]; 2]>| -> Vec<[[f64; 5]; 2]> {
            let stands = |block: &[[f64; 5]; 2]| block[0][3..] != block[1][3..];
            blocks.into_iter().filter(stands).collect()
        };
        let off = |blocks: &[[[f64; 5]; 2]]| {
            let mut worst = Worst::new();
            for at in sampled(blocks) {
                worst.add((machine.tip(&at, &FORCE) - place).norm());
            }
            worst.of(40 * blocks.len())
        };
        let before = off(&at_place(blocks_behind(TURN, &[40.0, 10.0, 0.0])));
        let run = machine.run_of(TURN, FORCE, |_| {});
        let text = String::from_utf8(run.written.as_ref().expect("a program").bytes.clone());
        let text = text.expect("text");
        let turning = at_place(blocks_behind(&text, &[40.0, 10.0, 0.0]));
        let after = off(&turning);
        assert!(turning.len() > 2, "{text}");
        assert!(after < TOLERANCE_MM + 1e-4, "{before} {after}\n{text}");
        assert!(before > 0.02 && before > 8.0 * after, "{before} {after}");
        // The headline figures have seen the way between, by the same physics.
        let summary = &run.result.summary;
        assert!(summary.max_position_error_before_mm > 0.999 * before);
        assert!(summary.max_position_error_after_mm < 1.1 * TOLERANCE_MM);
        assert!(text.contains("C180") && text.contains("A15"), "{text}");
    }
}

#[test]
fn a_turn_in_place_takes_its_time() {
    let run = Machine::arm_with_table().run_of(TURN, FORCE, |_| {});
    let text = String::from_utf8(run.written.expect("a program").bytes).expect("text");
    // Half a turn at 360 deg/min, then 15 and 30 degrees at once.
    let wanted = [30.0, 60.0 * 15.0_f64.hypot(30.0) / 360.0];
    let (mut times, mut inverse) = (Vec::new(), false);
    for line in text.lines() {
        if line.contains("G93") {
            inverse = true;
            times.push(0.0);
        }
        if line.contains("G94") {
            inverse = false;
        }
        let feed = line
            .split_whitespace()
            .find_map(|word| word.strip_prefix('F'));
        if let (true, Some(feed), Some(time)) = (inverse, feed, times.last_mut()) {
            *time += 60.0 / feed.parse::<f64>().expect("a number");
        }
    }
    assert_eq!(times.len(), 2, "{text}");
    for (time, wanted) in times.iter().zip(wanted) {
        assert!(
            (time / wanted - 1.0).abs() < 2e-3,
            "{time} {wanted}\n{text}"
        );
    }
    assert!(text.contains("\nG94 F360\n"), "{text}");
    assert!(text.contains("F500"), "{text}");
}

#[test]
fn a_circle_is_milled_by_the_table_alone() {
    let mut machine = Machine::arm_with_table();
    // A table about the z axis of the part, and a circle about it: the tool stands in the machine.
    machine.axes[1].2 = Vector3::z();
    machine.axes[1].3 = Vector3::zeros();
    let text = "G21 G90 G94\nG0 A0 C0\nG0 X40 Y0 Z40\nG43.4 H1 Z40\nG1 Z0 F600\nG3 X40 Y0 I-40 J0 C-360\nG0 Z40\nG49\nM30\n";
    let off = |at: &[f64; 5]| {
        let tip = machine.tip(at, &FORCE);
        (tip.x.hypot(tip.y) - 40.0).hypot(tip.z)
    };
    // Uncorrected, at hand-made stations: the tool stands and its error turns in the part.
    let mut before = Worst::new();
    for k in 0..36 {
        let angle = f64::from(10 * k).to_radians();
        let at = [
            40.0 * angle.cos(),
            40.0 * angle.sin(),
            0.0,
            0.0,
            -f64::from(10 * k),
        ];
        before.add(off(&at));
    }
    let run = machine.run_of(text, FORCE, |task| task.writing.arcs = Arcs::Lines);
    let written = String::from_utf8(run.written.expect("a program").bytes).expect("text");
    let round = blocks_behind(&written, &[40.0, 0.0, 0.0]);
    assert!(round.len() > 30, "{written}");
    let mut after = Worst::new();
    for at in sampled(&round) {
        after.add(off(&at));
    }
    let (before, after) = (before.of(36), after.of(40 * round.len()));
    assert!(before > 0.1, "{before}");
    // Tolerances of path and chords, and the digits.
    assert!(
        after < TOLERANCE_MM + 0.0004 + 2e-4,
        "{before} {after}\n{written}"
    );
}
