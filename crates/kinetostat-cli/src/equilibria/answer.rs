//! The answer of `equilibria`: every shape with its energy, stability and forces, and how complete
//! the list is.

use kinetostat::{Bounds, ChainProblem, Direction, DirectionKind, FoundEquilibrium, equilibria};
use kinetostat_analysis::degenerate::is_degenerate;
use kinetostat_analysis::outline::chain_outline;
use kinetostat_analysis::serial_chain::SerialChain;
use kinetostat_machining::Warning;
use nalgebra::Vector3;
use serde::Serialize;

use crate::end_condition::chain::{coordinates, mode_in_words, values};
use crate::end_condition::coordinates::CoordinateName;
use crate::end_condition::holding::Holding;
use crate::equilibria::query::EquilibriaQuery;
use crate::place::query::PlaceAnswer;
use crate::ui::background::Stage;
use crate::ui::failure::Answer;

/// The answer, stable names with units.
#[derive(Serialize)]
pub(crate) struct EquilibriaAnswer {
    pub(crate) schema: u32,
    pub(crate) kinetostat_version: &'static str,
    pub(crate) model: String,
    pub(crate) model_source: String,
    pub(crate) tool: String,
    pub(crate) place: PlaceAnswer,
    pub(crate) question: String,
    pub(crate) tool_held: Holding,
    /// Direction of `stiffness_n_per_mm`; null: the principal one with the smallest stiffness.
    pub(crate) stiffness_along: Option<[f64; 3]>,
    pub(crate) coordinates: Vec<CoordinateName>,
    /// By rising energy.
    pub(crate) equilibria: Vec<ShapeAnswer>,
    pub(crate) coverage: Coverage,
    pub(crate) conservative: bool,
    pub(crate) warnings: Vec<Warning>,
    /// Chain's shape per equilibrium, m.
    #[serde(skip)]
    pub(crate) outlines: Vec<Vec<Vector3<f64>>>,
}

/// One equilibrium.
#[derive(Serialize)]
pub(crate) struct ShapeAnswer {
    pub(crate) number: usize,
    /// Springs and loads, up to a constant; of the springs alone where a load has no potential.
    pub(crate) energy_j: f64,
    /// Under the conditions as prescribed.
    pub(crate) stable: bool,
    /// Under loads without a potential it does not go away, but it may swing with growing amplitude;
    /// whether it does depends on the masses.
    pub(crate) may_flutter: bool,
    /// With the tool held.
    pub(crate) shape_stable: bool,
    /// mu; null without inner freedom, and where a passive joint is pushed out of line.
    pub(crate) share_to_buckling: Option<f64>,
    /// Motion of the coordinates in which it would buckle.
    pub(crate) mode_in_words: String,
    /// At a limit or bifurcation point, or one of a family that moves for nothing.
    pub(crate) singular: bool,
    pub(crate) found_by_spread_starts: usize,
    /// Along the direction asked for; without one the smallest principal stiffness, rotations at the natural length. Null if infinite.
    pub(crate) stiffness_n_per_mm: f64,
    /// Rows: force (N), moment (N m); columns: displacement (m), rotation (rad); at the tool's tip.
    pub(crate) stiffness_n_m_rad: [[f64; 6]; 6],
    pub(crate) force_n: [f64; 3],
    pub(crate) moment_n_m: [f64; 3],
    pub(crate) position_mm: [f64; 3],
    pub(crate) rotation_vector_deg: [f64; 3],
    pub(crate) coordinates: Vec<f64>,
}

/// How complete the list is.
#[derive(Serialize)]
pub(crate) struct Coverage {
    pub(crate) starts: usize,
    pub(crate) ended_within_bounds: usize,
    pub(crate) ended_outside_bounds: usize,
    /// Starts since the last new equilibrium.
    pub(crate) fruitless: usize,
    pub(crate) chance_of_more: f64,
    pub(crate) chance_of_more_at_most: f64,
    pub(crate) settled: bool,
}

/// Finds all equilibria.
pub(crate) fn solve(
    chain: &SerialChain,
    q: &EquilibriaQuery,
    place: PlaceAnswer,
    names: [String; 3],
    stage: &Stage,
) -> Answer<EquilibriaAnswer> {
    stage.is("searching for equilibria");
    let problem = chain.problem(q.end.clone());
    let found = equilibria(&problem, &Bounds::of(&chain.chain), &q.settings)?;
    let outlines = found
        .found
        .iter()
        .map(|f| {
            chain_outline(
                &chain.chain,
                &chain.base,
                &chain.commands,
                &f.equilibrium.coordinates,
            )
        })
        .collect();
    let conservative = found.found.iter().all(|f| f.equilibrium.conservative);
    let [model, model_source, tool] = names;
    Ok(EquilibriaAnswer {
        schema: 3,
        kinetostat_version: env!("CARGO_PKG_VERSION"),
        model,
        model_source,
        tool,
        place,
        question: q.words.clone(),
        tool_held: q.holding.clone(),
        stiffness_along: q.along.map(Into::into),
        coordinates: coordinates(chain),
        equilibria: found
            .found
            .iter()
            .enumerate()
            .map(|(i, f)| shape(chain, q, &problem, i + 1, f))
            .collect(),
        coverage: Coverage {
            starts: found.starts,
            ended_within_bounds: found.hits,
            ended_outside_bounds: found.outside,
            fruitless: found.fruitless,
            chance_of_more: found.chance_of_more,
            chance_of_more_at_most: found.chance_of_more_at_most,
            settled: found.settled,
        },
        conservative,
        warnings: Vec::new(),
        outlines,
    })
}

fn shape(
    chain: &SerialChain,
    q: &EquilibriaQuery,
    problem: &ChainProblem<'_>,
    number: usize,
    f: &FoundEquilibrium,
) -> ShapeAnswer {
    let e = &f.equilibrium;
    let k = &e.stiffness.cartesian.matrix;
    let stiffness = match q.along {
        Some(d) => 1e-3 * (d.transpose() * k.fixed_view::<3, 3>(0, 0) * d)[0],
        None => softest(&e.stiffness.directions),
    };
    ShapeAnswer {
        number,
        energy_j: f.potential.unwrap_or(e.energy),
        stable: f.stable,
        may_flutter: f.may_flutter,
        shape_stable: e.stability.stable,
        share_to_buckling: e.stability.share_to_buckling.filter(|m| m.is_finite()),
        mode_in_words: if e.stability.mode.is_empty() {
            String::new()
        } else {
            mode_in_words(chain, &e.stability.mode)
        },
        singular: is_degenerate(chain, problem, f),
        found_by_spread_starts: f.hits,
        stiffness_n_per_mm: stiffness,
        stiffness_n_m_rad: std::array::from_fn(|i| std::array::from_fn(|j| k[(i, j)])),
        force_n: e.wrench.force().into(),
        moment_n_m: e.wrench.moment().into(),
        position_mm: (e.tip.translation.vector * 1e3).into(),
        rotation_vector_deg: e.tip.rotation.scaled_axis().map(f64::to_degrees).into(),
        coordinates: values(chain, &e.coordinates),
    }
}

/// Smallest principal stiffness that is not free, N/mm.
fn softest(directions: &[Direction]) -> f64 {
    directions
        .iter()
        .filter(|d| d.kind != DirectionKind::Free)
        .map(|d| 1e-3 * d.stiffness_n_per_m)
        .fold(f64::INFINITY, f64::min)
}
