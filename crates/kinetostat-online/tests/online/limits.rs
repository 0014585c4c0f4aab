//! Whatever comes in: finite numbers out, no step above the limits, no pass above eight, no allocation, on every machine.

use std::time::Instant;

use assert_no_alloc::{assert_no_alloc, reset_violation_count, violation_count};
use kinetostat::nalgebra::Vector3;
use kinetostat::{Directions, Mechanism, Wrench};
use kinetostat_online::{
    Command, Input, Mode, Output, Plan, PlanSettings, Reason, Sensor, State, step,
};
use proptest::prelude::*;
use proptest::strategy::ValueTree;

use crate::common::{Random, feed_forward, joints, next, preset};
use crate::loops::{gantry, sensor};

/// Numbers as a broken packet has them.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        12 => -1.0..1.0_f64,
        4 => -1e3..1e3_f64,
        1 => Just(f64::NAN),
        1 => Just(f64::INFINITY),
        1 => Just(f64::NEG_INFINITY),
        1 => Just(f64::MAX),
        1 => Just(1e-310),
        1 => -1e18..1e18_f64,
    ]
}

fn wrench() -> impl Strategy<Value = Wrench> {
    prop::array::uniform6(number()).prop_map(|x| Wrench(x.into()))
}

#[derive(Clone, Debug)]
struct Packet {
    joints: Vec<f64>,
    measured: Option<Wrench>,
    programmed: Wrench,
    age: f64,
    observed: Option<[f64; 3]>,
    command: Command,
    sequence: u64,
}

/// Mostly a good packet after the one before, sometimes any.
fn packet() -> impl Strategy<Value = Packet> {
    let command = prop_oneof![
        8 => Just(Command::None),
        3 => Just(Command::Arm),
        1 => Just(Command::Stop),
        1 => Just(Command::ZeroSensor),
    ];
    let sequence = prop_oneof![20 => 1..3_u64, 1 => Just(0), 1 => any::<u64>()];
    let broken = (
        prop::collection::vec(number(), 6),
        prop::option::weighted(0.9, wrench()),
        wrench(),
        number(),
        prop::option::weighted(0.5, prop::array::uniform3(number())),
    );
    let good = (
        prop::collection::vec(-0.02..0.02_f64, 6),
        prop::array::uniform3(-900.0..900.0_f64),
    );
    (
        any::<prop::sample::Index>(),
        broken,
        good,
        command,
        sequence,
    )
        .prop_map(
            |(
                kind,
                (joints, measured, programmed, age, observed),
                (near, force),
                command,
                sequence,
            )| {
                match kind.index(8) {
                    0 => Packet {
                        joints,
                        measured,
                        programmed,
                        age,
                        observed,
                        command,
                        sequence,
                    },
                    _ => Packet {
                        joints: near,
                        measured: Some(Wrench::new(Vector3::from(force), Vector3::zeros())),
                        programmed: Wrench::new(Vector3::from(force) * 0.5, Vector3::zeros()),
                        age: 1e-3,
                        observed: Some([0.0; 3]),
                        command,
                        sequence,
                    },
                }
            },
        )
}

/// What holds of every output, after the one before.
fn holds(plan: &Plan, before: &Output, output: &Output) -> Result<(), TestCaseError> {
    let limits = &plan.settings().limits;
    let period = plan.settings().period;
    let all = output
        .correction
        .0
        .iter()
        .chain(output.wanted.0.iter())
        .chain(output.left_over.0.iter());
    prop_assert!(
        all.chain(&output.joints).all(|x| x.is_finite()),
        "{output:?}"
    );
    prop_assert!(output.loop_gain.is_finite() && output.passes <= 8);
    let step = output.correction - before.correction;
    let most = 1.0 + 1e-9;
    prop_assert!(
        step.linear().norm() <= limits.speed * period * most,
        "{step:?}"
    );
    prop_assert!(
        step.angular().norm() <= limits.angular_speed * period * most,
        "{step:?}"
    );
    prop_assert!(output.correction.linear().norm() <= limits.position * most);
    prop_assert!(output.correction.angular().norm() <= limits.rotation * most);
    for (now, then) in output.joints.iter().zip(&before.joints) {
        prop_assert!((now - then).abs() <= limits.joint_speed * period * most);
    }
    if matches!(output.mode, Mode::Shadow | Mode::Off) {
        prop_assert_eq!(output.correction.0.norm(), 0.0);
    }
    Ok(())
}

