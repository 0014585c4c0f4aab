//! From lines to routines and data. Blocks are kept on a list, not on the stack of calls: any depth is safe.

use std::ops::Range;

use crate::error::ProgramError;
use crate::krl::lex::{Kind, TokenFile};
use crate::krl::tree::{Content, DatumNode, Least, Parameter, Preset, Routine, Statement};

/// Deepest nesting of blocks.
const DEEPEST: usize = 100;

/// Types that need no DECL.
const TYPES: [&str; 11] = [
    "INT", "REAL", "BOOL", "CHAR", "FRAME", "POS", "E3POS", "E6POS", "AXIS", "E3AXIS", "E6AXIS",
];

/// The content of a file.
pub(crate) fn content_of(file: &TokenFile<'_>, faults: &mut Vec<ProgramError>) -> Content {
    let mut parser = Parser {
        file,
        faults,
        content: Content::default(),
        routine: None,
        blocks: Vec::new(),
        in_list: false,
        in_spline: false,
        lost: false,
        outside: false,
    };
    for line in 0..file.lines.len() {
        parser.line(line);
    }
    parser.end_of_file();
    parser.content
}

/// A block that is not closed yet.
enum Block {
    Branches {
        header: usize,
        is_switch: bool,
        complete: bool,
        blocks: Vec<Vec<Statement>>,
        now: Vec<Statement>,
    },
    Loop {
        header: usize,
        word: &'static str,
        block: Vec<Statement>,
    },
}

struct Parser<'p, 'a> {
    file: &'p TokenFile<'a>,
    faults: &'p mut Vec<ProgramError>,
    content: Content,
    routine: Option<Routine>,
    blocks: Vec<Block>,
    in_list: bool,
    in_spline: bool,
    /// Blocks were not nested as they must be: one fault for a routine is enough.
    lost: bool,
    outside: bool,
}

impl Parser<'_, '_> {
    fn fault(&mut self, tokens: &Range<usize>, reason: impl Into<String>, remedy: &str) {
        let span = self.file.span(tokens);
        self.faults
            .push(ProgramError::at(self.file.source, span, reason, remedy));
    }

    fn line(&mut self, line: usize) {
        let tokens = self.file.lines[line].tokens.clone();
        if tokens.is_empty() {
            return;
        }
        let word = |offset: usize| {
            let at = tokens.start + offset;
            (at < tokens.end).then(|| self.file.name(at)).flatten()
        };
        let is = |offset: usize, capitals: &str| word(offset).is_some_and(|name| name.is(capitals));
        let second = usize::from(is(0, "GLOBAL"));
        if is(second, "DEF") || is(second, "DEFFCT") {
            return self.begin_routine(&tokens, tokens.start + second, is(second, "DEFFCT"));
        }
        if is(0, "DEFDAT") {
            self.in_list = true;
            self.content.list = word(1);
            return;
        }
        if self.in_spline {
            self.in_spline = !is(0, "ENDSPLINE");
            return;
        }
        if is(0, "END") || is(0, "ENDFCT") {
            return self.end_routine(&tokens);
        }
        if is(0, "ENDDAT") {
            self.in_list = false;
            return;
        }
        if is(0, "SPLINE") || is(0, "PTP_SPLINE") {
            self.in_spline = true;
        }
        let declares = is(0, "DECL")
            || is(0, "CONST")
            || (is(0, "GLOBAL") && !is(1, "INTERRUPT"))
            || (word(1).is_some() && TYPES.iter().any(|capitals| is(0, capitals)));
        if declares {
            return self.declaration(&tokens);
        }
        match self.routine.is_some() {
            true => self.statement(line, &tokens),
            false if self.in_list => self.preset(&tokens),
            false if self.outside => {}
            false => {
                // Once for a file: nothing of it is where it must be.
                self.outside = true;
                self.fault(
                    &tokens,
                    "it stands in no routine and no data list",
                    "begin the file with DEF or DEFDAT, as the controller saves it",
                );
            }
        }
    }

