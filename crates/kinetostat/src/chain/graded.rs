//! Stiffnesses of very different size in one chain (a steel wire: stiff along, soft across).
//!
//! `K = U S^-1 G S^-1 U^T` with the singular values `S` of the Jacobian, whose coordinates are measured so
//! that every spring block is one: they are the roots of compliances, and `G` is about one whatever the
//! springs are (exactly one without passive joints). Ranks are decided on `G`, values are squares of
//! singular values, so that stiffnesses of a ratio of 1e14 keep eight digits.

use nalgebra::{DMatrix, DVector, Vector6};

use crate::chain::directions::{Direction, DirectionKind, direction, rigid_directions};
use crate::chain::scaling::disparate;
use crate::chain::sweep::factor::STEP_SPRINGS;
use crate::chain::sweep::solve::{Bordered, EndRows};
use crate::chain::sweep::stages::{Form, Sweep};
use crate::chain::system::{Hessian, System};
use crate::linalg::saddle::{RANK_TOLERANCE, Saddle};
use crate::linalg::singular_values::SingularValues;
use crate::model::chain::{Chain, Scale};
use crate::model::mechanism::Mechanism;
use crate::model::springs::block::scaled;
use crate::number::{larger, short, smaller};

/// Roots of compliances that differ by more than this (stiffnesses by its square) are taken apart.
const UNEVEN: f64 = 1e3;

/// Motions of a chain's end sorted by how stiff they are.
pub(crate) struct Graded {
    /// `U`, orthonormal, scaled, 6 x r.
    pub range: DMatrix<f64>,
    /// Wrench and coordinates per unit motion of the tip, (6 + n) x 6.
    pub answer: DMatrix<f64>,
    sizes: Vec<f64>,
    /// `G`.
    inner: DMatrix<f64>,
}

impl Graded {
    /// True if the end moves much more easily in some directions than in others.
    pub fn uneven(jacobian: &DMatrix<f64>) -> bool {
        // A cheap test first: the norms of a triangle and its inverse bound the singular values. Pivots alone
        // do not: one soft direction that leans towards two others can hide among them.
        let gram = jacobian * jacobian.transpose();
        if let Some(c) = gram.cholesky() {
            let root = c.l();
            let mut inverse = DMatrix::identity(root.nrows(), root.nrows());
            let solved = root.solve_lower_triangular_mut(&mut inverse);
            if solved && root.norm() * inverse.norm() < UNEVEN {
                return false;
            }
        }
        let own = SingularValues::of(jacobian);
        let rank = own.rank(RANK_TOLERANCE);
        rank > 1 && own.values[0] > UNEVEN * own.values[rank - 1]
    }

    /// `None` where stiffnesses of springs and of the end are of similar size: nothing is lost there in any way.
    pub fn of(
        chain: &Chain,
        system: &System,
        scales: &[f64],
        jacobian: &DMatrix<f64>,
    ) -> Option<Self> {
        let n = jacobian.ncols();
        // Springs' own stiffness only: with what loads take from it a block may not be positive definite.
        let units = MaterialUnits::of(chain, &material_springs(system, scales));
        let mut turned = jacobian.transpose();
        units.gather(&mut turned);
        let turned = turned.transpose();
        if !disparate(scales, chain) && !Self::uneven(&turned) {
            return None;
        }
        let own = SingularValues::of(&turned);
        let r = own.rank(RANK_TOLERANCE);
        let right = own.right.columns(0, r);
        let bordered = system.bordered(Hessian::Kept);
        let torques = DMatrix::from_fn(n, n, |i, j| {
            bordered[(6 + i, 6 + j)] * scales[6 + i] * scales[6 + j]
        });
        let torques = units.both(torques);
        let size = match torques.amax() {
            most if most > 0.0 => most,
            _ => 1.0,
        };
        let mut a = DMatrix::zeros(r + n, r + n);
        a.view_mut((0, r), (r, n)).copy_from(&right.transpose());
        a.view_mut((r, 0), (n, r)).copy_from(&right);
        a.view_mut((r, r), (n, n)).copy_from(&(torques / size));
        let mut b = DMatrix::identity(r + n, r);
        let ones = vec![1.0; r + n];
        Saddle::new(a, &ones, &ones).solve(&mut b);
        let inner = b.rows(0, r) * size;
        let moved = units.motions(b.rows(r, n).into_owned());
        Some(Self::from_motions(scales, &own, r, inner, &moved))
    }

