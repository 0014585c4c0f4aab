//! Stiffness of a chain at its end, unloaded and loaded [R 3.7-3.13, 4.24-4.30].
//!
//! ```text
//! [K_C; K_Cq; K_Ctheta] = first block column of the inverse of
//! [0 J_q J_theta; J_q^T H_qq H_qtheta; J_theta^T H_thetaq H_thetatheta - K_theta]
//! ```
//!
//! The bordered form is used throughout: the closed form [R 4.28] needs inverses that do not exist
//! for, say, parallel last links. A Cartesian stiffness has four kinds of directions: free
//! (passive joints), finite, negative (under load) and rigid (motions that the chain cannot make,
//! whose stiffness is infinite).

use nalgebra::{DMatrix, Matrix6};

use crate::chain::directions::{
    Share, free_by_joints, largest, names_in, passive_null_space, scaled_jacobian, shares,
};
use crate::chain::graded::Graded;
use crate::chain::scaling::scales_of;
use crate::chain::sweep::stages::Sweep;
use crate::chain::system::{Hessian, System};
use crate::error::Result;
use crate::linalg::saddle::{Saddle, column_space};
use crate::model::chain::{Chain, Role};
use crate::number::larger;
use crate::spatial::{CartesianStiffness, Pose, Twist, Wrench};

pub(crate) use crate::chain::directions::{Direction, DirectionKind, directions};

/// Stiffness of a chain at its tip.
///
/// # Examples
///
/// ```
/// # use kinetostat::nalgebra::{Vector3, vector};
/// # use kinetostat::*;
/// # let slide = |axis, stiffness| ActuatorSpec::new(MotionKind::Prismatic, axis, stiffness);
/// let table = Chain::builder("table")
///     .actuator("long", slide(Vector3::x(), 8e7)) // N/m
///     .actuator("cross", slide(Vector3::y(), 2e7))
///     .passive("lift", MotionKind::Prismatic, Vector3::z(), 0.0)
///     .translation(vector![0.3, 0.1, 0.2])
///     .build()?;
/// let (at_rest, commands) = (table.home_coordinates(), table.home_commands());
/// let stiffness = unloaded_stiffness(&table, &Pose::identity(), &at_rest, &commands)?;
/// assert_eq!(stiffness.count(DirectionKind::Rigid), 3, "nothing turns it");
/// assert_eq!(stiffness.count(DirectionKind::Finite), 2);
/// assert_eq!(stiffness.count(DirectionKind::Free), 1);
/// assert!((stiffness.spread() - 8e7 / 2e7).abs() < 1e-9);
/// let text: Vec<String> = stiffness.directions.iter().map(Direction::description).collect();
/// assert_eq!(text[4], "finite, 20.0e6 N/m: moves along y");
/// assert_eq!(stiffness.directions[5].description(), "free: moves along z by lift");
/// // A motion of 3 mm and 4 mm takes the slides along as its components say.
/// let motion = Twist::new(vector![3e-3, 4e-3, 0.0], Vector3::zeros());
/// let shares = stiffness.participation(&table, &motion);
/// assert!((shares[0].motion - 3e-3).abs() < 1e-15 && (shares[0].share - 0.36).abs() < 1e-9);
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ChainStiffness {
    /// `K_C`, base axes, at the tip. Rigid directions contribute nothing to it: see `directions`.
    pub cartesian: CartesianStiffness,
    /// `K_Cq`, n_q x 6: motion of the passive joints per motion of the end (rad or m per m or rad).
    pub passive: DMatrix<f64>,
    /// `K_Ctheta`, n_theta x 6: motion of the springs per motion of the end.
    pub springs: DMatrix<f64>,
    /// Rank of `K_C` among the motions that the chain can make.
    pub rank: usize,
    /// Principal directions: rigid ones first, then by falling stiffness.
    pub directions: Vec<Direction>,
    /// Names of passive joints that can move although the end is held and nothing resists (a strut
    /// that spins about its own axis).
    pub redundant_passive: Vec<String>,
}

