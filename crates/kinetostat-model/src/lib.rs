//! Model files of robots: TOML with units in the keys, presets, JSON Schema.
//!
//! A model file reads like the drawing: platforms, chains as ordered lists of elements, and limbs
//! that join two platforms by a chain.
//!
//! ```
//! let text = r#"
//! schema = 1
//! [mechanism]
//! name = "a sprung arm"
//!
//! [[platform]]
//! name = "tool"
//! home = { position_mm = [500, 0, 0] }
//!
//! [section.tube]
//! tube = { outer_diameter_mm = 60, inner_diameter_mm = 50 }
//! youngs_modulus_gpa = 70
//! shear_modulus_gpa = 26
//!
//! [chain.arm]
//! elements = [
//!   { actuator = "revolute", name = "shoulder", axis = "z", stiffness_n_m_per_rad = 2.0e5 },
//!   { link = "tube", length_mm = 500 },
//! ]
//!
//! [[limb]]
//! name = "arm"
//! from = "base"
//! to = "tool"
//! chain = "arm"
//! "#;
//! let model = kinetostat_model::Model::from_toml(text, "arm.toml")?;
//! assert_eq!(model.mechanism.actuator_names(), ["shoulder"]);
//!
//! // Mistakes come with their line and with what would have been right.
//! let wrong = text.replace("length_mm", "lenght_mm");
//! let error = kinetostat_model::Model::from_toml(&wrong, "arm.toml").unwrap_err();
//! assert!(error.to_string().contains("did you mean 'length_mm'?"));
//! # Ok::<(), kinetostat_model::ModelError>(())
//! ```
//!
//! # Decisions
//!
//! - **Units are part of the key** (`length_mm`, `stiffness_n_per_m`); where several units are usual,
//!   there are several keys, and exactly one is written. Conversion to SI happens once, on reading.
//! - **Orientations name their convention**; a bare `rpy` or `quaternion` is refused.
//! - **The word of an element is its key** (`{ link = "bar", length_mm = 300 }`), so that a chain can be
//!   read aloud; order is the order of the product. Elements without a name are called by word and
//!   position, `link 4`.
//! - **Chains are tables, limbs refer to them**: three equal legs are written once. `start` and `end`
//!   place the chain between its platforms.
//! - **Deviations are separate** (`[[deviation]]`): the chain says what was drawn, the deviation what
//!   was built. A deviation is a motion behind a named rigid element or link, or at the limb's `start`
//!   or `end`; or in words of the shop, a link that is longer, a joint whose axis is tilted.
//! - **Links bow**: a link shortens as it bends, so that it buckles at its Euler load; `convention`
//!   names the plain springs of the literature, `segments` divides it.
//! - **Loads belong to a limb** (`[[limb.load]]`): springs, gas springs and ropes between two of its
//!   points or one and the base, wrenches that keep their direction or turn with their node,
//!   counterweights. Places are named: nodes, bodies, or any element with a name (behind it).
//! - **The controller has coordinates of its own** (`[controller]`): a linear map of the model's joints,
//!   with names and units as it shows them. Geometry is never bent to fit a controller.
//! - **Gravity has no default**: a file with masses says which way is down.
//! - **The reader checks the file against the generated JSON Schema first.** One description serves
//!   editors, messages and reading; places of values are looked up in the text only for messages, so
//!   the schema types stay plain data that can be changed and written again.
//!
//! [`Model`] holds the document and the [`kinetostat::Mechanism`]; [`schema`] has the types.

mod assembly;
mod elements;
mod exact;
mod findings;
#[doc(hidden)]
pub mod internal;
mod model;
mod parameters;
mod plausibility;
mod presets;
mod problem;
pub mod schema;
mod text;

pub use assembly::controller::{Controller, ControllerAxis};
pub use elements::rotary::RotaryAxis;
pub use exact::{exact, exact_toml};
pub use model::{Model, json_schema, read_model, require_stiffness};
pub use parameters::{NumberEdit, Parameter, ParameterKind, ParametricModel};
pub use plausibility::link_matrix::doubts_of_link_matrix;
pub use plausibility::masses::inertia_of_body;
pub use plausibility::numbers::{looks_like_radians, odd_angles};
pub use presets::{Preset, PresetKind, preset_names, preset_text};
pub use problem::{ModelError, Problem, Severity, TextStyle, shortened};

/// The examples of the README run.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