    /// Grades a long chain by sweeps, `turned` by [`Sweep::by_spring_roots`]; `None` where they lose a pivot.
    pub fn swept(sweep: &Sweep, scales: &[f64], turned: &DMatrix<f64>) -> Option<Self> {
        let n = turned.ncols();
        let own = SingularValues::of(turned);
        let r = own.rank(RANK_TOLERANCE);
        let range = own.left.columns(0, r).into_owned();
        let rows = EndRows::held(&range);
        STEP_SPRINGS.into_iter().find_map(|spring| {
            let bordered = Bordered::new(sweep, Form::Exact, rows, spring)?;
            let (mut inner, mut moved) = (DMatrix::zeros(r, r), DMatrix::zeros(n, r));
            for j in 0..r {
                // The tip goes as far as it yields.
                let right = Vector6::from_fn(|i, _| if i == j { own.values[j] } else { 0.0 });
                let (wrench, x) = bordered.solve(&vec![0.0; n], &right)?;
                for i in 0..r {
                    inner[(i, j)] = own.values[i] * range.column(i).dot(&wrench);
                }
                moved.column_mut(j).copy_from_slice(&x);
            }
            Some(Self::from_motions(scales, &own, r, inner, &moved))
        })
    }

    /// Grades by `G` and the coordinates (scaled, n x r) while the tip moves by `U S`.
    fn from_motions(
        scales: &[f64],
        own: &SingularValues,
        r: usize,
        inner: DMatrix<f64>,
        moved: &DMatrix<f64>,
    ) -> Self {
        let range = own.left.columns(0, r).into_owned();
        let mut back = range.transpose();
        for (mut row, value) in back.row_iter_mut().zip(&own.values) {
            row.unscale_mut(*value);
        }
        let wrench = back.transpose() * &inner * &back;
        let moved = moved * &back;
        let answer = DMatrix::from_fn(6 + moved.nrows(), 6, |i, j| {
            let scaled = match i < 6 {
                true => wrench[(i, j)],
                false => moved[(i - 6, j)],
            };
            scaled * scales[i] * scales[j]
        });
        Self {
            range,
            answer,
            sizes: own.values[..r].to_vec(),
            inner,
        }
    }

    /// Principal directions.
    pub fn directions(&self, chain: &Chain) -> Vec<Direction> {
        let scale = chain.scale();
        let inner = 0.5 * (&self.inner + self.inner.transpose());
        let eigen = inner.clone().symmetric_eigen();
        let most = eigen.eigenvalues.amax();
        let zero = 100.0 * RANK_TOLERANCE * most;
        if eigen.eigenvalues.min() < -zero {
            let sizes = DVector::from_iterator(self.sizes.len(), self.sizes.iter().copied());
            let back = DMatrix::from_diagonal(&sizes.map(f64::recip));
            return principal(scale, &back, &inner, &self.range);
        }
        let held: Vec<usize> = (0..self.sizes.len())
            .filter(|&i| eigen.eigenvalues[i] > zero)
            .collect();
        let root = DMatrix::from_fn(held.len(), self.sizes.len(), |i, j| {
            let value = eigen.eigenvalues[held[i]].sqrt();
            value * eigen.eigenvectors[(j, held[i])] / self.sizes[j]
        });
        by_root(scale, &root, &self.range, held.len())
    }
}

/// Principal stiffnesses below this share of the stiffest are computed again without the stiffer ones.
const LEVEL: f64 = 1e-4;

/// Principal directions of `back^T inner back` (scaled, in coordinates of the range).
pub(crate) fn principal(
    scale: Scale,
    back: &DMatrix<f64>,
    inner: &DMatrix<f64>,
    range: &DMatrix<f64>,
) -> Vec<Direction> {
    if *inner == DMatrix::identity(back.nrows(), back.nrows()) {
        let rank = SingularValues::of(back).rank(RANK_TOLERANCE);
        return by_root(scale, back, range, rank);
    }
    let mut list = rigid_directions(scale, range);
    list.extend(levels(back, inner).into_iter().map(|(value, motion)| {
        let kind = match value {
            v if v > 0.0 => DirectionKind::Finite,
            v if v < 0.0 => DirectionKind::Negative,
            _ => DirectionKind::Free,
        };
        direction(scale, kind, value * scale.stiffness, &(range * motion))
    }));
    list
}

