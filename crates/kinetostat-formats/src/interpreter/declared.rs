//! Declared targets at which motions end: a correction changes their numbers, or those of a copy.

use std::ops::Range;

use crate::interpreter::expression::{Expression, Node};
use crate::interpreter::run::{Dialect, Run};
use crate::interpreter::tree::DatumNode;
use crate::model::site::{Declaration, DeclarationCopy, PoseText, TargetSite};
use crate::model::target::PoseTarget;

/// Texts around the name and the value of a further declaration.
pub(crate) struct Around {
    pub before: fn(&DatumNode) -> String,
    pub middle: &'static [u8],
    pub after: &'static [u8],
}

impl<D: Dialect> Run<'_, '_, D> {
    /// The declaration of a name or of an element of an array, where its first value, of which this is the text, is what the
    /// motion ends at.
    pub(crate) fn declared(
        &mut self,
        expression: &Expression,
        text: PoseText,
        pose: &PoseTarget,
        around: &Around,
    ) -> Option<TargetSite> {
        let file = self.file();
        let name = match &expression.node {
            Node::Word(name) => name,
            Node::Element(of, _) => match &of.node {
                Node::Word(name) => name,
                _ => return None,
            },
            _ => return None,
        };
        let index = self.datum_of(self.root(name)?)?;
        let datum = &self.symbols.data[index];
        let home = &self.files[datum.file];
        let is_in = |tokens: &Range<usize>| {
            let Range { start, end } = home.span(tokens);
            text.file == datum.file && start <= text.whole.start && text.whole.end <= end
        };
        let preset = datum.elements.values().find(|preset| is_in(&preset.tokens));
        let (statement, name_at) = match preset {
            Some(preset) => (&preset.tokens, preset.name_at),
            None if is_in(&datum.node.tokens) => (&datum.node.tokens, datum.node.name_at),
            None => return None,
        };
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
        let is_whole = matches!(expression.node, Node::Word(_)) && datum.node.is_alone;
        let named = home.span(&(name_at..name_at + 1));
        let copy = match is_whole && preset.is_none() {
            true => DeclarationCopy::Statement,
            false => DeclarationCopy::Around {
                before: (around.before)(datum.node).into_bytes(),
                middle: around.middle.to_vec(),
                after: around.after.to_vec(),
            },
        };
        let declaration = self.targets.declarations.len();
        self.targets.known.insert(key, declaration);
        self.targets.names.push(*name);
        self.targets.declarations.push(Declaration {
            statement: home.span(statement),
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
}
