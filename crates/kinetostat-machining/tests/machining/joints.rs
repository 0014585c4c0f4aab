//! Limits, ratings and configuration along a program, against plain geometry.

use std::f64::consts::{PI, TAU};

use kinetostat::{Directions, Mechanism, Pose, PostureRequest, Wrench};
use kinetostat_machining::internal::configuration_at;
use kinetostat_machining::{
    Bounds, CuttingLoad, Elbow, LimitEnd, LoadAxes, Placement, PointKind, ProgramLoad, Run,
    RunError, RunInputs, Shoulder, Task, Unwatched, WarningCode, WeightCorrection, Wrist, analyse,
    natural_length,
};
use kinetostat_model::{Model, preset_names};
use kinetostat_program::{Gcode, Program, ReadOptions, WriteOptions, interpret, irregular};
use kinetostat_testing::Worst;
use nalgebra::{Matrix6, UnitQuaternion, Vector3, vector};

fn run(
    mechanism: &Mechanism,
    text: &str,
    placement: Placement,
    force: Vector3<f64>,
    ratings: Vec<Option<f64>>,
) -> Result<Run, RunError> {
    let program = Program::read(text).expect("program");
    let reading = ReadOptions::default();
    let path = interpret(&program, &reading).expect("path");
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
            wrench: Wrench::new(force, Vector3::zeros()),
        }),
        tools: &[],
        weight: WeightCorrection::All,
        cut: None,
        writing: WriteOptions::default(),
        run_inputs: RunInputs::default(),
        bounds: Bounds {
            ratings,
            ..Bounds::default()
        },
        places: 0,
        compliances: false,
    };
    analyse(&task, &Unwatched)
}

fn preset(name: &str) -> Model {
    Model::preset(name).expect("preset")
}

/// Home orientation of the tool, program zero at the base.
fn at_home(mechanism: &Mechanism) -> Placement {
    let mut placement = Placement::at(Vector3::zeros());
    placement.tool_orientation = mechanism.platforms()[mechanism.tool()].home.rotation;
    placement
}

/// Joint values of the heavy arm inside its limits, rad, as irregular as can be.
fn heavy_joints(sample: u64) -> [f64; 6] {
    let limits = [
        (-185.0, 185.0),
        (-65.0, 75.0),
        (-120.0, 150.0),
        (-350.0, 350.0),
        (-125.0, 125.0),
        (-350.0, 350.0),
    ];
    let mut joint = 0;
    limits.map(|(low, high): (f64, f64)| {
        joint += 1;
        (low + (high - low) * irregular(7, sample, joint)).to_radians()
    })
}

fn wrapped(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).round()
}

/// In the plane of the arm: shoulder 350 mm out, upper arm 1250 mm, forearm 1100 mm out and 55 mm down.
#[test]
fn the_heavy_arm_against_plain_geometry() {
    let mechanism = preset("heavy_6r").mechanism;
    let [mut shoulder, mut elbow, mut wrist] = [Worst::new(), Worst::new(), Worst::new()];
    let mut seen = [0; 8];
    for sample in 0..2000 {
        let q = heavy_joints(sample);
        let found = configuration_at(&mechanism, &q).expect("an arm");
        let out =
            350.0 + 1250.0 * q[1].sin() + 1100.0 * (q[1] + q[2]).cos() - 55.0 * (q[1] + q[2]).sin();
        let bent = wrapped(q[2] + 1100_f64.atan2(-55.0));
        let turned = wrapped(q[4]);
        shoulder.add(found.shoulder_from_singular_mm - out.abs());
        elbow.add(found.elbow_from_singular_deg - bent.abs().min(PI - bent.abs()).to_degrees());
        wrist.add(found.wrist_from_singular_deg - turned.abs().min(PI - turned.abs()).to_degrees());
        assert_eq!(found.shoulder == Shoulder::Front, out >= 0.0, "{q:?}");
        assert_eq!(found.elbow == Elbow::Up, bent >= 0.0, "{q:?}");
        assert_eq!(found.wrist == Wrist::NoFlip, turned >= 0.0, "{q:?}");
        let flags = [out < 0.0, bent < 0.0, turned < 0.0].map(u8::from);
        assert_eq!(found.number, flags[0] + 2 * flags[1] + 4 * flags[2]);
        seen[usize::from(found.number)] += 1;
    }
    assert!(seen.iter().all(|times| *times > 3), "{seen:?}");
    assert!(shoulder.of(2000) < 1e-9 && elbow.of(2000) < 1e-10 && wrist.of(2000) < 1e-10);
}

