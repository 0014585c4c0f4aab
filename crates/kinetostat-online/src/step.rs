//! One cycle: checks, wrench, equilibrium, state, limits.

use kinetostat::spatial::{Twist, Wrench, pose_residual};
use nalgebra::{Vector3, Vector6};

use crate::gain::ForceGain;
use crate::input::{Clamped, Command, Input, Output};
use crate::machine::equilibrium::Solved;
use crate::plan::Plan;
use crate::probe::{Probe, Verdict};
use crate::state::State;
use crate::supervisor::{Events, Mode, Reason};

/// A correction of more than so many times its limit is no correction.
const RUNAWAY: f64 = 2.0;

/// Computes one cycle: nothing is allocated, the equilibrium takes at most [`crate::MOST_PASSES`] passes, and whatever the input
/// is, the output is finite and its correction within the limits of size and rate.
pub fn step(plan: &Plan, state: &mut State, input: &Input) -> Output {
    let mut cycle = Cycle::default();
    if state.plan != plan.id {
        cycle.finding = Reason::OtherPlan;
        return cycle.output(state);
    }
    cycle.finding = check(plan, state, input);
    if cycle.finding == Reason::None {
        let outcome = cycle.model(plan, state, input);
        cycle.finding = outcome.err().unwrap_or_default();
    }
    supervise(plan, state, input, cycle.finding);
    cycle.send(plan, state);
    let sent = state.correction();
    cycle.clamped.joints = state.joints.follow(plan, &state.machine, &sent);
    cycle.output(state)
}

/// Checks of the input: numbers, sequence, age, joints.
fn check(plan: &Plan, state: &mut State, input: &Input) -> Reason {
    let last = state.last_sequence;
    let advances = last.is_none_or(|last| input.sequence > last);
    // A controller that starts again counts from the beginning: followed while nothing is sent.
    let idle = matches!(state.mode(), Mode::Shadow | Mode::Off);
    if advances || idle {
        state.last_sequence = Some(input.sequence);
    }
    if let (true, Some(last)) = (advances, last) {
        state.lost = state.lost.saturating_add(input.sequence - last - 1);
    }
    let measured = input.measured.unwrap_or_default();
    let mut numbers = input.joints[..plan.joints()]
        .iter()
        .chain(input.programmed.0.iter())
        .chain(measured.0.iter())
        .chain(input.observed.iter().flatten())
        .chain([&input.age]);
    let limits = plan.joint_limits.iter().zip(&input.joints);
    if !numbers.all(|x| x.is_finite()) {
        Reason::NotFinite
    } else if last == Some(input.sequence) {
        Reason::SequenceRepeated
    } else if !advances {
        Reason::SequenceOld
    } else if input.age > plan.settings.most_age {
        Reason::TooOld
    } else if limits
        .into_iter()
        .any(|((low, high), x)| x < low || x > high)
    {
        Reason::JointLimit
    } else if plan.settings.sensor.is_some() && input.measured.is_none() {
        Reason::SensorMissing
    } else {
        Reason::None
    }
}

/// State of the machine of states after this cycle.
fn supervise(plan: &Plan, state: &mut State, input: &Input, finding: Reason) {
    let is_new = input.command != state.last_command;
    state.last_command = input.command;
    let (mode, mut finding) = (state.mode(), finding);
    let idle = matches!(mode, Mode::Shadow | Mode::Off);
    if let (Command::ZeroSensor, true, true, Some(sensor)) =
        (input.command, is_new, idle, &plan.settings.sensor)
    {
        state.sensor.begin_zeroing(sensor);
    }
    let refusal = match &plan.settings.sensor {
        Some(sensor) if sensor.process_stiffness.is_none() => Reason::ProcessStiffnessUnknown,
        Some(_) if !state.sensor.is_zeroed() => Reason::SensorNotZeroed,
        _ => Reason::None,
    };
    if mode == Mode::Armed && plan.settings.probe.is_some() && input.observed.is_none() {
        finding = match finding {
            Reason::None => Reason::NotObserved,
            found => found,
        };
    }
    let mut events = Events {
        arm: is_new && input.command == Command::Arm,
        stop: is_new && input.command == Command::Stop,
        finding,
        refusal,
        probe: None,
        at_zero: state.linear.is_at_rest()
            && state.angular.is_at_rest()
            && state.joints.is_at_rest(),
    };
    if let (Mode::Armed, Some(settings), Reason::None) = (mode, &plan.settings.probe, finding) {
        let observed = input.observed.unwrap_or_default();
        let along = Vector3::from(observed).dot(&plan.probe_direction);
        let (request, verdict) = state.probe.next(settings, along);
        events.probe = Some(verdict);
        if verdict == Verdict::Running {
            state.goal = Twist::new(plan.probe_direction * request, Vector3::zeros());
        }
    }
    state.supervisor.next(&events, plan.most_held);
    if state.mode() == Mode::Armed && mode != Mode::Armed {
        state.probe = Probe::new();
        state.goal = Twist::zero();
    }
    state.is_probing = match state.mode() {
        Mode::Armed => true,
        Mode::Ramp => state.is_probing,
        _ => false,
    };
}

