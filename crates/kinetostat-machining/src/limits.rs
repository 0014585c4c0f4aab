//! Limits of a correction. A program that leaves these limits is not written: something in the question is most
//! likely wrong, a unit, a sign, a decimal point. Each limit can be moved by its name where the figure is meant.

use std::fmt;

use kinetostat::number::{self, Rounding, short};
use serde::{Deserialize, Serialize};

/// Limits of a run, by name; units in the names.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Limits {
    /// Largest correction of a place, mm, without the part that makes up for the machine's own weight.
    /// Default 2.
    pub correction_mm: f64,
    /// Maximum deflection of the tool by the machine's own weight and the loads of its model, mm. Default 5.
    pub own_weight_mm: f64,
    /// Largest tilt of the tool that stays, degrees. Default 1.
    pub tilt_deg: f64,
    /// Largest force on the tool, N. Default 5000.
    pub force_n: f64,
    /// Largest moment on the tool about its tip, N m. Default 200.
    pub moment_n_m: f64,
    /// Largest force or torque of a drive by its rating, 1 is the rating. Default 1.
    pub share_of_rating: f64,
    /// Largest share of the way to buckling, 1 is buckling. Default 0.5.
    pub share_of_buckling: f64,
    /// Maximum block rate of the written program, blocks per second. Default 2000.
    pub blocks_per_second: f64,
    /// Shortest tool, mm; a tool that is not there (length 0) is none. Default 1.
    pub shortest_tool_mm: f64,
    /// Longest tool, mm. Default 1000.
    pub longest_tool_mm: f64,
    /// Nearest place of a base to the zero of its robot, mm; a base at zero is none. Default 10.
    pub nearest_base_mm: f64,
    /// Maximum depth of the program's zero below the base of a machine that works above it, mm. Default 400: risers of
    /// arms are up to 1 m high, and tables with their vice at least 0.6 m.
    pub below_base_mm: f64,
    /// Fastest feed, mm/s. Default 3000: `$VEL.CP` of KRL takes no more, and the fastest cuts (foam) have a tenth of it.
    pub speed_mm_per_s: f64,
    /// Largest rounding of corners at feed, mm. Default 5: it leaves a right angle by 1.8 mm, nearly the whole `correction_mm`,
    /// and is the coarsest zone that roughing in foam has (z5 of RAPID).
    pub zone_mm: f64,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            correction_mm: 2.0,
            own_weight_mm: 5.0,
            tilt_deg: 1.0,
            force_n: 5000.0,
            moment_n_m: 200.0,
            share_of_rating: 1.0,
            share_of_buckling: 0.5,
            blocks_per_second: 2000.0,
            shortest_tool_mm: 1.0,
            longest_tool_mm: 1000.0,
            nearest_base_mm: 10.0,
            below_base_mm: 400.0,
            speed_mm_per_s: 3000.0,
            zone_mm: 5.0,
        }
    }
}

/// Description of one of the [`Limits`]: its name, its unit, its subject, and its range.
#[derive(Clone, Copy)]
pub struct Limit {
    /// Name, the key under `[limits]` of a job file and the word of `--limit NAME=VALUE`.
    pub name: &'static str,
    /// Unit of its value; empty for shares.
    pub unit: &'static str,
    /// Figure that it bounds, as the subject of a sentence.
    pub what: &'static str,
    /// Usual values and their reason.
    pub usual: &'static str,
    /// The least and the largest value that it can be given.
    pub range: [f64; 2],
    value: fn(&mut Limits) -> &mut f64,
}

impl fmt::Debug for Limit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name)
    }
}

impl Limit {
    /// True if it can be given that value.
    #[must_use]
    pub fn takes(&self, value: f64) -> bool {
        (self.range[0]..=self.range[1]).contains(&value)
    }

    /// True if it bounds a figure of the question, not one of the answer.
    pub(crate) fn stated(&self) -> bool {
        let of_question = ["force_n", "moment_n_m", "speed_mm_per_s", "zone_mm"];
        of_question.contains(&self.name)
            || self.name.ends_with("tool_mm")
            || self.name.ends_with("base_mm")
    }

    /// True if it bounds its figure from below.
    fn is_least(&self) -> bool {
        self.name.starts_with("shortest") || self.name.starts_with("nearest")
    }

    /// A value with the limit's unit.
    #[must_use]
    pub fn with_unit(&self, value: impl fmt::Display) -> String {
        number::with_unit(&value.to_string(), self.unit)
    }

