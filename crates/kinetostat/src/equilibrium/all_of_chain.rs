//! All equilibria of a chain under one set of conditions, as far as they can be found.
//!
//! Newton on the conditions of equilibrium converges to stable and unstable shapes alike. It is
//! started from the posture, from every shape found (mirrored, pushed along its critical mode) and
//! from a sequence that fills the coordinates' bounds evenly; each start that ends where another
//! one ended is run once more with the known equilibria deflated. When a stated number of starts
//! was fruitless, the curve through every equilibrium is followed for others that it connects. The
//! result says how often each equilibrium was found and how likely another start is to find a new
//! one. It is deterministic.

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

use crate::chain::equilibrium::Equilibrium;
use crate::chain::found_by::FoundBy;
use crate::chain::potential::load_energy;
use crate::chain::problem::ChainProblem;
use crate::equilibrium::bounds::Bounds;
use crate::equilibrium::chain_search::{ChainSearch, Known};
use crate::equilibrium::search::{Entry, Limits, search};
use crate::error::Result;
use crate::settings::Settings;

/// How long to search.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct SearchSettings {
    /// The search stops after this many evenly spread starts in a row that found nothing new (four
    /// times as many while some equilibrium was hit only once). Default 400.
    pub fruitless: usize,
    /// Evenly spread starts at most. Default 5000.
    pub starts: usize,
    /// The search stops when this many equilibria are known. Default 100.
    pub most: usize,
    /// Follow the curve through every equilibrium for others that it connects. Default true.
    pub sweep: bool,
    /// Tolerances of each equilibrium; `iterations` bounds each start.
    pub solver: Settings,
}

impl Default for SearchSettings {
    fn default() -> Self {
        Self {
            fruitless: 400,
            starts: 5000,
            most: 100,
            sweep: true,
            solver: Settings::default(),
        }
    }
}

/// One equilibrium among all.
#[derive(Clone, Debug)]
pub struct FoundEquilibrium {
    /// Coordinates (rotations of passive joints within the bounds), wrench, stiffness, shape.
    pub equilibrium: Equilibrium,
    /// Whether it holds under the conditions as prescribed: dead wrench where the wrench is
    /// prescribed, held where the pose is.
    pub stable: bool,
    /// Under loads without a potential it does not go away, but may swing with growing amplitude
    /// (flutter), which depends on the masses.
    pub may_flutter: bool,
    /// Potential energy of springs and loads, J, up to a constant of the problem; `None` where a
    /// load has none (see [`crate::model::loads::potential`]).
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
pub struct Equilibria {
    /// By rising potential energy.
    pub found: Vec<FoundEquilibrium>,
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
    pub settled: bool,
}

/// Finds all equilibria of a chain within bounds: prescribed pose, wrench or a mixture.
///
/// # Errors
/// Wrong input. That nothing was found is a result.
pub fn equilibria(
    problem: &ChainProblem<'_>,
    bounds: &Bounds,
    settings: &SearchSettings,
) -> Result<Equilibria> {
    bounds.check(problem.chain)?;
    let mut system = ChainSearch::new(problem, bounds, &settings.solver, settings.sweep)?;
    let limits = Limits {
        fruitless: settings.fruitless,
        starts: settings.starts,
        most: settings.most,
    };
    let (known, coverage) = search(&mut system, &limits);
    let mut found: Vec<FoundEquilibrium> = known
        .into_iter()
        .map(|entry| of_entry(problem, entry))
        .collect();
    let rank = |f: &FoundEquilibrium| f.potential.unwrap_or(f.equilibrium.energy);
    found.sort_by(|a, b| rank(a).total_cmp(&rank(b)));
    Ok(Equilibria {
        found,
        starts: coverage.starts,
        hits: coverage.hits,
        outside: coverage.outside,
        fruitless: coverage.fruitless,
        chance_of_more: coverage.chance_of_more.0,
        chance_of_more_at_most: coverage.chance_of_more.1,
        settled: coverage.settled,
    })
}

fn of_entry(problem: &ChainProblem<'_>, entry: Entry<Known>) -> FoundEquilibrium {
    let k = entry.known;
    FoundEquilibrium {
        potential: load_energy(problem, &k.equilibrium.coordinates)
            .ok()
            .flatten()
            .map(|loads| k.equilibrium.energy + loads),
        stable: k.stable,
        may_flutter: k.may_flutter,
        hits: entry.hits,
        singular: k.singular(),
        equilibrium: Equilibrium {
            found_by: FoundBy::OtherStart,
            ..k.equilibrium
        },
    }
}
