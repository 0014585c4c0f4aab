//! Facts and acts of RAPID that files outside this folder ask for.

use crate::error::WriteError;
use crate::model::parsed::Parsed;
use crate::model::program::RobotProgram;
use crate::options::{ReadOptions, WriteOptions};
use crate::program_language::{ProgramLanguage, WrittenFile, of_run};
use crate::rapid::reader::{expand_rapid, parse_rapid};
use crate::rapid::table::RAPID_STATEMENTS;
use crate::rapid::write::RapidSyntax;
use crate::refused_run::RefusedRun;
use crate::table::StatementRow;
use crate::text::flat::FlatText;
use crate::text::source::SourceFile;
use crate::writing::motions::write_with;
use crate::writing::piece::Piece;

/// ABB RAPID.
pub(crate) struct RapidLanguage;

impl ProgramLanguage for RapidLanguage {
    fn word(&self) -> &'static str {
        "rapid"
    }

    fn name(&self) -> &'static str {
        "RAPID"
    }

    fn title(&self) -> &'static str {
        "ABB RAPID"
    }

    fn endings(&self) -> &'static [&'static str] {
        &["mod", "modx", "prg", "sys", "sysx"]
    }

    fn comment(&self) -> &'static str {
        "!"
    }

    fn statements(&self) -> &'static [StatementRow] {
        RAPID_STATEMENTS
    }

    fn written(&self) -> &'static str {
        "Written: numbers of targets in place, declarations edited or copied under a free name of at most 32 characters, further motions as MoveL, and of circles as MoveC, with the same speed, tool and work object. External axes are shared out evenly over the motions that one becomes. A divided motion stops at its end alone."
    }

    fn parse(&self, files: Vec<SourceFile>, options: &ReadOptions) -> Parsed {
        parse_rapid(files, options)
    }

    fn write(
        &self,
        program: &RobotProgram,
        pieces: &[Piece],
        options: &WriteOptions,
    ) -> Result<Vec<WrittenFile>, WriteError> {
        write_with(program, pieces, options, &RapidSyntax)
    }

    fn expand(
        &self,
        files: &[SourceFile],
        options: &ReadOptions,
    ) -> Result<Option<FlatText>, RefusedRun> {
        of_run(expand_rapid(files, options))
    }

    fn held_word(&self) -> Option<&'static str> {
        Some("MODULE")
    }

    fn own_words(&self) -> &'static [(&'static str, &'static str)] {
        &[("ENDMODULE", "mod")]
    }

    fn header_below(&self) -> Option<&'static str> {
        Some("MODULE")
    }
}