fn run(plan: &Plan, home: &[f64], packets: &[Packet]) -> Result<Vec<Mode>, TestCaseError> {
    let mut state = plan.start().unwrap();
    let mut input = Input {
        joints: joints(home),
        ..Input::default()
    };
    let mut before = next(plan, &mut state, &mut input);
    let mut modes = Vec::new();
    for packet in packets {
        let own: Vec<f64> = home
            .iter()
            .zip(&packet.joints)
            .map(|(x, d)| x + d)
            .collect();
        input = Input {
            joints: joints(&own),
            measured: packet.measured,
            programmed: packet.programmed,
            age: packet.age,
            sequence: input.sequence.wrapping_add(packet.sequence),
            observed: packet.observed,
            command: packet.command,
        };
        let repeated = step(plan, &mut state, &input);
        holds(plan, &before, &repeated)?;
        let finite = own
            .iter()
            .chain(packet.programmed.0.iter())
            .all(|x| x.is_finite());
        prop_assert!(finite || repeated.finding != Reason::None);
        before = repeated;
        modes.push(before.mode);
        // Good cycles in between, so that something is sent when the next packet comes.
        input.joints = joints(home);
        (input.age, input.command, input.observed) = (0.0, Command::None, Some([0.0; 3]));
        input.programmed = Wrench::new(Vector3::new(400.0, -300.0, 200.0), Vector3::zeros());
        input.measured = Some(input.programmed);
        for _ in 0..12 {
            let output = next_wrapping(plan, &mut state, &mut input);
            holds(plan, &before, &output)?;
            before = output;
        }
        modes.push(before.mode);
    }
    Ok(modes)
}

fn next_wrapping(plan: &Plan, state: &mut State, input: &mut Input) -> Output {
    input.sequence = input.sequence.wrapping_add(1);
    step(plan, state, input)
}

fn home(mechanism: &Mechanism) -> Vec<f64> {
    let home = mechanism.platforms()[mechanism.tool()].home;
    mechanism.posture(&home).unwrap().commands()
}

/// Feed-forward alone, feedback, and a probe, with all directions.
fn settings(kind: usize) -> PlanSettings {
    let mut settings = match kind {
        2 => PlanSettings::new(1e-3),
        _ => feed_forward(),
    };
    settings.directions = Directions::ALL;
    if kind != 0 {
        // So fast that the speed alone limits a step of this size.
        (
            settings.limits.acceleration,
            settings.limits.angular_acceleration,
        ) = (100.0, 100.0);
    }
    if kind == 1 {
        settings.limits.joint_speed = 0.005;
        settings.sensor = Some(Sensor {
            mass: 5.0,
            zeroing_cycles: 3,
            ..sensor(3.0, 12.0, Some(2e6))
        });
    }
    settings
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_input_leads_beyond_the_limits(packets in prop::collection::vec(packet(), 1..40), kind in 0..3_usize, machine in 0..3_usize) {
        let mechanism = [preset("heavy_6r"), gantry(5e6), preset("puu3")][machine].clone();
        let plan = Plan::compile(&mechanism, &settings(kind)).unwrap();
        run(&plan, &home(&mechanism), &packets)?;
    }
}

#[test]
fn the_inputs_of_the_property_reach_every_mode() {
    let mechanism = gantry(5e6);
    let plan = Plan::compile(&mechanism, &settings(0)).unwrap();
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let mut seen = [false; 6];
    for _ in 0..200 {
        let packets = prop::collection::vec(packet(), 40)
            .new_tree(&mut runner)
            .unwrap()
            .current();
        for mode in run(&plan, &home(&mechanism), &packets).unwrap() {
            seen[mode as usize] = true;
        }
    }
    assert_eq!(seen, [true; 6], "Shadow, Armed, Active, Hold, Ramp, Off");
}

#[test]
fn acceleration_is_limited_outside_the_probe() {
    let mechanism = gantry(5e6);
    let plan = Plan::compile(&mechanism, &settings(0)).unwrap();
    let (mut state, mut input) = (plan.start().unwrap(), Input::default());
    let mut random = Random(5);
    let mut last = [next(&plan, &mut state, &mut input); 2];
    let mut fastest = 0.0_f64;
    for cycle in 0..20_000 {
        input.command = match cycle % 2000 {
            10 => Command::Arm,
            1500 => Command::Stop,
            _ => Command::None,
        };
        if random.unit() < 0.02 {
            input.programmed = Wrench::new(random.vector(2500.0), Vector3::zeros());
        }
        let output = next(&plan, &mut state, &mut input);
        let change =
            (output.correction - last[1].correction) - (last[1].correction - last[0].correction);
        let limits = &plan.settings().limits;
        let most = limits.acceleration * 1e-6 * (1.0 + 1e-9) + 1e-18;
        assert!(change.linear().norm() <= most, "{cycle}: {change:?}");
        fastest = kinetostat::number::larger(
            fastest,
            (output.correction - last[1].correction).linear().norm(),
        );
        last = [last[1], output];
    }
    let most = plan.settings().limits.speed * 1e-3;
    assert!(
        fastest > 0.9 * most && fastest <= most * (1.0 + 1e-9),
        "the limit of speed is reached: {fastest}"
    );
}

/// Machines on which nothing may be allocated.
const MACHINES: [&str; 9] = [
    "heavy_6r",
    "kuka_kr270_like",
    "fanuc_r2000ic_like",
    "scara",
    "compensated_arm",
    "orthoglide",
    "puu3",
    "hexapod",
    "hexaglide",
];

