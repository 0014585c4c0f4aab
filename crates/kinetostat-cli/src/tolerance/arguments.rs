//! Options of `tolerance`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use kinetostat_analysis::tolerance::Quantity;

use crate::options::{number, whole};

/// Quantity requested at every place.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Asked {
    /// Where the unloaded tool is, from where it is commanded
    Error,
    /// How far the load moves it
    DeflectionByLoad,
    /// Where the loaded tool is, from where it is commanded
    Deviation,
    /// What compensation with the numbers of the drawing leaves of it
    Compensated,
    /// Force along x, y and z per motion
    Stiffness,
}

impl Asked {
    pub(crate) fn quantity(self) -> Quantity {
        match self {
            Self::Error => Quantity::Error,
            Self::DeflectionByLoad => Quantity::DeflectionByLoad,
            Self::Deviation => Quantity::Deviation,
            Self::Compensated => Quantity::Compensated,
            Self::Stiffness => Quantity::Stiffness,
        }
    }
}

/// How far do results scatter when the machine is not exactly as drawn
///
/// Builds thousands of machines whose numbers scatter as a file says, commands each as the drawing
/// says, and tells the spread of its error, its deflection and its stiffness, before and after
/// compensation; beside it what linear propagation says, and whether that is enough.
#[derive(Debug, Args)]
#[command(after_help = crate::options::EXIT_CODES, after_long_help = HELP)]
pub(crate) struct ToleranceArgs {
    /// Preset or model file
    #[arg(value_name = "MODEL")]
    pub(crate) model: String,
    /// What is uncertain (TOML, see below), or a model that `identify` wrote [default: what the model says]
    #[arg(long, value_name = "FILE")]
    pub(crate) uncertain: Option<PathBuf>,
    /// Place of the tool's tip in base axes, mm; once for each place; home without it
    #[arg(long, num_args = 3, action = clap::ArgAction::Append, value_names = ["X", "Y", "Z"], allow_negative_numbers = true, value_parser = number)]
    pub(crate) at: Vec<f64>,
    /// Orientation of the tool there by a named convention, as in a_b_c_kuka_deg=0,0,90
    #[arg(long, value_name = "CONVENTION=A,B,C")]
    pub(crate) rotation: Option<String>,
    /// Distance of the tool's tip along z of the flange, mm
    #[arg(long, value_name = "L", allow_negative_numbers = true, value_parser = number)]
    pub(crate) tool_length_mm: Option<f64>,
    /// Force on the tool's tip, N, base axes
    #[arg(long, num_args = 3, value_names = ["FX", "FY", "FZ"], allow_negative_numbers = true, value_parser = number)]
    pub(crate) force: Option<Vec<f64>>,
    /// Moment on the tool about its tip, N m, base axes
    #[arg(long, num_args = 3, value_names = ["MX", "MY", "MZ"], allow_negative_numbers = true, value_parser = number)]
    pub(crate) moment: Option<Vec<f64>>,
    /// What is asked; without it, error and stiffness, and under a load everything
    #[arg(long, value_enum, value_name = "WHAT", num_args = 1.., value_delimiter = ',')]
    pub(crate) only: Vec<Asked>,
    /// Number of machines, rounded up to a multiple of 16 [default: 4096]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole)]
    pub(crate) machines: Option<usize>,
    /// Seed of the draws; the same seed draws the same machines [default: 0]
    #[arg(long, value_name = "SEED", allow_negative_numbers = true, value_parser = whole)]
    pub(crate) seed: Option<usize>,
    /// Sobol indices, too, from so many draws, each of which asks for as many machines as there are
    /// uncertain numbers, and two
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole)]
    pub(crate) sobol: Option<usize>,
    /// All machines as a table (CSV): the numbers drawn, then the results at every place
    #[arg(long, value_name = "FILE", help_heading = "Outputs")]
    pub(crate) csv: Option<PathBuf>,
    /// Histogram of the first result at the first place, with the linear one above it (SVG)
    #[arg(long, value_name = "FILE", help_heading = "Outputs")]
    pub(crate) plot: Option<PathBuf>,
    /// Print the answer as JSON; the text goes to the standard error
    #[arg(long, help_heading = "Outputs")]
    pub(crate) json: bool,
    /// Overwrite outputs that exist (never an input)
    #[arg(long, help_heading = "Outputs")]
    pub(crate) force_overwrite: bool,
    /// Number of threads; all cores without it. The result is the same
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole)]
    pub(crate) threads: Option<usize>,
}

const HELP: &str = "\
Examples:
  kinetostat tolerance orthoglide --uncertain spread.toml --at 0 0 0 \\
      --force 215 -10 -25
  kinetostat tolerance identified.toml --at 1600 300 900 --force 300 0 -500
  kinetostat tolerance my_robot.toml --uncertain spread.toml --at 1200 0 900 \\
      --at 1400 200 900 --force 300 0 -500 --sobol 1024 --plot spread.svg

What is uncertain, one table for each number; spreads are in its own unit:

  schema = 1
  [[uncertain]]
  parameter = \"chain.leg.q2.length_mm\"   # a number of the model, by its path
  normal = 0.02                          # standard deviation; or uniform,
                                         # triangular: half width
  each = true                            # limbs that share it scatter by
                                         # themselves; all together without it
  [[uncertain]]
  load = \"force_n.x\"                     # or moment_n_m.z, or factor: the
  uniform_percent = 10                   # whole load, as all cutting
                                         # coefficients together
  [[correlation]]
  between = [\"chain.leg.q2.length_mm\", \"force_n.x\"]
  coefficient = 0.5

Exit codes:
  0    answered
  1    wrong input: a file, a number or an option; the message says which
  2    no answer: not even the machine as drawn has one
  130  stopped with Ctrl-C; nothing was written";