    /// The values that it can be given: "0.000001 to 1000000 mm can be allowed".
    #[must_use]
    pub fn range_description(&self) -> String {
        let [least, most] = self.range;
        format!("{least} to {} can be allowed", self.with_unit(most))
    }
}

impl PartialEq for Limit {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

/// Deflections of a tool, mm: above zero, since nothing would be allowed otherwise, and at most the largest
/// coordinate of a program.
const LENGTHS: [f64; 2] = [1e-6, 1e6];

/// Loads, N and N m.
const LOADS: [f64; 2] = [1e-3, 1e9];

/// Shares of a rating or of the way to buckling.
const SHARES: [f64; 2] = [1e-3, 1e3];

/// Places of parts, mm.
const PLACES: [f64; 2] = [0.0, 1e6];

/// Lengths of tools, mm; negative where the flange's z axis points into the machine.
const TOOLS: [f64; 2] = [-2e5, 2e5];

macro_rules! limit {
    ($name:ident, $unit:literal, $range:expr, $what:literal, $usual:literal) => {
        Limit {
            name: stringify!($name),
            unit: $unit,
            what: $what,
            usual: $usual,
            range: $range,
            value: |limits| &mut limits.$name,
        }
    };
}

impl Limits {
    /// All limits, as messages list them.
    pub const ALL: [Limit; 14] = [
        limit!(
            correction_mm,
            "mm",
            LENGTHS,
            "the correction",
            "arms give way by 0.1 to 1 mm under a cutting force, parallel machines by hundredths; more is mostly a wrong unit (N m per degree, micrometres for mm), or a table of places instead of differences"
        ),
        limit!(
            own_weight_mm,
            "mm",
            LENGTHS,
            "the displacement of the tool by the machine's own weight and the loads of its model",
            "heavy arms sag by 0.5 to 3 mm with a spindle in their hand, parallel machines by hundredths; more is mostly a wrong mass or stiffness"
        ),
        limit!(
            tilt_deg,
            "deg",
            [1e-6, 180.0],
            "the tilt of the tool",
            "cutting tilts a tool by hundredths of a degree, on soft arms by tenths; a program of positions cannot correct it"
        ),
        limit!(
            force_n,
            "N",
            LOADS,
            "the force on the tool",
            "robots mill with 50 to 1000 N and drill with up to 3000 N"
        ),
        limit!(
            moment_n_m,
            "N m",
            LOADS,
            "the moment on the tool",
            "cutting torques are 0.1 to 100 N m; the unit is N m, not N mm"
        ),
        limit!(
            share_of_rating,
            "",
            SHARES,
            "the load of a drive as a share of its rating",
            "a drive carries at most its rating, cutting force and weights together"
        ),
        limit!(
            share_of_buckling,
            "",
            SHARES,
            "the share of the way to buckling",
            "columns are loaded to at most a half, better a fifth, of their buckling load; stiffness falls on the way"
        ),
        limit!(
            blocks_per_second,
            "1/s",
            [0.1, 1e6],
            "the number of blocks per second",
            "controllers of robots take 50 to 250 blocks per second, those of machine tools 500 to 2000"
        ),
        limit!(
            shortest_tool_mm,
            "mm",
            TOOLS,
            "the tool's length",
            "tools with their holders are 20 to 400 mm long, from the flange outward; millimetres, not metres. Where the flange's z axis points into the machine, a negative length is meant"
        ),
        limit!(
            longest_tool_mm,
            "mm",
            TOOLS,
            "the tool's length",
            "tools with their holders are 20 to 400 mm long, with a spindle between up to 800 mm"
        ),
        limit!(
            nearest_base_mm,
            "mm",
            PLACES,
            "the distance of the base from the robot's zero",
            "parts lie 300 to 3000 mm from the zero of a robot; millimetres, not metres"
        ),
        limit!(
            below_base_mm,
            "mm",
            PLACES,
            "the depth of the program's zero below the machine's base",
            "parts lie above the foot of an arm, or up to 300 mm below it where the arm stands on a pedestal; check the sign of part_origin_mm"
        ),
        limit!(
            speed_mm_per_s,
            "mm/s",
            [1e-3, 1e6],
            "the speed at feed",
            "robots cut with 1 to 300 mm/s and move with up to 2000 mm/s; of faster ways through the air a job says so (rapid_from_mm_per_s); $VEL.CP of KRL is in m/s, F of G-code in mm/min"
        ),
        limit!(
            zone_mm,
            "mm",
            [0.0, 200.0],
            "the rounding of corners at feed (feeds_mm)",
            "cuts are rounded within 0 to 1 mm; a corner is cut by about a third of the zone"
        ),
    ];

