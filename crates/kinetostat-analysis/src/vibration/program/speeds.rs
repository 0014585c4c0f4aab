//! A spindle speed at which a stretch of a program would not chatter.

use std::collections::BTreeSet;
use std::sync::OnceLock;

use kinetostat::number::smaller;
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
    /// True if a neighbouring speed, 5 % of the program's speed away, chatters. In this case the speed is the one with
    /// the largest limit relative to its depth, otherwise the nearest one.
    pub is_narrow: bool,
    /// Feed, mm/min, that keeps the feed per tooth; `None` where this changes along the stretch.
    pub feed_mm_per_min: Option<f64>,
}

/// A cut at which speeds are tried, and what is known of it.
struct Tried {
    regeneration: Regeneration,
    /// m.
    depth: f64,
    /// Stability by the index of the speed.
    stable: [OnceLock<bool>; SPEEDS.2],
    room: [OnceLock<f64>; SPEEDS.2],
}

/// The worst cut of each cluster, which is tried once for all stretches.
pub(crate) struct OtherSpeeds<'q, 'a, 'l> {
    question: &'q ChatterQuestion<'a>,
    load: &'q LoadAlongPath<'l>,
    worst: &'q [JudgedSite],
    cuts: Vec<OnceLock<Option<Tried>>>,
}

impl<'q, 'a, 'l> OtherSpeeds<'q, 'a, 'l> {
    /// `worst`: what was judged for each cluster.
    pub(crate) fn new(
        question: &'q ChatterQuestion<'a>,
        load: &'q LoadAlongPath<'l>,
        worst: &'q [JudgedSite],
    ) -> Self {
        Self {
            question,
            load,
            worst,
            cuts: worst.iter().map(|_| OnceLock::new()).collect(),
        }
    }

    /// The speed nearest to that of the program which is stable with its neighbours all along a stretch; else the one with the
    /// largest limit.
    ///
    /// One look at some of the cuts rules out most speeds; the one that would be offered is tried in full at all of them, with
    /// its neighbours if it is to have room.
    pub(crate) fn stable_speed(
        &self,
        rpm: f64,
        sites: &[&JudgedSite],
        beside: &[&JudgedSite],
    ) -> Result<Option<StableSpeed>, ProgramChatterError> {
        let (from, to, count) = SPEEDS;
        let speeds: Vec<f64> = (0..count)
            .map(|k| rpm * (from + (to - from) * k as f64 / (count - 1) as f64))
            .collect();
        let (mut chosen, mut others) = (Vec::new(), Vec::new());
        for (places, most) in [
            (one_of_each(sites), TRIED),
            (one_of_each(beside), TRIED_BESIDE),
        ] {
            for (judged, is_chosen) in places.iter().zip(some_of(places.len(), most)) {
                match is_chosen {
                    true => chosen.push(judged.cluster),
                    false => others.push(judged.cluster),
                }
            }
        }
        let tried = self.cuts(&chosen)?;
        let may_be_stable =
            |(k, rpm): (usize, &f64)| !tried.iter().any(|c| c.is_ruled_out(k, *rpm));
        let looked_at = speeds.par_iter().enumerate().map(may_be_stable);
        let mut stable: Vec<bool> = looked_at.collect();
        if !stable.contains(&true) {
            return Ok(None);
        }
        let others = self.cuts(&others)?;
        let all: Vec<&Tried> = tried.iter().chain(&others).copied().collect();
        let holds = |k: usize, stable: &mut [bool]| {
            stable[k] = stable[k] && all.par_iter().all(|cut| cut.is_stable(k, speeds[k]));
            stable[k]
        };
        let offered = 1..count - 1;
        let apart = |k: &usize| (speeds[*k] - rpm).abs();
        let (k, is_narrow) = loop {
            let has_room = |k: &usize| stable[k - 1..=k + 1].iter().all(|s| *s);
            let nearest = offered.clone().filter(has_room);
            if let Some(k) = nearest.min_by(|a, b| apart(a).total_cmp(&apart(b))) {
                if [k, k - 1, k + 1].iter().all(|k| holds(*k, &mut stable)) {
                    break (k, false);
                }
                continue;
            }
            let alone = offered.clone().filter(|k| holds(*k, &mut stable));
            let alone: Vec<usize> = alone.collect();
            let room = |k: &usize| -> f64 {
                let of_cuts = tried.par_iter().map(|cut| cut.room(*k, speeds[*k]));
                of_cuts.reduce(|| f64::INFINITY, smaller)
            };
            let largest = match alone[..] {
                // One needs no comparison.
                [] | [_] => alone.first().copied(),
                _ => (alone.iter().map(|k| (room(k), *k)))
                    .reduce(|a, b| if b.0 > a.0 { b } else { a })
                    .map(|(_, k)| k),
            };
            match largest {
                Some(k) => break (k, true),
                None => return Ok(None),
            }
        };
        Ok(Some(StableSpeed {
            rpm: speeds[k],
            is_narrow,
            feed_mm_per_min: feed(self.question, sites, speeds[k])?,
        }))
    }

