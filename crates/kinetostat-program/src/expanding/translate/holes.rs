//! The motions of one hole, from its retract level on.

use crate::expanding::{Dialect, Wrong};
use crate::number::number;
use crate::path::spindle::SpindleRotation;
use crate::reading::interpreting::Interpreter;

/// Pecks of one hole.
const MOST_PECKS: f64 = 1e5;

/// Spindle state when the cycle begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Spindle {
    on: Option<[&'static str; 2]>,
}

impl Spindle {
    pub fn of(state: &Interpreter<'_>) -> Self {
        Self {
            on: match state.spindle_rotation() {
                SpindleRotation::Clockwise => Some(["M3", "M4"]),
                SpindleRotation::CounterClockwise => Some(["M4", "M3"]),
                SpindleRotation::Stopped => None,
            },
        }
    }

    /// The words that start it as it turns, and the other way round.
    fn turning(self, code: u32) -> Result<[&'static str; 2], Wrong> {
        self.on.ok_or((
            format!("the cycle G{} needs a spindle that turns", code / 10),
            "write M3 or M4 before it",
        ))
    }
}

/// A hole.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Hole {
    /// Position of the hole in the plane.
    pub at: [f64; 2],
    pub level: f64,
    pub clear: f64,
    pub bottom: f64,
    pub dwell: Option<f64>,
    pub peck: Option<f64>,
    pub shift: [Option<f64>; 3],
    /// Level at which G87 begins to bore; its end is below.
    pub middle: Option<f64>,
    /// Height above the last depth at which a peck begins.
    pub peck_back: f64,
    pub dialect: Dialect,
}

/// Writes a move; `None` if it goes nowhere.
type Go<'g> = dyn FnMut(&str, [f64; 2], f64) -> Option<String> + 'g;

impl Hole {
    /// The blocks of a cycle; the tool is above the hole at the retract level.
    pub fn blocks(
        &self,
        code: u32,
        spindle: Spindle,
        go: &mut Go<'_>,
    ) -> Result<Vec<String>, Wrong> {
        let mut all = Vec::new();
        let (at, bottom, clear) = (self.at, self.bottom, self.clear);
        let dwell = |needed: bool| match self.dwell {
            Some(p) => Ok(Some(format!("G4 P{}", number(p)))),
            None if needed && self.dialect != Dialect::Fanuc => Err((
                format!("the cycle G{} has no dwell (P)", code / 10),
                "write P into its first block",
            )),
            None => Ok(None),
        };
        let stop = || "M5".to_owned();
        match code {
            810 => {
                all.extend(go("G1", at, bottom));
                all.extend(go("G0", at, clear));
            }
            820 => {
                all.extend(go("G1", at, bottom));
                all.extend(dwell(true)?);
                all.extend(go("G0", at, clear));
            }
            730 | 830 => {
                for depth in self.pecks(code)? {
                    all.extend(go("G1", at, depth));
                    if code == 830 {
                        all.extend(go("G0", at, self.level));
                    }
                    all.extend(go("G0", at, depth + self.peck_back));
                }
                all.extend(go("G1", at, bottom));
                all.extend(go("G0", at, clear));
            }
            740 | 840 => {
                let [own, other] = spindle.turning(code)?;
                let expected = if code == 840 { "M3" } else { "M4" };
                if own != expected {
                    return Err((
                        format!(
                            "the cycle G{} needs the spindle to turn with {expected}",
                            code / 10
                        ),
                        "turn it so before the cycle",
                    ));
                }
                all.extend(go("G1", at, bottom));
                all.extend([stop(), other.to_owned()]);
                all.extend(dwell(false)?);
                all.extend(go("G1", at, clear));
                all.extend([stop(), own.to_owned()]);
            }
            850 => {
                all.extend(go("G1", at, bottom));
                all.extend(go("G1", at, self.level));
                all.extend(go("G0", at, clear));
            }
            860 => {
                let [own, _] = spindle.turning(code)?;
                all.extend(go("G1", at, bottom));
                all.extend(dwell(true)?);
                all.push(stop());
                all.extend(go("G0", at, clear));
                all.push(own.to_owned());
            }
            890 => {
                all.extend(go("G1", at, bottom));
                all.extend(dwell(true)?);
                all.extend(go("G1", at, clear));
            }
            760 if self.dialect == Dialect::Fanuc => {
                self.fine_bore(spindle, dwell(false)?, go, &mut all)?
            }
            870 => self.back_bore(spindle, go, &mut all)?,
            880 => {
                return Err((
                    "in the cycle G88 the operator draws the tool out by hand".to_owned(),
                    "write the hole with G86, or as moves",
                ));
            }
            _ => {
                return Err((
                    match self.dialect {
                        Dialect::LinuxCnc => {
                            "G76 of LinuxCNC is a thread of many passes, tied to the spindle"
                        }
                        _ => "G76 is a thread on LinuxCNC and lathes, and a fine boring elsewhere",
                    }
                    .to_owned(),
                    "write its moves as G0 and G1 blocks; the fine boring is followed with --dialect fanuc",
                ));
            }
        }
        Ok(all)
    }

