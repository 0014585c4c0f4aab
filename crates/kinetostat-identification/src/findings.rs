//! What a reader of an identification must know beside its numbers.

use std::fmt;

use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::Serialize;

use crate::experiment::{Observation, Reading, ReadingOf, TestLoad, by_posture};
use crate::fit::Fit;
use crate::identifiability::Knowledge;
use crate::identified::{IdentifiedNumber, PostureResiduals};
use crate::least_squares::{LinearFit, SCATTER};

/// Something that a reader of the result must know.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(tag = "finding", rename_all = "snake_case")]
#[non_exhaustive]
pub enum Finding {
    /// No reading sees a number alone.
    Unseen {
        /// Path of the number.
        number: String,
        /// The combination that is seen, if it takes part in one.
        known: Option<String>,
    },
    /// Readings of places do not decide every number of the geometry.
    Geometry {
        /// Errors of the geometry and places of markers.
        numbers: usize,
        /// Combinations of them that are free.
        directions: usize,
    },
    /// Noise hides a number.
    Weak {
        /// Path of the number.
        number: String,
        /// Its standard deviation, percent.
        deviation_percent: f64,
    },
    /// Loops of loading and unloading show no friction of a drive.
    NoFriction {
        /// Which friction.
        number: String,
    },
    /// A spring beside the joints came out without stiffness.
    Absent {
        /// Path of the number.
        number: String,
    },
    /// A compliance came out at zero, its bound: the readings do not tell it from rigid.
    Rigid {
        /// Path of the number.
        number: String,
    },
    /// A posture that fits far worse than the others.
    Outlier {
        /// Name of the posture.
        posture: String,
        /// Its residual against the fit to all others, in those of the median posture.
        times: f64,
    },
    /// The displacements of two markers fit far better the other way round.
    Exchanged {
        /// Name of the posture.
        posture: String,
        /// Places of the markers in the tool's frame, mm.
        markers_mm: [[f64; 3]; 2],
    },
    /// Readings scatter more about the fit than they should.
    Scatter {
        /// Standard deviation about the fit, in stated ones.
        times: f64,
    },
    /// Readings are far larger or smaller than what the model says, or go the other way.
    Scale {
        /// Readings in those that the model as it was foretells; negative where they go against the load.
        times: f64,
    },
    /// Nothing is left to tell how well the model fits.
    NoRedundancy,
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unseen {
                number,
                known: None,
            } => write!(
                f,
                "{number}: no reading depends on it; it keeps the value of the model"
            ),
            Self::Unseen {
                number,
                known: Some(known),
            } => {
                write!(
                    f,
                    "{number}: not seen alone, only in {known}; its own value is the one nearest to the model"
                )
            }
            Self::Geometry {
                numbers,
                directions,
            } => write!(
                f,
                "the places decide {directions} combinations of the {numbers} numbers of the geometry; all others keep the values of the model, so that a number by itself says nothing, but all together say where the markers are. The tool stays on the flange as the model has it: markers do not tell where its tip is"
            ),
            Self::Weak {
                number,
                deviation_percent,
            } => write!(
                f,
                "{number}: weakly known, to {deviation_percent:.0} %; load the machine so that more of the deflection comes from it, or read more often"
            ),
            Self::NoFriction { number } => write!(f, "{number}: none is seen in the loops"),
            Self::Absent { number } => write!(
                f,
                "{number}: the readings do not tell it from none; the force of such a spring shows in absolute positions and torques, hardly in how stiff the machine is"
            ),
            Self::Rigid { number } => write!(
                f,
                "{number}: the readings do not tell it from rigid; with less than no compliance they would fit still better, so that noise hides it, or another part that yields is missing in the model"
            ),
            Self::Outlier { posture, times } => write!(
                f,
                "posture '{posture}' is {times:.1} times as far from the fit to all others as the median posture: look at its joints, load and markers, or use --robust"
            ),
            Self::Exchanged {
                posture,
                markers_mm: [a, b],
            } => write!(
                f,
                "posture '{posture}': the displacements of the markers at {a:?} and {b:?} mm fit far better the other way round: they seem to be exchanged"
            ),
            Self::Scatter { times } => write!(
                f,
                "the readings scatter {times:.1} times as much about the fit as their standard deviations say: the model lacks something that yields, or the readings are less exact than stated; the deviations above take the scatter into account"
            ),
            Self::Scale { times } if *times < 0.0 => write!(
                f,
                "on the whole the tool moves against its load: look at the signs of forces and readings, and whether unloaded was subtracted from loaded"
            ),
            Self::Scale { times } => write!(
                f,
                "on the whole the readings are {times:.3} times what the model as it was foretells: look at the units of forces and readings"
            ),
            Self::NoRedundancy => write!(
                f,
                "there are as many unknowns as readings: nothing tells how well the model fits"
            ),
        }
    }
}

/// Residual of a posture against those of the median above which it is named.
const FAR: f64 = 4.0;

