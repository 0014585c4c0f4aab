//! Facts and acts of RAPID that files outside this folder ask for.

use crate::error::WriteError;
use crate::model::motion::Motion;
use crate::model::orientation::OrientationText;
use crate::model::parsed::Parsed;
use crate::model::program::RobotProgram;
use crate::model::stated_arm::StatedArm;
use crate::model::target::Configuration;
use crate::options::{ReadOptions, WriteOptions};
use crate::program_language::{ProgramLanguage, WrittenFile, of_run};
use crate::rapid::lex::code_of;
use crate::rapid::reader::{expand_rapid, parse_rapid};
use crate::rapid::table::{MODES, RAPID_STATEMENTS};
use crate::rapid::write::RapidSyntax;
use crate::refused_run::RefusedRun;
use crate::table::StatementRow;
use crate::text::flat::FlatText;
use crate::text::source::SourceFile;
use crate::writing::motions::write_with;
use crate::writing::piece::Piece;

/// Instructions that say how fast the arm moves beside its speeds, wherever they stand on their line.
const DYNAMICS: [&str; 5] = [
    "VELSET",
    "SPEEDREFRESH",
    "ACCSET",
    "PATHACCLIM",
    "WORLDACCLIM",
];

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

    fn files_are_joined(&self) -> bool {
        true
    }

    fn orientation_of_controller(&self) -> Option<OrientationText> {
        Some(OrientationText::Quaternion)
    }

    fn stated_arm(&self, configuration: &Configuration) -> StatedArm {
        StatedArm::of_bits(configuration.numbers.get(3), [4, 2, 1])
    }

    fn words_of_arm(&self, arm: &StatedArm) -> Option<String> {
        Some(format!("cfx {}", arm.in_bits([4, 2, 1])?))
    }

    fn wrist_is_sign_of_axis_5(&self) -> bool {
        true
    }

    fn may_take_near_configurations(&self) -> bool {
        true
    }

    fn takes_near_configurations(&self, program: &RobotProgram) -> bool {
        let mut files = program.files.iter();
        files.any(|file| {
            let text = String::from_utf8_lossy(file.bytes()).to_ascii_lowercase();
            text.contains("confl\\off") && text.contains("confj\\off")
        })
    }

    fn name_of_external_axis(&self, axis: usize) -> String {
        match u8::try_from(axis) {
            Ok(axis @ 0..=5) => format!("external axis eax_{}", char::from(b'a' + axis)),
            _ => format!("external axis {}", axis + 1),
        }
    }

    fn modes_of_motions(&self) -> &'static str {
        ", or how motions behind it go (`CirPathMode`, `SingArea`, `ConfL`, `ConfJ`, `AccSet`, `VelSet`)"
    }

    /// A `;` begins no comment.
    fn takes_origin(&self, _line: &[u8]) -> bool {
        false
    }

    fn code_of<'t>(&self, line: &'t str) -> &'t str {
        code_of(line)
    }

    fn modes(&self) -> &'static [&'static [&'static str]] {
        MODES
    }

    fn sign_of_declaration(&self) -> Option<&'static str> {
        Some(":=[")
    }

    fn words_of_motion(&self, motion: &Motion) -> Option<Vec<String>> {
        let work_object = format!("\\WOBJ:={}", motion.work_object.name);
        Some(vec![work_object, motion.tool.name.clone()])
    }

    fn order_words(&self) -> &'static [&'static str] {
        &[
            "MODULE",
            "ENDMODULE",
            "PROC",
            "ENDPROC",
            "CONST",
            "PERS",
            "VAR",
            "LOCAL",
            "TASK",
            "%%%",
            "VERSION",
            "LANGUAGE",
            // The rotation mode on circles is modelled.
            "CIRPATHMODE",
            "SINGAREA",
        ]
    }

    fn states_dynamics(&self, words: &[&str]) -> bool {
        words.iter().any(|word| DYNAMICS.contains(word))
    }

    fn comment_behind_statement(&self) -> Option<&'static str> {
        Some("!")
    }

    fn has_several_statements_a_line(&self) -> bool {
        true
    }

    fn routines(&self) -> [&'static [&'static str]; 2] {
        [
            &["PROC", "FUNC", "TRAP"],
            &["ENDPROC", "ENDFUNC", "ENDTRAP"],
        ]
    }

    fn main_routine(&self) -> Option<&'static str> {
        Some("MAIN")
    }

    fn is_call(&self, behind: &str) -> bool {
        !behind.starts_with(':')
    }

    /// One instruction on a condition is one of its own.
    fn opens_block(&self, words: &[String]) -> bool {
        let has = |word: &str| words.iter().any(|own| own == word);
        has("IF") && has("THEN") || has("FOR") || has("WHILE") || has("TEST")
    }
}
