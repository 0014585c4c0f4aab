//! Options of `compare`.

use clap::Args;

use crate::files::answer_files::AnswerFiles;
use crate::options::{EXIT_CODES, number};

/// Which of two designs is stiffer where, and by which parts
///
/// Puts both at the same places: stiffness along the axes and the shares of their parts beside each
/// other, and over a grid the difference at every place that both reach. (`model compare` tells whether
/// two files describe one machine.)
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES, after_long_help = HELP)]
pub(crate) struct CompareArgs {
    /// Preset or model file
    #[arg(value_name = "A")]
    pub(crate) a: String,
    /// Preset or model file
    #[arg(value_name = "B")]
    pub(crate) b: String,
    /// Position of the tool, base axes, mm; may be repeated. Without it, each at its home
    #[arg(long, num_args = 3, value_names = ["X", "Y", "Z"], allow_negative_numbers = true, value_parser = number)]
    pub(crate) at: Vec<f64>,
    /// Grid along x of the base, mm: from, to, and how many places
    #[arg(long, num_args = 3, value_names = ["FROM", "TO", "N"], allow_negative_numbers = true, help_heading = "Grid", value_parser = number)]
    pub(crate) x: Option<Vec<f64>>,
    /// The same along y
    #[arg(long, num_args = 3, value_names = ["FROM", "TO", "N"], allow_negative_numbers = true, help_heading = "Grid", value_parser = number)]
    pub(crate) y: Option<Vec<f64>>,
    /// The same along z
    #[arg(long, num_args = 3, value_names = ["FROM", "TO", "N"], allow_negative_numbers = true, help_heading = "Grid", value_parser = number)]
    pub(crate) z: Option<Vec<f64>>,
    /// Distance of the tool's tip along z of the flange, mm, of both
    #[arg(long, value_name = "L", allow_negative_numbers = true, value_parser = number)]
    pub(crate) tool_length_mm: Option<f64>,
    #[command(flatten)]
    pub(crate) outputs: AnswerFiles,
}

const HELP: &str = "\
Examples:
  kinetostat compare orthoglide tripteron
  kinetostat compare kuka_kr270_like abb_irb6640_like --at 1500 0 1200 --json
  kinetostat compare orthoglide stiffer.toml --x -60 60 13 --y -60 60 13 \\
      --plot difference.svg --csv difference.csv
      where the second is stiffer, and by how much

Every machine has the orientation of its own home; where it turns as it moves, the
nearest to that.

Exit codes:
  0    answered
  1    wrong input: a file, a number or an option; the message says which
  2    no answer: a place that one of them cannot reach, or none that both reach";
