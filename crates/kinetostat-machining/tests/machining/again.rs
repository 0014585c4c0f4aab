//! A correction that changes where the division does not look: the check finds it, and the block is divided
//! again until the claim is true.

use kinetostat::{
    ActuatorSpec, Chain, Directions, Limb, Load, Mechanism, MotionKind, Platform, Pose, Wrench,
    model::FunctionLoad,
};
use kinetostat_machining::{
    Bounds, CuttingLoad, Placement, ProgramLoad, Run, RunInputs, Task, Unwatched, WarningCode,
    WeightCorrection, compensate_program,
};
use kinetostat_program::{Gcode, Program, ReadOptions, WriteOptions, interpret};
use kinetostat_testing::Worst;
use nalgebra::{Vector3, vector};

/// N/m of every slide.
const STIFFNESS: f64 = 1e6;

/// N, at the top of the bump.
const PUSH: f64 = 20.0;

/// What pushes sideways: a bump of the given half width about a place of X, m.
fn push(x: f64, [at, half]: [f64; 2]) -> f64 {
    let u = (x - at) / half;
    PUSH * (1.0 - u * u).max(0.0).powi(3)
}

/// Three slides with a force along Y that depends on X.
fn gantry(bump: [f64; 2]) -> Mechanism {
    let slide = |axis| ActuatorSpec::new(MotionKind::Prismatic, axis, STIFFNESS);
    let chain = Chain::builder("gantry")
        .translation(vector![0.0, 0.0, 0.5])
        .actuator("x", slide(Vector3::x()))
        .actuator("y", slide(Vector3::y()))
        .actuator("z", slide(Vector3::z()))
        .translation(vector![0.0, 0.0, -0.3])
        .build()
        .expect("chain");
    let home = Pose::translation(0.0, 0.0, 0.2);
    let tip = chain.node("tip").expect("tip");
    let side = FunctionLoad::new("side", vec![tip], move |poses| {
        let force = push(poses[0].translation.x, bump);
        vec![Wrench::new(vector![0.0, force, 0.0], Vector3::zeros())]
    });
    let side = side.with_steps(0.01 * bump[1], 1e-4);
    let mut builder = Mechanism::builder("gantry");
    let tool = builder.platform(Platform::new("tool", home));
    let limb = Limb::between("gantry", 0, tool, chain);
    let builder = builder.limb(limb).load("gantry", Load::function(side));
    builder.build().expect("machine")
}

const LINE: &str = "G21 G90\nG0 X0 Y0 Z0\nG1 X100 Y0 Z0 F600\nM2\n";

fn run(bump: [f64; 2]) -> Run {
    let machine = gantry(bump);
    let program = Program::read(LINE).expect("program");
    let reading = ReadOptions::default();
    let path = interpret(&program, &reading).expect("path");
    let task = Task {
        mechanism: &machine,
        program: &Gcode {
            program: &program,
            path: &path,
            reading: &reading,
        },
        corrected: Directions::POSITION,
        placement: Placement::at(vector![0.0, 0.0, 0.2]),
        load: ProgramLoad::new(CuttingLoad::None),
        tools: &[],
        weight: WeightCorrection::All,
        cut: None,
        writing: WriteOptions::default(),
        run_inputs: RunInputs::default(),
        bounds: Bounds::default(),
        places: 0,
        compliances: false,
    };
    compensate_program(&task, &Unwatched).expect("run")
}

/// Largest distance of the written program from where the bump wants it, mm, in many even places.
fn worst(run: &Run, bump: [f64; 2]) -> f64 {
    let written = run.written.as_ref().expect("written");
    let mut worst = Worst::new();
    for piece in written
        .pieces
        .iter()
        .filter(|p| p.commanded_to.y.abs() < 1.0)
    {
        for k in 0..=50 {
            let part = f64::from(k) / 50.0;
            let at = piece.commanded_from.lerp(&piece.commanded_to, part);
            // The machine gives way along Y only, by the force over the stiffness.
            let off = at.y + 1e3 * push(1e-3 * at.x, bump) / STIFFNESS;
            assert!(off.is_finite());
            worst.add(off.abs());
        }
    }
    worst.value()
}

#[test]
fn what_only_the_check_finds_is_divided_again() {
    // Nothing is there within the line: where the check looks is seen.
    let plain = run([-9.0, 0.004]);
    assert!(
        plain
            .result
            .warnings
            .iter()
            .all(|w| w.code != WarningCode::DividedAgain)
    );
    let looked: Vec<f64> = plain.points.iter().map(|p| p.position_mm[0]).collect();
    let places = looked.iter().filter(|x| **x > 5.0 && **x < 95.0);
    // Not where the division looks.
    let hidden = places.filter(|x| ((*x / 25.0).round() * 25.0 - *x).abs() > 5.0);
    let mut again = 0;
    // Every third of them: each is a run of its own.
    for place in hidden.step_by(3) {
        let bump = [1e-3 * (place + 0.3), 0.0015];
        let run = run(bump);
        let reported = run.result.warnings.iter();
        again += usize::from(
            reported
                .clone()
                .any(|w| w.code == WarningCode::DividedAgain),
        );
        let off = worst(&run, bump);
        let allowed = run.result.allowed_mm();
        assert!(off <= 1.1 * allowed, "{place}: {off} of {allowed}");
        assert_eq!(run.result.holds_tolerance(), Some(true), "{place}");
    }
    assert!(again > 0, "no place that only the check finds: {looked:?}");
}
