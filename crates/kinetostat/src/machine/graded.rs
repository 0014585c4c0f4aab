//! Stiffnesses of very different size in a machine: its platforms' stiffness by rows of its limbs, and of the loads that turn with
//! them.
//!
//! `K = B^T D B` over the motions of all moving platforms: every principal stiffness of a limb is a row of `B`
//! (its root) and a sign in `D`; what loads add as their arms turn is a block of its own, of their size. No
//! stiffness is added to another, so that the stiff ones do not drown the soft ones. Other platforms are
//! eliminated by Householder reflections of the rows, the long ones first, which err by a share of each row only
//! (A. J. Cox and N. J. Higham, "Stability of Householder QR factorization for weighted least squares", 1998):
//! with `Q^T B = [R *; 0 C]`, `K_tool = C^T (D22 - D21 D11^-1 D12) C` where `D` is that of `Q`.

use nalgebra::{DMatrix, DVector, Matrix3, Matrix6};

use crate::chain::graded::{levels, principal, root_rows, spread};
use crate::chain::stiffness::{ChainStiffness, Direction};
use crate::linalg::complement::complement;
use crate::linalg::saddle::{RANK_TOLERANCE, Saddle, independent_columns};
use crate::linalg::sparse::Sparse;
use crate::machine::network::{Ends, ends};
use crate::machine::platform_system::motion_units;
use crate::machine::platforms::solver::PlatformSolver;
use crate::model::chain::Scale;
use crate::model::loads::load::Load;
use crate::spatial::hat;

/// Stiffnesses of limbs that differ by more are kept apart when limbs are added.
const UNEVEN: f64 = 1e6;

/// Number of platforms above which only stiffnesses that differ by more than [`UNEVEN_OF_MANY`] are kept apart: rows of
/// all limbs cost the cube of the number of platforms (a minute and more for 240), and legs under load have a stiffness
/// of `F/L` across them that a platform on six legs does not feel.
const MANY: usize = 12;

/// Leaves four digits of the soft ones in a sum.
const UNEVEN_OF_MANY: f64 = 1e11;

/// Stiffness of all moving platforms, scaled.
pub(crate) struct GradedPlatforms {
    scale: Scale,
    /// Signs and rows over the motions of all moving platforms.
    rows: Vec<(f64, DVector<f64>)>,
    /// Stiffness that no limb has by itself, 6P x 6P.
    more: DMatrix<f64>,
}

/// `K = B^T D B` in coordinates of some motions.
struct Parts {
    back: DMatrix<f64>,
    inner: DMatrix<f64>,
}

