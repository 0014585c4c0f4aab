//! Facts and acts of KRL that files outside this folder ask for.

use std::collections::BTreeSet;

use nalgebra::Vector3;

use crate::error::WriteError;
use crate::flat_run::RefusedRun;
use crate::krl::frames::krl_needs_config;
use crate::krl::reader::{expand_krl, is_data_list, parse_krl};
use crate::krl::table::{IN_MOTIONS, KRL_STATEMENTS, MODES, MOTIONS, row};
use crate::krl::writing::write::write_krl;
use crate::model::motion::Motion;
use crate::model::orientation::OrientationText;
use crate::model::parsed::Parsed;
use crate::model::program::RobotProgram;
use crate::model::target::{Configuration, StatedArm};
use crate::options::{ReadOptions, WriteOptions};
use crate::program_language::{ProgramLanguage, WrittenFile, of_run, with_ending};
use crate::table::StatementRow;
use crate::text::Name;
use crate::text::source::{FlatText, SourceFile};
use crate::writing::piece::Piece;

/// Variables that say how fast the arm moves beside `$VEL.CP`.
const DYNAMICS: [&str; 8] = [
    "ACC",
    "ACC_AXIS",
    "VEL_AXIS",
    "ACC_AXIS_C",
    "VEL_AXIS_C",
    "ACC_EXTAX",
    "VEL_EXTAX",
    "OV_PRO",
];

/// Settings of `BAS` that do.
const DYNAMICS_OF_BAS: [&str; 5] = ["VEL_PTP", "ACC_PTP", "ACC_CP", "PTP_PARAMS", "PTP_DAT"];

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

    fn called_files(&self, file: &SourceFile) -> Vec<String> {
        let mut names = names_before_brackets(file.bytes());
        // `BAS` and its like belong to the controller.
        names.retain(|name| Name::of(name.as_bytes()).is_none_or(|name| row(&name).is_none()));
        with_ending(names, "src")
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

    fn data_ending(&self) -> Option<&'static str> {
        Some("dat")
    }

    fn files_are_joined(&self) -> bool {
        true
    }

    fn needs_config(&self, files: &[SourceFile]) -> bool {
        krl_needs_config(files)
    }

    fn usual_tool_axis(&self) -> Vector3<f64> {
        -Vector3::x()
    }

    fn tool_axis_is_open(&self) -> bool {
        true
    }

    fn orientation_of_controller(&self) -> Option<OrientationText> {
        Some(OrientationText::Abc)
    }

    fn stated_arm(&self, configuration: &Configuration) -> StatedArm {
        let says_s = configuration.text.trim_start().starts_with(['S', 's']);
        let status = configuration.numbers.first().filter(|_| says_s);
        StatedArm::of_bits(status, [1, 2, 4])
    }

    fn words_of_arm(&self, arm: &StatedArm) -> Option<String> {
        Some(format!("S {}", arm.in_bits([1, 2, 4])?))
    }

    fn elbow_flag_is_up(&self) -> bool {
        true
    }

    fn wrist_is_sign_of_axis_5(&self) -> bool {
        true
    }

    fn name_of_external_axis(&self, axis: usize) -> String {
        format!("external axis E{}", axis + 1)
    }

    fn modes_of_motions(&self) -> &'static str {
        ", or how motions behind it go (`$ORI_TYPE`, `$CIRC_TYPE`, `$ACC`, `$APO`)"
    }

    fn code_of<'t>(&self, line: &'t str) -> &'t str {
        line.split(';').next().unwrap_or_default()
    }

    fn modes(&self) -> &'static [&'static [&'static str]] {
        MODES
    }

    fn modes_have_members(&self) -> bool {
        true
    }

    fn settings_in_motions(&self) -> &'static [&'static str] {
        IN_MOTIONS
    }

    fn sign_of_declaration(&self) -> Option<&'static str> {
        Some("={")
    }

    /// Motions of splines blend and turn otherwise.
    fn law_of_motion(&self, word: &str) -> Option<&'static str> {
        word.starts_with('S').then_some("a spline motion")
    }

    fn words_of_motion(&self, _motion: &Motion) -> Option<Vec<String>> {
        let passes = MOTIONS.iter().map(|row| row.pass.to_owned());
        Some(passes.collect())
    }

    fn order_words(&self) -> &'static [&'static str] {
        &[
            "&",
            "DEF",
            "DEFFCT",
            "DEFDAT",
            "END",
            "ENDFCT",
            "ENDDAT",
            "ENDIF",
            "ENDLOOP",
            "ENDFOR",
            "ENDWHILE",
            "ENDSWITCH",
            "DECL",
            ";FOLD",
            ";ENDFOLD",
            "; ENDFOLD",
            "INI",
            "$BASE",
            "$TOOL",
            "$VEL",
            "$APO",
            "PDAT_ACT",
            "FDAT_ACT",
            "LDAT_ACT",
            "BAS",
            "BASE_DATA",
            "TOOL_DATA",
            "$BWDSTART",
            "EXT",
            "EXTFCT",
            "INT ",
            "REAL ",
            "BOOL ",
            "E6POS ",
            "FRAME ",
            "POS ",
            "$ACC",
            // Followed, or refused where the tool would go or turn otherwise.
            "SPLINE",
            "ENDSPLINE",
            "$IPO_MODE",
            "$ORI_TYPE",
            "$CIRC_TYPE",
            "$CIRC_MODE",
        ]
    }

    fn states_dynamics(&self, words: &[&str]) -> bool {
        match words {
            ["VEL", "ORI1" | "ORI2", ..] => true,
            ["BAS", what, ..] => DYNAMICS_OF_BAS.contains(what),
            [first, rest @ ..] => {
                // After WITH they are valid for one motion.
                let with = rest.iter().position(|word| *word == "WITH");
                let own = with.map_or(&[][..], |with| &rest[with..]);
                (DYNAMICS.contains(first) && !rest.is_empty())
                    || own.iter().any(|word| DYNAMICS.contains(word))
            }
            [] => false,
        }
    }

    /// LIN and CIRC with `#VAR` do, and turn with `$VEL.ORI1` and `$VEL.ORI2`. Of motions of a spline nothing is published: they count as
    /// turns about one axis.
    fn swivels(&self, word: &[u8]) -> bool {
        word.eq_ignore_ascii_case(b"LIN") || word.eq_ignore_ascii_case(b"CIRC")
    }

    /// `$VEL.CP` takes no more.
    fn most_speed_mm_per_s(&self) -> Option<f64> {
        Some(3000.0)
    }

    fn numbers_frames(&self) -> bool {
        true
    }

    fn comment_behind_statement(&self) -> Option<&'static str> {
        Some(";")
    }

    fn routines(&self) -> [&'static [&'static str]; 2] {
        [&["DEF", "DEFFCT"], &["END", "ENDFCT"]]
    }

    fn opens_block(&self, words: &[String]) -> bool {
        let opening = ["IF", "FOR", "WHILE", "LOOP", "REPEAT", "SWITCH"];
        let first = words.first();
        first.is_some_and(|first| opening.contains(&first.as_str()))
    }
}

