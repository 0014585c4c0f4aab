//! Thrust and torque of a drill in full material or in a hole that is there.
//!
//! Knows the geometry of straight lips; takes a law of force and a feed, gives forces on the drill. The lips of a drill with
//! the half point angle `k` cut chips of `h = f/N sin k` over `b = (d - d_0)/2 / sin k` (feed `f` in a turn, `N` lips, hole
//! `d_0`); `shared/theory/cutting.md`, "Closed forms". What the chisel edge in the middle presses is no cut and in no law of
//! force: it is a factor that the user gives.

use std::f64::consts::TAU;

use crate::error::{CutErrorKind, Result, within};
use crate::law::ForceLaw;

/// A drill with straight lips.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drill {
    diameter_mm: f64,
    lips: usize,
    half_point_angle: f64,
    hole_mm: f64,
    chisel_factor: f64,
}

/// Force on a drill, and the chip of a lip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DrillForce {
    /// Thrust along the axis towards the spindle, the chisel's part included, N.
    pub thrust_n: f64,
    /// Thrust of the lips alone, N.
    pub lips_thrust_n: f64,
    /// Torque that the spindle must give, N mm.
    pub torque_n_mm: f64,
    /// Force on one lip against its way, N.
    pub cutting_per_lip_n: f64,
    /// Thickness of the chip of a lip, mm.
    pub chip_mm: f64,
    /// Length of a lip in the material, mm.
    pub lip_mm: f64,
}

impl Drill {
    /// A drill in full material; diameter in mm, point angle (between the lips, 118 degrees on many drills) in rad. The
    /// chisel presses nothing until [`Drill::with_chisel_factor`] says otherwise.
    ///
    /// ```
    /// use kinetostat_cutting::{Drill, Kienzle};
    ///
    /// // k_c = 2200 N/mm^2 whatever the chip, and 0.63 of it along the feed; a drill with a flat end.
    /// let law = Kienzle::new([2200.0, 0.63 * 2200.0, 0.0], [0.0; 3])?;
    /// let force = Drill::new(22.0, 2, 180_f64.to_radians())?.force(&law, 0.15)?;
    /// assert!((force.torque_n_mm - 19_965.0).abs() < 1e-6); // k_c f d^2/8, 20 N m
    /// assert!((force.thrust_n - 2286.9).abs() < 1e-9); // N
    /// # Ok::<(), kinetostat_cutting::CutError>(())
    /// ```
    ///
    /// # Errors
    /// A diameter outside 0.01 to 1000 mm, lips other than 1 to 8, a point angle outside 40 to 180 degrees.
    pub fn new(diameter_mm: f64, lips: usize, point_angle: f64) -> Result<Self> {
        let tool = CutErrorKind::Tool;
        within(tool, "diameter", diameter_mm, 0.01..=1000.0, "mm")?;
        within(tool, "lips", lips as f64, 1.0..=8.0, "")?;
        let degrees = point_angle.to_degrees();
        // 180 degrees come back from radians with an error of their last digit.
        within(tool, "point angle", degrees, 40.0..=180.0 + 1e-9, "deg")?;
        Ok(Self {
            diameter_mm,
            lips,
            half_point_angle: 0.5 * point_angle,
            hole_mm: 0.0,
            chisel_factor: 1.0,
        })
    }

    /// Opens an existing hole of this diameter, mm. The chisel then cuts nothing, and its factor has no effect.
    ///
    /// ```
    /// use kinetostat_cutting::{Drill, Linear};
    ///
    /// let law = Linear::new([1800.0, 900.0, 0.0], [0.0; 3])?;
    /// let full = Drill::new(10.0, 2, 118_f64.to_radians())?;
    /// let wider = full.in_hole(5.0)?.force(&law, 0.2)?;
    /// // Three quarters of the area, and that at the outside: (1 - 1/4) of the torque.
    /// assert!((wider.torque_n_mm / full.force(&law, 0.2)?.torque_n_mm - 0.75).abs() < 1e-12);
    /// # Ok::<(), kinetostat_cutting::CutError>(())
    /// ```
    ///
    /// # Errors
    /// A hole that is negative or as wide as the drill.
    pub fn in_hole(mut self, hole_mm: f64) -> Result<Self> {
        let most = self.diameter_mm.next_down();
        within(CutErrorKind::Cut, "hole", hole_mm, 0.0..=most, "mm")?;
        self.hole_mm = hole_mm;
        Ok(self)
    }

