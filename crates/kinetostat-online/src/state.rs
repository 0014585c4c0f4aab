//! The state: what a compensation remembers from cycle to cycle, and all of its buffers.

use kinetostat::spatial::{Twist, moved};

use crate::error::{Error, Result};
use crate::input::{Command, MOST_JOINTS};
use crate::limiter::Follower;
use crate::low_pass::LowPassState;
use crate::machine::equilibrium::MachineState;
use crate::machine::joints::Joints;
use crate::plan::Plan;
use crate::probe::Probe;
use crate::sensor::SensorState;
use crate::supervisor::{Mode, Supervisor};

/// State of one compensation. Made by [`Plan::start`]; changed by [`crate::step`] alone.
#[derive(Clone, Debug)]
pub struct State {
    pub(crate) plan: u64,
    pub(crate) machine: MachineState,
    pub(crate) sensor: SensorState,
    pub(crate) filter: LowPassState,
    pub(crate) supervisor: Supervisor,
    pub(crate) probe: Probe,
    /// True while the request of a probe is sent or taken back.
    pub(crate) is_probing: bool,
    /// Correction that the model wanted last, and what it leaves over.
    pub(crate) wanted: Twist,
    pub(crate) left_over: Twist,
    /// Target of the correction: what the model wanted last, clamped.
    pub(crate) goal: Twist,
    pub(crate) linear: Follower,
    pub(crate) angular: Follower,
    pub(crate) joints: JointCorrection,
    pub(crate) last_command: Command,
    pub(crate) last_sequence: Option<u64>,
    pub(crate) unconverged: u64,
    pub(crate) lost: u64,
}

impl Plan {
    /// A state at rest in `Shadow`, with all buffers of this plan.
    ///
    /// # Errors
    /// As [`Self::compile`], which has made one already.
    pub fn start(&self) -> Result<State> {
        State::new(self)
    }
}

impl State {
    fn new(plan: &Plan) -> Result<Self> {
        let machine = MachineState::new(&plan.machine).ok_or_else(|| Error::Unsupported {
            machine: plan.name().to_owned(),
            reason: "a spring has no stiffness at rest".into(),
        })?;
        Ok(Self {
            plan: plan.id,
            joints: JointCorrection::new(plan),
            machine,
            sensor: SensorState::default(),
            filter: LowPassState::default(),
            supervisor: Supervisor::default(),
            probe: Probe::new(),
            is_probing: false,
            wanted: Twist::zero(),
            left_over: Twist::zero(),
            goal: Twist::zero(),
            linear: Follower::default(),
            angular: Follower::default(),
            last_command: Command::None,
            last_sequence: None,
            unconverged: 0,
            lost: 0,
        })
    }

    /// State of the machine of states.
    #[must_use]
    pub fn mode(&self) -> Mode {
        self.supervisor.mode
    }

    /// Correction that was sent last.
    #[must_use]
    pub fn correction(&self) -> Twist {
        Twist::new(self.linear.at, self.angular.at)
    }
}

/// The correction of the joints: nominal inverse kinematics at the pose that is sent, followed from cycle to cycle.
#[derive(Clone, Debug)]
pub(crate) struct JointCorrection {
    limbs: Vec<Joints>,
    /// Joints less those of the program.
    pub at: [f64; MOST_JOINTS],
}

/// Newton steps of one cycle.
const STEPS: usize = 3;
/// Distance from the pose below which no further step is taken, as a share of the natural length: the step from there is exact.
const PRECISION: f64 = 1e-7;

impl JointCorrection {
    fn new(plan: &Plan) -> Self {
        let limbs = plan.machine.limbs.iter();
        Self {
            limbs: limbs.map(|limb| Joints::new(limb, true)).collect(),
            at: [0.0; MOST_JOINTS],
        }
    }

    pub(crate) fn is_at_rest(&self) -> bool {
        self.at == [0.0; MOST_JOINTS]
    }

    /// Follows the pose that is sent, at the joints that the machine was evaluated at last. True if a joint was held back by
    /// its speed, or the posture is singular and they stay.
    pub(crate) fn follow(&mut self, plan: &Plan, machine: &MachineState, sent: &Twist) -> bool {
        let (forward, joints) = (&machine.forward, &machine.joints);
        let pose = moved(&forward.pose, sent);
        let most = plan.settings.limits.joint_speed * plan.settings.period;
        let is_zero = *sent == Twist::zero();
        let mut held = false;
        for (index, (limb, own)) in self.limbs.iter_mut().zip(&plan.machine.limbs).enumerate() {
            limb.coordinates.copy_from_slice(forward.coordinates(index));
            for (command, joint) in limb.commands.iter_mut().zip(own.joints.clone()) {
                *command = joints[joint] + self.at[joint];
            }
            let mut found = is_zero || limb.factor(own);
            if found && !is_zero {
                for _ in 0..STEPS {
                    let tip = limb.tip(own);
                    if limb.follow(own, &pose, &tip).0 < PRECISION * own.length {
                        break;
                    }
                }
                found = limb.is_near(own, &joints[own.joints.clone()]);
            }
            held |= !found;
            for (command, joint) in limb.commands.iter().zip(own.joints.clone()) {
                let goal = match (is_zero, found) {
                    (true, _) => 0.0,
                    (_, true) => command - joints[joint],
                    (_, false) => self.at[joint],
                };
                let step = goal - self.at[joint];
                held |= step.abs() > most;
                self.at[joint] = match step.abs() > most {
                    true => self.at[joint] + most.copysign(step),
                    false => goal,
                };
            }
        }
        held
    }
}
