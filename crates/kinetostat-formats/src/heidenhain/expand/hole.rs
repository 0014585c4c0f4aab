//! A drilling cycle as it was defined (200, 201, 203 and the pecking of cycle 1), and the blocks that it runs.

/// Limit of the strokes of a hole.
const MOST: usize = 10_000;

/// A block of a cycle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Stroke {
    /// To a coordinate of the tool's axis, in the program's unit, at a feed; none in rapid traverse.
    To(f64, Option<f64>),
    /// Step along the tool axis.
    By(f64, Option<f64>),
    /// Dwell, s.
    Dwell(f64),
}

/// A cycle as it was defined, in the program's unit.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Hole {
    /// 200, 201, 203 or 1.
    pub cycle: u32,
    /// Q200.
    pub clearance: f64,
    /// Q201, negative downwards.
    pub depth: f64,
    /// Q206.
    pub feed: f64,
    /// Q202.
    pub peck: f64,
    /// Q203.
    pub surface: f64,
    /// Q204.
    pub second: f64,
    /// Q210, s.
    pub dwell_above: f64,
    /// Q211, s.
    pub dwell_below: f64,
    /// Q208, zero for the feed of the cycle; none in rapid traverse.
    pub retract: Option<f64>,
    /// Q212.
    pub less: f64,
    /// Q205.
    pub least: f64,
    /// Q213.
    pub breaks: f64,
    /// Q256.
    pub back: f64,
    /// Length of the program's unit.
    pub unit_mm: f64,
}

impl Hole {
    /// Hole of cycle 1, from the numbers of its lines.
    pub(crate) fn pecked(lines: &[Option<f64>; 6], unit_mm: f64) -> Self {
        let own = |line: usize| lines[line].unwrap_or(0.0);
        Self {
            cycle: 1,
            clearance: own(1),
            depth: own(2),
            feed: own(5),
            peck: own(3).abs(),
            dwell_below: own(4),
            unit_mm,
            ..Self::default()
        }
    }

    /// Hole of cycles 200, 201 and 203, from their parameters.
    pub(crate) fn drilled(
        cycle: u32,
        value: impl Fn(&str) -> f64,
        retract: Option<f64>,
        unit_mm: f64,
    ) -> Self {
        let only = |is: bool, name: &str| match is {
            true => value(name),
            false => 0.0,
        };
        Self {
            cycle,
            clearance: value("Q200"),
            depth: value("Q201"),
            feed: value("Q206"),
            peck: only(cycle != 201, "Q202").abs(),
            surface: value("Q203"),
            second: value("Q204"),
            dwell_above: only(cycle != 201, "Q210"),
            dwell_below: value("Q211"),
            retract,
            less: only(cycle == 203, "Q212"),
            least: value("Q205"),
            breaks: value("Q213"),
            back: value("Q256"),
            unit_mm,
        }
    }

    /// Strokes of the hole.
    ///
    /// # Errors
    /// The parameters give no valid strokes.
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
        self.retract.map(|feed| match feed > 0.0 {
            true => feed,
            false => self.feed,
        })
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
        // Advance stop distance: change from rapid traverse to feed above the last depth.
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
