//! The machine in a milling cut: its tool response in the axes of the cut [D 8, D 10].

use kinetostat_chatter::{ChatterError, FeedFrame, MillingCut, Mode, Regeneration, ToolResponse};
use kinetostat_dynamics::{Damping, Error};

use crate::vibration::machine::VibratingMachine;

/// A machine, how it is damped, and what its tool cuts.
#[derive(Clone, Debug)]
pub struct MachineCut<'m> {
    /// At the place of the cut, the tool free.
    pub machine: &'m VibratingMachine,
    /// How it is damped.
    pub damping: &'m Damping,
    /// Feed and tool axis.
    pub frame: FeedFrame,
    /// What is cut.
    pub cut: MillingCut,
    /// Modes above this frequency count by their flexibility at rest, Hz.
    pub modes_up_to_hz: f64,
}

/// Why a machine has no lobes.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MachineCutError {
    /// The equilibrium is unstable or free: there is no vibration about it, and nothing that chatters.
    #[error("{0}")]
    NoVibration(String),
    /// From the machine: damping, loads without a potential.
    #[error(transparent)]
    Machine(#[from] Error),
    /// From the cut: no damping, a tool that does not give way, numbers that are none.
    #[error(transparent)]
    Cut(#[from] ChatterError),
}

impl MachineCut<'_> {
    /// The cut with the response of the tool's tip.
    ///
    /// # Errors
    /// [`MachineCutError`].
    pub fn regeneration(&self) -> Result<Regeneration, MachineCutError> {
        let counts = self.machine.modes.counts;
        if counts.unstable + counts.massless_unstable + counts.free > 0 {
            return Err(MachineCutError::NoVibration(format!(
                "there are no lobes: the machine does not hold its place here ({} unstable, {} massless unstable and {} free directions); see `kinetostat modes`",
                counts.unstable, counts.massless_unstable, counts.free
            )));
        }
        // Those above the band are springs, however they are damped.
        let own_hz = self.machine.modes.frequencies_hz();
        let kept = own_hz.iter().filter(|hz| **hz <= self.modes_up_to_hz);
        let kept = kept.count();
        if let (0, Some(lowest_hz)) = (kept, own_hz.first()) {
            return Err(MachineCutError::NoVibration(format!(
                "there are no lobes: the lowest mode of the machine is at {lowest_hz:.4} Hz, and modes up to {} Hz were asked for",
                self.modes_up_to_hz
            )));
        }
        let response = self.machine.tool_response(self.damping, kept)?;
        let data = response.translational()?;
        let modes = data.shapes.iter().zip(&data.squared).zip(&data.ratios);
        let modes = modes.zip(&own_hz).map(|(((shape, squared), ratio), hz)| {
            Mode::new(*shape, *squared, *ratio).map_err(|mut error| {
                error.quantity = format!("{} of the mode at {hz:.4} Hz", error.quantity);
                error
            })
        });
        let tool = ToolResponse::new(modes.collect::<Result<_, _>>()?)?;
        let tool = tool.with_residual(data.residual)?;
        Ok(Regeneration::new(
            tool.in_frame(&self.frame),
            self.cut.clone().into(),
        )?)
    }
}
