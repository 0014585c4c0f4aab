//! From a matrix of many degrees of freedom to the 6 x 6 stiffness of one interface, the other fixed.
//!
//! The nodes of the interface are tied to a rigid body (a rigid spider, RBE2) whose point is the link's end;
//! the nodes of the other interface are fixed; everything else follows without load (static
//! condensation \[Guyan1965\]): `K = G^T K_bb G - (K_ib G)^T K_ii^-1 (K_ib G)`, `G` the spider.
//!
//! An averaged interface (RBE3) may warp: its motion is the rigid one that fits the displacements of its
//! nodes best, `A u` with `A = (G^T G)^-1 G^T`, and a load of the end acts on the nodes as `A^T w`, so
//! that `K^-1 = A K_uu^-1 A^T` with every node of the interface free. That is never stiffer than the
//! rigid one. Every node counts alike, so that a coarse mesh gives way a little under its spread load.
//! [`crate::identify`] takes the average of a table of displacements by the same fit.

use std::collections::BTreeSet;

use kinetostat::number::short;
use nalgebra::{DMatrix, Matrix6, Rotation3, Vector3, Vector6};

use crate::condensation::envelope::{Factor, NoFactor};
use crate::error::{Error, LinkErrorKind, Result};
use crate::files::nodes::Nodes;
use crate::interface::{RigidRank, rigid_rank};
use crate::superelement::Superelement;
use crate::units::Units;

/// Coupling of the nodes of an interface to the link's end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tie {
    /// Rigid body (RBE2): a bolted flange, a cast-in bearing.
    #[default]
    Rigid,
    /// Average, with loads spread over the nodes (RBE3): an interface that its neighbour lets warp.
    Averaged,
}

