//! Compensation off, on, and between G40 and the next move.
//!
//! While it is on, the blocks are run as they are programmed beside the flat program: that run knows the modes and the
//! programmed places; the flat program knows where the tool's centre is. After G40 the two places stay apart until a
//! straight move brings the tool to a programmed place.

use std::collections::BTreeMap;

use crate::expanding::flat::Flat;
use crate::expanding::radius::blocks::{Block, First, Next, behind, within};
use crate::expanding::radius::contour::Contour;
use crate::expanding::radius::cutter::{InSpindle, begin};
use crate::expanding::radius::words::{Switch, Words, asks_behind, words};
use crate::expanding::{Dialect, ExpandOptions, Origin, Trouble, Wrong};
use crate::reading::interpreting::Interpreter;
use crate::reading::options::Units;

/// State of the compensation.
enum State {
    Off,
    /// A tool without a radius: its centre is on the contour.
    Without,
    On {
        contour: Contour,
        /// The tool was beside the programmed place when G41 or G42 came: no move since the last G40.
        begins_beside: bool,
    },
    /// After G40. A change of the tool ends the difference between the two places (LinuxCNC asks the machine where the tool
    /// is), and there is no other run any more; the next move must be straight all the same.
    Beside,
}

/// Stands between the blocks that a program runs and the flat program.
pub(crate) struct Radius<'o> {
    spindle: InSpindle,
    dialect: Dialect,
    /// Diameters of tools, mm, by number: those of the options, and those that the program states.
    diameters_mm: BTreeMap<u32, f64>,
    state: State,
    /// The blocks as programmed, where these are others than the flat ones.
    programmed: Option<Flat<'o>>,
}

impl<'o> Radius<'o> {
    pub fn new(options: &'o ExpandOptions) -> Self {
        Self {
            diameters_mm: options.tool_diameters_mm.clone(),
            spindle: InSpindle::default(),
            dialect: options.dialect,
            state: State::Off,
            programmed: None,
        }
    }

    /// The run that knows the modes and the programmed places.
    pub fn interpreter<'a>(&'a self, flat: &'a Flat<'o>) -> &'a Interpreter<'o> {
        let programmed = self.programmed.as_ref();
        programmed.map_or(&flat.interpreter, |programmed| &programmed.interpreter)
    }

    /// The program states the diameter of a tool.
    pub fn know_diameter(&mut self, tool: u32, diameter_mm: f64) {
        self.diameters_mm.insert(tool, diameter_mm);
    }

    /// Reason for which cycles cannot be run here; `None` if they can.
    pub fn refuses_cycles(&self) -> Option<Wrong> {
        match self.state {
            State::Off => None,
            State::Beside => Some(asks_behind()),
            State::On { .. } | State::Without => Some((
                "a canned cycle cannot be run while cutter radius compensation is on".to_owned(),
                "write G40 and a move before it",
            )),
        }
    }

    /// True if programs may not query the tool position: it is not the programmed one.
    pub fn hides_the_place(&self) -> bool {
        matches!(self.state, State::On { .. } | State::Without)
    }

    /// A block of plain words, behind all blocks so far.
    pub fn block(
        &mut self,
        text: &[u8],
        origin: Origin,
        flat: &mut Flat<'o>,
    ) -> Result<(), Trouble> {
        let words = words(text)?;
        self.spindle.note(&words);
        let is_off = matches!(self.state, State::Off);
        let rest = match words.switch {
            None => text,
            Some(Switch::Off) if is_off => text,
            Some(switch) => {
                let units = self.interpreter(flat).units().map(|units| match units {
                    Units::Inches => 200,
                    Units::Millimetres => 210,
                });
                words.check_beside_switch(units)?;
                self.switch(switch, flat)?;
                words.rest.trim_ascii()
            }
        };
        match rest {
            [] => Ok(()),
            rest => self.run(rest, &words, origin, flat),
        }
    }

    /// The program has ended, or its text has.
    pub fn finish(&self) -> Result<(), Wrong> {
        match &self.state {
            State::On { contour, .. } if contour.pending.is_waiting() => Err((
                "the program ends while cutter radius compensation is on, and its last move may not be made".to_owned(),
                "write G40, and M2 or M30 at its end",
            )),
            _ => Ok(()),
        }
    }

    fn switch(&mut self, switch: Switch, flat: &mut Flat<'o>) -> Result<(), Trouble> {
        if switch == Switch::Off {
            return self.off(flat);
        }
        if matches!(self.state, State::On { .. } | State::Without) {
            return Err(Trouble::Line((
                "cutter radius compensation is on already".to_owned(),
                "write G40 and a move before it is put on again",
            )));
        }
        if let Some(what) = self.interpreter(flat).carried_turn() {
            return Err(Trouble::Line((
                format!(
                    "cutter radius compensation while {what}: in which plane it acts depends on the controller"
                ),
                "let the CAM system write the way of the tool's centre",
            )));
        }
        let begins_beside = matches!(self.state, State::Beside);
        let diameters = &self.diameters_mm;
        let state = self.interpreter(flat);
        let begun = begin(switch, self.spindle, diameters, state, self.dialect)?;
        self.state = match begun {
            Some(contour) => {
                self.programmed.get_or_insert_with(|| flat.following());
                State::On {
                    contour,
                    begins_beside,
                }
            }
            None if begins_beside => return Err(Trouble::Line(asks_behind())),
            None => State::Without,
        };
        Ok(())
    }

    fn off(&mut self, flat: &mut Flat<'o>) -> Result<(), Trouble> {
        self.state = match &mut self.state {
            State::Off | State::Without => State::Off,
            State::Beside => State::Beside,
            State::On {
                contour,
                begins_beside,
            } => {
                contour.settle(flat)?;
                match contour.has_begun() || *begins_beside {
                    true => State::Beside,
                    false => State::Off,
                }
            }
        };
        if let State::Off = self.state {
            self.programmed = None;
        }
        Ok(())
    }

    fn run(
        &mut self,
        text: &[u8],
        words: &Words,
        origin: Origin,
        flat: &mut Flat<'o>,
    ) -> Result<(), Trouble> {
        let block = Block {
            text,
            words,
            origin,
        };
        match (&mut self.state, &mut self.programmed) {
            (
                State::On {
                    contour,
                    begins_beside,
                },
                Some(programmed),
            ) => {
                let first = match *begins_beside && !contour.has_begun() {
                    true => First::Straight,
                    false => First::Any,
                };
                within(block, contour, first, programmed, flat)
            }
            (State::Beside, programmed) => {
                if words.changes_tool() {
                    *programmed = None;
                }
                if let Next::Together = behind(block, programmed.as_mut(), flat)? {
                    self.state = State::Off;
                    self.programmed = None;
                }
                Ok(())
            }
            (State::Without, _) => {
                words.check_within(flat.interpreter.plane_axes())?;
                flat.add(text, origin).map_err(Trouble::from)
            }
            _ => flat.add(text, origin).map_err(Trouble::from),
        }
    }
}
