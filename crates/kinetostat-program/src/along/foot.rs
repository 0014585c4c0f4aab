//! The places of the path that are nearest to a point.

use nalgebra::Vector3;

use crate::along::nominal::{NominalPath, SAME_MM};
use crate::path::curve::Curve;

/// Steps towards the foot on an arc, each of which leaves a share of the distance to it like that of the point's distance
/// from the arc to its radius.
const STEPS: usize = 50;

/// A place of the path and a point that is nearest to it around there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Foot {
    /// Index of the piece.
    pub piece: usize,
    /// Share of the piece.
    pub share: f64,
    /// Length along the path, mm.
    pub along_mm: f64,
    /// The place, mm.
    pub place_mm: Vector3<f64>,
    /// Direction of the path there.
    pub tangent: Vector3<f64>,
    /// Distance of the point from the path, mm.
    pub distance_mm: f64,
}

impl NominalPath<'_> {
    /// The nearest place of the whole path; `None` for a point that is none.
    ///
    /// ```
    /// use kinetostat_program::{NominalPath, Program, ReadOptions, interpret};
    /// use nalgebra::Vector3;
    ///
    /// let text = "G21 G90\nG0 X0 Y0 Z0\nG1 X10 F300\nG3 X10 Y20 J10\n";
    /// let path = interpret(&Program::read(text)?, &ReadOptions::default())?;
    /// let nominal = NominalPath::new(&path)?;
    /// let foot = nominal.nearest(&Vector3::new(21.0, 10.0, 0.0)).unwrap();
    /// assert!((foot.distance_mm - 1.0).abs() < 1e-12);
    /// assert!((foot.along_mm - 10.0 - 5.0 * std::f64::consts::PI).abs() < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn nearest(&self, point: &Vector3<f64>) -> Option<Foot> {
        let chord = self.chords.nearest_neighbor((*point).into())?;
        let (piece, shares) = chord.data;
        let foot = self.foot(piece, shares, point);
        foot.distance_mm.is_finite().then_some(foot)
    }

    /// The nearest places of all stretches of the path that come within a distance, in order along the path. Places belong to
    /// one stretch where the path between them is no longer than four times the distance. With a line of the program only
    /// its moves are looked at.
    #[must_use]
    pub fn feet_within(
        &self,
        point: &Vector3<f64>,
        within_mm: f64,
        line: Option<usize>,
    ) -> Vec<Foot> {
        let of_line =
            |piece: usize| line.is_none_or(|line| self.motion(&self.pieces()[piece]).line == line);
        let squared = within_mm * within_mm;
        // Chords leave their arcs a little: what is left out here by that is within the distance by no more.
        let near = self.chords.locate_within_distance((*point).into(), squared);
        let mut feet: Vec<Foot> = near
            .filter(|chord| of_line(chord.data.0))
            .map(|chord| self.foot(chord.data.0, chord.data.1, point))
            .filter(|foot| foot.distance_mm <= within_mm)
            .collect();
        feet.sort_by(|a, b| a.along_mm.total_cmp(&b.along_mm));
        let mut stretches: Vec<(f64, Foot)> = Vec::new();
        for foot in feet {
            match stretches.last_mut() {
                Some((end, best))
                    if self.pieces()[best.piece].pass == self.pieces()[foot.piece].pass
                        && foot.along_mm - *end <= 4.0 * within_mm =>
                {
                    *end = foot.along_mm;
                    if foot.distance_mm < best.distance_mm {
                        *best = foot;
                    }
                }
                _ => stretches.push((foot.along_mm, foot)),
            }
        }
        stretches.into_iter().map(|(_, foot)| foot).collect()
    }

    /// The places within a distance of a point to which it is nearer than to those beside them, in order along the path.
    ///
    /// ```
    /// use kinetostat_program::{NominalPath, Program, ReadOptions, interpret};
    /// use nalgebra::Vector3;
    ///
    /// let text = "G21 G90\nG0 X0 Y0 Z0\nG1 X10 F300\nG1 Y10\n";
    /// let path = interpret(&Program::read(text)?, &ReadOptions::default())?;
    /// let nominal = NominalPath::new(&path)?;
    /// let near = |x, y| nominal.nearest_within(&Vector3::new(x, y, 0.0), 3.0);
    /// let along = |x, y| near(x, y).iter().map(|foot| foot.along_mm).collect::<Vec<f64>>();
    /// assert_eq!(along(8.0, 1.0), [8.0, 11.0]);
    /// assert_eq!(along(11.0, -1.0), [10.0]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn nearest_within(&self, point: &Vector3<f64>, within_mm: f64) -> Vec<Foot> {
        let near = self
            .chords
            .locate_within_distance((*point).into(), within_mm * within_mm);
        let mut feet: Vec<(Foot, bool)> = near
            .filter_map(|chord| self.foot_of_chord(chord.data.0, chord.data.1, point))
            .filter(|(foot, _)| foot.distance_mm <= within_mm)
            .collect();
        feet.sort_by(|a, b| a.0.along_mm.total_cmp(&b.0.along_mm));
        // The place between two chords is an end of both.
        feet.dedup_by(|b, a| {
            a.1 && b.1 && (b.0.along_mm - a.0.along_mm).abs() <= 1e-12 * (1.0 + a.0.along_mm)
        });
        feet.into_iter().map(|(foot, _)| foot).collect()
    }

    /// The foot on the piece of a chord if it lies on that chord, and whether at an end of it; none where it is an end from which
    /// the path comes nearer on the next chord.
    fn foot_of_chord(
        &self,
        piece: usize,
        [from, to]: [f64; 2],
        point: &Vector3<f64>,
    ) -> Option<(Foot, bool)> {
        let foot = self.foot(piece, [from, to], point);
        let share = foot.share.clamp(from, to);
        if share > from && share < to {
            return Some((foot, false));
        }
        let own = &self.pieces()[piece];
        let pass = &self.passes()[own.pass].pieces;
        let beyond = match (share == to, share >= 1.0, share <= 0.0) {
            (true, true, _) => (piece + 1 < pass.end).then_some((piece + 1, 0.0)),
            (false, _, true) => (piece > pass.start).then(|| (piece - 1, 1.0)),
            _ => Some((piece, share)),
        };
        let leaves = |(index, share): (usize, f64), sign: f64| {
            let motion = self.motion(&self.pieces()[index]);
            let tangent = motion.tangent(share).unwrap_or_else(Vector3::zeros);
            let away = point - motion.point(share);
            // A point at the end itself is nearest to that: which way it is away from there is rounding.
            away.norm() <= SAME_MM || sign * tangent.dot(&away) <= 1e-9 * away.norm()
        };
        let sign = if share == to { 1.0 } else { -1.0 };
        let is_nearest = beyond.is_none_or(|beyond| leaves(beyond, sign));
        is_nearest.then(|| (self.at(piece, share, point), true))
    }

    /// The foot on a piece around a chord of it.
    fn foot(&self, piece: usize, [from, to]: [f64; 2], point: &Vector3<f64>) -> Foot {
        let own = &self.pieces()[piece];
        let motion = self.motion(own);
        let tangent = |share: f64| motion.tangent(share).unwrap_or_else(Vector3::zeros);
        let step = |share: f64| {
            let way = (point - motion.point(share)).dot(&tangent(share)) / own.length_mm;
            (share + way).clamp(0.0, 1.0)
        };
        let mut share = step(0.5 * (from + to));
        if let Curve::Arc(arc) = &motion.curve {
            // Outside an arc the way along its tangent is too long for the way around.
            let radius = arc.start_radius.max(f64::MIN_POSITIVE);
            share = 0.5 * (from + to);
            for _ in 0..STEPS {
                let out = (point - arc.point(share)).norm() / radius;
                let next = share + (step(share) - share) / (1.0 + out);
                let moved = (next - share).abs();
                share = next;
                if moved * own.length_mm <= 1e-14 * radius {
                    break;
                }
            }
        }
        self.at(piece, share, point)
    }

    /// A place of a piece, with the point that belongs to it.
    fn at(&self, piece: usize, share: f64, point: &Vector3<f64>) -> Foot {
        let own = &self.pieces()[piece];
        let motion = self.motion(own);
        let place_mm = motion.point(share);
        Foot {
            piece,
            share,
            along_mm: own.from_mm + share * own.length_mm,
            place_mm,
            tangent: motion.tangent(share).unwrap_or_else(Vector3::zeros),
            distance_mm: (point - place_mm).norm(),
        }
    }
}
