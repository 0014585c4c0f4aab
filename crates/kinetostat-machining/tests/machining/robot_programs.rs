//! Programs in the language of a robot, with the orientation of the tool: compensated, and solved again from the written text,
//! which a scan of this file reads.

use kinetostat::{Directions, Mechanism, Pose, Wrench};
use kinetostat_formats::{
    Correctable, Language, PathOptions, ReadOptions, RobotProgram, SourceFile,
    WriteOptions as TextOptions, path_of,
};
use kinetostat_machining::{
    Bounds, CuttingLoad, LoadAlongPath, LoadAxes, Placement, ProgramLoad, Run, RunInputs, Task,
    Unwatched, WeightCorrection, compensate_program,
};
use kinetostat_model::Model;
use kinetostat_program::{ToolTurn, WriteOptions, irregular};
use kinetostat_testing::Worst;
use nalgebra::{Quaternion, UnitQuaternion, Vector3, vector};

/// A pose of RAPID, base axes, mm.
fn rapid_pose(pose: &Pose) -> String {
    let p = 1e3 * pose.translation.vector;
    let q = pose.rotation.quaternion();
    format!(
        "[[{:.4},{:.4},{:.4}],[{:.9},{:.9},{:.9},{:.9}],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]",
        p.x, p.y, p.z, q.w, q.i, q.j, q.k
    )
}

/// A pose of KRL, base axes, mm and degrees: Rz(A) Ry(B) Rx(C).
fn krl_pose(pose: &Pose) -> String {
    let p = 1e3 * pose.translation.vector;
    let (c, b, a) = pose.rotation.euler_angles();
    let [a, b, c] = [a, b, c].map(f64::to_degrees);
    format!(
        "{{X {:.4},Y {:.4},Z {:.4},A {a:.6},B {b:.6},C {c:.6},S 2,T 35}}",
        p.x, p.y, p.z
    )
}

/// The first numbers of every target that begins so.
fn numbers_of(text: &str, begins: &str, count: usize) -> Vec<Vec<f64>> {
    let targets = text.split(begins).skip(1);
    targets
        .map(|target| {
            let numbers: Vec<f64> = target
                .split([',', '[', ']', ' ', '}'])
                .filter_map(|number| number.parse().ok())
                .take(count)
                .collect();
            assert_eq!(numbers.len(), count);
            numbers
        })
        .collect()
}

/// The poses that a text states, base axes, m: of RAPID and of KRL.
fn poses_of(text: &str) -> Vec<Pose> {
    let pose = |n: &[f64], rotation: UnitQuaternion<f64>| {
        Pose::from_parts((vector![n[0], n[1], n[2]] * 1e-3).into(), rotation)
    };
    let rapid = numbers_of(text, "[[", 7);
    let rapid = rapid.iter().map(|n| {
        let quaternion = Quaternion::new(n[3], n[4], n[5], n[6]);
        pose(n, UnitQuaternion::from_quaternion(quaternion))
    });
    let krl = numbers_of(text, "{X ", 6);
    let krl = krl.iter().map(|n| {
        let about =
            |axis, degrees: f64| UnitQuaternion::from_axis_angle(&axis, degrees.to_radians());
        let turn = about(Vector3::z_axis(), n[3])
            * about(Vector3::y_axis(), n[4])
            * about(Vector3::x_axis(), n[5]);
        pose(n, turn)
    });
    rapid.chain(krl).collect()
}

/// Straight motions that turn the tool by some degrees each, round the pose in which the arm is drawn.
fn program(language: Language, home: &Pose, seed: u64) -> (String, Vec<Pose>) {
    let mut poses = Vec::new();
    for k in 0..7 {
        let off = |n: u64, size: f64| size * (2.0 * irregular(seed, k, n) - 1.0);
        let shift = vector![off(0, 0.15), off(1, 0.15), off(2, 0.05)];
        let turn = UnitQuaternion::from_scaled_axis(vector![off(3, 0.2), off(4, 0.2), off(5, 0.2)]);
        let at = home.translation.vector + shift;
        poses.push(Pose::from_parts(at.into(), turn * home.rotation));
    }
    let mut text = String::new();
    match language {
        Language::Krl => {
            text.push_str("DEF cut( )\n$VEL.CP=0.02\n");
            text.push_str(&format!("PTP {}\n", krl_pose(&poses[0])));
            for pose in &poses[1..] {
                text.push_str(&format!("LIN {}\n", krl_pose(pose)));
            }
            text.push_str("END\n");
        }
        _ => {
            text.push_str("MODULE Cut\n  ! by hand\n  PROC main()\n");
            text.push_str(&format!(
                "    MoveJ {},v500,z10,tool0;\n",
                rapid_pose(&poses[0])
            ));
            for pose in &poses[1..] {
                text.push_str(&format!("    MoveL {},v20,fine,tool0;\n", rapid_pose(pose)));
            }
            text.push_str("  ENDPROC\nENDMODULE\n");
        }
    }
    // As written, with its digits.
    let poses = poses_of(&text);
    (text, poses)
}

