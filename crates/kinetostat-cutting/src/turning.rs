//! Force on a turning tool with a straight edge.
//!
//! Takes depth of cut, feed and approach angle; gives the force on the tool. With the angle `k` between the edge and the feed
//! the chip is `h = f sin k` thick and `b = a_p / sin k` wide. The corner radius is left out: it counts where the depth is
//! not several times that radius.

use crate::error::{CutErrorKind, Result, within};
use crate::law::ForceLaw;

/// A cut on a lathe: along the part, or across it (facing).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turning {
    depth_mm: f64,
    feed_mm_per_turn: f64,
    approach_angle: f64,
}

/// Force on a turning tool, and its chip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TurningForce {
    /// Force along the speed of the part at the edge, N.
    pub cutting_n: f64,
    /// Force against the feed, N.
    pub feed_n: f64,
    /// Force across the feed, away from the part, N. It does no work, and it bends the part.
    pub passive_n: f64,
    /// Thickness of the chip, mm.
    pub chip_mm: f64,
    /// Width of the chip, mm.
    pub width_mm: f64,
}

impl Turning {
    /// A cut of a depth (mm) with a feed (mm per turn) and an approach angle (between edge and feed, rad: 90 degrees is an
    /// edge across the feed).
    ///
    /// ```
    /// use kinetostat_cutting::{Kienzle, Turning};
    ///
    /// let law = Kienzle::new([1500.0, 500.0, 0.0], [0.25, 0.5, 0.0])?;
    /// let force = Turning::new(3.0, 0.4, 90_f64.to_radians())?.force(&law)?;
    /// assert!((force.cutting_n - 1500.0 * 3.0 * 0.4_f64.powf(0.75)).abs() < 1e-9); // N
    /// assert!(force.passive_n.abs() < 1e-9);
    /// # Ok::<(), kinetostat_cutting::CutError>(())
    /// ```
    ///
    /// # Errors
    /// A depth outside 1e-4 to 1000 mm, a feed outside 1e-6 to 100 mm, an angle outside 5 to 150 degrees.
    pub fn new(depth_mm: f64, feed_mm_per_turn: f64, approach_angle: f64) -> Result<Self> {
        let cut = CutErrorKind::Cut;
        within(cut, "depth of cut", depth_mm, 1e-4..=1e3, "mm")?;
        within(cut, "feed", feed_mm_per_turn, 1e-6..=100.0, "mm per turn")?;
        let degrees = approach_angle.to_degrees();
        within(
            CutErrorKind::Tool,
            "approach angle",
            degrees,
            5.0..=150.0,
            "deg",
        )?;
        Ok(Self {
            depth_mm,
            feed_mm_per_turn,
            approach_angle,
        })
    }

    /// Thickness of the chip, mm.
    #[must_use]
    pub fn chip_mm(&self) -> f64 {
        self.feed_mm_per_turn * self.approach_angle.sin()
    }

    /// Width of the chip, mm.
    #[must_use]
    pub fn width_mm(&self) -> f64 {
        self.depth_mm / self.approach_angle.sin()
    }

    /// Force on the tool. The law's radial part acts across the edge, its axial part along the edge from the corner outward.
    ///
    /// # Errors
    /// A force of the law that is no number.
    pub fn force(&self, law: &impl ForceLaw) -> Result<TurningForce> {
        let (chip_mm, width_mm) = (self.chip_mm(), self.width_mm());
        let force = law.edge_force(chip_mm) * width_mm;
        let (sin, cos) = self.approach_angle.sin_cos();
        let checked =
            |name: &str, value: f64| within(CutErrorKind::Cut, name, value, -1e12..=1e12, "N");
        Ok(TurningForce {
            cutting_n: checked("cutting force of the law", force.tangential)?,
            feed_n: checked(
                "feed force of the law",
                force.radial * sin - force.axial * cos,
            )?,
            passive_n: checked(
                "passive force of the law",
                force.radial * cos + force.axial * sin,
            )?,
            chip_mm,
            width_mm,
        })
    }
}

impl TurningForce {
    /// Power of the cut at a cutting speed in m/min, W; that of the feed, thousands of times slower, is left out.
    ///
    /// ```
    /// use kinetostat_cutting::{Linear, Turning};
    ///
    /// let law = Linear::new([2000.0, 800.0, 0.0], [0.0; 3])?;
    /// let force = Turning::new(2.0, 0.3, 75_f64.to_radians())?.force(&law)?;
    /// assert!((force.power_w(150.0) - 3000.0).abs() < 1e-9); // 1200 N at 2.5 m/s
    /// # Ok::<(), kinetostat_cutting::CutError>(())
    /// ```
    #[must_use]
    pub fn power_w(&self, speed_m_per_min: f64) -> f64 {
        self.cutting_n * speed_m_per_min / 60.0
    }
}
