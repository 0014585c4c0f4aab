//! `kinetostat curve`: force against displacement of a chain or a machine, with everything that
//! happens on the way.
//!
//! It takes a model, a place, and what grows, and gives branches with limit points, bifurcations, jumps and
//! critical loads, as text, table and drawing.

mod answer;
pub(crate) mod arguments;
mod chain;
mod chain_points;
mod critical;
mod csv;
mod figures;
mod machine;
mod plot;
mod query;
mod state;
mod text;
mod verdict;

use kinetostat_analysis::serial_chain::is_serial_chain;

use crate::curve::answer::CurveAnswer;
use crate::curve::arguments::CurveArgs;
use crate::curve::query::curve_query;
use crate::end_condition::answering::{CommandQuery, Shown, Work, answer_query};
use crate::end_condition::chain::{moves_of, serial_chain};
use crate::end_condition::loads::with_loads;
use crate::end_condition::machine::CommandedMachine;
use crate::place::query::PlaceQuery;
use crate::ui::failure::Answer;

pub(crate) fn run(args: &CurveArgs) -> Answer<()> {
    let command = CommandQuery {
        model: &args.model,
        place: &args.place,
        tool_length_mm: args.tool_length_mm,
        outputs: &args.outputs,
    };
    let about = |query: &PlaceQuery| -> Answer<Work<CurveAnswer>> {
        let length = query.mechanism.size();
        if is_serial_chain(&query.mechanism) {
            let chain = with_loads(serial_chain(query)?, &args.end)?;
            let q = curve_query(&moves_of(&chain), Some(&chain), args)?;
            Ok(Box::new(move |place, names, stage| {
                chain::solve(&chain, &q, place, names, stage)
                    .map(|a| a.with_stretch_warning(length))
            }))
        } else {
            machine::refuse(args)?;
            let machine = CommandedMachine::of(query)?;
            let q = curve_query(&machine.moves, None, args)?;
            Ok(Box::new(move |place, names, stage| {
                machine::solve(&machine, &q, place, names, stage)
                    .map(|a| a.with_stretch_warning(length))
            }))
        }
    };
    answer_query(
        &command,
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