/// The Jacobian of the tool by differences: its determinant changes its sign where one of the flags does, and nowhere else.
#[test]
fn flags_have_the_sign_of_the_determinant() {
    for name in [
        "heavy_6r",
        "kuka_kr270_like",
        "abb_irb6640_like",
        "fanuc_r2000ic_like",
    ] {
        let mechanism = preset(name).mechanism;
        let pose = |q: &[f64; 6]| {
            let posture = mechanism
                .posture(PostureRequest::commands(q))
                .expect("a posture");
            *posture.target()
        };
        let mut signs = Vec::new();
        for sample in 0..200 {
            let q = heavy_joints(sample).map(|angle| 0.9 * angle);
            let found = configuration_at(&mechanism, &q).expect("an arm");
            let near = found
                .wrist_from_singular_deg
                .min(found.elbow_from_singular_deg)
                < 1.0
                || found.shoulder_from_singular_mm < 20.0;
            if near {
                continue;
            }
            let step = 1e-6;
            let jacobian = Matrix6::from_columns(&[0, 1, 2, 3, 4, 5].map(|joint| {
                let moved = |way: f64| {
                    let mut q = q;
                    q[joint] += way * step;
                    pose(&q)
                };
                let [back, forth] = [moved(-1.0), moved(1.0)];
                let linear = (forth.translation.vector - back.translation.vector) / (2.0 * step);
                let turn = (forth.rotation * back.rotation.inverse()).scaled_axis() / (2.0 * step);
                vector![linear.x, linear.y, linear.z, turn.x, turn.y, turn.z]
            }));
            let flags = [
                found.shoulder == Shoulder::Back,
                found.elbow == Elbow::Down,
                found.wrist == Wrist::Flip,
            ];
            let odd = flags.iter().filter(|flag| **flag).count() % 2 == 1;
            let sign = jacobian.determinant().signum();
            signs.push(match odd {
                true => -sign,
                false => sign,
            });
        }
        assert!(signs.len() > 100, "{name}: {}", signs.len());
        assert!(signs.iter().all(|sign| *sign == signs[0]), "{name}");
    }
}

/// At home arms of the library reach to the front with their elbow up; machines of another kind (also arms with bars beside their
/// axes) have no configuration.
#[test]
fn arms_have_a_configuration_and_other_machines_none() {
    let mut arms = Vec::new();
    for name in preset_names().iter().map(|preset| preset.name) {
        let mechanism = preset(name).mechanism;
        let home: Vec<f64> = mechanism
            .limbs()
            .iter()
            .flat_map(|limb| limb.nominal.home_commands())
            .collect();
        if let Some(found) = configuration_at(&mechanism, &home) {
            assert_eq!(found.number, 0, "{name}: {found}");
            arms.push(name.to_owned());
        }
    }
    arms.sort();
    let expected = [
        "abb_irb6640_like",
        "fanuc_r2000ic_like",
        "heavy_6r",
        "kuka_kr270_like",
    ];
    assert_eq!(arms, expected);
}

