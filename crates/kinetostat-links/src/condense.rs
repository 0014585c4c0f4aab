//! From a matrix of many degrees of freedom to the 6 x 6 stiffness of one interface, the other fixed.
//!
//! The nodes of the interface are tied to a rigid body (a rigid spider, RBE2) whose point is the link's end;
//! the nodes of the other interface are fixed; everything else follows without load (static
//! condensation [Guyan1965]): `K = G^T K_bb G - (K_ib G)^T K_ii^-1 (K_ib G)`, `G` the spider.
//!
//! An averaged interface (RBE3) may warp: its motion is the rigid one that fits the displacements of its
//! nodes best, `A u` with `A = (G^T G)^-1 G^T`, and a load of the end acts on the nodes as `A^T w`, so
//! that `K^-1 = A K_uu^-1 A^T` with every node of the interface free. That is never stiffer than the
//! rigid one. Every node counts alike, so that a coarse mesh gives way a little under its spread load.
//! [`crate::identify`] takes the average of a table of displacements by the same fit.

use kinetostat::number::short;
use std::collections::BTreeSet;

use nalgebra::{DMatrix, Matrix6, Rotation3, Vector3, Vector6};

use crate::envelope::{Factor, NoFactor};
use crate::error::{Error, Result};
use crate::interface::{RigidRank, rigid_rank};
use crate::nodes::Nodes;
use crate::superelement::Superelement;
use crate::units::Units;

/// How the nodes of an interface hang on the link's end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tie {
    /// As on a rigid body (RBE2): a bolted flange, a cast-in bearing.
    #[default]
    Rigid,
    /// By their average, loads spread over them (RBE3): an interface that its neighbour lets warp.
    Averaged,
}

/// What is asked of a superelement.
#[derive(Clone, Debug)]
pub struct Question {
    /// Units of the file.
    pub units: Units,
    /// Nodes of the interface that moves.
    pub interface: Vec<u64>,
    /// Nodes of the interface that is fixed; may be empty where the file's matrix is of a link held already.
    pub fixed: Vec<u64>,
    /// The link's end, m, file's axes; the middle of the interface's nodes without it.
    pub end: Option<Vector3<f64>>,
    /// The link's axes in the file's: `file = axes * link`.
    pub axes: Rotation3<f64>,
    /// How the nodes of the interface hang on the end.
    pub tie: Tie,
}

/// The stiffness of an interface.
#[derive(Clone, Debug, PartialEq)]
pub struct Condensed {
    /// Stiffness at the link's end in the link's axes, N/m, N/rad, N m/m, N m/rad.
    pub stiffness: Matrix6<f64>,
    /// The link's end, m, file's axes.
    pub end: Vector3<f64>,
    /// Degrees of freedom tied to the end, fixed, and condensed.
    pub counts: [usize; 3],
    /// Which motions the interface's nodes hold.
    pub rank: RigidRank,
    /// Smallest share that elimination left of a diagonal entry; tiny: a nearly free part inside.
    pub least_pivot: f64,
}

