//! Stretches of a program that chatter, and what would not.

use kinetostat_chatter::Instability;
use kinetostat_machining::Watch;

use crate::vibration::program::judged::{JudgedSite, Verdict};
use crate::vibration::program::question::ProgramChatterError;
use crate::vibration::program::speeds::{OtherSpeeds, StableSpeed};

/// Stretches for which other speeds are looked for; the worst ones.
const MOST: usize = 12;

/// Lines in a row that chatter with one spindle speed.
#[derive(Clone, Debug, PartialEq)]
pub struct ChatterStretch {
    /// First and last line, from 1.
    pub lines: [usize; 2],
    /// Start and end along the path, mm.
    pub path_mm: [f64; 2],
    /// Speed of the program, rpm.
    pub rpm: f64,
    /// Largest depth of the program there, mm.
    pub depth_mm: f64,
    /// Depth that does not chatter anywhere there at this speed, mm.
    pub stable_depth_mm: f64,
    /// Stable spindle speed; `None` if none is stable among those from half to one and a half times that of the
    /// program, in steps of 5 % of it.
    pub stable_speed: Option<StableSpeed>,
    /// True if speeds were tried, which is done for the worst stretches.
    pub speeds_tried: bool,
    /// Chatter frequency of the worst place at its limit, Hz.
    pub chatter_hz: f64,
    /// Flip or Hopf.
    pub kind: Instability,
}

/// Stretches of places that chatter, in the order of the path.
pub(crate) fn stretches(
    speeds: &OtherSpeeds<'_, '_, '_>,
    judged: &[JudgedSite],
    watch: &dyn Watch,
    advance: &dyn Fn(f64),
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
    let tried = order.len();
    for (done, i) in order.into_iter().enumerate() {
        if watch.cancelled() {
            return Err(ProgramChatterError::Cancelled);
        }
        let (stretch, sites) = &mut all[i];
        // Other places of the same lines may chatter at another speed.
        let [first, last] = stretch.lines;
        let is_beside = |site: &&JudgedSite| {
            site.verdict == Verdict::Stable
                && (first..=last).contains(&site.site.line)
                && site.site.station.rpm == stretch.rpm
        };
        let beside: Vec<&JudgedSite> = judged.iter().filter(is_beside).collect();
        stretch.stable_speed = speeds.stable_speed(stretch.rpm, sites, &beside)?;
        stretch.speeds_tried = true;
        advance((done + 1) as f64 / tried as f64);
    }
    Ok(all.into_iter().map(|(stretch, _)| stretch).collect())
}
