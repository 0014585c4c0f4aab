//! From tokens to modules, routines and statements. What is wrong is noted, and the parser goes on.

use std::ops::Range;

use crate::error::ProgramError;
use crate::rapid::lex::Kind;
use crate::text::name::Name;
use crate::rapid::tree::{
    Change, Choice, DatumNode, Module, Parameter, Routine, RoutineKind, Sight, Statement, TokenFile,
};

/// Deepest nesting of blocks.
const DEEPEST: usize = 100;

/// Words that begin a statement or end a block: a statement before them has no semicolon.
const KEYWORDS: [&str; 36] = [
    "BACKWARD",
    "CASE",
    "CONST",
    "DEFAULT",
    "ELSE",
    "ELSEIF",
    "ENDFOR",
    "ENDFUNC",
    "ENDIF",
    "ENDMODULE",
    "ENDPROC",
    "ENDRECORD",
    "ENDTEST",
    "ENDTRAP",
    "ENDWHILE",
    "ERROR",
    "EXIT",
    "FOR",
    "FUNC",
    "GOTO",
    "IF",
    "LOCAL",
    "MODULE",
    "PERS",
    "PROC",
    "RAISE",
    "RECORD",
    "RETRY",
    "RETURN",
    "TASK",
    "TEST",
    "TRAP",
    "TRYNEXT",
    "UNDO",
    "VAR",
    "WHILE",
];

/// Words between operands.
const OPERATORS: [&str; 6] = ["AND", "DIV", "MOD", "NOT", "OR", "XOR"];

