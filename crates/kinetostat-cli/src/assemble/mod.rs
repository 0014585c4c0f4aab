//! `kinetostat assemble`: what assembly with errors locks in.
//!
//! It takes a model with deviations, a place and perhaps a load, and gives the shift of the tool, the forces inside
//! and the over-constraint, at one place or along a line.

mod along_line;
mod answer;
pub(crate) mod arguments;
mod query;
mod table;
mod text;

use crate::assemble::answer::answer;
use crate::assemble::arguments::AssembleArgs;
use crate::assemble::query::assembly_query;
use crate::files::outputs::{self, Existing, Outputs};
use crate::ui::failure::Answer;
use crate::ui::json;
use crate::ui::result_form::ResultForm;
use crate::ui::screen::{self, Stream};

/// Results that the command gives as JSON.
pub(crate) const RESULTS: &[ResultForm] = &[
    ResultForm::of::<answer::Assembly>("an assembly at one place"),
    ResultForm::of::<along_line::AlongLine>("an assembly along a line"),
];

pub(crate) fn run(args: &AssembleArgs) -> Answer<()> {
    let assembly = assembly_query(args)?;
    let existing = Existing::forced(args.force_overwrite);
    let mut outputs = Outputs::new(existing, assembly.query.inputs.clone());
    let csv = args.csv.as_ref().map(|p| outputs.claim("table", p));
    let csv = csv.transpose()?;
    let plot = args.plot.as_ref().map(|p| outputs.claim("plot", p));
    let plot = plot.transpose()?;
    let (text, json, table) = match &args.along {
        Some(line) => {
            let a = along_line::answer(&assembly, line, args)?;
            if let Some(index) = plot {
                let drawn = along_line::plot(&a, args.component).svg();
                outputs.fill(index, drawn.as_bytes())?;
            }
            (
                along_line::answer_text(&assembly, &a),
                json::json(&a)?,
                along_line::csv(&a)?,
            )
        }
        None => {
            let a = answer(&assembly)?;
            (
                text::answer_text(&assembly, &a, args.all),
                json::json(&a)?,
                table::csv(&a)?,
            )
        }
    };
    if let Some(index) = csv {
        outputs.fill(index, &table)?;
    }
    let paths = outputs.commit()?;
    let text = format!("{text}{}", outputs::written(&paths));
    if args.json {
        screen::print(Stream::Err, &text)?;
        return screen::print_bytes(json.as_bytes());
    }
    screen::print(Stream::Out, &text)
}
