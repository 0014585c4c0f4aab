//! `kinetostat import`: models and links from the files of other programs.
//!
//! It takes a robot description (URDF), or matrices, superelements and displacements of a link, and gives a model
//! file or a table of one, with everything that was assumed.

pub(crate) mod arguments;
mod displacements;
mod link;
mod link_arguments;
mod matrix;
mod mesh;
mod urdf;

use crate::import::arguments::{ImportAction, ImportArgs};
use crate::import::urdf::urdf;
use crate::ui::failure::Answer;

pub(crate) fn run(args: &ImportArgs) -> Answer<()> {
    match &args.action {
        ImportAction::Urdf(args) => urdf(args),
        ImportAction::Matrix(args) => matrix::matrix(args),
        ImportAction::LinkDisplacements(args) => displacements::displacements(args),
    }
}
