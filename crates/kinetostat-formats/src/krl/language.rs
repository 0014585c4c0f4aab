//! Facts and acts of KRL that files outside this folder ask for.

use crate::error::WriteError;
use crate::krl::reader::{expand_krl, is_data_list, parse_krl};
use crate::krl::table::KRL_STATEMENTS;
use crate::krl::writing::write::write_krl;
use crate::model::parsed::Parsed;
use crate::model::program::RobotProgram;
use crate::options::{ReadOptions, WriteOptions};
use crate::program_language::{ProgramLanguage, WrittenFile, of_run};
use crate::refused_run::RefusedRun;
use crate::table::StatementRow;
use crate::text::flat::FlatText;
use crate::text::source::SourceFile;
use crate::writing::piece::Piece;

/// KUKA KRL.
pub(crate) struct KrlLanguage;

impl ProgramLanguage for KrlLanguage {
    fn word(&self) -> &'static str {
        "krl"
    }

    fn name(&self) -> &'static str {
        "KRL"
    }

    fn title(&self) -> &'static str {
        "KUKA KRL"
    }

    fn endings(&self) -> &'static [&'static str] {
        &["src", "dat", "sub"]
    }

    fn comment(&self) -> &'static str {
        ";"
    }

    fn statements(&self) -> &'static [StatementRow] {
        KRL_STATEMENTS
    }

    fn written(&self) -> &'static str {
        "Written: numbers in place, in the program or in its data list; points that several motions use copied under a free name of at most 24 characters, with the texts of their FOLDs; further motions as LIN, and of circles as CIRC, with the same approximation. S and T stay as they are; external axes are shared out evenly over the motions that one becomes."
    }

    fn parse(&self, files: Vec<SourceFile>, options: &ReadOptions) -> Parsed {
        parse_krl(files, options)
    }

    fn write(
        &self,
        program: &RobotProgram,
        pieces: &[Piece],
        options: &WriteOptions,
    ) -> Result<Vec<WrittenFile>, WriteError> {
        write_krl(program, pieces, options)
    }

    fn expand(
        &self,
        files: &[SourceFile],
        options: &ReadOptions,
    ) -> Result<Option<FlatText>, RefusedRun> {
        of_run(expand_krl(files, options))
    }

    fn stays_beside_flat(&self, file: &SourceFile) -> bool {
        is_data_list(file)
    }

    fn held_word(&self) -> Option<&'static str> {
        Some("DEF")
    }

    fn own_words(&self) -> &'static [(&'static str, &'static str)] {
        &[("ENDDAT", "dat"), ("&ACCESS", "src")]
    }

    fn written_endings(&self) -> &'static [&'static str] {
        &["src", "sub"]
    }

    fn header_below(&self) -> Option<&'static str> {
        Some("DEF")
    }
}
