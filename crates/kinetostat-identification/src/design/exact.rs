//! Choice of whole postures: exchanges of single ones (Fedorov 1972) from several starts.

use nalgebra::DMatrix;

use super::criterion::DesignSettings;
use super::error::DesignError;
use super::problem::Problem;
use crate::random::SplitMix64;

/// Relative decrease of the value below which an exchange is rounding.
const DECREASE: f64 = 1e-10;

/// Pairs after which an improvement is taken without looking for a better one.
const PAIRS: usize = 64;

/// Information that regularises incomplete sets, relative to the mean candidate.
const REGULAR: f64 = 1e-6;

/// Efficiency at which further starts are useless.
const OPTIMAL: f64 = 1.0 - 1e-9;

/// Best set of postures over all starts, in ascending order, with its value.
///
/// `weights` of a continuous design guide the starts; `bound` ends them early.
pub(super) fn search(
    problem: &Problem,
    weights: &[f64],
    bound: Option<f64>,
    settings: &DesignSettings,
) -> Result<(Vec<usize>, f64), DesignError> {
    let p = problem.parameters;
    let regular = &problem.fixed + DMatrix::identity(p, p) * (REGULAR / weights.len() as f64);
    let mut random = SplitMix64(settings.seed);
    let mut best: Option<(Vec<usize>, f64)> = None;
    let mut largest_rank = 0;
    for start in 0..settings.starts.max(1) {
        let mut chosen = match start {
            0 => Vec::new(),
            1 => rounded(weights, problem),
            _ => drawn(weights, problem, &mut random),
        };
        complete(problem, &regular, &mut chosen);
        if value(problem, &problem.fixed, &chosen).is_none() {
            // The regularised criterion drives the set towards full rank.
            improve(problem, &regular, &mut chosen);
        }
        let Some(value) = improve(problem, &problem.fixed, &mut chosen) else {
            largest_rank = usize::max(largest_rank, problem.rank(&chosen));
            continue;
        };
        if best.as_ref().is_none_or(|(_, v)| value < *v) {
            best = Some((chosen, value));
        }
        if bound.is_some_and(|b| b >= OPTIMAL * value) {
            break;
        }
    }
    let (mut postures, found) = best.ok_or_else(|| problem.too_few_observations(largest_rank))?;
    postures.sort_unstable();
    // Independent of the order in which the postures were found.
    let value = value(problem, &problem.fixed, &postures).unwrap_or(found);
    Ok((postures, value))
}

/// Value of a set with the information `base` added; `None` if the information is singular.
fn value(problem: &Problem, base: &DMatrix<f64>, chosen: &[usize]) -> Option<f64> {
    problem
        .objective
        .value(problem.sum(base, chosen), f64::INFINITY)
}

/// Adds the posture that lowers the value most until the set is complete or `base` is singular.
fn complete(problem: &Problem, base: &DMatrix<f64>, chosen: &mut Vec<usize>) {
    while chosen.len() < problem.count
        && let Some(next) = best_change(problem, base, chosen, &[None])
    {
        chosen.push(next.enters);
    }
}

/// Exchanges postures until no single exchange lowers the value. Returns the value; `None` if the information is singular.
fn improve(problem: &Problem, base: &DMatrix<f64>, chosen: &mut [usize]) -> Option<f64> {
    let mut now = value(problem, base, chosen)?;
    loop {
        let places: Vec<_> = (0..chosen.len()).map(Some).collect();
        let Some(next) = best_change(problem, base, chosen, &places) else {
            return Some(now);
        };
        let before = chosen.to_vec();
        if let Some(place) = next.place {
            chosen[place] = next.enters;
        }
        // Computed anew, so that errors of the updates do not add up.
        match value(problem, base, chosen) {
            Some(v) if v < now * (1.0 - DECREASE) => now = v,
            _ => {
                chosen.copy_from_slice(&before);
                return Some(now);
            }
        }
    }
}

/// Exchange of one posture, or addition of one.
struct Change {
    enters: usize,
    /// Place of the posture that leaves.
    place: Option<usize>,
}

/// Best exchange at one of the places that lowers the value; the best addition for the place `None`.
///
/// Pairs are tried in the order of their sensitivities, until the bound of the criterion excludes all others.
fn best_change(
    problem: &Problem,
    base: &DMatrix<f64>,
    chosen: &[usize],
    places: &[Option<usize>],
) -> Option<Change> {
    let information = problem.sum(base, chosen);
    let state = problem.objective.state(information.clone())?;
    let sensitivities = problem.sensitivities(&state.solution);
    let out = |place: &Option<usize>| place.map_or(0.0, |k| sensitivities[chosen[k]]);
    let mut entering: Vec<usize> = (0..sensitivities.len())
        .filter(|x| problem.repeats || !chosen.contains(x))
        .collect();
    entering.sort_by(|a, b| sensitivities[*b].total_cmp(&sensitivities[*a]));
    let mut leaving = places.to_vec();
    leaving.sort_by(|a, b| out(a).total_cmp(&out(b)));
    leaving.dedup_by_key(|place| place.map(|k| chosen[k]));
    let is_exchange = leaving[0].is_some();
    let mut limit = if is_exchange {
        state.value * (1.0 - DECREASE)
    } else {
        f64::INFINITY
    };
    let mut best: Option<Change> = None;
    let mut pairs = 0;
    for enters in entering {
        let entered = &information + problem.information_of(enters);
        let can_improve =
            |place: &&Option<usize>| state.bound(sensitivities[enters] - out(place)) < limit;
        let ready = is_exchange && pairs >= PAIRS && best.is_some();
        if ready || !can_improve(&&leaving[0]) {
            break;
        }
        let open: Vec<Option<usize>> = leaving.iter().take_while(can_improve).copied().collect();
        for place in open {
            let after = match place {
                Some(k) => &entered - problem.information_of(chosen[k]),
                None => entered.clone(),
            };
            pairs += 1;
            if let Some(value) = problem.objective.value(after, limit)
                && value < limit
            {
                limit = value;
                best = Some(Change { enters, place });
            }
        }
    }
    best
}

/// Whole parts of the weights times the number of postures, the most weighted ones first.
fn rounded(weights: &[f64], problem: &Problem) -> Vec<usize> {
    let mut order: Vec<usize> = (0..weights.len()).collect();
    order.sort_by(|a, b| weights[*b].total_cmp(&weights[*a]));
    let most = if problem.repeats { problem.count } else { 1 };
    let share = |x: usize| (weights[x] * problem.count as f64).round() as usize;
    let each = order
        .into_iter()
        .flat_map(|x| std::iter::repeat_n(x, share(x).min(most)));
    each.take(problem.count).collect()
}

/// Random set: each posture is drawn by the weights or, equally often, from all candidates.
fn drawn(weights: &[f64], problem: &Problem, random: &mut SplitMix64) -> Vec<usize> {
    let n = weights.len();
    let mut chosen = Vec::with_capacity(problem.count);
    while chosen.len() < problem.count {
        let by_weight = random.uniform() < 0.5;
        let mut left = random.uniform();
        let mut x = (left * n as f64) as usize;
        if by_weight {
            let reached = |w: &f64| {
                left -= w;
                left < 0.0
            };
            x = weights.iter().position(reached).unwrap_or(n - 1);
        }
        // There are at least as many candidates as postures.
        while !problem.repeats && chosen.contains(&x) {
            x = (x + 1) % n;
        }
        chosen.push(x);
    }
    chosen
}
