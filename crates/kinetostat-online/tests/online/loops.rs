//! The loop in time: low pass against its closed form, sensor, gain rule, and the plant of `loop_sim.py` below and above the critical gain.

use kinetostat::nalgebra::{Vector3, vector};
use kinetostat::*;
use kinetostat_online::{
    Command, Error, Input, Limits, Mode, Plan, PlanSettings, Reason, SampledLoop, Sensor, State,
    Warning,
};
use kinetostat_testing::Worst;

use crate::common::{Random, feed_forward, joints, next, preset, wide};

/// Stiffness of the robot of `loop_sim.py`, N/m.
const ROBOT: f64 = 5e5;

/// Three slides of this stiffness.
pub fn gantry(stiffness: f64) -> Mechanism {
    let slide = |axis| ActuatorSpec::new(MotionKind::Prismatic, axis, stiffness);
    let chain = Chain::builder("gantry")
        .actuator("x", slide(Vector3::x()))
        .actuator("y", slide(Vector3::y()))
        .actuator("z", slide(Vector3::z()))
        .build()
        .unwrap();
    Mechanism::serial(chain, Pose::identity(), Vector3::zeros()).unwrap()
}

pub fn sensor(cutoff_hz: f64, first_frequency_hz: f64, process: Option<f64>) -> Sensor {
    Sensor {
        tool_from_sensor: Pose::identity(),
        mass: 0.0,
        centre_of_mass: Vector3::zeros(),
        gravity: Vector3::zeros(),
        zeroing_cycles: 5,
        cutoff_hz,
        first_frequency_hz,
        process_stiffness: process.map(Vector3::repeat),
    }
}

/// Limits that leave the loop linear.
fn linear() -> Limits {
    Limits {
        speed: 1e6,
        acceleration: 1e9,
        ..wide()
    }
}

/// Zeroes, arms and waits until the correction is active, in air.
pub fn activate(plan: &Plan, state: &mut State, input: &mut Input) {
    input.measured = Some(Wrench::zero());
    input.command = Command::ZeroSensor;
    for _ in 0..10 {
        next(plan, state, input);
    }
    input.command = Command::Arm;
    for _ in 0..3 {
        next(plan, state, input);
    }
    assert_eq!(state.mode(), Mode::Active);
}

#[test]
fn the_low_pass_of_1_hz_answers_a_step_as_its_closed_form() {
    let mut settings = feed_forward();
    settings.sensor = Some(sensor(1.0, 12.0, Some(1e3)));
    let plan = Plan::compile(&gantry(ROBOT), &settings).unwrap();
    let (mut state, mut input) = (plan.start().unwrap(), Input::default());
    activate(&plan, &mut state, &mut input);
    input.measured = Some(Wrench::new(vector![200.0, 0.0, 0.0], Vector3::zeros()));
    // Butterworth, second order: poles at w (-1 +- i) / sqrt(2).
    let w = std::f64::consts::TAU / 2.0_f64.sqrt();
    let mut worst = Worst::new();
    for k in 0..3000 {
        let output = next(&plan, &mut state, &mut input);
        // The bilinear transform takes a step half a period before its first sample.
        let t = 1e-3 * (f64::from(k) + 0.5);
        let expected = 1.0 - (-w * t).exp() * ((w * t).cos() + (w * t).sin());
        worst.apart(-output.wanted.linear().x * ROBOT / 200.0, expected);
    }
    println!("low pass: {:?}", worst.measured());
    assert!(worst.holds(2e-5), "{worst:?}");
}

#[test]
fn a_filter_above_a_quarter_of_the_first_frequency_is_refused_with_both() {
    let mut settings = feed_forward();
    settings.sensor = Some(sensor(3.5, 12.0, Some(1e3)));
    let error = Plan::compile(&gantry(ROBOT), &settings).unwrap_err();
    let text = error.to_string();
    assert!(matches!(error, Error::FilterTooFast { .. }));
    assert!(
        ["3.5 Hz", "12 Hz", "3 Hz"].iter().all(|x| text.contains(x)),
        "{text}"
    );
    settings.sensor = Some(sensor(3.0, 12.0, Some(1e3)));
    assert!(Plan::compile(&gantry(ROBOT), &settings).is_ok());
}