/// Condenses to one interface.
///
/// # Errors
///
/// Nodes that the matrix does not have, an interface on one line, places that are needed but unknown,
/// interior degrees of freedom that nothing holds, a matrix too large for a direct solution.
pub fn condense(element: &Superelement, nodes: &Nodes, question: &Question) -> Result<Condensed> {
    let fault = |message: String, help: &str| Error::new(&element.file, message, help);
    let interface: BTreeSet<u64> = question.interface.iter().copied().collect();
    let fixed: BTreeSet<u64> = question.fixed.iter().copied().collect();
    let known: BTreeSet<u64> = element.nodes().into_iter().collect();
    if interface.is_empty() {
        return Err(fault(
            "the interface has no nodes".into(),
            "name the nodes of the end that moves",
        ));
    }
    if let Some(node) = interface.intersection(&fixed).next() {
        return Err(fault(
            format!("the node {node} is in both interfaces"),
            "one end moves, the other is fixed",
        ));
    }
    if let Some(node) = interface.iter().find(|n| !known.contains(n)) {
        return Err(fault(
            format!("the node {node} of the interface is not in the matrix"),
            "its directions are held or were not retained: retain all nodes of the interface",
        ));
    }
    // What a boundary condition holds is in the mesh but not in the matrix.
    if let Some(node) = fixed
        .iter()
        .find(|n| !known.contains(n) && !nodes.places.contains_key(n))
    {
        return Err(fault(
            format!("the node {node} that shall be fixed is neither in the matrix nor in a mesh"),
            "check the number, or name the mesh with --nodes",
        ));
    }
    let mut places = Vec::new();
    for node in &interface {
        match nodes.places.get(node) {
            Some(place) => places.push(*place),
            None if interface.len() == 1 => places.push(question.end.unwrap_or_default()),
            None => {
                return Err(fault(
                    format!("the place of the node {node} is unknown"),
                    "an interface of several nodes needs their places: name the mesh with --nodes",
                ));
            }
        }
    }
    if interface.len() == 1
        && question.end.is_some()
        && !interface.iter().all(|n| nodes.places.contains_key(n))
    {
        return Err(fault(
            "the link's end is given, but not where the interface's node lies".into(),
            "name the mesh with --nodes, or leave the end out: it is the node then",
        ));
    }
    #[allow(clippy::cast_precision_loss)]
    let middle = places.iter().sum::<Vector3<f64>>() / places.len() as f64;
    let end = question.end.unwrap_or(middle);
    let index: Vec<u64> = interface.iter().copied().collect();
    // Translations only where the program has no rotations: then the places must span.
    let turns = element
        .dofs
        .iter()
        .any(|d| interface.contains(&d.node) && d.direction > 3);
    let rank = rigid_rank(&places);
    let averaged = question.tie == Tie::Averaged;
    if (!turns || averaged) && rank.rank < 6 {
        return Err(fault(
            format!(
                "the interface's nodes hold {} of 6 motions: {}",
                rank.rank, rank.words
            ),
            if averaged {
                "an average needs three nodes that lie on no line: take all nodes of a face, or tie them rigidly"
            } else {
                "take all nodes of a face, or a node with rotations"
            },
        ));
    }
    let scale: Vec<f64> = element
        .dofs
        .iter()
        .map(|d| {
            let base = (question.units.force_n / question.units.length_m).sqrt();
            if d.direction > 3 {
                base * question.units.length_m
            } else {
                base
            }
        })
        .collect();
    // Row of the spider for each degree of freedom of the interface.
    let spider: Vec<Option<Vector6<f64>>> = element
        .dofs
        .iter()
        .map(|d| {
            let at = index.binary_search(&d.node).ok()?;
            let mut row = Vector6::zeros();
            match d.direction {
                0 => return None,
                d @ 1..=3 => {
                    let d = usize::from(d) - 1;
                    row[d] = 1.0;
                    // u = phi x arm: component d of -hat(arm) phi.
                    let turned = -kinetostat::hat(&(places[at] - end));
                    row.fixed_rows_mut::<3>(3)
                        .copy_from(&turned.row(d).transpose());
                }
                d => row[usize::from(d) - 1] = 1.0,
            }
            Some(row)
        })
        .collect();
    let mut inner = vec![u32::MAX; element.dofs.len()];
    let mut count = 0_u32;
    let mut counts = [0; 3];
    for (i, dof) in element.dofs.iter().enumerate() {
        if spider[i].is_some() {
            counts[0] += 1;
            if averaged {
                inner[i] = count;
                count += 1;
            }
        } else if fixed.contains(&dof.node) {
            counts[1] += 1;
        } else {
            inner[i] = count;
            count += 1;
            counts[2] += 1;
        }
    }
    let mut own = Matrix6::zeros();
    let mut right = DMatrix::zeros(count as usize, 6);
    let mut inside = Vec::new();
    for &(i, j, value) in &element.entries {
        let (i, j) = (i as usize, j as usize);
        let value = value * scale[i] * scale[j];
        let of = |i: usize| spider[i].as_ref().filter(|_| !averaged);
        match (of(i), of(j)) {
            (Some(a), Some(b)) => {
                own += value * a * b.transpose();
                if i != j {
                    own += value * b * a.transpose();
                }
            }
            (Some(a), None) if inner[j] != u32::MAX => add(&mut right, inner[j] as usize, value, a),
            (None, Some(b)) if inner[i] != u32::MAX => add(&mut right, inner[i] as usize, value, b),
            (None, None) if inner[i] != u32::MAX && inner[j] != u32::MAX => {
                let (a, b) = (inner[i].max(inner[j]), inner[i].min(inner[j]));
                inside.push((a, b, value));
            }
            _ => {}
        }
    }
    let mut least_pivot = 1.0;
    if count > 0 {
        let factor =
            Factor::new(count as usize, &inside).map_err(|e| not_solved(&e, element, &inner))?;
        least_pivot = factor.least_pivot;
        if averaged {
            let rows = averages(element, &index, &places, (&middle, rank.size), &inner);
            own = of_average(&factor, &rows, count as usize)
                .and_then(|c| moved_to(&c, &(end - middle)).try_inverse())
                .ok_or_else(|| {
                    fault(
                        "the averaged interface has no stiffness of six directions".into(),
                        "check that the link hangs together and that the other interface is fixed",
                    )
                })?;
        }
        for c in 0..if averaged { 0 } else { 6 } {
            let b: Vec<f64> = right.column(c).iter().copied().collect();
            let x = factor.solve(&b);
            for r in 0..6 {
                own[(r, c)] -= right
                    .column(r)
                    .iter()
                    .zip(&x)
                    .map(|(a, b)| a * b)
                    .sum::<f64>();
            }
        }
    }
    let own = 0.5 * (own + own.transpose());
    let turn = kinetostat::turn_matrix(&question.axes);
    Ok(Condensed {
        stiffness: turn.transpose() * own * turn,
        end,
        counts,
        rank,
        least_pivot,
    })
}

