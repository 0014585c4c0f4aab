//! The reader of VAL3 applications.

use std::collections::BTreeSet;

use crate::error::ProgramError;
use crate::interpreter::flat::flat_of;
use crate::interpreter::symbols::Symbols;
use crate::interpreter::token::TokenFile;
use crate::interpreter::tree::{DatumNode, Routine};
use crate::model::Language;
use crate::model::parsed::{Parsed, Read};
use crate::model::program::RobotProgram;
use crate::options::ReadOptions;
use crate::text::Name;
use crate::text::source::{Finding, FlatText, SourceFile};
use crate::val3::frames::Val3;
use crate::val3::parser::routine_of;
use crate::val3::xml::content_of;

const MOST_BYTES: usize = 1 << 26;

/// Files of an application: their tokens, and what each declares.
struct Application<'a> {
    files: Vec<TokenFile<'a>>,
    contents: Vec<(Vec<DatumNode>, Vec<Routine>)>,
    says_millimetres: bool,
}

/// Reads VAL3 programs (`.pgx`) with the data of their application (`.dtx`) together; they begin with `start`, or with the program of the
/// first file.
///
/// The program is run as the controller runs it. Points are in the frames of their fathers; a frame that is changed while the program runs
/// by an instruction (`setFrame`, `link`) is refused, as are tasks that move the tool. The speed of a motion is the limit `tvel` of its
/// description in mm/s; without one it is not known, as `vel` is percent of the speeds of joints.
///
/// # Errors
/// All that is refused, in the order of files and lines.
pub fn read_val3(
    files: Vec<SourceFile>,
    options: &ReadOptions,
) -> Result<RobotProgram, Vec<ProgramError>> {
    parse_val3(files, options).without_faults()
}

/// Reads all that can be read of VAL3 programs.
pub(crate) fn parse_val3(files: Vec<SourceFile>, options: &ReadOptions) -> Parsed {
    let large = |file: &SourceFile| ProgramError::too_large(file, MOST_BYTES);
    let mut faults: Vec<ProgramError> = files.iter().filter_map(large).collect();
    if !faults.is_empty() {
        return Parsed::refused(Language::Val3, faults);
    }
    let application = Application::of(&files, &mut faults);
    let symbols = application.symbols(&mut faults);
    let run = Val3::run(&application.files, &symbols, options).whole();
    faults.extend(run.faults);
    let mut findings = run.findings;
    if !application.says_millimetres {
        let message =
            "lengths are taken to be in mm: the project (.pjx) that says their unit is not given"
                .to_owned();
        findings.push(Finding {
            file: 0,
            line: 1,
            message,
        });
    }
    let is_world = |name: &String| name.eq_ignore_ascii_case("world");
    if let (Some(first), false) = (run.motions.first(), options.frames.keys().any(is_world)) {
        let message = "`world` is taken as the base of the model; that of an arm of Staubli may lie where its axes 1 and 2 meet: state `world` under [robot.frames] where it is another frame".to_owned();
        let (file, line) = (first.file, first.line);
        findings.push(Finding {
            file,
            line,
            message,
        });
    }
    let read = Read {
        motions: run.motions,
        declarations: run.targets.declarations,
        findings,
        outside_calls: run.outside_calls,
        ran: run.ran_beside,
        faults,
        external_axes_may_move: true,
        moving_calls: &options.moving_calls,
    };
    Parsed::of_robot(Language::Val3, files, read)
}

/// Runs a program once and writes it flat: the statements of its run in place of those of its first program; data stay beside it.
pub(crate) fn expand_val3(
    files: &[SourceFile],
    options: &ReadOptions,
) -> Result<FlatText, Vec<ProgramError>> {
    let mut faults = Vec::new();
    let application = Application::of(files, &mut faults);
    let symbols = application.symbols(&mut faults);
    flat_of(
        Val3::run(&application.files, &symbols, options),
        files,
        faults,
    )
}

impl<'a> Application<'a> {
    fn of(files: &'a [SourceFile], faults: &mut Vec<ProgramError>) -> Self {
        let mut scalars = BTreeSet::new();
        // Programs use the names of data: those are read first.
        let mut order: Vec<(usize, &SourceFile)> = files.iter().enumerate().collect();
        order.sort_by_key(|(_, file)| is_program(file));
        let contents = order
            .into_iter()
            .map(|(index, file)| content_of(index, file, &mut scalars, faults));
        let mut contents: Vec<_> = contents.collect();
        contents.sort_by_key(|content| content.file.index);
        let mut own = Self {
            files: Vec::new(),
            contents: Vec::new(),
            says_millimetres: false,
        };
        for content in contents {
            let drafts = content.drafts.into_iter();
            let routines = drafts
                .map(|draft| routine_of(&content.file, draft, faults))
                .collect();
            own.files.push(content.file);
            own.contents.push((content.data, routines));
            own.says_millimetres |= content.says_millimetres;
        }
        own
    }

    /// The names of all files; the run begins with `start`, or with the first program.
    fn symbols<'p>(&'p self, faults: &mut Vec<ProgramError>) -> Symbols<'p> {
        let mut all = Symbols::default();
        for (file, (data, routines)) in self.files.iter().zip(&self.contents) {
            let module = all.add_module(file.index, None);
            data.iter()
                .for_each(|node| all.add_datum(file, module, node, faults));
            routines
                .iter()
                .for_each(|routine| all.add_routine(file, module, routine, faults));
        }
        let start = Name::of(b"start").and_then(|name| all.routine_everywhere(&name));
        all.main = start.or((!all.routines.is_empty()).then_some(0));
        if all.main.is_none() && faults.is_empty() {
            let [reason, remedy] = <Val3 as crate::interpreter::run::Dialect>::NO_MAIN;
            faults.extend(
                self.files
                    .first()
                    .map(|file| ProgramError::at(file.source, 0..0, reason, remedy)),
            );
        }
        all
    }
}

/// True for a file of programs; others hold data.
pub(crate) fn is_program(file: &SourceFile) -> bool {
    file.name().to_ascii_lowercase().ends_with(".pgx")
}

/// Place below the line of `begin` of the first program.
pub(crate) fn below_begin(program: &[u8]) -> Option<usize> {
    let file = SourceFile::new("", program);
    let content = content_of(0, &file, &mut BTreeSet::new(), &mut Vec::new());
    let begin = content.drafts.first()?.code.start;
    Some(file.start_of(content.file.line_of(begin) + 1))
}

/// Names of files of programs that a file calls.
pub(crate) fn called_by(file: &SourceFile) -> Vec<String> {
    let content = content_of(0, file, &mut BTreeSet::new(), &mut Vec::new()).file;
    let calls = (0..content.tokens.len()).filter(|at| content.is_word(*at, "CALL"));
    calls
        .map(|at| format!("{}.pgx", content.text(&(at + 1..at + 2))))
        .collect()
}
