//! Moves in the words of the modes in force.

use crate::expanding::number::number;
use crate::reading::interpreting::interpreter::Interpreter;

const LETTERS: [char; 3] = ['X', 'Y', 'Z'];

/// Tool position in program coordinates, as far as it is known, and the distance mode for writing places.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Place {
    pub at: [Option<f64>; 3],
    pub incremental: bool,
}

impl Place {
    pub fn of(state: &Interpreter<'_>) -> Self {
        Self {
            at: [0, 1, 2].map(|axis| state.coordinate(axis).ok()),
            incremental: state.is_incremental(),
        }
    }

    /// A straight move to a place, `G0` or `G1`; `None` if it goes nowhere. Axes without a place stand still.
    pub fn go(&mut self, code: &str, to: [Option<f64>; 3]) -> Option<String> {
        let mut text = code.to_owned();
        for axis in 0..3 {
            let Some(target) = to[axis] else { continue };
            if self.at[axis] == Some(target) {
                continue;
            }
            let word = match (self.incremental, self.at[axis]) {
                (true, Some(at)) => target - at,
                _ => target,
            };
            text.push_str(&format!(" {}{}", LETTERS[axis], number(word)));
            self.at[axis] = Some(target);
        }
        (text.len() > code.len()).then_some(text)
    }
}