pub(crate) fn findings(
    numbers: &[IdentifiedNumber],
    residuals: &[PostureResiduals],
    fit: &LinearFit,
) -> Vec<Finding> {
    let mut out = Vec::new();
    // Numbers of the geometry have one finding together.
    for number in numbers.iter().filter(|n| !n.is_geometry()) {
        let name = || number.number.clone();
        match (
            number.knowledge,
            number.identified,
            number.deviation_percent,
        ) {
            (Knowledge::Unseen, ..) => out.push(Finding::Unseen {
                number: name(),
                known: number.known_combination.clone(),
            }),
            _ if number.at_bound && !number.is_of_model => {
                out.push(Finding::NoFriction { number: name() });
            }
            _ if number.at_bound && number.acts_beside_joints => {
                out.push(Finding::Absent { number: name() })
            }
            _ if number.at_bound => out.push(Finding::Rigid { number: name() }),
            (Knowledge::Weak, _, Some(deviation_percent)) => out.push(Finding::Weak {
                number: name(),
                deviation_percent,
            }),
            _ => {}
        }
    }
    let of_posture = |r: &PostureResiduals| r.left_out.unwrap_or(r.after);
    let mut sorted: Vec<f64> = residuals.iter().map(of_posture).collect();
    sorted.sort_by(f64::total_cmp);
    let median = sorted.get(sorted.len() / 2).copied().unwrap_or(0.0);
    // Two postures have no median to speak of, and rounding is no outlier.
    let tells = residuals.len() >= 4 && median > 1e-6;
    let outliers = residuals
        .iter()
        .filter(|r| tells && of_posture(r) > FAR * median);
    out.extend(outliers.map(|r| Finding::Outlier {
        posture: r.posture.clone(),
        times: of_posture(r) / median,
    }));
    match fit.degrees_of_freedom() {
        0 => out.push(Finding::NoRedundancy),
        _ if fit.sigma_factor() > SCATTER => out.push(Finding::Scatter {
            times: fit.sigma_factor(),
        }),
        _ => {}
    }
    out
}

/// Squares of residuals that exchanged markers leave, relative to those that they have as they stand, below which they seem exchanged.
const EXCHANGED: f64 = 0.05;
/// Squares of the residuals of a marker, in standard deviations and for each reading, below which nothing is asked.
const NOTICEABLE: f64 = 25.0;

/// What was read of a marker in one posture under one load: three components, and what the fit leaves of them.
struct MarkerRead<'o> {
    load: &'o TestLoad,
    readings: &'o [Reading],
    left: Vector3<f64>,
}

/// Pairs of markers under one load whose displacements or places seem to be exchanged.
pub(crate) fn exchanged_markers(fit: &Fit, observations: &[Observation]) -> Vec<Finding> {
    let mut found = Vec::new();
    for ((name, members), residuals) in by_posture(observations).iter().zip(&fit.linear.residuals) {
        let mut all: Vec<MarkerRead<'_>> = Vec::new();
        let mut start = 0;
        for observation in members.iter().map(|m| &observations[*m]) {
            for readings in observation.readings.chunk_by(is_of_same_vector) {
                if readings.len() % 3 == 0 && !matches!(readings[0].of, ReadingOf::About(_)) {
                    let vectors = readings.chunks(3).enumerate();
                    all.extend(vectors.map(|(k, readings)| MarkerRead {
                        load: &observation.load,
                        readings,
                        left: residuals.fixed_rows::<3>(start + 3 * k).into_owned(),
                    }));
                }
                start += readings.len();
            }
        }
        for (i, a) in all.iter().enumerate() {
            for b in &all[i + 1..] {
                let [of_a, of_b] = [a, b].map(|x| &x.readings[0]);
                let same_kind = of_a.is_place() == of_b.is_place();
                if a.load != b.load || !same_kind || of_a.marker == of_b.marker {
                    continue;
                }
                let before = a.left.norm_squared() + b.left.norm_squared();
                let after = with_values_of(b, a) + with_values_of(a, b);
                if before > 6.0 * NOTICEABLE && after < EXCHANGED * before {
                    let mm = |r: &Reading| (r.marker.at * 1e3).into();
                    found.push(Finding::Exchanged {
                        posture: (*name).to_owned(),
                        markers_mm: [mm(of_a), mm(of_b)],
                    });
                }
            }
        }
    }
    found
}

/// True for neighbours that are components of one displacement or place.
fn is_of_same_vector(a: &Reading, b: &Reading) -> bool {
    a.marker == b.marker && std::mem::discriminant(&a.of) == std::mem::discriminant(&b.of)
}

/// Squares of the residuals of a marker if another's values had been read of it.
fn with_values_of(other: &MarkerRead<'_>, own: &MarkerRead<'_>) -> f64 {
    let pairs = own.readings.iter().zip(other.readings);
    let each = pairs.zip(own.left.iter());
    each.map(|((own, other), left)| (left + (other.value - own.value) / own.deviation).powi(2))
        .sum()
}

/// Ratio of readings to what the model foretells beyond which units are asked about.
const UNLIKELY: f64 = 15.0;

/// Asks about units and signs where readings have another size than any machine of this kind has.
pub(crate) fn scale(fit: &Fit) -> Option<Finding> {
    let (mut both, mut own) = (0.0, 0.0);
    for (reading, residual) in fit.readings.iter().zip(&fit.before) {
        let foretold = reading - residual;
        both += foretold.dot(reading);
        own += foretold.norm_squared();
    }
    let times = both / own;
    let is_likely = (1.0 / UNLIKELY..UNLIKELY).contains(&times);
    (times.is_finite() && !is_likely).then_some(Finding::Scale { times })
}
