//! Nastran `DMIG`: direct matrix input at grid points, as punch files of superelements have it.
//!
//! Small fields are 8 columns wide, large ones (`DMIG*`) 16, free ones are separated by commas. A
//! column entry is `NAME, GJ, CJ, -`, then groups `G, C, A, B` of rows. Form 6 (symmetric) gives one
//! half, form 1 (square) both.

use crate::error::{Error, Result};
use crate::superelement::{Dof, Halves, Numbering, Raw, Superelement};
use crate::text::{Text, short};

/// Data fields of one card with their lines, keyword left out.
struct Card {
    line: usize,
    fields: Vec<(usize, String)>,
}

/// Fields of a physical line: (keyword field, data fields). Tabs stand for the next column of eight.
fn split(text: &Text, line: usize, written: &str) -> Result<(String, Vec<String>)> {
    let written = written.split('$').next().unwrap_or_default();
    if written.contains(',') {
        let mut cells = written.split(',').map(|c| c.trim().to_owned());
        let key = cells.next().unwrap_or_default();
        let count = if key.contains('*') { 4 } else { 8 };
        let mut data: Vec<String> = cells.take(count).collect();
        data.resize(count, String::new());
        return Ok((key, data));
    }
    let mut plain = String::new();
    for c in written.chars() {
        if c == '\t' {
            plain.push(' ');
            while !plain.len().is_multiple_of(8) {
                plain.push(' ');
            }
        } else {
            plain.push(c);
        }
    }
    if !plain.is_ascii() {
        return Err(text
            .fault(
                "the line has characters that Nastran does not",
                "cards are plain ASCII",
            )
            .at(line));
    }
    let part = |from: usize, to: usize| {
        plain
            .get(from..to.min(plain.len()))
            .unwrap_or("")
            .trim()
            .to_owned()
    };
    let key = part(0, 8);
    let (width, count) = if key.contains('*') { (16, 4) } else { (8, 8) };
    let data = (0..count)
        .map(|i| part(8 + i * width, 8 + (i + 1) * width))
        .collect();
    Ok((key, data))
}

/// All cards whose keyword is one of `keys`.
fn cards(text: &Text, key: &str) -> Result<Vec<Card>> {
    let mut found: Vec<Card> = Vec::new();
    let mut inside = false;
    for (line, written) in text.lines() {
        let trimmed = written.trim();
        if trimmed.is_empty() || trimmed.starts_with('$') {
            continue;
        }
        let first = written.chars().next().unwrap_or(' ');
        let continues = matches!(first, '+' | '*' | ' ' | ',' | '\t')
            && !trimmed.to_uppercase().starts_with(key);
        if continues && !inside {
            continue;
        }
        if !continues {
            let word: String = trimmed
                .chars()
                .take_while(char::is_ascii_alphanumeric)
                .collect();
            inside = word.eq_ignore_ascii_case(key);
            if !inside {
                continue;
            }
        }
        let (_, data) = split(
            text,
            line,
            if continues {
                written
            } else {
                written.trim_start()
            },
        )?;
        let data = data.into_iter().map(|f| (line, f));
        if continues {
            if let Some(card) = found.last_mut() {
                card.fields.extend(data);
            }
        } else {
            found.push(Card {
                line,
                fields: data.collect(),
            });
        }
    }
    Ok(found)
}

/// Places of the `GRID` cards: (line, node, three coordinates).
pub(crate) fn grids(text: &Text) -> Result<Vec<(usize, u64, [f64; 3])>> {
    let mut found = Vec::new();
    for card in cards(text, "GRID")? {
        let field = |i: usize| card.fields.get(i).map_or("", |f| f.1.as_str());
        let node = text.whole(
            card.line,
            "the number of the grid point",
            field(0),
            1,
            u64::MAX,
        )?;
        if !matches!(field(1), "" | "0") {
            return Err(text
                .fault(
                    format!(
                        "the grid point {node} is given in the coordinate system {}",
                        short(field(1))
                    ),
                    "only the basic system is read: write the places in it",
                )
                .at(card.line));
        }
        let mut place = [0.0; 3];
        for (i, x) in place.iter_mut().enumerate() {
            let written = field(2 + i);
            *x = if written.is_empty() {
                0.0
            } else {
                text.number(card.line, "a coordinate", written)?
            };
        }
        found.push((card.line, node, place));
    }
    Ok(found)
}

/// Header of a matrix.
struct Header {
    name: String,
    symmetric: bool,
}

fn header(text: &Text, card: &Card) -> Result<Header> {
    let field = |i: usize| card.fields.get(i).map_or("", |f| f.1.as_str());
    let name = field(0).to_uppercase();
    let refuse = |message: String, help: &str| -> Error { text.fault(message, help).at(card.line) };
    let symmetric = match field(2) {
        "6" => true,
        "1" => false,
        other => {
            return Err(refuse(
                format!("the matrix {name} has the form {}", short(other)),
                "a stiffness has form 6 (symmetric) or 1 (square)",
            ));
        }
    };
    if !matches!(field(3), "1" | "2") {
        return Err(refuse(
            format!("the matrix {name} has the type {}", short(field(3))),
            "a stiffness is real: type 1 or 2",
        ));
    }
    Ok(Header { name, symmetric })
}

