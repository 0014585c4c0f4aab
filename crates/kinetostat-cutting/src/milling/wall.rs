//! The force at the moment at which a tooth makes the surface.
//!
//! A point of a wall is made when the edge at its height passes it: `phi = pi` on the right of the feed, `phi = 0` on the left.
//! What bends the tool away at that moment prints into the wall; the mean does not (`shared/theory/cutting.md`).

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

use crate::engagement::{Contact, Edge, Side};
use crate::law::ForceLaw;
use crate::milling::cut::{Milling, Rotation};
use crate::milling::cut_force::CutForce;
use crate::number::integrate;

/// A wall that the tool leaves, parallel to the feed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
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
