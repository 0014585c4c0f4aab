//! Payload of a tool, as programs state it.

use nalgebra::{UnitQuaternion, Vector3};

/// The load of a tool: `loaddata` of RAPID, `LOAD` of KRL.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ToolLoad {
    pub mass_kg: f64,
    /// In axes of the flange, mm.
    pub centre_of_mass_mm: Vector3<f64>,
    /// Turns the axes of the flange into those of the moments of inertia.
    pub axes_of_moment: UnitQuaternion<f64>,
    /// About those axes through the centre of mass, kg m^2.
    pub inertia_kg_m2: Vector3<f64>,
}
