//! Equilibria that a search found, of a chain or of a machine, and how sure it is that there are no more.

use crate::chain::equilibrium::Equilibrium;
use crate::continuation::curve::CurveEquilibrium;
use crate::equilibrium::search::Coverage;

/// An equilibrium that a search found, with its stability and how many starts ended there.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct FoundEquilibrium<E: CurveEquilibrium = Equilibrium> {
    /// Coordinates (rotations of passive joints within the bounds), wrench, stiffness, shape.
    pub equilibrium: E,
    /// True if it is stable under the conditions as prescribed: dead wrench where the wrench is prescribed, held where
    /// the pose is.
    pub stable: bool,
    /// True if, under loads without a potential, it does not diverge but may oscillate with growing amplitude
    /// (flutter), which depends on the masses.
    pub may_flutter: bool,
    /// Potential energy of springs and loads, J, up to a constant of the problem; `None` where a
    /// load has none (see [`crate::chain::is_conservative`]).
    pub potential: Option<f64>,
    /// Number of evenly spread starts that ended here; 0: found from another equilibrium only.
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
    /// Equilibria by rising potential energy.
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
    /// Shapes of each limb of a machine whose tool is held: every combination of them is an equilibrium. Empty for
    /// chains, and for machines whose limbs are searched together.
    pub limbs: Vec<LimbShapes>,
    /// True if there certainly are more: the energy has a minimum, and none of those found is one.
    pub incomplete: bool,
}

/// Shapes of one limb of a machine whose tool is held, and how sure it is that there are no more.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct LimbShapes {
    /// Name of the limb, as in the model.
    pub name: String,
    /// Shapes that were found.
    pub shapes: usize,
    /// Number of the stable ones.
    pub stable: usize,
    /// Evenly spread starts made.
    pub starts: usize,
    /// Starts since the last new shape.
    pub fruitless: usize,
    /// Upper end (95 %) of the chance that one more successful start finds a new one.
    pub chance_of_more_at_most: f64,
    /// True if the search ended because nothing new was found.
    pub exhausted: bool,
}

impl LimbShapes {
    pub(crate) fn of(name: &str, own: &Equilibria) -> Self {
        Self {
            name: name.to_owned(),
            shapes: own.found.len(),
            stable: own.found.iter().filter(|shape| shape.stable).count(),
            starts: own.starts,
            fruitless: own.fruitless,
            chance_of_more_at_most: own.chance_of_more_at_most,
            exhausted: own.exhausted,
        }
    }
}

impl<E: CurveEquilibrium> Equilibria<E> {
    /// Sorts by rising energy. `has_minimum`: the conditions give the energy a minimum, if all loads have a potential.
    pub(crate) fn of(
        mut found: Vec<FoundEquilibrium<E>>,
        coverage: &Coverage,
        has_minimum: bool,
    ) -> Self {
        found.sort_by(|a, b| a.energy().total_cmp(&b.energy()));
        let none_stays = !found.is_empty()
            && (found.iter()).all(|f| !f.stable && !f.singular && f.potential.is_some());
        let incomplete = has_minimum && none_stays;
        let (chance, at_most) = match incomplete {
            true => (1.0, 1.0),
            false => coverage.chance_of_more,
        };
        Self {
            found,
            starts: coverage.starts,
            hits: coverage.hits,
            outside: coverage.outside,
            fruitless: coverage.fruitless,
            chance_of_more: chance,
            chance_of_more_at_most: at_most,
            exhausted: coverage.exhausted,
            limbs: Vec::new(),
            incomplete,
        }
    }

    /// Number of equilibria that are known, those included that are not listed because there are too many.
    #[must_use]
    pub fn count(&self) -> usize {
        self.of_limbs(|limb| limb.shapes, self.found.len())
    }

    /// Number of those that are stable.
    #[must_use]
    pub fn stable_count(&self) -> usize {
        let listed = self.found.iter().filter(|f| f.stable).count();
        self.of_limbs(|limb| limb.stable, listed)
    }

    /// A number of the product of the limbs' shapes, if it is not listed in full.
    fn of_limbs(&self, number: impl Fn(&LimbShapes) -> usize, listed: usize) -> usize {
        let of = |number: &dyn Fn(&LimbShapes) -> usize| {
            let numbers = self.limbs.iter().map(number);
            numbers.fold(1, usize::saturating_mul)
        };
        match !self.limbs.is_empty() && of(&|limb| limb.shapes) > self.found.len() {
            true => of(&number),
            false => listed,
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
