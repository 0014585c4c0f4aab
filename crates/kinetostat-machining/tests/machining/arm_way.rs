//! An arm that comes along a program: the posture that it has then, and joints that turn on and on.

use kinetostat::{Directions, Mechanism, PostureRequest, Wrench};
use kinetostat_machining::{
    Bounds, CuttingLoad, LoadAxes, Placement, ProgramLoad, Run, RunInputs, Task, Unwatched,
    Warning, WarningCode, WeightCorrection, analyse,
};
use kinetostat_model::Model;
use kinetostat_program::{Gcode, Path, Program, ReadOptions, ToolTurn, WriteOptions, interpret};
use nalgebra::{UnitQuaternion, Vector3, vector};

/// Solves a program of positions; `turns_deg` are those of the tool about the vertical at the ends of the moves.
fn run(mechanism: &Mechanism, text: &str, placement: Placement, turns_deg: &[f64]) -> Run {
    let program = Program::read(text).expect("program");
    let reading = ReadOptions::default();
    let mut path: Path = interpret(&program, &reading).expect("path");
    let at = |turn: f64| {
        UnitQuaternion::from_axis_angle(&Vector3::z_axis(), turn.to_radians())
            * placement.tool_orientation
    };
    if !turns_deg.is_empty() {
        assert_eq!(turns_deg.len(), path.moves.len());
        for (index, motion) in path.moves.iter_mut().enumerate() {
            let start = turns_deg[index.saturating_sub(1)];
            motion.tool_turn = Some(Box::new(ToolTurn::shortest(
                at(start),
                at(turns_deg[index]),
            )));
        }
        path.tool_axis = -Vector3::z();
    }
    let task = Task {
        mechanism,
        program: &Gcode {
            program: &program,
            path: &path,
            reading: &reading,
        },
        corrected: Directions::POSITION,
        placement,
        load: ProgramLoad::new(CuttingLoad::Constant {
            axes: LoadAxes::Base,
            wrench: Wrench::new(vector![0.0, 0.0, 50.0], Vector3::zeros()),
        }),
        tools: &[],
        weight: WeightCorrection::All,
        cut: None,
        writing: WriteOptions::default(),
        run_inputs: RunInputs::default(),
        bounds: Bounds::default(),
        places: 0,
        compliances: false,
    };
    analyse(&task, &Unwatched).expect("run")
}

fn warning(run: &Run, code: WarningCode) -> Option<&Warning> {
    run.result.warnings.iter().find(|w| w.code == code)
}

/// The tool goes sideways in front of an arm whose wrist is straight in the middle: there it flips, and nowhere else. Solved from home
/// every place by itself, the wrist would be on either side as it happens.
#[test]
fn the_arm_flips_where_its_wrist_is_straight() {
    let mechanism = Model::preset("heavy_6r").expect("preset").mechanism;
    let straight = [0.0, 0.2, -0.2, 0.0, 0.0, 0.0];
    let posture = mechanism
        .posture(PostureRequest::commands(&straight))
        .expect("a posture");
    let pose = *posture.target();
    let [x, _, z]: [f64; 3] = (1e3 * pose.translation.vector).into();
    let mut placement = Placement::at(Vector3::zeros());
    placement.tool_orientation = pose.rotation;
    // In one block, and in short ones, over which the arm is followed in the same steps.
    let short: String = (-289..=300).map(|y| format!("G1 Y{y}\n")).collect();
    for rest in ["G1 Y300\n", &short] {
        let text = format!("G21 G90\nG0 X{x:.6} Y-300 Z{z:.6}\nG1 Y-290 F1200\n{rest}");
        let run = run(&mechanism, &text, placement, &[]);
        let joints = &run.result.joints;
        assert_eq!(joints.change_count, 1, "{:?}", joints.changes);
        let change = joints.changes[0];
        assert!(change.position_mm[1].abs() < 6.0, "{change:?}");
        let line = if rest == short { 293 } else { 4 };
        assert!(change.line.abs_diff(line) < 7, "{change:?}");
        // Joint 4 stays: the wrist goes straight through.
        let fourth = |index: usize| run.points[index].actuator_command[3];
        let turned = fourth(run.points.len() - 2) - fourth(1);
        assert!(turned.abs() < 10.0, "{turned}");
    }
}

