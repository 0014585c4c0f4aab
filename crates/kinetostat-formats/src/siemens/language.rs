//! Facts and acts of SINUMERIK programs that files outside this folder ask for.

use crate::error::WriteError;
use crate::flat_run::RefusedRun;
use crate::model::parsed::Parsed;
use crate::model::program::RobotProgram;
use crate::options::{ReadOptions, WriteOptions};
use crate::program_language::{ProgramLanguage, SPEED_REMEDY_OF_BLOCKS, WrittenFile, with_ending};
use crate::siemens::called::called;
use crate::siemens::flat::run_or_refused;
use crate::siemens::reader::parse_siemens;
use crate::siemens::table::{MODES, SIEMENS_STATEMENTS};
use crate::siemens::writing::write::write_siemens;
use crate::table::StatementRow;
use crate::text::source::{FlatText, SourceFile};
use crate::writing::piece::Piece;

/// SINUMERIK 840D.
pub(crate) struct SiemensLanguage;

impl ProgramLanguage for SiemensLanguage {
    fn word(&self) -> &'static str {
        "siemens"
    }

    fn name(&self) -> &'static str {
        "SINUMERIK"
    }

    fn title(&self) -> &'static str {
        "Siemens SINUMERIK 840D"
    }

    fn endings(&self) -> &'static [&'static str] {
        &["mpf", "spf"]
    }

    fn comment(&self) -> &'static str {
        ";"
    }

    fn statements(&self) -> &'static [StatementRow] {
        SIEMENS_STATEMENTS
    }

    fn written(&self) -> &'static str {
        "Written: numbers in place, the first piece in its block and further ones in blocks behind it, without numbers: N numbers need be neither unique nor complete. Arcs that are corrected become circles through a place (CIP), which may lean, or G1; codes, feeds and places that stay in force are stated again where they would be others; steps (G91, IC) become X=AC(). Blocks of at most 512 characters; file names have at most 24. Programs with jumps, loops, calls, drilling cycles, rounded and broken corners (RND, CHF, CHR) are run once and written flat (--expand)."
    }

    fn parse(&self, files: Vec<SourceFile>, options: &ReadOptions) -> Parsed {
        parse_siemens(files, options)
    }

    fn write(
        &self,
        program: &RobotProgram,
        pieces: &[Piece],
        options: &WriteOptions,
    ) -> Result<Vec<WrittenFile>, WriteError> {
        write_siemens(program, pieces, options)
    }

    fn expand(
        &self,
        files: &[SourceFile],
        options: &ReadOptions,
    ) -> Result<Option<FlatText>, RefusedRun> {
        run_or_refused(files, options).map(Some)
    }

    fn called_files(&self, file: &SourceFile) -> Vec<String> {
        with_ending(called(file), "SPF")
    }

    fn rapids_are_straight(&self) -> bool {
        true
    }

    fn is_beginning(&self, beginning: &[u8]) -> bool {
        is_siemens(beginning)
    }

    fn file_title(&self) -> &'static str {
        "a SINUMERIK program"
    }

    /// SINUMERIK programs with the file endings of G-code are recognised by their content.
    fn written_endings(&self) -> &'static [&'static str] {
        &["mpf", "spf", "ngc", "nc", "tap", "cnc", "iso"]
    }

    /// The control reads a path only right below the name of the program.
    fn header_place(&self, program: &[u8], below: usize) -> Option<usize> {
        let next = program[below..]
            .split_inclusive(|byte| *byte == b'\n')
            .next();
        let is_path = |line: &&[u8]| {
            line.to_ascii_uppercase().starts_with(b";$PATH") && line.ends_with(b"\n")
        };
        Some(below + next.filter(is_path).map_or(0, <[u8]>::len))
    }

    fn is_of_robot(&self) -> bool {
        false
    }

    fn takes_values(&self) -> bool {
        true
    }

    fn modes(&self) -> &'static [&'static [&'static str]] {
        MODES
    }

    fn is_in_blocks(&self) -> bool {
        true
    }

    fn has_slash_switch(&self) -> bool {
        true
    }

    fn states_turn(&self) -> bool {
        false
    }

    fn is_rapid(&self, speed: &str) -> bool {
        speed == "G0"
    }

    fn words_of_direction(&self) -> Option<&'static str> {
        Some("A3, B3, C3")
    }

    fn speed_remedy(&self) -> &'static str {
        SPEED_REMEDY_OF_BLOCKS
    }

    /// A CIP stands in place of G2 and G3.
    fn writes_circles(&self, _is_fixed: bool) -> bool {
        true
    }
}

/// True if a program has lines that only a SINUMERIK reads (in capitals); otherwise it may be G-code.
fn is_siemens(beginning: &[u8]) -> bool {
    beginning.split(|byte| *byte == b'\n').any(|line| {
        let line = line.trim_ascii();
        let numbered = line
            .strip_prefix(b"N")
            .filter(|rest| rest.first().is_some_and(u8::is_ascii_digit));
        let digits = numbered.map_or(0, |rest| {
            1 + rest.iter().take_while(|byte| byte.is_ascii_digit()).count()
        });
        let words = line[digits..].trim_ascii_start();
        let cycle = words.strip_prefix(b"CYCLE8").is_some_and(|rest| {
            let digits = rest.iter().take_while(|byte| byte.is_ascii_digit()).count();
            digits > 0 && rest.get(digits) == Some(&b'(')
        });
        cycle
            || words.starts_with(b"%_N_")
            || words.starts_with(b"DEF REAL ")
            || words == b"TRAORI"
            || words.starts_with(b"TRAORI(")
            || words.starts_with(b"TRAORI ")
    })
}
