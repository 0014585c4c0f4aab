//! Names of a program: data and routines of all files, and what a routine sees.

use std::collections::BTreeMap;
use std::ops::Range;

use crate::error::{ProgramError, note};
use crate::krl::assigned_frames::Assignments;
use crate::krl::lex::TokenFile;
use crate::krl::tree::{Content, DatumNode, Routine};
use crate::text::name::Name;

/// A value that a data list states: of a name, or of an element of an array.
#[derive(Debug, Clone)]
pub(crate) struct Stated {
    /// Tokens of the value.
    pub value: Range<usize>,
    /// The whole statement.
    pub statement: Range<usize>,
    /// Token of the name.
    pub name_at: usize,
    /// The statement declares this name and no other.
    pub alone: bool,
    /// Something else than the motions that end there rests on it.
    pub keeps_value: bool,
    /// File and line of an assignment, or of a call that may change it.
    pub assigned: Option<(usize, usize)>,
}

/// A datum of the program.
#[derive(Debug)]
pub(crate) struct Datum {
    /// An index of the files.
    pub file: usize,
    pub type_name: Name,
    pub is_global: bool,
    /// By index of the element; 0 for the datum itself.
    pub stated: BTreeMap<u32, Stated>,
    /// Where it, or any of its elements, is assigned.
    pub assigned: Option<(usize, usize)>,
    /// How many statements give it, or a part of it, a value.
    pub assignments: usize,
    /// The members to which they give one, and the routine of the first.
    pub parts_assigned: Vec<Name>,
    pub assigned_in: Option<usize>,
    /// A routine to which it is given, a loop, or a second routine may change it.
    pub is_changed_by_calls: bool,
    /// Where elements without a stated value are assigned.
    pub elements_assigned: BTreeMap<u32, (usize, usize)>,
}

/// What a name means in a routine.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Meaning {
    /// An index of [`Symbols::data`].
    Datum(usize),
    Parameter,
}

/// Where a routine is.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Home<'p> {
    /// An index of the files.
    pub file: usize,
    /// An index over the names of files.
    pub module: usize,
    /// Its file is called by the name of the first routine.
    pub is_first: bool,
    pub routine: &'p Routine,
}

/// All names.
#[derive(Debug, Default)]
pub(crate) struct Symbols<'p> {
    pub data: Vec<Datum>,
    pub routines: Vec<Home<'p>>,
    /// Statements that change elements of TOOL_DATA and BASE_DATA.
    pub frames_assigned: Assignments,
    everywhere: BTreeMap<Name, usize>,
    in_module: Vec<BTreeMap<Name, usize>>,
    in_routine: Vec<BTreeMap<Name, Meaning>>,
    routines_everywhere: BTreeMap<Name, usize>,
    routines_in_module: Vec<BTreeMap<Name, usize>>,
}

/// The name of a file without folders and extension, in capitals: `.src` and `.dat` of one name are one module.
fn stem(file: &TokenFile<'_>) -> String {
    let name = file.source.name();
    let name = name.rsplit(['/', '\\']).next().unwrap_or(name);
    let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
    stem.to_uppercase()
}

