//! Uncertainties of the machine and the load of a run: `[uncertain]`, `--uncertain`.

use std::path::PathBuf;

use clap::Args;
use kinetostat_analysis::tolerance::MOST_DRAWS;
use kinetostat_diagnostic::ErrorCode;

use crate::files::input_files::InputFiles;
use crate::files::origin;
use crate::job::job_file::JobFile;
use crate::job::values::{NotAllowed, chosen};
use crate::options::whole;
use crate::ui::failure::{Answer, Failing};

/// Machines that are drawn by default.
const MACHINES: usize = 1024;

/// Fewer say nothing of nineteen in twenty.
const FEWEST: usize = 64;

/// What is uncertain, as options.
#[derive(Clone, Debug, Default, Args)]
pub(crate) struct UncertainFlags {
    /// What is uncertain about machine and load (TOML; see `kinetostat tolerance --help-all`), or a model that `identify` wrote: the errors before and
    /// after compensation come as a band over many machines
    #[arg(long, value_name = "FILE", help_heading = "Tolerances")]
    pub(crate) uncertain: Option<PathBuf>,
    /// Number of machines drawn for the band, rounded up to a multiple of 16 [default: 1024]
    #[arg(long, value_name = "N", allow_negative_numbers = true, help_heading = "Tolerances", value_parser = whole)]
    pub(crate) machines: Option<usize>,
}

/// Uncertainties as they were read.
pub(crate) struct Uncertainty {
    pub(crate) name: String,
    pub(crate) text: String,
    pub(crate) path: PathBuf,
    pub(crate) read: kinetostat_machining::FileRead,
    pub(crate) machines: usize,
    pub(crate) seed: u64,
}

/// Uncertainties, if the job or an option has them.
pub(crate) fn uncertainty(
    files: &InputFiles,
    job: Option<&JobFile>,
    flags: &UncertainFlags,
) -> Answer<Option<Uncertainty>> {
    let table = job.and_then(|j| Some((j, j.job.uncertain.as_ref()?.get_ref())));
    let in_job = table.map(|(j, table)| j.base().join(table.file.get_ref()));
    let Some(path) = flags.uncertain.clone().or(in_job) else {
        return match flags.machines {
            Some(_) => Err(ErrorCode::Missing.failure("--machines says how many machines are drawn: say with --uncertain FILE (file under [uncertain] in the job) how they scatter",
            )),
            None => Ok(None),
        };
    };
    let machines = chosen(
        job,
        "--machines",
        flags.machines,
        table.and_then(|(_, table)| table.machines.as_ref()),
        |count| match (FEWEST..=MOST_DRAWS).contains(&count) {
            true => Ok(count),
            false => Err(NotAllowed("64 to 1048576 machines can be drawn")),
        },
    )?;
    let text = files.settings("uncertainties", &path)?;
    let bytes = files.bytes("uncertainties", &path)?;
    Ok(Some(Uncertainty {
        name: path.display().to_string(),
        text,
        read: origin::file("uncertainties", &path, &bytes),
        path,
        machines: machines.unwrap_or(MACHINES),
        seed: table.and_then(|(_, table)| table.seed).unwrap_or(0).into(),
    }))
}
