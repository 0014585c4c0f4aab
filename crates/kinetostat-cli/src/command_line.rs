//! The command line.

use std::ffi::OsString;
use std::path::PathBuf;

use clap::{ArgAction, Args, Parser, Subcommand};

use crate::assemble::arguments::AssembleArgs;
use crate::curve::arguments::{CurveArgs, EquilibriaArgs};
use crate::import::link_arguments::{DisplacementsArgs, MatrixArgs};
use crate::job::format::{Axes, BlockDeleteWord, CornerWord, UnitsWord};
use crate::map::arguments::MapArgs;
use crate::model::draw::DrawArgs;

pub(crate) const EXIT_CODES: &str = "\
Exit codes:
  0    answered
  1    wrong input: a file, a number or an option; the message says which
  2    no answer: not converged, or a point that cannot be reached
  3    compensated and written, but the tolerance is missed; the line is said
  130  stopped with Ctrl-C; nothing was written";

/// Elastostatics of robots that machine: how far a machine bends along a program, and a program
/// that cuts where it should.
#[derive(Debug, Parser)]
#[command(
    name = "kinetostat",
    version,
    max_term_width = 80,
    arg_required_else_help = true,
    subcommand_required = true,
    after_help = EXIT_CODES,
    after_long_help = concat!(
        "Examples:\n",
        "  kinetostat demo\n",
        "      a first look: mills a circle on a bending machine and opens no network\n",
        "  kinetostat deflect job.toml\n",
        "      how far is the tool off along the program?\n",
        "  kinetostat compensate job.toml\n",
        "      write the program that cuts where it should\n",
        "  kinetostat curve three_link_z --direction -1 0 0 --displacement-mm 0 400\n",
        "      push a chain together: which force, and where does it buckle?\n",
        "  kinetostat check my_robot.toml\n",
        "      what does the model file say, in words?\n\n",
        "Exit codes:\n",
        "  0    answered\n",
        "  1    wrong input: a file, a number or an option; the message says which\n",
        "  2    no answer: not converged, or a point that cannot be reached\n",
        "  3    compensated and written, but the tolerance is missed; the line is said\n",
        "  130  stopped with Ctrl-C; nothing was written",
    )
)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    Demo(DemoArgs),
    Compensate(Box<CompensateArgs>),
    Deflect(Box<DeflectArgs>),
    Stiffness(StiffnessArgs),
    Map(Box<MapArgs>),
    Assemble(Box<AssembleArgs>),
    Curve(Box<CurveArgs>),
    Equilibria(Box<EquilibriaArgs>),
    Check(CheckArgs),
    Import(Box<ImportArgs>),
    Reproduce(ReproduceArgs),
    Model(ModelArgs),
    Completions(CompletionsArgs),
    Man(ManArgs),
}

/// Mill a circular groove on a bending machine: the first look
///
/// Writes the program, the compensated program, the report, the result and the points, and the
/// model and job files that repeat the run.
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub(crate) struct DemoArgs {
    /// Directory for the files; it is made if it does not exist
    #[arg(long, value_name = "DIR", default_value = "kinetostat-demo")]
    pub(crate) out: PathBuf,
    /// Overwrite files of the same names in it
    #[arg(long)]
    pub(crate) force_overwrite: bool,
    /// Print the result as JSON; the text goes to the standard error
    #[arg(long)]
    pub(crate) json: bool,
    /// Number of threads; all cores without it
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole)]
    pub(crate) threads: Option<usize>,
}

