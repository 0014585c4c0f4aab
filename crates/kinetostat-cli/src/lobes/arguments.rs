//! Options of `lobes`.

use clap::Args;

use crate::files::answer_files::AnswerFiles;
use crate::force::arguments::MaterialArgs;
use crate::options::{EXIT_CODES, number, whole};
use crate::vibration::arguments::VibrationArgs;
use crate::vibration::damping::DampingArgs;

/// At which spindle speed and depth a milling cut chatters
///
/// Stability lobes of the machine in its loaded posture, exact (monodromy of the regenerative cut by
/// collocation), flip and Hopf told apart, with islands. Limits of zeroth order stand beside them under
/// their own name: on robots they may be several times too large. Straight edges or a helix of even
/// pitch; linear force law, stated or of a material; no process damping.
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES, after_long_help = HELP)]
pub(crate) struct LobesArgs {
    #[command(flatten)]
    pub(crate) machine: VibrationArgs,
    #[command(flatten)]
    pub(crate) cut: LobeCutArgs,
    #[command(flatten)]
    pub(crate) damping: DampingArgs,
    #[command(flatten)]
    pub(crate) outputs: AnswerFiles,
}

/// What is cut, with what, and which speeds and depths are looked at.
#[derive(Debug, Default, Args)]
pub(crate) struct LobeCutArgs {
    /// Slowest and fastest spindle speed, rpm, and how many
    #[arg(long, num_args = 3, value_names = ["LO", "HI", "N"], allow_negative_numbers = true, value_parser = number, required = true, help_heading = "Cut")]
    pub(crate) rpm: Vec<f64>,
    /// Largest depth of cut that is looked at, mm
    #[arg(long, value_name = "A", allow_negative_numbers = true, value_parser = number, default_value = "5", help_heading = "Cut")]
    pub(crate) depth_mm: f64,
    /// Force by area of chip: tangential, radial and axial, N/mm^2 (the radial one is no ratio; a
    /// positive axial one pushes the tool towards the spindle: below zero with a helix that lifts the chip)
    #[arg(long, num_args = 3, value_names = ["KT", "KR", "KA"], allow_negative_numbers = true, value_parser = number, required_unless_present = "material", conflicts_with = "material", help_heading = "Cut")]
    pub(crate) coefficients_n_per_mm2: Vec<f64>,
    /// Feed per tooth, mm: the law of --material is taken as a straight line at the mean thickness of its chips
    #[arg(long, value_name = "F", allow_negative_numbers = true, value_parser = number, requires = "material", help_heading = "Cut")]
    pub(crate) feed_per_tooth_mm: Option<f64>,
    /// Width of cut by diameter of the tool: 1 is a slot
    #[arg(long, value_name = "SHARE", allow_negative_numbers = true, value_parser = number, default_value = "1", help_heading = "Cut")]
    pub(crate) immersion: f64,
    /// Up (conventional) milling; without it down (climb)
    #[arg(long, help_heading = "Cut", conflicts_with = "climb")]
    pub(crate) up: bool,
    /// Down (climb) milling, as without it
    #[arg(long, help_heading = "Cut")]
    pub(crate) climb: bool,
    /// Direction of the feed, base axes
    #[arg(long, num_args = 3, value_names = ["X", "Y", "Z"], allow_negative_numbers = true, value_parser = number, default_values = ["1", "0", "0"], help_heading = "Cut")]
    pub(crate) feed_direction: Vec<f64>,
    /// Number of teeth
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole, required = true, help_heading = "Tool")]
    pub(crate) teeth: usize,
    /// Helix angle, degrees; it needs --diameter-mm
    #[arg(long, value_name = "ANGLE", allow_negative_numbers = true, value_parser = number, help_heading = "Tool")]
    pub(crate) helix_deg: Option<f64>,
    /// Diameter of the tool, mm
    #[arg(long, value_name = "D", allow_negative_numbers = true, value_parser = number, help_heading = "Tool")]
    pub(crate) diameter_mm: Option<f64>,
    /// From the tip towards the spindle, base axes [default: against z of the tool's tip]
    #[arg(long, num_args = 3, value_names = ["X", "Y", "Z"], allow_negative_numbers = true, value_parser = number, help_heading = "Tool")]
    pub(crate) tool_axis: Option<Vec<f64>>,
    /// Modes above this count by their flexibility at rest, Hz [default: 1000, and as far as modes count]
    #[arg(long, value_name = "F", allow_negative_numbers = true, value_parser = number)]
    pub(crate) modes_up_to_hz: Option<f64>,
    #[command(flatten)]
    pub(crate) material: MaterialArgs,
}

const HELP: &str = "\
Examples:
  kinetostat lobes heavy_6r --damping 0.03 --teeth 2 --immersion 0.5 --up \\
      --coefficients-n-per-mm2 800 240 0 --rpm 1000 6000 60 --plot lobes.svg
  kinetostat lobes heavy_6r --damping 0.03 --teeth 4 --immersion 0.3 \\
      --material Ti-6Al-4V --feed-per-tooth-mm 0.08 --rpm 300 2000 40

Exit codes:
  0    answered
  1    wrong input: a file, a number or an option, or a model without mass
  2    no answer: the machine does not hold its place, not converged, or a point
       that cannot be reached";
