//! Forces along a path: stations of all moves, and the load between them.

use kinetostat::Wrench;
use kinetostat::number::larger;

use crate::cut::finding::CutFinding;
use crate::cut::measured_report::MeasuredReport;
use crate::cut::origin::ForceOrigin;
use crate::cut::station::CutStation;

/// Vertices of the load are left out where the others give it within this share of the largest force.
const NEGLIGIBLE: f64 = 0.005;

/// Lists, one for each move, in one piece of memory.
#[derive(Clone, Debug)]
struct ByMove<T> {
    all: Vec<T>,
    /// Where the list of each move begins; one more than there are moves.
    first: Vec<usize>,
}

impl<T> ByMove<T> {
    fn new() -> Self {
        Self {
            all: Vec::new(),
            first: vec![0],
        }
    }

    /// The list of the next move.
    fn push(&mut self, list: impl IntoIterator<Item = T>) {
        self.all.extend(list);
        self.first.push(self.all.len());
    }

    fn of(&self, move_index: usize) -> &[T] {
        match self.first.get(move_index..move_index + 2) {
            Some(&[from, to]) => &self.all[from..to],
            _ => &[],
        }
    }
}

/// The force of the cut along a path.
#[derive(Clone, Debug)]
pub struct ForceAlongPath {
    stations: ByMove<CutStation>,
    /// Those between which the load is linear.
    vertices: ByMove<(f64, Wrench)>,
    /// The same in axes of the part, for forces that were measured in them: these do not turn with the feed at corners.
    in_part: Option<ByMove<(f64, Wrench)>>,
    largest: Wrench,
    /// What no such cut should be.
    pub findings: Vec<CutFinding>,
    /// What was done to forces that were measured; `None` for computed ones.
    pub measured: Option<MeasuredReport>,
}

impl ForceAlongPath {
    /// Of the stations of each move, in the order of the path.
    pub(crate) fn of(moves: Vec<Vec<CutStation>>, findings: Vec<CutFinding>) -> Self {
        let (largest, tolerance) = largest_of(&moves);
        let vertices = all_essential(&moves, tolerance);
        let mut stations = ByMove::new();
        for own in moves {
            stations.push(own);
        }
        Self {
            stations,
            vertices,
            in_part: None,
            largest,
            findings,
            measured: None,
        }
    }

    /// Of stations that were measured, with those in axes of the part where that is how they were measured.
    pub(crate) fn of_measured(
        moves: Vec<Vec<CutStation>>,
        in_part: Option<&[Vec<CutStation>]>,
        findings: Vec<CutFinding>,
        report: MeasuredReport,
    ) -> Self {
        let in_part = in_part.map(|moves| all_essential(moves, largest_of(moves).1));
        Self {
            in_part,
            measured: Some(report),
            ..Self::of(moves, findings)
        }
    }

    /// Whether it was computed or measured.
    #[must_use]
    pub fn origin(&self) -> ForceOrigin {
        match self.measured {
            Some(_) => ForceOrigin::Measured,
            None => ForceOrigin::Computed,
        }
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
        between(self.vertices.of(move_index), share)
    }

    /// The same in axes of the part, where it was measured in them.
    pub(crate) fn wrench_in_part(&self, move_index: usize, share: f64) -> Option<Wrench> {
        let in_part = self.in_part.as_ref()?;
        Some(between(in_part.of(move_index), share))
    }

    /// Shares inside a move at which the load has another slope.
    #[must_use]
    pub fn breaks(&self, move_index: usize) -> Vec<f64> {
        let vertices = self.in_part.as_ref().unwrap_or(&self.vertices);
        let inside = vertices.of(move_index).iter().map(|(at, _)| *at);
        inside.filter(|at| *at > 0.0 && *at < 1.0).collect()
    }
}

/// The load between vertices; that of the first before it, and of the last behind it.
fn between(vertices: &[(f64, Wrench)], share: f64) -> Wrench {
    let after = vertices.partition_point(|(at, _)| *at < share);
    match (
        after.checked_sub(1).map(|i| vertices[i]),
        vertices.get(after),
    ) {
        (None, None) => Wrench::zero(),
        (None, Some((_, wrench))) => *wrench,
        (Some((_, wrench)), None) => wrench,
        (Some((from, a)), Some(&(to, b))) => {
            let part = match to > from {
                true => (share - from) / (to - from),
                false => 1.0,
            };
            Wrench(a.0.lerp(&b.0, part))
        }
    }
}

/// The wrench with the largest force, and the forces and moments that matter no more.
fn largest_of(moves: &[Vec<CutStation>]) -> (Wrench, [f64; 2]) {
    let (mut force, mut moment, mut largest) = (0.0, 0.0, Wrench::zero());
    for station in moves.iter().flatten() {
        moment = larger(moment, station.wrench.moment().norm());
        if station.wrench.force().norm() > force {
            force = station.wrench.force().norm();
            largest = station.wrench;
        }
    }
    (largest, [NEGLIGIBLE * force, NEGLIGIBLE * moment])
}

fn all_essential(moves: &[Vec<CutStation>], [force, moment]: [f64; 2]) -> ByMove<(f64, Wrench)> {
    let mut vertices = ByMove::new();
    for own in moves {
        vertices.push(essential(own, force, moment));
    }
    vertices
}

/// The stations that the load needs (Ramer, Douglas and Peucker): the others lie within the tolerances of it.
fn essential(stations: &[CutStation], force: f64, moment: f64) -> Vec<(f64, Wrench)> {
    let Some(first) = stations.first() else {
        return Vec::new();
    };
    let mut vertices = vec![(first.share, first.wrench)];
    // Spans that are still to be looked at, the first on top.
    let mut open = vec![(0, stations.len() - 1)];
    while let Some((from, to)) = open.pop() {
        let (a, b) = (&stations[from], &stations[to]);
        let mut worst = (1.0, 0);
        for i in from + 1..to {
            let s = &stations[i];
            let part = match b.share > a.share {
                true => (s.share - a.share) / (b.share - a.share),
                false => 0.0,
            };
            let off = Wrench(s.wrench.0 - a.wrench.0.lerp(&b.wrench.0, part));
            let relative = |off: f64, tolerance: f64| if off > 0.0 { off / tolerance } else { 0.0 };
            let size = larger(
                relative(off.force().norm(), force),
                relative(off.moment().norm(), moment),
            );
            if size > worst.0 {
                worst = (size, i);
            }
        }
        match worst.1 {
            0 if to > from => vertices.push((b.share, b.wrench)),
            0 => {}
            middle => open.extend([(middle, to), (from, middle)]),
        }
    }
    vertices
}