/// The modules of a file.
pub(crate) fn modules_of(file: &TokenFile<'_>, faults: &mut Vec<ProgramError>) -> Vec<Module> {
    let mut parser = Parser {
        file,
        at: 0,
        faults,
        jumps: false,
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

struct Parser<'f, 'a> {
    file: &'f TokenFile<'a>,
    at: usize,
    faults: &'f mut Vec<ProgramError>,
    /// The routine has a GOTO.
    jumps: bool,
    /// The end of the file was noted where the end of a block was missing.
    cut_off: bool,
}

impl Parser<'_, '_> {
    fn fault(&mut self, tokens: Range<usize>, reason: &str, remedy: &str) {
        let span = self.file.span(&tokens);
        self.faults
            .push(ProgramError::at(self.file.source, span, reason, remedy));
    }

    fn kind(&self) -> Option<Kind> {
        self.file.tokens.get(self.at).map(|token| token.kind)
    }

    fn word_is(&self, at: usize, capitals: &str) -> bool {
        let is_word = self
            .file
            .tokens
            .get(at)
            .is_some_and(|token| token.kind == Kind::Word);
        is_word && self.file.word(at).eq_ignore_ascii_case(capitals.as_bytes())
    }

    fn is(&self, capitals: &str) -> bool {
        self.word_is(self.at, capitals)
    }

    fn takes(&mut self, capitals: &str) -> bool {
        let found = self.is(capitals);
        self.at += usize::from(found);
        found
    }

    fn takes_symbol(&mut self, symbol: u8) -> bool {
        let found = self.kind() == Some(Kind::Symbol(symbol));
        self.at += usize::from(found);
        found
    }

    fn is_keyword(&self, at: usize) -> bool {
        KEYWORDS.iter().any(|word| self.word_is(at, word))
    }

    /// An identifier; of one that is none, the fault is noted.
    fn name(&mut self) -> Option<(Name, usize)> {
        let at = self.at;
        if self.kind() != Some(Kind::Word) {
            self.fault(at..at + 1, "a name is missing here", "write the name");
            return None;
        }
        self.at += 1;
        let name = Name::of(self.file.word(at));
        if name.is_none() {
            self.fault(
                at..at + 1,
                "the name has more than 32 characters",
                "shorten it everywhere",
            );
        }
        name.map(|name| (name, at))
    }

    /// To behind the next semicolon, or before a keyword where it is missing.
    fn rest_of_statement(&mut self, start: usize) -> Range<usize> {
        loop {
            match self.kind() {
                Some(Kind::Symbol(b';')) => {
                    self.at += 1;
                    return start..self.at;
                }
                Some(Kind::OpenText) => {
                    self.fault(
                        self.at..self.at + 1,
                        "the text is not closed on its line",
                        "close it with \"",
                    );
                    self.at += 1;
                    while self.kind().is_some() && !self.is_keyword(self.at) {
                        self.at += 1;
                    }
                    return start..self.at;
                }
                Some(Kind::Word)
                    if self.at > start && self.is_keyword(self.at) && !self.after_backslash() => {}
                Some(_) => {
                    self.at += 1;
                    continue;
                }
                None => {}
            }
            let end = self.at.max(start + 1);
            self.fault(
                start..end,
                "no semicolon ends the statement",
                "end it with ;",
            );
            return start..self.at;
        }
    }

    /// `\Default:=` is the name of an argument.
    fn after_backslash(&self) -> bool {
        let before = self
            .at
            .checked_sub(1)
            .and_then(|at| self.file.tokens.get(at));
        before.is_some_and(|token| token.kind == Kind::Symbol(b'\\'))
    }

    fn module(&mut self) -> Module {
        let start = self.at - 1;
        let mut module = Module {
            data: Vec::new(),
            routines: Vec::new(),
        };
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
            module.routines.extend(self.routine(kind, sight));
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

    /// None where no declaration begins; nothing inside where it is wrong, which is noted.
    fn datum(&mut self, start: usize, sight: Sight) -> Option<Option<DatumNode>> {
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
        let ((type_name, _), (name, name_at)) = (type_name?, name?);
        if !dimensions.is_empty() && self.file.word(open) != b"{" {
            self.fault(
                dimensions,
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
            initial: assigned.then(|| first..tokens.end.saturating_sub(1).max(first)),
            tokens,
        }))
    }

    fn routine(&mut self, kind: RoutineKind, sight: Sight) -> Option<Routine> {
        let start = self.at - 1;
        if kind == RoutineKind::Function {
            self.name();
        }
        let name = self.name();
        let parameters = match self.takes_symbol(b'(') {
            true => self.parameters(),
            false => Vec::new(),
        };
        self.jumps = false;
        let mut routine_data = Vec::new();
        let mut body = Vec::new();
        let mut handlers = Vec::new();
        let end = match kind {
            RoutineKind::Procedure => "ENDPROC",
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
            jumps: self.jumps,
        })
    }

    /// To behind the closing parenthesis.
    fn parameters(&mut self) -> Vec<Parameter> {
        let mut found = Vec::new();
        let mut changes = false;
        let mut last = None;
        while let Some(kind) = self.kind() {
            match kind {
                Kind::Word if ["INOUT", "VAR", "PERS"].iter().any(|word| self.is(word)) => {
                    changes = true
                }
                Kind::Word => last = Name::of(self.file.word(self.at)),
                Kind::Symbol(b',' | b'|' | b'\\' | b')') => {
                    found.extend(last.take().map(|name| Parameter { name, changes }));
                    changes = false;
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

    /// Statements up to a word that ends or divides a block.
    fn block(&mut self, statements: &mut Vec<Statement>, depth: usize) {
        while let Some(kind) = self.kind() {
            match kind {
                Kind::Symbol(b';') => self.at += 1,
                Kind::Word if self.is_keyword(self.at) => {
                    if !self.structure(statements, depth) {
                        return;
                    }
                }
                _ => statements.extend(self.simple()),
            }
        }
    }

    /// A statement that a keyword begins; false where the keyword is the block's end.
    fn structure(&mut self, statements: &mut Vec<Statement>, depth: usize) -> bool {
        let start = self.at;
        if depth >= DEEPEST
            && ["IF", "FOR", "WHILE", "TEST"]
                .iter()
                .any(|word| self.is(word))
        {
            self.fault(
                start..start + 1,
                "blocks are nested deeper than 100",
                "take the inner ones into a routine",
            );
            // Nothing behind it is read.
            self.at = self.file.tokens.len();
            return false;
        }
        if self.takes("IF") {
            statements.extend(self.branches(start, depth));
        } else if self.takes("FOR") {
            statements.push(self.repeated(start, "ENDFOR", depth));
        } else if self.takes("WHILE") {
            statements.push(self.repeated(start, "ENDWHILE", depth));
        } else if self.takes("TEST") {
            statements.push(self.test(start, depth));
        } else if ["RETURN", "EXIT", "RAISE", "RETRY", "TRYNEXT", "GOTO"]
            .iter()
            .any(|word| self.is(word))
        {
            self.jumps |= self.is("GOTO");
            self.at += 1;
            let tokens = self.rest_of_statement(start);
            statements.push(Statement::Leaves { tokens });
        } else {
            return false;
        }
        true
    }

    /// Tokens up to one of the words, which is not taken; none where a semicolon or another keyword comes first.
    fn up_to(&mut self, words: &[&str]) -> Option<Range<usize>> {
        let start = self.at;
        while let Some(kind) = self.kind() {
            if words.iter().any(|word| self.is(word)) {
                return Some(start..self.at);
            }
            if kind == Kind::Symbol(b';') || kind == Kind::Word && self.is_keyword(self.at) {
                return None;
            }
            self.at += 1;
        }
        None
    }

    fn close(&mut self, start: usize, word: &str) {
        if !self.takes(word) {
            self.missing(
                start..start + 1,
                &format!("no {word} ends it"),
                &format!("end it with {word}"),
            );
        }
    }

    /// An end that is missing; at the end of the file only the innermost is noted.
    fn missing(&mut self, tokens: Range<usize>, reason: &str, remedy: &str) {
        if self.kind().is_some() || !std::mem::replace(&mut self.cut_off, true) {
            self.fault(tokens, reason, remedy);
        }
    }

    fn repeated(&mut self, start: usize, end: &str, depth: usize) -> Statement {
        let header = self.up_to(&["DO"]);
        if header.is_none() {
            self.fault(
                start..self.at.max(start + 1),
                "DO is missing",
                "write DO behind the loop's condition",
            );
        }
        self.takes("DO");
        let mut block = Vec::new();
        self.block(&mut block, depth + 1);
        self.close(start, end);
        Statement::Loop {
            header: header.unwrap_or(start..start),
            block,
        }
    }

    fn test(&mut self, start: usize, depth: usize) -> Statement {
        let header = self
            .up_to(&["CASE", "DEFAULT", "ENDTEST"])
            .unwrap_or(start..start);
        let mut blocks = Vec::new();
        let mut choice = Choice::AtMostOne;
        loop {
            let is_default = self.is("DEFAULT");
            if !is_default && !self.is("CASE") {
                break;
            }
            let case = self.at;
            while self
                .kind()
                .is_some_and(|kind| kind != Kind::Symbol(b':') && kind != Kind::Symbol(b';'))
            {
                self.at += 1;
            }
            if !self.takes_symbol(b':') {
                self.fault(
                    case..case + 1,
                    "a colon is missing behind it",
                    "end it with :",
                );
            }
            if is_default {
                choice = Choice::OneOfAll;
            }
            let mut block = Vec::new();
            self.block(&mut block, depth + 1);
            blocks.push(block);
        }
        self.close(start, "ENDTEST");
        Statement::Branches {
            header,
            choice,
            blocks,
        }
    }

    fn branches(&mut self, start: usize, depth: usize) -> Option<Statement> {
        let condition = self.condition();
        let header = condition.clone();
        if !self.takes("THEN") {
            // One statement without THEN.
            let mut block = Vec::new();
            if self.is_keyword(self.at) {
                if !self.structure(&mut block, depth + 1) {
                    self.fault(
                        start..self.at.max(start + 1),
                        "THEN is missing",
                        "write THEN behind the condition",
                    );
                }
            } else {
                block.extend(self.simple());
            }
            return Some(Statement::Branches {
                header,
                choice: Choice::Compact,
                blocks: vec![block],
            });
        }
        let mut blocks = Vec::new();
        let mut choice = Choice::AtMostOne;
        loop {
            let mut block = Vec::new();
            self.block(&mut block, depth + 1);
            blocks.push(block);
            if self.takes("ELSEIF") {
                self.condition();
                if !self.takes("THEN") {
                    self.fault(
                        self.at..self.at + 1,
                        "THEN is missing before it",
                        "write THEN behind the condition",
                    );
                }
            } else if self.takes("ELSE") {
                choice = Choice::OneOfAll;
            } else {
                break;
            }
        }
        self.close(start, "ENDIF");
        Some(Statement::Branches {
            header,
            choice,
            blocks,
        })
    }

    /// An expression: it ends at THEN, or where a word follows an operand.
    fn condition(&mut self) -> Range<usize> {
        let start = self.at;
        let mut open = 0_usize;
        let mut operand = false;
        while let Some(kind) = self.kind() {
            match kind {
                Kind::Symbol(b'(' | b'[' | b'{') => {
                    open += 1;
                    operand = false;
                }
                Kind::Symbol(b')' | b']' | b'}') => {
                    open = open.saturating_sub(1);
                    operand = true;
                }
                Kind::Symbol(b';') => break,
                Kind::Word if OPERATORS.iter().any(|word| self.is(word)) => operand = false,
                Kind::Word if self.is_keyword(self.at) => break,
                Kind::Word if open == 0 && (operand || self.is("THEN")) => break,
                Kind::Symbol(b'%') if open == 0 && operand => break,
                Kind::Word | Kind::Number | Kind::Text => operand = true,
                _ => operand = false,
            }
            self.at += 1;
        }
        start..self.at
    }

    /// An assignment, a call, a label or a connection.
    fn simple(&mut self) -> Option<Statement> {
        let start = self.at;
        let next = self.file.tokens.get(start + 1).map(|token| token.kind);
        if self.kind() == Some(Kind::Word) && next == Some(Kind::Symbol(b':')) {
            self.at += 2;
            return Some(Statement::Label);
        }
        let tokens = self.rest_of_statement(start);
        if tokens.is_empty() {
            self.at += 1;
            return None;
        }
        let begins = self.file.tokens.get(start).map(|token| token.kind);
        if !matches!(begins, Some(Kind::Word | Kind::Symbol(b'%'))) {
            self.fault(
                tokens,
                "no statement begins so",
                "mend it: the module must compile on the controller",
            );
            return None;
        }
        // Behind the name, its components and its index; `\WObj:=` is of a call.
        let assign = tokens.clone().find(|at| {
            let kind = self.file.tokens[*at].kind;
            matches!(kind, Kind::Assign | Kind::Symbol(b'\\' | b','))
        });
        let is_assignment = |at: &usize| self.file.tokens[*at].kind == Kind::Assign;
        Some(match assign.filter(is_assignment) {
            Some(assign) => Statement::Assignment { tokens, assign },
            None => Statement::Call { tokens },
        })
    }
}
