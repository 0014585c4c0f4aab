//! Options of `convert`.

use std::path::PathBuf;

use clap::{ArgAction, Args};

use crate::job::arguments::ReadingArgs;
use crate::job::expansion::arguments::ExpandFlags;
use crate::job::robot_arguments::{AxisWord, JointRowsWord, StatedArgs};
use crate::job::target_word::TargetWord;
use crate::options::number;

/// A program of one language in another: G-code for a robot, KRL as RAPID
///
/// Lines stay lines, arcs stay arcs where the language has them, feeds stay; what stands beside the
/// moves becomes notes with their lines, and what is lost is named. The new program is read again and
/// compared with the path before it is written: the largest differences are said.
#[derive(Debug, Args)]
#[command(after_long_help = HELP)]
pub(crate) struct ConvertArgs {
    /// Program: G-code, or of a robot; of a job where this is left out
    #[arg(value_name = "PROGRAM")]
    pub(crate) program: Option<PathBuf>,
    /// Language of the new program
    #[arg(long, value_enum, value_name = "LANGUAGE")]
    pub(crate) to: TargetWord,
    /// The new program; the parts of a long one go beside it
    #[arg(long, short, value_name = "FILE")]
    pub(crate) out: PathBuf,
    /// Template of the cell (TOML): base, tool, orientation, speeds, zones, digits
    #[arg(long, value_name = "FILE")]
    pub(crate) template: Option<PathBuf>,
    /// Job file: what it says of reading the program
    #[arg(long, value_name = "JOB")]
    pub(crate) job: Option<PathBuf>,
    /// Orientation of the tool in the part, of a program of positions, as in a_b_c_kuka_deg=0,0,180
    #[arg(long, value_name = "CONVENTION=A,B,C")]
    pub(crate) tool_orientation: Option<String>,
    /// Arm (preset or model file) along whose way a round tool is turned about its axis: inside the limits of the
    /// joints, away from singular postures, in one configuration
    #[arg(long, value_name = "MODEL", help_heading = "Free turn")]
    pub(crate) free_turn: Option<String>,
    /// Choose that turn so that the tip of the tool yields little to a force, too
    #[arg(long, requires = "free_turn", help_heading = "Free turn")]
    pub(crate) stiff_turn: bool,
    /// Picture of that turn along the path (SVG)
    #[arg(
        long,
        value_name = "FILE",
        requires = "free_turn",
        help_heading = "Free turn"
    )]
    pub(crate) turn_plot: Option<PathBuf>,
    /// How far lines may leave helices and other curves that the language has not, mm [default:
    /// 0.001]
    #[arg(long, value_name = "MM", allow_negative_numbers = true, value_parser = number)]
    pub(crate) tolerance_mm: Option<f64>,
    /// Arm (preset or model file) whose joint values are written, or stand in the program [default: that of the job]
    #[arg(long, value_name = "MODEL", help_heading = "Joint values")]
    pub(crate) model: Option<String>,
    /// How the controller moves between the rows of a table of joint values: of one that is read, and of one that is written
    /// (linear: a row for each pose; joint: as many as the tolerance needs) [default: linear where it is written]
    #[arg(long, value_enum, value_name = "WAY", help_heading = "Joint values")]
    pub(crate) joint_rows: Option<JointRowsWord>,
    /// Move a limit, as in speed_mm_per_s=9000 (repeat for more): shortest_tool_mm, longest_tool_mm, nearest_base_mm,
    /// speed_mm_per_s, zone_mm. A program that leaves a limit is refused
    #[arg(long = "limit", value_name = "NAME=VALUE", action = ArgAction::Append, allow_hyphen_values = true, help_heading = "Limits")]
    pub(crate) limits: Vec<String>,
    /// Overwrite the outputs if they exist (never an input)
    #[arg(long)]
    pub(crate) force_overwrite: bool,
    #[command(flatten)]
    pub(crate) reading: ReadingArgs,
    /// Linear motions of a robot's program at this speed or a higher one are rapids, mm/s
    #[arg(long, value_name = "V", allow_negative_numbers = true, help_heading = "Robot programs", value_parser = number)]
    pub(crate) rapid_from_mm_per_s: Option<f64>,
    /// Axis of the tool of a robot's program from its tip to its holder, in axes of its frame [default: -z; of KRL -x]
    #[arg(
        long,
        value_enum,
        value_name = "AXIS",
        allow_hyphen_values = true,
        help_heading = "Robot programs"
    )]
    pub(crate) tool_axis: Option<AxisWord>,
    #[command(flatten)]
    pub(crate) stated: StatedArgs,
    #[command(flatten)]
    pub(crate) expansion: ExpandFlags,
}

const HELP: &str = r#"Examples:
  kinetostat convert part.ngc --to krl --out part.src --template cell.toml
  kinetostat convert part.ngc --to rapid --out part.mod \
      --tool-orientation a_b_c_kuka_deg=0,0,180
  kinetostat convert part.src --to ls --out part.ls
  kinetostat convert part.ngc --to krl --out part.src --template cell.toml \
      --free-turn heavy_6r --turn-plot turn.svg
  kinetostat convert macros.ngc --expand --to csv --out poses.csv
  kinetostat convert part.src --to joints --model arm.toml --out joints.csv
  kinetostat convert joints.csv --model arm.toml --joint-rows linear \
      --template cell.toml --to rapid --out part.mod

A template; all of it may be left out but tool_orientation, which programs of
positions need:
  schema = 1
  program_name = "part"            # without it, the name of the output
  tool_orientation = { a_b_c_kuka_deg = [0, 0, 180] }   # in axes of the part
  rapids = "linear"                # or "joint": another way than the source's
  rapid_speed_mm_per_s = 200
  joint_speed_percent = 10
  # unstated_feed_mm_per_s = 10    # of feeds without an F
  # acceleration_m_per_s2 = 2
  # configuration = "S 2, T 35"    # "[0,-1,0,0]", "N U T, 0, 0, 0"
  # start_joints_deg = [0, -90, 90, 0, 45, 0]
  # places_unknown = "left_out"    # G28, G53 between moves; else refused
  # tolerance_mm = 0.001, most_points = 5000
  # position_decimals = 6, angle_decimals = 8, quaternion_decimals = 10
  # speed_decimals = 1       # of mm/s

  [base]                           # where the part is
  number = 1                       # BASE_DATA[1], wobj1, UF : 1
  # name = "wPart"                 # RAPID
  # pose = { position_mm = [800, 0, 400], a_b_c_kuka_deg = [0, 0, 0] }

  [tool]
  number = 1
  # pose = { position_mm = [0, 0, 180] }
  # mass_kg = 5, centre_of_mass_mm = [0, 0, 60]   # RAPID, KRL

  # [[tools]]                      # of a program with several: T1 M6, T2 M6
  # in_program = 2                 # and number, name, pose, mass_kg as above

  # [spindle]                      # for S, M3, M4, M5; without it, notes
  # clockwise = ["$ANOUT[1]={rpm}/24000.0", "$OUT[12]=TRUE"]
  # counter_clockwise = [...], stop = ["$OUT[12]=FALSE"]

  [zones]                          # 0 stops at each end
  feeds_mm = 0.3                   # KRL and RAPID
  rapids_mm = 1
  feeds_percent = 20               # FANUC: CNT20
  rapids_percent = 50

Exit codes:
  0    answered
  1    wrong input: a file, a number or an option; the message says which"#;
