//! The blocks that a drilling cycle runs.

use crate::heidenhain::expand::hole::{Hole, Retract, Stroke};

/// Most strokes of a hole.
const MOST: usize = 10_000;

impl Hole {
    /// Its strokes.
    ///
    /// # Errors
    /// Why there are none.
    pub(crate) fn strokes(&self) -> Result<Vec<Stroke>, String> {
        let numbers = [
            self.clearance,
            self.depth,
            self.feed,
            self.peck,
            self.surface,
            self.second,
            self.less,
            self.least,
            self.breaks,
            self.back,
            self.dwell_above,
            self.dwell_below,
        ];
        if numbers.iter().any(|number| !number.is_finite()) {
            return Err("a number of the cycle is not finite".to_owned());
        }
        if self.depth == 0.0 {
            // The control does not run it.
            return Ok(Vec::new());
        }
        if self.depth > 0.0 {
            return Err("the depth of the cycle is above the surface".to_owned());
        }
        if self.feed <= 0.0 {
            return Err("the cycle has no feed".to_owned());
        }
        if self.dwell_above < 0.0 || self.dwell_below < 0.0 {
            return Err("the dwell of the cycle is below zero".to_owned());
        }
        let mut strokes = Vec::new();
        match self.cycle {
            1 => self.pecking(&mut strokes)?,
            201 => self.reaming(&mut strokes),
            _ => self.drilling(&mut strokes)?,
        }
        Ok(strokes)
    }

    /// Steps below the surface, each with its depth.
    fn depths(&self) -> Result<Vec<f64>, String> {
        let total = -self.depth;
        let (mut depth, mut peck) = (0.0, self.peck);
        let mut depths = Vec::new();
        while depth < total {
            if depths.len() >= MOST {
                return Err("the hole has more than 10000 pecks".to_owned());
            }
            depth = match peck > 0.0 && depth + peck < total - 1e-9 {
                true => depth + peck,
                false => total,
            };
            depths.push(depth);
            if self.less > 0.0 {
                // A peck never becomes nothing.
                let least = match self.least > 0.0 {
                    true => self.least,
                    false => peck.min(self.less),
                };
                peck = (peck - self.less).max(least);
            }
        }
        Ok(depths)
    }

    fn back_up(&self) -> Option<f64> {
        match self.retract {
            Retract::Rapid => None,
            Retract::Feed(feed) if feed > 0.0 => Some(feed),
            Retract::Feed(_) => Some(self.feed),
        }
    }

    fn drilling(&self, strokes: &mut Vec<Stroke>) -> Result<(), String> {
        let above = self.surface + self.clearance;
        let out = match self.cycle {
            203 => self.back_up(),
            _ => None,
        };
        let depths = self.depths()?;
        strokes.push(Stroke::To(above, None));
        let mut broken = 0.0;
        for (index, depth) in depths.iter().enumerate() {
            strokes.push(Stroke::To(self.surface - depth, Some(self.feed)));
            if index + 1 == depths.len() {
                break;
            }
            if self.cycle == 203 && broken < self.breaks {
                // The chip breaks, the tool stays in the hole.
                broken += 1.0;
                strokes.push(Stroke::To(self.surface - depth + self.back, out));
                continue;
            }
            broken = 0.0;
            strokes.push(Stroke::To(above, out));
            if self.dwell_above > 0.0 {
                strokes.push(Stroke::Dwell(self.dwell_above));
            }
            let again = (self.surface - depth + self.clearance).min(above);
            strokes.push(Stroke::To(again, None));
        }
        if self.dwell_below > 0.0 {
            strokes.push(Stroke::Dwell(self.dwell_below));
        }
        strokes.push(Stroke::To(above, out));
        self.leave(strokes, above);
        Ok(())
    }

    fn reaming(&self, strokes: &mut Vec<Stroke>) {
        let above = self.surface + self.clearance;
        strokes.push(Stroke::To(above, None));
        strokes.push(Stroke::To(self.surface + self.depth, Some(self.feed)));
        if self.dwell_below > 0.0 {
            strokes.push(Stroke::Dwell(self.dwell_below));
        }
        strokes.push(Stroke::To(above, self.back_up()));
        self.leave(strokes, above);
    }

    /// To the second clearance, where that is higher.
    fn leave(&self, strokes: &mut Vec<Stroke>, above: f64) {
        let second = self.surface + self.second;
        if second > above {
            strokes.push(Stroke::To(second, None));
        }
    }

    /// The tool stands at the clearance above the surface before, and there again behind.
    fn pecking(&self, strokes: &mut Vec<Stroke>) -> Result<(), String> {
        let total = -self.depth;
        // How far above the last depth the control goes over from rapid traverse to feed.
        let early = match total * self.unit_mm < 30.0 {
            true => 0.6 / self.unit_mm,
            false => (total / 50.0).min(7.0 / self.unit_mm),
        };
        let depths = self.depths()?;
        let mut begins = 0.0;
        for (index, depth) in depths.iter().enumerate() {
            let below = self.clearance + depth;
            strokes.push(Stroke::By(begins - below, Some(self.feed)));
            if index + 1 == depths.len() {
                if self.dwell_below > 0.0 {
                    strokes.push(Stroke::Dwell(self.dwell_below));
                }
                strokes.push(Stroke::By(below, None));
                break;
            }
            strokes.push(Stroke::By(below, None));
            begins = (below - early).max(0.0);
            if begins > 0.0 {
                strokes.push(Stroke::By(-begins, None));
            }
        }
        Ok(())
    }
}
