//! The steady correction is that of the off-line compensation: one path of the core, none of whose code the plan runs.

use kinetostat::compensation::compensate_from;
use kinetostat::linalg::SingularValues;
use kinetostat::machine::LimbPosture;
use kinetostat::model::{
    BilinearLaw, Kinematics, LinkConvention, LinkMass, SpringLaw, unloaded_tip,
};
use kinetostat::nalgebra::{Vector3, vector};
use kinetostat::spatial::moved;
use kinetostat::*;
use kinetostat_online::{Command, Input, Mode, Plan, Reason};
use kinetostat_testing::Worst;

use crate::common::{Random, feed_forward, joints, next, preset, wide};

/// Random states of each serial machine and set of directions; with both sets ten thousand.
const STATES: usize = 5000;
/// Smallest singular value of the joints' Jacobian, as a share of the natural length, below which a posture counts as nearly singular.
const NEAR: f64 = 0.01;
/// Presets of one limb.
const SERIAL: [&str; 6] = [
    "heavy_6r",
    "kuka_kr270_like",
    "abb_irb6640_like",
    "fanuc_r2000ic_like",
    "scara",
    "compensated_arm",
];
/// Presets of several limbs on one platform.
const PARALLEL: [&str; 7] = [
    "orthoglide",
    "puu3",
    "stewart_gough_b",
    "hexapod",
    "hexapod_with_screws",
    "cubic_hexapod",
    "hexaglide",
];

/// A posture with random joints near home, within limits; joints of machines with loops come from a random pose.
fn posture(mechanism: &Mechanism, random: &mut Random) -> Option<Posture> {
    let tool = &mechanism.platforms()[mechanism.tool()];
    if mechanism.limbs().len() > 1 {
        let size = 0.05 * mechanism.natural_length();
        let target = Pose::new(
            tool.home.translation.vector + random.vector(size),
            kinetostat::nalgebra::Vector3::zeros(),
        );
        let target = Pose::from_parts(target.translation, tool.home.rotation);
        return mechanism.posture(&target).ok();
    }
    let limb = &mechanism.limbs()[0];
    let commands: Vec<f64> = limb
        .nominal
        .actuators()
        .iter()
        .map(|a| {
            let (low, high) = a.limits.unwrap_or((-1.0, 1.0));
            let x: f64 = a.home + random.within(0.4 * (high - low).min(2.0));
            x.clamp(low, high)
        })
        .collect();
    let coordinates = limb.nominal.home_coordinates();
    let base = mechanism.platforms()[0].home;
    let tip = unloaded_tip(&limb.nominal, &base, &coordinates, &commands);
    let target = tip * limb.platform_from_tip.inverse();
    let limbs = vec![LimbPosture {
        commands,
        coordinates,
    }];
    mechanism
        .posture(PostureRequest::joints(&target, limbs))
        .ok()
}

/// Smallest singular value of the joints' Jacobian of an arm, rotations at the natural length and as a share of it.
fn singular_value(posture: &Posture) -> f64 {
    let mechanism = posture.mechanism();
    let (limb, joints) = (&mechanism.limbs()[0], &posture.limbs()[0]);
    let base = &mechanism.platforms()[0].home;
    let at = Kinematics::new(&limb.nominal, base, &joints.coordinates, &joints.commands);
    let columns = limb.nominal.coordinate_count()..;
    let own = at.jacobian(limb.nominal.tip());
    let mut own = own.columns_range(columns).into_owned();
    let length = mechanism.natural_length();
    own.rows_mut(0, 3).scale_mut(1.0 / length);
    SingularValues::of(&own).least()
}

/// Largest difference of the position (m) and of the rotation (rad), and the largest number of passes.
fn compare(
    mechanism: &Mechanism,
    directions: Directions,
    states: usize,
    force: f64,
) -> (Worst, u32) {
    let mut settings = feed_forward();
    settings.limits = wide();
    settings.directions = directions;
    let plan = Plan::compile(mechanism, &settings).unwrap();
    let mut state = plan.start().unwrap();
    let mut random = Random(7);
    let mut input = Input::default();
    let (mut worst, mut passes, mut refused) = (Worst::new(), 0, 0);
    for index in 0..states {
        let Some(posture) = posture(mechanism, &mut random) else {
            continue;
        };
        let wrench = random.wrench(force, 0.1 * force);
        let desired = *posture.target();
        let start = posture.rest_state();
        let Ok(exact) = compensate_from(&posture, &desired, &wrench, plan.directions(), start)
        else {
            continue;
        };
        input.joints = joints(&posture.commands());
        input.programmed = wrench;
        // The pose jumps from state to state, which no program does: some cycles to get there.
        for _ in 0..40 {
            let output = next(&plan, &mut state, &mut input);
            if output.passes > passes {
                passes = output.passes;
            }
            if output.finding == Reason::None {
                break;
            }
        }
        let output = next(&plan, &mut state, &mut input);
        if output.finding != Reason::None {
            // Near a singular posture the passes do not contract; a plan says so instead.
            let said = matches!(output.finding, Reason::Singular | Reason::NotConverged);
            let near = singular_value(&posture);
            assert!(
                said && near < NEAR,
                "{} {:?}: {near}",
                mechanism.name(),
                output.finding
            );
            refused += 1;
            continue;
        }
        let place = || {
            format!(
                "{} state {index}: {:?} {}",
                mechanism.name(),
                output.finding,
                output.passes
            )
        };
        let off = output.wanted - exact.correction;
        worst.add_at(off.linear().norm(), place);
        worst.add_at(off.angular().norm(), place);
        worst.add_at((output.left_over - exact.left_over).linear().norm(), place);
    }
    assert!(
        refused * 200 <= states,
        "{}: {refused} of {states} refused",
        mechanism.name()
    );
    (worst, passes)
}

