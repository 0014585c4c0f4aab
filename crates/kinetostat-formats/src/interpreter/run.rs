//! A run of a program: its data, the routine that runs, and the motions so far.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use crate::error::{ProgramError, excerpt, note};
use crate::interpreter::evaluate::index_of;
use crate::interpreter::expression::{Argument, Expression, Operator};
use crate::interpreter::operation::two;
use crate::interpreter::reading::{self, Grammar};
use crate::interpreter::symbols::{Scope, Symbols};
use crate::interpreter::targets::Targets;
use crate::interpreter::token::TokenFile;
use crate::interpreter::tree::{Choice, Counting, DatumNode, Flow, Leave, RoutineKind};
use crate::interpreter::value::{Datum, StatedValues, Step, printed};
use crate::model::motion::{Motion, Runs};
use crate::model::program::{OutsideCall, RanStatement};
use crate::options::ReadOptions;
use crate::table::{StatementRow, Treatment};
use crate::text::Name;
use crate::text::source::Finding;

/// The reason why something is refused, and the remedy.
pub(crate) type Reason = (String, &'static str);

/// Limit of the motions of repeated statements.
const MOST_REPEATED: usize = 200_000;

/// Deepest nesting of calls and blocks together.
pub(crate) const DEEPEST: usize = 200;

/// A place of data: where it is stored, and the way to a part of it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Place {
    pub root: Root,
    pub path: Vec<Step>,
}

/// Storage of a variable.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Root {
    /// An index of [`Symbols::data`], of a module.
    Module(usize),
    /// A name that no file declares.
    Undeclared(Name),
    /// A name of a routine that runs: its depth among the calls.
    Routine(usize, Name),
}

/// A datum or a parameter of a routine that runs.
#[derive(Debug, Clone)]
pub(crate) enum Slot {
    Own(Datum),
    /// A parameter that stands for data of the caller.
    Of(Place),
}

/// A call that runs.
#[derive(Debug)]
pub(crate) struct Called {
    pub routine: usize,
    pub slots: BTreeMap<Name, Slot>,
}

/// Ways to parts of a value.
pub(crate) type Ways = BTreeSet<Vec<Step>>;

/// Uses of a datum with the value of the files.
#[derive(Debug, Default)]
pub(crate) struct FirstUse {
    /// For a use of the whole, ways to the parts that the run had given a value before.
    pub whole: Option<Ways>,
    /// For elements that were used, the same.
    pub parts: BTreeMap<Step, Ways>,
}

/// A statement that ran, as it is written flat.
#[derive(Debug)]
pub(crate) struct Logged {
    pub file: usize,
    /// The place of the statement.
    pub at: usize,
    pub text: Vec<u8>,
}

/// Interface of a run to a language.
pub(crate) trait Dialect: Sized {
    /// True where a loop counts down by itself if its end is below its begin, and its variable lives in the loop alone.
    const OWN_COUNTER: bool;

    /// True where a name that no file declares is one of the controller, and gets its value by an assignment.
    const DECLARES_BY_USE: bool;

    /// Expression grammar of the language.
    const GRAMMAR: &'static Grammar;

    /// Carried words that influence the deflection, with their effects.
    const EFFECTS: &'static [(&'static str, &'static str)] = &[];

    /// The expression that tokens are.
    fn expression_of(file: &TokenFile<'_>, tokens: Range<usize>) -> Expression {
        reading::expression_of(Self::GRAMMAR, file, tokens)
    }

    /// The arguments of a call, those in brackets where these are the brackets of a statement `name(a,b)`.
    fn arguments_of(file: &TokenFile<'_>, tokens: Range<usize>) -> Vec<Argument> {
        let is_bracketed = file.is(tokens.start, b'(');
        let close = file.find(tokens.start + 1..tokens.end, b')');
        let inner = match (is_bracketed, close) {
            (true, Some(close)) => tokens.start + 1..close,
            _ => tokens,
        };
        reading::arguments_of(Self::GRAMMAR, file, inner)
    }

