//! Values that the caller states, and the treatment of blocks that a switch at the machine leaves out.

use std::collections::BTreeMap;

use crate::text::source::Finding;

/// A value that only the controller knows, as the caller states it.
#[derive(Debug, Clone, PartialEq)]
pub enum StatedValue {
    /// A number.
    Number(f64),
    /// TRUE or FALSE.
    Truth(bool),
    /// Any other text.
    Text(String),
}

/// Findings on the values that the caller states for a program in blocks, checked against its bytes.
pub(crate) fn told_of_values(values: &BTreeMap<String, StatedValue>, bytes: &[u8]) -> Vec<Finding> {
    let text = String::from_utf8_lossy(bytes).to_ascii_uppercase();
    let names = |name: &str| {
        let mut found = text.match_indices(name);
        found
            .any(|(at, _)| !text[at + name.len()..].starts_with(|next: char| next.is_ascii_digit()))
    };
    let finding = |(name, value): (&String, &StatedValue)| {
        let name = name.to_ascii_uppercase();
        let value = match value {
            StatedValue::Number(number) => number.to_string(),
            StatedValue::Truth(truth) => truth.to_string(),
            StatedValue::Text(text) => text.clone(),
        };
        let message = match names(&name) {
            true => format!(
                "`{name}` is {value}, as is stated, unless the program gives it another value"
            ),
            false => format!("a value of `{name}` is stated, and the program does not name it"),
        };
        Finding {
            file: 0,
            line: 1,
            message,
        }
    };
    values.iter().map(finding).collect()
}

/// Reason and remedy of a refused block with a slash.
pub(crate) const SLASHED: (&str, &str) = (
    "whether the block runs, depends on a switch at the machine (/)",
    "say it (--block-delete run or skip), or take the slash out, or the block",
);

/// Treatment of blocks with a slash (SINUMERIK: `/N50`, `/0` to `/9`; Heidenhain: `/12 L X+5`), which a switch at the machine skips.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SlashBlocks {
    /// They are refused with their lines, but for those that change neither places nor what follows.
    #[default]
    Refused,
    /// They run, with a finding.
    Run,
    /// They are carried as they are written, and do nothing, with a finding.
    Skipped,
}
