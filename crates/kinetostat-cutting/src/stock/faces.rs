//! The walls in a cell of the grid, each by itself.
//!
//! Every point knows how far away its next wall is, where that wall looks, and whether a tool went along it or turned there.
//! What is wanted is the difference of two distances at a place of a rim: from the wall, and from the rim itself, which is
//! nothing there. From a point `x` with the difference `f` and its gradient `g` it is
//! `f + (g + g_place) (place - x) / 2`, exact for whatever bends evenly (the trapezoidal rule along the way from `x`). Seen
//! from all four points the gradients at the place cancel; from fewer they follow from how the wall bends. It vanishes where the
//! rim itself made the wall.
//!
//! Points whose walls look the same way see one wall, and their answers are weighted by their shares of the cell; walls that
//! look another way are other walls. Air is the union of what was swept, so that the nearest of them counts: ribs thinner than
//! a cell and tips between two passes keep both of their walls.
//!
//! Source: own work after the gradient-augmented level sets of Nave, Rosales and Seibold ("A gradient-augmented level set
//! method with an optimally local, coherent advection scheme", Journal of Computational Physics 229, 2010).

use crate::stock::profile::{Bend, Normal};

/// Walls whose normals have at least this cosine between them are one wall.
const SAME_WALL: f64 = 0.8;
/// Weight of a point that has no share of the cell.
const LEAST_SHARE: f64 = 1e-6;

/// A place on a rim, and the rim's axis seen from above and its radius.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OnRim {
    pub centre: [f64; 2],
    pub radius: f64,
    pub place: [f64; 2],
}

/// Information of a point on the wall next to it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seen {
    pub point: [f64; 2],
    /// Distance of the wall, negative in the air.
    pub distance: f64,
    pub normal: Normal,
    /// The point's share of the cell.
    pub share: f64,
}

/// One wall with the weighted sums of what its points say.
#[derive(Clone, Copy, Debug, Default)]
struct Face {
    normal: [f64; 2],
    weight: f64,
    /// Weighted sum of the differences, plus half of the way to the place times their own gradients.
    sum: f64,
    /// Weighted sum of the ways to the place.
    ways: [f64; 2],
    /// Weighted sum of the gradients at the place.
    gradients: [f64; 2],
}

/// The walls of one cell.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Faces {
    faces: [Face; 4],
    count: usize,
}

impl Faces {
    /// Adds what a point says.
    #[inline]
    pub fn add(&mut self, rim: &OnRim, seen: &Seen) {
        let from_axis = [0, 1].map(|i| seen.point[i] - rim.centre[i]);
        let length = (from_axis[0] * from_axis[0] + from_axis[1] * from_axis[1]).sqrt();
        let way = [0, 1].map(|i| rim.place[i] - seen.point[i]);
        let normal = seen.normal.vector();
        let known = normal[0] != 0.0 || normal[1] != 0.0;
        let (mut own, mut there) = ([0.0; 2], [0.0; 2]);
        if known {
            own = [0, 1].map(|i| normal[i] - from_axis[i] / length);
            there = match seen.normal.bend() {
                Bend::Straight => {
                    [0, 1].map(|i| normal[i] - (rim.place[i] - rim.centre[i]) / rim.radius)
                }
                // The wall bends like the rim itself.
                Bend::Round => own,
            };
        }
        let value =
            seen.distance - (length - rim.radius) + 0.5 * (own[0] * way[0] + own[1] * way[1]);
        let weight = seen.share + LEAST_SHARE;
        let same = |face: &Face| {
            !known || face.normal[0] * normal[0] + face.normal[1] * normal[1] > SAME_WALL
        };
        let k = self.faces[..self.count]
            .iter()
            .position(same)
            .unwrap_or(self.count);
        let face = &mut self.faces[k];
        if k == self.count {
            face.normal = normal;
            self.count += 1;
        }
        face.weight += weight;
        face.sum += weight * value;
        for i in 0..2 {
            face.ways[i] += weight * way[i];
            face.gradients[i] += weight * there[i];
        }
    }

    /// All points see the same wall.
    #[inline]
    pub fn is_one(&self) -> bool {
        self.count <= 1
    }

    /// Depth of the place in the material, from the nearest wall; infinite if no point sees one.
    #[inline]
    pub fn nearest(&self) -> f64 {
        let mut nearest = f64::INFINITY;
        for face in &self.faces[..self.count] {
            let value = face.value();
            nearest = if value < nearest { value } else { nearest };
        }
        nearest
    }
}

impl Face {
    #[inline]
    fn value(&self) -> f64 {
        let rest = self.gradients[0] * self.ways[0] + self.gradients[1] * self.ways[1];
        (self.sum + 0.5 * rest / self.weight) / self.weight
    }
}
