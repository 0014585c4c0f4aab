//! The parts of URScript that a run and the writer ask for.

use std::collections::BTreeSet;
use std::marker::PhantomData;
use std::ops::Range;

use crate::interpreter::block_files::{BlockDialect, BlockLanguage, Facts};
use crate::interpreter::expression::{Argument, Expression, Operator};
use crate::interpreter::lexing::{Words, tokens_of};
use crate::interpreter::operation::two;
use crate::interpreter::reading::Grammar;
use crate::interpreter::run::{Dialect, MotionParts, Reason};
use crate::interpreter::token::{TokenFile, words_of};
use crate::interpreter::tree::{Choice, Flow, Leave};
use crate::interpreter::value::Datum;
use crate::model::Language;
use crate::model::motion::{FrameUse, Motion};
use crate::model::program::RobotProgram;
use crate::model::site::ReplacedText;
use crate::options::WriteOptions;
use crate::table::StatementRow;
use crate::text::Name;
use crate::text::number::short;
use crate::text::source::{Edits, SourceFile};
use crate::urscript::grammar::{GRAMMAR, WORDS, computed};
use crate::urscript::motion::{EFFECTS, End, Run, URSCRIPT_STATEMENTS, UrScript, motion_row, row};
use crate::writing::syntax::{PieceLiterals, Syntax, Wanted, names_of, replace_word};

/// The entry of URScript in the registry.
pub(crate) const URSCRIPT: BlockLanguage<UrScript> = BlockLanguage(PhantomData);

impl BlockDialect for UrScript {
    const LANGUAGE: Language = Language::UrScript;
    const FACTS: Facts = Facts {
        word: "urscript",
        name: "URScript",
        title: "Universal Robots URScript",
        endings: &["script", "urscript"],
        unread_endings: &[(
            "urp",
            "it holds the program tree of PolyScope, compressed, which is not read: export the script (saved on the pendant, a .script lies beside the .urp), and give that",
        )],
        comment: "#",
        statements: URSCRIPT_STATEMENTS,
        written: "Written: numbers of poses in place, in metres and as rotation vectors, poses that several motions use copied under a free name, further motions as movel or movep, and of circles as movec, with the same speed, TCP and frame. The pieces before the end of a divided motion blend within 0.1 mm.",
        held_word: "MOVE",
        order_words: &["DEF", "END", "GLOBAL", "LOCAL", "SET_TCP", "$"],
        laws: &[(&["MOVEP", "MOVEC"], "a process motion")],
        syntax: &UrScriptSyntax,
    };
    const WORDS: &'static Words = &WORDS;

    fn before() -> Self {
        Self {
            tool: FrameUse::stated("tcp", None, "the program"),
            tools: Vec::new(),
        }
    }
}

impl Dialect for UrScript {
    const OWN_COUNTER: bool = false;
    const DECLARES_BY_USE: bool = false;
    const JOINS_FILES: bool = true;
    const NO_MAIN: [&'static str; 2] = [
        "which `def` is the program is not known: none, or more than one, stands in no other and is called by none",
        "give the file of the program that cuts",
    ];
    const GRAMMAR: &'static Grammar = &GRAMMAR;
    const MODAL: &'static [&'static str] = &["set_tcp"];
    const EFFECTS: &'static [(&'static str, &'static str)] = EFFECTS;

    fn row(word: &[u8]) -> Option<&'static StatementRow> {
        row(word)
    }

    /// Lists are no vectors, and what is left of negative numbers is not said.
    fn operation(_: &Run<'_, '_>, operator: Operator, left: &Datum, right: &Datum) -> Datum {
        let is_list = |of: &Datum| of.parts().len() + of.members().len() > 0;
        let is_negative = |of: &Datum| of.as_number().is_some_and(|number| number < 0.0);
        let is_open = match operator {
            Operator::Equal | Operator::Unequal => false,
            Operator::Remainder => is_negative(left) || is_negative(right),
            _ => is_list(left) || is_list(right),
        };
        match is_open {
            true => Datum::unknown("how the controller computes it is not known here"),
            false => two(operator, left, right),
        }
    }

    fn computed(name: &Name, values: &[Datum]) -> Option<Datum> {
        computed(name, values)
    }

    fn function(
        run: &mut Run<'_, '_>,
        name: &Name,
        arguments: &[Argument],
        whole: &Expression,
    ) -> Option<Datum> {
        run.called_function(name, arguments, whole)
    }

    fn instruction(run: &mut Run<'_, '_>, tokens: &Range<usize>, _: Choice) -> Flow {
        run.run_call(tokens)
    }

    fn is_motion(word: &Name) -> bool {
        motion_row(word.letters()).is_some()
    }

    fn motion(
        run: &mut Run<'_, '_>,
        tokens: &Range<usize>,
        arguments: &[Argument],
    ) -> Result<Motion, Reason> {
        run.motion_of(tokens, arguments)
    }

    fn sets(run: &mut Run<'_, '_>, word: &[u8], value: &Expression) {
        if word == b"set_tcp" {
            run.set_tcp(value);
        }
    }

    fn leave(file: &TokenFile<'_>, tokens: &Range<usize>) -> Leave {
        WORDS.leave(file, tokens)
    }

    fn begin(run: &mut Run<'_, '_>) {
        run.own.tool = FrameUse::stated("tcp", run.options.frames.get("tcp"), "the program");
    }

    fn motion_parts(file: &TokenFile<'_>, tokens: &Range<usize>) -> MotionParts {
        let mut parts = MotionParts::default();
        let row = motion_row(file.word(tokens.start));
        let ends = row.map_or(&[][..], |row| &row.parameters[..row.ends]);
        let arguments = Self::arguments_of(file, tokens.start + 1..tokens.end);
        for (at, Argument { option, value }) in arguments.iter().enumerate() {
            let is_end = match option {
                Some(name) => ends.iter().any(|own| name.is(own)),
                None => at < ends.len(),
            };
            let end = value.as_ref().filter(|_| is_end).map(End::of);
            parts.ends.extend(end.iter().map(|end| end.pose.clone()));
            let others = match end {
                Some(end) => end.frame.into_iter().chain(end.others).collect(),
                None => Vec::from_iter(value),
            };
            parts.others.extend(others.into_iter().cloned());
        }
        parts
    }
}