    /// Depths of the pecks above the bottom.
    fn pecks(&self, code: u32) -> Result<Vec<f64>, Wrong> {
        let peck = self.peck.filter(|peck| *peck > 0.0).ok_or((
            format!(
                "the cycle G{} has no depth of a peck above zero (Q)",
                code / 10
            ),
            "write Q into its first block",
        ))?;
        if (self.level - self.bottom) / peck > MOST_PECKS {
            return Err((
                "the hole has more than 100000 pecks".to_owned(),
                "correct Q",
            ));
        }
        let mut depths = Vec::new();
        let mut depth = self.level - peck;
        while depth > self.bottom {
            depths.push(depth);
            depth -= peck;
        }
        Ok(depths)
    }

    /// Down, stop and turn to its place, aside by I and J, out, back over the hole (Fanuc, Operator's Manual B-63534EN, G76;
    /// Haas has I and J).
    fn fine_bore(
        &self,
        spindle: Spindle,
        dwell: Option<String>,
        go: &mut Go<'_>,
        all: &mut Vec<String>,
    ) -> Result<(), Wrong> {
        let [own, _] = spindle.turning(760)?;
        let [i, j, _] = self.shift;
        let aside = [self.at[0] + i.unwrap_or(0.0), self.at[1] + j.unwrap_or(0.0)];
        all.extend(go("G1", self.at, self.bottom));
        all.extend(dwell);
        all.extend(["M5".to_owned(), "M19".to_owned()]);
        all.extend(go("G0", aside, self.bottom));
        all.extend(go("G0", aside, self.clear));
        all.extend(go("G0", self.at, self.clear));
        all.push(own.to_owned());
        Ok(())
    }

    fn back_bore(
        &self,
        spindle: Spindle,
        go: &mut Go<'_>,
        all: &mut Vec<String>,
    ) -> Result<(), Wrong> {
        let [own, _] = spindle.turning(870)?;
        let ([Some(i), Some(j), _], Some(middle)) = (self.shift, self.middle) else {
            return Err((
                "the cycle G87 has no I, J and K".to_owned(),
                "write how far the tool is shifted (I, J) and where it bores from (K)",
            ));
        };
        let aside = [self.at[0] + i, self.at[1] + j];
        let orient = || ["M5".to_owned(), "M19".to_owned()];
        all.extend(go("G0", aside, self.level));
        all.extend(orient());
        all.extend(go("G0", aside, self.bottom));
        all.extend(go("G0", self.at, self.bottom));
        all.push(own.to_owned());
        all.extend(go("G1", self.at, middle));
        all.extend(go("G1", self.at, self.bottom));
        all.extend(orient());
        all.extend(go("G0", aside, self.bottom));
        all.extend(go("G0", aside, self.clear));
        all.extend(go("G0", self.at, self.clear));
        all.push(own.to_owned());
        Ok(())
    }
}
