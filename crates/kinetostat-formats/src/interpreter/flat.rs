//! A program that was run once and written flat: the statements of its run, one after the other, in place of those of `main`.
//!
//! Names that mean something in the routine of a statement alone (parameters, own data, variables of loops) are replaced by their
//! values, and computed ends of motions by their numbers. Routines that ran are left out.

use std::collections::BTreeSet;
use std::ops::Range;

use crate::error::ProgramError;
use crate::flat_run::{Written, not_flat};
use crate::interpreter::expression::{Argument, Expression, Node};
use crate::interpreter::run::{Dialect, Logged, Root, Run};
use crate::interpreter::symbols::{Meaning, Scope, Symbols};
use crate::interpreter::token::TokenFile;
use crate::interpreter::tree::RoutineKind;
use crate::interpreter::value::Datum;
use crate::model::program::RanStatement;
use crate::model::site::TargetSite;
use crate::text::Name;
use crate::text::source::{Edits, Finding, FlatText, SourceFile};

impl<D: Dialect> Run<'_, '_, D> {
    /// A motion that ran.
    pub(crate) fn log_motion(&mut self, tokens: &Range<usize>) {
        if self.log.is_none() {
            return;
        }
        let file = self.file();
        let parts = D::motion_parts(file, tokens);
        let mut edits = Edits::default();
        let last = self.motions.last();
        let is_computed: Vec<bool> = match last.map(|motion| &motion.site) {
            Some(site) => {
                let via = site.via.iter().map(|(_, via)| is_replaced(via));
                via.chain([is_replaced(&site.target)]).collect()
            }
            None => Vec::new(),
        };
        for (index, expression) in parts.ends.iter().enumerate() {
            let is_computed = is_computed
                .get(index)
                .is_some_and(|is_computed| *is_computed);
            let is_list = matches!(expression.node, Node::List(_) | Node::Members(_));
            self.put_value(expression, is_computed && !is_list, &mut edits);
        }
        for expression in &parts.others {
            self.put_value(expression, false, &mut edits);
        }
        self.log_with(tokens, edits);
    }

    /// An instruction that ran.
    pub(crate) fn log_instruction(&mut self, tokens: &Range<usize>) {
        let mut edits = Edits::default();
        for Argument { value, .. } in D::arguments_of(self.file(), tokens.start + 1..tokens.end) {
            if let Some(value) = value {
                self.put_value(&value, false, &mut edits);
            }
        }
        self.put_constants(&(tokens.start + 1..tokens.end), &mut edits);
        self.log_with(tokens, edits);
    }

    /// An assignment that ran; of data of a routine nothing remains but their values.
    pub(crate) fn log_assignment(&mut self, tokens: &Range<usize>, [to, value]: [&Expression; 2]) {
        let place = self.place(to);
        let stays = match place.map(|place| place.root) {
            Some(Root::Routine(..)) => false,
            Some(_) => true,
            // A variable of the controller.
            None => D::DECLARES_BY_USE,
        };
        if !stays {
            return;
        }
        let mut edits = Edits::default();
        self.put_place(to, &mut edits);
        self.put_value(value, false, &mut edits);
        self.put_constants(&value.tokens, &mut edits);
        self.log_with(tokens, edits);
    }

    /// A branch or a loop that the controller decides.
    pub(crate) fn log_passed_over(&mut self, whole: &Range<usize>) {
        if !std::mem::take(&mut self.passed_over) {
            return;
        }
        let file = self.file();
        let names = whole.clone().filter_map(|at| Name::of(file.word(at)));
        if names
            .into_iter()
            .any(|name| self.means_another_in_main(&name))
        {
            self.cannot_be_flat(
                whole,
                "it uses data that `main` does not see, of which the controller knows the value",
            );
        }
        self.log_with(whole, Edits::default());
    }

    /// A variable of the program that a loop counts gets its value.
    pub(crate) fn log_counter(&mut self, variable: &Expression, value: f64) {
        if self.log.is_none() || self.is_own(variable) {
            return;
        }
        let file = self.file();
        let text = format!("{}={value}", file.text(&variable.tokens));
        let (index, at) = (file.index, file.span(&variable.tokens).start);
        if let Some(log) = &mut self.log {
            log.push(Logged {
                file: index,
                at,
                text: text.into_bytes(),
            });
        }
    }