/// Write a program that cuts where it should
///
/// Reads model, program, placement and load from a job file, from options, or from both (options go
/// over the job file), solves the machine along the program, writes the compensated program, reads
/// it again from its bytes and solves it once more: the error after compensation is measured, not
/// promised. Nothing is overwritten without --force-overwrite, an input never.
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES, after_long_help = COMPENSATE_HELP)]
pub(crate) struct CompensateArgs {
    #[command(flatten)]
    pub(crate) run: RunArgs,
    /// The compensated program; without it, PROGRAM-compensated beside the job or the program
    #[arg(long, short, value_name = "FILE", help_heading = "Outputs")]
    pub(crate) out: Option<PathBuf>,
    /// Corrections from a table instead of a model: CSV with the columns
    /// x_mm,y_mm,z_mm,dx_mm,dy_mm,dz_mm on a full grid
    #[arg(long, value_name = "FILE", conflicts_with_all = ["model", "force", "moment", "load_axes", "milling", "load_at_corners", "below_z_mm", "tool_length_mm", "part_origin_mm", "part_orientation", "tool_orientation", "scale", "report", "points"])]
    pub(crate) map: Option<PathBuf>,
    /// Write the program as it was read, byte for byte
    #[arg(long, conflicts_with_all = ["map", "json", "report", "points", "again"])]
    pub(crate) no_compensation: bool,
    /// Compensate a program that is marked as compensated once more
    #[arg(long)]
    pub(crate) again: bool,
    /// Leave out the header that marks the program as compensated
    #[arg(long, help_heading = "Outputs")]
    pub(crate) no_header: bool,
    /// How far the straight pieces may leave the corrected path, micrometres [default: a third of the
    /// repeatability that the model states, 20 for an arm that states none, else 0.5]
    #[arg(long, value_name = "UM", help_heading = "Tolerances", allow_negative_numbers = true, value_parser = number)]
    pub(crate) tolerance_um: Option<f64>,
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
    /// Warn if the written program asks for more blocks per second than this
    #[arg(long, value_name = "N", help_heading = "Tolerances", allow_negative_numbers = true, value_parser = number)]
    pub(crate) max_blocks_per_second: Option<f64>,
}

/// How far is the tool off: at one place, or along a program
///
/// With --at: displacement and rotation under a load at one place, actuator forces and stability.
/// With a job file, or with --program: the same along a whole program, with report and tables;
/// nothing is compensated. The outputs that a job file names are those of `compensate`: name what
/// you want here with --report, --points and --json.
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES, after_long_help = DEFLECT_HELP)]
pub(crate) struct DeflectArgs {
    /// Preset, model file, or job file
    #[arg(value_name = "MODEL|JOB")]
    pub(crate) subject: String,
    #[command(flatten)]
    pub(crate) place: PlaceArgs,
    #[command(flatten)]
    pub(crate) program: ProgramArgs,
    /// Print the result as JSON (the text goes to the standard error), or write it to FILE
    #[arg(long, value_name = "FILE", num_args = 0..=1, default_missing_value = "-", help_heading = "Outputs")]
    pub(crate) json: Option<PathBuf>,
}

/// How stiff is the machine at one place
///
/// The 6 x 6 stiffness matrix of the tool with units, axes and reference point, its principal
/// directions, and the share of each limb; under a load if a force is given.
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES, after_long_help = STIFFNESS_HELP)]
pub(crate) struct StiffnessArgs {
    /// Preset or model file
    #[arg(value_name = "MODEL")]
    pub(crate) model: String,
    #[command(flatten)]
    pub(crate) place: PlaceArgs,
    /// Force on the tool's tip, N
    #[arg(long, num_args = 3, value_names = ["FX", "FY", "FZ"], allow_negative_numbers = true, value_parser = number)]
    pub(crate) force: Option<Vec<f64>>,
    /// Moment on the tool about its tip, N m
    #[arg(long, num_args = 3, value_names = ["MX", "MY", "MZ"], allow_negative_numbers = true, value_parser = number)]
    pub(crate) moment: Option<Vec<f64>>,
    /// Distance of the tool's tip along z of the flange, mm
    #[arg(long, value_name = "L", allow_negative_numbers = true, value_parser = number)]
    pub(crate) tool_length_mm: Option<f64>,
    /// Print the result as JSON; the text goes to the standard error
    #[arg(long)]
    pub(crate) json: bool,
}

/// What a model file or a job file says, in words
///
/// Of a model: platforms, limbs, actuators with units and limits, passive joints, springs, masses;
/// mobility, stiffness at home, effect of deviations, stability under gravity; and everything that
/// looks wrong. Of a job: its model, program, placement, load and outputs, and whether the ends of
/// the program can be reached; the program is read, not run.
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES, after_long_help = CHECK_HELP)]
pub(crate) struct CheckArgs {
    /// Preset, model file or job file
    #[arg(value_name = "MODEL|JOB")]
    pub(crate) model: String,
    /// Load on the tool by which deflections are judged, N, base axes; 1 kN along each axis without it
    #[arg(long, num_args = 3, value_names = ["FX", "FY", "FZ"], allow_negative_numbers = true, value_parser = number)]
    pub(crate) force: Option<Vec<f64>>,
    /// Compare with poses jogged on the machine instead: a table (CSV) or TOML with joint values and
    /// the measured pose of the tool
    #[arg(long, value_name = "FILE")]
    pub(crate) pose: Option<PathBuf>,
    /// How far apart such poses may be, mm; 0.1 degrees for each millimetre
    #[arg(long, value_name = "MM", default_value = "1", requires = "pose", allow_negative_numbers = true, value_parser = number)]
    pub(crate) pose_tolerance_mm: f64,
    /// Print the findings as JSON; the text goes to the standard error
    #[arg(long)]
    pub(crate) json: bool,
}

