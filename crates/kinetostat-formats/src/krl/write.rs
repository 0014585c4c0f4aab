//! What the writer must know of KRL.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use crate::error::WriteError;
use crate::krl::folds::folds_of;
use crate::krl::lex::{Kind, Line, TokenFile};
use crate::krl::reader::read_krl;
use crate::krl::table::{Ends, MotionRow, motion_row};
use crate::model::motion::{Motion, Zone};
use crate::model::orientation::OrientationText;
use crate::model::program::RobotProgram;
use crate::model::site::TargetSite;
use crate::options::{ExactStops, ExternalAxes, ReadOptions, UnknownTargets, WriteOptions};
use crate::text::edits::Edits;
use crate::text::name::Name;
use crate::text::source::SourceFile;
use crate::writing::motions::write_with;
use crate::writing::piece::Piece;
use crate::writing::syntax::{PieceLiterals, Renamed, Syntax};

/// Most characters of a name.
const LONGEST: usize = 24;

/// KRL.
struct KrlSyntax;

/// The files of a program with pieces in place of its motions.
pub(crate) fn write_krl(
    program: &RobotProgram,
    pieces: &[Piece],
    options: &WriteOptions,
) -> Result<Vec<(String, Vec<u8>)>, WriteError> {
    let stated = with_stated_ends(program, pieces);
    write_with(
        stated.as_ref().unwrap_or(program),
        pieces,
        options,
        &KrlSyntax,
    )
}

/// The program with the ends of those steps (`LIN_REL`) stated that are corrected, or that go on from what is; none where no step is.
fn with_stated_ends(program: &RobotProgram, pieces: &[Piece]) -> Option<RobotProgram> {
    let changed: BTreeSet<usize> = pieces.iter().map(|piece| piece.motion).collect();
    let mut edits: Vec<Edits> = program.files.iter().map(|_| Edits::default()).collect();
    let mut needed = false;
    let turned = pieces.iter().any(|piece| turns(program, piece));
    for (index, motion) in program.motions.iter().enumerate() {
        if turned && keeps_angles(motion) {
            needed |= state_angles(program, motion, &mut edits[motion.file]);
            continue;
        }
        let row = row_of(program, motion).filter(|row| row.ends == Ends::Step);
        let from = motion.follows.is_some_and(|from| changed.contains(&from));
        let (Some(row), Some(pose), true) =
            (row, motion.target.pose(), from || changed.contains(&index))
        else {
            continue;
        };
        let [x, y, z] = pose.position_mm.into();
        let angles = OrientationText::Abc.numbers_of(&pose.orientation, &[0.0; 3]);
        let [a, b, c] = [0, 1, 2].map(|index| angles.get(index).copied().unwrap_or_default());
        let end = format!("{{X {x:.6},Y {y:.6},Z {z:.6},A {a:.8},B {b:.8},C {c:.8}}}");
        let edits = &mut edits[motion.file];
        edits.replace(motion.site.keyword.clone(), row.straight.unwrap_or("LIN"));
        let file = &program.files[motion.file];
        let behind = file.part(&(motion.site.target_span.end..motion.span.end));
        // In whose axes the step was.
        let blanks = behind.len() - behind.trim_ascii_start().len();
        let word = match behind.trim_ascii_start().starts_with(b"#") {
            true => blanks + "#BASE".len(),
            false => 0,
        };
        let span = motion.site.target_span.start..motion.site.target_span.end + word;
        edits.replace(span, end);
        needed = true;
    }
    if !needed {
        return None;
    }
    let files = program.files.iter().zip(edits).map(|(file, edits)| {
        let bytes = edits.applied_to(file.bytes())?;
        Some(SourceFile::new(file.name(), bytes))
    });
    let reading = ReadOptions {
        unknown_targets: UnknownTargets::LeftAsWritten,
        external_axes: ExternalAxes::Carried,
        ..ReadOptions::default()
    };
    let again = read_krl(files.collect::<Option<Vec<_>>>()?, &reading).ok()?;
    (again.motions.len() == program.motions.len()).then_some(again)
}

/// Whether a piece turns the tool out of the orientation that its motion ends with.
fn turns(program: &RobotProgram, piece: &Piece) -> bool {
    let end = program.motions.get(piece.motion);
    let end = end.and_then(|motion| motion.target.pose());
    end.zip(piece.orientation)
        .is_some_and(|(end, to)| to.angle_to(&end.orientation) > 1e-9)
}

/// Whether the end states X, Y and Z, and keeps A, B and C of before.
fn keeps_angles(motion: &Motion) -> bool {
    matches!(&motion.site.target, TargetSite::Literal(text) if text.orientation.is_empty())
}

