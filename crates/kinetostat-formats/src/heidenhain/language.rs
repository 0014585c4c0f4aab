//! Facts and acts of Heidenhain programs that files outside this folder ask for.

use crate::error::WriteError;
use crate::flat_run::RefusedRun;
use crate::heidenhain::blocks::{is_numbered, numbered_again};
use crate::heidenhain::expand::flat::run_or_refused;
use crate::heidenhain::flow::called;
use crate::heidenhain::reading::reader::parse_heidenhain;
use crate::heidenhain::table::HEIDENHAIN_STATEMENTS;
use crate::heidenhain::writing::write::write_heidenhain;
use crate::model::parsed::Parsed;
use crate::model::program::RobotProgram;
use crate::options::{ReadOptions, WriteOptions};
use crate::program_language::{ProgramLanguage, WrittenFile, with_ending};
use crate::table::StatementRow;
use crate::text::source::{FlatText, SourceFile};
use crate::writing::piece::Piece;

/// Heidenhain conversational.
pub(crate) struct HeidenhainLanguage;

impl ProgramLanguage for HeidenhainLanguage {
    fn word(&self) -> &'static str {
        "heidenhain"
    }

    fn name(&self) -> &'static str {
        "Heidenhain"
    }

    fn title(&self) -> &'static str {
        "Heidenhain conversational programs of TNC 426 to TNC 640"
    }

    fn endings(&self) -> &'static [&'static str] {
        &["h"]
    }

    fn comment(&self) -> &'static str {
        ";"
    }

    fn statements(&self) -> &'static [StatementRow] {
        HEIDENHAIN_STATEMENTS
    }

    fn written(&self) -> &'static str {
        "Written: numbers in place with the file's signs, at most 4 decimals in mm and 5 in inches, as the control takes them (from -99999.9999 to 99999.9999); a coordinate that a block took over from a corrected one is stated. Further blocks stand before the block, with its feed and radius compensation; a function acts on the first or the last of them as it acts on a block. Circles that are corrected become circles about centres of their own (CC and C), helices where they rise (CP with IPA and IZ), or L blocks where neither follows; the program's pole is stated again where a block counts from it. Polar lines become L blocks. LN blocks are divided with surface normals and tool directions between those of the program; a corrected direction is stated (TX, TY, TZ) as long as it differs. Where a file numbers its blocks and gets further ones, all are numbered again. Programs with labels, Q parameters, jumps, drilling cycles and rounded corners (RND, an arc of its own then) are written flat first (--expand): at most 5 million blocks."
    }

    fn parse(&self, files: Vec<SourceFile>, options: &ReadOptions) -> Parsed {
        parse_heidenhain(files, options)
    }

    fn write(
        &self,
        program: &RobotProgram,
        pieces: &[Piece],
        options: &WriteOptions,
    ) -> Result<Vec<WrittenFile>, WriteError> {
        write_heidenhain(program, pieces, options)
    }

    fn expand(
        &self,
        files: &[SourceFile],
        options: &ReadOptions,
    ) -> Result<Option<FlatText>, RefusedRun> {
        run_or_refused(files, options).map(Some)
    }

    fn called_files(&self, file: &SourceFile) -> Vec<String> {
        with_ending(called(file), "H")
    }

    fn rapids_are_straight(&self) -> bool {
        true
    }

    fn held_word(&self) -> Option<&'static str> {
        Some("BEGIN PGM")
    }

    fn file_title(&self) -> &'static str {
        "a Heidenhain program"
    }

    /// A block of its own, where blocks have numbers.
    fn header_opens(&self, program: &[u8]) -> String {
        match is_numbered(program) {
            true => "0 ; ".to_owned(),
            false => "; ".to_owned(),
        }
    }

    fn header_below(&self) -> Option<&'static str> {
        Some("BEGIN")
    }

    fn behind_number<'l>(&self, line: &'l [u8]) -> &'l [u8] {
        let digits = line.iter().take_while(|byte| byte.is_ascii_digit()).count();
        line[digits..].trim_ascii_start()
    }

    fn numbered_again(&self, program: &[u8]) -> Option<Vec<u8>> {
        is_numbered(program).then(|| numbered_again(program))?
    }

    fn has_slash_switch(&self) -> bool {
        true
    }

    fn takes_values(&self) -> bool {
        true
    }

    fn is_of_robot(&self) -> bool {
        false
    }

    fn is_in_blocks(&self) -> bool {
        true
    }

    fn states_turn(&self) -> bool {
        false
    }

    fn takes_origin(&self, line: &[u8]) -> bool {
        let upper = line.to_ascii_uppercase();
        let words = upper.split(|byte| byte.is_ascii_whitespace());
        let mut words = words.skip_while(|word| word.iter().all(u8::is_ascii_digit));
        let (first, second) = (words.next().unwrap_or_default(), words.next());
        let ends = matches!(first, b"BEGIN" | b"END") && second == Some(b"PGM");
        !first.is_empty() && !first.starts_with(b"*") && !ends && !line.ends_with(b"~")
    }

    fn is_rapid(&self, speed: &str) -> bool {
        speed == "FMAX"
    }

    fn words_of_direction(&self) -> Option<&'static str> {
        Some("TX, TY, TZ")
    }

    fn speed_remedy(&self) -> &'static str {
        "write F as a number of mm/min (FZ, FU, FT and F AUTO state none; with M136 S in TOOL CALL and M3, too), or state unstated_feed_mm_per_s in the template"
    }

    fn has_centres(&self) -> bool {
        true
    }

    fn goes_on_great_circles(&self) -> bool {
        false
    }
}
