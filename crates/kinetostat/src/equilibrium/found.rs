//! Equilibria that a search found, of a chain or of a machine, and how sure it is that there are no more.

use crate::chain::equilibrium::Equilibrium;
use crate::continuation::curve_equilibrium::CurveEquilibrium;
use crate::equilibrium::search::Coverage;

/// An equilibrium that a search found, with its stability and how many starts ended there.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct FoundEquilibrium<E: CurveEquilibrium = Equilibrium> {
    /// Coordinates (rotations of passive joints within the bounds), wrench, stiffness, shape.
    pub equilibrium: E,
    /// Whether it holds under the conditions as prescribed: dead wrench where the wrench is
    /// prescribed, held where the pose is.
    pub stable: bool,
    /// Under loads without a potential it does not go away, but may swing with growing amplitude
    /// (flutter), which depends on the masses.
    pub may_flutter: bool,
    /// Potential energy of springs and loads, J, up to a constant of the problem; `None` where a
    /// load has none (see [`crate::chain::is_conservative`]).
    pub potential: Option<f64>,
    /// How many evenly spread starts ended here; 0: found from another equilibrium only.
    pub hits: usize,
    /// True if the equilibrium is degenerate: at a limit or bifurcation point, or one of a family
    /// that moves for nothing.
    pub singular: bool,
}

/// All equilibria found, by rising potential energy (where a load has none: by the springs'
/// energy), and how sure it is that there are no more.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Equilibria<E: CurveEquilibrium = Equilibrium> {
    /// By rising potential energy.
    pub found: Vec<FoundEquilibrium<E>>,
    /// Evenly spread starts made.
    pub starts: usize,
    /// Evenly spread starts that ended at an equilibrium within the bounds.
    pub hits: usize,
    /// Evenly spread starts that ended at an equilibrium outside the bounds.
    pub outside: usize,
    /// Starts since the last new equilibrium.
    pub fruitless: usize,
    /// Good-Turing estimate of the chance that one more successful start finds something new: the
    /// share of successful starts whose equilibrium was found just once (never, by spread starts,
    /// counts too).
    pub chance_of_more: f64,
    /// Upper end of that chance (95 %; the rule of three where no equilibrium was found just once).
    pub chance_of_more_at_most: f64,
    /// True if the search ended because nothing new was found, not because starts ran out or the
    /// largest number was reached.
    pub exhausted: bool,
}

impl<E: CurveEquilibrium> Equilibria<E> {
    /// By rising energy.
    pub(crate) fn of(mut found: Vec<FoundEquilibrium<E>>, coverage: &Coverage) -> Self {
        found.sort_by(|a, b| a.energy().total_cmp(&b.energy()));
        Self {
            found,
            starts: coverage.starts,
            hits: coverage.hits,
            outside: coverage.outside,
            fruitless: coverage.fruitless,
            chance_of_more: coverage.chance_of_more.0,
            chance_of_more_at_most: coverage.chance_of_more.1,
            exhausted: coverage.exhausted,
        }
    }
}

impl<E: CurveEquilibrium> FoundEquilibrium<E> {
    /// Potential energy of springs and loads, J; where a load has none, that of the springs.
    #[must_use]
    pub fn energy(&self) -> f64 {
        self.potential
            .unwrap_or_else(|| self.equilibrium.spring_energy())
    }
}
