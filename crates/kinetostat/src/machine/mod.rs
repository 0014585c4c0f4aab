//! A mechanism commanded for a target: its posture, its stiffness there, and the Newton iteration of its platforms.
//!
//! Takes a [`Mechanism`](crate::Mechanism) and a target of the tool, gives the commands of the actuators (`inverse`), the
//! posture, its unloaded stiffness, what the limbs constrain, how near a singular posture is (`singular`), what assembly
//! with errors does to first order (`assembly`), and which joints and springs take part in a motion of the tool
//! (`participation`, `negative_stiffness`). `stiffness` has each limb's share in the tangent, too. `linearised` is an equilibrium's tangent with all coordinates kept: who stores what of
//! a deflection, and where the equilibrium goes as the machine changes. `platforms` is the equilibrium of the platforms at one share of the load.
//!
//! ```text
//! W = sum T_i^T F_i,   K = sum T_i^T K_i T_i + sum blkdiag(0, hat(f_i) hat(s_i))     [R 6.21-6.30, 5.28 corrected]
//! ```

pub(crate) mod assembly;
pub(crate) mod constraints;
pub(crate) mod directions;
pub(crate) mod equilibrium;
pub(crate) mod following;
pub(crate) mod forward;
pub(crate) mod graded;
pub(crate) mod inverse;
pub(crate) mod linearised;
pub(crate) mod mobility;
pub(crate) mod negative_stiffness;
pub(crate) mod network;
pub(crate) mod participation;
pub(crate) mod platform_system;
pub(crate) mod platforms;
pub(crate) mod posture;
pub(crate) mod request;
pub(crate) mod singular;
pub(crate) mod state;
pub(crate) mod stiffness;

pub use assembly::LinearAssembly;
pub use constraints::{Overconstraint, SelfStress};
pub use equilibrium::{LimbEquilibrium, MechanismEquilibrium, PlatformStability};
pub use inverse::limb::{LimbPosture, inverse_kinematics};
pub use linearised::{
    LinearisedMachine, MachineMotion, MachineResidual, MachineTangents, WorkOf, WorkTerm,
};
pub use negative_stiffness::NegativeNetStiffness;
pub use posture::Posture;
pub use request::PostureRequest;
pub use singular::near::{NearSingularity, SingularityKind};
pub use state::MechanismState;
pub use stiffness::{JointSensitivity, LimbStiffness, UnloadedStiffness};
