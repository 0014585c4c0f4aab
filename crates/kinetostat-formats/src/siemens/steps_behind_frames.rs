//! Steps (G91, IC) behind a frame: whether the machine goes the offset of the frame with them, is a setting.
//!
//! With SD42440 $SC_FRAME_OFFSET_INCR_PROG = 0 the first step of an axis behind a frame change is gone alone; with 1 the offset of the frame
//! as well. That controls come with 1, and so it is taken here: a step adds to the number of its axis. Siemens' manuals (programming manual
//! "Fundamentals", G91 and IC; list manual, setting data) were not at hand. The source is published code: CEAD's open interpreter of
//! SINUMERIK programs, which quotes the setting's name, its factory default TRUE and "changes to work offsets are traversed after a frame
//! change". Of frames that are turned it says nothing, and neither is said here.

use crate::siemens::state::{Counted, NO_SHIFT_MM};
use crate::siemens::walker::Reader;
use crate::siemens::words::Words;
use crate::text::number::in_words;
use crate::text::source::Finding;

/// Turn of a frame that is none, rad.
const NO_TURN: f64 = 1e-9;

/// Reason why the end of a step is unknown.
const TURNED: &str = "a step (G91, IC) is the first word of its axis behind a frame that is turned otherwise (ROT, AROT), and from where the machine counts it is not documented";
const ON_ARC: &str = "a step (G91, IC) of an arc is the first word of its axis behind a frame (TRANS, ATRANS), and whether the machine goes the offset of the frame with it is a setting (SD42440 $SC_FRAME_OFFSET_INCR_PROG)";

impl Reader<'_> {
    /// Reference values of the steps of a motion: the numbers of the axes' last words.
    ///
    /// # Errors
    /// Why that is not known, and of which axes.
    pub(crate) fn steps_from(
        &mut self,
        words: &Words,
    ) -> Result<[Option<f64>; 3], (&'static str, [bool; 3])> {
        let mut from = self.state.place;
        let mut unknown = [false; 3];
        let mut reason = TURNED;
        for (axis, word) in words.axes.iter().enumerate() {
            let (Some(word), Some(counted), Some(place)) =
                (word, self.state.counted[axis], from[axis])
            else {
                continue;
            };
            if !word.step || (counted.number_mm - place).abs() <= NO_SHIFT_MM {
                continue;
            }
            let turn = counted.turn.angle_to(&self.state.frame.rotation);
            if turn > NO_TURN || self.state.code.is_arc() {
                unknown[axis] = true;
                if turn <= NO_TURN {
                    reason = ON_ARC;
                }
                continue;
            }
            from[axis] = Some(counted.number_mm);
            let line = self.file.line_of(word.word.start);
            self.out.steps_behind_frames.push(line);
        }
        match unknown.contains(&true) {
            true => Err((reason, unknown)),
            false => Ok(from),
        }
    }

    /// A motion ends: steps count from there, but along axes that no word was of.
    pub(crate) fn count_from(&mut self, words: &Words, end: [Option<f64>; 3]) {
        let state = &mut self.state;
        for axis in 0..3 {
            let stays = words.axes[axis].is_none() && end[axis] == state.place[axis];
            if stays && state.counted[axis].is_some() && end[axis].is_some() {
                continue;
            }
            state.counted[axis] = end[axis].map(|number_mm| Counted {
                number_mm,
                turn: state.frame.rotation,
            });
        }
    }
}

/// Finding on the steps in these lines of a file, at the first of them.
pub(crate) fn finding_of_steps(file: usize, lines: &[usize]) -> Option<Finding> {
    let mut lines = lines.to_vec();
    lines.sort_unstable();
    lines.dedup();
    let first = *lines.first()?;
    let further = match lines.len() {
        1 => String::new(),
        _ => format!(" ({})", in_words(&lines)),
    };
    Some(Finding {
        file,
        line: first,
        message: format!(
            "a step (G91, IC) is the first word of its axis behind a frame (TRANS, ATRANS, ROT, AROT), and how far the machine goes is a setting, SD42440 $SC_FRAME_OFFSET_INCR_PROG. With 1 it goes the step and the offset of the frame: controls come with it as far as is known here, and it is what is taken. With 0 it goes the step alone: then all places from here to the next absolute one are elsewhere by that offset. Check the setting, or write an absolute place behind the frame{further}"
        ),
    })
}
