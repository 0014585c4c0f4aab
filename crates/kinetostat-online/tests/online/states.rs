//! Every transition of the machine of states, by the inputs that cause it.

use kinetostat::nalgebra::{Vector3, vector};
use kinetostat::*;
use kinetostat_online::{
    Command, Input, Mode, Output, Plan, PlanSettings, ProbeSettings, Reason, State, step,
};

use crate::common::{feed_forward, next};
use crate::loops::{activate, gantry, sensor};

/// A compensation of a gantry under a programmed force, which wants 100 um.
struct Run {
    plan: Plan,
    state: State,
    input: Input,
}

impl Run {
    fn new(settings: &PlanSettings) -> Self {
        let plan = Plan::compile(&gantry(5e6), settings).unwrap();
        let state = plan.start().unwrap();
        let programmed = Wrench::new(vector![500.0, 0.0, 0.0], Vector3::zeros());
        let input = Input {
            programmed,
            ..Input::default()
        };
        Self { plan, state, input }
    }

    /// Without a probe and a sensor.
    fn plain() -> Self {
        Self::new(&feed_forward())
    }

    fn next(&mut self) -> Output {
        next(&self.plan, &mut self.state, &mut self.input)
    }

    fn command(&mut self, command: Command) -> Output {
        self.input.command = command;
        let output = self.next();
        self.input.command = Command::None;
        output
    }

    /// Active, with the whole correction sent.
    fn active() -> Self {
        let mut run = Self::plain();
        run.next();
        assert_eq!(run.command(Command::Arm).mode, Mode::Armed);
        assert_eq!(run.next().mode, Mode::Active);
        for _ in 0..100 {
            run.next();
        }
        assert!((run.state.correction().linear().x + 1e-4).abs() < 1e-12);
        run
    }

    /// Cycles until another mode; at most a second.
    fn until_not(&mut self, mode: Mode) -> usize {
        (0..1000)
            .find(|_| self.next().mode != mode)
            .expect("it ends")
    }
}

#[test]
fn shadow_computes_and_sends_nothing() {
    let mut run = Run::plain();
    for _ in 0..50 {
        let output = run.next();
        assert_eq!((output.mode, output.finding), (Mode::Shadow, Reason::None));
        assert_eq!(output.correction, Twist::zero());
        assert_eq!(output.joints, [0.0; 16]);
    }
    assert!((run.next().wanted.linear().x + 1e-4).abs() < 1e-12);
    // Nothing but a person moves it.
    run.input.joints[0] = f64::NAN;
    assert_eq!(
        (run.next().mode, run.next().finding),
        (Mode::Shadow, Reason::NotFinite)
    );
    assert_eq!(run.command(Command::Stop).mode, Mode::Shadow);
}

#[test]
fn the_joints_carry_the_correction() {
    let mut run = Run::active();
    let output = run.next();
    assert!((output.joints[0] - output.correction.linear().x).abs() < 1e-15);
    assert_eq!(output.joints[3..], [0.0; 13]);
    assert!(!output.clamped.joints && !output.clamped.rate);
}

#[test]
fn slow_joints_lag_behind_and_are_waited_for_at_the_end() {
    let mut settings = feed_forward();
    settings.limits.joint_speed = 1e-3; // 1 um in a cycle
    let mut run = Run::new(&settings);
    run.command(Command::Arm);
    let mut last = run.next();
    for cycle in 0..150 {
        let output = run.next();
        assert!((output.joints[0] - last.joints[0]).abs() <= 1e-6 * (1.0 + 1e-9));
        assert!(
            output.clamped.joints || !(10..90).contains(&cycle),
            "cycle {cycle}"
        );
        last = output;
    }
    assert!((last.joints[0] + 1e-4).abs() < 1e-12);
    run.command(Command::Stop);
    let cycles = run.until_not(Mode::Ramp);
    assert!((95..110).contains(&cycles), "{cycles} cycles of ramp");
    assert_eq!(
        (run.state.mode(), run.next().joints),
        (Mode::Off, [0.0; 16])
    );
}

#[test]
fn arming_is_refused_while_something_is_wrong() {
    let mut run = Run::plain();
    run.input.joints[1] = f64::INFINITY;
    let output = run.command(Command::Arm);
    assert_eq!(
        (output.mode, output.cause),
        (Mode::Shadow, Reason::NotFinite)
    );
    run.input.joints[1] = 0.0;
    assert_eq!(
        run.next().mode,
        Mode::Shadow,
        "a refused command is not kept"
    );
}

