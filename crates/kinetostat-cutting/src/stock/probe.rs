//! A tool that goes through a stock: what it meets, and what it takes away.

use crate::engagement::Engagement;
use crate::error::{CutError, CutErrorKind, Result};
use crate::stock::arcs::Range;
use crate::stock::corner::Corner;
use crate::stock::end::End;
use crate::stock::grid::Stock;
use crate::stock::profile::Profile;
use crate::stock::rim::{Rim, Stand};
use crate::tool::Tool;

/// Samples of a rim, as a share of a cell.
const SAMPLE: f64 = 0.5;

/// A tool that goes through a stock. It owns what is used again from move to move.
#[derive(Clone, Debug)]
pub struct Probe {
    pub(crate) profile: Profile,
    pub(crate) radius: f64,
    rim: Rim,
    corner: Corner,
    end: End,
    pub(crate) found: Engagement,
    /// End of the last move, and true if in contact there.
    pub(crate) last: Option<([f64; 3], bool)>,
}

impl Probe {
    /// A probe of the shape of a tool.
    #[must_use]
    pub fn new(tool: &Tool) -> Self {
        Self {
            profile: Profile::new(tool),
            radius: tool.radius_mm(),
            rim: Rim::default(),
            corner: Corner::default(),
            end: End::default(),
            found: Engagement::air(),
            last: None,
        }
    }

    /// The contacts of the tool with its tip at a place, mm, that goes on in a direction (of any length). Straight up and
    /// down there is no feed in the plane: x of the part stands for it.
    ///
    /// Contact is where the outward normal of the envelope has a part along the motion and there is material. A tool that
    /// stands where it has cut touches nothing but what is before it: look a little further on, as [`Probe::walk`] does.
    ///
    /// ```
    /// use kinetostat_cutting::{Engagement, Probe, Shape, Stock, StockSettings, Tool};
    ///
    /// let tool = Tool::new(Shape::Flat, 6.0, 2)?;
    /// let stock = Stock::block([0.0; 3], [40.0, 30.0, 10.0], &StockSettings::for_tool(&tool))?;
    /// let found = Probe::new(&tool).engagement(&stock, [20.0, 15.0, 9.0], [0.0, 0.0, -1.0])?;
    /// assert_eq!(found, Engagement::plunge(3.0));
    /// # Ok::<(), kinetostat_cutting::CutError>(())
    /// ```
    ///
    /// # Errors
    /// A place beyond 100 m, no direction.
    pub fn engagement(
        &mut self,
        stock: &Stock,
        at: [f64; 3],
        direction: [f64; 3],
    ) -> Result<Engagement> {
        Stock::checked_place(at)?;
        Stock::checked_place(direction)?;
        let length = norm(direction);
        if length <= 0.0 {
            return Err(CutError::new(
                CutErrorKind::Cut,
                "direction of the tool",
                "no length",
                "a direction",
            ));
        }
        self.look(stock, at, direction.map(|d| d / length));
        Ok(self.found.clone())
    }

    /// Removes what the tool sweeps from one place of its tip to another, mm, without looking.
    ///
    /// # Errors
    /// A place beyond 100 m.
    pub fn cut(&mut self, stock: &mut Stock, from: [f64; 3], to: [f64; 3]) -> Result<()> {
        Stock::checked_place(from)?;
        Stock::checked_place(to)?;
        stock.cut(&self.profile, from, to);
        self.last = Some((to, true));
        Ok(())
    }

    /// Cuts along a list of places: chords of arcs, for instance.
    ///
    /// # Errors
    /// A place beyond 100 m.
    pub fn cut_along(&mut self, stock: &mut Stock, places: &[[f64; 3]]) -> Result<()> {
        places
            .windows(2)
            .try_for_each(|ends| self.cut(stock, ends[0], ends[1]))
    }

    /// Finds the contacts at a place with a direction of length one.
    pub(crate) fn look(&mut self, stock: &Stock, at: [f64; 3], direction: [f64; 3]) {
        self.found.contacts.clear();
        let horizontal = direction[0].hypot(direction[1]);
        let motion = match horizontal > 1e-9 {
            true => [horizontal, direction[2]],
            false => [0.0, direction[2]],
        };
        let stand = Stand {
            centre: [at[0], at[1]],
            tip: at[2] - stock.bottom,
            feed: match motion[0] > 0.0 {
                true => [direction[0] / horizontal, direction[1] / horizontal],
                false => [1.0, 0.0],
            },
            slope: if motion[0] > 0.0 {
                motion[1] / motion[0]
            } else {
                0.0
            },
        };
        if stand.tip >= stock.height {
            return;
        }
        let profile = self.profile;
        if profile.end > 0.0 && motion[1] < 0.0 {
            self.end
                .contacts(stock, &stand, profile.end, &mut self.found);
        }
        if !profile.is_flat() {
            let found = &mut self.found;
            self.corner.contacts(stock, &stand, &profile, motion, found);
        }
        let shoulder = profile.shoulder();
        let step = SAMPLE * stock.cell;
        let ahead = Range::facing(std::f64::consts::FRAC_PI_2, motion, profile.outer, step);
        if let Some(range) = ahead
            && stand.tip + shoulder < stock.height
        {
            let found = &mut self.found;
            self.rim
                .contacts(stock, &stand, profile.outer, shoulder, &range, found);
        }
    }
}

pub(crate) fn norm(vector: [f64; 3]) -> f64 {
    vector.iter().map(|x| x * x).sum::<f64>().sqrt()
}
