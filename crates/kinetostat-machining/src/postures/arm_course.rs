//! The way of an arm along a program in one go.
//!
//! Places of a program are solved in groups, each from the posture that an arm takes there from home. If an arm has several postures
//! and the program passes a singular one, that may be another posture than the one with which the arm comes along. Then the program is
//! followed from its start, posture by posture, and every place is solved next to the posture of the arm there.

use kinetostat::{Posture, PostureRequest};
use kinetostat_program::{Knowledge, Move};

use crate::joints::Arm;
use crate::task::Task;

/// Distance from one posture to the next along the path, over moves that are shorter, mm, ...
const EVERY_MM: f64 = 5.0;

/// ... and where the tool turns, deg.
const EVERY_DEG: f64 = 2.0;

/// Maximum number of postures; on longer paths they are farther apart.
const MOST: f64 = 20_000.0;

/// A posture on the way.
struct Mark {
    move_index: usize,
    share: f64,
    posture: Posture,
}

/// Postures along a program, each next to the one before.
pub(crate) struct ArmCourse {
    marks: Vec<Mark>,
}

/// Length of a move, in steps from one posture to the next.
fn steps(motion: &Move) -> f64 {
    let turn = motion.tool_turn.as_ref();
    let turned = turn.map_or(0.0, |turn| turn.start.angle_to(&turn.end).to_degrees());
    match motion.known {
        Knowledge::Whole => (motion.length_mm() / EVERY_MM).max(turned / EVERY_DEG),
        Knowledge::End | Knowledge::Nothing => 0.0,
    }
}

impl ArmCourse {
    /// Course of an arm that comes along a program in other postures than it takes from home; `None` if there is no difference,
    /// for other machines, and if it cannot be followed so.
    pub fn of(task: &Task<'_>) -> Option<Self> {
        let arm = Arm::of(task.mechanism).filter(|_| !task.placement.orientation_follows)?;
        let number = |posture: &Posture| {
            let found = arm.configuration(&posture.commands());
            found.map(|found| found.number)
        };
        let moves = &task.path().moves;
        let all: f64 = moves.iter().map(steps).sum();
        if !all.is_finite() {
            return None;
        }
        let coarser = (all / MOST).max(1.0);
        let mut marks: Vec<Mark> = Vec::new();
        let mut differs = false;
        let mut last: Option<usize> = None;
        // Since the last posture, in steps.
        let mut gone = 0.0;
        for (move_index, motion) in moves.iter().enumerate() {
            if motion.known == Knowledge::Nothing {
                continue;
            }
            let own = steps(motion) / coarser;
            let mechanism = task.mechanism_on(motion.line);
            if last.is_some_and(|line| !std::ptr::eq(task.mechanism_on(line), mechanism)) {
                // Another tool: the arm comes from anywhere.
                return None;
            }
            let is_first = last.is_none();
            last = Some(motion.line);
            let is_whole = motion.known == Knowledge::Whole;
            if is_whole && !is_first && gone + own <= 1.0 && move_index + 1 < moves.len() {
                gone += own;
                continue;
            }
            let pieces = own.ceil().max(1.0);
            let from_start = is_whole && (is_first || gone + own / pieces > 1.0);
            gone = 0.0;
            let first = u32::from(!from_start);
            for piece in first..=pieces as u32 {
                let share = match first {
                    1 if motion.known != Knowledge::Whole => 1.0,
                    _ => f64::from(piece) / pieces,
                };
                let place = task.placement.on(motion, share);
                let orientation = task.placement.orientation_on(motion, share);
                let pose = place.pose(&motion.point(share), orientation);
                let alone = mechanism.posture(&pose).ok()?;
                let posture = match marks.last() {
                    None => alone.clone(),
                    Some(before) => {
                        let near = PostureRequest::pose(&pose).near(&before.posture);
                        mechanism.posture(near).ok()?
                    }
                };
                posture.within_limits().ok()?;
                differs |= number(&posture) != number(&alone);
                marks.push(Mark {
                    move_index,
                    share,
                    posture,
                });
            }
        }
        differs.then_some(Self { marks })
    }

    /// The posture of the arm at a place, or the last one before it.
    pub fn standing_at(&self, move_index: usize, share: f64) -> Option<&Posture> {
        let at = (move_index, share);
        let after = (self.marks).partition_point(|mark| (mark.move_index, mark.share) <= at);
        let before = after.checked_sub(1).and_then(|index| self.marks.get(index));
        let found = before.or(self.marks.first());
        found.map(|mark| &mark.posture)
    }
}
