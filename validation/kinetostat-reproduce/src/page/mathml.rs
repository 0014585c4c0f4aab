//! Formulas of the report, kept as plain characters, as MathML.
//!
//! `-G/(4L sin^3 a) - K/L^2 (a - a0)`: what stands without blanks belongs together, so `K/L (a + b)` is
//! a fraction times a sum; ` / ` divides the whole term before it. Digits behind a letter are its index,
//! letters side by side are factors unless they name a function or a Greek letter. A minus that follows
//! a blank and is followed by none is the sign of a factor.

use std::iter::Peekable;
use std::str::Chars;

use crate::page::formula::GREEK;

const FUNCTIONS: [&str; 5] = ["sin", "cos", "tan", "arccos", "arcsin"];
/// Applies a function to what follows; joins factors.
const APPLY: &str = "<mo>&#x2061;</mo>";
const TIMES: &str = "<mo>&#x2062;</mo>";
/// Space between factors that blanks separate, and before the argument of a function without brackets.
const THIN: &str = "<mspace width=\"0.17em\"/>";
const OPEN: &str = "<mo stretchy=\"false\">(</mo>";
const CLOSE: &str = "<mo stretchy=\"false\">)</mo>";
const MINUS: &str = "<mo>\u{2212}</mo>";

/// The formula as a `math` element; `None` if the text is no formula.
pub(crate) fn math(text: &str) -> Option<String> {
    let mut reader = Reader {
        rest: text.trim().chars().peekable(),
        before: ' ',
    };
    let inner = reader.sum()?;
    let whole = reader.rest.peek().is_none();
    whole.then(|| format!("<math displaystyle=\"true\">{inner}</math>"))
}

struct Reader<'a> {
    rest: Peekable<Chars<'a>>,
    /// The character before.
    before: char,
}

/// A piece of a product, and what is inside of it if it stands in brackets.
struct Piece {
    set: String,
    inside: Option<String>,
}

