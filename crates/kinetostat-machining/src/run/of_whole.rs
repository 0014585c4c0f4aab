//! Facts about a whole program for the run of a part of it.

use kinetostat::number::smaller;

/// Facts about a whole program for the run of a part of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OfWhole {
    /// Moves of the whole program, over which the places of a first look are spread.
    pub moves: usize,
    /// Smallest stiffness against a force at the places that a first look took, N/mm; infinite before the first.
    pub stiffness_n_per_mm: f64,
    /// The program is left as it is: it keeps its tolerance so, or nothing can be written.
    pub as_it_is: bool,
}

impl OfWhole {
    /// Adds the facts found in another part.
    pub fn add(&mut self, found: &Self) {
        self.stiffness_n_per_mm = smaller(self.stiffness_n_per_mm, found.stiffness_n_per_mm);
    }
}

impl Default for OfWhole {
    fn default() -> Self {
        Self {
            moves: 0,
            stiffness_n_per_mm: f64::INFINITY,
            as_it_is: false,
        }
    }
}
