//! Calls of subprograms: the files that they need, and those that are not there.

use crate::siemens::block::{Block, Item, What};
use crate::siemens::table::row;
use crate::text::source::SourceFile;

/// The word by which a block calls a subprogram: `NAME`, `NAME(5)`, `L6` or `PCALL NAME`, alone or with the number of its runs (`P3`).
pub(crate) fn called_by<'b>(file: &SourceFile, items: &'b [Item]) -> Option<&'b Item> {
    let is = |item: &Item, name: &str| file.part(&item.name).eq_ignore_ascii_case(name.as_bytes());
    let (first, mut rest) = items.split_first()?;
    let called = match is(first, "PCALL") && first.what == What::Name {
        true => {
            let (named, behind) = rest.split_first()?;
            rest = behind;
            named
        }
        false => first,
    };
    let name = String::from_utf8_lossy(file.part(&called.name)).to_ascii_uppercase();
    let is_call = matches!(called.what, What::Name | What::Call(_))
        && !name.starts_with('$')
        && row(&name).is_none();
    let is_alone = match rest {
        [] => true,
        [runs] => is(runs, "P") && matches!(runs.what, What::Value { .. }),
        _ => false,
    };
    (is_call && is_alone).then_some(called)
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
