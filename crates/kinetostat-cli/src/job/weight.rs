//! Share of the displacement by the machine's own weight that counts as an error, from a job file and options.

use kinetostat_machining::{TouchOff, WeightCorrection};

use crate::job::arguments::ProgramArgs;
use crate::job::format::WeightWord;
use crate::job::job_file::JobFile;
use crate::ui::failure::{Answer, Failure};

/// Reads it; not stated where neither job nor options say anything.
pub(crate) fn weight(job: Option<&JobFile>, flags: &ProgramArgs) -> Answer<WeightCorrection> {
    if let Some(j) = job {
        of_tools(j)?;
    }
    let table = job.map(|j| &j.job.load);
    let in_job = table.and_then(|table| table.weight.as_ref());
    let places_in_job = table.and_then(|table| table.touch_off_mm.as_ref());
    let word = flags.weight.or(in_job.map(|word| *word.get_ref()));
    let help = "give one place, or three and more that are not on one line: touch_off_mm = [[X, Y, Z]] under [load], or --touch-off X Y Z";
    let touch_off = |places: Vec<[f64; 3]>| {
        TouchOff::at(places).map_err(|error| match (job, places_in_job, &flags.touch_off) {
            (Some(j), Some(at), None) => j.error(at, &error.to_string(), help),
            _ => Failure::input(format!("{error}; {help}")),
        })
    };
    let places = match (&flags.touch_off, places_in_job) {
        (Some(all), _) => {
            let all = all.chunks_exact(3);
            Some(all.map(|p| [p[0], p[1], p[2]]).collect())
        }
        (None, places) => places.map(|places| places.get_ref().clone()),
    };
    // A word on the command line goes over the places of the job.
    let goes_over = flags.weight.is_some() && flags.touch_off.is_none();
    match word {
        Some(WeightWord::TouchOff) => {
            let touched = touch_off(places.unwrap_or_default())?;
            Ok(WeightCorrection::TouchOff(touched))
        }
        _ if places.is_some() && !goes_over => Err(Failure::input(
            "places where the part was touched off are given (touch_off_mm under [load], --touch-off), and weight is not \"touch-off\"; write weight = \"touch-off\" under [load] or --weight touch-off, or leave the places out",
        )),
        Some(WeightWord::All) => Ok(WeightCorrection::All),
        Some(WeightWord::None) => Ok(WeightCorrection::None),
        None => Ok(WeightCorrection::NotStated),
    }
}

/// The frame is that of the whole program.
fn of_tools(j: &JobFile) -> Answer<()> {
    let tools = j
        .job
        .tools
        .iter()
        .filter_map(|tool| tool.get_ref().load.as_ref());
    for table in tools {
        if let Some(at) = &table.weight {
            return Err(j.error(
                at,
                "the weight is stated for one tool, and the part frame is measured once for all",
                "write it under [load] at the top of the job",
            ));
        }
    }
    Ok(())
}
