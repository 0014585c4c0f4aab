//! Options of `engagement`.

use std::path::PathBuf;

use clap::Args;

use crate::files::answer_files::AnswerFiles;

/// What a program cuts: engagement, force, torque and power along it
///
/// Takes the job file of `compensate`: program, cutters, material, stock (or engagement) and spindle. The
/// tools go through the stock as the program says; at every place the force follows from what they
/// meet. No machine is needed: model, placement and tool lengths of the job play no part.
#[derive(Debug, Args)]
#[command(after_help = CODES, after_long_help = ENGAGEMENT_HELP)]
pub(crate) struct EngagementArgs {
    /// Job file (TOML): program, tool with a cutter, material, stock or engagement, spindle
    #[arg(value_name = "JOB")]
    pub(crate) job: PathBuf,
    /// G-code program, in place of the job's
    #[arg(long, short, value_name = "FILE")]
    pub(crate) program: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) outputs: AnswerFiles,
}

const CODES: &str = "\
Exit codes:
  0    answered
  1    wrong input: a file, a number or an option; the message says which
  130  stopped with Ctrl-C; nothing was written";

const ENGAGEMENT_HELP: &str = r#"Examples:
  kinetostat engagement milling.toml
  kinetostat engagement milling.toml --plot cut.svg --csv cut.csv
  kinetostat engagement milling.toml --program part.ngc --json

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
