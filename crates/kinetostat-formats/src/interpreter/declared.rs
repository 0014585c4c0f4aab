//! Declared targets at which motions end: a correction changes their numbers, or those of a copy.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use crate::interpreter::expression::{Expression, Node};
use crate::interpreter::run::{Dialect, Run};
use crate::interpreter::symbols::Symbols;
use crate::interpreter::token::{Kind, TokenFile};
use crate::interpreter::tree::DatumNode;
use crate::model::site::{Declaration, DeclarationCopy, PoseText, TargetSite};
use crate::model::target::PoseTarget;
use crate::text::name::Name;

/// Texts around the name and the value of a further declaration.
pub(crate) struct Around {
    pub before: fn(&DatumNode) -> String,
    pub middle: &'static [u8],
    pub after: &'static [u8],
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

impl Targets {
    /// A name in a statement that ends elsewhere rests on the value of its declaration.
    pub(crate) fn is_no_end(&mut self, file: usize, start: usize) {
        self.ends.remove(&(file, start));
    }

    /// Notes which declarations something else than the motions that end at them rests on.
    pub(crate) fn with_other_uses(
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
        let declared = symbols.data.iter().flat_map(|datum| {
            let elements = datum.elements.values().map(|preset| preset.name);
            let own = datum
                .elements
                .values()
                .all(|own| own.name_at != datum.node.name_at);
            elements.chain(own.then_some(datum.node.name))
        });
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
