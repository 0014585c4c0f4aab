//! Orientation corrected by rotary axes: the written text, scanned here, on poses that are put together by hand; the tip within a
//! micrometre of the tolerance, the tool's axis where the program has it.

use kinetostat::Directions;
use kinetostat_machining::{Run, WarningCode};
use kinetostat_program::{Carries, RotaryAxes, RotaryAxis};
use kinetostat_testing::Worst;
use nalgebra::{Unit, UnitQuaternion, Vector3, vector};

use crate::five_axes::{Machine, TOLERANCE_MM, blocks, numbered_blocks};

const FORCE: Vector3<f64> = Vector3::new(300.0, -200.0, 400.0);

/// Tilted all along, with a turn in place, increments and an arc.
const PROGRAM: &str = "G21 G90 G94\nG0 A0 C0\nG0 X0 Y0 Z40\nG43.4 H1 Z40\nG0 A20 C-20\nG1 X5 Y3 Z0 F600\nX60 Y10 A35 C30\nX20 Y50 Z-4 A30 C130\nA25 C150\nX0 Y0 Z0\nG91 G1 X9 C-60\nG90 G2 X29 Y0 I10 J0 A20\nG0 Z50\nG49\nG0 A0 C0\nM30\n";

fn run(machine: &Machine, program: &str) -> (Run, String) {
    let run = machine.run_of(program, FORCE, |task| {
        task.corrected = Directions::ALL;
        task.writing.tolerance_mm = TOLERANCE_MM;
    });
    let text = String::from_utf8(run.written.as_ref().expect("a program").bytes.clone());
    (run, text.expect("text"))
}

fn check(machine: &Machine) {
    let (run, text) = run(machine, PROGRAM);
    let written = numbered_blocks(&text);
    let ends = blocks(PROGRAM);
    // Where the blocks of the program end in the written text.
    let pieces = run.written.as_ref().expect("a program").pieces.iter();
    let last = pieces.filter(|piece| piece.share_to == 1.0 && !piece.corner_step);
    let last = last.filter_map(|piece| written.iter().find(|(line, _)| *line == piece.output_line));
    let last: Vec<_> = last.map(|(_, block)| *block).collect();
    assert_eq!(last.len(), ends.len(), "{text}");
    let (mut tips, mut axes, mut before, mut count) = (Worst::new(), Worst::new(), Worst::new(), 0);
    let mut corrected = 0;
    for ([_, end], last) in ends.iter().zip(&last) {
        let at = last[1];
        count += 1;
        let wanted = vector![end[0], end[1], end[2]];
        tips.add((machine.tip(&at, &FORCE) - wanted).norm());
        let direction = machine.direction(end, &Vector3::zeros());
        axes.add(machine.direction(&at, &FORCE).angle(&direction));
        before.add(machine.direction(end, &FORCE).angle(&direction));
        corrected += usize::from(at[3] != end[3]);
    }
    assert_eq!(count, 7);
    assert_eq!(corrected, count, "{text}");
    // A micrometre beside the tolerance; half a digit of an angle is 1e-7 rad.
    let (tips, axes, before) = (tips.of(count), axes.of(count), before.of(count));
    assert!(tips < 0.001, "{tips}\n{text}");
    assert!(axes < 1e-6, "{axes} {before}\n{text}");
    assert!(before > 1e-5 && before > 50.0 * axes, "{before}");
    let (tips, axes, places) = between(machine, &run, &text);
    assert!(places >= 15, "{places}");
    assert!(tips < TOLERANCE_MM + 2e-4, "{tips}\n{text}");
    assert!(axes < (TOLERANCE_MM + 2e-4) / 50.0, "{axes}\n{text}");
    let summary = &run.result.summary;
    assert!(
        summary.max_position_error_after_mm < 1.2 * TOLERANCE_MM + 0.001,
        "{}",
        summary.max_position_error_after_mm
    );
    // Between the ends a point of the tool 50 mm from the tip keeps the tolerance.
    let lever = TOLERANCE_MM / 50.0;
    assert!(
        summary.max_residual_rotation_deg.to_radians() < 1.5 * lever,
        "{}",
        summary.max_residual_rotation_deg
    );
    assert!(text.contains("G49") && !text.contains("G2 "), "{text}");
}

/// Along the straight pieces, at places that the division does not take: how far the tip is off its place (mm) and the tool off
/// its direction (rad), where the program goes evenly from end to end.
fn between(machine: &Machine, run: &Run, text: &str) -> (f64, f64, usize) {
    let written = numbered_blocks(text);
    let source = blocks(PROGRAM);
    let lerp = |pair: &[[f64; 5]; 2], share: f64| {
        [0, 1, 2, 3, 4].map(|k| pair[0][k] + (pair[1][k] - pair[0][k]) * share)
    };
    let (mut tips, mut axes, mut count) = (Worst::new(), Worst::new(), 0);
    let (mut block, mut last) = (0, None);
    for piece in &run.written.as_ref().expect("a program").pieces {
        let Some((_, own)) = written.iter().find(|(line, _)| *line == piece.output_line) else {
            continue;
        };
        block += usize::from(last.is_some_and(|last| last != piece.move_index));
        last = Some(piece.move_index);
        // The first comes from a rapid, with a load that comes gradually; the last is an arc.
        if piece.corner_step || block == 0 || block + 1 == source.len() {
            continue;
        }
        for part in [0.23, 0.5, 0.81] {
            let share = piece.share_from + part * (piece.share_to - piece.share_from);
            let (at, wanted) = (lerp(own, part), lerp(&source[block], share));
            let place = vector![wanted[0], wanted[1], wanted[2]];
            tips.add((machine.tip(&at, &FORCE) - place).norm());
            let direction = machine.direction(&wanted, &Vector3::zeros());
            axes.add(machine.direction(&at, &FORCE).angle(&direction));
            count += 1;
        }
    }
    assert_eq!(block + 1, source.len());
    (tips.of(count), axes.of(count), count)
}

