//! Options of a run along a program, over a job file.

use std::path::{Path, PathBuf};

use clap::{ArgAction, Args};

use crate::job::expansion::arguments::ExpandFlags;
use crate::job::format::{ArcsWord, Axes, BlockDeleteWord, CornerWord, WeightWord};
use crate::job::robot_arguments::RobotArgs;
use crate::job::turn_arguments::TurnFlags;
use crate::job::uncertain::UncertainFlags;
use crate::job::units_word::UnitsWord;
use crate::options::{number, whole};
use crate::ui::language::LanguageWord;

/// Job file, model and everything about the program.
#[derive(Debug, Default, Args)]
pub(crate) struct RunArgs {
    /// Job file (TOML): model, program, placement, load, tolerances, outputs
    #[arg(value_name = "JOB")]
    pub(crate) job: Option<PathBuf>,
    /// Preset or model file
    #[arg(long, value_name = "MODEL")]
    pub(crate) model: Option<String>,
    #[command(flatten)]
    pub(crate) program: ProgramArgs,
    /// Print the result as JSON (the text goes to the standard error), or write it to FILE
    #[arg(long, value_name = "FILE", num_args = 0..=1, default_missing_value = "-", help_heading = "Outputs")]
    pub(crate) json: Option<PathBuf>,
}

