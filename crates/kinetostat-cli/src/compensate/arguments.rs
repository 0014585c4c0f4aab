//! Options of `compensate`.

use std::path::PathBuf;

use clap::Args;

use crate::job::arguments::RunArgs;
use crate::job::format::ArcsWord;
use crate::job::target_word::RobotWord;
use crate::options::{EXIT_CODES, number, small};

/// Write a program that cuts where it should
///
/// Reads model, program, placement and load from a job file, from options, or from both (options go
/// over the job file), solves the machine along the program, writes the compensated program, reads
/// it again from its bytes and solves it once more: the error after compensation is measured, not
/// promised. Nothing is overwritten without --force-overwrite, an input never.
#[derive(Debug, Default, Args)]
#[command(after_help = EXIT_CODES, after_long_help = COMPENSATE_HELP)]
pub(crate) struct CompensateArgs {
    #[command(flatten)]
    pub(crate) run: RunArgs,
    /// The compensated program; without it, PROGRAM-compensated beside the job or the program, or compensated/PROGRAM of one that its
    /// controller loads by name
    #[arg(long, short, value_name = "FILE", help_heading = "Outputs")]
    pub(crate) out: Option<PathBuf>,
    /// Convert the program for a robot first, and compensate that (other languages: `kinetostat convert`)
    #[arg(long, value_enum, value_name = "LANGUAGE", help_heading = "Other language", conflicts_with_all = ["map", "no_compensation"])]
    pub(crate) to: Option<RobotWord>,
    /// Template of the cell for that (`kinetostat help convert`): numbers, speeds, zones, and tool and part where the job
    /// has none
    #[arg(long, value_name = "FILE", help_heading = "Other language")]
    pub(crate) template: Option<PathBuf>,
    /// Corrections from a table instead of a model: CSV with the columns
    /// x_mm,y_mm,z_mm,dx_mm,dy_mm,dz_mm on a full grid
    #[arg(long, value_name = "FILE", conflicts_with_all = ["model", "force", "moment", "load_axes", "milling", "load_at_corners", "below_z_mm", "tool_length_mm", "part_origin_mm", "part_orientation", "tool_orientation", "scale", "report", "pdf", "language", "part_number", "revision", "points"])]
    pub(crate) map: Option<PathBuf>,
    /// Write the program of a machine as it was read, byte for byte; with --expand its flat form
    #[arg(long, conflicts_with_all = ["map", "json", "report", "pdf", "language", "part_number", "revision", "points", "again"])]
    pub(crate) no_compensation: bool,
    /// Compensate a program that is marked as compensated once more
    #[arg(long)]
    pub(crate) again: bool,
    /// Leave out the header that marks the program as compensated
    #[arg(long, help_heading = "Outputs")]
    pub(crate) no_header: bool,
    /// How far off the tool may be along the written program, micrometres, chords of arcs and rounding included (with
    /// --chord-tolerance-um those of arcs have their own): missed, the exit code is 3 [default: for straight pieces alone a
    /// third of the repeatability that the model states, 20 for an arm that states none, else 0.5]
    #[arg(long, value_name = "UM", help_heading = "Tolerances", allow_negative_numbers = true, value_parser = number)]
    pub(crate) tolerance_um: Option<f64>,
    /// What becomes of arcs where they are corrected: arcs again, or straight pieces [default: fit]
    #[arg(long, value_enum, value_name = "WHAT", help_heading = "Tolerances")]
    pub(crate) arcs: Option<ArcsWord>,
    /// Shortest block that the controller takes, mm: shorter pieces are shared out anew, and lines that need them are named
    #[arg(long, value_name = "MM", help_heading = "Tolerances", allow_negative_numbers = true, value_parser = number)]
    pub(crate) min_block_mm: Option<f64>,
    /// Digits after the point in mm, one more in inches [default: 4]
    #[arg(long, value_name = "N", help_heading = "Tolerances", allow_negative_numbers = true, value_parser = small)]
    pub(crate) decimals: Option<u8>,
    /// How many times the programmed feed may be written at most, to keep the speed along the part
    /// where the tool's own path is longer [default: 1.2]
    #[arg(long, value_name = "N", help_heading = "Tolerances", allow_negative_numbers = true, value_parser = number)]
    pub(crate) max_feed_factor: Option<f64>,
    /// Warn of steps that cut backwards by more than this, micrometres [default: 50]
    #[arg(long, value_name = "UM", help_heading = "Tolerances", allow_negative_numbers = true, value_parser = number)]
    pub(crate) backward_step_um: Option<f64>,
    /// Blocks that the controller reads in a second: as --min-block-mm, and a warning if the written program asks for more
    #[arg(long, value_name = "N", help_heading = "Tolerances", allow_negative_numbers = true, value_parser = number)]
    pub(crate) max_blocks_per_second: Option<f64>,
}

impl CompensateArgs {
    /// A job as it is written.
    pub(crate) fn of_job(job: PathBuf, force_overwrite: bool) -> Self {
        let mut args = Self::default();
        args.run.job = Some(job);
        args.run.program.force_overwrite = force_overwrite;
        args
    }
}

