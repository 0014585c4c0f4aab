//! The control flow of one program.

use std::collections::BTreeMap;

use crate::error::{ProgramError, note};
use crate::siemens::block::{Block, STATEMENTS, What};
use crate::siemens::expression::Cursor;
use crate::siemens::flat::statements::{
    Control, Parameter, case, condition, for_loop, jump, procedure, repeat,
};
use crate::siemens::table::row;
use crate::siemens::tokens::{Broken, Token};
use crate::table::Treatment;
use crate::text::source::SourceFile;

/// A program.
#[derive(Debug, Default)]
pub(super) struct Unit {
    pub lines: Vec<Line>,
    /// Lines by label in capitals, ascending.
    pub labels: BTreeMap<Vec<u8>, Vec<usize>>,
    /// Lines by block number.
    pub numbers: BTreeMap<u64, Vec<usize>>,
    pub parameters: Vec<Parameter>,
    /// PROC ... SAVE.
    pub saves: bool,
    /// Nothing is wrong with what says which line runs next.
    pub runs: bool,
}

/// A line, counted from 0.
#[derive(Debug)]
pub(super) struct Line {
    pub block: Block,
    pub control: Control,
    /// Tokens of a DEF.
    pub tokens: Vec<Token>,
}

/// True if a line that cannot be read may change the control flow or a variable.
fn controls(text: &[u8]) -> bool {
    let text = text.split(|byte| *byte == b';').next().unwrap_or_default();
    if text.contains(&b'=') {
        return true;
    }
    let mut words = text.split(|byte| !byte.is_ascii_alphanumeric() && *byte != b'_');
    words.any(|word| {
        let word = String::from_utf8_lossy(word).to_ascii_uppercase();
        STATEMENTS.contains(&word.as_str())
    })
}

impl Unit {
    /// Parses a file and notes its errors.
    pub(super) fn of(file: &SourceFile, faults: &mut Vec<ProgramError>) -> Self {
        let mut unit = Self {
            runs: true,
            ..Self::default()
        };
        let mut open: Vec<usize> = Vec::new();
        for number in 1..=file.line_count() {
            let range = file.range_of(number);
            if number == file.line_count() && range.is_empty() {
                break;
            }
            let line = unit.lines.len();
            let made = Block::of(file.bytes(), range).and_then(|(block, tokens)| {
                let control = unit.control(file.bytes(), &block, &tokens)?;
                Ok((block, tokens, control))
            });
            let (block, tokens, control) = match made {
                Ok(made) => made,
                Err(broken) => {
                    let text = file.part(&file.range_of(number));
                    unit.runs &= !controls(text);
                    note(faults, || {
                        ProgramError::at(file, broken.span, broken.reason, broken.remedy)
                    });
                    // The line is written unchanged.
                    let block = Block::unread(file.range_of(number));
                    (block, Vec::new(), Control::None)
                }
            };
            if let Some(label) = &block.label {
                let name = file.part(label).to_ascii_uppercase();
                unit.labels.entry(name).or_default().push(line);
            }
            if let Some(number) = block.number {
                unit.numbers.entry(number).or_default().push(line);
            }
            let span = block.span.clone();
            unit.lines.push(Line {
                tokens: match control {
                    Control::Define => tokens,
                    _ => Vec::new(),
                },
                block,
                control,
            });
            // A line that opens and cannot be read would leave what closes it alone.
            if unit.runs
                && let Err(reason) = unit.pair(line, file, &mut open)
            {
                unit.runs = false;
                let remedy =
                    "close each IF, WHILE, FOR, LOOP and REPEAT once, the inner ones first";
                note(faults, || ProgramError::at(file, span, reason, remedy));
            }
        }
        if !unit.runs {
            open.clear();
        }
        unit.runs &= open.is_empty();
        for line in open {
            let span = unit.lines[line].block.span.clone();
            note(faults, || {
                ProgramError::at(file, span, "it is not closed", "write what closes it")
            });
        }
        unit
    }

    /// The first word of a line in capitals.
    fn word(&self, line: usize, file: &SourceFile) -> Vec<u8> {
        let item = self.lines[line].block.items.first();
        item.map_or(Vec::new(), |item| {
            file.part(&item.name).to_ascii_uppercase()
        })
    }