/// Options of a run along a program, shared by `compensate` and `deflect`.
#[derive(Clone, Debug, Default, Args)]
pub(crate) struct ProgramArgs {
    /// Program: G-code, or of a robot (`kinetostat dialect list`)
    #[arg(long, short, value_name = "FILE")]
    pub(crate) program: Option<PathBuf>,
    /// Distance of the tool's tip along z of the flange, mm
    #[arg(long, value_name = "L", allow_negative_numbers = true, help_heading = "Placement", value_parser = number)]
    pub(crate) tool_length_mm: Option<f64>,
    /// Where the program's zero point lies in the machine's base, mm
    #[arg(long, num_args = 3, value_names = ["X", "Y", "Z"], allow_negative_numbers = true, help_heading = "Placement", value_parser = number)]
    pub(crate) part_origin_mm: Option<Vec<f64>>,
    /// Orientation of the program's axes in the base, as in a_b_c_kuka_deg=90,0,0
    #[arg(long, value_name = "CONVENTION=A,B,C", help_heading = "Placement")]
    pub(crate) part_orientation: Option<String>,
    /// Orientation of the tool in the base, or the word follows: everywhere the one nearest to that
    /// at home which the machine can have. Without it, the one at home; it follows where the machine
    /// cannot hold one
    #[arg(long, value_name = "CONVENTION=A,B,C", help_heading = "Placement")]
    pub(crate) tool_orientation: Option<String>,
    /// Length in the machine per length in the program [default: 1]
    #[arg(long, value_name = "S", allow_negative_numbers = true, help_heading = "Placement", value_parser = number)]
    pub(crate) scale: Option<f64>,
    /// Force on the tool's tip, N: everywhere on feed moves (with --at: at that place)
    #[arg(long, num_args = 3, value_names = ["FX", "FY", "FZ"], allow_negative_numbers = true, help_heading = "Load", value_parser = number)]
    pub(crate) force: Option<Vec<f64>>,
    /// Moment on the tool about its tip, N m
    #[arg(long, num_args = 3, value_names = ["MX", "MY", "MZ"], allow_negative_numbers = true, help_heading = "Load", value_parser = number)]
    pub(crate) moment: Option<Vec<f64>>,
    /// Axes of force and moment [default: base]
    #[arg(long, value_enum, value_name = "AXES", help_heading = "Load")]
    pub(crate) load_axes: Option<Axes>,
    /// Milling force instead, N: to the right of the feed, along it, along the part's z
    #[arg(long, num_args = 3, value_names = ["RADIAL", "TANGENTIAL", "AXIAL"], allow_negative_numbers = true, conflicts_with_all = ["force", "moment", "load_axes"], help_heading = "Load", value_parser = number)]
    pub(crate) milling: Option<Vec<f64>>,
    /// Load on the steps that are written at sharp corners: it turns evenly while the tool steps, or it
    /// follows the feed; the program is the same, the claim about it is not [default: turns, which is an
    /// assumption until it is stated]
    #[arg(long, value_enum, value_name = "READING", help_heading = "Load")]
    pub(crate) load_at_corners: Option<CornerWord>,
    /// The load acts only below this height of the program, mm
    #[arg(long, value_name = "Z", allow_negative_numbers = true, help_heading = "Load", value_parser = number)]
    pub(crate) below_z_mm: Option<f64>,
    /// How much of the displacement by the machine's own weight counts as an error of the program; it must
    /// be stated where own weight moves the tool
    #[arg(long, value_enum, value_name = "SHARE", help_heading = "Load")]
    pub(crate) weight: Option<WeightWord>,
    /// Place where this machine touched the part off, program coordinates, mm, for --weight touch-off: one,
    /// or three and more (repeat it) that give the frame's orientation, too
    #[arg(long, num_args = 3, value_names = ["X", "Y", "Z"], action = ArgAction::Append, allow_negative_numbers = true, help_heading = "Load", value_parser = number)]
    pub(crate) touch_off: Option<Vec<f64>>,
    #[command(flatten)]
    pub(crate) reading: ReadingArgs,
    #[command(flatten)]
    pub(crate) robot: RobotArgs,
    #[command(flatten)]
    pub(crate) turn: TurnFlags,
    #[command(flatten)]
    pub(crate) expansion: ExpandFlags,
    /// How far the chords of arcs may leave them, micrometres [default: 0.4, in a
    /// compensated program at most 0.8 of the path's default tolerance]
    #[arg(long, value_name = "UM", allow_negative_numbers = true, help_heading = "Tolerances", value_parser = number)]
    pub(crate) chord_tolerance_um: Option<f64>,
    #[command(flatten)]
    pub(crate) uncertain: UncertainFlags,
    /// Move a limit, as in correction_mm=5 (repeat for more): correction_mm, own_weight_mm,
    /// tilt_deg, force_n, moment_n_m, share_of_rating, share_of_buckling, blocks_per_second, shortest_tool_mm,
    /// longest_tool_mm, nearest_base_mm, below_base_mm, speed_mm_per_s, zone_mm. A program that leaves a limit is refused
    #[arg(long = "limit", value_name = "NAME=VALUE", action = ArgAction::Append, allow_hyphen_values = true, help_heading = "Limits")]
    pub(crate) limits: Vec<String>,
    /// The report, one HTML file
    #[arg(long, value_name = "FILE", help_heading = "Outputs")]
    pub(crate) report: Option<PathBuf>,
    /// The report as PDF, to be signed and filed
    #[arg(long, value_name = "FILE", help_heading = "Outputs")]
    pub(crate) pdf: Option<PathBuf>,
    /// Language of the reports [default: en]. In French and German the HTML report is the paper
    #[arg(long, value_enum, value_name = "LANGUAGE", help_heading = "Outputs")]
    pub(crate) language: Option<LanguageWord>,
    /// Number of the part, for the reports and the result
    #[arg(
        long,
        value_name = "NUMBER",
        help_heading = "Outputs",
        allow_hyphen_values = true
    )]
    pub(crate) part_number: Option<String>,
    /// Revision of the part
    #[arg(
        long,
        value_name = "REVISION",
        help_heading = "Outputs",
        allow_hyphen_values = true
    )]
    pub(crate) revision: Option<String>,
    /// Points of the path as a table: CSV, of long programs the worst of every stretch; Parquet with every point where the name ends
    /// in .parquet
    #[arg(long, value_name = "FILE", help_heading = "Outputs")]
    pub(crate) points: Option<PathBuf>,
    /// The path as lines for ParaView (VTK): errors, corrections and loads as vectors at its points
    #[arg(long, value_name = "FILE", help_heading = "Outputs")]
    pub(crate) vtk: Option<PathBuf>,
    /// Every point in the table, however large it becomes
    #[arg(long, help_heading = "Outputs")]
    pub(crate) all_points: bool,
    /// Overwrite outputs that exist (never an input)
    #[arg(long, help_heading = "Outputs")]
    pub(crate) force_overwrite: bool,
    /// Begin a long program anew, though a run of it was interrupted and could go on
    #[arg(long, help_heading = "Outputs")]
    pub(crate) restart: bool,
    /// Lines of a part of a long program (for tests): a program of any length is run in parts
    #[arg(long, value_name = "N", hide = true, allow_negative_numbers = true, value_parser = whole)]
    pub(crate) part_lines: Option<usize>,
    /// Number of threads; all cores without it. The result is the same
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole)]
    pub(crate) threads: Option<usize>,
}

