//! Report on the processing of measured forces.

use kinetostat_cutting::{ConditioningReport, ShiftMatch};
use serde::{Deserialize, Serialize};

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
