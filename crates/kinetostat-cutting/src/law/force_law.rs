//! Interface of a law of force.

use std::fmt::Debug;
use std::ops::{Add, Mul};

/// Force per length of edge, N/mm.
///
/// The tooth pushes on the part along its way, and the part pushes back: the force on the tool is `tangential` against the
/// tooth's way, `radial` against the outward normal of the envelope and `axial` along the meridian towards the shank.
/// Literature on ball ends often has the opposite sign of the last.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EdgeForce {
    /// Force along the tooth's motion.
    pub tangential: f64,
    /// Force along the normal of the envelope: radially on a cylinder.
    pub radial: f64,
    /// Force along the edge: axially on a cylinder.
    pub axial: f64,
}

impl EdgeForce {
    /// The three of them.
    #[must_use]
    pub fn new(tangential: f64, radial: f64, axial: f64) -> Self {
        Self {
            tangential,
            radial,
            axial,
        }
    }
}

impl From<[f64; 3]> for EdgeForce {
    fn from([tangential, radial, axial]: [f64; 3]) -> Self {
        Self::new(tangential, radial, axial)
    }
}

impl Add for EdgeForce {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self::new(
            self.tangential + other.tangential,
            self.radial + other.radial,
            self.axial + other.axial,
        )
    }
}

impl Mul<f64> for EdgeForce {
    type Output = Self;

    fn mul(self, factor: f64) -> Self {
        Self::new(
            self.tangential * factor,
            self.radial * factor,
            self.axial * factor,
        )
    }
}

/// A law of force; whoever has another implements this for it.
///
/// ```
/// use kinetostat_cutting::{EdgeForce, Engagement, Feed, ForceLaw, Milling, Shape, Side, Tool};
///
/// /// A chip that costs the square root of its thickness.
/// #[derive(Debug)]
/// struct Root(f64);
///
/// impl ForceLaw for Root {
///     fn edge_force(&self, chip_mm: f64) -> EdgeForce {
///         let force = self.0 * chip_mm.sqrt();
///         EdgeForce::new(force, 0.3 * force, 0.1 * force)
///     }
/// }
///
/// let tool = Tool::new(Shape::Flat, 10.0, 2)?;
/// let engagement = Engagement::straight(5.0, 10.0, 1.0, Side::Left)?;
/// let force = Milling::new(&tool, &Root(200.0), &engagement, Feed::level(0.1)?).mean();
/// assert!(force.force_n.z > 0.0);
/// # Ok::<(), kinetostat_cutting::CutError>(())
/// ```
pub trait ForceLaw: Debug + Send + Sync {
    /// Force per length of edge, N/mm, with a chip of this thickness, mm, above zero.
    fn edge_force(&self, chip_mm: f64) -> EdgeForce;

    /// Thicknesses of chip, mm, between which its coefficients were measured; `None` where nothing is known.
    fn known_between_mm(&self) -> Option<(f64, f64)> {
        None
    }
}

impl<L: ForceLaw + ?Sized> ForceLaw for &L {
    fn edge_force(&self, chip_mm: f64) -> EdgeForce {
        (**self).edge_force(chip_mm)
    }

    fn known_between_mm(&self) -> Option<(f64, f64)> {
        (**self).known_between_mm()
    }
}
