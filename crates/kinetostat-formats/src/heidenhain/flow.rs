//! The order in which the blocks of a file run, where each runs once, and the names of the programs that they call (CALL PGM).

use std::collections::BTreeMap;

use crate::heidenhain::blocks::{Block, blocks_of};
use crate::heidenhain::words::{Value, Word};
use crate::model::stated_value::SlashBlocks;
use crate::text::source::SourceFile;

/// The labels of a file: by number or text, the block.
pub(crate) type Labels = BTreeMap<String, usize>;

/// The name of a label as a word states it.
pub(crate) fn label_name(bytes: &[u8], word: &Word) -> Option<String> {
    match &word.value {
        Value::Number(number) => Some(format!("{}", number.value)),
        Value::Text(text) => Some(format!(
            "\"{}\"",
            String::from_utf8_lossy(bytes.get(text.clone())?)
        )),
        _ => None,
    }
}

/// Message for a second label of one name, with the line of the first.
pub(crate) fn label_twice(line: usize) -> String {
    format!("there is a label of this name above, in line {line}")
}
pub(crate) const NAME_IT: &str = "name it otherwise";

/// Reason and remedy of words after a label.
pub(crate) const NOT_ALONE: (&str, &str) = (
    "more stands behind the label",
    "write it as a block of its own",
);

/// The labels of a file, and blocks that state one a second time, each behind that of before.
pub(crate) fn labels_of(bytes: &[u8], blocks: &[Block]) -> (Labels, Vec<[usize; 2]>) {
    let (mut labels, mut twice) = (Labels::new(), Vec::new());
    for (index, block) in blocks.iter().enumerate() {
        // Quick check: labels begin with L.
        let first = bytes.get(block.text.start).map(u8::to_ascii_uppercase);
        if first != Some(b'L') {
            continue;
        }
        let words = block.words(bytes);
        let name = words
            .first()
            .filter(|word| word.is("LBL"))
            .and_then(|word| label_name(bytes, word));
        if let Some(name) = name.filter(|name| name != "0")
            && let Some(first) = labels.insert(name, index)
        {
            twice.push([first, index]);
        }
    }
    (labels, twice)
}

/// Successor of a block.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Step {
    Next,
    /// Call of a label, with the return at LBL 0.
    Call(String),
    /// LBL 0.
    Back,
    /// The program ends behind it.
    Ends,
}

/// Error of a file without a control flow of its own: the block and the reason.
pub(crate) type Fault = (usize, String);

/// Deepest nesting of calls.
pub(crate) const DEEPEST: usize = 20;

/// The blocks in the order in which they run.
///
/// # Errors
/// The first block that runs twice or leads nowhere.
pub(crate) fn order(
    first: usize,
    count: usize,
    labels: &Labels,
    step: impl Fn(usize) -> Step,
) -> Result<Vec<usize>, Fault> {
    let mut order = Vec::with_capacity(count);
    let mut ran = vec![false; count];
    let mut calls: Vec<usize> = Vec::new();
    let mut at = first;
    while at < count {
        if ran[at] {
            let by = calls.last().copied().unwrap_or(at);
            return Err((by, "it runs blocks a second time".to_owned()));
        }
        ran[at] = true;
        order.push(at);
        at = match step(at) {
            Step::Next => at + 1,
            Step::Ends => break,
            Step::Back => calls.pop().map_or(at, |from| from) + 1,
            Step::Call(name) => {
                let Some(to) = labels.get(&name) else {
                    return Err((at, format!("there is no LBL {name}")));
                };
                if calls.len() >= DEEPEST {
                    return Err((at, "calls are nested more than 20 deep".to_owned()));
                }
                calls.push(at);
                *to
            }
        };
    }
    Ok(order)
}

/// Successor of a block, unless it depends on a parameter.
pub(crate) fn step_of(bytes: &[u8], block: &Block, slash: SlashBlocks) -> Step {
    if block.skipped && slash == SlashBlocks::Skipped {
        return Step::Next;
    }
    let words = block.words(bytes);
    let Some(first) = words.first() else {
        return Step::Next;
    };
    if first.is("END") {
        return Step::Ends;
    }
    if first.is("LBL") {
        return match first.value() {
            Some(0.0) => Step::Back,
            _ => Step::Next,
        };
    }
    if first.is("CALL") {
        let label = words.get(1).filter(|word| word.is("LBL"));
        let once = words.len() == 2;
        let name = label
            .filter(|_| once)
            .and_then(|word| label_name(bytes, word));
        return name.map_or(Step::Next, Step::Call);
    }
    let ends = |word: &Word| word.is("M") && matches!(word.whole(), Some(2 | 30));
    match words.iter().any(ends) {
        true => Step::Ends,
        false => Step::Next,
    }
}

/// Names of the programs that a file calls, as often as they stand there.
pub(crate) fn called(file: &SourceFile) -> Vec<String> {
    let bytes = file.bytes();
    let mut names = Vec::new();
    for block in blocks_of(bytes) {
        let begins = bytes.get(block.text.start).map(u8::to_ascii_uppercase);
        if begins != Some(b'C') {
            continue;
        }
        let words = block.words(bytes);
        if let [call, program, ..] = words.as_slice()
            && call.is("CALL")
            && program.is("PGM")
        {
            names.push(stem(&called_name(bytes, &block, program)));
        }
    }
    names
}

/// Name of the program that CALL PGM calls; `program` is the word PGM.
pub(crate) fn called_name(bytes: &[u8], block: &Block, program: &Word) -> String {
    let from = program.span.start + b"PGM".len();
    let text = &bytes[from.min(block.text.end)..block.text.end];
    let text = text.split(|byte| *byte == b';').next().unwrap_or_default();
    String::from_utf8_lossy(text).trim().to_owned()
}

/// True if CALL PGM calls a file by this name.
pub(crate) fn is_called(file: &SourceFile, name: &str) -> bool {
    stem(file.name()).eq_ignore_ascii_case(&stem(name))
}

/// A name of a file without folders and ending.
fn stem(name: &str) -> String {
    let name = name.trim().trim_matches('"');
    let name = name.rsplit(['/', '\\', ':']).next().unwrap_or(name);
    match name.rsplit_once('.') {
        Some((stem, ending)) if ending.eq_ignore_ascii_case("h") => stem.to_owned(),
        _ => name.to_owned(),
    }
}
