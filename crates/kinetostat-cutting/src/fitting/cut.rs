//! The cut in which mean forces were measured, and the closed form of the mean force in it.

use std::f64::consts::PI;

use crate::engagement::{Contact, Edge, Engagement};
use crate::error::{CutError, CutErrorKind, Result};
use crate::law::Linear;
use crate::tool::{Shape, Tool};

/// A cut with one arc of engagement: a slot or partial immersion.
///
/// The mean force of the linear law does not depend on helix and radius; the radius makes the arc of a width of cut
/// ([`Engagement::straight`]).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasuredCut {
    teeth: f64,
    depth_mm: f64,
    entry: f64,
    exit: f64,
    /// Half the diameter: a tooth that moves on by more from turn to turn is a mistake of units.
    most_feed_mm: f64,
}

impl MeasuredCut {
    /// A cut with this tool and engagement.
    ///
    /// ```
    /// use kinetostat_cutting::{Engagement, MeasuredCut, Shape, Side, Tool};
    ///
    /// let tool = Tool::new(Shape::Flat, 20.0, 4)?;
    /// let slot = Engagement::straight(tool.radius_mm(), 20.0, 2.0, Side::Left)?; // mm
    /// assert!(MeasuredCut::new(&tool, &slot).is_ok());
    /// assert!(MeasuredCut::new(&tool, &Engagement::air()).is_err());
    /// # Ok::<(), kinetostat_cutting::CutError>(())
    /// ```
    ///
    /// # Errors
    /// A tool that is not flat; no contact, more than one, or one that is not on the side; an arc that is not within 0 to 180
    /// degrees, where the tool feeds into the material.
    pub fn new(tool: &Tool, engagement: &Engagement) -> Result<Self> {
        let refuse = |quantity: &str, found: String, expected: &str| {
            Err(CutError::new(
                CutErrorKind::Measurement,
                quantity,
                found,
                expected,
            ))
        };
        if tool.shape() != Shape::Flat {
            let found = format!("{:?}", tool.shape());
            return refuse(
                "shape of the tool",
                found,
                "a flat cutter: others have no closed form here",
            );
        }
        let [contact] = engagement.contacts[..] else {
            let found = format!("{} contacts", engagement.contacts.len());
            return refuse("engagement", found, "one arc on the side of the tool");
        };
        let depth_mm = contact.to_mm - contact.from_mm;
        if contact.edge != Edge::Side || !(1e-6..=1e4).contains(&depth_mm) {
            let found = format!("{:?}, {depth_mm} mm deep", contact.edge);
            return refuse(
                "engagement",
                found,
                "a contact of the side, 0.000001 to 10000 mm deep",
            );
        }
        let (entry, exit) = (contact.entry, contact.exit);
        // Half a turn need not be exactly pi in a caller's numbers.
        if !(entry >= -1e-9 && exit - entry > 1e-6 && exit <= PI + 1e-9) {
            let found = format!("{} to {} deg", entry.to_degrees(), exit.to_degrees());
            return refuse(
                "arc of engagement",
                found,
                "a part of 0 to 180 deg, where the feed makes a chip",
            );
        }
        Ok(Self {
            teeth: tool.teeth() as f64,
            depth_mm,
            entry,
            exit,
            most_feed_mm: tool.radius_mm(),
        })
    }

    /// Mean force on the tool of a linear law, N: along the feed, to its left, along the axis towards the spindle.
    /// Feed per tooth in mm.
    ///
    /// ```
    /// use kinetostat_cutting::{Engagement, Linear, MeasuredCut, Shape, Side, Tool};
    ///
    /// let tool = Tool::new(Shape::Flat, 20.0, 4)?;
    /// let slot = Engagement::straight(10.0, 20.0, 2.0, Side::Left)?;
    /// let law = Linear::new([800.0, 0.0, 0.0], [0.0; 3])?;
    /// let [x, y, z] = MeasuredCut::new(&tool, &slot)?.mean_force_n(&law, 0.1);
    /// // A slot: N a c K_tc/4 to the left, and nothing else.
    /// assert!((y - 4.0 * 2.0 * 0.1 * 800.0 / 4.0).abs() < 1e-9 && x.abs() < 1e-9 && z == 0.0);
    /// # Ok::<(), kinetostat_cutting::CutError>(())
    /// ```
    #[must_use]
    pub fn mean_force_n(&self, law: &Linear, feed_mm_per_tooth: f64) -> [f64; 3] {
        let ([t, r, a], [t_e, r_e, a_e]) = (law.cutting_n_per_mm2, law.edge_n_per_mm);
        let [x, y] = self.plane_rows(feed_mm_per_tooth);
        let z = self.axial_row(feed_mm_per_tooth);
        let of = |row: [f64; 4]| row[0] * t + row[1] * r + row[2] * t_e + row[3] * r_e;
        [of(x), of(y), z[0] * a + z[1] * a_e]
    }

    /// Largest thickness of chip at a feed per tooth, mm.
    pub(crate) fn largest_chip_mm(&self, feed_mm_per_tooth: f64) -> f64 {
        feed_mm_per_tooth * Contact::side(0.0, self.depth_mm, self.entry, self.exit).largest_sine()
    }

    /// Feeds per tooth above this are refused, mm.
    pub(crate) fn most_feed_mm(&self) -> f64 {
        self.most_feed_mm
    }

    /// Thickness of chip at a feed per tooth in the mean over the arc, mm.
    pub(crate) fn mean_chip_mm(&self, feed_mm_per_tooth: f64) -> f64 {
        feed_mm_per_tooth * (self.entry.cos() - self.exit.cos()) / (self.exit - self.entry)
    }

    /// Coefficients of `K_tc`, `K_rc`, `K_te` and `K_re` in the mean force along x and along y.
    pub(crate) fn plane_rows(&self, feed: f64) -> [[f64; 4]; 2] {
        let between = |of: fn(f64) -> f64| of(self.exit) - of(self.entry);
        let double_cosine = between(|phi| (2.0 * phi).cos());
        let swept = between(|phi| 2.0 * phi - (2.0 * phi).sin());
        let (sine, cosine) = (between(f64::sin), between(f64::cos));
        let edge = self.teeth * self.depth_mm / (2.0 * PI);
        let chip = edge * feed / 4.0;
        [
            [
                chip * double_cosine,
                -chip * swept,
                -edge * sine,
                edge * cosine,
            ],
            [
                chip * swept,
                chip * double_cosine,
                -edge * cosine,
                -edge * sine,
            ],
        ]
    }

    /// Coefficients of `K_ac` and `K_ae` in the mean force along z.
    pub(crate) fn axial_row(&self, feed: f64) -> [f64; 2] {
        let edge = self.teeth * self.depth_mm / (2.0 * PI);
        let cosine = self.exit.cos() - self.entry.cos();
        [-edge * feed * cosine, edge * (self.exit - self.entry)]
    }
}
