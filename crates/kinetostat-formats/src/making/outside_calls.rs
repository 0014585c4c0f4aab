//! What a source calls and none of its files holds: it is a note, and may move the tool.

use std::collections::BTreeMap;

use crate::making::fault::MakeFinding;
use crate::model::outside_call::by_name;
use crate::model::program::RobotProgram;

/// Each name once, with its lines.
pub(crate) fn outside_calls(program: &RobotProgram, file: usize) -> Vec<MakeFinding> {
    let all = by_name(&program.outside_calls).into_iter().map(|of| {
        let message = of.message(program.language, "it is a note here");
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

/// By line of motions, the call behind which their speed is not known.
pub(crate) fn lost_speeds(program: &RobotProgram, file: usize) -> BTreeMap<usize, String> {
    let calls = program
        .outside_calls
        .iter()
        .filter(|call| call.file == file);
    let by_line = calls.flat_map(|call| {
        let name = call.name.as_deref().unwrap_or("what is called");
        let shown = format!("`{name}`, which line {} calls,", call.line);
        call.speeds_behind
            .iter()
            .map(move |line| (*line, shown.clone()))
    });
    by_line.collect()
}
