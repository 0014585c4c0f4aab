//! Masses and inertias.

use nalgebra::Matrix3;

use crate::elements::part::Part;
use crate::elements::quantity::{MM, ReadResult, choice, choices, need, vector};
use crate::problem::{Finding, KeyPath};
use crate::schema::BodyElement;

pub(crate) fn body(place: &KeyPath, e: &BodyElement) -> ReadResult<Part> {
    let mass = mass(place, Some(e.mass_kg))?;
    let centre = vector(
        place,
        "centre of mass",
        &choices!(e, (centre_of_mass_mm, MM), (centre_of_mass_m, 1.0)),
    )?;
    let inertia = inertia(place, e.inertia_kg_m2)?;
    Ok(Part::Body(e.body.clone(), mass, centre, inertia))
}

pub(crate) fn mass(place: &KeyPath, mass: Option<f64>) -> ReadResult<f64> {
    let given = need(place, "mass", &[choice("mass_kg", mass.or(Some(0.0)), 1.0)])?;
    if given.value < 0.0 {
        return Err(Finding::new(
            &place.key(given.key),
            format!(
                "the mass is {} kg, a number not below zero is needed",
                given.value
            ),
            "correct 'mass_kg'",
        ));
    }
    Ok(given.value)
}

pub(crate) fn inertia(place: &KeyPath, rows: Option<[[f64; 3]; 3]>) -> ReadResult<Matrix3<f64>> {
    let Some(rows) = rows else {
        return Ok(Matrix3::zeros());
    };
    let place = place.key("inertia_kg_m2");
    let m = Matrix3::from_fn(|i, j| rows[i][j]);
    let size = m.amax();
    if (m - m.transpose()).amax() > 1e-9 * size {
        return Err(Finding::new(
            &place,
            "the inertia is not symmetric",
            "write three rows [Ixx, Ixy, Ixz], [Ixy, Iyy, Iyz], [Ixz, Iyz, Izz]; products of inertia carry their minus sign",
        ));
    }
    // Scaled first: squares of extreme numbers would not be finite.
    if size > 0.0 && (m / size).symmetric_eigenvalues().min() < -1e-9 {
        return Err(Finding::new(
            &place,
            "the inertia is negative about some axis",
            "check the products of inertia and their signs",
        ));
    }
    Ok(m)
}
