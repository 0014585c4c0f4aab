//! The order in which motions run: routines followed from `main`, branches and loops noted.
//!
//! Where a motion begins is known if it is the same at every run. Each routine is walked once; what depends on where it is
//! called from stays open until all its calls are known.

use std::ops::Range;

use crate::calls::{Call, Holds, Summary, of_calls};
use crate::error::{ProgramError, note};
use crate::model::motion::{Motion, Runs};
use crate::model::outside_call::OutsideCall;
use crate::options::ReadOptions;
use crate::rapid::frames::Values;
use crate::rapid::labels::destination;
use crate::rapid::place::Place;
use crate::rapid::table::motion_row;
use crate::rapid::targets::Targets;
use crate::rapid::tree::{Choice, RoutineKind, Statement};
use crate::rapid::turning::Modes;
use crate::rapid::walker::{Now, Walker, stays};
use crate::text::finding::Finding;
use crate::text::name::Name;

/// Deepest nesting of calls and blocks together.
const DEEPEST: usize = 200;

/// What the walk gives: motions in their order.
pub(crate) struct Walked {
    pub motions: Vec<Motion>,
    pub findings: Vec<Finding>,
    pub outside_calls: Vec<OutsideCall>,
}

/// Walks `main` and what it calls, then all that nothing calls.
pub(crate) fn walk(
    values: &mut Values<'_>,
    targets: &mut Targets,
    options: &ReadOptions,
    faults: &mut Vec<ProgramError>,
) -> Walked {
    let count = values.symbols.routines.len();
    let main = values.symbols.main();
    let homes = values.symbols.routines.iter().enumerate();
    let moving_functions = homes
        .map(|(index, home)| {
            home.routine.kind == RoutineKind::Function && !stays(values, index, &home.routine.body)
        })
        .collect();
    let anywhere = Modes::anywhere(values.files, &values.symbols);
    let mut walker = Walker {
        values,
        targets,
        unknown: options.unknown_targets,
        external: options.external_axes,
        faults,
        motions: Vec::new(),
        places: Vec::new(),
        moves_external_at_entry: false,
        has_ended: false,
        findings: Vec::new(),
        outside_calls: Vec::new(),
        moving_functions,
        summaries: vec![Summary::default(); count],
        finished: Vec::new(),
        jumps: Vec::new(),
        now: Now {
            routine: 0,
            runs: Runs::Once,
            left: None,
            depth: 0,
            modes: Modes::BASIC,
        },
        modes_at_entry: vec![(Modes::BASIC, 0); count],
        modes_behind: vec![Modes::NOTHING; count],
        modes: Vec::new(),
        anywhere,
        modes_stated: 0,
        states_modes: vec![true; count],
        moment: 0,
        active: Vec::new(),
        called_again: 0,
    };
    walker.speeds_begin();
    for routine in main.into_iter().chain(0..count) {
        if !walker.summaries[routine].begun {
            walker.root(routine, Some(routine) == main);
        }
    }
    walker.resolve(main)
}