/// Why the inside could not be solved for.
fn not_solved(error: &NoFactor, element: &Superelement, inner: &[u32]) -> Error {
    let fault = |message: String, help: &str| Error::new(&element.file, message, help);
    match *error {
        NoFactor::TooLarge(size) => fault(
            format!(
                "the direct solution needs {size} numbers, at most {} are held",
                crate::envelope::MOST_ENVELOPE
            ),
            "let the program condense it to the interfaces first (*SUBSTRUCTURE GENERATE, superelement)",
        ),
        NoFactor::NotHeld(row, share) => {
            let at = inner
                .iter()
                .position(|&i| i as usize == row)
                .map_or_else(String::new, |i| element.dofs[i].to_string());
            if share < -1e-6 {
                fault(
                    format!(
                        "the matrix is not positive definite inside: at node.direction {at} elimination leaves {} of the diagonal entry",
                        short(share)
                    ),
                    "this is no stiffness of a body without load: check signs, and that it is not a mass matrix",
                )
            } else {
                fault(
                    format!(
                        "nothing holds the inside of the link: at node.direction {at} elimination leaves nothing"
                    ),
                    "a part is loose, or neither interface touches it; fix the other interface",
                )
            }
        }
    }
}

/// `A^T` of an averaged interface: for each translation of its nodes, the row of the unknown and the
/// force on it by unit loads at the middle of the nodes (N, N m).
fn averages(
    element: &Superelement,
    interface: &[u64],
    places: &[Vector3<f64>],
    (middle, size): (&Vector3<f64>, f64),
    inner: &[u32],
) -> Vec<(usize, Vector6<f64>)> {
    // Rotations in units of the interface's size keep the normal equations well-conditioned.
    let unit = Vector6::new(1.0, 1.0, 1.0, 1.0 / size, 1.0 / size, 1.0 / size);
    let mut rows: Vec<(usize, Vector6<f64>)> = Vec::new();
    for (i, dof) in element.dofs.iter().enumerate() {
        let (Ok(at), 1..=3) = (interface.binary_search(&dof.node), dof.direction) else {
            continue;
        };
        let d = usize::from(dof.direction) - 1;
        let map = crate::interface::spider(&places[at..=at], middle);
        let row = map.row(d).transpose();
        let row = Vector6::from_column_slice(row.as_slice()).component_mul(&unit);
        rows.push((inner[i] as usize, row));
    }
    let gram: Matrix6<f64> = rows.iter().map(|(_, s)| s * s.transpose()).sum();
    let inverse = gram.try_inverse().unwrap_or_else(Matrix6::zeros);
    for (_, s) in &mut rows {
        *s = (inverse * *s).component_mul(&unit);
    }
    rows
}

/// `A K_uu^-1 A^T`, compliance of the average.
fn of_average(
    factor: &Factor,
    rows: &[(usize, Vector6<f64>)],
    count: usize,
) -> Option<Matrix6<f64>> {
    let mut compliance = Matrix6::zeros();
    for c in 0..6 {
        let mut load = vec![0.0; count];
        for (row, s) in rows {
            load[*row] += s[c];
        }
        let moved = factor.solve(&load);
        for (row, s) in rows {
            let mut column = compliance.column_mut(c);
            column += s * moved[*row];
        }
    }
    compliance
        .iter()
        .all(|x: &f64| x.is_finite())
        .then_some(compliance)
}

/// A compliance at a point `arm` further on.
fn moved_to(compliance: &Matrix6<f64>, arm: &Vector3<f64>) -> Matrix6<f64> {
    let shift = kinetostat::shift_matrix(arm);
    shift * compliance * shift.transpose()
}

fn add(right: &mut DMatrix<f64>, row: usize, value: f64, spider: &Vector6<f64>) {
    for c in 0..6 {
        right[(row, c)] += value * spider[c];
    }
}

