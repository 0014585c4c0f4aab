//! Options of `force`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use crate::files::answer_files::AnswerFiles;
use crate::force::fit_arguments::FitArgs;
use crate::options::{number, whole};

/// Force of one cut: from material, tool, width, depth and feed
///
/// The force on a milling tool over the revolution: its mean, which bends the machine; its peak; and
/// the force at the moment at which the wall is made, which prints into it. With torque, power,
/// harmonics and how far to trust all of it. It needs no machine and no program. With --fit it goes
/// the other way: from mean forces of a dynamometer to the coefficients of a material.
#[derive(Debug, Args)]
#[command(after_help = CODES, after_long_help = FORCE_HELP)]
pub(crate) struct ForceArgs {
    /// Table of the known materials: law, spread and source; with --json all that is known of them
    #[arg(long, conflicts_with_all = ["csv", "plot"])]
    pub(crate) list_materials: bool,
    #[command(flatten)]
    pub(crate) material: MaterialArgs,
    #[command(flatten)]
    pub(crate) tool: ToolArgs,
    #[command(flatten)]
    pub(crate) cut: CutArgs,
    #[command(flatten)]
    pub(crate) spindle: SpindleArgs,
    #[command(flatten)]
    pub(crate) steady: SteadyArgs,
    #[command(flatten)]
    pub(crate) fit: FitArgs,
    #[command(flatten)]
    pub(crate) outputs: AnswerFiles,
}

