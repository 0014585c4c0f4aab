//! Names of a program in KRL: data and routines of all files; `.src` and `.dat` of one name are one module.

use std::collections::BTreeMap;

use crate::error::ProgramError;
use crate::interpreter::symbols::Symbols;
use crate::interpreter::token::{Kind, TokenFile};
use crate::interpreter::tree::{Change, DatumNode, Sight};
use crate::krl::parser::cursor::Content;
use crate::text::name::Name;

/// The name of a file without folders and extension, in capitals.
fn stem(file: &TokenFile<'_>) -> String {
    let name = file.source.name();
    let name = name.rsplit(['/', '\\']).next().unwrap_or(name);
    let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
    stem.to_uppercase()
}

/// Completes the contents of files: what stands in `$config.dat` is seen everywhere, as is the first routine of a file, and what the system
/// declares has a declaration.
pub(super) fn complete(files: &[TokenFile<'_>], contents: &mut [Content]) {
    for (file, content) in files.iter().zip(contents.iter_mut()) {
        let is_config =
            stem(file) == "$CONFIG" || content.list.is_some_and(|name| name.is("$CONFIG"));
        if is_config {
            for node in &mut content.data {
                node.sight = Sight::Everywhere;
            }
        }
    }
    let mut declared: Vec<(String, Name)> = Vec::new();
    for (file, content) in files.iter().zip(contents.iter()) {
        let own = content.data.iter().map(|node| {
            let home = match node.sight {
                Sight::Everywhere => String::new(),
                Sight::Module => stem(file),
            };
            (home, node.name)
        });
        declared.extend(own);
    }
    for (file, content) in files.iter().zip(contents.iter_mut()) {
        let home = stem(file);
        for preset in &content.presets {
            let is_it = |(of, name): &(String, Name)| {
                *name == preset.name && (of.is_empty() || *of == home)
            };
            if declared.iter().any(is_it) {
                continue;
            }
            declared.push((String::new(), preset.name));
            content.data.push(DatumNode {
                change: Change::Variable,
                sight: Sight::Everywhere,
                type_name: Name::of(b"E6POS").unwrap_or(preset.name),
                name: preset.name,
                name_at: preset.name_at,
                tokens: preset.tokens.clone(),
                initial: None,
                dimensions: None,
                is_alone: false,
            });
        }
    }
}

/// The names of the content of each file.
pub(super) fn symbols_of<'p>(
    files: &[TokenFile<'_>],
    contents: &'p [Content],
    faults: &mut Vec<ProgramError>,
) -> Symbols<'p> {
    let mut all = Symbols::default();
    let mut modules: BTreeMap<String, usize> = BTreeMap::new();
    let mut firsts = Vec::new();
    for (file, content) in files.iter().zip(contents) {
        let stem = stem(file);
        let module = all.add_module(file.index, modules.get(&stem).copied());
        modules.entry(stem).or_insert(module);
        for node in &content.data {
            all.add_datum(file, module, node, faults);
        }
        for preset in &content.presets {
            all.add_element(file.index, module, preset);
        }
        for (number, routine) in content.routines.iter().enumerate() {
            all.add_routine(file, module, routine, faults);
            if number == 0 {
                firsts.push(all.routines.len() - 1);
                all.see_everywhere(all.routines.len() - 1);
            }
        }
    }
    all.main = main_of(files, &all, &firsts);
    all
}

/// The first routine of the first file that no other calls.
fn main_of(files: &[TokenFile<'_>], all: &Symbols<'_>, firsts: &[usize]) -> Option<usize> {
    let mut called = vec![false; all.routines.len()];
    for (index, home) in all.routines.iter().enumerate() {
        let file = &files[home.file];
        home.routine.each_part(&mut |tokens| {
            for at in tokens.clone() {
                let is_call = file.tokens.get(at).map(|token| token.kind) == Some(Kind::Word)
                    && file.is(at + 1, b'(');
                let name = is_call.then(|| file.name(at)).flatten();
                if let Some(found) = name.and_then(|name| all.routine(index, &name)) {
                    called[found] |= found != index;
                }
            }
        });
    }
    let uncalled = firsts.iter().find(|index| !called[**index]);
    uncalled.or_else(|| firsts.first()).copied()
}