/// Names before an opening bracket, which calls have, and arrays as well; without those of the file's own routines.
fn names_before_brackets(bytes: &[u8]) -> Vec<String> {
    let (mut own, mut named) = (BTreeSet::new(), Vec::new());
    for line in bytes.split(|byte| *byte == b'\n') {
        let code = line.split(|byte| *byte == b';').next().unwrap_or_default();
        let is_part = |byte: &u8| byte.is_ascii_alphanumeric() || matches!(byte, b'_' | b'$');
        let mut words = code
            .split(|byte| !is_part(byte))
            .filter(|word| !word.is_empty());
        let is_header = words.any(|word| {
            [&b"DEF"[..], b"DEFFCT"]
                .iter()
                .any(|def| word.eq_ignore_ascii_case(def))
        });
        let parts: Vec<&[u8]> = code.split(|byte| *byte == b'(').collect();
        for part in &parts[..parts.len() - 1] {
            let name = part.trim_ascii_end().rsplit(|byte| !is_part(byte)).next();
            let name = name.filter(|name| !name.is_empty());
            let Some(name) = name.map(|name| String::from_utf8_lossy(name).into_owned()) else {
                continue;
            };
            match is_header {
                true => _ = own.insert(name.to_ascii_uppercase()),
                false => named.push(name),
            }
        }
    }
    named.retain(|name| !own.contains(&name.to_ascii_uppercase()));
    named
}
