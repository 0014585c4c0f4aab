//! Spindle rotation from `SPINDL`: `SPINDL/3500,RPM,CLW`, `SPINDL/RPM,3500,CCLW`, `SPINDL/ON`, `SPINDL/OFF`.

use kinetostat_program::{SpeedMode, Spindle, SpindleChange, SpindleRotation};

use crate::apt::lines::{Statement, statements_of};
use crate::apt::numbers::{Argument, arguments_of};
use crate::text::source::SourceFile;

/// Spindle state after a statement `SPINDL`. A number without a unit is in rpm, and the sense is clockwise if none is stated; a surface speed (`SFM`,
/// `SMM`) gives no rpm without the tool's diameter.
pub(crate) fn spindle_of(file: &SourceFile, statement: &Statement, before: Spindle) -> Spindle {
    let mut spindle = before;
    let mut sense = None;
    let mut turns = None;
    let mut is_speed = true;
    for argument in arguments_of(file.bytes(), &statement.arguments) {
        match argument {
            Argument::Number(number) if is_speed => {
                turns = turns.or(Some(number.value));
            }
            Argument::Number(_) => is_speed = true,
            Argument::Word(word) => match file.part(&word).to_ascii_uppercase().as_slice() {
                b"CLW" | b"CLWX" => sense = Some(SpindleRotation::Clockwise),
                b"CCLW" => sense = Some(SpindleRotation::CounterClockwise),
                b"OFF" | b"LOCK" | b"ORIENT" | b"NEUTRL" => sense = Some(SpindleRotation::Stopped),
                b"SFM" | b"SMM" | b"CSS" => turns = Some(f64::NAN),
                // The number behind them is another one.
                b"RANGE" | b"MAXRPM" | b"RADIUS" | b"ZRANGE" => is_speed = false,
                _ => {}
            },
        }
    }
    spindle.mode = SpeedMode::Constant;
    if let Some(rpm) = turns {
        spindle.speed = Some(rpm).filter(|rpm| rpm.is_finite() && *rpm > 0.0);
    }
    spindle.rotation = match (sense, before.rotation) {
        (Some(sense), _) => sense,
        (None, SpindleRotation::Stopped) => SpindleRotation::Clockwise,
        (None, turning) => turning,
    };
    spindle
}

/// Changes of the spindle rotation, in the order of the lines.
pub(crate) fn spindle_changes(file: &SourceFile) -> Vec<SpindleChange> {
    let mut changes: Vec<SpindleChange> = Vec::new();
    let mut spindle = Spindle::default();
    for statement in statements_of(file.bytes()) {
        let is_spindle = file.part(&statement.word).eq_ignore_ascii_case(b"SPINDL");
        if is_spindle && !statement.assigns {
            spindle = spindle_of(file, &statement, spindle);
            changes.push(SpindleChange {
                line: file.line_of(statement.span.start),
                spindle,
            });
        }
    }
    changes
}