/// Two turning joints in a plane by the law of cosines, a quill, and torques as the lever of the force about each axis.
#[test]
fn scara_by_hand() {
    let model = preset("scara");
    let mechanism = &model.mechanism;
    let [first, second] = [0.325_f64, 0.275];
    let force = vector![12.0, -7.0, 0.0];
    let ratings = vec![Some(40.0), Some(9.0), None, Some(5.0)];
    let text = "G21 G90 G17\nG0 X460 Y-30 Z140\nG1 X300 Y200 F1000\nG1 X-120 Y330\nG1 Z180\nM2\n";
    let run = run(mechanism, text, at_home(mechanism), force, ratings).expect("run");
    let length = natural_length(mechanism);
    let (mut joints, mut distances, mut shares) = (Worst::new(), Worst::new(), Worst::new());
    let mut cut = 0;
    for point in run.points.iter().filter(|p| p.kind == PointKind::Feed) {
        let at = Vector3::from(point.position_mm) * 1e-3;
        let reach = at.xy().norm();
        let bent =
            ((reach * reach - first * first - second * second) / (2.0 * first * second)).acos();
        let turned = at.y.atan2(at.x) - (second * bent.sin()).atan2(first + second * bent.cos());
        let last = 45_f64.to_radians() - turned - bent;
        // The quill's end is 120 mm below a column of 350 mm.
        let slid = at.z - 0.35 + 0.12;
        let values = [
            turned.to_degrees(),
            bent.to_degrees(),
            1e3 * slid,
            last.to_degrees(),
        ];
        joints.all_apart(&point.actuator_command, &values);
        let limits = [
            (-132.0, 132.0),
            (-150.0, 150.0),
            (-200.0, 0.0),
            (-360.0, 360.0),
        ];
        let nearest = values
            .iter()
            .zip(limits)
            .enumerate()
            .flat_map(|(joint, (value, (low, high)))| {
                [
                    (joint, LimitEnd::Lower, value - low),
                    (joint, LimitEnd::Upper, high - value),
                ]
            })
            .min_by(|a, b| {
                let far = |found: &(usize, LimitEnd, f64)| match found.0 {
                    2 => 1e-3 * found.2,
                    _ => found.2.to_radians() * length,
                };
                far(a).total_cmp(&far(b))
            })
            .expect("limits");
        let limit = point.nearest_limit.expect("a limit");
        assert_eq!((limit.actuator, limit.end), (nearest.0, nearest.1));
        distances.apart(limit.distance, nearest.2);
        // J^T F: the lever about each axis.
        let elbow = vector![first * turned.cos(), first * turned.sin(), 0.0];
        let about = |axis: Vector3<f64>| (at - axis).cross(&force).z.abs();
        let loads = [about(Vector3::zeros()) / 40.0, about(elbow) / 9.0];
        let loaded = point.most_loaded.expect("a rating");
        if point.force_n == [12.0, -7.0, 0.0] {
            cut += 1;
            assert_eq!(loaded.actuator, usize::from(loads[1] > loads[0]));
            shares.add(loaded.share_of_rating / kinetostat_testing::largest(loads) - 1.0);
        }
        assert_eq!(point.configuration, None);
    }
    assert!(cut > 20, "{cut} places carry the whole force");
    let count = run
        .points
        .iter()
        .filter(|p| p.kind == PointKind::Feed)
        .count();
    assert!(joints.value() < 1e-6 && distances.of(count) < 1e-6);
    // The machine bends by some tenths of a millimetre of half a metre.
    assert!(shares.of(cut) < 5e-3, "{}", shares.value());
    let joints = &run.result.joints;
    let nearest = joints.nearest_limit.expect("a limit");
    let least = kinetostat_testing::least(
        run.points
            .iter()
            .filter_map(|p| {
                p.nearest_limit
                    .filter(|l| l.actuator == nearest.limit.actuator)
            })
            .map(|limit| limit.distance),
    );
    assert_eq!(nearest.limit.distance, least);
    let most = joints.most_loaded.expect("a rating").drive.share_of_rating;
    assert_eq!(Some(most), run.result.summary.largest_share_of_rating);
    assert_eq!((joints.change_count, joints.way_out), (0, None));
}

const GANTRY: &str = r#"
schema = 1

[mechanism]
name = "gantry"

[[platform]]
name = "tool"
home = { position_mm = [0, 0, 0] }

[chain.gantry]
elements = [
  { actuator = "prismatic", name = "x", axis = "x", stiffness_n_per_mm = 50000 },
  { actuator = "prismatic", name = "y", axis = "y", stiffness_n_per_mm = 50000 },
  { actuator = "prismatic", name = "z", axis = "z", stiffness_n_per_mm = 50000 },
]

