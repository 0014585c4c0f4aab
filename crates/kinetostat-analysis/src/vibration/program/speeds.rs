//! A spindle speed at which a stretch of a program would not chatter.

use std::collections::BTreeSet;

use kinetostat_chatter::Regeneration;
use kinetostat_machining::LoadAlongPath;
use rayon::prelude::*;

use crate::vibration::program::judge::{SiteCut, limit_at};
use crate::vibration::program::judged::JudgedSite;
use crate::vibration::program::question::{ChatterQuestion, ProgramChatterError};

/// Spindle speeds that are tried, by that of the program: from, to, and how many. The first and the last are tried for those
/// beside them.
const SPEEDS: (f64, f64, usize) = (0.45, 1.55, 23);
/// Places of a stretch at which all speeds are tried, and how many more of its lines that do not chatter as programmed.
const TRIED: usize = 6;
const TRIED_BESIDE: usize = 3;
/// Change of a feed, share of it, up to which it is one.
const SAME_FEED: f64 = 2e-3;

/// A spindle speed at which the depths of the program, with its feeds per tooth, do not chatter at any place of the stretch that
/// was judged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StableSpeed {
    /// rpm.
    pub rpm: f64,
    /// Whether a speed beside it, 5 % of that of the program away, chatters: of such ones it is that with the largest limit by its
    /// depth. Else it is the nearest one.
    pub is_narrow: bool,
    /// Feed, mm/min, that keeps the feed per tooth; `None` where this changes along the stretch.
    pub feed_mm_per_min: Option<f64>,
}

/// A cut of the stretch at which all speeds are tried, and its depth, m.
struct Tried {
    regeneration: Regeneration,
    depth: f64,
}

/// The speed nearest to that of the program which is stable with its neighbours all along a stretch; else the one with the
/// largest limit.
///
/// All speeds are tried at some of the places. The one that would be offered is tried at all others, with its neighbours if it is to
/// have room, and where one of these chatters all speeds are tried, too.
pub(crate) fn stable_speed(
    question: &ChatterQuestion<'_>,
    load: &LoadAlongPath<'_>,
    rpm: f64,
    (sites, beside): (&[&JudgedSite], &[&JudgedSite]),
) -> Result<Option<StableSpeed>, ProgramChatterError> {
    let (from, to, count) = SPEEDS;
    let speeds: Vec<f64> = (0..count)
        .map(|k| rpm * (from + (to - from) * k as f64 / (count - 1) as f64))
        .collect();
    let mut stable = vec![true; count];
    let cut_at = |judged: &JudgedSite| -> Result<Option<Tried>, ProgramChatterError> {
        let cut = question.site_cut(load, &judged.site)?.ok();
        Ok(cut.map(|SiteCut { regeneration, .. }| Tried {
            regeneration,
            depth: 1e-3 * judged.site.station.depth_mm,
        }))
    };
    let (mut others, mut cuts): (Vec<&JudgedSite>, Vec<Tried>) = (Vec::new(), Vec::new());
    for (places, most) in [
        (one_of_each(sites), TRIED),
        (one_of_each(beside), TRIED_BESIDE),
    ] {
        for (judged, is_chosen) in places.iter().zip(some_of(places.len(), most)) {
            if !is_chosen {
                others.push(judged);
                continue;
            }
            if let Some(cut) = cut_at(judged)? {
                cut.rule_out(&speeds, &mut stable);
                cuts.push(cut);
            }
            if !stable.contains(&true) {
                return Ok(None);
            }
        }
    }
    let (offered, is_narrow) = loop {
        let Some((k, is_narrow)) = candidate(&speeds, &stable, rpm, &cuts) else {
            return Ok(None);
        };
        let beside = usize::from(!is_narrow);
        let with_neighbours = &speeds[k - beside..=k + beside];
        let holds = |cut: &Tried| with_neighbours.iter().all(|rpm| cut.is_stable(*rpm));
        let chatters = |judged: &&JudgedSite| match cut_at(judged) {
            Ok(Some(cut)) => (!holds(&cut)).then_some(Ok(cut)),
            Ok(None) => None,
            Err(error) => Some(Err(error)),
        };
        let Some(found) = others.par_iter().find_map_first(chatters) else {
            break (speeds[k], is_narrow);
        };
        let found = found?;
        found.rule_out(&speeds, &mut stable);
        cuts.push(found);
    };
    Ok(Some(StableSpeed {
        rpm: offered,
        is_narrow,
        feed_mm_per_min: feed(question, sites, offered)?,
    }))
}