    /// The row of a word in the table of the language.
    fn row(_word: &[u8]) -> Option<&'static StatementRow> {
        None
    }

    /// The motion of a statement that is a call, or why it is refused.
    fn motion(
        _run: &mut Run<'_, '_, Self>,
        _tokens: &Range<usize>,
        _arguments: &[Argument],
    ) -> Result<Motion, Reason> {
        Err(("it is no motion".to_owned(), "take it out"))
    }

    /// Puts in force what the call of a word with a value sets.
    fn sets(_run: &mut Run<'_, '_, Self>, _word: &[u8], _value: &Expression) {}

    /// The way to a component of a value.
    fn component(_of: &Datum, _name: &Name) -> Option<Step> {
        None
    }

    /// The way to an element of a value.
    fn element(of: &Datum, index: &Datum) -> Option<Step> {
        let is_from_one = Self::GRAMMAR.counts_from_one;
        let index = index_of(index, usize::from(is_from_one))?;
        match of.members() {
            [] => Some(Step::Index(index)),
            _ if is_from_one => Some(Step::Index(index)),
            members => members.get(index).map(|(name, _)| Step::Member(*name)),
        }
    }

    /// The value of a name that every controller declares.
    fn predefined(_name: &Name) -> Option<Datum> {
        None
    }

    /// The value of a declaration without one; none where only the controller knows it.
    fn of_type(_node: &DatumNode) -> Option<Datum> {
        None
    }

    /// Message on data whose value in the controller may differ from the file.
    fn kept(_run: &Run<'_, '_, Self>, _index: usize) -> Option<String> {
        None
    }

    /// True for data that decide where the tool goes: such data must not keep another value for the next run.
    fn decides_places(_node: &DatumNode) -> bool {
        false
    }

    /// A value as a datum of a type holds it.
    fn converted(_type_name: &Name, value: Datum) -> Datum {
        value
    }

    /// True for operands of which the quotient is a whole number.
    fn divides_whole(_run: &Run<'_, '_, Self>, _operands: &[Expression; 2]) -> bool {
        false
    }

    /// True for data that the controller changes while the program runs.
    fn changes_by_itself(_name: &Name) -> bool {
        false
    }

    /// The result of an operator with two operands.
    fn operation(
        _run: &Run<'_, '_, Self>,
        operator: Operator,
        left: &Datum,
        right: &Datum,
    ) -> Datum {
        two(operator, left, right)
    }

    /// The result of a function of the controller; none of one that is not computed here.
    fn function(
        run: &mut Run<'_, '_, Self>,
        name: &Name,
        arguments: &[Argument],
        whole: &Expression,
    ) -> Option<Datum>;

    /// The result of a function of the controller with these values; none of one that is not computed here.
    fn computed(_name: &Name, _values: &[Datum]) -> Option<Datum> {
        None
    }

    /// True for a function of the controller that leaves its arguments as they are.
    fn leaves_arguments(_function: &Name) -> bool {
        true
    }

    /// True for an instruction that changes what it is given.
    fn changes_arguments(_instruction: &Name) -> bool {
        false
    }

    /// True for the word of a motion.
    fn is_motion(word: &Name) -> bool;

    /// Puts in force what an assignment to a variable of the controller sets.
    fn assigned(_run: &mut Run<'_, '_, Self>, _tokens: &Range<usize>, _assign: usize) {}

    /// Runs an instruction, or calls a procedure.
    fn instruction(run: &mut Run<'_, '_, Self>, tokens: &Range<usize>, choice: Choice) -> Flow;

    /// Reads a statement that leaves its block.
    fn leave(file: &TokenFile<'_>, tokens: &Range<usize>) -> Leave;

    /// Reads how a loop counts; none where the language has no such loops.
    fn counting(_file: &TokenFile<'_>, _header: &Range<usize>) -> Option<Counting> {
        None
    }

    /// Words that change modal state.
    const MODAL: &'static [&'static str] = &[];

    /// True for an instruction that moves the tool or changes modal state.
    fn acts(_run: &Run<'_, '_, Self>, file: &TokenFile<'_>, tokens: &Range<usize>) -> bool {
        let called = tokens.clone().filter(|at| file.is(*at + 1, b'('));
        called.map(|at| file.word(at)).any(|word| {
            let treatment = Self::row(word).map(|row| row.treatment);
            let is_refused = matches!(treatment, Some(Treatment::Refused { .. }));
            let is_modal = || Self::MODAL.iter().any(|own| word == own.as_bytes());
            let is_motion = || Name::of(word).is_some_and(|name| Self::is_motion(&name));
            is_refused || is_modal() || is_motion()
        })
    }

    /// Routines that run beside the program or break into it.
    fn interrupting(run: &Run<'_, '_, Self>) -> Vec<usize> {
        let all = run.symbols.routines.iter().enumerate();
        let traps = all.filter(|(_, home)| home.routine.kind == RoutineKind::Trap);
        traps.map(|(index, _)| index).collect()
    }

    /// Takes the modal state with which a program begins.
    fn begin(run: &mut Run<'_, '_, Self>);

    /// True where all files of a program are written flat as one; otherwise those that hold no routines stay beside it.
    const JOINS_FILES: bool;

    /// Message and remedy of a program without a main routine.
    const NO_MAIN: [&'static str; 2];

    /// Expressions in the statement of a motion.
    fn motion_parts(file: &TokenFile<'_>, tokens: &Range<usize>) -> MotionParts;

    /// A value as the language writes it; none where a part of it is not known.
    fn printed(datum: &Datum) -> Option<String> {
        printed(Self::GRAMMAR, datum)
    }
}

/// Expressions in the statement of a motion.
#[derive(Default)]
pub(crate) struct MotionParts {
    /// The place on a circle, and the end.
    pub ends: Vec<Expression>,
    pub others: Vec<Expression>,
}

/// A run of a program.
pub(crate) struct Run<'r, 'p, D> {
    pub(crate) files: &'p [TokenFile<'p>],
    pub(crate) symbols: &'r Symbols<'p>,
    pub(crate) options: &'r ReadOptions,
    /// Values that the caller states.
    pub(crate) values: StatedValues<'r>,
    /// Data of every controller, once they are asked for.
    pub(crate) predefined: BTreeMap<Name, Datum>,
    /// Values of the data of modules, once they are asked for.
    pub(crate) data: BTreeMap<usize, Datum>,
    /// Values of names that no file declares.
    pub(crate) undeclared: BTreeMap<Name, Datum>,
    /// Uses of data of modules with the values of the files.
    pub(crate) first_uses: BTreeMap<usize, FirstUse>,
    /// Parts of data of modules to which the run gave a value; none where that was the whole.
    pub(crate) given: BTreeMap<usize, Option<Ways>>,
    /// Data of modules that an earlier program of the files changed.
    pub(crate) left_changed: BTreeSet<usize>,
    /// Data that interrupts change at any time.
    pub(crate) volatile: BTreeSet<usize>,
    pub(crate) calls: Vec<Called>,
    /// Scope of the expression that is evaluated.
    pub(crate) scope: Scope,
    /// Declarations that are evaluated, each for the one before.
    pub(crate) open_data: BTreeSet<usize>,
    /// Nesting of blocks and calls.
    pub(crate) depth: usize,
    /// Modal state of the language, and what it keeps beside.
    pub(crate) own: D,
    pub(crate) runs: Runs,
    /// The motion at whose end the tool is.
    pub(crate) here: Option<usize>,
    pub(crate) targets: Targets,
    pub(crate) motions: Vec<Motion>,
    /// Begins of the statements of motions that ran, by file.
    pub(crate) ran: BTreeSet<(usize, usize)>,
    pub(crate) findings: Vec<Finding>,
    pub(crate) outside_calls: Vec<OutsideCall>,
    pub(crate) faults: Vec<ProgramError>,
    /// Places of faults and findings that were noted: a statement in a loop has one.
    pub(crate) noted: BTreeSet<(usize, usize, &'static str)>,
    /// Statements that ran in loops and in routines that others call.
    pub(crate) repeated_statements: usize,
    /// Nesting of loops that run.
    pub(crate) in_loops: usize,
    /// Tokens of the statement that runs.
    pub(crate) statement: Range<usize>,
    /// The branch or the loop that ran last was passed over.
    pub(crate) passed_over: bool,
    /// Statements beside the motions that ran, where the program is not to be written flat.
    pub(crate) ran_beside: Vec<RanStatement>,
    /// Statements that ran, where the program is to be written flat.
    pub(crate) log: Option<Vec<Logged>>,
    /// Results of functions in the statement that runs, by the depth of the call, the file and the token.
    pub(crate) results: BTreeMap<(usize, usize, usize), Datum>,
    /// Such functions whose statements stand in the flat program: their calls do not.
    pub(crate) calls_that_act: BTreeSet<(usize, usize, usize)>,
    /// Places from which routines were called.
    pub(crate) call_sites: BTreeMap<usize, BTreeSet<(usize, usize)>>,
    /// The routine of each motion.
    pub(crate) routines: Vec<usize>,
    pub(crate) repeated_motions: usize,
}

impl<'r, 'p, D: Dialect> Run<'r, 'p, D> {
    pub(crate) fn new(
        files: &'p [TokenFile<'p>],
        symbols: &'r Symbols<'p>,
        options: &'r ReadOptions,
        own: D,
    ) -> Self {
        Self {
            files,
            symbols,
            options,
            values: StatedValues::of(options),
            predefined: BTreeMap::new(),
            data: BTreeMap::new(),
            undeclared: BTreeMap::new(),
            first_uses: BTreeMap::new(),
            given: BTreeMap::new(),
            left_changed: BTreeSet::new(),
            volatile: BTreeSet::new(),
            calls: Vec::new(),
            scope: Scope::Module(0),
            open_data: BTreeSet::new(),
            depth: 0,
            own,
            runs: Runs::Once,
            here: None,
            targets: Targets::default(),
            motions: Vec::new(),
            ran: BTreeSet::new(),
            findings: Vec::new(),
            outside_calls: Vec::new(),
            faults: Vec::new(),
            noted: BTreeSet::new(),
            repeated_statements: 0,
            in_loops: 0,
            statement: 0..0,
            passed_over: false,
            ran_beside: Vec::new(),
            log: None,
            results: BTreeMap::new(),
            calls_that_act: BTreeSet::new(),
            call_sites: BTreeMap::new(),
            routines: Vec::new(),
            repeated_motions: 0,
        }
    }

    /// The call of a function: its depth, its file and its token.
    pub(crate) fn key_of_call(&self, whole: &Expression) -> (usize, usize, usize) {
        (self.calls.len(), self.file().index, whole.tokens.start)
    }

    /// The file of the scope.
    pub(crate) fn file(&self) -> &'p TokenFile<'p> {
        &self.files[match self.scope {
            Scope::Routine(routine) => self.symbols.routines[routine].file,
            Scope::Module(module) => self.symbols.file_of_module(module),
        }]
    }

    /// The result of what is done with the names of another scope.
    pub(crate) fn within<T>(&mut self, scope: Scope, act: impl FnOnce(&mut Self) -> T) -> T {
        let outer = std::mem::replace(&mut self.scope, scope);
        let found = act(self);
        self.scope = outer;
        found
    }

    /// Notes that the statement of a motion runs; false where too many ran before.
    pub(crate) fn begins_motion(&mut self, tokens: &Range<usize>) -> bool {
        let start = self.file().span(tokens).start;
        if self.ran.insert((self.file().index, start)) {
            return true;
        }
        self.repeated_motions += 1;
        let is_too_much = self.repeated_motions > MOST_REPEATED;
        if is_too_much {
            let reason = "the loops of the program run more than 200000 motions".to_owned();
            self.fault(tokens, (reason, "read the part that cuts by itself"));
        }
        !is_too_much
    }

    /// Adds a motion that ran.
    pub(crate) fn push_motion(&mut self, mut motion: Motion) {
        motion.runs = self.runs;
        motion.follows = self.here;
        self.motions.push(motion);
        let routine = self.calls.last().map_or(0, |called| called.routine);
        self.routines.push(routine);
        self.here = Some(self.motions.len() - 1);
    }

    /// The line of the statement that runs.
    pub(crate) fn line(&self) -> usize {
        self.file().line_of(self.statement.start)
    }

    /// Notes a fault once.
    pub(crate) fn fault(&mut self, tokens: &Range<usize>, (reason, remedy): Reason) {
        let file = self.file();
        let span = file.span(tokens);
        if self.noted.insert((file.index, span.start, "fault")) {
            note(&mut self.faults, || {
                ProgramError::at(file.source, span, reason, remedy)
            });
        }
    }

    /// Notes a call of what is in none of the files, by its row in the table of the language; one that the table refuses is a fault. What
    /// stands in no table is taken not to move the tool and not to change what is in force.
    pub(crate) fn note_call(&mut self, row: Option<&'static StatementRow>, tokens: &Range<usize>) {
        match row.map(|row| row.treatment) {
            Some(Treatment::Refused { reason, remedy }) => {
                self.fault(tokens, (reason.to_owned(), remedy));
            }
            Some(_) => {}
            None => {
                let name = excerpt(self.file().word(tokens.start));
                self.note_outside_call(Some(name), tokens);
            }
        }
    }

    /// Notes a call that no file defines, by its name where it is not computed.
    pub(crate) fn note_outside_call(&mut self, name: Option<String>, tokens: &Range<usize>) {
        let file = self.file();
        let call = OutsideCall {
            file: file.index,
            line: file.line_of(tokens.start),
            name,
        };
        if !self.outside_calls.contains(&call) {
            self.outside_calls.push(call);
        }
    }

    /// Notes a finding once.
    pub(crate) fn find(&mut self, tokens: &Range<usize>, message: String) {
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
