//! Material: the library and a file of the user's, and the factors by which the cut differs from the test.

use std::path::Path;

use kinetostat_cutting::{Applied, Coolant, Correction, CuttingMaterial, Material, Materials};
use kinetostat_diagnostic::ErrorCode;

use crate::files::input_files::InputFiles;
use crate::force::arguments::{CoolantWord, EdgeWord, MaterialArgs};
use crate::force::refusal::refused;
use crate::ui::failure::{Answer, Failing};

/// The materials of a file and of the library.
pub(crate) fn materials(files: &InputFiles, own: Option<&Path>) -> Answer<Materials> {
    let mut all = Materials::library();
    if let Some(path) = own {
        let text = files.settings("file of materials", path)?;
        let read = Materials::read(&path.display().to_string(), &text);
        all.with(read.map_err(|error| refused(&error))?);
    }
    Ok(all)
}

/// The material that was named.
pub(crate) fn material(materials: &Materials, args: &MaterialArgs) -> Answer<Material> {
    let Some(name) = &args.material else {
        return Err(ErrorCode::Missing.failure("what is cut? Give --material NAME; `kinetostat force --list-materials` shows the names",
        ));
    };
    let found = materials.find(name).map_err(|error| {
        let near = match error.is_suggestion {
            true => format!("; {}", error.expected),
            false => ";".to_owned(),
        };
        ErrorCode::UnknownName.failure(format!(
            "--material: {}{near} `kinetostat force --list-materials` shows them, and --materials FILE.toml takes your own",
            error.found
        ))
    })?;
    Ok(found.clone())
}

/// Type of the cutting process.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Made {
    Milled,
    /// Drilled or turned: an edge that stays in the cut, as in a turning test.
    Steadily,
}

/// The factors by which a cut differs from the test. `rake_deg`: of the table of tools; `speed_m_per_min`: where the speed is to
/// be corrected for.
pub(crate) fn correction(
    args: &MaterialArgs,
    made: Made,
    rake_deg: Option<f64>,
    speed_m_per_min: Option<f64>,
) -> Correction {
    Correction {
        process: match made {
            Made::Milled => args.process_factor,
            Made::Steadily => args.process_factor.or(Some(1.0)),
        },
        cutting_speed_m_per_min: speed_m_per_min,
        rake_deg: args.rake_deg.or(rake_deg),
        cutting_material: match args.edge {
            None | Some(EdgeWord::Carbide) => CuttingMaterial::Carbide,
            Some(EdgeWord::HighSpeedSteel) => CuttingMaterial::HighSpeedSteel,
            Some(EdgeWord::Ceramic) => CuttingMaterial::Ceramic,
        },
        wear: args.wear,
        coolant: match args.coolant {
            None | Some(CoolantWord::Dry) => Coolant::Dry,
            Some(CoolantWord::Emulsion) => Coolant::Emulsion,
            Some(CoolantWord::Oil) => Coolant::Oil,
        },
        ..Correction::default()
    }
}

/// Applies the material law to this cut.
pub(crate) fn applied(
    material: &Material,
    args: &MaterialArgs,
    made: Made,
    rake_deg: Option<f64>,
    speed_m_per_min: Option<f64>,
) -> Answer<Applied> {
    let correction = correction(args, made, rake_deg, speed_m_per_min);
    let applied = material.for_milling(&correction);
    let mut applied = applied.map_err(|error| refused(&error))?;
    if made == Made::Steadily {
        // The axial part without a helix is that of the test.
        applied.law.law = material.clone();
    }
    if args.process_factor.is_none() && made == Made::Steadily {
        // Nobody gave the 1 that keeps the factor of milling away.
        applied.factors.retain(|factor| factor.symbol != "K_PRO");
    }
    Ok(applied)
}