/// Does a superelement without supports let itself be moved as a rigid body?
#[derive(Clone, Debug, PartialEq)]
pub struct FreeTest {
    /// `|K r| / (|K| |r|)` for the rigid motions x, y, z, rx, ry, rz: 0 for a body that nothing holds;
    /// `None` where the places of nodes are unknown (rotations) .
    pub resistance: [Option<f64>; 6],
    /// Number of eigenvalues that are zero, of the matrix balanced by its diagonal; `None` for matrices
    /// of more than 600 rows.
    pub zero_modes: Option<usize>,
    /// Number of negative ones.
    pub negative_modes: Option<usize>,
}

/// What counts as no resistance: files have 9 to 13 digits.
const FREE_TO: f64 = 1e-6;

impl FreeTest {
    /// True if the six rigid motions (those that could be tried) meet no resistance.
    #[must_use]
    pub fn is_free(&self) -> bool {
        self.resistance.iter().flatten().all(|r| *r < FREE_TO)
    }

    /// In words.
    #[must_use]
    pub fn words(&self) -> String {
        let held: Vec<&str> = (0..6)
            .filter(|&i| self.resistance[i].is_some_and(|r| r >= FREE_TO))
            .map(|i| crate::judge::DIRECTIONS[i])
            .collect();
        let modes = self
            .zero_modes
            .map_or_else(String::new, |n| format!("; {n} zero modes"));
        let negative = match self.negative_modes {
            Some(n) if n > 0 => {
                format!("; {n} negative modes, so this is no stiffness of a body without load")
            }
            _ => String::new(),
        };
        let tried = self.resistance.iter().flatten().count();
        if held.is_empty() {
            format!(
                "the body is free: {tried} of 6 rigid motions tried, none meets resistance{modes}{negative}"
            )
        } else {
            format!(
                "the body is held: the rigid motion along {} meets resistance{modes}{negative}",
                held.join(", ")
            )
        }
    }
}

/// The rigid-body test of a superelement; `units` are those of its file.
#[must_use]
pub fn free_test(element: &Superelement, nodes: &Nodes, units: Units) -> FreeTest {
    let n = element.dofs.len();
    let placed = element
        .dofs
        .iter()
        .all(|d| nodes.places.contains_key(&d.node));
    #[allow(clippy::cast_precision_loss)]
    let centre = if placed {
        element
            .dofs
            .iter()
            .filter_map(|d| nodes.places.get(&d.node))
            .sum::<Vector3<f64>>()
            / n.max(1) as f64
    } else {
        Vector3::zeros()
    };
    let resistance = std::array::from_fn(|m| {
        if m >= 3 && !placed {
            return None;
        }
        let motion: Vec<f64> = element
            .dofs
            .iter()
            .map(|d| {
                let turn = Vector3::from_fn(|i, _| f64::from(u8::from(i + 3 == m)));
                let place = nodes.places.get(&d.node).copied().unwrap_or_default();
                let move_ = if m < 3 {
                    Vector3::from_fn(|i, _| f64::from(u8::from(i == m)))
                } else {
                    turn.cross(&(place - centre)) / units.length_m
                };
                match d.direction {
                    0 => 0.0,
                    d @ 1..=3 => move_[usize::from(d) - 1],
                    d => turn[usize::from(d) - 4],
                }
            })
            .collect();
        let (mut force, mut size) = (vec![0.0; n], vec![0.0; n]);
        for &(i, j, value) in &element.entries {
            let (i, j) = (i as usize, j as usize);
            let mut add = |to: usize, from: usize| {
                force[to] += value * motion[from];
                size[to] += (value * motion[from]).abs();
            };
            add(i, j);
            if i != j {
                add(j, i);
            }
        }
        let norm = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        let whole = norm(&size);
        Some(if whole > 0.0 {
            norm(&force) / whole
        } else {
            0.0
        })
    });
    let (mut zero_modes, mut negative_modes) = (None, None);
    if n <= 600 {
        let mut dense = DMatrix::zeros(n, n);
        for &(i, j, value) in &element.entries {
            dense[(i as usize, j as usize)] = value;
            dense[(j as usize, i as usize)] = value;
        }
        let unit: Vec<f64> = (0..n)
            .map(|i| {
                let d: f64 = dense[(i, i)];
                if d > 0.0 {
                    d.sqrt()
                } else {
                    dense.row(i).amax().max(f64::MIN_POSITIVE).sqrt()
                }
            })
            .collect();
        let balanced = DMatrix::from_fn(n, n, |i, j| dense[(i, j)] / unit[i] / unit[j]);
        let eigen = balanced.symmetric_eigenvalues();
        let largest = eigen.amax();
        zero_modes = Some(eigen.iter().filter(|e| e.abs() < 1e-7 * largest).count());
        negative_modes = Some(eigen.iter().filter(|e| **e < -1e-7 * largest).count());
    }
    FreeTest {
        resistance,
        zero_modes,
        negative_modes,
    }
}
