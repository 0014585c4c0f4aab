//! Forces along a path: stations of all moves, and the load between them.

use kinetostat::Wrench;
use kinetostat::number::larger;

use crate::cut::finding::CutFinding;
use crate::cut::station::CutStation;

/// Vertices of the load are left out where the others give it within this share of the largest force.
const NEGLIGIBLE: f64 = 0.005;

/// The force of the cut along a path.
#[derive(Clone, Debug, Default)]
pub struct ForceAlongPath {
    /// Stations of all moves, one after the other.
    stations: Vec<CutStation>,
    /// Where the stations of each move begin; one more than there are moves.
    first: Vec<usize>,
    /// Those between which the load is linear.
    vertices: Vec<(f64, Wrench)>,
    first_vertex: Vec<usize>,
    largest: Wrench,
    /// What no such cut should be.
    pub findings: Vec<CutFinding>,
}

impl ForceAlongPath {
    /// Of the stations of each move, in the order of the path.
    pub(crate) fn of(moves: impl Iterator<Item = Vec<CutStation>>, findings: Vec<CutFinding>) -> Self {
        let mut along = Self {
            findings,
            ..Self::default()
        };
        along.first.push(0);
        for stations in moves {
            along.stations.extend(stations);
            along.first.push(along.stations.len());
        }
        let size = |station: &CutStation| station.wrench.force().norm();
        for station in &along.stations {
            if size(station) > along.largest.force().norm() {
                along.largest = station.wrench;
            }
        }
        let size = along.largest.force().norm();
        let moment = along.stations.iter().map(|s| s.wrench.moment().norm());
        let moment = moment.fold(0.0, larger);
        along.first_vertex.push(0);
        for pair in along.first.windows(2) {
            let stations = &along.stations[pair[0]..pair[1]];
            essential(stations, NEGLIGIBLE * size, NEGLIGIBLE * moment, &mut along.vertices);
            along.first_vertex.push(along.vertices.len());
        }
        along
    }

    /// Stations of a move; none where it does not cut.
    #[must_use]
    pub fn stations(&self, move_index: usize) -> &[CutStation] {
        match self.first.get(move_index..move_index + 2) {
            Some(&[from, to]) => &self.stations[from..to],
            _ => &[],
        }
    }

    /// The wrench with the largest force, in axes of the feed.
    #[must_use]
    pub fn largest(&self) -> Wrench {
        self.largest
    }

    fn vertices(&self, move_index: usize) -> &[(f64, Wrench)] {
        match self.first_vertex.get(move_index..move_index + 2) {
            Some(&[from, to]) => &self.vertices[from..to],
            _ => &[],
        }
    }

    /// Force (N) and moment (N m) on the tool's tip at a share of a move: x along the feed, z along the part's z, y to the left.
    #[must_use]
    pub fn wrench(&self, move_index: usize, share: f64) -> Wrench {
        let vertices = self.vertices(move_index);
        let after = vertices.partition_point(|(at, _)| *at < share);
        match (after.checked_sub(1).map(|i| vertices[i]), vertices.get(after)) {
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

    /// Shares inside a move at which the load has another slope.
    #[must_use]
    pub fn breaks(&self, move_index: usize) -> Vec<f64> {
        let inside = self.vertices(move_index).iter().map(|(at, _)| *at);
        inside.filter(|at| *at > 0.0 && *at < 1.0).collect()
    }
}

/// The stations that the load needs (Ramer, Douglas and Peucker): the others lie within the tolerances of it.
fn essential(stations: &[CutStation], force: f64, moment: f64, vertices: &mut Vec<(f64, Wrench)>) {
    let (Some(first), Some(last)) = (stations.first(), stations.last()) else {
        return;
    };
    vertices.push((first.share, first.wrench));
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
    debug_assert_eq!(vertices.last().map(|v| v.0), Some(last.share));
}
