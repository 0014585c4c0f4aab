//! Blocks divided again where the last check finds the tool farther off than the written program claims.
//!
//! The division rests on an assumption about the model between the places that it evaluates ([`Course::Smooth`]); the
//! check looks at places of its own. A place that it finds off becomes one at which the block is divided in any case,
//! the program is written once more, and checked as before in every place. Places that are off for another reason (an
//! axis that the program never states, a corner) are not divided again: it would not help.
//!
//! [`Course::Smooth`]: kinetostat_program::Course::Smooth

use std::collections::BTreeMap;

use kinetostat_program::{
    Correction, CorrectionField, FieldFailure, Move, Path, Request, Structure,
};
use nalgebra::Vector3;

use crate::field::ModelField;
use crate::number::largest_length;
use crate::result::point::{PointKind, PointResult, size};
use crate::warning::{Warning, WarningCode};

/// Rounds of dividing again, at most. Each halves what is left at a kink of the correction, at least.
const ROUNDS: usize = 8;

/// Additional divisions of blocks.
#[derive(Debug, Default)]
pub(crate) struct Again {
    /// Shares by move at which blocks are divided besides those that the field itself knows.
    breaks: BTreeMap<usize, Vec<f64>>,
    rounds: usize,
    /// Line of the worst place that was found, and how far the tool was off there, mm.
    worst: Option<(usize, f64)>,
}

/// A model's field that is to be evaluated in some more places.
pub(crate) struct Refined<'a> {
    field: &'a ModelField<'a>,
    breaks: &'a BTreeMap<usize, Vec<f64>>,
}

impl CorrectionField for Refined<'_> {
    fn turns_tool(&self) -> bool {
        self.field.turns_tool()
    }

    fn corrections(&self, requests: &[Request]) -> Vec<Result<Correction, FieldFailure>> {
        self.field.corrections(requests)
    }

    fn turns(&self) -> bool {
        self.field.turns()
    }

    fn structure(&self, move_index: usize, motion: &Move) -> Structure {
        let mut own = self.field.structure(move_index, motion);
        own.breaks
            .extend(self.breaks.get(&move_index).into_iter().flatten());
        own
    }
}

impl Again {
    pub fn field<'a>(&'a self, field: &'a ModelField<'a>) -> Refined<'a> {
        Refined {
            field,
            breaks: &self.breaks,
        }
    }

    /// Takes the places of a written program that are off and would not be if they were ends of pieces;
    /// whether there are any, and a round left for them.
    pub fn divides(
        &mut self,
        path: &Path,
        field: &ModelField<'_>,
        points: &[PointResult],
        allowed_mm: f64,
    ) -> bool {
        if self.rounds == ROUNDS {
            return false;
        }
        let off: Vec<(Request, &PointResult)> = points
            .iter()
            .filter(|p| p.kind == PointKind::Feed && size(&p.error_after_mm) > allowed_mm)
            .filter_map(|p| Some((inside(path, p)?, p)))
            .collect();
        let answers = field.corrections(&off.iter().map(|(r, _)| *r).collect::<Vec<_>>());
        let mut found = false;
        for ((request, point), answer) in off.into_iter().zip(answers) {
            let Ok(answer) = answer else { continue };
            let mut missing = answer.shift_mm - Vector3::from(point.correction_mm);
            for axis in (0..3).filter(|axis| !path.stated[*axis]) {
                missing[axis] = 0.0;
            }
            let breaks = self.breaks.entry(request.move_index).or_default();
            if missing.norm() <= allowed_mm || breaks.contains(&request.share) {
                continue;
            }
            breaks.push(request.share);
            found = true;
            let error = size(&point.error_after_mm);
            if self.worst.is_none_or(|(_, most)| error > most) {
                self.worst = Some((point.line, error));
            }
        }
        self.rounds += usize::from(found);
        found
    }

    /// Warning about the additional divisions.
    pub fn description(&self, allowed_mm: f64) -> Option<Warning> {
        let (line, worst) = self.worst?;
        let places: usize = self.breaks.values().map(Vec::len).sum();
        let blocks = self.breaks.values().filter(|list| !list.is_empty()).count();
        let many = |count: usize, what: &str| match count {
            1 => format!("1 {what}"),
            _ => format!("{count} {what}s"),
        };
        Some(Warning::at_line(
            WarningCode::DividedAgain,
            line,
            format!(
                "the check of the written program found the tool up to {} off at {}, beyond the {} that are allowed: {} divided again there, in {}, because the correction changes faster than the size of the machine lets expect",
                largest_length(worst),
                many(places, "place"),
                largest_length(allowed_mm),
                match blocks {
                    1 => "1 block was".to_owned(),
                    _ => format!("{blocks} blocks were"),
                },
                many(self.rounds, "round"),
            ),
        ))
    }
}

/// The place of a point inside a block that can be divided.
fn inside(path: &Path, point: &PointResult) -> Option<Request> {
    let move_index = point.move_index;
    let motion = path.moves.get(move_index)?;
    let divided = motion.is_known_feed();
    (divided && point.share > 0.0 && point.share < 1.0).then(|| Request {
        move_index,
        share: point.share,
        position_mm: motion.point(point.share),
        tangent: motion.tangent(point.share),
        orientation: motion.orientation(point.share),
        turning: None,
    })
}
