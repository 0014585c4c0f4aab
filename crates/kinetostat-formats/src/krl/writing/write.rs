//! Adapter of the writer for KRL, and the renaming of a point in its FOLD and its data.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use crate::error::WriteError;
use crate::interpreter::token::{Kind, Line, TokenFile};
use crate::krl::lex::{folds_of, token_file};
use crate::krl::position::{PLACE, kept_angles};
use crate::krl::table::{MotionRow, motion_row, only_reads};
use crate::krl::writing::stated::with_stated_ends;
use crate::model::motion::{Motion, Zone};
use crate::model::program::RobotProgram;
use crate::model::site::ReplacedText;
use crate::options::WriteOptions;
use crate::text::Name;
use crate::text::source::{Edits, SourceFile};
use crate::writing::motions::write_with;
use crate::writing::piece::Piece;
use crate::writing::syntax::{PieceLiterals, Renamed, Syntax, Wanted, replace_word};

/// Limit of the characters of a name.
const LONGEST: usize = 24;

/// KRL.
struct KrlSyntax;

/// The files of a program with pieces in place of its motions.
pub(crate) fn write_krl(
    program: &RobotProgram,
    pieces: &[Piece],
    options: &WriteOptions,
) -> Result<Vec<(String, Vec<u8>)>, WriteError> {
    let stated = with_stated_ends(program, pieces)?;
    write_with(
        stated.as_ref().unwrap_or(program),
        pieces,
        options,
        &KrlSyntax,
    )
}

/// The row of the word with which a motion begins.
fn row_of(program: &RobotProgram, motion: &Motion) -> Option<&'static MotionRow> {
    let word = program.files.get(motion.file)?.part(&motion.site.keyword);
    motion_row(&Name::of(word)?)
}

impl Syntax for KrlSyntax {
    fn names(&self, program: &RobotProgram) -> BTreeSet<Vec<u8>> {
        let mut names = BTreeSet::new();
        for (index, source) in program.files.iter().enumerate() {
            let file = token_file(index, source);
            for token in &file.tokens {
                if token.kind == Kind::Word {
                    names.insert(source.part(&token.bytes()).to_ascii_uppercase());
                }
            }
        }
        names
    }

    fn free_name(
        &self,
        near: &[u8],
        number: &mut usize,
        taken: &mut BTreeSet<Vec<u8>>,
    ) -> Option<Vec<u8>> {
        // The loop tries more names than are taken.
        for _ in 0..=2 * taken.len() + 2 {
            let end = format!("_{number}");
            *number += 1;
            let kept = near.len().min(LONGEST.checked_sub(end.len())?);
            let name = [&near[..kept], end.as_bytes()].concat();
            let upper = name.to_ascii_uppercase();
            // A point of an inline form has its data beside it: XP1 and FP1.
            let data = [b"F", upper.get(1..).unwrap_or_default()].concat();
            if !taken.contains(&data) && taken.insert(upper) {
                return Some(name);
            }
        }
        None
    }

    fn writes_circles(&self) -> bool {
        true
    }

    fn piece(
        &self,
        program: &RobotProgram,
        motion: &Motion,
        literals: &PieceLiterals,
        speed: Option<&[u8]>,
    ) -> Option<Vec<u8>> {
        let file = program.files.get(motion.file)?;
        let row = row_of(program, motion)?;
        let site = &motion.site;
        let mut edits = Edits::default();
        if let (Some(site), Some(speed)) = (&site.speed, speed) {
            edits.replace(site.span.clone(), speed);
        }
        let straight = row.straight?;
        match (&literals.via, &site.via) {
            (Some((span, via)), _) => edits.replace(span.clone(), via.clone()),
            (None, via) => {
                let written = file.part(&site.keyword);
                replace_word(written, straight, &site.keyword, &mut edits);
                if let Some((span, _)) = via {
                    edits.replace(span.clone(), "");
                }
            }
        }
        edits.replace(site.target_span.clone(), literals.end.clone());
        if motion.zone == Zone::Exact {
            let end = site.target_span.end;
            edits.replace(end..end, format!(" {}", row.pass));
        }
        edits.applied_to_part(file.bytes(), &motion.span)
    }

    fn is_written_flat(&self) -> bool {
        true
    }

    fn replaced(
        &self,
        _file: &SourceFile,
        text: &ReplacedText,
        wanted: &Wanted<'_>,
        options: &WriteOptions,
    ) -> Option<Vec<u8>> {
        let rotation = wanted.orientation.unwrap_or(text.pose.orientation);
        let decimals = [options.position_decimals, options.angle_decimals];
        let place = wanted.position_mm.iter().copied();
        let values = place.chain(kept_angles(&rotation));
        let mut members: Vec<String> = (PLACE.iter().zip(values).enumerate())
            .map(|(at, (name, value))| format!("{name} {value:.*}", decimals[at / 3]))
            .collect();
        let configuration = &text.pose.configuration.text;
        members.extend((!configuration.is_empty()).then(|| configuration.clone()));
        for (axis, before) in text.pose.external.iter().enumerate() {
            let changed = wanted.external.get(axis).copied().flatten();
            let value = changed
                .or(*before)
                .map(|value| format!("E{} {value}", axis + 1));
            members.extend(value);
        }
        Some(format!("{{{}}}", members.join(",")).into_bytes())
    }

