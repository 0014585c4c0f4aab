//! Options of `import`.

use std::path::PathBuf;

use clap::{Args, Subcommand};

use crate::import::link_arguments::{DisplacementsArgs, MatrixArgs};
use crate::options::EXIT_CODES;

/// A model file from another program's description of a robot, or a link's stiffness for one
#[derive(Debug, Args)]
pub(crate) struct ImportArgs {
    #[command(subcommand)]
    pub(crate) action: ImportAction,
}

#[derive(Debug, Subcommand)]
pub(crate) enum ImportAction {
    Urdf(UrdfArgs),
    Matrix(MatrixArgs),
    LinkDisplacements(DisplacementsArgs),
}

/// A model file from a URDF
///
/// Geometry, masses and limits come from the URDF; it says nothing of what bends. Joint stiffnesses
/// and the section of links are given here, or filled in where the written file says FILL IN.
/// Everything that is skipped, replaced or looks wrong is reported.
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub(crate) struct UrdfArgs {
    /// URDF file (a xacro file must be expanded first)
    #[arg(value_name = "FILE")]
    pub(crate) file: PathBuf,
    /// Link that stands; the root without it
    #[arg(long, value_name = "LINK")]
    pub(crate) base: Option<String>,
    /// Link that carries the tool; needed where the tree has several ends
    #[arg(long, value_name = "LINK")]
    pub(crate) tip: Option<String>,
    /// Axis of the tip link that points out of the flange, where tools lie: x of `flange` in ROS, z of
    /// `tool0`; without it, the frame of the tip is taken as it is
    #[arg(long, value_name = "AXIS", value_parser = ["x", "y", "z"])]
    pub(crate) flange_z: Option<String>,
    /// Closed loops (TOML): what the proposed `constraint` element of a URDF says
    #[arg(long, value_name = "FILE")]
    pub(crate) loops: Option<PathBuf>,
    /// Joints that nothing drives
    #[arg(long, value_name = "JOINT", value_delimiter = ',')]
    pub(crate) passive: Vec<String>,
    /// Where a joint stands at home, as in joint_5=30deg or rail=1200mm; zero without it
    #[arg(long, value_name = "JOINT=VALUE", value_delimiter = ',')]
    pub(crate) home: Vec<String>,
    /// Stiffness of the drives: one number for all that turn, N m/rad, or a table (CSV) with the
    /// columns name,value,unit
    #[arg(long, value_name = "VALUE|FILE", allow_negative_numbers = true)]
    pub(crate) joint_stiffness: Option<String>,
    /// Links are straight beams of this section (TOML: the keys of a section of a model file);
    /// rigid without it
    #[arg(long, value_name = "FILE")]
    pub(crate) link_section: Option<PathBuf>,
    /// The model file; without it, the model goes to the standard output
    #[arg(long, short, value_name = "FILE", help_heading = "Outputs")]
    pub(crate) out: Option<PathBuf>,
    /// Overwrite an existing file
    #[arg(long, help_heading = "Outputs")]
    pub(crate) force_overwrite: bool,
    /// Print what was imported as JSON instead of the model; the text goes to the standard error
    #[arg(long, help_heading = "Outputs")]
    pub(crate) json: bool,
}
