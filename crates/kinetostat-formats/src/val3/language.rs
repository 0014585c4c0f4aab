//! Facts and acts of VAL3 that files outside this folder ask for, and the adapter of the writer.

use std::collections::BTreeSet;

use nalgebra::Isometry3;

use crate::error::WriteError;
use crate::flat_run::RefusedRun;
use crate::interpreter::token::words_of;
use crate::model::motion::Motion;
use crate::model::parsed::Parsed;
use crate::model::program::RobotProgram;
use crate::model::site::ReplacedText;
use crate::options::{ReadOptions, WriteOptions};
use crate::program_language::{ProgramLanguage, WrittenFile, of_run};
use crate::table::StatementRow;
use crate::text::number::short;
use crate::text::source::{Edits, FlatText, SourceFile};
use crate::val3::frames::{numbers_of, trsf_of};
use crate::val3::instructions::VAL3_STATEMENTS;
use crate::val3::reader::{below_begin, called_by, expand_val3, is_program, parse_val3};
use crate::val3::xml::content_of;
use crate::writing::motions::write_with;
use crate::writing::piece::Piece;
use crate::writing::syntax::{PieceLiterals, Syntax, Wanted, replace_word};

/// Staubli VAL3.
pub(crate) struct Val3Language;

impl ProgramLanguage for Val3Language {
    fn word(&self) -> &'static str {
        "val3"
    }

    fn name(&self) -> &'static str {
        "VAL3"
    }

    fn title(&self) -> &'static str {
        "Staubli VAL3"
    }

    fn endings(&self) -> &'static [&'static str] {
        &["pgx", "dtx", "pjx"]
    }

    fn comment(&self) -> &'static str {
        "//"
    }

    fn statements(&self) -> &'static [StatementRow] {
        VAL3_STATEMENTS
    }

    fn written(&self) -> &'static str {
        "Written: numbers of points in place, in the data of the application; points that several motions use copied under a free name; points that are computed, or of which numbers are left out, moved by appro; further motions as movel or movec, with the same description of speed and blending."
    }

    fn parse(&self, files: Vec<SourceFile>, options: &ReadOptions) -> Parsed {
        parse_val3(files, options)
    }

    fn write(
        &self,
        program: &RobotProgram,
        pieces: &[Piece],
        options: &WriteOptions,
    ) -> Result<Vec<WrittenFile>, WriteError> {
        write_with(program, pieces, options, &Val3Syntax)
    }

    fn expand(
        &self,
        files: &[SourceFile],
        options: &ReadOptions,
    ) -> Result<Option<FlatText>, RefusedRun> {
        of_run(expand_val3(files, options))
    }

    fn stays_beside_flat(&self, file: &SourceFile) -> bool {
        !is_program(file)
    }

    fn called_files(&self, file: &SourceFile) -> Vec<String> {
        called_by(file)
    }

    fn data_ending(&self) -> Option<&'static str> {
        Some("dtx")
    }

    /// Data and project of the application, and programs that are called.
    fn files_beside(&self, file: &SourceFile, folder: &[String]) -> Vec<String> {
        let called = called_by(file);
        let belongs = |name: &&String| {
            let lower = name.to_ascii_lowercase();
            lower.ends_with(".dtx")
                || lower.ends_with(".pjx")
                || called.iter().any(|own| own.eq_ignore_ascii_case(&lower))
        };
        folder.iter().filter(belongs).cloned().collect()
    }

    fn written_endings(&self) -> &'static [&'static str] {
        &["pgx"]
    }

    fn header_place(&self, program: &[u8], _: usize) -> Option<usize> {
        below_begin(program)
    }

    /// Lines of XML take no comment.
    fn takes_origin(&self, _: &[u8]) -> bool {
        false
    }

    fn comment_behind_statement(&self) -> Option<&'static str> {
        Some("//")
    }

    /// XML around a program, and what only waits.
    fn order_words(&self) -> &'static [&'static str] {
        &["<", "]]>", "BEGIN", "END", "WAITENDMOVE"]
    }

    fn speed_remedy(&self) -> &'static str {
        "state tvel of its description of motion (tmax in the data) as a number of mm/s, or state unstated_feed_mm_per_s in the template"
    }

    fn opens_block(&self, words: &[String]) -> bool {
        let opening = ["IF", "FOR", "WHILE", "DO", "SWITCH"];
        words
            .first()
            .is_some_and(|first| opening.contains(&first.as_str()))
    }

    /// Signs of XML in a text would break a program that is not in CDATA.
    fn header_is_mark(&self) -> bool {
        true
    }
}

