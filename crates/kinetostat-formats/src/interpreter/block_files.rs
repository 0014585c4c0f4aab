//! Files of a language of [`super::blocks`]: read, and written flat.

use std::marker::PhantomData;

use crate::error::{ProgramError, WriteError};
use crate::flat_run::RefusedRun;
use crate::interpreter::blocks::module_of;
use crate::interpreter::flat::flat_of;
use crate::interpreter::lexing::{Words, symbols_of, tokens_of};
use crate::interpreter::run::{Dialect, Run};
use crate::interpreter::symbols::Symbols;
use crate::interpreter::token::TokenFile;
use crate::interpreter::tree::{Module, RoutineKind};
use crate::model::Language;
use crate::model::parsed::{Parsed, Read};
use crate::model::program::RobotProgram;
use crate::options::{ReadOptions, WriteOptions};
use crate::program_language::{ProgramLanguage, WrittenFile, of_run};
use crate::table::StatementRow;
use crate::text::source::{FlatText, SourceFile};
use crate::writing::motions::write_with;
use crate::writing::piece::Piece;
use crate::writing::syntax::Syntax;

/// Limit of the bytes of a file; the memory needed is some twenty times as much.
const MOST_BYTES: usize = 1 << 26;

/// A language of blocks.
pub(crate) trait BlockDialect: Dialect {
    const LANGUAGE: Language;
    const FACTS: Facts;
    const WORDS: &'static Words;

    /// State before a program begins.
    fn before() -> Self;
}

/// Properties of a block language that other files need; the methods of [`ProgramLanguage`] document them.
pub(crate) struct Facts {
    pub word: &'static str,
    pub name: &'static str,
    pub title: &'static str,
    pub endings: &'static [&'static str],
    pub unread_endings: &'static [(&'static str, &'static str)],
    pub comment: &'static str,
    pub statements: &'static [StatementRow],
    pub written: &'static str,
    pub held_word: &'static str,
    pub order_words: &'static [&'static str],
    /// Words of motions in capitals, and the law of each group.
    pub laws: &'static [(&'static [&'static str], &'static str)],
    pub syntax: &'static (dyn Syntax + Sync),
}

/// The entry of a language of blocks in the registry.
pub(crate) struct BlockLanguage<D>(pub PhantomData<fn() -> D>);

impl<D: BlockDialect> ProgramLanguage for BlockLanguage<D> {
    fn word(&self) -> &'static str {
        D::FACTS.word
    }

    fn name(&self) -> &'static str {
        D::FACTS.name
    }

    fn title(&self) -> &'static str {
        D::FACTS.title
    }

    fn endings(&self) -> &'static [&'static str] {
        D::FACTS.endings
    }

    fn comment(&self) -> &'static str {
        D::FACTS.comment
    }

    fn statements(&self) -> &'static [StatementRow] {
        D::FACTS.statements
    }

    fn written(&self) -> &'static str {
        D::FACTS.written
    }

    fn held_word(&self) -> Option<&'static str> {
        Some(D::FACTS.held_word)
    }

    fn order_words(&self) -> &'static [&'static str] {
        D::FACTS.order_words
    }

    fn comment_behind_statement(&self) -> Option<&'static str> {
        Some(D::FACTS.comment)
    }

    fn unread_endings(&self) -> &'static [(&'static str, &'static str)] {
        D::FACTS.unread_endings
    }

    fn law_of_motion(&self, word: &str) -> Option<&'static str> {
        (D::FACTS.laws.iter()).find_map(|(own, law)| own.contains(&word).then_some(*law))
    }

    fn parse(&self, files: Vec<SourceFile>, options: &ReadOptions) -> Parsed {
        parse_blocks::<D>(files, options)
    }

    fn write(
        &self,
        program: &RobotProgram,
        pieces: &[Piece],
        options: &WriteOptions,
    ) -> Result<Vec<WrittenFile>, WriteError> {
        write_with(program, pieces, options, D::FACTS.syntax)
    }

    fn expand(
        &self,
        files: &[SourceFile],
        options: &ReadOptions,
    ) -> Result<Option<FlatText>, RefusedRun> {
        of_run(expand_blocks::<D>(files, options))
    }
}

/// Gives tokens, names and faults of files to a function; files that are too large are refused.
fn with_program<T>(
    files: &[SourceFile],
    words: &'static Words,
    with: impl FnOnce(&[TokenFile<'_>], &Symbols<'_>, Vec<ProgramError>) -> T,
) -> Result<T, Vec<ProgramError>> {
    let large = |file: &SourceFile| ProgramError::too_large(file, MOST_BYTES);
    let mut faults: Vec<ProgramError> = files.iter().filter_map(large).collect();
    if !faults.is_empty() {
        return Err(faults);
    }
    let token_files: Vec<TokenFile<'_>> = (files.iter().enumerate())
        .map(|(index, source)| TokenFile {
            index,
            source,
            tokens: tokens_of(&words.marks, source.bytes()),
            lines: Vec::new(),
        })
        .collect();
    let modules: Vec<Module> = (token_files.iter())
        .map(|file| module_of(words, file, &mut faults))
        .collect();
    let symbols = symbols_of(&token_files, &modules, &mut faults);
    Ok(with(&token_files, &symbols, faults))
}

/// Reads all that can be read of programs.
fn parse_blocks<D: BlockDialect>(files: Vec<SourceFile>, options: &ReadOptions) -> Parsed {
    let read = with_program(&files, D::WORDS, |token_files, symbols, mut faults| {
        let mut run = Run::new(token_files, symbols, options, D::before()).whole();
        refuse_moving_threads(&mut run);
        faults.extend(run.faults);
        Read {
            motions: run.motions,
            declarations: run.targets.declarations,
            findings: run.findings,
            outside_calls: run.outside_calls,
            ran: run.ran_beside,
            faults,
            external_axes_may_move: false,
            moving_calls: &options.moving_calls,
        }
    });
    match read {
        Ok(read) => Parsed::of_robot(D::LANGUAGE, files, read),
        Err(faults) => Parsed::refused(D::LANGUAGE, faults),
    }
}

/// Runs a program once and writes it flat.
fn expand_blocks<D: BlockDialect>(
    files: &[SourceFile],
    options: &ReadOptions,
) -> Result<FlatText, Vec<ProgramError>> {
    with_program(files, D::WORDS, |token_files, symbols, faults| {
        let run = Run::new(token_files, symbols, options, D::before());
        flat_of(run, files, faults)
    })?
}

/// A thread runs beside the program: where it moves the tool, nobody knows when.
fn refuse_moving_threads<D: Dialect>(run: &mut Run<'_, '_, D>) {
    for (index, home) in run.symbols.routines.iter().enumerate() {
        if home.routine.kind == RoutineKind::Trap && run.routine_acts(index) {
            let file = &run.files[home.file];
            let span = file.span(&(home.routine.name_at..home.routine.name_at + 1));
            let reason = "the thread moves the tool, or sets its frame, beside the program";
            let remedy = "move the tool in the program itself, or take the thread out";
            let fault = ProgramError::at(file.source, span, reason, remedy);
            run.faults.push(fault);
        }
    }
}
