//! Depths between which a cut is stable at one speed.
//!
//! The depth is scanned upwards from where nothing can chatter, in ratios: coarse where the largest multiplier is far from the
//! unit circle, fine where it is near, so that islands (a stable stretch above an unstable one) are found. Every crossing is
//! then closed in on.

use std::cell::RefCell;

use nalgebra::DVector;

use crate::error::{ChatterError, ChatterErrorKind, Result};
use crate::number::larger;
use crate::response::Mode;
use crate::stability::eigenvalues::{ACCURATE, ROUGH};
use crate::stability::multiplier::{Crossing, Multiplier, SpeedStability};
use crate::stability::operator::Operator;
use crate::stability::period::Period;
use crate::stability::regeneration::Regeneration;

/// First steps of the scan, as the logarithm of a ratio of depths.
const COARSE: f64 = 0.22;
/// Steps beside the unit circle: an island that is narrower may be missed.
const FINE: f64 = 0.025;
/// Such steps below a limit: what is stable again within a tenth of the depth is no limit to a tool that passes it.
const FINE_BELOW_LIMIT: f64 = 0.1;
/// Steps with a change of stability inside are divided to this before it is closed in on.
const ALONE: f64 = 0.06;
/// Change of the multiplier's logarithm over that of the depth that is reckoned with at least, where the cut is stable and
/// where it is not: the largest multiplier of light damping hardly moves before another one passes it.
const SLOPE: [f64; 2] = [0.4, 1.0];
/// Accuracy of a crossing with the points of the scan, and of the last one, share of the depth.
const ROUGHLY_CLOSED: f64 = 1e-7;
const CLOSED: f64 = 1e-9;
/// Change of a crossing with a third more points that is accepted, share of the depth; else points are added.
const RESOLVED: f64 = 1e-6;
/// Share of the usual points with which the depth is scanned: enough for the side of the unit circle. Each crossing is then closed
/// in on with more.
const SCANNED: f64 = 0.6;
/// Largest multiple of the usual points.
const FINEST: f64 = 3.5;

/// The changes of stability that are looked for.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Search {
    All,
    /// The limit; islands above it are not.
    First,
}

/// A place of the scan: logarithms of depth and multiplier.
#[derive(Clone, Copy)]
struct Sample {
    at: f64,
    log: f64,
}

impl Regeneration {
    /// Stability as by [`Self::stability_at`] or [`Self::stability_continued`], all modes dynamic.
    pub(crate) fn stability_of_all(
        &self,
        known: Option<&SpeedStability>,
        speed_rpm: f64,
        up_to: f64,
        search: Search,
    ) -> Result<SpeedStability> {
        let modes = self.response().modes().iter();
        let modes_up_to_hz = modes.map(Mode::frequency_hz).fold(0.0, larger);
        // Small gain: below this depth no displacement can keep itself up.
        let small_gain = (2.0 * self.gain() * self.cut().bound()).recip();
        let goes_on = |known: &&SpeedStability| {
            known.crossings.is_empty() && known.modes_up_to_hz == modes_up_to_hz
        };
        let certain = known
            .filter(goes_on)
            .map_or(small_gain, |known| larger(small_gain, known.up_to));
        let mut crossings = Vec::new();
        if certain < up_to {
            let along = Along::new(self, speed_rpm, SCANNED)?;
            for (low, high) in changes(&along, [certain.ln(), up_to.ln()], search)? {
                crossings.push(self.crossing(&along, low, high)?);
            }
        } else {
            // If nothing can chatter, an invalid speed is still an error.
            self.cut().delay(speed_rpm)?;
        }
        Ok(SpeedStability {
            speed_rpm,
            up_to,
            crossings,
            modes_up_to_hz,
            left_out: None,
        })
    }

    /// Closes in on a crossing between two samples, with more points until the depth no longer changes.
    fn crossing(&self, along: &Along<'_>, low: Sample, high: Sample) -> Result<Crossing> {
        let mut at = root(along, low, high)?;
        let slope = (high.log - low.log) / (high.at - low.at);
        let mut fineness = along.fineness;
        loop {
            fineness *= 4.0 / 3.0;
            let finer = Along::new(self, along.speed_rpm, fineness)?;
            let before = at;
            at = followed(&finer, before, slope)?;
            let resolved = (at - before).abs();
            if resolved <= RESOLVED {
                let multiplier = finer.multiplier(at.exp())?;
                return Ok(Crossing {
                    depth: at.exp(),
                    unstable_above: low.log < 0.0,
                    kind: multiplier.kind,
                    frequency_hz: multiplier.frequency_hz,
                    multiplier: (multiplier.real, multiplier.imaginary),
                    resolved,
                });
            }
            if fineness > FINEST {
                return Err(ChatterError::new(
                    ChatterErrorKind::NotConverged,
                    format!("limit at {} rpm near {:e} m", along.speed_rpm, at.exp()),
                    format!("changes by {resolved:.1e} of itself with a third more points"),
                    "a change below 1e-6: take faster modes as springs (modes up to a lower frequency)",
                ));
            }
        }
    }
}

