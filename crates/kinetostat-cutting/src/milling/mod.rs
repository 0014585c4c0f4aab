//! Forces of a milling cutter from its engagement.
//!
//! Takes a tool, a law of force, an engagement and a feed; gives the force over the revolution, its mean, peaks and harmonics,
//! and the force at the moment at which a tooth makes the surface. `shared/theory/cutting.md`.
//!
//! Nothing is divided into slices of fixed size: between the places at which a chip begins, ends or changes the tooth that it
//! follows, the sums are integrals of smooth functions, and are taken by Gauss's rule.
//!
//! The force at the moment at which a tooth makes the surface.
//!
//! A point of a wall is made when the edge at its height passes it: `phi = pi` on the right of the feed, `phi = 0` on the left.
//! What bends the tool away at that moment prints into the wall; the mean does not (`shared/theory/cutting.md`).

mod chip;
mod cut;
mod instant;
mod mean;
mod peak;
mod table;

use std::f64::consts::PI;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::engagement::{Contact, Edge, Side};
use crate::law::ForceLaw;
use crate::number::{integrate, larger};
use crate::tool::{Meridian, Piece};

pub use chip::Feed;
pub use cut::{CutForce, Milling, Rotation};
pub use mean::{Harmonic, Revolution};
pub use peak::{Peak, Peaks};
pub use table::MeanTable;

/// Places of a corner at which chips are looked at, and angles of an arc.
const CORNER_PLACES: usize = 32;
const ANGLES: usize = 720;

/// Thicknesses of the chips of a cut, over all edges in contact and all angles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChipThickness {
    /// The thickest place of a chip, mm.
    pub largest_mm: f64,
    /// Mean over the edges and angles at which there is a chip, mm.
    pub mean_mm: f64,
}

impl<L: ForceLaw + ?Sized> Milling<'_, L> {
    /// Chip thickness; `None` without a cut.
    ///
    /// ```
    /// use kinetostat_cutting::{Engagement, Feed, Linear, Milling, Shape, Side, Tool};
    ///
    /// let tool = Tool::new(Shape::Flat, 10.0, 2)?;
    /// let law = Linear::new([800.0, 200.0, 100.0], [20.0, 20.0, 0.0])?;
    /// let slot = Engagement::straight(5.0, 10.0, 1.0, Side::Left)?;
    /// let chip = Milling::new(&tool, &law, &slot, Feed::level(0.1)?).chip_thickness().unwrap();
    /// assert!((chip.largest_mm - 0.1).abs() < 1e-9); // the feed per tooth, in the middle of a slot
    /// assert!((chip.mean_mm - 0.2 / std::f64::consts::PI).abs() < 1e-6);
    /// # Ok::<(), kinetostat_cutting::CutError>(())
    /// ```
    #[must_use]
    pub fn chip_thickness(&self) -> Option<ChipThickness> {
        let (mut sum, mut length) = (0.0, 0.0);
        for contact in &self.engagement.contacts {
            let arc = contact.exit - contact.entry;
            let mut look = |place: &Meridian, width: f64| {
                for tooth in &self.chips.teeth {
                    let at = |share: f64| {
                        tooth.thickness(&self.feed, place, (contact.entry + share * arc).sin())
                    };
                    for i in 0..ANGLES {
                        let chip = at((i as f64 + 0.5) / ANGLES as f64);
                        if chip > 0.0 {
                            let weight = tooth.alike * width * arc;
                            sum += chip * weight;
                            length += weight;
                        }
                    }
                }
            };
            if contact.edge == Edge::End {
                let middle = 0.5 * (contact.from_mm + contact.to_mm);
                look(&Meridian::of_end(middle), contact.to_mm - contact.from_mm);
                continue;
            }
            for (piece, from, to) in Piece::between(self.tool, contact.from_mm, contact.to_mm) {
                let places = match piece {
                    Piece::Straight { .. } => 1,
                    Piece::Corner { .. } => CORNER_PLACES,
                };
                let step = (to - from) / places as f64;
                for i in 0..places {
                    let place = piece.point(from + step * (i as f64 + 0.5));
                    look(&place, place.width * step);
                }
            }
        }
        (length > 0.0).then(|| ChipThickness {
            largest_mm: self.largest_chip_mm(),
            mean_mm: sum / length,
        })
    }

    /// Thickness of the thickest chip, mm; 0 where nothing is cut.
    ///
    /// ```
    /// use kinetostat_cutting::{Engagement, Feed, Linear, Milling, Shape, Side, Tool};
    ///
    /// let tool = Tool::new(Shape::Flat, 10.0, 2)?;
    /// let law = Linear::new([800.0, 200.0, 100.0], [20.0, 20.0, 0.0])?;
    /// let narrow = Engagement::straight(5.0, 0.1, 1.0, Side::Right)?;
    /// let chip = Milling::new(&tool, &law, &narrow, Feed::level(0.1)?).largest_chip_mm();
    /// assert!((chip - 0.1 * 0.98_f64.acos().sin()).abs() < 1e-12); // c sin(acos(1 - ae/r))
    /// # Ok::<(), kinetostat_cutting::CutError>(())
    /// ```
    #[must_use]
    pub fn largest_chip_mm(&self) -> f64 {
        let mut largest = 0.0;
        for contact in &self.engagement.contacts {
            let sine = contact.largest_sine();
            // Each tooth's chip grows with the way of the feed, so it is thickest where that is longest.
            let mut look = |place: &Meridian| {
                for tooth in &self.chips.teeth {
                    largest = larger(largest, tooth.thickness(&self.feed, place, sine));
                }
            };
            match contact.edge {
                Edge::End => look(&Meridian::of_end(contact.to_mm)),
                Edge::Side => {
                    for (piece, from, to) in
                        Piece::between(self.tool, contact.from_mm, contact.to_mm)
                    {
                        // The parameter on a corner is the angle of the normal: the way along it is longest where it
                        // points along the feed.
                        let along = (self.feed.level_mm * sine).atan2(self.feed.down_mm);
                        for at in [from, to, along.clamp(from, to)] {
                            look(&piece.point(at));
                        }
                    }
                }
            }
        }
        largest
    }
}

