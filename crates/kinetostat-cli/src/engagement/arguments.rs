//! Options of `engagement`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use crate::files::answer_files::AnswerFiles;
use crate::force::arguments::{MaterialArgs, PartWord, SpindleArgs, ToolArgs};
use crate::job::arguments::ReadingArgs;
use crate::job::expansion::arguments::ExpandFlags;
use crate::options::number;

/// What a program cuts: engagement, force, torque and power along it
///
/// Takes a G-code program with tool, material and stock from options, or the job file of
/// `compensate`; options go over the job file. The tools go through the stock as the program says; at
/// every place the force follows from what they meet. No machine is needed: model, placement and
/// tool lengths of a job play no part.
#[derive(Debug, Args)]
#[command(after_help = CODES, after_long_help = ENGAGEMENT_HELP)]
pub(crate) struct EngagementArgs {
    /// G-code program, or a job file
    #[arg(value_name = "PROGRAM|JOB", required_unless_present_any = ["job", "program"])]
    pub(crate) subject: Option<PathBuf>,
    /// Job file (TOML), for everything that no option says
    #[arg(long, value_name = "JOB")]
    pub(crate) job: Option<PathBuf>,
    /// G-code program, in place of the job's
    #[arg(long, short, value_name = "FILE")]
    pub(crate) program: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) material: MaterialArgs,
    #[command(flatten)]
    pub(crate) tool: ToolArgs,
    #[command(flatten)]
    pub(crate) stock: StockArgs,
    #[command(flatten)]
    pub(crate) turning: TurningArgs,
    #[command(flatten)]
    pub(crate) spindle: SpindleArgs,
    #[command(flatten)]
    pub(crate) reading: ReadingArgs,
    #[command(flatten)]
    pub(crate) expansion: ExpandFlags,
    #[command(flatten)]
    pub(crate) outputs: AnswerFiles,
}

/// Where the tools are in the material.
#[derive(Debug, Args)]
pub(crate) struct StockArgs {
    /// Block before the cut: two opposite corners in the coordinates of the program, mm
    #[arg(long, num_args = 6, value_names = ["X0", "Y0", "Z0", "X1", "Y1", "Z1"], help_heading = "Stock", allow_negative_numbers = true, value_parser = number, conflicts_with_all = ["width_mm", "depth_mm", "part"])]
    pub(crate) block_mm: Option<Vec<f64>>,
    /// Size of its cells, mm [default: a twentieth of the smallest tool's diameter]
    #[arg(long, value_name = "MM", help_heading = "Stock", requires = "block_mm", allow_negative_numbers = true, value_parser = number)]
    pub(crate) cell_mm: Option<f64>,
    /// Memory that it may take, MB [default: 500]
    #[arg(long, value_name = "MB", help_heading = "Stock", requires = "block_mm", allow_negative_numbers = true, value_parser = number)]
    pub(crate) memory_mb: Option<f64>,
    /// In place of a block: width of the cut on all feed moves, mm; the diameter is a slot
    #[arg(long, value_name = "AE", help_heading = "Stock", requires = "depth_mm", allow_negative_numbers = true, value_parser = number)]
    pub(crate) width_mm: Option<f64>,
    /// Its depth, mm
    #[arg(long, value_name = "AP", help_heading = "Stock", requires = "width_mm", allow_negative_numbers = true, value_parser = number)]
    pub(crate) depth_mm: Option<f64>,
    /// On which side of the tool the part is then, seen along the feed
    #[arg(
        long,
        value_enum,
        value_name = "SIDE",
        help_heading = "Stock",
        requires = "width_mm"
    )]
    pub(crate) part: Option<PartWord>,
}

/// How the spindle turns, where the program does not say it.
#[derive(Debug, Args)]
pub(crate) struct TurningArgs {
    /// Speed in place of the program's S, turns per minute
    #[arg(long, value_name = "S", help_heading = "Spindle", allow_negative_numbers = true, value_parser = number)]
    pub(crate) rpm: Option<f64>,
    /// Sense in place of the program's M3 and M4, seen from the spindle
    #[arg(long, value_enum, value_name = "SENSE", help_heading = "Spindle")]
    pub(crate) rotation: Option<RotationWord>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum RotationWord {
    /// As after M3
    Clockwise,
    /// As after M4
    CounterClockwise,
}

const CODES: &str = "\
Exit codes:
  0    answered
  1    wrong input: a file, a number or an option; the message says which
  130  stopped with Ctrl-C; nothing was written";

const ENGAGEMENT_HELP: &str = r#"Examples:
  kinetostat engagement part.ngc --material AlMg4.5Mn --tool flat \
      --diameter-mm 6 --teeth 2 --helix-deg 30 --rpm 12000 \
      --rotation clockwise --block-mm -30 -20 -20 30 20 0 --plot cut.svg
      --rpm and --rotation stand for S and M3, where the program has none
  kinetostat engagement part.ngc --material C45 --tool-table tools.toml \
      --tool-number 3 --width-mm 2 --depth-mm 3 --part right --rpm 4000 \
      --rotation clockwise
      the same cut on all feed moves; without --tool-number, T calls the tools
  kinetostat engagement milling.toml --plot cut.svg --csv cut.csv
  kinetostat engagement part.ngc --job milling.toml --json

A job file:
  schema = 1
  program = "part.ngc"

  [tool]
  cutter = { shape = "flat", diameter_mm = 6, teeth = 2, helix_deg = 30 }
  # [[tools]]                      # several tools: T1 M6, T2 M6
  # number = 1
  # cutter = { ... }

  [material]
  name = "AlMg4.5Mn"               # kinetostat force --list-materials

  [stock]                          # before the cut, program coordinates
  block_mm = [[-30, -20, -20], [30, 20, 0]]
  # or cylinder = { ... }, stl = "part.stl", height_map = { ... }
  # cell_mm = 0.3, memory_mb = 500

  # [engagement]                   # in place of a stock
  # width_mm = 2, depth_mm = 3, part = "right"

  [spindle]
  rpm = 12000                      # in place of the program's S
  rotation = "clockwise"           # in place of its M3 or M4
  power_w = 800                    # if its limits are to be compared
  base_rpm = 10000
  most_rpm = 24000

The picture shows the stock from above, in grey what stays as it is, in colour
how deep it is cut; below it force with its band, depth, arc and torque along
the path. The table (CSV) has a row for every place that was looked at; the
force is that on the tool: along the feed, to its left, along z of the part.

Exit codes:
  0    answered
  1    wrong input: a file, a number or an option; the message says which
  130  stopped with Ctrl-C; nothing was written"#;
