//! The answer of `curve` from what was followed of a chain or a machine.

use kinetostat::Parameter;
use kinetostat::continuation::{Branch, CurveEquilibrium};
use kinetostat_analysis::rotation::ContinuousRotation;
use kinetostat_machining::large_load;
use nalgebra::{UnitQuaternion, Vector3};

use crate::curve::answer::{CurveAnswer, Units, grows, reached};
use crate::curve::followed::Followed;
use crate::curve::points::View;
use crate::curve::query::{CurveQuery, Measure};
use crate::end_condition::subject::Subject;
use crate::place::query::{AnswerHead, PlaceAnswer};

/// Displacement along the growing load where the curve starts, from the commanded place, m or rad. The conjugate of a
/// machine counts from there, that of a chain from the curve's start; so does that of forces on nodes, which have no
/// commanded place.
fn displacement_at_start<E: CurveEquilibrium>(
    q: &CurveQuery,
    branches: &[Branch<E>],
    place: &PlaceAnswer,
) -> f64 {
    let Parameter::Load(pattern) = &q.parameter else {
        return 0.0;
    };
    let own = branches.first().and_then(|b| b.points.get(b.start));
    let Some(start) = own.filter(|_| q.holding.subject == "chain") else {
        return 0.0;
    };
    let tool = start.equilibrium.tool();
    let along = |direction: Vector3<f64>, displacement: Vector3<f64>| {
        let direction = direction.try_normalize(0.0);
        direction.map_or(0.0, |direction| direction.dot(&displacement))
    };
    match q.measure {
        Measure::Force(_) => {
            let commanded = Vector3::from(place.position_mm) * 1e-3;
            along(pattern.end.force(), tool.translation.vector - commanded)
        }
        Measure::Moment(_) => {
            let commanded = Vector3::from(place.rotation_vector_deg).map(f64::to_radians);
            let turned = tool.rotation * UnitQuaternion::from_scaled_axis(commanded).inverse();
            along(pattern.end.moment(), turned.scaled_axis())
        }
        Measure::Work => 0.0,
    }
}

pub(crate) fn answer_of<S: Subject>(
    subject: &S,
    q: &CurveQuery,
    mut followed: Followed<S::Equilibrium>,
    head: AnswerHead,
) -> CurveAnswer {
    let critical_loads = std::mem::take(&mut followed.critical);
    let mut warnings = std::mem::take(&mut followed.warnings);
    warnings.extend(followed.what_is_missing(q));
    warnings.extend(large_load(&q.largest_load()));
    warnings.dedup();
    let (branches, specials) = (&followed.branches, &followed.specials);
    let view = View {
        subject,
        q,
        curves: &followed,
        rotation: match q.measure {
            Measure::Moment(_) if q.by_load() => ContinuousRotation::of(branches, specials),
            _ => ContinuousRotation::none(),
        },
        at_start: displacement_at_start(q, &followed.branches, &head.place),
    };
    let (named_points, jumps) = view.named();
    let own = branches.first().map_or(&[][..], |b| &b.points);
    // A limit point lies between two points, and farther out than both.
    let on_own = specials.iter().filter(|s| s.branches.contains(&0));
    let turns = on_own.map(|s| &s.point);
    let mut points = branches.iter().flat_map(|b| &b.points);
    CurveAnswer {
        head,
        question: q.words.clone(),
        tool_held: q.holding.clone(),
        grows: grows(q),
        coordinates: subject.coordinates(),
        branches: view.branches(&named_points),
        named_points,
        jumps,
        critical_loads,
        more_branches: followed.more_branches,
        conservative: points.all(|p| p.equilibrium.conservative()),
        warnings,
        force_limited: q.force_limits.is_some(),
        subject: q.holding.subject,
        units: Units::of(q),
        requested: (q.shown(q.range.0), q.shown(q.range.1)),
        reached: reached(own.iter().chain(turns).map(|p| q.shown(p.parameter))),
    }
}
