//! Harwell-Boeing files (Ansys `HBMAT`, ASCII) with the mapping file that says which row is which node.
//!
//! The layout is that of Duff, Grimes, Lewis, "Users' guide for the Harwell-Boeing sparse matrix
//! collection", TR/PA/92/86: four or five header lines, then column pointers, row numbers and values in
//! the Fortran formats that the fourth line names. The mapping file has lines `row node label` with the
//! labels UX, UY, UZ, ROTX, ROTY, ROTZ; other lines of it are headings.

use crate::error::Result;
use crate::superelement::{Dof, Halves, MOST_DOFS, Raw, Superelement, too_many};
use crate::text::{Text, short};

/// Third and fourth line of the header.
pub(crate) struct Header {
    kind: String,
    rows: usize,
    entries: usize,
    widths: [usize; 3],
    lines: [usize; 4],
    with_right_hand_sides: bool,
}

/// Width of one number in a Fortran format such as `(8I10)` or `(1P,3D25.17)`.
fn width(format: &str) -> Option<usize> {
    let bytes = format.as_bytes();
    let at = bytes
        .iter()
        .rposition(|b| matches!(b.to_ascii_uppercase(), b'I' | b'E' | b'D' | b'F' | b'G'))?;
    let digits: String = format[at + 1..]
        .chars()
        .take_while(char::is_ascii_digit)
        .collect();
    digits.parse().ok().filter(|w| (1..=64).contains(w))
}

/// The header, if the text looks like such a file.
pub(crate) fn recognised(text: &Text) -> Option<Header> {
    let mut lines = text.body().lines().skip(1);
    let counts: Vec<usize> = lines
        .next()?
        .split_whitespace()
        .map_while(|f| f.parse().ok())
        .collect();
    let third = lines.next()?;
    let formats = lines.next()?;
    let mut words = third.split_whitespace();
    let kind = words.next()?.to_uppercase();
    if kind.len() != 3 || counts.len() < 4 || !formats.trim_start().starts_with('(') {
        return None;
    }
    let sizes: Vec<usize> = words.map_while(|f| f.parse().ok()).collect();
    let mut widths = formats
        .split(')')
        .filter_map(|f| f.split_once('('))
        .map(|f| width(f.1));
    Some(Header {
        kind,
        rows: *sizes.first()?,
        entries: *sizes.get(2)?,
        widths: [widths.next()??, widths.next()??, widths.next()??],
        lines: [
            counts[1],
            counts[2],
            counts[3],
            counts.get(4).copied().unwrap_or(0),
        ],
        with_right_hand_sides: counts.get(4).is_some_and(|n| *n > 0),
    })
}

/// Half of the matrix that its type declares as written.
fn halves_of(text: &Text, header: &Header) -> Result<Halves> {
    match header.kind.as_str() {
        "RSA" => Ok(Halves::Found),
        "RUA" => Ok(Halves::Both),
        other => Err(text
            .fault(
                format!("the matrix is of the type {}", short(other)),
                "a stiffness is RSA or RUA: real and assembled",
            )
            .at(3)),
    }
}

pub(crate) fn read_hbmat(
    text: &Text,
    companion: Option<&Text>,
    header: Header,
) -> Result<Superelement> {
    let halves = halves_of(text, &header)?;
    if header.rows > MOST_DOFS {
        return Err(too_many(text, header.rows).at(3));
    }
    let Some(list) = companion else {
        return Err(text.fault(
            "rows and columns are numbers; which nodes they are is not in this file",
            "write the mapping file too (HBMAT with Mapping = YES) and name it with --dofs",
        ));
    };
    let dofs = mapping(list, header.rows)?;
    let mut at = 4 + usize::from(header.with_right_hand_sides);
    let lines: Vec<&str> = text.body().lines().collect();
    let mut block = |which: usize, wanted: usize, what: &str| -> Result<Vec<(f64, usize)>> {
        let mut found = Vec::with_capacity(wanted.min(1 << 20));
        let end = at + header.lines[which];
        while at < end {
            let line = lines.get(at).copied().unwrap_or("");
            at += 1;
            if !line.is_ascii() {
                return Err(text
                    .fault("the line is not ASCII", "export the file again")
                    .at(at));
            }
            let mut from = 0;
            while from < line.len() && found.len() < wanted {
                let cell = &line[from..line.len().min(from + header.widths[which])];
                from += header.widths[which];
                if cell.trim().is_empty() {
                    continue;
                }
                found.push((text.number(at, what, cell)?, at));
            }
        }
        if found.len() < wanted {
            return Err(text.fault(
                format!(
                    "the file has {} {what}s, its header promises {wanted}",
                    found.len()
                ),
                "it may have been cut off: export it again",
            ));
        }
        Ok(found)
    };
    let pointers = block(0, header.rows + 1, "column pointer")?;
    let rows = block(1, header.entries, "row number")?;
    let values = block(2, header.entries, "value")?;
    let mut raw = Vec::with_capacity(values.len());
    for column in 0..header.rows {
        let bounds = [pointers[column], pointers[column + 1]];
        let ends = bounds.map(|p| p.0);
        #[allow(clippy::cast_precision_loss)]
        let most = header.entries as f64 + 1.0;
        if ends
            .iter()
            .any(|p| *p < 1.0 || *p > most || p.fract() != 0.0)
            || ends[0] > ends[1]
        {
            return Err(text
                .fault(
                    format!("the pointers of column {} are wrong", column + 1),
                    "export the file again (Ansys before 11 wrote wrong ones)",
                )
                .at(bounds[0].1));
        }
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        for e in ends[0] as usize - 1..ends[1] as usize - 1 {
            let (row, line) = rows[e];
            #[allow(clippy::cast_precision_loss)]
            if row < 1.0 || row > header.rows as f64 || row.fract() != 0.0 {
                return Err(text
                    .fault(format!("there is no row {row}"), "export the file again")
                    .at(line));
            }
            raw.push(Raw {
                row: row as u32 - 1,
                column: column as u32,
                value: values[e].0,
                line: values[e].1,
            });
        }
    }
    Superelement::collect(text, "stiffness", "Harwell-Boeing", dofs, raw, halves)
}

fn mapping(list: &Text, rows: usize) -> Result<Vec<Dof>> {
    let mut dofs: Vec<Option<Dof>> = vec![None; rows];
    for (line, written) in list.lines() {
        let cells: Vec<&str> = written.split_whitespace().collect();
        let Some(row) = cells.first().and_then(|c| c.parse::<usize>().ok()) else {
            continue;
        };
        let label = cells.get(2).map(|c| c.to_uppercase()).unwrap_or_default();
        let direction = ["UX", "UY", "UZ", "ROTX", "ROTY", "ROTZ"]
            .iter()
            .position(|l| *l == label);
        let (Some(direction), true, 3) = (direction, (1..=rows).contains(&row), cells.len()) else {
            return Err(list
                .fault(
                    format!("'{}' maps no row", short(written)),
                    format!("lines are: row (1 to {rows}), node, UX ... ROTZ"),
                )
                .at(line));
        };
        let node = list.whole(line, "the node", cells[1], 1, u64::MAX)?;
        dofs[row - 1] = Some(Dof {
            node,
            direction: u8::try_from(direction + 1).unwrap_or(0),
        });
    }
    let missing = dofs.iter().position(Option::is_none);
    match missing {
        Some(row) => Err(list.fault(
            format!("row {} is not mapped", row + 1),
            "do both files come from one run?",
        )),
        None => Ok(dofs.into_iter().flatten().collect()),
    }
}