/// The tool, downwards, is turned by 120 deg on each move and on and on: joint 6 follows.
#[test]
fn a_joint_that_turns_on_and_on_meets_its_limit() {
    let mechanism = Model::preset("heavy_6r").expect("preset").mechanism;
    let home = mechanism.platforms()[mechanism.tool()].home;
    let mut placement = Placement::at(vector![1.2, 0.0, 0.8]);
    placement.tool_orientation = home.rotation;
    let text = "G21 G90\nG0 X0 Y0 Z0\nG1 X1 F600\nG1 X10\nG1 X20\nG1 X30\nG1 X40\n";
    // Limits of +-350 deg, from 0: a third of a turn thrice is 360.
    for sign in [1.0, -1.0] {
        let turns = [0.0, 0.0, 120.0, 240.0, 360.0, 480.0].map(|turn| sign * turn);
        let run = run(&mechanism, text, placement, &turns);
        let found = warning(&run, WarningCode::JointTurnsOn).expect("a warning");
        assert_eq!(found.line, Some(6), "{found}");
        let text = &found.message;
        assert!(text.contains("'joint 6' meets its limit of"), "{text}");
        assert!(text.contains("350 deg"), "{text}");
        assert!(text.contains("lift the tool before line 6"), "{text}");
    }
    // From 170 deg on: a turn back at the start is enough.
    for sign in [1.0, -1.0] {
        let turns = [170.0, 170.0, 230.0, 290.0, 350.0, 400.0].map(|turn| sign * turn);
        let run = run(&mechanism, text, placement, &turns);
        let found = warning(&run, WarningCode::JointTurnsOn).expect("a warning");
        assert_eq!(found.line, Some(7), "{found}");
        let start = run.points[0].actuator_command[5];
        let back = start - 360.0 * start.signum();
        let said = format!("begin the cut on line 2 with 'joint 6' at {back:.1} deg");
        assert!(
            found.message.contains(&said) || found.message.contains("begin the cut on line 3"),
            "{found}"
        );
    }
    // There and back again it stays inside.
    let turns = [0.0, 0.0, 120.0, 240.0, 120.0, 0.0];
    let run = run(&mechanism, text, placement, &turns);
    assert!(warning(&run, WarningCode::JointTurnsOn).is_none());
}

/// The tool turns by one and a half turns over 600 short moves: joint 6 turns by as much, without a jump at any boundary of a batch.
#[test]
fn joint_values_are_continuous_along_the_path() {
    let mechanism = Model::preset("heavy_6r").expect("preset").mechanism;
    let home = mechanism.platforms()[mechanism.tool()].home;
    let mut placement = Placement::at(vector![1.2, 0.0, 0.8]);
    placement.tool_orientation = home.rotation;
    let moves: String = (1..=600)
        .map(|k| format!("G1 X{:.1} F600\n", 0.1 * f64::from(k)))
        .collect();
    let turns: Vec<f64> = (0..=600).map(|k| 0.9 * f64::from(k)).collect();
    let run = run(
        &mechanism,
        &format!("G21 G90\nG0 X0 Y0 Z0\n{moves}"),
        placement,
        &turns,
    );
    assert!(run.points.len() > 512, "more than two batches");
    let commands = || run.points.iter().map(|p| &p.actuator_command);
    for (before, after) in commands().zip(commands().skip(1)) {
        let steps = before.iter().zip(after).map(|(a, b)| (b - a).abs());
        assert!(steps.clone().all(|step| step < 2.0), "{before:?} {after:?}");
    }
    let sixth: Vec<f64> = commands().map(|values| values[5]).collect();
    let turned = (sixth[sixth.len() - 1] - sixth[0]).abs();
    assert!((turned - 540.0).abs() < 5.0, "{turned}");
    // The kept points and the ranges have the same values.
    let [low, high] = run.result.joints.ranges[5];
    assert!((high - low - turned).abs() < 1.0, "{low} to {high}");
    for kept in &run.result.points {
        let same = |p: &&kinetostat_machining::PointResult| {
            p.path_mm == kept.path_mm && p.kind == kept.kind
        };
        assert!(
            run.points
                .iter()
                .any(|p| same(&p) && p.actuator_command == kept.actuator_command)
        );
    }
}
