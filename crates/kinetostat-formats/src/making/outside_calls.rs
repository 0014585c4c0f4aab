//! Calls of a source that none of its files defines: each becomes a note.

use crate::making::fault::MakeFinding;
use crate::model::outside_call::by_name;
use crate::model::program::RobotProgram;

/// Each name once, with its lines.
pub(crate) fn outside_calls(program: &RobotProgram, file: usize) -> Vec<MakeFinding> {
    let all = by_name(&program.outside_calls).into_iter().map(|of| {
        let message = of.message(program.language, Some("it is a note here"));
        let other = program.files.get(of.file).filter(|_| of.file != file);
        match other {
            Some(other) => {
                let place = format!("'{}', line {}", other.name(), of.line());
                MakeFinding::of(None, format!("{place}: {message}"))
            }
            None => MakeFinding::of(of.line(), message),
        }
    });
    all.collect()
}
