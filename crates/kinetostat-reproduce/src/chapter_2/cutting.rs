//! Cutting force as the report estimates it [R 2.1-2.4]: a worst case, no prediction.

/// What is cut [R Table 2.2].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Material {
    pub(crate) name: &'static str,
    /// Specific cutting force of a chip of 1 mm by 1 mm, `k_c1.1`, N/mm^2.
    pub(crate) specific: f64,
    /// Exponent `m_c`.
    pub(crate) exponent: f64,
}

pub(crate) const MONEL_400: Material = Material {
    name: "Monel 400",
    specific: 2600.0,
    exponent: 0.19,
};

pub(crate) const AL_MG_4_5_MN: Material = Material {
    name: "Al Mg 4.5 Mn",
    specific: 780.0,
    exponent: 0.23,
};

/// `k_c = k_c1.1 h^-m_c` [R 2.2], N/mm^2; chip thickness in mm.
pub(crate) fn specific_force(material: &Material, thickness: f64) -> f64 {
    material.specific * thickness.powf(-material.exponent)
}

/// `F_max = 2 k_c b h v_c^-0.07`, N; lengths in mm, cutting speed in m/min.
///
/// Differs from [R 2.4], which leaves the speed out (erratum): all cells of Table 2.3 follow from
/// this, with the correction of [R Table 2.1] for speeds above 100 m/min and a factor of 2 for all
/// others.
pub(crate) fn largest_force(material: &Material, thickness: f64, width: f64, speed: f64) -> f64 {
    printed_2_4(material, thickness, width) * speed.powf(-0.07)
}

/// `F_max = 2 k_c b h` as printed [R 2.4], N.
pub(crate) fn printed_2_4(material: &Material, thickness: f64, width: f64) -> f64 {
    2.0 * specific_force(material, thickness) * width * thickness
}

/// Torque of a spindle, N m: power in W, speed in turns per minute.
pub(crate) fn spindle_torque(power: f64, speed: f64, efficiency: f64) -> f64 {
    efficiency * power / (speed * std::f64::consts::TAU / 60.0)
}
