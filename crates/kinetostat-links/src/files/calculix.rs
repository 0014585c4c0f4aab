//! Matrices of CalculiX (and, for the first two formats, Abaqus).
//!
//! - `*SUBSTRUCTURE GENERATE` with `*SUBSTRUCTURE MATRIX OUTPUT` writes a `.mtx`: comments with the
//!   nodes, the direction of each row, `*MATRIX,TYPE=STIFFNESS` and the lower half row after row; with
//!   `OUTPUT FILE=MATRIX` lines `node, direction, node, direction, value`.
//! - `*FREQUENCY, SOLVER=MATRIXSTORAGE` writes `.sti` (`row column value`, one half) and `.dof` (a line
//!   `node.direction` for each row). Directions held by `*BOUNDARY` are left out of both.

use crate::error::Result;
use crate::superelement::{Dof, Halves, MOST_DOFS, Numbering, Raw, Superelement, too_many};
use crate::text::{Text, fields, short};

fn direction(text: &Text, line: usize, field: &str) -> Result<u8> {
    let d = text.whole(line, "the direction", field, 1, 6)?;
    Ok(u8::try_from(d).unwrap_or(0))
}

fn parts(line: &str) -> impl Iterator<Item = &str> {
    line.split([',', ' ', '\t', '*']).filter(|f| !f.is_empty())
}

/// `*USER ELEMENT` with `*MATRIX, TYPE=STIFFNESS`.
pub(crate) fn user_element(text: &Text) -> Result<Superelement> {
    let mut element = UserElement::default();
    for (line, written) in text.lines() {
        let upper = written.trim().to_uppercase();
        if upper.starts_with("**") {
            element.comment(text, line, &upper)?;
        } else if upper.starts_with('*') {
            element.card(text, line, &upper)?;
        } else {
            element.data(text, line, &upper)?;
        }
    }
    if element.nodes.is_empty() || element.directions.is_empty() {
        return Err(text.fault(
            "the nodes or their directions are missing",
            "keep the comment '** ELEMENT NODES' with its list and the lines of directions that the program writes",
        ));
    }
    let dofs = element.dofs(text)?;
    let raw = lower_half(text, dofs.len(), element.values)?;
    Superelement::collect(
        text,
        "stiffness",
        "CalculiX or Abaqus *MATRIX",
        dofs,
        raw,
        Halves::One,
    )
}

/// Section of a user element to which the next line belongs.
#[derive(Default, PartialEq)]
enum Part {
    #[default]
    Before,
    Nodes,
    Directions,
    Stiffness,
    Other,
}

/// A user element as far as it has been read.
#[derive(Default)]
struct UserElement {
    part: Part,
    nodes: Vec<u64>,
    /// Directions of all nodes from this position in their list (from 0) on.
    directions: Vec<(usize, Vec<u8>)>,
    /// Entries of the lower half with their lines.
    values: Vec<(f64, usize)>,
}

impl UserElement {
    /// The list of nodes stands in comments.
    fn comment(&mut self, text: &Text, line: usize, upper: &str) -> Result<()> {
        if upper.contains("ELEMENT NODES") {
            self.part = Part::Nodes;
        } else if self.part == Part::Nodes && upper.len() > 2 {
            for field in parts(upper) {
                if self.nodes.len() >= MOST_DOFS {
                    return Err(too_many(text, self.nodes.len() + 1).at(line));
                }
                let node = text.whole(line, "a node of the list", field, 1, u64::MAX)?;
                self.nodes.push(node);
            }
        }
        Ok(())
    }

    fn card(&mut self, text: &Text, line: usize, upper: &str) -> Result<()> {
        if upper.starts_with("*USER ELEMENT") {
            if upper.contains("UNSYMM") {
                return Err(text
                    .fault(
                        "the element is declared unsymmetric",
                        "a link's stiffness is symmetric: export it without UNSYMM",
                    )
                    .at(line));
            }
            self.part = Part::Directions;
        } else if upper.starts_with("*MATRIX") {
            let kind = upper.replace(' ', "");
            self.part = if kind.contains("TYPE=STIFFNESS") {
                Part::Stiffness
            } else {
                Part::Other
            };
            if self.part == Part::Stiffness && !self.values.is_empty() {
                return Err(text
                    .fault("there is a second stiffness matrix", "one file holds one")
                    .at(line));
            }
        } else {
            self.part = Part::Other;
        }
        Ok(())
    }

    fn data(&mut self, text: &Text, line: usize, upper: &str) -> Result<()> {
        match self.part {
            Part::Nodes | Part::Directions if !upper.is_empty() => {
                self.part = Part::Directions;
                self.directions_of_line(text, line, upper)
            }
            Part::Stiffness => {
                for field in parts(upper) {
                    let value = text.number(line, "an entry of the matrix", field)?;
                    self.values.push((value, line));
                }
                Ok(())
            }
            _ => Ok(()),
        }
    }

