//! Directions of the tool in place of angles: G43.5 with I, J and K (tool centre point control, type 2, of Fanuc).
//!
//! A vector in axes of the part, from the tip to the holder, says how the tool stands at the end of a straight move; one or two letters
//! that are missing are zero, and without all three the tool stays. The control turns the rotary axes the shorter way: evenly (P0, or no P
//! where the control's parameter 19604#0 leaves it so), or with its tool posture control (P1) so that the tool's axis stays in the plane of
//! both directions. (FANUC 30i-A, Tool center point control for 5-axis machining, A-79348E; Tool posture control, A-79294E.)

use nalgebra::Vector3;

use crate::error::{ProgramError, ProgramErrorKind};
use crate::path::great_circle::{GreatCircle, OffCircle};
use crate::path::moves::{Motion, MoveKind};
use crate::path::rotary::RotaryAxes;
use crate::path::rotary_angles::Unreached;
use crate::path::tool_turn::ToolTurn;
use crate::reading::block::Block;
use crate::reading::modes::{DirectionLaw, Modes};
use crate::reading::rotary::RotaryWords;

/// Vectors shorter than this say no direction.
const SHORTEST: f64 = 1e-6;

/// True if a block has a word of a direction.
pub(crate) fn states_direction(block: &Block<'_>) -> bool {
    b"IJK".iter().any(|letter| block.value(*letter).is_some())
}

/// A turn whose axis goes on a great circle.
pub(crate) fn with_circle(mut turn: Box<ToolTurn>, circle: Option<GreatCircle>) -> Box<ToolTurn> {
    if let (Some(rotary), Some(circle)) = (&mut turn.rotary, circle) {
        rotary.start_deg = circle.start_deg().to_vec();
        rotary.great_circle = Some(circle);
        return Box::new(ToolTurn::rotary(rotary.clone()));
    }
    turn
}

/// A fault of a block, at one of its words.
fn refused(block: &Block<'_>, word: u8, reason: &str, remedy: &str) -> ProgramError {
    block.refuse(
        ProgramErrorKind::Ambiguous,
        block.word(word),
        reason,
        remedy,
    )
}