#[test]
fn nothing_is_allocated_in_a_cycle() {
    reset_violation_count();
    assert_no_alloc(|| drop(std::hint::black_box(Box::new(1))));
    assert!(violation_count() > 0, "the check sees an allocation");
    for name in MACHINES {
        let mechanism = preset(name);
        let home = home(&mechanism);
        for kind in 0..3 {
            let mut settings = settings(kind);
            (settings.limits.position, settings.limits.rotation) = (0.1, 1.0);
            let plan = Plan::compile(&mechanism, &settings).unwrap();
            let mut state = plan.start().unwrap();
            let mut random = Random(17);
            let mut input = Input::default();
            reset_violation_count();
            let (mut active, mut most) = (0, 0);
            for cycle in 0..3000 {
                for (k, x) in home.iter().enumerate() {
                    input.joints[k] = x + 0.01 * (1e-3 * f64::from(cycle) + k as f64).sin();
                }
                let force =
                    Vector3::from_fn(|k, _| 100.0 * (0.02 * f64::from(cycle) + k as f64).sin());
                input.programmed = Wrench::new(force, Vector3::zeros());
                input.measured = Some(random.wrench(100.0, 5.0));
                input.observed = Some([0.0; 3]);
                input.age = 0.0;
                input.command = match cycle % 500 {
                    3 => Command::ZeroSensor,
                    20 => Command::Arm,
                    480 => Command::Stop,
                    _ => Command::None,
                };
                match cycle % 97 {
                    90 => input.joints[0] = f64::NAN,
                    91 => input.age = 1e9,
                    92 => input.programmed.0[2] = 1e300,
                    _ => {}
                }
                let output = assert_no_alloc(|| next(&plan, &mut state, &mut input));
                active += usize::from(output.mode == Mode::Active);
                if output.passes > most {
                    most = output.passes;
                }
            }
            assert_eq!(violation_count(), 0, "{name}, settings {kind}");
            assert!(
                most <= 8 && (kind == 2 || active > 100),
                "{name}: {active} active cycles"
            );
        }
    }
}

#[test]
fn a_program_is_followed_without_a_held_cycle() {
    for name in MACHINES {
        let mechanism = preset(name);
        let mut settings = settings(0);
        settings.limits.position = 0.1;
        settings.limits.rotation = 1.0;
        let plan = Plan::compile(&mechanism, &settings).unwrap();
        let (mut state, mut input) = (plan.start().unwrap(), Input::default());
        let home = home(&mechanism);
        let (mut passes, mut cycles, mut times) = ([0; 9], 0, Vec::new());
        for cycle in 0..2000 {
            // Sixty millimetres, or as many thousandths of a radian, in a second, and a force that turns with it.
            let t = 1e-3 * f64::from(cycle);
            for (k, x) in home.iter().enumerate() {
                input.joints[k] = x + 0.03 * ((2.0 * t + k as f64).sin() - (k as f64).sin());
            }
            let force = Vector3::new(200.0 * (6.0 * t).cos(), 200.0 * (6.0 * t).sin(), -80.0);
            input.programmed = Wrench::new(force, Vector3::zeros());
            let begun = Instant::now();
            let output = next(&plan, &mut state, &mut input);
            times.push(begun.elapsed().as_nanos());
            if cycle > 20 {
                assert_eq!(output.finding, Reason::None, "{name} cycle {cycle}");
                passes[output.passes as usize] += 1;
                cycles += 1;
            }
        }
        assert_eq!(passes.iter().sum::<i32>(), cycles);
        times.sort_unstable();
        // Reported, not asserted: other work shares the machine.
        let at = |share: usize| times[times.len() * share / 1000] as f64 / 1e3;
        println!(
            "{name}: cycles by passes {passes:?}, {:.1} us median, {:.1} us p99.9",
            at(500),
            at(999)
        );
    }
}

#[test]
fn machines_that_are_not_supported_are_refused_with_the_reason() {
    for (name, reason) in [
        ("gantry", "platforms between base and tool"),
        ("delta", "platforms between base and tool"),
        ("counterweight_arm", "platforms between base and tool"),
        ("prs3", "turns as it moves"),
        ("three_link_z", "actuators"),
    ] {
        let error = Plan::compile(&preset(name), &feed_forward())
            .unwrap_err()
            .to_string();
        assert!(error.contains(name) && error.contains(reason), "{error}");
    }
    let mut wrong = feed_forward();
    wrong.period = f64::NAN;
    let error = Plan::compile(&gantry(5e6), &wrong).unwrap_err().to_string();
    assert!(error.contains("the period (s) is NaN"), "{error}");
    let mut turns = feed_forward();
    turns.directions = Directions::NONE.with(4);
    let error = Plan::compile(&gantry(5e6), &turns).unwrap_err().to_string();
    assert!(error.contains("none of ry"), "{error}");
}
