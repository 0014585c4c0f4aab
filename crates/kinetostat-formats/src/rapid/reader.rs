//! The reader of RAPID modules.

use crate::error::ProgramError;
use crate::model::language::Language;
use crate::model::parsed::{Parsed, Read};
use crate::model::program::RobotProgram;
use crate::options::{ExternalAxes, ReadOptions};
use crate::rapid::frames::Values;
use crate::rapid::lex::tokens_of;
use crate::rapid::parser::modules::modules_of;
use crate::rapid::symbols::Symbols;
use crate::rapid::targets::Targets;
use crate::rapid::tree::{Module, TokenFile};
use crate::rapid::usage::note_usage;
use crate::rapid::walk::walk;
use crate::text::source::SourceFile;

/// Most bytes of a file; the memory needed is some twenty times as much.
const MOST_BYTES: usize = 1 << 26;

/// Reads RAPID modules (`.mod`, `.modx`, `.prg`, `.sys`) together: those that run together, with the data they use.
///
/// Motions in branches, loops and routines that are called more than once are taken where target, tool, work object and
/// speed are the same at each run; [`crate::Motion::runs`] says so. What a displacement, a search, a sensor, a moving work
/// object or a target computed at run time decides is refused, as are external axes that move unless the options carry them.
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
    let token_files: Vec<TokenFile<'_>> = (files.iter().enumerate())
        .map(|(index, source)| TokenFile {
            index,
            source,
            tokens: tokens_of(source.bytes()),
        })
        .collect();
    let mut modules: Vec<(usize, Module)> = Vec::new();
    for file in &token_files {
        let found = modules_of(file, &mut faults);
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
    let mut symbols = Symbols::of(&token_files, &modules, &mut faults);
    note_usage(&token_files, &mut symbols);
    let mut values = Values::new(&token_files, symbols, options);
    let mut targets = Targets::default();
    let walked = walk(&mut values, &mut targets, options, &mut faults);
    let read = Read {
        motions: walked.motions,
        declarations: targets.declarations,
        findings: [targets.findings, walked.findings].concat(),
        outside_calls: walked.outside_calls,
        faults,
        external_axes_may_move: options.external_axes != ExternalAxes::Refused,
    };
    Parsed::of_robot(Language::Rapid, files, read)
}