#[test]
fn missing_inputs_hold_and_come_back() {
    let mut run = Run::active();
    let sent = run.state.correction();
    let input = run.input;
    // The same packet again, 20 cycles of 1 ms long.
    for _ in 0..20 {
        let output = step(&run.plan, &mut run.state, &input);
        assert_eq!(
            (output.mode, output.finding),
            (Mode::Hold, Reason::SequenceRepeated)
        );
        assert_eq!(output.correction, sent);
    }
    let output = run.next();
    assert_eq!(
        (output.mode, output.finding, output.cause),
        (Mode::Active, Reason::None, Reason::SequenceRepeated)
    );
}

#[test]
fn after_20_ms_it_ramps_to_zero_and_stays_off_until_a_person_arms() {
    let mut run = Run::active();
    let input = run.input;
    for _ in 0..20 {
        assert_eq!(step(&run.plan, &mut run.state, &input).mode, Mode::Hold);
    }
    let output = step(&run.plan, &mut run.state, &input);
    assert_eq!(
        (output.mode, output.cause),
        (Mode::Ramp, Reason::SequenceRepeated)
    );
    // A good input does not bring it back, nor does arming on the way.
    run.command(Command::Arm);
    assert_eq!(run.state.mode(), Mode::Ramp);
    run.until_not(Mode::Ramp);
    let output = run.next();
    assert_eq!(
        (output.mode, output.cause),
        (Mode::Off, Reason::SequenceRepeated)
    );
    assert_eq!(
        (output.correction, output.joints),
        (Twist::zero(), [0.0; 16])
    );
    for _ in 0..100 {
        let output = run.next();
        assert_eq!((output.mode, output.correction), (Mode::Off, Twist::zero()));
    }
    assert_eq!(run.command(Command::Arm).mode, Mode::Armed);
    assert_eq!(run.next().mode, Mode::Active);
}

#[test]
fn a_level_is_one_command() {
    let mut run = Run::plain();
    run.input.command = Command::Arm;
    run.next();
    assert_eq!(run.next().mode, Mode::Active);
    run.input.programmed.0[0] = f64::NAN;
    assert_eq!(run.next().mode, Mode::Ramp);
    run.input.programmed.0[0] = 0.0;
    run.until_not(Mode::Ramp);
    // Arm is still pressed.
    for _ in 0..100 {
        assert_eq!(run.next().mode, Mode::Off);
    }
}

#[test]
fn the_operator_stops_it_in_every_state_that_sends() {
    let mut run = Run::active();
    let output = run.command(Command::Stop);
    assert_eq!((output.mode, output.cause), (Mode::Ramp, Reason::Stopped));
    let mut run = Run::active();
    let input = Input {
        command: Command::Stop,
        ..run.input
    };
    step(&run.plan, &mut run.state, &run.input);
    assert_eq!(run.state.mode(), Mode::Hold);
    step(&run.plan, &mut run.state, &input);
    assert_eq!(run.state.mode(), Mode::Ramp);
    let mut run = Run::new(&PlanSettings::new(1e-3));
    run.input.observed = Some([0.0; 3]);
    assert_eq!(run.command(Command::Arm).mode, Mode::Armed);
    assert_eq!(run.command(Command::Stop).mode, Mode::Ramp);
    run.until_not(Mode::Ramp);
    assert_eq!(run.state.mode(), Mode::Off);
}

/// What an input leads to from `Active`.
fn from_active(change: impl Fn(&mut Input)) -> (Mode, Reason) {
    let mut run = Run::active();
    change(&mut run.input);
    let output = run.next();
    (output.mode, output.finding)
}

#[test]
fn what_may_pass_is_held_and_what_may_not_ramps() {
    let held = |change: &dyn Fn(&mut Input), reason| {
        assert_eq!(from_active(change), (Mode::Hold, reason));
    };
    held(&|i| i.age = 0.1, Reason::TooOld);
    held(&|i| i.sequence -= 2, Reason::SequenceOld);
    held(&|i| i.sequence -= 1, Reason::SequenceRepeated);
    let ramps = |change: &dyn Fn(&mut Input), reason| {
        assert_eq!(from_active(change), (Mode::Ramp, reason));
    };
    ramps(&|i| i.age = f64::NAN, Reason::NotFinite);
    ramps(&|i| i.joints[2] = f64::NEG_INFINITY, Reason::NotFinite);
    ramps(&|i| i.joints[2] = 1e4, Reason::JointLimit);
    ramps(&|i| i.programmed.0[1] = 6e3, Reason::ForceCeiling);
    ramps(&|i| i.programmed.0[5] = -3e3, Reason::ForceCeiling);
    ramps(&|i| i.programmed.0[1] = 1e300, Reason::ForceCeiling);
    ramps(
        &|i| i.measured = Some(Wrench::new(Vector3::repeat(f64::NAN), Vector3::zeros())),
        Reason::NotFinite,
    );
}

