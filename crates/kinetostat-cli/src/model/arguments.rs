//! Options of `model`.

use clap::{Args, Subcommand};

use crate::model::draw::DrawArgs;

/// Models that come with the program, and the format of model files
#[derive(Debug, Args)]
pub(crate) struct ModelArgs {
    #[command(subcommand)]
    pub(crate) action: ModelAction,
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
    Draw(Box<DrawArgs>),
}
