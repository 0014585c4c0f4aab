//! The machine in a milling cut: its tool response in the axes of the cut [D 8, D 10].

use kinetostat_chatter::{
    ChatterError, FeedFrame, MillingCut, Mode, Regeneration, Swinging, ToolResponse,
};
use kinetostat_dynamics::{Damping, Error, TranslationalModes};
use nalgebra::{DMatrix, Vector3};

use crate::vibration::machine::VibratingMachine;

/// A machine, how it is damped, and what its tool cuts.
#[derive(Clone, Debug)]
pub struct MachineCut<'m> {
    /// Machine at the place of the cut, the tool free.
    pub machine: &'m VibratingMachine,
    /// Law of damping of the machine.
    pub damping: &'m Damping,
    /// Feed and tool axis.
    pub frame: FeedFrame,
    /// Geometry and conditions of the cut.
    pub cut: MillingCut,
    /// Selection of the modes kept dynamic; the others enter as residual flexibility.
    pub swinging: Swinging,
}

/// Reason why a machine has no stability lobes.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MachineCutError {
    /// The equilibrium is unstable or free: there is no vibration about it, and nothing that chatters.
    #[error("{0}")]
    NoVibration(String),
    /// Error of the machine: damping, loads without a potential.
    #[error(transparent)]
    Machine(#[from] Error),
    /// Error of the cut: no damping, a tool that does not give way, numbers that are not finite.
    #[error(transparent)]
    Cut(#[from] ChatterError),
}

/// A ratio below which a mode has no damping of a machine: dampers at some joints alone hardly move it.
const SCARCE: f64 = 1e-4;

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
        let own_hz = self.machine.modes.frequencies_hz();
        if let (Swinging::UpTo(band_hz), Some(lowest_hz)) = (self.swinging, own_hz.first())
            && band_hz < *lowest_hz
        {
            return Err(MachineCutError::NoVibration(format!(
                "there are no lobes: the lowest mode of the machine is at {lowest_hz:.4} Hz, and modes up to {band_hz} Hz were asked for",
            )));
        }
        let response = self.machine.tool_response(self.damping, usize::MAX)?;
        let tool = self.tool(&response.translational()?, &own_hz)?;
        Ok(
            Regeneration::new(tool.in_frame(&self.frame), self.cut.clone().into())?
                .with_swinging(self.swinging),
        )
    }

    /// The response with the modes that can swing. Of those that cannot, damped by more than the critical or, above the band,
    /// by nothing that counts, the flexible ones are errors and the rest springs.
    fn tool(
        &self,
        data: &TranslationalModes,
        own_hz: &[f64],
    ) -> Result<ToolResponse, MachineCutError> {
        let above = |hz: f64| match self.swinging {
            Swinging::UpTo(band_hz) | Swinging::AtLeastTo(band_hz) => hz > band_hz,
            _ => false,
        };
        let (mut modes, mut odd) = (Vec::with_capacity(own_hz.len()), Vec::new());
        // Index of each mode in the data.
        let mut places = Vec::with_capacity(own_hz.len());
        let each = data.shapes.iter().zip(&data.squared).zip(&data.ratios);
        for (place, (((shape, squared), ratio), hz)) in each.zip(own_hz).enumerate() {
            let mode = match data.coupling.is_some() && *squared > 0.0 {
                true => Mode::with_rate(*shape, *squared, 2.0 * ratio * squared.sqrt()),
                false => Mode::new(*shape, *squared, *ratio),
            };
            match mode {
                Ok(mode) if *ratio >= SCARCE || !above(*hz) => {
                    modes.push(mode);
                    places.push(place);
                }
                other => odd.push((place, (shape, *squared, *hz, other))),
            }
        }
        // Compliance at rest, in the measure of the peaks of the dynamic modes.
        let across = |shape: &Vector3<f64>| {
            let turned = self.frame.rotation().transpose() * shape;
            turned.xy().norm() * shape.norm()
        };
        let largest = match ToolResponse::new(modes.clone()) {
            Ok(tool) => (tool.in_frame(&self.frame).modes().iter())
                .map(Mode::peak_flexibility)
                .fold(0.0, kinetostat::number::larger),
            Err(_) => 0.0,
        };
        let mut residual = data.residual;
        for (place, (shape, squared, hz, found)) in odd {
            let flexible = across(shape) / squared >= Swinging::SHARE * largest;
            let counts = match self.swinging {
                Swinging::AtLeastTo(_) => flexible,
                _ => !above(hz),
            };
            match found {
                Ok(mode) if counts => {
                    modes.push(mode);
                    places.push(place);
                }
                Err(mut error) if counts => {
                    error.quantity = format!("{} of the mode at {hz:.4} Hz", error.quantity);
                    return Err(error.into());
                }
                _ => residual += shape * shape.transpose() / squared,
            }
        }
        let tool = ToolResponse::new(modes)?.with_residual(residual)?;
        let Some(coupling) = &data.coupling else {
            return Ok(tool);
        };
        let before = data.shapes.len();
        places.extend(before..before + coupling.held.len());
        let n = places.len();
        let rates = DMatrix::from_fn(n, n, |i, j| coupling.rates[(places[i], places[j])]);
        Ok(tool.with_coupled_damping(rates, coupling.held.clone())?)
    }
}
