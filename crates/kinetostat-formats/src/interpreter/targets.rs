//! The declared targets of a program, and what rests on their values.

use std::collections::{BTreeMap, BTreeSet};

use crate::interpreter::symbols::Symbols;
use crate::interpreter::token::{Kind, TokenFile};
use crate::model::site::Declaration;
use crate::text::Name;

/// The declared targets of a program.
#[derive(Debug, Default)]
pub(crate) struct Targets {
    pub declarations: Vec<Declaration>,
    /// Names of the declarations.
    pub names: Vec<Name>,
    /// Known literals by file and first byte.
    pub known: BTreeMap<(usize, usize), usize>,
    /// Names in statements that a motion ends at, by file and begin.
    pub ends: BTreeMap<(usize, usize), Name>,
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
