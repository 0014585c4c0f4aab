//! Chatter of a program, and forced vibration by its teeth where it does not chatter. Plain data, units in the names; the
//! crate `kinetostat-analysis` finds it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::number::{Rounding, significant};

/// A place in the cut that was judged for those like it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, JsonSchema, Deserialize)]
pub struct ChatterPlace {
    /// Line of the program, from 1.
    pub line: usize,
    /// Range along the path of the places that it stands for, mm.
    pub path_mm: [f64; 2],
    /// Speed of the spindle, rpm.
    pub rpm: f64,
    /// Depth of the program, mm.
    pub depth_mm: f64,
    /// True if it chatters; `None` if nothing can be said.
    pub chatters: Option<bool>,
    /// Depth at which it chatters at this speed, mm; `None` if it does not up to `looked_up_to_mm`.
    pub limit_mm: Option<f64>,
    /// Largest depth that was looked at, mm.
    pub looked_up_to_mm: f64,
    /// Frequency of the chatter at the limit, Hz.
    pub chatter_hz: Option<f64>,
    /// Lowest frequency of the machine there, Hz.
    pub first_hz: Option<f64>,
    /// Frequency of the fastest mode that swings in the calculation, Hz; those above count by their flexibility at rest.
    #[serde(default)]
    pub modes_up_to_hz: Option<f64>,
    /// Relative uncertainty of the cutting force law, percent.
    #[serde(default)]
    pub force_spread_percent: f64,
    /// Forced vibration of the tip about its mean place, root of the mean square, um; `None` if it chatters.
    pub vibration_rms_um: Option<f64>,
    /// Strongest frequency of the vibration, Hz.
    pub strongest_hz: Option<f64>,
    /// The machine's mode next to that, Hz.
    pub nearest_mode_hz: Option<f64>,
    /// The larger error that it leaves on a wall, um, positive where the tool cuts too deep; `None` if the cut makes no wall.
    pub wall_um: Option<f64>,
}

/// Lines in a row that chatter, and what would not.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, JsonSchema, Deserialize)]
pub struct ChatterLines {
    /// First and last line, from 1.
    pub lines: [usize; 2],
    /// Speed of the program, rpm.
    pub rpm: f64,
    /// Largest depth of the program there, mm.
    pub depth_mm: f64,
    /// Depth that does not chatter anywhere there at this speed, mm.
    pub stable_depth_mm: f64,
    /// Spindle speed at which the depths of the program with its feeds per tooth do not chatter, rpm: the nearest one with stable
    /// speeds beside it; none of those from half to one and a half times that of the program in steps of 5 %, or not tried.
    pub stable_rpm: Option<f64>,
    /// A speed beside it, 5 % away, chatters; of such ones it is that with the largest limit.
    #[serde(default)]
    pub stable_speed_is_narrow: bool,
    /// Feed that keeps the feed per tooth at that speed, mm/min; `None` if the feed per tooth changes along the lines.
    #[serde(default)]
    pub stable_feed_mm_per_min: Option<f64>,
    /// True if speeds were tried: they are for the worst lines.
    #[serde(default)]
    pub speeds_tried: bool,
    /// Frequency of the chatter, Hz.
    pub chatter_hz: f64,
}

/// Chatter of a program.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema, Deserialize)]
pub struct ChatterResult {
    /// Damping of the machine, in words.
    pub damping: String,
    /// Places of the program at which the tool cuts.
    pub places_in_cut: usize,
    /// Places that were judged, each for all that are like it.
    pub places_judged: usize,
    /// Stretches that chatter, in the order of the program.
    pub stretches: Vec<ChatterLines>,
    /// The place with the least limit by its depth.
    pub nearest: Option<ChatterPlace>,
    /// Place of the largest forced vibration.
    pub most_shaken: Option<ChatterPlace>,
    /// Place at which that leaves the largest error on a wall.
    pub worst_wall: Option<ChatterPlace>,
    /// All places, in the order of the path.
    pub places: Vec<ChatterPlace>,
}