    fn begin_routine(&mut self, tokens: &Range<usize>, def: usize, is_function: bool) {
        if let Some(routine) = &self.routine {
            let open = routine.name_at..routine.name_at + 1;
            self.fault(&open, "the routine has no end", "end it with END or ENDFCT");
            self.close();
        }
        // A function has its type before its name, with `[]` where it is an array.
        let mut name_at = def + 1 + usize::from(is_function);
        while self.file.is(name_at, b'[') || self.file.is(name_at, b']') {
            name_at += 1;
        }
        let name = (name_at < tokens.end)
            .then(|| self.file.name(name_at))
            .flatten();
        let Some(name) = name else {
            return self.fault(tokens, "the routine has no name", "write DEF name()");
        };
        let mut parameters = Vec::new();
        for at in name_at + 1..tokens.end {
            let separated = self.file.is(at - 1, b'(') || self.file.is(at - 1, b',');
            if let (true, Some(name)) = (separated, self.file.name(at)) {
                let mut rest = at + 1;
                while rest < tokens.end && !self.file.is(rest, b',') && !self.file.is(rest, b':') {
                    rest += 1;
                }
                let is_in = self.file.is(rest, b':')
                    && self.file.word(rest + 1).eq_ignore_ascii_case(b"IN");
                parameters.push(Parameter {
                    name,
                    changes: !is_in,
                });
            }
        }
        self.lost = false;
        self.routine = Some(Routine {
            is_global: def > tokens.start,
            name,
            name_at,
            parameters,
            data: Vec::new(),
            body: Vec::new(),
            jumps: false,
        });
    }

    fn end_routine(&mut self, tokens: &Range<usize>) {
        match self.routine.is_some() {
            true => self.close(),
            false => self.fault(
                tokens,
                "no routine is open here",
                "remove it, or begin the routine with DEF",
            ),
        }
    }

    fn end_of_file(&mut self) {
        if let Some(routine) = &self.routine {
            let open = routine.name_at..routine.name_at + 1;
            self.fault(&open, "the routine has no end", "end it with END or ENDFCT");
            self.close();
        }
    }

    /// Ends the routine and what is open in it.
    fn close(&mut self) {
        while let Some(block) = self.blocks.pop() {
            let header = match &block {
                Block::Branches { header, .. } | Block::Loop { header, .. } => *header,
            };
            if !self.lost {
                let tokens = self.file.lines[header].tokens.clone();
                self.fault(
                    &tokens,
                    "the block has no end",
                    "close it as the controller does",
                );
            }
            self.lost = true;
            let statement = finished(block);
            self.push(statement);
        }
        self.content.routines.extend(self.routine.take());
    }

    fn push(&mut self, statement: Statement) {
        match self.blocks.last_mut() {
            Some(Block::Branches { now, .. }) => now.push(statement),
            Some(Block::Loop { block, .. }) => block.push(statement),
            None => {
                if let Some(routine) = &mut self.routine {
                    routine.body.push(statement);
                }
            }
        }
    }

    fn open(&mut self, tokens: &Range<usize>, block: Block) {
        if self.blocks.len() == DEEPEST && !self.lost {
            self.lost = true;
            self.fault(
                tokens,
                "blocks are nested deeper than 100",
                "put what is deepest into a routine",
            );
        }
        if self.blocks.len() < DEEPEST {
            self.blocks.push(block);
        }
    }

