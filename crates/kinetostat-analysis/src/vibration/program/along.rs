//! All cuts along a program, judged, with the stretches that chatter, and the result as plain data for reports and files.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};

use kinetostat::number::smaller;
use kinetostat_chatter::{Instability, LeftOut};
use kinetostat_machining::{ChatterLines, ChatterPlace, ChatterResult, LoadAlongPath, Watch};
use rayon::prelude::*;

use crate::vibration::program::judged::{JudgedSite, Verdict};
use crate::vibration::program::question::{ChatterQuestion, ProgramChatterError};
use crate::vibration::program::site::{SiteGroup, WithoutSide, groups, sites};
use crate::vibration::program::speeds::{OtherSpeeds, StableSpeed};

/// Share of the work that other spindle speeds are reckoned with: one in so many of the judged cuts.
const SPEEDS_SHARE: usize = 3;
/// Share of the work on cuts near their limit: one in so many of the judged cuts.
const NEAR_SHARE: usize = 3;

/// Chatter of a program along its path.
#[derive(Clone, Debug, PartialEq)]
pub struct ProgramChatter {
    /// All places that were judged, in the order of the path.
    pub sites: Vec<JudgedSite>,
    /// Stretches of the program that chatter.
    pub stretches: Vec<ChatterStretch>,
    /// Places of the program at which the tool cuts; each stands in one group with those like it.
    pub places: usize,
    /// Places at which a force acts and the side of the tool is not in the cut.
    pub without_side: Option<WithoutSide>,
    /// Factor on the usual tolerances of a group, so that the groups do not exceed the requested number; 1 by default.
    pub wider: f64,
}

impl ChatterQuestion<'_> {
    /// Judges the cuts along the program, on all cores.
    ///
    /// # Errors
    /// [`ProgramChatterError`], the first in the order of the program.
    pub fn along(&self, watch: &dyn Watch) -> Result<ProgramChatter, ProgramChatterError> {
        let all = sites(self.forces, self.task.path());
        let tools: Vec<usize> = all
            .iter()
            .map(|s| self.index_of(s))
            .collect::<Result<_, _>>()?;
        let (groups, wider) = groups(&all, &tools, self.every_mm, self.most);
        let load = LoadAlongPath::with_tools(self.task.load, self.task.path(), self.task.tools)
            .with_cut(self.task.cut);
        let (cluster_of, judged) = self.clusters(&all, &tools, &groups, wider);
        let of_near = judged.len().div_ceil(NEAR_SHARE);
        let of_speeds = judged.len().div_ceil(SPEEDS_SHARE);
        watch.stage("chatter", judged.len() + of_near + of_speeds);
        let judge_all = |list: &[usize], from: usize, of: usize| {
            let done = AtomicUsize::new(0);
            let each = list.par_iter().map(|group| {
                if watch.cancelled() {
                    return Err(ProgramChatterError::Cancelled);
                }
                let group = SiteGroup::of(&all, groups[*group].clone());
                let found = self.judge(&load, &group, wider);
                watch.advance(from + (done.fetch_add(1, Ordering::Relaxed) + 1) * of / list.len());
                found
            });
            // All of them, so that the first error is the first in the order of the program.
            let found: Vec<Result<JudgedSite, ProgramChatterError>> = each.collect();
            found.into_iter().collect::<Result<Vec<_>, _>>()
        };
        let mut found = judge_all(&judged, 0, judged.len())?;
        let line = |i: usize| all[groups[i].start].line;
        let mut least: BTreeMap<usize, f64> = BTreeMap::new();
        for (i, cluster) in cluster_of.iter().enumerate() {
            if let Some(limit_mm) = found[*cluster].limit_mm {
                let own = least.entry(line(i)).or_insert(limit_mm);
                *own = smaller(*own, limit_mm);
            }
        }
        let is_apart = |i: &usize| {
            let alike = &found[cluster_of[*i]];
            let least_mm = least.get(&line(*i)).copied().unwrap_or_default();
            judged[cluster_of[*i]] != *i && alike.is_decisive(least_mm)
        };
        let apart: Vec<usize> = (0..groups.len()).filter(is_apart).collect();
        let of_group = |(i, cluster): (usize, &usize)| {
            found[*cluster].for_group(SiteGroup::of(&all, groups[i].clone()), *cluster)
        };
        let mut judged_sites: Vec<JudgedSite> =
            cluster_of.iter().enumerate().map(of_group).collect();
        for (i, own) in apart.iter().zip(judge_all(&apart, judged.len(), of_near)?) {
            let cluster = cluster_of[*i];
            judged_sites[*i] = JudgedSite { cluster, ..own };
            // Other speeds are tried at the worst cut of each cluster.
            if judged_sites[*i].is_worse_than(&found[cluster]) {
                found[cluster] = judged_sites[*i].clone();
            }
        }
        let part = |share: f64| {
            let of_speeds = (share * of_speeds as f64) as usize;
            watch.advance(judged.len() + of_near + of_speeds);
        };
        let stretches = stretches(
            &OtherSpeeds::new(self, &load, &found),
            &judged_sites,
            watch,
            &part,
        )?;
        Ok(ProgramChatter {
            sites: judged_sites,
            stretches,
            places: all.len(),
            without_side: WithoutSide::of(self.forces, self.task.path()),
            wider,
        })
    }
}

