//! `kinetostat curve`: force against displacement of a chain or a machine, with everything that
//! happens on the way.

mod answer;
pub(crate) mod arguments;
mod chain;
mod chain_points;
mod critical;
mod csv;
mod machine;
mod plot;
mod query;
mod state;
mod text;

use kinetostat_analysis::serial_chain::is_serial_chain;

use crate::curve::answer::CurveAnswer;
use crate::curve::arguments::CurveArgs;
use crate::curve::query::question;
use crate::end_condition::chain::{moves_of, serial_chain};
use crate::end_condition::command::{Asked, Shown, Work, follow};
use crate::end_condition::loads::with_loads;
use crate::end_condition::machine::Machine;
use crate::place::query::Spot;
use crate::ui::failure::Answer;

pub(crate) fn run(args: &CurveArgs) -> Answer<()> {
    let asked = Asked {
        model: &args.model,
        place: &args.place,
        tool_length_mm: args.tool_length_mm,
        outputs: &args.outputs,
    };
    let about = |spot: &Spot| -> Answer<Work<CurveAnswer>> {
        let length = spot.mechanism.size();
        if is_serial_chain(&spot.mechanism) {
            let chain = with_loads(serial_chain(spot)?, &args.end)?;
            let q = question(&moves_of(&chain), Some(&chain), args)?;
            Ok(Box::new(move |place, names, stage| {
                chain::solve(&chain, &q, place, names, stage).map(|a| a.judged(length))
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
