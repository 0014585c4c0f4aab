//! Runs over programs on preset machines.

use kinetostat::{Directions, Mechanism, Pose, Wrench};
use kinetostat_machining::{
    Bounds, CuttingLoad, LoadAlongPath, Placement, ProgramLoad, Run, RunError, RunInputs, Task,
    Unwatched, WeightCorrection, analyse, compensate_program, straight_tool,
};
use kinetostat_model::Model;
use kinetostat_program::{Gcode, Program, ReadOptions, WriteOptions, interpret};
use nalgebra::{Vector3, vector};

const GROOVE: &str = "G21 G90 G17\nG0 X25 Y0 Z5\nG1 Z-2 F300\nG3 X25 Y0 I-25 J0 F600\nG0 Z5\nM2\n";

const GANTRY_WITH_A_ROD: &str = r#"
schema = 1

[mechanism]
name = "gantry with a rod"

[[platform]]
name = "tool"
home = { position_mm = [0, 0, -500] }

[section.rod]
round = { diameter_mm = 4 }
youngs_modulus_gpa = 210
poissons_ratio = 0.3

[chain.gantry]
elements = [
  { actuator = "prismatic", name = "x", axis = "x", stiffness_n_per_mm = 50000 },
  { actuator = "prismatic", name = "y", axis = "y", stiffness_n_per_mm = 50000 },
  { actuator = "prismatic", name = "z", axis = "z", stiffness_n_per_mm = 50000 },
  { rigid = { rotation_vector_deg = [0, 90, 0] } },
  { link = "rod", name = "rod", length_mm = 500, segments = 8 },
  { rigid = { rotation_vector_deg = [0, -90, 0] } },
]

[[limb]]
name = "gantry"
from = "base"
to = "tool"
chain = "gantry"
"#;

fn orthoglide() -> Mechanism {
    let mut model = Model::preset("orthoglide").expect("preset");
    for (leg, axis) in [
        ("leg x", Vector3::x()),
        ("leg y", Vector3::x()),
        ("leg z", Vector3::x()),
    ] {
        model = model
            .with_deviation(leg, "line", &Pose::rotation(axis * 1_f64.to_radians()))
            .expect("deviation");
    }
    model.mechanism.with_tool(&straight_tool(0.1))
}

fn milling() -> ProgramLoad {
    ProgramLoad::new(CuttingLoad::Milling {
        radial: 215.0,
        tangential: -10.0,
        axial: -25.0,
    })
}

fn run(
    mechanism: &Mechanism,
    text: &str,
    origin: Vector3<f64>,
    load: ProgramLoad,
    write: bool,
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
        placement: Placement::at(origin),
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
    if write {
        compensate_program(&task, &Unwatched)
    } else {
        analyse(&task, &Unwatched)
    }
}

#[test]
fn the_written_groove_is_within_a_micrometre_also_between_its_points() {
    let machine = orthoglide();
    let run = run(&machine, GROOVE, vector![0.0, 0.0, 0.1], milling(), true).expect("run");
    let summary = &run.result.summary;
    assert!(summary.max_position_error_before_mm > 0.5, "{summary:?}");
    assert!(summary.max_position_error_after_mm < 1e-3, "{summary:?}");
    assert!(summary.max_speed_deviation_percent <= 0.1);
    assert!(summary.converged && summary.stable);
    // An independent look at some points: read the written program with the reader, command what it
    // says, and ask the core where the tool goes.
    let written = run.written.expect("written");
    let program = Program::read(written.bytes).expect("written program");
    let path = interpret(&program, &ReadOptions::default()).expect("written path");
    let last = &path.moves[path.moves.len() - 2];
    let commanded = last.end * 1e-3 + vector![0.0, 0.0, 0.1];
    // The groove ends at angle 0, feed along +y: e_r is +x, e_t is +y.
    let force = Wrench::new(vector![215.0, -10.0, -25.0], Vector3::zeros());
    let target = Pose::translation(commanded.x, commanded.y, commanded.z);
    let tool = machine
        .posture(&target)
        .expect("posture")
        .deflected_by(&force)
        .expect("equilibrium")
        .tool;
    let error = tool.translation.vector - vector![0.025, 0.0, 0.098];
    assert!(error.norm() < 2e-7, "{error}");
}

#[test]
fn sharp_corners_and_cuts_that_begin_half_way_are_followed_within_a_micrometre() {
    let machine = orthoglide();
    let text = "G21 G90\nG0 X0 Y0 Z5\nG1 Z-2 F300\nG1 X30\nG1 Y20\nG1 X0\nG1 Y0\nG0 Z5\n";
    let mut law = milling();
    law.below_z_mm = Some(0.0);
    let summary = run(&machine, text, vector![0.0, 0.0, 0.1], law, true)
        .expect("run")
        .result
        .summary;
    assert!(summary.corner_steps >= 5, "{summary:?}");
    assert!(summary.largest_corner_step_mm > 0.05, "{summary:?}");
    assert!(summary.max_position_error_after_mm < 1e-3, "{summary:?}");
}

