//! What a job says of the part for its papers: a number and a revision.

use kinetostat_diagnostic::ErrorCode;
use serde_spanned::Spanned;

use crate::job::arguments::ProgramArgs;
use crate::job::job_file::JobFile;
use crate::ui::failure::{Answer, Failing};

/// Letters of each.
const MOST: usize = 60;

/// Number and revision of the part; options go before the job.
pub(crate) fn part_stated(
    job: Option<&JobFile>,
    flags: &ProgramArgs,
) -> Answer<(Option<String>, Option<String>)> {
    let output = job.map(|job| &job.job.output);
    let stated = |option: &str, flag: &Option<String>, key: Option<&Spanned<String>>| {
        if let Some(text) = flag {
            let words = |why: &str| ErrorCode::Value.failure(format!("{option}: {why}"));
            return line(text).map(Some).map_err(words);
        }
        let read = job.zip(key).map(|(job, key)| {
            let refused = |why: &str| job.error(key, why, "as in \"4711-02\"");
            line(key.get_ref()).map_err(refused)
        });
        read.transpose()
    };
    let number = output.and_then(|output| output.part_number.as_ref());
    let revision = output.and_then(|output| output.revision.as_ref());
    Ok((
        stated("--part-number", &flags.part_number, number)?,
        stated("--revision", &flags.revision, revision)?,
    ))
}

/// A text as it stands on one line of a paper.
fn line(text: &str) -> Result<String, &'static str> {
    let text = text.trim();
    match text.is_empty() || text.chars().count() > MOST || text.chars().any(char::is_control) {
        true => Err("one line of 1 to 60 letters is needed"),
        false => Ok(text.to_owned()),
    }
}
