//! The four kinds of directions of a Cartesian stiffness, and which joints and springs are behind
//! each: free (passive joints), finite, negative (under load), rigid (motions that the chain
//! cannot make, whose stiffness is infinite).

use nalgebra::{DMatrix, DVector, Matrix6, Vector3, Vector6};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

use crate::chain::system::System;
use crate::linalg::complement::complement;
use crate::linalg::saddle::{RANK_TOLERANCE, column_space, rows_certainly_independent};
use crate::model::chain::{Chain, Role, Scale};
use crate::number::short;
use crate::spatial::{MotionKind, Twist};

/// Kind of a direction of the end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum DirectionKind {
    /// Moves without force.
    Free,
    /// Positive stiffness.
    Finite,
    /// Negative stiffness: pulls away by itself under a dead load.
    Negative,
    /// The chain cannot move that way: infinite stiffness.
    Rigid,
}

/// A joint or spring that moves when the end moves in a direction.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Share {
    /// Name of the coordinate; in a mechanism `limb: coordinate`.
    pub name: String,
    /// Passive joint or spring.
    pub role: Role,
    /// Kind of the motion, prismatic or revolute.
    pub kind: MotionKind,
    /// Motion while the end moves by the direction's twist, m or rad.
    pub motion: f64,
    /// Squared motion as a share of all squares, rotations at the natural length: 0 to 1.
    pub share: f64,
}

/// A principal direction of the (symmetric part of the) stiffness.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Direction {
    /// Free, finite, negative or rigid.
    pub kind: DirectionKind,
    /// Stiffness along it, N/m (rotations referred to the natural length); infinite if rigid.
    #[cfg_attr(feature = "schema", schemars(with = "Option<f64>"))]
    pub stiffness_n_per_m: f64,
    /// The motion, scaled so that its longest part (m, or rad times the natural length) is 1 m.
    pub twist: Twist,
    /// Participation for free and negative directions: joints and springs that move, the most first; those below 0.1 %
    /// are left out. Empty where limbs hang on platforms in between. [`crate::ChainStiffness::participation`] tells it
    /// of any motion.
    #[cfg_attr(feature = "serde", serde(default, rename = "behind"))]
    pub participation: Vec<Share>,
}

impl Direction {
    /// Kind, motion and what is behind it: `free: turns about z by q3`.
    #[must_use]
    pub fn description(&self) -> String {
        let motion = motion_description(&self.twist);
        let names: Vec<&str> = self.participation.iter().map(|s| s.name.as_str()).collect();
        let by = if names.is_empty() {
            String::new()
        } else {
            format!(" by {}", names.join(", "))
        };
        let stiffness = self.stiffness_n_per_m;
        match self.kind {
            DirectionKind::Free => format!("free: {motion}{by}"),
            DirectionKind::Rigid => format!("rigid: nothing {motion}"),
            DirectionKind::Finite => format!("finite, {} N/m: {motion}{by}", short(stiffness)),
            DirectionKind::Negative => format!("negative, {} N/m: {motion}{by}", short(stiffness)),
        }
    }
}

/// `moves along x`, `turns about z`, with place and advance where they are not zero.
pub(crate) fn motion_description(twist: &Twist) -> String {
    let (linear, angular) = (twist.linear(), twist.angular());
    let turning = angular.norm();
    if turning <= 1e-9 * linear.norm() {
        return format!("moves along {}", axis_description(&linear));
    }
    let axis = angular / turning;
    let advance = linear.dot(&axis) / turning;
    // Point of the axis nearest the reference point.
    let through = axis.cross(&linear) / turning;
    let mut words = format!("turns about {}", axis_description(&axis));
    let p = through.map(|x| if x.abs() < 5e-5 { 0.0 } else { x });
    if p.norm() > 0.0 {
        words += &format!(
            " on an axis [{:.4}, {:.4}, {:.4}] m from the end",
            p.x, p.y, p.z
        );
    }
    if advance.abs() >= 5e-5 {
        words += &format!(" and advances {advance:.4} m per rad");
    }
    words
}

