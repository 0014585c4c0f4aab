//! Requests and answers of the page, stable names with units.

use kinetostat_report::{Scene, ShownPose};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::lobes::answer::{Best, Point};

/// A request that asks for nothing in particular.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Nothing {}

/// The machine of a session.
#[derive(Serialize, JsonSchema)]
pub(crate) struct MachineAnswer {
    pub(crate) name: String,
    pub(crate) description: Option<String>,
    /// Name on the command line: a preset, a model file, or a job file.
    pub(crate) source: String,
    pub(crate) actuators: Vec<ActuatorRange>,
    pub(crate) limbs: Vec<String>,
    /// Diagonal of the box around the machine at home.
    pub(crate) size_mm: f64,
    pub(crate) gravity_m_per_s2: [f64; 3],
    /// True if a program belongs to the session.
    pub(crate) has_path: bool,
    /// What a map of it can show.
    pub(crate) variables: Vec<MapVariable>,
    /// True if the model states how vibrations are damped.
    pub(crate) is_damped: bool,
    /// The model file.
    pub(crate) model_text: String,
    pub(crate) version: &'static str,
}

/// Range of an actuator.
#[derive(Serialize, JsonSchema)]
pub(crate) struct ActuatorRange {
    pub(crate) name: String,
    /// `mm` or `deg`.
    pub(crate) unit: &'static str,
    pub(crate) low: Option<f64>,
    pub(crate) high: Option<f64>,
    pub(crate) home: f64,
}

/// A state that is asked for: by joints, by the place of the tool, or as it is at a place of the program; at home without any.
#[derive(Clone, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct StateRequest {
    /// Values of all actuators, mm and deg.
    pub(crate) actuators: Option<Vec<f64>>,
    /// Place of the tool, base axes; orientation as at home, or the nearest that the machine can have there.
    pub(crate) at_mm: Option<[f64; 3]>,
    /// Index among the places of the program; its load acts.
    pub(crate) place: Option<usize>,
    pub(crate) force_n: Option<[f64; 3]>,
    pub(crate) moment_n_m: Option<[f64; 3]>,
}

/// A machine in a state under a load.
#[derive(Serialize, JsonSchema)]
pub(crate) struct StateAnswer {
    /// Values of all actuators, mm and deg.
    pub(crate) actuators: Vec<f64>,
    pub(crate) within_limits: bool,
    /// Pose as commanded.
    pub(crate) tool: ShownPose,
    pub(crate) tool_deflected: Option<ShownPose>,
    /// The machine as drawn and commanded, without a load.
    pub(crate) scene: Scene,
    /// In equilibrium under load and weights, with its deviations.
    pub(crate) deflected: Option<Scene>,
    pub(crate) force_n: [f64; 3],
    pub(crate) moment_n_m: [f64; 3],
    pub(crate) figures: Vec<Figure>,
    pub(crate) displacement_mm: Option<[f64; 3]>,
    pub(crate) displacement_by_load_mm: Option<[f64; 3]>,
    pub(crate) turn_mrad: Option<[f64; 3]>,
    pub(crate) compliance: Option<Compliance>,
    pub(crate) rotary_compliance: Option<RotaryCompliance>,
    /// Shares of the deflection along the load, the largest first; empty without a load.
    pub(crate) shares: Vec<ShareOfPart>,
    pub(crate) stable: Option<bool>,
    pub(crate) limb_loads: Vec<LimbLoad>,
    /// Reason why there is no equilibrium.
    pub(crate) finding: Option<String>,
    /// The command that says the same.
    pub(crate) cli: String,
    pub(crate) python: String,
}

/// A figure in words.
#[derive(Serialize, JsonSchema)]
pub(crate) struct Figure {
    pub(crate) label: String,
    pub(crate) value: String,
    pub(crate) detail: Option<String>,
}

/// Displacement of the tool by a force on it, principal axes in base axes.
#[derive(Serialize, JsonSchema)]
pub(crate) struct Compliance {
    pub(crate) axes: Vec<[f64; 3]>,
    pub(crate) um_per_n: Vec<f64>,
}

/// Turn of the tool by a moment on it, principal axes in base axes.
#[derive(Serialize, JsonSchema)]
pub(crate) struct RotaryCompliance {
    pub(crate) axes: Vec<[f64; 3]>,
    pub(crate) urad_per_n_m: Vec<f64>,
}

