//! The answer of `curve` from what was followed of a chain or a machine.

use kinetostat::continuation::CurveEquilibrium;
use kinetostat_analysis::rotation::ContinuousRotation;
use kinetostat_machining::large_load;

use crate::curve::answer::{CurveAnswer, Units, grows, reached};
use crate::curve::followed::Followed;
use crate::curve::points::View;
use crate::curve::query::{CurveQuery, Measure};
use crate::end_condition::subject::Subject;
use crate::place::query::PlaceAnswer;

pub(crate) fn answer_of<S: Subject>(
    subject: &S,
    q: &CurveQuery,
    mut followed: Followed<S::Equilibrium>,
    place: PlaceAnswer,
    names: [String; 3],
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
    };
    let (named_points, jumps) = view.named();
    let own = branches.first().map_or(&[][..], |b| &b.points);
    // A limit point lies between two points, and farther out than both.
    let on_own = specials.iter().filter(|s| s.branches.contains(&0));
    let turns = on_own.map(|s| &s.point);
    let mut points = branches.iter().flat_map(|b| &b.points);
    let [model, model_source, tool] = names;
    CurveAnswer {
        schema: 3,
        kinetostat_version: env!("CARGO_PKG_VERSION"),
        model,
        model_source,
        tool,
        place,
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
