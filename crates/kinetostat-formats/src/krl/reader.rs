//! The reader of KRL programs.

use crate::error::ProgramError;
use crate::interpreter::flat::flat_of;
use crate::interpreter::token::TokenFile;
use crate::krl::folds::not_paired;
use crate::krl::lex::token_file;
use crate::krl::names::{complete, symbols_of};
use crate::krl::parser::cursor::Content;
use crate::krl::parser::routines::content_of;
use crate::krl::state::Krl;
use crate::model::language::Language;
use crate::model::parsed::{Parsed, Read};
use crate::model::program::RobotProgram;
use crate::options::{ExternalAxes, ReadOptions};
use crate::text::finding::Finding;
use crate::text::flat::FlatText;
use crate::text::source::SourceFile;

/// Limit of the bytes of a file; the memory needed is some forty times as much.
const MOST_BYTES: usize = 1 << 28;

/// Reads KRL programs (`.src`) with their data (`.dat`) together; `$config.dat` for tools, bases and home positions if given.
///
/// Files of one name are one module. The program begins with the first routine of the first `.src` file that no other
/// calls. Bases and tools that neither the statements nor the data say are those that [`ReadOptions::frames`] states as
/// `BASE_DATA[1]`, `TOOL_DATA[1]`, or `$BASE` and `$TOOL` for where nothing sets them. Splines through points (SPL), joint splines, motions of
/// sensors and ends computed at run time are refused, as are external axes that move unless the options carry them. The text of
/// FOLDs is carried and never trusted; where it contradicts its statements a finding says so.
///
/// ```
/// use kinetostat_formats::{MotionKind, ReadOptions, SourceFile, Zone, read_krl};
///
/// let source = "DEF groove()\nBAS(#INITMOV,0)\n$BASE=BASE_DATA[1]\n$TOOL={X 0,Y 0,Z 150,A 0,B 0,C 0}\n\
///     $VEL.CP=0.02\n$APO.CDIS=1\nPTP start:{X 0,Y 0,Z -50,A 0,B 0,C 0} ; above\nLIN Start C_DIS\nEND\n";
/// let data = "DEFDAT groove\nDECL E6POS START={X 100,Y 0,Z 0,A 0,B 0,C 180,S 2,T 35}\nENDDAT\n";
/// let files = vec![SourceFile::new("groove.src", source), SourceFile::new("groove.dat", data)];
/// let program = read_krl(files, &ReadOptions::default()).unwrap();
/// assert_eq!(program.motions.len(), 2);
/// let motion = &program.motions[1];
/// assert_eq!((&motion.kind, motion.zone, motion.follows), (&MotionKind::Linear, Zone::Radius(1.0), Some(0)));
/// assert_eq!(motion.speed.mm_per_s, Some(20.0));
/// assert_eq!(motion.tool.known().unwrap().translation.z, 150.0);
/// // A sum is in the axes of what is added to: this tool points down.
/// assert!((program.motions[0].target.pose().unwrap().position_mm.z - 50.0).abs() < 1e-9);
/// ```
///
/// # Errors
/// All that is refused, in the order of files and lines.
pub fn read_krl(
    files: Vec<SourceFile>,
    options: &ReadOptions,
) -> Result<RobotProgram, Vec<ProgramError>> {
    parse_krl(files, options).without_faults()
}

/// Reads all that can be read of KRL programs.
pub(crate) fn parse_krl(files: Vec<SourceFile>, options: &ReadOptions) -> Parsed {
    let large = |file: &SourceFile| ProgramError::too_large(file, MOST_BYTES);
    let mut faults: Vec<ProgramError> = files.iter().filter_map(large).collect();
    if !faults.is_empty() {
        return Parsed::refused(Language::Krl, faults);
    }
    let token_files = token_files(&files);
    let contents = contents_of(&token_files, &mut faults);
    let symbols = symbols_of(&token_files, &contents, &mut faults);
    let run = Krl::run(&token_files, &symbols, options).whole();
    faults.extend(run.faults);
    let mut findings = run.findings;
    for file in &token_files {
        findings.extend(not_paired(file).into_iter().map(|(line, what)| Finding {
            file: file.index,
            line,
            message: format!(
                "{what}: it is carried, but the pendant shows other FOLDs than are meant"
            ),
        }));
    }
    let read = Read {
        motions: run.motions,
        declarations: run.targets.declarations,
        findings,
        outside_calls: run.outside_calls,
        ran: run.ran_beside,
        faults,
        external_axes_may_move: options.external_axes != ExternalAxes::Refused,
        moving_calls: &options.moving_calls,
    };
    let mut parsed = Parsed::of_robot(Language::Krl, files, read);
    parsed.program.values = options.values.clone();
    parsed
}

/// Runs a program once and writes it flat: the statements of its run, one after the other, in place of those of its first routine. Data lists
/// stay beside it.
pub(crate) fn expand_krl(
    files: &[SourceFile],
    options: &ReadOptions,
) -> Result<FlatText, Vec<ProgramError>> {
    let mut faults = Vec::new();
    let token_files = token_files(files);
    let contents = contents_of(&token_files, &mut faults);
    let symbols = symbols_of(&token_files, &contents, &mut faults);
    flat_of(Krl::run(&token_files, &symbols, options), files, faults)
}

/// True for a file that holds no routine.
pub(crate) fn is_data_list(file: &SourceFile) -> bool {
    let tokens = token_file(0, file);
    content_of(&tokens, &mut Vec::new()).routines.is_empty()
}

fn token_files(files: &[SourceFile]) -> Vec<TokenFile<'_>> {
    let all = files.iter().enumerate();
    all.map(|(index, source)| token_file(index, source))
        .collect()
}

/// Parses each file.
fn contents_of(files: &[TokenFile<'_>], faults: &mut Vec<ProgramError>) -> Vec<Content> {
    let mut contents: Vec<Content> = Vec::with_capacity(files.len());
    for file in files {
        let before = faults.len();
        let content = content_of(file, faults);
        if content.routines.is_empty() && content.list.is_none() && faults.len() == before {
            faults.push(ProgramError::at(
                file.source,
                0..0,
                "there is no DEF and no DEFDAT in the file",
                "give a .src or .dat file as the controller saves it",
            ));
        }
        contents.push(content);
    }
    complete(files, &mut contents);
    contents
}