/// Share of a part.
#[derive(Serialize, JsonSchema)]
pub(crate) struct ShareOfPart {
    pub(crate) part: String,
    pub(crate) limb: Option<String>,
    pub(crate) percent: f64,
}

/// Load of the platform on a limb.
#[derive(Serialize, JsonSchema)]
pub(crate) struct LimbLoad {
    pub(crate) limb: String,
    pub(crate) force_n: [f64; 3],
    pub(crate) share_to_buckling: Option<f64>,
}

/// Vibrations of a machine about a state.
#[derive(Serialize, JsonSchema)]
pub(crate) struct ModesOfState {
    /// The machine in its equilibrium under the load.
    pub(crate) from: Scene,
    /// The lowest ones.
    pub(crate) modes: Vec<ModeOfState>,
}

/// A mode of vibration.
#[derive(Serialize, JsonSchema)]
pub(crate) struct ModeOfState {
    pub(crate) frequency_hz: f64,
    /// `12.3 Hz`, and what is special of it.
    pub(crate) words: String,
    /// A little way along its shape: the motion is continued along straight lines.
    pub(crate) moved: Scene,
}

/// A load that grows, from 0 to a factor of that of a state.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct CurveRequest {
    pub(crate) state: StateRequest,
    pub(crate) factor: f64,
}

/// Equilibria of a machine while the load on its tool grows.
#[derive(Serialize, JsonSchema)]
pub(crate) struct CurveOfState {
    /// Unit of `along`: `mm` along the force, `deg` about a moment without one.
    pub(crate) unit: &'static str,
    /// The branch of the unloaded machine is the first.
    pub(crate) branches: Vec<CurveBranch>,
    pub(crate) marks: Vec<CurveMark>,
    /// There are more branches than these.
    pub(crate) more_branches: bool,
}

/// A branch of equilibria in order.
#[derive(Serialize, JsonSchema)]
pub(crate) struct CurveBranch {
    pub(crate) places: Vec<CurvePlace>,
}

/// An equilibrium.
#[derive(Serialize, JsonSchema)]
pub(crate) struct CurvePlace {
    /// Factor of the load.
    pub(crate) factor: f64,
    /// Displacement of the tool along the load.
    pub(crate) along: f64,
    /// Under this load, which stays as it is.
    pub(crate) stable: bool,
    pub(crate) shape: Scene,
}

/// A special point of a curve.
#[derive(Serialize, JsonSchema)]
pub(crate) struct CurveMark {
    pub(crate) words: String,
    pub(crate) factor: f64,
    pub(crate) along: f64,
}

/// A quantity that a map can show.
#[derive(Serialize, JsonSchema)]
pub(crate) struct MapVariable {
    pub(crate) name: &'static str,
    /// SI; `1` without one.
    pub(crate) unit: &'static str,
    pub(crate) description: &'static str,
}

/// Places of a grid, the tool turned as in a state and under its load.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct MapRequest {
    pub(crate) state: StateRequest,
    /// Name of a variable of the machine.
    pub(crate) variable: String,
    /// Places of the tool, base axes; x runs fastest.
    pub(crate) from_mm: [f64; 3],
    pub(crate) to_mm: [f64; 3],
    pub(crate) counts: [usize; 3],
}

/// A quantity over places.
#[derive(Serialize, JsonSchema)]
pub(crate) struct MapOfState {
    /// None where the machine cannot be, or has no equilibrium.
    pub(crate) values: Vec<Option<f64>>,
}

/// Frequencies, evenly spaced.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct ResponseRequest {
    pub(crate) state: StateRequest,
    /// The lowest and the highest.
    pub(crate) frequencies_hz: [f64; 2],
    pub(crate) count: usize,
    /// Of all modes; without it the damping of the model.
    pub(crate) damping_ratio: Option<f64>,
}

/// How the tip answers to a vibrating force.
#[derive(Serialize, JsonSchema)]
pub(crate) struct ResponseOfState {
    pub(crate) frequencies_hz: Vec<f64>,
    /// Amplitude along x, y and z of the base by a force along the same axis.
    pub(crate) um_per_n: [Vec<f64>; 3],
    pub(crate) natural_frequencies_hz: Vec<f64>,
    /// In words.
    pub(crate) damping: String,
    pub(crate) warnings: Vec<String>,
}

