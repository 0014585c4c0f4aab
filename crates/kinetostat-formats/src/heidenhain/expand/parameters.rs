//! Q parameters: what gives them values, and blocks with values in their place.

use crate::flat_run::BlockId;
use crate::heidenhain::digits::length;
use crate::heidenhain::expand::expression::value_of;
use crate::heidenhain::expand::run::{Fault, Run};
use crate::heidenhain::expand::values::Parameters;
use crate::heidenhain::expand::values::{STATE_VALUE, begins_value, no_value};
use crate::heidenhain::tilt::is_of_plane;
use crate::heidenhain::words::{Value, Word};
use crate::text::edits::Edits;
use crate::text::number::short;

impl Run<'_> {
    /// Puts values into parameters: `Q1 = ...`, more of them in a cycle.
    pub(crate) fn assign(&mut self, at: BlockId, words: &[Word]) -> Result<(), Fault> {
        let bytes = self.programs[at.file].file.bytes();
        let is_name = |word: &Word| {
            matches!(word.letters.letters(), b"Q" | b"QL" | b"QR") && word.whole().is_some()
        };
        let starts: Vec<usize> = (0..words.len().saturating_sub(1))
            .filter(|index| is_name(&words[*index]) && begins_value(&words[index + 1], bytes))
            .collect();
        if starts.is_empty() {
            return Err(self.fault(at, "no parameter gets a value here", "write Q1 = ..."));
        }
        for (order, index) in starts.iter().enumerate() {
            let next = starts.get(order + 1).copied().unwrap_or(words.len());
            let name = &words[*index];
            let key = format!(
                "{}{}",
                String::from_utf8_lossy(name.letters.letters()),
                name.whole().unwrap_or(0)
            );
            // Comments between are no words.
            let parts = words[index + 1..next]
                .iter()
                .map(|word| &bytes[word.span.clone()]);
            let text = parts.collect::<Vec<_>>().join(&b' ');
            let text = text.strip_prefix(b"=").unwrap_or(&text).trim_ascii();
            if key == "Q208" {
                self.rapid_out = text.eq_ignore_ascii_case(b"MAX");
            }
            if ["MAX", "FMAX", "AUTO", "FAUTO"]
                .iter()
                .any(|w| text.eq_ignore_ascii_case(w.as_bytes()))
            {
                self.parameters.remove(&key);
                continue;
            }
            let value = value_of(text, &self.parameters);
            let value = value.map_err(|reason| self.fault(at, reason, STATE_VALUE))?;
            self.parameters.insert(key, value);
        }
        Ok(())
    }

    /// The text of a block with values in place of its parameters.
    pub(crate) fn text(&self, at: BlockId, words: &[Word]) -> Result<Vec<u8>, Fault> {
        let program = &self.programs[at.file];
        let block = &program.blocks[at.block];
        let bytes = program.file.bytes();
        let mut edits = Edits::default();
        for (index, word) in words.iter().enumerate() {
            let (span, sign, name) = match &word.value {
                Value::Parameter { span, sign, name } => (span.clone(), *sign, name.clone()),
                // `= Q5` without a sign.
                Value::Number(number)
                    if matches!(word.letters.letters(), b"Q" | b"QL" | b"QR")
                        && index > 0
                        && begins_value(&words[index - 1], bytes) =>
                {
                    (word.span.clone(), 1.0, word.span.start..number.span.end)
                }
                _ => continue,
            };
            let key: Vec<u8> = bytes[name]
                .iter()
                .filter(|byte| !byte.is_ascii_whitespace())
                .map(u8::to_ascii_uppercase)
                .collect();
            let key = String::from_utf8_lossy(&key).into_owned();
            let held = self.parameters.value(&key);
            if held.is_none() && is_of_plane(word, bytes) {
                continue;
            }
            let Some(value) = held else {
                return Err(self.fault(at, no_value(&key), STATE_VALUE));
            };
            let plain = ["F", "S", "M", "CALL", "DEF"]
                .iter()
                .any(|letters| word.is(letters));
            let text = match plain {
                true => short(sign * value, 3),
                false => length(sign * value, self.unit_mm),
            };
            edits.replace(span, text);
        }
        let text = edits.applied_to_part(bytes, &block.text);
        text.ok_or_else(|| {
            self.fault(
                at,
                "its words overlap",
                "write the block as the control shows it",
            )
        })
    }

    pub(crate) fn substituted(&mut self, at: BlockId, words: &[Word]) -> Result<Vec<u8>, Fault> {
        let text = self.text(at, words)?;
        self.write(&text, at);
        Ok(text)
    }
}
