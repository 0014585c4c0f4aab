//! A stretch of the turn on which the same parts of the same teeth are in the material, and the directional matrix of one tooth.

use nalgebra::{Matrix3, Vector3};

use crate::cut::coefficients::Coefficients;

/// An end of the stretch of one edge in the material, as an angle of its places.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum End {
    /// End at a border of the arc.
    Fixed(f64),
    /// End at the tip or at the top of the edge, which move as the spindle turns: turn plus this.
    Moving(f64),
}

impl End {
    fn at(self, turn: f64) -> f64 {
        match self {
            Self::Fixed(angle) => angle,
            Self::Moving(offset) => turn + offset,
        }
    }
}

/// Edge in the material on a piece.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Active {
    /// A straight edge at turn plus this angle.
    Edge(f64),
    /// A helical edge between two ends, with the reciprocal of the lag from tip to top, 1/rad.
    Swept {
        /// Lower angle.
        from: End,
        /// Upper angle.
        to: End,
        /// One over the lag from tip to top, positive.
        per_lag: f64,
    },
    /// Constant matrix, N/m^2.
    Constant(Matrix3<f64>),
}

/// A stretch of the turn of the spindle on which the directional matrix is smooth.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Piece {
    /// Turn at which it begins, rad.
    pub(crate) start: f64,
    /// Length, rad.
    pub(crate) length: f64,
    /// Edges in the material; empty in air.
    pub(crate) active: Vec<Active>,
}

impl Piece {
    /// Directional matrix [D 8], mean over the depth, sum over the teeth, N/m^2.
    pub(crate) fn matrix(&self, coefficients: &Coefficients, turn: f64) -> Matrix3<f64> {
        let mut sum = Matrix3::zeros();
        for active in &self.active {
            sum += match *active {
                Active::Edge(offset) => directional_matrix(coefficients, turn + offset),
                Active::Swept { from, to, per_lag } => {
                    let upper = directional_integral(coefficients, to.at(turn));
                    (upper - directional_integral(coefficients, from.at(turn))) * per_lag
                }
                Active::Constant(matrix) => matrix,
            };
        }
        sum
    }

    /// The only straight edge, where there is one and nothing else: the matrix has rank one.
    pub(crate) fn single_edge(&self) -> Option<f64> {
        match self.active[..] {
            [Active::Edge(offset)] => Some(offset),
            _ => None,
        }
    }
}

/// `D = -(Kt t + Kr n - Ka z) n^T` with `n = (sin, cos, 0)`, `t = (cos, -sin, 0)`, N/m^2: [D 8] with the axial sign of
/// `cutting.md`.
pub(crate) fn directional_matrix(coefficients: &Coefficients, angle: f64) -> Matrix3<f64> {
    force_direction(coefficients, angle) * normal(angle).transpose()
}

/// Force on the tool for a chip of one metre, per depth: `-(Kt t + Kr n - Ka z)`, N/m^2.
pub(crate) fn force_direction(coefficients: &Coefficients, angle: f64) -> Vector3<f64> {
    let (s, c) = angle.sin_cos();
    let (kt, kr, ka) = (
        coefficients.tangential(),
        coefficients.radial(),
        coefficients.axial(),
    );
    Vector3::new(-kt * c - kr * s, kt * s - kr * c, ka)
}

/// Outward normal at an angle.
pub(crate) fn normal(angle: f64) -> Vector3<f64> {
    let (s, c) = angle.sin_cos();
    Vector3::new(s, c, 0.0)
}

/// Integral of [`directional_matrix`] from 0 to an angle, N/m^2 rad.
pub(crate) fn directional_integral(coefficients: &Coefficients, angle: f64) -> Matrix3<f64> {
    let (s, c) = angle.sin_cos();
    let (kt, kr, ka) = (
        coefficients.tangential(),
        coefficients.radial(),
        coefficients.axial(),
    );
    let ss = 0.5 * (angle - s * c); // integral of sin^2
    let cc = 0.5 * (angle + s * c); // integral of cos^2
    let sc = 0.5 * s * s; // integral of sin cos
    let (int_s, int_c) = (1.0 - c, s);
    Matrix3::new(
        -(kt * sc + kr * ss),
        -(kt * cc + kr * sc),
        0.0,
        kt * ss - kr * sc,
        kt * sc - kr * cc,
        0.0,
        ka * int_s,
        ka * int_c,
        0.0,
    )
}