impl ChainStiffness {
    /// Largest stiffness of a principal direction over the smallest that is not zero; 1 where there
    /// are none. From about 1e9 on, the entries of `cartesian` hold the soft directions to fewer and
    /// fewer digits (none at 1e16); `directions` hold them all.
    #[must_use]
    pub fn spread(&self) -> f64 {
        crate::chain::graded::spread(&self.directions)
    }

    /// Number of directions of one kind.
    #[must_use]
    pub fn count(&self, kind: DirectionKind) -> usize {
        self.directions.iter().filter(|d| d.kind == kind).count()
    }

    /// Motions of passive joints and springs in the chain's order, when the end of `chain` (the one that this is the
    /// stiffness of) moves by a small twist (m, rad); none is omitted.
    #[must_use]
    pub fn participation(&self, chain: &Chain, twist: &Twist) -> Vec<Share> {
        self.participation_named(chain, "", twist)
    }

    /// Participation as by [`Self::participation`], with `prefix` in front of every name.
    pub(crate) fn participation_named(
        &self,
        chain: &Chain,
        prefix: &str,
        twist: &Twist,
    ) -> Vec<Share> {
        let mut motion = vec![0.0; chain.coordinate_count()];
        for (role, rows) in [
            (Role::Passive, &self.passive),
            (Role::Spring, &self.springs),
        ] {
            for (k, index) in chain.indices_of(role).into_iter().enumerate() {
                motion[index] = (rows.row(k) * twist.0)[0];
            }
        }
        shares(chain, prefix, &motion)
    }
}

/// Stiffness of the unloaded chain: springs at rest, no load [R 3.7].
///
/// `base` is the pose of the chain's base, `coordinates` and `commands` (m, rad) the posture.
///
/// # Errors
/// Lists of the wrong length or with numbers that are not finite.
///
/// ```
/// # use kinetostat::nalgebra::{Vector3, vector};
/// # use kinetostat::*;
/// # let hinge = |stiffness| ActuatorSpec::new(MotionKind::Revolute, Vector3::z(), stiffness);
/// # let chain = Chain::builder("column") // two bars of 0.5 m on springs of 100 N m/rad
/// #     .actuator("foot", hinge(100.0))
/// #     .translation(vector![0.5, 0.0, 0.0])
/// #     .actuator("middle", hinge(100.0))
/// #     .translation(vector![0.5, 0.0, 0.0])
/// #     .build()?;
/// let (x, commands) = (chain.home_coordinates(), chain.home_commands());
/// let stiffness = unloaded_stiffness(&chain, &Pose::identity(), &x, &commands)?;
/// assert_eq!(stiffness.rank, 2, "two springs; nothing moves in the other four directions");
/// # Ok::<(), Error>(())
/// ```
pub fn unloaded_stiffness(
    chain: &Chain,
    base: &Pose,
    coordinates: &[f64],
    commands: &[f64],
) -> Result<ChainStiffness> {
    chain.check(coordinates, commands)?;
    let place = chain.place();
    crate::model::limits::check_pose(&place, "the pose of the base", base)?;
    let scales = scales_of(chain, coordinates);
    let mut system = System::of_chain(chain, base, coordinates, commands, &scales, None);
    loop {
        system.evaluate(
            chain,
            base,
            coordinates,
            commands,
            &[],
            coordinates,
            &Wrench::zero(),
            0.0,
        );
        let Some(sweep) = &system.sweep else {
            return Ok(chain_stiffness(chain, &system, &scales, None));
        };
        if let Some(stiffness) = swept_stiffness(chain, &system, sweep, &scales, None) {
            return Ok(stiffness);
        }
        system.make_dense();
    }
}

