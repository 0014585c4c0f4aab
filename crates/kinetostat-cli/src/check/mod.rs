//! `kinetostat check`: what a model or a job file says, in words, and what looks wrong.
//!
//! It takes a model, a job, or a model with poses measured on the machine, and gives findings; it solves a model at
//! home only.

pub(crate) mod arguments;
mod job;
mod model;
mod poses;

use std::path::Path;

use crate::check::arguments::CheckArgs;
use crate::check::model::findings::findings;
use crate::check::model::text::answer_text;
use crate::files::file_kind::FileKind;
use crate::files::input_files::InputFiles;
use crate::options::vector;
use crate::ui::failure::{Answer, Failure};
use crate::ui::json;

pub(crate) fn run(args: &CheckArgs) -> Answer<()> {
    let file = Path::new(&args.model);
    if FileKind::of_file(file) == Some(FileKind::Job) {
        if args.pose.is_some() || args.force.is_some() {
            return Err(Failure::input(
                "--pose and --force check a model, and this is a job file: name its model instead",
            ));
        }
        return job::run(file, args.json);
    }
    let (model, path) = InputFiles::default().model(&args.model, Path::new(""))?;
    let source = match path {
        Some(_) => args.model.clone(),
        None => format!("preset {}", args.model),
    };
    if let Some(file) = &args.pose {
        return poses::run(&model, &source, file, args.pose_tolerance_mm, args.json);
    }
    let force = args.force.as_deref().map(|f| vector("--force", f));
    let force = force.transpose()?;
    let findings = findings(&model, source, force);
    let text = answer_text(&findings, &model, force.is_some());
    json::print_answer(&text, &findings, args.json)
}