#[test]
fn weight_and_offset_are_removed_in_every_posture() {
    let robot = preset("heavy_6r");
    let mut settings = feed_forward();
    settings.limits = wide();
    let forward = Plan::compile(&robot, &settings).unwrap();
    let mount = Pose::new(vector![0.05, -0.02, -0.2], vector![0.3, -0.5, 0.2]); // m, rad
    settings.sensor = Some(Sensor {
        tool_from_sensor: mount,
        mass: 23.0,
        centre_of_mass: vector![0.01, 0.02, 0.08],
        gravity: vector![0.0, 0.0, -9.81],
        ..sensor(10.0, 41.0, Some(1e3))
    });
    let plan = Plan::compile(&robot, &settings).unwrap();
    let (mut state, mut random) = (plan.start().unwrap(), Random(3));
    let offset = random.wrench(40.0, 3.0);
    let limb = &robot.limbs()[0];
    let home = limb.nominal.home_commands();
    let rest = limb.nominal.home_coordinates();
    let base = robot.platforms()[0].home;
    let mut worst = Worst::new();
    let mut input = Input::default();
    for posture in 0..8 {
        let commands: Vec<f64> = home.iter().map(|x| x + random.within(0.3)).collect();
        let tip = model::unloaded_tip(&limb.nominal, &base, &rest, &commands);
        let tool = tip * limb.platform_from_tip.inverse();
        let process = if posture == 0 {
            Wrench::zero()
        } else {
            random.wrench(300.0, 20.0)
        };
        // What a sensor feels, from first principles: forces and moments of process and weight about its origin.
        let frame = tool * mount;
        let (origin, turn) = (frame.translation.vector, frame.rotation.inverse());
        let to_tool = tool.translation.vector - origin;
        let weight = vector![0.0, 0.0, -9.81] * 23.0;
        let centre = frame.rotation * vector![0.01, 0.02, 0.08];
        let force = turn * (process.force() + weight);
        let moment =
            turn * (process.moment() + to_tool.cross(&process.force()) + centre.cross(&weight));
        input.joints = joints(&commands);
        input.measured = Some(Wrench::new(force, moment) + offset);
        input.command = if posture == 0 {
            Command::ZeroSensor
        } else {
            Command::None
        };
        let mut output = next(&plan, &mut state, &mut input);
        for _ in 0..600 {
            output = next(&plan, &mut state, &mut input);
        }
        let mut expected = Input {
            joints: input.joints,
            programmed: process,
            ..Input::default()
        };
        let mut other = forward.start().unwrap();
        let mut exact = next(&forward, &mut other, &mut expected);
        for _ in 0..20 {
            exact = next(&forward, &mut other, &mut expected);
        }
        worst.add((output.wanted - exact.wanted).linear().norm());
        assert_eq!(output.finding, Reason::None);
    }
    assert!(worst.holds(1e-9), "{worst:?}");
}

/// The plant of `loop_sim.py`, along x: servo, structure, contact.
struct Plant {
    kappa: f64,
    servo: f64,
    at: f64,
    speed: f64,
    chain: [f64; 12],
}

impl Plant {
    fn new(kappa: f64) -> Self {
        Self {
            kappa,
            servo: 0.0,
            at: 0.0,
            speed: 0.0,
            chain: [0.0; 12],
        }
    }

    /// Force on the tool (N) under an external one.
    fn force(&self, external: f64) -> f64 {
        external - self.kappa * ROBOT * self.at
    }

    /// One millisecond under a correction (m) that arrives after twelve cycles: 12 Hz, damping 0.04, lag 20 ms.
    fn go(&mut self, correction: f64, external: f64) {
        let (w, lag, h) = (std::f64::consts::TAU * 12.0, 0.02, 1e-5);
        let (m, d) = (ROBOT / (w * w), 2.0 * 0.04 * ROBOT / w);
        let command = self.chain[0];
        self.chain.rotate_left(1);
        self.chain[11] = correction;
        for _ in 0..100 {
            let rate = (command - self.servo) / lag;
            let pull =
                ROBOT * (self.servo - self.at) + d * (rate - self.speed) + self.force(external);
            self.speed += h * pull / m;
            self.at += h * self.speed;
            self.servo += h * rate;
        }
    }
}

/// Largest deviations from the mean in the third and in the last quarter of 16 s after a push of 20 N, and the last force.
fn ring(beta: f64, kappa: f64, cutoff: f64, stated: f64) -> (f64, f64, f64) {
    let mut settings = feed_forward();
    settings.limits = linear();
    // A frequency that lets the filter pass: the test shows what the rule prevents.
    settings.sensor = Some(sensor(cutoff, 1e3, Some(stated)));
    // A model that is too soft corrects too much: gain beta.
    let plan = Plan::compile(&gantry(ROBOT / beta), &settings).unwrap();
    let (mut state, mut input) = (plan.start().unwrap(), Input::default());
    activate(&plan, &mut state, &mut input);
    let mut plant = Plant::new(kappa);
    let mut places = Vec::new();
    for k in 0..16_000 {
        let external = if k < 8000 { 20.0 } else { 20.0 + 1e-3 };
        input.measured = Some(Wrench::new(
            vector![plant.force(external), 0.0, 0.0],
            Vector3::zeros(),
        ));
        let output = next(&plan, &mut state, &mut input);
        assert!(output.passes <= 8);
        plant.go(output.correction.linear().x, external);
        places.push(plant.at);
        if plant.at.abs() > 1.0 {
            return (0.0, f64::INFINITY, plant.force(external));
        }
    }
    let swing = |part: &[f64]| {
        let (low, high) = part.iter().fold((f64::MAX, f64::MIN), |(a, b), x| {
            (
                kinetostat::number::smaller(a, *x),
                kinetostat::number::larger(b, *x),
            )
        });
        high - low
    };
    (
        swing(&places[4000..6000]),
        swing(&places[14_000..]),
        plant.force(20.0),
    )
}

