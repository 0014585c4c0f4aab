//! Modules, their routines, and declarations of data and parameters.

use crate::error::ProgramError;
use crate::interpreter::token::{Kind, TokenFile};
use crate::interpreter::tree::{Change, DatumNode, Module, Parameter, Routine, RoutineKind, Sight};
use crate::rapid::parser::cursor::Parser;
use crate::text::Name;

/// The modules of a file.
pub(crate) fn modules_of(file: &TokenFile<'_>, faults: &mut Vec<ProgramError>) -> Vec<Module> {
    let mut parser = Parser {
        file,
        at: 0,
        faults,
        cut_off: false,
    };
    let mut modules = Vec::new();
    while parser.at < file.tokens.len() {
        if parser.takes("MODULE") {
            modules.push(parser.module());
        } else {
            let here = parser.at..parser.at + 1;
            parser.fault(
                here,
                "it stands outside a module",
                "put it between MODULE and ENDMODULE",
            );
            while parser.at < file.tokens.len() && !parser.is("MODULE") {
                parser.at += 1;
            }
        }
    }
    modules
}

impl Parser<'_, '_> {
    fn module(&mut self) -> Module {
        let start = self.at - 1;
        let mut module = Module::default();
        self.name();
        if self.takes_symbol(b'(') {
            while self.kind().is_some() && !self.takes_symbol(b')') {
                self.at += 1;
            }
        }
        while self.kind().is_some() {
            if self.takes("ENDMODULE") {
                return module;
            }
            self.element(&mut module);
        }
        self.missing(
            start..start + 2,
            "no ENDMODULE ends the module",
            "the file is cut off: take a whole one",
        );
        module
    }

    /// A declaration, a routine or a record.
    fn element(&mut self, module: &mut Module) {
        let start = self.at;
        let sight = match self.takes("LOCAL") {
            true => Sight::Module,
            false => Sight::Everywhere,
        };
        if self.takes("RECORD") {
            while self.kind().is_some() && !self.is("ENDMODULE") && !self.takes("ENDRECORD") {
                self.at += 1;
            }
        } else if self.takes("ALIAS") {
            self.rest_of_statement(start);
        } else if let Some(kind) = self.routine_word() {
            module.routines.extend(self.routine(kind, sight, start));
        } else if let Some(datum) = self.datum(start, sight) {
            module.data.extend(datum);
        } else {
            self.fault(
                start..self.at + 1,
                "neither a declaration nor a routine begins here",
                "mend the module: it must compile on the controller",
            );
            self.at += 1;
            while self.kind().is_some() && !self.is_keyword(self.at) {
                self.at += 1;
            }
        }
    }

    fn routine_word(&mut self) -> Option<RoutineKind> {
        let words = [
            ("PROC", RoutineKind::Procedure),
            ("FUNC", RoutineKind::Function),
            ("TRAP", RoutineKind::Trap),
        ];
        let found = words.into_iter().find(|(word, _)| self.takes(word));
        found.map(|(_, kind)| kind)
    }