/// How the program is read.
#[derive(Clone, Debug, Default, Args)]
pub(crate) struct ReadingArgs {
    /// Units of a program that does not say G20 or G21
    #[arg(long, value_enum, value_name = "UNITS", help_heading = "Reading")]
    pub(crate) units: Option<UnitsWord>,
    /// Largest difference of an arc's radii at start and end, mm [default: 0.005]
    #[arg(long, value_name = "MM", allow_negative_numbers = true, help_heading = "Reading", value_parser = number)]
    pub(crate) arc_tolerance: Option<f64>,
    /// Origin of a work coordinate system in the part, mm: G54=x,y,z (repeat for more)
    #[arg(long, value_name = "G54=X,Y,Z", action = ArgAction::Append, allow_hyphen_values = true, help_heading = "Reading")]
    pub(crate) work_offset: Vec<String>,
    /// Blocks marked with `/`: run them (the default), or skip them
    #[arg(long, value_enum, value_name = "WHAT", help_heading = "Reading")]
    pub(crate) block_delete: Option<BlockDeleteWord>,
    /// Rotary and second axes (A B C U V W) stand still: take a program with their words
    #[arg(long, help_heading = "Reading")]
    pub(crate) axes_stand_still: bool,
    /// X, Y and Z are places of the tool's tip in the part all along, however rotary axes stand (G43.4 says so
    /// in the program)
    #[arg(long, help_heading = "Reading")]
    pub(crate) tool_centre_point: bool,
    /// Where the tool stands before the first block, mm
    #[arg(long, num_args = 3, value_names = ["X", "Y", "Z"], allow_negative_numbers = true, help_heading = "Reading", value_parser = number)]
    pub(crate) start_position_mm: Option<Vec<f64>>,
    /// Where the tool's point is in the part when the machine stands at its zero and no tool length is in force, mm:
    /// where G53, G28 and G30 count from
    #[arg(long, num_args = 3, value_names = ["X", "Y", "Z"], allow_negative_numbers = true, help_heading = "Reading", value_parser = number)]
    pub(crate) machine_zero_mm: Option<Vec<f64>>,
    /// Reference point of G28 in machine coordinates, mm (with --machine-zero-mm)
    #[arg(long, num_args = 3, value_names = ["X", "Y", "Z"], allow_negative_numbers = true, help_heading = "Reading", value_parser = number)]
    pub(crate) g28_mm: Option<Vec<f64>>,
    /// Reference point of G30 in machine coordinates, mm (with --machine-zero-mm)
    #[arg(long, num_args = 3, value_names = ["X", "Y", "Z"], allow_negative_numbers = true, help_heading = "Reading", value_parser = number)]
    pub(crate) g30_mm: Option<Vec<f64>>,
}

/// Options that only the writing needs.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct WritingFlags<'a> {
    pub(crate) tolerance_um: Option<f64>,
    /// True if the tolerance is the total: straight pieces, chords of arcs and rounding.
    pub(crate) of_all: bool,
    pub(crate) arcs: Option<ArcsWord>,
    pub(crate) min_block_mm: Option<f64>,
    pub(crate) decimals: Option<u8>,
    pub(crate) max_blocks_per_second: Option<f64>,
    pub(crate) max_feed_factor: Option<f64>,
    pub(crate) backward_step_um: Option<f64>,
    pub(crate) no_header: bool,
    pub(crate) again: bool,
    pub(crate) out: Option<&'a Path>,
    pub(crate) json: Option<&'a Path>,
}
