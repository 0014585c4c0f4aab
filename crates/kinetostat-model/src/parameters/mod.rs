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
use crate::schema::Document;

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

    /// The model with other words about the sources of some numbers, by their paths: those of the element, section or stiffness that
    /// has the number. Paths of other numbers are passed over.
    ///
    /// # Errors
    /// [`ModelError`] as for a file with these words; cannot happen for a model that was read.
    pub fn with_sources(&self, sources: &[(&str, String)]) -> Result<Self, ModelError> {
        let mut document = self.document.clone();
        for (path, words) in sources {
            if let Some(source) = source_of(&mut document, path) {
                *source = Some(words.clone());
            }
        }
        Self::from_document(&document, &self.changed())
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

/// The words about the source of a number.
fn source_of<'d>(document: &'d mut Document, path: &str) -> Option<&'d mut Option<String>> {
    let (kind, rest) = path.split_once('.')?;
    let is_in = |name: &str| {
        rest.strip_prefix(name)
            .is_some_and(|after| after.starts_with('.'))
    };
    match kind {
        "chain" => {
            let (name, chain) = document.chain.iter_mut().find(|(name, _)| is_in(name))?;
            let rest = &rest[name.len() + 1..];
            let mut elements = chain.elements.iter_mut().enumerate();
            let (_, own) = elements.find(|(i, element)| {
                let label = element.name_or_number(i + 1);
                rest.strip_prefix(&label)
                    .is_some_and(|after| after.starts_with('.'))
            })?;
            own.source_mut()
        }
        "section" => (document.section.iter_mut())
            .find(|(name, _)| is_in(name))
            .map(|(_, s)| &mut s.source),
        "stiffness" => (document.stiffness.iter_mut())
            .find(|(name, _)| is_in(name))
            .map(|(_, s)| &mut s.source),
        _ => None,
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
