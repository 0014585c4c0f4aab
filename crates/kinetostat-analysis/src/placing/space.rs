//! Search space of a part's placement: ranges of its place and turns, and fixtures.

use kinetostat::Pose;
use kinetostat_machining::Placement;
use nalgebra::{UnitQuaternion, Vector3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Variable of a placement.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, JsonSchema, Deserialize,
)]
pub enum Variable {
    /// Program's zero along x of the base, mm.
    #[serde(rename = "x_mm")]
    X,
    /// Program's zero along y of the base, mm.
    #[serde(rename = "y_mm")]
    Y,
    /// Program's zero along z of the base, mm.
    #[serde(rename = "z_mm")]
    Z,
    /// Turn of the part about x of the base through the program's zero, on top of its orientation, deg.
    #[serde(rename = "turn_x_deg")]
    TurnX,
    /// Turn of the part about y, after that about x.
    #[serde(rename = "turn_y_deg")]
    TurnY,
    /// Turn of the part about z, after both.
    #[serde(rename = "turn_z_deg")]
    TurnZ,
    /// Turn of the tool about its own axis, right-handed, deg.
    #[serde(rename = "turn_tool_deg")]
    TurnTool,
}

impl Variable {
    /// All of them, in the order in which answers list them.
    pub const ALL: [Self; 7] = [
        Self::X,
        Self::Y,
        Self::Z,
        Self::TurnX,
        Self::TurnY,
        Self::TurnZ,
        Self::TurnTool,
    ];

    /// Name with its unit, as in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::X => "x_mm",
            Self::Y => "y_mm",
            Self::Z => "z_mm",
            Self::TurnX => "turn_x_deg",
            Self::TurnY => "turn_y_deg",
            Self::TurnZ => "turn_z_deg",
            Self::TurnTool => "turn_tool_deg",
        }
    }

    /// Variable in words.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::X => "x",
            Self::Y => "y",
            Self::Z => "z",
            Self::TurnX => "turn about x",
            Self::TurnY => "turn about y",
            Self::TurnZ => "turn about z",
            Self::TurnTool => "turn of the tool",
        }
    }

    /// Unit of the variable.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::X | Self::Y | Self::Z => "mm",
            _ => "deg",
        }
    }
}

/// Range of a variable.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Range {
    /// Variable of the range.
    pub variable: Variable,
    /// Smallest value, mm or deg.
    pub from: f64,
    /// Largest value.
    pub to: f64,
}

/// A place where the part can be clamped.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Fixture {
    /// Name of the fixture.
    pub name: String,
    /// Program's zero there, base axes, mm.
    pub origin_mm: [f64; 3],
    /// Orientation of the program's axes there, base from part; that of the placement as given if none is stated.
    pub orientation: Option<UnitQuaternion<f64>>,
}

/// Error of a search space.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SpaceError {
    /// Nothing is free.
    #[error(
        "nothing about the placement is free: give a range (--x-mm FROM TO, --turn-z-deg FROM TO, ...), or several fixtures"
    )]
    NothingFree,
    /// The range is invalid.
    #[error(
        "{name} from {from} to {to}: finite numbers are needed, and the second above the first"
    )]
    NoRange {
        /// Name of the variable.
        name: &'static str,
        /// Start as given.
        from: f64,
        /// End as given.
        to: f64,
    },
    /// A variable twice.
    #[error("{0} is given twice")]
    Twice(&'static str),
    /// Fixtures say where the part lies.
    #[error("{0}: fixtures say where the part lies; only turns can have a range beside them")]
    BesideFixtures(&'static str),
    /// Two fixtures have the same name.
    #[error("two fixtures are called '{0}': give each a name of its own")]
    SameName(String),
    /// The program states how the tool stands.
    #[error(
        "turn_tool_deg: the program states the orientation of the tool itself, so that no turn of it is free here; `kinetostat deflect --free-turn` chooses one along its path"
    )]
    StatedOrientation,
}

/// Search space of a part's placement.
#[derive(Clone, Debug)]
pub struct Space {
    given: Placement,
    fixtures: Vec<Fixture>,
    ranges: Vec<Range>,
}

/// A placement in a [`Space`].
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    /// Index of the fixture; 0 if there are none.
    pub fixture: usize,
    /// Value of every range, mm or deg.
    pub values: Vec<f64>,
}

/// Values are looked at in so many steps of a millimetre or degree, so that what is said is what was solved.
const STEPS_OF_ONE: f64 = 100.0;

