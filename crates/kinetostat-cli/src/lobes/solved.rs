//! Limits of a milling cut at a place, by the modes of the machine there.

use kinetostat::Pose;
use kinetostat_analysis::vibration::{MachineCut, MachineCutError, VibratingMachine};
use kinetostat_chatter::{Arc, FeedFrame, LobeDiagram, LobeRequest, Milled, MillingCut, Swinging};
use kinetostat_diagnostic::ErrorCode;
use kinetostat_dynamics::Damping;
use kinetostat_machining::{Warning, WarningCode};
use nalgebra::Vector3;

use crate::lobes::arguments::LobeCutArgs;
use crate::lobes::coefficients::CutCoefficients;
use crate::options::vector;
use crate::ui::failure::{Answer, Failing, Failure};
use crate::ui::numbers::number;
use crate::vibration::stability::{implausible, left_out_warning};
use crate::vibration::subject;

/// Modes up to this frequency vibrate whether they count or not, Hz.
const AT_LEAST_HZ: f64 = 1000.0;

/// Limits over the spindle speed, and what they rest on.
pub(crate) struct Lobes {
    pub(crate) diagram: LobeDiagram,
    pub(crate) coefficients: CutCoefficients,
    pub(crate) frame: FeedFrame,
    pub(crate) warnings: Vec<Warning>,
}

impl LobeCutArgs {
    /// The limits of a machine that vibrates with its tool at `target`.
    pub(crate) fn lobes(
        &self,
        target: &Pose,
        machine: &VibratingMachine,
        damping: &Damping,
    ) -> Answer<Lobes> {
        let (cut, coefficients) = self.cut()?;
        let request = self.request()?;
        let frame = self.frame(target)?;
        let asked = self.modes_up_to_hz;
        let swinging = asked.map_or(Swinging::AtLeastTo(AT_LEAST_HZ), Swinging::UpTo);
        let cut = MachineCut {
            machine,
            damping,
            frame,
            cut,
            swinging,
        };
        let regeneration = cut.regeneration().map_err(refused)?;
        let diagram = regeneration
            .lobes(&request)
            .map_err(|e| ErrorCode::NoAnswer.failure(format!("lobes: {e}")))?;
        let mut warnings = Vec::new();
        if let Some((left_out, rpm)) = diagram.left_out() {
            let at = format!("at {} rpm", number(rpm, 4));
            warnings.push(left_out_warning(&left_out, swinging, &at, rpm));
        }
        let off = machine.lost_coupling(damping, diagram.modes_up_to_hz());
        warnings.extend(subject::lost_coupling(off.map_err(subject::refused)?));
        warnings.extend(implausible(damping));
        warnings.extend(coefficients.warnings.iter().cloned());
        warnings.extend(beyond_all_modes(&request, self.teeth, machine));
        if let Some((speed, why)) = diagram.without_answer.first() {
            warnings.push(Warning::new(
                WarningCode::ChatterNotJudged,
                format!(
                    "no limit was found at {} of {} speeds, the first at {speed:.1} rpm: {why}",
                    diagram.without_answer.len(),
                    diagram.without_answer.len() + diagram.points.len()
                ),
            ));
        }
        Ok(Lobes {
            diagram,
            coefficients,
            frame,
            warnings,
        })
    }

    fn cut(&self) -> Answer<(MillingCut, CutCoefficients)> {
        let milled = match self.up && !self.climb {
            true => Milled::Up,
            false => Milled::Down,
        };
        let arc = Arc::straight(milled, self.immersion)
            .map_err(|error| ErrorCode::Value.failure(error))?;
        let coefficients = CutCoefficients::of(self, &arc)?;
        let cut = MillingCut::new(self.teeth, arc, coefficients.law)
            .map_err(|error| ErrorCode::Value.failure(error))?;
        let cut = match (self.helix_deg, self.diameter_mm) {
            (None, _) => Ok(cut),
            (Some(_), None) => Err(ErrorCode::Missing
                .failure("--helix-deg needs --diameter-mm: the edge lags behind its tip by both")),
            (Some(helix), Some(diameter)) => cut
                .with_helix(helix.to_radians(), 1e-3 * diameter)
                .map_err(|error| ErrorCode::Value.failure(error)),
        };
        Ok((cut?, coefficients))
    }

    /// Speeds and depths that are looked at.
    pub(crate) fn request(&self) -> Answer<LobeRequest> {
        let &[low, high, count] = self.rpm.as_slice() else {
            return Err(ErrorCode::Value.failure("--rpm needs LO HI N"));
        };
        let one = count == 1.0 && low == high && low > 0.0 && low.is_finite();
        if !one && (!(2.0..=20_000.0).contains(&count) || count.fract() != 0.0) {
            return Err(ErrorCode::Value.failure(format!(
                "--rpm: N is {count}; a whole number from 2 to 20000 is needed, or 1 with the same speed twice"
            ),
        ));
        }
        let rising = low > 0.0 && high > low && high.is_finite();
        if !(one || rising) {
            return Err(ErrorCode::Value.failure(format!(
                "--rpm {low} {high}: spindle speeds above 0 are needed, the second above the first"
            )));
        }
        if !(self.depth_mm > 0.0 && self.depth_mm <= 1e3) {
            return Err(ErrorCode::Value.failure(format!(
                "--depth-mm is {}; a depth above 0 and of at most 1000 mm is needed",
                self.depth_mm
            )));
        }
        Ok(LobeRequest::new(
            low,
            high,
            count as usize,
            1e-3 * self.depth_mm,
        ))
    }

    /// Feed, and the tool's axis: z of the tool's tip points out of the spindle.
    fn frame(&self, target: &Pose) -> Answer<FeedFrame> {
        let axis = match &self.tool_axis {
            Some(axis) => vector("--tool-axis", axis)?,
            None => target.rotation * -Vector3::z(),
        };
        let feed = vector("--feed-direction", &self.feed_direction)?;
        FeedFrame::new(feed, axis).map_err(|error| ErrorCode::Value.failure(error))
    }
}

fn refused(error: MachineCutError) -> Failure {
    match error {
        MachineCutError::Machine(error) => subject::refused(error),
        MachineCutError::Cut(error) => ErrorCode::Value.failure(error),
        _ => ErrorCode::NoAnswer.failure(error),
    }
}

/// Warns of teeth that pass far above all modes: the spindle speed is a slip, or modes of spindle and tool are missing.
fn beyond_all_modes(
    request: &LobeRequest,
    teeth: usize,
    machine: &VibratingMachine,
) -> Option<Warning> {
    let passing_hz = request.to_rpm * teeth as f64 / 60.0;
    let fastest_hz = subject::far_below(machine, passing_hz)?;
    Some(Warning::new(
        WarningCode::Model,
        format!(
            "at {} rpm the teeth pass at {} Hz, and the fastest mode of the model has {} Hz: no limit there says anything of a real spindle; check --rpm and --teeth",
            number(request.to_rpm, 4),
            number(passing_hz, 4),
            number(fastest_hz, 4)
        ),
    ))
}