impl Walker<'_, '_> {
    pub(super) fn routine(&mut self, index: usize, depth: usize) {
        let home = self.values.symbols.routines[index];
        let modes = self.now.modes;
        let outer = std::mem::replace(
            &mut self.now,
            Now {
                routine: index,
                runs: Runs::Once,
                left: None,
                depth,
                modes,
            },
        );
        let outer_jumps = std::mem::take(&mut self.jumps);
        self.summaries[index].begun = true;
        self.active.push(index);
        self.modes_at_entry[index] = (self.now.modes, self.next_moment());
        let (before, stated) = (self.motions.len(), self.modes_stated);
        let called_again = self.called_again;
        if home.routine.jumps {
            self.now.runs = Runs::Repeatedly;
        }
        let mut place = self.block(&home.routine.body, Place::Entry);
        if let Some((left, modes)) = self.now.left {
            place = place.merged(left);
            self.now.modes = self.now.modes.met(modes);
        }
        let in_body = self.motions.len();
        self.jumps.clear();
        self.now.runs = Runs::OnCondition.max(self.now.runs);
        let has_ended = self.has_ended;
        self.handlers(&home.routine.handlers, before..in_body, stated);
        // Handlers run where something went wrong.
        self.has_ended = has_ended;
        // Where handlers move or jumps lead back, no place of the routine is sure.
        if home.routine.jumps || self.motions.len() > in_body {
            let own = (before..in_body).filter(|motion| self.places[*motion].0 == index);
            for motion in own.collect::<Vec<_>>() {
                self.places[motion].1 = Place::Unknown;
            }
            let calls = self.summaries.iter_mut().flat_map(|of| &mut of.calls);
            (calls.filter(|call| call.from == index)).for_each(|call| call.at = Place::Unknown);
            place = Place::Unknown;
        }
        self.active.pop();
        self.summaries[index].leaves = Some(place);
        self.finished.push(index);
        self.jumps = outer_jumps;
        self.states_modes[index] = self.modes_stated > stated || self.called_again > called_again;
        let modes = self.now.modes;
        self.modes_behind[index] = modes;
        self.now = Now { modes, ..outer };
    }

    pub(super) fn block(&mut self, statements: &[Statement], mut place: Place) -> Place {
        let runs = self.now.runs;
        // Behind a GOTO of this block nothing runs up to a label.
        let mut is_left_out = false;
        for statement in statements {
            match statement {
                Statement::Label { at } if !self.jumps_anywhere() => {
                    let before = (!is_left_out).then_some(place);
                    let arrived = self.arrive(*at, before);
                    is_left_out = arrived.is_none();
                    place = arrived.unwrap_or(place);
                }
                _ if is_left_out => {
                    self.now.runs = Runs::Elsewhere;
                    self.statement(statement, Place::Unknown);
                }
                _ => {
                    place = self.statement(statement, place);
                    is_left_out =
                        !self.jumps_anywhere() && destination(self.file(), statement).is_some();
                }
            }
            self.now.runs = self.runs_here(runs);
        }
        self.now.runs = runs;
        place
    }

    /// Whether the order of the routine is not that of its lines.
    fn jumps_anywhere(&self) -> bool {
        let routine = self.values.symbols.routines[self.now.routine];
        routine.routine.jumps
    }

    fn statement(&mut self, statement: &Statement, place: Place) -> Place {
        match statement {
            Statement::Call { tokens } => self.call(tokens, place, Choice::OneOfAll),
            Statement::Assignment { tokens, assign } => {
                let place = self.behind_functions(tokens.clone(), place);
                self.speeds_are_certain();
                self.assigns_speed(tokens, *assign);
                place
            }
            Statement::Label { .. } => {
                // A jump from anywhere in the routine leads here.
                self.now.modes = self.now.modes.met(self.anywhere);
                Place::Unknown
            }
            // Nothing is left where nothing runs.
            Statement::Leaves { .. } if self.now.runs == Runs::Elsewhere => place,
            Statement::Leaves { tokens } => {
                if let (false, Some(label)) =
                    (self.jumps_anywhere(), destination(self.file(), statement))
                {
                    self.jump_to(label, place);
                    return place;
                }
                self.has_ended |= self.file().word(tokens.start).eq_ignore_ascii_case(b"EXIT");
                let modes = self.now.modes;
                let left = self.now.left.map_or((place, modes), |(left, before)| {
                    (left.merged(place), before.met(modes))
                });
                self.now.left = Some(left);
                place
            }
            Statement::Branches {
                conditions,
                choice,
                blocks,
            } => {
                let place = (conditions.iter().cloned()).fold(place, |place, condition| {
                    self.behind_functions(condition, place)
                });
                self.now.depth += 1;
                let runs = self.now.runs;
                self.now.runs = runs.max(Runs::OnCondition);
                let mut after = (*choice != Choice::OneOfAll).then_some(place);
                // A block that is left out is a way, too.
                let modes = self.now.modes;
                let mut met = (*choice != Choice::OneOfAll).then_some(modes);
                for block in blocks {
                    self.now.modes = modes;
                    let end = match (choice, block.as_slice()) {
                        (Choice::Compact, [Statement::Call { tokens }]) => {
                            self.call(tokens, place, *choice)
                        }
                        _ => self.block(block, place),
                    };
                    let here = self.now.modes;
                    met = Some(met.map_or(here, |met| met.met(here)));
                    after = Some(after.map_or(end, |after| after.merged(end)));
                }
                self.now.modes = met.unwrap_or(modes);
                self.now.runs = runs;
                self.now.depth -= 1;
                after.unwrap_or(place)
            }
            Statement::Loop { header, block } => {
                let place = self.behind_functions(header.clone(), place);
                let runs = self.now.runs;
                self.now.runs = runs.max(Runs::Repeatedly);
                let inside = match stays(self.values, self.now.routine, block) {
                    true => place,
                    false => Place::Unknown,
                };
                self.now.depth += 1;
                let pass = self.pass();
                let end = self.block(block, inside);
                self.next_pass(&pass);
                self.now.depth -= 1;
                self.now.runs = runs;
                place.merged(end)
            }
        }
    }

