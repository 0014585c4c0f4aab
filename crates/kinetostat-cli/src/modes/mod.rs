//! `kinetostat modes`: at which frequencies a machine vibrates at a place, and what moves.
//!
//! It takes a model, a place, a load, what holds the tool and damping, and gives signed frequencies, the motion of the tool,
//! shares of kinetic and elastic energy, and the count of all directions.

mod answer;
pub(crate) mod arguments;
mod doubtful;
mod fields;
mod pairs;
mod shapes;
mod text;

use crate::files::answer_files::{ClaimedFiles, Shown};
use crate::modes::answer::answer;
use crate::modes::arguments::ModesArgs;
use crate::ui::failure::{Answer, Failure};
use crate::vibration::subject;

pub(crate) fn run(args: &ModesArgs) -> Answer<()> {
    if args.modes == 0 {
        return Err(Failure::input("--modes is 0; ask for one at least"));
    }
    let query = subject::query(&args.machine)?;
    let damping = args.damping.law(&query.damping)?;
    let held = subject::held(args.hold.as_deref())?;
    let files = ClaimedFiles::claim(&args.outputs, &query.inputs)?;
    let posture = query.posture()?;
    let machine = subject::machine(&query, &posture, &held)?;
    let answer = answer(args, &query, &posture, &machine, &damping)?;
    let svg = match args.outputs.plot.is_some() {
        true => shapes::drawn(&query, &posture, &machine, (&damping, args.modes))?,
        false => String::new(),
    };
    let shown = Shown {
        text: text::answer_text(&query, &answer),
        csv: text::table(&answer)?,
        svg,
        failure: None,
    };
    files.finish(&shown, &answer)
}
