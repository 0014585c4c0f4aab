//! Analyses of a machine as a whole, on top of the elastostatics of `kinetostat`.
//!
//! | question | answer |
//! |---|---|
//! | how far does the tool get? | [`reach::reach`] |
//! | are two models the same machine? | [`comparison::compare`] |
//! | which sign, offset or frame explains measured poses? | [`measured_poses::explain`] |
//! | what do deviations lock in? | [`assembled::AssembledMachine`] |
//! | how near is a load to instability? | [`instability::InstabilityShares`] |
//! | which spring, link, joint gives how much of a deflection? | [`shares::Shares`] |
//! | what would stiffen it most cheaply? | [`shares::stiffening::stiffen`] |
//! | what does every number of the model file change? | [`sensitivity::sensitivities`] |
//! | are deflections under a load small? | [`reference_load::under_forces`], [`push_stiffness::PushStiffnesses`] |
//! | how does it vibrate at a place, and where does its cut chatter? | [`vibration::VibratingMachine`], [`vibration::MachineCut`] |
//! | what do single limbs and actuators do? | [`limb_motions`], [`joint_motion`] |
//! | a machine of one limb as a chain whose end is held | [`serial_chain::SerialChain`], [`movable`], [`degenerate`] |
//! | how far has the tool turned along a curve? | [`rotation::ContinuousRotation`] |
//! | how far do results scatter when a machine is not exactly as drawn? | [`tolerance`] |
//! | where does a part lie best? | [`placing::place`] |
//!
//! It takes mechanisms, postures and equilibria, and gives figures: lengths in m and angles in rad where a name
//! does not say another unit, directions in axes of the base. It prints nothing.

pub mod assembled;
pub mod comparison;
pub mod degenerate;
pub mod forward;
pub mod instability;
pub mod joint_motion;
pub mod limb_motions;
pub mod measured_poses;
pub mod movable;
pub mod outline;
pub mod placing;
pub mod push_stiffness;
pub mod reach;
pub mod reference_load;
pub mod rotation;
pub mod sensitivity;
pub mod serial_chain;
pub mod shares;
pub mod tolerance;
pub mod vibration;