#[test]
fn a_correction_above_its_limit_is_clamped_and_one_of_twice_its_size_ramps() {
    let mut run = Run::plain();
    run.plan = {
        let mut settings = feed_forward();
        settings.limits.position = 1.5e-4;
        Plan::compile(&gantry(5e6), &settings).unwrap()
    };
    run.state = run.plan.start().unwrap();
    run.command(Command::Arm);
    for _ in 0..100 {
        run.next();
    }
    assert_eq!(run.state.mode(), Mode::Active);
    run.input.programmed.0[0] = 1200.0; // wants 240 um of 150
    let mut output = run.next();
    for _ in 0..200 {
        output = run.next();
    }
    assert!(output.clamped.position && output.mode == Mode::Active);
    assert!((output.correction.linear().norm() - 1.5e-4).abs() < 1e-15);
    assert!((output.wanted.linear().norm() - 2.4e-4).abs() < 1e-12);
    run.input.programmed.0[0] = 1600.0; // 320 um
    let output = run.next();
    assert_eq!(
        (output.mode, output.cause),
        (Mode::Ramp, Reason::CorrectionLimit)
    );
}

/// A gantry whose flange hangs on a hinge that a force half as large as its buckling load presses.
fn soft() -> Plan {
    let slide = |axis| ActuatorSpec::new(MotionKind::Prismatic, axis, 1e7);
    let chain = Chain::builder("soft")
        .actuator("x", slide(Vector3::x()))
        .actuator("y", slide(Vector3::y()))
        .actuator("z", slide(Vector3::z()))
        .spring("hinge", MotionKind::Revolute, Vector3::z(), 1e3, 0.0)
        .translation(vector![1.0, 0.0, 0.0])
        .build()
        .unwrap();
    let machine = Mechanism::serial(chain, Pose::translation(1.0, 0.0, 0.0), Vector3::zeros());
    let mut settings = feed_forward();
    settings.limits.position = 1.0;
    Plan::compile(&machine.unwrap(), &settings).unwrap()
}

#[test]
fn what_does_not_converge_in_a_cycle_is_held_and_counted_and_the_next_cycles_go_on() {
    for (press, ends) in [(-500.0, Mode::Active), (-985.0, Mode::Ramp)] {
        let plan = soft();
        let (mut state, mut input) = (plan.start().unwrap(), Input::default());
        input.command = Command::Arm;
        for _ in 0..3 {
            next(&plan, &mut state, &mut input);
        }
        assert_eq!(state.mode(), Mode::Active);
        input.programmed = Wrench::new(vector![press, 2.0, 0.0], Vector3::zeros());
        let output = next(&plan, &mut state, &mut input);
        assert_eq!(
            (output.mode, output.finding, output.passes),
            (Mode::Hold, Reason::NotConverged, 8)
        );
        assert_eq!(output.unconverged, 1);
        let cycles = (0..100).find(|_| next(&plan, &mut state, &mut input).mode != Mode::Hold);
        assert_eq!(
            state.mode(),
            ends,
            "after {cycles:?} cycles under {press} N"
        );
    }
}

#[test]
fn a_sensor_is_zeroed_and_its_process_known_before_it_arms() {
    let mut settings = feed_forward();
    settings.sensor = Some(sensor(1.0, 12.0, None));
    let mut run = Run::new(&settings);
    run.input.measured = Some(Wrench::zero());
    run.command(Command::ZeroSensor);
    for _ in 0..10 {
        run.next();
    }
    let output = run.command(Command::Arm);
    assert_eq!(
        (output.mode, output.cause),
        (Mode::Shadow, Reason::ProcessStiffnessUnknown)
    );

    settings.sensor = Some(sensor(1.0, 12.0, Some(1e4)));
    let mut run = Run::new(&settings);
    run.input.measured = Some(Wrench::zero());
    let output = run.command(Command::Arm);
    assert_eq!(
        (output.mode, output.cause),
        (Mode::Shadow, Reason::SensorNotZeroed)
    );
    activate(&run.plan, &mut run.state, &mut run.input);
    // Zeroing does nothing while corrections are sent.
    run.command(Command::ZeroSensor);
    assert_eq!(run.next().mode, Mode::Active);
    run.input.measured = None;
    let output = run.next();
    assert_eq!(
        (output.mode, output.finding),
        (Mode::Hold, Reason::SensorMissing)
    );
}