/// Adds the angles that an end keeps to its literal.
fn state_angles(program: &RobotProgram, motion: &Motion, edits: &mut Edits) -> bool {
    let (TargetSite::Literal(text), Some(pose)) = (&motion.site.target, motion.target.pose())
    else {
        return false;
    };
    let angles = OrientationText::Abc.numbers_of(&pose.orientation, &[0.0; 3]);
    let ([a, b, c], true) = (
        [0, 1, 2].map(|index| angles.get(index).copied().unwrap_or_default()),
        program.files[motion.file].part(&text.whole).ends_with(b"}"),
    ) else {
        return false;
    };
    let at = text.whole.end - 1;
    edits.replace(at..at, format!(",A {a:.8},B {b:.8},C {c:.8}"));
    true
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
            let file = TokenFile::of(index, source);
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
        // Of so many names one is free.
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
        options: &WriteOptions,
    ) -> Option<Vec<u8>> {
        let file = program.files.get(motion.file)?;
        let row = row_of(program, motion)?;
        let site = &motion.site;
        let mut edits = Edits::default();
        if let Some(speed) = speed {
            edits.replace(motion.span.start..motion.span.start, speed);
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
        if (motion.zone, options.exact_stops) == (Zone::Exact, ExactStops::AtEnd) {
            let end = site.target_span.end;
            edits.replace(end..end, format!(" {}", row.pass));
        }
        edits.applied_to_part(file.bytes(), &motion.span)
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

    /// The text of the fold around the statement, `FDAT_ACT=` in it, and the data of the point.
    fn renamed(&self, program: &RobotProgram, names: &[Renamed], edits: &mut [Edits]) {
        let files: Vec<TokenFile<'_>> = (program.files.iter().enumerate())
            .map(|(index, source)| TokenFile::of(index, source))
            .collect();
        let folds: Vec<Vec<Option<usize>>> = files.iter().map(folds_of).collect();
        let data: Vec<_> = files.iter().map(point_data).collect();
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
            let starts = |line: &Line| {
                tokens
                    .tokens
                    .get(line.tokens.start)
                    .map_or(0, |token| token.bytes().start)
            };
            let line = tokens
                .lines
                .partition_point(|line| starts(line) <= place.start);
            let Some(line) = line.checked_sub(1) else {
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
            for inside in top..line {
                for (place, new) in renamings(tokens, inside, old, new, of_point.is_some()) {
                    if changed.insert((*file, place.start)) {
                        edits[*file].replace(place, new);
                    }
                }
            }
            if let Some((statement, letters)) = of_point
                && copied.insert((*home, name.clone()))
            {
                let source = files[*home].source;
                let mut copy = Edits::default();
                copy.replace(letters.clone(), new);
                let mut text = copy
                    .applied_to_part(source.bytes(), statement)
                    .unwrap_or_default();
                text.extend_from_slice(source.line_ending());
                text.extend_from_slice(source.indentation(statement.start));
                edits[*home].replace(statement.start..statement.start, text);
            }
        }
    }
}

/// Statement, and place of the name behind its F, of each FDAT of a file.
fn point_data(file: &TokenFile<'_>) -> BTreeMap<Vec<u8>, (Range<usize>, Range<usize>)> {
    let mut all = BTreeMap::new();
    for line in &file.lines {
        let is_word = |at: usize, word: &[u8]| file.word(at).eq_ignore_ascii_case(word);
        let mut tokens = line.tokens.clone();
        let of_type = tokens.find(|at| !is_word(*at, b"DECL") && !is_word(*at, b"GLOBAL"));
        let of_type = of_type.filter(|at| is_word(*at, b"FDAT"));
        // One of several names of a statement is not copied.
        let alone = file.find(line.tokens.clone(), b',').is_none();
        if let Some(name) = of_type
            .map(|at| at + 1)
            .filter(|name| alone && *name < line.tokens.end)
        {
            let place = file.tokens[name].bytes();
            let upper = file.word(name).to_ascii_uppercase();
            all.insert(upper, (file.span(&line.tokens), place.start + 1..place.end));
        }
    }
    all
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

/// Where a line speaks of a point, and what is to stand there: in its comment and in `FDAT_ACT=`.
fn renamings(
    file: &TokenFile<'_>,
    line: usize,
    old: &[u8],
    new: &[u8],
    has_data: bool,
) -> Vec<(Range<usize>, Vec<u8>)> {
    let mut found = Vec::new();
    for word in words(file, line) {
        if file.source.part(&word).eq_ignore_ascii_case(old) {
            found.push((word, new.to_vec()));
        }
    }
    let tokens = file.lines[line].tokens.clone();
    if has_data && file.word(tokens.start).eq_ignore_ascii_case(b"FDAT_ACT") {
        for at in tokens {
            let place = file.tokens[at].bytes();
            let is_data = file.word(at).split_first();
            if is_data.is_some_and(|(first, rest)| {
                first.eq_ignore_ascii_case(&b'F') && rest.eq_ignore_ascii_case(old)
            }) {
                found.push((place.start + 1..place.end, new.to_vec()));
            }
        }
    }
    found
}

/// A word of the same letters stays as it is written.
fn replace_word(written: &[u8], word: &str, span: &Range<usize>, edits: &mut Edits) {
    if !written.eq_ignore_ascii_case(word.as_bytes()) {
        edits.replace(span.clone(), word);
    }
}
