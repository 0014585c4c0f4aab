//! `kinetostat curve`: force against displacement of a serial chain, with everything that happens
//! on the way.

use std::path::Path;

use serde::Serialize;

use crate::along;
use crate::curve_answer::{self, CurveAnswer};
use crate::curve_args::{CurveArgs, CurveOutputs};
use crate::curve_chain::serial_chain;
use crate::curve_csv;
use crate::curve_plot;
use crate::curve_question::question;
use crate::curve_table;
use crate::curve_work::interruptible;
use crate::failure::Answer;
use crate::input::Files;
use crate::output::{Existing, Outputs};
use crate::place::spot;
use crate::screen::{self, Stream};

pub(crate) fn run(args: &CurveArgs) -> Answer<()> {
    let spot = spot(
        &Files::default(),
        &args.model,
        &args.place,
        args.tool_length_mm,
        None,
        None,
    )?;
    let q = question(serial_chain(&spot)?, args)?;
    let targets = Targets::claim(&args.outputs, &spot.inputs)?;
    let place = spot.asked();
    let names = [
        spot.name.clone(),
        spot.source.clone(),
        spot.tool_words.clone(),
    ];
    let mut answer: CurveAnswer =
        interruptible(move |stage| curve_answer::solve(&q, place, names, stage))?;
    answer.warnings.extend(spot.warnings.iter().cloned());
    let near = spot.near_singular();
    answer.warnings.extend(near.map(|n| n.in_words));
    let text = curve_table::in_words(&spot.heading(), &answer);
    targets.finish(
        &text,
        &answer,
        || curve_csv::of_curve(&answer),
        || curve_plot::plot(&answer).svg(),
    )
}

/// Claimed outputs of `curve` and `equilibria`.
pub(crate) struct Targets {
    outputs: Outputs,
    json: Option<usize>,
    csv: Option<usize>,
    plot: Option<usize>,
    to_screen: bool,
}

impl Targets {
    /// Claims every target before the long work begins.
    pub(crate) fn claim(args: &CurveOutputs, inputs: &[std::path::PathBuf]) -> Answer<Self> {
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
    pub(crate) fn finish<T: Serialize>(
        mut self,
        text: &str,
        answer: &T,
        csv: impl FnOnce() -> Answer<Vec<u8>>,
        svg: impl FnOnce() -> String,
    ) -> Answer<()> {
        if let Some(index) = self.json {
            self.outputs.fill(index, along::json(answer)?.as_bytes())?;
        }
        if let Some(index) = self.csv {
            self.outputs.fill(index, &csv()?)?;
        }
        if let Some(index) = self.plot {
            self.outputs.fill(index, svg().as_bytes())?;
        }
        let paths = self.outputs.commit()?;
        let text = format!("{text}{}", along::written(&paths));
        if self.to_screen {
            screen::print(Stream::Err, &text)?;
            return screen::print_bytes(along::json(answer)?.as_bytes());
        }
        screen::print(Stream::Out, &text)
    }
}