/// A model file from another program's description of a robot, or a link's stiffness for one
#[derive(Debug, Args)]
pub(crate) struct ImportArgs {
    #[command(subcommand)]
    pub(crate) action: ImportAction,
}

#[derive(Debug, Subcommand)]
pub(crate) enum ImportAction {
    Urdf(UrdfArgs),
    Matrix(MatrixArgs),
    LinkDisplacements(DisplacementsArgs),
}

/// A model file from a URDF
///
/// Geometry, masses and limits come from the URDF; it says nothing of what bends. Joint stiffnesses
/// and the section of links are given here, or filled in where the written file says FILL IN.
/// Everything that is skipped, replaced or looks wrong is told.
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub(crate) struct UrdfArgs {
    /// URDF file (a xacro file must be expanded first)
    #[arg(value_name = "FILE")]
    pub(crate) file: PathBuf,
    /// Link that stands; the root without it
    #[arg(long, value_name = "LINK")]
    pub(crate) base: Option<String>,
    /// Link that carries the tool; needed where the tree has several ends
    #[arg(long, value_name = "LINK")]
    pub(crate) tip: Option<String>,
    /// Closed loops (TOML): what the proposed `constraint` element of a URDF says
    #[arg(long, value_name = "FILE")]
    pub(crate) loops: Option<PathBuf>,
    /// Joints that nothing drives
    #[arg(long, value_name = "JOINT", value_delimiter = ',')]
    pub(crate) passive: Vec<String>,
    /// Where a joint stands at home, as in joint_5=30deg or rail=1200mm; zero without it
    #[arg(long, value_name = "JOINT=VALUE", value_delimiter = ',')]
    pub(crate) home: Vec<String>,
    /// Stiffness of the drives: one number for all that turn, N m/rad, or a table (CSV) with the
    /// columns name,value,unit
    #[arg(long, value_name = "VALUE|FILE", allow_negative_numbers = true)]
    pub(crate) joint_stiffness: Option<String>,
    /// Links are straight beams of this section (TOML: the keys of a section of a model file);
    /// rigid without it
    #[arg(long, value_name = "FILE")]
    pub(crate) link_section: Option<PathBuf>,
    /// The model file; without it, the model goes to the standard output
    #[arg(long, short, value_name = "FILE", help_heading = "Outputs")]
    pub(crate) out: Option<PathBuf>,
    /// Overwrite an existing file
    #[arg(long, help_heading = "Outputs")]
    pub(crate) force_overwrite: bool,
    /// Print what was imported as JSON instead of the model; the text goes to the standard error
    #[arg(long, help_heading = "Outputs")]
    pub(crate) json: bool,
}

/// Models that come with the program, and the format of model files
#[derive(Debug, Args)]
pub(crate) struct ModelArgs {
    #[command(subcommand)]
    pub(crate) action: ModelAction,
}

/// The numbers of the COROUSSO report L1.1, computed again and set beside their print
///
/// Each table, each equation with a number in it and each figure of chapters 2 to 7: what is printed,
/// what comes out, and whether they agree; where they do not, why.
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub(crate) struct ReproduceArgs {
    /// Which one, as in table-5.2, eq-3.34 or fig-5.7; all without it
    #[arg(value_name = "ID")]
    pub(crate) id: Option<String>,
    /// Print the numbers as JSON; the text goes to the standard error
    #[arg(long)]
    pub(crate) json: bool,
    /// Write a page with all numbers and the figures drawn
    #[arg(long, value_name = "FILE", help_heading = "Outputs")]
    pub(crate) html: Option<PathBuf>,
    /// Overwrite an existing file
    #[arg(long, help_heading = "Outputs")]
    pub(crate) force_overwrite: bool,
}

