//! A machine as built beside the same machine as drawn: what its deviations lock in, without and under load.

use kinetostat::{MechanismEquilibrium, Posture, Wrench, machine::LinearAssembly};
use schemars::JsonSchema;
use serde::Serialize;

/// A value without load and under load: of the machine as built, the share of its deviations in it,
/// and the first-order answer [R 6.15-6.20], which knows no weights and preloads.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub struct Cases<T> {
    /// Value of the machine as built.
    pub without_load: T,
    /// Difference between the machine as built and as drawn.
    pub without_load_by_deviations: T,
    /// First-order value in the deviations.
    pub without_load_linear: T,
    /// Value under load; `None` without a force or moment.
    pub under_load: Option<T>,
    /// Difference between the machine as built and as drawn.
    pub under_load_by_deviations: Option<T>,
    /// First-order value in the deviations.
    pub under_load_linear: Option<T>,
}

impl Cases<[f64; 3]> {
    /// Selects component `i` of every case.
    #[must_use]
    pub fn component(&self, i: usize) -> Cases<f64> {
        Cases {
            without_load: self.without_load[i],
            without_load_by_deviations: self.without_load_by_deviations[i],
            without_load_linear: self.without_load_linear[i],
            under_load: self.under_load.map(|v| v[i]),
            under_load_by_deviations: self.under_load_by_deviations.map(|v| v[i]),
            under_load_linear: self.under_load_linear.map(|v| v[i]),
        }
    }
}

impl Cases<f64> {
    /// All six, in the order of the fields.
    #[must_use]
    pub fn all(&self) -> [Option<f64>; 6] {
        [
            Some(self.without_load),
            Some(self.without_load_by_deviations),
            Some(self.without_load_linear),
            self.under_load,
            self.under_load_by_deviations,
            self.under_load_linear,
        ]
    }
}

/// The four equilibria of one place, and the first-order assembly.
#[derive(Clone, Debug)]
pub struct AssembledMachine {
    /// Posture of the machine as built.
    pub posture: Posture,
    /// Equilibria as drawn and as built, without load.
    pub rest: [MechanismEquilibrium; 2],
    /// Equilibria as drawn and as built, under load.
    pub loaded: Option<[MechanismEquilibrium; 2]>,
    /// First-order solution in the deviations, without load.
    pub linear: LinearAssembly,
    /// First-order solution under load.
    pub linear_loaded: Option<LinearAssembly>,
}

impl AssembledMachine {
    /// Solves both machines in a posture of the machine as built, without load and under a wrench on the tool.
    ///
    /// # Errors
    /// One of them has no equilibrium.
    pub fn solve(posture: Posture, drawn: &Posture, wrench: &Wrench) -> kinetostat::Result<Self> {
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
        Ok(Self {
            posture,
            rest,
            loaded,
            linear,
            linear_loaded,
        })
    }

    /// A scalar of the equilibria of the machine as built (`of`), what the deviations change of it, and the same to
    /// first order in them (`linear`). Under load there is none where the wrench is zero.
    #[must_use]
    pub fn scalar(
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
    #[must_use]
    pub fn vector(
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
