//! Facts and acts of VAL3 that files outside this folder ask for.

use crate::error::WriteError;
use crate::model::parsed::Parsed;
use crate::model::program::RobotProgram;
use crate::options::{ReadOptions, WriteOptions};
use crate::program_language::{ProgramLanguage, WrittenFile, of_run};
use crate::refused_run::RefusedRun;
use crate::table::StatementRow;
use crate::text::flat::FlatText;
use crate::text::source::SourceFile;
use crate::val3::reader::{below_begin, called_by, expand_val3, is_program, parse_val3};
use crate::val3::table::VAL3_STATEMENTS;
use crate::val3::write::Val3Syntax;
use crate::writing::motions::write_with;
use crate::writing::piece::Piece;

/// Staubli VAL3.
pub(crate) struct Val3Language;

impl ProgramLanguage for Val3Language {
    fn word(&self) -> &'static str {
        "val3"
    }

    fn name(&self) -> &'static str {
        "VAL3"
    }

    fn title(&self) -> &'static str {
        "Staubli VAL3"
    }

    fn endings(&self) -> &'static [&'static str] {
        &["pgx", "dtx", "pjx"]
    }

    fn comment(&self) -> &'static str {
        "//"
    }

    fn statements(&self) -> &'static [StatementRow] {
        VAL3_STATEMENTS
    }

    fn written(&self) -> &'static str {
        "Written: numbers of points in place, in the data of the application; points that several motions use copied under a free name; points that are computed, or of which numbers are left out, moved by appro; further motions as movel or movec, with the same description of speed and blending."
    }

    fn parse(&self, files: Vec<SourceFile>, options: &ReadOptions) -> Parsed {
        parse_val3(files, options)
    }

    fn write(
        &self,
        program: &RobotProgram,
        pieces: &[Piece],
        options: &WriteOptions,
    ) -> Result<Vec<WrittenFile>, WriteError> {
        write_with(program, pieces, options, &Val3Syntax)
    }

    fn expand(
        &self,
        files: &[SourceFile],
        options: &ReadOptions,
    ) -> Result<Option<FlatText>, RefusedRun> {
        of_run(expand_val3(files, options))
    }

    fn stays_beside_flat(&self, file: &SourceFile) -> bool {
        !is_program(file)
    }

    fn called_files(&self, file: &SourceFile) -> Vec<String> {
        called_by(file)
    }

    fn data_ending(&self) -> Option<&'static str> {
        Some("dtx")
    }

    /// Data and project of the application, and programs that are called.
    fn files_beside(&self, file: &SourceFile, folder: &[String]) -> Vec<String> {
        let called = called_by(file);
        let belongs = |name: &&String| {
            let lower = name.to_ascii_lowercase();
            lower.ends_with(".dtx")
                || lower.ends_with(".pjx")
                || called.iter().any(|own| own.eq_ignore_ascii_case(&lower))
        };
        folder.iter().filter(belongs).cloned().collect()
    }

    fn written_endings(&self) -> &'static [&'static str] {
        &["pgx"]
    }

    fn header_place(&self, program: &[u8], _: usize) -> Option<usize> {
        below_begin(program)
    }

    /// Lines of XML take no comment.
    fn takes_origin(&self, _: &[u8]) -> bool {
        false
    }

    fn comment_behind_statement(&self) -> Option<&'static str> {
        Some("//")
    }

    /// XML around a program, and what only waits.
    fn order_words(&self) -> &'static [&'static str] {
        &["<", "]]>", "BEGIN", "END", "WAITENDMOVE"]
    }

    fn speed_remedy(&self) -> &'static str {
        "state tvel of its description of motion (tmax in the data) as a number of mm/s, or state unstated_feed_mm_per_s in the template"
    }

    fn opens_block(&self, words: &[String]) -> bool {
        let opening = ["IF", "FOR", "WHILE", "DO", "SWITCH"];
        words
            .first()
            .is_some_and(|first| opening.contains(&first.as_str()))
    }

    /// Signs of XML in a text would break a program that is not in CDATA.
    fn header_is_mark(&self) -> bool {
        true
    }
}
