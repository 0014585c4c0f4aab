//! Contact of a tool's edges with the material.
//!
//! Seen along the tool axis from the spindle, in the frame of the cut: x along the feed, z along the tool axis towards
//! the spindle, y to the left of the feed. An angle counts from +y clockwise, so that the point of the tool at an angle
//! `phi` lies at `r (sin phi, cos phi)`; the half from 0 to pi faces the feed. Angles are places, independent of the
//! spindle's rotation.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::error::{CutError, CutErrorKind, Result};
use crate::number::larger;

/// Edge of the tool in contact, and the direction of its extent.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Edge {
    /// Edges on the envelope of the tool (cylinder, ball, corner radius, cone): extent along the axis, from the tip.
    Side,
    /// Edges on the flat end: extent along the radius, from the axis. They cut only where the tool goes down.
    End,
}

/// A patch of the tool's envelope in the material: an extent of one edge times an arc.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema, Deserialize)]
pub struct Contact {
    /// Edge in contact.
    pub edge: Edge,
    /// Start of the contact: height above the tip, or radius, mm.
    pub from_mm: f64,
    /// End of the contact, mm.
    pub to_mm: f64,
    /// Angle at which the arc begins, rad, from 0 below one turn.
    pub entry: f64,
    /// Angle at which it ends, rad; beyond `entry` by at most one turn.
    pub exit: f64,
}

impl Contact {
    /// A patch of the side between two heights above the tip, mm, and two angles, rad.
    #[must_use]
    pub fn side(bottom_mm: f64, top_mm: f64, entry: f64, exit: f64) -> Self {
        Self {
            edge: Edge::Side,
            from_mm: bottom_mm,
            to_mm: top_mm,
            entry,
            exit,
        }
    }

    /// A patch of the flat end between two radii, mm, and two angles, rad.
    #[must_use]
    pub fn end(inner_mm: f64, outer_mm: f64, entry: f64, exit: f64) -> Self {
        Self {
            edge: Edge::End,
            from_mm: inner_mm,
            to_mm: outer_mm,
            entry,
            exit,
        }
    }
}

impl Contact {
    /// True if an angle (rad) lies on the arc, or within a tolerance (rad) of it.
    #[must_use]
    pub fn reaches(&self, angle: f64, within: f64) -> bool {
        let past = (angle - self.entry + within).rem_euclid(TAU);
        past <= self.exit - self.entry + 2.0 * within
    }

    /// Largest sine of an angle on the arc: where the chip of a level feed is thickest.
    pub(crate) fn largest_sine(&self) -> f64 {
        let ahead = (FRAC_PI_2 - self.entry).rem_euclid(TAU);
        match ahead <= self.exit - self.entry {
            true => 1.0,
            false => larger(self.entry.sin(), self.exit.sin()),
        }
    }
}

/// Side of the tool on which the part is, seen along the feed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    /// Left of the feed: conventional milling (up) with a spindle that turns clockwise.
    Left,
    /// Right of the feed: climb milling (down) with a spindle that turns clockwise.
    Right,
}

/// The contacts of a tool at one place of its path; none in air.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema, Deserialize)]
#[serde(transparent)]
pub struct Engagement {
    /// Patches that do not overlap.
    pub contacts: Vec<Contact>,
}

impl Engagement {
    /// Engagement without contact.
    #[must_use]
    pub fn air() -> Self {
        Self::default()
    }

    /// A straight cut `width_mm` wide and `depth_mm` deep with a tool of this radius at full depth, with the part on one
    /// side: `cos a = 1 - width/r` (`shared/theory/cutting.md`). A width of the diameter is a slot.
    ///
    /// ```
    /// use kinetostat_cutting::{Engagement, Side};
    ///
    /// let climb = Engagement::straight(6.0, 3.0, 2.0, Side::Right)?; // mm
    /// assert!((climb.contacts[0].entry.to_degrees() - 120.0).abs() < 1e-9);
    /// assert!((climb.contacts[0].exit.to_degrees() - 180.0).abs() < 1e-9);
    /// # Ok::<(), kinetostat_cutting::CutError>(())
    /// ```
    ///
    /// # Errors
    /// A width that is negative or more than the diameter; a negative depth.
    pub fn straight(radius_mm: f64, width_mm: f64, depth_mm: f64, part: Side) -> Result<Self> {
        let within =
            |quantity: &str, value: f64, most: f64, of: &str| match value >= 0.0 && value <= most {
                true => Ok(()),
                false => Err(CutError::new(
                    CutErrorKind::Cut,
                    quantity,
                    format!("{value} mm"),
                    format!("0 mm (air) to {most} mm ({of})"),
                )),
            };
        within(
            "width of cut",
            width_mm,
            2.0 * radius_mm,
            "the tool's diameter: a slot",
        )?;
        within("depth of cut", depth_mm, 1e4, "a tool's length")?;
        if width_mm == 0.0 || depth_mm == 0.0 {
            return Ok(Self::air());
        }
        let angle = (1.0 - width_mm / radius_mm).acos();
        let (entry, exit) = match part {
            Side::Left => (0.0, angle),
            Side::Right => (PI - angle, PI),
        };
        Ok(Self {
            contacts: vec![Contact::side(0.0, depth_mm, entry, exit)],
        })
    }

    /// A tool that goes straight down into full material: its whole end is in contact, its side is not.
    #[must_use]
    pub fn plunge(end_radius_mm: f64) -> Self {
        Self {
            contacts: vec![Contact::end(0.0, end_radius_mm, 0.0, TAU)],
        }
    }

    /// True without any contact.
    #[must_use]
    pub fn is_air(&self) -> bool {
        self.contacts.is_empty()
    }

    /// Length along the axis in contact, mm; 0 in air. What the tip leaves below the material does not count, nor do gaps
    /// between contacts.
    ///
    /// ```
    /// use kinetostat_cutting::{Contact, Engagement};
    ///
    /// // A plate of 3 mm, the tip 5 mm below it.
    /// let through = Engagement { contacts: vec![Contact::side(5.0, 8.0, 0.0, 1.0)] };
    /// assert_eq!((through.depth_mm(), through.reach_mm()), (3.0, 8.0));
    /// ```
    #[must_use]
    pub fn depth_mm(&self) -> f64 {
        let side = self.contacts.iter().filter(|c| c.edge == Edge::Side);
        let mut extents: Vec<[f64; 2]> = side.map(|c| [c.from_mm, c.to_mm]).collect();
        extents.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let (mut depth, mut counted) = (0.0, f64::NEG_INFINITY);
        for [from, to] in extents {
            let from = larger(from, counted);
            if to > from {
                depth += to - from;
                counted = to;
            }
        }
        depth
    }

    /// Greatest height above the tip in contact, mm: how long the edges must be; 0 in air.
    #[must_use]
    pub fn reach_mm(&self) -> f64 {
        self.contacts
            .iter()
            .filter(|contact| contact.edge == Edge::Side)
            .map(|contact| contact.to_mm)
            .fold(0.0, larger)
    }

    /// Mirrors the engagement at the plane of the feed and the axis: left becomes right.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        let mirror = |contact: &Contact| {
            let entry = (PI - contact.exit).rem_euclid(TAU);
            Contact {
                entry,
                exit: entry + (contact.exit - contact.entry),
                ..*contact
            }
        };
        Self {
            contacts: self.contacts.iter().map(mirror).collect(),
        }
    }
}
