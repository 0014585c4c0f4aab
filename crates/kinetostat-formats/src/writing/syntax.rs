//! Interface of the writer to a language.

use std::collections::BTreeSet;
use std::ops::Range;

use nalgebra::{UnitQuaternion, Vector3};

use crate::model::motion::Motion;
use crate::model::orientation::OrientationText;
use crate::model::program::RobotProgram;
use crate::model::site::{Declaration, PoseText, ReplacedText};
use crate::options::WriteOptions;
use crate::text::number::{NumberText, Width, printed};
use crate::text::source::{Edits, SourceFile};

/// The poses of a piece as they are written.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PieceLiterals {
    pub end: Vec<u8>,
    /// Position of the auxiliary point in the text, and its replacement; `None` for a straight piece.
    pub via: Option<(Range<usize>, Vec<u8>)>,
}

/// Interface of the writer to a language.
pub(crate) trait Syntax {
    /// All names of the program, as the language compares them; none where the language declares nothing.
    fn names(&self, _program: &RobotProgram) -> BTreeSet<Vec<u8>> {
        BTreeSet::new()
    }

    /// A name like `near` with a number, from this one on, that is not taken; it is taken then, and the number is the next.
    fn free_name(
        &self,
        near: &[u8],
        number: &mut usize,
        taken: &mut BTreeSet<Vec<u8>>,
    ) -> Option<Vec<u8>> {
        numbered_name(near, number, taken)
    }

    /// True if the pieces of a motion to a declared end get declared ends of their own: the statement has no literals.
    fn declares_pieces(&self) -> bool {
        false
    }

    /// Insertion point of a copy of a declaration, in the same file.
    fn copies_at(&self, _program: &RobotProgram, declaration: &Declaration) -> usize {
        // Before it: what stands behind it on its line may be a comment on it.
        declaration.statement.start
    }

    /// Changes in a motion statement whose end gets another pose, besides its numbers.
    fn moved(&self, _program: &RobotProgram, _motion: &Motion, _edits: &mut Edits) {}

    /// True if the pieces of a circular motion may be circular, too.
    fn writes_circles(&self) -> bool {
        false
    }

    /// A statement that goes to a pose (its literal) before the end of a motion, as that motion is written otherwise: straight, or
    /// on a circle through a place in place of that of the motion; without line ending. Where pieces are declared, the literals
    /// are the declared names.
    fn piece(
        &self,
        program: &RobotProgram,
        motion: &Motion,
        literals: &PieceLiterals,
        speed: Option<&[u8]>,
    ) -> Option<Vec<u8>>;

    /// True where a program with loops and calls can be written flat.
    fn is_written_flat(&self) -> bool {
        false
    }

    /// The text of an end that the statement has by names or computes, with another pose.
    fn replaced(
        &self,
        _file: &SourceFile,
        _text: &ReplacedText,
        _wanted: &Wanted<'_>,
        _options: &WriteOptions,
    ) -> Option<Vec<u8>> {
        None
    }

    /// Makes a circular motion a straight one to the same end.
    fn straighten(&self, _program: &RobotProgram, _motion: &Motion, _edits: &mut Edits) {}

    /// Position and text that restore a modal speed for the following motions.
    fn restored_speed(
        &self,
        _program: &RobotProgram,
        _motion: &Motion,
    ) -> Option<(usize, Vec<u8>)> {
        None
    }

    /// Changes what else speaks of names that became others: texts around the statement, data that belong to a name.
    fn renamed(&self, _program: &RobotProgram, _names: &[Renamed], _edits: &mut [Edits]) {}
}

/// A use of a declared pose under a further name.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Renamed {
    /// The file of the declaration.
    pub home: usize,
    /// The file of the use.
    pub file: usize,
    /// Position of the name in that file.
    pub place: Range<usize>,
    /// The further name.
    pub name: Vec<u8>,
}

