//! Facts and acts of FANUC TP programs that files outside this folder ask for.

use crate::error::WriteError;
use crate::flat_run::RefusedRun;
use crate::ls::flat::expand_ls;
use crate::ls::lines::Layout;
use crate::ls::reader::parse_ls;
use crate::ls::step::{Step, step_of};
use crate::ls::table::{IN_MOTIONS, LS_STATEMENTS, MODES};
use crate::ls::write::{numbered_again, write_ls};
use crate::model::motion::Motion;
use crate::model::orientation::OrientationText;
use crate::model::parsed::Parsed;
use crate::model::program::RobotProgram;
use crate::model::target::{Configuration, StatedArm};
use crate::options::{ReadOptions, WriteOptions};
use crate::program_language::{ProgramLanguage, WrittenFile, of_run, with_ending};
use crate::table::StatementRow;
use crate::text::source::{FlatText, SourceFile};
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

    fn expand(
        &self,
        files: &[SourceFile],
        options: &ReadOptions,
    ) -> Result<Option<FlatText>, RefusedRun> {
        of_run(expand_ls(files, options))
    }

    fn called_files(&self, file: &SourceFile) -> Vec<String> {
        // Most lines of a long program are motions, which are not decoded for this.
        let calls = |text: &[u8]| text.windows(4).any(|word| word == b"CALL");
        let lines = Layout::of(file.bytes()).lines.into_iter();
        let lines = lines.filter(|line| calls(file.part(&line.text)));
        let names = lines.filter_map(|line| match step_of(file.bytes(), &line.text).action() {
            Step::Call(call) => call.name.clone(),
            _ => None,
        });
        let names = names.map(|name| String::from_utf8_lossy(file.part(&name)).into_owned());
        with_ending(names.collect(), "LS")
    }

    fn held_word(&self) -> Option<&'static str> {
        Some("/PROG")
    }

    fn unread_endings(&self) -> &'static [(&'static str, &'static str)] {
        &[(
            "tp",
            "it holds a TP program in the form of the controller, which is not read: save it as text there (ASCII, .ls), and give that",
        )]
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

    /// No remark stands behind an instruction.
    fn takes_origin(&self, _line: &[u8]) -> bool {
        false
    }

    fn orientation_of_controller(&self) -> Option<OrientationText> {
        Some(OrientationText::Wpr)
    }

    fn stated_arm(&self, configuration: &Configuration) -> StatedArm {
        let letters = configuration.text.split(',').next().unwrap_or_default();
        let one_of = |yes: &str, no: &str| {
            letters.split_whitespace().find_map(|word| match word {
                word if word == yes => Some(true),
                word if word == no => Some(false),
                _ => None,
            })
        };
        StatedArm {
            is_back: one_of("B", "T"),
            elbow: one_of("D", "U"),
            wrist: one_of("F", "N"),
        }
    }

    fn words_of_arm(&self, arm: &StatedArm) -> Option<String> {
        let letter = |is: Option<bool>, yes: char, no: char| is.map(|is| if is { yes } else { no });
        Some(format!(
            "`{} {} {}`",
            letter(arm.wrist, 'F', 'N')?,
            letter(arm.elbow, 'D', 'U')?,
            letter(arm.is_back, 'B', 'T')?
        ))
    }

    fn states_all_axes(&self) -> bool {
        true
    }

    fn name_of_external_axis(&self, axis: usize) -> String {
        format!("external axis or group axis {}", axis + 1)
    }

    fn modes(&self) -> &'static [&'static [&'static str]] {
        MODES
    }

    fn settings_in_motions(&self) -> &'static [&'static str] {
        IN_MOTIONS
    }

    fn words_of_motion(&self, _motion: &Motion) -> Option<Vec<String>> {
        Some(Vec::new())
    }

    fn order_words(&self) -> &'static [&'static str] {
        &["/", "UFRAME_NUM", "UTOOL_NUM"]
    }

    fn states_dynamics(&self, words: &[&str]) -> bool {
        match words {
            ["OVERRIDE" | "JOINT_MAX_SPEED" | "LINEAR_MAX_SPEED", ..] => true,
            // ACC after the zone of a motion.
            ["J" | "L" | "C" | "A", others @ ..] => others.iter().any(|word| {
                let percent = word.strip_prefix("ACC");
                percent.is_some_and(|percent| percent.bytes().all(|byte| byte.is_ascii_digit()))
            }),
            _ => false,
        }
    }

    /// Text of a line without its number; empty for the count of lines.
    fn behind_number<'l>(&self, line: &'l [u8]) -> &'l [u8] {
        if line.starts_with(b"LINE_COUNT") {
            return b"";
        }
        let colon = line.iter().position(|byte| *byte == b':');
        let number = |at: &usize| line[..*at].iter().all(|b| *b == b' ' || b.is_ascii_digit());
        colon.filter(number).map_or(line, |at| &line[at..])
    }

    fn section(&self) -> Option<[&'static [u8]; 2]> {
        Some([b"/MN", b"/POS"])
    }

    fn statement_in<'t>(&self, line: &'t str) -> &'t str {
        let line = line.trim();
        let numbered = line
            .split_once(':')
            .filter(|(number, _)| number.trim().bytes().all(|byte| byte.is_ascii_digit()));
        let behind = numbered.map_or(line, |(_, rest)| rest);
        behind.trim().trim_end_matches(';').trim()
    }

    fn opens_block(&self, words: &[String]) -> bool {
        match words.first().map(String::as_str) {
            Some("IF") => words.iter().any(|word| word == "THEN"),
            first => first == Some("FOR"),
        }
    }

    fn ends_of_run(&self) -> &'static [&'static str] {
        &["END", "ABORT"]
    }
}
