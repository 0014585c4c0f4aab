//! The corrected curve of a move, from what its division found out about the correction.

use nalgebra::{Vector3, Vector6};

use crate::path::moves::Move;
use crate::writing::merge::Accepted;

/// A stretch on which the correction is a polynomial of fourth degree.
struct Stretch {
    from: f64,
    to: f64,
    /// Newton's forward differences of five values at equal parts, each over its factorial.
    differences: [Vector6<f64>; 5],
}

impl Stretch {
    fn new(accepted: &Accepted, to: f64) -> Self {
        let mut row = accepted.values;
        let mut differences = [row[0]; 5];
        for (order, difference) in differences.iter_mut().enumerate().skip(1) {
            for i in 0..5 - order {
                // Divided differences: dividing by the order at each step gives the factorial.
                row[i] = (row[i + 1] - row[i]) / order as f64;
            }
            *difference = row[0];
        }
        Self {
            from: accepted.share,
            to,
            differences,
        }
    }

    fn correction(&self, share: f64) -> Vector6<f64> {
        let x = 4.0 * ((share - self.from) / (self.to - self.from)).clamp(0.0, 1.0);
        let d = &self.differences;
        let mut sum = d[4];
        for order in (0..4).rev() {
            sum = d[order] + sum * (x - order as f64);
        }
        sum
    }
}

/// Path and correction of one move; between two stretches the correction may jump.
pub(crate) struct CorrectedCurve<'a> {
    pub motion: &'a Move,
    stretches: Vec<Stretch>,
    /// The tool is turned somewhere.
    turned: bool,
}

impl<'a> CorrectedCurve<'a> {
    /// Corrected curve of the whole move, by share.
    pub fn new(motion: &'a Move, accepted: &[Accepted]) -> Self {
        let ends = accepted.iter().skip(1).map(|next| next.share).chain([1.0]);
        Self {
            motion,
            stretches: accepted
                .iter()
                .zip(ends)
                .map(|(accepted, end)| Stretch::new(accepted, end))
                .collect(),
            turned: accepted
                .iter()
                .flat_map(|accepted| &accepted.values)
                .any(|value| value.fixed_rows::<3>(3).amax() > 0.0),
        }
    }

    fn correction(&self, share: f64) -> Vector6<f64> {
        let next = self
            .stretches
            .partition_point(|stretch| stretch.from <= share);
        next.checked_sub(1).map_or_else(Vector6::zeros, |index| {
            self.stretches[index].correction(share)
        })
    }

    /// Corrected position at a share of the move that is no end of it, in mm.
    pub fn point(&self, share: f64) -> Vector3<f64> {
        self.motion.point(share) + self.correction(share).fixed_rows::<3>(0)
    }

    /// Rotation of the tool there, as a length at [`crate::WriteOptions::turn_lever_mm`]; `None` for a move without rotations.
    pub fn turn(&self, share: f64) -> Option<Vector3<f64>> {
        self.turned
            .then(|| self.correction(share).fixed_rows::<3>(3).into_owned())
    }

    /// Ends and quarters of the stretches that lie inside two shares: between them the correction may bend in its own way.
    pub fn quarters(&self, from: f64, to: f64) -> impl Iterator<Item = f64> + '_ {
        let first = self.stretches.partition_point(|stretch| stretch.to <= from);
        self.stretches[first..]
            .iter()
            .take_while(move |stretch| stretch.from < to)
            .flat_map(|stretch| {
                (0..4).map(|quarter| {
                    stretch.from + (stretch.to - stretch.from) * 0.25 * f64::from(quarter)
                })
            })
            .filter(move |share| *share > from && *share < to)
    }
}
