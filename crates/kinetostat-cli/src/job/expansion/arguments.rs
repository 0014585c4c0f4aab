//! Options of the expansion of a program.

use std::path::PathBuf;

use clap::{ArgAction, Args};

use crate::job::dialect_word::DialectWord;

/// What a program does not say and its expansion needs.
#[derive(Clone, Debug, Default, Args)]
pub(crate) struct ExpansionArgs {
    /// Folder of subprograms beside that of the program (repeat for more)
    #[arg(long, value_name = "FOLDER", action = ArgAction::Append, help_heading = "Expansion")]
    pub(crate) subprograms: Vec<PathBuf>,
    /// Diameter of a tool for G41 and G42, mm, as in 3=6.5 (repeat for more)
    #[arg(long, value_name = "TOOL=MM", action = ArgAction::Append, help_heading = "Expansion")]
    pub(crate) tool_diameter_mm: Vec<String>,
    /// Value of a numbered parameter before the program, as in 100=2.5 (repeat for more)
    #[arg(long, value_name = "NUMBER=VALUE", action = ArgAction::Append, help_heading = "Expansion")]
    pub(crate) parameter: Vec<String>,
    /// Controller that the program is written for; what controllers read differently is refused without it
    #[arg(long, value_enum, value_name = "NAME", help_heading = "Expansion")]
    pub(crate) dialect: Option<DialectWord>,
    /// Leave out the comments that say the line of each flat block
    #[arg(long, help_heading = "Expansion")]
    pub(crate) no_comments: bool,
    /// The flat program is on its way to another language, whose comments those would become.
    #[arg(skip)]
    pub(crate) goes_on: bool,
}

/// Option for the origin of flat lines, in `kinetostat expand` for every language.
pub(crate) const NO_COMMENTS: &str = "--no-comments";

impl ExpansionArgs {
    /// The first option that was given.
    pub(crate) fn given(&self) -> Option<&'static str> {
        let subprograms = (!self.subprograms.is_empty()).then_some("--subprograms");
        subprograms.or(self.given_for_gcode())
    }

    /// The first option that was given and says something of G-code alone.
    pub(crate) fn given_for_gcode(&self) -> Option<&'static str> {
        let all = [
            ("--tool-diameter-mm", !self.tool_diameter_mm.is_empty()),
            ("--parameter", !self.parameter.is_empty()),
            ("--dialect", self.dialect.is_some()),
            (NO_COMMENTS, self.no_comments),
        ];
        all.into_iter()
            .find_map(|(name, given)| given.then_some(name))
    }
}

/// Whether a program is expanded before it is read, and how.
#[derive(Clone, Debug, Default, Args)]
pub(crate) struct ExpandFlags {
    /// Run the program once and go on with its flat form: subprograms, variables, cycles, G41 and
    /// G42 as plain blocks (`kinetostat expand` shows them)
    #[arg(long, help_heading = "Expansion")]
    pub(crate) expand: bool,
    #[command(flatten)]
    pub(crate) with: ExpansionArgs,
    /// File for the flat program, whose lines the messages name; of a conversion (--to) the converted one
    #[arg(long, value_name = "FILE", help_heading = "Expansion")]
    pub(crate) flat_program: Option<PathBuf>,
}
