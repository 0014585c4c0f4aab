//! Spring blocks: groups of coordinates held by one energy, and their laws [R 3.2, 4.9].
//!
//! A block answers with energy, torque and tangent for the deflections of its own coordinates; a
//! constant matrix is the simplest law. What a block stores is the virtual joint's energy: the
//! torque that the chain must apply to it is the gradient.

use nalgebra::{DMatrix, Matrix6, Vector3, Vector6};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

use crate::model::springs::bilinear::{BilinearLaw, SingleLaw};
use crate::model::springs::bowing::BowingLaw;
use crate::model::springs::curved::CurvedLaw;
use crate::model::springs::logarithm::LogarithmLaw;
use crate::model::springs::parallelogram::ParallelogramLaw;

/// A named group of spring coordinates with one law.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct SpringBlock {
    /// Name, unique in the chain.
    pub name: String,
    /// Index of the first coordinate; the block's coordinates are consecutive.
    pub first: usize,
    /// Coordinates at rest, `theta0` (m or rad): a preload when they differ from the assembled ones.
    pub rest: Vec<f64>,
    /// Law by which the coordinates get their torques, N or N m.
    pub law: SpringLaw,
    /// The piece of an elastic link that this spring stands for, if it is one.
    #[cfg_attr(feature = "serde", serde(default))]
    pub segment: Option<Segment>,
}

/// A piece of a straight elastic link.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Segment {
    /// Name of the link.
    pub link: String,
    /// Length of the whole link, m.
    pub link_length: f64,
    /// Smaller of the link's two bending stiffnesses `EI`, N m^2.
    pub bending_stiffness: f64,
    /// Direction of the link from its near to its far end, in the axes of the spring; unit length.
    #[cfg_attr(feature = "serde", serde(default = "Vector3::x"))]
    pub along: Vector3<f64>,
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

    /// Adds this block's energy gradient to `torque` (all coordinates of the chain) and gives its second
    /// derivative to `entry`: row and column, both counted within the block, and the value there. Returns the
    /// energy (J). `values` are the coordinates, `posture` those of the commanded, unloaded posture,
    /// `preload` scales `theta0` (1 is the real one).
    /// A law with strains that are not linear appends its first coordinate and its geometric stiffness to
    /// `geometric`: like the loads' Hessian, it decides about stability.
    pub(crate) fn add(
        &self,
        values: &[f64],
        posture: &[f64],
        preload: f64,
        torque: &mut [f64],
        entry: &mut impl FnMut(usize, usize, f64),
        geometric: &mut Vec<(usize, Matrix6<f64>)>,
    ) -> f64 {
        let deflection =
            || Vector6::from_fn(|i, _| values[self.first + i] - preload * self.rest[i]);
        if let SpringLaw::Linear(matrix) = &self.law {
            return self.add_constant(matrix, values, preload, torque, entry);
        }
        if let SpringLaw::Parallelogram(law) = &self.law {
            let matrix = law.matrix(posture[law.inclination]);
            return self.add_constant(&matrix, values, preload, torque, entry);
        }
        if_single!(&self.law, law => {
            let x = values[self.first] - preload * self.rest[0];
            torque[self.first] += law.torque(x);
            entry(0, 0, law.tangent(x));
            return law.energy(x);
        }, else ());
        let response = if_curved!(&self.law, law => law.respond(&deflection()), else return 0.0);
        for i in 0..6 {
            torque[self.first + i] += response.torque[i];
            for j in 0..6 {
                entry(i, j, response.material[(i, j)] + response.geometric[(i, j)]);
            }
        }
        geometric.push((self.first, response.geometric));
        response.energy
    }

    /// Adds this block's energy gradient to `torque` (all coordinates of the chain) without a tangent and without allocating:
    /// `values` are the coordinates, `posture` those of the commanded, unloaded posture.
    pub fn add_torque(&self, values: &[f64], posture: &[f64], torque: &mut [f64]) {
        match &self.law {
            SpringLaw::Linear(matrix) => {
                self.add_constant(matrix, values, 1.0, torque, &mut |_, _, _| {});
            }
            SpringLaw::Parallelogram(law) => {
                let matrix = law.matrix(posture[law.inclination]);
                self.add_constant(&matrix, values, 1.0, torque, &mut |_, _, _| {});
            }
            other => if_single!(
                other,
                law => torque[self.first] += law.torque(values[self.first] - self.rest[0]),
                else if_curved!(
                    other,
                    law => {
                        let at: [f64; 6] = std::array::from_fn(|i| values[self.first + i] - self.rest[i]);
                        for (i, own) in law.torque_at(&at).0.into_iter().enumerate() {
                            torque[self.first + i] += own;
                        }
                    },
                    else ()
                )
            ),
        }
    }

    /// Corrects `to`, which is `from` plus a step of an iteration, to second order: a law that is
    /// linear in other coordinates than these takes the step in its own.
    pub(crate) fn follow(&self, from: &[f64], preload: f64, to: &mut [f64]) {
        if self.len() != 6 {
            return;
        }
        let own = self.first..self.first + self.len();
        let rest = Vector6::from_column_slice(&self.rest) * preload;
        let now = Vector6::from_column_slice(&from[own.clone()]);
        let step = Vector6::from_column_slice(&to[own.clone()]) - now;
        let next = if_curved!(&self.law, law => law.follow(&(now - rest), &step), else return);
        to[own].copy_from_slice((next + rest).as_slice());
    }

    fn add_constant<R, C, S>(
        &self,
        matrix: &nalgebra::Matrix<f64, R, C, S>,
        values: &[f64],
        preload: f64,
        torque: &mut [f64],
        entry: &mut impl FnMut(usize, usize, f64),
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
                entry(i, j, matrix[(i, j)]);
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
            other => if_curved!(
                other,
                law => {
                    let m = law.at_rest();
                    DMatrix::from_fn(6, 6, |i, j| m[(i, j)])
                },
                else if_single!(
                    other,
                    law => DMatrix::from_element(1, 1, law.at_rest()),
                    else DMatrix::zeros(self.len(), self.len())
                )
            ),
        }
    }
}

