//! The ends of motions and where their numbers stand: literals, declarations, elements of arrays, offsets.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use crate::interpreter::expression::{Argument, Expression, Node};
use crate::interpreter::value::Datum;
use crate::model::site::{
    Declaration, DeclarationCopy, OffsetAxes, PartText, PoseText, ReplacedText, TargetSite,
};
use crate::model::target::PoseTarget;
use crate::rapid::lex::Kind;
use crate::rapid::literals::{numbers_in, pose_of, text_of};
use crate::rapid::run::{Reason, Run};
use crate::rapid::symbols::Symbols;
use crate::rapid::tree::TokenFile;
use crate::text::name::Name;
use crate::text::number::NumberText;

/// An end that is known.
pub(crate) struct Found {
    pub pose: PoseTarget,
    pub site: TargetSite,
}

/// The declared targets of a program.
#[derive(Debug, Default)]
pub(crate) struct Targets {
    pub declarations: Vec<Declaration>,
    /// Names of the declarations.
    names: Vec<Name>,
    /// By the file and the begin of the literal.
    known: BTreeMap<(usize, usize), usize>,
    /// Names in statements that a motion ends at, by file and begin.
    ends: BTreeMap<(usize, usize), Name>,
}

const WRITE_IT: &str =
    "write the motion with a literal or declared target, or leave it as written when reading";

const IN_NUMBERS: &str = "write the target in numbers: [[x,y,z],[q1,q2,q3,q4],[cf1,cf4,cf6,cfx],[six external axes]], with q1 to q4 of length 1 in all, cf1 to cfx whole, and 9E9 for axes that are not there";
const OFFSETS: &str = "write the offsets as numbers, or leave the motion as written when reading";
const GIVE_IT: &str = "give the module that declares it as well";

impl Run<'_, '_> {
    /// The end that an expression in a motion statement is.
    pub(super) fn end(
        &mut self,
        expression: &Expression,
        statement: &Range<usize>,
    ) -> Result<Found, Reason> {
        let value = self.value(expression);
        let shown = self.text(expression);
        let pose = pose_of(self.files, &value).map_err(|reason| match &expression.node {
            Node::List(_) => (reason, IN_NUMBERS),
            Node::Call(name, _) if name.is("OFFS") || name.is("RELTOOL") => (reason, OFFSETS),
            Node::Word(name) if self.root(name).is_none() => (reason, GIVE_IT),
            Node::Word(_) | Node::Element(..) if value.unknown_reason().is_none() => {
                match value.parts().len() {
                    4 => (format!("`{shown}`: {reason}"), WRITE_IT),
                    _ => (format!("`{shown}` is no robtarget"), WRITE_IT),
                }
            }
            _ => (reason, WRITE_IT),
        })?;
        let site = self.site(expression, (&value, &pose), statement);
        Ok(Found { pose, site })
    }

    /// Where the numbers of an end stand. Where the statement has them by other names or computes them, another end is written in place of
    /// the expression.
    fn site(
        &mut self,
        expression: &Expression,
        (value, pose): (&Datum, &PoseTarget),
        statement: &Range<usize>,
    ) -> TargetSite {
        let file = self.file();
        let span = file.span(&expression.tokens);
        let is_here = |_: &PoseText| {
            let literal = value.literal;
            literal.is_some_and(|literal| literal.is_within(file.index, statement))
        };
        let found = match &expression.node {
            Node::List(_) => text_of(value).filter(is_here).map(TargetSite::Literal),
            Node::Word(name) => self.declared(expression, (value, pose), name),
            Node::Element(of, _) => match &of.node {
                Node::Word(name) => self.declared(expression, (value, pose), name),
                _ => None,
            },
            Node::Call(name, arguments) if name.is("OFFS") || name.is("RELTOOL") => {
                self.offset(name, arguments, &span)
            }
            _ => None,
        };
        found.unwrap_or_else(|| {
            let part = |at: usize, expression: &Expression| PartText {
                span: file.span(&expression.tokens),
                numbers: (value.parts().get(at))
                    .and_then(|part| numbers_in(part, file.index, &span))
                    .unwrap_or_default(),
            };
            TargetSite::Replaced(Box::new(ReplacedText {
                pose: pose.clone(),
                parts: match &expression.node {
                    Node::List(parts) => match parts.as_slice() {
                        [place, turn, ..] => Some([part(0, place), part(1, turn)]),
                        _ => None,
                    },
                    _ => None,
                },
                span: span.clone(),
            }))
        })
    }