const COMPENSATE_HELP: &str = r#"Examples:
  kinetostat compensate job.toml
  kinetostat compensate job.toml --tolerance-um 1 --out tighter.ngc
  kinetostat compensate --model orthoglide --program part.ngc \
      --tool-length-mm 100 --part-origin-mm 20 20 120 --milling 215 -10 -25 \
      --out part-compensated.ngc
  kinetostat compensate --map measured.csv --program part.ngc \
      --out corrected.ngc
  kinetostat compensate --no-compensation --program part.ngc --out copy.ngc

A job file:
  schema = 1
  model = "orthoglide"             # a preset, or a file: "machine.toml"
  program = "part.ngc"             # paths start at the job file

  [placement]
  part_origin_mm = [20, 20, 120]   # the program's zero point, base axes
  part_orientation = { a_b_c_kuka_deg = [0, 0, 0] }
  # tool_orientation = { ... }     # without it, as at home
  # orientation = "follows"        # the nearest that there is; "held": it alone
  # scale = 1

  [tool]
  length_mm = 100                  # or pose = { position_mm = [...], ... }
  # mass_kg = 12                   # spindle and tool on the flange
  # centre_of_mass_mm = [0, 0, 60] # in it; halfway to the tip without this
  # inertia_kg_m2 = [[0.2, 0, 0], [0, 0.2, 0], [0, 0, 0.05]] # about that centre

  # [[tools]]                      # several tools: T1 M6, T2 M6
  # number = 1
  # length_mm = 100                # and load, at_corners, mass_kg too

  [load]                           # on feed moves; none in rapids
  milling = { radial_n = 215, tangential_n = -10, axial_n = -25 }
  # or force_n = [0, 0, -200], moment_n_m = [0, 0, 1], axes = "base"
  # below_z_mm = 0, gentle_corner_deg = 30, turning_length_mm = 2
  # largest_step_mm_per_mm = 0.5   # of the correction, outside sharp corners
  # at_corners = "turns"           # or "follows_feed"

  # [material]                     # instead of [load]: the force of the cut
  # name = "AlMg4.5Mn"             # `kinetostat force --list-materials`
  # [cutters]                      # or cutter = { ... } under [tool]
  # file = "tools.toml"
  # [stock]                        # or [engagement] width_mm, depth_mm, part
  # block_mm = [[0, 0, -10], [90, 60, 0]]
  # [spindle]                      # rpm, rotation, force = "mean"
  # power_w = 800, base_rpm = 10000, most_rpm = 24000

  # [measured]                     # instead of [load]: a log of the forces
  # file = "log.csv"               # time_s or along_mm, fx_n, fy_n, fz_n
  # acts_on = "part"               # or "tool"; axes = "part" or "feed"
  # rapid_mm_per_min = 10000, shift_s = 2.5, air_s = [[0, 1], [58, 60]]
  # dwell_unit = "s"               # what the P of G4 counts: "s" or "ms"
  # smooth_s = 0.01, drift = "line", outliers = "replace"

  [reading]
  # units = "mm", arc_tolerance_mm = 0.005, block_delete = "run"
  # axes_stand_still = true   (a program with words of A B C U V W)
  # start_position_mm = [0, 0, 50]
  # machine_zero_mm = [0, 0, 300], g28_mm = [0, 0, 0], g30_mm = [0, 0, 0]
  # work_offset_mm = { G54 = [0, 0, 0] }

  # [expand]                       # a program with macros, run once
  # subprograms = ["macros"], comments = true
  # tool_diameters_mm = { 1 = 6.5 }, parameters = { 100 = 2.5 }

  # [robot]                        # written for a robot; a round tool turned
  # to = "krl", template = "cell.toml", free_turn = "choose"

  [tolerances]
  path_um = 0.5
  chord_um = 0.4
  # arcs = "fit"                   # or "lines": straight pieces for arcs
  # decimals = 4, max_blocks_per_second = 500, min_block_mm = 0.01
  # max_feed_factor = 1.2, backward_step_um = 50

  [output]                         # below the job's own directory
  program = "compensated.ngc"
  report = "report.html"
  json = "result.json"
  points = "points.csv"
  # flat_program = "flat.ngc"      # of an expanded or converted program
  # turn_plot = "turn.svg"         # the turn that free_turn chose
  # header = true

  # [[features]]                   # each with a verdict of its own
  # name = "pocket", lines = [12, 40], tolerance_um = 5

  [limits]                         # a program that leaves them is refused
  # correction_mm = 2, own_weight_mm = 5, tilt_deg = 1
  # force_n = 5000, moment_n_m = 200
  # share_of_rating = 1, share_of_buckling = 0.5, blocks_per_second = 2000
  # shortest_tool_mm = 1, longest_tool_mm = 1000, below_base_mm = 400
  # nearest_base_mm = 10, speed_mm_per_s = 3000, zone_mm = 5

Exit codes:
  0    answered
  1    wrong input: a file, a number or an option; the message says which
  2    no answer: not converged, or a point that cannot be reached
  3    compensated and written, but the tolerance is missed; the line is said
  4    compensated and written; the tolerance is kept only if the assumptions hold
  130  stopped with Ctrl-C; nothing was written"#;
