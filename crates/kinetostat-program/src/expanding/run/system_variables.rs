//! Numbers that mean something else on Fanuc's controllers: kept common variables and system variables.
//!
//! Fanuc, Operator's Manual B-63944EN, section 16.2 (system variables): #500 to #999 keep their values when the controller is
//! switched off, #3000 raises an alarm, #3006 stops with a message, #5001 to #5003 are the place at the end of the block before.

use crate::expanding::options::Dialect;
use crate::reading::interpreting::interpreter::Interpreter;

/// `#3006 = 1 (MESSAGE)`: a stop, as M0.
pub(crate) const STOP: u32 = 3006;

/// `#3000 = 1 (MESSAGE)`.
const ALARM: u32 = 3000;

/// Places at the end of the block before, in the work coordinates.
const PLACES: std::ops::RangeInclusive<u32> = 5001..=5003;

/// The value of a number that nobody has given one; none where it is one of a program.
pub(crate) fn not_given(
    number: u32,
    rules: Dialect,
    state: &Interpreter<'_>,
    is_turned: bool,
) -> Option<Result<f64, String>> {
    let is_kept = (500..=999).contains(&number);
    let is_systems = (1000..5161).contains(&number);
    match rules {
        Dialect::LinuxCnc => None,
        _ if !is_kept && !is_systems => None,
        Dialect::Undecided => Some(Err(format!(
            "#{number} has not been given a value: for LinuxCNC it is 0, {}; give it with --parameter {number}=VALUE, or name the dialect (--dialect)",
            match is_kept {
                true => "Fanuc's controllers have kept one from before",
                false => "Fanuc's controllers have a value of their own there (a system variable)",
            }
        ))),
        Dialect::Fanuc if PLACES.contains(&number) && is_turned => Some(Err(format!(
            "#{number} is asked for in scaled, mirrored or turned coordinates, where its value depends on the controller: ask before G51, G51.1 or G68"
        ))),
        Dialect::Fanuc if PLACES.contains(&number) => {
            Some(state.coordinate((number - PLACES.start()) as usize))
        }
        Dialect::Fanuc => Some(Err(format!(
            "{} whose value is not known here: give it with --parameter {number}=VALUE (under [expand] in a job file: parameters)",
            match is_kept {
                true => format!(
                    "#{number} is a common variable that the controller keeps when it is switched off,"
                ),
                false => format!("#{number} is a system variable of the controller,"),
            }
        ))),
    }
}

/// Checks that a program may assign a number; the error has the reason and the remedy.
pub(crate) fn may_be_given(number: u32, rules: Dialect) -> Result<(), (String, &'static str)> {
    match (rules, number) {
        (Dialect::LinuxCnc, _) => Ok(()),
        (Dialect::Undecided, ALARM | STOP) => Err((
            format!(
                "#{number} is a parameter as others for LinuxCNC; Fanuc's controllers {} there",
                match number {
                    ALARM => "end the program with an alarm",
                    _ => "stop the program with a message",
                }
            ),
            "name the dialect (--dialect)",
        )),
        (Dialect::Undecided, _) => Ok(()),
        (Dialect::Fanuc, ALARM) => Err((
            format!("the program comes to an alarm of its own here (#{ALARM})"),
            "look at what it checks before: the values may be those of another machine",
        )),
        (Dialect::Fanuc, STOP) => Err((
            format!("#{STOP} stops the program with a message"),
            "write it in a block of its own, as in #3006=1 (MESSAGE)",
        )),
        (Dialect::Fanuc, 1000..) => Err((
            format!(
                "#{number} is a system variable: what the controller does when it is given a value is not followed"
            ),
            "leave it out, or use #1 to #33 or #100 to #999; offsets are set by G10",
        )),
        (Dialect::Fanuc, _) => Ok(()),
    }
}
