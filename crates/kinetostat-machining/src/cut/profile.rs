//! Forces along a path: stations of all moves, and the load between them.

use kinetostat::Wrench;
use kinetostat::number::larger;
use kinetostat_cutting::SpindleCurve;
use serde::{Deserialize, Serialize};

use crate::cut::finding::CutFinding;
use crate::cut::measured_stations::MeasuredReport;
use crate::cut::question::CutQuestion;
use crate::cut::station::CutStation;
use crate::profile::{ByMove, Profile, between, reduced};

/// The force of the cut along a path.
#[derive(Clone, Debug)]
pub struct ForceAlongPath {
    stations: ByMove<CutStation>,
    /// Stations between which the load is linear.
    vertices: Vertices,
    /// Stations in axes of the part, for forces that were measured in them: these do not turn with the feed at corners.
    in_part: Option<Vertices>,
    resolution_mm: f64,
    largest: Wrench,
    spindle: Option<SpindleCurve>,
    spread: f64,
    /// Warnings about cuts.
    pub findings: Vec<CutFinding>,
    /// Processing of forces that were measured; `None` for computed ones.
    pub measured: Option<MeasuredReport>,
}

impl ForceAlongPath {
    /// Forces from the stations of each move, in the order of the path.
    pub(crate) fn of(moves: Vec<Vec<CutStation>>, findings: Vec<CutFinding>) -> Self {
        let vertices = Vertices::of(&moves);
        let largest = moves.iter().flatten().map(|station| station.wrench);
        let largest = largest.max_by(|a, b| a.force().norm().total_cmp(&b.force().norm()));
        let mut stations = ByMove::new();
        for own in moves {
            stations.push(own);
        }
        Self {
            stations,
            vertices,
            in_part: None,
            resolution_mm: 0.0,
            largest: largest.unwrap_or_else(Wrench::zero),
            spindle: None,
            spread: 0.0,
            findings,
            measured: None,
        }
    }

    /// Forces from measured stations, with those in axes of the part if they were measured there.
    pub(crate) fn of_measured(
        moves: Vec<Vec<CutStation>>,
        in_part: Option<&[Vec<CutStation>]>,
        findings: Vec<CutFinding>,
        report: MeasuredReport,
    ) -> Self {
        let in_part = in_part.map(Vertices::of);
        Self {
            in_part,
            measured: Some(report),
            ..Self::of(moves, findings)
        }
    }

    /// The forces on another path over the same way: of each of its moves the move here that it is a part of, and the shares of that
    /// (by length) from which to which it goes. Warnings keep the lines of this path.
    ///
    /// ```
    /// use kinetostat_cutting::{ForceLog, LoggedBy};
    /// use kinetostat_machining::{ActsOn, MeasuredForces, Unwatched};
    /// use kinetostat_program::{Program, ReadOptions, interpret};
    ///
    /// // A force against the feed that grows from 0 to 40 N over 40 mm.
    /// let path = interpret(&Program::read("G21 G90\nG0 X0 Y0 Z0\nG1 X40 F600\n")?, &ReadOptions::default())?;
    /// let along = vec![0.0, 40.0];
    /// let log = ForceLog::new(LoggedBy::AlongPath, along, [vec![0.0, -40.0], vec![0.0; 2], vec![0.0; 2]], None)?;
    /// let mut measured = MeasuredForces::new(log, ActsOn::Tool);
    /// measured.smooth = Some(0.0);
    /// let forces = measured.along(&path, &Unwatched)?;
    /// // The same way in two lines.
    /// let other = forces.on_parts(&[(0, [0.0, 1.0]), (1, [0.0, 0.25]), (1, [0.25, 1.0])]);
    /// assert!((other.wrench(1, 0.5).force().x + 5.0).abs() < 1e-9);
    /// assert!((other.wrench(2, 0.5).force().x + 25.0).abs() < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn on_parts(&self, parts: &[(usize, [f64; 2])]) -> Self {
        let own = parts.iter();
        let moves = own.map(|(index, span)| of_stations(self.stations.of(*index), *span));
        let in_part = self.in_part.as_ref().map(|vertices| {
            let all = parts
                .iter()
                .map(|(index, span)| of_stations(&as_stations(&vertices.profile, *index), *span));
            Vertices::of(&all.collect::<Vec<_>>())
        });
        Self {
            in_part,
            measured: self.measured.clone(),
            resolution_mm: self.resolution_mm,
            spindle: self.spindle.clone(),
            spread: self.spread,
            ..Self::of(moves.collect(), self.findings.clone())
        }
    }

    /// Origin of the forces, computed or measured.
    #[must_use]
    pub fn origin(&self) -> ForceOrigin {
        match self.measured {
            Some(_) => ForceOrigin::Measured,
            None => ForceOrigin::Computed,
        }
    }

    /// Adds the spindle of the question, and the spread of its forces.
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

    /// Torque curve of the spindle; `None` if it is not stated.
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
        let value = self.vertices.profile.at(move_index, share);
        value.map_or_else(Wrench::zero, |value| Wrench(value.into()))
    }

    /// Shares inside a move at which the load has another slope.
    #[must_use]
    pub fn breaks(&self, move_index: usize) -> Vec<f64> {
        self.of_load().0.profile.breaks(move_index).collect()
    }

    /// The vertices of the load, and the axes of its wrenches.
    pub(crate) fn of_load(&self) -> (&Vertices, CutAxes) {
        match &self.in_part {
            Some(in_part) => (in_part, CutAxes::Part),
            None => (&self.vertices, CutAxes::Feed),
        }
    }

    /// Forces whose places are known to within a length, mm: the size of a cell; infinite if an engagement was stated and its
    /// distance from a rapid is unknown.
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
}

