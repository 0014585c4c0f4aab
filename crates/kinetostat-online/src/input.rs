//! Input and output of one cycle: plain numbers in arrays of fixed length.

use kinetostat::spatial::{Twist, Wrench};

use crate::supervisor::{Mode, Reason};

/// Joints of a machine at most.
pub const MOST_JOINTS: usize = 16;

/// Command of the operator. A command counts in the cycle in which it appears; a level that stays is one command.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum Command {
    /// Nothing new.
    #[default]
    None,
    /// Arms, and after `Off` arms again: a person is there.
    Arm,
    /// Ramps to zero.
    Stop,
    /// Averages the sensor's offset; the tool is in air, nothing is sent.
    ZeroSensor,
}

/// Input of one cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Input {
    /// Joints as the program commands them, m or rad, WITHOUT the correction: a controller that reports positions which
    /// contain it needs a port that subtracts it, else there is a second feedback path.
    pub joints: [f64; MOST_JOINTS],
    /// Measured wrench: what environment and weight apply to the body beyond the sensor; sensor axes, about its origin.
    pub measured: Option<Wrench>,
    /// Wrench that the program expects here: what the environment applies to the tool, base axes, about the tool's point.
    pub programmed: Wrench,
    /// Age of these numbers, s.
    pub age: f64,
    /// Number of the packet or cycle; larger than the one before.
    pub sequence: u64,
    /// Position of the controller's commanded tool less that of the program, base axes, m: what the probe looks at.
    pub observed: Option<[f64; 3]>,
    /// Command of the operator.
    pub command: Command,
}

/// Limits that held the correction back in a cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Clamped {
    /// Size of the position's correction.
    pub position: bool,
    /// Size of the rotation's correction.
    pub rotation: bool,
    /// Speed or acceleration: the correction has not arrived at what is wanted.
    pub rate: bool,
    /// Speed of a joint.
    pub joints: bool,
    /// Gain of the measured force in some direction, for a loop gain of 0.7.
    pub gain: bool,
}

/// Output of one cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Output {
    /// Correction to send: the motion from the pose that the program commands to the pose that the controller shall command.
    /// Linear part in m at the tool's reference point, angular part the rotation vector in rad, both in base axes. It points against the
    /// deflection. Zero in `Shadow` and `Off`.
    pub correction: Twist,
    /// Correction as a change of the joints (m or rad), the first ones of the array.
    pub joints: [f64; MOST_JOINTS],
    /// The correction that the model wants, before clamps and limits of rate; also in `Shadow`.
    pub wanted: Twist,
    /// Deflection that remains under the model's correction, in directions without actuators.
    pub left_over: Twist,
    /// State of the machine of states.
    pub mode: Mode,
    /// Reason of the last fall to `Hold`, `Ramp` or `Off`, or of a refused command.
    pub cause: Reason,
    /// Finding of this cycle.
    pub finding: Reason,
    /// Limits that held the correction back.
    pub clamped: Clamped,
    /// Passes of the equilibrium.
    pub passes: u32,
    /// Largest static loop gain before the gain rule; zero without a sensor or a process stiffness.
    pub loop_gain: f64,
    /// Cycles without convergence since the start.
    pub unconverged: u64,
    /// Sequence numbers that were left out since the start.
    pub lost: u64,
}
