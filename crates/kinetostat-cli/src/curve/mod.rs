//! `kinetostat curve`: force against displacement of a chain or a machine, with everything that
//! happens on the way; and what `curve` and `equilibria` do alike.

mod answer;
pub(crate) mod arguments;
pub(crate) mod csv;
pub(crate) mod machine;
mod plot;
pub(crate) mod query;
mod rotation;
mod text;

use std::path::Path;

use kinetostat_machining::Warning;
use serde::Serialize;

use crate::command_line::PlaceArgs;
use crate::curve::answer::CurveAnswer;
use crate::curve::arguments::{CurveArgs, CurveOutputs};
use crate::curve::machine::Machine;
use crate::curve::query::{question, with_loads};
use crate::deflect::PlaceAsked;
use crate::end_condition::chain::{is_chain, serial_chain};
use crate::files::input::Files;
use crate::files::output::{Existing, Outputs};
use crate::place::query::{Spot, spot};
use crate::program::solve;
use crate::ui::background::{Stage, interruptible};
use crate::ui::failure::Answer;
use crate::ui::screen::{self, Stream};

pub(crate) fn run(args: &CurveArgs) -> Answer<()> {
    let asked = Asked {
        model: &args.model,
        place: &args.place,
        tool_length_mm: args.tool_length_mm,
        outputs: &args.outputs,
    };
    let about = |spot: &Spot| -> Answer<Work<CurveAnswer>> {
        let length = spot.mechanism.size();
        if is_chain(spot) {
            let chain = with_loads(serial_chain(spot)?, &args.end)?;
            let q = question(&chain.moves(), Some(&chain), args)?;
            Ok(Box::new(move |place, names, stage| {
                answer::solve(&chain, &q, place, names, stage).map(|a| a.judged(length))
            }))
        } else {
            machine::refuse(args)?;
            let machine = Machine::of(spot)?;
            let q = question(&machine.moves, None, args)?;
            Ok(Box::new(move |place, names, stage| {
                machine::solve(&machine, &q, place, names, stage).map(|a| a.judged(length))
            }))
        }
    };
    follow(
        &asked,
        about,
        |answer| &mut answer.warnings,
        |heading, answer| {
            Ok(Shown {
                text: text::in_words(heading, answer),
                csv: csv::of_curve(answer)?,
                svg: plot::plot(answer).svg(),
            })
        },
    )
}

/// What `curve` and `equilibria` are asked alike.
pub(crate) struct Asked<'a> {
    pub(crate) model: &'a str,
    pub(crate) place: &'a PlaceArgs,
    pub(crate) tool_length_mm: Option<f64>,
    pub(crate) outputs: &'a CurveOutputs,
}

/// The long work: from the place and the names of model, source and tool to the answer.
pub(crate) type Work<A> =
    Box<dyn FnOnce(PlaceAsked, [String; 3], &Stage) -> Answer<A> + Send + 'static>;

/// An answer for a person and as files.
pub(crate) struct Shown {
    pub(crate) text: String,
    pub(crate) csv: Vec<u8>,
    pub(crate) svg: String,
}

/// From the question to the files: reads the model, claims what will be written, works, shows.
pub(crate) fn follow<A: Serialize + Send + 'static>(
    asked: &Asked<'_>,
    question: impl FnOnce(&Spot) -> Answer<Work<A>>,
    warnings: impl Fn(&mut A) -> &mut Vec<Warning>,
    show: impl FnOnce(&str, &A) -> Answer<Shown>,
) -> Answer<()> {
    let spot = spot(
        &Files::default(),
        asked.model,
        asked.place,
        asked.tool_length_mm,
        None,
        None,
    )?;
    let work = question(&spot)?;
    let targets = Targets::claim(asked.outputs, &spot.inputs)?;
    let place = spot.asked();
    let names = [
        spot.name.clone(),
        spot.source.clone(),
        spot.tool_words.clone(),
    ];
    let mut answer = interruptible(move |stage| work(place, names, stage))?;
    warnings(&mut answer).extend(spot.warnings.iter().cloned());
    if is_chain(&spot) {
        // Of a machine the answer says it itself, as far as it is moved.
        warnings(&mut answer).extend(spot.near_singular().map(|n| n.warning()));
    }
    let shown = show(&spot.heading(), &answer)?;
    targets.finish(&shown, &answer)
}

/// Claimed outputs of `curve` and `equilibria`.
struct Targets {
    outputs: Outputs,
    json: Option<usize>,
    csv: Option<usize>,
    plot: Option<usize>,
    to_screen: bool,
}

impl Targets {
    /// Claims every target before the long work begins.
    fn claim(args: &CurveOutputs, inputs: &[std::path::PathBuf]) -> Answer<Self> {
        let existing = if args.force_overwrite {
            Existing::Replace
        } else {
            Existing::Refuse
        };
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

    /// Writes what was asked for and says the rest.
    fn finish<T: Serialize>(mut self, shown: &Shown, answer: &T) -> Answer<()> {
        if let Some(index) = self.json {
            self.outputs.fill(index, solve::json(answer)?.as_bytes())?;
        }
        if let Some(index) = self.csv {
            self.outputs.fill(index, &shown.csv)?;
        }
        if let Some(index) = self.plot {
            self.outputs.fill(index, shown.svg.as_bytes())?;
        }
        let paths = self.outputs.commit()?;
        let text = format!("{}{}", shown.text, solve::written(&paths));
        if self.to_screen {
            screen::print(Stream::Err, &text)?;
            return screen::print_bytes(solve::json(answer)?.as_bytes());
        }
        screen::print(Stream::Out, &text)
    }
}
