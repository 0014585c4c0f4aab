//! The turn of a round tool about its own axis, as options and job files ask for it.

use std::path::PathBuf;

use clap::Args;
use serde::Deserialize;

/// Redundancy resolution for a round tool about its own axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum FreeTurnWord {
    /// The turn is that of the job.
    #[default]
    AsStated,
    /// The turn is chosen along the whole path.
    Choose,
    /// The turn is chosen for stiffness, too.
    Stiff,
}

/// Options for the turn of a round tool about its own axis.
#[derive(Clone, Debug, Default, Args)]
pub(crate) struct TurnFlags {
    /// Turn a round tool about its axis along the path of an arm: inside the limits of the joints, away from singular
    /// postures, in one configuration
    #[arg(long, help_heading = "Free turn")]
    pub(crate) free_turn: bool,
    /// Choose that turn so that the tip of the tool yields little to a force, too
    #[arg(long, help_heading = "Free turn")]
    pub(crate) stiff_turn: bool,
    /// Picture of that turn along the path (SVG)
    #[arg(long, value_name = "FILE", help_heading = "Free turn")]
    pub(crate) turn_plot: Option<PathBuf>,
}
