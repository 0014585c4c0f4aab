//! Common steps of `curve` and `equilibria`: from the options to the files.

use kinetostat_analysis::serial_chain::is_serial_chain;
use kinetostat_machining::Warning;
use schemars::JsonSchema;
use serde::Serialize;

use crate::files::answer_files::{AnswerFiles, ClaimedFiles, Shown};
use crate::files::input_files::InputFiles;
use crate::place::arguments::PlaceArgs;
use crate::place::query::{AnswerHead, PlaceQuery, place_query};
use crate::ui::background::{Stage, interruptible};
use crate::ui::failure::Answer;

/// Common interface of the queries of `curve` and `equilibria`.
pub(crate) struct CommandQuery<'a> {
    pub(crate) model: &'a str,
    pub(crate) place: &'a PlaceArgs,
    pub(crate) tool_length_mm: Option<f64>,
    pub(crate) outputs: &'a AnswerFiles,
}

/// The version of what both print as JSON.
const SCHEMA: u32 = 3;

/// The long work: from what the answer begins with to the answer.
pub(crate) type Work<A> = Box<dyn FnOnce(AnswerHead, &Stage) -> Answer<A> + Send + 'static>;

/// Answers a query: reads the model, claims the outputs, works, shows.
pub(crate) fn answer_query<A: Serialize + JsonSchema + Send + 'static>(
    command: &CommandQuery<'_>,
    work_of: impl FnOnce(&PlaceQuery) -> Answer<Work<A>>,
    warnings: impl Fn(&mut A) -> &mut Vec<Warning>,
    show: impl FnOnce(&str, &A) -> Answer<Shown>,
) -> Answer<()> {
    let query = place_query(
        &InputFiles::default(),
        command.model,
        command.place,
        command.tool_length_mm,
        None,
        None,
    )?;
    let work = work_of(&query)?;
    let targets = ClaimedFiles::claim(command.outputs, &query.inputs)?;
    let head = query.head(SCHEMA);
    let mut answer = interruptible(move |stage| work(head, stage))?;
    warnings(&mut answer).extend(query.warnings.iter().cloned());
    if is_serial_chain(&query.mechanism) {
        // The answer for a machine already states this for its range of motion.
        warnings(&mut answer).extend(query.near_singular().map(|n| n.warning()));
    }
    let shown = show(&query.heading(), &answer)?;
    targets.finish(&shown, &answer)?;
    shown.failure.map_or(Ok(()), Err)
}
