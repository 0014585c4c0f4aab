//! Measured forces at stations along the moves of a program.

use kinetostat::Wrench;
use kinetostat::number::larger;
use kinetostat_cutting::ForceLog;
use kinetostat_program::{Curve, Move, Path};
use nalgebra::{Rotation3, Vector3};

use crate::cut::clock::{Clock, cuts};
use crate::cut::measured_report::{ActsOn, MeasuredAxes};
use crate::cut::station::{CutStation, heading};

/// Maximum number of stations of a program, apart from the ends of moves and from arcs.
const MOST_STATIONS: f64 = 500_000.0;

/// Largest turn against the feed, rad, from station to station on an arc, of a force in axes of the part: on straight lines
/// between them it is off by 0.03 %.
const MOST_TURN: f64 = 0.05;

/// Maximum number of stations on an arc for that.
const MOST_ON_AN_ARC: f64 = 10_000.0;

/// A log laid along a program.
pub(crate) struct Laid<'a> {
    pub log: &'a ForceLog,
    pub clock: &'a Clock,
    /// Time or length of the log less that of the program.
    pub shift: f64,
    pub axes: MeasuredAxes,
    pub acts_on: ActsOn,
    /// Minimum distance of stations, s or mm.
    pub step: f64,
}

/// Minimum distance of stations: four in a window of the mean, and not too many of them.
pub(crate) fn step(window: f64, clock: &Clock) -> f64 {
    let all: f64 = clock.spans.iter().map(|[from, to]| to - from).sum();
    larger(0.25 * window, all / MOST_STATIONS)
}

impl Laid<'_> {
    /// Interval of a move in the log, s or mm.
    pub fn span(&self, move_index: usize) -> [f64; 2] {
        self.clock.spans[move_index].map(|at| at + self.shift)
    }

    /// The part of a move that the log covers, s or mm; `None` for nothing.
    pub fn covered(&self, move_index: usize) -> Option<[f64; 2]> {
        let [from, to] = self.span(move_index);
        let [first, last] = self.log.range();
        let (from, to) = (from.clamp(first, last), to.clamp(first, last));
        (to > from).then_some([from, to])
    }

    /// Size of the force at a place of the log, N.
    pub fn size(&self, at: f64) -> f64 {
        let force = self.log.at(at).map_or([0.0; 3], |(force, _)| force);
        Vector3::from(force).norm()
    }

    /// Stations of a move in axes of the feed, and the same in axes of the part where these are those of the log.
    pub fn stations(&self, path: &Path, move_index: usize) -> [Vec<CutStation>; 2] {
        let motion = &path.moves[move_index];
        let mut all = [Vec::new(), Vec::new()];
        if !cuts(motion) {
            return all;
        }
        let [from, to] = self.span(move_index);
        let share = |at: f64| ((at - from) / (to - from)).clamp(0.0, 1.0);
        let mut add = |share: f64, wrench: Option<Wrench>| {
            let none = CutStation::air(share);
            let Some(logged) = wrench else {
                all[0].push(none);
                all[1].push(none);
                return;
            };
            let (in_feed, in_part) = self.in_axes(motion, share, logged);
            let station = |wrench| CutStation { wrench, ..none };
            all[0].push(station(in_feed));
            all[1].push(station(in_part));
        };
        // Parts beyond the log have no force: it jumps where the log begins or ends.
        match self.covered(move_index) {
            None => {
                add(0.0, None);
                add(1.0, None);
            }
            Some([first, last]) => {
                if first > from {
                    add(0.0, None);
                    add(share(first), None);
                }
                for at in self.places(motion, [first, last], to - from) {
                    add(share(at), Some(self.on_the_tool(at)));
                }
                if last < to {
                    add(share(last), None);
                    add(1.0, None);
                }
            }
        }
        all
    }

    /// Places of stations from one place of the log to another, on a move that takes `whole`: rows of the log, as between them
    /// it is straight, none closer than the step; more of them on an arc.
    fn places(&self, motion: &Move, [first, last]: [f64; 2], whole: f64) -> Vec<f64> {
        let mut places = vec![first];
        let mut before = first;
        let rows = self.log.rows_between(first, last).iter().copied();
        for at in rows.filter(|at| last - at >= self.step).chain([last]) {
            if at <= before || (at - before < self.step && at < last) {
                continue;
            }
            let turn = match (motion.curve, self.axes) {
                (Curve::Arc(arc), MeasuredAxes::Part) => arc.sweep.abs() * (at - before) / whole,
                _ => 0.0,
            };
            let pieces = (turn / MOST_TURN).ceil().clamp(1.0, MOST_ON_AN_ARC) as usize;
            for i in 1..pieces {
                places.push(before + (at - before) * i as f64 / pieces as f64);
            }
            places.push(at);
            before = at;
        }
        places
    }

    /// Wrench on the tool at a place of the log, in the axes of the log.
    fn on_the_tool(&self, at: f64) -> Wrench {
        let (force, moment) = self.log.at(at).unwrap_or_default();
        let sign = match self.acts_on {
            ActsOn::Tool => 1.0,
            ActsOn::Part => -1.0,
        };
        Wrench::new(sign * Vector3::from(force), sign * Vector3::from(moment))
    }

    /// Wrench in axes of the feed, and of the part.
    fn in_axes(&self, motion: &Move, share: f64, logged: Wrench) -> (Wrench, Wrench) {
        // Straight up and down there is no feed across the axis: axes of the part then.
        let angle = heading(motion.tangent(share)).unwrap_or(0.0);
        let turned =
            |angle: f64| logged.rotated(&Rotation3::from_axis_angle(&Vector3::z_axis(), angle));
        match self.axes {
            MeasuredAxes::Part => (turned(-angle), logged),
            MeasuredAxes::Feed => (logged, turned(angle)),
        }
    }
}
