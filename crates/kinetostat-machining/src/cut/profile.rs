//! Forces along a path: stations of all moves, and the load between them.

use kinetostat::Wrench;
use kinetostat::number::larger;
use kinetostat_cutting::SpindleCurve;

use crate::cut::finding::CutFinding;
use crate::cut::question::CutQuestion;
use crate::cut::station::CutStation;
use crate::profile::by_move::{ByMove, Profile};
use crate::profile::reduced::reduced;

/// A part of the largest force or moment that does not matter.
const NEGLIGIBLE: f64 = 0.005;

/// The force of the cut along a path.
#[derive(Clone, Debug)]
pub struct ForceAlongPath {
    stations: ByMove<CutStation>,
    /// Those between which the load is linear.
    vertices: Profile<6>,
    scale: Scale,
    resolution_mm: f64,
    largest: Wrench,
    spindle: Option<SpindleCurve>,
    spread: f64,
    /// What no such cut should be.
    pub findings: Vec<CutFinding>,
}

impl ForceAlongPath {
    /// Of the stations of each move, in the order of the path.
    pub(crate) fn of(moves: Vec<Vec<CutStation>>, findings: Vec<CutFinding>) -> Self {
        let (mut force, mut moment, mut largest) = (0.0, 0.0, Wrench::zero());
        for station in moves.iter().flatten() {
            moment = larger(moment, station.wrench.moment().norm());
            if station.wrench.force().norm() > force {
                force = station.wrench.force().norm();
                largest = station.wrench;
            }
        }
        let scale = Scale { force, moment };
        let (mut stations, mut vertices) = (ByMove::new(), ByMove::new());
        for own in moves {
            let all: Vec<_> = own.iter().map(|s| (s.share, s.wrench.0.into())).collect();
            vertices.push(scale.needed(&all));
            stations.push(own);
        }
        Self {
            stations,
            vertices,
            scale,
            resolution_mm: 0.0,
            largest,
            spindle: None,
            spread: 0.0,
            findings,
        }
    }

    /// With what the question says of the spindle and of how far the forces may be off.
    pub(crate) fn asked(self, question: &CutQuestion) -> Self {
        let spreads = question.tools.iter().map(|tool| tool.spread);
        Self {
            spindle: question.spindle.clone(),
            spread: spreads.fold(0.0, larger),
            ..self
        }
    }

    /// Half width of the band in which the forces lie, as a share of them: the largest of the tools.
    #[must_use]
    pub fn spread(&self) -> f64 {
        self.spread
    }

    /// What the spindle can; `None` where it is not stated.
    #[must_use]
    pub fn spindle(&self) -> Option<&SpindleCurve> {
        self.spindle.as_ref()
    }

    /// Stations of a move; none where it does not cut.
    #[must_use]
    pub fn stations(&self, move_index: usize) -> &[CutStation] {
        self.stations.of(move_index)
    }

    /// The wrench with the largest force, in axes of the feed.
    #[must_use]
    pub fn largest(&self) -> Wrench {
        self.largest
    }

    /// Force (N) and moment (N m) on the tool's tip at a share of a move: x along the feed, z along the part's z, y to the left.
    #[must_use]
    pub fn wrench(&self, move_index: usize, share: f64) -> Wrench {
        let value = self.vertices.at(move_index, share);
        value.map_or_else(Wrench::zero, |value| Wrench(value.into()))
    }

    /// Shares inside a move at which the load has another slope.
    #[must_use]
    pub fn breaks(&self, move_index: usize) -> Vec<f64> {
        self.vertices.breaks(move_index).collect()
    }

    pub(crate) fn vertices(&self) -> &Profile<6> {
        &self.vertices
    }

    /// The same of forces whose places are known to within a length, mm: the size of a cell; infinite where an engagement was
    /// stated and nobody knows where in a block it begins.
    pub(crate) fn with_resolution_mm(self, resolution_mm: f64) -> Self {
        Self {
            resolution_mm,
            ..self
        }
    }

    /// Length within which the places of the forces are known, mm.
    pub(crate) fn resolution_mm(&self) -> f64 {
        self.resolution_mm
    }

    pub(crate) fn scale(&self) -> Scale {
        self.scale
    }
}

/// The largest force (N) and moment (N m) along a path.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scale {
    pub force: f64,
    pub moment: f64,
}

impl Scale {
    /// Size of a wrench; 1 where it is no longer negligible.
    pub fn size(&self, wrench: &[f64; 6]) -> f64 {
        let wrench = Wrench((*wrench).into());
        let relative = |size: f64, largest: f64| match size > 0.0 {
            true => size / (NEGLIGIBLE * largest),
            false => 0.0,
        };
        larger(
            relative(wrench.force().norm(), self.force),
            relative(wrench.moment().norm(), self.moment),
        )
    }

    /// The vertices without which the load would be another.
    pub fn needed(&self, vertices: &[(f64, [f64; 6])]) -> Vec<(f64, [f64; 6])> {
        reduced(vertices, |off| self.size(off))
    }
}