pub(crate) fn axis_description(axis: &Vector3<f64>) -> String {
    let unit = axis.normalize();
    for (k, name) in ["x", "y", "z"].into_iter().enumerate() {
        if unit[k].abs() > 1.0 - 1e-6 {
            return name.into();
        }
    }
    let clean = unit.map(|x| if x.abs() < 5e-4 { 0.0 } else { x });
    format!("[{:.3}, {:.3}, {:.3}]", clean.x, clean.y, clean.z)
}

impl Share {
    /// The motion in metres, a rotation at the given natural length.
    pub(crate) fn size(&self, length: f64) -> f64 {
        match self.kind {
            MotionKind::Prismatic => self.motion,
            MotionKind::Revolute => self.motion * length,
        }
    }
}

/// Motion of the chain's coordinates (m, rad) as shares.
pub(crate) fn shares(chain: &Chain, prefix: &str, motion: &[f64]) -> Vec<Share> {
    let length = chain.scale().length;
    let named = chain.coordinates().iter().zip(motion);
    let mut list: Vec<Share> = named
        .map(|(coordinate, &motion)| Share {
            name: format!("{prefix}{}", coordinate.name),
            role: coordinate.role,
            kind: coordinate.kind,
            motion,
            share: 0.0,
        })
        .collect();
    let total: f64 = list.iter().map(|s| s.size(length).powi(2)).sum();
    for share in &mut list {
        share.share = share.size(length).powi(2) / total.max(f64::MIN_POSITIVE);
    }
    list
}

/// The largest shares of all that move, in falling order, adding up to one. Shares that rounding
/// alone tells apart stay in the order of the chain.
pub(crate) fn largest(mut list: Vec<Share>) -> Vec<Share> {
    list.retain(|s| s.share > 1e-3);
    let rounded = |s: &Share| (s.share * 1e9).round();
    list.sort_by(|a, b| rounded(b).total_cmp(&rounded(a)));
    list
}

/// Principal directions of a scaled stiffness within the motions that exist (`range`).
pub(crate) fn directions(
    scale: Scale,
    scaled: &Matrix6<f64>,
    range: &DMatrix<f64>,
) -> Vec<Direction> {
    let mut list = rigid_directions(scale, range);
    if range.ncols() == 0 {
        return list; // a chain that cannot move at all
    }
    let symmetric = 0.5 * (scaled + scaled.transpose());
    let within = range.transpose() * symmetric * range;
    let eigen = within.symmetric_eigen();
    let most = eigen.eigenvalues.amax();
    let mut order: Vec<usize> = (0..eigen.eigenvalues.len()).collect();
    order.sort_by(|&i, &j| eigen.eigenvalues[j].total_cmp(&eigen.eigenvalues[i]));
    for i in order {
        let value = eigen.eigenvalues[i];
        let (kind, stiffness) = if value.abs() <= 100.0 * RANK_TOLERANCE * most || most == 0.0 {
            (DirectionKind::Free, 0.0)
        } else if value > 0.0 {
            (DirectionKind::Finite, value * scale.stiffness)
        } else {
            (DirectionKind::Negative, value * scale.stiffness)
        };
        let motion = range * eigen.eigenvectors.column(i);
        list.push(direction(scale, kind, stiffness, &motion));
    }
    list
}

/// A direction of a scaled motion; its participation is not known yet.
pub(crate) fn direction(
    scale: Scale,
    kind: DirectionKind,
    stiffness_n_per_m: f64,
    motion: &DVector<f64>,
) -> Direction {
    Direction {
        kind,
        stiffness_n_per_m,
        twist: scaled_twist(scale, &Vector6::from_fn(|i, _| motion[i])),
        participation: Vec::new(),
    }
}

/// Motions outside the scaled `range`, which do not exist; with room for those inside.
pub(crate) fn rigid_directions(scale: Scale, range: &DMatrix<f64>) -> Vec<Direction> {
    let mut list = Vec::with_capacity(6);
    for column in complement(range).column_iter() {
        let motion = column.into_owned();
        list.push(direction(
            scale,
            DirectionKind::Rigid,
            f64::INFINITY,
            &motion,
        ));
    }
    list
}

