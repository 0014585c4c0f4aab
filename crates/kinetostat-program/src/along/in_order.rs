//! Points in their order along the path.

use nalgebra::Vector3;

use crate::along::foot::Foot;
use crate::along::why::WhyLeftOut;

/// The most that a way may cost which does not fit that between two points.
const DEAREST_STEP: f64 = 4.0;

/// A foot of a point with the cost of the best way to it, and the foot before on that way.
struct Reached {
    foot: Foot,
    cost: f64,
    /// Layer and foot in it.
    before: Option<(usize, usize)>,
}

/// Which of its feet belongs to each point, of points in the order in which the tool went; or why none does.
///
/// Of all ways through the feet along which none goes back by more than the window, that with the least sum of `(d / window)^2` and
/// `((way along the path - way between the points) / (way between the points + window))^2`, the latter 4 at most; found as the
/// shortest way through a graph (Viterbi 1967), not point by point. Lengths in mm.
#[must_use]
pub fn in_order(
    points: &[Vector3<f64>],
    feet: &[Vec<Foot>],
    window_mm: f64,
) -> Vec<Result<Foot, WhyLeftOut>> {
    let mut chosen = Vec::with_capacity(points.len());
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
            let way = (points[index] - points[*before]).norm();
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

/// What a step along the path costs where the points are so far apart; `None` if it goes back.
fn step(along_mm: f64, way_mm: f64, window_mm: f64) -> Option<f64> {
    let cost = ((along_mm - way_mm) / (way_mm + window_mm)).powi(2);
    (along_mm >= -window_mm).then_some(cost.min(DEAREST_STEP))
}