    /// Sets the ratio of the thrust of lips and chisel together to that of the lips: 1 where the point is thinned to
    /// nothing, about 2 where the chisel takes as much as the lips. Measure it: no law of force gives it.
    ///
    /// ```
    /// use kinetostat_cutting::{Drill, Linear};
    ///
    /// let law = Linear::new([1800.0, 900.0, 0.0], [0.0; 3])?;
    /// let drill = Drill::new(10.0, 2, 118_f64.to_radians())?.with_chisel_factor(1.8)?;
    /// let force = drill.force(&law, 0.2)?;
    /// assert_eq!(force.thrust_n, 1.8 * force.lips_thrust_n);
    /// # Ok::<(), kinetostat_cutting::CutError>(())
    /// ```
    ///
    /// # Errors
    /// A factor outside 1 to 5.
    pub fn with_chisel_factor(mut self, factor: f64) -> Result<Self> {
        within(CutErrorKind::Tool, "chisel factor", factor, 1.0..=5.0, "")?;
        self.chisel_factor = factor;
        Ok(self)
    }

    /// Force with a feed in mm per turn. The law's radial part acts across the lip, its axial part along the lip towards the
    /// shank, as on the corner of a cutter.
    ///
    /// # Errors
    /// A feed outside 1e-6 to 100 mm, a force of the law that is no number.
    pub fn force(&self, law: &impl ForceLaw, feed_mm_per_turn: f64) -> Result<DrillForce> {
        let cut = CutErrorKind::Cut;
        within(cut, "feed", feed_mm_per_turn, 1e-6..=100.0, "mm per turn")?;
        let lips = self.lips as f64;
        let (sin, cos) = self.half_point_angle.sin_cos();
        let chip_mm = feed_mm_per_turn / lips * sin;
        let (inner, outer) = (0.5 * self.hole_mm, 0.5 * self.diameter_mm);
        let lip_mm = (outer - inner) / sin;
        let force = law.edge_force(chip_mm);
        let lips_thrust_n = lips * lip_mm * (force.radial * sin + force.axial * cos);
        let chisel = match self.hole_mm > 0.0 {
            true => 1.0,
            false => self.chisel_factor,
        };
        let cutting_per_lip_n = force.tangential * lip_mm;
        let torque_n_mm = lips * cutting_per_lip_n * 0.5 * (outer + inner);
        within(cut, "torque of the law", torque_n_mm, -1e12..=1e12, "N mm")?;
        within(cut, "thrust of the law", lips_thrust_n, -1e12..=1e12, "N")?;
        Ok(DrillForce {
            thrust_n: chisel * lips_thrust_n,
            lips_thrust_n,
            torque_n_mm,
            cutting_per_lip_n,
            chip_mm,
            lip_mm,
        })
    }
}

impl DrillForce {
    /// Power of the torque at a speed in rpm, W.
    ///
    /// ```
    /// use kinetostat_cutting::{Drill, Linear};
    ///
    /// let law = Linear::new([2200.0, 0.0, 0.0], [0.0; 3])?;
    /// let force = Drill::new(22.0, 2, 180_f64.to_radians())?.force(&law, 0.15)?;
    /// assert!((force.power_w(2894.0) - 6051.0).abs() < 1.0);
    /// # Ok::<(), kinetostat_cutting::CutError>(())
    /// ```
    #[must_use]
    pub fn power_w(&self, rpm: f64) -> f64 {
        1e-3 * self.torque_n_mm * TAU * rpm / 60.0
    }
}
