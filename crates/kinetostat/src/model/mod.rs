//! Model of a robot: chains and mechanisms, the laws of their springs, the loads on them.
//!
//! Takes descriptions in the words of the field (actuator, passive joint, link, spring, platform, limb), checks them once
//! and freezes them; nothing here changes after `build()`. Gives positions, Jacobians and the Hessian of loads of a
//! chain at given coordinates (`kinematics`), torques and tangents of springs (`springs`), wrenches and tangents of loads
//! (`loads`). It solves nothing.
//!
//! ```text
//! base_from_tip = E_1 E_2 ... E_m                                         [R 4.1]
//! J, H = d(sum J_j^T G_j)/dx                                              [R 4.3-4.6, 4.21]
//! torques of a spring block  -dU/dtheta, tangent d2U/dtheta2              [R 3.2, 4.9]
//! ```

pub(crate) mod actuator;
pub(crate) mod beam;
pub(crate) mod builder;
pub(crate) mod chain;
pub(crate) mod chain_check;
pub(crate) mod evaluation;
pub(crate) mod kinematics;
pub(crate) mod limits;
pub(crate) mod link;
pub(crate) mod link_mass;
pub(crate) mod loads;
pub(crate) mod mechanism;
pub(crate) mod mechanism_builder;
pub(crate) mod segment_weight;
pub(crate) mod springs;

pub use actuator::{ActuatorSpec, DriveRotor};
pub use beam::BeamSection;
pub use builder::ChainBuilder;
pub use chain::{Actuator, Body, Chain, Coordinate, Drive, Element, Motion, Role, Scale};
pub use evaluation::ChainEvaluation;
pub use kinematics::{Kinematics, NodeTangent, unloaded_tip};
pub use link::{LinkConvention, LinkElasticity, LinkSpec};
pub use link_mass::{LinkMass, MassModel, SegmentMass, Slice};
pub use loads::check::{TangentCheck, check_tangents};
pub use loads::follower::{Follower, PointForce};
pub use loads::function::FunctionLoad;
pub use loads::length_law::{LengthFunction, LengthLaw, LengthResponse};
pub use loads::load::Load;
pub use loads::node_load::NodeLoad;
pub use loads::platform::PlatformLoad;
pub use loads::strut::{Anchor, Strut};
pub use mechanism::{Limb, Mechanism, Platform};
pub use mechanism_builder::MechanismBuilder;
pub use segment_weight::turn_rates;
pub use springs::bilinear::BilinearLaw;
pub use springs::block::{Segment, SpringBlock, SpringLaw};
pub use springs::bowing::BowingLaw;
pub use springs::logarithm::LogarithmLaw;
pub use springs::parallelogram::ParallelogramLaw;
