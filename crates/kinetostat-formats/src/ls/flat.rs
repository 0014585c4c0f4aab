//! A TP program that was run once and written flat: the lines of its run one after the other, in place of those of its file.
//!
//! Registers get the same values in the same order, so that lines stay as they are. Counters of loops are assigned, arguments of
//! calls are put in as values, and positions of called programs follow those of the first one.

use std::ops::Range;

use crate::error::ProgramError;
use crate::flat_run::{Written, not_flat};
use crate::interpreter::value::{Datum, Value};
use crate::ls::expression::indices_of;
use crate::ls::lines::{Kind, Layout, index_of, words_of};
use crate::ls::positions::Positions;
use crate::ls::reader::{parse_ls, with_run};
use crate::ls::run::{FlatLines, Run};
use crate::ls::step::{Step, comma_in};
use crate::ls::write::numbered;
use crate::model::motion::Motion;
use crate::options::ReadOptions;
use crate::text::Name;
use crate::text::source::{Edits, FlatText, SourceFile, next_line};

impl Run<'_, '_> {
    /// Writes a line that ran, without the condition on which it ran.
    pub(super) fn write_action(&mut self, at: usize) {
        let program = self.program();
        let line = self.all.layouts[program].lines[at].text.clone();
        let mut step = &self.all.programs[program].steps[at];
        let mut from = line.start;
        while let Step::Perhaps(_) | Step::Case(_) = step {
            let comma = comma_in(self.file().bytes(), &(from..line.end));
            from = comma.map_or(from, |comma| comma + 1);
            step = match step {
                Step::Perhaps(own) => &own.1,
                Step::Case(own) => &own.action,
                _ => break,
            };
        }
        self.write_part(at, from..line.end);
    }

    /// Writes a line as it stands.
    pub(super) fn write_whole(&mut self, at: usize) {
        let line = self.all.layouts[self.program()].lines[at].text.clone();
        self.write_part(at, line);
    }

    /// Writes the value that a counter gets.
    pub(super) fn write_counter(&mut self, at: usize, counter: &Name, value: f64) {
        let (program, line) = (self.program(), self.line(at));
        if let Some(flat) = &mut self.flat {
            flat.is_changed = true;
            let text = [counter.letters(), b"=", printed(value).as_bytes(), b" "].concat();
            flat.line(&text, program, line);
        }
    }

    fn write_part(&mut self, at: usize, part: Range<usize>) {
        if self.flat.is_none() {
            return;
        }
        let program = self.program();
        let (file, number) = (self.file(), self.line(at));
        let mut edits = Edits::default();
        let is_remark = file.part(&part).trim_ascii_start().starts_with(b"!");
        if program > 0 && !is_remark {
            self.put_positions(at, &part, &mut edits);
            self.put_arguments(at, &part, &mut edits);
        }
        let text = edits.applied_to_part(file.bytes(), &part);
        let line = &self.all.layouts[program].lines[at];
        let Some(flat) = &mut self.flat else {
            return;
        };
        flat.is_changed |= program > 0 || at != flat.count || part != line.text;
        flat.count += 1;
        flat.line(&text.unwrap_or_default(), program, number);
    }

    /// Puts the values of arguments in place of `AR[1]`.
    fn put_arguments(&mut self, at: usize, part: &Range<usize>, edits: &mut Edits) {
        let file = self.file();
        let mut from = part.start;
        while let Some(found) =
            (file.bytes()[from..part.end].windows(3)).position(|of| of == b"AR[")
        {
            let start = from + found;
            from = start + 3;
            let close = file.bytes()[from..part.end]
                .iter()
                .position(|byte| *byte == b']');
            let end = close.map_or(part.end, |close| from + close + 1);
            let number = index_of(file.bytes(), &(start + 2..end)).map(|(number, _)| number);
            let arguments = self.calls.last().map(|called| called.arguments.as_slice());
            let value = number.and_then(|number| arguments?.get(number.checked_sub(1)? as usize));
            let text = match value.map(|value| &value.value) {
                Some(Value::Text(text)) => Some(format!("'{text}'")),
                _ => value.and_then(Datum::as_number).map(printed),
            };
            match text {
                _ if edits.touches(&(start..from)) => {}
                Some(text) => edits.replace(start..end, text),
                None => self.not_flat(at, "an argument of its call has no value that is known"),
            }
        }
    }

    /// Puts new numbers in place of those of positions of a called program.
    fn put_positions(&mut self, at: usize, part: &Range<usize>, edits: &mut Edits) {
        let bytes = self.file().bytes();
        for pair in words_of(bytes, part).windows(2) {
            let bracket = &pair[1].span;
            if bytes[pair[0].span.clone()] != *b"P" || pair[1].kind != Kind::Bracket {
                continue;
            }
            let index = indices_of(bytes, bracket).and_then(|all| all.into_iter().next());
            match index.and_then(|index| self.index(&index)) {
                Some(number) => {
                    let new = self.new_number(number);
                    edits.replace(bracket.clone(), format!("[{new}]"));
                }
                None => self.not_flat(at, "which position it uses is not known"),
            }
        }
    }

    /// The number in the first program of a position of the program that runs.
    fn new_number(&mut self, number: u32) -> u32 {
        let program = self.program();
        let last = self.all.positions[0].all.keys().next_back();
        let last = last.copied().unwrap_or(0);
        let Some(flat) = &mut self.flat else {
            return number;
        };
        let count = flat.positions.len() as u32;
        *flat
            .positions
            .entry((program, number))
            .or_insert(last + 1 + count)
    }

    pub(super) fn not_flat(&mut self, at: usize, why: &str) {
        if self.flat.is_some() {
            let (reason, remedy) = not_flat(why);
            self.fault(at, reason, remedy);
        }
    }
}

/// A number as a statement has it.
fn printed(value: f64) -> String {
    match value < 0.0 {
        true => format!("({value})"),
        false => format!("{value}"),
    }
}

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