// Adapter of the writer for VAL3: a point without numbers of its own is moved by `appro`.

/// VAL3.
pub(crate) struct Val3Syntax;

impl Syntax for Val3Syntax {
    fn names(&self, program: &RobotProgram) -> BTreeSet<Vec<u8>> {
        let mut names = BTreeSet::new();
        for (index, file) in program.files.iter().enumerate() {
            let content = content_of(index, file, &mut BTreeSet::new(), &mut Vec::new());
            let words = words_of(&content.file.tokens).into_iter();
            names.extend(words.map(|word| file.part(&word).to_ascii_uppercase()));
        }
        names
    }

    fn declares_pieces(&self) -> bool {
        true
    }

    fn writes_circles(&self) -> bool {
        true
    }

    fn is_written_flat(&self) -> bool {
        true
    }

    fn piece(
        &self,
        program: &RobotProgram,
        motion: &Motion,
        literals: &PieceLiterals,
        _: Option<&[u8]>,
    ) -> Option<Vec<u8>> {
        let file = program.files.get(motion.file)?;
        let mut edits = Edits::default();
        match &literals.via {
            Some((span, via)) => edits.replace(span.clone(), via.clone()),
            None => self.straighten(program, motion, &mut edits),
        }
        edits.replace(motion.site.target_span.clone(), literals.end.clone());
        edits.applied_to_part(file.bytes(), &motion.span)
    }

    /// `appro(point,{x,y,z,rx,ry,rz})`: the numbers of one that is there, or a further one about what names the point.
    fn replaced(
        &self,
        file: &SourceFile,
        text: &ReplacedText,
        wanted: &Wanted<'_>,
        options: &WriteOptions,
    ) -> Option<Vec<u8>> {
        let orientation = wanted.orientation.unwrap_or(text.pose.orientation);
        let wanted = Isometry3::from_parts(wanted.position_mm.into(), orientation);
        let own = std::str::from_utf8(file.part(&text.span)).ok()?;
        let (before, by, after) = match last_trsf(own) {
            Some((before, by)) => (before.to_owned(), by, "})"),
            None => (format!("appro({own},{{"), [0.0; 6], "})"),
        };
        let base = text.pose.isometry() * trsf_of(by)?.inverse();
        let [.., a, b, c] = by;
        let numbers = numbers_of(&(base.inverse() * wanted), [a, b, c]);
        let decimals = |at: usize| {
            if at < 3 {
                options.position_decimals
            } else {
                options.angle_decimals
            }
        };
        let numbers = numbers
            .iter()
            .enumerate()
            .map(|(at, number)| short(*number, decimals(at)));
        Some(
            format!(
                "{before}{}{after}",
                numbers.collect::<Vec<String>>().join(",")
            )
            .into_bytes(),
        )
    }

    fn straighten(&self, program: &RobotProgram, motion: &Motion, edits: &mut Edits) {
        let site = &motion.site;
        if let Some((span, _)) = &site.via {
            let written = program.files[motion.file].part(&site.keyword);
            replace_word(written, "movel", &site.keyword, edits);
            edits.replace(span.clone(), "");
        }
    }
}

/// The numbers with which a call of `appro` ends, and the text before them.
fn last_trsf(text: &str) -> Option<(&str, [f64; 6])> {
    let inner = text.strip_suffix(')')?.trim_end().strip_suffix('}')?;
    let open = inner.rfind('{')? + 1;
    let is_appro =
        text.get(..5)?.eq_ignore_ascii_case("appro") && inner[..open - 1].trim_end().ends_with(',');
    let numbers = inner[open..]
        .split(',')
        .map(|number| number.trim().parse::<f64>().ok());
    let numbers: Vec<f64> = numbers.collect::<Option<_>>().filter(|_| is_appro)?;
    Some((&text[..open], numbers.try_into().ok()?))
}
