//! A quantity of the machine over places of a grid, as the page colours them. The page asks piece by piece, so that it draws what is
//! there and can stop.

use kinetostat::{Posture, Wrench};
use kinetostat_diagnostic::ErrorCode;
use kinetostat_dynamics::check_masses;
use kinetostat_machining::{Grid, MapPlace, MapTask, Unwatched, VARIABLES, Variable, Width, map};

use crate::shown::answer::{MapOfState, MapRequest, MapVariable};
use crate::ui::failure::{Answer, Failing, Failure};

/// Places of one request.
const MOST_PLACES: usize = 2048;

/// What a map can show of a machine: variables with one number at each place.
pub(crate) fn variables(posture: &Posture, ratings: &[Option<f64>]) -> Vec<MapVariable> {
    let has_masses = check_masses(posture.mechanism()).is_ok();
    let shown = VARIABLES.iter().filter(|entry| {
        entry.width == Width::Fixed(1)
            && (has_masses || !entry.variable.needs_mass())
            && (entry.variable != Variable::EffortShare || ratings.iter().any(Option::is_some))
    });
    let each = shown.map(|entry| MapVariable {
        name: entry.name,
        unit: entry.unit,
        description: entry.description,
    });
    each.collect()
}

/// The variable at the places of a grid, the tool turned as in a posture and under the same load.
pub(crate) fn map_of(
    posture: &Posture,
    wrench: &Wrench,
    ratings: Vec<Option<f64>>,
    request: &MapRequest,
) -> Answer<MapOfState> {
    let known = variables(posture, &ratings);
    let variable = (known.iter().find(|own| own.name == request.variable))
        .and_then(|own| Variable::named(own.name));
    let variable = variable.ok_or_else(|| {
        ErrorCode::UnknownName.failure(format!(
            "there is no variable '{}' of this machine",
            request.variable
        ))
    })?;
    let ends = request.from_mm.iter().chain(&request.to_mm);
    let is_far = |mm: &f64| !mm.is_finite() || mm.abs() > 1e7;
    if ends.copied().any(|mm| is_far(&mm))
        || request.counts.contains(&0)
        || request.counts.iter().any(|n| *n > MOST_PLACES)
        || request.counts.iter().product::<usize>() > MOST_PLACES
    {
        return Err(ErrorCode::Value.failure(format!(
            "a grid has 1 to {MOST_PLACES} places, at most 10 km away"
        )));
    }
    let mechanism = posture.mechanism();
    let task = MapTask {
        mechanism,
        grid: Grid {
            from_mm: request.from_mm,
            to_mm: request.to_mm,
            counts: request.counts,
        },
        orientation: posture.target().rotation,
        orientation_follows: mechanism.turns_as_it_moves(),
        load: Some(*wrench),
        further: Vec::new(),
        variables: vec![variable],
        ratings,
        first: 0,
    };
    let mut values = Vec::new();
    let of_place = |place: &MapPlace| place.values.first().copied().filter(|x| x.is_finite());
    map::<_, Failure>(
        &task,
        &Unwatched,
        |places| places.iter().map(of_place).collect::<Vec<_>>(),
        |block| {
            values.extend(block);
            Ok(())
        },
    )?;
    Ok(MapOfState { values })
}
