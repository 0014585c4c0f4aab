//! The places of the path that are nearest to a point.

use kinetostat_program::Curve;
use nalgebra::Vector3;

use crate::nominal::path::NominalPath;

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
    /// How far the point is from it, mm.
    pub distance_mm: f64,
}

impl NominalPath<'_> {
    /// The nearest place of the whole path; `None` for a point that is none.
    ///
    /// ```
    /// use kinetostat_mirror::NominalPath;
    /// use kinetostat_program::{Program, ReadOptions, interpret};
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
    pub(crate) fn feet_within(
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
        let place_mm = motion.point(share);
        Foot {
            piece,
            share,
            along_mm: own.from_mm + share * own.length_mm,
            place_mm,
            tangent: tangent(share),
            distance_mm: (point - place_mm).norm(),
        }
    }
}