    /// An instruction without arguments in brackets: what it names must mean the same in `main`.
    pub(crate) fn log_words(&mut self, tokens: &Range<usize>) {
        let file = self.file();
        let mut names = tokens.clone().filter_map(|at| file.name(at));
        if names.any(|name| self.means_another_in_main(&name)) {
            self.cannot_be_flat(tokens, "it uses data of its routine");
        }
        let mut edits = Edits::default();
        self.put_constants(&(tokens.start + 1..tokens.end), &mut edits);
        self.log_with(tokens, edits);
    }

    /// Notes what a run says of itself at a statement.
    pub(crate) fn say_beside(&mut self, tokens: &Range<usize>, text: String) {
        let file = self.file();
        if self.log.is_none() {
            self.ran_beside.push(RanStatement {
                file: file.index,
                span: file.span(tokens),
                motions: self.motions.len(),
                text: Some(text.into_bytes()),
            });
        }
    }

    /// Puts numbers and truth values in place of names of data: another value makes another statement.
    fn put_constants(&mut self, tokens: &Range<usize>, edits: &mut Edits) {
        if self.log.is_some() {
            return;
        }
        let (file, symbols) = (self.file(), self.symbols);
        for at in tokens.clone() {
            let Some(name) = file.name(at).filter(|_| file.is_alone(at)) else {
                continue;
            };
            let span = file.span(&(at..at + 1));
            let word = Expression {
                node: Node::Word(name),
                tokens: at..at + 1,
            };
            let value = match self.place(&word).map(|place| place.root) {
                // A value of the files is asked for without a word on it.
                Some(Root::Module(index)) => match (self.data.get(&index), &symbols.data[index]) {
                    (Some(value), _) => Some(value.clone()),
                    (None, datum) => datum.node.initial.clone().map(|initial| {
                        let value = D::expression_of(&self.files[datum.file], initial);
                        self.within(datum.scope, |run| run.value(&value))
                    }),
                },
                Some(_) => Some(self.value(&word)),
                None => None,
            };
            let is_scalar = |own: &Datum| own.as_number().is_some() || own.as_truth().is_some();
            let text = value.filter(is_scalar).and_then(|own| D::printed(&own));
            if let Some(text) = text.filter(|_| !edits.touches(&span)) {
                edits.replace(span, text);
            }
        }
    }

    fn cannot_be_flat(&mut self, tokens: &Range<usize>, why: &str) {
        if self.log.is_some() {
            self.fault(tokens, not_flat(why));
        }
    }

    fn log_with(&mut self, tokens: &Range<usize>, edits: Edits) {
        let file = self.file();
        let span = file.span(tokens);
        let is_edited = !edits.is_empty() || self.log.is_some();
        let text = (is_edited.then(|| edits.applied_to_part(file.source.bytes(), &span))).flatten();
        match (&mut self.log, text) {
            (None, text) => self.ran_beside.push(RanStatement {
                file: file.index,
                span,
                motions: self.motions.len(),
                text,
            }),
            (Some(log), Some(text)) => log.push(Logged {
                file: file.index,
                at: span.start,
                text,
            }),
            _ => {}
        }
    }

    /// Puts the value in place of an expression that means something in its routine alone.
    fn put_value(&mut self, expression: &Expression, is_computed: bool, edits: &mut Edits) {
        if !is_computed && !self.is_own(expression) {
            return;
        }
        match &expression.node {
            Node::Call(_, arguments) if !is_computed && !self.acts_in_call(expression) => {
                let values = arguments
                    .iter()
                    .filter_map(|argument| argument.value.as_ref());
                values.for_each(|value| self.put_value(value, false, edits));
                return;
            }
            Node::List(parts) => {
                parts
                    .iter()
                    .for_each(|part| self.put_value(part, false, edits));
                return;
            }
            Node::Members(members) => {
                members
                    .iter()
                    .for_each(|(_, part)| self.put_value(part, false, edits));
                return;
            }
            _ => {}
        }
        let span = self.file().span(&expression.tokens);
        if !is_computed && let Some(name) = self.name_in_main(expression) {
            edits.replace(span, name);
            return;
        }
        match D::printed(&self.value(expression)) {
            Some(text) => edits.replace(span, text),
            None => self.cannot_be_flat(
                &expression.tokens,
                "it uses data that `main` does not see, of which the controller knows the value",
            ),
        }
    }

