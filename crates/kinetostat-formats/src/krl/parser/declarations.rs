//! Declarations of data, and the values that data lists state.

use std::ops::Range;

use crate::interpreter::tree::{Change, DatumNode, Preset, Sight};
use crate::krl::aggregate::literal_index;
use crate::krl::lex::assignment;
use crate::krl::parser::cursor::Parser;

impl Parser<'_, '_> {
    /// `[GLOBAL] [DECL] [CONST] type name[3]=value, name`.
    pub(super) fn declaration(&mut self, tokens: &Range<usize>) {
        let mut at = tokens.start;
        let (mut is_global, mut is_constant, mut is_other) = (false, false, false);
        while let Some(name) = (at < tokens.end).then(|| self.file.name(at)).flatten() {
            is_global |= name.is("GLOBAL");
            is_constant |= name.is("CONST");
            is_other |= ["STRUC", "ENUM", "SIGNAL", "EXT", "EXTFCT"]
                .iter()
                .any(|word| name.is(word));
            if !["GLOBAL", "DECL", "CONST"].iter().any(|word| name.is(word)) {
                break;
            }
            at += 1;
        }
        if is_other {
            return;
        }
        let Some(type_name) = (at < tokens.end).then(|| self.file.name(at)).flatten() else {
            return self.fault(tokens, "nothing is declared here", "write DECL type name");
        };
        let mut found = Vec::new();
        let mut start = at + 1;
        while start < tokens.end {
            let end = self
                .file
                .find(start..tokens.end, b',')
                .unwrap_or(tokens.end);
            let Some(name) = self.file.name(start) else {
                return self.fault(
                    tokens,
                    "a declared name is missing or longer than 24 characters",
                    "write DECL type name",
                );
            };
            let assign = assignment(self.file, &(start..end));
            let close = self.file.is(start + 1, b'[').then(|| {
                let close = self.file.find(start + 2..end, b']');
                start + 2..close.unwrap_or(end)
            });
            found.push(DatumNode {
                change: match is_constant {
                    true => Change::Constant,
                    false => Change::Variable,
                },
                sight: match is_global {
                    true => Sight::Everywhere,
                    false => Sight::Module,
                },
                type_name,
                name,
                name_at: start,
                tokens: tokens.clone(),
                initial: assign.map(|assign| assign + 1..end),
                dimensions: close.filter(|sizes| !sizes.is_empty()),
                is_alone: start == at + 1 && end == tokens.end,
            });
            start = end + 1;
        }
        if found.is_empty() {
            return self.fault(tokens, "nothing is declared here", "write DECL type name");
        }
        match &mut self.routine {
            Some(routine) => routine.data.extend(found),
            None => self.content.data.extend(found),
        }
    }

    /// `name[3]=value` in a data list.
    pub(super) fn preset(&mut self, tokens: &Range<usize>) {
        let Some(name) = self.file.name(tokens.start) else {
            return;
        };
        let Some(assign) = assignment(self.file, tokens) else {
            return;
        };
        if let Some(index) = literal_index(self.file, tokens.start + 1..assign) {
            self.content.presets.push(Preset {
                name,
                name_at: tokens.start,
                index: index as usize,
                tokens: tokens.clone(),
                value: assign + 1..tokens.end,
            });
        }
    }
}
