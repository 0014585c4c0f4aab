//! Points in their order along the path.

use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::Serialize;

use crate::along::Foot;

/// The most that a way may cost which does not fit that between two points.
const DEAREST_STEP: f64 = 4.0;

/// A foot of a point with the cost of the best way to it, and the foot before on that way.
struct Reached {
    foot: Foot,
    cost: f64,
    /// Layer and foot in it.
    before: Option<(usize, usize)>,
}

/// Assigns one of its feet to each point, given in the order in which the tool went; or the reason why it has none.
///
/// The result minimises, over all ways through the feet along which none goes back by more than the window, the sum of
/// `(d / window)^2` and `((way along the path - way between the points) / (way between the points + window))^2`, the latter 4 at
/// most; found as the shortest way through a graph (Viterbi 1967), not point by point. Lengths in mm.
#[must_use]
pub fn in_order(
    points: &[Vector3<f64>],
    feet: &[Vec<Foot>],
    window_mm: f64,
) -> Vec<Result<Foot, WhyLeftOut>> {
    in_order_by(feet, window_mm, |from, to| {
        (points[to] - points[from]).norm()
    })
}

/// Variant of [`in_order`] for points between which the length along the path is known by other means: `way_mm` returns it for the
/// indices of two points. It is zero between two cuts however long the rapid is: rapids do not add to the length along a path.
///
/// ```
/// use kinetostat_program::{NominalPath, Program, ReadOptions, in_order_by, interpret};
/// use nalgebra::Vector3;
///
/// // Two pecks of one hole: the second begins where the first one was cut.
/// let text = "G21 G90\nG0 X3 Y4 Z1\nG1 Z-2 F300\nG0 Z1\nG0 Z-1.8\nG1 Z-5\n";
/// let path = interpret(&Program::read(text)?, &ReadOptions::default())?;
/// let nominal = NominalPath::new(&path)?;
/// let depths = [-1.0, -2.0, -1.8, -5.0];
/// let feet = depths.map(|z| nominal.nearest_within(&Vector3::new(3.0, 4.0, z), 0.5));
/// let cut_mm = [2.0, 3.0, 3.0, 6.2];
/// let found = in_order_by(&feet, 0.5, |from, to| cut_mm[to] - cut_mm[from]);
/// let along: Vec<f64> = found.iter().flatten().map(|foot| foot.along_mm).collect();
/// assert!(along.iter().zip(cut_mm).all(|(found, cut)| (found - cut).abs() < 1e-12));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn in_order_by(
    feet: &[Vec<Foot>],
    window_mm: f64,
    way_mm: impl Fn(usize, usize) -> f64,
) -> Vec<Result<Foot, WhyLeftOut>> {
    let mut chosen = Vec::with_capacity(feet.len());
    // Layers of points that have a way to them, with the index of the point.
    let mut layers: Vec<(usize, Vec<Reached>)> = Vec::new();
    for (index, feet) in feet.iter().enumerate() {
        if feet.is_empty() {
            chosen.push(Err(WhyLeftOut::BeyondWindow));
            continue;
        }
        chosen.push(Err(WhyLeftOut::OutOfOrder));
        let reached = feet.iter().filter_map(|foot| {
            let own = (foot.distance_mm / window_mm).powi(2);
            let Some((before, layer)) = layers.last() else {
                return Some(Reached {
                    foot: *foot,
                    cost: own,
                    before: None,
                });
            };
            let way = way_mm(*before, index);
            let costs = layer.iter().enumerate().filter_map(|(k, from)| {
                let step = step(foot.along_mm - from.foot.along_mm, way, window_mm)?;
                Some((from.cost + step, k))
            });
            let (cost, k) = costs.min_by(|a, b| a.0.total_cmp(&b.0))?;
            Some(Reached {
                foot: *foot,
                cost: cost + own,
                before: Some((layers.len() - 1, k)),
            })
        });
        let reached: Vec<Reached> = reached.collect();
        if !reached.is_empty() {
            layers.push((index, reached));
        }
    }
    let last = layers.last().and_then(|(_, layer)| {
        let ends = layer.iter().enumerate();
        ends.min_by(|a, b| a.1.cost.total_cmp(&b.1.cost))
            .map(|(k, _)| k)
    });
    let mut at = last.map(|k| (layers.len() - 1, k));
    while let Some((layer, k)) = at {
        let (index, feet) = &layers[layer];
        chosen[*index] = Ok(feet[k].foot);
        at = feet[k].before;
    }
    chosen
}

/// Cost of a step along the path between points at this distance; `None` if it goes back.
fn step(along_mm: f64, way_mm: f64, window_mm: f64) -> Option<f64> {
    let cost = ((along_mm - way_mm) / (way_mm + window_mm)).powi(2);
    (along_mm >= -window_mm).then_some(cost.min(DEAREST_STEP))
}

/// Reason for which a point has no place.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum WhyLeftOut {
    /// The path does not come within the window.
    BeyondWindow,
    /// Several stretches of the path come within the window.
    SeveralStretches,
    /// The point names a line, and only cuts of other lines come within the window.
    NotOnItsLine,
    /// The place would lie before those of earlier points.
    OutOfOrder,
}