    /// Puts the name that `main` knows in place of that by which a routine knows a place.
    fn put_place(&mut self, expression: &Expression, edits: &mut Edits) {
        match &expression.node {
            Node::Word(name) if self.means_another_in_main(name) => {
                match self.name_in_main(expression) {
                    Some(name) => edits.replace(self.file().span(&expression.tokens), name),
                    None => self
                        .cannot_be_flat(&expression.tokens, "it assigns what `main` does not see"),
                }
            }
            Node::Field(of, _) => self.put_place(of, edits),
            Node::Element(of, indices) => {
                self.put_place(of, edits);
                indices
                    .iter()
                    .for_each(|index| self.put_value(index, false, edits));
            }
            _ => {}
        }
    }

    /// The name of whole data of a module that a parameter stands for, where `main` sees them.
    fn name_in_main(&mut self, expression: &Expression) -> Option<String> {
        let place = self.place(expression)?;
        let (Root::Module(index), true) = (place.root, place.path.is_empty()) else {
            return None;
        };
        let name = self.symbols.data[index].node.name;
        let main = self.symbols.meaning(self.symbols.main?, &name);
        (main == Some(Meaning::Datum(index))).then(|| self.shown(index))
    }

    /// True for an expression with a name that means something else, or nothing, in `main`.
    fn is_own(&self, expression: &Expression) -> bool {
        match &expression.node {
            Node::Word(name) => self.means_another_in_main(name),
            Node::Field(of, _) | Node::One(_, of) => self.is_own(of),
            Node::Element(of, indices) => {
                self.is_own(of) || indices.iter().any(|part| self.is_own(part))
            }
            Node::List(parts) => parts.iter().any(|part| self.is_own(part)),
            Node::Members(members) => members.iter().any(|(_, part)| self.is_own(part)),
            Node::Two(_, operands) => operands.iter().any(|part| self.is_own(part)),
            Node::Call(_, arguments) => {
                let values = arguments.iter();
                let mut values = values.filter_map(|argument| argument.value.as_ref());
                self.acts_in_call(expression) || values.any(|part| self.is_own(part))
            }
            Node::Number(_) | Node::Truth(_) | Node::Text | Node::Choice(_) | Node::Unreadable => {
                false
            }
        }
    }

    /// True for the call of a function whose statements have been written.
    fn acts_in_call(&self, expression: &Expression) -> bool {
        self.calls_that_act.contains(&self.key_of_call(expression))
    }

    fn means_another_in_main(&self, name: &Name) -> bool {
        let here = self.symbols.meaning_in(self.scope, name);
        let main = self
            .symbols
            .main
            .and_then(|main| self.symbols.meaning(main, name));
        let is_of_module = match here {
            Some(Meaning::Datum(index)) => {
                matches!(self.symbols.data[index].scope, Scope::Module(_))
            }
            Some(Meaning::Parameter) => false,
            None => true,
        };
        !is_of_module || here != main
    }
}

fn is_replaced(site: &TargetSite) -> bool {
    matches!(site, TargetSite::Replaced(_))
}

