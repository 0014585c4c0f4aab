//! The flat file of a TP program.

use crate::error::ProgramError;
use crate::flat_run::{Written, not_flat};
use crate::ls::flat_lines::FlatLines;
use crate::ls::lines::{Layout, next_line};
use crate::ls::positions::Positions;
use crate::ls::reader::{parse_ls, with_run};
use crate::ls::write::numbered;
use crate::model::motion::Motion;
use crate::options::ReadOptions;
use crate::text::flat::FlatText;
use crate::text::source::SourceFile;

/// Runs a program once and writes it flat: its loops, branches and jumps as they ran, and the programs that it calls.
///
/// # Errors
/// All that is refused, and what cannot be said by lines alone: the flat program is read again, and must have the same motions.
pub(crate) fn expand_ls(
    files: &[SourceFile],
    options: &ReadOptions,
) -> Result<FlatText, Vec<ProgramError>> {
    let Some(file) = files.first() else {
        return Ok(FlatText::unchanged(&SourceFile::new("", ""), 0));
    };
    let (flat, motions) = with_run(files, options, |mut run| {
        run.flat = Some(FlatLines {
            written: Written::new(file),
            ..FlatLines::default()
        });
        let mut run = run.whole();
        let called = run.called_by_name();
        for program in (1..files.len()).filter(|program| !called.contains(program)) {
            let (reason, _) = not_flat("no other program calls this one");
            (run.reader).fault(&files[program], 0..0, reason, "give it by itself");
        }
        if !run.reader.faults.is_empty() {
            return Err(run.reader.faults);
        }
        let lines = run.flat.take().unwrap_or_default();
        let (layout, positions) = (&run.all.layouts[0], run.all.positions);
        let flat = match !lines.is_changed && lines.count == layout.lines.len() {
            true => FlatText::unchanged(file, 0),
            false => FlatText {
                findings: run.reader.findings,
                ..with_lines(lines, files, layout, positions)?
            },
        };
        Ok((flat, run.motions))
    })?;
    match flat.changed {
        true => same_motions(file, &flat, &motions, options).map(|()| flat),
        false => Ok(flat),
    }
}

/// The first program with the flat lines in place of its own, and the positions of called programs behind its own.
fn with_lines(
    lines: FlatLines,
    files: &[SourceFile],
    layout: &Layout,
    positions: &[Positions],
) -> Result<FlatText, Vec<ProgramError>> {
    let (file, bytes) = (&files[0], files[0].bytes());
    let (Some(first), Some(last), Some(section)) =
        (layout.lines.first(), layout.lines.last(), &layout.positions)
    else {
        return Err(refused(file, "it has no lines, or no section /POS"));
    };
    let (begin, end) = (
        file.start_of(file.line_of(first.whole.start)),
        next_line(bytes, last.whole.end),
    );
    if section.end < end {
        return Err(refused(file, "its section /POS stands before its lines"));
    }
    let mut out = Written::new(file);
    out.copy(file, 0, &(0..begin));
    out.bytes.extend_from_slice(&lines.written.bytes);
    out.origins.extend(lines.written.origins);
    out.copy(file, 0, &(end..section.end));
    for ((program, number), new) in lines.positions {
        let source = &files[program];
        let Some(position) = positions[program].all.get(&number) else {
            continue;
        };
        let text = source.part(&position.span);
        let digits = text
            .iter()
            .skip(2)
            .take_while(|byte| byte.is_ascii_digit())
            .count();
        let text = [b"P[", new.to_string().as_bytes(), &text[2 + digits..]].concat();
        out.line(&text, program, source.line_of(position.span.start));
    }
    out.copy(file, 0, &(section.end..bytes.len()));
    let now = Layout::of(&out.bytes);
    let added = now.lines.len() as f64 - layout.lines.len() as f64;
    let bytes = numbered(&out.bytes, &now, added);
    Ok(FlatText {
        changed: true,
        file: SourceFile::new(file.name(), bytes.unwrap_or(out.bytes)),
        origins: out.origins,
        findings: Vec::new(),
    })
}

/// Reads the flat program again: it must have the motions of the run.
fn same_motions(
    file: &SourceFile,
    flat: &FlatText,
    motions: &[Motion],
    options: &ReadOptions,
) -> Result<(), Vec<ProgramError>> {
    let read = parse_ls(vec![flat.file.clone()], options).without_faults();
    let said = |motion: &Motion| {
        let frames = (motion.tool.name.clone(), motion.work_object.name.clone());
        (
            motion.kind.clone(),
            motion.target.clone(),
            motion.zone,
            motion.speed.mm_per_s,
            frames,
        )
    };
    let why = match read {
        Ok(again) if again.motions.iter().map(said).eq(motions.iter().map(said)) => return Ok(()),
        Ok(_) => "its lines alone do not have the same motions".to_owned(),
        Err(faults) => faults
            .first()
            .map_or_else(String::new, |fault| fault.reason.clone()),
    };
    Err(refused(file, &why))
}

fn refused(file: &SourceFile, why: &str) -> Vec<ProgramError> {
    let (reason, remedy) = not_flat(why);
    vec![ProgramError::at(file, 0..0, reason, remedy)]
}
