//! Axes beside X, Y and Z: they may stand, and not move; those that turn stand at zero alone.

use crate::siemens::block::{How, Item};
use crate::siemens::state::Code;
use crate::siemens::walker::Reader;
use crate::siemens::words::Purpose;

/// Letters of axes beside X, Y and Z.
pub(crate) const OTHER_AXES: &[u8] = b"ABCUVWQE";

impl Reader<'_> {
    /// An axis beside X, Y, Z: it may stand, and not move.
    pub(crate) fn other_axis(
        &mut self,
        name: &str,
        item: &Item,
        value: f64,
        how: How,
        purpose: Purpose,
    ) {
        let steps = how == How::Step || how == How::Modal && self.state.steps;
        let code = self.state.code;
        let turns = matches!(name, "A" | "B" | "C");
        let axis = self
            .state
            .others
            .entry(name.as_bytes().to_vec())
            .or_default();
        match (purpose, axis.at) {
            (Purpose::Machine, _) => axis.elsewhere = true,
            (_, _) if steps && value == 0.0 => {}
            // From wherever it stands, beside a motion of the tool; and turned, whether by a rapid or not.
            (Purpose::Motion, None) if !steps && value != 0.0 && (turns || code != Code::Rapid) => {
                axis.at = Some(value);
                self.moves_aside(name, item);
            }
            (_, None) if !steps => {
                axis.at = Some(value);
                axis.elsewhere = false;
                if value != 0.0 {
                    self.finding(
                        &item.span,
                        format!("{name} stands at {value}: the part is taken to lie as the frame in force says then"),
                    );
                }
            }
            (_, Some(at)) if !steps && at == value => axis.elsewhere = false,
            _ => {
                // All that follows stands there.
                axis.at = (!steps).then_some(value);
                axis.elsewhere = false;
                self.moves_aside(name, item);
            }
        }
    }

    fn moves_aside(&mut self, name: &str, item: &Item) {
        self.fault(
            &item.span,
            format!("the axis {name} moves: where the tool stands on the part then, needs the kinematics of the machine"),
            "give the parts of the program between such motions one by one, or describe the axis in the model ([[rotary_axis]]), if it is one of A, B, C that turns",
        );
    }
}
