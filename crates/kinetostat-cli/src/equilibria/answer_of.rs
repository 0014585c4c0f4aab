//! The answer of `equilibria` from what a search found of a chain or a machine.

use kinetostat::{
    CartesianStiffness, DirectionKind,
    continuation::CurveEquilibrium,
    equilibrium::{Equilibria, FoundEquilibrium, LimbShapes},
};
use kinetostat_machining::{Warning, large_load};
use nalgebra::{Matrix6, Vector3};

use crate::end_condition::subject::Subject;
use crate::equilibria::answer::{Coverage, EquilibriaAnswer, LimbCoverage, ShapeAnswer};
use crate::equilibria::query::EquilibriaQuery;
use crate::place::query::AnswerHead;

pub(crate) fn answer_of<S: Subject>(
    subject: &S,
    q: &EquilibriaQuery,
    (all, mut warnings): (Equilibria<S::Equilibrium>, Vec<Warning>),
    head: AnswerHead,
) -> EquilibriaAnswer {
    warnings.extend(large_load(&q.end.wrench));
    let found = || all.found.iter().map(|f| &f.equilibrium);
    let shapes = all.found.iter().enumerate();
    EquilibriaAnswer {
        head,
        question: q.words.clone(),
        tool_held: q.holding.clone(),
        stiffness_along: q.along.map(Into::into),
        coordinates: subject.coordinates(),
        equilibria: shapes.map(|(i, f)| shape(subject, q, i + 1, f)).collect(),
        coverage: Coverage {
            starts: all.starts,
            ended_within_bounds: all.hits,
            ended_outside_bounds: all.outside,
            fruitless: all.fruitless,
            chance_of_more: Some(all.chance_of_more).filter(|chance| *chance > 0.0),
            chance_of_more_at_most: all.chance_of_more_at_most,
            exhausted: all.exhausted,
            incomplete: all.incomplete,
            known: all.count(),
            known_stable: all.stable_count(),
            limbs: all.limbs.iter().map(limb_coverage).collect(),
        },
        conservative: found().all(CurveEquilibrium::conservative),
        warnings,
        outlines: found().map(|e| subject.outline(e)).collect(),
    }
}

/// Stiffness along a unit direction; NaN where it is infinite.
fn along(stiffness: &Matrix6<f64>, d: &Vector3<f64>) -> f64 {
    let parts = (0..3).flat_map(|i| (0..3).map(move |j| (i, j)));
    let parts = parts.filter(|&(i, j)| d[i] != 0.0 && d[j] != 0.0);
    parts.map(|(i, j)| d[i] * stiffness[(i, j)] * d[j]).sum()
}

fn limb_coverage(own: &LimbShapes) -> LimbCoverage {
    LimbCoverage {
        name: own.name.clone(),
        shapes: own.shapes,
        stable: own.stable,
        starts: own.starts,
        fruitless: own.fruitless,
        chance_of_more_at_most: own.chance_of_more_at_most,
        exhausted: own.exhausted,
    }
}

fn shape<S: Subject>(
    subject: &S,
    q: &EquilibriaQuery,
    number: usize,
    f: &FoundEquilibrium<S::Equilibrium>,
) -> ShapeAnswer {
    let e = &f.equilibrium;
    let matrix = *e.stiffness();
    let k = CartesianStiffness { matrix }.finite_entries(e.directions());
    // Smallest principal stiffness that is neither free nor rigid.
    let softest = || {
        let directions = e.directions().iter();
        directions
            .filter(|d| !matches!(d.kind, DirectionKind::Free | DirectionKind::Rigid))
            .map(|d| d.stiffness_n_per_m)
            .fold(f64::INFINITY, kinetostat::number::smaller)
    };
    ShapeAnswer {
        number,
        energy_j: f.energy(),
        stable: f.stable,
        may_flutter: f.may_flutter,
        shape_stable: e.shape_stable(),
        share_to_buckling: e.share_to_buckling().filter(|m| m.is_finite()),
        mode_in_words: subject.motion_description(e.buckling_mode()),
        singular: f.singular,
        found_by_spread_starts: f.hits,
        stiffness_n_per_mm: 1e-3
            * match q.along {
                Some(d) => along(&k, &d),
                None => softest(),
            },
        stiffness_n_m_rad: std::array::from_fn(|i| std::array::from_fn(|j| k[(i, j)])),
        force_n: e.wrench().force().into(),
        moment_n_m: e.wrench().moment().into(),
        position_mm: (e.tool().translation.vector * 1e3).into(),
        rotation_vector_deg: e.tool().rotation.scaled_axis().map(f64::to_degrees).into(),
        coordinates: subject.values(e),
    }
}
