//! Lobes: limits over the spindle speed.

use rayon::prelude::*;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::cut::{checked_depth, checked_speed};
use crate::error::{ChatterError, ChatterErrorKind, Result};
use crate::number::larger;
use crate::stability::{LeftOut, Regeneration, SpeedStability};
use crate::zeroth_order::{self, ZerothOrderLimit};

/// Maximum number of speeds of a diagram.
const MOST_SPEEDS: usize = 100_000;

/// Request for a lobe diagram.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema, Deserialize)]
pub struct LobeRequest {
    /// Slowest spindle speed, rpm.
    pub from_rpm: f64,
    /// Fastest spindle speed, rpm.
    pub to_rpm: f64,
    /// Number of speeds, evenly spaced, before any are added; 1 where both speeds are the same.
    pub speeds: usize,
    /// Largest depth of cut that is looked at, m.
    pub up_to: f64,
    /// Maximum number of halvings of a gap between speeds where the limit changes fast or in kind; 0 adds none.
    pub refinements: usize,
    /// A change of the limit between neighbours by more than this share is fast.
    pub fast: f64,
}

impl LobeRequest {
    /// Requests evenly spaced speeds between two, without refinement.
    #[must_use]
    pub fn new(from_rpm: f64, to_rpm: f64, speeds: usize, up_to: f64) -> Self {
        Self {
            from_rpm,
            to_rpm,
            speeds,
            up_to,
            refinements: 0,
            fast: 0.1,
        }
    }

    /// Halves gaps up to `refinements` times where the limit changes fast or in kind.
    #[must_use]
    pub fn refined(self, refinements: usize) -> Self {
        Self {
            refinements,
            ..self
        }
    }

    fn checked(&self) -> Result<()> {
        let setting = |quantity: &str, found: String, expected: &str| {
            Err(ChatterError::new(
                ChatterErrorKind::Setting,
                quantity,
                found,
                expected,
            ))
        };
        checked_speed(self.from_rpm)?;
        checked_speed(self.to_rpm)?;
        checked_depth(self.up_to)?;
        let one = self.speeds == 1 && self.to_rpm == self.from_rpm;
        if self.to_rpm <= self.from_rpm && !one {
            let found = format!("{} to {} rpm", self.from_rpm, self.to_rpm);
            return setting("spindle speeds", found, "a second speed above the first");
        }
        if !one && !(2..=MOST_SPEEDS).contains(&self.speeds) {
            let found = self.speeds.to_string();
            let expected = "2 to 100000, or 1 where both speeds are the same";
            return setting("number of spindle speeds", found, expected);
        }
        if self.up_to <= 0.0 {
            return setting("largest depth", "0 m".into(), "a depth above 0");
        }
        if self.refinements > 12 || self.fast.is_nan() || self.fast <= 0.0 {
            let found = format!("{} times, by {}", self.refinements, self.fast);
            return setting(
                "refinement of lobes",
                found,
                "at most 12 times, by a share above 0",
            );
        }
        Ok(())
    }
}

/// Limits at one spindle speed.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema, Deserialize)]
pub struct LobePoint {
    /// All depths at which stability changes.
    pub exact: SpeedStability,
    /// Limit of zeroth order, under its own name: no bound.
    pub zeroth_order: Option<ZerothOrderLimit>,
}

/// Limits over the spindle speed, from the slowest upwards.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema, Deserialize)]
pub struct LobeDiagram {
    /// Largest depth that was looked at, m.
    pub up_to: f64,
    /// Edges that pass in one turn.
    pub teeth: usize,
    /// One for each speed that has an answer.
    pub points: Vec<LobePoint>,
    /// Speeds, rpm, at which the calculation did not reach its accuracy, and why.
    pub without_answer: Vec<(f64, String)>,
}

impl LobeDiagram {
    /// The speed with the largest limit, of those that were looked at, rpm, with its limit, m (the largest depth where there
    /// is none).
    #[must_use]
    pub fn best(&self) -> Option<(f64, f64)> {
        let limit = |point: &LobePoint| point.exact.limit().map_or(self.up_to, |c| c.depth);
        let mut best: Option<(f64, f64)> = None;
        for point in &self.points {
            if best.is_none_or(|(_, depth)| limit(point) > depth) {
                best = Some((point.exact.speed_rpm, limit(point)));
            }
        }
        best
    }

