//! Lines of features beside those of the program.

use crate::job::job_file::JobFile;
use crate::job::setting::Setting;
use crate::ui::failure::Answer;

/// Refuses features of lines that the program does not have: nothing could be said of them, and nobody would miss it.
pub(crate) fn refuse_lines_beyond(job: Option<&JobFile>, setting: &Setting) -> Answer<()> {
    let (Some(job), Some(lines)) = (job, setting.lines_of_file) else {
        return Ok(());
    };
    for table in &job.job.features {
        let own = table.get_ref();
        let [first, last] = *own.lines.get_ref();
        if last <= lines {
            continue;
        }
        let what = format!(
            "the feature '{}' has the lines {first} to {last}, and the program '{}' ends with line {lines}",
            own.name.get_ref(),
            setting.program_name
        );
        let help = "write the first and the last line of the feature in that program, counted from 1, as in lines = [12, 40]";
        return Err(job.error(&own.lines, &what, help));
    }
    Ok(())
}
