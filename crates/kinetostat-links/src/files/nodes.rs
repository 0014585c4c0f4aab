//! Positions of the nodes, and their sets by name: from the mesh that the matrix or the table belongs to.

use std::collections::BTreeMap;

use nalgebra::Vector3;

use crate::error::{Error, LinkErrorKind, Result};
use crate::files::dmig::grids;
use crate::text::{Text, fields, short};
use crate::units::Units;

/// Places of nodes in m, file's axes, and sets of nodes (names in capitals).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Nodes {
    /// Name of the file.
    pub file: String,
    /// Places, m.
    pub places: BTreeMap<u64, Vector3<f64>>,
    /// Sets by name.
    pub sets: BTreeMap<String, Vec<u64>>,
}

impl Nodes {
    /// The nodes of a set, or of a list such as `12` or `12,13,14`.
    ///
    /// # Errors
    ///
    /// Neither a set nor a list of numbers.
    pub fn named(&self, words: &str) -> Result<Vec<u64>> {
        if let Some(set) = self.sets.get(&words.trim().to_uppercase()) {
            return Ok(set.clone());
        }
        let list: Option<Vec<u64>> = words
            .split([',', ' '])
            .filter(|w| !w.trim().is_empty())
            .map(|w| w.trim().parse().ok().filter(|n| *n > 0))
            .collect();
        match list {
            Some(mut list) if !list.is_empty() => {
                list.sort_unstable();
                list.dedup();
                Ok(list)
            }
            _ => Err(Error::new(
                LinkErrorKind::File,
                if self.file.is_empty() {
                    "the nodes"
                } else {
                    &self.file
                },
                format!(
                    "'{}' is no set of nodes and no list of node numbers",
                    short(words)
                ),
                if self.sets.is_empty() {
                    "write numbers as in 12,13,14; sets come with a mesh in .inp".to_owned()
                } else {
                    let names: Vec<&str> = self.sets.keys().take(12).map(String::as_str).collect();
                    format!(
                        "there are the sets {}; or write numbers as in 12,13,14",
                        names.join(", ")
                    )
                },
            )),
        }
    }
}

/// Reads nodes: an input file of CalculiX or Abaqus (`*NODE`, `*NSET`), bulk data of Nastran (`GRID`), or
/// CSV with the header `node,x_mm,y_mm,z_mm` (or `_m`). `units`: lengths of the first two.
///
/// # Errors
///
/// With file, line and what to do.
pub fn read_nodes(text: &Text, units: Units) -> Result<Nodes> {
    let mut nodes = Nodes {
        file: text.name().to_owned(),
        ..Nodes::default()
    };
    let mut kind = None;
    for (_, line) in text.lines() {
        let upper = line.trim_start().to_uppercase();
        kind = match upper.as_str() {
            l if l.starts_with("*NODE") => Some(Kind::Input),
            l if l.starts_with("GRID") => Some(Kind::Bulk),
            l if l.starts_with("NODE") => Some(Kind::Table),
            _ => None,
        };
        if kind.is_some() {
            break;
        }
    }
    match kind {
        Some(Kind::Input) => input(text, units, &mut nodes)?,
        Some(Kind::Bulk) => {
            for (line, node, place) in grids(text)? {
                insert(
                    text,
                    line,
                    &mut nodes,
                    node,
                    Vector3::from(place) * units.length_m,
                )?;
            }
        }
        Some(Kind::Table) => table(text, &mut nodes)?,
        None => {
            return Err(text.fault(
                "the file holds no nodes",
                "a mesh has *NODE (CalculiX, Abaqus) or GRID (Nastran); a CSV starts with node,x_mm,y_mm,z_mm",
            ));
        }
    }
    Ok(nodes)
}

enum Kind {
    Input,
    Bulk,
    Table,
}

fn insert(
    text: &Text,
    line: usize,
    nodes: &mut Nodes,
    node: u64,
    place: Vector3<f64>,
) -> Result<()> {
    match nodes.places.insert(node, place) {
        Some(before) if before != place => Err(text
            .fault(
                format!("the node {node} is given twice, at different places"),
                "keep one of them",
            )
            .at(line)),
        _ => Ok(()),
    }
}

