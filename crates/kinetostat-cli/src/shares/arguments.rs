//! Options of `shares`.

use clap::{Args, ValueEnum};
use kinetostat::Wrench;
use nalgebra::Vector3;

use crate::files::answer_files::AnswerFiles;
use crate::options::{EXIT_CODES, number};
use crate::place::arguments::PlaceArgs;

/// Which link, drive, joint gives how much of the deflection in a direction
///
/// Divides the compliance of the tool in one direction exactly among all springs of the machine, and
/// what loads add as they turn; all shares add to 100 %. Without a force it is that of the unloaded
/// machine as drawn; under one, what a further small load meets.
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES, after_long_help = HELP)]
pub(crate) struct SharesArgs {
    /// Preset or model file
    #[arg(value_name = "MODEL")]
    pub(crate) model: String,
    #[command(flatten)]
    pub(crate) place: PlaceArgs,
    /// Along which axis of the base the tool is pushed, or about which it is turned
    #[arg(long, value_enum, value_name = "AXIS", default_value_t = Axis::Z, conflicts_with = "along")]
    pub(crate) direction: Axis,
    /// Any other direction of the push, base axes
    #[arg(long, num_args = 3, value_names = ["X", "Y", "Z"], allow_negative_numbers = true, value_parser = number)]
    pub(crate) along: Option<Vec<f64>>,
    /// Force on the tool's tip, N: shares under it
    #[arg(long, num_args = 3, value_names = ["FX", "FY", "FZ"], allow_negative_numbers = true, value_parser = number)]
    pub(crate) force: Option<Vec<f64>>,
    /// Moment on the tool about its tip, N m
    #[arg(long, num_args = 3, value_names = ["MX", "MY", "MZ"], allow_negative_numbers = true, value_parser = number)]
    pub(crate) moment: Option<Vec<f64>>,
    /// Distance of the tool's tip along z of the flange, mm
    #[arg(long, value_name = "L", allow_negative_numbers = true, value_parser = number)]
    pub(crate) tool_length_mm: Option<f64>,
    /// Besides: what every number of the model file changes, the strongest first
    #[arg(long)]
    pub(crate) sensitivities: bool,
    /// Besides: the cheapest stiffening that lowers the deflection by so many percent
    #[arg(long, value_name = "PERCENT", allow_negative_numbers = true, value_parser = number)]
    pub(crate) reduce_percent: Option<f64>,
    #[command(flatten)]
    pub(crate) outputs: AnswerFiles,
}

/// An axis of the base.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Axis {
    /// Force along x
    X,
    /// Force along y
    Y,
    /// Force along z
    Z,
    /// Moment about x
    Rx,
    /// Moment about y
    Ry,
    /// Moment about z
    Rz,
}

impl Axis {
    /// Unit load.
    pub(crate) fn load(self) -> Wrench {
        let (force, moment) = match self {
            Self::X => (Vector3::x(), Vector3::zeros()),
            Self::Y => (Vector3::y(), Vector3::zeros()),
            Self::Z => (Vector3::z(), Vector3::zeros()),
            Self::Rx => (Vector3::zeros(), Vector3::x()),
            Self::Ry => (Vector3::zeros(), Vector3::y()),
            Self::Rz => (Vector3::zeros(), Vector3::z()),
        };
        Wrench::new(force, moment)
    }

    pub(crate) fn words(self) -> &'static str {
        match self {
            Self::X => "a force along x",
            Self::Y => "a force along y",
            Self::Z => "a force along z",
            Self::Rx => "a moment about x",
            Self::Ry => "a moment about y",
            Self::Rz => "a moment about z",
        }
    }
}

const HELP: &str = "\
Examples:
  kinetostat shares orthoglide --at 50 50 150 --direction x
  kinetostat shares heavy_6r --direction z --plot shares.svg
  kinetostat shares heavy_6r --force 800 0 -900 --sensitivities
      which number of the model file changes the deflection by how much
  kinetostat shares heavy_6r --reduce-percent 30
      the cheapest way to 30 % less deflection, by relative stiffening

Exit codes:
  0    answered
  1    wrong input: a file, a number or an option; the message says which
  2    no answer: not converged, a point that cannot be reached, or a direction
       that nothing holds or in which nothing yields";
