//! Stretches of a program that chatter, and what would not.

use kinetostat_chatter::Instability;
use kinetostat_machining::{LoadAlongPath, Watch};
use rayon::prelude::*;

use crate::vibration::program::judge::{JudgedSite, Limit, SiteCut, Verdict};
use crate::vibration::program::question::{ChatterQuestion, ProgramChatterError};

/// Spindle speeds that are tried, by that of the program: from, to, and how many.
const SPEEDS: (f64, f64, usize) = (0.5, 1.5, 21);
/// Places of a stretch at which a speed is tried.
const TRIED: usize = 6;
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
    /// Spindle speed nearest to that of the program at which the depths of the program do not chatter at the places that were
    /// tried, rpm, with the speeds beside it stable as well; `None` where there is none within half and one and a half times.
    pub stable_rpm: Option<f64>,
    /// Whether speeds were tried: they are for the worst stretches.
    pub speeds_tried: bool,
    /// Of the worst place: frequency of the chatter at its limit, Hz, and how it begins.
    pub chatter_hz: f64,
    /// Flip or Hopf.
    pub kind: Instability,
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
                    stable_rpm: None,
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
        stretch.stable_rpm = stable_rpm(question, load, stretch.rpm, sites)?;
        stretch.speeds_tried = true;
        watch.advance(done + 1);
    }
    Ok(all.into_iter().map(|(stretch, _)| stretch).collect())
}

/// The speed nearest to that of the program which is stable at places of a stretch.
fn stable_rpm(
    question: &ChatterQuestion<'_>,
    load: &LoadAlongPath<'_>,
    rpm: f64,
    sites: &[&JudgedSite],
) -> Result<Option<f64>, ProgramChatterError> {
    let (from, to, count) = SPEEDS;
    let speeds: Vec<f64> = (0..count)
        .map(|k| rpm * (from + (to - from) * k as f64 / (count - 1) as f64))
        .collect();
    let mut stable = vec![true; count];
    let step = sites.len().div_ceil(TRIED);
    // The last place, too: the machine stands otherwise there.
    let tried = sites.iter().step_by(step).chain(sites.last());
    for judged in tried {
        let site = &judged.site;
        let Ok(SiteCut { regeneration, .. }) = question.site_cut(load, site)? else {
            continue;
        };
        let depth = 1e-3 * site.station.depth_mm;
        let still = speeds.par_iter().zip(&mut stable).filter(|(_, s)| **s);
        still.for_each(|(speed, is_stable)| {
            // Where no multiplier is found nothing is known to be stable.
            let found = Limit::of(&regeneration, *speed, depth, 1.0);
            *is_stable = found.is_ok_and(|found| found.limit.is_none());
        });
    }
    let alone = |k: usize| {
        let beside = [k.checked_sub(1), Some(k + 1)];
        let mut known = beside.into_iter().flatten().filter_map(|i| stable.get(i));
        !known.all(|beside| *beside)
    };
    let good = (0..count).filter(|k| stable[*k] && !alone(*k));
    Ok(good
        .min_by(|a, b| {
            (speeds[*a] - rpm)
                .abs()
                .total_cmp(&(speeds[*b] - rpm).abs())
        })
        .map(|k| speeds[k]))
}
