//! Declarations of data and parameters.

use crate::interpreter::token::Kind;
use crate::interpreter::tree::{Change, DatumNode, Parameter, Sight};
use crate::rapid::parser::cursor::Parser;
use crate::text::name::Name;

impl Parser<'_, '_> {
    /// Parses a declaration: `None` if none begins here, `Some(None)` if it is faulty, which is noted.
    pub(super) fn datum(&mut self, start: usize, sight: Sight) -> Option<Option<DatumNode>> {
        self.takes("TASK");
        let words = [
            ("CONST", Change::Constant),
            ("PERS", Change::Persistent),
            ("VAR", Change::Variable),
        ];
        let (_, change) = words.into_iter().find(|(word, _)| self.takes(word))?;
        let (type_name, name) = (self.name(), self.name());
        let open = self.at;
        while self
            .kind()
            .is_some_and(|kind| kind != Kind::Assign && kind != Kind::Symbol(b';'))
            && !self.is_keyword(self.at)
        {
            self.at += 1;
        }
        let dimensions = open..self.at;
        let assigned = self.kind() == Some(Kind::Assign);
        let first = self.at + 1;
        let tokens = self.rest_of_statement(start);
        let (Some((type_name, _)), Some((name, name_at))) = (type_name, name) else {
            return Some(None);
        };
        if !dimensions.is_empty() && self.file.word(open) != b"{" {
            self.fault(
                dimensions.clone(),
                "it does not belong into a declaration",
                "write the type, the name, and := value",
            );
            return Some(None);
        }
        Some(Some(DatumNode {
            change,
            sight,
            type_name,
            name,
            name_at,
            dimensions: (dimensions.len() > 2).then(|| dimensions.start + 1..dimensions.end - 1),
            initial: assigned.then(|| first..tokens.end.saturating_sub(1).max(first)),
            tokens,
            is_alone: true,
        }))
    }

    /// To behind the closing parenthesis.
    pub(super) fn parameters(&mut self) -> Vec<Parameter> {
        let mut found = Vec::new();
        let (mut changes, mut is_optional) = (false, false);
        let mut last = None;
        while let Some(kind) = self.kind() {
            match kind {
                Kind::Word if ["INOUT", "VAR", "PERS"].iter().any(|word| self.is(word)) => {
                    changes = true
                }
                Kind::Word => last = Name::of(self.file.word(self.at)),
                Kind::Symbol(b',' | b'|' | b'\\' | b')') => {
                    found.extend(last.take().map(|name| Parameter {
                        name,
                        changes,
                        is_optional,
                    }));
                    changes = false;
                    // Alternatives (`\switch a | switch b`) are options as the first one is.
                    is_optional = match kind {
                        Kind::Symbol(b'|') => is_optional,
                        _ => kind == Kind::Symbol(b'\\'),
                    };
                }
                Kind::Symbol(b';') => break,
                _ => {}
            }
            self.at += 1;
            if kind == Kind::Symbol(b')') {
                break;
            }
        }
        found
    }
}
