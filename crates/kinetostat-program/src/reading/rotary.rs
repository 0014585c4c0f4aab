//! Words of rotary axes that the machine's model knows: how they turn tool and part, and whether places are those of the tool's tip.

use crate::error::{ProgramError, ProgramErrorKind};
use crate::path::moves::{Feed, FeedMode, Move, MoveKind};
use crate::path::rotary::RotaryAxes;
use crate::path::tool_turn::{RotaryTurn, StatedBy, ToolTurn};
use crate::reading::block::Block;
use crate::reading::modes::Modes;
use crate::reading::options::{OtherAxes, ReadOptions, ToolCentrePoint};
use crate::reading::places::{Cause, Places};

/// Angles below this are zero, deg.
const ZERO_DEG: f64 = 1e-9;

/// Interpretation of the words of rotary axes.
#[derive(Clone, Copy)]
pub(crate) struct RotaryWords<'o> {
    options: &'o ReadOptions,
}

impl<'o> RotaryWords<'o> {
    pub fn new(options: &'o ReadOptions) -> Self {
        Self { options }
    }

    /// Angles of the rotary axes, deg, as far as the program states them.
    pub fn angles(self, modes: &Modes) -> Vec<Option<f64>> {
        let axes = self.options.rotary.iter().flat_map(|rotary| &rotary.axes);
        axes.map(|axis| modes.extra.angle_deg(axis.letter))
            .collect()
    }

    /// True if a word is that of a rotary axis of the machine, or may be.
    pub fn is_counted(self, letter: u8) -> bool {
        let mut axes = self.options.rotary.iter().flat_map(|rotary| &rotary.axes);
        self.options.other_axes == OtherAxes::Carried
            || axes.any(|axis| axis.letter == char::from(letter))
    }

