//! The answer of `lobes`, stable names with units.

use kinetostat_chatter::{Instability, LobeDiagram};
use kinetostat_machining::Warning;
use schemars::JsonSchema;
use serde::Serialize;

use crate::place::query::AnswerHead;

#[derive(Serialize, JsonSchema)]
pub(crate) struct LobesAnswer {
    #[serde(flatten)]
    pub(crate) head: AnswerHead,
    pub(crate) force_n: [f64; 3],
    pub(crate) moment_n_m: [f64; 3],
    /// Damping in words.
    pub(crate) damping: String,
    /// Base axes, across the tool axis.
    pub(crate) feed_direction: [f64; 3],
    /// Direction from the tip towards the spindle, base axes.
    pub(crate) tool_axis: [f64; 3],
    pub(crate) teeth: usize,
    /// Width of cut by diameter.
    pub(crate) immersion: f64,
    pub(crate) milled: &'static str,
    /// Tangential, radial, axial.
    pub(crate) coefficients_n_per_mm2: Vec<f64>,
    /// Material, and the chip thickness at which its law was linearised; null if coefficients were stated.
    pub(crate) material: Option<String>,
    pub(crate) chip_mm: Option<f64>,
    /// Modes that vibrate; those above count by their flexibility at rest. At some speeds it may be fewer.
    pub(crate) modes_hz: Vec<f64>,
    /// The fastest of them.
    pub(crate) modes_up_to_hz: f64,
    /// Largest depth that was looked at.
    pub(crate) depth_limit_mm: f64,
    pub(crate) best: Option<Best>,
    pub(crate) points: Vec<Point>,
    pub(crate) warnings: Vec<Warning>,
}

/// The speed with the largest limit.
#[derive(Serialize, JsonSchema)]
pub(crate) struct Best {
    pub(crate) speed_rpm: f64,
    /// A limit, or the largest depth that was looked at.
    pub(crate) depth_mm: f64,
    /// Stable up to the largest depth that was looked at, as so many speeds are: no limit is known.
    pub(crate) no_limit_found: bool,
    pub(crate) speeds_without_limit: usize,
}

impl Best {
    pub(crate) fn of(diagram: &LobeDiagram) -> Option<Self> {
        let (speed_rpm, depth) = diagram.best()?;
        let all = diagram.points.iter();
        let without = all.filter(|point| point.exact.limit().is_none()).count();
        Some(Self {
            speed_rpm,
            depth_mm: 1e3 * depth,
            no_limit_found: without > 0,
            speeds_without_limit: without,
        })
    }
}

/// Limits at one speed.
#[derive(Serialize, JsonSchema)]
pub(crate) struct Point {
    pub(crate) speed_rpm: f64,
    /// Exact; null: stable up to the largest depth.
    pub(crate) limit_mm: Option<f64>,
    /// `flip` or `hopf`.
    pub(crate) kind: Option<Instability>,
    pub(crate) chatter_hz: Option<f64>,
    /// All stretches of depth that are stable; those above the first are islands.
    pub(crate) stable_mm: Vec<(f64, f64)>,
    /// Fastest mode that swings in the calculation at this speed.
    pub(crate) modes_up_to_hz: f64,
    /// Zeroth order, no bound.
    pub(crate) zeroth_order_mm: Option<f64>,
}

pub(crate) fn points(diagram: &LobeDiagram) -> Vec<Point> {
    let one = |point: &kinetostat_chatter::LobePoint| {
        let limit = point.exact.limit();
        Point {
            speed_rpm: point.exact.speed_rpm,
            limit_mm: limit.map(|c| 1e3 * c.depth),
            kind: limit.map(|c| c.kind),
            chatter_hz: limit.map(|c| c.frequency_hz),
            stable_mm: (point.exact.stable().into_iter())
                .map(|(low, high)| (1e3 * low, 1e3 * high))
                .collect(),
            modes_up_to_hz: point.exact.modes_up_to_hz,
            zeroth_order_mm: point.zeroth_order.map(|z| 1e3 * z.depth),
        }
    };
    diagram.points.iter().map(one).collect()
}
