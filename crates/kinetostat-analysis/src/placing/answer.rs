//! The answer of a search: plain data, units in the names.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Serialize;

use crate::placing::evaluate::OnAll;
use crate::placing::space::{Place, Space, Variable};
use crate::placing::value::{Refusal, Value};

/// A placement that was solved at all places of the program.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Candidate {
    /// Name of the fixture; `None` if there are none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fixture: Option<String>,
    /// Value of every variable that is free, by its name (mm or deg).
    #[serde(flatten)]
    pub values: BTreeMap<&'static str, f64>,
    /// Program's zero, base axes, mm.
    pub part_origin_mm: [f64; 3],
    /// Orientation of the program's axes in the base: unit quaternion w, x, y, z.
    pub part_orientation: [f64; 4],
    /// Orientation of the tool in the base, of programs that do not state it: w, x, y, z.
    pub tool_orientation: [f64; 4],
    /// The figure over the whole program, in its unit; `None` if it is refused.
    pub figure: Option<f64>,
    /// Reason for which it is refused.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub refusal: Option<Refusal>,
    /// Line of the program where the figure is largest, from 1.
    pub line: Option<usize>,
    /// Position in the program, mm.
    pub position_mm: Option<[f64; 3]>,
    /// The placement, for further questions.
    #[serde(skip)]
    pub place: Place,
}

impl Candidate {
    pub(crate) fn new(
        space: &Space,
        place: &Place,
        found: &OnAll,
        at: impl Fn(usize) -> (usize, [f64; 3]),
    ) -> Self {
        let lies = space.placement(place);
        let quaternion = |q: nalgebra::UnitQuaternion<f64>| [q.w, q.i, q.j, q.k];
        let names = space.ranges().iter().map(|range| range.variable.name());
        let worst = found.worst.map(at);
        Self {
            fixture: space.fixture_of(place).map(str::to_owned),
            values: names.zip(place.values.iter().copied()).collect(),
            part_origin_mm: (lies.base_from_part.translation.vector * 1e3)
                .map(|x| (1e6 * x).round() / 1e6 + 0.0)
                .into(),
            part_orientation: quaternion(lies.base_from_part.rotation),
            tool_orientation: quaternion(lies.tool_orientation),
            figure: found.value.figure(),
            refusal: match &found.value {
                Value::Refused(refusal) => Some(refusal.clone()),
                Value::Figure(_) => None,
            },
            line: worst.map(|(line, _)| line),
            position_mm: worst.map(|(_, position)| position),
            place: place.clone(),
        }
    }
}

/// A placement that was looked at on the way, at the places that the search looks at.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Evaluated {
    /// The placement.
    #[serde(skip)]
    pub place: Place,
    /// Value of the placement there.
    pub value: Value,
}

/// Sensitivity to one side of the best placement.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct SideSensitivity {
    /// Change of the figure by that of the variable close by, its unit per mm or deg; none at the end of the range, and where a program
    /// cannot be run there.
    pub slope: Option<f64>,
    /// Change of the variable until the figure is 5 % larger or the placement is refused, mm or deg; `None` if it may go to the end
    /// of its range.
    pub until_5_percent_worse: Option<f64>,
}

/// Sensitivity of the figure around the best placement to one variable.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Sensitivity {
    /// Variable that changes.
    pub variable: Variable,
    /// Sensitivity towards smaller values.
    pub down: SideSensitivity,
    /// Sensitivity towards larger ones.
    pub up: SideSensitivity,
}

/// The figure over two variables (or one), all others as in the best placement.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct MapPanel {
    /// Across and up; one alone is a curve.
    pub variables: Vec<Variable>,
    /// Values of the first.
    pub across: Vec<f64>,
    /// Values of the second; empty of a curve.
    pub up: Vec<f64>,
    /// Values of the placements, the first variable running fastest.
    #[serde(skip)]
    pub values: Vec<Value>,
}

/// Remark on an answer beside its figures, in words.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Finding {
    /// Kind: `at_bound`, `flat`, `few_reachable`, `thinned`, `not_better`.
    pub kind: &'static str,
    /// Remark in a sentence.
    pub message: String,
}

/// Explanation of a search without a placement that can be taken.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Nowhere {
    /// The one that is nearest to being taken, and why it is refused.
    pub nearest: Candidate,
    /// Displacement of the part from there with which all of it is reached, base axes, mm; `None` if none was found.
    pub move_mm: Option<[f64; 3]>,
}

/// Result of a search.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Placed {
    /// The best placement; `None` if none can be taken.
    pub best: Option<Candidate>,
    /// The next best ones, each apart from all before it.
    pub next_best: Vec<Candidate>,
    /// Placement in the middle of all ranges.
    pub centre: Candidate,
    /// The figure where the placement is as given; `None` if it is refused there.
    pub given: Option<f64>,
    /// Explanation, if no placement can be taken.
    pub nowhere: Option<Nowhere>,
    /// Around the best placement.
    pub sensitivity: Vec<Sensitivity>,
    /// Remarks in words.
    pub findings: Vec<Finding>,
    /// Placements that were looked at.
    pub evaluated: usize,
    /// Number of samples that can be taken.
    pub taken: usize,
    /// Number of samples that fill the space.
    pub samples: usize,
    /// Places of the program at which the best ones were solved.
    pub places: usize,
    /// Places at which all others were.
    pub places_of_search: usize,
    /// Slices through the best placement.
    pub maps: Vec<MapPanel>,
    /// The placements that fill the space.
    #[serde(skip)]
    pub filling: Vec<Evaluated>,
}
