//! The load along a program.

use kinetostat::Wrench;
use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::{CornerLoad, CuttingLoad, LoadAxes, ProgramLoad};
use nalgebra::Vector3;

use crate::job::arguments::ProgramArgs;
use crate::job::format::{Axes, CornerWord, LoadTable};
use crate::job::job_file::JobFile;
use crate::options::{finite, vector};
use crate::ui::failure::{Answer, Failing};

pub(crate) fn load(
    job: Option<&JobFile>,
    table: Option<&LoadTable>,
    flags: &ProgramArgs,
) -> Answer<ProgramLoad> {
    let table = table.cloned().unwrap_or_default();
    if let (Some(j), Some(milling)) = (job, &table.milling)
        && (table.force_n.is_some() || table.moment_n_m.is_some() || table.axes.is_some())
    {
        return Err(j.error(
            milling,
            "the load is given twice: 'milling' and 'force_n', 'moment_n_m' or 'axes'",
            "keep one of them",
        ));
    }
    let constant =
        |force: Vector3<f64>, moment: Vector3<f64>, axes: Option<Axes>| CuttingLoad::Constant {
            axes: match axes.unwrap_or(Axes::Base) {
                Axes::Base => LoadAxes::Base,
                Axes::Tool => LoadAxes::Tool,
                Axes::Feed => LoadAxes::Feed,
            },
            wrench: Wrench::new(force, moment),
        };
    let has_force = flags.force.is_some()
        || flags.moment.is_some()
        || table.force_n.is_some()
        || table.moment_n_m.is_some();
    if flags.load_axes.is_some() && !has_force {
        return Err(ErrorCode::Unused.failure("--load-axes are the axes of a force or moment, and the load has none: add --force or --moment, or leave it out",
        ));
    }
    let cutting = if let Some(v) = &flags.milling {
        let v = vector("--milling", v)?;
        CuttingLoad::Milling {
            radial: v.x,
            tangential: v.y,
            axial: v.z,
        }
    } else if flags.force.is_some() || flags.moment.is_some() {
        // A force on the command line goes over a milling force of the job.
        let part = |name: &str, flag: &Option<Vec<f64>>, written: Option<[f64; 3]>| match flag {
            Some(v) => vector(name, v),
            None => Ok(written.map_or_else(Vector3::zeros, Into::into)),
        };
        constant(
            part("--force", &flags.force, table.force_n)?,
            part("--moment", &flags.moment, table.moment_n_m)?,
            flags.load_axes.or(table.axes),
        )
    } else if let Some(m) = &table.milling {
        let m = m.get_ref();
        CuttingLoad::Milling {
            radial: m.radial_n,
            tangential: m.tangential_n,
            axial: m.axial_n,
        }
    } else if table.force_n.is_some() || table.moment_n_m.is_some() {
        constant(
            table.force_n.unwrap_or_default().into(),
            table.moment_n_m.unwrap_or_default().into(),
            flags.load_axes.or(table.axes),
        )
    } else {
        CuttingLoad::None
    };
    possible(cutting)?;
    let mut load = ProgramLoad::new(cutting);
    let at_corners = flags.load_at_corners.or(table.at_corners);
    load.corners_stated = at_corners.is_some();
    load.at_corners = match at_corners {
        Some(CornerWord::FollowsFeed) => CornerLoad::FollowsFeed,
        Some(CornerWord::Turns) | None => CornerLoad::Turns,
    };
    load.below_z_mm = flags.below_z_mm.or(table.below_z_mm);
    if let Some(z) = load.below_z_mm {
        finite("the height below which the load acts", &[z])?;
    }
    if let (Some(j), Some(angle)) = (job, &table.gentle_corner_deg) {
        if !(0.0..=180.0).contains(angle.get_ref()) {
            return Err(j.error(
                angle,
                "a corner turns by 0 to 180 degrees",
                "correct the angle",
            ));
        }
        load.gentle_corner = angle.get_ref().to_radians();
    }
    if let (Some(j), Some(length)) = (job, &table.turning_length_mm) {
        if *length.get_ref() <= 0.0 {
            return Err(j.error(
                length,
                "a length above zero is needed",
                "write some millimetres",
            ));
        }
        load.turning_length_mm = *length.get_ref();
    }
    if let (Some(j), Some(step)) = (job, &table.largest_step_mm_per_mm) {
        if !(1e-4..=10.0).contains(step.get_ref()) {
            return Err(j.error(
                step,
                "a correction may change by 0.0001 to 10 mm per mm of path",
                "write 0.5, for instance",
            ));
        }
        load.largest_step = *step.get_ref();
    }
    Ok(load)
}

/// Largest part of a load on a tool, N or N m: far beyond what any limit allows, and far below where squares overflow.
const LARGEST: f64 = 1e9;

fn possible(cutting: CuttingLoad) -> Answer<()> {
    let parts = match cutting {
        CuttingLoad::Constant { wrench, .. } => wrench.0.iter().copied().collect(),
        CuttingLoad::Milling {
            radial,
            tangential,
            axial,
        } => vec![radial, tangential, axial],
        _ => Vec::new(),
    };
    match parts
        .into_iter()
        .find(|part| !(-LARGEST..=LARGEST).contains(part))
    {
        Some(part) => Err(ErrorCode::Value.failure(format!(
                "a part of the load on the tool is {part:e} N or N m; no more than {LARGEST:e} is possible: write the force in N and the moment in N m"
            ),
        )),
        None => Ok(()),
    }
}