fn read(text: &str) -> RobotProgram {
    let language = match text.starts_with("DEF") {
        true => Language::Krl,
        false => Language::Rapid,
    };
    let files = vec![SourceFile::new("cut", text)];
    kinetostat_formats::read(language, files, &ReadOptions::default()).expect("a program")
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
        weight: WeightCorrection::All,
        cut: None,
        writing: WriteOptions::default(),
        run_inputs: RunInputs::default(),
        bounds: Bounds::default(),
        places: 0,
        compliances: false,
    };
    compensate_program(&task, &Unwatched).unwrap_or_else(|e| panic!("{e}"))
}

/// Where the core has the tool when it is commanded to a pose under a wrench.
fn tool(mechanism: &Mechanism, commanded: &Pose, wrench: &Wrench) -> Pose {
    let posture = mechanism.posture(commanded).expect("a posture");
    posture.deflected_by(wrench).expect("an equilibrium").tool
}

/// How the controller turns the tool: about one axis, or (KUKA's LIN) its x swivels in a plane while it turns about its x.
fn turned(
    language: Language,
    [from, to]: [UnitQuaternion<f64>; 2],
    share: f64,
) -> UnitQuaternion<f64> {
    if language != Language::Krl {
        return ToolTurn::shortest(from, to).at(share);
    }
    let [a, b] = [from, to].map(|turn| turn * Vector3::x_axis());
    let swivel = UnitQuaternion::rotation_between_axis(&a, &b).expect("less than half a turn");
    let spin = (swivel * from).inverse() * to;
    swivel.powf(share) * from * spin.powf(share)
}

/// Position (mm) and orientation (rad) missed at the ends of motions and between them, where the arm goes evenly along the line
/// while it turns as the controller does.
fn missed(language: Language, corrected: Directions, load: ProgramLoad, seed: u64) -> [f64; 4] {
    let model = Model::preset("heavy_6r").expect("preset");
    let mechanism = &model.mechanism;
    let home = mechanism.platforms()[mechanism.tool()].home;
    let (text, wanted) = program(language, &home, seed);
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
            let at = a.translation.vector.lerp(&b.translation.vector, share);
            Pose::from_parts(at.into(), turned(language, [a.rotation, b.rotation], share))
        };
        let mut look = |part: f64, [position, orientation]: [usize; 2]| {
            let share = piece.share_from + part * (piece.share_to - piece.share_from);
            let [a, b] = [commanded[index - 1], commanded[index]];
            let turn = turned(language, [a.rotation, b.rotation], part);
            let at = a.translation.vector.lerp(&b.translation.vector, part);
            let wrench = law.wrench(&placement, motion, share);
            let is = tool(mechanism, &Pose::from_parts(at.into(), turn), &wrench);
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

/// Of all loads and seeds.
fn largest_missed(language: Language, name: &str) {
    let mut largest = [0.0_f64; 4];
    for (seed, axes) in [
        (1, LoadAxes::Tool),
        (2, LoadAxes::Base),
        (3, LoadAxes::Feed),
    ] {
        let found = missed(language, Directions::ALL, constant(axes), seed);
        for (all, one) in largest.iter_mut().zip(found) {
            *all = kinetostat::number::larger(*all, one);
        }
    }
    let [position, orientation, between, turned] = largest;
    use kinetostat_testing::figure::at_most;
    let held = |what: &str, measured, most, unit| {
        let name = format!("{name} of heavy_6r, pose corrected: {what}");
        assert!(at_most(&name, measured, most, unit), "{what}: {measured}");
    };
    held("position at the points", position, 1e-3, "mm");
    held("orientation at the points", orientation, 1e-5, "rad");
    held("position between the points", between, 1e-3, "mm");
    held("orientation between the points", turned, 1e-5, "rad");
}

#[test]
fn figure_rapid_of_a_heavy_arm_is_where_it_should_be_with_its_orientation() {
    largest_missed(Language::Rapid, "RAPID");
}

#[test]
fn figure_krl_of_a_heavy_arm_is_where_it_should_be_with_its_orientation() {
    largest_missed(Language::Krl, "KRL");
}

#[test]
fn where_only_the_position_is_corrected_the_orientation_is_that_of_the_program() {
    let [position, orientation, between, _] = missed(
        Language::Rapid,
        Directions::POSITION,
        constant(LoadAxes::Tool),
        5,
    );
    assert!(position < 1e-3 && between < 1.5e-3, "{position} {between}");
    // The arm turns under its load, and is let.
    assert!((1e-5..0.01).contains(&orientation), "{orientation}");
}

#[test]
fn forces_of_milling_turn_with_the_tool() {
    let model = Model::preset("heavy_6r").expect("preset");
    let home = model.mechanism.platforms()[model.mechanism.tool()].home;
    let (text, _) = program(Language::Rapid, &home, 9);
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
