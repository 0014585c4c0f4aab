//! Measured modes of the tool beside those of a model, and numbers of the model scaled to them [D 11].

use kinetostat::number::larger;
use kinetostat_chatter::{
    ChatterError, ChatterErrorKind, Fit, FittedMode, MeasuredResponse, ModePair, Parameter, Scaled,
    ShapedMode, fit_modes, pair_modes, scale_parameters,
};
use kinetostat_dynamics::ModeKind;
use schemars::JsonSchema;
use serde::Serialize;

use crate::vibration::machine::VibratingMachine;

/// Modes of the model up to so many times the highest measured frequency are looked at.
const HIGHER: f64 = 4.0;
/// Modes whose frequencies differ by more than this factor are not the same, whatever their shapes.
const SAME: f64 = 1.5;
/// A fitted mode whose peak is less than this share of the highest one is none that was measured: the force does not excite it.
const EXCITED: f64 = 1e-3;
/// A mode that moves the tool by less than this share of the most moving one is not seen there.
const SEEN: f64 = 1e-6;

/// Modes that were found in measured responses of the tool's tip.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct MeasuredModes {
    /// Frequencies, damping and constants of the curves, and how well they follow them.
    pub fit: Fit,
    /// Names of the curves.
    pub curves: Vec<String>,
    /// Names of the curves by other forces, which are not fitted: shapes are those of curves by the same force.
    pub others: Vec<String>,
    /// Axis of the motion of each curve, 0 to 2 for x, y, z of the base, and its sign.
    directions: Vec<(usize, f64)>,
    /// Axis and sign of the force, if it is known to act at the place of the motion.
    reference: Option<(usize, f64)>,
}

/// The model's modes that the tool can show, as they are compared.
#[derive(Clone, Debug, PartialEq)]
pub struct ShownModes {
    /// Numbers of these modes among those of the machine.
    pub numbers: Vec<usize>,
    /// Their frequencies, damping and shapes along the measured directions.
    pub modes: Vec<ShapedMode>,
    /// Motion of the tool's tip in each, base axes, normalised by mass.
    pub at_tool: Vec<[f64; 3]>,
}

impl MeasuredModes {
    /// Fits so many modes in a band, Hz, to the curves by one force: the first along the first of these axes (0 to 2 for x, y, z) that
    /// has one, else that of the first curve. Axes of the measurement are those of the base.
    ///
    /// # Errors
    /// A curve without a direction along x, y or z, and those of [`fit_modes`].
    pub fn fitted(
        responses: &[MeasuredResponse],
        axes: &[usize],
        modes: usize,
        band_hz: [f64; 2],
    ) -> Result<Self, ChatterError> {
        let force = |r: &MeasuredResponse| (r.reference_node, r.reference_direction.unsigned_abs());
        let along = |axis: &usize| {
            let mut all = responses.iter();
            all.find(|response| force(response).1 as usize == axis + 1)
        };
        let chosen = axes.iter().find_map(along).or_else(|| responses.first());
        let chosen = chosen.map(force);
        let is_own = |response: &MeasuredResponse| Some(force(response)) == chosen;
        let (own, by_others): (Vec<_>, Vec<_>) = responses.iter().cloned().partition(is_own);
        let directions = own.iter().map(|response| {
            let direction = response.response_direction;
            match direction.abs() {
                axis @ 1..=3 => Ok((axis as usize - 1, f64::from(direction.signum()))),
                _ => Err(ChatterError::new(
                    ChatterErrorKind::Measurement,
                    format!("direction of '{}'", response.name),
                    direction,
                    "motion along x, y or z: name the columns as in xx_re_um_per_n",
                )),
            }
        });
        let directions = directions.collect::<Result<_, _>>()?;
        let mut fit = fit_modes(&own, modes, band_hz)?;
        let peak = |mode: &FittedMode| {
            let largest = mode.constants.iter().map(|c| c.abs());
            largest.fold(0.0, larger) / (mode.damping_ratio * mode.frequency_hz.powi(2))
        };
        let highest = fit.modes.iter().map(peak).fold(0.0, larger);
        let all = std::mem::take(&mut fit.modes).into_iter();
        let (excited, others): (Vec<_>, Vec<_>) =
            all.partition(|mode| peak(mode) >= EXCITED * highest);
        fit.left_out_hz
            .extend(others.iter().map(|mode| mode.frequency_hz));
        fit.modes = excited;
        let at_one_place = own.iter().all(|r| r.response_node == r.reference_node);
        let force = own.first().map_or(0, |r| r.reference_direction);
        let reference = match force.abs() {
            axis @ 1..=3 if at_one_place => Some((axis as usize - 1, f64::from(force.signum()))),
            _ => None,
        };
        Ok(Self {
            directions,
            reference,
            curves: own.into_iter().map(|response| response.name).collect(),
            others: by_others
                .into_iter()
                .map(|response| response.name)
                .collect(),
            fit,
        })
    }

    /// A curve whose motion is along its own force, at its own place, and whose modes give way against that force at rest: none
    /// does, so that a sign is wrong (of a sensor, of a hammer, of an axis).
    #[must_use]
    pub fn against_its_force(&self) -> Option<&str> {
        let (axis, sign) = self.reference?;
        let own = (self.directions.iter()).position(|(along, _)| *along == axis)?;
        let flexibility: f64 = (self.fit.modes.iter())
            .map(|mode| mode.constants[own] / mode.frequency_hz.powi(2))
            .sum();
        let turned = flexibility * sign * self.directions[own].1 < 0.0;
        turned.then_some(self.curves[own].as_str())
    }

