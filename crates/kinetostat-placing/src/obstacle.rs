//! Boxes that neither the path of the tool's tip nor the part may enter.

use kinetostat::Pose;
use nalgebra::{Point3, Vector3};
use serde::{Deserialize, Serialize};

/// A box with its edges along the axes of the base, mm.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Obstacle {
    /// Name in messages.
    pub name: String,
    /// Smallest coordinates, base axes, mm.
    pub from_mm: [f64; 3],
    /// Largest coordinates.
    pub to_mm: [f64; 3],
}

/// A box around the part, with its edges along the axes of the program, mm.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PartBox {
    /// Smallest coordinates of the program, mm.
    pub from_mm: [f64; 3],
    /// Largest coordinates.
    pub to_mm: [f64; 3],
}

impl Obstacle {
    /// Share of the straight way from `a` to `b` (base axes, mm) that lies inside.
    pub(crate) fn share_inside(&self, a: &Vector3<f64>, b: &Vector3<f64>) -> f64 {
        let (mut enters, mut leaves) = (0.0_f64, 1.0_f64);
        let way = b - a;
        for k in 0..3 {
            let [low, high] = [self.from_mm[k] - a[k], self.to_mm[k] - a[k]];
            if way[k].abs() < 1e-12 {
                if low > 0.0 || high < 0.0 {
                    return 0.0;
                }
                continue;
            }
            let (first, last) = match way[k] > 0.0 {
                true => (low / way[k], high / way[k]),
                false => (high / way[k], low / way[k]),
            };
            enters = kinetostat::number::larger(enters, first);
            leaves = kinetostat::number::smaller(leaves, last);
        }
        match way.norm() < 1e-12 {
            // A place that is inside is wholly inside.
            true => 1.0,
            false if leaves > enters => leaves - enters,
            false => 0.0,
        }
    }

    /// Depth of a box on the part inside this one, mm; 0 if the two do not meet. Two boxes are apart exactly if one of fifteen
    /// directions shows a gap: the edges of both and their cross products.
    pub(crate) fn depth_of(&self, part: &PartBox, base_from_part_mm: &Pose) -> f64 {
        let half =
            |from: &[f64; 3], to: &[f64; 3]| (Vector3::from(*to) - Vector3::from(*from)) / 2.0;
        let middle =
            |from: &[f64; 3], to: &[f64; 3]| (Vector3::from(*to) + Vector3::from(*from)) / 2.0;
        let own = half(&self.from_mm, &self.to_mm);
        let other = half(&part.from_mm, &part.to_mm);
        let there = base_from_part_mm * Point3::from(middle(&part.from_mm, &part.to_mm));
        let apart = there.coords - middle(&self.from_mm, &self.to_mm);
        let turned = base_from_part_mm.rotation.to_rotation_matrix();
        let edges = |k: usize| turned.matrix().column(k).into_owned();
        let unit = |k: usize| Vector3::ith(k, 1.0);
        let crosses = (0..9).map(|k| unit(k / 3).cross(&edges(k % 3)));
        let directions = (0..3).map(unit).chain((0..3).map(edges)).chain(crosses);
        let mut depth = f64::INFINITY;
        for direction in directions {
            let length = direction.norm();
            if length < 1e-9 {
                continue;
            }
            let along = direction / length;
            let reach: f64 = (0..3)
                .map(|k| own[k] * along[k].abs() + other[k] * along.dot(&edges(k)).abs())
                .sum();
            depth = kinetostat::number::smaller(depth, reach - along.dot(&apart).abs());
        }
        kinetostat::number::larger(depth, 0.0)
    }
}