/// Blend with which a piece passes its end: 0.1 mm. Where blends overlap the controller leaves motions out.
const PASSING: &str = "0.0001";

/// URScript.
pub(crate) struct UrScriptSyntax;

/// Makes a circle straight: another word, without the place on the circle and the mode. But for these, movep has the same parameters.
fn straight(source: &SourceFile, motion: &Motion, edits: &mut Edits) {
    let site = &motion.site;
    let Some((via, _)) = &site.via else { return };
    let keyword = &site.keyword;
    replace_word(source.part(keyword), "movep", keyword, edits);
    edits.replace(via.clone(), "");
    // Arguments after the end: acceleration, speed, blend, mode.
    let mut at = site.target_span.end;
    let rest = source.part(&(at..motion.span.end - 1));
    for (index, part) in rest.split(|byte| *byte == b',').enumerate() {
        let text = part.trim_ascii();
        if text.starts_with(b"mode") || index == 4 && !text.contains(&b'=') {
            edits.replace(at - 1..at + part.len(), "");
        }
        at += part.len() + 1;
    }
}

impl Syntax for UrScriptSyntax {
    fn names(&self, program: &RobotProgram) -> BTreeSet<Vec<u8>> {
        names_of(program, |bytes| words_of(&tokens_of(&WORDS.marks, bytes)))
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
        speed: Option<&[u8]>,
    ) -> Option<Vec<u8>> {
        let file = program.files.get(motion.file)?;
        let site = &motion.site;
        let mut edits = Edits::default();
        match &literals.via {
            Some((span, via)) => edits.replace(span.clone(), via.clone()),
            None => straight(file, motion, &mut edits),
        }
        edits.replace(site.target_span.clone(), literals.end.clone());
        if let (Some(site), Some(speed)) = (&site.speed, speed) {
            edits.replace(site.span.clone(), speed);
        }
        match &site.zone {
            Some(zone) => edits.replace(zone.clone(), PASSING),
            None => {
                let close = motion.span.end - 1;
                edits.replace(close..close, format!(", r={PASSING}"));
            }
        }
        edits.applied_to_part(file.bytes(), &motion.span)
    }

    fn replaced(
        &self,
        _: &SourceFile,
        text: &ReplacedText,
        wanted: &Wanted<'_>,
        options: &WriteOptions,
    ) -> Option<Vec<u8>> {
        let rotation = wanted.orientation.unwrap_or(text.pose.orientation);
        let (place, turn) = (1e-3 * wanted.position_mm, rotation.scaled_axis());
        let decimals = [options.position_decimals + 3, options.quaternion_decimals];
        let place = place.iter().map(|part| short(*part, decimals[0]));
        let turn = turn.iter().map(|part| short(*part, decimals[1]));
        let numbers: Vec<String> = place.chain(turn).collect();
        Some(format!("p[{}]", numbers.join(",")).into_bytes())
    }

    fn straighten(&self, program: &RobotProgram, motion: &Motion, edits: &mut Edits) {
        straight(&program.files[motion.file], motion, edits);
    }
}
