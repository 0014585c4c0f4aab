//! All equilibria of a machine of several limbs: from many places of its tool, and along curves.

use kinetostat::number::smaller;
use kinetostat::{DirectionKind, SearchSettings, SpreadSettings};

use crate::end_condition::machine::CommandedMachine;
use crate::equilibria::answer::{Coverage, EquilibriaAnswer, ShapeAnswer};
use crate::equilibria::query::EquilibriaQuery;
use crate::place::query::PlaceAnswer;
use crate::ui::background::Stage;
use crate::ui::failure::Answer;

/// Finds the equilibria.
pub(crate) fn solve(
    machine: &CommandedMachine,
    q: &EquilibriaQuery,
    place: PlaceAnswer,
    names: [String; 3],
    stage: &Stage,
) -> Answer<EquilibriaAnswer> {
    let posture = machine.posture()?;
    stage.is("looking for singular postures nearby");
    let warnings = machine.near_singular(&posture, 0.0)?;
    stage.is("searching for equilibria");
    let settings = SpreadSettings {
        starts: q.settings.starts,
        // A start of a machine costs more than one of a chain.
        fruitless: match q.settings.fruitless == SearchSettings::default().fruitless {
            true => SpreadSettings::default().fruitless,
            false => q.settings.fruitless,
        },
    };
    let all = posture.equilibria(&q.end, &settings)?;
    let equilibria = all
        .found
        .iter()
        .enumerate()
        .map(|(i, f)| {
            let e = &f.equilibrium;
            let k = &e.stiffness.matrix;
            ShapeAnswer {
                number: i + 1,
                energy_j: f.potential,
                stable: f.stable,
                may_flutter: f.may_flutter,
                shape_stable: e.shapes_stable(),
                share_to_buckling: e.share_to_buckling().filter(|m| m.is_finite()),
                mode_in_words: String::new(),
                singular: f.singular,
                found_by_spread_starts: f.hits,
                stiffness_n_per_mm: match q.along {
                    Some(d) => 1e-3 * (d.transpose() * k.fixed_view::<3, 3>(0, 0) * d)[0],
                    None => e
                        .directions
                        .iter()
                        .filter(|d| !matches!(d.kind, DirectionKind::Free | DirectionKind::Rigid))
                        .map(|d| 1e-3 * d.stiffness_n_per_m)
                        .fold(f64::INFINITY, smaller),
                },
                stiffness_n_m_rad: std::array::from_fn(|i| std::array::from_fn(|j| k[(i, j)])),
                force_n: e.wrench.force().into(),
                moment_n_m: e.wrench.moment().into(),
                position_mm: (e.tool.translation.vector * 1e3).into(),
                rotation_vector_deg: e.tool.rotation.scaled_axis().map(f64::to_degrees).into(),
                coordinates: machine.values(&posture, e),
            }
        })
        .collect();
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
        coordinates: machine.coordinates(&posture),
        equilibria,
        coverage: Coverage {
            starts: all.starts,
            ended_within_bounds: all.hits,
            ended_outside_bounds: all.outside,
            fruitless: all.fruitless,
            chance_of_more: all.chance_of_more,
            chance_of_more_at_most: all.chance_of_more_at_most,
            settled: all.settled,
        },
        conservative: all.found.iter().all(|f| f.equilibrium.conservative),
        warnings,
        outlines: all
            .found
            .iter()
            .map(|f| machine.outline(&posture, &f.equilibrium))
            .collect(),
    })
}