#[derive(Debug, Subcommand)]
pub(crate) enum ModelAction {
    /// The presets, one line each
    List,
    /// The model file of a preset: a start for your own
    Show {
        /// Name of the preset
        name: String,
    },
    /// The JSON Schema of model files, for editors
    Schema,
    /// Are two models one machine but for constant offsets of base, tool and joints?
    Compare {
        /// Preset or model file
        a: String,
        /// Preset or model file with as many actuators
        b: String,
        /// Print the answer as JSON; the text goes to the standard error
        #[arg(long)]
        json: bool,
    },
    Draw(DrawArgs),
}

/// Completions for a shell, to be saved where the shell looks for them
#[derive(Debug, Args)]
pub(crate) struct CompletionsArgs {
    /// The shell
    pub(crate) shell: clap_complete::Shell,
}

/// Manual pages
#[derive(Debug, Args)]
pub(crate) struct ManArgs {
    /// Write one page per command into this directory instead of printing the first
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Overwrite pages that exist
    #[arg(long, requires = "out")]
    pub(crate) force_overwrite: bool,
}

/// A place in the workspace.
#[derive(Debug, Default, Args)]
pub(crate) struct PlaceArgs {
    /// Place of the tool's tip in base axes, mm; home without it
    #[arg(long, num_args = 3, value_names = ["X", "Y", "Z"], allow_negative_numbers = true, value_parser = number)]
    pub(crate) at: Option<Vec<f64>>,
    /// Orientation of the tool there by a named convention, as in a_b_c_kuka_deg=0,0,90, or the word
    /// follows: the one nearest to that at home which the machine can have there. Without it, the
    /// orientation at home; it follows where the machine cannot hold one
    #[arg(long, value_name = "CONVENTION=A,B,C", conflicts_with_all = ["joints", "pendant"])]
    pub(crate) rotation: Option<String>,
    /// The place by the model's joint values instead, deg and mm, as in shoulder=30 rail=250; joints
    /// that are not named stay at home
    #[arg(long, num_args = 1.., value_name = "JOINT=VALUE", value_delimiter = ',', conflicts_with = "at")]
    pub(crate) joints: Vec<String>,
    /// The same by what the controller's pendant shows, as in J1=10 J2=31.324; the model declares it
    /// in its section controller
    #[arg(long, num_args = 1.., value_name = "AXIS=VALUE", value_delimiter = ',', conflicts_with_all = ["at", "joints"])]
    pub(crate) pendant: Vec<String>,
}

impl PlaceArgs {
    /// One place is asked for.
    pub(crate) fn given(&self) -> bool {
        self.at.is_some()
            || self.rotation.is_some()
            || !self.joints.is_empty()
            || !self.pendant.is_empty()
    }
}

/// Job file, model and everything about the program.
#[derive(Debug, Args)]
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
#[derive(Debug, Default, Args)]
pub(crate) struct ProgramArgs {
    /// G-code program
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
    /// follows the feed; the program is the same, the claim about it is not [default: turns]
    #[arg(long, value_enum, value_name = "READING", help_heading = "Load")]
    pub(crate) load_at_corners: Option<CornerWord>,
    /// The load acts only below this height of the program, mm
    #[arg(long, value_name = "Z", allow_negative_numbers = true, help_heading = "Load", value_parser = number)]
    pub(crate) below_z_mm: Option<f64>,
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
    /// Where the tool stands before the first block, mm
    #[arg(long, num_args = 3, value_names = ["X", "Y", "Z"], allow_negative_numbers = true, help_heading = "Reading", value_parser = number)]
    pub(crate) start_position_mm: Option<Vec<f64>>,
    /// How far the chords of arcs may leave them, micrometres [default: 0.4, in a
    /// compensated program at most 0.8 of the path's default tolerance]
    #[arg(long, value_name = "UM", allow_negative_numbers = true, help_heading = "Tolerances", value_parser = number)]
    pub(crate) chord_tolerance_um: Option<f64>,
    /// Move a limit, as in correction_mm=5 (repeat for more): correction_mm, own_weight_mm,
    /// tilt_deg, force_n, moment_n_m, share_of_rating, share_of_buckling, blocks_per_second, shortest_tool_mm,
    /// longest_tool_mm. A program that leaves a limit is refused
    #[arg(long = "limit", value_name = "NAME=VALUE", action = ArgAction::Append, allow_hyphen_values = true, help_heading = "Limits")]
    pub(crate) limits: Vec<String>,
    /// The report, one HTML file
    #[arg(long, value_name = "FILE", help_heading = "Outputs")]
    pub(crate) report: Option<PathBuf>,
    /// Points of the path as a table (CSV); of long programs the worst of every stretch
    #[arg(long, value_name = "FILE", help_heading = "Outputs")]
    pub(crate) points: Option<PathBuf>,
    /// Every point in the table, however large it becomes
    #[arg(long, help_heading = "Outputs")]
    pub(crate) all_points: bool,
    /// Overwrite outputs that exist (never an input)
    #[arg(long, help_heading = "Outputs")]
    pub(crate) force_overwrite: bool,
    /// Number of threads; all cores without it. The result is the same
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole)]
    pub(crate) threads: Option<usize>,
}