    /// Factors from measured constants (products of mass-normalised shapes at motion and force) to those of the model,
    /// one per pair, by least squares over the curves. A factor is 1 where mass and units are right, `None` where the
    /// force does not act at the place of the motions or its direction is unknown.
    #[must_use]
    pub fn amplitudes(&self, shown: &ShownModes, pairs: &[ModePair]) -> Vec<Option<f64>> {
        let of = |pair: &ModePair| {
            let (axis, sign) = self.reference?;
            let by_force = sign * shown.at_tool[pair.model][axis];
            let model = shown.modes[pair.model].shape.iter();
            let measured = self.fit.modes[pair.measured].constants.iter();
            let (mut both, mut own) = (0.0, 0.0);
            for (model, measured) in model.zip(measured) {
                let constant = model * by_force;
                both += measured * constant;
                own += constant * constant;
            }
            (own > 0.0).then(|| both / own)
        };
        pairs.iter().map(of).collect()
    }

    /// The measured modes, shapes along the directions of the curves.
    #[must_use]
    pub fn shaped(&self) -> Vec<ShapedMode> {
        let modes = self.fit.modes.iter();
        modes
            .map(|mode| ShapedMode {
                frequency_hz: mode.frequency_hz,
                damping_ratio: mode.damping_ratio,
                shape: mode.constants.clone(),
            })
            .collect()
    }

    /// Modes of the model that the tool shows along the measured directions; `ratios` are their shares of critical damping (none
    /// where the model says nothing).
    #[must_use]
    pub fn shown(&self, machine: &VibratingMachine, ratios: Option<&[f64]>) -> ShownModes {
        let highest = self.fit.modes.iter().map(|mode| mode.frequency_hz);
        let highest = highest.fold(0.0, larger);
        let all = machine.modes.modes.iter().enumerate();
        let vibrating = all.filter(|(_, mode)| {
            mode.kind == ModeKind::Vibration && mode.frequency_hz() <= HIGHER * highest
        });
        let shaped: Vec<(usize, ShapedMode)> = vibrating
            .map(|(number, mode)| {
                let along = |(axis, sign): &(usize, f64)| sign * mode.tool[*axis];
                let shape = ShapedMode {
                    frequency_hz: mode.frequency_hz(),
                    damping_ratio: ratios.map_or(0.0, |ratios| ratios[number]),
                    shape: self.directions.iter().map(along).collect(),
                };
                (number, shape)
            })
            .collect();
        let size = |mode: &ShapedMode| mode.shape.iter().map(|x| x * x).sum::<f64>().sqrt();
        let most = (shaped.iter().map(|(_, mode)| size(mode))).fold(0.0, larger);
        let seen = shaped
            .into_iter()
            .filter(|(_, mode)| size(mode) > SEEN * most);
        let (numbers, modes): (Vec<usize>, Vec<ShapedMode>) = seen.unzip();
        let tool = |number: &usize| machine.modes.modes[*number].tool;
        ShownModes {
            at_tool: (numbers.iter())
                .map(|number| std::array::from_fn(|k| tool(number)[k]))
                .collect(),
            numbers,
            modes,
        }
    }

    /// Each measured mode with that of the model which it resembles most, if their frequencies are within a factor of 1.5;
    /// `model` counts [`ShownModes::modes`].
    ///
    /// # Errors
    /// As [`pair_modes`].
    pub fn beside(&self, shown: &ShownModes) -> Result<Vec<ModePair>, ChatterError> {
        let mut pairs = pair_modes(&self.shaped(), &shown.modes)?;
        pairs.retain(|pair| (1.0 / SAME - 1.0..=SAME - 1.0).contains(&pair.frequency_apart));
        Ok(pairs)
    }

    /// Scales numbers of the model so that its frequencies are the measured ones, each known to a share `deviation` of itself,
    /// and, where a share `damping_deviation` is given, its damping ratios too. `machine_of` takes the numbers to the machine
    /// and to the ratios of all its modes (which are read in the second case alone).
    ///
    /// # Errors
    /// Those of `machine_of`, [`scale_parameters`] and [`pair_modes`]; a measured mode that the model has not.
    pub fn scaled<E: From<ChatterError>>(
        &self,
        parameters: &[Parameter],
        deviation: f64,
        damping_deviation: Option<f64>,
        mut machine_of: impl FnMut(&[f64]) -> Result<(VibratingMachine, Option<Vec<f64>>), E>,
    ) -> Result<Scaled, E> {
        let modes = &self.fit.modes;
        let known = |value: f64, share: f64| (value, share * value);
        let mut measured: Vec<(f64, f64)> = (modes.iter())
            .map(|mode| known(mode.frequency_hz, deviation))
            .collect();
        if let Some(share) = damping_deviation {
            measured.extend(modes.iter().map(|mode| known(mode.damping_ratio, share)));
        }
        let mut failed = None;
        let scaled = scale_parameters(parameters, &measured, |values| {
            let (machine, ratios) = machine_of(values).map_err(|error| {
                failed = Some(error);
                lost("machine", "no answer of the model")
            })?;
            let shown = self.shown(&machine, ratios.as_deref());
            // A mode may be far off during the iteration.
            let pairs = pair_modes(&self.shaped(), &shown.modes)?;
            if pairs.len() < modes.len() {
                return Err(lost("modes of the model", "fewer than were measured"));
            }
            let of = |pair: &ModePair| &shown.modes[pair.model];
            let mut found: Vec<f64> = pairs.iter().map(|p| of(p).frequency_hz).collect();
            if damping_deviation.is_some() {
                found.extend(pairs.iter().map(|p| of(p).damping_ratio));
            }
            Ok(found)
        });
        scaled.map_err(|error| failed.unwrap_or_else(|| E::from(error)))
    }
}

fn lost(quantity: &str, found: &str) -> ChatterError {
    let kind = ChatterErrorKind::Measurement;
    ChatterError::new(kind, quantity, found, "a mode for each that was measured")
}
