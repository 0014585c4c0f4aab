//! The machine solved as built, as designed and linearised, without and under load.

use kinetostat::{LinearAssembly, MechanismEquilibrium, Posture, Wrench};

use crate::assemble::cases::Cases;

/// The four equilibria of one place, and the first-order assembly.
pub(crate) struct Solved<'m> {
    pub(crate) posture: Posture<'m>,
    /// As drawn and as built, without load.
    pub(crate) rest: [MechanismEquilibrium; 2],
    /// The same under load.
    pub(crate) loaded: Option<[MechanismEquilibrium; 2]>,
    pub(crate) linear: LinearAssembly,
    /// The same under load.
    pub(crate) linear_loaded: Option<LinearAssembly>,
}

/// Solves both machines in a posture of the machine as built.
pub(crate) fn solve<'m>(
    posture: Posture<'m>,
    drawn: &Posture<'_>,
    wrench: &Wrench,
) -> kinetostat::Result<Solved<'m>> {
    let both = |wrench: &Wrench| -> kinetostat::Result<_> {
        Ok([drawn.deflected_by(wrench)?, posture.deflected_by(wrench)?])
    };
    let rest = both(&Wrench::zero())?;
    let errors = posture.assembly_errors();
    let (loaded, linear_loaded) = match wrench.0.norm() > 0.0 {
        true => (
            Some(both(wrench)?),
            Some(posture.linear_assembly_under(&errors, wrench)?),
        ),
        false => (None, None),
    };
    let linear = posture.linear_assembly(&errors)?;
    Ok(Solved {
        posture,
        rest,
        loaded,
        linear,
        linear_loaded,
    })
}

impl Solved<'_> {
    /// A scalar of an equilibrium in all cases.
    pub(crate) fn scalar(
        &self,
        linear: impl Fn(&LinearAssembly) -> f64,
        of: impl Fn(&MechanismEquilibrium) -> f64,
    ) -> Cases<f64> {
        let [drawn, built] = &self.rest;
        let under = self.loaded.as_ref();
        Cases {
            without_load: of(built),
            without_load_by_deviations: of(built) - of(drawn),
            without_load_linear: linear(&self.linear),
            under_load: under.map(|[_, built]| of(built)),
            under_load_by_deviations: under.map(|[drawn, built]| of(built) - of(drawn)),
            under_load_linear: self.linear_loaded.as_ref().map(linear),
        }
    }

    /// Three components in all cases.
    pub(crate) fn vector(
        &self,
        linear: impl Fn(&LinearAssembly) -> [f64; 3],
        of: impl Fn(&MechanismEquilibrium) -> [f64; 3],
    ) -> Cases<[f64; 3]> {
        let less = |[drawn, built]: &[MechanismEquilibrium; 2]| {
            let (a, b) = (of(drawn), of(built));
            std::array::from_fn(|i| b[i] - a[i])
        };
        let under = self.loaded.as_ref();
        Cases {
            without_load: of(&self.rest[1]),
            without_load_by_deviations: less(&self.rest),
            without_load_linear: linear(&self.linear),
            under_load: under.map(|both| of(&both[1])),
            under_load_by_deviations: under.map(less),
            under_load_linear: self.linear_loaded.as_ref().map(linear),
        }
    }
}