/// Zero of the logarithm near a place where it is nearly zero, by the secant method.
fn followed(along: &Along<'_>, start: f64, slope: f64) -> Result<f64> {
    let mut last = Sample {
        at: start,
        log: along.logarithm(start.exp(), ACCURATE)?,
    };
    let mut at = start - last.log / slope;
    for _ in 0..6 {
        if (at - last.at).abs() < CLOSED {
            break;
        }
        let log = along.logarithm(at.exp(), ACCURATE)?;
        let (before, now) = (last, Sample { at, log });
        last = now;
        let secant = now.log * (now.at - before.at) / (now.log - before.log);
        if !secant.is_finite() {
            break;
        }
        at = now.at - secant;
    }
    Ok(at)
}

/// Steps in each of which stability changes once, in order.
fn changes(
    along: &Along<'_>,
    [from, to]: [f64; 2],
    search: Search,
) -> Result<Vec<(Sample, Sample)>> {
    let sample = |at: f64| -> Result<Sample> {
        Ok(Sample {
            at,
            log: along.logarithm(at.exp(), ROUGH)?,
        })
    };
    let finest = match search {
        Search::All => FINE,
        Search::First => FINE_BELOW_LIMIT,
    };
    let steps = ((to - from) / COARSE).ceil().max(1.0);
    let mut last = sample(from)?;
    let mut found = Vec::new();
    let mut slope = 0.0;
    for k in 1..=steps as usize {
        let end = sample(from + (to - from) * k as f64 / steps)?;
        // Depth first, from below: `waiting` holds the far ends.
        let mut waiting = vec![end];
        while let Some(next) = waiting.last().copied() {
            let step = next.at - last.at;
            let steep = ((next.log - last.log) / step).abs();
            let least = SLOPE[usize::from(last.log >= 0.0)];
            slope = larger(least, larger(0.5 * slope, 1.5 * steep));
            let change = (last.log < 0.0) != (next.log < 0.0);
            // The line may come so much nearer to the circle between two samples than the mean of its ends.
            let near = 0.5 * (last.log.abs() + next.log.abs()) < 0.5 * slope * step;
            let divide = match change {
                true => step > ALONE,
                false => near && step > finest,
            };
            if divide {
                waiting.push(sample(0.5 * (last.at + next.at))?);
                continue;
            }
            if change {
                found.push((last, next));
                if search == Search::First {
                    return Ok(found);
                }
            }
            last = next;
            waiting.pop();
        }
    }
    Ok(found)
}

/// Zero of the logarithm between two samples of different sign: Illinois method, which never leaves the interval.
fn root(along: &Along<'_>, mut low: Sample, mut high: Sample) -> Result<f64> {
    let mut side = 0;
    for _ in 0..80 {
        let share = low.log / (low.log - high.log);
        let at = low.at + share.clamp(1e-3, 1.0 - 1e-3) * (high.at - low.at);
        if high.at - low.at < ROUGHLY_CLOSED {
            return Ok(at);
        }
        let log = along.logarithm(at.exp(), ACCURATE)?;
        if log.abs() < 1e-9 {
            return Ok(at);
        }
        if (log < 0.0) == (low.log < 0.0) {
            low = Sample { at, log };
            if side == -1 {
                high.log *= 0.5;
            }
            side = -1;
        } else {
            high = Sample { at, log };
            if side == 1 {
                low.log *= 0.5;
            }
            side = 1;
        }
    }
    Ok(0.5 * (low.at + high.at))
}

/// The logarithm of the largest multiplier's size over that of the depth, at one speed.
pub(crate) struct Along<'a> {
    regeneration: &'a Regeneration,
    pub(crate) speed_rpm: f64,
    /// Share of the usual points of collocation.
    pub(crate) fineness: f64,
    /// The period, where it does not depend on the depth.
    period: Option<Period>,
    /// Start vector of the search for the largest multiplier, from the previous depth.
    last: RefCell<Option<DVector<f64>>>,
}

impl<'a> Along<'a> {
    pub(crate) fn new(
        regeneration: &'a Regeneration,
        speed_rpm: f64,
        fineness: f64,
    ) -> Result<Self> {
        let period = match regeneration.cut().pieces_depend_on_depth() {
            true => None,
            false => Some(regeneration.period(speed_rpm, 0.0, fineness)?),
        };
        Ok(Self {
            regeneration,
            speed_rpm,
            fineness,
            period,
            last: RefCell::new(None),
        })
    }

    fn with<T>(&self, depth: f64, of: impl FnOnce(&Operator<'_>) -> Result<T>) -> Result<T> {
        match &self.period {
            Some(period) => of(&Operator::new(period, depth)),
            None => {
                let period = self
                    .regeneration
                    .period(self.speed_rpm, depth, self.fineness)?;
                of(&Operator::new(&period, depth))
            }
        }
    }

    pub(crate) fn logarithm(&self, depth: f64, accuracy: f64) -> Result<f64> {
        self.with(depth, |operator| {
            let value = operator.largest(accuracy, &mut self.last.borrow_mut())?.0;
            Ok(value.norm().ln())
        })
    }

    pub(crate) fn multiplier(&self, depth: f64) -> Result<Multiplier> {
        self.with(depth, |operator| {
            let (value, vector) = operator.largest(ACCURATE, &mut self.last.borrow_mut())?;
            let receptance = |w| self.regeneration.at(w);
            Ok(Multiplier::new(
                value,
                &vector,
                operator,
                depth,
                &receptance,
            ))
        })
    }
}