impl ProgramChatter {
    /// Groups of places of which nothing is said, by reason, with the first line of each and how many places they are.
    #[must_use]
    pub fn not_judged(&self) -> Vec<(&str, usize, usize)> {
        let mut all: Vec<(&str, usize, usize)> = Vec::new();
        for site in &self.sites {
            let Verdict::NotJudged(why) = &site.verdict else {
                continue;
            };
            match all.iter_mut().find(|(known, _, _)| known == why) {
                Some(own) => own.2 += site.places,
                None => all.push((why, site.site.line, site.places)),
            }
        }
        all
    }

    /// Places whose contact differs with the height, of which the widest arc was taken.
    #[must_use]
    pub fn uneven(&self) -> usize {
        let of_one = |site: &&JudgedSite| {
            let contact = site.site.station.contact;
            site.is_judged() && contact.is_some_and(|c| !c.is_even)
        };
        self.sites.iter().filter(of_one).map(|s| s.places).sum()
    }

    /// Error of the response by modes with their own damping alone, at the worst place ([`JudgedSite::lost_coupling`]).
    #[must_use]
    pub fn lost_coupling(&self) -> f64 {
        let each = self.sites.iter().map(|site| site.lost_coupling);
        each.fold(0.0, kinetostat::number::larger)
    }

    /// Mode with the largest share among those treated as springs although they contribute, and its place.
    #[must_use]
    pub fn left_out(&self) -> Option<(LeftOut, &JudgedSite)> {
        let each = self.sites.iter().filter_map(|s| Some((s.left_out?, s)));
        each.max_by(|a, b| a.0.share.total_cmp(&b.0.share))
    }

    /// Frequency of the fastest mode that swings at any place, Hz; those above are springs everywhere.
    #[must_use]
    pub fn modes_up_to_hz(&self) -> Option<f64> {
        let each = self.sites.iter().filter_map(|site| site.modes_up_to_hz);
        each.max_by(f64::total_cmp)
    }

    /// The place with the least limit by its depth.
    #[must_use]
    pub fn nearest(&self) -> Option<&JudgedSite> {
        let share = |site: &JudgedSite| site.limit_mm.map(|l| l / site.site.station.depth_mm);
        let known = self
            .sites
            .iter()
            .filter_map(|site| Some((share(site)?, site)));
        known
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(_, site)| site)
    }
}

impl ProgramChatter {
    /// Converts to the form in result files, with the law of damping in words.
    #[must_use]
    pub fn result(&self, damping: String) -> ChatterResult {
        let places: Vec<ChatterPlace> = self.sites.iter().map(place).collect();
        let most = |of: fn(&ChatterPlace) -> Option<f64>| {
            let known = places.iter().filter_map(|p| Some((p, of(p)?.abs())));
            known.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(p, _)| *p)
        };
        ChatterResult {
            damping,
            places_in_cut: self.places,
            places_judged: self.sites.iter().filter(|site| site.is_judged()).count(),
            stretches: self.stretches.iter().map(lines).collect(),
            nearest: self.nearest().map(place),
            most_shaken: most(|p| p.vibration_rms_um),
            worst_wall: most(|p| p.wall_um),
            places,
        }
    }
}

fn place(judged: &JudgedSite) -> ChatterPlace {
    let (site, forced) = (&judged.site, judged.forced.as_ref());
    ChatterPlace {
        line: site.line,
        path_mm: judged.path_mm,
        rpm: site.station.rpm,
        depth_mm: site.station.depth_mm,
        chatters: match judged.verdict {
            Verdict::Stable => Some(false),
            Verdict::Chatters => Some(true),
            Verdict::NotJudged(_) => None,
        },
        limit_mm: judged.limit_mm,
        looked_up_to_mm: judged.looked_up_to_mm,
        chatter_hz: judged.chatter_hz,
        first_hz: judged.first_hz,
        modes_up_to_hz: judged.modes_up_to_hz,
        force_spread_percent: 100.0 * judged.force_spread,
        vibration_rms_um: forced.map(|f| 1e3 * f.root_mean_square_mm),
        strongest_hz: forced.map(|f| f.strongest_hz),
        nearest_mode_hz: forced.map(|f| f.nearest_mode_hz),
        wall_um: forced.and_then(|f| f.worst_wall_mm()).map(|mm| 1e3 * mm),
    }
}

fn lines(stretch: &ChatterStretch) -> ChatterLines {
    ChatterLines {
        lines: stretch.lines,
        rpm: stretch.rpm,
        depth_mm: stretch.depth_mm,
        stable_depth_mm: stretch.stable_depth_mm,
        stable_rpm: stretch.stable_speed.map(|stable| stable.rpm),
        stable_speed_is_narrow: stretch.stable_speed.is_some_and(|stable| stable.is_narrow),
        stable_feed_mm_per_min: stretch
            .stable_speed
            .and_then(|stable| stable.feed_mm_per_min),
        speeds_tried: stretch.speeds_tried,
        chatter_hz: stretch.chatter_hz,
    }
}

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
