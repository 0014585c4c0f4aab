//! Stations along a move.

use crate::engagement::Engagement;
use crate::error::Result;
use crate::stock::grid::Stock;
use crate::stock::probe::{Probe, norm};
use crate::stock::sweep::Sweep;

/// Steps along a move, as a share of the tool's radius.
const STEP: f64 = 0.25;
/// Entry and exit are found to this share of a cell; the tool is looked at no nearer to the start of a move than half of it,
/// where the wall that it left itself begins.
const PLACE: f64 = 0.5;
/// The tool at a place of a move.
#[derive(Clone, Debug, PartialEq)]
pub struct Station {
    /// Share of the move, 0 to 1.
    pub share: f64,
    /// Engagement from the previous station up to this one.
    pub engagement: Engagement,
}

/// End of a stretch of a move, and true if the tool is in contact there.
#[derive(Clone, Copy, Debug)]
struct Mark {
    share: f64,
    in_contact: bool,
}

/// A straight move with its length, mm, and where the tool goes at both ends: along it, or along the curve that it stands for.
#[derive(Clone, Copy, Debug)]
struct Move {
    from: [f64; 3],
    to: [f64; 3],
    length: f64,
    tangents: Option<[[f64; 3]; 2]>,
}

impl Move {
    fn at(&self, share: f64) -> [f64; 3] {
        std::array::from_fn(|i| self.from[i] + share * (self.to[i] - self.from[i]))
    }

    fn direction(&self, share: f64) -> [f64; 3] {
        let turning = self.tangents.and_then(|[a, b]| {
            let between: [f64; 3] = std::array::from_fn(|i| a[i] + share * (b[i] - a[i]));
            let length = norm(between);
            (length > 0.0).then(|| between.map(|part| part / length))
        });
        turning
            .unwrap_or_else(|| std::array::from_fn(|i| (self.to[i] - self.from[i]) / self.length))
    }
}

impl Probe {
    /// Goes along a straight move: calls `at(share, engagement)` at stations, in the order of their shares, and then removes
    /// what the tool sweeps.
    ///
    /// A station speaks for the way from the one before up to itself; the last has the share 1. They stand a quarter of the
    /// tool's radius apart, or a cell where that is more; where contact begins or ends, the place is found to half a cell
    /// and has stations on both sides; what is met between two stations in air is looked for in the sweep, so that no wall
    /// wider than a cell is missed. Air outside the stock is one step. What the move itself has removed before a station
    /// needs no second look: of a convex tool on a straight way it lies nowhere before the part of the envelope that cuts.
    /// A move shorter than a quarter of a cell is looked at that far from its start, beyond its end: what follows it there may
    /// be seen too early by as much.
    ///
    /// # Errors
    /// A place beyond 100 m.
    pub fn walk(
        &mut self,
        stock: &mut Stock,
        from: [f64; 3],
        to: [f64; 3],
        at: impl FnMut(f64, &Engagement),
    ) -> Result<()> {
        self.walk_turning(stock, from, to, None, at)
    }

    /// Walks along a chord of a curve: the tool is placed on the chord, but moves along the curve, whose tangents (of
    /// the same length) at both ends are `tangents`. Without them the ends of the arcs in contact would be off by half
    /// of the chord's turn.
    ///
    /// ```
    /// use kinetostat_cutting::{Probe, Shape, Stock, StockSettings, Tool};
    ///
    /// let tool = Tool::new(Shape::Flat, 6.0, 2)?;
    /// let mut stock = Stock::block([0.0; 3], [40.0, 30.0, 10.0], &StockSettings::for_tool(&tool))?;
    /// // An eighth of a circle of 10 mm in the full material: a slot all along.
    /// let (sin, cos) = std::f64::consts::FRAC_PI_4.sin_cos();
    /// let (from, to) = ([25.0, 15.0, 8.0], [15.0 + 10.0 * cos, 15.0 + 10.0 * sin, 8.0]);
    /// let tangents = [[0.0, 1.0, 0.0], [-sin, cos, 0.0]];
    /// let mut arcs = Vec::new();
    /// Probe::new(&tool).walk_turning(&mut stock, from, to, Some(tangents), |_, met| {
    ///     arcs.push(met.contacts[0].exit - met.contacts[0].entry);
    /// })?;
    /// assert!(arcs.iter().all(|arc| (arc - std::f64::consts::PI).abs() < 1e-9));
    /// # Ok::<(), kinetostat_cutting::CutError>(())
    /// ```
    ///
    /// # Errors
    /// A place beyond 100 m.
    pub fn walk_turning(
        &mut self,
        stock: &mut Stock,
        from: [f64; 3],
        to: [f64; 3],
        tangents: Option<[[f64; 3]; 2]>,
        mut at: impl FnMut(f64, &Engagement),
    ) -> Result<()> {
        Stock::checked_place(from)?;
        Stock::checked_place(to)?;
        let way = Move {
            from,
            to,
            length: norm(std::array::from_fn(|i| to[i] - from[i])),
            tangents,
        };
        let met = way.length > 1e-9;
        let inside = met.then(|| self.near(stock, &way)).flatten();
        let mut in_contact = false;
        if let Some([first, last]) = inside {
            stock.settle(&self.profile, from);
            let stretch = (last - first) * way.length;
            let step = (STEP * self.radius).max(stock.cell);
            let steps = (stretch / step).ceil().max(1.0);
            let mut mark = Mark {
                share: first,
                in_contact: self.was_in_contact(stock, &way, first),
            };
            if first > 0.0 {
                mark.in_contact = false;
                at(first, &Engagement::air());
            }
            for k in 1..=steps as usize {
                let share = first + (last - first) * k as f64 / steps;
                let share = if k == steps as usize { last } else { share };
                mark = self.stretch(stock, &way, mark, share, &mut at);
            }
            in_contact = mark.in_contact;
            stock.cut(&self.profile, from, to);
            if last < 1.0 {
                in_contact = false;
                at(1.0, &Engagement::air());
            }
        } else {
            at(1.0, &Engagement::air());
        }
        self.last = Some((to, in_contact));
        Ok(())
    }

