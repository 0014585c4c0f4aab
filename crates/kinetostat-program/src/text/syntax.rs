//! Syntax of a line of tokens: a block of words, a vendor's command, or a refusal.

use std::ops::Range;

use crate::error::ProgramErrorKind;
use crate::text::LineKind;
use crate::text::lex::{Spanned, Token};

/// A line that may be kept.
pub(crate) struct Checked {
    pub kind: LineKind,
    /// Number of significant tokens that are words of the block.
    pub words: usize,
}

/// A line that is refused; the span is within the line.
pub(crate) struct Refused {
    pub kind: ProgramErrorKind,
    pub span: Range<usize>,
    pub reason: String,
    pub remedy: &'static str,
}

pub(crate) const FLATTEN: &str = "add --expand (in a job file: a table [expand]), flatten the program with `kinetostat expand`, or post-process it without subprograms";
const NO_VARIABLES: &str = "add --expand (in a job file: a table [expand]), flatten the program with `kinetostat expand`, or let the CAM system write plain numbers";

/// Checks the tokens of a line without comments and blanks.
pub(crate) fn check(
    line: &[u8],
    tokens: &[&Spanned],
    first_block: bool,
) -> Result<Checked, Refused> {
    if let Some(words) = vendor_command(line, tokens) {
        return Ok(Checked {
            kind: LineKind::Vendor,
            words,
        });
    }
    for (index, spanned) in tokens.iter().enumerate() {
        match spanned.token {
            Token::Word { .. } => exponent(line, tokens, index)?,
            Token::Letter(b'O') if named_subprogram(tokens, index) => {
                return Err(subprogram(spanned, "an O word"));
            }
            Token::Letter(_) if homing_axis(tokens) && stands_alone(tokens, index) => {}
            Token::Letter(_) => {
                return Err(match tokens.get(index + 1).map(|after| &after.token) {
                    Some(Token::Other(byte @ (b'#' | b'[' | b'='))) => {
                        other(line, tokens, index + 1, *byte)
                    }
                    _ => letters(line, tokens, index),
                });
            }
            Token::Other(byte) => return Err(other(line, tokens, index, byte)),
            Token::Quoted => {
                return Err(Refused {
                    kind: ProgramErrorKind::Malformed,
                    span: spanned.span.clone(),
                    reason: "a quoted text appears in a block that is no vendor's M command"
                        .to_owned(),
                    remedy: "remove the text or make it a comment",
                });
            }
            Token::Blank | Token::Parenthesis { .. } | Token::Semicolon => {}
        }
    }
    dialect(tokens, first_block)?;
    Ok(Checked {
        kind: LineKind::Words,
        words: tokens.len(),
    })
}

fn word(spanned: &Spanned, letter: u8) -> Option<f64> {
    match spanned.token {
        Token::Word {
            letter: found,
            value,
            ..
        } if found == letter => Some(value),
        _ => None,
    }
}

/// M commands of printers whose arguments are their own: text, or letters that are axes elsewhere.
///
/// Controllers of mills run M codes and motions in one block, so a line that holds a G word is never
/// taken as a vendor's command, and neither is one with an X, Y or Z unless the command is a printer's
/// well-known setting ([`printer_setting`]).
fn vendor_command(line: &[u8], tokens: &[&Spanned]) -> Option<usize> {
    let at = usize::from(tokens.first().and_then(|first| word(first, b'N')).is_some());
    let command = tokens.get(at).and_then(|spanned| word(spanned, b'M'))?;
    let arguments = &tokens[at + 1..];
    let code = command.floor();
    let takes_text = [23.0, 28.0, 32.0, 117.0, 118.0].contains(&code);
    let printers_own = printer_setting(code as u32);
    if !(takes_text || printers_own || code >= 100.0) || arguments.is_empty() {
        return None;
    }
    // Variables and checksums are refused with their own reason.
    if !takes_text
        && arguments.iter().any(|spanned| {
            matches!(
                spanned.token,
                Token::Other(b'#' | b'[' | b']' | b'*' | b'=')
            )
        })
    {
        return None;
    }
    let plain = arguments
        .iter()
        .all(|spanned| matches!(spanned.token, Token::Word { .. }))
        && (0..arguments.len()).all(|index| exponent(line, arguments, index).is_ok());
    let has = |letters: &[u8]| {
        arguments.iter().any(|spanned| {
            letters
                .iter()
                .any(|letter| word(spanned, *letter).is_some())
        })
    };
    // Mills have motions beside M20 to M87: in another order of words it would be one.
    let moves = match (printers_own, sets_axes(code as u32)) {
        (true, true) => false,
        (true, false) => has(b"XYZAB"),
        (false, _) => has(b"XYZ"),
    };
    // M29 S1000 F300 begins rigid tapping on mills, and printers give it no words.
    if plain && (has(b"GM") || moves || code == 29.0) {
        return None;
    }
    Some(at + 1)
}

