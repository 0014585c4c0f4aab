//! Names of a program: data and routines of all modules, and what a routine sees.

use std::collections::BTreeMap;

use crate::error::{ProgramError, note};
use crate::interpreter::token::TokenFile;
use crate::interpreter::tree::{DatumNode, Preset, Routine, Sight};
use crate::text::Name;

/// Scope of a name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Scope {
    /// An index over all modules.
    Module(usize),
    /// An index of the routines.
    Routine(usize),
}

/// A datum of the program.
#[derive(Debug)]
pub(crate) struct Datum<'p> {
    pub node: &'p DatumNode,
    /// An index of the files.
    pub file: usize,
    /// Scope of the declaration.
    pub scope: Scope,
    /// First values of elements of an array, by index.
    pub elements: BTreeMap<usize, &'p Preset>,
}

/// Meaning of a name in a routine.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Meaning {
    /// An index of [`Symbols::data`].
    Datum(usize),
    /// A parameter of the routine, or the variable of a loop.
    Parameter,
}

/// Location of a routine.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Home<'p> {
    /// An index of the files.
    pub file: usize,
    /// An index over all modules.
    pub module: usize,
    pub routine: &'p Routine,
}

/// All names.
#[derive(Debug, Default)]
pub(crate) struct Symbols<'p> {
    pub data: Vec<Datum<'p>>,
    pub routines: Vec<Home<'p>>,
    /// The routine with which the program begins.
    pub main: Option<usize>,
    everywhere: BTreeMap<Name, usize>,
    in_module: Vec<BTreeMap<Name, usize>>,
    /// Files of the modules, and which of the modules' names each sees.
    files: Vec<(usize, usize)>,
    in_routine: Vec<BTreeMap<Name, Meaning>>,
    routines_everywhere: BTreeMap<Name, usize>,
    routines_in_module: Vec<BTreeMap<Name, usize>>,
}

impl<'p> Symbols<'p> {
    /// Adds a module of a file without names; `with` is one that shares its names.
    pub(crate) fn add_module(&mut self, file: usize, with: Option<usize>) -> usize {
        let names = match with.and_then(|with| self.files.get(with)) {
            Some((_, names)) => *names,
            None => {
                self.in_module.push(BTreeMap::new());
                self.routines_in_module.push(BTreeMap::new());
                self.in_module.len() - 1
            }
        };
        self.files.push((file, names));
        self.files.len() - 1
    }

    /// The names of a module, by its index.
    fn names(&self, module: usize) -> usize {
        self.files.get(module).map_or(0, |(_, names)| *names)
    }

    /// Adds a datum of a module.
    pub(crate) fn add_datum(
        &mut self,
        file: &TokenFile<'_>,
        module: usize,
        node: &'p DatumNode,
        faults: &mut Vec<ProgramError>,
    ) {
        let index = self.add(file.index, node, Scope::Module(module));
        let own = self.names(module);
        let names = match node.sight {
            Sight::Module => &mut self.in_module[own],
            Sight::Everywhere => &mut self.everywhere,
        };
        if names.insert(node.name, index).is_some() {
            note(faults, || twice(file, node.name_at));
        }
    }

    /// Adds a routine of a module with its parameters and its data.
    pub(crate) fn add_routine(
        &mut self,
        file: &TokenFile<'_>,
        module: usize,
        routine: &'p Routine,
        faults: &mut Vec<ProgramError>,
    ) {
        let index = self.routines.len();
        self.routines.push(Home {
            file: file.index,
            module,
            routine,
        });
        let own = self.names(module);
        let names = match routine.sight {
            Sight::Module => &mut self.routines_in_module[own],
            Sight::Everywhere => &mut self.routines_everywhere,
        };
        if names.insert(routine.name, index).is_some() {
            note(faults, || twice(file, routine.name_at));
        }
        let mut locals = BTreeMap::new();
        for parameter in &routine.parameters {
            locals.insert(parameter.name, Meaning::Parameter);
        }
        // KRL declares its parameters as data as well.
        let is_parameter =
            |node: &&DatumNode| (routine.parameters.iter()).any(|own| own.name == node.name);
        for node in routine.data.iter().filter(|node| !is_parameter(node)) {
            let datum = self.add(file.index, node, Scope::Routine(index));
            let before = locals.insert(node.name, Meaning::Datum(datum));
            if before.is_some() {
                note(faults, || twice(file, node.name_at));
            }
        }
        self.in_routine.push(locals);
    }

    /// Adds the first value of an element to the datum of its name, where that is of the same file.
    pub(crate) fn add_element(&mut self, file: usize, module: usize, preset: &'p Preset) {
        let index = self.datum_in(module, &preset.name);
        if let Some(datum) = index.and_then(|index| self.data.get_mut(index))
            && datum.file == file
        {
            datum.elements.insert(preset.index, preset);
        }
    }

    /// Lets all modules see a routine of one, unless they see another of its name.
    pub(crate) fn see_everywhere(&mut self, routine: usize) {
        let name = self.routines[routine].routine.name;
        self.routines_everywhere.entry(name).or_insert(routine);
    }

    /// Adds a name of a routine that is no datum: the variable of a loop.
    pub(crate) fn add_local(&mut self, routine: usize, name: Name) {
        if let Some(locals) = self.in_routine.get_mut(routine) {
            locals.entry(name).or_insert(Meaning::Parameter);
        }
    }

    fn add(&mut self, file: usize, node: &'p DatumNode, scope: Scope) -> usize {
        self.data.push(Datum {
            node,
            file,
            scope,
            elements: BTreeMap::new(),
        });
        self.data.len() - 1
    }

    /// The datum of a name in a module.
    pub(crate) fn datum_in(&self, module: usize, name: &Name) -> Option<usize> {
        let own = self.in_module.get(self.names(module))?.get(name);
        own.or_else(|| self.everywhere.get(name)).copied()
    }

    /// A routine that modules other than its own may call.
    pub(crate) fn routine_everywhere(&self, name: &Name) -> Option<usize> {
        self.routines_everywhere.get(name).copied()
    }

    /// Meaning of a name in a routine (an index).
    pub(crate) fn meaning(&self, routine: usize, name: &Name) -> Option<Meaning> {
        let local = self.in_routine.get(routine)?.get(name);
        local.copied().or_else(|| {
            let found = self.datum_in(self.routines[routine].module, name);
            found.map(Meaning::Datum)
        })
    }

    /// Meaning of a name in its scope.
    pub(crate) fn meaning_in(&self, scope: Scope, name: &Name) -> Option<Meaning> {
        match scope {
            Scope::Routine(routine) => self.meaning(routine, name),
            Scope::Module(module) => self.datum_in(module, name).map(Meaning::Datum),
        }
    }

    /// The routine that a name means in a routine.
    pub(crate) fn routine(&self, from: usize, name: &Name) -> Option<usize> {
        let names = self.names(self.routines[from].module);
        let module = self.routines_in_module.get(names)?;
        let found = module
            .get(name)
            .or_else(|| self.routines_everywhere.get(name));
        found.copied()
    }

    /// The file of a module.
    pub(crate) fn file_of_module(&self, module: usize) -> usize {
        self.files.get(module).map_or(0, |(file, _)| *file)
    }
}

fn twice(file: &TokenFile<'_>, name_at: usize) -> ProgramError {
    let span = file.span(&(name_at..name_at + 1));
    ProgramError::twice(file.source, span, "modules")
}