    fn routine(&mut self, kind: RoutineKind, sight: Sight, begins: usize) -> Option<Routine> {
        let start = self.at - 1;
        if kind == RoutineKind::Function {
            self.name();
        }
        let name = self.name();
        let parameters = match self.takes_symbol(b'(') {
            true => self.parameters(),
            false => Vec::new(),
        };
        let mut routine_data = Vec::new();
        let mut body = Vec::new();
        let mut statements = None;
        let mut handlers = Vec::new();
        let end = match kind {
            RoutineKind::Procedure | RoutineKind::Inner => "ENDPROC",
            RoutineKind::Function => "ENDFUNC",
            RoutineKind::Trap => "ENDTRAP",
        };
        loop {
            let begin = self.at;
            if let Some(datum) = self.datum(begin, Sight::Module) {
                routine_data.extend(datum);
                continue;
            }
            self.block(&mut body, 0);
            statements.get_or_insert(begin..self.at);
            if ["ERROR", "UNDO", "BACKWARD"]
                .iter()
                .any(|word| self.takes(word))
            {
                if self.takes_symbol(b'(') {
                    while self.kind().is_some() && !self.takes_symbol(b')') {
                        self.at += 1;
                    }
                }
                self.block(&mut handlers, 0);
                // A second handler follows.
                while ["ERROR", "UNDO", "BACKWARD"]
                    .iter()
                    .any(|word| self.takes(word))
                {
                    self.block(&mut handlers, 0);
                }
            }
            if self.takes(end) {
                break;
            }
            if self.kind().is_none()
                || ["PROC", "FUNC", "TRAP", "ENDMODULE", "LOCAL"]
                    .iter()
                    .any(|word| self.is(word))
            {
                self.missing(
                    start..start + 2,
                    &format!("no {end} ends the routine"),
                    &format!("end it with {end}"),
                );
                break;
            }
            if self.is("VAR") || self.is("CONST") || self.is("PERS") {
                self.fault(
                    self.at..self.at + 1,
                    "a declaration stands behind statements",
                    "put it at the routine's beginning",
                );
                let begin = self.at;
                self.datum(begin, Sight::Module);
                continue;
            }
            self.fault(
                self.at..self.at + 1,
                "nothing is open that it ends",
                "mend the blocks of the routine",
            );
            self.at += 1;
        }
        let (name, name_at) = name?;
        Some(Routine {
            kind,
            sight,
            name,
            name_at,
            parameters,
            data: routine_data,
            body,
            handlers,
            whole: begins..self.at,
            statements: statements.unwrap_or(start..start),
        })
    }

    /// Parses a declaration: `None` if none begins here, `Some(None)` if it is faulty, which is noted.
    pub(super) fn datum(&mut self, start: usize, sight: Sight) -> Option<Option<DatumNode>> {
        self.takes("TASK");
        let words = [
            ("CONST", Change::Constant),
            ("PERS", Change::Persistent),
            ("VAR", Change::Variable),
        ];
        let (_, change) = words.into_iter().find(|(word, _)| self.takes(word))?;
        let (type_name, name) = (self.name(), self.name());
        let open = self.at;
        while self
            .kind()
            .is_some_and(|kind| kind != Kind::Assign && kind != Kind::Symbol(b';'))
            && !self.is_keyword(self.at)
        {
            self.at += 1;
        }
        let dimensions = open..self.at;
        let assigned = self.kind() == Some(Kind::Assign);
        let first = self.at + 1;
        let tokens = self.rest_of_statement(start);
        let (Some((type_name, _)), Some((name, name_at))) = (type_name, name) else {
            return Some(None);
        };
        if !dimensions.is_empty() && self.file.word(open) != b"{" {
            self.fault(
                dimensions.clone(),
                "it does not belong into a declaration",
                "write the type, the name, and := value",
            );
            return Some(None);
        }
        Some(Some(DatumNode {
            change,
            sight,
            type_name,
            name,
            name_at,
            dimensions: (dimensions.len() > 2).then(|| dimensions.start + 1..dimensions.end - 1),
            initial: assigned.then(|| first..tokens.end.saturating_sub(1).max(first)),
            tokens,
            is_alone: true,
        }))
    }

    /// Parses parameters up to and with the closing parenthesis.
    pub(super) fn parameters(&mut self) -> Vec<Parameter> {
        let mut found = Vec::new();
        let (mut changes, mut is_optional) = (false, false);
        let mut last = None;
        while let Some(kind) = self.kind() {
            match kind {
                Kind::Word if ["INOUT", "VAR", "PERS"].iter().any(|word| self.is(word)) => {
                    changes = true
                }
                Kind::Word => last = Name::of(self.file.word(self.at)),
                Kind::Symbol(b',' | b'|' | b'\\' | b')') => {
                    found.extend(last.take().map(|name| Parameter {
                        name,
                        changes,
                        is_optional,
                    }));
                    changes = false;
                    // Alternatives (`\switch a | switch b`) are options as the first one is.
                    is_optional = match kind {
                        Kind::Symbol(b'|') => is_optional,
                        _ => kind == Kind::Symbol(b'\\'),
                    };
                }
                Kind::Symbol(b';') => break,
                _ => {}
            }
            self.at += 1;
            if kind == Kind::Symbol(b')') {
                break;
            }
        }
        found
    }
}
