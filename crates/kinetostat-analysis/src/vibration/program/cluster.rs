//! Groups of places whose cuts and postures are alike, wherever they lie along the path: one of them is judged for all, unless what
//! is said hangs on it.
//!
//! The passes of a pocket come back to the same cuts at nearly the same places. Within a group places may lie `every_mm` apart
//! already; the same tolerances hold between groups.

use std::ops::Range;

use kinetostat::Pose;
use nalgebra::Vector3;

use crate::vibration::program::question::ChatterQuestion;
use crate::vibration::program::site::{CutSite, SAME_ANGLE, SiteGroup, is_alike};

/// Machine and cut at the deepest place of a group.
struct Reference<'s> {
    site: &'s CutSite,
    tool: usize,
    pose: Pose,
    /// Direction of the feed, base axes.
    feed: Vector3<f64>,
}

impl ChatterQuestion<'_> {
    /// The cluster of each group, and the groups that stand for their clusters: those with the deepest cut, of equally deep ones
    /// with the widest arc, in the order of the path of the first group of each.
    pub(crate) fn clusters(
        &self,
        all: &[CutSite],
        tools: &[usize],
        groups: &[Range<usize>],
        wider: f64,
    ) -> (Vec<usize>, Vec<usize>) {
        let (mut references, mut judged): (Vec<Reference<'_>>, Vec<usize>) =
            (Vec::new(), Vec::new());
        let mut worst: Vec<&CutSite> = Vec::new();
        let mut of_group = Vec::with_capacity(groups.len());
        for (i, range) in groups.iter().enumerate() {
            let (site, _) = SiteGroup::of(all, range.clone()).judged(1.0);
            let own = self.reference(site, tools[range.start]);
            let known = references
                .iter()
                .position(|known| self.are_alike(&own, known, wider));
            let cluster = known.unwrap_or(references.len());
            match known {
                Some(known) if site.cuts_more_than(worst[known]) => {
                    (worst[known], judged[known]) = (site, i);
                }
                Some(_) => {}
                None => {
                    references.push(own);
                    judged.push(i);
                    worst.push(site);
                }
            }
            of_group.push(cluster);
        }
        (of_group, judged)
    }

    fn reference<'s>(&self, site: &'s CutSite, tool: usize) -> Reference<'s> {
        let motion = &self.task.path().moves[site.move_index];
        let placement = self.task.placement.on(motion, site.station.share);
        let orientation = placement.orientation_on(motion, site.station.share);
        Reference {
            site,
            tool,
            pose: placement.pose(&site.position_mm, orientation),
            feed: placement.to_base_axes(&site.direction),
        }
    }

    fn are_alike(&self, a: &Reference<'_>, b: &Reference<'_>, wider: f64) -> bool {
        let apart_mm = 1e3 * (a.pose.translation.vector - b.pose.translation.vector).norm();
        a.tool == b.tool
            && is_alike(a.site, b.site, wider)
            && apart_mm <= self.every_mm * wider
            && a.feed.angle(&b.feed) <= SAME_ANGLE * wider
            && a.pose.rotation.angle_to(&b.pose.rotation) <= SAME_ANGLE * wider
    }
}
