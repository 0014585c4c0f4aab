//! The first look at a long program, part by part.

use crate::load::along_path::LoadAlongPath;
use crate::run::first_look::FirstLook;
use crate::run::preparation::{OfWhole, load, refuse};
use crate::task::{RunError, Task};
use crate::watch::Watch;

/// A first look at a part of a whole program, to be added to what is found in the others; `compensate`: it is to be corrected. A
/// program that takes hours to be solved everywhere is refused here, at some places of every part; the smallest stiffness is that
/// of the places which a first look at the whole program takes, so that it does not depend on how long the parts are.
///
/// # Errors
/// A load under which the machine folds over, or corrections that are beyond their limits by far.
pub fn look_at_part(
    whole: OfWhole,
    task: &Task<'_>,
    compensate: bool,
    watch: &dyn Watch,
) -> Result<OfWhole, RunError> {
    let load: LoadAlongPath<'_> = load(task);
    let looked = FirstLook::new(task, &load, watch)?;
    refuse(match compensate {
        true => looked.gross(task),
        false => looked.folding_load(task),
    })?;
    let of_whole = FirstLook::of_whole(task, &load, whole.moves, watch)?;
    Ok(OfWhole {
        stiffness_n_per_mm: of_whole.stiffness(),
        ..whole
    })
}
