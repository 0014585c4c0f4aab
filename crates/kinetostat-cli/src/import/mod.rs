//! `kinetostat import`: models and links from the files of other programs.

pub(crate) mod arguments;
mod link;
mod link_arguments;
mod urdf;

use crate::import::arguments::{ImportAction, ImportArgs};
use crate::import::urdf::urdf;
use crate::ui::failure::Answer;

pub(crate) fn run(args: &ImportArgs) -> Answer<()> {
    match &args.action {
        ImportAction::Urdf(args) => urdf(args),
        ImportAction::Matrix(args) => link::matrix(args),
        ImportAction::LinkDisplacements(args) => link::displacements(args),
    }
}
