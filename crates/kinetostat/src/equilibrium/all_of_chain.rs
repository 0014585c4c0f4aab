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
use crate::chain::problem::{ChainProblem, Prescribed, load_energy};
use crate::chain::residual::FoundBy;
use crate::equilibrium::chain_search::{ChainSearch, Known};
use crate::equilibrium::chain_starts::Bounds;
use crate::equilibrium::found::{Equilibria, FoundEquilibrium};
use crate::equilibrium::search::{Entry, Limits, search};
use crate::error::Result;
use crate::model::chain::{Chain, Coordinate, Role};
use crate::settings::Settings;
use crate::spatial::MotionKind;

/// Limits of the search.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[non_exhaustive]
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

crate::settings::setters!(SearchSettings {
    with_fruitless: fruitless: usize,
    with_starts: starts: usize,
    with_most: most: usize,
    with_sweep: sweep: bool,
    with_solver: solver: Settings,
});

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

/// Finds all equilibria of a chain within bounds: prescribed pose, wrench or a mixture.
///
/// # Errors
/// Wrong input. That nothing was found is a result.
///
/// ```
/// # use kinetostat::nalgebra::{Vector3, vector};
/// # use kinetostat::*;
/// # let hinge = |stiffness| ActuatorSpec::new(MotionKind::Revolute, Vector3::z(), stiffness);
/// # let chain = Chain::builder("column") // two bars of 0.5 m on springs of 100 N m/rad
/// #     .actuator("foot", hinge(100.0))
/// #     .translation(vector![0.5, 0.0, 0.0])
/// #     .actuator("middle", hinge(100.0))
/// #     .translation(vector![0.5, 0.0, 0.0])
/// #     .build()?;
/// let push = Wrench::new(vector![-150.0, 0.0, 0.0], Vector3::zeros()); // N: beyond the critical load
/// let problem = ChainProblem::new(&chain, EndCondition::wrench(push));
/// let settings = equilibrium::SearchSettings::default();
/// let all = equilibria(&problem, &equilibrium::Bounds::of(&chain), &settings)?;
/// let stable = all.found.iter().filter(|found| found.stable).count();
/// assert!(stable >= 2, "it buckles to one side or the other");
/// # Ok::<(), Error>(())
/// ```
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
    let found = known.into_iter().map(|entry| of_entry(problem, entry));
    let (loads, wrench) = (&problem.loads, &problem.end.wrench);
    let held = problem.end.prescribed == [Prescribed::Pose; 6] || wrench.0.amax() == 0.0;
    let has_minimum = held && (loads.is_empty() || !has_passive_slide(problem.chain));
    Ok(Equilibria::of(found.collect(), &coverage, has_minimum))
}

/// True if a passive joint slides: along it, loads may lower the energy without end.
pub(crate) fn has_passive_slide(chain: &Chain) -> bool {
    let slides = |c: &Coordinate| c.role == Role::Passive && c.kind == MotionKind::Prismatic;
    chain.coordinates().iter().any(slides)
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
