//! Share of the displacement by the machine's own weight that counts as an error of the program.

use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Share of the displacement by the machine's own weight, and by what else acts in its model (springs, counterweights), that counts
/// as an error of the program. It depends on how the part frame was measured.
///
/// ```
/// use kinetostat_machining::{TouchOff, WeightCorrection};
///
/// let at_corner = TouchOff::at(vec![[0.0; 3]])?;
/// assert_eq!(WeightCorrection::TouchOff(at_corner).word(), "touch-off");
/// let on_a_line = vec![[0.0; 3], [100.0, 0.0, 0.0], [200.0, 0.0, 0.0]];
/// assert!(TouchOff::at(on_a_line).is_err());
/// # Ok::<(), kinetostat_machining::TouchOffError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum WeightCorrection {
    /// Not stated: a run along a program is refused where own weight moves the tool.
    #[default]
    NotStated,
    /// The machine itself measured the part frame, unloaded and as it hangs: only the change from there is an error.
    TouchOff(TouchOff),
    /// The part frame was measured without the machine: all of it is an error.
    All,
    /// No part is an error: the controller corrects own weight, for instance. The machine still carries it, so that drive loads,
    /// stiffness and stability stay those of the loaded machine.
    None,
}

impl WeightCorrection {
    /// Word that stands for it in jobs and options; empty where nothing is stated.
    #[must_use]
    pub fn word(&self) -> &'static str {
        match self {
            Self::NotStated => "",
            Self::TouchOff(_) => "touch-off",
            Self::All => "all",
            Self::None => "none",
        }
    }

    /// True if nothing is stated.
    #[must_use]
    pub fn is_not_stated(&self) -> bool {
        *self == Self::NotStated
    }
}

/// Places where the machine measured the part frame, program coordinates, mm: one, or three and more that are not on a line.
///
/// One place measures where the part lies: the displacement there is no error anywhere. Several places measure its orientation,
/// too: the rigid motion that fits the displacements there best is no error.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema, Deserialize)]
#[serde(transparent)]
pub struct TouchOff {
    places_mm: Vec<[f64; 3]>,
}

/// Places that measure no part frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TouchOffError {
    /// No place.
    #[error(
        "the weight is to be corrected from where the part was touched off, and no place is given"
    )]
    NoPlace,
    /// Not a number, or an infinite one.
    #[error("a coordinate of a place where the part was touched off is no finite number")]
    NotFinite,
    /// The turn about a line is left open.
    #[error(
        "the places where the part was touched off lie on one line, which leaves the turn about it open"
    )]
    OnLine,
}

/// Narrower than this share of their length, places lie on a line.
const NARROW: f64 = 0.01;

impl TouchOff {
    /// Touch-off at these places, program coordinates, mm.
    ///
    /// # Errors
    /// [`TouchOffError`].
    pub fn at(places_mm: Vec<[f64; 3]>) -> Result<Self, TouchOffError> {
        let points: Vec<Vector3<f64>> = places_mm.iter().map(|p| Vector3::from(*p)).collect();
        if points.iter().any(|p| !p.iter().all(|x| x.is_finite())) {
            return Err(TouchOffError::NotFinite);
        }
        let Some((first, others)) = points.split_first() else {
            return Err(TouchOffError::NoPlace);
        };
        let ways = || others.iter().map(|p| p - first);
        let longest = ways().max_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()));
        if let Some(along) = longest {
            let wide = |way: Vector3<f64>| along.cross(&way).norm() > NARROW * along.norm_squared();
            if !ways().any(wide) {
                return Err(TouchOffError::OnLine);
            }
        }
        Ok(Self { places_mm })
    }

    /// The places, program coordinates, mm.
    #[must_use]
    pub fn places_mm(&self) -> &[[f64; 3]] {
        &self.places_mm
    }

    /// Text, such as "the place where the part was touched off (X0 Y0 Z0)".
    #[must_use]
    pub fn description(&self) -> String {
        match self.places_mm.as_slice() {
            [[x, y, z]] => format!("the place where the part was touched off (X{x} Y{y} Z{z})"),
            places => format!("the {} places where the part was touched off", places.len()),
        }
    }
}