#[test]
fn a_fork_head_lays_the_tool_where_it_should_be() {
    check(&Machine::portal_with_head());
}

#[test]
fn a_table_of_two_axes_lays_the_part_against_the_tool() {
    check(&Machine::arm_with_table());
}

#[test]
fn a_head_and_a_table_share_the_turn() {
    check(&Machine::head_and_table());
}

#[test]
fn behind_the_last_cut_the_axes_stand_as_in_the_program() {
    let (_, text) = run(&Machine::portal_with_head(), PROGRAM);
    let lines: Vec<&str> = text.lines().collect();
    let off = lines.iter().position(|line| *line == "G49").expect("G49");
    // The rapid before it states both angles again.
    let back = lines[off - 1];
    assert!(
        back.starts_with("G0") && back.contains("A20") && back.contains("C90"),
        "{text}"
    );
}

#[test]
fn at_the_pole_the_angle_stays_and_a_line_says_so() {
    let machine = Machine::portal_with_head();
    let text =
        "G21 G90 G94\nG0 A0 C0\nG0 X0 Y0 Z40\nG43.4 H1 Z40\nG1 Z0 F600\nX60\nG0 Z50\nG49\nM30\n";
    let (run, written) = run(&machine, text);
    // A upright head tilts about x alone; C, along the tool, stays.
    assert!(
        !blocks(&written).iter().any(|block| block[1][4] != 0.0),
        "{written}"
    );
    assert!(
        blocks(&written).iter().any(|block| block[1][3] != 0.0),
        "{written}"
    );
    let pole = |w: &&kinetostat_machining::Warning| w.code == WarningCode::AtPole;
    let warning = run.result.warnings.iter().find(pole).expect("a warning");
    assert_eq!(warning.line, Some(5));
    assert!(run.result.summary.max_residual_rotation_deg > 1e-4);
    assert!(run.result.summary.max_position_error_after_mm < 1.1 * TOLERANCE_MM);
}

#[test]
fn a_tip_behind_the_flange_is_told() {
    use kinetostat_machining::{ToolGiven, straight_tool};
    // The platform of this portal has z up, into the ram, and a tool along z with it.
    let machine = Machine::portal_with_head();
    let warned = |length: f64| {
        let run = machine.run_of(PROGRAM, FORCE, |task| {
            let pose = straight_tool(length);
            task.bounds.limits.shortest_tool_mm = -200.0;
            task.bounds.tools = vec![ToolGiven {
                number: None,
                pose,
                stated: true,
            }];
        });
        let found = run.result.warnings.into_iter();
        found
            .filter(|w| w.code == WarningCode::TipBehindFlange)
            .count()
    };
    assert_eq!((warned(0.1), warned(-0.1)), (1, 0));
}

#[test]
fn directions_and_angles_are_inverse_for_any_two_axes() {
    // Angles to direction by Rodrigues' formula written here; back by the rule.
    let turn = |axis: &Vector3<f64>, angle: f64, v: &Vector3<f64>| {
        let n = axis.normalize();
        v * angle.cos() + n.cross(v) * angle.sin() + n * n.dot(v) * (1.0 - angle.cos())
    };
    let (first, second) = (vector![0.1, 0.2, 0.97], vector![0.9, -0.2, 0.1]);
    let axis = |letter, carries, direction| RotaryAxis {
        letter,
        carries,
        direction: Unit::new_normalize(direction),
        point_mm: Vector3::zeros(),
        limits_deg: None,
    };
    for carries in [Carries::Tool, Carries::Part] {
        let axes = RotaryAxes {
            axes: vec![axis('C', carries, first), axis('A', carries, second)],
            tool_at_zero: UnitQuaternion::identity(),
        };
        for k in 0..40_i32 {
            let (c, a) = (f64::from(37 * k % 360 - 180), f64::from(15 + 7 * k % 60));
            let z = Vector3::z();
            let by_hand = match carries {
                Carries::Tool => turn(&first, c.to_radians(), &turn(&second, a.to_radians(), &z)),
                Carries::Part => turn(&second, -a.to_radians(), &turn(&first, -c.to_radians(), &z)),
            };
            let found = axes.angles_near(&by_hand, &z, &[c + 4.0, a - 3.0]);
            if carries == Carries::Part && found.at_pole {
                continue;
            }
            assert!(found.left_rad < 1e-9, "{carries:?} {c} {a}: {found:?}");
            assert!((axes.tool_direction_at(&found.angles_deg, &z) - by_hand).norm() < 1e-9);
            // The closed form finds the same angles.
            let closed = axes.angles_towards(&by_hand, &[c + 4.0, a - 3.0]).unwrap();
            for (one, other) in closed.iter().zip(&found.angles_deg) {
                assert!(
                    (one - other).abs() < 1e-6,
                    "{carries:?}: {closed:?} {found:?}"
                );
            }
        }
    }
}
