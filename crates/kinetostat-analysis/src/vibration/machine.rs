//! Equilibrium and modes of a machine under a load, parts without mass, motion of all parts in a mode [D 3].

use kinetostat::machine::MechanismState;
use kinetostat::spatial::moved;
use kinetostat::{MechanismEquilibrium, Posture, Twist, Wrench};
use kinetostat_dynamics::{
    ComplexModes, Damping, Held, LinearDynamics, ModalResponse, Mode, Modes, Result, Verdict,
};

/// A machine that vibrates about the equilibrium under a load.
#[derive(Clone, Debug)]
pub struct VibratingMachine {
    /// Equilibrium about which the machine vibrates.
    pub equilibrium: MechanismEquilibrium,
    /// Mass, tangent and motions there.
    pub dynamics: LinearDynamics,
    /// Undamped modes of the machine.
    pub modes: Modes,
}

impl VibratingMachine {
    /// Vibrations at a posture under a wrench on the tool (N, N m, base axes), the tool held in some directions while
    /// it vibrates.
    ///
    /// # Errors
    /// [`kinetostat_dynamics::Error`]: no equilibrium, no mass anywhere, an inertia that no body has.
    pub fn at(posture: &Posture, wrench: &Wrench, held: &Held) -> Result<Self> {
        let equilibrium = posture.deflected_by(wrench)?;
        let dynamics = LinearDynamics::of_machine(posture, &equilibrium, held)?;
        let modes = dynamics.modes()?;
        Ok(Self {
            equilibrium,
            dynamics,
            modes,
        })
    }

    /// Response of the tool's tip to what acts on it, by `kept` modes and the residual flexibility of all others [D 8].
    ///
    /// # Errors
    /// As [`ModalResponse::new`].
    pub fn tool_response(&self, damping: &Damping, kept: usize) -> Result<ModalResponse> {
        let tool = self.dynamics.tool();
        ModalResponse::new(&self.dynamics, &self.modes, damping, tool, tool, kept)
    }

    /// Complex modes, the lowest `count`, and what becomes of a small disturbance, where loads have no potential; `None`
    /// where they all have one, and real modes say it all.
    ///
    /// # Errors
    /// As [`LinearDynamics::complex_modes_damped`].
    pub fn complex_modes(&self, damping: &Damping, count: usize) -> Result<Option<ComplexModes>> {
        if !self.dynamics.is_circulatory() {
            return Ok(None);
        }
        self.dynamics
            .complex_modes_damped(&self.modes, damping, count)
            .map(Some)
    }

    /// True if small disturbances do not grow: by the modes, and where loads have no potential by the complex modes, as
    /// far as these are judged ([`Verdict::NotJudged`]).
    #[must_use]
    pub fn stable(&self, complex: Option<&ComplexModes>) -> bool {
        match complex.map(|found| &found.verdict) {
            Some(Verdict::Stable) => true,
            Some(Verdict::Flutter | Verdict::Divergence) => false,
            _ => self.modes.stable(),
        }
    }

    /// Limbs and platforms without any mass: their parts follow at once, and their own frequencies are missing.
    #[must_use]
    pub fn without_mass(&self, posture: &Posture) -> Vec<String> {
        let machine = posture.mechanism();
        let parts = self.dynamics.mass_parts();
        let several = machine.limbs().len() > 1;
        let limbs = machine.limbs().iter().filter(|limb| {
            let prefix = format!("{}.", limb.name);
            several && !parts.iter().any(|part| part.name.starts_with(&prefix))
        });
        let platforms = machine.platforms().iter().skip(1);
        limbs
            .map(|limb| format!("limb '{}'", limb.name))
            .chain(
                platforms
                    // The mass on a single limb may be part of its last body, as the flange of an arm is.
                    .filter(|p| several && p.mass == 0.0)
                    .map(|p| format!("platform '{}'", p.name)),
            )
            .collect()
    }

    /// The state that a mode has moved by `step` of its shape (times `sqrt(kg)`): for drawings, so small that all parts move
    /// along straight lines.
    #[must_use]
    pub fn moved_in(&self, posture: &Posture, mode: &Mode, step: f64) -> MechanismState {
        let mut state = self.equilibrium.state.clone();
        let motions = self.dynamics.block_motions(mode);
        let limbs = posture.mechanism().limbs().len();
        let (of_limbs, of_platforms) = motions.split_at(limbs);
        for (own, motion) in state.coordinates.iter_mut().zip(of_limbs) {
            // Coordinates of the platform that carries the limb may follow its own.
            for (x, moves) in own.iter_mut().zip(motion.iter()) {
                *x += step * moves;
            }
        }
        for (platform, motion) in state.platforms.iter_mut().skip(1).zip(of_platforms) {
            let twist = Twist(motion.fixed_rows::<6>(0) * step);
            *platform = moved(platform, &twist);
        }
        state
    }
}