/// A stiffness matrix in units in which its diagonal is one: metres and radians are compared alike.
pub(crate) fn scaled(k: &DMatrix<f64>) -> DMatrix<f64> {
    let scale: Vec<f64> = k
        .diagonal()
        .iter()
        .map(|x| x.abs().max(1e-300).sqrt())
        .collect();
    DMatrix::from_fn(k.nrows(), k.ncols(), |i, j| {
        k[(i, j)] / (scale[i] * scale[j])
    })
}

/// Law of a spring block.
///
/// A law is a file of its own with one struct, written once for every number. Here it becomes a variant of
/// [`SpringLaw`] and a line in the macro of its kind; both engines go through these.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[non_exhaustive]
pub enum SpringLaw {
    /// Constant symmetric stiffness, k x k (N/m, N/rad, N m/m, N m/rad by coordinate).
    Linear(DMatrix<f64>),
    /// Two parallel bars lumped into one spring: see [`ParallelogramLaw`].
    Parallelogram(Box<ParallelogramLaw>),
    /// A beam segment that shortens as it bends: see [`BowingLaw`]. Six coordinates.
    Bowing(Box<BowingLaw>),
    /// A spring in exponential coordinates: see [`LogarithmLaw`]. Six coordinates.
    Logarithm(Box<LogarithmLaw>),
    /// Two stiffnesses with a knee: see [`BilinearLaw`]. One coordinate.
    Bilinear(BilinearLaw),
}

/// Selects a law of six coordinates with strains of its own ([`super::curved::CurvedLaw`]): `$do` with the law as
/// `$own`; `$other` for all other laws.
macro_rules! if_curved {
    ($law:expr, $own:ident => $do:expr, else $other:expr) => {
        match $law {
            $crate::model::springs::block::SpringLaw::Bowing($own) => $do,
            $crate::model::springs::block::SpringLaw::Logarithm($own) => $do,
            _ => $other,
        }
    };
}
pub(crate) use if_curved;

/// Selects a law of one coordinate that is not linear ([`super::bilinear::SingleLaw`]).
macro_rules! if_single {
    ($law:expr, $own:ident => $do:expr, else $other:expr) => {
        match $law {
            $crate::model::springs::block::SpringLaw::Bilinear($own) => $do,
            _ => $other,
        }
    };
}
pub(crate) use if_single;

impl SpringLaw {
    /// Scales the stiffness of the law.
    pub(crate) fn scaled(&self, factor: f64) -> Self {
        let mut scaled = self.clone();
        match &mut scaled {
            Self::Linear(matrix) => *matrix *= factor,
            Self::Parallelogram(law) => law.bar *= factor,
            Self::Bowing(law) => law.matrix *= factor,
            Self::Logarithm(law) => law.matrix *= factor,
            Self::Bilinear(law) => {
                law.stiffness *= factor;
                law.beyond *= factor;
            }
        }
        scaled
    }

    /// Describes the fault of its numbers, the stiffness at rest excepted.
    pub(crate) fn fault(&self) -> Option<&'static str> {
        if_curved!(
            self,
            law => law.fault(),
            else if_single!(self, law => law.fault(), else None)
        )
    }
}
