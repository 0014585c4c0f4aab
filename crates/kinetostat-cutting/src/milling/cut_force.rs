//! Force and moment of a cut on the tool.

use nalgebra::Vector3;
use std::ops::{AddAssign, Mul};

use crate::law::EdgeForce;
use crate::tool::Meridian;

/// Force of a cut on the tool and its moment about the tip, in the axes of the cut: x along the feed, z along the tool axis
/// towards the spindle, y to the left of the feed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CutForce {
    /// Force on the tool, N.
    pub force_n: Vector3<f64>,
    /// Moment on the tool about its tip, N mm. Along z it is the torque that the spindle gives, against its rotation.
    pub moment_n_mm: Vector3<f64>,
}

impl CutForce {
    /// Adds the force on a piece of edge: force per length times `width`, at the angle of which sine and cosine are given.
    ///
    /// `dF = -dFt (cos phi, -sin phi, 0) - dFr n + dFa m` with the outward normal `n` and the meridian `m` towards the shank.
    #[inline]
    pub(crate) fn add(
        &mut self,
        place: &Meridian,
        sin_phi: f64,
        cos_phi: f64,
        of: EdgeForce,
        width: f64,
    ) {
        let radially = place.cos * of.axial - place.sin * of.radial;
        let x = (-of.tangential * cos_phi + radially * sin_phi) * width;
        let y = (of.tangential * sin_phi + radially * cos_phi) * width;
        let z = (place.cos * of.radial + place.sin * of.axial) * width;
        self.force_n.x += x;
        self.force_n.y += y;
        self.force_n.z += z;
        let (r_x, r_y) = (place.radius * sin_phi, place.radius * cos_phi);
        self.moment_n_mm.x += r_y * z - place.height * y;
        self.moment_n_mm.y += place.height * x - r_x * z;
        self.moment_n_mm.z += r_x * y - r_y * x;
    }

    /// Mirrors the force at the plane of the feed and the axis.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        let (f, m) = (self.force_n, self.moment_n_mm);
        Self {
            force_n: Vector3::new(f.x, -f.y, f.z),
            moment_n_mm: Vector3::new(-m.x, m.y, -m.z),
        }
    }

    /// Force across the tool axis, N.
    #[must_use]
    pub fn in_plane_n(&self) -> f64 {
        self.force_n.xy().norm()
    }

    /// Torque of the spindle against the cut, N mm: positive where the cut brakes it.
    #[must_use]
    pub fn torque_n_mm(&self) -> f64 {
        self.moment_n_mm.z.abs()
    }
}

impl AddAssign for CutForce {
    fn add_assign(&mut self, other: Self) {
        self.force_n += other.force_n;
        self.moment_n_mm += other.moment_n_mm;
    }
}

impl Mul<f64> for CutForce {
    type Output = Self;

    fn mul(self, factor: f64) -> Self {
        Self {
            force_n: self.force_n * factor,
            moment_n_mm: self.moment_n_mm * factor,
        }
    }
}
