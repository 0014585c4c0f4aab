//! Serial-parallel hybrids with everything at once: errors of every limb, preload, rigid limbs,
//! gravity and a load, against one dense flattened system.

use crate::common::{Rng, assert_equilibrium, scaled_error};
use crate::graphs::{arm_on_a_parallel_base, arm_with_parallel_wrist, limb};
use crate::oracle::Flat;
use crate::pantographs_and_lattices::double_pantograph;
use crate::platforms::leg;
use kinetostat::{
    ActuatorSpec, Anchor, BeamSection, Chain, LengthLaw, Limb, Mechanism, MotionKind, Platform,
    PlatformLoad, Pose, Settings, Twist, Wrench,
    spatial::{moved, pose_residual},
};
use kinetostat_testing::largest;
use nalgebra::{Vector3, vector};

/// The chain with its base put elsewhere: an error of assembly.
fn misplaced(chain: &Chain, error: &Pose) -> Chain {
    let mut written = serde_json::to_value(chain).unwrap();
    let rigid = serde_json::to_value(kinetostat::model::Element::Rigid(*error)).unwrap();
    written["elements"].as_array_mut().unwrap().insert(0, rigid);
    serde_json::from_value(written).unwrap()
}

/// Everything of a machine once more, with errors of a size (m, rad) in every limb but those that
/// `keep` their place, more limbs and loads.
fn with(machine: &Mechanism, error: f64, limbs: Vec<Limb>, loads: Vec<PlatformLoad>) -> Mechanism {
    let mut rng = Rng(21);
    let mut builder = Mechanism::builder(machine.name()).gravity(machine.gravity());
    for platform in &machine.platforms()[1..] {
        builder.platform(platform.clone());
    }
    for own in machine.limbs().iter().cloned().chain(limbs) {
        let error_pose = rng.pose(error, error);
        let actual = misplaced(&own.actual, &error_pose);
        builder = builder.limb(own.with_actual(actual));
    }
    for load in loads {
        builder = builder.platform_load(load);
    }
    builder.build().unwrap()
}

/// A spring under preload between two platforms.
fn preload(from: usize, to: usize) -> PlatformLoad {
    let law = LengthLaw::Linear {
        stiffness: 2e4,
        free_length: 0.2,
        preload: 400.0,
    };
    // Far apart: the oracle takes differences of the direction between them.
    let ends = [vector![0.26, -0.12, 0.2], vector![-0.2, 0.15, -0.1]];
    PlatformLoad::strut(
        Anchor::on_platform(from, ends[0]),
        Anchor::on_platform(to, ends[1]),
        law,
    )
}

/// A bar without a spring between points of two platforms, as they are at home.
fn bar(machine: &Mechanism, from: usize, to: usize) -> Limb {
    let span = machine.platforms()[from].home.inverse() * machine.platforms()[to].home;
    let ends = [vector![0.05, 0.04, -0.02], vector![0.02, -0.03, 0.01]];
    leg("bar", from, to, ends, &span, true).unwrap()
}

/// A gantry that carries a tripod: three legs with universal joints on slides, as in a 3-PUU.
fn gantry_with_tripod() -> Mechanism {
    let slide = |axis: Vector3<f64>| ActuatorSpec::new(MotionKind::Prismatic, axis, 5e7);
    let beam = BeamSection::tube(2.1e11, 8.1e10, 0.2, 0.17);
    let gantry = Chain::builder("gantry")
        .actuator("x", slide(Vector3::x()))
        .link("bridge", &beam, 0.4)
        .actuator("y", slide(Vector3::y()))
        .build()
        .unwrap();
    let carriage_home = Pose::translation(0.4, 0.0, 0.0);
    let offset = Pose::translation(0.03, -0.02, -0.04);
    let mut builder = Mechanism::builder("gantry with a tripod").gravity(vector![0.0, 0.0, -9.81]);
    let mut carriage = Platform::new("carriage", carriage_home);
    carriage.mass = 40.0;
    let carriage = builder.platform(carriage);
    let mut tool = Platform::new("tool", carriage_home * offset);
    tool.mass = 3.0;
    let tool = builder.platform(tool);
    builder = builder.limb(limb("gantry", 0, carriage, Pose::identity(), gantry));
    let section = BeamSection::tube(2.1e11, 8.1e10, 0.022, 0.014);
    let third = 2.0 * std::f64::consts::FRAC_PI_3;
    for (name, turns) in [("x", 0.0), ("y", 1.0), ("z", 2.0)] {
        let turned = Pose::rotation(Vector3::repeat(1.0).normalize() * (third * turns));
        let mut drive = ActuatorSpec::new(MotionKind::Prismatic, Vector3::x(), 2.8e6);
        drive.home = -0.34;
        let chain = Chain::builder(name)
            .rigid(turned)
            .actuator("drive", drive)
            .passive_universal("foot joint", Vector3::z(), Vector3::y())
            .link("bar", &section, 0.31)
            .passive_universal("head joint", Vector3::y(), Vector3::z())
            .translation(vector![0.03, 0.0, 0.0])
            .rigid(turned.inverse())
            .build()
            .unwrap();
        builder = builder.limb(limb(name, carriage, tool, Pose::identity(), chain));
    }
    builder.build().unwrap()
}

