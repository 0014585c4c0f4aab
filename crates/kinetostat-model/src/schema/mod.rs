//! Schema of a model file, one type per table, in the order in which it is written.
//!
//! These types are the only description of the format: reading, writing and the JSON Schema are
//! generated from them. They hold the numbers as written, each with its unit in the field's name;
//! the assembly turns them into SI once.

mod document;
mod elastic;
mod element;
mod joint;
pub(crate) mod load;
mod placement;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use document::{CarriesWord, RotaryAxisTable, RotaryWord};
pub use document::{
    ChainTable, Deviation, Document, LimbTable, MechanismTable, PlatformTable, SCHEMA_VERSION,
    Workspace,
};
pub use document::{ControllerAxisTable, ControllerCoupling, ControllerTable, ControllerUnit};
pub use document::{DampingTable, RayleighTable, RotorTable};
pub use elastic::{
    HollowBox, IBeam, Rectangle, Rigidities, Round, Section, ShearWord, Spring6, Stiffness, Tip,
    Tube, Values,
};
pub use element::{
    ActuatorElement, ActuatorKind, BodyElement, Convention, CoupledElement, Element, LinkElement,
    MassModelWord, NodeElement, ParallelogramElement, PassiveElement, RigidElement, Spring6Element,
    SpringElement,
};
pub use joint::{JointKind, PassiveKind};
pub use load::{
    Anchor, ConstantTensionLoad, CounterweightLoad, GasSpringLoad, LoadTable, PlatformAxes,
    PlatformLoadTable, PlatformPoint, PlatformWrench, SpringLoad, WrenchAxes, WrenchLoad,
};
pub use placement::{Axis, AxisName, Placement};

/// Bilinear spring: knee, the same in both senses, and the stiffness beyond it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Knee {
    /// Deflection at which the stiffness changes, mm.
    pub at_mm: Option<f64>,
    /// Deflection at which the stiffness changes, m.
    pub at_m: Option<f64>,
    /// Deflection at which the stiffness changes, degrees.
    pub at_deg: Option<f64>,
    /// Deflection at which the stiffness changes, rad.
    pub at_rad: Option<f64>,
    /// Stiffness beyond, N/m.
    pub then_n_per_m: Option<f64>,
    /// Stiffness beyond, N/mm.
    pub then_n_per_mm: Option<f64>,
    /// Stiffness beyond, N m/rad.
    pub then_n_m_per_rad: Option<f64>,
    /// Stiffness beyond, N mm/rad.
    pub then_n_mm_per_rad: Option<f64>,
}
