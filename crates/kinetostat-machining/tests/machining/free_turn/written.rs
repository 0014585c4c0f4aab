//! The turns in the moves of the path.

use kinetostat_machining::{TurnTask, choose_turns, with_turns};
use kinetostat_program::{Knowledge, Path, ToolTurn};
use kinetostat_testing::Worst;
use nalgebra::{UnitQuaternion, Vector3, vector};

use super::{downwards, milling_arm, path_of};

const ROUND: &str = "G21 G90 G17\nG0 X0 Y-150 Z0\nG1 X120 F900\nG3 X200 Y-70 I0 J80\nG1 Y60\nG0 Z40\nG0 X0 Y100\nG53 G0 Z0\nG0 X0 Y100 Z40\nG1 Z0\nG2 X60 Y160 Z-10 I60 J0\n";

/// Divided moves go along the same curves with the same lines, and end where the next one begins, with its orientation.
#[test]
fn divided_moves_make_the_same_path() {
    let mechanism = milling_arm("heavy_6r");
    let path = path_of(ROUND);
    let mut task = TurnTask::new(&mechanism, &path, downwards(vector![1.35, 0.0, 0.9], 20.0));
    task.bounds.rate_deg_per_mm = 1.5;
    // Evenness counts nothing.
    task.criteria.pop();
    let choice = choose_turns(&task).expect("a way");
    let turned = with_turns(&task, &choice).expect("a path");
    assert_eq!(turned.added + path.moves.len(), turned.path.moves.len());
    assert!(turned.added > 0, "it is divided somewhere");
    let (mut off, mut way) = (Worst::new(), 0.0);
    let (mut index, mut from) = (usize::MAX, 0.0);
    for (piece, source) in turned.path.moves.iter().zip(&turned.source) {
        let motion = &path.moves[*source];
        assert_eq!(
            (piece.line, piece.kind, piece.known),
            (motion.line, motion.kind, motion.known)
        );
        if *source != index {
            (index, from) = (*source, 0.0);
        }
        if motion.known != Knowledge::Whole {
            continue;
        }
        let length = piece.length_mm();
        for sample in 0..=8 {
            let share = f64::from(sample) / 8.0;
            let at = match motion.length_mm() > 0.0 {
                true => (from + share * length) / motion.length_mm(),
                false => share,
            };
            off.add((piece.point(share) - motion.point(at)).norm());
            // The turn that was chosen, by the way along the path.
            let wanted = choice.turn_at_deg(way + share * length - 1e-9 * f64::from(sample / 8));
            let wanted = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), wanted.to_radians());
            let found = piece.orientation(share).expect("stated");
            let wanted = task.placement.tool_orientation * wanted;
            assert!(
                wanted.angle_to(&found) < 1e-6,
                "line {} at {share}",
                piece.line
            );
        }
        way += length;
        from += length;
    }
    assert!(off.value() < 1e-9, "{off:?}");
    let ends = turned.path.moves.windows(2);
    for pair in
        ends.filter(|pair| pair[1].known == Knowledge::Whole && pair[0].known == Knowledge::Whole)
    {
        assert!((pair[0].end - pair[1].start).norm() < 1e-12);
        let turns = [pair[0].orientation(1.0), pair[1].orientation(0.0)].map(Option::unwrap);
        assert!(turns[0].angle_to(&turns[1]) < 1e-9);
    }
    // Tip to holder: the tool points downwards, so against its z.
    assert_eq!(turned.path.tool_axis, -Vector3::z());
    assert!(turned.axis_off_deg < 1e-6);
}

/// A program that tilts its tool: the axis stays where the program has it at the stations, and hardly off between them.
#[test]
fn the_axis_of_the_program_is_kept() {
    let mechanism = milling_arm("heavy_6r");
    let placement = downwards(vector![1.35, 0.0, 0.9], 0.0);
    let mut path: Path =
        path_of("G21 G90\nG0 X0 Y-100 Z0\nG1 X40 F900\nG1 X80 Y20\nG1 X80.01\nG1 Y100\n");
    let tilts = [0.0, 0.0, 0.2, 0.35, 0.1].map(|tilt: f64| {
        placement.tool_orientation * UnitQuaternion::from_euler_angles(0.5 * tilt, tilt, 0.3 * tilt)
    });
    let count = path.moves.len();
    for (index, motion) in path.moves.iter_mut().enumerate() {
        let start = tilts[index.saturating_sub(1)];
        motion.tool_turn = Some(Box::new(ToolTurn::shortest(start, tilts[index])));
    }
    assert_eq!(count, tilts.len());
    path.tool_axis = -Vector3::z();
    let mut task = TurnTask::new(&mechanism, &path, placement);
    task.station_mm = 4.0;
    task.band.step_deg = 4.0;
    let choice = choose_turns(&task).expect("a way");
    // The short move tilts by about 9 deg and has stations of its own.
    let last = choice.stations.last().expect("stations").way_mm;
    let length: f64 = path.moves[1..].iter().map(|m| m.length_mm()).sum();
    assert!(
        last > length + 5.0 && last < length + 20.0,
        "{last} {length}"
    );
    let turned = with_turns(&task, &choice).expect("a path");
    let (mut off, mut along) = (Worst::new(), [0; 5]);
    for (piece, source) in turned.path.moves.iter().zip(&turned.source) {
        along[*source] += 1;
        let motion = &path.moves[*source];
        let axis = |orientation: UnitQuaternion<f64>| orientation * Vector3::z();
        // By place along the move; the short one by share.
        for share in [0.0, 0.5, 1.0] {
            let point = piece.point(share);
            let at = (point - motion.start).norm() / (motion.end - motion.start).norm();
            if *source > 0 {
                let program = axis(motion.orientation(at).expect("stated"));
                off.add(axis(piece.orientation(share).expect("stated")).angle(&program));
            }
        }
    }
    assert!(off.value().to_degrees() < 0.2, "{off:?}");
    assert!(
        (off.value().to_degrees() - turned.axis_off_deg).abs() < 1e-3,
        "{off:?} {}",
        turned.axis_off_deg
    );
    assert!(along.iter().sum::<usize>() > 5, "{along:?}");
}