/// All names of a program in capitals, by the places of the words of its files.
pub(crate) fn names_of(
    program: &RobotProgram,
    words_of: impl Fn(&[u8]) -> Vec<Range<usize>>,
) -> BTreeSet<Vec<u8>> {
    let mut names = BTreeSet::new();
    for file in &program.files {
        let words = words_of(file.bytes()).into_iter();
        names.extend(words.map(|word| file.part(&word).to_ascii_uppercase()));
    }
    names
}

/// Most letters of a further name: as many as RAPID takes.
const LONGEST: usize = 32;

/// A free name with the number at its end.
fn numbered_name(
    near: &[u8],
    number: &mut usize,
    taken: &mut BTreeSet<Vec<u8>>,
) -> Option<Vec<u8>> {
    // The loop tries more names than are taken.
    for _ in 0..=taken.len() {
        let end = format!("_{number}");
        *number += 1;
        let kept = near.len().min(LONGEST.checked_sub(end.len())?);
        let name = [&near[..kept], end.as_bytes()].concat();
        if taken.insert(name.to_ascii_uppercase()) {
            return Some(name);
        }
    }
    None
}

/// A word of the same letters stays as it is written.
pub(crate) fn replace_word(written: &[u8], word: &str, span: &Range<usize>, edits: &mut Edits) {
    if !written.eq_ignore_ascii_case(word.as_bytes()) {
        edits.replace(span.clone(), word);
    }
}

/// A pose that is wanted: its place, and its orientation where that changes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Wanted<'a> {
    pub position_mm: Vector3<f64>,
    pub orientation: Option<UnitQuaternion<f64>>,
    /// External axes that become others, by their order; those that are left out stay.
    pub external: &'a [Option<f64>],
}

/// Puts a value in place of a number of the text.
pub(crate) fn put(
    file: &SourceFile,
    number: &NumberText,
    value: f64,
    least_decimals: usize,
    width: Width,
    edits: &mut Edits,
) {
    let original = file.part(&number.span);
    let text = printed(original, number.value, value, least_decimals, width);
    if text != original {
        edits.replace(number.span.clone(), text);
    }
}

/// Puts the numbers of a pose in place of those of a literal.
pub(crate) fn put_pose(
    file: &SourceFile,
    literal: &PoseText,
    wanted: &Wanted<'_>,
    options: &WriteOptions,
    edits: &mut Edits,
) {
    let more = literal.unit_mm.log10().ceil() as usize;
    for (number, value) in literal.position.iter().zip(wanted.position_mm.iter()) {
        put(
            file,
            number,
            *value / literal.unit_mm,
            options.position_decimals + more,
            literal.width,
            edits,
        );
    }
    for (number, value) in literal.external.iter().zip(wanted.external) {
        if let (Some(number), Some(value)) = (number, value) {
            let least = options.position_decimals;
            put(file, number, *value, least, literal.width, edits);
        }
    }
    let Some(rotation) = wanted.orientation else {
        return;
    };
    let least = match literal.convention {
        OrientationText::Quaternion | OrientationText::Axis | OrientationText::RotationVector => {
            options.quaternion_decimals
        }
        _ => options.angle_decimals,
    };
    let near: Vec<f64> = literal
        .orientation
        .iter()
        .map(|number| number.value)
        .collect();
    let values = literal.convention.numbers_of(&rotation, &near);
    for (number, value) in literal.orientation.iter().zip(values) {
        put(file, number, value, least, literal.width, edits);
    }
}

/// The whole literal with the numbers of a pose.
pub(crate) fn literal_of(
    file: &SourceFile,
    literal: &PoseText,
    wanted: &Wanted<'_>,
    options: &WriteOptions,
) -> Option<Vec<u8>> {
    let mut edits = Edits::default();
    put_pose(file, literal, wanted, options, &mut edits);
    edits.applied_to_part(file.bytes(), &literal.whole)
}
