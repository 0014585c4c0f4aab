//! Facts and acts of FANUC TP programs that files outside this folder ask for.

use crate::error::WriteError;
use crate::ls::reader::parse_ls;
use crate::ls::table::LS_STATEMENTS;
use crate::ls::write::{numbered_again, write_ls};
use crate::model::parsed::Parsed;
use crate::model::program::RobotProgram;
use crate::options::{ReadOptions, WriteOptions};
use crate::program_language::{ProgramLanguage, WrittenFile};
use crate::table::StatementRow;
use crate::text::source::SourceFile;
use crate::writing::piece::Piece;

/// FANUC TP programs as text.
pub(crate) struct LsLanguage;

impl ProgramLanguage for LsLanguage {
    fn word(&self) -> &'static str {
        "ls"
    }

    fn name(&self) -> &'static str {
        "FANUC"
    }

    fn title(&self) -> &'static str {
        "FANUC TP programs as text"
    }

    fn endings(&self) -> &'static [&'static str] {
        &["ls"]
    }

    fn comment(&self) -> &'static str {
        "!"
    }

    fn statements(&self) -> &'static [StatementRow] {
        LS_STATEMENTS
    }

    fn written(&self) -> &'static str {
        "Written: numbers of positions in place and in their columns; further motions as L, and of circles as C, with positions of their own at the end of /POS (external axes shared out evenly), lines numbered again and LINE_COUNT raised, since a controller loads only lines that follow one another."
    }

    fn parse(&self, files: Vec<SourceFile>, options: &ReadOptions) -> Parsed {
        parse_ls(files, options)
    }

    fn write(
        &self,
        program: &RobotProgram,
        pieces: &[Piece],
        options: &WriteOptions,
    ) -> Result<Vec<WrittenFile>, WriteError> {
        write_ls(program, pieces, options)
    }

    fn held_word(&self) -> Option<&'static str> {
        Some("/PROG")
    }

    fn own_words(&self) -> &'static [(&'static str, &'static str)] {
        &[("/PROG", "ls")]
    }

    fn file_title(&self) -> &'static str {
        "a TP program of FANUC"
    }

    fn header_opens(&self, _program: &[u8]) -> String {
        "   1:  !".to_owned()
    }

    fn header_closes(&self) -> &'static str {
        " ;"
    }

    fn header_below(&self) -> Option<&'static str> {
        Some("/MN")
    }

    /// A remark has 32 characters.
    fn header_is_mark(&self) -> bool {
        true
    }

    fn numbered_again(&self, program: &[u8]) -> Option<Vec<u8>> {
        numbered_again(program)
    }
}