/// A wall that the tool leaves, parallel to the feed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Wall {
    /// Left of the feed.
    Left,
    /// Right of the feed.
    Right,
}

impl From<Side> for Wall {
    fn from(part: Side) -> Self {
        match part {
            Side::Left => Self::Left,
            Side::Right => Self::Right,
        }
    }
}

/// An arc ends at a wall if it comes this close to it, rad.
const AT_THE_WALL: f64 = 1e-3;

impl Wall {
    /// Angle of the wall from the axis, rad.
    fn angle(self) -> f64 {
        match self {
            Self::Left => 0.0,
            Self::Right => PI,
        }
    }

    fn mirrored(self) -> Self {
        match self {
            Self::Left => Self::Right,
            Self::Right => Self::Left,
        }
    }
}

impl<L: ForceLaw + ?Sized> Milling<'_, L> {
    /// Force on the tool when the edge at a height above the tip (mm) passes a wall.
    ///
    /// With run-out the tooth that stands out furthest makes the wall.
    ///
    /// ```
    /// use kinetostat_cutting::{Engagement, Feed, Linear, Milling, Shape, Side, Tool, Wall};
    ///
    /// let tool = Tool::new(Shape::Flat, 12.0, 4)?.with_helix(38_f64.to_radians())?;
    /// let law = Linear::new([796.0, 168.0, 222.0], [27.7, 30.8, 1.4])?;
    /// let climb = Engagement::straight(6.0, 4.0, 8.0, Side::Right)?;
    /// let cut = Milling::new(&tool, &law, &climb, Feed::level(0.1)?);
    /// assert!((cut.at_wall(Wall::Right, 4.0).force_n.y - 341.935).abs() < 0.1); // N; the mean is 465.8
    /// # Ok::<(), kinetostat_cutting::CutError>(())
    /// ```
    #[must_use]
    pub fn at_wall(&self, wall: Wall, height_mm: f64) -> CutForce {
        let force = self.at_wall_clockwise(self.wall_as_it_turns(wall), height_mm);
        self.as_it_turns(force, CutForce::mirrored)
    }

    /// Mean of [`Self::at_wall`] over the heights at which the tool is in contact with the wall; `None` where it makes none.
    #[must_use]
    pub fn surface_generation(&self, wall: Wall) -> Option<CutForce> {
        let wall = self.wall_as_it_turns(wall);
        let makes = |contact: &&Contact| {
            contact.edge == Edge::Side && contact.reaches(wall.angle(), AT_THE_WALL)
        };
        let (mut sum, mut length) = (CutForce::default(), 0.0);
        for contact in self.engagement.contacts.iter().filter(makes) {
            length += contact.to_mm - contact.from_mm;
            integrate(contact.from_mm, contact.to_mm, |height, weight| {
                sum += self.at_wall_clockwise(wall, height) * weight;
            });
        }
        let mean = (length > 0.0).then(|| sum * f64::recip(length))?;
        Some(self.as_it_turns(mean, CutForce::mirrored))
    }

    fn wall_as_it_turns(&self, wall: Wall) -> Wall {
        match self.rotation {
            Rotation::Clockwise => wall,
            Rotation::CounterClockwise => wall.mirrored(),
        }
    }

    fn at_wall_clockwise(&self, wall: Wall, height_mm: f64) -> CutForce {
        let mut furthest = 0;
        for tooth in 1..self.tool.teeth() {
            if self.tool.stands_out_mm(tooth) > self.tool.stands_out_mm(furthest) {
                furthest = tooth;
            }
        }
        let lag = self.tool.lag_per_mm() * height_mm;
        self.at_clockwise(wall.angle() + lag - self.tool.pitch() * furthest as f64)
    }
}
