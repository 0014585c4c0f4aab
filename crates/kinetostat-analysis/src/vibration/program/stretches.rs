//! Stretches of a program that chatter, and what would not.

use kinetostat_chatter::{Instability, Regeneration};
use kinetostat_machining::{LoadAlongPath, Watch};
use rayon::prelude::*;

use crate::vibration::program::judge::{JudgedSite, SiteCut, Verdict, limit_at};
use crate::vibration::program::question::{ChatterQuestion, ProgramChatterError};

/// Spindle speeds that are tried, by that of the program: from, to, and how many. The first and the last are tried for those
/// beside them.
const SPEEDS: (f64, f64, usize) = (0.45, 1.55, 23);
/// Places of a stretch at which a speed is tried, and how many more of its lines that do not chatter as programmed.
const TRIED: usize = 6;
const TRIED_BESIDE: usize = 3;
/// Change of a feed, share of it, up to which it is one.
const SAME_FEED: f64 = 2e-3;
/// Stretches for which other speeds are looked for; the worst ones.
const MOST: usize = 12;

/// Lines in a row that chatter with one spindle speed.
#[derive(Clone, Debug, PartialEq)]
pub struct ChatterStretch {
    /// First and last line, from 1.
    pub lines: [usize; 2],
    /// From where to where along the path, mm.
    pub path_mm: [f64; 2],
    /// Speed of the program, rpm.
    pub rpm: f64,
    /// Largest depth of the program there, mm.
    pub depth_mm: f64,
    /// Depth that does not chatter anywhere there at this speed, mm.
    pub stable_depth_mm: f64,
    /// Another spindle speed; `None` where of those from half to one and a half times that of the program, in steps of 5 % of
    /// it, none is stable.
    pub stable_speed: Option<StableSpeed>,
    /// Whether speeds were tried: they are for the worst stretches.
    pub speeds_tried: bool,
    /// Of the worst place: frequency of the chatter at its limit, Hz, and how it begins.
    pub chatter_hz: f64,
    /// Flip or Hopf.
    pub kind: Instability,
}

/// A spindle speed at which the depths of the program, with its feeds per tooth, do not chatter at the places that were tried.
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

/// Stretches of places that chatter, in the order of the path.
pub(crate) fn stretches(
    question: &ChatterQuestion<'_>,
    load: &LoadAlongPath<'_>,
    judged: &[JudgedSite],
    watch: &dyn Watch,
) -> Result<Vec<ChatterStretch>, ProgramChatterError> {
    let mut all: Vec<(ChatterStretch, Vec<&JudgedSite>)> = Vec::new();
    let mut goes_on = false;
    for site in judged {
        let (Verdict::Chatters, Some(limit_mm), Some(chatter_hz), Some(kind)) =
            (&site.verdict, site.limit_mm, site.chatter_hz, site.kind)
        else {
            goes_on = false;
            continue;
        };
        let station = &site.site.station;
        let own = all
            .last_mut()
            .filter(|(s, _)| goes_on && s.rpm == station.rpm);
        goes_on = true;
        match own {
            Some((stretch, sites)) => {
                stretch.lines[1] = site.site.line;
                stretch.path_mm[1] = site.site.path_mm;
                stretch.depth_mm = kinetostat::number::larger(stretch.depth_mm, station.depth_mm);
                if limit_mm < stretch.stable_depth_mm {
                    (stretch.stable_depth_mm, stretch.chatter_hz, stretch.kind) =
                        (limit_mm, chatter_hz, kind);
                }
                sites.push(site);
            }
            None => all.push((
                ChatterStretch {
                    lines: [site.site.line; 2],
                    path_mm: [site.site.path_mm; 2],
                    rpm: station.rpm,
                    depth_mm: station.depth_mm,
                    stable_depth_mm: limit_mm,
                    stable_speed: None,
                    speeds_tried: false,
                    chatter_hz,
                    kind,
                },
                vec![site],
            )),
        }
    }
    let mut order: Vec<usize> = (0..all.len()).collect();
    let share = |i: &usize| all[*i].0.stable_depth_mm / all[*i].0.depth_mm;
    order.sort_by(|a, b| share(a).total_cmp(&share(b)));
    order.truncate(MOST);
    watch.stage("other spindle speeds", order.len());
    for (done, i) in order.into_iter().enumerate() {
        if watch.cancelled() {
            return Err(ProgramChatterError::Cancelled);
        }
        let (stretch, sites) = &mut all[i];
        // At another speed other places of the same lines may chatter.
        let [first, last] = stretch.lines;
        let is_beside = |site: &&JudgedSite| {
            site.verdict == Verdict::Stable
                && (first..=last).contains(&site.site.line)
                && site.site.station.rpm == stretch.rpm
        };
        let beside: Vec<&JudgedSite> = judged.iter().filter(is_beside).collect();
        stretch.stable_speed = stable_speed(question, load, stretch.rpm, (sites, &beside))?;
        stretch.speeds_tried = true;
        watch.advance(done + 1);
    }
    Ok(all.into_iter().map(|(stretch, _)| stretch).collect())
}

