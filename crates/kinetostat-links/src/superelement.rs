//! Stiffness matrices over the degrees of freedom of many nodes, as finite element programs write them.

use std::collections::BTreeMap;

use crate::error::Result;
use crate::text::Text;

/// Largest number of degrees of freedom.
pub const MOST_DOFS: usize = 60_000;

/// A direction of a node: 1 to 3 translations, 4 to 6 rotations, 0 a coordinate without direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Dof {
    /// Number of the node.
    pub node: u64,
    /// 1 to 6, or 0.
    pub direction: u8,
}

impl std::fmt::Display for Dof {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}.{}", self.node, self.direction)
    }
}

/// A symmetric stiffness matrix over named degrees of freedom, in the file's own units and axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Superelement {
    /// Name of the file.
    pub file: String,
    /// Name of the matrix in it.
    pub name: String,
    /// Format, in words.
    pub format: &'static str,
    /// Row and column order.
    pub dofs: Vec<Dof>,
    /// Lower half: (row, column, value) with row >= column, sorted, each pair once.
    pub entries: Vec<(u32, u32, f64)>,
    /// `|K - K^T| / |K + K^T|` of what was written, scaled by the diagonal; 0 where only one half is.
    pub antisymmetric_share: f64,
}

/// Entry as the file states it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Raw {
    pub(crate) row: u32,
    pub(crate) column: u32,
    pub(crate) value: f64,
    pub(crate) line: usize,
}

/// Halves of the matrix that are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Halves {
    /// One half: each pair once.
    One,
    /// Both halves: the entries of either are taken as written.
    Both,
    /// Whichever is found: if no pair occurs in both, one half.
    Found,
}

/// Numbers of the degrees of freedom in the order of appearance.
#[derive(Default)]
pub(crate) struct Numbering {
    pub(crate) dofs: Vec<Dof>,
    index: BTreeMap<Dof, u32>,
}

impl Numbering {
    pub(crate) fn of(&mut self, text: &Text, line: usize, dof: Dof) -> Result<u32> {
        if let Some(&i) = self.index.get(&dof) {
            return Ok(i);
        }
        if self.dofs.len() >= MOST_DOFS {
            return Err(too_many(text, self.dofs.len() + 1).at(line));
        }
        let i = u32::try_from(self.dofs.len()).unwrap_or(u32::MAX);
        self.dofs.push(dof);
        self.index.insert(dof, i);
        Ok(i)
    }
}

pub(crate) fn too_many(text: &Text, count: usize) -> crate::error::Error {
    text.fault(
        format!("the matrix has {count} or more degrees of freedom, at most {MOST_DOFS} are read"),
        "let the program condense it to the interfaces first (superelement, substructure)",
    )
}

/// Each degree of freedom has one row.
fn check_listed_once(text: &Text, dofs: &[Dof]) -> Result<()> {
    let mut seen: Vec<Dof> = dofs.to_vec();
    seen.sort_unstable();
    if let Some(pair) = seen.windows(2).find(|p| p[0] == p[1]) {
        return Err(text.fault(
            format!("the degree of freedom {} is listed twice", pair[0]),
            "each node and direction has one row",
        ));
    }
    Ok(())
}

/// Each entry is written once. `raw` is sorted by row and column.
fn check_written_once(text: &Text, dofs: &[Dof], raw: &[Raw]) -> Result<()> {
    if let Some(pair) = raw
        .windows(2)
        .find(|p| p[0].row == p[1].row && p[0].column == p[1].column)
    {
        return Err(text
            .fault(
                format!(
                    "the entry {} / {} is written twice, also at line {}",
                    dofs[pair[0].row as usize],
                    dofs[pair[0].column as usize],
                    pair[0].line.min(pair[1].line)
                ),
                "each entry is written once; remove one of them",
            )
            .at(pair[0].line.max(pair[1].line)));
    }
    Ok(())
}

/// True if both halves of the matrix are written; refuses a second half if one is declared. `raw` is sorted by row
/// and column.
fn has_both_halves(text: &Text, dofs: &[Dof], raw: &[Raw], halves: Halves) -> Result<bool> {
    let written = |row: u32, column: u32| {
        raw.binary_search_by_key(&(row, column), |e| (e.row, e.column))
            .is_ok()
    };
    let twin = raw
        .iter()
        .find(|e| e.row != e.column && written(e.column, e.row));
    Ok(match halves {
        Halves::Both => true,
        Halves::Found => twin.is_some(),
        Halves::One => {
            if let Some(e) = twin {
                return Err(text
                    .fault(
                        format!(
                            "the matrix is declared symmetric, but {} / {} is written in both halves",
                            dofs[e.row as usize], dofs[e.column as usize]
                        ),
                        "write one half, or declare the matrix square",
                    )
                    .at(e.line));
            }
            false
        }
    })
}

impl Superelement {
    /// Sorts what a file said and finds entries written twice.
    pub(crate) fn collect(
        text: &Text,
        name: &str,
        format: &'static str,
        dofs: Vec<Dof>,
        mut raw: Vec<Raw>,
        halves: Halves,
    ) -> Result<Self> {
        if dofs.len() > MOST_DOFS {
            return Err(too_many(text, dofs.len()));
        }
        if raw.is_empty() {
            return Err(text.fault("the matrix has no entries", "export it again"));
        }
        check_listed_once(text, &dofs)?;
        raw.sort_unstable_by_key(|e| (e.row, e.column));
        check_written_once(text, &dofs, &raw)?;
        let both = has_both_halves(text, &dofs, &raw, halves)?;
        // Partner of an entry on the other side of the diagonal.
        let value = |row: u32, column: u32| {
            raw.binary_search_by_key(&(row, column), |e| (e.row, e.column))
                .ok()
                .map(|at| raw[at].value)
        };
        let mut diagonal = vec![0.0_f64; dofs.len()];
        for e in raw.iter().filter(|e| e.row == e.column) {
            diagonal[e.row as usize] = e.value;
        }
        let (mut odd, mut even) = (0.0, 0.0);
        let mut entries = Vec::with_capacity(raw.len());
        for e in &raw {
            let mean = if both && e.row != e.column {
                let other = value(e.column, e.row);
                // Each pair is met from both sides unless one is missing (zero): take it once.
                if e.row < e.column && other.is_some() {
                    continue;
                }
                let other = other.unwrap_or(0.0);
                let unit = (diagonal[e.row as usize] * diagonal[e.column as usize])
                    .abs()
                    .max(f64::MIN_POSITIVE);
                odd += 2.0 * (e.value - other).powi(2) / unit;
                even += 2.0 * (e.value + other).powi(2) / unit;
                0.5 * (e.value + other)
            } else {
                if e.row == e.column && e.value != 0.0 {
                    even += 4.0;
                }
                e.value
            };
            entries.push((e.row.max(e.column), e.row.min(e.column), mean));
        }
        entries.sort_unstable_by_key(|e| (e.0, e.1));
        Ok(Self {
            file: text.name().to_owned(),
            name: name.to_owned(),
            format,
            dofs,
            entries,
            antisymmetric_share: if even > 0.0 {
                f64::sqrt(odd / even)
            } else {
                0.0
            },
        })
    }

    /// Numbers of the nodes, ascending.
    #[must_use]
    pub fn nodes(&self) -> Vec<u64> {
        let mut nodes: Vec<u64> = self.dofs.iter().map(|d| d.node).collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }
}
