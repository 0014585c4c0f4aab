//! `kinetostat curve`: force against displacement of a chain or a machine, with everything that
//! happens on the way.
//!
//! It takes a model, a place, and what grows, and gives branches with limit points, bifurcations, jumps and
//! critical loads, as text, table and drawing.

mod answer;
mod answer_of;
pub(crate) mod arguments;
mod chain;
mod critical;
mod csv;
mod figures;
mod followed;
mod machine;
mod plot;
mod point;
mod points;
mod query;
mod stability_text;
mod text;

use kinetostat_analysis::serial_chain::is_serial_chain;

use crate::curve::answer::CurveAnswer;
use crate::curve::answer_of::answer_of;
use crate::curve::arguments::CurveArgs;
use crate::curve::query::curve_query;
use crate::end_condition::answering::{CommandQuery, Work, answer_query};
use crate::end_condition::chain::{moves_of, serial_chain};
use crate::end_condition::loads::with_loads;
use crate::end_condition::machine::CommandedMachine;
use crate::files::answer_files::Shown;
use crate::place::query::PlaceQuery;
use crate::ui::failure::Answer;

pub(crate) fn run(args: &CurveArgs) -> Answer<()> {
    let command = CommandQuery {
        model: &args.model,
        place: &args.place,
        tool_length_mm: args.tool_length_mm,
        outputs: &args.outputs,
    };
    let work_of = |query: &PlaceQuery| -> Answer<Work<CurveAnswer>> {
        let size = query.mechanism.size();
        if is_serial_chain(&query.mechanism) {
            let chain = with_loads(serial_chain(query)?, &args.end)?;
            let q = curve_query(&moves_of(&chain), Some(&chain), args)?;
            Ok(Box::new(move |head, stage| {
                let followed = chain::follow(&chain, &q, stage)?;
                Ok(answer_of(&chain, &q, followed, head).with_plausibility_warnings(size))
            }))
        } else {
            let machine = CommandedMachine::of(query, &args.end)?;
            let q = curve_query(&machine.moves, None, args)?;
            Ok(Box::new(move |head, stage| {
                let followed = machine::follow(&machine, &q, stage)?;
                Ok(answer_of(&machine, &q, followed, head).with_plausibility_warnings(size))
            }))
        }
    };
    answer_query(
        &command,
        work_of,
        |answer| &mut answer.warnings,
        |heading, answer| {
            Ok(Shown {
                text: text::answer_text(heading, answer),
                csv: csv::of_curve(answer)?,
                svg: plot::plot(answer).svg(),
                failure: answer.unanswered(),
            })
        },
    )
}