    /// The first line has no position: its directions are those of the first node.
    fn directions_of_line(&mut self, text: &Text, line: usize, upper: &str) -> Result<()> {
        let cells: Vec<&str> = parts(upper).collect();
        let (from, own) = match (self.directions.is_empty(), cells.split_first()) {
            (false, Some((from, own))) => (
                text.whole(line, "the position of a node", from, 1, MOST_DOFS as u64)? as usize - 1,
                own,
            ),
            _ => (0, cells.as_slice()),
        };
        let own = own
            .iter()
            .map(|f| direction(text, line, f))
            .collect::<Result<Vec<u8>>>()?;
        if own.is_empty() || own.len() > 6 || self.directions.last().is_some_and(|d| d.0 >= from) {
            return Err(text
                .fault(
                    "the list of directions is out of order",
                    "lines are: position, direction, ..., ascending",
                )
                .at(line));
        }
        self.directions.push((from, own));
        Ok(())
    }

    fn dofs(&self, text: &Text) -> Result<Vec<Dof>> {
        let (nodes, directions) = (&self.nodes, &self.directions);
        let mut dofs = Vec::new();
        let mut at = 0;
        for (position, &node) in nodes.iter().enumerate() {
            while at + 1 < directions.len() && directions[at + 1].0 <= position {
                at += 1;
            }
            for &direction in &directions[at].1 {
                dofs.push(Dof { node, direction });
            }
        }
        if dofs.len() > MOST_DOFS {
            return Err(too_many(text, dofs.len()));
        }
        Ok(dofs)
    }
}

/// The lower half of `n` rows, written row after row; zeros off the diagonal are left out.
fn lower_half(text: &Text, n: usize, values: Vec<(f64, usize)>) -> Result<Vec<Raw>> {
    if values.len() != n * (n + 1) / 2 {
        return Err(text.fault(
            format!("the stiffness has {} entries, {n} degrees of freedom need {}", values.len(), n * (n + 1) / 2),
            "the lower half is written row after row; the file may have been cut off: export it again",
        ));
    }
    let mut raw = Vec::with_capacity(values.len());
    let mut next = values.into_iter();
    for row in 0..n {
        for column in 0..=row {
            if let Some((value, line)) = next.next()
                && (value != 0.0 || row == column)
            {
                #[allow(clippy::cast_possible_truncation)] // at most MOST_DOFS
                raw.push(Raw {
                    row: row as u32,
                    column: column as u32,
                    value,
                    line,
                });
            }
        }
    }
    Ok(raw)
}

/// Lines `node, direction, node, direction, value`.
pub(crate) fn pairs(text: &Text) -> Result<Superelement> {
    let mut numbers = Numbering::default();
    let mut raw = Vec::new();
    for (line, written) in text.lines() {
        if written.trim().is_empty() || written.trim_start().starts_with("**") {
            continue;
        }
        let cells: Vec<&str> = fields(written);
        if cells.len() < 5 {
            return Err(text
                .fault(
                    format!("the line has {} fields", cells.len()),
                    "five are needed: node, direction, node, direction, value",
                )
                .at(line));
        }
        let mut one = |from: usize| -> Result<u32> {
            let dof = Dof {
                node: text.whole(line, "the node", cells[from], 1, u64::MAX)?,
                direction: direction(text, line, cells[from + 1])?,
            };
            numbers.of(text, line, dof)
        };
        let (row, column) = (one(0)?, one(2)?);
        raw.push(Raw {
            row,
            column,
            value: text.number(line, "the entry", cells[4])?,
            line,
        });
    }
    Superelement::collect(
        text,
        "stiffness",
        "CalculiX or Abaqus matrix input",
        numbers.dofs,
        raw,
        Halves::Found,
    )
}

/// `.sti` with `.dof`.
pub(crate) fn triplets(text: &Text, companion: Option<&Text>) -> Result<Superelement> {
    let Some(list) = companion else {
        return Err(text.fault(
            "rows and columns are numbers; which nodes they are is not in this file",
            "name the .dof file that CalculiX wrote beside it with --dofs",
        ));
    };
    let mut dofs = Vec::new();
    for (line, written) in list.lines() {
        let written = written.trim();
        if written.is_empty() {
            continue;
        }
        let Some((node, own)) = written.split_once('.') else {
            return Err(list
                .fault(
                    format!("'{}' is no degree of freedom", short(written)),
                    "lines are: node.direction, as in 12.3",
                )
                .at(line));
        };
        let node = list.whole(line, "the node", node, 1, u64::MAX)?;
        dofs.push(Dof {
            node,
            direction: direction(list, line, own)?,
        });
        if dofs.len() > MOST_DOFS {
            return Err(too_many(list, dofs.len()).at(line));
        }
    }
    let mut raw = Vec::new();
    for (line, written) in text.lines() {
        if written.trim().is_empty() {
            continue;
        }
        let cells: Vec<&str> = fields(written);
        if cells.len() != 3 {
            return Err(text
                .fault(
                    format!("the line has {} fields", cells.len()),
                    "three are needed: row, column, value",
                )
                .at(line));
        }
        let number = |what: &str, field: &str| -> Result<u32> {
            let n = text.whole(line, what, field, 1, dofs.len() as u64).map_err(|mut e| {
                e.help = format!("the list of degrees of freedom has {} lines: do both files come from one run?", dofs.len());
                e
            })?;
            Ok(u32::try_from(n - 1).unwrap_or(u32::MAX))
        };
        let (row, column) = (
            number("the row", cells[0])?,
            number("the column", cells[1])?,
        );
        raw.push(Raw {
            row,
            column,
            value: text.number(line, "the entry", cells[2])?,
            line,
        });
    }
    Superelement::collect(text, "stiffness", "CalculiX .sti", dofs, raw, Halves::Found)
}