    /// The declaration of a name or of an element of an array, where its first value is what the motion ends at.
    fn declared(
        &mut self,
        expression: &Expression,
        (value, pose): (&Datum, &PoseTarget),
        name: &Name,
    ) -> Option<TargetSite> {
        let file = self.file();
        let text = text_of(value)?;
        let index = self.datum_of(self.root(name)?)?;
        let datum = &self.symbols.data[index];
        let home = &self.files[datum.file];
        let whole = home.span(&datum.node.tokens);
        if !value.literal?.is_within(datum.file, &whole) {
            return None;
        }
        let span = file.span(&expression.tokens);
        let ends = &mut self.targets.ends;
        ends.insert((file.index, span.start), *name);
        let key = (text.file, text.whole.start);
        if let Some(declaration) = self.targets.known.get(&key) {
            let declaration = *declaration;
            return Some(TargetSite::Declared {
                declaration,
                name: span,
            });
        }
        let is_whole = matches!(expression.node, Node::Word(_));
        let named = home.span(&(datum.node.name_at..datum.node.name_at + 1));
        let copy = match is_whole {
            true => DeclarationCopy::Statement,
            false => DeclarationCopy::Around {
                before: b"CONST robtarget ".to_vec(),
                middle: b":=".to_vec(),
                after: b";".to_vec(),
            },
        };
        let declaration = self.targets.declarations.len();
        self.targets.known.insert(key, declaration);
        self.targets.names.push(*name);
        self.targets.declarations.push(Declaration {
            statement: whole,
            name: named,
            text,
            pose: pose.clone(),
            keeps_value: false,
            copy,
        });
        Some(TargetSite::Declared {
            declaration,
            name: span,
        })
    }

    /// `Offs` and `RelTool` of a target that is written in numbers: their lengths are written otherwise.
    fn offset(
        &mut self,
        name: &Name,
        arguments: &[Argument],
        call: &Range<usize>,
    ) -> Option<TargetSite> {
        let file = self.file();
        let axes = match name.is("OFFS") {
            true => OffsetAxes::WorkObject,
            false => OffsetAxes::Tool,
        };
        let ordered: Vec<&Expression> = (arguments.iter())
            .filter(|argument| argument.option.is_none())
            .filter_map(|argument| argument.value.as_ref())
            .collect();
        let [base, lengths @ ..] = ordered.as_slice() else {
            return None;
        };
        let base = self.value(base);
        let literal = text_of(&base)?;
        let mut number = |length: &&Expression| {
            let value = self.value(length).as_number()?;
            let span = file.span(&length.tokens);
            Some(NumberText { span, value })
        };
        let numbers: Option<Vec<NumberText>> = lengths.iter().map(&mut number).collect();
        Some(TargetSite::Offset {
            call: call.clone(),
            arguments: Box::new(numbers?.try_into().ok()?),
            axes,
            base: Box::new(pose_of(self.files, &base).ok()?),
            literal: Box::new(literal),
        })
    }
}

impl Targets {
    /// Notes which declarations something else than the motions that end at them rests on.
    pub(super) fn with_other_uses(
        mut self,
        files: &[TokenFile<'_>],
        symbols: &Symbols<'_>,
    ) -> Self {
        let names: BTreeSet<Name> = self.names.iter().copied().collect();
        if names.is_empty() {
            return self;
        }
        let mut uses: BTreeMap<Name, usize> = BTreeMap::new();
        for file in files {
            for (at, token) in file.tokens.iter().enumerate() {
                if token.kind == Kind::Word
                    && let Some(name) = Name::of(file.word(at)).filter(|name| names.contains(name))
                {
                    *uses.entry(name).or_default() += 1;
                }
            }
        }
        let declared = symbols.data.iter().map(|datum| datum.node.name);
        for name in declared.chain(self.ends.values().copied()) {
            if let Some(uses) = uses.get_mut(&name) {
                *uses = uses.saturating_sub(1);
            }
        }
        for (declaration, name) in self.declarations.iter_mut().zip(&self.names) {
            declaration.keeps_value = uses.get(name).is_some_and(|uses| *uses > 0);
        }
        self
    }
}