    fn statement(&mut self, line: usize, tokens: &Range<usize>) {
        let Some(word) = self.file.name(tokens.start) else {
            return self.push(Statement::Simple(line));
        };
        let looped = |word: &'static str| Block::Loop {
            header: line,
            word,
            block: Vec::new(),
        };
        let letters = word.letters();
        let is_label = tokens.len() == 2 && self.file.is(tokens.start + 1, b':');
        match letters {
            _ if is_label => self.push(Statement::Label),
            b"IF" | b"SWITCH" => {
                let block = Block::Branches {
                    header: line,
                    is_switch: letters == b"SWITCH",
                    complete: false,
                    blocks: Vec::new(),
                    now: Vec::new(),
                };
                self.open(tokens, block);
            }
            b"ELSE" => self.next_branch(tokens, false, true),
            b"CASE" => self.next_branch(tokens, true, false),
            b"DEFAULT" => self.next_branch(tokens, true, true),
            b"ENDIF" => self.end_branches(tokens, false),
            b"ENDSWITCH" => self.end_branches(tokens, true),
            b"LOOP" => self.open(tokens, looped("LOOP")),
            b"FOR" => self.open(tokens, looped("FOR")),
            b"WHILE" => self.open(tokens, looped("WHILE")),
            b"REPEAT" => self.open(tokens, looped("REPEAT")),
            b"ENDLOOP" => self.end_loop(tokens, "LOOP"),
            b"ENDFOR" => self.end_loop(tokens, "FOR"),
            b"ENDWHILE" => self.end_loop(tokens, "WHILE"),
            b"UNTIL" => self.end_loop(tokens, "REPEAT"),
            b"EXIT" => self.push(Statement::Exit),
            b"RETURN" => self.push(Statement::Leaves(line)),
            b"GOTO" => {
                if let Some(routine) = &mut self.routine {
                    routine.jumps = true;
                }
                self.push(Statement::Leaves(line));
            }
            _ => self.push(Statement::Simple(line)),
        }
    }

    fn next_branch(&mut self, tokens: &Range<usize>, of_switch: bool, is_last: bool) {
        match self.blocks.last_mut() {
            Some(Block::Branches {
                is_switch,
                complete,
                blocks,
                now,
                ..
            }) if *is_switch == of_switch => {
                blocks.push(std::mem::take(now));
                *complete |= is_last;
            }
            _ => self.misplaced(tokens),
        }
    }

    fn misplaced(&mut self, tokens: &Range<usize>) {
        if !self.lost {
            self.lost = true;
            self.fault(
                tokens,
                "it closes no block that is open here",
                "close blocks in the order in which they are opened",
            );
        }
    }

    fn end_branches(&mut self, tokens: &Range<usize>, of_switch: bool) {
        match self.blocks.pop() {
            Some(block @ Block::Branches { is_switch, .. }) if is_switch == of_switch => {
                let statement = finished(block);
                self.push(statement);
            }
            other => {
                self.blocks.extend(other);
                self.misplaced(tokens);
            }
        }
    }

    fn end_loop(&mut self, tokens: &Range<usize>, opened: &str) {
        match self.blocks.pop() {
            Some(block @ Block::Loop { word, .. }) if word == opened => {
                let statement = finished(block);
                self.push(statement);
            }
            other => {
                self.blocks.extend(other);
                self.misplaced(tokens);
            }
        }
    }

    /// `[GLOBAL] [DECL] [CONST] type name[3]=value, name`.
    fn declaration(&mut self, tokens: &Range<usize>) {
        let mut at = tokens.start;
        let (mut is_global, mut is_other) = (false, false);
        while let Some(name) = (at < tokens.end).then(|| self.file.name(at)).flatten() {
            is_global |= name.is("GLOBAL");
            is_other |= ["STRUC", "ENUM", "SIGNAL", "EXT", "EXTFCT"]
                .iter()
                .any(|word| name.is(word));
            if !["GLOBAL", "DECL", "CONST"].iter().any(|word| name.is(word)) {
                break;
            }
            at += 1;
        }
        if is_other {
            return;
        }
        let Some(type_name) = (at < tokens.end).then(|| self.file.name(at)).flatten() else {
            return self.fault(tokens, "nothing is declared here", "write DECL type name");
        };
        let mut found = Vec::new();
        let mut start = at + 1;
        while start < tokens.end {
            let end = self
                .file
                .find(start..tokens.end, b',')
                .unwrap_or(tokens.end);
            let Some(name) = self.file.name(start) else {
                return self.fault(
                    tokens,
                    "a declared name is missing or longer than 24 characters",
                    "write DECL type name",
                );
            };
            let assign = self.file.assign(&(start..end));
            found.push(DatumNode {
                type_name,
                name,
                name_at: start,
                tokens: tokens.clone(),
                initial: assign.map(|assign| assign + 1..end),
                alone: start == at + 1 && end == tokens.end,
                is_global,
            });
            start = end + 1;
        }
        match &mut self.routine {
            Some(routine) => routine.data.extend(found),
            None => self.content.data.extend(found),
        }
    }

    /// `name[3]=value` in a data list.
    fn preset(&mut self, tokens: &Range<usize>) {
        let Some(name) = self.file.name(tokens.start) else {
            return;
        };
        let Some(assign) = self.file.assign(tokens) else {
            return;
        };
        if let Some(index) = literal_index(self.file, tokens.start + 1..assign) {
            self.content.presets.push(Preset {
                name,
                index,
                tokens: tokens.clone(),
                value: assign + 1..tokens.end,
            });
        }
    }
}

/// `[3]`, or nothing, which is 0; none for all else.
pub(crate) fn literal_index(file: &TokenFile<'_>, tokens: Range<usize>) -> Option<u32> {
    if tokens.is_empty() {
        return Some(0);
    }
    let is_number = tokens.len() == 3 && file.tokens[tokens.start + 1].kind == Kind::Number;
    let closed = file.is(tokens.start, b'[') && file.is(tokens.end - 1, b']');
    let text = std::str::from_utf8(file.word(tokens.start + 1)).ok()?;
    (is_number && closed).then(|| text.parse().ok())?
}

fn finished(block: Block) -> Statement {
    match block {
        Block::Branches {
            header,
            is_switch,
            complete,
            mut blocks,
            now,
        } => {
            blocks.push(now);
            // What stands between SWITCH and the first CASE never runs.
            if is_switch && blocks.len() > 1 {
                blocks.remove(0);
            }
            Statement::Branches {
                header,
                complete,
                blocks,
            }
        }
        Block::Loop {
            header,
            word,
            block,
        } => {
            let least = match word {
                "LOOP" | "REPEAT" => Least::Once,
                _ => Least::Never,
            };
            Statement::Loop {
                header,
                least,
                block,
            }
        }
    }
}
