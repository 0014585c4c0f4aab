//! Facts and acts of APT that files outside this folder ask for.

use crate::apt::flat::expand::expand_apt;
use crate::apt::reader::parse_apt;
use crate::apt::table::APT_STATEMENTS;
use crate::apt::write::write_apt;
use crate::error::WriteError;
use crate::model::parsed::Parsed;
use crate::model::program::RobotProgram;
use crate::options::{ReadOptions, WriteOptions};
use crate::program_language::{ProgramLanguage, WrittenFile, of_run};
use crate::refused_run::RefusedRun;
use crate::table::StatementRow;
use crate::text::flat::FlatText;
use crate::text::source::SourceFile;
use crate::writing::piece::Piece;

/// APT and CLDATA.
pub(crate) struct AptLanguage;

impl ProgramLanguage for AptLanguage {
    fn word(&self) -> &'static str {
        "apt"
    }

    fn name(&self) -> &'static str {
        "APT"
    }

    fn title(&self) -> &'static str {
        "APT and CLDATA of SolidWorks CAM, NX, CATIA and others"
    }

    fn endings(&self) -> &'static [&'static str] {
        &["apt", "cls", "cl", "aptsource", "apt_source", "cldata"]
    }

    fn comment(&self) -> &'static str {
        "$$"
    }

    fn statements(&self) -> &'static [StatementRow] {
        APT_STATEMENTS
    }

    fn written(&self) -> &'static str {
        "Written: numbers of GOTO in place, further places as GOTO before it; circles that are corrected become straight motions."
    }

    fn parse(&self, files: Vec<SourceFile>, options: &ReadOptions) -> Parsed {
        parse_apt(files, options)
    }

    fn write(
        &self,
        program: &RobotProgram,
        pieces: &[Piece],
        options: &WriteOptions,
    ) -> Result<Vec<WrittenFile>, WriteError> {
        write_apt(program, pieces, options)
    }

    fn expand(
        &self,
        files: &[SourceFile],
        _options: &ReadOptions,
    ) -> Result<Option<FlatText>, RefusedRun> {
        of_run(expand_apt(files))
    }

    fn rapids_are_straight(&self) -> bool {
        true
    }

    fn held_word(&self) -> Option<&'static str> {
        Some("GOTO")
    }
}
