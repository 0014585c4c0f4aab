//! What `curve` and `equilibria` do alike: from the options to the files.

use std::path::Path;

use kinetostat_analysis::serial_chain::is_serial_chain;
use kinetostat_machining::Warning;
use serde::Serialize;

use crate::end_condition::arguments::CurveOutputs;
use crate::files::input_files::InputFiles;
use crate::files::outputs::{self, Existing, Outputs};
use crate::place::arguments::PlaceArgs;
use crate::place::query::{PlaceAnswer, PlaceQuery, place_query};
use crate::ui::background::{Stage, interruptible};
use crate::ui::failure::{Answer, Failure};
use crate::ui::json;

/// What queries of `curve` and `equilibria` share.
pub(crate) struct CommandQuery<'a> {
    pub(crate) model: &'a str,
    pub(crate) place: &'a PlaceArgs,
    pub(crate) tool_length_mm: Option<f64>,
    pub(crate) outputs: &'a CurveOutputs,
}

/// The long work: from the place and the names of model, source and tool to the answer.
pub(crate) type Work<A> =
    Box<dyn FnOnce(PlaceAnswer, [String; 3], &Stage) -> Answer<A> + Send + 'static>;

/// An answer for a person and as files.
pub(crate) struct Shown {
    pub(crate) text: String,
    pub(crate) csv: Vec<u8>,
    pub(crate) svg: String,
    /// Why the question has no answer, if it has none: said when everything is written.
    pub(crate) failure: Option<Failure>,
}

/// From the query to the files: reads the model, claims what will be written, works, shows.
pub(crate) fn answer_query<A: Serialize + Send + 'static>(
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
    let targets = ClaimedOutputs::claim(command.outputs, &query.inputs)?;
    let place = query.answer();
    let names = [
        query.name.clone(),
        query.source.clone(),
        query.tool_words.clone(),
    ];
    let mut answer = interruptible(move |stage| work(place, names, stage))?;
    warnings(&mut answer).extend(query.warnings.iter().cloned());
    if is_serial_chain(&query.mechanism) {
        // Of a machine the answer says it itself, as far as it is moved.
        warnings(&mut answer).extend(query.near_singular().map(|n| n.warning()));
    }
    let shown = show(&query.heading(), &answer)?;
    targets.finish(&shown, &answer)?;
    shown.failure.map_or(Ok(()), Err)
}

/// Claimed outputs of `curve` and `equilibria`.
struct ClaimedOutputs {
    outputs: Outputs,
    json: Option<usize>,
    csv: Option<usize>,
    plot: Option<usize>,
    to_screen: bool,
}

impl ClaimedOutputs {
    /// Claims every target before the long work begins.
    fn claim(args: &CurveOutputs, inputs: &[std::path::PathBuf]) -> Answer<Self> {
        let existing = Existing::forced(args.force_overwrite);
        let mut outputs = Outputs::new(existing, inputs.to_vec());
        let to_screen = args.json.as_deref() == Some(Path::new("-"));
        let mut claim =
            |what, target: Option<&Path>| target.map(|path| outputs.claim(what, path)).transpose();
        let json = args.json.as_deref().filter(|_| !to_screen);
        Ok(Self {
            json: claim("result", json)?,
            csv: claim("table of points", args.csv.as_deref())?,
            plot: claim("drawing", args.plot.as_deref())?,
            to_screen,
            outputs,
        })
    }

    /// Writes what was requested and says the rest.
    fn finish<T: Serialize>(mut self, shown: &Shown, answer: &T) -> Answer<()> {
        if let Some(index) = self.json {
            self.outputs.fill(index, json::json(answer)?.as_bytes())?;
        }
        if let Some(index) = self.csv {
            self.outputs.fill(index, &shown.csv)?;
        }
        if let Some(index) = self.plot {
            self.outputs.fill(index, shown.svg.as_bytes())?;
        }
        let paths = self.outputs.commit()?;
        let text = format!("{}{}", shown.text, outputs::written(&paths));
        json::print_answer(&text, answer, self.to_screen)
    }
}
