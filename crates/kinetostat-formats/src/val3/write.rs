//! Adapter of the writer for VAL3: a point without numbers of its own is moved by `appro`.

use std::collections::BTreeSet;

use nalgebra::Isometry3;

use crate::interpreter::token::words_of;
use crate::model::motion::Motion;
use crate::model::program::RobotProgram;
use crate::model::site::ReplacedText;
use crate::options::WriteOptions;
use crate::text::edits::Edits;
use crate::text::number::short;
use crate::text::source::SourceFile;
use crate::val3::frames::{numbers_of, trsf_of};
use crate::val3::xml::content_of;
use crate::writing::syntax::{PieceLiterals, Syntax, Wanted, replace_word};

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