impl Space {
    /// Around a placement that says all that has no range. `states_orientation`: the program states how the tool stands.
    ///
    /// # Errors
    /// [`SpaceError`].
    pub fn new(
        given: Placement,
        mut ranges: Vec<Range>,
        mut fixtures: Vec<Fixture>,
        states_orientation: bool,
    ) -> Result<Self, SpaceError> {
        ranges.sort_by_key(|range| range.variable);
        for range in &ranges {
            let Range { variable, from, to } = *range;
            let name = variable.name();
            if !(from.is_finite() && to.is_finite() && from < to) {
                return Err(SpaceError::NoRange { name, from, to });
            }
            if ranges.iter().filter(|r| r.variable == variable).count() > 1 {
                return Err(SpaceError::Twice(name));
            }
            if !fixtures.is_empty() && variable.unit() == "mm" {
                return Err(SpaceError::BesideFixtures(name));
            }
            if variable == Variable::TurnTool && states_orientation {
                return Err(SpaceError::StatedOrientation);
            }
        }
        // The answer does not depend on the order in which they are named.
        fixtures.sort_by(|a, b| a.name.cmp(&b.name));
        if let Some(pair) = fixtures
            .windows(2)
            .find(|pair| pair[0].name == pair[1].name)
        {
            return Err(SpaceError::SameName(pair[0].name.clone()));
        }
        if ranges.is_empty() && fixtures.len() < 2 {
            return Err(SpaceError::NothingFree);
        }
        Ok(Self {
            given,
            fixtures,
            ranges,
        })
    }

    /// The placement around which it lies.
    #[must_use]
    pub fn given(&self) -> &Placement {
        &self.given
    }

    /// Ranges, in the order of [`Variable::ALL`].
    #[must_use]
    pub fn ranges(&self) -> &[Range] {
        &self.ranges
    }

    /// Fixtures, by name.
    #[must_use]
    pub fn fixtures(&self) -> &[Fixture] {
        &self.fixtures
    }

    /// Name of the fixture of a placement; `None` if there are none.
    #[must_use]
    pub fn fixture_of(&self, place: &Place) -> Option<&str> {
        let fixture = self.fixtures.get(place.fixture);
        fixture.map(|fixture| fixture.name.as_str())
    }

    /// The placement at shares (0 to 1) of all ranges, to a hundredth of a millimetre or degree.
    #[must_use]
    pub fn at(&self, fixture: usize, shares: &[f64]) -> Place {
        let value = |(range, share): (&Range, &f64)| {
            let value = range.from + share.clamp(0.0, 1.0) * (range.to - range.from);
            ((value * STEPS_OF_ONE).round() / STEPS_OF_ONE).clamp(range.from, range.to)
        };
        Place {
            fixture,
            values: self.ranges.iter().zip(shares).map(value).collect(),
        }
    }

    /// Shares of all ranges at a placement.
    #[must_use]
    pub fn shares(&self, place: &Place) -> Vec<f64> {
        let share = |(range, value): (&Range, &f64)| (value - range.from) / (range.to - range.from);
        self.ranges.iter().zip(&place.values).map(share).collect()
    }

    /// Placement in the middle of all ranges, at the first fixture.
    #[must_use]
    pub fn centre(&self) -> Place {
        self.at(0, &vec![0.5; self.ranges.len()])
    }

    /// Distance of two placements: root mean square of the differences by the ranges; infinite between fixtures.
    #[must_use]
    pub fn distance(&self, a: &Place, b: &Place) -> f64 {
        if a.fixture != b.fixture {
            return f64::INFINITY;
        }
        let (a, b) = (self.shares(a), self.shares(b));
        let squares: f64 = a.iter().zip(&b).map(|(a, b)| (a - b).powi(2)).sum();
        (squares / self.ranges.len().max(1) as f64).sqrt()
    }

    /// Placement of the program for a place. The tool keeps its axis in the part, and is not turned about it more than
    /// that needs.
    #[must_use]
    pub fn placement(&self, place: &Place) -> Placement {
        let fixture = self.fixtures.get(place.fixture);
        let given = self.given.base_from_part;
        let mut origin_mm = given.translation.vector * 1e3;
        if let Some(fixture) = fixture {
            origin_mm = fixture.origin_mm.into();
        }
        let (mut turns, mut of_tool) = (Vector3::zeros(), 0.0);
        for (range, value) in self.ranges.iter().zip(&place.values) {
            match range.variable {
                Variable::X => origin_mm.x = *value,
                Variable::Y => origin_mm.y = *value,
                Variable::Z => origin_mm.z = *value,
                Variable::TurnX => turns.x = value.to_radians(),
                Variable::TurnY => turns.y = value.to_radians(),
                Variable::TurnZ => turns.z = value.to_radians(),
                Variable::TurnTool => of_tool = value.to_radians(),
            }
        }
        let turn = UnitQuaternion::from_euler_angles(turns.x, turns.y, turns.z);
        let clamped = fixture.and_then(|fixture| fixture.orientation);
        let clamped = clamped.unwrap_or(given.rotation);
        let rotation = turn * clamped;
        let carried = rotation * given.rotation.inverse();
        let held = self.given.tool_orientation;
        let axis = held * Vector3::z();
        // The shortest rotation is ambiguous for a tool that is turned over: its own x is taken.
        let tilt = UnitQuaternion::rotation_between(&axis, &(carried * axis));
        let over =
            || UnitQuaternion::from_axis_angle(&(held * Vector3::x_axis()), std::f64::consts::PI);
        let own = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), of_tool);
        Placement {
            base_from_part: Pose::from_parts((1e-3 * origin_mm).into(), rotation),
            tool_orientation: tilt.unwrap_or_else(over) * held * own,
            ..self.given
        }
    }
}