    pub fn axes(self) -> Option<&'o RotaryAxes> {
        self.options.rotary.as_deref()
    }

    /// G43.4, G43.5 and G49.
    pub fn set_tool_centre_point(
        self,
        block: &Block<'_>,
        modes: &mut Modes,
    ) -> Result<(), ProgramError> {
        if block.codes.tool_centre_point {
            if self.options.rotary.is_none() && self.options.other_axes != OtherAxes::Carried {
                let code = match block.codes.by_direction {
                    true => "G43.5",
                    false => "G43.4",
                };
                return Err(block.refuse(
                    ProgramErrorKind::UnknownCode,
                    None,
                    &format!("{code} (tool length offset with tool point control): it changes where the tool point goes with rotary axes, and the machine's model has none"),
                    "use G43 H with a Z word, or describe the rotary axes in the model ([[rotary_axis]])",
                ));
            }
            modes.tool_centre_point = true;
            modes.axes_in_doubt = false;
        } else if block.codes.tool_length == Some(490) {
            modes.axes_in_doubt = false;
            modes.tool_centre_point = self.options.tool_centre_point == ToolCentrePoint::Throughout;
            modes.directions = None;
        }
        if block.codes.position_offset.is_some()
            && let Some(word) = self.rotary_word(block)
        {
            return Err(block.refuse(
                ProgramErrorKind::Ambiguous,
                block.word(word),
                "G92 gives a rotary axis another angle than the machine's",
                "state the angles that the axes have, and set their zeros at the machine",
            ));
        }
        Ok(())
    }

    /// The first rotary axis of which the block has a word.
    fn rotary_word(self, block: &Block<'_>) -> Option<u8> {
        let axes = self.options.rotary.iter().flat_map(|rotary| &rotary.axes);
        let mut letters = axes.map(|axis| axis.letter as u8);
        letters.find(|letter| block.value(*letter).is_some())
    }

    /// Orientation of the tool in a move, after its words were read; `before` are the angles before them. Places that are not those of
    /// the tip in the part are lost.
    pub fn turn_of_move(
        self,
        block: &Block<'_>,
        kind: MoveKind,
        before: &[Option<f64>],
        modes: &Modes,
        places: &mut Places,
    ) -> Result<Option<Box<ToolTurn>>, ProgramError> {
        let Some(axes) = self.options.rotary.clone().filter(|_| !modes.axes_in_doubt) else {
            return Ok(None);
        };
        let after = self.angles(modes);
        if before != after || self.rotary_word(block).is_some() {
            places.turned_on = block.line_number;
        }
        let turned = self.turned(&after).or(self.turned(before)).is_some();
        if kind == MoveKind::Feed {
            self.refuse_cut_at_angles(block, modes, &after)?;
            if !modes.tool_centre_point {
                self.refuse_cut_at_angles(block, modes, before)?;
            }
        }
        let tip = modes.tool_centre_point;
        let unknown = after.contains(&None);
        if (tip && unknown) || (!tip && turned) {
            for axis in 0..3 {
                places.lose(axis, Cause::Rotary, places.turned_on);
            }
        }
        if !tip || unknown {
            return Ok(None);
        }
        let end_deg: Vec<f64> = after.iter().flatten().copied().collect();
        let start = before.iter().zip(&end_deg);
        let origin_deg = axes
            .axes
            .iter()
            .map(|axis| modes.extra.origin_deg(axis.letter));
        let turn = RotaryTurn {
            origin_deg: origin_deg.collect(),
            axes: axes.clone(),
            start_deg: start.map(|(start, end)| start.unwrap_or(*end)).collect(),
            end_deg,
            great_circle: None,
            stated: match modes.directions {
                Some(_) => StatedBy::Direction,
                None => StatedBy::Angles,
            },
        };
        Ok(Some(Box::new(ToolTurn::rotary(turn))))
    }

    /// A turn in place has a feed in degrees or in time.
    pub fn refuse_turn_per_revolution(
        self,
        block: &Block<'_>,
        motion: &Move,
    ) -> Result<(), ProgramError> {
        let per_revolution = |feed: Feed| feed.mode == FeedMode::PerRevolution;
        if motion.kind == MoveKind::Feed
            && motion.feed.is_some_and(per_revolution)
            && motion.turns_in_place()
        {
            return Err(block.refuse(
                ProgramErrorKind::Ambiguous,
                None,
                "rotary axes turn alone with a feed per revolution of the spindle (G95): how fast is not known",
                "write G94 and F in degrees a minute, or G93 and F in blocks a minute, before it",
            ));
        }
        Ok(())
    }

    /// The first axis that stands at an angle.
    fn turned(self, angles: &[Option<f64>]) -> Option<(char, f64)> {
        let axes = self.options.rotary.iter().flat_map(|rotary| &rotary.axes);
        let mut both = axes.zip(angles);
        both.find_map(|(axis, angle)| Some((axis.letter, angle.filter(|a| a.abs() > ZERO_DEG)?)))
    }

    /// A cut is where the program says only with axes of known angles and places of the tip, or with all axes at zero.
    pub fn refuse_cut_at_angles(
        self,
        block: &Block<'_>,
        modes: &Modes,
        angles: &[Option<f64>],
    ) -> Result<(), ProgramError> {
        if modes.axes_in_doubt {
            return Ok(());
        }
        let axes = self.options.rotary.iter().flat_map(|rotary| &rotary.axes);
        let unknown = axes.zip(angles).find(|(_, angle)| angle.is_none());
        let mut axes = self.options.rotary.iter().flat_map(|rotary| &rotary.axes);
        let away = axes.find(|axis| modes.extra.is_elsewhere(axis.letter));
        if let (false, Some(axis)) = (modes.tool_centre_point, away) {
            return Err(block.refuse(
                ProgramErrorKind::Ambiguous,
                None,
                &format!(
                    "axis {} was sent to a place of the machine (G53), and tool centre point control is off: where the tip is in the part is not known",
                    axis.letter
                ),
                &format!("turn it back with an absolute word (G0 {}0) before the cut, or let the CAM system write places of the tool's tip in the part (G43.4)", axis.letter),
            ));
        }
        match (modes.tool_centre_point, unknown, self.turned(angles)) {
            (true, Some((axis, _)), _) => Err(block.refuse(
                ProgramErrorKind::Ambiguous,
                None,
                &format!("where axis {} stands is not stated before this block cuts", axis.letter),
                &format!("state it with a rapid and an absolute word (G0 {}0) before it", axis.letter),
            )),
            (false, _, Some((letter, angle))) => Err(block.refuse(
                ProgramErrorKind::Ambiguous,
                None,
                &format!(
                    "axis {letter} stands at {angle} deg, and tool centre point control is off: X, Y and Z are places of the machine's slides"
                ),
                "let the CAM system write places of the tool's tip in the part (G43.4), or where the controller has that on all along, say so: --tool-centre-point, or tool_centre_point = true under [reading] in the job file",
            )),
            _ => Ok(()),
        }
    }
}