    fn straighten(&self, program: &RobotProgram, motion: &Motion, edits: &mut Edits) {
        let site = &motion.site;
        let word = row_of(program, motion).and_then(|row| row.straight);
        if let (Some(word), Some((span, _))) = (word, &site.via) {
            let written = program.files[motion.file].part(&site.keyword);
            replace_word(written, word, &site.keyword, edits);
            edits.replace(span.clone(), "");
        }
    }

    fn restored_speed(&self, program: &RobotProgram, motion: &Motion) -> Option<(usize, Vec<u8>)> {
        let file = program.files.get(motion.file)?;
        let site = motion.site.speed.as_ref()?;
        // A speed in WITH applies to the motion alone.
        let is_before = site.span == (motion.span.start..motion.span.start);
        let site = is_before.then_some(site)?;
        let metres_per_s = motion.speed.mm_per_s? / 1000.0;
        let rest = file.bytes().get(motion.span.end..)?;
        let to_end = rest
            .iter()
            .position(|byte| *byte == b'\n')
            .unwrap_or(rest.len());
        let kept = rest[..to_end]
            .strip_suffix(b"\r")
            .map_or(to_end, <[u8]>::len);
        let mut text = file.line_ending().to_vec();
        text.extend_from_slice(file.indentation(motion.span.start));
        text.extend_from_slice(format!("{}{metres_per_s}", site.before).as_bytes());
        Some((motion.span.end + kept, text))
    }

    fn renamed(&self, program: &RobotProgram, names: &[Renamed], edits: &mut [Edits]) {
        rename_in_folds(program, names, edits);
    }
}

// Source: inline forms as the pendant of KSS 5.x and 8.x writes them. A point `XP1` is shown as `P1`, and `FP1` is its data.

/// Declaration of a FDAT: its statement, and the name in it behind the F.
struct PointData {
    statement: Range<usize>,
    letters: Range<usize>,
}

/// The text of the fold around each statement, its names of the point's data, and a copy of these data.
pub(super) fn rename_in_folds(program: &RobotProgram, names: &[Renamed], edits: &mut [Edits]) {
    let files: Vec<TokenFile<'_>> = (program.files.iter().enumerate())
        .map(|(index, source)| token_file(index, source))
        .collect();
    let folds: Vec<Vec<Option<usize>>> = files.iter().map(folds_of).collect();
    let changed: BTreeSet<Vec<u8>> = files.iter().flat_map(perhaps_changed).collect();
    let mut data: Vec<BTreeMap<Vec<u8>, PointData>> = files.iter().map(point_data).collect();
    let all = data.iter_mut();
    all.for_each(|own| own.retain(|name, _| !changed.contains(name)));
    let (mut copied, mut changed) = (BTreeSet::new(), BTreeSet::new());
    for Renamed {
        home,
        file,
        place,
        name,
    } in names
    {
        let tokens = &files[*file];
        let (Some(old), Some(new)) = (point(tokens.source.part(place)), point(name)) else {
            continue;
        };
        let Some(line) = line_of(tokens, place.start) else {
            continue;
        };
        let shows = |line: usize| {
            words(tokens, line).any(|word| tokens.source.part(&word).eq_ignore_ascii_case(old))
        };
        // The fold of parameters is inside the fold of the motion.
        let Some(top) = folds[*file][line].filter(|top| shows(*top)) else {
            continue;
        };
        let mut upper = [b"F", old].concat();
        upper.make_ascii_uppercase();
        let of_point = data[*home].get(&upper);
        let shown = (top..line).flat_map(|line| shown_at(tokens, line, old));
        let mut places: Vec<Range<usize>> = shown.collect();
        if of_point.is_some() {
            places.extend((top..=line).flat_map(|line| data_at(tokens, line, old)));
        }
        for place in places {
            if changed.insert((*file, place.start)) {
                edits[*file].replace(place, new);
            }
        }
        if let Some(data) = of_point
            && copied.insert((*home, name.clone()))
        {
            copy_data(&files[*home], data, new, &mut edits[*home]);
        }
    }
}

/// The line with tokens in which a place is.
fn line_of(file: &TokenFile<'_>, place: usize) -> Option<usize> {
    let starts = |line: &Line| {
        let first = file.tokens.get(line.tokens.start);
        first.map_or(usize::MAX, |token| token.bytes().start)
    };
    let behind = file.lines.partition_point(|line| starts(line) <= place);
    behind.checked_sub(1)
}

