//! A straight way of the tool, and how far places are from it.

use nalgebra::Vector3;

/// A way lies on another within this, mm, beside what corrections shift it by.
pub(crate) const ON_WAY_MM: f64 = 0.05;

/// A straight way of the tool.
pub(crate) struct Way {
    pub(crate) line: usize,
    pub(crate) ends: [Vector3<f64>; 2],
}

impl Way {
    /// True if a place lies beside it within a distance, and not beyond its ends: corrections shift a way across, not along.
    pub(crate) fn holds(&self, point: &Vector3<f64>, within_mm: f64) -> bool {
        let [from, to] = &self.ends;
        let length = (to - from).norm();
        if length <= ON_WAY_MM {
            return (point - from).norm() <= ON_WAY_MM;
        }
        let along = (point - from).dot(&(to - from)) / length;
        (-ON_WAY_MM..=length + ON_WAY_MM).contains(&along) && self.distance(point) <= within_mm
    }

    pub(crate) fn distance(&self, point: &Vector3<f64>) -> f64 {
        let [from, to] = &self.ends;
        let way = to - from;
        let squared = way.norm_squared();
        let share = match squared > 0.0 {
            true => ((point - from).dot(&way) / squared).clamp(0.0, 1.0),
            false => 0.0,
        };
        (from + share * way - point).norm()
    }
}
