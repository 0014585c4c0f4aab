//! The reader of RAPID modules.

use crate::error::ProgramError;
use crate::interpreter::flat::flat_of;
use crate::interpreter::symbols::Symbols;
use crate::interpreter::token::TokenFile;
use crate::interpreter::tree::{LoopKind, Module, Statement};
use crate::model::Language;
use crate::model::parsed::{Parsed, Read};
use crate::model::program::RobotProgram;
use crate::options::{ExternalAxes, ReadOptions};
use crate::rapid::lex::tokens_of;
use crate::rapid::parser::modules::modules_of;
use crate::rapid::state::Rapid;
use crate::text::Name;
use crate::text::source::{FlatText, SourceFile};

/// Limit of the bytes of a file; the memory needed is some twenty times as much.
const MOST_BYTES: usize = 1 << 26;

/// Reads RAPID modules (`.mod`, `.modx`, `.prg`, `.sys`) together: those that run together, with the data they use.
///
/// The program is run as the controller runs it: loops, branches and calls with the values that the files state. A statement that runs
/// several times gives as many motions; [`crate::Motion::runs`] says so. A branch on a value that only the controller knows is passed
/// over where its arms neither move the tool nor change modal state, and refused with its line otherwise. Displacements, searches,
/// sensors, moving work objects and targets that only the controller knows are refused, as are external axes that move unless the
/// options carry them.
///
/// ```
/// use kinetostat_formats::{MotionKind, ReadOptions, SourceFile, Zone, read_rapid};
///
/// let text = r#"MODULE Groove
///   PERS tooldata mill:=[TRUE,[[0,0,150],[1,0,0,0]],[2,[0,0,50],[1,0,0,0],0,0,0]];
///   CONST robtarget start:=[[100,0,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
///   PROC main()
///     MoveJ Offs(start,0,0,50), v500, z10, mill;  ! above
///     MoveL start, v20, fine, mill;
///   ENDPROC
/// ENDMODULE"#;
/// let files = vec![SourceFile::new("Groove.mod", text)];
/// let program = read_rapid(files, &ReadOptions::default()).unwrap();
/// assert_eq!(program.motions.len(), 2);
/// let motion = &program.motions[1];
/// assert_eq!((&motion.kind, motion.zone, motion.follows), (&MotionKind::Linear, Zone::Exact, Some(0)));
/// assert_eq!(motion.tool.known().unwrap().translation.z, 150.0);
/// ```
///
/// # Errors
/// All that is refused, in the order of files and lines.
pub fn read_rapid(
    files: Vec<SourceFile>,
    options: &ReadOptions,
) -> Result<RobotProgram, Vec<ProgramError>> {
    parse_rapid(files, options).without_faults()
}

/// Reads all that can be read of RAPID modules.
pub(crate) fn parse_rapid(files: Vec<SourceFile>, options: &ReadOptions) -> Parsed {
    let large = |file: &SourceFile| ProgramError::too_large(file, MOST_BYTES);
    let mut faults: Vec<ProgramError> = files.iter().filter_map(large).collect();
    if !faults.is_empty() {
        return Parsed::refused(Language::Rapid, faults);
    }
    let token_files = tokens_of_files(&files);
    let modules = modules_of_files(&token_files, &mut faults);
    let symbols = symbols_of(&token_files, &modules, &mut faults);
    let run = Rapid::run(&token_files, &symbols, options).whole();
    faults.extend(run.faults);
    let read = Read {
        motions: run.motions,
        declarations: run.targets.declarations,
        findings: run.findings,
        outside_calls: run.outside_calls,
        ran: run.ran_beside,
        faults,
        external_axes_may_move: options.external_axes != ExternalAxes::Refused,
        moving_calls: &options.moving_calls,
    };
    Parsed::of_robot(Language::Rapid, files, read)
}

/// Runs a program once and writes it flat: the statements of its run, one after the other, in place of those of `main`.
pub(crate) fn expand_rapid(
    files: &[SourceFile],
    options: &ReadOptions,
) -> Result<FlatText, Vec<ProgramError>> {
    let token_files = tokens_of_files(files);
    let mut faults = Vec::new();
    let modules = modules_of_files(&token_files, &mut faults);
    let symbols = symbols_of(&token_files, &modules, &mut faults);
    flat_of(Rapid::run(&token_files, &symbols, options), files, faults)
}

/// Tokens of files.
pub(super) fn tokens_of_files(files: &[SourceFile]) -> Vec<TokenFile<'_>> {
    let all = files.iter().enumerate().map(|(index, source)| TokenFile {
        index,
        source,
        tokens: tokens_of(source.bytes()),
        lines: Vec::new(),
    });
    all.collect()
}

/// Modules of files, each with the index of its file.
pub(super) fn modules_of_files(
    files: &[TokenFile<'_>],
    faults: &mut Vec<ProgramError>,
) -> Vec<(usize, Module)> {
    let mut modules = Vec::new();
    for file in files {
        let found = modules_of(file, faults);
        if found.is_empty() && faults.is_empty() {
            faults.push(ProgramError::at(
                file.source,
                0..0,
                "there is no MODULE in the file",
                "give a RAPID module as the controller saves it",
            ));
        }
        modules.extend(found.into_iter().map(|module| (file.index, module)));
    }
    modules
}

/// The names of the modules of each file.
fn symbols_of<'p>(
    files: &[TokenFile<'_>],
    modules: &'p [(usize, Module)],
    faults: &mut Vec<ProgramError>,
) -> Symbols<'p> {
    let mut all = Symbols::default();
    for (file, content) in modules {
        let file = &files[*file];
        let module = all.add_module(file.index, None);
        for node in &content.data {
            all.add_datum(file, module, node, faults);
        }
        for routine in &content.routines {
            all.add_routine(file, module, routine, faults);
            let index = all.routines.len() - 1;
            for block in [&routine.body, &routine.handlers] {
                add_loop_variables(file, block, index, &mut all);
            }
        }
    }
    all.main = Name::of(b"main").and_then(|name| all.routine_everywhere(&name));
    all
}

/// Adds the variables of loops (`FOR i FROM`): each is one of its routine.
fn add_loop_variables(
    file: &TokenFile<'_>,
    block: &[Statement],
    routine: usize,
    all: &mut Symbols<'_>,
) {
    for statement in block {
        match statement {
            Statement::Loop {
                kind,
                header,
                block,
                ..
            } => {
                let name = Name::of(file.word(header.start));
                if let (LoopKind::Counting, Some(name)) = (kind, name) {
                    all.add_local(routine, name);
                }
                add_loop_variables(file, block, routine, all);
            }
            Statement::Branches { blocks, .. } => {
                for block in blocks {
                    add_loop_variables(file, block, routine, all);
                }
            }
            _ => {}
        }
    }
}
