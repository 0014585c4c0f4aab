//! Does a cut chatter?
//!
//! Modal data of a tool ([`Mode`], [`ToolResponse`]) and a cut ([`MillingCut`], [`TurningCut`]) go in. Out come the depths
//! that are stable at a spindle speed ([`Regeneration`]), exact by collocation of the monodromy operator. It knows no robot
//! and no program. SI units: m, N, s, rad; spindle speeds in rpm and frequencies in Hz where the name says so.
//!
//! Axes of the cut: x along the feed of the tool over the part, z along the tool axis towards the spindle, y to the left of
//! the feed ([`FeedFrame`]). Forces are those on the tool. Source: `shared/theory/dynamics.md` sections 7 to 11, whose
//! equations are cited as [D 8], and `cutting.md`.
//!
//! What is not covered (`dynamics.md` section 14): variable pitch, process damping, ball ends, run-out, loss of contact.

mod branches;
mod coupling;
mod cut;
mod error;
mod forced;
mod lobes;
mod measured;
mod number;
mod response;
mod stability;
pub mod zeroth_order;

pub use coupling::{Coupled, CoupledLimit, Process, coupled_limit, coupled_roots, two_axis_limit};
pub use cut::{Arc, Coefficients, Cut, Linearised, Milled, MillingCut, TurningCut};
pub use error::{ChatterError, ChatterErrorKind, Result};
pub use forced::{PeriodicForce, Vibration, VibrationHarmonic};
pub use lobes::{LobeDiagram, LobePoint, LobeRequest};
pub use measured::{
    Fit, FittedMode, MeasuredResponse, ModePair, Motion, Parameter, Scaled, ShapedMode,
    UniversalFile, fit_modes, modal_assurance, pair_modes, read_columns, read_universal,
    scale_parameters, turning_columns,
};
pub use response::{FeedFrame, Mode, ToolResponse};
pub use stability::{
    Crossing, Instability, LeftOut, Multiplier, Regeneration, SpeedStability, Swinging,
};
pub use zeroth_order::ZerothOrderLimit;