/// One matrix of a file; without a name, the only one or the only one whose name begins with K.
pub(crate) fn read_dmig(text: &Text, wanted: Option<&str>) -> Result<Superelement> {
    let cards = cards(text, "DMIG")?;
    let chosen = chosen(text, &cards, wanted)?;
    let of_it = |c: &&Card| {
        c.fields
            .first()
            .is_some_and(|f| f.1.eq_ignore_ascii_case(&chosen))
    };
    let (headers, columns): (Vec<&Card>, Vec<&Card>) =
        cards.iter().filter(of_it).partition(|c| is_header(c));
    let header = header(text, only_header(text, &chosen, &headers)?)?;
    let (dofs, raw) = entries(text, &columns)?;
    let halves = if header.symmetric {
        Halves::One
    } else {
        Halves::Both
    };
    Superelement::collect(text, &header.name, "Nastran DMIG", dofs, raw, halves)
}

fn is_header(card: &Card) -> bool {
    card.fields.get(1).is_some_and(|f| f.1 == "0")
}

/// Name of the matrix that is meant.
fn chosen(text: &Text, cards: &[Card], wanted: Option<&str>) -> Result<String> {
    let mut names: Vec<String> = Vec::new();
    for card in cards {
        let name = card
            .fields
            .first()
            .map_or_else(String::new, |f| f.1.to_uppercase());
        if !names.contains(&name) {
            names.push(name);
        }
        if names.len() > 1000 {
            return Err(text
                .fault(
                    "the file has more than 1000 matrices",
                    "export the stiffness only",
                )
                .at(card.line));
        }
    }
    let chosen = match wanted {
        Some(name) => names.iter().find(|n| n.eq_ignore_ascii_case(name)).cloned(),
        None => {
            let stiff: Vec<&String> = names.iter().filter(|n| n.starts_with('K')).collect();
            match (names.as_slice(), stiff.as_slice()) {
                ([only], _) => Some(only.clone()),
                (_, [only]) => Some((*only).clone()),
                _ => None,
            }
        }
    };
    chosen.ok_or_else(|| {
        text.fault(
            match wanted {
                Some(name) => format!("there is no matrix '{}'", short(name)),
                None => "it is not clear which matrix is the stiffness".to_owned(),
            },
            format!("choose with --matrix; there are: {}", names.join(", ")),
        )
    })
}

fn only_header<'c>(text: &Text, chosen: &str, headers: &[&'c Card]) -> Result<&'c Card> {
    match headers {
        [head] => Ok(head),
        [] => Err(text.fault(
            format!("the matrix {chosen} has no header"),
            "a card DMIG, NAME, 0, 6, 1, ... says its form and type: export it again",
        )),
        [head, second, ..] => Err(text
            .fault(
                format!(
                    "the matrix {chosen} has a second header, the first at line {}",
                    head.line
                ),
                "keep one of them",
            )
            .at(second.line)),
    }
}

/// Entries of the columns of a matrix, with the degrees of freedom in the order of their appearance.
fn entries(text: &Text, columns: &[&Card]) -> Result<(Vec<Dof>, Vec<Raw>)> {
    let mut numbers = Numbering::default();
    let mut raw = Vec::new();
    for card in columns {
        let field = |i: usize| card.fields.get(i).map_or("", |f| f.1.as_str());
        let column = dof(text, card.line, "the column's", field(1), field(2))?;
        let column = numbers.of(text, card.line, column)?;
        for group in card.fields.get(4..).unwrap_or_default().chunks(4) {
            if group.iter().all(|f| f.1.is_empty()) {
                continue;
            }
            let line = group[0].0;
            let cell = |i: usize| group.get(i).map_or("", |f| f.1.as_str());
            let row = dof(text, line, "the row's", cell(0), cell(1))?;
            let row = numbers.of(text, line, row)?;
            let value = text.number(line, "the entry", cell(2))?;
            if !cell(3).is_empty() && crate::text::number(cell(3)) != Some(0.0) {
                return Err(text
                    .fault("the entry has an imaginary part", "a stiffness is real")
                    .at(line));
            }
            raw.push(Raw {
                row,
                column,
                value,
                line,
            });
        }
    }
    Ok((numbers.dofs, raw))
}

fn dof(text: &Text, line: usize, whose: &str, node: &str, direction: &str) -> Result<Dof> {
    let node = text.whole(line, &format!("{whose} grid point"), node, 1, u64::MAX)?;
    let direction = if direction.is_empty() { "0" } else { direction };
    let direction = text.whole(line, &format!("{whose} component"), direction, 0, 6)?;
    Ok(Dof {
        node,
        direction: u8::try_from(direction).unwrap_or(0),
    })
}
