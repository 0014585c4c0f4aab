//! The thickest chip of an engagement, for the limits of a law of force.

use std::f64::consts::{FRAC_PI_2, TAU};

use kinetostat::number::larger;
use kinetostat_cutting::{Contact, Edge, Engagement, Feed, Tool};

/// Thickness of the thickest chip, mm, without run-out: `c sin phi sin kappa + d cos kappa` at the top of each contact.
pub(crate) fn thickest_chip_mm(engagement: &Engagement, feed: &Feed, tool: &Tool) -> f64 {
    let of = |contact: &Contact| match contact.edge {
        Edge::End => feed.down_mm,
        Edge::Side => {
            let (sin, cos) = normal_at(tool, contact.to_mm);
            feed.level_mm * largest_sine(contact) * sin + feed.down_mm * cos
        }
    };
    engagement.contacts.iter().map(of).fold(0.0, larger)
}

/// Sine and cosine of the angle between the axis and the outward normal at a height, mm.
fn normal_at(tool: &Tool, height_mm: f64) -> (f64, f64) {
    let corner = tool.corner_radius_mm();
    match height_mm < corner {
        true => {
            let cos = 1.0 - height_mm / corner;
            ((1.0 - cos * cos).sqrt(), cos)
        }
        false => tool.side_angle().sin_cos(),
    }
}

fn largest_sine(contact: &Contact) -> f64 {
    let length = contact.exit - contact.entry;
    match (FRAC_PI_2 - contact.entry).rem_euclid(TAU) <= length {
        true => 1.0,
        false => larger(contact.entry.sin(), contact.exit.sin()),
    }
}
