//! The frame and the units of a mesh.

use kinetostat_diagnostic::ErrorCode;
use kinetostat_links::{Units, axes_from};
use nalgebra::{Rotation3, Vector3};

use crate::import::link_arguments::MeshArgs;
use crate::ui::failure::{Answer, Failing};

pub(crate) fn metres(mm: &[f64]) -> Vector3<f64> {
    Vector3::from_fn(|i, _| mm.get(i).copied().unwrap_or(0.0) * 1e-3)
}

pub(crate) fn axes(mesh: &MeshArgs) -> Answer<Rotation3<f64>> {
    let vector = |written: &Option<Vec<f64>>, otherwise: Vector3<f64>| match written {
        Some(v) => Vector3::from_fn(|i, _| v.get(i).copied().unwrap_or(0.0)),
        None => otherwise,
    };
    let (x, y) = (
        vector(&mesh.x_axis, Vector3::x()),
        vector(&mesh.y_axis, Vector3::y()),
    );
    axes_from(&x, &y).ok_or_else(|| {
        ErrorCode::Value.failure("--x-axis and --y-axis span no frame; give two directions that are not parallel and not zero")
    })
}

pub(crate) fn units(mesh: &MeshArgs) -> Answer<Option<Units>> {
    match &mesh.units {
        None => Ok(None),
        Some(word) => match Units::named(word) {
            Some(units) => Ok(Some(units)),
            None => Err(ErrorCode::UnknownName.failure(format!(
                "--units: '{word}' is not known; there are: {}",
                Units::names().replace('_', "-")
            ))),
        },
    }
}

pub(crate) fn needed_units(mesh: &MeshArgs) -> Answer<Units> {
    units(mesh)?.ok_or_else(|| {
        ErrorCode::Missing.failure(
            "the file does not say its units: say --units, as in --units n-mm (N, mm and N mm)",
        )
    })
}
