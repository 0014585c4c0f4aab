//! External axes of a source, which no made program states: where they stand is named.

use crate::making::fault::MakeFinding;
use crate::model::motion::Motion;
use crate::model::program::RobotProgram;

/// Findings on external axes that are not at 0 throughout: first position, and motion.
pub(crate) fn external_axes(program: &RobotProgram) -> Vec<MakeFinding> {
    let all = || program.motions.iter().map(|motion| &motion.site.external);
    let count = all().map(Vec::len).max().unwrap_or_default();
    let mut found = Vec::new();
    for axis in 0..count {
        let at = |values: &Vec<Option<f64>>| values.get(axis).copied().flatten();
        let Some(first) = program
            .motions
            .iter()
            .find(|motion| at(&motion.site.external).is_some_and(|value| value != 0.0))
        else {
            continue;
        };
        let value = at(&first.site.external).unwrap_or_default();
        let mut before = program
            .motions
            .iter()
            .take_while(|motion| motion.line != first.line);
        let is_open =
            |motion: &Motion| motion.target.pose().is_some() && at(&motion.site.external).is_none();
        let moves = all().filter_map(at).any(|other| other != value) || before.any(is_open);
        let name = program.language.name_of_external_axis(axis);
        found.push(MakeFinding::of(
            Some(first.line),
            match moves {
                true => format!("{name} moves along the source: the made program does not state it, and leaves it where it is"),
                false => format!("{name} stands at {value} in the source: the made program does not state it; bring it there before it runs"),
            },
        ));
    }
    found
}
