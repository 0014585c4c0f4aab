//! The question of chatter along a program, and groups of places whose cuts and postures are alike.

use std::ops::Range;

use kinetostat::Pose;
use kinetostat_chatter::{ChatterError, Swinging};
use kinetostat_dynamics::{Damping, Error};
use kinetostat_machining::{CutFailure, CutQuestion, CuttingTool, ForceAlongPath, Task};
use nalgebra::Vector3;

use crate::vibration::program::site::{CutSite, SAME_ANGLE, SiteGroup, is_alike};

/// A machine that cuts along a program, and how it is damped.
#[derive(Clone, Copy)]
pub struct ChatterQuestion<'a> {
    /// Machine, program, placement and load.
    pub task: &'a Task<'a>,
    /// Forces of its cuts.
    pub forces: &'a ForceAlongPath,
    /// Tools with their laws of force.
    pub cut: &'a CutQuestion,
    /// Law of damping of the machine.
    pub damping: &'a Damping,
    /// Selection of the modes kept dynamic; the others enter as residual flexibility.
    pub swinging: Swinging,
    /// Places farther apart than this are judged by themselves, mm.
    pub every_mm: f64,
    /// Maximum number of places that are judged.
    pub most: usize,
}

/// Reason why there is no result.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ProgramChatterError {
    /// Error of the machine: no mass, damping, a place that it does not reach, no equilibrium.
    #[error("line {line}: {error}")]
    Machine {
        /// Line of the program, from 1.
        line: usize,
        /// Error of the machine.
        error: Error,
    },
    /// Error of the cut: a tool that is not a flat end mill, no damping, a law of force that falls.
    #[error("line {line}: {error}")]
    Cut {
        /// Line of the program, from 1.
        line: usize,
        /// Error of the stability analysis.
        error: ChatterError,
    },
    /// Error of the program's tools.
    #[error(transparent)]
    Tool(#[from] CutFailure),
    /// Stopped on request.
    #[error("stopped on request")]
    Cancelled,
}

impl ChatterQuestion<'_> {
    /// The tool of a place.
    pub(crate) fn tool_of(&self, site: &CutSite) -> Result<&CuttingTool, ProgramChatterError> {
        Ok(&self.cut.tools[self.index_of(site)?])
    }

    pub(crate) fn index_of(&self, site: &CutSite) -> Result<usize, ProgramChatterError> {
        Ok(self.cut.tool_on(self.task.path(), site.line)?)
    }
}

/// Machine and cut at the deepest place of a group.
///
/// The passes of a pocket come back to the same cuts at nearly the same places. Within a group places may lie `every_mm` apart
/// already; the same tolerances hold between groups.
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
