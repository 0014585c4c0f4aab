//! Missing data of a cut, neither in options nor job file, requested by name.

use crate::engagement::arguments::EngagementArgs;
use crate::force::arguments::MaterialArgs;
use crate::job::format::Job;
use crate::job::job_file::JobFile;
use crate::ui::failure::{Answer, Failure};

pub(super) const NO_STOCK: &str = "no stock: give --block-mm X0 Y0 Z0 X1 Y1 Z1 (two corners, program coordinates), --width-mm with --depth-mm for the same cut everywhere, or --job JOB";

/// Reports all missing data at once.
pub(super) fn nothing_missing(job: Option<&JobFile>, args: &EngagementArgs) -> Answer<()> {
    let of_job = |says: fn(&Job) -> bool| job.is_some_and(|j| says(&j.job));
    let mut missing = Vec::new();
    if args.material.material.is_none() && !of_job(|job| job.material.is_some()) {
        missing.push(
            "no material: give --material NAME (`kinetostat force --list-materials` shows the names), or [material] in a job file",
        );
    }
    let cutter = |job: &Job| {
        let numbered = job.tools.iter().any(|tool| tool.get_ref().cutter.is_some());
        job.tool.cutter.is_some() || numbered || job.cutters.is_some()
    };
    if !args.tool.given() && !of_job(cutter) {
        missing.push(
            "no tool: give --tool flat (ball, bull, face) with --diameter-mm and --teeth, --tool-table FILE.toml, or a cutter in a job file",
        );
    }
    let stated = args.stock.block_mm.is_some() || args.stock.width_mm.is_some();
    if !stated && !of_job(|job| job.stock.is_some() || job.engagement.is_some()) {
        missing.push(NO_STOCK);
    }
    match missing.is_empty() {
        true => Ok(()),
        false => Err(Failure::input(missing.join("; "))),
    }
}

/// Factors belong to a material that is named beside them.
pub(super) fn no_factors(args: &MaterialArgs) -> Answer<()> {
    let given = [
        ("--materials", args.materials.is_some()),
        ("--rake-deg", args.rake_deg.is_some()),
        ("--wear", args.wear.is_some()),
        ("--coolant", args.coolant.is_some()),
        ("--edge", args.edge.is_some()),
        ("--correct-speed", args.correct_speed),
        ("--process-factor", args.process_factor.is_some()),
    ];
    match given.iter().find(|(_, given)| *given) {
        Some((option, _)) => Err(Failure::input(format!(
            "{option} needs --material: the job names the material together with its factors"
        ))),
        None => Ok(()),
    }
}