/// An input file of CalculiX or Abaqus.
fn input(text: &Text, units: Units, nodes: &mut Nodes) -> Result<()> {
    enum Part {
        Nodes,
        Set(String, bool),
        Other,
    }
    let mut part = Part::Other;
    for (line, written) in text.lines() {
        let trimmed = written.trim();
        if trimmed.is_empty() || trimmed.starts_with("**") {
            continue;
        }
        if let Some(card) = trimmed.strip_prefix('*') {
            let card = card.to_uppercase().replace(' ', "");
            let mut words = card.split(',');
            let key = words.next().unwrap_or_default().to_owned();
            let words: Vec<&str> = words.collect();
            let set = words
                .iter()
                .find_map(|w| w.strip_prefix("NSET="))
                .map(str::to_owned);
            part = match (key.as_str(), set) {
                ("NODE", _) => Part::Nodes,
                ("NSET", Some(name)) => {
                    nodes.sets.entry(name.clone()).or_default();
                    Part::Set(name, words.contains(&"GENERATE"))
                }
                _ => Part::Other,
            };
            continue;
        }
        let cells: Vec<&str> = trimmed
            .split(',')
            .map(str::trim)
            .filter(|c| !c.is_empty())
            .collect();
        match &part {
            Part::Nodes => {
                let node = text.whole(
                    line,
                    "the number of the node",
                    cells.first().copied().unwrap_or(""),
                    1,
                    u64::MAX,
                )?;
                let mut place = Vector3::zeros();
                for (i, cell) in cells.iter().skip(1).take(3).enumerate() {
                    place[i] = text.number(line, "a coordinate", cell)? * units.length_m;
                }
                insert(text, line, nodes, node, place)?;
            }
            Part::Set(name, generate) => {
                let own = members(text, line, &cells, *generate, &nodes.sets)?;
                let set = nodes.sets.entry(name.clone()).or_default();
                if set.len() + own.len() > 10_000_000 {
                    return Err(text
                        .fault(
                            "the set has far too many nodes",
                            "a set names each node once",
                        )
                        .at(line));
                }
                set.extend(own);
            }
            Part::Other => {}
        }
    }
    for set in nodes.sets.values_mut() {
        set.sort_unstable();
        set.dedup();
    }
    Ok(())
}

/// Nodes that a line of a set names: one by one or by other sets, or as first, last and step.
fn members(
    text: &Text,
    line: usize,
    cells: &[&str],
    generate: bool,
    sets: &BTreeMap<String, Vec<u64>>,
) -> Result<Vec<u64>> {
    let mut own = Vec::new();
    if generate {
        let mut bounds = [1, 1, 1];
        for (b, cell) in bounds.iter_mut().zip(cells) {
            *b = text.whole(line, "a bound of the set", cell, 1, u64::MAX)?;
        }
        let [from, to, step] = bounds;
        if to < from || (to - from) / step > 10_000_000 {
            return Err(text
                .fault(
                    "the set has no nodes or far too many",
                    "lines are: first, last, step",
                )
                .at(line));
        }
        own.extend((from..=to).step_by(usize::try_from(step).unwrap_or(1)));
    } else {
        for cell in cells {
            match sets.get(&cell.to_uppercase()) {
                Some(other) => own.extend(other.clone()),
                None => own.push(text.whole(line, "a node of the set", cell, 1, u64::MAX)?),
            }
        }
    }
    Ok(own)
}

/// CSV with a node, its number and its coordinates, on each line.
fn table(text: &Text, nodes: &mut Nodes) -> Result<()> {
    let mut unit = None;
    for (line, written) in text.lines() {
        let cells = fields(written);
        if cells.iter().all(|c| c.is_empty()) {
            continue;
        }
        let Some(unit) = unit else {
            let header: Vec<String> = cells.iter().map(|c| c.to_lowercase()).collect();
            unit = match header
                .iter()
                .map(String::as_str)
                .collect::<Vec<_>>()
                .as_slice()
            {
                ["node", "x_mm", "y_mm", "z_mm"] => Some(1e-3),
                ["node", "x_m", "y_m", "z_m"] => Some(1.0),
                _ => {
                    return Err(text
                        .fault(
                            "the header is not known",
                            "it is node,x_mm,y_mm,z_mm or node,x_m,y_m,z_m",
                        )
                        .at(line));
                }
            };
            continue;
        };
        if cells.len() < 4 {
            return Err(text
                .fault(
                    format!("the line has {} fields", cells.len()),
                    "four are needed: node, x, y, z",
                )
                .at(line));
        }
        let node = text.whole(line, "the node", cells[0], 1, u64::MAX)?;
        let mut place = Vector3::zeros();
        for i in 0..3 {
            place[i] = text.number(line, "a coordinate", cells[i + 1])? * unit;
        }
        insert(text, line, nodes, node, place)?;
    }
    Ok(())
}