/// What is cut, and how the cut differs from the test in which it was measured.
#[derive(Debug, Default, Args)]
pub(crate) struct MaterialArgs {
    /// What is cut, by any of its names; case, spaces and hyphens do not matter
    #[arg(
        long,
        value_name = "NAME",
        help_heading = "Material",
        allow_hyphen_values = true
    )]
    pub(crate) material: Option<String>,
    /// Materials of your own (TOML), found before those of the library
    #[arg(long, value_name = "FILE", help_heading = "Material")]
    pub(crate) materials: Option<PathBuf>,
    /// Rake angle of the tool, degrees (factor K_gamma); without it that of the table of tools
    #[arg(
        long,
        value_name = "ANGLE",
        help_heading = "Material",
        allow_negative_numbers = true,
        value_parser = number
    )]
    pub(crate) rake_deg: Option<f64>,
    /// Wear of the edge (factor K_TW): 1 sharp, 1.3 to 1.5 worn
    #[arg(
        long,
        value_name = "FACTOR",
        help_heading = "Material",
        allow_negative_numbers = true,
        value_parser = number
    )]
    pub(crate) wear: Option<f64>,
    /// How the cut is cooled (factor K_CL)
    #[arg(long, value_enum, value_name = "WORD", help_heading = "Material")]
    pub(crate) coolant: Option<CoolantWord>,
    /// What the edge is made of (factor K_CM)
    #[arg(long, value_enum, value_name = "WORD", help_heading = "Material")]
    pub(crate) edge: Option<EdgeWord>,
    /// Correct for the cutting speed (factor K_V); it needs --rpm
    #[arg(long, help_heading = "Material")]
    pub(crate) correct_speed: bool,
    /// Milling with coefficients of turning tests (factor K_PRO): 1.2 to 1.4 [default: 1.3 for such
    /// coefficients]
    #[arg(
        long,
        value_name = "FACTOR",
        help_heading = "Material",
        allow_negative_numbers = true,
        value_parser = number
    )]
    pub(crate) process_factor: Option<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum CoolantWord {
    /// Dry: 1
    Dry,
    /// Emulsion: 0.9
    Emulsion,
    /// Oil that does not mix with water: 0.85
    Oil,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum EdgeWord {
    /// Cemented carbide: 1
    Carbide,
    /// High-speed steel: 1.05
    HighSpeedSteel,
    /// Ceramic: 0.925
    Ceramic,
}

/// The tool, by its sizes or from a table of tools.
#[derive(Debug, Args)]
pub(crate) struct ToolArgs {
    /// Shape of the tool
    #[arg(long, value_enum, value_name = "SHAPE", help_heading = "Tool", conflicts_with_all = ["tool_table", "tool_number"])]
    pub(crate) tool: Option<ShapeWord>,
    /// Its diameter, mm; of a face mill that at the tip
    #[arg(long, value_name = "D", help_heading = "Tool", allow_negative_numbers = true, value_parser = number, conflicts_with = "tool_table")]
    pub(crate) diameter_mm: Option<f64>,
    /// Number of teeth
    #[arg(long, value_name = "N", help_heading = "Tool", allow_negative_numbers = true, value_parser = whole, conflicts_with = "tool_table")]
    pub(crate) teeth: Option<usize>,
    /// Helix angle, degrees [default: 0]; positive lifts the chip
    #[arg(long, value_name = "ANGLE", help_heading = "Tool", allow_negative_numbers = true, value_parser = number, conflicts_with = "tool_table")]
    pub(crate) helix_deg: Option<f64>,
    /// Radius of the corner of a bull-nosed tool, mm
    #[arg(long, value_name = "R", help_heading = "Tool", allow_negative_numbers = true, value_parser = number, conflicts_with = "tool_table")]
    pub(crate) corner_radius_mm: Option<f64>,
    /// Angle between the edge of a face mill and the plane of the feed, degrees: 90 is a cylinder
    #[arg(long, value_name = "ANGLE", help_heading = "Tool", allow_negative_numbers = true, value_parser = number, conflicts_with = "tool_table")]
    pub(crate) lead_angle_deg: Option<f64>,
    /// Run-out: how far the axis of the teeth lies beside that of the rotation, um
    #[arg(long, value_name = "E", help_heading = "Tool", allow_negative_numbers = true, value_parser = number, conflicts_with = "tool_table")]
    pub(crate) run_out_um: Option<f64>,
    /// Where the run-out points, seen from tooth 0, degrees [default: 0]
    #[arg(long, value_name = "ANGLE", help_heading = "Tool", allow_negative_numbers = true, value_parser = number, requires = "run_out_um")]
    pub(crate) run_out_angle_deg: Option<f64>,
    /// Feed per tooth that the maker of the tool allows, mm
    #[arg(long, value_name = "H", help_heading = "Tool", allow_negative_numbers = true, value_parser = number, conflicts_with = "tool_table")]
    pub(crate) max_chip_mm: Option<f64>,
    /// Length of its edges, mm
    #[arg(long, value_name = "L", help_heading = "Tool", allow_negative_numbers = true, value_parser = number, conflicts_with = "tool_table")]
    pub(crate) flute_length_mm: Option<f64>,
    /// Length outside the holder, mm
    #[arg(long, value_name = "L", help_heading = "Tool", allow_negative_numbers = true, value_parser = number, conflicts_with = "tool_table")]
    pub(crate) stick_out_mm: Option<f64>,
    /// Table of tools (TOML)
    #[arg(long, value_name = "FILE", help_heading = "Tool")]
    pub(crate) tool_table: Option<PathBuf>,
    /// Number of the tool in the table; without it, a program calls its tools (T)
    #[arg(long, value_name = "T", help_heading = "Tool", allow_negative_numbers = true, value_parser = whole, requires = "tool_table")]
    pub(crate) tool_number: Option<usize>,
}

impl ToolArgs {
    /// True if any of them is given.
    pub(crate) fn given(&self) -> bool {
        let numbers = [
            self.diameter_mm,
            self.helix_deg,
            self.corner_radius_mm,
            self.lead_angle_deg,
            self.run_out_um,
            self.run_out_angle_deg,
            self.max_chip_mm,
            self.flute_length_mm,
            self.stick_out_mm,
        ];
        let counts = [self.teeth, self.tool_number];
        self.tool.is_some()
            || self.tool_table.is_some()
            || numbers.iter().any(Option::is_some)
            || counts.iter().any(Option::is_some)
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ShapeWord {
    /// Cylinder with a flat end
    Flat,
    /// Cylinder that ends in a half sphere
    Ball,
    /// Cylinder with a corner radius (bull nose)
    Bull,
    /// Face mill with straight inserts
    Face,
}

/// A straight cut.
#[derive(Debug, Args)]
pub(crate) struct CutArgs {
    /// Width of the cut (ae), across the feed, mm; the diameter is a slot
    #[arg(long, value_name = "AE", help_heading = "Cut", allow_negative_numbers = true, value_parser = number)]
    pub(crate) width_mm: Option<f64>,
    /// Depth of the cut (ap), along the tool, mm
    #[arg(long, value_name = "AP", help_heading = "Cut", allow_negative_numbers = true, value_parser = number)]
    pub(crate) depth_mm: Option<f64>,
    /// On which side of the tool the part is, seen along the feed
    #[arg(long, value_enum, value_name = "SIDE", help_heading = "Cut", conflicts_with_all = ["climb", "conventional"])]
    pub(crate) part: Option<PartWord>,
    /// Climb (down) milling: the part is on the right, with a spindle that turns clockwise
    #[arg(long, help_heading = "Cut", conflicts_with = "conventional")]
    pub(crate) climb: bool,
    /// Conventional (up) milling: the part is on the left, with a spindle that turns clockwise
    #[arg(long, help_heading = "Cut")]
    pub(crate) conventional: bool,
    /// Feed per tooth, mm
    #[arg(long, value_name = "F", help_heading = "Cut", allow_negative_numbers = true, value_parser = number, conflicts_with = "feed_mm_per_min")]
    pub(crate) feed_per_tooth_mm: Option<f64>,
    /// Feed, mm/min; it needs --rpm
    #[arg(long, value_name = "F", help_heading = "Cut", allow_negative_numbers = true, value_parser = number)]
    pub(crate) feed_mm_per_min: Option<f64>,
    /// Speed of the spindle, turns per minute; power, cutting speed and frequencies need it
    #[arg(long, value_name = "S", help_heading = "Cut", allow_negative_numbers = true, value_parser = number)]
    pub(crate) rpm: Option<f64>,
    /// The spindle turns counter-clockwise (M4), seen from it down to the tool
    #[arg(long, help_heading = "Cut")]
    pub(crate) counter_clockwise: bool,
    /// Feed down the tool axis per tooth, mm (a ramp in a slot); negative where the tool rises
    #[arg(long, value_name = "F", help_heading = "Cut", allow_negative_numbers = true, value_parser = number)]
    pub(crate) down_feed_per_tooth_mm: Option<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum PartWord {
    /// To the left of the feed
    Left,
    /// To the right of the feed
    Right,
}

/// What the spindle can give.
#[derive(Debug, Args)]
pub(crate) struct SpindleArgs {
    /// Rated power of the spindle, W
    #[arg(long, value_name = "P", help_heading = "Spindle", allow_negative_numbers = true, value_parser = number, requires = "spindle_base_rpm")]
    pub(crate) spindle_power_w: Option<f64>,
    /// Its base speed: constant torque up to it, constant power above, turns per minute
    #[arg(long, value_name = "S", help_heading = "Spindle", allow_negative_numbers = true, value_parser = number, requires = "spindle_most_rpm")]
    pub(crate) spindle_base_rpm: Option<f64>,
    /// Its largest speed, turns per minute
    #[arg(long, value_name = "S", help_heading = "Spindle", allow_negative_numbers = true, value_parser = number, requires = "spindle_power_w")]
    pub(crate) spindle_most_rpm: Option<f64>,
}

/// Cuts whose force does not change over the turn.
#[derive(Debug, Args)]
pub(crate) struct SteadyArgs {
    /// A drill instead of a milling tool: --diameter-mm, --feed-per-turn-mm, perhaps --rpm
    #[arg(long, help_heading = "Drilling and turning", requires = "feed_per_turn_mm", conflicts_with_all = ["turning", "tool", "tool_table", "width_mm", "depth_mm", "part", "climb", "conventional", "feed_per_tooth_mm", "feed_mm_per_min", "csv", "plot", "spindle_power_w"])]
    pub(crate) drill: bool,
    /// A turning tool: --depth-mm, --feed-per-turn-mm, perhaps --speed-m-per-min
    #[arg(long, help_heading = "Drilling and turning", requires = "feed_per_turn_mm", conflicts_with_all = ["tool", "tool_table", "diameter_mm", "teeth", "width_mm", "part", "climb", "conventional", "feed_per_tooth_mm", "feed_mm_per_min", "rpm", "csv", "plot", "spindle_power_w"])]
    pub(crate) turning: bool,
    /// Feed per turn, mm
    #[arg(long, value_name = "F", help_heading = "Drilling and turning", allow_negative_numbers = true, value_parser = number)]
    pub(crate) feed_per_turn_mm: Option<f64>,
    /// Lips of the drill [default: 2]
    #[arg(long, value_name = "N", help_heading = "Drilling and turning", allow_negative_numbers = true, value_parser = whole, requires = "drill")]
    pub(crate) lips: Option<usize>,
    /// Angle between the lips, degrees [default: 118]
    #[arg(long, value_name = "ANGLE", help_heading = "Drilling and turning", allow_negative_numbers = true, value_parser = number, requires = "drill")]
    pub(crate) point_angle_deg: Option<f64>,
    /// Diameter of the hole that is there already, mm [default: none]
    #[arg(long, value_name = "D", help_heading = "Drilling and turning", allow_negative_numbers = true, value_parser = number, requires = "drill")]
    pub(crate) hole_mm: Option<f64>,
    /// Thrust of lips and chisel together over that of the lips [default: 1, no chisel]
    #[arg(long, value_name = "FACTOR", help_heading = "Drilling and turning", allow_negative_numbers = true, value_parser = number, requires = "drill")]
    pub(crate) chisel_factor: Option<f64>,
    /// Angle between the edge and the feed of the turning tool, degrees [default: 90]
    #[arg(long, value_name = "ANGLE", help_heading = "Drilling and turning", allow_negative_numbers = true, value_parser = number, requires = "turning")]
    pub(crate) approach_angle_deg: Option<f64>,
    /// Cutting speed of turning, m/min: power and --correct-speed need it
    #[arg(long, value_name = "V", help_heading = "Drilling and turning", allow_negative_numbers = true, value_parser = number, requires = "turning")]
    pub(crate) speed_m_per_min: Option<f64>,
}

const CODES: &str = "\
Exit codes:
  0    answered
  1    wrong input: a file, a number or an option; the message says which";

const FORCE_HELP: &str = "\
Examples:
  kinetostat force --material AlMg4.5Mn --tool flat --diameter-mm 12 --teeth 4 \\
      --helix-deg 38 --width-mm 4 --depth-mm 8 --climb \\
      --feed-per-tooth-mm 0.1 --rpm 8000 --plot cut.svg
      the force of a climb cut over the revolution
  kinetostat force --material C45 --tool face --diameter-mm 63 --teeth 5 \\
      --lead-angle-deg 45 --width-mm 40 --depth-mm 2 --part left \\
      --feed-mm-per-min 800 --rpm 1000 --wear 1.3 --spindle-power-w 7500 \\
      --spindle-base-rpm 1500 --spindle-most-rpm 6000
      a worn face mill: does the spindle bear it?
  kinetostat force --material Ti-6Al-4V --tool-table tools.toml \\
      --tool-number 3 --width-mm 1 --depth-mm 6 --climb \\
      --feed-per-tooth-mm 0.05 --json
  kinetostat force --drill --material C45 --diameter-mm 8 \\
      --feed-per-turn-mm 0.2 --rpm 1200
  kinetostat force --turning --material C45 --depth-mm 2 \\
      --feed-per-turn-mm 0.3 --approach-angle-deg 75 --speed-m-per-min 150
  kinetostat force --list-materials
  kinetostat force --fit means.csv --material \"our 7075\" --tool flat \\
      --diameter-mm 12 --teeth 4 --width-mm 12 --depth-mm 2 \\
      --acts-on part --out-material ours.toml --plot fit.svg
      coefficients of a material from mean forces in a slot

Axes of the force, which is that on the tool: x along the feed of the tool over
the part, y to the left of the feed, z along the tool towards the spindle.
Angles of the spindle count from +y (from -y with --counter-clockwise) to the
place of tooth 0 at the tip, as the spindle turns.

Mean forces for --fit (CSV): a row for each cut, all of them but for the feed
alike; better five feeds than two. Lines that begin with # are passed over.
  feed_mm_per_tooth,fx_n,fy_n,fz_n
  0.05,-95.2,149.7,-19.3
  0.10,-112.3,230.6,-33.6

A table of tools (TOML) has per tool
  [[tool]]
  number = 3            # and name
  shape = \"flat\"        # flat, ball, bull, face
  diameter_mm = 12
  teeth = 4             # and helix_deg, corner_radius_mm, lead_angle_deg,
                        # run_out_um, run_out_angle_deg, rake_deg, max_chip_mm,
                        # flute_length_mm, stick_out_mm, length_mm

Exit codes:
  0    answered
  1    wrong input: a file, a number or an option; the message says which";