/// Eigenvalues and eigenvectors of `back^T inner back`, which may be negative: the stiffest first, then the others
/// in what is left, where the stiff ones no longer drown them. Where nothing is left but rounding, they are zero.
pub(crate) fn levels(back: &DMatrix<f64>, inner: &DMatrix<f64>) -> Vec<(f64, DVector<f64>)> {
    let mut found: Vec<(f64, DVector<f64>)> = Vec::new();
    let mut rest = DMatrix::identity(back.ncols(), back.ncols());
    while rest.ncols() > 0 {
        let moved = back * &rest;
        let eigen = (moved.transpose() * inner * &moved).symmetric_eigen();
        let most = eigen.eigenvalues.amax();
        let parts = inner.amax() * moved.norm_squared();
        if moved.norm() <= RANK_TOLERANCE * back.norm() || most <= 100.0 * RANK_TOLERANCE * parts {
            found.extend(rest.column_iter().map(|motion| (0.0, motion.into_owned())));
            break;
        }
        let motions = rest * &eigen.eigenvectors;
        let (now, later): (Vec<usize>, Vec<usize>) =
            (0..motions.ncols()).partition(|&i| eigen.eigenvalues[i].abs() > LEVEL * most);
        found.extend(
            now.iter()
                .map(|&i| (eigen.eigenvalues[i], motions.column(i).into_owned())),
        );
        rest = motions.select_columns(&later);
    }
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    found
}

/// Principal directions of `root^T root` (scaled) within a range; `rank` of them are not free.
fn by_root(scale: Scale, root: &DMatrix<f64>, range: &DMatrix<f64>, rank: usize) -> Vec<Direction> {
    let mut list = rigid_directions(scale, range);
    let own = SingularValues::of(root);
    for (i, column) in own.all_right().column_iter().enumerate() {
        let motion = range * column;
        list.push(match own.values.get(i).filter(|_| i < rank) {
            Some(value) => direction(
                scale,
                DirectionKind::Finite,
                value * value * scale.stiffness,
                &motion,
            ),
            None => direction(scale, DirectionKind::Free, 0.0, &motion),
        });
    }
    list
}

/// Largest stiffness over the smallest that is not zero; 1 where there are none.
pub(crate) fn spread(list: &[Direction]) -> f64 {
    let finite = list.iter().map(|d| d.stiffness_n_per_m.abs());
    let finite = finite.filter(|k| k.is_finite() && *k > 0.0);
    let (most, least) = finite.fold((0.0_f64, f64::INFINITY), |(m, l), k| {
        (larger(m, k), smaller(l, k))
    });
    if most > 0.0 { most / least } else { 1.0 }
}

/// Stiffnesses of principal directions that differ by more lose digits in a 6 x 6 matrix.
const SAID: f64 = 1e9;

/// Warns of very different principal stiffnesses in a 6 x 6 matrix, in a sentence; `None` where they differ by less
/// than 1e9.
#[must_use]
pub fn uneven_stiffness(directions: &[Direction]) -> Option<String> {
    let spread = spread(directions);
    (spread > SAID).then(|| {
        let digits = (15.0 - spread.log10()).floor().max(0.0);
        format!(
            "the stiffest direction is {} times as stiff as the softest: the entries of the 6 x 6 matrix hold the soft ones to about {digits} digits only, the principal directions hold them all. Is the stiff one meant, or is a unit wrong?",
            short(spread)
        )
    })
}

/// Share of the softest motion of a spring's matrix, in units in which its diagonal is one, below which
/// numbers of 16 digits hold it to fewer than nine.
const COUPLED: f64 = 1e-7;

/// Warns of springs whose matrix couples stiff motions so closely that the soft one among them is lost in rounding, a
/// sentence for each. A diagonal matrix has no such motion, however different its entries are.
#[must_use]
pub fn uneven_springs(mechanism: &Mechanism) -> Vec<String> {
    let limbs = mechanism.limbs().iter();
    let blocks = limbs.flat_map(|l| l.actual.springs().iter().map(move |b| (l, b)));
    blocks
        .filter_map(|(limb, block)| {
            let k = block.stiffness_at(&limb.actual.home_coordinates());
            let least = scaled(&k).symmetric_eigenvalues().min();
            let digits = (16.0 + least.log10()).floor().max(0.0);
            (least < COUPLED).then(|| {
                format!(
                    "limb '{}', spring '{}': its matrix couples stiff motions, and the softest motion among them has {least:.1e} of their stiffness: numbers of 16 digits hold that one to about {digits} digits only. Give the spring in its principal axes (a rotation before it, the inverse one after it), where its matrix is diagonal, or as single springs",
                    limb.name, block.name
                )
            })
        })
        .collect()
}

