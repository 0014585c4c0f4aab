//! The first look at a long program, part by part.

use kinetostat::number::smaller;

use crate::load::along_path::LoadAlongPath;
use crate::run::first_look::FirstLook;
use crate::run::of_whole::OfWhole;
use crate::run::preparation::refuse;
use crate::task::{RunError, Task};
use crate::watch::Watch;

/// A first look at a part, with what was found before; `compensate`: it is to be corrected. What takes hours to be solved
/// everywhere is refused here.
///
/// # Errors
/// A load under which the machine folds over, or corrections that are beyond their limits by far.
pub fn look_at_part(
    before: OfWhole,
    task: &Task<'_>,
    compensate: bool,
    watch: &dyn Watch,
) -> Result<OfWhole, RunError> {
    let load = LoadAlongPath::with_tools(task.load, task.path(), task.tools);
    let looked = FirstLook::new(task, &load, watch)?;
    refuse(match compensate {
        true => looked.gross(task),
        false => looked.folding_load(task),
    })?;
    Ok(OfWhole {
        stiffness_n_per_mm: smaller(before.stiffness_n_per_mm, looked.stiffness()),
        ..before
    })
}
