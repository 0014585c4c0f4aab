//! Programs in the language of a robot, with the orientation of the tool: compensated, and solved again from the written text,
//! which a scan of this file reads.

use kinetostat::{Directions, Mechanism, Pose, Wrench};
use kinetostat_formats::{
    Correctable, PathOptions, ReadOptions, RobotProgram, SourceFile, WriteOptions as TextOptions,
    path_of, read_rapid,
};
use kinetostat_machining::{
    Bounds, CuttingLoad, LoadAlongPath, LoadAxes, Placement, ProgramLoad, Run, RunInputs, Task,
    Unwatched, compensate_program,
};
use kinetostat_model::Model;
use kinetostat_program::{ToolTurn, WriteOptions, irregular};
use kinetostat_testing::Worst;
use nalgebra::{Quaternion, UnitQuaternion, Vector3, vector};

/// A pose in base axes, mm.
fn rapid_pose(pose: &Pose) -> String {
    let p = 1e3 * pose.translation.vector;
    let q = pose.rotation.quaternion();
    format!(
        "[[{:.4},{:.4},{:.4}],[{:.9},{:.9},{:.9},{:.9}],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]",
        p.x, p.y, p.z, q.w, q.i, q.j, q.k
    )
}

/// The poses that a text states, base axes, m: the first two lists of numbers of every target.
fn poses_of(text: &str) -> Vec<Pose> {
    let mut poses = Vec::new();
    for target in text.split("[[").skip(1) {
        let numbers: Vec<f64> = target
            .split([',', '[', ']'])
            .filter(|number| !number.is_empty())
            .map_while(|number| number.parse().ok())
            .take(7)
            .collect();
        let [x, y, z, w, i, j, k] = numbers[..] else {
            panic!("a target of {numbers:?}");
        };
        poses.push(Pose::from_parts(
            (vector![x, y, z] * 1e-3).into(),
            UnitQuaternion::from_quaternion(Quaternion::new(w, i, j, k)),
        ));
    }
    poses
}

/// Straight motions that turn the tool by some degrees each, round the pose in which the arm is drawn.
fn program(home: &Pose, seed: u64) -> (String, Vec<Pose>) {
    let mut poses = Vec::new();
    for k in 0..7 {
        let off = |n: u64, size: f64| size * (2.0 * irregular(seed, k, n) - 1.0);
        let shift = vector![off(0, 0.15), off(1, 0.15), off(2, 0.05)];
        let turn = UnitQuaternion::from_scaled_axis(vector![off(3, 0.2), off(4, 0.2), off(5, 0.2)]);
        let at = home.translation.vector + shift;
        poses.push(Pose::from_parts(at.into(), turn * home.rotation));
    }
    let mut text = "MODULE Cut\n  ! by hand\n  PROC main()\n".to_owned();
    text.push_str(&format!(
        "    MoveJ {},v500,z10,tool0;\n",
        rapid_pose(&poses[0])
    ));
    for pose in &poses[1..] {
        text.push_str(&format!("    MoveL {},v20,fine,tool0;\n", rapid_pose(pose)));
    }
    text.push_str("  ENDPROC\nENDMODULE\n");
    // As written, with its digits.
    let poses = poses_of(&text);
    (text, poses)
}

fn read(text: &str) -> RobotProgram {
    let files = vec![SourceFile::new("cut.mod", text)];
    read_rapid(files, &ReadOptions::default()).expect("a program")
}

fn run(mechanism: &Mechanism, text: &str, corrected: Directions, load: ProgramLoad) -> Run {
    let program = read(text);
    let making = PathOptions::default();
    let path = path_of(&program, &making).expect("a path");
    let robot = Correctable {
        program: &program,
        path: &path,
        reading: &ReadOptions::default(),
        making: &making,
        writing: &TextOptions::default(),
    };
    let task = Task {
        mechanism,
        program: &robot,
        corrected,
        placement: Placement::at(Vector3::zeros()),
        load,
        tools: &[],
        cut: None,
        writing: WriteOptions::default(),
        run_inputs: RunInputs::default(),
        bounds: Bounds::default(),
    };
    compensate_program(&task, &Unwatched).unwrap_or_else(|e| panic!("{e}"))
}

/// Where the core has the tool when it is commanded to a pose under a wrench.
fn tool(mechanism: &Mechanism, commanded: &Pose, wrench: &Wrench) -> Pose {
    let posture = mechanism.posture(commanded).expect("a posture");
    posture.deflected_by(wrench).expect("an equilibrium").tool
}