/// Axes of the load of a cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum CutAxes {
    /// Axes of the feed: they turn with it at corners.
    Feed,
    /// Axes of the part.
    Part,
}

/// The stations of a part of a move, by shares of the part; jumps at its ends belong to what is outside.
fn of_stations(stations: &[CutStation], [from, to]: [f64; 2]) -> Vec<CutStation> {
    let (Some(first), Some(last)) = (stations.first(), stations.last()) else {
        return Vec::new();
    };
    let after = stations.partition_point(|station| station.share <= from);
    let before = after.checked_sub(1).and_then(|index| stations.get(index));
    let begin = at(from, before.unwrap_or(first), stations.get(after), before);
    let next = stations.partition_point(|station| station.share < to);
    let left = next.checked_sub(1).and_then(|index| stations.get(index));
    let right = stations.get(next);
    let end = at(to, left.unwrap_or(first), right, right.or(Some(last)));
    let mut part = vec![CutStation {
        share: 0.0,
        ..begin
    }];
    let inner = stations.get(after..next).unwrap_or_default();
    part.extend(inner.iter().map(|station| CutStation {
        share: (station.share - from) / (to - from),
        ..*station
    }));
    part.push(CutStation { share: 1.0, ..end });
    part
}

/// Wrench at a share between two stations; all other values are those of `like`.
fn at(
    share: f64,
    before: &CutStation,
    after: Option<&CutStation>,
    like: Option<&CutStation>,
) -> CutStation {
    let like = *like.unwrap_or(before);
    match after {
        Some(after) if after.share > before.share => {
            let part = ((share - before.share) / (after.share - before.share)).clamp(0.0, 1.0);
            let wrench = between(&before.wrench.0.into(), &after.wrench.0.into(), part);
            CutStation {
                wrench: kinetostat::Wrench(wrench.into()),
                ..like
            }
        }
        _ => CutStation {
            wrench: before.wrench,
            ..like
        },
    }
}

/// The wrenches of a move as stations.
fn as_stations(profile: &Profile<6>, move_index: usize) -> Vec<CutStation> {
    let vertices = profile.of(move_index).iter();
    vertices
        .map(|(share, wrench)| CutStation {
            wrench: kinetostat::Wrench((*wrench).into()),
            ..CutStation::air(*share)
        })
        .collect()
}

/// Origin of forces along a path.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ForceOrigin {
    /// Computed from material, tool and engagement.
    #[default]
    Computed,
    /// Measured on the machine.
    Measured,
}

/// A part of the largest force or moment that does not matter.
const NEGLIGIBLE: f64 = 0.005;

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

/// The load along a path by its vertices.
#[derive(Clone, Debug)]
pub(crate) struct Vertices {
    pub profile: Profile<6>,
    pub scale: Scale,
}

impl Vertices {
    pub fn of(moves: &[Vec<CutStation>]) -> Self {
        let wrenches = || moves.iter().flatten().map(|station| station.wrench);
        let force = wrenches().map(|wrench| wrench.force().norm());
        let moment = wrenches().map(|wrench| wrench.moment().norm());
        let scale = Scale {
            force: force.fold(0.0, larger),
            moment: moment.fold(0.0, larger),
        };
        let mut profile = ByMove::new();
        for own in moves {
            let all: Vec<_> = own.iter().map(|s| (s.share, s.wrench.0.into())).collect();
            profile.push(scale.needed(&all));
        }
        Self { profile, scale }
    }
}