fn holds(names: &[&str], states: usize, force: f64) {
    for name in names {
        let mechanism = preset(name);
        for directions in [Directions::POSITION, Directions::ALL] {
            let (worst, passes) = compare(&mechanism, directions, states, force);
            assert!(worst.samples() > 29 * states / 10, "{name}: too few states");
            assert!(passes <= 8);
            assert!(worst.holds(1e-9), "{worst:?}");
        }
    }
}

#[test]
fn serial_machines_are_corrected_as_off_line() {
    holds(&SERIAL, STATES, 800.0);
}

/// Slides that carry a bilinear gear, links of all conventions with masses, a preloaded spring and a platform with a weight and a spring of its own.
fn mixture() -> Mechanism {
    let bar = BeamSection::tube(2.1e11, 8.1e10, 0.05, 0.04); // Pa, m
    let slide = |axis| ActuatorSpec::new(MotionKind::Prismatic, axis, 5e6);
    let gear = SpringLaw::Bilinear(BilinearLaw {
        stiffness: 5e4,
        beyond: 2e5,
        knee: 2e-3,
    });
    let link = |convention| {
        let spec = LinkSpec::beam(bar, 0.4).segments(2).convention(convention);
        spec.with_mass(LinkMass::of_section(&bar, 7850.0))
    };
    let chain = Chain::builder("mixture")
        .actuator("x", slide(Vector3::x()))
        .actuator("y", slide(Vector3::y()))
        .actuator("z", slide(Vector3::z()))
        .spring_with_law("gear", MotionKind::Revolute, Vector3::z(), gear, 0.0)
        .link_with("one", &link(LinkConvention::Exponential))
        .spring("preloaded", MotionKind::Revolute, Vector3::y(), 1e5, 1e-3)
        .link_with("two", &link(LinkConvention::ConstantStrain))
        .body(
            "head",
            12.0,
            vector![0.05, 0.02, 0.0],
            nalgebra::Matrix3::zeros(),
        )
        .build()
        .unwrap();
    let mut machine = Mechanism::builder("mixture").gravity(vector![0.0, 0.0, -9.81]);
    let head = Platform {
        mass: 20.0,
        centre_of_mass: vector![0.1, 0.0, -0.05],
        ..Platform::new("tool", Pose::translation(0.8, 0.0, 0.0))
    };
    let tool = machine.platform(head);
    let law = LengthLaw::Linear {
        stiffness: 800.0,
        free_length: 0.5,
        preload: 0.0,
    };
    let balancer = PlatformLoad::strut(
        Anchor::Base(vector![0.8, 0.1, 1.0]),
        Anchor::on_platform(tool, Vector3::zeros()),
        law,
    );
    let machine = machine
        .limb(Limb::between("mixture", 0, tool, chain))
        .platform_load(balancer);
    machine.build().unwrap()
}

#[test]
fn every_law_of_springs_and_loads_is_the_core_s() {
    for directions in [Directions::POSITION, Directions::NONE.with(0).with(2)] {
        let (worst, _) = compare(&mixture(), directions, 300, 400.0);
        assert!(worst.samples() > 600 && worst.holds(1e-9), "{worst:?}");
    }
}

#[test]
fn the_joints_lead_to_the_pose_that_is_sent() {
    for name in ["heavy_6r", "scara", "puu3", "hexapod"] {
        let mechanism = preset(name);
        let mut settings = feed_forward();
        settings.directions = Directions::ALL;
        let plan = Plan::compile(&mechanism, &settings).unwrap();
        let home = mechanism
            .posture(&mechanism.platforms()[mechanism.tool()].home)
            .unwrap();
        let (mut state, mut input) = (plan.start().unwrap(), Input::default());
        input.joints = joints(&home.commands());
        input.programmed = Wrench::new(vector![60.0, -40.0, 20.0], Vector3::zeros());
        let mut output = next(&plan, &mut state, &mut input);
        for cycle in 0..1000 {
            input.command = if cycle == 20 {
                Command::Arm
            } else {
                Command::None
            };
            output = next(&plan, &mut state, &mut input);
        }
        assert_eq!(
            (output.mode, output.finding),
            (Mode::Active, Reason::None),
            "{name}"
        );
        assert!(output.correction.linear().norm() > 1e-6 && !output.clamped.joints);
        let target = moved(home.target(), &output.correction);
        let exact = mechanism
            .posture(PostureRequest::pose(&target).near(&home))
            .unwrap();
        let mut worst = Worst::new();
        for (k, command) in exact.commands().into_iter().enumerate() {
            worst.add_at(input.joints[k] + output.joints[k] - command, || {
                format!("{name}, joint {k}")
            });
        }
        assert!(worst.holds(1e-9), "{worst:?}");
    }
}

#[test]
fn parallel_machines_are_corrected_as_off_line() {
    holds(&PARALLEL, 50, 200.0);
}
