//! Mass along an elastic link, and how its slices move with the two ends of a segment [D 5, D7].
//!
//! A segment of length `h` has its near end at one node and its far end at another. What the far end does relative to
//! the near one is `eta = (u, v, w, rx, ry, rz)`: translations along the near axes, then turns `Rx Ry Rz`. A slice at
//! `xi = x / h` moves by shares of `eta`, those of a beam loaded at its end:
//!
//! ```text
//! u(xi)  = xi u,   rx(xi) = xi rx
//! v(xi)  = [(3 xi^2 - 2 xi^3 + Phi xi) v + h (xi^3 - xi^2 + Phi/2 (xi^2 - xi)) rz] / (1 + Phi)
//! rz(xi) = [6 (xi - xi^2) v/h + (3 xi^2 - 2 xi + Phi xi) rz] / (1 + Phi)         w, ry likewise with -ry
//! ```
//!
//! Four slices at Gauss' points integrate the squares of these exactly, so that a segment is the consistent mass of the
//! beam element, and its weight acts where its mass is. `eta` is read from the poses of the nodes: whichever
//! convention the spring of the segment has, its mass moves in this way.

use nalgebra::{Matrix6, Vector3, Vector6};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

use crate::model::beam::BeamSection;

/// Distribution of a link's mass.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum MassModel {
    /// Along the link, moving as the link bends: frequencies converge with the fourth power of the segments.
    #[default]
    Consistent,
    /// Half of every segment's mass at each of its ends, without inertia of its own: second power, and a link hinged at
    /// both ends has no mode of its own in one segment.
    HalvesAtEnds,
}

/// Mass of a link by its length.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct LinkMass {
    /// Mass per length, kg/m.
    pub per_length: f64,
    /// Inertia of a slice about its three axes (x along the link) by its thickness, kg m: `rho (Iy + Iz)`, `rho Iy`,
    /// `rho Iz`. Zero for a thin link.
    pub rotary: [f64; 3],
    /// Distribution of the mass.
    pub model: MassModel,
}

impl LinkMass {
    /// Mass of a section of a material of this density, kg/m^3, with the inertia of its slices. Torsion goes by the
    /// polar moment, not by the torsion constant.
    ///
    /// ```
    /// # use kinetostat::{BeamSection, model::LinkMass};
    /// let bar = BeamSection::tube(2.1e11, 8.1e10, 0.04, 0.03); // Pa, m
    /// let mass = LinkMass::of_section(&bar, 7850.0); // kg/m^3
    /// assert_eq!(mass.per_length, 7850.0 * bar.area);
    /// assert_eq!(mass.thin().rotary, [0.0; 3]);
    /// ```
    #[must_use]
    pub fn of_section(section: &BeamSection, density: f64) -> Self {
        let (y, z) = (section.second_moment_y, section.second_moment_z);
        Self {
            per_length: density * section.area,
            rotary: [density * (y + z), density * y, density * z],
            model: MassModel::Consistent,
        }
    }

    /// Removes the inertia of the slices about their own axes.
    #[must_use]
    pub fn thin(mut self) -> Self {
        self.rotary = [0.0; 3];
        self
    }

    /// Sets the distribution of the mass.
    #[must_use]
    pub fn with_model(mut self, model: MassModel) -> Self {
        self.model = model;
        self
    }

    /// Describes the fault of its numbers.
    pub(crate) fn fault(&self) -> Option<String> {
        let m = self.per_length;
        if !(m.is_finite() && m >= 0.0) {
            return Some(format!(
                "its mass is {m} kg/m, a number not below zero is needed"
            ));
        }
        let bad = self.rotary.iter().find(|x| !(x.is_finite() && **x >= 0.0));
        bad.map(|x| {
            format!("the inertia of its slices is {x} kg m, a number not below zero is needed")
        })
    }
}

/// Mass of one segment of a link, between two nodes.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct SegmentMass {
    /// Name of the link.
    pub link: String,
    /// Index of the segment's spring among [`crate::Chain::springs`].
    pub spring: usize,
    /// Node at its near end, x along the link.
    pub near: usize,
    /// Node at its far end.
    pub far: usize,
    /// Length of the segment, m.
    pub length: f64,
    /// Mass of the link by its length.
    pub mass: LinkMass,
    /// Shear ratios `12 EI / (k G A h^2)` of bending along y and along z; zero for a slender link.
    pub shear: [f64; 2],
}

/// A slice of a segment: what of it moves, and by which shares of the far end's motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slice {
    /// Place along the segment, 0 to 1.
    pub place: f64,
    /// Mass, kg.
    pub mass: f64,
    /// Inertia about its own axes, kg m^2.
    pub inertia: Vector3<f64>,
    /// Translations `(u, v, w)` of the slice by `eta`, 3 x 6.
    pub translations: [Vector6<f64>; 3],
    /// Turns `(rx, ry, rz)` of the slice by `eta`, 3 x 6.
    pub turns: [Vector6<f64>; 3],
}

/// Points and weights of Gauss' rule of four points on 0 to 1.
const GAUSS: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

/// Deflection and slope of a plane of bending at `x` by deflection and slope of the end, [D7].
fn bending(x: f64, h: f64, phi: f64) -> ([f64; 2], [f64; 2]) {
    let by = 1.0 / (1.0 + phi);
    let deflection = [
        (3.0 * x * x - 2.0 * x * x * x + phi * x) * by,
        h * (x * x * x - x * x + 0.5 * phi * (x * x - x)) * by,
    ];
    let slope = [
        6.0 * (x - x * x) / h * by,
        (3.0 * x * x - 2.0 * x + phi * x) * by,
    ];
    (deflection, slope)
}

impl SegmentMass {
    /// Slices of the segment.
    #[must_use]
    pub fn slices(&self) -> [Slice; 4] {
        GAUSS.map(|(place, weight)| {
            let ((v, rz), (w, ry)) = (
                bending(place, self.length, self.shear[0]),
                bending(place, self.length, self.shear[1]),
            );
            let size = self.length * weight;
            Slice {
                place,
                mass: self.mass.per_length * size,
                inertia: Vector3::from(self.mass.rotary) * size,
                translations: [
                    Vector6::new(place, 0.0, 0.0, 0.0, 0.0, 0.0),
                    Vector6::new(0.0, v[0], 0.0, 0.0, 0.0, v[1]),
                    Vector6::new(0.0, 0.0, w[0], 0.0, -w[1], 0.0),
                ],
                turns: [
                    Vector6::new(0.0, 0.0, 0.0, place, 0.0, 0.0),
                    Vector6::new(0.0, 0.0, -ry[0], 0.0, ry[1], 0.0),
                    Vector6::new(0.0, rz[0], 0.0, 0.0, 0.0, rz[1]),
                ],
            }
        })
    }

    /// Mass of the segment, kg.
    #[must_use]
    pub fn total(&self) -> f64 {
        self.mass.per_length * self.length
    }
}

/// Shear ratios of bending along y and along z of a segment of length `h` from the stiffness at its end.
pub(crate) fn shear_ratios(end: &Matrix6<f64>, h: f64) -> [f64; 2] {
    [(1, 5), (2, 4)].map(|(across, turn)| {
        let ratio = 12.0 * end[(turn, turn)] / (end[(across, across)] * h * h) - 4.0;
        // Rounding of a slender link, and matrices that are no beam's.
        if ratio.is_finite() && ratio > 1e-9 {
            ratio
        } else {
            0.0
        }
    })
}
