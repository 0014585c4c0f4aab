//! The numbers of a model by name: listed, changed, and set thousands of times without writing a file.
//!
//! A path is what one says of a number: `platform.tool.home.position_mm.x`, `chain.leg.q2.length_mm`,
//! `chain.arm.joint 2.stiffness_n_m_per_rad`, `section.tube.tube.outer_diameter_mm`, `deviation.leg x.foot arm.longer_by_mm`.
//! Elements without a name are called by word and position (`link 4`); components by their letters (`x`, `rz`; `y.rz` in a
//! matrix, whose lower half follows the upper one).
//!
//! - A chain is shared by its limbs: `chain.NAME. ...` changes all of them, `limb.LIMB.ELEMENT. ...` the limb alone; so do
//!   `limb.LIMB.section.NAME. ...` and `limb.LIMB.stiffness.NAME. ...`. Where both are given, the limb's counts.
//! - `section.NAME.scale` and `stiffness.NAME.scale` are a factor on all moduli, rigidities or entries, 1 in the file.
//! - A deviation that the file does not have is zero: `deviation.LIMB.PLACE.longer_by_mm`,
//!   `deviation.LIMB.PLACE.translation_mm.x`, `deviation.LIMB.PLACE.rotation_vector_deg.x`.

pub(crate) mod elements;
mod list;
mod resolve;
pub(crate) mod unit;
pub(crate) mod walk;

use kinetostat::Mechanism;

pub use self::list::Parameter;
use self::resolve::Resolved;
pub use self::unit::ParameterKind;
use crate::assembly::mechanism::mechanism_of;
use crate::findings::Findings;
use crate::model::{Model, move_home_within_reach};
use crate::problem::ModelError;
pub use crate::text::edit::NumberEdit;
use crate::text::edit::edited;

impl Model {
    /// Every number of the model file, in the order of the file's tables, with factors on sections and stiffnesses.
    /// Those of single limbs (`limb.LIMB.ELEMENT. ...`) are not listed: they are the chain's.
    ///
    /// ```
    /// let model = kinetostat_model::Model::preset("heavy_6r")?;
    /// let drive = model.parameters().into_iter().find(|p| p.path == "chain.arm.joint 2.stiffness_n_m_per_rad");
    /// let drive = drive.ok_or("no such parameter")?;
    /// assert_eq!((drive.value, drive.unit), (6.6e6, "N m/rad"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn parameters(&self) -> Vec<Parameter> {
        list::list(&mut self.document.clone())
    }

    /// The model with other numbers, in the units of their keys, as if its file said so.
    ///
    /// ```
    /// let model = kinetostat_model::Model::preset("orthoglide")?;
    /// let longer = model.with_parameters(&[("limb.leg x.q2.length_mm", 310.2)])?;
    /// assert_ne!(longer.mechanism.limbs()[0].nominal, model.mechanism.limbs()[0].nominal);
    /// assert_eq!(longer.mechanism.limbs()[1].nominal, model.mechanism.limbs()[1].nominal);
    /// # Ok::<(), kinetostat_model::ModelError>(())
    /// ```
    ///
    /// # Errors
    /// [`ModelError`] where a path names nothing (with the nearest that exist), is given twice, or where a file with these
    /// numbers would be refused.
    pub fn with_parameters(&self, changes: &[(&str, f64)]) -> Result<Self, ModelError> {
        let (paths, values): (Vec<&str>, Vec<f64>) = changes.iter().copied().unzip();
        let parametric = self.parametric(&paths)?;
        let mut document = parametric.resolved.set(&values, &parametric.file)?;
        parametric.resolved.tidy(&mut document);
        Self::from_document(&document, &parametric.file)
    }

    /// The model with other numbers and words about their source, with everything else of its text as it is.
    ///
    /// ```
    /// use kinetostat_model::{Model, NumberEdit};
    /// let model = Model::preset("heavy_6r")?;
    /// let softer = model.edited(&[NumberEdit {
    ///     path: "chain.arm.joint 2.stiffness_n_m_per_rad".into(),
    ///     value: 6.1e6,
    ///     source: Some("measured".into()),
    /// }])?;
    /// assert_eq!(softer.text.lines().count(), model.text.lines().count());
    /// assert!(softer.text.contains("stiffness_n_m_per_rad = 6100000.0"));
    /// # Ok::<(), kinetostat_model::ModelError>(())
    /// ```
    ///
    /// Where a number does not stand in the text as its path says (one of a single limb, a deviation that the file does not have, a
    /// factor), the document is written anew, without comments.
    ///
    /// # Errors
    /// As [`with_parameters`](Self::with_parameters).
    pub fn edited(&self, edits: &[NumberEdit]) -> Result<Self, ModelError> {
        if let Some(text) = edited(&self.text, &self.document, edits) {
            return Self::from_toml(&text, &self.changed());
        }
        let numbers: Vec<(&str, f64)> = edits.iter().map(|e| (e.path.as_str(), e.value)).collect();
        self.with_parameters(&numbers)
    }

    /// The model as a function of some of its numbers.
    ///
    /// # Errors
    /// As [`with_parameters`](Self::with_parameters) for paths.
    pub fn parametric(&self, paths: &[&str]) -> Result<ParametricModel, ModelError> {
        let resolved = Resolved::new(&self.document, paths, &self.file)?;
        Ok(ParametricModel {
            resolved,
            file: self.changed(),
        })
    }
}

/// A model as a function of some of its numbers: machines are made without writing and reading a file.
///
/// ```
/// let model = kinetostat_model::Model::preset("orthoglide")?;
/// let slider = model.parametric(&["chain.leg.slider.stiffness_n_per_mm"])?;
/// assert_eq!(slider.parameters()[0].value, 1e6);
/// let softer = slider.mechanism(&[5e4])?;
/// assert_eq!(softer, model.with_parameters(&[("chain.leg.slider.stiffness_n_per_mm", 5e4)])?.mechanism);
/// assert!(slider.mechanism(&[f64::NAN]).unwrap_err().to_string().contains("a finite number is needed"));
/// # Ok::<(), kinetostat_model::ModelError>(())
/// ```
#[derive(Clone, Debug)]
pub struct ParametricModel {
    resolved: Resolved,
    file: String,
}

impl ParametricModel {
    /// The numbers, in the order in which they were asked for, with what the file says of them.
    #[must_use]
    pub fn parameters(&self) -> &[Parameter] {
        &self.resolved.parameters
    }

    /// The machine with these numbers, in the order and in the units of [`parameters`](Self::parameters).
    ///
    /// # Errors
    /// [`ModelError`] as for a file with these numbers, or if there are not as many as parameters.
    pub fn mechanism(&self, values: &[f64]) -> Result<Mechanism, ModelError> {
        let mut document = self.resolved.set(values, &self.file)?;
        if values.iter().all(|v| v.is_finite()) {
            let mut findings = Findings::default();
            let mut mechanism = mechanism_of(&document, &mut findings);
            if let Some(mechanism) = mechanism.as_mut().filter(|_| findings.errors.is_empty()) {
                move_home_within_reach(mechanism, &mut findings);
            }
            if let (Some(mechanism), true) = (mechanism, findings.errors.is_empty()) {
                return Ok(mechanism);
            }
        }
        // Whatever is wrong is said as it is of a file.
        self.resolved.tidy(&mut document);
        Model::from_document(&document, &self.file).map(|model| model.mechanism)
    }
}
