//! Response of a platform on limbs from the base, limb by limb: `D = sum T_i^T D_i T_i + K_geo - w^2 M_p`, with the
//! dynamic stiffness `D_i` of every limb by the bordered matrix of the statics [D5]. The cost grows with the cube of the
//! largest limb instead of that of the machine.

use kinetostat::spatial::shift_matrix;
use kinetostat::{MechanismEquilibrium, Posture};
use nalgebra::{Complex, DMatrix, Matrix6};

use crate::damping::Damping;
use crate::error::{Error, Result};
use crate::linear::LinearDynamics;
use crate::linear::build::Whole;
use crate::linear::chain::{named, units};
use crate::linear::limb::LimbShare;
use crate::linear::rotor::rotors_of;
use crate::mass::body;
use crate::modes::{DirectionCounts, Modes};
use crate::response::Receptance;

/// A machine of one platform, limb by limb.
pub struct LimbResponse {
    limbs: Vec<(LinearDynamics, Matrix6<f64>)>,
    platform_stiffness: Matrix6<f64>,
    platform_mass: Matrix6<f64>,
}

impl LimbResponse {
    /// Of a machine whose limbs all lead from the base to its only platform.
    ///
    /// # Errors
    /// [`Error::Question`] for other machines; as [`LinearDynamics::of_machine`].
    pub fn new(posture: &Posture, at: &MechanismEquilibrium) -> Result<Self> {
        let machine = posture.mechanism();
        if machine.platforms().len() != 2 || machine.limbs().iter().any(|l| l.from != 0) {
            return Err(Error::Question(format!(
                "'{}' has platforms between base and tool: only a direct solution has its response",
                machine.name()
            )));
        }
        if !rotors_of(machine).is_empty() {
            return Err(Error::Question(format!(
                "the drives of '{}' have rotors: only a direct solution has its response",
                machine.name()
            )));
        }
        let tangents = posture.tangents_at(&at.state, &at.wrench)?;
        let length = machine.natural_length();
        let mut limbs = Vec::with_capacity(machine.limbs().len());
        for (limb, tangent) in machine.limbs().iter().zip(&tangents.limbs) {
            let chain = &limb.actual;
            let own: Vec<f64> = units(chain, length).collect();
            let mut whole = Whole::sized(own.clone(), vec![(0..own.len()).collect()]);
            whole.add_limb(0, LimbShare::new(chain, "", 0, tangent)?);
            whole.coordinates.extend(named(chain, "", 0));
            let arm = at.state.platforms[1].rotation * limb.platform_from_tip.translation.vector;
            let dynamics = whole.unconstrained(&limb.name, chain.tip(), length, own);
            limbs.push((dynamics, shift_matrix(&arm)));
        }
        let platform = &machine.platforms()[1];
        let rotation = *at.state.platforms[1].rotation.to_rotation_matrix().matrix();
        body::check(&platform.name, platform.mass, &platform.inertia)?;
        let arm = rotation * platform.centre_of_mass;
        Ok(Self {
            limbs,
            platform_stiffness: Matrix6::from_fn(|i, j| tangents.platforms[(i, j)]),
            platform_mass: body::about_point(platform.mass, &platform.inertia, &rotation, &arm),
        })
    }

    /// Dynamic stiffness of the platform about its origin, N/m and so on. Damping by ratios needs modes of the whole machine
    /// and is refused.
    ///
    /// # Errors
    /// [`Error::Damping`]; [`Error::NotSolved`] at a resonance of a limb with its end held.
    pub fn dynamic_stiffness(&self, damping: &Damping, hz: f64) -> Result<Receptance> {
        if matches!(
            damping,
            Damping::Ratio(_) | Damping::Ratios(_) | Damping::Viscous(_)
        ) {
            return Err(Error::Damping("modal ratios and dampers by name are those of the whole machine; limb by limb go Rayleigh and structural damping".to_owned()));
        }
        let none = Modes {
            modes: Vec::new(),
            counts: DirectionCounts::default(),
            neutral: Vec::new(),
        };
        let w = hz * std::f64::consts::TAU;
        let complex = |m: &Matrix6<f64>| m.map(|x| Complex::new(x, 0.0));
        let mut mass_factor = Complex::new(-w * w, 0.0);
        if let Damping::Rayleigh { mass_per_s, .. } = damping {
            mass_factor.im += w * mass_per_s;
        }
        let mut sum =
            complex(&self.platform_stiffness) + complex(&self.platform_mass) * mass_factor;
        for (limb, shift) in &self.limbs {
            let own = limb
                .direct(&none, damping)?
                .dynamic_stiffness(limb.tool(), hz)?;
            let shift = complex(shift);
            sum += shift.transpose() * own * shift;
        }
        Ok(sum)
    }

    /// Receptance of the platform about its origin.
    ///
    /// # Errors
    /// As [`Self::dynamic_stiffness`]; [`Error::NotSolved`] at an undamped resonance.
    pub fn at_hz(&self, damping: &Damping, hz: f64) -> Result<Receptance> {
        let stiffness = self.dynamic_stiffness(damping, hz)?;
        // Metres and radians apart by the sizes of the diagonal.
        let units: Vec<f64> = (0..6)
            .map(|k| 1.0 / stiffness[(k, k)].norm().sqrt().max(f64::MIN_POSITIVE))
            .collect();
        let scaled = DMatrix::from_fn(6, 6, |i, j| stiffness[(i, j)] * (units[i] * units[j]));
        let inverse = scaled.try_inverse().ok_or_else(|| {
            Error::NotSolved(format!("the platform has no finite response at {hz} Hz"))
        })?;
        Ok(Matrix6::from_fn(|i, j| {
            inverse[(i, j)] * (units[i] * units[j])
        }))
    }
}
