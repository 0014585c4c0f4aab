//! A milling cut, and its force and moment on the tool.

use std::borrow::Cow;
use std::ops::{AddAssign, Mul};

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::engagement::Engagement;
use crate::law::{EdgeForce, ForceLaw};
use crate::milling::chip::{Chips, Feed};
use crate::tool::{Meridian, Tool};

/// Sense of rotation of the spindle, seen from it down to the tool.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Rotation {
    /// M3.
    #[default]
    Clockwise,
    /// M4.
    CounterClockwise,
}

/// A cut of a milling tool with a law of force.
#[derive(Clone, Debug)]
pub struct Milling<'a, L: ForceLaw + ?Sized> {
    pub(crate) tool: &'a Tool,
    pub(crate) law: &'a L,
    pub(crate) engagement: Cow<'a, Engagement>,
    pub(crate) feed: Feed,
    pub(crate) chips: Chips,
    pub(crate) rotation: Rotation,
}

impl<'a, L: ForceLaw + ?Sized> Milling<'a, L> {
    /// A cut with a spindle that turns clockwise (M3).
    #[must_use]
    pub fn new(tool: &'a Tool, law: &'a L, engagement: &'a Engagement, feed: Feed) -> Self {
        Self {
            tool,
            law,
            engagement: Cow::Borrowed(engagement),
            feed,
            chips: Chips::new(tool),
            rotation: Rotation::Clockwise,
        }
    }

    /// Sets the sense of rotation: counter-clockwise is the mirror image of clockwise.
    #[must_use]
    pub fn turning(mut self, rotation: Rotation) -> Self {
        if rotation != self.rotation {
            self.engagement = Cow::Owned(self.engagement.mirrored());
            self.rotation = rotation;
        }
        self
    }

    /// Converts a result for a clockwise spindle to the actual sense of rotation.
    pub(crate) fn as_it_turns<T>(&self, of: T, mirrored: impl FnOnce(&T) -> T) -> T {
        match self.rotation {
            Rotation::Clockwise => of,
            Rotation::CounterClockwise => mirrored(&of),
        }
    }
}

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