/// The interfaces, units and axes to which a superelement is condensed.
#[derive(Clone, Debug)]
pub struct CondensationRequest {
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
    /// Coupling of the interface's nodes to the end.
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
    /// Motions that the interface's nodes hold.
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
pub fn condense(
    element: &Superelement,
    nodes: &Nodes,
    request: &CondensationRequest,
) -> Result<Condensed> {
    let fixed: BTreeSet<u64> = request.fixed.iter().copied().collect();
    let interface = Interface::new(element, nodes, request, &fixed)?;
    let parts = Parts::new(element, &interface, &fixed);
    let blocks = Blocks::new(element, &parts, &units_of(element, request.units));
    let count = parts.count as usize;
    let (mut own, mut least_pivot) = (blocks.own, 1.0);
    if count > 0 {
        let factor = Factor::new(count, &blocks.inside)
            .map_err(|e| not_solved(&e, element, &parts.inner))?;
        least_pivot = factor.least_pivot;
        if interface.averaged {
            own = averaged_stiffness(element, &interface, &factor, &parts)?;
        } else {
            eliminate(&mut own, &blocks.right, &factor);
        }
    }
    let own = 0.5 * (own + own.transpose());
    let turn = kinetostat::spatial::turn_matrix(&request.axes);
    Ok(Condensed {
        stiffness: turn.transpose() * own * turn,
        end: interface.end,
        counts: parts.counts,
        rank: interface.rank,
        least_pivot,
    })
}

/// The interface that moves: its nodes, where they are, and the end that they are tied to.
struct Interface {
    /// Nodes, ascending.
    index: Vec<u64>,
    /// Their places, m, file's axes.
    places: Vec<Vector3<f64>>,
    middle: Vector3<f64>,
    end: Vector3<f64>,
    rank: RigidRank,
    /// True for an average instead of a rigid body.
    averaged: bool,
}

impl Interface {
    fn new(
        element: &Superelement,
        nodes: &Nodes,
        request: &CondensationRequest,
        fixed: &BTreeSet<u64>,
    ) -> Result<Self> {
        let own: BTreeSet<u64> = request.interface.iter().copied().collect();
        check_nodes(element, nodes, &own, fixed)?;
        let places = places_of(element, nodes, &own, request.end)?;
        #[allow(clippy::cast_precision_loss)]
        let middle = places.iter().sum::<Vector3<f64>>() / places.len() as f64;
        // Translations only where the program has no rotations: then the places must span.
        let turns = element
            .dofs
            .iter()
            .any(|d| own.contains(&d.node) && d.direction > 3);
        let rank = rigid_rank(&places);
        let averaged = request.tie == Tie::Averaged;
        if (!turns || averaged) && rank.rank < 6 {
            return Err(Error::new(
                LinkErrorKind::Interface,
                &element.file,
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
        Ok(Self {
            index: own.into_iter().collect(),
            places,
            middle,
            end: request.end.unwrap_or(middle),
            rank,
            averaged,
        })
    }
}

/// Checks that the two interfaces can be those of the matrix.
fn check_nodes(
    element: &Superelement,
    nodes: &Nodes,
    interface: &BTreeSet<u64>,
    fixed: &BTreeSet<u64>,
) -> Result<()> {
    let fault = |message: String, help: &str| {
        Error::new(LinkErrorKind::Interface, &element.file, message, help)
    };
    let known: BTreeSet<u64> = element.nodes().into_iter().collect();
    if interface.is_empty() {
        return Err(fault(
            "the interface has no nodes".into(),
            "name the nodes of the end that moves",
        ));
    }
    if let Some(node) = interface.intersection(fixed).next() {
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
    // Nodes held by a boundary condition are in the mesh but not in the matrix.
    if let Some(node) = fixed
        .iter()
        .find(|n| !known.contains(n) && !nodes.places.contains_key(n))
    {
        return Err(fault(
            format!("the node {node} that shall be fixed is neither in the matrix nor in a mesh"),
            "check the number, or name the mesh with --nodes",
        ));
    }
    Ok(())
}

/// Places of the interface's nodes, m. A single node lies at the link's end where no mesh says otherwise.
fn places_of(
    element: &Superelement,
    nodes: &Nodes,
    interface: &BTreeSet<u64>,
    end: Option<Vector3<f64>>,
) -> Result<Vec<Vector3<f64>>> {
    let fault = |message: String, help: &str| {
        Error::new(LinkErrorKind::Interface, &element.file, message, help)
    };
    let mut places = Vec::new();
    for node in interface {
        match nodes.places.get(node) {
            Some(place) => places.push(*place),
            None if interface.len() == 1 => places.push(end.unwrap_or_default()),
            None => {
                return Err(fault(
                    format!("the place of the node {node} is unknown"),
                    "an interface of several nodes needs their places: name the mesh with --nodes",
                ));
            }
        }
    }
    if interface.len() == 1
        && end.is_some()
        && !interface.iter().all(|n| nodes.places.contains_key(n))
    {
        return Err(fault(
            "the link's end is given, but not where the interface's node lies".into(),
            "name the mesh with --nodes, or leave the end out: it is the node then",
        ));
    }
    Ok(places)
}

/// Units of the degrees of freedom: factors that turn the file's stiffness into SI from both sides.
fn units_of(element: &Superelement, units: Units) -> Vec<f64> {
    element
        .dofs
        .iter()
        .map(|d| {
            let base = (units.force_n / units.length_m).sqrt();
            if d.direction > 3 {
                base * units.length_m
            } else {
                base
            }
        })
        .collect()
}

/// Row of the spider for each degree of freedom of the interface; `None` for the others.
fn spider_rows(element: &Superelement, interface: &Interface) -> Vec<Option<Vector6<f64>>> {
    element
        .dofs
        .iter()
        .map(|d| {
            let at = interface.index.binary_search(&d.node).ok()?;
            let mut row = Vector6::zeros();
            match d.direction {
                0 => return None,
                d @ 1..=3 => {
                    let d = usize::from(d) - 1;
                    row[d] = 1.0;
                    // u = phi x arm: component d of -hat(arm) phi.
                    let turned = -kinetostat::spatial::hat(&(interface.places[at] - interface.end));
                    row.fixed_rows_mut::<3>(3)
                        .copy_from(&turned.row(d).transpose());
                }
                d => row[usize::from(d) - 1] = 1.0,
            }
            Some(row)
        })
        .collect()
}

/// Treatment of each degree of freedom.
struct Parts {
    /// Row of the spider of those that are tied rigidly; `None` for the others.
    spider: Vec<Option<Vector6<f64>>>,
    /// Number among the unknowns; `u32::MAX` for those that are no unknown.
    inner: Vec<u32>,
    /// Unknowns.
    count: u32,
    /// Degrees of freedom tied to the end, fixed, and condensed.
    counts: [usize; 3],
}

impl Parts {
    /// The nodes of an averaged interface are unknowns as well: it may warp.
    fn new(element: &Superelement, interface: &Interface, fixed: &BTreeSet<u64>) -> Self {
        let spider = spider_rows(element, interface);
        let mut inner = vec![u32::MAX; element.dofs.len()];
        let (mut count, mut counts) = (0_u32, [0; 3]);
        for (i, dof) in element.dofs.iter().enumerate() {
            let unknown = if spider[i].is_some() {
                counts[0] += 1;
                interface.averaged
            } else if fixed.contains(&dof.node) {
                counts[1] += 1;
                false
            } else {
                counts[2] += 1;
                true
            };
            if unknown {
                inner[i] = count;
                count += 1;
            }
        }
        let spider = match interface.averaged {
            true => vec![None; spider.len()],
            false => spider,
        };
        Self {
            spider,
            inner,
            count,
            counts,
        }
    }
}

/// The blocks of the matrix in SI: `G^T K_bb G`, `K_ib G` and the entries of `K_ii`.
struct Blocks {
    own: Matrix6<f64>,
    right: DMatrix<f64>,
    inside: Vec<(u32, u32, f64)>,
}

impl Blocks {
    fn new(element: &Superelement, parts: &Parts, scale: &[f64]) -> Self {
        let inner = &parts.inner;
        let mut own = Matrix6::zeros();
        let mut right = DMatrix::zeros(parts.count as usize, 6);
        let mut inside = Vec::new();
        for &(i, j, value) in &element.entries {
            let (i, j) = (i as usize, j as usize);
            let value = value * scale[i] * scale[j];
            match (&parts.spider[i], &parts.spider[j]) {
                (Some(a), Some(b)) => {
                    own += value * a * b.transpose();
                    if i != j {
                        own += value * b * a.transpose();
                    }
                }
                (Some(a), None) if inner[j] != u32::MAX => {
                    add(&mut right, inner[j] as usize, value, a);
                }
                (None, Some(b)) if inner[i] != u32::MAX => {
                    add(&mut right, inner[i] as usize, value, b);
                }
                (None, None) if inner[i] != u32::MAX && inner[j] != u32::MAX => {
                    let (a, b) = (inner[i].max(inner[j]), inner[i].min(inner[j]));
                    inside.push((a, b, value));
                }
                _ => {}
            }
        }
        Self { own, right, inside }
    }
}

/// Static condensation: takes `(K_ib G)^T K_ii^-1 (K_ib G)` from `G^T K_bb G`.
fn eliminate(own: &mut Matrix6<f64>, right: &DMatrix<f64>, factor: &Factor) {
    for c in 0..6 {
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

/// Stiffness of an averaged interface at the link's end: the inverse of `A K_uu^-1 A^T`.
fn averaged_stiffness(
    element: &Superelement,
    interface: &Interface,
    factor: &Factor,
    parts: &Parts,
) -> Result<Matrix6<f64>> {
    let rows = averages(element, interface, &parts.inner);
    of_average(factor, &rows, parts.count as usize)
        .and_then(|c| moved_to(&c, &(interface.end - interface.middle)).try_inverse())
        .ok_or_else(|| {
            Error::new(
                LinkErrorKind::Interface,
                &element.file,
                "the averaged interface has no stiffness of six directions",
                "check that the link hangs together and that the other interface is fixed",
            )
        })
}

/// Error of the factorisation of the inner degrees of freedom.
fn not_solved(error: &NoFactor, element: &Superelement, inner: &[u32]) -> Error {
    let fault = |message: String, help: &str| {
        Error::new(LinkErrorKind::Interface, &element.file, message, help)
    };
    match *error {
        NoFactor::TooLarge(size) => fault(
            format!(
                "the direct solution needs {size} numbers, at most {} are held",
                crate::condensation::envelope::MOST_ENVELOPE
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
    interface: &Interface,
    inner: &[u32],
) -> Vec<(usize, Vector6<f64>)> {
    let Interface { places, middle, .. } = interface;
    // Rotations in units of the interface's size keep the normal equations well-conditioned.
    let size = interface.rank.size;
    let unit = Vector6::new(1.0, 1.0, 1.0, 1.0 / size, 1.0 / size, 1.0 / size);
    let mut rows: Vec<(usize, Vector6<f64>)> = Vec::new();
    for (i, dof) in element.dofs.iter().enumerate() {
        let (Ok(at), 1..=3) = (interface.index.binary_search(&dof.node), dof.direction) else {
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
    let shift = kinetostat::spatial::shift_matrix(arm);
    shift * compliance * shift.transpose()
}

fn add(right: &mut DMatrix<f64>, row: usize, value: f64, spider: &Vector6<f64>) {
    for c in 0..6 {
        right[(row, c)] += value * spider[c];
    }
}
