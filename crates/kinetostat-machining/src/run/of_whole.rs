//! What is known of a whole program where a part of it is run.

use kinetostat::number::smaller;

use crate::load::along_path::LoadAlongPath;
use crate::run::first_look::FirstLook;
use crate::run::preparation::refuse;
use crate::task::{RunError, Task};
use crate::watch::Watch;

/// What is known of a whole program where a part of it is run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OfWhole {
    /// Smallest stiffness against a force at the places that a first look took, N/mm; infinite before the first.
    pub stiffness_n_per_mm: f64,
    /// The program is left as it is: it keeps its tolerance so, or nothing can be written.
    pub as_it_is: bool,
}

impl Default for OfWhole {
    fn default() -> Self {
        Self {
            stiffness_n_per_mm: f64::INFINITY,
            as_it_is: false,
        }
    }
}

impl OfWhole {
    /// A first look at a part; `compensate`: it is to be corrected. What takes minutes to be solved everywhere is refused here.
    ///
    /// # Errors
    /// A load under which the machine folds over, or corrections that are beyond their limits by far.
    pub fn look_at(
        &mut self,
        task: &Task<'_>,
        compensate: bool,
        watch: &dyn Watch,
    ) -> Result<(), RunError> {
        let load = LoadAlongPath::with_tools(task.load, task.path(), task.tools);
        let looked = FirstLook::new(task, &load, watch)?;
        refuse(match compensate {
            true => looked.gross(task),
            false => looked.folding_load(task),
        })?;
        self.stiffness_n_per_mm = smaller(self.stiffness_n_per_mm, looked.stiffness());
        Ok(())
    }
}
