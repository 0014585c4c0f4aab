//! Expressions from tokens, by the grammar of a language.

use std::ops::Range;

use crate::interpreter::expression::{Argument, Expression, Node, Operator};
use crate::interpreter::token::{Kind, TokenFile};
use crate::text::Name;

/// Deepest nesting of lists, calls and indices.
const DEEPEST: usize = 32;

/// Limit of consecutive operators of one precedence: it bounds the depth of the tree.
const MOST_OPERATORS: usize = 100;

/// Expression grammar of a language.
pub(crate) struct Grammar {
    /// Operators between two operands, longer ones before those that they begin with, and how strongly each binds.
    pub operators: &'static [(&'static str, Operator, u8)],
    /// Precedence of NOT.
    pub not: u8,
    /// Precedence of a sign.
    pub sign: u8,
    /// Brackets of an index.
    pub index: [u8; 2],
    /// Brackets of a list, where the language has them.
    pub list: Option<[u8; 2]>,
    /// True where braces hold members by their names.
    pub has_members: bool,
    /// True where an argument may be named: `name=value`.
    pub names_arguments: bool,
    /// True where the first element of a list is that of index 1; otherwise of index 0, and members have indices, too.
    pub counts_from_one: bool,
    /// Literals of false and true, in this order.
    pub truths: [&'static str; 2],
    /// A list behind this word is an aggregate with these members: `p[x,y,z,rx,ry,rz]`.
    pub aggregate: Option<(&'static str, &'static [&'static str])>,
    /// True where AND beside a comparison without brackets is not read: controllers bind it otherwise than people do.
    pub separates_comparisons: bool,
}

/// The arguments of a call between two tokens.
pub(crate) fn arguments_of(
    grammar: &'static Grammar,
    file: &TokenFile<'_>,
    tokens: Range<usize>,
) -> Vec<Argument> {
    let mut reader = Reader {
        grammar,
        file,
        at: tokens.start,
        end: tokens.end.min(file.tokens.len()),
    };
    reader.arguments(0)
}

/// The expression that tokens are.
pub(crate) fn expression_of(
    grammar: &'static Grammar,
    file: &TokenFile<'_>,
    tokens: Range<usize>,
) -> Expression {
    let mut reader = Reader {
        grammar,
        file,
        at: tokens.start,
        end: tokens.end.min(file.tokens.len()),
    };
    let found = reader.expression(0);
    match found.tokens.end == tokens.end {
        true => found,
        false => Expression {
            node: Node::Unreadable,
            tokens,
        },
    }
}

struct Reader<'f, 'a> {
    grammar: &'static Grammar,
    file: &'f TokenFile<'a>,
    at: usize,
    end: usize,
}

impl Reader<'_, '_> {
    fn kind(&self) -> Option<Kind> {
        let inside = (self.at < self.end).then_some(self.at)?;
        self.file.tokens.get(inside).map(|token| token.kind)
    }

    fn takes(&mut self, symbol: u8) -> bool {
        let found = self.kind() == Some(Kind::Symbol(symbol));
        self.at += usize::from(found);
        found
    }

    fn arguments(&mut self, depth: usize) -> Vec<Argument> {
        let mut found = Vec::new();
        while let Some(kind) = self.kind() {
            match kind {
                Kind::Symbol(b')' | b';') => break,
                Kind::Symbol(b',') => self.at += 1,
                Kind::Symbol(b'\\') => {
                    self.at += 1;
                    let option = self.name();
                    let valued = self.kind() == Some(Kind::Assign)
                        || self.kind() == Some(Kind::Symbol(b'?'));
                    self.at += usize::from(valued);
                    let value = valued.then(|| self.expression(depth));
                    found.push(Argument { option, value });
                }
                Kind::Word if self.grammar.names_arguments && self.is_named() => {
                    let option = self.name();
                    self.at += 1;
                    let value = Some(self.expression(depth));
                    found.push(Argument { option, value });
                }
                _ => {
                    let start = self.at;
                    let value = Some(self.expression(depth));
                    found.push(Argument {
                        option: None,
                        value,
                    });
                    // A bracket that nothing opened.
                    if self.at == start {
                        self.at += 1;
                    }
                }
            }
        }
        found
    }

    fn is_named(&self) -> bool {
        let next = self.file.tokens.get(self.at + 1);
        self.at + 1 < self.end && next.is_some_and(|next| next.kind == Kind::Assign)
    }

    fn name(&mut self) -> Option<Name> {
        let word = self.file.word(self.at);
        let is_word = self.kind() == Some(Kind::Word);
        self.at += usize::from(is_word);
        is_word.then(|| Name::of(word))?
    }

    /// Parses an expression up to a comma, a backslash, a closing bracket or the end.
    fn expression(&mut self, depth: usize) -> Expression {
        let start = self.at;
        let found = (depth < DEEPEST)
            .then(|| self.operation(depth, 0))
            .flatten();
        let over = match self.kind() {
            None => true,
            Some(Kind::Symbol(symbol)) => b",\\)]};".contains(&symbol),
            Some(_) => false,
        };
        match found {
            Some(found) if over => found,
            _ => {
                self.skip();
                Expression {
                    node: Node::Unreadable,
                    tokens: start..self.at,
                }
            }
        }
    }

    /// Operands and the operators between them that bind at least so strongly.
    fn operation(&mut self, depth: usize, least: u8) -> Option<Expression> {
        if depth >= DEEPEST {
            return None;
        }
        let start = self.at;
        let is_mark = self.kind() == Some(Kind::Symbol(b'!')) && self.operator().is_none();
        let mut left = match is_mark || self.is_word("NOT") {
            true => {
                self.at += 1;
                let operand = self.operation(depth + 1, self.grammar.not)?;
                self.over(start, Node::One(Operator::Not, Box::new(operand)))
            }
            false => self.signed(depth)?,
        };
        let mut count_of_operators = 0;
        while let Some((operator, strength, count)) = self.operator() {
            if strength < least {
                break;
            }
            count_of_operators += 1;
            if count_of_operators > MOST_OPERATORS {
                return None;
            }
            self.at += count;
            let right = self.operation(depth + 1, strength + 1)?;
            if self.grammar.separates_comparisons
                && matches!(operator, Operator::And | Operator::Or | Operator::Xor)
                && (self.is_bare_comparison(&left) || self.is_bare_comparison(&right))
            {
                return None;
            }
            left = self.over(start, Node::Two(operator, Box::new([left, right])));
        }
        Some(left)
    }

    /// An expression from a token to here.
    fn over(&self, start: usize, node: Node) -> Expression {
        Expression {
            node,
            tokens: start..self.at,
        }
    }

    fn is_word(&self, capitals: &str) -> bool {
        let is_word = self.kind() == Some(Kind::Word);
        is_word && (self.file.word(self.at)).eq_ignore_ascii_case(capitals.as_bytes())
    }

    /// The operator that stands here, how strongly it binds, and its tokens.
    fn operator(&self) -> Option<(Operator, u8, usize)> {
        let kind = self.kind()?;
        let mut all = self.grammar.operators.iter();
        match kind {
            Kind::Word => {
                let (_, operator, strength) = all.find(|(text, ..)| self.is_word(text))?;
                Some((*operator, *strength, 1))
            }
            Kind::Symbol(first) => {
                let stands = |text: &str| {
                    let mut bytes = text.bytes().enumerate();
                    text.as_bytes().first() == Some(&first)
                        && bytes.all(|(at, byte)| {
                            self.at + at < self.end && self.file.is(self.at + at, byte)
                        })
                };
                let (text, operator, strength) = all.find(|(text, ..)| stands(text))?;
                Some((*operator, *strength, text.len()))
            }
            _ => None,
        }
    }

    /// True for a comparison that no brackets enclose.
    fn is_bare_comparison(&self, expression: &Expression) -> bool {
        let Node::Two(operator, _) = &expression.node else {
            return false;
        };
        let Range { start, end } = expression.tokens;
        let is_enclosed =
            self.file.is(start, b'(') && self.file.find(start + 1..end, b')') == Some(end - 1);
        operator.compares() && !is_enclosed
    }

    /// A primary with its sign; a sign before a number belongs to the number.
    fn signed(&mut self, depth: usize) -> Option<Expression> {
        let start = self.at;
        let Kind::Symbol(sign @ (b'-' | b'+')) = self.kind()? else {
            return self.primary(depth);
        };
        self.at += 1;
        if let Some(number) = self.number() {
            let value = match sign {
                b'-' => -number,
                _ => number,
            };
            return Some(self.over(start, Node::Number(value)));
        }
        let operator = match sign {
            b'-' => Operator::Minus,
            _ => Operator::Plus,
        };
        let operand = self.operation(depth + 1, self.grammar.sign)?;
        Some(self.over(start, Node::One(operator, Box::new(operand))))
    }

    /// Skips to the end of the expression.
    fn skip(&mut self) {
        let mut open = 0_usize;
        while let Some(kind) = self.kind() {
            match kind {
                Kind::Symbol(b'(' | b'[' | b'{') => open += 1,
                Kind::Symbol(b')' | b']' | b'}') if open == 0 => return,
                Kind::Symbol(b')' | b']' | b'}') => open -= 1,
                Kind::Symbol(b',' | b'\\') if open == 0 => return,
                Kind::Symbol(b';') => return,
                _ => {}
            }
            self.at += 1;
        }
    }

    /// An operand with its indices and components.
    fn primary(&mut self, depth: usize) -> Option<Expression> {
        let start = self.at;
        let node = match self.kind()? {
            Kind::Number => Node::Number(self.number()?),
            Kind::Text => {
                self.at += 1;
                Node::Text
            }
            Kind::Bits => {
                self.at += 1;
                Node::Number(self.file.bits(self.at - 1)?)
            }
            Kind::Symbol(b'{') if self.grammar.has_members => {
                self.at += 1;
                Node::Members(self.members(depth)?)
            }
            Kind::Symbol(b'#') if self.grammar.has_members => {
                self.at += 1;
                Node::Choice(self.name()?)
            }
            Kind::Symbol(symbol) if self.grammar.list.is_some_and(|[open, _]| symbol == open) => {
                self.at += 1;
                Node::List(self.list(depth, self.grammar.list?[1])?)
            }
            Kind::Symbol(b'(') => {
                self.at += 1;
                let inner = self.operation(depth + 1, 0)?;
                self.takes(b')').then_some(inner)?.node
            }
            Kind::Word => self.named(depth)?,
            _ => return None,
        };
        let mut found = self.over(start, node);
        loop {
            let [open, close] = self.grammar.index;
            let node = if self.takes(open) {
                let indices = self.list(depth, close)?;
                Node::Element(Box::new(found), indices)
            } else if self.takes(b'.') {
                Node::Field(Box::new(found), self.name()?)
            } else {
                return Some(found);
            };
            found = self.over(start, node);
        }
    }

    fn number(&mut self) -> Option<f64> {
        let is_number = self.kind() == Some(Kind::Number);
        let text = self.file.word(self.at);
        self.at += usize::from(is_number);
        let value: f64 = is_number.then(|| std::str::from_utf8(text).ok()?.parse().ok())??;
        value.is_finite().then_some(value)
    }

    /// `{FRAME: X 10,Y 20}`, behind the brace; the name of the type may be left out.
    fn members(&mut self, depth: usize) -> Option<Vec<(Name, Expression)>> {
        if self.file.is(self.at + 1, b':') {
            self.at += 2;
        }
        let mut members = Vec::with_capacity(8);
        while !self.takes(b'}') {
            if !members.is_empty() && !self.takes(b',') {
                return None;
            }
            let name = self.name()?;
            if self.takes(b'[') {
                self.takes(b']').then_some(())?;
            }
            // Without a blank another number could grow into the name.
            let ends = self.file.span(&(self.at - 1..self.at)).end;
            let begins = self.file.span(&(self.at..self.at + 1)).start;
            if begins == ends && self.kind() != Some(Kind::Bits) {
                return None;
            }
            members.push((name, self.expression(depth + 1)));
        }
        Some(members)
    }

    fn list(&mut self, depth: usize, closing: u8) -> Option<Vec<Expression>> {
        let mut list = Vec::new();
        loop {
            if self.takes(closing) {
                return Some(list);
            }
            if !list.is_empty() && !self.takes(b',') {
                return None;
            }
            let start = self.at;
            list.push(self.expression(depth + 1));
            if self.at == start {
                return None;
            }
        }
    }

    /// True at the word of an aggregate, where the bracket of a list adjoins it.
    fn is_tag(&self, word: &str) -> bool {
        let opens = (self.grammar.list).is_some_and(|[open, _]| self.file.is(self.at + 1, open));
        let adjoins = || self.file.span(&(self.at..self.at + 2)).len() == word.len() + 1;
        opens && self.file.word(self.at) == word.as_bytes() && adjoins()
    }

    fn named(&mut self, depth: usize) -> Option<Node> {
        if let Some((_, names)) = (self.grammar.aggregate).filter(|(word, _)| self.is_tag(word)) {
            let start = self.at;
            let word = self.name()?;
            self.at += 1;
            let list = self.list(depth, self.grammar.list?[1])?;
            if list.len() != names.len() {
                // An element of what has this name.
                let tokens = start..start + 1;
                let of = Expression {
                    node: Node::Word(word),
                    tokens,
                };
                return Some(Node::Element(Box::new(of), list));
            }
            let names = names.iter().map(|name| Name::of(name.as_bytes()));
            let members = names
                .zip(list)
                .map(|(name, value)| Some((name?, value)))
                .collect::<Option<_>>();
            return Some(Node::Members(members?));
        }
        let name = self.name()?;
        if name.is("TRUE") || name.is("FALSE") {
            return Some(Node::Truth(name.is("TRUE")));
        }
        if self.takes(b'(') {
            let arguments = self.arguments(depth + 1);
            return self.takes(b')').then_some(Node::Call(name, arguments));
        }
        Some(Node::Word(name))
    }
}
