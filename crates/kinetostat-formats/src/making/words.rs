//! The words of a block that are no motion, what they do before its motion and behind it, and the spindle rotation that they state.

use kinetostat_program::{SpeedMode, Spindle, SpindleChange, SpindleRotation};

use crate::making::events::{Coolant, EventAction, EventKind, SourceEvent};

/// Known effect of a word.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Word {
    Action(EventAction),
    /// Start, stop or speed of the spindle.
    Spindle,
    SpindleStop,
    /// The time for which the tool stands still, or what goes with it.
    Dwell,
    /// Preselection of the next tool, without a change.
    NextTool,
    Other,
}

/// Action of an M function that other languages share.
pub(crate) fn word_of_m(number: u32) -> Word {
    let action = match number {
        0 | 60 => EventAction::Stop,
        1 => EventAction::OptionalStop,
        7 => EventAction::Coolant(Coolant::Mist),
        8 => EventAction::Coolant(Coolant::Flood),
        9 => EventAction::Coolant(Coolant::Off),
        3 | 4 => return Word::Spindle,
        5 => return Word::SpindleStop,
        _ => return Word::Other,
    };
    Word::Action(action)
}

/// Subject of an M function.
pub(crate) fn kind_of_m(number: u32) -> EventKind {
    match number {
        0 | 1 | 60 => EventKind::Stop,
        2 | 30 => EventKind::End,
        3..=5 | 19 => EventKind::Spindle,
        6 => EventKind::Tool,
        7..=9 => EventKind::Coolant,
        _ => EventKind::Other,
    }
}

/// A word that is no motion.
pub(crate) struct Said {
    pub kind: EventKind,
    /// The action that it is by itself.
    pub word: Word,
    pub text: String,
    /// The word acts after the motion of its block.
    pub is_late: bool,
}

impl Said {
    /// One that acts before the motion.
    pub(crate) fn early(kind: EventKind, word: Word, text: impl Into<String>) -> Self {
        Self {
            kind,
            word,
            text: text.into(),
            is_late: false,
        }
    }
}

/// The words of a block that are no motion.
pub(crate) struct Words {
    /// All of them.
    pub text: String,
    /// Words of a subject of their own, in order.
    pub said: Vec<Said>,
    /// The machine's switch says whether it runs.
    pub is_optional: bool,
}

/// Modal state on the line of a block, after its own words.
#[derive(Clone, Copy)]
pub(crate) struct InForce {
    /// Dwell of the block, s, if any.
    pub dwell_s: Option<f64>,
    /// Spindle state; `None` if a switch of the machine or a spindle number leaves it undetermined.
    pub spindle: Option<Spindle>,
}

/// Combined effect of words of a block.
#[derive(Default)]
struct Done {
    actions: Vec<EventAction>,
    rest: Option<EventKind>,
    states_speed: bool,
    is_of_tool: bool,
    /// The words are only comments and the end of the program.
    is_silent: bool,
}

impl Words {
    /// The events of the block: what acts before its motion, and what acts behind it.
    pub(crate) fn events(&self, line: usize, force: InForce) -> Vec<SourceEvent> {
        let Some(kind) = self.said.iter().map(|said| said.kind).min() else {
            return Vec::new();
        };
        let kind = match kind {
            // The machine's switch says whether such a block runs: it is a note.
            EventKind::Stop if self.is_optional => EventKind::Other,
            kind => kind,
        };
        let (late, early): (Vec<&Said>, Vec<&Said>) = self.said.iter().partition(|s| s.is_late);
        let event = |done: Done, is_behind: bool, kind: EventKind, text: String| SourceEvent {
            actions: done.actions,
            rest: done.rest,
            states_speed: done.states_speed,
            is_of_tool: done.is_of_tool,
            is_behind,
            ..SourceEvent::words_alone(line, kind, text)
        };
        let [before, behind] = [&early, &late].map(|said| self.done(said, force));
        if behind.is_silent || before.is_silent {
            let all: Vec<&Said> = early.into_iter().chain(late).collect();
            let is_behind = before.is_silent && all.iter().any(|said| said.is_late);
            return vec![event(
                self.done(&all, force),
                is_behind,
                kind,
                self.text.clone(),
            )];
        }
        let kinds = early.iter().map(|said| said.kind);
        let first = kinds.min().filter(|_| !self.is_optional).unwrap_or(kind);
        let last = late.iter().map(|said| said.kind).min().unwrap_or(kind);
        let texts: Vec<&str> = late.iter().map(|said| said.text.as_str()).collect();
        vec![
            event(before, false, first, self.text.clone()),
            event(behind, true, last, texts.join(" ")),
        ]
    }

