//! Coefficients of the cut: stated, or of a material at the thickness of its chips.

use kinetostat_chatter::{Arc, Coefficients};
use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::{Warning, WarningCode};

use crate::files::input_files::InputFiles;
use crate::force::fit::findings::radial_above_tangential;
use crate::force::material::{Made, applied, material, materials};
use crate::lobes::arguments::LobeCutArgs;
use crate::ui::failure::{Answer, Failing};
use crate::ui::numbers::number;

/// Tangential coefficients that materials have, N/mm^2: foams and wax have some tens, hardened steel with chips of some
/// hundredths of a millimetre ten thousand.
const PLAUSIBLE: std::ops::RangeInclusive<f64> = 5.0..=20_000.0;

/// The linear law of force of the cut.
pub(crate) struct CutCoefficients {
    pub(crate) law: Coefficients,
    /// Name of the material and the chip thickness at which its law was linearised, mm.
    pub(crate) of_material: Option<(String, f64)>,
    pub(crate) warnings: Vec<Warning>,
}

impl CutCoefficients {
    pub(crate) fn of(args: &LobeCutArgs, arc: &Arc) -> Answer<Self> {
        match &args.material.material {
            Some(_) => Self::of_material(args, arc),
            None => {
                let law = stated(&args.coefficients_n_per_mm2)?;
                Ok(Self {
                    law,
                    of_material: None,
                    warnings: exchanged(&law)
                        .into_iter()
                        .chain(odd_sign(&law, args.helix_deg))
                        .collect(),
                })
            }
        }
    }

    fn of_material(args: &LobeCutArgs, arc: &Arc) -> Answer<Self> {
        let Some(feed_mm) = args.feed_per_tooth_mm else {
            return Err(ErrorCode::Missing.failure("--material needs --feed-per-tooth-mm: how steep its law is depends on the thickness of the chips",
            ));
        };
        if !(1e-4..=10.0).contains(&feed_mm) {
            return Err(ErrorCode::Value.failure(format!(
                "--feed-per-tooth-mm is {feed_mm}; 0.0001 to 10 mm are possible"
            )));
        }
        if args.material.correct_speed {
            return Err(ErrorCode::Unused.failure(
                "--correct-speed: the cutting speed differs along the lobes; leave it out",
            ));
        }
        let files = InputFiles::default();
        let own = args.material.materials.as_deref();
        let material = material(&materials(&files, own)?, &args.material)?;
        let applied = applied(&material, &args.material, Made::Milled, None, None)?;
        let chip_mm = feed_mm * arc.mean_sine().abs();
        let found = Coefficients::linearised(&applied.law, 1e-3 * chip_mm)
            .map_err(|error| ErrorCode::UnknownName.failure(error))?;
        let outside = found.within_measured == Some(false);
        let warning = outside.then(|| {
            Warning::new(
                WarningCode::ChipsOutsideMeasured,
                format!(
                    "chips are {} mm thick in the mean, which is not what {} was measured with",
                    number(chip_mm, 3),
                    material.name
                ),
            )
        });
        Ok(Self {
            law: found.coefficients,
            of_material: Some((material.name.clone(), chip_mm)),
            warnings: warning.into_iter().collect(),
        })
    }

    /// Tangential, radial, axial, N/mm^2.
    pub(crate) fn n_per_mm2(&self) -> Vec<f64> {
        let law = &self.law;
        [law.tangential(), law.radial(), law.axial()]
            .map(|value| 1e-6 * value)
            .to_vec()
    }
}

/// A radial coefficient above the tangential one, as `force --fit` asks.
fn exchanged(law: &Coefficients) -> Option<Warning> {
    let [tangential, radial] = [law.tangential(), law.radial()].map(|pa| 1e-6 * pa);
    (radial > tangential).then(|| {
        let found = radial_above_tangential([radial, tangential], "N/mm^2");
        let text = format!("{found}: --coefficients-n-per-mm2 takes KT KR KA");
        Warning::new(WarningCode::ImplausibleCoefficient, text)
    })
}

/// An axial coefficient with a sign that its helix does not make: the rake face presses the chip where the helix carries it, and
/// the tool is pushed to the other side (oblique cutting with friction below 1).
fn odd_sign(law: &Coefficients, helix_deg: Option<f64>) -> Option<Warning> {
    let axial = 1e-6 * law.axial();
    let helix_deg = helix_deg.unwrap_or(0.0);
    let (is_odd, helix) = match helix_deg < 0.0 {
        true => (axial < 0.0, "a helix below zero"),
        false => (axial > 0.0, "a helix that lifts the chip"),
    };
    is_odd.then(|| {
        Warning::new(
            WarningCode::ImplausibleCoefficient,
            format!(
                "KA is {axial} N/mm^2: is its sign meant? Positive pushes the tool towards the spindle, and {helix} pushes it {} (the part the other way). Tables of coefficients mostly count towards the part: give {} then, or the helix with its sign (--helix-deg with --diameter-mm)",
                if axial > 0.0 { "to the part" } else { "towards the spindle" },
                -axial
            ),
        )
    })
}

fn stated(given: &[f64]) -> Answer<Coefficients> {
    let &[tangential, radial, axial] = given else {
        return Err(ErrorCode::Value.failure("--coefficients-n-per-mm2 needs KT KR KA"));
    };
    if tangential > 50.0 && radial != 0.0 && radial.abs() < 5.0 {
        return Err(ErrorCode::Value.failure(format!(
                "--coefficients-n-per-mm2: KR is {radial} beside KT {tangential}; it looks like a ratio. In N/mm^2 it is {}",
                radial * tangential
            ),
        ));
    }
    if !PLAUSIBLE.contains(&tangential) {
        return Err(ErrorCode::Value.failure(format!(
                "--coefficients-n-per-mm2: KT is {tangential} N/mm^2; {} to {} are possible, from foam to hardened steel at thin chips{}",
                PLAUSIBLE.start(),
                PLAUSIBLE.end(),
                match PLAUSIBLE.contains(&(1e-6 * tangential)) {
                    true => format!(
                        ". It looks like a value in Pa: in N/mm^2 it is {}",
                        1e-6 * tangential
                    ),
                    false => String::new(),
                }
            ),
        ));
    }
    let larger = [radial, axial]
        .into_iter()
        .find(|k| k.abs() > *PLAUSIBLE.end());
    if let Some(other) = larger {
        return Err(ErrorCode::Value.failure(format!(
            "--coefficients-n-per-mm2: {other} N/mm^2 is more than any material has ({} at most)",
            PLAUSIBLE.end()
        )));
    }
    Coefficients::new(1e6 * tangential, 1e6 * radial, 1e6 * axial)
        .map_err(|error| ErrorCode::Value.failure(error))
}