[[limb]]
name = "gantry"
from = "base"
to = "tool"
chain = "gantry"
"#;

#[test]
fn a_machine_without_limits_says_nothing() {
    let model = Model::from_toml(GANTRY, "gantry.toml").expect("model");
    let text = "G21 G90 G17\nG0 X0 Y0 Z0\nG1 X30 F600\nG1 Y20\nM2\n";
    let placement = Placement::at(Vector3::zeros());
    let run = run(
        &model.mechanism,
        text,
        placement,
        vector![50.0, 0.0, 0.0],
        model.ratings(),
    );
    let result = run.expect("run").result;
    let joints = &result.joints;
    assert_eq!(joints.ranges, [[0.0, 30.0], [0.0, 20.0], [0.0, 0.0]]);
    assert!(joints.nearest_limit.is_none() && joints.most_loaded.is_none());
    assert!(
        joints.configuration.is_none() && joints.changes.is_empty() && joints.way_out.is_none()
    );
    for point in &result.points {
        let known = (point.nearest_limit.is_some(), point.most_loaded.is_some());
        assert_eq!((known, point.configuration), ((false, false), None));
    }
    let actuators = &result.run_inputs.actuators;
    assert!(
        actuators.len() == 3
            && actuators
                .iter()
                .all(|a| a.limits.is_none() && a.rating.is_none())
    );
    assert!(!result.run_inputs.has_configuration);
}

/// The heavy arm with its tool across the last axis, as spindles are mounted, drawn home: joint 5 at `bent` degrees.
fn spindle_across(bent: f64) -> (Mechanism, Pose) {
    let across = Pose::from_parts(
        vector![0.0, 0.0, 0.1].into(),
        UnitQuaternion::from_axis_angle(&Vector3::y_axis(), -0.5 * PI),
    );
    let mechanism = preset("heavy_6r").mechanism.with_tool(&across);
    let degrees: [f64; 6] = [0.0, -20.0, 35.0, 0.0, bent, 0.0];
    let commands = degrees.map(f64::to_radians);
    let posture = mechanism
        .posture(PostureRequest::commands(&commands))
        .expect("a posture");
    let pose = *posture.target();
    (mechanism, pose)
}

/// A straight way of 200 mm to both sides of a place, along x.
fn through(at: &Pose) -> (String, Placement) {
    let middle = 1e3 * at.translation.vector;
    let mut placement = Placement::at(Vector3::zeros());
    placement.tool_orientation = at.rotation;
    let text = format!(
        "G21 G90 G17\nG0 X{:.3} Y{:.3} Z{:.3}\nG1 X{:.3} F1000\nG1 X{:.3}\nM2\n",
        middle.x - 200.0,
        middle.y,
        middle.z,
        middle.x - 150.0,
        middle.x + 200.0
    );
    (text, placement)
}

#[test]
fn a_planted_wrist_flip_is_found_with_its_line_and_a_way_out() {
    let (mechanism, pose) = spindle_across(0.0);
    let (text, mut placement) = through(&pose);
    let force = vector![0.0, 0.0, 50.0];
    let found = run(&mechanism, &text, placement, force, Vec::new())
        .expect("run")
        .result;
    let change = found.joints.changes[0];
    assert_eq!((change.line_before, change.line), (4, 4));
    assert!(
        (change.position_mm[0] - 1e3 * pose.translation.x).abs() < 5.0,
        "{change:?}"
    );
    assert_ne!(
        change.before.expect("an arm").wrist,
        change.after.expect("an arm").wrist
    );
    let warning = found
        .warnings
        .iter()
        .find(|w| w.code == WarningCode::PostureChanges);
    let warning = warning.expect("a warning");
    assert_eq!(warning.line, Some(4));
    assert!(
        warning.message.starts_with("within line 4"),
        "{}",
        warning.message
    );
    let way = found.joints.way_out.expect("looked for");
    assert!(way.places > 50);
    let turn = way.turn_about_tool_axis_deg.expect("a turn");
    assert!(
        warning
            .message
            .contains(&format!("turned by {turn:.0} deg")),
        "{}",
        warning.message
    );
    // A dense search by itself: the least turn on either side that has no change.
    let changes = |turn: f64, placement: &Placement| {
        let mut turned = *placement;
        turned.tool_orientation *=
            UnitQuaternion::from_axis_angle(&Vector3::z_axis(), turn.to_radians());
        match run(&mechanism, &text, turned, force, Vec::new()) {
            Ok(run) => run.result.joints.change_count,
            Err(_) => usize::MAX,
        }
    };
    assert_eq!(changes(turn, &placement), 0);
    assert!(turn.abs() < 60.0, "{turn}");
    placement.orientation_follows = false;
    assert!(changes(0.0, &placement) > 0);
}