impl<'p> Symbols<'p> {
    /// Of the content of each file.
    pub(crate) fn of(
        files: &[TokenFile<'_>],
        contents: &'p [Content],
        faults: &mut Vec<ProgramError>,
    ) -> Self {
        let mut all = Self::default();
        let mut modules: BTreeMap<String, usize> = BTreeMap::new();
        let mut firsts = Vec::new();
        for (file, content) in files.iter().zip(contents) {
            let stem = stem(file);
            let is_config =
                stem == "$CONFIG" || content.list.is_some_and(|name| name.is("$CONFIG"));
            let count = modules.len();
            let module = *modules.entry(stem).or_insert(count);
            if module == count {
                all.in_module.push(BTreeMap::new());
                all.routines_in_module.push(BTreeMap::new());
            }
            for node in &content.data {
                let index = all.add(file.index, node);
                let names = match node.is_global || is_config {
                    true => &mut all.everywhere,
                    false => &mut all.in_module[module],
                };
                if names.insert(node.name, index).is_some() {
                    note(faults, || twice(file, node.name_at));
                }
            }
            for preset in &content.presets {
                let known = all.in_module[module]
                    .get(&preset.name)
                    .or_else(|| all.everywhere.get(&preset.name));
                let index = match known {
                    Some(index) => *index,
                    None => {
                        all.data.push(Datum {
                            file: file.index,
                            // What the system declares and nobody here.
                            type_name: Name::of(b"E6POS").unwrap_or(preset.name),
                            is_global: true,
                            stated: BTreeMap::new(),
                            assigned: None,
                            assignments: 0,
                            parts_assigned: Vec::new(),
                            assigned_in: None,
                            is_changed_by_calls: false,
                            elements_assigned: BTreeMap::new(),
                        });
                        all.everywhere.insert(preset.name, all.data.len() - 1);
                        all.data.len() - 1
                    }
                };
                let stated = Stated {
                    value: preset.value.clone(),
                    statement: preset.tokens.clone(),
                    name_at: preset.tokens.start,
                    alone: false,
                    keeps_value: false,
                    assigned: None,
                };
                if all.data[index].file == file.index {
                    all.data[index].stated.insert(preset.index, stated);
                }
            }
            for (number, routine) in content.routines.iter().enumerate() {
                let index = all.routines.len();
                let is_first = number == 0;
                all.routines.push(Home {
                    file: file.index,
                    module,
                    is_first,
                    routine,
                });
                if is_first || routine.is_global {
                    firsts.push((routine.name, index));
                }
                if all.routines_in_module[module]
                    .insert(routine.name, index)
                    .is_some()
                {
                    note(faults, || twice(file, routine.name_at));
                }
                all.routine_data(file, routine, faults);
            }
        }
        for (name, index) in firsts {
            all.routines_everywhere.entry(name).or_insert(index);
        }
        all
    }

    fn routine_data(
        &mut self,
        file: &TokenFile<'_>,
        routine: &Routine,
        faults: &mut Vec<ProgramError>,
    ) {
        let mut locals = BTreeMap::new();
        for node in &routine.data {
            let index = self.add(file.index, node);
            if locals.insert(node.name, Meaning::Datum(index)).is_some() {
                note(faults, || twice(file, node.name_at));
            }
        }
        // Parameters are declared as data as well.
        for parameter in &routine.parameters {
            locals.insert(parameter.name, Meaning::Parameter);
        }
        self.in_routine.push(locals);
    }

    fn add(&mut self, file: usize, node: &DatumNode) -> usize {
        let stated = node.initial.clone().map(|value| Stated {
            value,
            statement: node.tokens.clone(),
            name_at: node.name_at,
            alone: node.alone,
            keeps_value: false,
            assigned: None,
        });
        self.data.push(Datum {
            file,
            type_name: node.type_name,
            is_global: node.is_global,
            stated: stated.map(|stated| (0, stated)).into_iter().collect(),
            assigned: None,
            assignments: 0,
            parts_assigned: Vec::new(),
            assigned_in: None,
            is_changed_by_calls: false,
            elements_assigned: BTreeMap::new(),
        });
        self.data.len() - 1
    }

    /// What a name means in a routine (an index).
    pub(crate) fn meaning(&self, routine: usize, name: &Name) -> Option<Meaning> {
        let local = self.in_routine.get(routine)?.get(name);
        local.copied().or_else(|| {
            let module = &self.in_module[self.routines[routine].module];
            let found = module.get(name).or_else(|| self.everywhere.get(name));
            found.map(|index| Meaning::Datum(*index))
        })
    }

    /// The datum of a name of the system, as $config.dat states it.
    pub(crate) fn of_system(&self, capitals: &str) -> Option<&Datum> {
        let index = self.everywhere.get(&Name::of(capitals.as_bytes())?)?;
        self.data.get(*index)
    }

    /// The routine that a name means in a routine.
    pub(crate) fn routine(&self, from: usize, name: &Name) -> Option<usize> {
        let module = &self.routines_in_module[self.routines[from].module];
        module
            .get(name)
            .or_else(|| self.routines_everywhere.get(name))
            .copied()
    }
}

fn twice(file: &TokenFile<'_>, name_at: usize) -> ProgramError {
    let span = file.span(&(name_at..name_at + 1));
    ProgramError::twice(file.source, span, "files")
}
