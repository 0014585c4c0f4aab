//! Tolerances and limits of the iterations.

use std::fmt::Debug;

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

use crate::error::{Error, Place, Result};

/// `settings.with_field(value)`: the same settings with one of them changed, because settings to come must not break
/// programs that write them down.
macro_rules! setters {
    ($type:ident { $($setter:ident: $field:ident: $kind:ty,)+ }) => {
        impl $type {
            $(
                #[doc = concat!("The same settings with another [`", stringify!($field), "`](Self::", stringify!($field), ").")]
                #[must_use]
                pub fn $setter(mut self, $field: $kind) -> Self {
                    self.$field = $field;
                    self
                }
            )+
        }
    };
}
pub(crate) use setters;

/// Tolerances and limits; the defaults suit every machine in SI units.
///
/// # Examples
///
/// ```
/// # use kinetostat::nalgebra::{Vector3, vector};
/// # use kinetostat::*;
/// # let slide = |axis| ActuatorSpec::new(MotionKind::Prismatic, axis, 5e7); // N/m
/// # let chain = Chain::builder("gantry")
/// #     .actuator("x", slide(Vector3::x()))
/// #     .actuator("y", slide(Vector3::y()))
/// #     .link("column", &BeamSection::tube(2.1e11, 8.1e10, 0.2, 0.17), 0.4) // Pa, m
/// #     .build()?;
/// # let home = Pose::translation(0.4, 0.0, 0.0);
/// # let gantry = Mechanism::serial(chain, home, Vector3::zeros())?;
/// let coarse = Settings::default()
///     .with_closure(1e-6) // of the natural length
///     .with_torque(1e-5) // of the loads
///     .with_iterations(10)
///     .with_picard_steps(0)
///     .with_smallest_load_step(0.25);
/// let cutting = Wrench::new(vector![300.0, -400.0, 150.0], vector![5.0, 0.0, 20.0]); // N, N m
/// let posture = gantry.posture(&home)?;
/// let fine = posture.deflected_by(&cutting)?;
/// let quick = posture.with_settings(coarse).deflected_by(&cutting)?;
/// assert!(fine.residual.torque <= 1e-10 && quick.residual.torque <= 1e-5);
/// assert!(quick.residual.iterations <= 10);
/// assert!((quick.displacement - fine.displacement).linear().norm() < 1e-4 * fine.displacement.linear().norm());
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[non_exhaustive]
pub struct Settings {
    /// Largest closure left over, as a share of the chain's natural length. Default 1e-12.
    pub closure: f64,
    /// Largest torque and force residual, as a share of the loads. Default 1e-10.
    pub torque: f64,
    /// Iterations of one attempt. Default 40.
    pub iterations: usize,
    /// Steps of the report's iteration (loads and Jacobians lagged) before Newton. Default 1.
    pub picard_steps: usize,
    /// Smallest load step before a failure is reported (1e-9 at least). Default 1/1024.
    pub smallest_load_step: f64,
}

crate::settings::setters!(Settings {
    with_closure: closure: f64,
    with_torque: torque: f64,
    with_iterations: iterations: usize,
    with_picard_steps: picard_steps: usize,
    with_smallest_load_step: smallest_load_step: f64,
});

impl Default for Settings {
    fn default() -> Self {
        Self {
            closure: 1e-12,
            torque: 1e-10,
            iterations: 40,
            picard_steps: 1,
            smallest_load_step: 1.0 / 1024.0,
        }
    }
}

/// A setting that nothing can be done with.
pub(crate) fn wrong(place: &Place, what: &str, found: impl Debug, required: &str) -> Error {
    Error::model(
        place,
        format!("settings: {what} is {found:?}, {required} is needed"),
    )
}

impl Settings {
    /// Refuses what no iteration can work with, naming it.
    pub(crate) fn check(&self, place: &Place) -> Result<()> {
        for (what, value) in [("closure", self.closure), ("torque", self.torque)] {
            if !(value > 0.0 && value < 1.0) {
                return Err(wrong(place, what, value, "a share between 0 and 1"));
            }
        }
        if self.iterations == 0 {
            return Err(wrong(place, "iterations", 0, "at least 1"));
        }
        let step = self.smallest_load_step;
        if !(step > 0.0 && step <= 1.0) {
            let required = "a share above 0 and up to 1";
            return Err(wrong(place, "smallest_load_step", step, required));
        }
        Ok(())
    }
}