/// Index of the speed to offer of those that are stable, and whether it is narrow.
fn candidate(speeds: &[f64], stable: &[bool], rpm: f64, cuts: &[Tried]) -> Option<(usize, bool)> {
    let offered = 1..speeds.len() - 1;
    let apart = |k: &usize| (speeds[*k] - rpm).abs();
    let has_room = |k: &usize| stable[k - 1] && stable[*k] && stable[k + 1];
    let nearest = offered.clone().filter(has_room);
    if let Some(k) = nearest.min_by(|a, b| apart(a).total_cmp(&apart(b))) {
        return Some((k, false));
    }
    let alone: Vec<usize> = offered.filter(|k| stable[*k]).collect();
    let largest = match alone[..] {
        // One needs no comparison.
        [] | [_] => alone.first().copied(),
        _ => (alone.par_iter().map(|k| (room(cuts, speeds[*k]), *k)))
            .collect::<Vec<_>>()
            .into_iter()
            .reduce(|a, b| if b.0 > a.0 { b } else { a })
            .map(|(_, k)| k),
    };
    largest.map(|k| (k, true))
}

impl Tried {
    /// Whether it does not chatter at a speed. Where no multiplier is found nothing is known to be stable.
    fn is_stable(&self, rpm: f64) -> bool {
        // A cut that is unstable at its depth is so without a look at its limit.
        if self
            .regeneration
            .is_unstable_at(rpm, self.depth)
            .unwrap_or(true)
        {
            return false;
        }
        let found = limit_at(&self.regeneration, rpm, self.depth, false);
        found.is_ok_and(|found| found.limit().is_none())
    }

    /// Marks the speeds at which it chatters, on all cores.
    fn rule_out(&self, speeds: &[f64], stable: &mut [bool]) {
        let still = speeds.par_iter().zip(stable).filter(|(_, s)| **s);
        still.for_each(|(speed, is_stable)| *is_stable = self.is_stable(*speed));
    }
}

/// The first place of each cluster.
fn one_of_each<'j>(places: &[&'j JudgedSite]) -> Vec<&'j JudgedSite> {
    let mut known = BTreeSet::new();
    let is_first = |judged: &&&JudgedSite| known.insert(judged.cluster);
    places.iter().filter(is_first).copied().collect()
}

/// Which of so many places are tried, evenly; the last one, too: the machine stands otherwise there.
fn some_of(places: usize, most: usize) -> impl Iterator<Item = bool> {
    let step = places.div_ceil(most).max(1);
    (0..places).map(move |k| k.is_multiple_of(step) || k + 1 == places)
}

/// Least limit by its depth of the cuts at a speed, as far as it is looked for.
fn room(cuts: &[Tried], rpm: f64) -> f64 {
    let of = |cut: &Tried| {
        let found = limit_at(&cut.regeneration, rpm, cut.depth, true);
        found.map_or(0.0, |found| {
            let limit = found.limit().map(|crossing| crossing.depth);
            limit.unwrap_or(found.up_to) / cut.depth
        })
    };
    cuts.iter()
        .map(of)
        .reduce(|a, b| if b < a { b } else { a })
        .unwrap_or(0.0)
}

/// Feed at a speed with the feed per tooth of the program, mm/min, where that is one along the stretch.
fn feed(
    question: &ChatterQuestion<'_>,
    sites: &[&JudgedSite],
    rpm: f64,
) -> Result<Option<f64>, ProgramChatterError> {
    let mut known: Option<f64> = None;
    for judged in sites {
        let teeth = question.tool_of(&judged.site)?.tool.teeth();
        let own = judged.site.station.feed_per_tooth_mm * teeth as f64 * rpm;
        match known {
            Some(known) if (own - known).abs() > SAME_FEED * known => return Ok(None),
            _ => known = known.or(Some(own)),
        }
    }
    Ok(known)
}
