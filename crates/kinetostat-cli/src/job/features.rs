//! Features of the part: `[[features]]` of a job file.

use kinetostat_machining::Feature;

use crate::job::job_file::JobFile;
use crate::job::values::{chosen, micrometres};
use crate::ui::failure::Answer;

/// Upper limit of the features: nobody reads a longer list.
const MOST: usize = 1000;

/// The features of a job; each name once, lines in their order.
pub(crate) fn features(job: Option<&JobFile>) -> Answer<Vec<Feature>> {
    let Some(job) = job else {
        return Ok(Vec::new());
    };
    let mut features: Vec<Feature> = Vec::new();
    for table in &job.job.features {
        let own = table.get_ref();
        let name = own.name.get_ref();
        if features.len() == MOST {
            let most = format!("at most {MOST} features are taken");
            return Err(job.error(
                table,
                &most,
                "keep those that have a tolerance of their own",
            ));
        }
        if name.trim().is_empty() || name.chars().any(char::is_control) {
            let what = "a feature has no name";
            return Err(job.error(&own.name, what, "write a name, as in name = \"pocket\""));
        }
        if features.iter().any(|other| other.name == *name) {
            let what = format!("two features have the name '{name}'");
            return Err(job.error(&own.name, &what, "give one of them another name"));
        }
        let lines = *own.lines.get_ref();
        if lines[0] == 0 || lines[0] > lines[1] {
            let what = format!("lines {} to {}", lines[0], lines[1]);
            let help = "write the first and the last line of the feature in the program, counted from 1, as in lines = [12, 40]";
            return Err(job.error(&own.lines, &what, help));
        }
        let tolerance_mm = chosen(
            Some(job),
            "tolerance_um",
            None,
            own.tolerance_um.as_ref(),
            micrometres,
        )?;
        features.push(Feature {
            name: name.clone(),
            lines,
            tolerance_mm,
        });
    }
    Ok(features)
}
