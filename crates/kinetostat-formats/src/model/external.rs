//! External axes from one motion to the next.
//!
//! A motion takes its external axes along evenly: at a share of the way they have gone that share of theirs.

use crate::error::ProgramError;
use crate::model::Language;
use crate::model::motion::Motion;
use crate::model::program::RobotProgram;
use crate::model::target::Target;
use crate::text::source::SourceFile;

/// An external axis that is elsewhere at the end of a motion than at its start.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct AxisWay {
    /// Counted from 0.
    pub axis: usize,
    /// Start of the axis; `None` if the text does not state it.
    pub start: Option<f64>,
    pub end: f64,
}

impl AxisWay {
    /// Position of the axis at a fraction of the path.
    pub(crate) fn at(&self, start: f64, share: f64) -> f64 {
        start + share * (self.end - start)
    }
}

/// The external axes that move, or may, with each motion.
pub(crate) fn ways_of_external_axes(program: &RobotProgram) -> Vec<Vec<AxisWay>> {
    let mut behind: Vec<Vec<Option<f64>>> = Vec::with_capacity(program.motions.len());
    let mut ways = Vec::with_capacity(program.motions.len());
    for motion in &program.motions {
        let before = (motion.follows)
            .filter(|from| !moved_behind(program, *from))
            .and_then(|from| behind.get(from));
        let mut now = before.cloned().unwrap_or_default();
        let stated = &motion.site.external;
        // Positions of TP programs state all groups that there are: others say nothing of these.
        if program.language.states_all_axes() && now.len() != stated.len() {
            now.clear();
        }
        now.resize(now.len().max(stated.len()), None);
        let mut own = Vec::new();
        for (axis, (now, end)) in now.iter_mut().zip(stated).enumerate() {
            if let Some(end) = *end {
                let start = now.replace(end);
                if start != Some(end) {
                    own.push(AxisWay { axis, start, end });
                }
            }
        }
        if matches!(motion.target, Target::Unknown { .. }) {
            now.clear();
        }
        behind.push(now);
        ways.push(own);
    }
    ways
}

fn moved_behind(program: &RobotProgram, motion: usize) -> bool {
    let motion = program.motions.get(motion);
    motion.is_none_or(|motion| motion.site.external_moved_behind)
}

/// The first motion at which an external axis is elsewhere than at the motions before it.
pub(crate) fn moving_axis(
    files: &[SourceFile],
    motions: &[Motion],
    language: Language,
) -> Option<ProgramError> {
    let mut known: Vec<Option<f64>> = Vec::new();
    // A pose before does not state the axis: where it stands there is not known. Positions of TP programs state all that there is.
    let may_be_open = !language.states_all_axes();
    let mut has_pose = false;
    for motion in motions {
        let external = &motion.site.external;
        known.resize(known.len().max(external.len()), None);
        for (axis, value) in external.iter().enumerate() {
            let (what, remedy) = match (known[axis], value) {
                (None, Some(value)) if may_be_open && has_pose && *value != 0.0 => (
                    format!("goes to {value}, and the poses before do not state it"),
                    "state it in all poses, or read with external axes carried if they do not move the arm or the part",
                ),
                (None, Some(_)) => {
                    known[axis] = *value;
                    continue;
                }
                (Some(before), Some(value)) if before != *value => (
                    format!("moves from {before} to {value}"),
                    "read with external axes carried if they do not move the arm or the part",
                ),
                _ => continue,
            };
            return Some(ProgramError::at(
                &files[motion.file],
                motion.span.clone(),
                format!(
                    "{} {what}: the arm stands elsewhere then",
                    language.name_of_external_axis(axis)
                ),
                remedy,
            ));
        }
        has_pose |= motion.target.pose().is_some();
    }
    None
}
