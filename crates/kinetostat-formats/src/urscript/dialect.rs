//! The parts of URScript that a run asks for.

use std::marker::PhantomData;
use std::ops::Range;

use crate::interpreter::block_files::{BlockDialect, BlockLanguage, Facts};
use crate::interpreter::expression::{Argument, Expression, Operator};
use crate::interpreter::flow::{Flow, Leave};
use crate::interpreter::operation::two;
use crate::interpreter::reading::Grammar;
use crate::interpreter::run::{Dialect, MotionParts, Reason};
use crate::interpreter::token::TokenFile;
use crate::interpreter::tree::Choice;
use crate::interpreter::value::Datum;
use crate::interpreter::words::Words;
use crate::model::frame::FrameUse;
use crate::model::language::Language;
use crate::model::motion::Motion;
use crate::table::StatementRow;
use crate::text::name::Name;
use crate::urscript::functions::computed;
use crate::urscript::grammar::{GRAMMAR, WORDS};
use crate::urscript::motion::{End, Run, UrScript};
use crate::urscript::table::{EFFECTS, URSCRIPT_STATEMENTS, motion_row, row};
use crate::urscript::write::UrScriptSyntax;

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