/// M commands of printers that set something (for each axis), or act on cards, fans and lights, and that
/// no mill has with axis words.
fn printer_setting(code: u32) -> bool {
    matches!(
        code,
        16..=18 | 20..=29 | 31..=34 | 36 | 42 | 43 | 73 | 75..=78 | 80..=87 | 92
            | 201..=205 | 208 | 350 | 351 | 566 | 569 | 572 | 574 | 579 | 584 | 593 | 906..=908 | 911..=919
    )
}

/// True if a code sets something of each axis, so that it owns X, Y and Z.
fn sets_axes(code: u32) -> bool {
    matches!(code, 17 | 18 | 84 | 92 | 201..)
}

/// `X1E5` is X1 and E5 to some controllers and 100000 to others.
fn exponent(line: &[u8], tokens: &[&Spanned], index: usize) -> Result<(), Refused> {
    let Some(before) = index.checked_sub(1).map(|before| &tokens[before]) else {
        return Ok(());
    };
    let Token::Word {
        letter: b'E',
        number,
        ..
    } = &tokens[index].token
    else {
        return Ok(());
    };
    let touching = matches!(before.token, Token::Word { .. })
        && before.span.end == tokens[index].span.start
        && number.start == tokens[index].span.start + 1;
    let digits = line[number.clone()].trim_ascii_start();
    let unsigned = digits
        .strip_prefix(b"-")
        .or(digits.strip_prefix(b"+"))
        .unwrap_or(digits);
    if touching && unsigned.len() <= 3 && unsigned.iter().all(u8::is_ascii_digit) {
        return Err(Refused {
            kind: ProgramErrorKind::Malformed,
            span: before.span.start..tokens[index].span.end,
            reason: "this may be a number with an exponent or a word E after another word"
                .to_owned(),
            remedy: "write the number without an exponent, or a blank before E",
        });
    }
    Ok(())
}

/// `O<name>` and `O[number]`.
fn named_subprogram(tokens: &[&Spanned], index: usize) -> bool {
    tokens
        .get(index + 1)
        .is_some_and(|after| matches!(after.token, Token::Other(b'<' | b'[' | b'#')))
}

/// `G28 X` names axes without numbers.
fn homing_axis(tokens: &[&Spanned]) -> bool {
    tokens.iter().any(|spanned| {
        word(spanned, b'G').is_some_and(|code| [28.0, 29.0, 30.0, 34.0].contains(&code.floor()))
    })
}

/// True if no letter touches the letter at `index`.
fn stands_alone(tokens: &[&Spanned], index: usize) -> bool {
    let touches = |a: &Spanned, b: &Spanned| {
        a.span.end == b.span.start
            && matches!(a.token, Token::Letter(_))
            && matches!(b.token, Token::Letter(_))
    };
    !(index > 0 && touches(tokens[index - 1], tokens[index])
        || tokens
            .get(index + 1)
            .is_some_and(|after| touches(tokens[index], after)))
}

/// A letter without a number: a missing number, a keyword, a macro's name.
fn letters(line: &[u8], tokens: &[&Spanned], index: usize) -> Refused {
    let start = tokens[index].span.start;
    let length = line[start..]
        .iter()
        .take_while(|byte| byte.is_ascii_alphabetic())
        .count();
    let name = String::from_utf8_lossy(&line[start..start + length]).to_uppercase();
    let span = start..start + length;
    let keywords = [
        "IF", "THEN", "ELSE", "ELSEIF", "ENDIF", "WHILE", "ENDWHILE", "DO", "END", "GOTO", "GOTOB",
        "GOTOF", "REPEAT", "FOR", "ENDFOR", "LOOP", "CASE",
    ];
    if keywords.contains(&name.as_str()) {
        return Refused {
            kind: ProgramErrorKind::ControlStructure,
            span,
            reason: format!(
                "{name} is a control structure; which blocks run is not known from the text"
            ),
            remedy: NO_VARIABLES,
        };
    }
    if tokens[..index]
        .iter()
        .any(|spanned| word(spanned, b'O').is_some())
    {
        return subprogram(tokens[index], "an O word with a keyword");
    }
    if length == 1 || name.ends_with("NAN") || name.ends_with("INF") {
        return Refused {
            kind: ProgramErrorKind::Malformed,
            span,
            reason: format!("{} has no number", &name[..1]),
            remedy: "write a fixed-point number such as -12.5 after the letter",
        };
    }
    Refused {
        kind: ProgramErrorKind::Malformed,
        span,
        reason: format!(
            "{name} is no word of a letter and a number (a macro, a call or plain text?)"
        ),
        remedy: "write macros out, or make the text a comment",
    }
}

