//! A run of a program: its data, the routine that runs, and the motions so far.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::rc::Rc;

use nalgebra::Isometry3;

use crate::error::{ProgramError, note};
use crate::interpreter::value::{Datum, Value};
use crate::model::frame::FrameUse;
use crate::model::motion::{Motion, Runs};
use crate::model::outside_call::OutsideCall;
use crate::model::site::TargetSite;
use crate::options::{ReadOptions, StatedValue};
use crate::rapid::lex::Kind;
use crate::rapid::symbols::{Scope, Symbols};
use crate::rapid::table::motion_row;
use crate::rapid::targets::Targets;
use crate::rapid::tree::{RoutineKind, TokenFile};
use crate::rapid::turning::Modes;
use crate::text::finding::Finding;
use crate::text::line_words::in_words;
use crate::text::name::Name;

/// The reason why something is refused, and the remedy.
pub(crate) type Reason = (String, &'static str);

/// Deepest nesting of calls and blocks together.
pub(super) const DEEPEST: usize = 200;

/// A place of data: where it is stored, and the path of indices to a part of it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Place {
    pub root: Root,
    pub path: Vec<usize>,
}

/// Where data are stored.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Root {
    /// An index of [`Symbols::data`], of a module.
    Module(usize),
    /// A name of a routine that runs: its depth among the calls.
    Routine(usize, Name),
}

/// A datum or a parameter of a routine that runs.
#[derive(Debug, Clone)]
pub(super) enum Slot {
    Own(Datum),
    /// A parameter that stands for data of the caller.
    Of(Place),
}

/// A call that runs.
#[derive(Debug)]
pub(super) struct Called {
    pub routine: usize,
    pub slots: BTreeMap<Name, Slot>,
}

/// A statement that ran, as it is written flat.
#[derive(Debug)]
pub(super) struct Logged {
    pub file: usize,
    /// The place of the statement.
    pub at: usize,
    pub text: Vec<u8>,
}

/// A frame and the value that it was read from.
pub(super) type KnownFrame = (Rc<Vec<Datum>>, FrameUse);

/// A run of a program.
pub(crate) struct Run<'r, 'p> {
    pub(super) files: &'p [TokenFile<'p>],
    pub(super) symbols: &'r Symbols<'p>,
    pub(super) options: &'r ReadOptions,
    /// Frames that the caller states.
    pub(super) stated: BTreeMap<Name, Isometry3<f64>>,
    /// Values that the caller states.
    pub(super) values: BTreeMap<Name, Datum>,
    /// Names whose stated values the run asked for.
    pub(super) used_values: BTreeSet<Name>,
    /// Data of every controller, once they are asked for.
    pub(super) predefined: BTreeMap<Name, Datum>,
    /// Frames of tools and work objects by the values that they were read from.
    pub(super) frames: BTreeMap<(bool, Name), KnownFrame>,
    /// Values of the data of modules, once they are asked for.
    pub(super) data: BTreeMap<usize, Datum>,
    /// Data that interrupts change at any time.
    pub(super) volatile: BTreeSet<usize>,
    pub(super) calls: Vec<Called>,
    /// Where the expression stands that is evaluated.
    pub(super) scope: Scope,
    /// Nesting of declarations that rest on others.
    pub(super) depth_of_data: usize,
    /// Nesting of blocks and calls.
    pub(super) depth: usize,
    pub(super) modes: Modes,
    /// Program displacement, in the axes of the work object, mm.
    pub(super) displacement: Option<Isometry3<f64>>,
    pub(super) runs: Runs,
    /// The motion at whose end the tool is.
    pub(super) here: Option<usize>,
    pub(super) targets: Targets,
    pub(super) motions: Vec<Motion>,
    /// Begins of the statements of motions that ran, by file.
    pub(super) ran: BTreeSet<(usize, usize)>,
    pub(super) findings: Vec<Finding>,
    pub(super) outside_calls: Vec<OutsideCall>,
    pub(super) faults: Vec<ProgramError>,
    /// Places of faults and findings that were noted: a statement in a loop has one.
    pub(super) noted: BTreeSet<(usize, usize, &'static str)>,
    pub(super) statements: usize,
    /// The branch or the loop that ran last was passed over.
    pub(super) passed_over: bool,
    /// Statements that ran, where the program is to be written flat.
    pub(super) log: Option<Vec<Logged>>,
    /// Results of functions in the statement that runs, by the depth of the call, the file and the token.
    pub(super) results: BTreeMap<(usize, usize, usize), Datum>,
    /// Places from which routines were called.
    pub(super) call_sites: BTreeMap<usize, BTreeSet<(usize, usize)>>,
    /// The routine of each motion.
    pub(super) routines: Vec<usize>,
    pub(super) repeated_motions: usize,
}