/// `solved` is the solution of the bordered system for unit motions of the tip, (6 + n) x 6, where
/// the caller has it already.
pub fn chain_stiffness(
    chain: &Chain,
    system: &System,
    scales: &[f64],
    solved: Option<DMatrix<f64>>,
) -> ChainStiffness {
    let jacobian = scaled_jacobian(system, scales);
    let redundant = passive_null_space(chain, &jacobian);
    if let Some(end) = Graded::of(chain, system, scales, &jacobian) {
        let list = end.directions(chain);
        return described(chain, &jacobian, &redundant, &end.answer, list);
    }
    let (range, answer) = match solved {
        Some(solution) if column_space(&jacobian).ncols() == 6 => {
            (DMatrix::identity(6, 6), solution)
        }
        _ => evenly_stiff_motions(chain, system, scales, &jacobian),
    };
    let list = directions(chain.scale(), &scaled_stiffness(scales, &answer), &range);
    described(chain, &jacobian, &redundant, &answer, list)
}

fn scaled_stiffness(scales: &[f64], answer: &DMatrix<f64>) -> Matrix6<f64> {
    Matrix6::from_fn(|i, j| answer[(i, j)] / (scales[i] * scales[j]))
}

/// Possible motions of the end (orthonormal, scaled, 6 x r), and wrench and coordinates per unit motion of it, (6 + n)
/// x 6.
pub(crate) fn motions_of_end(
    chain: &Chain,
    system: &System,
    scales: &[f64],
    jacobian: &DMatrix<f64>,
) -> (DMatrix<f64>, DMatrix<f64>) {
    match Graded::of(chain, system, scales, jacobian) {
        Some(end) => (end.range, end.answer),
        None => evenly_stiff_motions(chain, system, scales, jacobian),
    }
}

/// Motions of the end where no direction is much stiffer than others by its springs. A direction so stiff that all
/// others would drown in its rounding (a chain pulled straight) counts as rigid.
fn evenly_stiff_motions(
    chain: &Chain,
    system: &System,
    scales: &[f64],
    jacobian: &DMatrix<f64>,
) -> (DMatrix<f64>, DMatrix<f64>) {
    let range = column_space(jacobian);
    let answer = unit_motions(system, scales, jacobian, &range);
    if range.ncols() < 2 {
        return (range, answer);
    }
    // The direction that the joints move least in.
    let moved = range.transpose() * jacobian;
    let sizes: Vec<f64> = moved.row_iter().map(|row| row.norm()).collect();
    let most = sizes.iter().fold(0.0_f64, |m, x| larger(m, *x));
    let Some((weakest, size)) =
        (sizes.iter().copied().enumerate()).min_by(|a, b| a.1.total_cmp(&b.1))
    else {
        return (range, answer);
    };
    if size > STRAIGHT * most {
        return (range, answer);
    }
    let free = |range: &DMatrix<f64>, answer: &DMatrix<f64>| {
        let list = directions(chain.scale(), &scaled_stiffness(scales, answer), range);
        let free = list.iter().filter(|d| d.kind == DirectionKind::Free);
        free.count()
    };
    let others = range.clone().remove_column(weakest);
    let without = unit_motions(system, scales, jacobian, &others);
    if free(&others, &without) < free(&range, &answer) {
        (others, without)
    } else {
        (range, answer)
    }
}

/// Joints that move the end less than this share of their largest motion make it nearly rigid.
const STRAIGHT: f64 = 1e-3;

/// Stiffness by sweeps along a long chain; `None` where they cannot. `solved` are wrench and coordinates per unit
/// motion of the tip, (6 + n) x 6, if the caller has them already.
pub fn swept_stiffness(
    chain: &Chain,
    system: &System,
    sweep: &Sweep,
    scales: &[f64],
    solved: Option<&DMatrix<f64>>,
) -> Option<ChainStiffness> {
    let jacobian = scaled_jacobian(system, scales);
    let redundant = passive_null_space(chain, &jacobian);
    if redundant.ncols() > 0 {
        return None;
    }
    let turned = sweep.by_spring_roots(&jacobian);
    if Graded::uneven(&turned) {
        let end = Graded::swept(sweep, scales, &turned)?;
        let list = end.directions(chain);
        return Some(described(chain, &jacobian, &redundant, &end.answer, list));
    }
    let range = column_space(&jacobian);
    let answer = match solved {
        Some(solved) => solved.clone(),
        None => {
            let scaled = crate::chain::sweep::solve::unit_motions(sweep, &range)?;
            DMatrix::from_fn(scales.len(), 6, |i, j| {
                scaled[(i, j)] * scales[i] * scales[j]
            })
        }
    };
    let list = directions(chain.scale(), &scaled_stiffness(scales, &answer), &range);
    Some(described(chain, &jacobian, &redundant, &answer, list))
}