/// The flat text of a program that ran with a log, or all that is refused.
pub(crate) fn flat_of<D: Dialect>(
    mut run: Run<'_, '_, D>,
    files: &[SourceFile],
    mut faults: Vec<ProgramError>,
) -> Result<FlatText, Vec<ProgramError>> {
    run.log = Some(Vec::new());
    let run = run.whole();
    let (symbols, token_files) = (run.symbols, run.files);
    faults.extend(run.faults);
    let Some(main) = symbols.main else {
        let file = &files[0];
        let [reason, remedy] = D::NO_MAIN;
        faults.push(ProgramError::at(file, 0..0, reason, remedy));
        return Err(faults);
    };
    if !faults.is_empty() {
        return Err(faults);
    }
    let log = run.log.unwrap_or_default();
    let called: BTreeSet<usize> = run.call_sites.keys().copied().collect();
    let left_out = left_out(symbols, token_files, &called, main, &log);
    let mut findings = run.findings;
    for index in &left_out {
        let home = symbols.routines[*index];
        if !home.routine.handlers.is_empty() {
            let file = &token_files[home.file];
            let at = file
                .span(&(home.routine.name_at..home.routine.name_at + 1))
                .start;
            findings.push(Finding {
                file: home.file,
                line: file.source.line_of(at),
                message: "the error handler of this routine is not in the flat program".to_owned(),
            });
        }
    }
    let left_out = |index: usize| left_out.contains(&index);
    let mut out = Written::default();
    let own = symbols.routines[main].file;
    // Routines between the statements of `main` that stay are put before them.
    let statements = &symbols.routines[main].routine.statements;
    let is_between = |index: usize| {
        let (home, whole) = (
            symbols.routines[index],
            &symbols.routines[index].routine.whole,
        );
        home.file == own && statements.start <= whole.start && whole.end <= statements.end
    };
    let between =
        (0..symbols.routines.len()).filter(|index| is_between(*index) && !left_out(*index));
    let between = between.map(|index| {
        let span = token_files[own].span(&symbols.routines[index].routine.whole);
        let text = files[own].part(&span).to_vec();
        Logged {
            file: own,
            at: span.start,
            text,
        }
    });
    let log: Vec<Logged> = between.chain(log).collect();
    let put = |text: &[u8], of: &Logged, out: &mut Written| {
        out.part(text, of.file, files[of.file].line_of(of.at));
    };
    for file in token_files
        .iter()
        .filter(|file| D::JOINS_FILES || file.index == own)
    {
        let mut cuts: Vec<(Range<usize>, bool)> = Vec::new();
        for (index, home) in symbols.routines.iter().enumerate() {
            if home.file == file.index && index == main {
                cuts.push((file.span(&home.routine.statements), true));
            } else if home.file == file.index && left_out(index) && !is_between(index) {
                cuts.push((file.span(&home.routine.whole), false));
            }
        }
        cuts.sort_by_key(|(span, _)| span.start);
        let copy = |span: Range<usize>, out: &mut Written| {
            let first = file.source.line_of(span.start);
            out.part(file.source.part(&span), file.index, first);
        };
        let mut at = 0;
        for (span, is_main) in cuts {
            copy(at..span.start, &mut out);
            if is_main {
                let indentation = file.source.indentation_before(span.start).to_vec();
                for (number, logged) in log.iter().enumerate() {
                    if number > 0 {
                        out.bytes.extend_from_slice(file.source.line_ending());
                        put(&indentation, logged, &mut out);
                    }
                    put(&logged.text, logged, &mut out);
                }
            }
            at = span.end.max(at);
        }
        copy(at..file.source.bytes().len(), &mut out);
    }
    let changed = out.bytes != files[own].bytes();
    Ok(FlatText {
        file: SourceFile::new(files[own].name(), out.bytes),
        origins: out.origins,
        changed,
        findings,
    })
}

/// Procedures that ran and that nothing in the flat program names any more.
fn left_out(
    symbols: &Symbols<'_>,
    files: &[TokenFile<'_>],
    called: &BTreeSet<usize>,
    main: usize,
    log: &[Logged],
) -> BTreeSet<usize> {
    let texts = log.iter().map(|logged| logged.text.as_slice());
    let words =
        texts.flat_map(|text| text.split(|byte| !byte.is_ascii_alphanumeric() && *byte != b'_'));
    let mut named: BTreeSet<Name> = words.filter_map(Name::of).collect();
    let mut out: BTreeSet<usize> = (called.iter().copied())
        .filter(|index| {
            let kind = symbols.routines[*index].routine.kind;
            *index != main && matches!(kind, RoutineKind::Procedure | RoutineKind::Inner)
        })
        .collect();
    let words_of = |index: usize| {
        let home = symbols.routines[index];
        let file = &files[home.file];
        let whole = match index == main {
            // The statements of `main` are those of the log; its handlers stay.
            true => home.routine.statements.end..home.routine.whole.end,
            false => home.routine.whole.start..home.routine.whole.end,
        };
        whole
            .filter_map(|at| Name::of(file.word(at)))
            .filter(move |name| *name != home.routine.name)
    };
    for index in (0..symbols.routines.len()).filter(|index| !out.contains(index)) {
        named.extend(words_of(index));
    }
    loop {
        let stays = out
            .iter()
            .copied()
            .find(|index| named.contains(&symbols.routines[*index].routine.name));
        let Some(stays) = stays else { return out };
        out.remove(&stays);
        named.extend(words_of(stays));
    }
}
