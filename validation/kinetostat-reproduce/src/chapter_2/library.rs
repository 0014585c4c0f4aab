//! Materials of Table 2.2, from the library.

use kinetostat_cutting::{CutError, CutErrorKind, Kienzle, Law, Material, Materials};

/// A material of the library.
pub(crate) fn material(name: &str) -> Result<Material, CutError> {
    Materials::library().find(name).cloned()
}

/// Kienzle's law of a material of Table 2.2.
pub(crate) fn kienzle(name: &str) -> Result<Kienzle, CutError> {
    let material = material(name)?;
    match material.law {
        Law::Kienzle(law) => Ok(law),
        other => Err(CutError::new(
            CutErrorKind::Material,
            format!("law of {name}"),
            other.description(),
            "Kienzle's law",
        )),
    }
}
