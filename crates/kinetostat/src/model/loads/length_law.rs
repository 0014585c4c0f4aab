//! Tension of a strut as a function of its length: springs, gas springs, constant forces.

use std::sync::Arc;

use crate::model::limits::odd_number;

/// Response of a strut to its length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LengthResponse {
    /// Pull between the points, N; negative pushes them apart.
    pub tension: f64,
    /// Derivative of the tension by the length, N/m.
    pub slope: f64,
    /// Energy stored, J: the integral of the tension over the length.
    pub energy: f64,
}

/// A law of length that a user brings along: metres in, [`LengthResponse`] out.
pub type LengthFunction = Arc<dyn Fn(f64) -> LengthResponse + Send + Sync>;

/// Tension of a strut by its length.
///
/// # Examples
///
/// ```
/// # use kinetostat::nalgebra::{Vector3, vector};
/// # use kinetostat::*;
/// use kinetostat::model::LengthResponse;
///
/// let spring = LengthLaw::Linear { stiffness: 2e3, free_length: 0.3, preload: 50.0 }; // N/m, m, N
/// assert_eq!(spring.respond(0.3).tension, 50.0);
/// let gas = LengthLaw::Gas { force: 600.0, length: 0.4, column: 0.25, exponent: 1.4 }; // N, m, m
/// let pressed = gas.respond(0.3); // 0.1 m shorter: p V^1.4 stays
/// assert!((pressed.tension * 0.15_f64.powf(1.4) + 600.0 * 0.25_f64.powf(1.4)).abs() < 1e-9);
/// // A law of one's own: a rubber band, slack below 0.2 m.
/// let band = LengthLaw::function(|length| {
///     let stretch = (length - 0.2).max(0.0);
///     LengthResponse { tension: 1e4 * stretch.powi(2), slope: 2e4 * stretch, energy: 1e4 / 3.0 * stretch.powi(3) }
/// });
/// assert_eq!(band.respond(0.1).tension, 0.0);
/// // Tension is the slope of energy, slope that of tension.
/// for law in [spring, gas, band] {
///     let (shorter, here, longer) = (law.respond(0.35 - 1e-6), law.respond(0.35), law.respond(0.35 + 1e-6));
///     assert!(((longer.energy - shorter.energy) / 2e-6 - here.tension).abs() < 1e-6);
///     assert!(((longer.tension - shorter.tension) / 2e-6 - here.slope).abs() < 1e-3);
/// }
/// ```
#[derive(Clone)]
#[non_exhaustive]
pub enum LengthLaw {
    /// `T = preload + stiffness (l - free_length)`.
    Linear {
        /// N/m.
        stiffness: f64,
        /// Length without force if `preload` is zero, m. Zero is allowed: the ideal compensator.
        free_length: f64,
        /// Tension at `free_length`, N.
        preload: f64,
    },
    /// A gas spring: `T = -force (column / (column - (length - l)))^exponent`, pushing.
    Gas {
        /// Push at `length`, N.
        force: f64,
        /// Length at which it pushes with `force` (usually extended), m.
        length: f64,
        /// Volume of the gas at that length over the area of the rod, m: stroke at which the push
        /// would become infinite. The longer, the flatter the characteristic.
        column: f64,
        /// 1 for slow (isothermal), 1.4 for fast (adiabatic) motion of nitrogen.
        exponent: f64,
    },
    /// Constant tension at every length.
    Constant {
        /// N.
        tension: f64,
    },
    /// Anything else.
    Function(LengthFunction),
}

impl std::fmt::Debug for LengthLaw {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Linear {
                stiffness,
                free_length,
                preload,
            } => {
                write!(
                    f,
                    "Linear({stiffness} N/m from {free_length} m, preload {preload} N)"
                )
            }
            Self::Gas {
                force,
                length,
                column,
                exponent,
            } => {
                write!(
                    f,
                    "Gas({force} N at {length} m, column {column} m, exponent {exponent})"
                )
            }
            Self::Constant { tension } => write!(f, "Constant({tension} N)"),
            Self::Function(_) => write!(f, "Function"),
        }
    }
}

impl LengthLaw {
    /// A law from a function of the length (m) to tension, slope and energy.
    #[must_use]
    pub fn function(law: impl Fn(f64) -> LengthResponse + Send + Sync + 'static) -> Self {
        Self::Function(Arc::new(law))
    }

    /// Answers to a length, m. A gas spring pressed beyond its column goes on along the tangent of
    /// its characteristic at 95 % of the column, so that an iteration may come back from there.
    #[must_use]
    pub fn respond(&self, length: f64) -> LengthResponse {
        match self {
            Self::Linear {
                stiffness,
                free_length,
                preload,
            } => {
                let stretch = length - free_length;
                LengthResponse {
                    tension: preload + stiffness * stretch,
                    slope: *stiffness,
                    energy: (preload + 0.5 * stiffness * stretch) * stretch,
                }
            }
            Self::Gas {
                force,
                length: at,
                column,
                exponent,
            } => gas(*force, at - length, *column, *exponent),
            Self::Constant { tension } => LengthResponse {
                tension: *tension,
                slope: 0.0,
                energy: tension * length,
            },
            Self::Function(law) => law(length),
        }
    }

    pub(crate) fn fault(&self) -> Option<String> {
        let limits = self.limits();
        let odd = odd_number(limits.iter().map(|(what, value, _)| (*what, *value)));
        odd.or_else(|| {
            let (what, value, limit) = limits.iter().find(|(_, value, limit)| match limit {
                Limit::None => false,
                Limit::NotBelowZero => **value < 0.0,
                Limit::AboveZero => **value <= 0.0,
            })?;
            let required = match limit {
                Limit::AboveZero => "above zero",
                _ => "not below zero",
            };
            Some(format!(
                "the {what} of the law {self:?} is {value}, a number {required} is needed"
            ))
        })
    }

    /// The numbers of a law with their names and with what each of them must be.
    fn limits(&self) -> Vec<(&'static str, &f64, Limit)> {
        match self {
            Self::Linear {
                stiffness,
                free_length,
                preload,
            } => vec![
                ("stiffness", stiffness, Limit::None),
                ("preload", preload, Limit::None),
                ("free length", free_length, Limit::NotBelowZero),
            ],
            Self::Gas {
                force,
                length,
                column,
                exponent,
            } => vec![
                ("force", force, Limit::None),
                ("length", length, Limit::AboveZero),
                ("column", column, Limit::AboveZero),
                ("exponent", exponent, Limit::AboveZero),
            ],
            Self::Constant { tension } => vec![("tension", tension, Limit::None)],
            Self::Function(_) => Vec::new(),
        }
    }
}

/// Admissible range of a law's number.
enum Limit {
    None,
    NotBelowZero,
    AboveZero,
}

/// Gas spring compressed by `stroke` (m).
fn gas(force: f64, stroke: f64, column: f64, exponent: f64) -> LengthResponse {
    const LAST: f64 = 0.95;
    let inside = stroke.min(LAST * column);
    let ratio = column / (column - inside);
    let push = force * ratio.powf(exponent);
    let slope = push * exponent / (column - inside);
    // Work taken from outside: integral of the push over the stroke.
    let stored = if (exponent - 1.0).abs() < 1e-12 {
        force * column * ratio.ln()
    } else {
        force * column * (ratio.powf(exponent - 1.0) - 1.0) / (exponent - 1.0)
    };
    let beyond = stroke - inside;
    LengthResponse {
        tension: -(push + slope * beyond),
        slope,
        energy: stored + (push + 0.5 * slope * beyond) * beyond,
    }
}
