//! G33.1: a rigid tap, as a feed to its end with the pitch times the speed, and back with the spindle reversed.
//!
//! That is how G84 is written; the tool must float in its holder, which a warning says. LinuxCNC ties the feed to the spindle
//! (`docs/src/gcode/g-code.adoc`, G33.1) and makes one canonical call of it, `rigid_tap`: to the end and back.

use crate::error::ProgramError;
use crate::expanding::number::number;
use crate::expanding::run::runner::Runner;
use crate::expanding::translate::block::MotionBlock;
use crate::expanding::translate::moves::Place;
use crate::path::moves::FeedMode;
use crate::path::spindle::{SpeedMode, SpindleRotation};

impl Runner<'_> {
    /// A block with G33.1.
    pub fn rigid_tap(&mut self, block: &MotionBlock) -> Result<(), ProgramError> {
        if self.radius.refuses_cycles().is_some() {
            return Err(self.refuse(
                "a thread cannot be tapped while cutter radius compensation is on, or before the first move behind G40",
                "write G40 and a move before it",
            ));
        }
        self.add_rest(&block.before)?;
        let state = self.state();
        let spindle = state.spindle();
        let [own, other] = match spindle.rotation {
            SpindleRotation::Clockwise => ["M3", "M4"],
            SpindleRotation::CounterClockwise => ["M4", "M3"],
            SpindleRotation::Stopped => {
                return Err(self.refuse(
                    "G33.1 needs a spindle that turns",
                    "write M3 or M4 before it",
                ));
            }
        };
        let pitch = block
            .value(b'K')
            .filter(|pitch| *pitch > 0.0)
            .ok_or_else(|| {
                self.refuse(
                    "G33.1 has no pitch above zero (K)",
                    "write K, the way in a turn",
                )
            })?;
        let speed = spindle
            .speed
            .filter(|_| spindle.mode == SpeedMode::Constant);
        let feed = match (state.feed_mode(), speed) {
            (FeedMode::PerRevolution, _) => pitch,
            (FeedMode::PerMinute, Some(speed)) if speed > 0.0 => pitch * speed,
            _ => {
                return Err(self.refuse(
                    "the feed of G33.1 is its pitch times the speed of the spindle, which is not known here",
                    "write S in turns a minute (G97), and G94 or G95, before it",
                ));
            }
        };
        let faster = block
            .value(b'I')
            .map_or(1.0, |scale| if scale > 1.0 { scale } else { 1.0 });
        let before = state.feed_in_units();
        let mut place = Place::of(state);
        let start = place.at;
        let mut end = start;
        for (axis, letter) in (0..).zip(*b"XYZ") {
            let Some(word) = block.value(letter) else {
                continue;
            };
            end[axis] = match (place.incremental, start[axis]) {
                (_, None) => {
                    return Err(self.refuse(
                        "where the tool is before G33.1 is not known",
                        "state X, Y and Z before it, or give the start position",
                    ));
                }
                (true, Some(at)) => Some(at + word),
                (false, _) => Some(word),
            };
        }
        let there = place.go("G1", end);
        let back = place.go("G1", start);
        let (Some(there), Some(back)) = (there, back) else {
            return Err(self.refuse("G33.1 goes nowhere", "write the end of the thread"));
        };
        let fed = |scale: f64| format!(" F{}", number(feed * scale));
        let mut texts = vec![there + &fed(1.0), "M5".to_owned(), other.to_owned()];
        texts.push(back + &fed(faster));
        texts.extend(["M5".to_owned(), own.to_owned()]);
        texts.extend(before.map(|feed| format!("F{}", number(feed))));
        // LinuxCNC takes no bare places behind it.
        texts.push("G80".to_owned());
        for text in texts {
            self.add(text.as_bytes())?;
        }
        self.no_feed |= before.is_none();
        self.flat.warn("a thread is tapped here (G33.1) by a feed and a reversed spindle, as G84 does it: the tool must float in its holder");
        self.add_rest(&block.after)
    }
}
