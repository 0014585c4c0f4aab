//! Options of `force --fit`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use crate::options::number;

/// Coefficients of a material from mean forces.
#[derive(Debug, Args)]
pub(crate) struct FitArgs {
    /// Mean forces of a dynamometer at several feeds (CSV: feed_mm_per_tooth,fx_n,fy_n,fz_n): the
    /// coefficients that fit them best, with --material as the name of what was cut
    #[arg(long, value_name = "FILE", help_heading = "Fit", conflicts_with_all = ["list_materials", "materials", "wear", "coolant", "edge", "correct_speed", "process_factor", "feed_per_tooth_mm", "feed_mm_per_min", "down_feed_per_tooth_mm", "spindle_power_w", "drill", "turning", "feed_per_turn_mm"])]
    pub(crate) fit: Option<PathBuf>,
    /// What the forces of the file act on: the tool, or the part (a dynamometer under it shows the
    /// force on the part, which is turned) [default: tool]
    #[arg(
        long,
        value_enum,
        value_name = "WHAT",
        help_heading = "Fit",
        requires = "fit"
    )]
    pub(crate) acts_on: Option<ActsOnWord>,
    /// Family of the material [default: other]
    #[arg(
        long,
        value_enum,
        value_name = "GROUP",
        help_heading = "Fit",
        requires = "fit"
    )]
    pub(crate) group: Option<GroupWord>,
    /// How far the force of another batch or tool may lie from this one, % [default: the interval of
    /// the fit, which knows this batch alone]
    #[arg(long, value_name = "P", help_heading = "Fit", requires = "fit", allow_negative_numbers = true, value_parser = number)]
    pub(crate) spread_percent: Option<f64>,
    /// The material as a file (TOML) for --materials and for jobs; without it, it is printed
    #[arg(long, value_name = "FILE", help_heading = "Outputs", requires = "fit")]
    pub(crate) out_material: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum ActsOnWord {
    /// The tool
    #[default]
    Tool,
    /// The part
    Part,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum GroupWord {
    Aluminium,
    Magnesium,
    Copper,
    Steel,
    Stainless,
    /// Its factor of the rake angle is another
    CastIron,
    Titanium,
    Nickel,
    Plastic,
    Wood,
    #[default]
    Other,
}