    /// Joins what opens with what closes.
    fn pair(
        &mut self,
        line: usize,
        file: &SourceFile,
        open: &mut Vec<usize>,
    ) -> Result<(), &'static str> {
        let word = self.word(line, file);
        let opener = open.last().copied();
        let opens = opener.map_or(Vec::new(), |at| self.word(at, file));
        let closes: &[&[u8]] = match (word.as_slice(), &self.lines[line].control) {
            (_, Control::None | Control::Repeat { .. }) | (b"IF", Control::Jump(_)) => {
                return Ok(());
            }
            (b"IF" | b"WHILE" | b"FOR" | b"LOOP" | b"REPEAT", _) => {
                open.push(line);
                return Ok(());
            }
            (b"ELSE", _) => &[b"IF"],
            (b"ENDIF", _) => &[b"IF", b"ELSE"],
            (b"ENDWHILE", _) => &[b"WHILE"],
            (b"ENDFOR", _) => &[b"FOR"],
            (b"UNTIL", _) => &[b"REPEAT"],
            (b"ENDLOOP", _) => &[b"LOOP"],
            _ => return Ok(()),
        };
        let (Some(opener), true) = (opener, closes.contains(&opens.as_slice())) else {
            return Err("nothing that it closes is open");
        };
        open.pop();
        if word == b"ELSE" {
            open.push(line);
        }
        match &mut self.lines[opener].control {
            Control::Unless { to, .. } | Control::Goto(to) | Control::For { end: to, .. } => {
                *to = line + 1;
            }
            _ => {}
        }
        match &mut self.lines[line].control {
            Control::Goto(start) | Control::EndFor(start) => *start = opener,
            // UNTIL.
            Control::Unless { to, .. } => *to = opener + 1,
            _ => {}
        }
        Ok(())
    }

    fn control(
        &mut self,
        bytes: &[u8],
        block: &Block,
        tokens: &[Token],
    ) -> Result<Control, Broken> {
        let statement = block.items.iter().find(|item| item.what == What::Statement);
        let Some(item) = statement else {
            return Ok(Control::None);
        };
        let broken = |reason, remedy| Broken {
            span: item.span.clone(),
            reason,
            remedy,
        };
        if block.items.len() > 1 || block.skip {
            return Err(broken(
                "it does not stand alone in its block, or behind a slash",
                "write it as a block of its own, without a slash",
            ));
        }
        let from = tokens.iter().position(|token| token.span == item.name);
        let mut cursor = Cursor::new(bytes, &tokens[from.unwrap_or(0)..]);
        let word = bytes[item.name.clone()].to_ascii_uppercase();
        if !matches!(
            word.as_slice(),
            b"DEF" | b"GOTO" | b"GOTOF" | b"GOTOB" | b"GOTOC" | b"IF"
        ) {
            cursor.at = 1;
        }
        let control = match word.as_slice() {
            b"IF" => condition(&mut cursor)?,
            b"ENDIF" | b"LOOP" => Control::Mark,
            b"WHILE" | b"UNTIL" => Control::Unless {
                condition: cursor.expression()?,
                to: 0,
            },
            b"ELSE" | b"ENDWHILE" | b"ENDLOOP" => Control::Goto(0),
            b"FOR" => for_loop(&mut cursor)?,
            b"ENDFOR" => Control::EndFor(0),
            b"REPEAT" if cursor.peek().is_none() => Control::Mark,
            b"REPEAT" | b"REPEATB" => repeat(&mut cursor, word == b"REPEATB")?,
            b"GOTO" | b"GOTOF" | b"GOTOB" | b"GOTOC" => {
                Control::Jump(vec![(None, jump(&mut cursor)?)])
            }
            b"CASE" => case(&mut cursor)?,
            b"DEF" => return Ok(Control::Define),
            b"EXTERN" => return Ok(Control::Mark),
            b"PROC" => {
                let (parameters, saves) = procedure(&mut cursor)?;
                self.parameters = parameters;
                self.saves |= saves;
                return Ok(Control::Mark);
            }
            b"CALL" => {
                return Err(broken(
                    "what is called is stated by a text",
                    "call it by its name",
                ));
            }
            word => {
                let word = String::from_utf8_lossy(word).into_owned();
                return Err(match row(&word).map(|row| row.treatment) {
                    Some(Treatment::Refused { reason, remedy }) if word != "GOTOS" => {
                        broken(reason, remedy)
                    }
                    _ => broken("it is not followed", "write the program without it"),
                });
            }
        };
        match cursor.peek() {
            None => Ok(control),
            Some(token) => Err(Broken {
                span: token.span.clone(),
                reason: "more stands behind the statement",
                remedy: "write it as a block of its own",
            }),
        }
    }
}
