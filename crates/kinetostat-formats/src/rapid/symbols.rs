//! Names of a program: data and routines of all modules, and what a routine sees.

use std::collections::BTreeMap;

use crate::error::{ProgramError, note};
use crate::rapid::tree::{DatumNode, Module, Routine, Sight, Statement, TokenFile};
use crate::text::name::Name;

/// Where a name stands.
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
    /// Where it is declared.
    pub scope: Scope,
}

/// What a name means in a routine.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Meaning {
    /// An index of [`Symbols::data`].
    Datum(usize),
    /// A parameter of the routine, or the variable of a loop.
    Parameter,
}

/// Where a routine is.
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
    everywhere: BTreeMap<Name, usize>,
    in_module: Vec<BTreeMap<Name, usize>>,
    /// Files of the modules.
    files: Vec<usize>,
    in_routine: Vec<BTreeMap<Name, Meaning>>,
    routines_everywhere: BTreeMap<Name, usize>,
    routines_in_module: Vec<BTreeMap<Name, usize>>,
}

impl<'p> Symbols<'p> {
    /// Of the modules of each file.
    pub(crate) fn of(
        files: &[TokenFile<'_>],
        modules: &'p [(usize, Module)],
        faults: &mut Vec<ProgramError>,
    ) -> Self {
        let mut all = Self::default();
        for (module, (file, content)) in modules.iter().enumerate() {
            all.files.push(*file);
            let mut own = BTreeMap::new();
            for node in &content.data {
                let index = all.add(*file, node, Scope::Module(module));
                let names = match node.sight {
                    Sight::Module => &mut own,
                    Sight::Everywhere => &mut all.everywhere,
                };
                if names.insert(node.name, index).is_some() {
                    note(faults, || twice(&files[*file], node.name_at));
                }
            }
            all.in_module.push(own);
            let mut own = BTreeMap::new();
            for routine in &content.routines {
                let index = all.routines.len();
                all.routines.push(Home {
                    file: *file,
                    module,
                    routine,
                });
                let names = match routine.sight {
                    Sight::Module => &mut own,
                    Sight::Everywhere => &mut all.routines_everywhere,
                };
                if names.insert(routine.name, index).is_some() {
                    note(faults, || twice(&files[*file], routine.name_at));
                }
                let mut locals = BTreeMap::new();
                for parameter in &routine.parameters {
                    locals.insert(parameter.name, Meaning::Parameter);
                }
                for node in &routine.data {
                    let scope = Scope::Routine(all.routines.len() - 1);
                    let index = all.add(*file, node, scope);
                    if locals.insert(node.name, Meaning::Datum(index)).is_some() {
                        note(faults, || twice(&files[*file], node.name_at));
                    }
                }
                loop_variables(&files[*file], &routine.body, &mut locals);
                loop_variables(&files[*file], &routine.handlers, &mut locals);
                all.in_routine.push(locals);
            }
            all.routines_in_module.push(own);
        }
        all
    }

    fn add(&mut self, file: usize, node: &'p DatumNode, scope: Scope) -> usize {
        self.data.push(Datum { node, file, scope });
        self.data.len() - 1
    }

    /// What a name means in a routine (an index).
    pub(crate) fn meaning(&self, routine: usize, name: &Name) -> Option<Meaning> {
        let local = self.in_routine.get(routine)?.get(name);
        local.copied().or_else(|| {
            let module = self.in_module.get(self.routines[routine].module)?;
            let found = module.get(name).or_else(|| self.everywhere.get(name));
            found.map(|index| Meaning::Datum(*index))
        })
    }

    /// What a name means where it stands.
    pub(crate) fn meaning_in(&self, scope: Scope, name: &Name) -> Option<Meaning> {
        match scope {
            Scope::Routine(routine) => self.meaning(routine, name),
            Scope::Module(module) => {
                let own = self.in_module.get(module)?.get(name);
                let found = own.or_else(|| self.everywhere.get(name))?;
                Some(Meaning::Datum(*found))
            }
        }
    }

    /// The routine that a name means in a routine.
    pub(crate) fn routine(&self, from: usize, name: &Name) -> Option<usize> {
        let module = self.routines_in_module.get(self.routines[from].module)?;
        let found = module
            .get(name)
            .or_else(|| self.routines_everywhere.get(name));
        found.copied()
    }

    /// The file of a module.
    pub(crate) fn file_of_module(&self, module: usize) -> usize {
        self.files.get(module).copied().unwrap_or_default()
    }

    /// The routine with which the program begins.
    pub(crate) fn main(&self) -> Option<usize> {
        let name = Name::of(b"main")?;
        self.routines_everywhere.get(&name).copied()
    }
}

/// `FOR i FROM`: its variable is one of the routine.
fn loop_variables(file: &TokenFile<'_>, block: &[Statement], locals: &mut BTreeMap<Name, Meaning>) {
    for statement in block {
        match statement {
            Statement::Loop { header, block, .. } => {
                let second = file.word(header.start + 1);
                if header.len() > 1 && second.eq_ignore_ascii_case(b"FROM") {
                    let name = Name::of(file.word(header.start));
                    if let Some(name) = name {
                        locals.entry(name).or_insert(Meaning::Parameter);
                    }
                }
                loop_variables(file, block, locals);
            }
            Statement::Branches { blocks, .. } => {
                for block in blocks {
                    loop_variables(file, block, locals);
                }
            }
            _ => {}
        }
    }
}

fn twice(file: &TokenFile<'_>, name_at: usize) -> ProgramError {
    let span = file.span(&(name_at..name_at + 1));
    ProgramError::twice(file.source, span, "modules")
}