impl ChatterPlace {
    /// Depth at which it chatters if the force is larger by its spread, mm.
    #[must_use]
    pub fn limit_with_more_force_mm(&self) -> Option<f64> {
        // The force is the product of depth and law.
        Some(self.limit_mm? / (1.0 + 0.01 * self.force_spread_percent))
    }

    /// True if it does not chatter with the law of the force as it is, but would with a force larger by its spread.
    #[must_use]
    pub fn is_within_spread(&self) -> bool {
        let limit = self.limit_with_more_force_mm();
        self.chatters == Some(false) && limit.is_some_and(|limit| limit <= self.depth_mm)
    }
}

impl ChatterResult {
    /// Number of places without an answer.
    ///
    /// ```
    /// use kinetostat_machining::ChatterResult;
    ///
    /// assert_eq!(ChatterResult::default().without_answer(), 0);
    /// ```
    #[must_use]
    pub fn without_answer(&self) -> usize {
        let places = self.places.iter();
        places.filter(|place| place.chatters.is_none()).count()
    }

    /// Sentence on chatter anywhere in the program.
    #[must_use]
    pub fn verdict_text(&self) -> String {
        let within = self.places.iter().filter(|p| p.is_within_spread()).count();
        let spread = match within {
            0 => String::new(),
            _ => format!(
                " At {within} of {} judged places the limit lies within the spread of the force's law: with a force that much larger they chatter.",
                self.places_judged
            ),
        };
        self.verdict_alone() + &spread
    }

    fn verdict_alone(&self) -> String {
        match (self.stretches.len(), self.places_judged) {
            (0, 0) => "No place is judged.".to_owned(),
            (0, _) => match self.without_answer() {
                0 => "No judged place chatters.".to_owned(),
                1 => "No judged place chatters; one place has no answer.".to_owned(),
                count => format!("No judged place chatters; {count} places have no answer."),
            },
            (1, _) => "One stretch of the program chatters.".to_owned(),
            (count, _) => format!("{count} stretches of the program chatter."),
        }
    }

    /// The place with the least limit by its depth, in a sentence.
    #[must_use]
    pub fn nearest_text(&self) -> Option<String> {
        let place = self.nearest.as_ref()?;
        let first = place.first_hz.map_or_else(String::new, |first| {
            format!("; lowest frequency of the machine there {}", hertz(first))
        });
        let spread = match place.is_within_spread() {
            true => format!(
                " The force may be {} % more than its law says: then it chatters from {} on.",
                significant(place.force_spread_percent, 2, Rounding::Nearest),
                millimetres(place.limit_with_more_force_mm()?)
            ),
            false => String::new(),
        };
        Some(format!(
            "Nearest to its limit is line {}: it cuts {} deep at {} rpm, and chatters from {} on{first}.{spread}",
            place.line,
            millimetres(place.depth_mm),
            significant(place.rpm, 5, Rounding::Nearest),
            millimetres(place.limit_mm?),
        ))
    }

    /// Sentences on the largest forced vibration, and on the largest error that it leaves on a wall.
    #[must_use]
    pub fn vibration_text(&self) -> Option<String> {
        let place = self.most_shaken.as_ref()?;
        let mut text = format!(
            "Where it does not chatter, passing teeth shake the tip by up to {} (rms) about its mean place, on line {}: most of it at {}, beside a mode at {}.",
            micrometres(place.vibration_rms_um?),
            place.line,
            hertz(place.strongest_hz?),
            hertz(place.nearest_mode_hz?),
        );
        if let Some((place, wall)) = self.worst_wall.as_ref().and_then(|p| Some((p, p.wall_um?))) {
            text.push_str(&format!(
                " On a wall that leaves up to {} (line {}, {}), which no compensation takes away.",
                micrometres(wall.abs()),
                place.line,
                if wall > 0.0 {
                    "too deep"
                } else {
                    "left standing"
                }
            ));
        }
        Some(text)
    }
}

fn hertz(value: f64) -> String {
    format!("{} Hz", significant(value, 4, Rounding::Nearest))
}

fn millimetres(value: f64) -> String {
    format!("{} mm", significant(value, 4, Rounding::Nearest))
}

fn micrometres(value: f64) -> String {
    format!("{} um", significant(value, 3, Rounding::Nearest))
}
