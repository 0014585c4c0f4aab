//! Facts and acts of lists of poses that files outside this folder ask for.
//!
//! Adapter of the writer for lists of poses.
//!
//! A pose before another one is a copy of its row with other numbers. Lengths go back into the unit of the text.

use std::ops::Range;

use crate::error::WriteError;
use crate::file_form::{FileForm, ending_of};
use crate::model::motion::Motion;
use crate::model::parsed::Parsed;
use crate::model::program::RobotProgram;
use crate::model::site::TargetSite;
use crate::options::{ReadOptions, WriteOptions};
use crate::poses::columns::POSES_STATEMENTS;
use crate::poses::csv::{with_commas, with_points};
use crate::poses::reader::parse_poses;
use crate::program_language::{ProgramLanguage, WrittenFile};
use crate::table::StatementRow;
use crate::text::number::NumberText;
use crate::text::source::{Edits, SourceFile, beginning};
use crate::writing::motions::write_with;
use crate::writing::piece::Piece;
use crate::writing::syntax::{PieceLiterals, Syntax};

/// Lists of poses: tables and YAML.
pub(crate) struct PosesLanguage;

impl ProgramLanguage for PosesLanguage {
    fn word(&self) -> &'static str {
        "poses"
    }

    fn name(&self) -> &'static str {
        "poses"
    }

    fn title(&self) -> &'static str {
        "lists of poses: tables (CSV, Parquet) and YAML"
    }

    fn endings(&self) -> &'static [&'static str] {
        &["csv", "tsv", "yaml", "yml", "parquet"]
    }

    fn comment(&self) -> &'static str {
        "#"
    }

    fn statements(&self) -> &'static [StatementRow] {
        POSES_STATEMENTS
    }

    fn written(&self) -> &'static str {
        "Written: numbers in place, in their unit; further poses as copies of the row (CSV, Parquet) or of the item (YAML) before it, with all its other cells and keys. The first pose of a raster stays a motion in air, which is not divided."
    }

    fn parse(&self, files: Vec<SourceFile>, options: &ReadOptions) -> Parsed {
        parse_poses(files, options)
    }

    fn write(
        &self,
        program: &RobotProgram,
        pieces: &[Piece],
        options: &WriteOptions,
    ) -> Result<Vec<WrittenFile>, WriteError> {
        write_poses(program, pieces, options)
    }

    /// Tables may be binary.
    fn reads_all_line_ends(&self) -> bool {
        true
    }

    fn form(&self, name: &str, bytes: &[u8]) -> Option<FileForm> {
        let is_yaml = ["yaml", "yml"].contains(&ending_of(name).as_str());
        Some(match is_yaml {
            _ if bytes.starts_with(b"PAR1") => FileForm::Parquet,
            true => FileForm::Yaml,
            false => FileForm::Csv,
        })
    }

    /// Above the names of the columns; inside of YAML a comment could become a part of a text. Behind a byte order mark, which belongs
    /// to the first line, a table has it below the names.
    fn header_place(&self, program: &[u8], below: usize) -> Option<usize> {
        let mut lines = program.split(|byte| *byte == b'\n');
        match beginning(program) {
            0 => Some(0),
            _ => Some(below).filter(|_| lines.next().is_some_and(|first| first.contains(&b','))),
        }
    }

    fn is_of_robot(&self) -> bool {
        false
    }

    fn is_list(&self) -> bool {
        true
    }

    fn is_loaded(&self) -> bool {
        false
    }

    /// Rows and keys state poses; the rest of a list goes with its pose.
    fn order_words(&self) -> &'static [&'static str] {
        &[""]
    }

    fn speed_remedy(&self) -> &'static str {
        "write it as speed_mm_per_s, or state unstated_feed_mm_per_s in the template"
    }
}

/// The files of a program with pieces in place of its motions.
fn write_poses(
    program: &RobotProgram,
    pieces: &[Piece],
    options: &WriteOptions,
) -> Result<Vec<(String, Vec<u8>)>, WriteError> {
    let units: Vec<f64> = (0..program.files.len())
        .map(|file| unit_mm(program, file))
        .collect();
    let mut all = pieces.to_vec();
    for piece in &mut all {
        if let Some(motion) = program.motions.get(piece.motion) {
            piece.position_mm /= units[motion.file];
        }
    }
    let mut options = options.clone();
    if units.contains(&1000.0) {
        // Equal resolution in metres.
        options.position_decimals += 3;
    }
    let mut written = write_with(program, &all, &options, &PosesSyntax)?;
    for (file, (name, bytes)) in program.files.iter().zip(&mut written) {
        if with_points(file).is_some() {
            *bytes = with_commas(name, std::mem::take(bytes));
        }
    }
    Ok(written)
}

/// Length of the text's unit in mm: value read over value written, at a non-zero coordinate.
fn unit_mm(program: &RobotProgram, file: usize) -> f64 {
    let ratios = program
        .motions
        .iter()
        .filter(|motion| motion.file == file)
        .filter_map(|motion| {
            let (TargetSite::Literal(text), Some(pose)) =
                (&motion.site.target, motion.target.pose())
            else {
                return None;
            };
            let mut both = text.position.iter().zip(pose.position_mm.iter());
            let (number, mm) = both.find(|(number, _)| number.value.abs() > 1e-200)?;
            Some(mm / number.value)
        });
    match ratios.into_iter().next() {
        Some(ratio) if ratio > 30.0 => 1000.0,
        _ => 1.0,
    }
}

/// Tables and YAML.
struct PosesSyntax;

impl Syntax for PosesSyntax {
    fn piece(
        &self,
        program: &RobotProgram,
        motion: &Motion,
        literals: &PieceLiterals,
        speed: Option<&[u8]>,
    ) -> Option<Vec<u8>> {
        let literal = literals.end.as_slice();
        let (Some(speed), Some(site)) = (speed, &motion.site.speed) else {
            return Some(literal.to_vec());
        };
        let row = program.files.get(motion.file)?.part(&motion.span);
        let numbers = numbers(&motion.site.target)?;
        let at = moved(row, literal, motion.span.start, numbers, &site.span)?;
        let mut edits = Edits::default();
        edits.replace(at, speed);
        edits.applied_to(literal)
    }
}

/// The numbers of a row that become others.
fn numbers(site: &TargetSite) -> Option<Vec<&Range<usize>>> {
    let numbers: Vec<&NumberText> = match site {
        TargetSite::Literal(text) => (text.position.iter())
            .chain(&text.orientation)
            .chain(text.external.iter().flatten())
            .collect(),
        TargetSite::Joints(text) => text.numbers.iter().map(|(number, _)| number).collect(),
        _ => return None,
    };
    Some(numbers.into_iter().map(|number| &number.span).collect())
}

/// Position of a span of a row in a copy of the row with other numbers.
fn moved(
    row: &[u8],
    copy: &[u8],
    start: usize,
    mut numbers: Vec<&Range<usize>>,
    span: &Range<usize>,
) -> Option<Range<usize>> {
    numbers.retain(|number| number.start < span.start);
    numbers.sort_by_key(|number| number.start);
    let is_part = |byte: &&u8| byte.is_ascii_digit() || b"+-.eE".contains(byte);
    let (mut from, mut to) = (start, 0);
    for number in numbers {
        // Between numbers both are the same.
        to += number.start.checked_sub(from)?;
        to += copy.get(to..)?.iter().take_while(is_part).count();
        from = number.end;
    }
    to += span.start.checked_sub(from)?;
    let found = to..to + span.len();
    let same = copy.get(found.clone())? == row.get(span.start - start..span.end - start)?;
    same.then_some(found)
}