/// Hybrids by name: as drawn; with errors and preload; with a rigid bar besides, which makes them
/// over-constrained.
pub fn variants() -> Vec<(String, Mechanism)> {
    let mut list = Vec::new();
    for machine in [
        arm_with_parallel_wrist(9.81),
        arm_on_a_parallel_base(9.81),
        gantry_with_tripod(),
    ] {
        let name = machine.name().to_owned();
        let tool = machine.tool();
        // Where limbs in parallel are: between which platforms a bar strains them.
        let between = match machine.limbs()[0].from {
            0 if machine.limbs().iter().filter(|l| l.from == 0).count() > 1 => (0, 1),
            _ => (1, tool),
        };
        let rigid = vec![bar(&machine, between.0, between.1)];
        let preloaded = || vec![preload(between.0, between.1)];
        let errors = with(&machine, 1e-3, Vec::new(), preloaded());
        let all = with(&machine, 1e-3, rigid, preloaded());
        list.push((name.clone(), machine));
        list.push((format!("{name}, with errors and preload"), errors));
        list.push((format!("{name}, with errors, preload and a rigid bar"), all));
    }
    list
}

/// Displacement and wrenches of limbs (shares of the largest) and stiffness under load, against the
/// flattened system.
pub fn hybrids_apart(machine: &Mechanism) -> [f64; 3] {
    let mut rng = Rng(14);
    let home = machine.platforms()[machine.tool()].home;
    // Tighter than usual, and ten times tighter than what is compared.
    let tight = Settings::default().with_closure(1e-14).with_torque(1e-13);
    let posture = machine.posture(&home).unwrap().with_settings(tight);
    let wrench = rng.wrench(300.0, 30.0);
    let e = posture.deflected_by(&wrench).unwrap();
    assert_equilibrium(&posture, &e);
    let mut flat = Flat::at_rest(&posture);
    flat.load = wrench.0;
    flat.solve(false);
    let tool = pose_residual(&e.tool, &flat.platforms[machine.tool()]).0;
    let most = largest(flat.wrenches.iter().map(|w| w.norm()));
    let both = e.limbs.iter().zip(&flat.wrenches);
    let wrenches = both.map(|(limb, w)| (limb.wrench.0 - w).norm() / most);
    [
        tool.norm() / e.displacement.0.norm(),
        largest(wrenches),
        scaled_error(&e.stiffness.matrix, &flat.stiffness()),
    ]
}

#[test]
fn over_constrained_hybrids_with_errors_strain_themselves() {
    for (name, machine) in variants() {
        if !name.contains("rigid bar") {
            continue;
        }
        let home = machine.platforms()[machine.tool()].home;
        let posture = machine.posture(&home).unwrap();
        assert!(posture.overconstraint().degree > 0, "{name}");
        // The bar is a constraint in the answer: it carries and does not stretch.
        let e = posture.deflected_by(&Wrench::zero()).unwrap();
        let bar = e.limbs.last().unwrap();
        assert_eq!(bar.name, "bar");
        assert!(bar.wrench.force().norm() > 1.0, "{name}");
        assert_eq!(bar.energy, 0.0);
    }
}

/// Loops in loops: the double pantograph with errors in every limb, loaded out of its plane too.
#[test]
fn nested_loops_with_errors_and_load() {
    let machine = double_pantograph();
    let crooked = with(&machine, 2e-4, Vec::new(), Vec::new());
    let home = machine.platforms()[machine.tool()].home;
    let target = moved(
        &home,
        &Twist::new(vector![0.03, 0.0, 0.02], Vector3::zeros()),
    );
    let posture = crooked.posture(&target).unwrap();
    // The tool turns freely on its pin, which the errors tilt: a moment would have no answer.
    let wrench = Wrench::new(vector![40.0, 15.0, -60.0], Vector3::zeros());
    let e = posture.deflected_by(&wrench).unwrap();
    assert_equilibrium(&posture, &e);
    let linear = posture.linear_assembly(&posture.assembly_errors()).unwrap();
    let shift = posture.deflected_by(&Wrench::zero()).unwrap().displacement;
    let apart = (linear.shift.linear() - shift.linear()).norm();
    assert!(apart < 0.05 * shift.linear().norm(), "{apart:e} {shift:?}");
}
