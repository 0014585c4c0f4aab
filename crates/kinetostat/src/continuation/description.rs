//! Descriptions of special points and ends of curves, in sentences for people.

use crate::continuation::curve::{BranchEnd, Special, SpecialKind};
use crate::continuation::curve_equilibrium::CurveEquilibrium;

impl BranchEnd {
    /// Reason why the branch ends.
    #[must_use]
    pub fn description(self) -> &'static str {
        match self {
            Self::Range => "leaves the range",
            Self::Angle => "a joint or a machine's tool has turned about half a turn",
            Self::Points => "as many points as allowed",
            Self::Closed => "comes back to where it started",
            Self::Lost => "no further point was found",
            Self::Stalled => "ever shorter steps made no progress",
            Self::Found => "what was looked for was found",
        }
    }

    /// True if nothing that was requested ends the branch there: it may continue.
    #[must_use]
    pub fn may_go_on(self) -> bool {
        matches!(self, Self::Points | Self::Lost | Self::Stalled)
    }
}

impl<E: CurveEquilibrium> Special<E> {
    /// True if stability ends here: under a dead load, under prescribed motion.
    #[must_use]
    pub fn ends_stability(&self) -> [bool; 2] {
        if !self.stable_side {
            return [false; 2];
        }
        match self.kind {
            SpecialKind::LoadLimit => [true, false],
            SpecialKind::DisplacementLimit => [false, true],
            // The stability of the point itself is a matter of rounding: it is at the limit of what holds.
            _ => [self.point.slope >= 0.0, true],
        }
    }

    /// Describes the event here; `subject` is the owner of the curve: "chain" or "machine".
    #[must_use]
    pub fn description(&self, subject: &str) -> String {
        let text = match self.kind {
            SpecialKind::LoadLimit if self.stable_side => {
                format!("the load has its extreme here: under a dead load the {subject} snaps")
            }
            SpecialKind::DisplacementLimit if self.stable_side => format!(
                "the motion has its extreme here: under prescribed motion the {subject} snaps"
            ),
            SpecialKind::LoadLimit => "extreme of the load".to_owned(),
            SpecialKind::DisplacementLimit => "extreme of the motion".to_owned(),
            SpecialKind::Pitchfork if self.stable_side => {
                format!("pitchfork: the {subject} buckles to one side or the other")
            }
            SpecialKind::Pitchfork => "pitchfork: two mirrored shapes branch off".to_owned(),
            SpecialKind::Transcritical => "two branches cross and both go on".to_owned(),
            SpecialKind::StabilityChange => {
                "stability changes here in a limb or a platform that moves while the tool stands still".to_owned()
            }
            SpecialKind::Multiple { modes } => format!("{modes} modes become critical together"),
        };
        match self.stable_side {
            true => text,
            false => format!("{text}, on a part of the curve that is unstable anyway"),
        }
    }
}
