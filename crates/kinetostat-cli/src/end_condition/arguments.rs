//! Options that `curve` and `equilibria` share: what holds the tool, and what acts on it.

use clap::{ArgAction, Args};

use crate::options::number;

/// What holds the tool, and what acts all the time.
#[derive(Debug, Default, Args)]
pub(crate) struct EndArgs {
    /// Directions in which the tool is held, as in x,y,rz; the others are free. Also: all, none
    #[arg(
        long,
        value_name = "LIST",
        help_heading = "Tool",
        conflicts_with = "free"
    )]
    pub(crate) hold: Option<String>,
    /// Directions in which the tool is free, as in y,rz; the others are held. Also: rotations, and
    /// others (all but the one it is pushed along)
    #[arg(long, value_name = "LIST", help_heading = "Tool")]
    pub(crate) free: Option<String>,
    /// Axes of these directions in the base, as in a_b_c_kuka_deg=30,0,0; without it, the base
    #[arg(long, value_name = "CONVENTION=A,B,C", help_heading = "Tool")]
    pub(crate) axes: Option<String>,
    /// Force that acts on the tool's tip all the time, N, base axes
    #[arg(long, num_args = 3, value_names = ["FX", "FY", "FZ"], allow_negative_numbers = true, help_heading = "Constant load", value_parser = number)]
    pub(crate) constant_force: Option<Vec<f64>>,
    /// Moment that acts on the tool all the time, N m, base axes
    #[arg(long, num_args = 3, value_names = ["MX", "MY", "MZ"], allow_negative_numbers = true, help_heading = "Constant load", value_parser = number)]
    pub(crate) constant_moment: Option<Vec<f64>>,
    /// Force on a named node of the chain all the time, N, base axes (repeat for more); of a machine
    /// of several limbs LIMB:NODE=FX,FY,FZ
    #[arg(long, value_name = "NODE=FX,FY,FZ", action = ArgAction::Append, allow_hyphen_values = true, help_heading = "Constant load")]
    pub(crate) load: Vec<String>,
}
