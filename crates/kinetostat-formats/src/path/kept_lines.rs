//! Lines of a written program that hold nothing of a motion: there as they were, in their order. FOLDs of KRL show the points of
//! their motions; where a motion has got a point of its own, its name alone may have changed, and must have.

use std::collections::BTreeMap;

use kinetostat_program::{Corrected, WriteError};

use crate::interpreter::token::TokenFile;
use crate::krl::lex::{folds_of, token_file};
use crate::model::Language;
use crate::model::motion::Motion;
use crate::model::program::RobotProgram;
use crate::model::site::TargetSite;
use crate::path::broken;
use crate::path::of_program::RobotPath;

/// A program with its path.
#[derive(Clone, Copy)]
pub(crate) struct ReadProgram<'a> {
    pub program: &'a RobotProgram,
    pub path: &'a RobotPath,
}

/// A point and the one that it has become, as the pendant shows them: `P1` and `P1_2`.
type Renamed<'a> = (&'a [u8], &'a [u8]);

pub(super) fn lines(bytes: &[u8]) -> impl Iterator<Item = &[u8]> {
    bytes
        .split(|byte| *byte == b'\n')
        .map(|line| line.strip_suffix(b"\r").unwrap_or(line))
}

/// Looks for every line of the program in what was written.
pub(super) fn kept_lines(
    input: ReadProgram<'_>,
    again: ReadProgram<'_>,
    written: &Corrected,
) -> Result<(), WriteError> {
    let program = input.program;
    let renamed = match program.language {
        Language::Krl => renamed_lines(input, again, written),
        _ => BTreeMap::new(),
    };
    let mut beside = written.beside.iter();
    for (index, file) in program.files.iter().enumerate() {
        let output: &[u8] = match index == input.path.file {
            true => &written.bytes,
            false => beside.next().map_or(&[], |(_, bytes)| bytes),
        };
        let touched = program.lines_of_targets(index);
        let mut output = lines(output).enumerate();
        for (number, line) in lines(file.bytes()).enumerate() {
            if touched.contains(&(number + 1)) {
                continue;
            }
            let names = renamed.get(&(index, number + 1));
            let wanted = program.language.behind_number(line);
            let is_there = |(_, written): (usize, &[u8])| match names {
                Some(names) => only_names_changed(line, written, names),
                None => program.language.behind_number(written) == wanted,
            };
            if !output.any(is_there) {
                let with = match names {
                    Some(_) => " with the name of its point",
                    None => "",
                };
                return Err(broken(
                    number + 1,
                    0,
                    format!("line {} of {} is not there{with}", number + 1, file.name()),
                ));
            }
        }
    }
    Ok(())
}

/// Lines (by file, counted from 1) of FOLDs that show points of motions that have got points of their own.
fn renamed_lines<'a>(
    input: ReadProgram<'a>,
    output: ReadProgram<'a>,
    written: &Corrected,
) -> BTreeMap<(usize, usize), Vec<Renamed<'a>>> {
    let mut renamed: BTreeMap<(usize, usize), Vec<Renamed<'_>>> = BTreeMap::new();
    // The last piece of a motion is its own statement.
    let own: BTreeMap<usize, usize> = (written.pieces.iter().enumerate())
        .map(|(index, piece)| {
            (
                input.path.motions[piece.move_index],
                output.path.motions[index],
            )
        })
        .collect();
    let mut files: BTreeMap<usize, (TokenFile<'_>, Vec<Option<usize>>)> = BTreeMap::new();
    for (before, after) in own {
        let (before, after) = (
            &input.program.motions[before],
            &output.program.motions[after],
        );
        let points = points(input.program, before).zip(points(output.program, after));
        let points: Vec<Renamed<'_>> = points
            .filter(|(old, new)| !old.is_empty() && !new.is_empty() && old != new)
            .collect();
        if points.is_empty() {
            continue;
        }
        let (tokens, folds) = files.entry(before.file).or_insert_with(|| {
            let tokens = token_file(before.file, &input.program.files[before.file]);
            let folds = folds_of(&tokens);
            (tokens, folds)
        });
        let behind = tokens.lines.partition_point(|line| {
            let first = tokens.tokens.get(line.tokens.start);
            first.is_some_and(|token| token.bytes().start <= before.span.start)
        });
        let Some(top) = behind.checked_sub(1).and_then(|line| folds[line]) else {
            continue;
        };
        let comment = tokens.lines[top].comment.clone().unwrap_or(0..0);
        let first = tokens.source.line_of(comment.start);
        let shown = tokens.source.part(&comment);
        for (old, new) in points {
            if !runs(shown).any(|word| word.eq_ignore_ascii_case(old)) {
                continue;
            }
            for line in first..before.line {
                renamed
                    .entry((before.file, line))
                    .or_default()
                    .push((old, new));
            }
        }
    }
    renamed
}

/// The declared points of a motion as the pendant shows them, that of its end first.
fn points<'a>(program: &'a RobotProgram, motion: &'a Motion) -> impl Iterator<Item = &'a [u8]> {
    let via = motion.site.via.as_ref().map(|(_, site)| site);
    let file = &program.files[motion.file];
    let shown = move |site: &TargetSite| match site {
        TargetSite::Declared { name, .. } => {
            let (first, rest) = file.part(name).split_first()?;
            first.eq_ignore_ascii_case(&b'X').then_some(rest)
        }
        _ => None,
    };
    let sites = [Some(&motion.site.target), via].into_iter().flatten();
    sites.map(move |site| shown(site).unwrap_or_default())
}

/// A text cut into words and what is between them.
fn runs(text: &[u8]) -> impl Iterator<Item = &[u8]> {
    text.chunk_by(|one, next| is_part(*one) == is_part(*next))
}

fn is_part(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || matches!(byte, b'_' | b'$') || byte >= 0x80
}

/// True if a line only differs by renamed points: in its comment all of them, of the data names any.
fn only_names_changed(line: &[u8], written: &[u8], names: &[Renamed<'_>]) -> bool {
    let (mut old_runs, mut new_runs) = (runs(line), runs(written));
    let mut in_comment = false;
    loop {
        let (old, new) = match (old_runs.next(), new_runs.next()) {
            (Some(old), Some(new)) => (old, new),
            (None, None) => return true,
            _ => return false,
        };
        in_comment |= old.contains(&b';');
        let shows = |name: &&Renamed<'_>| name.0.eq_ignore_ascii_case(old);
        let mut shown = names.iter().filter(shows);
        let is_right = match shown.next().filter(|_| in_comment) {
            Some(first) => first.1 == new || shown.any(|(_, other)| *other == new),
            None => old == new || !in_comment && is_data_of(old, new, names),
        };
        if !is_right {
            return false;
        }
    }
}

/// True if two words are the data of a point and of its renamed copy: `FP1` and `FP1_2`.
fn is_data_of(old: &[u8], new: &[u8], names: &[Renamed<'_>]) -> bool {
    let (Some((a, old)), Some((b, new))) = (old.split_first(), new.split_first()) else {
        return false;
    };
    let of = |(from, to): &Renamed<'_>| from.eq_ignore_ascii_case(old) && *to == new;
    a.eq_ignore_ascii_case(&b'F') && a == b && names.iter().any(of)
}
