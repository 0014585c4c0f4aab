//! `kinetostat assemble`: what assembly with errors locks in.

use crate::along;
use crate::assemble_along;
use crate::assemble_answer::answer;
use crate::assemble_args::AssembleArgs;
use crate::assemble_question::question;
use crate::assemble_table;
use crate::failure::Answer;
use crate::output::{Existing, Outputs};
use crate::screen::{self, Stream};

pub(crate) fn run(args: &AssembleArgs) -> Answer<()> {
    let question = question(args)?;
    let existing = match args.force_overwrite {
        true => Existing::Replace,
        false => Existing::Refuse,
    };
    let mut outputs = Outputs::new(existing, question.spot.inputs.clone());
    let csv = args.csv.as_ref().map(|p| outputs.claim("table", p));
    let csv = csv.transpose()?;
    let plot = args.plot.as_ref().map(|p| outputs.claim("plot", p));
    let plot = plot.transpose()?;
    let (text, json, table) = match &args.along {
        Some(line) => {
            let a = assemble_along::answer(&question, line, args)?;
            if let Some(index) = plot {
                let drawn = assemble_along::plot(&a, args.component).svg();
                outputs.fill(index, drawn.as_bytes())?;
            }
            (
                assemble_along::in_words(&question, &a),
                along::json(&a)?,
                assemble_along::csv(&a)?,
            )
        }
        None => {
            let a = answer(&question)?;
            (
                assemble_table::in_words(&question, &a, args.all),
                along::json(&a)?,
                assemble_table::csv(&a)?,
            )
        }
    };
    if let Some(index) = csv {
        outputs.fill(index, &table)?;
    }
    let paths = outputs.commit()?;
    let text = format!("{text}{}", along::written(&paths));
    if args.json {
        screen::print(Stream::Err, &text)?;
        return screen::print_bytes(json.as_bytes());
    }
    screen::print(Stream::Out, &text)
}
