//! Names of a language in which a variable is declared where it is assigned.

use std::collections::{BTreeMap, BTreeSet};

use crate::error::{ProgramError, note};
use crate::interpreter::symbols::Symbols;
use crate::interpreter::token::TokenFile;
use crate::interpreter::tree::{DatumNode, Module, Routine, RoutineKind};
use crate::text::name::Name;

/// A name that a statement of a routine assigns.
pub(crate) struct Assigned {
    /// An index of the routines.
    pub routine: usize,
    /// Said before it: all routines see it, or its own alone.
    pub is_global: Option<bool>,
    pub node: DatumNode,
}

/// Letters of either case are one name to the run: names that differ in their case alone are refused.
pub(crate) fn refuse_other_capitals(
    file: &TokenFile<'_>,
    routines: &[Routine],
    assigned: &[Assigned],
    faults: &mut Vec<ProgramError>,
) {
    let assigned = assigned.iter().map(|own| own.node.name_at);
    // The first routine is that of the statements that stand in no other.
    let headers = routines.iter().skip(1);
    let headers = headers.flat_map(|own| own.name_at..own.statements.start);
    let declared = assigned.chain(headers);
    let mut known: BTreeMap<Name, usize> = BTreeMap::new();
    for at in declared {
        if let Some(name) = file.name(at) {
            known.entry(name).or_insert(at);
        }
    }
    for at in 0..file.tokens.len() {
        let Some(name) = file.name(at) else { continue };
        if (known.get(&name)).is_some_and(|first| file.word(*first) != file.word(at)) {
            known.remove(&name);
            let span = file.span(&(at..at + 1));
            let reason = "another name has the same letters, in capitals or not: the two are not told apart here";
            note(faults, || {
                ProgramError::at(file.source, span, reason, "rename one of them")
            });
        }
    }
}

/// Routines with their own data, and the data that all of them see: those of the program, and those of which it is said. A name of which
/// nothing is said is that of the program, where it has one.
pub(crate) fn with_data(
    mut routines: Vec<Routine>,
    assigned: Vec<Assigned>,
    programs: &BTreeSet<usize>,
) -> Module {
    let is_seen = |own: &&Assigned| own.is_global.unwrap_or(programs.contains(&own.routine));
    let seen: BTreeSet<Name> = (assigned.iter().filter(is_seen))
        .map(|own| own.node.name)
        .collect();
    let mut known = BTreeSet::new();
    let mut data = Vec::new();
    for own in assigned {
        let name = own.node.name;
        let routine = &mut routines[own.routine];
        if routine.parameters.iter().any(|own| own.name == name) {
            continue;
        }
        let is_local = own.is_global == Some(false) || !seen.contains(&name);
        let (home, list) = match is_local {
            true => (Some(own.routine), &mut routine.data),
            false => (None, &mut data),
        };
        if known.insert((home, name)) {
            list.push(own.node);
        }
    }
    Module { data, routines }
}

/// The names of the modules of files, and which routine is the program: the only one that may be one and that no other names.
pub(crate) fn symbols_of<'p>(
    files: &[TokenFile<'_>],
    modules: &'p [Module],
    faults: &mut Vec<ProgramError>,
) -> Symbols<'p> {
    let mut all = Symbols::default();
    let mut mentions: BTreeMap<Name, usize> = BTreeMap::new();
    for (file, content) in files.iter().zip(modules) {
        let module = all.add_module(file.index, None);
        for node in &content.data {
            all.add_datum(file, module, node, faults);
        }
        // The parser has noted faults of names; the first routine has the statements outside all others.
        let is_named =
            |(index, own): &(usize, &'p Routine)| *index == 0 || own.name != Name::empty();
        let routines = content.routines.iter().enumerate().filter(is_named);
        for (_, routine) in routines {
            all.add_routine(file, module, routine, faults);
        }
        for name in (0..file.tokens.len()).filter_map(|at| file.name(at)) {
            *mentions.entry(name).or_default() += 1;
        }
    }
    let is_program = |index: &usize| {
        let routine = all.routines[*index].routine;
        // The count includes the routine's own header.
        let is_called = mentions.get(&routine.name).is_some_and(|count| *count > 1);
        routine.kind == RoutineKind::Procedure && !is_called
    };
    let mut programs = (0..all.routines.len()).filter(is_program);
    all.main = match (programs.next(), programs.next()) {
        (Some(index), None) => Some(index),
        _ => None,
    };
    all
}