/// Writes the data of a point once more, for another one.
fn copy_data(file: &TokenFile<'_>, data: &PointData, new: &[u8], edits: &mut Edits) {
    let source = file.source;
    let mut copy = Edits::default();
    copy.replace(data.letters.clone(), new);
    let statement = &data.statement;
    let mut text = copy
        .applied_to_part(source.bytes(), statement)
        .unwrap_or_default();
    text.extend_from_slice(source.line_ending());
    text.extend_from_slice(source.indentation(statement.start));
    edits.replace(statement.start..statement.start, text);
}

/// The data of points that a file declares.
fn point_data(file: &TokenFile<'_>) -> BTreeMap<Vec<u8>, PointData> {
    let mut all = BTreeMap::new();
    for line in &file.lines {
        let is_word = |at: usize, word: &[u8]| file.word(at).eq_ignore_ascii_case(word);
        let mut tokens = line.tokens.clone();
        let of_type = tokens.find(|at| !is_word(*at, b"DECL") && !is_word(*at, b"GLOBAL"));
        let of_type = of_type.filter(|at| is_word(*at, b"FDAT"));
        // A statement with several names is not copied.
        let alone = file.find(line.tokens.clone(), b',').is_none();
        if let Some(name) = of_type
            .map(|at| at + 1)
            .filter(|name| alone && *name < line.tokens.end)
        {
            let place = file.tokens[name].bytes();
            let upper = file.word(name).to_ascii_uppercase();
            let data = PointData {
                statement: file.span(&line.tokens),
                letters: place.start + 1..place.end,
            };
            all.insert(upper, data);
        }
    }
    all
}

/// Names that may be those of a FDAT and stand elsewhere than behind its type, behind `FDAT_ACT=` and in functions of the
/// controller: a copy would not change with it.
fn perhaps_changed<'f>(file: &'f TokenFile<'_>) -> impl Iterator<Item = Vec<u8>> + use<'f> {
    let is_read = |at: usize| {
        at.checked_sub(2).is_some_and(|before| {
            file.is_word(at - 1, "FDAT")
                || file.is(at - 1, b'=') && file.is_word(before, "FDAT_ACT")
                || file.is(at - 1, b'(') && file.name(before).is_some_and(|own| only_reads(&own))
        })
    };
    let is_data = |at: &usize| {
        file.word(*at)
            .first()
            .is_some_and(|first| matches!(first, b'F' | b'f'))
    };
    let names = (0..file.tokens.len())
        .filter(is_data)
        .filter(move |at| !is_read(*at));
    names.map(|at| file.word(at).to_ascii_uppercase())
}

/// The name of a point as the pendant shows it: without the X before it.
fn point(name: &[u8]) -> Option<&[u8]> {
    let (first, rest) = name.split_first()?;
    (first.eq_ignore_ascii_case(&b'X') && !rest.is_empty()).then_some(rest)
}

/// Words of a comment with their places.
fn words<'f>(file: &'f TokenFile<'_>, line: usize) -> impl Iterator<Item = Range<usize>> + use<'f> {
    let comment = file.lines[line].comment.clone().unwrap_or(0..0);
    let bytes = file.source.bytes();
    let is_part =
        |byte: &u8| byte.is_ascii_alphanumeric() || matches!(byte, b'_' | b'$') || *byte >= 0x80;
    let mut at = comment.start;
    std::iter::from_fn(move || {
        while at < comment.end && !is_part(&bytes[at]) {
            at += 1;
        }
        let start = at;
        while at < comment.end && is_part(&bytes[at]) {
            at += 1;
        }
        (at > start).then_some(start..at)
    })
}

/// Positions in the comment of a line that show a point.
fn shown_at<'f>(
    file: &'f TokenFile<'_>,
    line: usize,
    old: &'f [u8],
) -> impl Iterator<Item = Range<usize>> + use<'f> {
    let bytes = file.source.bytes();
    words(file, line).filter(move |word| bytes[word.clone()].eq_ignore_ascii_case(old))
}

/// Positions at which a statement names the data of a point (`FDAT_ACT=FP1`, `$TOOL=STOOL2(FP1)`): the name after the F.
fn data_at<'f>(
    file: &'f TokenFile<'_>,
    line: usize,
    old: &'f [u8],
) -> impl Iterator<Item = Range<usize>> + use<'f> {
    let bytes = file.source.bytes();
    let tokens = &file.tokens[file.lines[line].tokens.clone()];
    let places = tokens.iter().map(|token| token.bytes());
    places.filter_map(move |place| {
        let (first, rest) = bytes[place.clone()].split_first()?;
        let is_data = first.eq_ignore_ascii_case(&b'F') && rest.eq_ignore_ascii_case(old);
        is_data.then(|| place.start + 1..place.end)
    })
}
