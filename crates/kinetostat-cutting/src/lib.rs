//! Cutting forces from the cut.
//!
//! A chip of some thickness costs force per length of edge ([`ForceLaw`]); the edges of a [`Tool`] are in the material where
//! its [`Engagement`] says; what all of them bear together is the force on the tool. It knows no robot and no program: mm, N,
//! N/mm^2 and rad, unless a name says otherwise; forces are those **on the tool**.
//!
//! Axes of the cut: x along the feed of the tool over the part, z along the tool axis towards the spindle, y to the left of
//! the feed. Source: `shared/theory/cutting.md`, and chapter 2 of the report with its errata.

mod drilling;
mod engagement;
mod error;
mod fitting;
mod law;
mod material;
mod measured;
mod milling;
mod number;
mod number_columns;
mod source;
mod spindle;
mod stock;
mod tool;
mod tool_table;
mod turning;

pub use drilling::{Drill, DrillForce};
pub use engagement::{Contact, Edge, Engagement, Side};
pub use error::{CutError, CutErrorKind, Result};
pub use fitting::{Coefficient, CoefficientFit, MeanForce, MeasuredCut, Series, fit_coefficients};
pub use law::{
    Coolant, Corrected, Correction, CuttingMaterial, EdgeForce, Exponential, ForceLaw, Kienzle,
    Law, Linear, RakeReference, Rational, Scaled, force_as_printed, largest_force,
};
pub use material::{Applied, AppliedFactor, Group, Material, Materials, MeasuredIn, Process};
pub use measured::{
    Activity, Conditioned, Conditioning, ConditioningReport, DriftModel, DriftRemoved, ForceLog,
    LoggedBy, Outlier, OutlierTreatment, ShiftMatch, match_shift,
};
pub use milling::{
    ChipThickness, CutForce, Feed, Harmonic, MeanTable, Milling, Peak, Peaks, Revolution, Rotation,
    Wall,
};
pub use spindle::{SpindleCurve, SpindleFinding, SpindleLimit, SpindlePoint};
pub use stock::{Probe, Station, Stock, StockSettings};
pub use tool::{RunOut, Shape, Tool};
pub use tool_table::{LinuxCncTable, LinuxCncTool, MachineUnit, ToolEntry, ToolTable, WrittenTool};
pub use turning::{Turning, TurningForce};
