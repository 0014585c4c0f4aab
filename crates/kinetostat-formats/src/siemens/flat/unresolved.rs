//! Calls of subprograms: the files that they need, and those that are not there.

use crate::error::{ProgramError, note};
use crate::siemens::block::{Block, Item, What};
use crate::siemens::table::row;
use crate::text::source::SourceFile;

pub(super) const REASON: &str =
    "no file of a subprogram of this name is given, and it is no word of the control that is known";
pub(super) const REMEDY: &str =
    "give its file together with the program (--subprograms FOLDER), or take the call out";

/// True if a word that begins a block can only be a call.
pub(super) fn is_call(file: &SourceFile, item: &Item) -> bool {
    let name = String::from_utf8_lossy(file.part(&item.name)).to_ascii_uppercase();
    matches!(item.what, What::Name | What::Call(_))
        && !name.starts_with('$')
        && row(&name).is_none()
}

/// Names of the subprograms that a file may call, in capitals, as often as they stand there.
pub(crate) fn called(file: &SourceFile) -> Vec<String> {
    let mut names = Vec::new();
    for line in 1..=file.line_count() {
        let Ok((block, _)) = Block::of(file.bytes(), file.range_of(line)) else {
            continue;
        };
        let name =
            |item: &Item| String::from_utf8_lossy(file.part(&item.name)).to_ascii_uppercase();
        let called = match block.items.as_slice() {
            [first, item, ..] if name(first) == "PCALL" => Some(item),
            [first, ..] if is_call(file, first) => Some(first),
            _ => None,
        };
        names.extend(called.map(name));
    }
    names
}

/// Notes all calls of a program that calls nothing else.
pub(super) fn note_calls(file: &SourceFile, faults: &mut Vec<ProgramError>) {
    for line in 1..=file.line_count() {
        let Ok((block, _)) = Block::of(file.bytes(), file.range_of(line)) else {
            continue;
        };
        if let Some(item) = block.items.first().filter(|item| is_call(file, item)) {
            note(faults, || {
                ProgramError::at(file, item.span.clone(), REASON, REMEDY)
            });
        }
    }
}

/// The name by which a program is called, in capitals: that of its file without ending and marks of the control.
pub(super) fn program_name(file: &str) -> Vec<u8> {
    let name = file.rsplit(['/', '\\']).next().unwrap_or(file);
    let name = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
    let name = name.to_ascii_uppercase();
    let name = name.strip_prefix("_N_").unwrap_or(&name);
    let name = name
        .strip_suffix("_SPF")
        .or(name.strip_suffix("_MPF"))
        .unwrap_or(name);
    name.as_bytes().to_vec()
}
