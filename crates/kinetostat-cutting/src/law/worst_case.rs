//! The report's estimate for the worst case [R 2.4], [R Table 2.3].

use crate::law::kienzle::Kienzle;

/// Largest force `F = 2 k_c b h v_c^-0.07`, N; thickness and width of the chip in mm, cutting speed in m/min.
///
/// Differs from [R 2.4], which leaves the speed out (erratum): all cells of Table 2.3 follow from this, with the speed of
/// [R Table 2.1] above 100 m/min and a factor of 2 for everything else.
///
/// ```
/// use kinetostat_cutting::{Kienzle, largest_force};
///
/// let monel = Kienzle::new([2600.0, 0.0, 0.0], [0.19, 0.0, 0.0])?;
/// let force = largest_force(&monel, 0.2, 8.0, 1000.0);
/// assert!((force - 6965.1043).abs() < 1e-4); // N
/// # Ok::<(), kinetostat_cutting::CutError>(())
/// ```
#[must_use]
pub fn largest_force(material: &Kienzle, chip_mm: f64, width_mm: f64, speed_m_per_min: f64) -> f64 {
    force_as_printed(material, chip_mm, width_mm) * speed_m_per_min.powf(-0.07)
}

/// `F = 2 k_c b h` as printed [R 2.4], N: what its table does not follow (erratum).
#[must_use]
pub fn force_as_printed(material: &Kienzle, chip_mm: f64, width_mm: f64) -> f64 {
    2.0 * material.specific_n_per_mm2(chip_mm) * width_mm * chip_mm
}
