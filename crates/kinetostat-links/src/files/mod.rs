//! Files of other programs: matrices of one link or of many nodes, meshes, displacements, loads.
//!
//! Takes a [`Text`]; gives numbers with their units, or refuses a line with what to do. Computes nothing with
//! them.

pub(crate) mod calculix;
pub(crate) mod displacements;
pub(crate) mod dmig;
pub(crate) mod harwell_boeing;
pub(crate) mod matrix;
pub(crate) mod nodes;

use crate::error::Result;
use crate::files::calculix::{pairs, triplets, user_element};
use crate::files::dmig::read_dmig;
use crate::files::harwell_boeing::{read_hbmat, recognised};
use crate::superelement::Superelement;
use crate::text::{Text, fields};

/// Reads a matrix of many degrees of freedom; the format is recognised from the text:
///
/// - Nastran bulk data with `DMIG` (small, large and free fields),
/// - CalculiX and Abaqus `.mtx`: `*USER ELEMENT` with `*MATRIX, TYPE=STIFFNESS`, or lines
///   `node, direction, node, direction, value`,
/// - CalculiX `.sti` (lines `row column value`) with its `.dof` file as `companion`,
/// - Harwell-Boeing (Ansys `HBMAT`) with its mapping file as `companion`.
///
/// `matrix`: name of the matrix where the file has several.
///
/// # Errors
///
/// With file, line and what to do.
pub fn read_superelement(
    text: &Text,
    companion: Option<&Text>,
    matrix: Option<&str>,
) -> Result<Superelement> {
    let mut dmig = false;
    let mut first = "";
    for (_, line) in text.lines() {
        let upper = line.trim_start().to_uppercase();
        if upper.starts_with("DMIG") {
            dmig = true;
            break;
        }
        if upper.starts_with("*USER ELEMENT") || upper.starts_with("*MATRIX") {
            return user_element(text);
        }
        if first.is_empty()
            && !upper.is_empty()
            && !upper.starts_with("**")
            && !upper.starts_with('$')
        {
            first = line;
        }
    }
    if dmig {
        return read_dmig(text, matrix);
    }
    if let Some(found) = recognised(text) {
        return read_hbmat(text, companion, found);
    }
    let cells = fields(first).into_iter().filter(|c| !c.is_empty()).count();
    match cells {
        5 => pairs(text),
        3 => triplets(text, companion),
        _ => Err(text.fault(
            "the file has none of the formats that are known",
            "these are: Nastran DMIG, CalculiX or Abaqus .mtx (*USER ELEMENT or node,dof,node,dof,value), CalculiX .sti with .dof, Ansys Harwell-Boeing with its mapping file",
        )),
    }
}
