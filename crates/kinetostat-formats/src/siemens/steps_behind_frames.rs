//! Steps (G91, IC) behind a frame: whether the machine goes the offset of the frame with them, is a setting.
//!
//! Source: Siemens, SINUMERIK 840D sl / 828D, programming manual, fundamentals, "Incremental dimensions (G91, IC)": with SD42440
//! $SC_FRAME_OFFSET_INCR_PROG = 0 the first step of an axis behind a frame change is gone alone; with 1 the offset of the frame as well.

use crate::model::program::Finding;
use crate::siemens::walker::Reader;
use crate::siemens::words::Words;
use crate::text::line_words::in_words;

/// Shift of a frame that is none, mm.
const NO_SHIFT_MM: f64 = 1e-9;

impl Reader<'_> {
    /// A frame takes the place of another one: by how much its zero is elsewhere along each of its axes.
    pub(crate) fn note_shift(&mut self, shift_mm: [f64; 3]) {
        for (open, shift) in self.state.shifted.iter_mut().zip(shift_mm) {
            *open |= shift.abs() > NO_SHIFT_MM;
        }
    }

    /// Notes a motion that steps along an axis which no place was stated of since its frame was shifted.
    pub(crate) fn note_steps(&mut self, words: &Words) {
        for (axis, word) in words.axes.iter().enumerate() {
            let Some(word) = word else {
                continue;
            };
            if std::mem::take(&mut self.state.shifted[axis]) && word.step {
                let line = self.file.line_of(word.word.start);
                self.out.steps_behind_frames.push(line);
            }
        }
    }
}

/// What is said of the lines of a file, at the first.
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
            "a step (G91, IC) is the first word of its axis behind a frame (TRANS, ATRANS, ROT, AROT), and how far the machine goes is a setting, SD42440 $SC_FRAME_OFFSET_INCR_PROG. With 0 it goes the step alone: this is what is taken here (the example in Siemens' programming manual sets it to 0 explicitly). With 1 it goes the step and the offset of the frame: then all places from here to the next absolute one are elsewhere by that offset. Check the setting, or write an absolute place behind the frame{further}"
        ),
    })
}
