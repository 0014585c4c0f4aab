//! Vibration of a machine at a place under a load: equilibrium, modes, parts without mass, motion of all parts in a
//! mode, and chatter stability of its cut.
//!
//! Sections of the theory of vibrations are cited as [D 3]. SI units.

mod cut;
mod machine;
mod measured;
pub mod program;

use kinetostat_dynamics::{
    Damping, DirectResponse, ModalResponse, Point, Quantity, Receptance, Result,
};

pub use cut::{MachineCut, MachineCutError};
pub use machine::VibratingMachine;
pub use measured::{MeasuredModes, ShownModes};

/// Receptance of a machine's tool, ready for any frequency.
pub enum ToolReceptance<'m> {
    /// Modal superposition, each mode with its own damping, and the residual flexibility of the others.
    ByModes(Box<ModalResponse>),
    /// Direct solution of all coordinates at each frequency.
    Direct(Box<DirectResponse<'m>>, Point),
}

impl VibratingMachine {
    /// The receptance of the tool's tip. By the lowest `kept` modes where a number is given. Else by all modes where no
    /// damping couples them, and by direct solution where one does (dampers at joints, Rayleigh's or structural damping under
    /// load) or where loads have no potential.
    ///
    /// # Errors
    /// As [`ModalResponse::new`] and [`kinetostat_dynamics::LinearDynamics::direct`].
    pub fn tool_receptance(
        &self,
        damping: &Damping,
        kept: Option<usize>,
    ) -> Result<ToolReceptance<'_>> {
        let directly =
            self.dynamics.modes_are_coupled_by(damping) || self.dynamics.is_circulatory();
        Ok(match kept {
            None if directly => ToolReceptance::Direct(
                Box::new(self.dynamics.direct(&self.modes, damping)?),
                self.dynamics.tool(),
            ),
            _ => ToolReceptance::ByModes(Box::new(
                self.tool_response(damping, kept.unwrap_or(usize::MAX))?,
            )),
        })
    }

    /// Error of the tip's translational response by modes, viscous coupling included, at the frequencies of the
    /// vibrations up to one, Hz: the largest share of the direct response. 0 where no damper couples modes. Effects of
    /// dampers on massless parts and the coupling by structural damping are not in the modes.
    ///
    /// # Errors
    /// See [`Self::tool_receptance`].
    pub fn lost_coupling(&self, damping: &Damping, up_to_hz: f64) -> Result<f64> {
        if !self.dynamics.modes_are_coupled_by(damping) || self.dynamics.is_circulatory() {
            return Ok(0.0);
        }
        let hz: Vec<f64> = (self.modes.frequencies_hz().into_iter())
            .filter(|hz| *hz > 0.0 && *hz <= up_to_hz)
            .collect();
        let by_modes = self.tool_response(damping, usize::MAX)?.translational()?;
        let directly = self.tool_receptance(damping, None)?.over(&hz)?;
        let off = hz.iter().zip(directly).map(|(hz, direct)| {
            let along = direct.fixed_view::<3, 3>(0, 0).into_owned();
            (by_modes.receptance_at_hz(*hz) - along).norm() / along.norm()
        });
        Ok(off.fold(0.0, kinetostat::number::larger))
    }
}

impl ToolReceptance<'_> {
    /// Displacement by force at many frequencies, Hz; what else is asked for is this by [`Quantity::factor`].
    ///
    /// # Errors
    /// [`kinetostat_dynamics::Error::NotSolved`] of a direct solution exactly at an undamped resonance.
    pub fn over(&self, hz: &[f64]) -> Result<Vec<Receptance>> {
        match self {
            Self::ByModes(response) => Ok(response.over(hz, Quantity::Displacement)),
            Self::Direct(response, tool) => response.over(*tool, *tool, hz, Quantity::Displacement),
        }
    }

    /// Name of the method of solution.
    #[must_use]
    pub fn solution(&self) -> &'static str {
        match self {
            Self::ByModes(_) => "modes",
            Self::Direct(..) => "direct",
        }
    }
}
