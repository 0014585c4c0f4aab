//! The turns that were chosen along a path. Plain data, units in the names.

use serde::Serialize;

use crate::number::counted;

/// The turn at a station.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct TurnStation {
    /// Line of the program, from 1.
    pub line: usize,
    /// Program coordinates, mm.
    pub position_mm: [f64; 3],
    /// Way along the path, mm; a move that turns the axis of the tool counts at least 1 mm by degree.
    pub way_mm: f64,
    /// The turn of the tool about its own axis, deg, without jumps of 360.
    pub turn_deg: f64,
    /// Joint values, deg.
    pub joints_deg: [f64; 6],
    /// The joint nearest to a limit, from 0, and how far it is from it, deg; `None` if no joint has limits.
    pub nearest_limit: Option<(usize, f64)>,
    /// Smallest singular value.
    pub smallest_singular_value: f64,
    /// The compliance that a criterion asked for, m/N; 0 without one.
    pub compliance_m_per_n: f64,
    /// The tool goes here from the station before on a way that the program does not state.
    pub after_break: bool,
}

/// Cost of the turns along a path, and their evenness.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct TurnFigures {
    /// The criteria by their weights, in the mean over the length.
    pub cost: f64,
    /// The fastest turn between two stations, deg/mm.
    pub largest_rate_deg_per_mm: f64,
    /// Largest change of that rate from one station to the next, deg/mm.
    pub largest_rate_change_deg_per_mm: f64,
}

/// A turn that stays the same along the whole path, for comparison; looked at at the stations alone.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ConstantTurn {
    /// The turn, deg.
    pub turn_deg: f64,
    /// Cost of the turn; `None` if it does not go all the way.
    pub cost: Option<f64>,
    /// Share of the way that it covers from the start.
    pub share_of_way: f64,
    /// Smallest singular value on the way that it covers, 0 where it covers none.
    pub smallest_singular_value: f64,
    /// Line where it ends, if it does.
    pub ends_on_line: Option<usize>,
}

/// A turn at a station in the configuration that was chosen, for a picture.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct TurnCell {
    /// Smallest singular value.
    pub smallest_singular_value: f64,
    /// Share of half its range by which the joint nearest to a limit is off the middle; 1 at a limit.
    pub share_of_range: f64,
}

/// All turns of the band at all stations, in the configuration that was chosen.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct TurnMap {
    /// Turns of the band, deg, ascending.
    pub turns_deg: Vec<f64>,
    /// Cells by station, then by turn; `None` if the turn is not allowed.
    pub cells: Vec<Vec<Option<TurnCell>>>,
}

/// Turns of the tool along a path. Between stations the turn goes evenly with the way.
///
/// ```
/// use kinetostat_machining::{Placement, TurnTask, choose_turns};
/// use kinetostat_program::{Program, ReadOptions, interpret};
/// use nalgebra::{UnitQuaternion, vector};
///
/// let tilt = UnitQuaternion::from_euler_angles(0.0, 0.5 * std::f64::consts::PI, 0.0);
/// let tool = kinetostat::Pose::from_parts(vector![0.2, 0.0, 0.1].into(), tilt); // m
/// let arm = kinetostat_model::Model::preset("heavy_6r")?.mechanism.with_tool(&tool);
/// let program = Program::read("G21 G90\nG0 X0 Y0 Z0\nG1 X100 F600\n")?;
/// let path = interpret(&program, &ReadOptions::default())?;
/// let mut placement = Placement::at(vector![1.3, -0.2, 0.8]);
/// placement.tool_orientation = UnitQuaternion::from_euler_angles(std::f64::consts::PI, 0.0, 0.0);
/// let choice = choose_turns(&TurnTask::new(&arm, &path, placement))?;
///
/// let [a, b] = [&choice.stations[3], &choice.stations[4]];
/// let between = choice.turn_at_deg(0.5 * (a.way_mm + b.way_mm));
/// assert!((between - 0.5 * (a.turn_deg + b.turn_deg)).abs() < 1e-9);
/// assert!(choice.description().starts_with("The tool "));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct TurnChoice {
    /// Distance of stations along the path, mm; a little less if the path is no multiple of it.
    pub station_mm: f64,
    /// Stations in the order of the path.
    pub stations: Vec<TurnStation>,
    /// The configuration of the arm all along, by its [number](crate::ArmConfiguration::number).
    pub configuration: u8,
    /// Cost of the choice: the criteria by their weights, in the mean over the length.
    pub cost: f64,
    /// The fastest turn between two stations, deg/mm.
    pub largest_rate_deg_per_mm: f64,
    /// Largest change of that rate from one station to the next, deg/mm.
    pub largest_rate_change_deg_per_mm: f64,
    /// Figures of the steps of the band from which it was made smooth; `None` for a task that asks for those
    /// ([`TurnCurve::Steps`](crate::TurnCurve::Steps)).
    pub in_steps: Option<TurnFigures>,
    /// Length by which velocities are divided in singular values, m: the mean of upper arm and forearm (to the centre of the
    /// wrist).
    pub length_m: f64,
    /// Smallest singular value at stations and between them.
    pub smallest_singular_value: f64,
    /// Line where that is.
    pub smallest_singular_value_line: usize,
    /// Smallest distance of a joint to a limit, at stations and between them: joint (from 0), distance (deg) and line; `None` if no
    /// joint has limits.
    pub nearest_limit: Option<(usize, f64, usize)>,
    /// Pairs of postures that would have been cheaper, but leave what is allowed between their stations.
    pub broken_links: usize,
    /// Turns of the band that are tried, and postures that were found for them at all stations.
    pub tried: (usize, usize),
    /// The turn of the band that is nearest to none, all along.
    pub as_programmed: Option<ConstantTurn>,
    /// The cheapest constant turn of the band, or the one that goes farthest.
    pub best_constant: Option<ConstantTurn>,
    /// Map for a picture.
    pub map: TurnMap,
}