/// Position (mm) and orientation (rad) missed at the ends of motions and between them, where the arm goes evenly along the line
/// while it turns about one axis.
fn missed(corrected: Directions, load: ProgramLoad, seed: u64) -> [f64; 4] {
    let model = Model::preset("heavy_6r").expect("preset");
    let mechanism = &model.mechanism;
    let home = mechanism.platforms()[mechanism.tool()].home;
    let (text, wanted) = program(&home, seed);
    let run = run(mechanism, &text, corrected, load);
    let written = run.written.expect("a program");
    let output = String::from_utf8(written.bytes.clone()).expect("text");
    let commanded = poses_of(&output);
    assert_eq!(commanded.len(), written.pieces.len());
    let making = PathOptions::default();
    let path = path_of(&read(&text), &making).expect("a path").path;
    let placement = Placement::at(Vector3::zeros());
    let law = LoadAlongPath::new(load, &path);
    let mut worst = [Worst::new(), Worst::new(), Worst::new(), Worst::new()];
    for (index, piece) in written.pieces.iter().enumerate().skip(1) {
        if piece.corner_step {
            continue;
        }
        let motion = piece.move_index;
        let goal = |share: f64| {
            let [a, b] = [wanted[motion - 1], wanted[motion]];
            let turn = ToolTurn {
                start: a.rotation,
                end: b.rotation,
            };
            let at = a.translation.vector.lerp(&b.translation.vector, share);
            Pose::from_parts(at.into(), turn.at(share))
        };
        let mut look = |part: f64, [position, orientation]: [usize; 2]| {
            let share = piece.share_from + part * (piece.share_to - piece.share_from);
            let [a, b] = [commanded[index - 1], commanded[index]];
            let turn = ToolTurn {
                start: a.rotation,
                end: b.rotation,
            };
            let at = a.translation.vector.lerp(&b.translation.vector, part);
            let wrench = law.wrench(&placement, motion, share);
            let is = tool(
                mechanism,
                &Pose::from_parts(at.into(), turn.at(part)),
                &wrench,
            );
            let goal = goal(share);
            let off = is.translation.vector - goal.translation.vector;
            worst[position].add(1e3 * off.norm());
            worst[orientation].add(is.rotation.angle_to(&goal.rotation));
        };
        look(1.0, [0, 1]);
        // Where the first cut begins the load comes over half a millimetre; the ends are there when it has.
        if index == 1 {
            continue;
        }
        for k in 0..3 {
            look(irregular(seed + 77, index as u64, k), [2, 3]);
        }
    }
    let ends = written.pieces.iter().skip(1).filter(|p| !p.corner_step);
    let ends = ends.count();
    [
        worst[0].of(ends),
        worst[1].of(ends),
        worst[2].of(3 * (ends - 1)),
        worst[3].of(3 * (ends - 1)),
    ]
}

fn constant(axes: LoadAxes) -> ProgramLoad {
    let wrench = Wrench::new(vector![300.0, -200.0, 150.0], vector![3.0, 1.0, -2.0]);
    ProgramLoad::new(CuttingLoad::Constant { axes, wrench })
}

#[test]
fn figure_rapid_of_a_heavy_arm_is_where_it_should_be_with_its_orientation() {
    let mut largest = [0.0_f64; 4];
    for (seed, axes) in [
        (1, LoadAxes::Tool),
        (2, LoadAxes::Base),
        (3, LoadAxes::Feed),
    ] {
        let found = missed(Directions::ALL, constant(axes), seed);
        for (all, one) in largest.iter_mut().zip(found) {
            *all = kinetostat::number::larger(*all, one);
        }
    }
    let [position, orientation, between, turned] = largest;
    use kinetostat_testing::figure::at_most;
    let name = "RAPID of heavy_6r, pose corrected";
    assert!(at_most(
        &format!("{name}: position at the points"),
        position,
        1e-3,
        "mm"
    ));
    assert!(at_most(
        &format!("{name}: orientation at the points"),
        orientation,
        1e-5,
        "rad"
    ));
    assert!(at_most(
        &format!("{name}: position between the points"),
        between,
        1.5e-3,
        "mm"
    ));
    assert!(at_most(
        &format!("{name}: orientation between the points"),
        turned,
        3e-5,
        "rad"
    ));
}

#[test]
fn where_only_the_position_is_corrected_the_orientation_is_that_of_the_program() {
    let [position, orientation, between, _] =
        missed(Directions::POSITION, constant(LoadAxes::Tool), 5);
    assert!(position < 1e-3 && between < 1.5e-3, "{position} {between}");
    // The arm turns under its load, and is let.
    assert!((1e-5..0.01).contains(&orientation), "{orientation}");
}

#[test]
fn forces_of_milling_turn_with_the_tool() {
    let model = Model::preset("heavy_6r").expect("preset");
    let home = model.mechanism.platforms()[model.mechanism.tool()].home;
    let (text, _) = program(&home, 9);
    let path = path_of(&read(&text), &PathOptions::default())
        .expect("a path")
        .path;
    let load = ProgramLoad::new(CuttingLoad::Milling {
        radial: 70.0,
        tangential: -20.0,
        axial: 15.0,
    });
    let law = LoadAlongPath::new(load, &path);
    for (index, motion) in path.moves.iter().enumerate().skip(1) {
        // In the middle, away from the corners: by cross products, without an angle.
        let force = law
            .wrench(&Placement::at(Vector3::zeros()), index, 0.5)
            .force();
        let up = motion.orientation(0.5).expect("an orientation") * -Vector3::z();
        let along = motion.tangent(0.5).expect("a direction");
        let along = (along - up * along.dot(&up)).normalize();
        let right = along.cross(&up);
        let wanted = right * 70.0 - along * 20.0 + up * 15.0;
        assert!((force - wanted).norm() < 1e-9, "{force} {wanted}");
    }
}
