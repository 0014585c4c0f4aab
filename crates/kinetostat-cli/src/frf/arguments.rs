//! Options of `frf`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use crate::files::answer_files::AnswerFiles;
use crate::options::{EXIT_CODES, number, whole};
use crate::vibration::arguments::VibrationArgs;
use crate::vibration::damping::DampingArgs;

/// How the tool's tip answers to a vibrating force, over the frequency
///
/// Entries of the 6 x 6 frequency response at the tool's tip about the equilibrium under weight,
/// preloads and the load: receptance, mobility or accelerance. Modes that are left out count by their
/// flexibility at rest, so that at 0 Hz the response is the loaded compliance.
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES, after_long_help = HELP)]
pub(crate) struct FrfArgs {
    #[command(flatten)]
    pub(crate) machine: VibrationArgs,
    /// Lowest and highest frequency, Hz, and how many
    #[arg(long, num_args = 3, value_names = ["LO", "HI", "N"], allow_negative_numbers = true, value_parser = number, default_values = ["1", "200", "1000"])]
    pub(crate) frequencies: Vec<f64>,
    /// Motions of the tip that are looked at, as in x,y,rz [default: the same as --from]
    #[arg(long, value_enum, num_args = 1.., value_delimiter = ',', value_name = "AXIS")]
    pub(crate) to: Vec<MotionAxis>,
    /// Forces and moments on the tip, as in x,y,rz; without --to, each with the motion along itself
    #[arg(long, value_enum, num_args = 1.., value_delimiter = ',', value_name = "AXIS", default_values = ["x", "y", "z"])]
    pub(crate) from: Vec<MotionAxis>,
    /// Which motion by force
    #[arg(long, value_enum, default_value_t = QuantityWord::Receptance, value_name = "WORD")]
    pub(crate) quantity: QuantityWord,
    /// Only the lowest modes vibrate; the others count by their flexibility at rest
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole)]
    pub(crate) modes: Option<usize>,
    /// Directions in which the tool is held while it vibrates, as in rx,ry,rz
    #[arg(long, value_name = "LIST")]
    pub(crate) hold: Option<String>,
    /// Measured responses to draw beside it: universal file (data set 58) or CSV
    #[arg(long, value_name = "FILE")]
    pub(crate) measured: Option<PathBuf>,
    /// Modes that are found in the measured responses, within --frequencies, and compared with the
    /// model's
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole, requires = "measured")]
    pub(crate) fit: Option<usize>,
    /// Numbers of the model that are scaled until its frequencies are the measured ones, by their paths:
    /// "chain.arm.joint 2.stiffness_n_m_per_rad"; of the damping until its ratios are: damping.ratio,
    /// damping.ratios.1, damping.rayleigh.stiffness_s, damping.loss_factor, damping.viscous.JOINT
    #[arg(long, num_args = 1.., value_name = "PATH", requires = "fit")]
    pub(crate) scale: Vec<String>,
    /// They are scaled by at most this factor, up or down
    #[arg(long, value_name = "FACTOR", allow_negative_numbers = true, value_parser = number, default_value = "4", requires = "scale")]
    pub(crate) scale_within: f64,
    /// How well measured frequencies are known, as a share of themselves (one standard deviation)
    #[arg(long, value_name = "SHARE", allow_negative_numbers = true, value_parser = number, default_value = "0.01", requires = "scale")]
    pub(crate) frequencies_known_to: f64,
    /// How well measured damping ratios are known, as a share of themselves (one standard deviation)
    #[arg(long, value_name = "SHARE", allow_negative_numbers = true, value_parser = number, default_value = "0.2", requires = "scale")]
    pub(crate) damping_known_to: f64,
    #[command(flatten)]
    pub(crate) damping: DampingArgs,
    #[command(flatten)]
    pub(crate) outputs: AnswerFiles,
}

/// An axis of the base at the tool's tip.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum MotionAxis {
    /// Along x
    X,
    /// Along y
    Y,
    /// Along z
    Z,
    /// About x
    Rx,
    /// About y
    Ry,
    /// About z
    Rz,
}

/// A motion by a force.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum QuantityWord {
    /// Displacement by force, m/N
    Receptance,
    /// Velocity by force, m/(s N)
    Mobility,
    /// Acceleration by force, m/(s^2 N)
    Accelerance,
}

impl QuantityWord {
    pub(crate) fn word(self) -> &'static str {
        match self {
            Self::Receptance => "receptance",
            Self::Mobility => "mobility",
            Self::Accelerance => "accelerance",
        }
    }
}

/// Names of the six axes.
pub(crate) const AXES: [&str; 6] = ["x", "y", "z", "rx", "ry", "rz"];

impl FrfArgs {
    /// Motions and forces by index: what is asked for.
    pub(crate) fn entries(&self) -> Vec<(usize, usize)> {
        let from = self.from.iter().map(|axis| *axis as usize);
        match self.to.is_empty() {
            true => from.map(|axis| (axis, axis)).collect(),
            false => from
                .flat_map(|from| self.to.iter().map(move |to| (*to as usize, from)))
                .collect(),
        }
    }
}

const HELP: &str = "\
Examples:
  kinetostat frf heavy_6r --damping 0.03 --plot response.svg
  kinetostat frf heavy_6r --from x --to x,y,z --frequencies 1 100 2000 \\
      --damping 0.03 0.02 --quantity accelerance --csv response.csv
  kinetostat frf cell.toml --at 1600 0 900 --measured tap_test.uff --fit 3 \\
      --frequencies 5 80 1000 --scale \"chain.arm.joint 2.stiffness_n_m_per_rad\"

Exit codes:
  0    answered
  1    wrong input: a file, a number or an option, or a model without mass
  2    no answer: not converged, or a point that cannot be reached";
