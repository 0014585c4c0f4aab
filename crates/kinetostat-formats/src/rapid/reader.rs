//! The reader of RAPID modules.

use std::collections::BTreeSet;

use crate::error::ProgramError;
use crate::model::external::moving_axis;
use crate::model::frame::{Frame, FrameUse};
use crate::model::motion::{Motion, MotionKind};
use crate::model::program::{Finding, Language, RobotProgram};
use crate::model::target::Target;
use crate::options::{ExternalAxes, ReadOptions};
use crate::rapid::frames::Values;
use crate::rapid::lex::tokens_of;
use crate::rapid::motion::Followed;
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
    let mut faults = Vec::new();
    for file in files.iter().filter(|file| file.bytes().len() > MOST_BYTES) {
        faults.push(ProgramError::at(
            file,
            0..0,
            "the file is larger than 64 MiB",
            "divide it",
        ));
    }
    if !faults.is_empty() {
        return Err(faults);
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
    if options.external_axes == ExternalAxes::Refused {
        faults.extend(moving_axis(
            &files,
            walked.motions.iter().map(external),
            |axis| format!("eax_{}", char::from(b'a' + axis as u8)),
        ));
    }
    let order: Vec<&str> = files.iter().map(SourceFile::name).collect();
    if !faults.is_empty() {
        let place = |fault: &ProgramError| {
            let file = order.iter().position(|name| *name == fault.file);
            (file, fault.span.start, fault.line)
        };
        faults.sort_by_key(place);
        return Err(faults);
    }
    let motions: Vec<_> = walked
        .motions
        .into_iter()
        .map(|followed| followed.motion)
        .collect();
    let mut findings = [targets.findings, walked.findings].concat();
    let mut named = BTreeSet::new();
    for motion in &motions {
        let (file, line) = (motion.file, motion.line);
        let via = match &motion.kind {
            MotionKind::Circular { via } => Some(via),
            MotionKind::Joint | MotionKind::Linear | MotionKind::Arc { .. } => None,
        };
        for target in via.into_iter().chain([&motion.target]) {
            if let Target::Unknown { reason } = target {
                let message = format!("it stays as it is written: {reason}");
                findings.push(Finding {
                    file,
                    line,
                    message,
                });
            }
        }
        let frames = [&motion.tool, &motion.work_object];
        for FrameUse { name, frame } in frames {
            if let Frame::Unknown { reason } = frame
                && named.insert(name)
            {
                let message = format!("where `{name}` is, is not known: {reason}");
                findings.push(Finding {
                    file,
                    line,
                    message,
                });
            }
        }
    }
    drop(named);
    findings.sort_by_key(|finding| (finding.file, finding.line));
    Ok(RobotProgram {
        language: Language::Rapid,
        files,
        motions,
        findings,
        declarations: targets.declarations,
        rotary: crate::model::stated_axes::StatedAxes::default(),
    })
}

/// A motion with its external axes.
fn external(followed: &Followed) -> (&Motion, &[Option<f64>]) {
    let all = followed.external.as_slice();
    (&followed.motion, &all[..all.len().min(6)])
}