impl Reader<'_> {
    fn peek(&mut self) -> Option<char> {
        self.rest.peek().copied()
    }

    /// The character behind the next one.
    fn after(&self) -> Option<char> {
        self.rest.clone().nth(1)
    }

    fn next(&mut self) -> Option<char> {
        let c = self.rest.next()?;
        self.before = c;
        Some(c)
    }

    fn blanks(&mut self) {
        while self.peek() == Some(' ') {
            self.next();
        }
    }

    fn take(&mut self, wanted: char) -> Option<()> {
        (self.next()? == wanted).then_some(())
    }

    /// Letters or digits in a row.
    fn run(&mut self, belongs: fn(char) -> bool) -> String {
        let mut run = String::new();
        while let Some(c) = self.peek().filter(|c| belongs(*c)) {
            run.push(c);
            self.next();
        }
        run
    }

    fn sum(&mut self) -> Option<String> {
        let mut out = String::new();
        self.blanks();
        if self.peek() == Some('-') {
            self.next();
            out.push_str(MINUS);
        }
        out.push_str(&self.term()?);
        loop {
            self.blanks();
            match self.peek() {
                Some('+') => out.push_str("<mo>+</mo>"),
                Some('-') => out.push_str(MINUS),
                _ => return Some(out),
            }
            self.next();
            out.push_str(&self.term()?);
        }
    }

    fn term(&mut self) -> Option<String> {
        let mut factors: Vec<String> = Vec::new();
        loop {
            self.blanks();
            match self.peek() {
                None | Some(')' | '+') => break,
                Some('-') if factors.is_empty() || self.before != ' ' => break,
                Some('-') if self.after() == Some(' ') => break,
                Some('-') => {
                    self.next();
                    let factor = self.factor()?;
                    factors.push(format!("{OPEN}{MINUS}{factor}{CLOSE}"));
                }
                Some('/') => {
                    self.next();
                    self.blanks();
                    let below = self.factor()?;
                    factors = vec![fraction(&factors.join(THIN), &below)];
                }
                Some(_) => factors.push(self.factor()?),
            }
        }
        (!factors.is_empty()).then(|| factors.join(THIN))
    }

    /// A product without blanks, or a fraction of two.
    fn factor(&mut self) -> Option<String> {
        let above = self.product()?;
        if self.peek() != Some('/') {
            return Some(above.set);
        }
        self.next();
        let below = self.product()?;
        let bare = |piece: Piece| piece.inside.unwrap_or(piece.set);
        Some(fraction(&bare(above), &bare(below)))
    }

    fn product(&mut self) -> Option<Piece> {
        let mut pieces = Vec::new();
        while let Some(c) = self.peek() {
            if !(c.is_ascii_alphanumeric() || c == '(') {
                break;
            }
            pieces.push(self.piece()?);
        }
        match pieces.len() {
            0 => None,
            1 => pieces.pop(),
            _ => {
                let set: Vec<String> = pieces.into_iter().map(|p| p.set).collect();
                Some(Piece {
                    set: set.join(TIMES),
                    inside: None,
                })
            }
        }
    }

    fn piece(&mut self) -> Option<Piece> {
        let plain = |set: String| Piece { set, inside: None };
        let first = self.peek()?;
        if first == '(' {
            self.next();
            let inside = self.sum()?;
            self.blanks();
            self.take(')')?;
            let set = format!("<mrow>{OPEN}{inside}{CLOSE}</mrow>");
            let raised = self.scripts(&set, "")?;
            let inside = (raised == set).then_some(inside);
            return Some(Piece {
                set: raised,
                inside,
            });
        }
        if first.is_ascii_digit() {
            let number = self.run(|c| c.is_ascii_digit() || c == '.');
            return Some(plain(self.scripts(&format!("<mn>{number}</mn>"), "")?));
        }
        let word: String = self
            .rest
            .clone()
            .take_while(char::is_ascii_alphabetic)
            .collect();
        if word == "sqrt" || FUNCTIONS.contains(&word.as_str()) {
            self.run(|c| c.is_ascii_alphabetic());
            return self.function(&word).map(plain);
        }
        let name = match GREEK.iter().find(|(name, _)| *name == word) {
            Some((_, sign)) => {
                self.run(|c| c.is_ascii_alphabetic());
                (*sign).to_owned()
            }
            None => self.next()?.to_string(),
        };
        let index = self.run(|c| c.is_ascii_digit());
        Some(plain(self.scripts(&format!("<mi>{name}</mi>"), &index)?))
    }

    /// A function and what it is applied to: a bracket, or the one piece that follows.
    fn function(&mut self, word: &str) -> Option<String> {
        let name = self.scripts(&format!("<mi>{word}</mi>"), "")?;
        self.blanks();
        let of = self.piece()?;
        Some(match word {
            "sqrt" => format!("<msqrt>{}</msqrt>", of.inside.unwrap_or(of.set)),
            _ if of.inside.is_some() => format!("<mrow>{name}{APPLY}{}</mrow>", of.set),
            _ => format!("<mrow>{name}{APPLY}{THIN}{}</mrow>", of.set),
        })
    }

    /// Adds the index and the power that follow.
    fn scripts(&mut self, base: &str, index: &str) -> Option<String> {
        let mut below = (!index.is_empty()).then(|| format!("<mn>{index}</mn>"));
        if self.peek() == Some('_') {
            self.next();
            below = Some(self.script()?);
        }
        let mut above = None;
        if self.peek() == Some('^') {
            self.next();
            above = Some(self.script()?);
        }
        Some(match (below, above) {
            (None, None) => base.to_owned(),
            (Some(b), None) => format!("<msub>{base}{b}</msub>"),
            (None, Some(a)) => format!("<msup>{base}{a}</msup>"),
            (Some(b), Some(a)) => format!("<msubsup>{base}{b}{a}</msubsup>"),
        })
    }

    fn script(&mut self) -> Option<String> {
        if self.peek() == Some('(') {
            return self.piece().map(|piece| piece.set);
        }
        // A number may have a point, as in `k_c1.1`.
        let run = self.run(|c| c.is_ascii_alphanumeric() || c == '.');
        let set: String = run
            .chars()
            .map(|c| match c.is_ascii_digit() || c == '.' {
                true => format!("<mn>{c}</mn>"),
                false => format!("<mi>{c}</mi>"),
            })
            .collect();
        (!run.is_empty()).then(|| format!("<mrow>{set}</mrow>"))
    }
}

fn fraction(above: &str, below: &str) -> String {
    format!("<mfrac><mrow>{above}</mrow><mrow>{below}</mrow></mfrac>")
}