impl TurnChoice {
    /// The turn after so many mm of the way, deg; before the first station and behind the last one as there. At a jump, where the
    /// program does not state the way, it is the turn after it.
    #[must_use]
    pub fn turn_at_deg(&self, way_mm: f64) -> f64 {
        let after = self.stations.partition_point(|s| s.way_mm <= way_mm);
        self.turn_between(after, way_mm)
    }

    /// Turn at a place, that before a change of the turn.
    pub(crate) fn turn_before_deg(&self, way_mm: f64) -> f64 {
        let after = self.stations.partition_point(|s| s.way_mm < way_mm);
        self.turn_between(after, way_mm)
    }

    fn turn_between(&self, after: usize, way_mm: f64) -> f64 {
        let before = after
            .checked_sub(1)
            .and_then(|index| self.stations.get(index));
        match (before, self.stations.get(after)) {
            (Some(a), Some(b)) => {
                let share = (way_mm - a.way_mm) / (b.way_mm - a.way_mm);
                a.turn_deg + share * (b.turn_deg - a.turn_deg)
            }
            (Some(one), None) | (None, Some(one)) => one.turn_deg,
            (None, None) => 0.0,
        }
    }

    /// Sentence on the gain in evenness over the steps of the band.
    fn smoothing(&self) -> String {
        let Some(steps) = self.in_steps else {
            return String::new();
        };
        let [own, steps] = [
            self.largest_rate_change_deg_per_mm,
            steps.largest_rate_change_deg_per_mm,
        ];
        if own >= steps {
            return String::new();
        }
        format!(
            ". From one station to the next its rate changes by at most {own:.3} deg/mm ({steps:.3} in the steps of the band)"
        )
    }

    /// Choice and its figures, in sentences.
    #[must_use]
    pub fn description(&self) -> String {
        let turns = self.stations.iter().map(|station| station.turn_deg);
        let low = turns.clone().fold(f64::INFINITY, crate::number::smaller);
        let high = turns.fold(f64::NEG_INFINITY, crate::number::larger);
        let turned = match high - low < 1e-9 {
            true => format!(
                "The tool is turned by {:.1} deg about its own axis throughout",
                low + 0.0
            ),
            false => format!(
                "The tool turns between {low:.1} and {high:.1} deg about its own axis, by at most {:.3} deg/mm",
                self.largest_rate_deg_per_mm
            ),
        };
        let chosen = format!(
            "{turned} ({}, {} mm apart); the smallest singular value is {:.4} (line {})",
            counted(self.stations.len(), "station"),
            self.station_mm,
            self.smallest_singular_value,
            self.smallest_singular_value_line
        );
        let constant = match self.best_constant {
            Some(ConstantTurn {
                turn_deg,
                cost: Some(cost),
                smallest_singular_value,
                ..
            }) if high - low >= 1e-9 => format!(
                ". The best constant turn, {turn_deg:.1} deg, costs {cost:.4} instead of {:.4}, with {smallest_singular_value:.4}",
                self.cost
            ),
            Some(ConstantTurn { cost: Some(_), .. }) => String::new(),
            Some(best) => format!(
                ". No constant turn goes all the way: the best, {:.1} deg, ends after {:.0} % of it",
                best.turn_deg,
                100.0 * best.share_of_way
            ),
            None => String::new(),
        };
        let smoothing = match high - low < 1e-9 {
            true => String::new(),
            false => self.smoothing(),
        };
        chosen + &smoothing + &constant
    }
}
