//! Options of `place`.

use std::path::PathBuf;

use clap::Args;

use crate::job::arguments::ProgramArgs;
use crate::job::place_table::ObjectiveWord;
use crate::options::{EXIT_CODES, number, whole};

/// Where does the part lie best?
///
/// Looks for the place of the part, its turn, and the turn of the tool about its own axis for which the
/// largest error of the whole program is least (or correction, tilt, drive load, share of
/// buckling). Every place of the program is reached inside the limits there. Says the ten next best
/// placements, how much room there is around the best one, and what was found at the ends of ranges.
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES, after_long_help = HELP)]
// Options of other commands along a program are hidden, and refused in words.
#[command(mut_arg("report", |arg| arg.hide(true)))]
#[command(mut_arg("pdf", |arg| arg.hide(true)))]
#[command(mut_arg("language", |arg| arg.hide(true)))]
#[command(mut_arg("part_number", |arg| arg.hide(true)))]
#[command(mut_arg("revision", |arg| arg.hide(true)))]
#[command(mut_arg("points", |arg| arg.hide(true)))]
#[command(mut_arg("all_points", |arg| arg.hide(true)))]
#[command(mut_arg("restart", |arg| arg.hide(true)))]
#[command(mut_arg("vtk", |arg| arg.hide(true)))]
#[command(mut_arg("free_turn", |arg| arg.hide(true)))]
#[command(mut_arg("stiff_turn", |arg| arg.hide(true)))]
#[command(mut_arg("turn_plot", |arg| arg.hide(true)))]
#[command(mut_arg("uncertain", |arg| arg.hide(true)))]
#[command(mut_arg("machines", |arg| arg.hide(true)))]
pub(crate) struct PlacingArgs {
    /// Job file (TOML): model, program, placement, load, and under [place] where the part may lie
    #[arg(value_name = "JOB")]
    pub(crate) job: Option<PathBuf>,
    /// Preset or model file
    #[arg(long, value_name = "MODEL")]
    pub(crate) model: Option<String>,
    /// What is to be least over the whole program [default: error]
    #[arg(long, value_enum, value_name = "WHAT", help_heading = "Search")]
    pub(crate) objective: Option<ObjectiveWord>,
    /// Between which places the program's zero point may lie along x of the base, mm; without it, it
    /// stays as in the placement
    #[arg(long, num_args = 2, value_names = ["FROM", "TO"], allow_negative_numbers = true, help_heading = "Search", value_parser = number)]
    pub(crate) x_mm: Option<Vec<f64>>,
    /// The same along y
    #[arg(long, num_args = 2, value_names = ["FROM", "TO"], allow_negative_numbers = true, help_heading = "Search", value_parser = number)]
    pub(crate) y_mm: Option<Vec<f64>>,
    /// The same along z
    #[arg(long, num_args = 2, value_names = ["FROM", "TO"], allow_negative_numbers = true, help_heading = "Search", value_parser = number)]
    pub(crate) z_mm: Option<Vec<f64>>,
    /// How the part may be turned about x of the base through the program's zero point, degrees on top
    /// of its orientation; the tool keeps its axis in the part
    #[arg(long, num_args = 2, value_names = ["FROM", "TO"], allow_negative_numbers = true, help_heading = "Search", value_parser = number)]
    pub(crate) turn_x_deg: Option<Vec<f64>>,
    /// The same about y
    #[arg(long, num_args = 2, value_names = ["FROM", "TO"], allow_negative_numbers = true, help_heading = "Search", value_parser = number)]
    pub(crate) turn_y_deg: Option<Vec<f64>>,
    /// The same about z
    #[arg(long, num_args = 2, value_names = ["FROM", "TO"], allow_negative_numbers = true, help_heading = "Search", value_parser = number)]
    pub(crate) turn_z_deg: Option<Vec<f64>>,
    /// How the tool may be turned about its own axis, degrees; a round tool does not notice
    #[arg(long, num_args = 2, value_names = ["FROM", "TO"], allow_negative_numbers = true, help_heading = "Search", value_parser = number)]
    pub(crate) turn_tool_deg: Option<Vec<f64>>,
    /// How many placements fill the ranges before the best are refined [default: 64 to 1024, by the
    /// number of ranges]
    #[arg(long, value_name = "N", allow_negative_numbers = true, help_heading = "Search", value_parser = whole)]
    pub(crate) samples: Option<usize>,
    #[command(flatten)]
    pub(crate) program: ProgramArgs,
    /// Print the result as JSON (the text goes to the standard error), or write it to FILE
    #[arg(long, value_name = "FILE", num_args = 0..=1, default_missing_value = "-", help_heading = "Outputs")]
    pub(crate) json: Option<PathBuf>,
    /// All placements that fill the ranges, and those of the map, as a table (CSV)
    #[arg(long, value_name = "FILE", help_heading = "Outputs")]
    pub(crate) csv: Option<PathBuf>,
    /// Map of the figure through the best placement, with the next best ones (SVG)
    #[arg(long, value_name = "FILE", help_heading = "Outputs")]
    pub(crate) plot: Option<PathBuf>,
}

const HELP: &str = r#"Examples:
  kinetostat place job.toml --plot where.svg
  kinetostat place --model orthoglide --program part.ngc --tool-length-mm 100 \
      --part-origin-mm 0 0 100 --milling 215 -10 -25 \
      --x-mm -40 40 --y-mm -40 40 --json where.json

In the job file:
  [place]
  objective = "error"
  x_mm = [1200, 1800]
  y_mm = [-400, 400]
  turn_tool_deg = [-180, 180]
  part_box_mm = [[0, 0, -40], [200, 100, 0]]

  [[place.obstacles]]
  name = "column"
  from_mm = [900, 200, 0]
  to_mm = [1300, 600, 900]

  [[place.fixtures]]               # instead of x_mm, y_mm and z_mm
  name = "left vice"
  part_origin_mm = [1400, 300, 500]

Exit codes:
  0    answered
  1    wrong input: a file, a number or an option; the message says which
  2    no answer: the program can be run at none of the placements
  130  stopped with Ctrl-C; nothing was written"#;
