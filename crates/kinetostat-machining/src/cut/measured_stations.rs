//! Measured forces at stations along the moves of a program, and the report of them.

use kinetostat::Wrench;
use kinetostat::number::larger;
use kinetostat_cutting::{ConditioningReport, ForceLog, ShiftMatch};
use kinetostat_program::{Curve, Move, Path};
use nalgebra::{Rotation3, Vector3};
use serde::{Deserialize, Serialize};

use crate::cut::clock::{Clock, cuts};
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

/// Axes in which forces were measured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MeasuredAxes {
    /// Axes of the program.
    #[default]
    Part,
    /// x along the feed, z along the program's z, y to the left; axes of the program where the tool goes straight up or down.
    Feed,
}

/// Body on which the measured force acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ActsOn {
    /// The tool: a dynamometer in the spindle or on the flange.
    Tool,
    /// The part: a dynamometer under it. The force on the tool is the opposite one.
    Part,
}

/// Report on the processing of measured forces.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct MeasuredReport {
    /// Conditioning of the log.
    pub conditioning: ConditioningReport,
    /// Time of the log at which the program's first cut begins, s; `None` for a log along the path.
    pub shift_s: Option<f64>,
    /// Match by which the shift was found; `None` if it was stated.
    pub matched: Option<ShiftMatch>,
    /// Speed of rapids, mm/min.
    pub rapid_mm_per_minute: Option<f64>,
    /// Axes of the log.
    pub axes: MeasuredAxes,
    /// Body on which the logged force acts.
    pub acts_on: ActsOn,
}

impl MeasuredReport {
    /// Processing steps and assumptions, one sentence each.
    #[must_use]
    pub fn sentences(&self) -> Vec<String> {
        let mut all = vec![self.of_the_log()];
        all.extend(self.conditioning.sentences());
        all.push(self.of_places());
        if self.shift_s.is_some() {
            let rapids = match self.rapid_mm_per_minute {
                Some(rate) => format!("rapids at {rate} mm/min"),
                None => "no rapids between cuts".to_owned(),
            };
            all.push(format!(
                "times of the program: lengths over the programmed feeds, {rapids}; dwells as programmed; accelerations and overrides are not known"
            ));
        }
        all
    }

    /// A step from row to row over which the log has nothing: where it begins, and its length, s or mm.
    #[must_use]
    pub fn gap(&self) -> Option<[f64; 2]> {
        let of = &self.conditioning;
        let [_, longest] = of.longest_step;
        (longest > 10.0 * of.spacing && longest > of.window).then_some(of.longest_step)
    }

    fn of_the_log(&self) -> String {
        let axes = match self.axes {
            MeasuredAxes::Part => "axes of the program",
            MeasuredAxes::Feed => "axes of the feed",
        };
        let acts_on = match self.acts_on {
            ActsOn::Tool => "forces on the tool",
            ActsOn::Part => "forces on the part, turned round to be those on the tool",
        };
        let moments = match self.conditioning.channels {
            6 => "with moments about the tip",
            _ => "without moments",
        };
        format!(
            "measured: {} rows, {acts_on}, {axes}, {moments}",
            self.conditioning.rows
        )
    }

    fn of_places(&self) -> String {
        let Some(shift) = self.shift_s else {
            return "places: by the length along the feed moves of the program".to_owned();
        };
        let start = format!("shift: the first cut begins at {shift:.4} s of the log");
        let Some(found) = &self.matched else {
            return format!("{start}, as stated");
        };
        let next = match found.next {
            Some([other, also]) => format!("the next best {also:.3} at {other:.3} s"),
            None => "no other peak".to_owned(),
        };
        format!(
            "{start}, found by correlation of the force with the program ({:.3}; {next}; known to within {:.4} s)",
            found.correlation, found.within_s
        )
    }
}
