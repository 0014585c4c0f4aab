//! Facts and acts of APT that files outside this folder ask for.

use crate::apt::flat::expand::expand_apt;
use crate::apt::reader::parse_apt;
use crate::apt::spindle::spindle_changes;
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
use kinetostat_program::SpindleChange;

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

    fn is_of_robot(&self) -> bool {
        false
    }

    fn is_loaded(&self) -> bool {
        false
    }

    fn states_turn(&self) -> bool {
        false
    }

    /// A `;` begins no comment.
    fn takes_origin(&self, _line: &[u8]) -> bool {
        false
    }

    fn has_rapid_word(&self) -> bool {
        true
    }

    fn is_rapid(&self, speed: &str) -> bool {
        speed.to_ascii_uppercase().starts_with("RAPID")
    }

    fn spindle_is_in_path(&self) -> bool {
        true
    }

    fn spindle_changes(&self, file: &SourceFile) -> Vec<SpindleChange> {
        spindle_changes(file)
    }

    fn code_of<'t>(&self, line: &'t str) -> &'t str {
        line.split("$$").next().unwrap_or_default()
    }

    fn order_words(&self) -> &'static [&'static str] {
        &[
            "GOTO", "RAPID", "FEDRAT", "UNITS", "UNIT", "MULTAX", "TLAXIS", "PARTNO", "TRNTYP",
            "FINI", "END",
        ]
    }

    fn speed_remedy(&self) -> &'static str {
        "state FEDRAT as a number (and SPINDL, where it is by turns), or state unstated_feed_mm_per_s in the template"
    }

    fn keeps_direction(&self) -> bool {
        true
    }

    fn comment_behind_statement(&self) -> Option<&'static str> {
        Some("$$")
    }

    fn jumps(&self) -> &'static [&'static str] {
        &["JUMPTO", "LOOPST"]
    }
}
