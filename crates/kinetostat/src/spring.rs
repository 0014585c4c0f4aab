//! Spring blocks: groups of coordinates held by one energy [R 3.2, 4.9].
//!
//! A block answers with energy, torque and tangent for the deflections of its own coordinates; a
//! constant matrix is the simplest law. What a block stores is the virtual joint's energy: the
//! torque that the chain must apply to it is the gradient.

use nalgebra::{DMatrix, Matrix6};
use serde::{Deserialize, Serialize};

/// How a spring block answers a deflection.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum SpringLaw {
    /// Constant symmetric stiffness, k x k (N/m, N/rad, N m/m, N m/rad by coordinate).
    Linear(DMatrix<f64>),
    /// Two parallel bars lumped into one spring: see [`ParallelogramLaw`].
    Parallelogram(Box<ParallelogramLaw>),
}

/// A bar parallelogram of width `d` seen as one link: five spring coordinates at the distal end
/// of the bar, `x, y, rx, ry, rz` in the bar's frame (u along the bars, then the axis of the
/// parallelogram's pivots, then the direction across); the sixth, `z`, is the parallelogram's own
/// free motion and belongs to the passive coordinate `inclination` (q2).
///
/// With the bar's matrix `K` and `c = cos q2, s = sin q2` (reference: Orthoglide literature, with
/// the sign of the (4,6) entry for this sense of q2):
/// `2 [K11; K22, K26; K44 + d^2 c^2 K22/4, d^2 sin(2 q2) K22/8; d^2 c^2 K11/4; K66 + d^2 s^2 K22/4]`.
/// `q2` is the one of the commanded posture: the block's matrix is constant while the machine
/// bends about that posture.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ParallelogramLaw {
    /// Stiffness of one bar at its distal end, 6 x 6, cantilever (N/m, N/rad, N m/rad).
    pub bar: Matrix6<f64>,
    /// Distance of the two bars, m.
    pub width: f64,
    /// Index of the passive coordinate that inclines the parallelogram.
    pub inclination: usize,
}

impl ParallelogramLaw {
    /// The 5 x 5 matrix at inclination `q2` (rad), order `x, y, rx, ry, rz`.
    #[must_use]
    pub fn matrix(&self, q2: f64) -> nalgebra::Matrix5<f64> {
        let (s, c) = q2.sin_cos();
        let k = &self.bar;
        let d2 = self.width * self.width;
        let mut m = nalgebra::Matrix5::zeros();
        m[(0, 0)] = k[(0, 0)];
        m[(1, 1)] = k[(1, 1)];
        m[(1, 4)] = k[(1, 5)];
        m[(2, 2)] = k[(3, 3)] + d2 * c * c * k[(1, 1)] / 4.0;
        m[(2, 4)] = d2 * (2.0 * q2).sin() * k[(1, 1)] / 8.0;
        m[(3, 3)] = d2 * c * c * k[(0, 0)] / 4.0;
        m[(4, 4)] = k[(5, 5)] + d2 * s * s * k[(1, 1)] / 4.0;
        m.fill_lower_triangle_with_upper_triangle();
        2.0 * m
    }
}

/// A named group of spring coordinates with one law.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SpringBlock {
    /// Name, unique in the chain.
    pub name: String,
    /// Index of the first coordinate; the block's coordinates are consecutive.
    pub first: usize,
    /// Coordinates at rest, `theta0` (m or rad): a preload when they differ from the assembled ones.
    pub rest: Vec<f64>,
    /// The law.
    pub law: SpringLaw,
}

impl SpringBlock {
    /// Number of coordinates.
    #[must_use]
    pub fn len(&self) -> usize {
        self.rest.len()
    }

    /// True for a block without coordinates.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rest.is_empty()
    }

    /// Adds this block's energy gradient to `torque` (all coordinates of the chain) and its second
    /// derivative to `tangent` (n x n); returns the energy (J). `values` are the coordinates,
    /// `posture` those of the commanded, unloaded posture, `preload` scales `theta0` (1 is the real one).
    pub(crate) fn add(
        &self,
        values: &[f64],
        posture: &[f64],
        preload: f64,
        torque: &mut [f64],
        tangent: &mut DMatrix<f64>,
    ) -> f64 {
        match &self.law {
            SpringLaw::Linear(matrix) => {
                self.add_constant(matrix, values, preload, torque, tangent)
            }
            SpringLaw::Parallelogram(law) => {
                let matrix = law.matrix(posture[law.inclination]);
                self.add_constant(&matrix, values, preload, torque, tangent)
            }
        }
    }

    fn add_constant<R, C, S>(
        &self,
        matrix: &nalgebra::Matrix<f64, R, C, S>,
        values: &[f64],
        preload: f64,
        torque: &mut [f64],
        tangent: &mut DMatrix<f64>,
    ) -> f64
    where
        R: nalgebra::Dim,
        C: nalgebra::Dim,
        S: nalgebra::RawStorage<f64, R, C>,
    {
        let mut energy = 0.0;
        for i in 0..self.len() {
            let mut sum = 0.0;
            for j in 0..self.len() {
                let deflection = values[self.first + j] - preload * self.rest[j];
                sum += matrix[(i, j)] * deflection;
                tangent[(self.first + i, self.first + j)] += matrix[(i, j)];
            }
            torque[self.first + i] += sum;
            energy += 0.5 * sum * (values[self.first + i] - preload * self.rest[i]);
        }
        energy
    }

    /// The stiffness at the unloaded posture, k x k.
    #[must_use]
    pub fn stiffness_at(&self, posture: &[f64]) -> DMatrix<f64> {
        match &self.law {
            SpringLaw::Linear(matrix) => matrix.clone(),
            SpringLaw::Parallelogram(law) => {
                let m = law.matrix(posture[law.inclination]);
                DMatrix::from_fn(5, 5, |i, j| m[(i, j)])
            }
        }
    }
}