#[test]
fn the_loop_decays_below_the_critical_gain_and_grows_above() {
    for (kappa, cutoff, below, above) in [(1.0, 10.0, 0.78, 0.86), (0.5, 10.0, 1.08, 1.22)] {
        let sampled = SampledLoop {
            kappa,
            mode_hz: 12.0,
            damping: 0.04,
            lag: 0.02,
            delay_cycles: 12,
            cutoff_hz: cutoff,
            order: 2,
            notch: false,
            period: 1e-3,
        };
        let critical = sampled.critical_gain();
        assert!(below < critical && critical < above, "{critical}");
        let (early, late, _) = ring(below, kappa, cutoff, 1e3);
        assert!(
            late < 0.5 * early,
            "kappa {kappa}, gain {below}: {early} to {late} m"
        );
        let (early, late, _) = ring(above, kappa, cutoff, 1e3);
        assert!(
            late > 2.0 * early,
            "kappa {kappa}, gain {above}: {early} to {late} m"
        );
    }
}

#[test]
fn the_gain_rule_keeps_a_stiff_process_at_a_loop_gain_of_0_7() {
    // Exactly known, the machine without the rule would answer 20 N with 20 (1 + kappa) of force variation by kappa = 10.
    let kappa = 10.0;
    let mut settings = feed_forward();
    settings.limits = linear();
    settings.sensor = Some(sensor(1.0, 12.0, Some(kappa * ROBOT)));
    let plan = Plan::compile(&gantry(ROBOT), &settings).unwrap();
    let named = plan.warnings().iter().any(|w| matches!(w, Warning::Scaled { loop_gain } if (loop_gain - kappa / (1.0 + kappa)).abs() < 1e-9));
    assert!(named, "{:?}", plan.warnings());
    let (mut state, mut input) = (plan.start().unwrap(), Input::default());
    activate(&plan, &mut state, &mut input);
    let mut plant = Plant::new(kappa);
    let mut last = None;
    for _ in 0..30_000 {
        input.measured = Some(Wrench::new(
            vector![plant.force(20.0), 0.0, 0.0],
            Vector3::zeros(),
        ));
        let output = next(&plan, &mut state, &mut input);
        plant.go(output.correction.linear().x, 20.0);
        last = Some(output);
    }
    let output = last.unwrap();
    assert!(output.clamped.gain && (output.loop_gain - kappa / (1.0 + kappa)).abs() < 1e-9);
    // Static theory with the share that the rule leaves: f = F / (1 + kappa (1 - share)).
    let share = 0.7 * (1.0 + kappa) / kappa;
    let expected = 20.0 / (1.0 + kappa * (1.0 - share));
    assert!(
        (plant.force(20.0) / expected - 1.0).abs() < 1e-6,
        "{}",
        plant.force(20.0)
    );
}

#[test]
fn programmed_forces_are_compensated_at_once_and_in_full() {
    // A process so stiff that feedback is scaled, and a force that the program knows: nothing is left to the filter.
    let mut settings = feed_forward();
    settings.limits = linear();
    settings.sensor = Some(sensor(1.0, 12.0, Some(100.0 * ROBOT)));
    let plan = Plan::compile(&gantry(ROBOT), &settings).unwrap();
    let (mut state, mut input) = (plan.start().unwrap(), Input::default());
    activate(&plan, &mut state, &mut input);
    let cut = Wrench::new(vector![150.0, -80.0, 30.0], Vector3::zeros());
    (input.programmed, input.measured) = (cut, Some(cut));
    let output = next(&plan, &mut state, &mut input);
    let off = output.correction.linear() + cut.force() / ROBOT;
    assert!(off.norm() < 1e-12, "{off}");
}