/// Negative numbers as in `-5e-12` and `-.5` in plain digits: the reader of the command line takes them
/// for options. The value stays the same to the last bit.
pub(crate) fn plain_numbers(words: impl Iterator<Item = OsString>) -> Vec<OsString> {
    let mut options_ended = false;
    words
        .map(|word| {
            options_ended |= word == "--";
            let plain = word
                .to_str()
                .filter(|w| !options_ended && looks_negative(w))
                .and_then(|w| w.parse::<f64>().ok())
                .filter(|value| value.is_finite());
            // Written in full by Rust: the shortest digits that give the same number again.
            plain.map_or(word, |value| format!("{value}").into())
        })
        .collect()
}

/// `-inf` or `-nan` where a number belongs, and the option before it: the reader of the command line would take it
/// for an option `-i` or `-n`.
pub(crate) fn no_number(words: &[OsString]) -> Option<String> {
    let words = words.iter().map(|w| w.to_str().unwrap_or_default());
    let mut option = "";
    for word in words.take_while(|w| *w != "--") {
        if word.starts_with("--") {
            option = word;
        }
        let lower = word.to_lowercase();
        if matches!(lower.as_str(), "-inf" | "-infinity" | "-nan") {
            let place = match option {
                "" => String::new(),
                option => format!("{option}: "),
            };
            return Some(format!(
                "{place}'{word}' is no finite number; write one as in -12.5"
            ));
        }
    }
    None
}

/// A minus and a digit, or a point.
fn looks_negative(word: &str) -> bool {
    let after = word.strip_prefix('-').and_then(|w| w.chars().next());
    after.is_some_and(|c| c.is_ascii_digit() || c == '.')
}

/// A finite number with a decimal point.
pub(crate) fn number(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err("a finite number is needed".to_owned()),
        Err(_) if text.contains(',') => Err(
            "a number is needed, with a decimal point and not a comma, and a space before the next"
                .to_owned(),
        ),
        Err(_) => {
            Err("a number is needed, as in 12.5; the unit is in the option's name".to_owned())
        }
    }
}

/// A whole number.
pub(crate) fn whole(text: &str) -> Result<usize, String> {
    text.trim()
        .parse()
        .map_err(|_| "a whole number is needed, as in 2".to_owned())
}

