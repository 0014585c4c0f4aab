//! Facts and acts of lists of poses that files outside this folder ask for.

use crate::error::WriteError;
use crate::file_form::{FileForm, ending_of};
use crate::model::parsed::Parsed;
use crate::model::program::RobotProgram;
use crate::options::{ReadOptions, WriteOptions};
use crate::poses::reader::parse_poses;
use crate::poses::table::POSES_STATEMENTS;
use crate::poses::write::write_poses;
use crate::program_language::{ProgramLanguage, WrittenFile};
use crate::table::StatementRow;
use crate::text::source::SourceFile;
use crate::text::source::beginning;
use crate::writing::piece::Piece;

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