/// Signs `s_i` and rows `r_i` with `K = sum s_i r_i r_i^T` (SI) of principal directions.
pub(crate) fn root_rows(list: &[Direction], length: f64) -> Vec<(f64, Vector6<f64>)> {
    let unit = |i: usize| if i < 3 { 1.0 } else { length };
    let finite = list
        .iter()
        .filter(|d| matches!(d.kind, DirectionKind::Finite | DirectionKind::Negative));
    finite
        .map(|d| {
            let scaled = Vector6::from_fn(|i, _| d.twist.0[i] * unit(i));
            let size = d.stiffness_n_per_m.abs().sqrt() / scaled.norm();
            let row = Vector6::from_fn(|i, _| scaled[i] * unit(i) * size);
            (d.stiffness_n_per_m.signum(), row)
        })
        .collect()
}

/// The springs' own stiffness, without what their loads add to it as they move (geometric), scaled, n x n.
pub(crate) fn material_springs(system: &System, scales: &[f64]) -> DMatrix<f64> {
    let n = system.spring_torque.len();
    let mut springs = DMatrix::from_fn(n, n, |i, j| {
        system.spring_tangent[(i, j)] * scales[6 + i] * scales[6 + j]
    });
    without_geometric(system, scales, &mut springs);
    springs
}

/// Takes the geometric stiffness of springs out of a scaled matrix, n x n.
pub(crate) fn without_geometric(system: &System, scales: &[f64], a: &mut DMatrix<f64>) {
    for &(first, matrix) in &system.spring_geometric {
        for i in 0..6 {
            for j in 0..6 {
                let (row, column) = (first + i, first + j);
                a[(row, column)] -= matrix[(i, j)] * scales[6 + row] * scales[6 + column];
            }
        }
    }
}

/// `C A C^T` of a change of rows `C`.
pub(crate) fn on_both_sides(
    mut a: DMatrix<f64>,
    of_rows: impl Fn(&mut DMatrix<f64>),
) -> DMatrix<f64> {
    for _ in 0..2 {
        of_rows(&mut a);
        a = a.transpose();
    }
    a
}

/// Units in which the material stiffness `K' = L L^T` of every spring is one: an axis that is worlds
/// stiffer than bending would otherwise drown it. Passive coordinates keep theirs.
pub(crate) struct MaterialUnits(Vec<(usize, DMatrix<f64>)>);

impl MaterialUnits {
    /// A block that is not positive definite keeps its units.
    pub fn of(chain: &Chain, springs: &DMatrix<f64>) -> Self {
        let blocks = chain.springs().iter().filter_map(|block| {
            let (first, len) = (block.first, block.len());
            let own = springs.view((first, first), (len, len)).into_owned();
            Some((first, own.cholesky()?.l()))
        });
        Self(blocks.collect())
    }

    /// Forces of the coordinates, one column each, in these units: `L^-1 f`.
    pub fn gather(&self, forces: &mut DMatrix<f64>) {
        for (first, l) in &self.0 {
            // A pivot of a Cholesky factor is positive.
            let _ = l.solve_lower_triangular_mut(&mut forces.rows_mut(*first, l.nrows()));
        }
    }

    /// A stiffness in these units: `L^-1 K L^-T`.
    pub fn both(&self, stiffness: DMatrix<f64>) -> DMatrix<f64> {
        on_both_sides(stiffness, |rows| self.gather(rows))
    }

    /// The material stiffness itself: one, but for the blocks that keep their units.
    pub fn stiffness(&self, mut springs: DMatrix<f64>) -> DMatrix<f64> {
        for (first, l) in &self.0 {
            let size = (l.nrows(), l.nrows());
            springs
                .view_mut((*first, *first), size)
                .fill_with_identity();
        }
        springs
    }

    /// Motions in these units, one column each, as those of the coordinates: `L^-T y`.
    pub fn motions(&self, mut motions: DMatrix<f64>) -> DMatrix<f64> {
        for (first, l) in &self.0 {
            let _ = l.tr_solve_lower_triangular_mut(&mut motions.rows_mut(*first, l.nrows()));
        }
        motions
    }
}