    /// Frequency of the fastest mode that swings at any of the speeds, Hz; those above are springs at all.
    #[must_use]
    pub fn modes_up_to_hz(&self) -> f64 {
        let each = self.points.iter().map(|point| point.exact.modes_up_to_hz);
        each.fold(0.0, larger)
    }

    /// Mode with the largest share among those treated as springs although they contribute, and the spindle speed, rpm.
    #[must_use]
    pub fn left_out(&self) -> Option<(LeftOut, f64)> {
        let of = |point: &LobePoint| Some((point.exact.left_out?, point.exact.speed_rpm));
        let each = self.points.iter().filter_map(of);
        each.reduce(|a, b| if b.0.share > a.0.share { b } else { a })
    }
}

impl Regeneration {
    /// The lobe diagram: exact limits with their islands, and those of zeroth order beside them.
    ///
    /// Speeds are worked on by all threads; their number changes nothing of the result.
    ///
    /// # Errors
    /// A request without sense, and those of [`Regeneration::stability_at`]; of calculations that do not reach their accuracy
    /// only where that is so at every speed ([`LobeDiagram::without_answer`]).
    pub fn lobes(&self, request: &LobeRequest) -> Result<LobeDiagram> {
        request.checked()?;
        let step = (request.to_rpm - request.from_rpm) / (request.speeds.max(2) - 1) as f64;
        let speeds: Vec<f64> = (0..request.speeds)
            .map(|i| request.from_rpm + step * i as f64)
            .collect();
        let steps = zeroth_order::steps(self);
        let at = |speed: &f64| -> Result<LobePoint> {
            Ok(LobePoint {
                exact: self.stability_at(*speed, request.up_to)?,
                zeroth_order: zeroth_order::limit_on(&steps, self, *speed)?,
            })
        };
        let mut without_answer: Vec<(f64, ChatterError)> = Vec::new();
        let mut all = |speeds: &[f64]| -> Result<Vec<LobePoint>> {
            let found: Vec<Result<LobePoint>> = speeds.par_iter().map(at).collect();
            let mut points = Vec::with_capacity(found.len());
            for (speed, found) in speeds.iter().zip(found) {
                match found {
                    Ok(point) => points.push(point),
                    Err(error) if error.kind == ChatterErrorKind::NotConverged => {
                        without_answer.push((*speed, error));
                    }
                    Err(error) => return Err(error),
                }
            }
            Ok(points)
        };
        let mut points = all(&speeds)?;
        for _ in 0..request.refinements {
            let between: Vec<f64> = points
                .windows(2)
                .filter(|pair| changes_fast(&pair[0], &pair[1], request))
                .map(|pair| 0.5 * (pair[0].exact.speed_rpm + pair[1].exact.speed_rpm))
                .collect();
            if between.is_empty() {
                break;
            }
            points.extend(all(&between)?);
            points.sort_by(|a, b| a.exact.speed_rpm.total_cmp(&b.exact.speed_rpm));
        }
        if let (true, Some((_, error))) = (points.is_empty(), without_answer.first()) {
            return Err(error.clone());
        }
        without_answer.sort_by(|a, b| a.0.total_cmp(&b.0));
        Ok(LobeDiagram {
            up_to: request.up_to,
            teeth: self.cut().teeth(),
            points,
            without_answer: (without_answer.into_iter())
                .map(|(speed, why)| (speed, why.to_string()))
                .collect(),
        })
    }
}

/// True if the limit may change between two speeds in a way that neither shows.
fn changes_fast(a: &LobePoint, b: &LobePoint, request: &LobeRequest) -> bool {
    let (a, b) = (&a.exact, &b.exact);
    if a.crossings.len() != b.crossings.len() {
        return true;
    }
    a.crossings
        .iter()
        .zip(&b.crossings)
        .any(|(a, b)| a.kind != b.kind || (a.depth / b.depth).ln().abs() > request.fast)
}
