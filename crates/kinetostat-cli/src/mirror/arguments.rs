//! Options of `mirror`.

use std::path::PathBuf;

use clap::{ArgAction, Args, ValueEnum};
use kinetostat_mirror::{Alignment, Register};

use crate::job::arguments::ReadingArgs;
use crate::job::robot_arguments::RobotArgs;
use crate::options::{number, small};

/// Assignment of points to places on the path.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum AlignWord {
    /// The nearest place, where only one pass of the tool comes by
    Nearest,
    /// In the order in which they were measured, along the path
    ArcLength,
}

impl From<AlignWord> for Alignment {
    fn from(word: AlignWord) -> Self {
        match word {
            AlignWord::Nearest => Self::Nearest,
            AlignWord::ArcLength => Self::ArcLength,
        }
    }
}

/// Motion that brings the points into the frame of the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum RegisterWord {
    /// The points are in the frame of the program: a shift of the whole is corrected too
    None,
    /// A shift; it is not corrected
    Translation,
    /// A shift and a turn; both are not corrected
    Rigid,
}

impl From<RegisterWord> for Register {
    fn from(word: RegisterWord) -> Self {
        match word {
            RegisterWord::None => Self::None,
            RegisterWord::Translation => Self::Translation,
            RegisterWord::Rigid => Self::Rigid,
        }
    }
}

/// Correct a program by what was measured of its last trial
///
/// Brings measured points onto the path, names outliers, smooths the deviations along the path, and
/// writes the program with them mirrored. Measure the new program, and give the points with the
/// same state: each trial corrects what the one before has left, until that is within the
/// repeatability.
#[derive(Debug, Args)]
#[command(after_help = crate::options::EXIT_CODES, after_long_help = HELP)]
pub(crate) struct MirrorArgs {
    /// The program as it is drawn, the same in every trial: G-code, or of a robot
    /// (`kinetostat dialect list`)
    #[arg(value_name = "PROGRAM")]
    pub(crate) program: PathBuf,
    /// Points measured of the last trial (CSV with x_mm,y_mm,z_mm), or a second program; once for each
    /// measurement of the same trial
    #[arg(long, value_name = "FILE", required = true, action = ArgAction::Append)]
    pub(crate) measured: Vec<PathBuf>,
    /// The state of all trials (TOML), read and written; without it this is the only trial
    #[arg(long, value_name = "FILE")]
    pub(crate) state: Option<PathBuf>,
    /// Job file (TOML): the compensation by its model, if it names one, comes first, and the mirror
    /// corrects what is left; each of its features gets figures of its own
    #[arg(long, value_name = "JOB")]
    pub(crate) job: Option<PathBuf>,
    /// Share of the deviation that is mirrored, above 0 and below 2 [default: 1]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = number)]
    pub(crate) relaxation: Option<f64>,
    /// Smoothing along the path, standard deviation of its kernel, mm [default: 5]
    #[arg(long, value_name = "MM", allow_negative_numbers = true, value_parser = number)]
    pub(crate) smoothing_mm: Option<f64>,
    /// How far the tool may have been from its path, mm [default: 1]
    #[arg(long, value_name = "MM", allow_negative_numbers = true, value_parser = number)]
    pub(crate) window_mm: Option<f64>,
    /// Standard deviation of one measured deviation in one direction, micrometres; without it, from
    /// several measurements of this trial
    #[arg(long, value_name = "UM", allow_negative_numbers = true, value_parser = number)]
    pub(crate) repeatability_um: Option<f64>,
    /// How points find their places on the path [default: nearest]
    #[arg(long, value_enum, value_name = "HOW")]
    pub(crate) align: Option<AlignWord>,
    /// Motion that brings the points onto the path first; what it takes away is not corrected. A state that exists knows it,
    /// and without one it must be chosen
    #[arg(long, value_enum, value_name = "MOTION")]
    pub(crate) register: Option<RegisterWord>,
    /// Seek a scale besides the rigid motion
    #[arg(long)]
    pub(crate) scale: bool,
    /// The program that was measured is the last one written for certain: go on although its
    /// correction is not seen in the points
    #[arg(long, requires = "state")]
    pub(crate) was_run: bool,
    /// Move a limit, as in correction_mm=5 (repeat for more; `kinetostat compensate --help-all` lists them): correction_mm bounds the
    /// correction by measurement, blocks_per_second the program
    #[arg(long = "limit", value_name = "NAME=VALUE", action = ArgAction::Append, allow_hyphen_values = true, help_heading = "Limits")]
    pub(crate) limits: Vec<String>,
    #[command(flatten)]
    pub(crate) reading: ReadingArgs,
    #[command(flatten)]
    pub(crate) robot: RobotArgs,
    /// How far the straight pieces may leave the corrected path, micrometres [default: 0.5]
    #[arg(long, value_name = "UM", help_heading = "Tolerances", allow_negative_numbers = true, value_parser = number)]
    pub(crate) tolerance_um: Option<f64>,
    /// Digits after the point in mm, one more in inches [default: 4]
    #[arg(long, value_name = "N", help_heading = "Tolerances", allow_negative_numbers = true, value_parser = small)]
    pub(crate) decimals: Option<u8>,
    /// The corrected program of the next trial
    #[arg(long, short, value_name = "FILE", help_heading = "Outputs")]
    pub(crate) out: PathBuf,
    /// Leave out the header that marks the program as compensated
    #[arg(long, help_heading = "Outputs")]
    pub(crate) no_header: bool,
    /// Print the answer as JSON (the text goes to the standard error), or write it to FILE
    #[arg(long, value_name = "FILE", num_args = 0..=1, default_missing_value = "-", help_heading = "Outputs")]
    pub(crate) json: Option<PathBuf>,
    /// Deviation along the path before and after smoothing, correction and outliers (SVG)
    #[arg(long, value_name = "FILE", help_heading = "Outputs")]
    pub(crate) plot: Option<PathBuf>,
    /// Overwrite outputs that exist (never an input)
    #[arg(long, help_heading = "Outputs")]
    pub(crate) force_overwrite: bool,
}

const HELP: &str = "\
Examples:
  kinetostat mirror part.ngc --measured trial1.csv --state mirror.toml \\
      --register none --out trial2.ngc --repeatability-um 10 --plot trial1.svg
  kinetostat mirror part.ngc --measured trial2.csv --state mirror.toml \\
      --out trial3.ngc --repeatability-um 10
  kinetostat mirror part.ngc --measured tracker.csv --register rigid \\
      --align arc-length --out next.ngc

Registration is a choice:

  --register none         the points are in the frame of the program
  --register translation  its zero was not measured; a shift is not corrected
  --register rigid        the points are in another frame (laser tracker); a
                          shift and a turn of the whole are not corrected

Measured points, one a row; units stand in the names (mm, m, um, cm, in):

  x_mm,y_mm,z_mm,sigma_mm,line
  0.012,0.003,-0.001,0.002,12

sigma or weight, and line (of the program) may be left out.

Exit codes:
  0    answered
  1    wrong input: a file, a number or an option; the message says which
  2    no answer: with a job, its machine cannot get somewhere
  130  stopped with Ctrl-C; nothing was written";
