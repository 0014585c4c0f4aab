//! All spring laws: the one place where a new law is registered.
//!
//! A law is a file of its own with one struct, written once for every number. Here it becomes a variant of
//! [`SpringLaw`] and a line in the macro of its kind; both engines go through these.

use nalgebra::DMatrix;
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

use crate::model::springs::bilinear::{BilinearLaw, SingleLaw};
use crate::model::springs::bowing::BowingLaw;
use crate::model::springs::curved::CurvedLaw;
use crate::model::springs::logarithm::LogarithmLaw;
use crate::model::springs::parallelogram::ParallelogramLaw;

/// Law of a spring block.
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
            $crate::model::springs::law::SpringLaw::Bowing($own) => $do,
            $crate::model::springs::law::SpringLaw::Logarithm($own) => $do,
            _ => $other,
        }
    };
}
pub(crate) use if_curved;

/// Selects a law of one coordinate that is not linear ([`super::bilinear::SingleLaw`]).
macro_rules! if_single {
    ($law:expr, $own:ident => $do:expr, else $other:expr) => {
        match $law {
            $crate::model::springs::law::SpringLaw::Bilinear($own) => $do,
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