    fn done(&self, said: &[&Said], force: InForce) -> Done {
        let mut done = Done {
            is_silent: true,
            ..Done::default()
        };
        for said in said {
            done.is_of_tool |= said.kind == EventKind::Tool && said.word != Word::NextTool;
            done.is_silent &= matches!(said.kind, EventKind::Comment | EventKind::End);
            let action = match (said.word, force.spindle, force.dwell_s) {
                _ if self.is_optional => None,
                (Word::Action(action), ..) => Some(action),
                (Word::Spindle, Some(spindle), _) if spindle.mode == SpeedMode::Constant => {
                    // A speed of a spindle that stands still is that of its start.
                    if spindle.rotation == SpindleRotation::Stopped {
                        done.states_speed = true;
                        continue;
                    }
                    Some(EventAction::Spindle {
                        rotation: spindle.rotation,
                        rpm: spindle.speed,
                    })
                }
                (Word::SpindleStop, spindle, _) => Some(EventAction::Spindle {
                    rotation: SpindleRotation::Stopped,
                    rpm: spindle.and_then(|spindle| spindle.speed),
                }),
                (Word::Dwell, _, Some(seconds)) => Some(EventAction::Wait { seconds }),
                _ => None,
            };
            match (action, said.kind) {
                (Some(action), _) if !done.actions.contains(&action) => done.actions.push(action),
                (Some(_), _) | (None, EventKind::Comment | EventKind::End) => {}
                (None, kind) => {
                    done.rest = Some(done.rest.map_or(kind, |rest: EventKind| rest.min(kind)));
                }
            }
        }
        // The tool stands still, and the spindle with it, before somebody comes.
        (done.actions).sort_by_key(|action| action.kind() == EventKind::Stop);
        done
    }
}

/// Known state of the spindle.
#[derive(Default)]
pub(crate) struct Turning {
    spindle: Spindle,
    /// A switch of the machine, or another master spindle, leaves it open which way it turns.
    is_open: bool,
    changes: Vec<SpindleChange>,
    /// The state was unknown somewhere: then no changes are reported.
    was_open: bool,
}

impl Turning {
    /// Spindle state; `None` if rotation or sense are unknown.
    pub(crate) fn now(&self) -> Option<Spindle> {
        (!self.is_open).then_some(self.spindle)
    }

    /// Takes down how it turns on a line.
    pub(crate) fn note(&mut self, line: usize) {
        let spindle = self.spindle;
        self.was_open |= self.is_open;
        let last = self.changes.last().map(|change| change.spindle);
        if last.unwrap_or_default() != spindle {
            self.changes.push(SpindleChange { line, spindle });
        }
    }

    /// Changes of the rotation, if it is known throughout.
    pub(crate) fn changes(self) -> Vec<SpindleChange> {
        match self.was_open {
            true => Vec::new(),
            false => self.changes,
        }
    }

    pub(crate) fn turn(&mut self, rotation: SpindleRotation) {
        self.spindle.rotation = rotation;
        self.is_open = false;
    }

    /// A speed; none where the program does not say it as a number.
    pub(crate) fn speed(&mut self, speed: Option<f64>) {
        self.spindle.speed = speed;
    }

    /// Sets the mode of the spindle speed; a speed of another mode becomes unknown.
    pub(crate) fn count(&mut self, mode: SpeedMode) {
        if self.spindle.mode != mode {
            self.spindle.mode = mode;
            self.spindle.speed = None;
        }
    }

    pub(crate) fn forget(&mut self) {
        self.spindle.speed = None;
        self.is_open = true;
    }
}