    /// The entry of [`Self::ALL`] with this name; `None` if no limit is called so.
    #[must_use]
    pub fn named(name: &str) -> Option<Limit> {
        Self::ALL.into_iter().find(|limit| limit.name == name)
    }

    /// Value of a limit, in its unit.
    #[must_use]
    pub fn get(&self, limit: Limit) -> f64 {
        let mut own = *self;
        *(limit.value)(&mut own)
    }

    /// A figure beyond the limit of that name, or NaN; `None` within it.
    #[must_use]
    pub fn beyond(
        &self,
        name: &str,
        found: f64,
        line: Option<usize>,
        place: &str,
    ) -> Option<Beyond> {
        let limit = Self::named(name)?;
        let allowed = self.get(limit);
        let is_within = match limit.is_least() {
            true => found >= allowed,
            false => found <= allowed,
        };
        (!is_within).then(|| Beyond {
            limit,
            found,
            allowed,
            line,
            place: place.to_owned(),
        })
    }

    /// Sets a limit to a value in its unit, which is not compared with its range.
    pub fn set(&mut self, limit: Limit, value: f64) {
        *(limit.value)(self) = value;
    }
}

/// A figure beyond its limit.
#[derive(Clone, Debug, PartialEq)]
pub struct Beyond {
    /// The limit, whose unit `found` and `allowed` have.
    pub limit: Limit,
    /// Value found, in the limit's unit.
    pub found: f64,
    /// Value of the limit: the largest one allowed, for the shortest tool the least one.
    pub allowed: f64,
    /// Line of the program, from 1; `None` if it concerns all of it.
    pub line: Option<usize>,
    /// Place in words, drive or direction; may be empty.
    pub place: String,
}

impl Beyond {
    /// The option that would allow it: a value a little beyond what was found.
    fn allowing(&self) -> f64 {
        let [least, most] = self.limit.range;
        let room = if self.found < self.allowed {
            self.found - 0.05 * self.found.abs()
        } else {
            1.05 * self.found
        };
        let unit = 10_f64.powf(room.abs().max(1e-9).log10().floor() - 1.0);
        let value = match self.found < self.allowed {
            true => (room / unit).floor() * unit,
            false => (room / unit).ceil() * unit,
        };
        value.clamp(least, most)
    }
}

/// A figure and the bound that it leaves, with as many digits as tell them apart. A stated value is shown as it was
/// stated; a computed one is rounded away from its bound, like the largest values beside it.
pub(crate) fn apart(found: f64, allowed: f64, stated: bool) -> (String, String) {
    let rounding = match (stated, found < allowed) {
        (true, _) => Rounding::Nearest,
        (false, true) => Rounding::Down,
        (false, false) => Rounding::Up,
    };
    let shown = |digits: usize| {
        let found = number::significant(found, digits, rounding);
        (
            number::without_zeros(&found).to_owned(),
            number::trimmed(allowed, digits),
        )
    };
    let mut all = (number::DIGITS..=17).map(shown);
    let shown_apart = all.find(|(found, allowed)| found != allowed);
    shown_apart.unwrap_or_else(|| shown(number::DIGITS))
}

impl Beyond {
    /// Value found, allowed and usual values, without the option that would allow it.
    #[must_use]
    pub fn description(&self) -> String {
        let line = self
            .line
            .map_or_else(String::new, |line| format!("line {line}: "));
        let unit = match self.limit.unit {
            "" => String::new(),
            unit => format!(" {unit}"),
        };
        let place = match self.place.as_str() {
            "" => String::new(),
            place => format!(" ({place})"),
        };
        let side = if self.found < self.allowed {
            "less"
        } else {
            "more"
        };
        let (found, allowed) = apart(self.found, self.allowed, self.limit.stated());
        format!(
            "{line}{}{place} is {found}{unit}, {side} than the {allowed}{unit} that are allowed. Usual: {}",
            self.limit.what, self.limit.usual,
        )
    }
}

impl fmt::Display for Beyond {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let value = short(self.allowing());
        let name = self.limit.name;
        write!(
            f,
            "{}. If it is meant, write  --limit {name}={value}  or, in the job file under [limits],  {name} = {value}",
            self.description()
        )
    }
}