fn small(text: &str) -> Result<u8, String> {
    text.trim()
        .parse()
        .map_err(|_| "a whole number from 3 to 8 is needed".to_owned())
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

  # [[tools]]                      # several tools: T1 M6, T2 M6
  # number = 1
  # length_mm = 100                # and load = { ... }, at_corners too

  [load]                           # on feed moves; none in rapids
  milling = { radial_n = 215, tangential_n = -10, axial_n = -25 }
  # or force_n = [0, 0, -200], moment_n_m = [0, 0, 1], axes = "base"
  # below_z_mm = 0, gentle_corner_deg = 30, turning_length_mm = 2
  # at_corners = "turns"           # or "follows_feed"

  [reading]
  # units = "mm", arc_tolerance_mm = 0.005, block_delete = "run"
  # axes_stand_still = true   (a program with words of A B C U V W)
  # start_position_mm = [0, 0, 50]
  # work_offset_mm = { G54 = [0, 0, 0] }

  [tolerances]
  path_um = 0.5
  chord_um = 0.4
  # decimals = 4, max_blocks_per_second = 500
  # max_feed_factor = 1.2, backward_step_um = 50

  [output]                         # below the job's own directory
  program = "compensated.ngc"
  report = "report.html"
  json = "result.json"
  points = "points.csv"
  # header = true

  [limits]                         # a program that leaves them is refused
  # correction_mm = 2, own_weight_mm = 5, tilt_deg = 1
  # force_n = 5000, moment_n_m = 200
  # share_of_rating = 1, share_of_buckling = 0.5, blocks_per_second = 2000
  # shortest_tool_mm = 1, longest_tool_mm = 1000

Exit codes:
  0    answered
  1    wrong input: a file, a number or an option; the message says which
  2    no answer: not converged, or a point that cannot be reached
  3    compensated and written, but the tolerance is missed; the line is said
  130  stopped with Ctrl-C; nothing was written"#;

const DEFLECT_HELP: &str = "\
Examples:
  kinetostat deflect orthoglide --at 0 0 0 --force 215 -10 -25
  kinetostat deflect my_robot.toml --at 1200 0 800 --tool-length-mm 150 \\
      --rotation a_b_c_kuka_deg=0,90,0 --force 0 0 -500 --moment 0 0 20
  kinetostat deflect job.toml --report report.html
  kinetostat deflect orthoglide --program part.ngc --part-origin-mm 0 0 100 \\
      --tool-length-mm 100 --force 0 0 200

Force and moment act on the tool at its tip; axes are those of the base.

Exit codes:
  0    answered
  1    wrong input: a file, a number or an option; the message says which
  2    no answer: not converged, or a point that cannot be reached
  130  stopped with Ctrl-C; nothing was written";

const CHECK_HELP: &str = "\
Examples:
  kinetostat check orthoglide
  kinetostat check my_robot.toml --force 0 0 -500
  kinetostat check job.toml

Exit codes:
  0    answered
  1    wrong input: a file, a number or an option; the message says which
  2    no answer: not converged, or a point that cannot be reached
  130  stopped with Ctrl-C; nothing was written";

const STIFFNESS_HELP: &str = "\
Examples:
  kinetostat stiffness orthoglide --at 0 0 0
  kinetostat stiffness heavy_6r --tool-length-mm 200
  kinetostat stiffness orthoglide --at 50 50 150 --tool-length-mm 100 \\
      --force 215 -10 -25

Exit codes:
  0    answered
  1    wrong input: a file, a number or an option; the message says which
  2    no answer: not converged, or a point that cannot be reached";

#[cfg(test)]
mod tests {
    use clap::CommandFactory;
    use clap::builder::ValueParser;

    use super::*;

    /// Every option of every command that takes numbers, with the words that lead to it.
    fn options_of_numbers(
        command: &clap::Command,
        way: &[String],
        found: &mut Vec<(Vec<String>, String, usize)>,
    ) {
        let numbers = [
            ValueParser::from(number).type_id(),
            ValueParser::from(whole).type_id(),
            ValueParser::from(small).type_id(),
        ];
        for argument in command.get_arguments() {
            if numbers.contains(&argument.get_value_parser().type_id()) {
                let name = argument.get_long().expect("numbers are options");
                let count = argument.get_num_args().expect("built").min_values();
                found.push((way.to_vec(), format!("--{name}"), count));
            }
        }
        for inner in command.get_subcommands() {
            let mut way = way.to_vec();
            way.push(inner.get_name().to_owned());
            options_of_numbers(inner, &way, found);
        }
    }

    #[test]
    fn negative_numbers_of_all_kinds_are_numbers_for_every_option() {
        let mut command = Cli::command();
        command.build();
        let mut options = Vec::new();
        options_of_numbers(&command, &["kinetostat".to_owned()], &mut options);
        assert!(options.len() >= 50, "{}", options.len());
        let number = ValueParser::from(number).type_id();
        let real = |(way, name, _): &&(Vec<String>, String, usize)| {
            let mut of = &command;
            for word in &way[1..] {
                of = of.find_subcommand(word).expect("a command");
            }
            let mut all = of.get_arguments();
            let own = all.find(|a| a.get_long().is_some_and(|long| name[2..] == *long));
            own.is_some_and(|a| a.get_value_parser().type_id() == number)
        };
        for (way, name, count) in options.iter().filter(real) {
            for written in ["-5e-12", "-1.5E+3", "-2e3", "-.5", "-0", "-1e-320", "-7.25"] {
                let mut words = way.clone();
                words.push(name.clone());
                words.extend(std::iter::repeat_n(written.to_owned(), *count));
                let words = plain_numbers(words.into_iter().map(OsString::from));
                // What else the command needs is missing here; no number may be the reason.
                if let Err(error) = Cli::try_parse_from(words) {
                    use clap::error::ErrorKind as Kind;
                    assert!(
                        matches!(
                            error.kind(),
                            Kind::MissingRequiredArgument | Kind::ArgumentConflict
                        ),
                        "{name} {written} of {way:?}: {error}"
                    );
                }
            }
        }
    }

    #[test]
    fn what_is_no_number_is_no_option() {
        let said = |line: &str| no_number(&line.split(' ').map(OsString::from).collect::<Vec<_>>());
        for word in ["-inf", "-Infinity", "-nan", "-NaN"] {
            let found = said(&format!("kinetostat deflect m --at 1 {word} 0 --json")).unwrap();
            assert!(
                found.starts_with(&format!("--at: '{word}' is no finite number")),
                "{found}"
            );
            assert!(said(&format!("kinetostat check -- {word}")).is_none());
        }
        assert!(said("kinetostat deflect m --at 1 -5e-12 0 -h").is_none());
    }

    #[test]
    fn a_wrong_number_is_said_with_its_option() {
        let mut command = Cli::command();
        command.build();
        let mut options = Vec::new();
        options_of_numbers(&command, &["kinetostat".to_owned()], &mut options);
        assert!(options.len() >= 60, "{}", options.len());
        for (way, name, count) in &options {
            let refused = |values: &[&str]| {
                let mut words = way.clone();
                words.push(name.clone());
                words.extend(values.iter().map(|&value| value.to_owned()));
                let words = plain_numbers(words.into_iter().map(OsString::from));
                let error = Cli::try_parse_from(words).expect_err("a wrong value");
                let said = error.to_string();
                let first = said.lines().next().unwrap_or_default();
                assert!(first.contains(name), "{way:?} {name} {values:?}: {said}");
            };
            for wrong in [
                "text", "nan", "inf", "1e400", "-1e400", "1,5", "0x10", "5mm", "",
            ] {
                for at in 0..(*count).max(1) {
                    let mut values = vec!["1"; (*count).max(1)];
                    values[at] = wrong;
                    refused(&values);
                }
            }
            // Too few; a value that may be left out is none too few.
            if *count > 0 {
                refused(&vec!["1"; count - 1]);
            }
        }
    }

    /// Options whose text holds numbers: the test `numbers_inside_texts_are_refused_with_their_option` has
    /// them all.
    #[test]
    fn the_options_with_numbers_inside_their_text_are_known() {
        fn texts(command: &clap::Command, found: &mut std::collections::BTreeSet<String>) {
            for argument in command.get_arguments() {
                let names = argument.get_value_names().unwrap_or_default();
                if names.iter().any(|name| name.contains('=')) {
                    found.insert(argument.get_long().expect("an option").to_owned());
                }
            }
            for inner in command.get_subcommands() {
                texts(inner, found);
            }
        }
        let mut found = std::collections::BTreeSet::new();
        texts(&Cli::command(), &mut found);
        let known = [
            "axes",
            "grow",
            "home",
            "joints",
            "limit",
            "load",
            "part-orientation",
            "pendant",
            "rotation",
            "section",
            "tool-orientation",
            "work-offset",
        ];
        assert_eq!(found, known.map(String::from).into());
    }

    #[test]
    fn plain_numbers_keep_their_value_and_words_stay() {
        let told = |word: &str| {
            let words = plain_numbers(["k".into(), word.into()].into_iter());
            words[1].to_str().expect("text").to_owned()
        };
        for written in [
            "-5e-12",
            "-1.7976931348623157e308",
            "-5e-324",
            "-0.1e1",
            "-123.456e-7",
        ] {
            let plain = told(written);
            let [a, b]: [f64; 2] = [written, &plain].map(|t| t.parse().expect("a number"));
            assert_eq!(a.to_bits(), b.to_bits(), "{written}");
            assert!(!plain.contains(['e', 'E']), "{plain}");
        }
        for word in [
            "-e", "--at", "-1e999", "-inf", "5e3", "--e5", "-5", "file-1e5",
        ] {
            assert_eq!(told(word), word);
        }
        let after = plain_numbers(["--".into(), "-1e3".into()].into_iter());
        assert_eq!(after[1], "-1e3");
    }
}