impl RotaryWords<'_> {
    /// Interpolation between directions that the block of a G43.4 or G43.5 states; `None` for G43.4.
    pub fn law_of_directions(
        self,
        block: &Block<'_>,
        modes: &Modes,
    ) -> Result<Option<DirectionLaw>, ProgramError> {
        let refuse = |word, reason: &str, remedy: &str| Err(refused(block, word, reason, remedy));
        let law = match block.value(b'P') {
            None => DirectionLaw::Evenly,
            Some(0.0) => DirectionLaw::Evenly,
            Some(1.0) => DirectionLaw::GreatCircle,
            Some(_) => {
                return refuse(
                    b'P',
                    "P of tool centre point control is 0 or 1",
                    "write P0 (rotary axes turn evenly) or P1 (tool posture control)",
                );
            }
        };
        if !block.codes.by_direction {
            return match law {
                DirectionLaw::Evenly => Ok(None),
                DirectionLaw::GreatCircle => refuse(
                    b'P',
                    "G43.4 P1 (tool posture control): between two blocks the rotary axes do not turn evenly, and the pieces of a block would need other angles",
                    "write G43.4 without P, or directions of the tool (G43.5 P1 with I, J, K)",
                ),
            };
        }
        let Some(axes) = self.axes() else {
            return refuse(
                b'G',
                "G43.5 (directions of the tool, I J K): a program with it is not written flat",
                "leave out --expand where the program has no loops, variables, subprograms and cycles; or let the CAM system write it without them, or with angles (G43.4)",
            );
        };
        if axes.axes.len() > 2 {
            return refuse(
                b'G',
                "G43.5 (directions of the tool, I J K) on a machine with more than two rotary axes: many angles give one direction",
                "let the CAM system write angles (G43.4)",
            );
        }
        if states_direction(block) {
            return refuse(
                b'I',
                "a direction stands in the block of G43.5: controls of machines with tables refuse it there",
                "write I, J and K in the block behind it",
            );
        }
        let mut both = axes.axes.iter().zip(self.angles(modes));
        match both.find(|(_, angle)| angle.is_none()) {
            None => Ok(Some(law)),
            Some((axis, _)) => refuse(
                b'G',
                &format!(
                    "where axis {} stands is not stated before G43.5: two sets of angles point the tool in one direction, and the control takes the nearer one",
                    axis.letter
                ),
                &format!(
                    "state it with a rapid and an absolute word (G0 {}0) before it",
                    axis.letter
                ),
            ),
        }
    }

    /// An angle by which the tool leans from how it is stated otherwise, in any block under tool centre point control.
    pub fn refuse_lean(self, block: &Block<'_>, modes: &Modes) -> Result<(), ProgramError> {
        let leans = block.value(b'Q').is_some_and(|angle| angle != 0.0);
        match leans && modes.tool_centre_point {
            false => Ok(()),
            true => Err(refused(
                block,
                b'Q',
                "Q leans the tool from the direction that is stated",
                "let the CAM system write the direction of the tool itself, without Q",
            )),
        }
    }

    /// Turns the axes as I, J and K say; the great circle on which the tool's axis goes there, if it does.
    pub fn take_direction(
        self,
        block: &Block<'_>,
        kind: MoveKind,
        motion: Motion,
        modes: &mut Modes,
    ) -> Result<Option<GreatCircle>, ProgramError> {
        let (Some(law), Some(axes)) = (modes.directions, self.axes()) else {
            return Ok(None);
        };
        // Consequences of a refused G43.5 are not reported again.
        if modes.axes_in_doubt {
            return Ok(None);
        }
        let refuse = |word, reason: &str, remedy: &str| Err(refused(block, word, reason, remedy));
        if matches!(motion, Motion::Clockwise | Motion::CounterClockwise) {
            return refuse(
                b'G',
                "an arc under G43.5, where I, J and K are the direction of the tool",
                "let the CAM system write straight moves, or angles (G43.4)",
            );
        }
        let of_axis =
            |axis: &&crate::path::rotary::RotaryAxis| block.value(axis.letter as u8).is_some();
        if let Some(axis) = axes.axes.iter().find(of_axis) {
            return refuse(
                axis.letter as u8,
                &format!(
                    "the angle of axis {} under G43.5, where I, J and K say how the tool stands",
                    axis.letter
                ),
                "write I, J and K, or angles behind G43.4",
            );
        }
        if !states_direction(block) {
            return Ok(None);
        }
        let parts = b"IJK".map(|letter| block.value(letter).unwrap_or(0.0));
        let Some(direction) = Vector3::from(parts).try_normalize(SHORTEST) else {
            return refuse(
                b'I',
                "the direction I, J, K has no length",
                "write a vector from the tip of the tool to its holder, such as K1",
            );
        };
        let standing: Option<Vec<f64>> = self.angles(modes).into_iter().collect();
        let Some(standing) = standing else {
            return refuse(
                b'I',
                "where the rotary axes stand is not known here: a block before it went to a place of the machine",
                "end G43.5 (G49), state all rotary axes with a rapid, and begin it again",
            );
        };
        let found = match law {
            DirectionLaw::GreatCircle => GreatCircle::new(axes, &standing, &direction)
                .map(|circle| (circle.end_deg().to_vec(), Some(circle))),
            DirectionLaw::Evenly => axes
                .angles_towards(&direction, &standing)
                .map(|angles| (angles, None))
                .map_err(|reason| OffCircle::Unreached(direction, reason)),
        };
        // In air the axes may go over to other angles.
        let found = match found {
            Err(_) if kind == MoveKind::Rapid => axes
                .angles_towards(&direction, &standing)
                .map(|angles| (angles, None))
                .map_err(|reason| OffCircle::Unreached(direction, reason)),
            found => found,
        };
        match found {
            Ok((angles, circle)) => {
                for (axis, angle) in axes.axes.iter().zip(angles) {
                    modes.extra.turn_to(axis.letter, angle);
                }
                Ok(circle)
            }
            Err(reason) => {
                let (reason, remedy) = why_unreached(axes, &direction, &reason);
                refuse(b'I', &reason, remedy)
            }
        }
    }
}

/// Reason for which a direction is not reached, and remedy.
fn why_unreached(
    axes: &RotaryAxes,
    end: &Vector3<f64>,
    reason: &OffCircle,
) -> (String, &'static str) {
    match reason {
        OffCircle::Opposite => (
            "the tool turns to its opposite here, and over which side it goes is not stated"
                .to_owned(),
            "let the CAM system write a direction between",
        ),
        OffCircle::Unreached(at, Unreached::Direction) => (
            format!(
                "the rotary axes of the machine do not point the tool along ({:.4}, {:.4}, {:.4})",
                at.x, at.y, at.z
            ),
            "check directions and words of the axes in the model ([[rotary_axis]])",
        ),
        OffCircle::Unreached(at, Unreached::Limits(angles)) => (
            format!(
                "{} the direction ({:.4}, {:.4}, {:.4}) {}",
                match (at - end).norm() > SHORTEST {
                    true => "on the way to",
                    false => "to point the tool along",
                },
                end.x,
                end.y,
                end.z,
                axes.words_of_limits(angles)
            ),
            "let the CAM system tilt the tool less, or turn the axes over in a rapid; or state other limits of the axis, if it has them (limits_deg of [[rotary_axis]], or of its joint)",
        ),
    }
}