/// Results of one cycle.
#[derive(Default)]
struct Cycle {
    finding: Reason,
    clamped: Clamped,
    passes: u32,
    loop_gain: f64,
    /// The model's correction of this cycle.
    fresh: Option<Twist>,
}

impl Cycle {
    /// Wrench and equilibrium; the correction that the model wants goes to `fresh`.
    fn model(&mut self, plan: &Plan, state: &mut State, input: &Input) -> Result<(), Reason> {
        believable(plan, &input.programmed)?;
        let machine = &mut state.machine;
        if !machine.prepare(&plan.machine, &input.joints[..plan.joints()]) {
            return Err(Reason::Singular);
        }
        let mut wrench = input.programmed;
        if let (Some(sensor), Some(filter), Some(reading)) =
            (&plan.settings.sensor, &plan.filter, &input.measured)
        {
            believable(plan, reading)?;
            let tool = machine.forward.pose;
            let process = state.sensor.process_wrench(sensor, reading, &tool);
            let trim = state
                .filter
                .next(filter, &(process - input.programmed).0.into());
            wrench += self.scaled(plan, state, Wrench(Vector6::from(trim)))?;
        }
        let machine = &mut state.machine;
        self.passes = crate::MOST_PASSES;
        match machine.solve(&plan.machine, &wrench) {
            Solved::Converged(passes) => self.passes = passes,
            Solved::Unfinished => {
                state.unconverged += 1;
                return Err(Reason::NotConverged);
            }
            Solved::Singular => return Err(Reason::Singular),
        }
        let program = machine.forward.pose;
        let wanted = pose_residual(&machine.target, &program);
        let (_, left_over) = plan.machine.split(&pose_residual(&machine.tool, &program));
        if !wanted
            .0
            .iter()
            .chain(left_over.0.iter())
            .all(|x| x.is_finite())
        {
            return Err(Reason::NotFinite);
        }
        (state.wanted, state.left_over) = (wanted, left_over);
        let limits = &plan.settings.limits;
        if wanted.linear().norm() > RUNAWAY * limits.position
            || wanted.angular().norm() > RUNAWAY * limits.rotation
        {
            return Err(Reason::CorrectionLimit);
        }
        self.fresh = Some(wanted);
        Ok(())
    }

    /// The measured part of the wrench by the gain rule.
    fn scaled(&mut self, plan: &Plan, state: &State, trim: Wrench) -> Result<Wrench, Reason> {
        let process = plan.settings.sensor.and_then(|s| s.process_stiffness);
        let Some(process) = process else {
            return Ok(trim);
        };
        let compliance = state
            .machine
            .compliance
            .fixed_view::<3, 3>(0, 0)
            .into_owned();
        let gain = ForceGain::new(&compliance, &process).ok_or(Reason::Singular)?;
        self.loop_gain = gain.loop_gain;
        self.clamped.gain = gain.is_scaled;
        Ok(Wrench::new(gain.matrix * trim.force(), trim.moment()))
    }

    /// Moves the correction towards its target by the limits of size and rate.
    fn send(&mut self, plan: &Plan, state: &mut State) {
        let limits = &plan.settings.limits;
        let period = plan.settings.period;
        match (state.mode(), self.fresh) {
            (Mode::Active, Some(wanted)) => {
                let (linear, position) = clamp(wanted.linear(), limits.position);
                let (angular, rotation) = clamp(wanted.angular(), limits.rotation);
                (self.clamped.position, self.clamped.rotation) = (position, rotation);
                state.goal = Twist::new(linear, angular);
            }
            (Mode::Armed, _) | (Mode::Active | Mode::Hold, None) | (Mode::Hold, Some(_)) => {}
            (Mode::Shadow | Mode::Off | Mode::Ramp, _) => state.goal = Twist::zero(),
        }
        let (linear, angular) = (state.goal.linear(), state.goal.angular());
        if state.is_probing {
            // A step in and a step out: a relative object sums up every cycle of a ramp.
            state.linear.step_to(&linear, &plan.linear, period);
        } else {
            self.clamped.rate |= state.linear.follow(&linear, &plan.linear, period);
        }
        self.clamped.rate |= state.angular.follow(&angular, &plan.angular, period);
    }

    fn output(&self, state: &State) -> Output {
        Output {
            correction: state.correction(),
            joints: state.joints.at,
            wanted: state.wanted,
            left_over: state.left_over,
            mode: state.mode(),
            cause: state.supervisor.cause,
            finding: self.finding,
            clamped: self.clamped,
            passes: self.passes,
            loop_gain: self.loop_gain,
            unconverged: state.unconverged,
            lost: state.lost,
        }
    }
}

/// Refuses wrenches beyond the ceiling.
fn believable(plan: &Plan, wrench: &Wrench) -> Result<(), Reason> {
    let limits = &plan.settings.limits;
    match wrench.force().norm() <= limits.force && wrench.moment().norm() <= limits.moment {
        true => Ok(()),
        false => Err(Reason::ForceCeiling),
    }
}

/// A vector of at most this length, and whether it was longer.
fn clamp(vector: Vector3<f64>, most: f64) -> (Vector3<f64>, bool) {
    let size = vector.norm();
    match size > most {
        true => (vector * (most / size), true),
        false => (vector, false),
    }
}
