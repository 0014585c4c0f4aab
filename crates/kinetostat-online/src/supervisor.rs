//! The machine of states: `Shadow -> Armed -> Active -> Hold -> Ramp -> Off`, by findings and counts of cycles.
//!
//! ```text
//! Shadow  computes and sends zeros; the default         Hold   the last target stays, at most 20 ms
//! Armed   probes the correction object                  Ramp   to zero at the limits of rate
//! Active  sends corrections                             Off    zeros, until a person arms again
//! ```

use crate::probe::Verdict;

/// State of an on-line compensation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum Mode {
    /// Computes, sends zeros.
    #[default]
    Shadow,
    /// A person has armed it; the probe runs.
    Armed,
    /// Sends corrections.
    Active,
    /// Keeps the last target while inputs are missing.
    Hold,
    /// Goes to zero.
    Ramp,
    /// Sends zeros until it is armed again.
    Off,
}

/// Finding of a cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum Reason {
    /// Nothing is wrong.
    #[default]
    None,
    /// An input is not a number or not finite.
    NotFinite,
    /// The sequence number is that of the cycle before.
    SequenceRepeated,
    /// The sequence number went back.
    SequenceOld,
    /// The input is too old.
    TooOld,
    /// A joint is beyond its limits.
    JointLimit,
    /// The plan has a sensor and the input has no reading.
    SensorMissing,
    /// A force or a moment is larger than any that is believed.
    ForceCeiling,
    /// The equilibrium was not found in the passes of a cycle.
    NotConverged,
    /// The posture is singular, or the loops of the machine do not close at these joints.
    Singular,
    /// The model wants more than twice the largest correction.
    CorrectionLimit,
    /// Arming refused: the sensor has not been zeroed.
    SensorNotZeroed,
    /// Arming refused: the process stiffness is not known.
    ProcessStiffnessUnknown,
    /// The probe needs the pose that the controller commands.
    NotObserved,
    /// The probe found a correction object that adds up what it is sent.
    ProbeRelative,
    /// The probe found that corrections do not arrive.
    ProbeSilent,
    /// The operator stopped it.
    Stopped,
    /// The state belongs to another plan.
    OtherPlan,
}

impl Reason {
    /// True if the next input may be right again: the correction is held before it is given up.
    #[must_use]
    pub fn is_passing(self) -> bool {
        matches!(
            self,
            Self::SequenceRepeated
                | Self::SequenceOld
                | Self::TooOld
                | Self::SensorMissing
                | Self::NotConverged
        )
    }
}

/// Events of one cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Events {
    /// The operator armed in this cycle.
    pub arm: bool,
    /// The operator stopped in this cycle.
    pub stop: bool,
    /// Finding of the input and of the model.
    pub finding: Reason,
    /// Reason to refuse arming.
    pub refusal: Reason,
    /// Verdict of the probe, of plans with one.
    pub probe: Option<Verdict>,
    /// The correction is zero.
    pub at_zero: bool,
}

/// Mode, cause and count of held cycles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Supervisor {
    pub mode: Mode,
    pub cause: Reason,
    held: u32,
}

impl Supervisor {
    /// The next state; `most_held` cycles may pass in `Hold`.
    pub(crate) fn next(&mut self, events: &Events, most_held: u32) {
        let finding = events.finding;
        let sends = matches!(self.mode, Mode::Armed | Mode::Active | Mode::Hold);
        if events.stop && sends {
            return self.go(Mode::Ramp, Reason::Stopped);
        }
        match self.mode {
            Mode::Shadow | Mode::Off if events.arm => {
                let refusal = match finding {
                    Reason::None => events.refusal,
                    found => found,
                };
                match refusal {
                    Reason::None => self.go(Mode::Armed, Reason::None),
                    refusal => self.cause = refusal,
                }
            }
            Mode::Shadow | Mode::Off => {}
            // A probe is short, and what disturbs it makes its verdict worthless.
            Mode::Armed if finding != Reason::None => self.go(Mode::Ramp, finding),
            Mode::Armed => match events.probe {
                None | Some(Verdict::Absolute) => self.go(Mode::Active, Reason::None),
                Some(Verdict::Running) => {}
                Some(Verdict::Relative) => self.go(Mode::Ramp, Reason::ProbeRelative),
                Some(Verdict::Silent) => self.go(Mode::Ramp, Reason::ProbeSilent),
            },
            Mode::Active | Mode::Hold => match finding {
                Reason::None => self.go(Mode::Active, self.cause),
                passing if passing.is_passing() && self.held < most_held => {
                    self.mode = Mode::Hold;
                    self.cause = passing;
                    self.held += 1;
                }
                lasting => self.go(Mode::Ramp, lasting),
            },
            Mode::Ramp if events.at_zero => self.go(Mode::Off, self.cause),
            Mode::Ramp => {}
        }
    }

    fn go(&mut self, mode: Mode, cause: Reason) {
        *self = Self {
            mode,
            cause,
            held: 0,
        };
    }
}