fn other(line: &[u8], tokens: &[&Spanned], index: usize, byte: u8) -> Refused {
    let spanned = tokens[index];
    let after_word = index > 0
        && matches!(tokens[index - 1].token, Token::Word { .. })
        && tokens[index - 1].span.end == spanned.span.start;
    let (reason, remedy) = match byte {
        b'#' | b'[' | b']' | b'=' | b'<' | b'>' => {
            let keyword = tokens[..index]
                .iter()
                .position(|before| matches!(before.token, Token::Letter(letter) if letter != b'O'));
            if let Some(at) = keyword {
                let refused = letters(line, tokens, at);
                if refused.kind == ProgramErrorKind::ControlStructure {
                    return refused;
                }
            }
            if tokens[..index]
                .iter()
                .any(|before| before.token == Token::Letter(b'O') || word(before, b'O').is_some())
            {
                return subprogram(spanned, "an O word");
            }
            return Refused {
                kind: ProgramErrorKind::Variables,
                span: spanned.span.clone(),
                reason: "variables and expressions are not read".to_owned(),
                remedy: NO_VARIABLES,
            };
        }
        b'.' if after_word => (
            "a number has two points".to_owned(),
            "write one fixed-point number after each letter",
        ),
        b',' => (
            "a comma appears where a word should be".to_owned(),
            "write a point in decimal numbers; write ,R and ,C corners as blocks of their own",
        ),
        b'*' => (
            "a checksum would be wrong after any change of the line".to_owned(),
            "write the program without checksums; the sender adds them",
        ),
        b'/' => (
            "a / appears inside the block".to_owned(),
            "mark a block with / only at its beginning",
        ),
        b')' => (
            "a comment is closed that was not opened".to_owned(),
            "remove the )",
        ),
        b'"' => ("a quoted text is not closed".to_owned(), "close it with \""),
        b':' => (
            "a : appears where a word should be".to_owned(),
            "write a program number as O and a number",
        ),
        b'+' | b'-' => (
            "a sign has no number".to_owned(),
            "write a fixed-point number such as -12.5 after each letter",
        ),
        b'0'..=b'9' | b'.' => (
            "a number has no letter".to_owned(),
            "write a letter and a number for each word",
        ),
        0x80.. => (
            "a character outside ASCII appears outside a comment".to_owned(),
            "remove it or put it into a comment",
        ),
        _ => (
            format!("{} begins no word", char::from(byte)),
            "remove it or put it into a comment",
        ),
    };
    Refused {
        kind: ProgramErrorKind::Malformed,
        span: spanned.span.clone(),
        reason,
        remedy,
    }
}

fn subprogram(spanned: &Spanned, what: &str) -> Refused {
    Refused {
        kind: ProgramErrorKind::Subprogram,
        span: spanned.span.clone(),
        reason: of_subprogram(what),
        remedy: FLATTEN,
    }
}

/// Reason for which a call is refused.
pub(crate) fn of_subprogram(what: &str) -> String {
    format!("{what} is a subroutine; its blocks would need another correction at each call")
}

/// Dialects with subroutines, each known by a word.
fn dialect(tokens: &[&Spanned], first_block: bool) -> Result<(), Refused> {
    let has = |letter: u8| tokens.iter().any(|spanned| word(spanned, letter).is_some());
    for spanned in tokens {
        let Token::Word { letter, value, .. } = spanned.token else {
            continue;
        };
        let code = value.floor() as i64;
        let found = match (letter, code) {
            (b'O', _) if first_block && tokens.len() == 1 => continue,
            (b'O', _) => "a second program number (O word)".to_owned(),
            // Judged where it is known whether the program was run.
            (b'M', 98) | (b'G', 65) if has(b'P') => return Ok(()),
            (b'M', 96..=99) => format!("M{code}"),
            (b'G', 65..=67) => format!("the macro call G{code}"),
            (b'G', 22 | 23) if has(b'C') || has(b'L') => {
                format!("the call G{code} with a number of a part")
            }
            (b'G', 98 | 99) if has(b'C') || has(b'L') => {
                format!("the label G{code} with a number of a part")
            }
            // A block that is nothing but L, wherever it stands, calls a subprogram on some controllers.
            (b'L', _) if !b"GMXYZABC".iter().any(|letter| has(*letter)) => "a call L".to_owned(),
            _ => continue,
        };
        return Err(subprogram(spanned, &found));
    }
    Ok(())
}
