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
mod uncertain;

pub use document::{
    CarriesWord, ChainTable, ControllerAxisTable, ControllerCoupling, ControllerTable,
    ControllerUnit, Deviation, Document, LimbTable, MechanismTable, PlatformTable, RotaryAxisTable,
    RotaryWord, SCHEMA_VERSION, Workspace,
};
pub use elastic::{
    HollowBox, IBeam, Rectangle, Rigidities, Round, Section, ShearWord, Spring6, Stiffness, Tip,
    Tube, Values,
};
pub use element::{
    ActuatorElement, ActuatorKind, BodyElement, Convention, CoupledElement, Element, LinkElement,
    MassModelWord, NodeElement, ParallelogramElement, PassiveElement, RigidElement, Spring6Element,
    SpringElement,
};
pub use joint::{DampingTable, JointKind, Knee, PassiveKind, RayleighTable, RotorTable};
pub use load::{
    Anchor, ConstantTensionLoad, CounterweightLoad, GasSpringLoad, LoadTable, PlatformAxes,
    PlatformLoadTable, PlatformPoint, PlatformWrench, SpringLoad, WrenchAxes, WrenchLoad,
};
pub use placement::{Axis, AxisName, Placement};
pub use uncertain::{CorrelationTable, UncertainTable};
