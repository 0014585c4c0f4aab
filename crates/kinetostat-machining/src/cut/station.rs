//! Force and engagement of the tool at one place of a cut.

use std::f64::consts::TAU;

use kinetostat::Wrench;
use kinetostat_cutting::{Edge, Engagement};
use nalgebra::Vector3;
use serde::Serialize;

/// Part of a direction across the tool axis below which a move has no direction there: within 0.1 degree of the axis.
pub(crate) const ACROSS: f64 = 2e-3;

/// Heading of a direction, seen along z of the part frame, rad; `None` along z.
pub(crate) fn heading(tangent: Option<Vector3<f64>>) -> Option<f64> {
    let t = tangent?;
    (t.xy().norm() > ACROSS).then(|| t.y.atan2(t.x))
}

/// Moves shorter than this, mm, do not turn the load: a tooth's feed is several times as long, and programs from CAM
/// systems have moves of tenths of micrometres in any direction.
pub(crate) const SHORT_MM: f64 = 0.01;

/// A place of the path with the force of the cut.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Default)]
pub struct CutStation {
    /// Share of the move's length.
    pub share: f64,
    /// Force (N) and moment about the tip (N m) on the tool: x along the feed, z along the part's z, y to the left; axes of
    /// the part where the tool goes within 0.1 degree of its axis.
    pub wrench: Wrench,
    /// Mean torque of the spindle, N m.
    pub torque_n_m: f64,
    /// Length of the edges in contact along the axis, mm, without what the tip leaves below the stock; 0 in air.
    pub depth_mm: f64,
    /// Sum of the arcs in contact at the lowest height, rad: pi in a slot, 0 in air.
    pub arc: f64,
    /// Contact arc of the side, seen along the feed as for a spindle that turns clockwise; `None` in air, for an end alone and for
    /// a spindle that turns the other way.
    pub contact: Option<ContactArc>,
    /// Thickest place of a chip, mm; 0 in air.
    pub chip_mm: f64,
    /// Feed per tooth, mm; 0 in air.
    pub feed_per_tooth_mm: f64,
    /// Speed of the spindle, rpm; 0 in air.
    pub rpm: f64,
}

/// The narrowest arc that holds all contact of the side.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ContactArc {
    /// Angle at which a tooth enters, rad, 0 to 2 pi: 0 is to the left of the feed, pi/2 ahead.
    pub entry: f64,
    /// Angle at which it leaves, rad, beyond the entry.
    pub exit: f64,
    /// True if contact is this arc at all heights, within 3 degrees.
    pub is_even: bool,
}

/// Ends of arcs that differ by less are the same, rad.
const EVEN: f64 = 0.052;

impl ContactArc {
    /// Contact arc of an engagement; `None` if its side is not in contact, or has no gap of its own (arcs on all
    /// sides).
    pub(crate) fn of(engagement: &Engagement) -> Option<Self> {
        let side = engagement.contacts.iter().filter(|c| c.edge == Edge::Side);
        let arcs: Vec<[f64; 2]> = side.map(|c| [c.entry, c.exit]).collect();
        let first = arcs.first()?;
        // Turns of the others are chosen so that they lie nearest to the first.
        let middle = 0.5 * (first[0] + first[1]);
        let near = |arc: &[f64; 2]| {
            let turns = ((0.5 * (arc[0] + arc[1]) - middle) / TAU).round() * TAU;
            arc.map(|angle| angle - turns)
        };
        let (mut entry, mut exit, mut is_even) = (first[0], first[1], true);
        for [from, to] in arcs.iter().map(near) {
            is_even &= (from - first[0]).abs() < EVEN && (to - first[1]).abs() < EVEN;
            entry = if from < entry { from } else { entry };
            exit = if to > exit { to } else { exit };
        }
        let turns = (entry / TAU).floor() * TAU;
        (exit - entry <= TAU).then_some(Self {
            entry: entry - turns,
            exit: exit - turns,
            is_even,
        })
    }
}

impl CutStation {
    /// Station without a force.
    pub(crate) fn air(share: f64) -> Self {
        Self {
            share,
            wrench: Wrench::zero(),
            ..Self::default()
        }
    }
}