impl GradedPlatforms {
    /// Grades limbs with their natural sizes and ends; `None` where their stiffnesses are of similar size.
    pub fn of<'a>(
        scale: Scale,
        moving: usize,
        limbs: impl Iterator<Item = (&'a ChainStiffness, Scale, &'a Ends)> + Clone,
    ) -> Option<Self> {
        let even = match moving <= MANY {
            // Limbs in series become softer with the cube of their number, and no less stiff along their axes.
            true => UNEVEN / moving.pow(3) as f64,
            false => UNEVEN_OF_MANY,
        };
        if !limbs
            .clone()
            .any(|(limb, ..)| spread(&limb.directions) > even)
        {
            return None;
        }
        let units = DVector::from_vec(motion_units(6 * moving, scale));
        let mut rows = Vec::new();
        for (limb, own, ends) in limbs {
            let motion = ends.matrix(moving).transpose();
            let of_limb = root_rows(&limb.directions, own.length).into_iter();
            rows.extend(of_limb.map(|(sign, row)| (sign, (&motion * row).component_mul(&units))));
        }
        let more = DMatrix::zeros(6 * moving, 6 * moving);
        Some(Self { scale, rows, more })
    }

    /// Adds a stiffness (SI) that is not in the limbs' own.
    pub fn with(mut self, more: &Sparse) -> Self {
        let units = motion_units(self.more.nrows(), self.scale);
        for &(i, j, value) in &more.entries {
            let half = 0.5 * value * units[i] * units[j];
            self.more[(i, j)] += half;
            self.more[(j, i)] += half;
        }
        self
    }

    /// Expresses the stiffness in coordinates of the columns of `basis`, the longest rows first.
    fn among(&self, basis: &DMatrix<f64>) -> Parts {
        let r = basis.ncols();
        let more = basis.transpose() * &self.more * basis;
        let size = more.amax();
        let own = self
            .rows
            .iter()
            .map(|(sign, row)| (*sign, row.tr_mul(basis)));
        let mut own: Vec<_> = own.map(|(sign, row)| (sign, row.norm(), row)).collect();
        own.sort_by(|a, b| b.1.total_cmp(&a.1));
        // Rows of the loads' size, each along one coordinate, are behind all longer ones.
        let root = size.sqrt();
        let first = own.iter().take_while(|row| row.1 >= root).count();
        let extra = if size > 0.0 { r } else { 0 };
        let place = |i: usize| if i < first { i } else { i + extra };
        let count = own.len() + extra;
        let (mut back, mut inner) = (DMatrix::zeros(count, r), DMatrix::zeros(count, count));
        for (i, (sign, _, row)) in own.iter().enumerate() {
            back.row_mut(place(i)).copy_from(row);
            inner[(place(i), place(i))] = *sign;
        }
        if extra > 0 {
            back.view_mut((first, 0), (r, r)).fill_diagonal(root);
            let mut block = inner.view_mut((first, first), (r, r));
            block.copy_from(&(more / size));
        }
        Parts { back, inner }
    }

    /// Principal directions of the tool of a machine without other platforms, within a scaled range.
    pub fn directions(&self, range: &DMatrix<f64>) -> Vec<Direction> {
        let Parts { back, inner } = self.among(range);
        principal(self.scale, &back, &inner, range)
    }

    /// True if no motion has a negative stiffness, among the columns of `possible` (all, if `None`) over the platforms
    /// that are not `held`.
    pub fn hold(&self, possible: Option<&DMatrix<f64>>, held: Option<usize>) -> bool {
        let size = self.more.nrows();
        let kept: Vec<usize> = (0..size).filter(|i| Some(i / 6) != held).collect();
        let unit = DMatrix::identity(size, size).select_columns(&kept);
        let Parts { back, inner } = match possible {
            Some(possible) => self.among(&(unit * possible)),
            None => self.among(&unit),
        };
        levels(&back, &inner).iter().all(|(value, _)| *value >= 0.0)
    }

    /// One platform with all others free, among the columns of `possible` (all motions, if `None`): its
    /// stiffness, SI, and principal directions.
    pub fn condensed(
        &self,
        possible: Option<&DMatrix<f64>>,
        platform: usize,
    ) -> (Matrix6<f64>, Vec<Direction>) {
        let size = self.more.nrows();
        let own: Vec<usize> = (6 * platform..6 * platform + 6).collect();
        let unit = DMatrix::identity(size, size);
        let possible = possible.unwrap_or(&unit);
        let part = possible.select_rows(&own);
        let range = match possible.ncols() {
            0 => DMatrix::zeros(6, 0),
            _ => independent_columns(&part),
        };
        let r = range.ncols();
        let followed = (range.transpose() * part).transpose();
        let along = match r {
            0 => followed.clone(),
            // A motion of all platforms for each of the one.
            _ => {
                &followed
                    * (followed.tr_mul(&followed))
                        .try_inverse()
                        .unwrap_or_default()
            }
        };
        let aside = match r {
            0 => DMatrix::identity(possible.ncols(), possible.ncols()),
            _ => complement(&independent_columns(&followed)),
        };
        let mut basis = DMatrix::zeros(size, aside.ncols() + r);
        basis
            .columns_mut(0, aside.ncols())
            .copy_from(&(possible * &aside));
        basis
            .columns_mut(aside.ncols(), r)
            .copy_from(&(possible * &along));
        let Parts { back, inner } = self.among(&basis).without(aside.ncols());
        let directions = principal(self.scale, &back, &inner, &range);
        (matrix_of(&directions, self.scale), directions)
    }
}

impl Parts {
    /// Eliminates the first coordinates, which are free to move.
    fn without(self, first: usize) -> Self {
        let (count, columns) = self.back.shape();
        if first == 0 || count == 0 {
            return Self {
                back: self.back.columns(first, columns - first).into_owned(),
                inner: self.inner,
            };
        }
        let qr = self.back.columns(0, first).into_owned().col_piv_qr();
        let diagonal = qr.r().diagonal().abs();
        let rank = diagonal
            .iter()
            .take_while(|d| **d > RANK_TOLERANCE * diagonal[0])
            .count();
        let mut back = self.back.columns(first, columns - first).into_owned();
        qr.q_tr_mul(&mut back);
        let mut inner = self.inner;
        if inner != DMatrix::identity(count, count) {
            qr.q_tr_mul(&mut inner);
            inner.transpose_mut();
            qr.q_tr_mul(&mut inner);
        }
        let rest = count - rank;
        let kept = inner.view((rank, rank), (rest, rest)).into_owned();
        let coupled = inner.view((0, rank), (rank, rest)).into_owned();
        let kept = if coupled.amax() > 0.0 {
            let ones = vec![1.0; rank];
            let mut answer = coupled.clone();
            let own = inner.view((0, 0), (rank, rank)).into_owned();
            Saddle::new(own, &ones, &ones).solve(&mut answer);
            kept - coupled.transpose() * answer
        } else {
            kept
        };
        Self {
            back: back.rows(rank, rest).into_owned(),
            inner: kept,
        }
    }
}