#[test]
fn the_report_s_own_fixed_point_finds_the_same_targets() {
    let machine = orthoglide();
    let result = run(&machine, GROOVE, vector![0.0, 0.0, 0.1], milling(), true)
        .expect("run")
        .result;
    let mut compared = 0;
    for point in result.points.iter().step_by(97) {
        let wanted = Vector3::from(point.position_mm) * 1e-3 + vector![0.0, 0.0, 0.1];
        let wrench = Wrench::new(Vector3::from(point.force_n), Vector3::zeros());
        // t0 <- t0 + (t - f^-1(F | t0)) [R 7.13]
        let mut t0 = wanted;
        for _ in 0..12 {
            let posture = machine
                .posture(&Pose::translation(t0.x, t0.y, t0.z))
                .expect("posture");
            let tool = posture.deflected_by(&wrench).expect("equilibrium").tool;
            t0 += wanted - tool.translation.vector;
        }
        let correction = (t0 - wanted) * 1e3;
        let written = Vector3::from(point.correction_mm);
        assert!(
            (correction - written).norm() < 1e-3,
            "line {}: {correction} {written}",
            point.line
        );
        compared += 1;
    }
    assert!(compared > 5);
}

#[test]
fn analysis_tells_the_errors_that_compensation_removes() {
    let machine = orthoglide();
    let origin = vector![0.0, 0.0, 0.1];
    let before = run(&machine, GROOVE, origin, milling(), false)
        .expect("analysis")
        .result;
    let both = run(&machine, GROOVE, origin, milling(), true)
        .expect("compensation")
        .result;
    assert!(!before.run_inputs.compensated && both.run_inputs.compensated);
    let (a, b) = (
        before.summary.max_position_error_before_mm,
        both.summary.max_position_error_before_mm,
    );
    assert!((a - b).abs() < 0.01 * a, "{a} {b}");
    assert_eq!(before.worst_points[0].line, both.worst_points[0].line);
}

#[test]
fn a_point_out_of_reach_is_named_with_its_line() {
    let machine = orthoglide();
    let text = "G21 G90\nG0 X0 Y0 Z0\nG1 X10 F100\nG1 X900\n";
    for write in [false, true] {
        let error = run(&machine, text, vector![0.0, 0.0, 0.1], milling(), write)
            .expect_err("out of reach");
        assert!(error.is_unanswered(), "{error}");
        assert!(error.to_string().starts_with("line 4:"), "{error}");
        assert!(error.to_string().contains("placement"), "{error}");
    }
}

#[test]
fn one_thread_and_two_write_the_same_bytes() {
    let machine = orthoglide();
    let bytes = |threads| {
        rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .expect("pool")
            .install(|| run(&machine, GROOVE, vector![0.0, 0.0, 0.1], milling(), true))
            .map(|run| {
                (
                    run.written.expect("written").bytes,
                    format!("{:?}", run.points),
                )
            })
            .expect("run")
    };
    assert_eq!(bytes(1), bytes(2));
}

#[test]
fn a_heavy_arm_sags_and_its_program_is_corrected_under_gravity_too() {
    let model = Model::preset("heavy_6r").expect("preset");
    let home = model.mechanism.platforms()[model.mechanism.tool()].home;
    let program = Program::read(GROOVE).expect("program");
    let reading = ReadOptions::default();
    let path = interpret(&program, &reading).expect("path");
    let placement = Placement {
        base_from_part: Pose::from_parts(home.translation, nalgebra::UnitQuaternion::identity()),
        tool_orientation: home.rotation,
        orientation_follows: false,
        scale: 1.0,
    };
    let task = Task {
        mechanism: &model.mechanism,
        program: &Gcode {
            program: &program,
            path: &path,
            reading: &reading,
        },
        corrected: Directions::POSITION,
        placement,
        load: milling(),
        tools: &[],
        weight: WeightCorrection::All,
        cut: None,
        writing: WriteOptions::default(),
        run_inputs: RunInputs::default(),
        bounds: Bounds::default(),
        places: 0,
        compliances: false,
    };
    let summary = compensate_program(&task, &Unwatched)
        .expect("run")
        .result
        .summary;
    assert!(summary.max_position_error_before_mm > 0.3, "{summary:?}");
    assert!(summary.max_position_error_after_mm < 1e-3, "{summary:?}");
    // Where the load is off (rapids), gravity is still there.
    let load = LoadAlongPath::new(milling(), &path);
    assert_eq!(load.wrench(&placement, 0, 1.0), Wrench::zero());
}

