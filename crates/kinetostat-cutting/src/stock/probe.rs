//! A tool that goes through a stock: what it meets, and what it takes away.

use crate::engagement::{Contact, Engagement};
use crate::error::{CutError, CutErrorKind, Result};
use crate::stock::arcs::{Range, same};
use crate::stock::corner::Corner;
use crate::stock::grid::Stock;
use crate::stock::profile::Profile;
use crate::stock::rim::{Cell, Rim, Stand};
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

/// Rings of the end at one place.
const RINGS: [f64; 2] = [4.0, 64.0];

/// Buffers for the contacts of a flat end.
#[derive(Clone, Debug, Default)]
pub(crate) struct End {
    arcs: Vec<[f64; 2]>,
    within: Vec<[f64; 2]>,
}

impl End {
    /// Adds the contacts of a flat end of this radius.
    pub fn contacts(&mut self, stock: &Stock, stand: &Stand, radius: f64, found: &mut Engagement) {
        let level = stand.tip.max(0.0) + stock.tolerance();
        if stand.tip < -stock.tolerance() || level >= stock.height {
            return;
        }
        let rings = (radius / stock.cell).ceil().clamp(RINGS[0], RINGS[1]);
        let width = radius / rings;
        self.within.clear();
        for ring in 0..rings as usize {
            let inner = width * ring as f64;
            let middle = inner + 0.5 * width;
            let value = |direction: [f64; 2]| {
                depth_below(stock, stand, stand.place(middle, direction), level, radius)
            };
            Range::full(middle, stock.cell).arcs(value, &mut self.arcs);
            let outer = match ring + 1 == rings as usize {
                true => radius,
                false => inner + width,
            };
            match same(&self.arcs, &self.within) {
                true => {
                    let first = found.contacts.len() - self.arcs.len();
                    for contact in &mut found.contacts[first..] {
                        contact.to_mm = outer;
                    }
                }
                false => {
                    let contact = |arc: &[f64; 2]| Contact::end(inner, outer, arc[0], arc[1]);
                    found.contacts.extend(self.arcs.iter().map(contact));
                }
            }
            std::mem::swap(&mut self.arcs, &mut self.within);
        }
    }
}

/// Positive in the material at a place under the end; about the distance of the next wall. Points beyond the end do not count:
/// the walls there are none of its own business.
fn depth_below(stock: &Stock, stand: &Stand, place: [f64; 2], level: f64, radius: f64) -> f64 {
    let Some(cell) = Cell::at(stock, place) else {
        return -stock.cell;
    };
    let columns = cell.columns(stock);
    let inside = columns.map(|column| f64::from(column.top) > level);
    if inside == [false; 4] {
        return -stock.cell;
    }
    let known = stock.known() as f32;
    let wall = |k: usize| {
        if inside[k] {
            columns[k].drop
        } else {
            columns[k].rise
        }
    };
    let is_slope = (0..4).all(|k| wall(k) >= known);
    let mut sum = 0.0;
    for k in 0..4 {
        if cell.distance(stock, k, stand.centre) > radius {
            continue;
        }
        let signed = match (is_slope, inside[k]) {
            (true, _) => f64::from(columns[k].top) - level,
            (false, true) => f64::from(wall(k)),
            (false, false) => -f64::from(wall(k)),
        };
        sum += cell.shares[k] * signed;
    }
    sum
}