/// A milling cut and spindle speeds, evenly spaced: as the options of `lobes`.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct LobesRequest {
    pub(crate) state: StateRequest,
    /// The slowest and the fastest.
    pub(crate) speed_rpm: [f64; 2],
    pub(crate) speeds: usize,
    /// Largest depth that is looked at.
    pub(crate) depth_mm: f64,
    pub(crate) teeth: usize,
    /// Width of cut by diameter.
    pub(crate) immersion: f64,
    pub(crate) up: bool,
    /// Base axes.
    pub(crate) feed_direction: [f64; 3],
    /// Tangential, radial, axial.
    pub(crate) coefficients_n_per_mm2: [f64; 3],
    /// Of all modes; without it the damping of the model.
    pub(crate) damping_ratio: Option<f64>,
}

/// Depths at which a cut chatters.
#[derive(Serialize, JsonSchema)]
pub(crate) struct LobesOfState {
    pub(crate) points: Vec<Point>,
    pub(crate) best: Option<Best>,
    /// In words.
    pub(crate) damping: String,
    pub(crate) warnings: Vec<String>,
}

/// The path of a program.
#[derive(Clone, Serialize, JsonSchema)]
pub(crate) struct PathAnswer {
    pub(crate) program: String,
    pub(crate) text: String,
    pub(crate) places: Vec<PlaceOnPath>,
    pub(crate) tolerance_mm: f64,
    pub(crate) headline: Vec<String>,
    /// True if the job has a stock, of which `stock` says what is left.
    pub(crate) has_stock: bool,
    /// Stock around the path, the part and obstacles.
    pub(crate) boxes: Vec<ShownBox>,
}

/// A place at which the stock is asked for, by its index.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct StockRequest {
    pub(crate) place: usize,
}

/// What is left of the stock: heights over a grid of the part.
#[derive(Serialize, JsonSchema)]
pub(crate) struct StockAtPlace {
    /// First point of the grid at the bottom of the stock, base axes.
    pub(crate) corner_mm: [f64; 3],
    /// From a point of the grid to the next along x and y of the part.
    pub(crate) steps_mm: [[f64; 3]; 2],
    /// Along z of the part, 1 mm of height.
    pub(crate) up_mm: [f64; 3],
    pub(crate) counts: [usize; 2],
    /// Heights above the bottom, x fastest; none where there is no material.
    pub(crate) heights: Vec<Option<f32>>,
}

/// A box, base axes.
#[derive(Clone, Serialize, JsonSchema)]
pub(crate) struct ShownBox {
    pub(crate) name: String,
    /// `stock`, `part` or `obstacle`.
    pub(crate) kind: &'static str,
    pub(crate) corner_mm: [f64; 3],
    /// From that corner.
    pub(crate) edges_mm: [[f64; 3]; 3],
}

/// A place of the path.
#[derive(Clone, Serialize, JsonSchema)]
pub(crate) struct PlaceOnPath {
    /// Line of the program, from 1.
    pub(crate) line: usize,
    pub(crate) path_mm: f64,
    /// Time at feed from the beginning; none if a feed is not known.
    pub(crate) time_s: Option<f64>,
    /// Base axes.
    pub(crate) position_mm: [f64; 3],
    /// Base axes.
    pub(crate) force_n: [f64; 3],
    pub(crate) error_before_mm: f64,
    /// Error with the compensated program.
    pub(crate) error_after_mm: f64,
    /// Force (N) or torque (N m) of each actuator.
    pub(crate) drives: Vec<f64>,
    /// Largest share of a rated one, where the model states ratings.
    pub(crate) share_of_rating: Option<f64>,
    /// Largest share of the way to buckling.
    pub(crate) share_to_buckling: Option<f64>,
    /// Depth of the cut by the depth at which it chatters, or by the largest depth that was looked at; where the job judges chatter.
    pub(crate) depth_by_limit: Option<f64>,
}

/// Content of a page without a server.
#[derive(Serialize, JsonSchema)]
pub(crate) struct Exported {
    /// True if the page around this one answers for further states, by messages.
    pub(crate) live: bool,
    pub(crate) machine: MachineAnswer,
    pub(crate) state: StateAnswer,
    pub(crate) path: Option<PathAnswer>,
    /// States at some places of the path.
    pub(crate) states: Vec<ExportedState>,
}

/// A state at a place of the path.
#[derive(Serialize, JsonSchema)]
pub(crate) struct ExportedState {
    pub(crate) place: usize,
    pub(crate) state: StateAnswer,
}
