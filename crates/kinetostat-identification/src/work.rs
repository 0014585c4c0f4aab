//! Where the machine works: what its own numbers would have left of the tool's displacement there, and what the identified ones leave.

use nalgebra::DVector;
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::IdentificationError;
use crate::experiment::Observation;
use crate::prediction::{Theory, predict};
use crate::result::{Identification, student_95};
use crate::unknown::Unknowns;

/// A place of work: errors after compensation, as the identified model foresees them.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ErrorAtWork {
    /// Name of the place.
    pub place: String,
    /// Displacement of the tool by the load, mm.
    pub displacement_mm: f64,
    /// What is left of it where the model as it was compensates, mm.
    pub before_mm: f64,
    /// What is left where the identified model compensates, mm: less than this with a confidence of 95 %, from the covariance of its
    /// numbers.
    pub after_mm: f64,
}

impl Identification {
    /// Errors after compensation where the machine works: postures and loads whose readings are displacements of the tool, m. What the
    /// numbers cannot describe (the misfit of the measurement) comes on top.
    ///
    /// # Errors
    /// A posture without an equilibrium under its load.
    pub fn at_work(
        &self,
        unknowns: &Unknowns,
        work: &[Observation],
        theory: Theory,
    ) -> Result<Vec<ErrorAtWork>, IdentificationError> {
        let of = |values: &DVector<f64>| predict(unknowns, values, work, theory);
        // The length of a normally distributed vector is within that of a single component with its variance [Szekely and Bakirov 2003].
        let fit = &self.fit;
        let quantile = student_95(fit.names.len(), fit.linear.degrees_of_freedom());
        let (before, after) = (of(&unknowns.nominal())?, of(&fit.linear.estimate)?);
        let each = work.iter().zip(before.iter().zip(&after));
        Ok(each
            .map(|(place, (before, after))| {
                let rows = &after.derivatives;
                let left = rows * &self.covariance_in_si * rows.transpose();
                ErrorAtWork {
                    place: place.posture.clone(),
                    displacement_mm: 1e3 * after.values.norm(),
                    before_mm: 1e3 * (&after.values - &before.values).norm(),
                    after_mm: 1e3 * quantile * left.trace().max(0.0).sqrt(),
                }
            })
            .collect())
    }
}