    /// The cuts of clusters that can be reckoned.
    fn cuts(&self, clusters: &[usize]) -> Result<Vec<&Tried>, ProgramChatterError> {
        let each = clusters.par_iter().map(|cluster| {
            let known = &self.cuts[*cluster];
            if known.get().is_none() {
                let site = &self.worst[*cluster].site;
                let cut = self.question.site_cut(self.load, site)?.ok();
                let cut = cut.map(|SiteCut { regeneration, .. }| Tried {
                    regeneration,
                    depth: 1e-3 * site.station.depth_mm,
                    stable: Default::default(),
                    room: Default::default(),
                });
                // Nobody else has made it: each cluster comes once.
                let _ = known.set(cut);
            }
            Ok(known.get().and_then(Option::as_ref))
        });
        let all: Vec<Option<&Tried>> = each.collect::<Result<_, ProgramChatterError>>()?;
        Ok(all.into_iter().flatten().collect())
    }
}

impl Tried {
    /// True if it chatters at a speed for certain, by one look. Where no multiplier is found nothing is known to be stable.
    fn is_ruled_out(&self, k: usize, rpm: f64) -> bool {
        let is_unstable = || self.regeneration.is_unstable_at(rpm, self.depth);
        match self.stable[k].get() {
            Some(is_stable) => !is_stable,
            None if is_unstable().unwrap_or(true) => !*self.stable[k].get_or_init(|| false),
            None => false,
        }
    }

    /// True if it does not chatter at a speed at its depth or at a smaller one.
    fn is_stable(&self, k: usize, rpm: f64) -> bool {
        *self.stable[k].get_or_init(|| {
            let found = limit_at(&self.regeneration, rpm, self.depth, false);
            found.is_ok_and(|found| found.limit().is_none())
        })
    }

    /// Limit relative to the depth at a speed, as far as the search went.
    fn room(&self, k: usize, rpm: f64) -> f64 {
        *self.room[k].get_or_init(|| {
            let found = limit_at(&self.regeneration, rpm, self.depth, true);
            found.map_or(0.0, |found| {
                let limit = found.limit().map(|crossing| crossing.depth);
                limit.unwrap_or(found.up_to) / self.depth
            })
        })
    }
}

/// The first place of each cluster.
fn one_of_each<'j>(places: &[&'j JudgedSite]) -> Vec<&'j JudgedSite> {
    let mut known = BTreeSet::new();
    let is_first = |judged: &&&JudgedSite| known.insert(judged.cluster);
    places.iter().filter(is_first).copied().collect()
}

/// Selects at most `most` of the places, evenly; the last one always, as the machine is in another posture there.
fn some_of(places: usize, most: usize) -> impl Iterator<Item = bool> {
    let step = places.div_ceil(most).max(1);
    (0..places)
        .rev()
        .map(move |behind| behind.is_multiple_of(step))
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
