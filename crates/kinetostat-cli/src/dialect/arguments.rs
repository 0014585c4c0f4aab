//! Options of `kinetostat dialect`.

use clap::{Args, Subcommand};

/// What is done with every word of a language of programs: the tables that readers and writers are made from
#[derive(Debug, Args)]
#[command(arg_required_else_help = true, subcommand_required = true)]
pub(crate) struct DialectArgs {
    #[command(subcommand)]
    pub(crate) what: DialectCommand,
}

#[derive(Debug, Subcommand)]
pub(crate) enum DialectCommand {
    /// The languages that are read
    List,
    /// Every word of a language: followed, carried byte for byte, or refused and why
    Show(ShowArgs),
}

#[derive(Debug, Args)]
pub(crate) struct ShowArgs {
    /// Name of a language, as `dialect list` has it
    #[arg(value_name = "NAME")]
    pub(crate) name: String,
    /// Print the table as JSON
    #[arg(long)]
    pub(crate) json: bool,
}
