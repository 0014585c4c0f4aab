//! Identity of two measurements: by their points, whatever their files look like.

use sha2::{Digest, Sha256};

use crate::points::set::MeasuredPoints;

/// Units per mm to which points are rounded: no measurement is finer than a nanometre, and units of a file round
/// below it.
const IN_MM: f64 = 1e6;

impl MeasuredPoints {
    /// SHA-256 of the places in whole nanometres, sorted: the same for two files of the same points, whatever their order,
    /// spacing, remarks and units.
    ///
    /// ```
    /// use kinetostat_mirror::MeasuredPoints;
    ///
    /// let hash = |text| MeasuredPoints::read("trial.csv", text).map(|points| points.sha256());
    /// let one = hash("x_mm,y_mm,z_mm\n0,0,0\n1,0,0\n2,0.5,0\n")?;
    /// let same = hash("# again\nz_mm; y_um; x_m\n\n 0; 500; 0.002\n-0; 0; 0.001\n0.0; 0; 0\n")?;
    /// let other = hash("x_mm,y_mm,z_mm\n0,0,0\n1,0,0\n2,0.501,0\n")?;
    /// assert!(one == same && one != other);
    /// # Ok::<(), kinetostat_mirror::MirrorError>(())
    /// ```
    #[must_use]
    pub fn sha256(&self) -> String {
        let places = self.points().iter().map(|point| {
            let whole = point.position_mm.map(|mm| (mm * IN_MM).round() as i64);
            [whole.x, whole.y, whole.z]
        });
        let mut places: Vec<[i64; 3]> = places.collect();
        places.sort_unstable();
        let mut hash = Sha256::new();
        for axis in places.iter().flatten() {
            hash.update(axis.to_le_bytes());
        }
        let hash = hash.finalize();
        hash.iter().map(|byte| format!("{byte:02x}")).collect()
    }
}