impl<'r, 'p> Run<'r, 'p> {
    pub(super) fn new(
        files: &'p [TokenFile<'p>],
        symbols: &'r Symbols<'p>,
        options: &'r ReadOptions,
    ) -> Self {
        let stated = options.frames.iter();
        let stated = stated.filter_map(|(name, frame)| Some((Name::of(name.as_bytes())?, *frame)));
        let values = options.values.iter().filter_map(|(name, value)| {
            let value = match value {
                StatedValue::Number(number) => Value::Number(*number),
                StatedValue::Truth(truth) => Value::Truth(*truth),
                StatedValue::Text(text) => Value::Text(text.as_str().into()),
            };
            Some((Name::of(name.as_bytes())?, Datum::of(value)))
        });
        Self {
            files,
            symbols,
            options,
            stated: stated.collect(),
            values: values.collect(),
            used_values: BTreeSet::new(),
            predefined: BTreeMap::new(),
            frames: BTreeMap::new(),
            data: BTreeMap::new(),
            volatile: BTreeSet::new(),
            calls: Vec::new(),
            scope: Scope::Module(0),
            depth_of_data: 0,
            depth: 0,
            modes: Modes::BASIC,
            displacement: None,
            runs: Runs::Once,
            here: None,
            targets: Targets::default(),
            motions: Vec::new(),
            ran: BTreeSet::new(),
            findings: Vec::new(),
            outside_calls: Vec::new(),
            faults: Vec::new(),
            noted: BTreeSet::new(),
            statements: 0,
            passed_over: false,
            log: None,
            results: BTreeMap::new(),
            call_sites: BTreeMap::new(),
            routines: Vec::new(),
            repeated_motions: 0,
        }
    }

    /// Runs `main`, then each procedure that nothing calls as a program of its own.
    pub(super) fn whole(mut self) -> Self {
        self.note_volatile();
        let main = self.symbols.main();
        let called = self.called_by_name();
        let others = (0..self.symbols.routines.len()).filter(|index| {
            let kind = self.symbols.routines[*index].routine.kind;
            Some(*index) != main && kind == RoutineKind::Procedure && !called.contains(index)
        });
        let roots: Vec<usize> = main.into_iter().chain(others).collect();
        for root in roots {
            self.here = None;
            self.modes = Modes::BASIC;
            self.displacement = None;
            self.runs = match Some(root) == main {
                true => Runs::Once,
                false => Runs::Elsewhere,
            };
            self.data.clear();
            if self.log.is_none() || Some(root) == main {
                self.call(root, BTreeMap::new());
            }
        }
        self.say_of_values();
        self.say_of_unreached();
        self.mark_repeated();
        self.fix_what_others_call();
        let targets = std::mem::take(&mut self.targets);
        self.targets = targets.with_other_uses(self.files, self.symbols);
        self
    }

    /// A target that a routine computes is that of the calls that ran. Where code that did not run calls the routine too (an interrupt, an
    /// error handler, a branch), or a computed name may, it is not written as numbers.
    fn fix_what_others_call(&mut self) {
        let is_computed = self.outside_calls.iter().any(|call| call.name.is_none());
        let mut mentions: BTreeMap<Name, usize> = BTreeMap::new();
        for file in self.files {
            for at in (0..file.tokens.len()).filter(|at| file.tokens[*at].kind == Kind::Word) {
                if let Some(name) = Name::of(file.word(at)) {
                    *mentions.entry(name).or_default() += 1;
                }
            }
        }
        let is_open: Vec<bool> = (self.symbols.routines.iter().enumerate())
            .map(|(index, home)| {
                let sites = self.call_sites.get(&index).map_or(0, BTreeSet::len);
                let named = mentions
                    .get(&home.routine.name)
                    .copied()
                    .unwrap_or_default();
                // One mention is its own declaration.
                sites > 0 && (is_computed || named > sites + 1)
            })
            .collect();
        for (motion, routine) in self.motions.iter_mut().zip(&self.routines) {
            if !is_open.get(*routine).copied().unwrap_or_default() {
                continue;
            }
            let source = self.files[motion.file].source;
            let fixed = |site: &TargetSite| match site {
                TargetSite::Replaced(_) => true,
                TargetSite::Offset { arguments, .. } => arguments.iter().any(|number| {
                    let text = std::str::from_utf8(source.part(&number.span));
                    text.is_ok_and(|text| text.trim().parse::<f64>().is_err())
                }),
                _ => false,
            };
            let reason = "its routine computes it, and is called by code that does not run here (an interrupt, an error handler, a branch)";
            if fixed(&motion.site.target) {
                motion.site.target = TargetSite::Fixed(reason);
            }
            if let Some((_, via)) = &mut motion.site.via
                && fixed(via)
            {
                *via = TargetSite::Fixed(reason);
            }
        }
    }

    /// Routines that a statement of the files names.
    fn called_by_name(&self) -> BTreeSet<usize> {
        let mut called = BTreeSet::new();
        if self.symbols.routines.len() < 2 {
            return called;
        }
        for (index, home) in self.symbols.routines.iter().enumerate() {
            let file = &self.files[home.file];
            let mut see = |tokens: &Range<usize>| {
                let is_word = |at: &usize| file.tokens[*at].kind == Kind::Word;
                let words = tokens.clone().filter(is_word);
                let names = words.filter_map(|at| Name::of(file.word(at)));
                called.extend(names.filter_map(|name| self.symbols.routine(index, &name)));
            };
            home.routine.each_part(&mut see);
        }
        called
    }

    /// Data that routines of interrupts assign may change between any two statements.
    fn note_volatile(&mut self) {
        for (index, home) in self.symbols.routines.iter().enumerate() {
            if home.routine.kind == RoutineKind::Trap {
                let volatile = self.assigned_in(index, &home.routine.body);
                let modules = volatile.into_iter().filter_map(|root| match root {
                    Root::Module(datum) => Some(datum),
                    Root::Routine(..) => None,
                });
                self.volatile.extend(modules);
            }
        }
    }

    /// Values that the caller states decide the way of the program.
    fn say_of_values(&mut self) {
        let Some(file) = self.files.first() else {
            return;
        };
        for (name, value) in &self.options.values {
            let is_used =
                Name::of(name.as_bytes()).is_some_and(|own| self.used_values.contains(&own));
            let message = match (is_used, value) {
                (false, _) => {
                    format!("a value of `{name}` is stated, and the run does not ask for it")
                }
                (true, StatedValue::Number(number)) => {
                    format!("`{name}` is {number}, as is stated")
                }
                (true, StatedValue::Truth(truth)) => format!("`{name}` is {truth}, as is stated"),
                (true, StatedValue::Text(text)) => format!("`{name}` is \"{text}\", as is stated"),
            };
            self.findings.push(Finding {
                file: file.index,
                line: 1,
                message,
            });
        }
    }

    /// Motions that the run does not come to: of arms that are not taken, behind the end of the program, of error handlers and interrupts.
    fn say_of_unreached(&mut self) {
        let mut unreached: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for home in &self.symbols.routines {
            let file = &self.files[home.file];
            home.routine.each_part(&mut |tokens| {
                let start = file.span(tokens).start;
                let is_motion = || {
                    let name = Name::of(file.word(tokens.start));
                    name.is_some_and(|name| motion_row(&name).is_some())
                };
                if !self.ran.contains(&(file.index, start)) && is_motion() {
                    let lines = unreached.entry(file.index).or_default();
                    lines.push(file.source.line_of(start));
                }
            });
        }
        let all = unreached.into_iter().map(|(file, mut lines)| {
            lines.sort_unstable();
            lines.dedup();
            let named = in_words(&lines);
            Finding {
                file,
                line: lines.first().copied().unwrap_or(1),
                message: format!(
                    "the run of the program does not come to the motions on {named}: they stay as they are written"
                ),
            }
        });
        self.findings.extend(all);
    }

    /// Statements that ran several times say so at each of their motions.
    fn mark_repeated(&mut self) {
        let mut count: BTreeMap<(usize, usize), usize> = BTreeMap::new();
        for motion in &self.motions {
            *count.entry((motion.file, motion.span.start)).or_default() += 1;
        }
        for motion in &mut self.motions {
            let runs = count.get(&(motion.file, motion.span.start));
            if runs.is_some_and(|runs| *runs > 1) && motion.runs < Runs::Repeatedly {
                motion.runs = Runs::Repeatedly;
            }
        }
    }

    /// The file of the scope.
    pub(super) fn file(&self) -> &'p TokenFile<'p> {
        &self.files[match self.scope {
            Scope::Routine(routine) => self.symbols.routines[routine].file,
            Scope::Module(module) => self.symbols.file_of_module(module),
        }]
    }

    /// Notes a fault once.
    pub(super) fn fault(&mut self, tokens: &Range<usize>, (reason, remedy): Reason) {
        let file = self.file();
        let span = file.span(tokens);
        if self.noted.insert((file.index, span.start, "fault")) {
            note(&mut self.faults, || {
                ProgramError::at(file.source, span, reason, remedy)
            });
        }
    }

    /// Notes a finding once.
    pub(super) fn find(&mut self, tokens: &Range<usize>, message: String) {
        let file = self.file();
        let start = file.span(tokens).start;
        if self.noted.insert((file.index, start, "finding")) {
            self.findings.push(Finding {
                file: file.index,
                line: file.source.line_of(start),
                message,
            });
        }
    }
}