/// The matrix, SI, of principal directions; what cannot move contributes nothing.
fn matrix_of(directions: &[Direction], scale: Scale) -> Matrix6<f64> {
    let rows = root_rows(directions, scale.length);
    rows.iter()
        .map(|(sign, row)| row * row.transpose() * *sign)
        .sum()
}

// A limb holds its tip by `W = (f, m)`. Where its base turns by `phi`, the whole limb turns and `dW = (phi x f,
// phi x m)`; where its ends move against each other, the arms of `f` change. A limb that carries loads of its
// own does not turn with them: the rest of its tangent is added as it was computed.
impl PlatformSolver<'_> {
    /// Ends of the limbs now.
    fn ends(&self) -> Vec<Ends> {
        let limbs = 0..self.mechanism.limbs().len();
        limbs
            .map(|i| ends(self.mechanism, &self.state.platforms, i))
            .collect()
    }

    /// The platforms' stiffness by rows of the limbs; `None` where stiffnesses are of similar size.
    pub fn graded(&self, tangent: &Sparse, limbs: &[&ChainStiffness]) -> Option<GradedPlatforms> {
        let m = self.mechanism;
        let ends = self.ends();
        let scales = m.limbs().iter().map(|limb| limb.actual.scale());
        let own = limbs.iter().zip(scales).zip(&ends);
        let own = own.map(|((k, scale), ends)| (*k, scale, ends));
        let graded = GradedPlatforms::of(m.scale(), tangent.rows / 6, own)?;
        Some(graded.with(&self.turned_loads(tangent, limbs, &ends)))
    }

    /// Contribution of the limbs' forces and of loads on platforms to the limbs' stiffnesses at the present state, 6P x
    /// 6P; `tangent` is that of [`Self::tangents`].
    fn turned_loads(&self, tangent: &Sparse, limbs: &[&ChainStiffness], ends: &[Ends]) -> Sparse {
        let (m, at) = (self.mechanism, &self.state);
        let mut sum = Sparse::zeros(tangent.rows, tangent.columns);
        let mut loaded = false;
        for (i, limb) in m.limbs().iter().enumerate() {
            let to = 6 * (limb.to - 1);
            sum.add(to, to, &self.turned_force(i, at));
            if limb.from == 0 {
                continue;
            }
            let weightless =
                limb.actual.bodies().is_empty() && limb.actual.segment_masses().is_empty();
            loaded |= self.loads[i]
                .iter()
                .any(|load| !(weightless && matches!(load, Load::Gravity(_))));
            let from = 6 * (limb.from - 1);
            let (force, moment) = (at.wrenches[i].force(), at.wrenches[i].moment());
            let turned = columns(&hat(&-force), &hat(&-moment));
            let (by_to, by_from) = (ends[i].to.1, ends[i].from.1);
            sum.add(to, from, &(by_to.transpose() * turned));
            let arm = lower(&hat(&force));
            sum.add(from, from, &(by_from.transpose() * turned - arm));
            sum.add(from, to, &(arm * by_to));
        }
        self.add_platform_loads(at, |on, by, block| {
            sum.add(6 * (on - 1), 6 * (by - 1), block);
        });
        if loaded {
            let mut rest = tangent.dense() - sum.dense();
            for (k, ends) in limbs.iter().zip(ends) {
                let a = ends.matrix(tangent.rows / 6);
                let k = DMatrix::from_fn(6, 6, |i, j| k.cartesian.matrix[(i, j)]);
                rest -= a.transpose() * k * a;
            }
            sum.add(0, 0, &rest);
        }
        sum
    }
}

/// Force and moment by a turn.
fn columns(force: &Matrix3<f64>, moment: &Matrix3<f64>) -> Matrix6<f64> {
    let mut matrix = Matrix6::zeros();
    matrix.fixed_view_mut::<3, 3>(0, 3).copy_from(force);
    matrix.fixed_view_mut::<3, 3>(3, 3).copy_from(moment);
    matrix
}

/// Moment by a displacement.
fn lower(moment: &Matrix3<f64>) -> Matrix6<f64> {
    let mut matrix = Matrix6::zeros();
    matrix.fixed_view_mut::<3, 3>(3, 0).copy_from(moment);
    matrix
}
