//! All equilibria of a chain.

use kinetostat::number::smaller;
use kinetostat::{Bounds, ChainProblem, Direction, DirectionKind, FoundEquilibrium, equilibria};
use kinetostat_analysis::degenerate::is_degenerate;
use kinetostat_analysis::outline::chain_outline;
use kinetostat_analysis::serial_chain::SerialChain;

use crate::end_condition::chain::{coordinates, mode_in_words, values};
use crate::equilibria::answer::{Coverage, EquilibriaAnswer, ShapeAnswer};
use crate::equilibria::query::EquilibriaQuery;
use crate::place::query::PlaceAnswer;
use crate::ui::background::Stage;
use crate::ui::failure::Answer;

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
        .fold(f64::INFINITY, smaller)
}