#[test]
fn a_controller_that_counts_anew_is_followed_while_nothing_is_sent() {
    let mut run = Run::plain();
    run.input.sequence = 1000;
    run.next();
    run.input.sequence = 0;
    assert_eq!(run.next().finding, Reason::SequenceOld);
    assert_eq!(run.next().finding, Reason::None);
    run.input.sequence += 7;
    assert_eq!(run.next().lost, 7);
    run.input.sequence = u64::MAX - 1;
    assert_eq!(run.next().finding, Reason::None);
}

#[test]
fn the_state_of_another_plan_is_refused() {
    let mut run = Run::active();
    let other = Run::plain().plan;
    let sent = run.state.correction();
    let output = step(&other, &mut run.state, &run.input);
    assert_eq!(
        (output.finding, output.correction),
        (Reason::OtherPlan, sent)
    );
}

/// A controller that takes corrections as totals, adds them up, or ignores them, and shows its pose some cycles later.
fn probed(delay: usize, takes: impl Fn(f64, f64) -> f64) -> (Output, f64) {
    let mut run = Run::new(&PlanSettings::new(4e-3));
    let (mut offset, mut farthest) = (0.0, 0.0_f64);
    let mut shown = vec![0.0; delay];
    run.input.observed = Some([0.0; 3]);
    run.command(Command::Arm);
    for _ in 0..400 {
        run.input.observed = Some([0.0, 0.0, shown[0]]);
        let output = run.next();
        offset = takes(offset, output.correction.linear().z);
        farthest = kinetostat::number::larger(farthest, f64::abs(offset));
        shown.rotate_left(1);
        shown[delay - 1] = offset;
        if output.mode != Mode::Armed && output.mode != Mode::Ramp {
            return (output, farthest);
        }
    }
    panic!("the probe ends");
}

#[test]
fn the_probe_arms_absolute_objects_and_refuses_relative_ones_before_0_25_mm() {
    for delay in [1, 2, 3, 10, 30] {
        let (output, farthest) = probed(delay, |_, sent| sent);
        assert_eq!(
            output.mode,
            Mode::Active,
            "delay {delay}: {:?}",
            output.cause
        );
        assert!((farthest - 2e-5).abs() < 1e-12);
        let (output, farthest) = probed(delay, |offset, sent| offset + sent);
        assert_eq!(
            (output.mode, output.cause),
            (Mode::Off, Reason::ProbeRelative)
        );
        println!(
            "delay {delay}: a relative object moved by {:.3} mm",
            1e3 * farthest
        );
        assert!(farthest < 0.25e-3, "delay {delay}: {farthest}");
        let (output, _) = probed(delay, |_, _| 0.0);
        assert_eq!(
            (output.mode, output.cause),
            (Mode::Off, Reason::ProbeSilent)
        );
    }
}

#[test]
fn a_probe_needs_the_pose_that_the_controller_commands() {
    let mut run = Run::new(&PlanSettings::new(1e-3));
    assert_eq!(run.command(Command::Arm).mode, Mode::Armed);
    let output = run.next();
    assert_eq!(
        (output.mode, output.cause),
        (Mode::Ramp, Reason::NotObserved)
    );
    let settings = ProbeSettings {
        amplitude: 3e-5,
        ..ProbeSettings::default()
    };
    let mut wrong = PlanSettings::new(1e-3);
    wrong.probe = Some(settings);
    let error = Plan::compile(&gantry(5e6), &wrong).unwrap_err().to_string();
    assert!(error.contains("amplitude of the probe"), "{error}");
}

#[test]
fn a_disturbed_probe_ends_off() {
    let mut run = Run::new(&PlanSettings::new(1e-3));
    run.input.observed = Some([0.0; 3]);
    run.command(Command::Arm);
    run.next();
    assert!(run.state.correction().linear().z > 0.0, "the probe moves");
    let repeated = run.input;
    let output = step(&run.plan, &mut run.state, &repeated);
    assert_eq!(
        (output.mode, output.cause),
        (Mode::Ramp, Reason::SequenceRepeated)
    );
    run.next();
    assert_eq!(run.next().mode, Mode::Off);
}
