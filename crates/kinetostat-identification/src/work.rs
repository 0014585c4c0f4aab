//! Where the machine works: what its own numbers would have left of the tool's displacement there, and what the identified ones leave.

use nalgebra::{DMatrix, DVector};
use schemars::JsonSchema;
use serde::Serialize;

use crate::cone::UNSEEN;
use crate::error::IdentificationError;
use crate::experiment::Observation;
use crate::identifiability::singular_values;
use crate::least_squares::PostureRows;
use crate::prediction::{Theory, predict};
use crate::result::{Identification, student_95};
use crate::unknown::Unknowns;

/// A place of work: errors after compensation, as the identified model foresees them.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ErrorAtWork {
    /// Name of the place.
    pub place: String,
    /// Distance of the tool from where it should be, without compensation, mm.
    pub displacement_mm: f64,
    /// What is left of it where the model as it was compensates, mm.
    pub before_mm: f64,
    /// What is left where the identified model compensates, mm: less than this with a confidence of 95 %, from the covariance of its
    /// numbers. Null where it depends on numbers that no reading shows.
    pub after_mm: Option<f64>,
}

/// Part of the derivatives at a place that the readings do not see, relative to the rest, above which nothing bounds the error there.
const NOT_BOUNDED: f64 = 1e-6;

impl Identification {
    /// Errors after compensation where the machine works, in postures under loads. Readings are displacements by the load, or places of
    /// the tool (m), which contain what weights and the geometry do; the value of each is what it should be. What the numbers cannot
    /// describe (the misfit of the measurement) comes on top.
    ///
    /// # Errors
    /// A posture without an equilibrium under its load.
    pub fn at_work(
        &self,
        unknowns: &Unknowns,
        work: &[Observation],
        theory: Theory,
    ) -> Result<Vec<ErrorAtWork>, IdentificationError> {
        // The length of a normally distributed vector is within that of a single component with its variance [Szekely and Bakirov 2003].
        let fit = &self.fit;
        let quantile = student_95(fit.names.len(), fit.linear.degrees_of_freedom());
        // The tool is no marker, even if it has the place of one.
        let mut unknowns = unknowns.clone();
        unknowns
            .markers
            .iter_mut()
            .for_each(|m| m.at.fill(f64::NAN));
        let of = |values: &DVector<f64>| predict(&unknowns, values, work, theory);
        let (before, after) = (of(&unknowns.nominal())?, of(&fit.linear.estimate)?);
        let sizes = unknowns.sizes();
        let seen = self.seen(&sizes);
        let each = work.iter().zip(before.iter().zip(&after));
        Ok(each
            .map(|(place, (before, after))| {
                let mut rows = after.derivatives.clone();
                if let Some(gauge) = &fit.gauge {
                    gauge.restrict(&mut rows);
                }
                let left = &rows * &self.covariance_in_si * rows.transpose();
                for (mut column, size) in rows.column_iter_mut().zip(sizes.iter()) {
                    column *= *size;
                }
                let rest = &rows - &rows * &seen * seen.transpose();
                let wanted = place.readings.iter().map(|r| r.value);
                let wanted = DVector::from_iterator(place.readings.len(), wanted);
                let is_bounded = rest.norm() <= NOT_BOUNDED * rows.norm();
                let bound = 1e3 * quantile * left.trace().max(0.0).sqrt();
                ErrorAtWork {
                    place: place.posture.clone(),
                    displacement_mm: 1e3 * (&after.values - wanted).norm(),
                    before_mm: 1e3 * (&after.values - &before.values).norm(),
                    after_mm: is_bounded.then_some(bound),
                }
            })
            .collect())
    }

    /// Orthonormal combinations of the unknowns, each in its size, that the readings or a prior see.
    fn seen(&self, sizes: &DVector<f64>) -> DMatrix<f64> {
        let all: Vec<PostureRows> = (self.fit.postures.iter())
            .chain(&self.fit.prior)
            .cloned()
            .collect();
        let found = singular_values(&all, sizes);
        let rank = found.rank(UNSEEN);
        found.right.columns(0, rank).into_owned()
    }
}