    /// The stations of [`Probe::walk`] as a list.
    ///
    /// # Errors
    /// A place beyond 100 m.
    pub fn stations(
        &mut self,
        stock: &mut Stock,
        from: [f64; 3],
        to: [f64; 3],
    ) -> Result<Vec<Station>> {
        let mut stations = Vec::new();
        self.walk(stock, from, to, |share, engagement| {
            stations.push(Station {
                share,
                engagement: engagement.clone(),
            });
        })?;
        Ok(stations)
    }

    /// Stations from a mark up to a share, more where contact begins or ends between them.
    fn stretch(
        &mut self,
        stock: &Stock,
        way: &Move,
        from: Mark,
        to: f64,
        at: &mut impl FnMut(f64, &Engagement),
    ) -> Mark {
        let length = (to - from.share) * way.length;
        let in_contact = self.look_at(stock, way, to);
        let divide = length > PLACE * stock.cell
            && match (from.in_contact, in_contact) {
                (true, true) => false,
                (false, false) => self.is_touched(stock, way, [from.share, to]),
                _ => true,
            };
        if divide {
            let middle = self.stretch(stock, way, from, 0.5 * (from.share + to), at);
            return self.stretch(stock, way, middle, to, at);
        }
        at(to, &self.found);
        Mark {
            share: to,
            in_contact,
        }
    }

    /// True if the tool is in contact at the start of a move.
    fn was_in_contact(&mut self, stock: &Stock, way: &Move, first: f64) -> bool {
        match self.last {
            Some((place, in_contact)) if place == way.from => in_contact,
            // A short move is one station.
            _ if way.length <= PLACE * stock.cell => false,
            _ => self.look_at(stock, way, first),
        }
    }

    /// Looks at a share of a move, but not where the tool stood at its start.
    fn look_at(&mut self, stock: &Stock, way: &Move, share: f64) -> bool {
        let least = 0.5 * PLACE * stock.cell / way.length;
        let share = if share < least { least } else { share };
        self.look(stock, way.at(share), way.direction(share));
        !self.found.is_air()
    }

    fn is_touched(&self, stock: &Stock, way: &Move, shares: [f64; 2]) -> bool {
        let [from, to] = shares.map(|share| way.at(share));
        stock.is_touched(&self.profile, &Sweep::new(from, to, stock.bottom))
    }

    /// Shares of a move between which the tool may reach the stock.
    fn near(&self, stock: &Stock, way: &Move) -> Option<[f64; 2]> {
        let lowest = if way.to[2] < way.from[2] {
            way.to[2]
        } else {
            way.from[2]
        };
        let reach = self.profile.reach(stock.bottom + stock.height - lowest) + stock.cell;
        let last = |axis: usize| stock.place(stock.points[0] - 1, stock.points[1] - 1)[axis];
        let low = [
            stock.origin[0] - reach,
            stock.origin[1] - reach,
            f64::NEG_INFINITY,
        ];
        let high = [
            last(0) + reach,
            last(1) + reach,
            stock.bottom + stock.height,
        ];
        let mut shares = [0.0, 1.0];
        for i in 0..3 {
            let (start, step) = (way.from[i], way.to[i] - way.from[i]);
            if step == 0.0 {
                if start < low[i] || start > high[i] {
                    return None;
                }
                continue;
            }
            let (a, b) = ((low[i] - start) / step, (high[i] - start) / step);
            let (enters, leaves) = if a < b { (a, b) } else { (b, a) };
            shares[0] = if enters > shares[0] {
                enters
            } else {
                shares[0]
            };
            shares[1] = if leaves < shares[1] {
                leaves
            } else {
                shares[1]
            };
        }
        (shares[0] < shares[1]).then_some(shares)
    }
}