#[test]
fn a_fast_filter_is_warned_of_by_its_predicted_critical_gain() {
    let mut settings: PlanSettings = feed_forward();
    settings.sensor = Some(sensor(3.0, 12.0, Some(10.0 * ROBOT)));
    let drive = |lag, delay_cycles| kinetostat_online::Drive {
        lag,
        delay_cycles,
        damping: 0.04,
    };
    settings.drive = Some(drive(0.02, 12));
    let plan = Plan::compile(&gantry(ROBOT), &settings).unwrap();
    let slow = |w: &Warning| matches!(w, Warning::CriticalGain { .. });
    assert!(!plan.warnings().iter().any(slow), "{:?}", plan.warnings());
    // Hardly damped, the same loop is on its limit.
    settings.drive = Some(kinetostat_online::Drive {
        damping: 0.002,
        ..drive(0.005, 4)
    });
    let plan = Plan::compile(&gantry(ROBOT), &settings).unwrap();
    assert!(plan.warnings().iter().any(slow), "{:?}", plan.warnings());
}

#[test]
fn the_loop_gain_of_an_arm_is_0_7_at_most_in_every_direction() {
    let robot = preset("heavy_6r").without_own_loads();
    let mut random = Random(11);
    let mut scaled = 0;
    for directions in [Directions::POSITION, Directions::NONE.with(0).with(2)] {
        for _ in 0..20 {
            let process = Vector3::from_fn(|_, _| 10.0_f64.powf(5.0 + 3.0 * random.unit()));
            let mut settings = feed_forward();
            settings.limits = wide();
            settings.directions = directions;
            settings.sensor = Some(Sensor {
                process_stiffness: Some(process),
                ..sensor(10.0, 41.0, None)
            });
            let home = robot.limbs()[0].nominal.home_commands();
            let moved: Vec<f64> = home.iter().map(|x| x + random.within(0.3)).collect();
            // Corrections by the measured force and by the programmed one: columns of -C G and of -C.
            let plan = Plan::compile(&robot, &settings).unwrap();
            let mut output = None;
            let mut columns = |measured: bool| {
                nalgebra::Matrix3::from_columns(&[0, 1, 2].map(|k| {
                    let mut state = plan.start().unwrap();
                    let mut push = Wrench::zero();
                    push.0[k] = 1.0;
                    // Read in the axes of the tool, which is the sensor's frame.
                    let turn = pose_of(&robot, &moved).rotation.to_rotation_matrix();
                    let mut input = Input {
                        joints: joints(&moved),
                        ..Input::default()
                    };
                    input.measured = Some(push.rotated(&turn.inverse()));
                    if !measured {
                        input.programmed = push;
                    }
                    for _ in 0..400 {
                        output = Some(next(&plan, &mut state, &mut input));
                    }
                    -output.unwrap().wanted.linear()
                }))
            };
            let (scaled_compliance, mut compliance) = (columns(true), columns(false));
            let output = output.unwrap();
            // Rows that are not corrected are the machine's, too: they are missing in the correction alone.
            if directions.len() == 2 {
                settings.directions = Directions::POSITION;
                let whole = Plan::compile(&robot, &settings).unwrap();
                for k in 0..3 {
                    let mut state = whole.start().unwrap();
                    let mut push = Wrench::zero();
                    push.0[k] = 1.0;
                    let turn = pose_of(&robot, &moved).rotation.to_rotation_matrix();
                    let mut input = Input {
                        joints: joints(&moved),
                        programmed: push,
                        ..Input::default()
                    };
                    input.measured = Some(push.rotated(&turn.inverse()));
                    let mut last = next(&whole, &mut state, &mut input);
                    for _ in 0..20 {
                        last = next(&whole, &mut state, &mut input);
                    }
                    compliance.set_column(k, &-last.wanted.linear());
                }
            }
            let contact = nalgebra::Matrix3::from_diagonal(&process);
            let closed = (nalgebra::Matrix3::identity() + compliance * contact)
                .try_inverse()
                .unwrap();
            let gain = scaled_compliance * contact * closed;
            let mut vector = vector![0.5, 0.7, -0.3];
            let mut radius = 0.0;
            for _ in 0..3000 {
                let after = gain * vector;
                radius = after.norm();
                vector = after / radius;
            }
            assert!(radius <= 0.7 * (1.0 + 1e-3), "{radius}, {output:?}");
            scaled += usize::from(output.clamped.gain);
        }
    }
    assert!(scaled > 5, "only {scaled} cases were scaled");
}

fn pose_of(robot: &Mechanism, commands: &[f64]) -> Pose {
    let limb = &robot.limbs()[0];
    let rest = limb.nominal.home_coordinates();
    let tip = model::unloaded_tip(&limb.nominal, &robot.platforms()[0].home, &rest, commands);
    tip * limb.platform_from_tip.inverse()
}