/// The speed nearest to that of the program which is stable with its neighbours at places of a stretch; else the one with the
/// largest limit.
fn stable_speed(
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
    let tried = some_of(sites, TRIED).chain(some_of(beside, TRIED_BESIDE));
    let mut cuts = Vec::new();
    for judged in tried {
        let Ok(SiteCut { regeneration, .. }) = question.site_cut(load, &judged.site)? else {
            continue;
        };
        let depth = 1e-3 * judged.site.station.depth_mm;
        let still = speeds.par_iter().zip(&mut stable).filter(|(_, s)| **s);
        still.for_each(|(speed, is_stable)| {
            // Where no multiplier is found nothing is known to be stable.
            let found = limit_at(&regeneration, *speed, depth, false);
            *is_stable = found.is_ok_and(|found| found.limit().is_none());
        });
        cuts.push((regeneration, depth));
    }
    let offered = 1..count - 1;
    let apart = |k: &usize| (speeds[*k] - rpm).abs();
    let has_room = |k: &usize| stable[k - 1] && stable[*k] && stable[k + 1];
    let nearest = offered.clone().filter(has_room);
    let nearest = nearest.min_by(|a, b| apart(a).total_cmp(&apart(b)));
    let found = match nearest {
        Some(k) => Some((speeds[k], false)),
        None => {
            let alone: Vec<f64> = offered.filter(|k| stable[*k]).map(|k| speeds[k]).collect();
            let largest = match alone[..] {
                // One needs no comparison.
                [] | [_] => alone.first().copied(),
                _ => (alone.par_iter().map(|speed| (room(&cuts, *speed), *speed)))
                    .collect::<Vec<_>>()
                    .into_iter()
                    .reduce(|a, b| if b.0 > a.0 { b } else { a })
                    .map(|(_, speed)| speed),
            };
            largest.map(|speed| (speed, true))
        }
    };
    let Some((stable_rpm, is_narrow)) = found else {
        return Ok(None);
    };
    Ok(Some(StableSpeed {
        rpm: stable_rpm,
        is_narrow,
        feed_mm_per_min: feed(question, sites, stable_rpm)?,
    }))
}

/// About so many places of some, evenly; the last one, too: the machine stands otherwise there.
fn some_of<'a, 's>(
    sites: &'a [&'s JudgedSite],
    most: usize,
) -> impl Iterator<Item = &'s JudgedSite> + use<'a, 's> {
    let step = sites.len().div_ceil(most).max(1);
    let chosen = sites.iter().enumerate();
    let chosen = chosen.filter(move |(k, _)| k.is_multiple_of(step) || k + 1 == sites.len());
    chosen.map(|(_, site)| *site)
}

/// Least limit by its depth of the cuts at a speed, as far as it is looked for.
fn room(cuts: &[(Regeneration, f64)], rpm: f64) -> f64 {
    let of = |(regeneration, depth): &(Regeneration, f64)| {
        let found = limit_at(regeneration, rpm, *depth, true);
        found.map_or(0.0, |found| {
            let limit = found.limit().map(|crossing| crossing.depth);
            limit.unwrap_or(found.up_to) / depth
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
