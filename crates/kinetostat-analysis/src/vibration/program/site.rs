//! Places of a program at which the tool cuts, and which of them are alike.

use std::ops::Range;

use kinetostat_machining::{CutStation, ForceAlongPath};
use kinetostat_program::Path;
use nalgebra::Vector3;

/// Relative change of depth and feed per tooth, and change of the ends of the arc and of the heading (rad), beyond which a cut
/// is another one.
const SAME_SIZE: f64 = 0.05;
pub(crate) const SAME_ANGLE: f64 = 0.1;

/// Share of a depth by which equally deep cuts differ.
const SAME_DEPTH: f64 = 1e-6;

/// A place of a program at which the tool cuts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CutSite {
    /// Index of its move in the path.
    pub move_index: usize,
    /// Line of the program, from 1.
    pub line: usize,
    /// Length of the path up to here, mm.
    pub path_mm: f64,
    /// Place of the tip, mm, part frame.
    pub position_mm: Vector3<f64>,
    /// Unit vector along the motion, in axes of the part.
    pub direction: Vector3<f64>,
    /// The cut.
    pub station: CutStation,
}

impl CutSite {
    /// True if its cut is deeper than another, or as deep with a wider arc.
    pub(crate) fn cuts_more_than(&self, other: &Self) -> bool {
        let (own, other) = (&self.station, &other.station);
        let slack = SAME_DEPTH * other.depth_mm;
        own.depth_mm > other.depth_mm + slack
            || (own.depth_mm >= other.depth_mm - slack && own.arc > other.arc)
    }
}

/// All places with a chip, in the order of the path.
pub(crate) fn sites(forces: &ForceAlongPath, path: &Path) -> Vec<CutSite> {
    let mut all = Vec::new();
    let mut start_mm = 0.0;
    for (move_index, motion) in path.moves.iter().enumerate() {
        let length = motion.length_mm();
        let cuts = |station: &&CutStation| station.rpm > 0.0 && station.depth_mm > 0.0;
        for station in forces.stations(move_index).iter().filter(cuts) {
            let Some(direction) = motion.tangent(station.share) else {
                continue;
            };
            all.push(CutSite {
                move_index,
                line: motion.line,
                path_mm: start_mm + station.share * length,
                position_mm: motion.point(station.share),
                direction,
                station: *station,
            });
        }
        // A move without a known place adds no length.
        start_mm += if length.is_finite() { length } else { 0.0 };
    }
    all
}

/// Places at which a force acts and the side of the tool is not in the cut (a plunge, drilling): nothing is said of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WithoutSide {
    /// Number of places.
    pub places: usize,
    /// Line of the largest force, from 1.
    pub line: usize,
    /// Largest force, N.
    pub force_n: f64,
}

impl WithoutSide {
    pub(crate) fn of(forces: &ForceAlongPath, path: &Path) -> Option<Self> {
        let mut found: Option<Self> = None;
        for (i, motion) in path.moves.iter().enumerate() {
            for station in forces.stations(i) {
                let force_n = station.wrench.force().norm();
                let is_judged = station.rpm > 0.0 && station.depth_mm > 0.0;
                if force_n == 0.0 || (is_judged && motion.tangent(station.share).is_some()) {
                    continue;
                }
                let own = found.get_or_insert(Self {
                    places: 0,
                    line: motion.line,
                    force_n,
                });
                own.places += 1;
                if force_n > own.force_n {
                    (own.line, own.force_n) = (motion.line, force_n);
                }
            }
        }
        found
    }
}

/// Places that are alike, one of which is judged for all.
#[derive(Clone, Copy)]
pub(crate) struct SiteGroup<'s> {
    /// Places in the order of the path.
    sites: &'s [CutSite],
}

impl<'s> SiteGroup<'s> {
    /// Takes a non-empty range of places.
    pub fn of(all: &'s [CutSite], range: Range<usize>) -> Self {
        Self { sites: &all[range] }
    }

    /// The places that are judged for the group. Where its cuts hardly differ, the deepest (of equally deep ones that with the
    /// widest arc); where they differ by more (`wider` above 1), the one with the widest arc too, and both ends, where the machine
    /// stands otherwise.
    pub fn judged(&self, wider: f64) -> (&'s CutSite, Vec<&'s CutSite>) {
        let width = |site: &CutSite| site.station.contact.map_or(0.0, |c| c.exit - c.entry);
        let deepest = self.most(CutSite::cuts_more_than);
        let mut others: Vec<&CutSite> = Vec::new();
        if wider > 1.0 {
            let ends = [&self.sites[0], &self.sites[self.sites.len() - 1]];
            for site in [self.most(|a, b| width(a) > width(b))]
                .into_iter()
                .chain(ends)
            {
                let mut known = others.iter().copied().chain([deepest]);
                if !known.any(|known| std::ptr::eq(known, site)) {
                    others.push(site);
                }
            }
        }
        (deepest, others)
    }

    /// The first place that is more than all before it.
    fn most(&self, is_more: impl Fn(&CutSite, &CutSite) -> bool) -> &'s CutSite {
        let found = self
            .sites
            .iter()
            .reduce(|a, b| if is_more(b, a) { b } else { a });
        found.unwrap_or(&self.sites[0])
    }

    pub fn count(&self) -> usize {
        self.sites.len()
    }

    /// Start and end along the path, mm.
    pub fn path_mm(&self) -> [f64; 2] {
        [&self.sites[0], &self.sites[self.sites.len() - 1]].map(|site| site.path_mm)
    }
}

/// Places that are alike (`tools` are theirs), one range for each group: at most `most` of them, for which they may differ by more; and by how many
/// times more.
pub(crate) fn groups(
    sites: &[CutSite],
    tools: &[usize],
    every_mm: f64,
    most: usize,
) -> (Vec<Range<usize>>, f64) {
    let mut wider = 1.0;
    loop {
        let found = groups_within(sites, tools, every_mm, wider);
        // Tools and speeds alone may be more.
        if found.len() <= most || wider > 1e3 {
            return (found, wider);
        }
        wider *= 1.5;
    }
}

fn groups_within(
    sites: &[CutSite],
    tools: &[usize],
    every_mm: f64,
    wider: f64,
) -> Vec<Range<usize>> {
    let mut all = Vec::new();
    let mut first = 0;
    for (i, site) in sites.iter().enumerate() {
        let reference = &sites[first];
        let same = tools[i] == tools[first]
            && is_alike(site, reference, wider)
            && (site.position_mm - reference.position_mm).norm() <= every_mm * wider;
        if !same {
            all.push(first..i);
            first = i;
        }
    }
    if first < sites.len() {
        all.push(first..sites.len());
    }
    all
}

pub(crate) fn is_alike(site: &CutSite, reference: &CutSite, wider: f64) -> bool {
    let (a, b) = (&site.station, &reference.station);
    let size = |a: f64, b: f64| (a - b).abs() <= SAME_SIZE * wider * b.abs();
    let angle = |a: f64, b: f64| (a - b).abs() <= SAME_ANGLE * wider;
    let arcs = match (a.contact, b.contact) {
        (Some(a), Some(b)) => angle(a.entry, b.entry) && angle(a.exit, b.exit),
        (None, None) => true,
        _ => false,
    };
    arcs && a.rpm == b.rpm
        && size(a.depth_mm, b.depth_mm)
        && size(a.feed_per_tooth_mm, b.feed_per_tooth_mm)
        && site.direction.angle(&reference.direction) <= SAME_ANGLE * wider
}