#[test]
fn a_program_on_which_the_machine_would_buckle_is_not_written() {
    // A slender rod below three slides, pressed upwards at 1.5 times Euler's load (4 mm, 0.5 m: 26 N).
    let model = Model::from_toml(GANTRY_WITH_A_ROD, "gantry.toml").expect("a model");
    let machine = model.mechanism;
    let push = CuttingLoad::Constant {
        axes: kinetostat_machining::LoadAxes::Base,
        wrench: Wrench::new(vector![0.0, 0.0, 39.0], Vector3::zeros()),
    };
    let text = "G21 G90\nG0 X0 Y0 Z0\nG1 X20 F100\n";
    let origin = vector![0.0, 0.0, -0.5];
    let reported = run(&machine, text, origin, ProgramLoad::new(push), false)
        .expect("analysis")
        .result;
    assert!(!reported.summary.stable, "{:?}", reported.summary);
    assert!(
        reported
            .warnings
            .iter()
            .any(|w| w.message.contains("do not run this program")),
        "{:?}",
        reported.warnings
    );
    let error = run(&machine, text, origin, ProgramLoad::new(push), true).expect_err("unstable");
    assert!(
        error.is_unanswered() && error.to_string().contains("not stable"),
        "{error}"
    );
}

#[test]
fn the_load_description_names_the_machine_s_own_weight() {
    for (preset, words) in [
        ("heavy_6r", "own weight, 940 kg"),
        ("orthoglide", "no weight in the model"),
    ] {
        let model = Model::preset(preset).expect("preset");
        let program = Program::read(GROOVE).expect("program");
        let path = interpret(&program, &ReadOptions::default()).expect("path");
        let text = kinetostat_machining::load_description(
            &model.mechanism,
            &LoadAlongPath::new(milling(), &path),
        );
        assert!(text.contains("215 N") && text.contains(words), "{text}");
    }
}

/// Points are solved many at once; each is what the scalar engine gives.
#[test]
fn points_of_a_run_are_those_of_the_general_engine() {
    let arm = Model::preset("heavy_6r").expect("preset").mechanism;
    let arm_at = arm.platforms()[arm.tool()].home;
    for (mechanism, home, origin) in [
        (orthoglide(), Pose::identity(), vector![0.0, 0.0, 0.1]),
        (
            arm.with_tool(&straight_tool(0.12)),
            arm_at,
            arm_at.translation.vector - vector![0.0, 0.0, 0.12],
        ),
    ] {
        let program = Program::read(GROOVE).expect("program");
        let reading = ReadOptions::default();
        let path = interpret(&program, &reading).expect("path");
        let task = Task {
            mechanism: &mechanism,
            program: &Gcode {
                program: &program,
                path: &path,
                reading: &reading,
            },
            corrected: Directions::POSITION,
            placement: Placement {
                tool_orientation: home.rotation,
                orientation_follows: false,
                ..Placement::at(origin)
            },
            load: milling(),
            tools: &[],
            weight: WeightCorrection::All,
            cut: None,
            writing: WriteOptions::default(),
            run_inputs: RunInputs::default(),
            bounds: Bounds::default(),
            places: 0,
            compliances: false,
        };
        for written in [false, true] {
            let run = match written {
                true => compensate_program(&task, &Unwatched),
                false => analyse(&task, &Unwatched),
            }
            .expect("a run");
            assert!(run.points.len() > 100);
            for point in run.points.iter().step_by(11) {
                let wrench = Wrench::new(point.force_n.into(), Vector3::zeros());
                let wanted = task.placement.tool_pose(&point.position_mm.into());
                let scalar = |commanded: &Pose| {
                    let posture = mechanism.posture(commanded).expect("a posture");
                    let e = posture.deflected_by(&wrench).expect("an equilibrium");
                    let off = e.tool.translation.vector - wanted.translation.vector;
                    (posture.commands(), off * 1e3, e)
                };
                let near = |a: &[f64; 3], b: &Vector3<f64>| (Vector3::from(*a) - b).norm() < 1e-8;
                let (nominal, before, _) = scalar(&wanted);
                assert!(near(&point.error_before_mm, &before), "{point:?} {before}");
                let there = Vector3::from(point.position_mm) + Vector3::from(point.correction_mm);
                let (commands, after, e) = scalar(&task.placement.tool_pose(&there));
                assert!(near(&point.error_after_mm, &after), "{point:?} {after}");
                let moved = commands.iter().zip(&nominal).map(|(a, b)| a - b);
                let reported = point.actuator_correction.iter().zip(moved);
                for (reported, own) in reported {
                    // Metres or radians as mm or degrees.
                    let (mm, deg) = (own * 1e3, own.to_degrees());
                    assert!(
                        (reported - mm).abs().min((reported - deg).abs()) < 1e-8,
                        "{point:?}"
                    );
                }
                for (reported, own) in point.actuator_force.iter().zip(e.actuator_forces()) {
                    assert!(
                        (reported - own).abs() < 1e-6 * own.abs().max(1.0),
                        "{reported} {own}"
                    );
                }
                let relative = |a: f64, b: f64| (a - b).abs() < 1e-7 * b.abs();
                let stiffness = 1e-3 * e.stiffness_against_force();
                assert!(relative(point.smallest_stiffness_n_per_mm, stiffness));
                let (reported, own) = (point.share_to_buckling, e.share_to_buckling());
                let own = own.filter(|mu| mu.is_finite());
                assert_eq!(reported.is_some(), own.is_some());
                assert!(
                    reported.zip(own).is_none_or(|(a, b)| relative(a, b)),
                    "{reported:?} {own:?}"
                );
                assert_eq!(point.stable, e.stable());
            }
        }
    }
}
