//! Values of parameters: those of the open subprogram, those of all, what the machine's state says, and Fanuc's system variables.

use std::collections::BTreeMap;

use crate::expanding::Dialect;
use crate::expanding::expression::Parameter;
use crate::expanding::expression::evaluate::Parameters;
use crate::expanding::run::frame::Frame;
use crate::reading::interpreting::Interpreter;

/// Numbers below this are parameters (LinuxCNC, `RS274NGC_MAX_PARAMETERS`).
const NUMBERS: u32 = 5602;

/// Reason for which the tool position cannot be queried.
const HIDDEN: &str = "where the tool is cannot be asked for while cutter radius compensation is on";

/// Values that all subprograms see.
#[derive(Debug, Default)]
pub(crate) struct Shared {
    pub numbered: BTreeMap<u32, f64>,
    pub named: BTreeMap<String, f64>,
}

/// Values as an open subprogram sees them.
pub(crate) struct Seen<'r, 'o> {
    pub shared: &'r Shared,
    pub frame: &'r Frame,
    pub state: &'r Interpreter<'o>,
    /// True if the tool position differs from the programmed one.
    pub place_is_hidden: bool,
    /// True if coordinates are scaled, mirrored or rotated.
    pub is_turned: bool,
    /// Open subprograms.
    pub depth: usize,
}

impl Parameters for Seen<'_, '_> {
    fn numbered(&self, number: u32) -> Result<f64, String> {
        match number {
            0 if self.rules() == Dialect::Fanuc => Ok(0.0),
            0 => Err("#0 is no parameter; Fanuc's controllers have it for one without a value (--dialect fanuc)".to_owned()),
            5001..=5003 | 5420..=5428 if self.place_is_hidden => Err(HIDDEN.to_owned()),
            n if self.frame.numbered.has(n) => Ok(self.frame.numbered.value(n)),
            n if n < NUMBERS => match self.state.numbered_state(n) {
                // The user may know a value that the state does not.
                Some(of_state) => of_state.or_else(|reason| {
                    let given = self.shared.numbered.get(&n);
                    given.copied().ok_or(reason)
                }),
                // Default value of a controller that was given none.
                None => match self.shared.numbered.get(&n) {
                    Some(given) => Ok(*given),
                    None => {
                        let own = not_given(n, self.rules(), self.state, self.is_turned);
                        own.unwrap_or(Ok(0.0))
                    }
                },
            },
            _ => Err(format!(
                "#{number} is no parameter; they end with #{}",
                NUMBERS - 1
            )),
        }
    }

    fn named(&self, name: &str) -> Result<Option<f64>, String> {
        if !name.starts_with('_') {
            return Ok(self.frame.named.get(name).copied());
        }
        if let Some(value) = self.shared.named.get(name) {
            return Ok(Some(*value));
        }
        match name {
            "_x" | "_y" | "_z" if self.place_is_hidden => Err(HIDDEN.to_owned()),
            "_call_level" => Ok(Some(self.depth as f64)),
            _ => self.state.named_state(name),
        }
    }

    fn is_vacant(&self, number: u32) -> bool {
        let own = &self.frame.numbered;
        match own.has(number) {
            true => own.is_vacant(number),
            false => {
                number < NUMBERS
                    && self.state.numbered_state(number).is_none()
                    && !self.shared.numbered.contains_key(&number)
                    && not_given(number, self.rules(), self.state, self.is_turned).is_none()
            }
        }
    }

    fn rules(&self) -> Dialect {
        self.frame.numbered.rules
    }

    fn has_number(&self, number: u32) -> bool {
        (1..NUMBERS).contains(&number)
    }
}

/// Gives a parameter a value.
pub(crate) fn assign(
    parameter: &Parameter,
    number: Option<u32>,
    value: f64,
    frame: &mut Frame,
    shared: &mut Shared,
) -> Result<(), (String, &'static str)> {
    match (parameter, number) {
        (Parameter::Name(name), _) if name.starts_with('_') => {
            shared.named.insert(name.clone(), value);
        }
        (Parameter::Name(name), _) => {
            frame.named.insert(name.clone(), value);
        }
        (Parameter::Number(_), Some(n)) if frame.numbered.has(n) => {
            frame.numbered.set(n, value);
        }
        (Parameter::Number(_), Some(n)) if (1..NUMBERS).contains(&n) => {
            if matches!(n, 5161..=5390 | 5400..=5428) {
                return Err((
                    format!(
                        "#{n} is kept by the controller: offsets, tools or the place of the tool"
                    ),
                    "use another parameter, or G10 and work offsets",
                ));
            }
            may_be_given(n, frame.numbered.rules)?;
            shared.numbered.insert(n, value);
        }
        (Parameter::Number(_), _) => {
            return Err((
                "a parameter that there is not".to_owned(),
                "use #1 to #33 or #100 to #999",
            ));
        }
    }
    Ok(())
}

/// `#3006 = 1 (MESSAGE)`: a stop, as M0.
pub(crate) const STOP: u32 = 3006;

/// `#3000 = 1 (MESSAGE)`.
const ALARM: u32 = 3000;

/// Places at the end of the block before, in the work coordinates.
const PLACES: std::ops::RangeInclusive<u32> = 5001..=5003;

/// The value of a number that nobody has given one; none where it is one of a program.
///
/// Fanuc, Operator's Manual B-63944EN, section 16.2 (system variables): #500 to #999 keep their values when the controller is
/// switched off, #3000 raises an alarm, #3006 stops with a message, #5001 to #5003 are the place at the end of the block before.
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