/// With the tip on axis 6 and the tool along it, a turn about the tool is a turn of joint 6: nothing helps.
#[test]
fn where_no_turn_helps_it_is_said() {
    let heavy = preset("heavy_6r").mechanism;
    let pose = |mechanism: &Mechanism, last: f64| {
        let commands = [0.0, -20.0, 35.0, 0.0, 0.0, last].map(f64::to_radians);
        let posture = mechanism.posture(PostureRequest::commands(&commands));
        *posture.expect("a posture").target()
    };
    // The flange is 100 mm beside the axis.
    let mut on_axis = [-0.1, 0.1]
        .into_iter()
        .map(|x| heavy.with_tool(&Pose::translation(x, 0.0, 0.1)));
    let mechanism = on_axis.find(|mechanism| {
        let moved =
            pose(mechanism, 0.0).translation.vector - pose(mechanism, 90.0).translation.vector;
        moved.norm() < 1e-9
    });
    let mechanism = mechanism.expect("one of both");
    let (text, placement) = through(&pose(&mechanism, 0.0));
    let found = run(
        &mechanism,
        &text,
        placement,
        vector![0.0, 0.0, 50.0],
        Vec::new(),
    );
    let found = found.expect("run").result;
    assert!(found.joints.change_count > 0);
    assert_eq!(
        found
            .joints
            .way_out
            .expect("looked for")
            .turn_about_tool_axis_deg,
        None
    );
    let said = found
        .warnings
        .iter()
        .any(|w| w.message.contains("No turn of the tool"));
    assert!(said, "{:?}", found.warnings);
}

/// Joint 5 of an arm whose range ends on the way.
#[test]
fn a_planted_limit_is_reported_with_line_and_way_out() {
    let text = preset("heavy_6r").text;
    let narrow = text.replace(
        "home_deg = 75, limits_deg = [-125, 125]",
        "home_deg = 75, limits_deg = [73, 125]",
    );
    assert_ne!(text, narrow);
    let model = Model::from_toml(&narrow, "narrow.toml").expect("model");
    let mechanism = model.mechanism.with_tool(&Pose::from_parts(
        vector![0.0, 0.0, 0.1].into(),
        UnitQuaternion::from_axis_angle(&Vector3::y_axis(), -0.5 * PI),
    ));
    let home = mechanism.platforms()[mechanism.tool()].home;
    let (text, placement) = through(&home);
    let force = vector![0.0, 0.0, 50.0];
    let error = run(&mechanism, &text, placement, force, Vec::new()).expect_err("a limit");
    let RunError::ArmStops { error, way_out } = error else {
        panic!("{error}");
    };
    let RunError::Point { line, message, .. } = *error else {
        panic!("{error}");
    };
    assert_eq!(line, 4, "{message}");
    assert!(
        message.contains("joint 5") && message.contains("73"),
        "{message}"
    );
    let turn = way_out.turn_about_tool_axis_deg.expect("a turn");
    let mut turned = placement;
    turned.tool_orientation *=
        UnitQuaternion::from_axis_angle(&Vector3::z_axis(), turn.to_radians());
    let found = run(&mechanism, &text, turned, force, Vec::new())
        .expect("a run")
        .result
        .joints;
    assert_eq!(found.change_count, 0);
    assert!(found.nearest_limit.expect("limits").limit.distance > 0.0);
}
