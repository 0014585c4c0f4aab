//! `kinetostat equilibria`: all shapes that a chain or a machine can take.
//!
//! It takes a model, a place, and what holds the tool or acts on it, and gives every equilibrium with its energy,
//! stability and forces, and how complete the list is.

mod answer;
mod answer_of;
pub(crate) mod arguments;
mod csv;
mod found;
mod plot;
mod query;
mod text;

use kinetostat_analysis::serial_chain::is_serial_chain;

use crate::end_condition::answering::{CommandQuery, Work, answer_query};
use crate::end_condition::chain::{moves_of, serial_chain};
use crate::end_condition::loads::with_loads;
use crate::end_condition::machine::CommandedMachine;
use crate::equilibria::answer::EquilibriaAnswer;
use crate::equilibria::answer_of::answer_of;
use crate::equilibria::arguments::EquilibriaArgs;
use crate::equilibria::query::equilibria_query;
use crate::files::answer_files::Shown;
use crate::place::query::PlaceQuery;
use crate::ui::failure::Answer;

pub(crate) fn run(args: &EquilibriaArgs) -> Answer<()> {
    let command = CommandQuery {
        model: &args.model,
        place: &args.place,
        tool_length_mm: args.tool_length_mm,
        outputs: &args.outputs,
    };
    let work_of = |query: &PlaceQuery| -> Answer<Work<EquilibriaAnswer>> {
        let size = query.mechanism.size();
        if is_serial_chain(&query.mechanism) {
            let chain = with_loads(serial_chain(query)?, &args.end)?;
            let q = equilibria_query(&moves_of(&chain), args)?;
            Ok(Box::new(move |head, stage| {
                let all = found::of_chain(&chain, &q, stage)?;
                Ok(answer_of(&chain, &q, all, head).with_plausibility_warnings(size))
            }))
        } else {
            let machine = CommandedMachine::of(query, &args.end)?;
            let q = equilibria_query(&machine.moves, args)?;
            Ok(Box::new(move |head, stage| {
                let all = found::of_machine(&machine, &q, stage)?;
                Ok(answer_of(&machine, &q, all, head).with_plausibility_warnings(size))
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
                csv: csv::of_equilibria(answer)?,
                svg: plot::plot(answer).shape_svg(),
                failure: answer.unanswered(),
            })
        },
    )
}
