//! Options of `assemble`.

use std::path::PathBuf;

use clap::{ArgAction, Args, ValueEnum};

use crate::options::{EXIT_CODES, number, whole};
use crate::place::arguments::PlaceArgs;

/// What assembly with errors locks in: shifts, internal forces, springs
///
/// Counts over-constraint and names the directions in which the limbs fight; tells where the platforms
/// and passive joints go by the deviations of the model, which wrenches stay in the limbs and how
/// much every spring is bent: without load, to first order, and under a load.
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES, after_long_help = HELP)]
pub(crate) struct AssembleArgs {
    /// Preset or model file
    #[arg(value_name = "MODEL")]
    pub(crate) model: String,
    /// One more deviation, as in "leg x:line:1deg about x", "leg y:bar:0.2mm longer" or
    /// "*:foot:1mm along z" (* is every limb); repeat for more
    #[arg(long, value_name = "LIMB:AT:WHAT", action = ArgAction::Append, allow_hyphen_values = true)]
    pub(crate) deviation: Vec<String>,
    #[command(flatten)]
    pub(crate) place: PlaceArgs,
    /// Distance of the tool's tip along z of the flange, mm
    #[arg(long, value_name = "L", allow_negative_numbers = true, value_parser = number)]
    pub(crate) tool_length_mm: Option<f64>,
    /// Force on the tool's tip, N, base axes
    #[arg(long, num_args = 3, value_names = ["FX", "FY", "FZ"], allow_negative_numbers = true, value_parser = number)]
    pub(crate) force: Option<Vec<f64>>,
    /// Moment on the tool about its tip, N m, base axes
    #[arg(long, num_args = 3, value_names = ["MX", "MY", "MZ"], allow_negative_numbers = true, value_parser = number)]
    pub(crate) moment: Option<Vec<f64>>,
    /// Along a straight line instead of at one place, mm, base axes
    #[arg(long, num_args = 6, value_names = ["X0", "Y0", "Z0", "X1", "Y1", "Z1"], allow_negative_numbers = true, help_heading = "Along a line", value_parser = number, conflicts_with_all = ["at", "rotation", "joints", "controller", "pendant"])]
    pub(crate) along: Option<Vec<f64>>,
    // Clap does not require the line beside a place, so these options are refused here.
    /// Points of the line [default: 41]
    #[arg(long, value_name = "N", help_heading = "Along a line", allow_negative_numbers = true, value_parser = whole, requires = "along", conflicts_with_all = ["at", "joints", "controller", "pendant"])]
    pub(crate) points: Option<usize>,
    /// Draw the displacement along the line: alone, together, and the sum of both alone (SVG)
    #[arg(
        long,
        value_name = "FILE",
        help_heading = "Along a line",
        requires = "along",
        conflicts_with_all = ["at", "joints", "controller", "pendant"]
    )]
    pub(crate) plot: Option<PathBuf>,
    /// What is drawn
    #[arg(long, value_enum, value_name = "PART", default_value_t = Component::Size, help_heading = "Along a line", requires = "along", conflicts_with_all = ["at", "joints", "controller", "pendant"])]
    pub(crate) component: Component,
    /// Show every joint and spring, not only those that move most
    #[arg(long, help_heading = "Outputs")]
    pub(crate) all: bool,
    /// Print the answer as JSON; the text goes to the standard error
    #[arg(long, help_heading = "Outputs")]
    pub(crate) json: bool,
    /// All numbers as a table (CSV)
    #[arg(long, value_name = "FILE", help_heading = "Outputs")]
    pub(crate) csv: Option<PathBuf>,
    /// Overwrite outputs that exist (never an input)
    #[arg(long, help_heading = "Outputs")]
    pub(crate) force_overwrite: bool,
}

/// A part of the displacement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Component {
    /// Along x of the base
    X,
    /// Along y of the base
    Y,
    /// Along z of the base
    Z,
    /// How long it is
    Size,
}

const HELP: &str = "\
Examples:
  kinetostat assemble orthoglide --deviation \"*:line:1deg about x\" \\
      --at 126.35 126.35 126.35
  kinetostat assemble my_machine.toml --force 215 -10 -25 --csv locked-in.csv
  kinetostat assemble my_machine.toml --along -70 -70 -70  -70 120 -70 \\
      --force 215 -10 -25 --plot line.svg --component x

Deviations are the [[deviation]] tables of the model and those of --deviation.
They belong to the machine as built; the controller commands the machine as
drawn.

Exit codes:
  0    answered
  1    wrong input: a file, a number or an option; the message says which
  2    no answer: not converged, or a point that cannot be reached";