    fn call(&mut self, tokens: &Range<usize>, place: Place, choice: Choice) -> Place {
        let file = self.file();
        let name = Name::of(file.word(tokens.start));
        if let Some(row) = name.as_ref().and_then(motion_row) {
            self.speeds_are_certain();
            return self.motion_by(row, tokens, (place, choice));
        }
        let routine = self.now.routine;
        if let Some(called) = name
            .as_ref()
            .and_then(|name| self.values.symbols.routine(routine, name))
        {
            return self.enter(called, file.span(tokens), place);
        }
        let place = self.behind_functions(tokens.start + 1..tokens.end, place);
        self.carried(name, tokens, place)
    }

    fn enter(&mut self, called: usize, span: Range<usize>, place: Place) -> Place {
        let now = self.now;
        let (from, runs) = (now.routine, now.runs);
        self.summaries[called].calls.push(Call {
            from,
            at: place,
            runs,
        });
        if now.depth >= DEEPEST {
            let file = &self.values.files[self.values.symbols.routines[from].file];
            note(self.faults, || {
                ProgramError::at(
                    file.source,
                    span,
                    "calls and blocks are nested deeper than 200",
                    "call what is deepest from main",
                )
            });
            return Place::Unknown;
        }
        self.speeds_of_call(called);
        if !self.summaries[called].begun {
            self.routine(called, now.depth + 1);
            self.speeds_of_call(called);
        } else {
            // It was walked with what held at its first call, and may change what holds.
            self.modes_of_another_call(called);
        }
        self.left_by_error(now.modes, called);
        let summary = &mut self.summaries[called];
        match summary.leaves {
            Some(leaves) => leaves.in_call(place),
            None => {
                summary.recursive = true;
                Place::Unknown
            }
        }
    }

    /// Fills in what depends on the calls of each routine.
    fn resolve(mut self, main: Option<usize>) -> Walked {
        let (runs, entry) = of_calls(&self.summaries, &self.finished, main);
        for (motion, (routine, place)) in self.motions.iter_mut().zip(&self.places) {
            motion.follows = match place.in_call(entry[*routine]) {
                Place::Motion(index) => Some(index),
                Place::Entry | Place::Unknown => None,
            };
            motion.runs = runs[*routine].max(motion.runs);
            motion.site.external_moved_behind |= self.moves_external_at_entry;
        }
        for (motion, modes) in self.motions.iter_mut().zip(&self.modes) {
            motion.site.turns_otherwise = modes.otherwise(motion);
        }
        Walked {
            motions: self.motions,
            findings: self.findings,
            outside_calls: self.outside_calls,
        }
    }
}
