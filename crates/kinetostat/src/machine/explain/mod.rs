//! Why a machine is soft or unstable: which joints and springs move with the tool, and which springs have a negative
//! net stiffness under their loads.
//!
//! Takes an equilibrium and a motion of the tool, gives the shares of joints and springs by name.
//!
//! ```text
//! share of coordinate i = x_i^2 / sum x_j^2, x the motion of all coordinates with the tool, turns at the natural length
//! net stiffness of a spring coordinate = K_i + (by all that acts on the limb), negative: it runs away
//! ```

pub(crate) mod negative_stiffness;
pub(crate) mod participation;