/// A scaled motion as a twist whose longest part is 1 m.
pub(crate) fn scaled_twist(scale: Scale, scaled: &Vector6<f64>) -> Twist {
    let v = Vector6::from_fn(|i, _| {
        if i < 3 {
            scaled[i]
        } else {
            scaled[i] / scale.length
        }
    });
    let linear = v.fixed_rows::<3>(0).norm();
    let angular = v.fixed_rows::<3>(3).norm() * scale.length;
    Twist(v / linear.max(angular).max(f64::MIN_POSITIVE))
}

/// Several free directions are a space without a basis of its own: where single passive joints
/// (columns of the scaled Jacobian) span it, these are shown instead of eigenvectors.
pub(crate) fn free_by_joints(chain: &Chain, jacobian: &DMatrix<f64>, list: &mut [Direction]) {
    let scale = chain.scale();
    let unit = |i: usize| if i < 3 { 1.0 } else { scale.length };
    let free: Vec<usize> = (0..list.len())
        .filter(|&i| list[i].kind == DirectionKind::Free)
        .collect();
    if free.len() < 2 {
        return;
    }
    let columns: Vec<DVector<f64>> = free
        .iter()
        .map(|&i| DVector::from_fn(6, |k, _| list[i].twist.0[k] * unit(k)))
        .collect();
    let space = column_space(&DMatrix::from_columns(&columns));
    let mut chosen: Vec<DVector<f64>> = Vec::new();
    let mut taken = Vec::new();
    for joint in chain.indices_of(Role::Passive) {
        let column = jacobian.column(joint).into_owned();
        let norm = column.norm();
        let outside = (&column - &space * (space.transpose() * &column)).norm();
        let mut rest = column.clone();
        for other in &chosen {
            rest -= other * other.dot(&rest);
        }
        if norm == 0.0 || outside > 1e-8 * norm || rest.norm() <= 1e-6 * norm {
            continue;
        }
        chosen.push(rest.normalize());
        taken.push(scaled_twist(scale, &Vector6::from_fn(|k, _| column[k])));
        if taken.len() == free.len() {
            break;
        }
    }
    if taken.len() == free.len() {
        for (i, twist) in free.into_iter().zip(taken) {
            list[i].twist = twist;
        }
    }
}

/// Scaled Jacobian of the `n` coordinates, 6 x n.
pub fn scaled_jacobian(system: &System, scales: &[f64]) -> DMatrix<f64> {
    let n = system.spring_torque.len();
    DMatrix::from_fn(6, n, |i, j| {
        system.jacobian[(i, j)] * scales[i] * scales[6 + j]
    })
}

/// Basis of the coordinates' motions that move only passive joints and leave the tip where it is,
/// n x k, scaled.
pub(crate) fn passive_null_space(chain: &Chain, jacobian: &DMatrix<f64>) -> DMatrix<f64> {
    let passive = chain.indices_of(Role::Passive);
    let n = jacobian.ncols();
    if passive.is_empty() {
        return DMatrix::zeros(n, 0);
    }
    let own = jacobian.select_columns(&passive);
    if rows_certainly_independent(&own.transpose()) {
        return DMatrix::zeros(n, 0);
    }
    let rows = column_space(&own.transpose());
    if rows.ncols() == passive.len() {
        return DMatrix::zeros(n, 0);
    }
    let null = complement(&rows);
    let mut basis = DMatrix::zeros(n, null.ncols());
    for (k, &index) in passive.iter().enumerate() {
        basis.row_mut(index).copy_from(&null.row(k));
    }
    basis
}

/// Names of the coordinates with a share of at least a tenth in any column.
pub(crate) fn names_in(chain: &Chain, basis: &DMatrix<f64>) -> Vec<String> {
    (0..basis.nrows())
        .filter(|&i| basis.row(i).amax() > 0.1)
        .map(|i| chain.coordinates()[i].name.clone())
        .collect()
}
