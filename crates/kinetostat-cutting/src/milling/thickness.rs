//! Chip thickness of a cut, to be compared with the range of a law of force and with the tool's limit.

use crate::engagement::Edge;
use crate::law::ForceLaw;
use crate::milling::cut::Milling;
use crate::number::larger;
use crate::tool::{Meridian, Piece};

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
