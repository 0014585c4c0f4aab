//! Calls of subprograms: the files that they need, and those that are not there or not read at all.

use std::ops::Range;

use crate::error::{ProgramError, note};
use crate::siemens::block::{Block, Item, What};
use crate::siemens::table::row;
use crate::text::source::SourceFile;

/// The word that names what a block calls, and the words behind it: of `PCALL NAME P3` those of NAME; `None` where it is not stated.
pub(crate) fn named_by<'b>(file: &SourceFile, items: &'b [Item]) -> Option<(&'b Item, &'b [Item])> {
    let (first, rest) = items.split_first()?;
    let is_word = file.part(&first.name).eq_ignore_ascii_case(b"PCALL");
    match (is_word, &first.what) {
        (false, _) => Some((first, rest)),
        (true, What::Name) => rest.split_first(),
        (true, _) => None,
    }
}

/// The word by which a block calls a subprogram: `NAME`, `NAME(5)`, `L6` or `PCALL NAME`, alone or with the number of its runs (`P3`).
pub(crate) fn called_by<'b>(file: &SourceFile, items: &'b [Item]) -> Option<&'b Item> {
    let (called, rest) = named_by(file, items)?;
    if !matches!(called.what, What::Name | What::Call(_)) {
        return None;
    }
    let is_alone = match rest {
        [] => true,
        [runs] => {
            file.part(&runs.name).eq_ignore_ascii_case(b"P")
                && matches!(runs.what, What::Value { .. })
        }
        _ => false,
    };
    let name = String::from_utf8_lossy(file.part(&called.name)).to_ascii_uppercase();
    let is_call = is_alone && !name.starts_with('$') && row(&name).is_none();
    is_call.then_some(called)
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
        // MCALL calls behind each block with a place.
        let items = match block.items.split_first() {
            Some((first, called)) if name(first) == "MCALL" => called,
            _ => &block.items,
        };
        names.extend(called_by(file, items).map(name));
    }
    names
}

/// A called name in the form of [`program_name`].
pub(crate) fn key_of_call(name: &[u8]) -> Vec<u8> {
    program_name(&format!("{}.SPF", String::from_utf8_lossy(name)))
}

/// The name by which a program is called, in capitals: that of its file without ending and marks of the control.
pub(crate) fn program_name(file: &str) -> Vec<u8> {
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

const MOST_BYTES: usize = 1 << 28;

/// Checks that a file can be read at all; otherwise notes the error and returns false.
pub(crate) fn whole_file(file: &SourceFile, faults: &mut Vec<ProgramError>) -> bool {
    let mut refuse = |span: Range<usize>, reason: &str, remedy: &str| {
        note(faults, || ProgramError::at(file, span, reason, remedy));
        false
    };
    if file.bytes().len() > MOST_BYTES {
        return refuse(0..0, "the file is larger than 256 MiB", "divide it");
    }
    let is_archive = |name: &str| name.to_ascii_lowercase().ends_with(".arc");
    if is_archive(file.name()) {
        return refuse(
            0..0,
            "it is an archive of the control",
            "give the programs (.mpf, .spf) that are in it",
        );
    }
    let heads = (1..=file.line_count())
        .filter(|line| {
            file.line(*line)
                .is_some_and(|line| line.trim_ascii_start().starts_with(b"%"))
        })
        .take(2);
    match heads.collect::<Vec<usize>>().as_slice() {
        [_, second] => {
            let at = file.start_of(*second);
            refuse(
                at..at + 1,
                "a second program begins here",
                "give each program as a file of its own",
            )
        }
        _ => true,
    }
}
