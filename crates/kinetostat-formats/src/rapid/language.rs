//! Facts and acts of RAPID that files outside this folder ask for, and the adapter of the writer.

use std::collections::BTreeSet;
use std::ops::Range;

use crate::error::WriteError;
use crate::flat_run::RefusedRun;
use crate::interpreter::token::words_of;
use crate::model::motion::{Motion, Zone};
use crate::model::orientation::OrientationText;
use crate::model::parsed::Parsed;
use crate::model::program::RobotProgram;
use crate::model::site::ReplacedText;
use crate::model::target::{Configuration, StatedArm};
use crate::options::{ReadOptions, WriteOptions};
use crate::program_language::{ProgramLanguage, WrittenFile, of_run};
use crate::rapid::lex::{code_of, tokens_of};
use crate::rapid::reader::{expand_rapid, parse_rapid};
use crate::rapid::table::{MODES, MotionRow, RAPID_STATEMENTS, motion_row};
use crate::table::StatementRow;
use crate::text::Name;
use crate::text::number::Width;
use crate::text::source::{Edits, FlatText, SourceFile};
use crate::writing::motions::write_with;
use crate::writing::piece::Piece;
use crate::writing::syntax::{PieceLiterals, Syntax, Wanted, names_of, put, replace_word};

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

/// RAPID.
pub(crate) struct RapidSyntax;

/// The row of the word with which a motion begins.
fn row_of(program: &RobotProgram, motion: &Motion) -> Option<&'static MotionRow> {
    let word = program.files.get(motion.file)?.part(&motion.site.keyword);
    motion_row(&Name::of(word)?)
}

impl Syntax for RapidSyntax {
    fn names(&self, program: &RobotProgram) -> BTreeSet<Vec<u8>> {
        names_of(program, |bytes| words_of(&tokens_of(bytes)))
    }

    fn writes_circles(&self) -> bool {
        true
    }

    fn piece(
        &self,
        program: &RobotProgram,
        motion: &Motion,
        literals: &PieceLiterals,
        speed: Option<&[u8]>,
    ) -> Option<Vec<u8>> {
        let file = program.files.get(motion.file)?;
        let (word, _) = row_of(program, motion)?.straight?;
        let site = &motion.site;
        let mut edits = Edits::default();
        let written = file.part(&site.keyword);
        match (&literals.via, &site.via) {
            (Some((span, via)), _) => {
                replace_word(written, &circular(word), &site.keyword, &mut edits);
                edits.replace(span.clone(), via.clone());
            }
            (None, via) => {
                replace_word(written, word, &site.keyword, &mut edits);
                if let Some((span, _)) = via {
                    leave_out(span, &site.keyword, &mut edits);
                }
            }
        }
        edits.replace(site.target_span.clone(), literals.end.clone());
        if let (Some(site), Some(speed)) = (&site.speed, speed) {
            edits.replace(site.span.clone(), speed);
        }
        if let (Some(zone), Zone::Exact) = (&site.zone, motion.zone) {
            edits.replace(zone.clone(), "z0");
        }
        edits.applied_to_part(file.bytes(), &motion.span)
    }

    fn is_written_flat(&self) -> bool {
        true
    }

    fn replaced(
        &self,
        file: &SourceFile,
        text: &ReplacedText,
        wanted: &Wanted<'_>,
        options: &WriteOptions,
    ) -> Option<Vec<u8>> {
        let rotation = wanted.orientation.unwrap_or(text.pose.orientation);
        let turn = [rotation.w, rotation.i, rotation.j, rotation.k];
        let place = wanted.position_mm.as_slice();
        let list = |values: &[f64], decimals: usize| {
            let values = values.iter().map(|value| format!("{value:.decimals$}"));
            format!("[{}]", values.collect::<Vec<String>>().join(","))
        };
        let decimals = [options.position_decimals, options.quaternion_decimals];
        // Names in the aggregate stay.
        if let Some(parts) = &text.parts {
            let mut edits = Edits::default();
            let same_sign = match parts[1]
                .numbers
                .iter()
                .zip(turn)
                .map(|(n, t)| n.value * t)
                .sum::<f64>()
                < 0.0
            {
                true => turn.map(|part| -part),
                false => turn,
            };
            let turns = wanted.orientation.is_some();
            let values = [(place, true), (&same_sign[..], turns)];
            for ((part, (values, is_wanted)), decimals) in parts.iter().zip(values).zip(decimals) {
                if !is_wanted {
                    continue;
                }
                if part.numbers.is_empty() {
                    edits.replace(part.span.clone(), list(values, decimals));
                }
                for (number, value) in part.numbers.iter().zip(values) {
                    put(file, number, *value, decimals, Width::Free, &mut edits);
                }
            }
            return edits.applied_to_part(file.bytes(), &text.span);
        }
        let external = |axis: usize| {
            let wanted = wanted.external.get(axis).copied().flatten();
            let value = wanted.or_else(|| text.pose.external.get(axis).copied().flatten());
            value.map_or_else(|| "9E9".to_owned(), |value| value.to_string())
        };
        let axes = [0, 1, 2, 3, 4, 5].map(external).join(",");
        let configuration = &text.pose.configuration.text;
        let [place, turn] = [list(place, decimals[0]), list(&turn, decimals[1])];
        Some(format!("[{place},{turn},{configuration},[{axes}]]").into_bytes())
    }

    fn straighten(&self, program: &RobotProgram, motion: &Motion, edits: &mut Edits) {
        let site = &motion.site;
        let words = row_of(program, motion).and_then(|row| row.straight);
        if let (Some((_, word)), Some((span, _))) = (words, &site.via) {
            let written = program.files[motion.file].part(&site.keyword);
            replace_word(written, word, &site.keyword, edits);
            leave_out(span, &site.keyword, edits);
        }
    }
}

/// The word of a circle for that of a straight motion: `MoveC` for `MoveL`, `ArcC1` for `ArcL1`.
fn circular(straight: &str) -> String {
    match straight.rfind('L') {
        Some(at) => format!("{}C{}", &straight[..at], &straight[at + 1..]),
        None => straight.to_owned(),
    }
}

/// Takes the pose on a circle out; a blank stays between the word and what follows (`MoveC[[...]],p1`).
fn leave_out(via: &Range<usize>, keyword: &Range<usize>, edits: &mut Edits) {
    let blank = match via.start == keyword.end {
        true => " ",
        false => "",
    };
    edits.replace(via.clone(), blank);
}