/// Describes the stiffness by wrench and coordinates per unit motion of the tip, (6 + n) x 6.
fn described(
    chain: &Chain,
    jacobian: &DMatrix<f64>,
    redundant: &DMatrix<f64>,
    answer: &DMatrix<f64>,
    mut directions: Vec<Direction>,
) -> ChainStiffness {
    free_by_joints(chain, jacobian, &mut directions);
    let rank = directions
        .iter()
        .filter(|d| matches!(d.kind, DirectionKind::Finite | DirectionKind::Negative))
        .count();
    let rows = |role| {
        let indices = chain.indices_of(role);
        DMatrix::from_fn(indices.len(), 6, |k, j| answer[(6 + indices[k], j)])
    };
    let mut stiffness = ChainStiffness {
        cartesian: CartesianStiffness {
            matrix: answer.fixed_view::<6, 6>(0, 0).into_owned(),
        },
        passive: rows(Role::Passive),
        springs: rows(Role::Spring),
        rank,
        directions: Vec::new(),
        redundant_passive: names_in(chain, redundant),
    };
    for direction in &mut directions {
        if matches!(
            direction.kind,
            DirectionKind::Free | DirectionKind::Negative
        ) {
            direction.participation = largest(stiffness.participation(chain, &direction.twist));
        }
    }
    stiffness.directions = directions;
    stiffness
}

/// Wrench and coordinates per unit motion of the tip, (6 + n) x 6, over the motions that the chain
/// can make: the bordered system with its first rows restricted to the Jacobian's range.
fn unit_motions(
    system: &System,
    scales: &[f64],
    jacobian: &DMatrix<f64>,
    range: &DMatrix<f64>,
) -> DMatrix<f64> {
    let (n, r) = (jacobian.ncols(), range.ncols());
    let bordered = system.bordered(Hessian::Kept);
    // Rows of unit length and torques of size one: where the joints hardly move the end (a chain
    // pulled straight) its stiffness is large, but nothing of it is lost.
    let mut reduced = range.transpose() * jacobian;
    let rows: Vec<f64> = reduced
        .row_iter()
        .map(|row| 1.0 / row.norm().max(f64::MIN_POSITIVE))
        .collect();
    for (mut row, unit) in reduced.row_iter_mut().zip(&rows) {
        row *= *unit;
    }
    let torques = DMatrix::from_fn(n, n, |i, j| {
        bordered[(6 + i, 6 + j)] * scales[6 + i] * scales[6 + j]
    });
    let size = match torques.amax() {
        most if most > 0.0 => most,
        _ => 1.0,
    };
    let mut a = DMatrix::zeros(r + n, r + n);
    a.view_mut((0, r), (r, n)).copy_from(&reduced);
    a.view_mut((r, 0), (n, r)).copy_from(&reduced.transpose());
    a.view_mut((r, r), (n, n)).copy_from(&(torques / size));
    let mut b = DMatrix::zeros(r + n, 6);
    b.view_mut((0, 0), (r, 6)).copy_from(&range.transpose());
    for (i, unit) in rows.iter().enumerate() {
        b.row_mut(i).scale_mut(*unit);
    }
    let ones = vec![1.0; r + n];
    Saddle::new(a, &ones, &ones).solve(&mut b);
    for (i, unit) in rows.iter().enumerate() {
        b.row_mut(i).scale_mut(*unit * size);
    }
    let wrench = range * b.rows(0, r);
    DMatrix::from_fn(6 + n, 6, |i, j| {
        let scaled = if i < 6 {
            wrench[(i, j)]
        } else {
            b[(r + i - 6, j)]
        };
        scaled * scales[i] * scales[j]
    })
}
