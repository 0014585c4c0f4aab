//! Calls of other programs (CALL PGM): their names.

use crate::heidenhain::blocks::{Block, blocks_of};
use crate::heidenhain::words::Word;
use crate::text::source::SourceFile;

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
