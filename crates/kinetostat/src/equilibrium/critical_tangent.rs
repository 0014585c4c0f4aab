//! The tangent of a chain under a growing load among the motions that nothing holds: divergence, and the prediction by the
//! first load step.

use crate::chain::directions::scaled_jacobian;
use crate::chain::stability::share_to_buckling;
use crate::continuation::chain::system::ChainSystem;
use crate::linalg::complement::complement;
use crate::linalg::saddle::{Saddle, column_space};
use crate::linalg::singular_values::SingularValues;
use crate::number::larger;
use nalgebra::{DMatrix, DVector};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Object whose stability is demanded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum StabilityOf {
    /// The shape, with the whole end held where the load has brought it.
    Shape,
    /// The shape and the end, under the conditions as prescribed.
    ShapeAndEnd,
}

/// The tangent among the motions that nothing holds: springs, loads that stay, and loads that grow, apart.
pub(crate) struct Tangent {
    /// `N`, scaled coordinates.
    null: DMatrix<f64>,
    /// `N^T K N`.
    springs: DMatrix<f64>,
    /// `N^T H N` of the loads and reactions at factor 0; unsymmetric without a potential.
    staying: DMatrix<f64>,
    /// Part `N^T H N` of the growing loads.
    growing: DMatrix<f64>,
}

impl Tangent {
    /// Tangent at the state `z` of a path that starts at `start`.
    pub fn at(
        system: &mut ChainSystem<'_, '_>,
        z: &DVector<f64>,
        start: &DVector<f64>,
        of: StabilityOf,
    ) -> Self {
        let (r, n) = (system.reactions(), system.coordinates_count());
        let last = system.count();
        // Posture `z` under the loads of the start.
        let mut before = z.clone();
        before.rows_mut(0, r).copy_from(&start.rows(0, r));
        before[last] = start[last];
        system.linearised_densely(&before);
        let staying = system.load_hessian();
        let (_, _, matrix) = system.linearised_densely(z);
        let rows = match of {
            StabilityOf::ShapeAndEnd => matrix.view((0, r), (r, n)).into_owned(),
            StabilityOf::Shape => {
                crate::chain::directions::scaled_jacobian(&system.equations, &system.scaling)
            }
        };
        let null = free_motions(system, &rows);
        Self {
            springs: null.transpose() * system.spring_tangent() * &null,
            growing: null.transpose() * (system.load_hessian() - &staying) * &null,
            staying: null.transpose() * staying * &null,
            null,
        }
    }

    /// Springs and loads at factor 0.
    pub fn at_start(self) -> (DMatrix<f64>, DMatrix<f64>) {
        (self.springs, self.staying)
    }

    /// Motion of the coordinates that meets the least resistance.
    pub fn mode(&self) -> Option<DVector<f64>> {
        let own = SingularValues::of(&(&self.springs - &self.staying - &self.growing));
        let least = own.right.column_iter().next_back()?;
        Some(&self.null * least)
    }
}

/// Motions that `rows` leave free, without those that change nothing.
fn free_motions(system: &ChainSystem<'_, '_>, rows: &DMatrix<f64>) -> DMatrix<f64> {
    let range = column_space(rows);
    let mut all = (range.transpose() * rows).transpose();
    // Motions that change nothing are no modes: those of them that the held directions leave free.
    for v in system
        .neutral_motions()
        .iter()
        .flat_map(|v| v.column_iter())
    {
        if (rows * v).amax() < 1e-9 * rows.amax().max(f64::MIN_POSITIVE) {
            let k = all.ncols();
            all = all.insert_column(k, 0.0);
            all.set_column(k, &v);
        }
    }
    complement(&all)
}

/// True beyond a zero of `det (A - G)`, where `A = K - H` at factor 0 and `G` is what has come on top: a real
/// eigenvalue of `A^-1 G` has passed one. Two that pass together (a round rod) do not change the
/// determinant's sign, so they are counted one by one. Eigenvalues of `K^-1 H` would not do: beside a load
/// that stays, two of them may leave the complex plane above one, where nothing has diverged.
pub(crate) fn diverges(tangent: &Tangent) -> bool {
    let springs = &tangent.springs - &tangent.staying;
    largest_real(&springs, &tangent.growing).is_some_and(|mu| mu >= 1.0)
}

/// Largest real eigenvalue of `A^-1 G`, neither symmetric. Where `A` is singular (passive motions that
/// strain no spring), the sign of the determinant of `A - G` decides: infinity if it is negative.
pub(crate) fn largest_real(springs: &DMatrix<f64>, loads: &DMatrix<f64>) -> Option<f64> {
    if springs.is_empty() || springs.iter().chain(loads.iter()).any(|x| !x.is_finite()) {
        return None;
    }
    let own = SingularValues::of(springs);
    let (most, least) = (own.values.first(), own.values.last());
    let regular = least > most.map(|x| 1e-10 * x).as_ref();
    let solved = regular.then(|| springs.clone().lu().solve(loads)).flatten();
    let found = solved.and_then(|product| {
        let schur = nalgebra::linalg::Schur::try_new(product, f64::EPSILON, 10_000)?;
        let all = schur.complex_eigenvalues();
        let most = all.iter().fold(0.0_f64, |m, x| larger(m, x.norm()));
        if !most.is_finite() {
            return None;
        }
        let real = all.iter().filter(|x| x.im.abs() <= 1e-6 * most);
        Some(real.fold(f64::NEG_INFINITY, |m, x| larger(m, x.re)))
    });
    found.or_else(|| {
        let sign = (springs - loads).determinant();
        (sign < 0.0).then_some(f64::INFINITY)
    })
}

/// Largest eigenvalue of the stresses per unit factor against the stiffness, in the posture at
/// factor 0: `(N^T d(H - K)/df N) v = (1/f) (N^T (K - H) N) v`.
pub(crate) fn linear_prediction(
    system: &mut ChainSystem<'_, '_>,
    z: &DVector<f64>,
    of: StabilityOf,
    conservative: bool,
) -> (Option<f64>, Vec<f64>) {
    let (r, m) = (system.reactions(), system.count());
    let n = system.coordinates_count();
    let (_, _, matrix) = system.linearised_densely(z);
    let at_rest = system.curvature();
    let rows = match of {
        StabilityOf::ShapeAndEnd => matrix.view((0, r), (r, n)).into_owned(),
        StabilityOf::Shape => scaled_jacobian(&system.equations, &system.scaling),
    };
    // Reactions per unit factor; the posture stays.
    let ones = vec![1.0; m];
    let mut step = DMatrix::zeros(m, 1);
    step.column_mut(0)
        .copy_from(&(-matrix.column(m) / system.sigma));
    Saddle::new(matrix.columns(0, m).into_owned(), &ones, &ones).solve(&mut step);
    let mut ahead = z.clone();
    for i in 0..r {
        ahead[i] += step[(i, 0)];
    }
    ahead[m] += 1.0 / system.sigma;
    system.evaluate(&ahead);
    let mut stress = system.curvature() - &at_rest;
    // Links that bow take a geometric stiffness from the start.
    let springs = |system: &ChainSystem<'_, '_>| {
        let mut sum = DMatrix::zeros(n, n);
        for (first, matrix) in &system.equations.spring_geometric {
            let unit = &system.scaling[6 + first..];
            for i in 0..6 {
                for j in 0..6 {
                    sum[(first + i, first + j)] += matrix[(i, j)] * unit[i] * unit[j];
                }
            }
        }
        sum
    };
    let before = springs(system);
    let share = 1e-5 / step.rows(r, n).amax().max(1e-300);
    let mut moved = z.clone();
    for i in 0..n {
        moved[r + i] += share * step[(r + i, 0)];
    }
    system.evaluate(&moved);
    stress -= (springs(system) - before) / share;
    system.evaluate(z);
    let null = free_motions(system, &rows);
    if !conservative {
        let springs = null.transpose() * system.spring_tangent() * &null;
        let before = null.transpose() * system.load_hessian() * &null;
        system.evaluate(&ahead);
        let loads = null.transpose() * system.load_hessian() * &null - &before;
        system.evaluate(z);
        let mu = largest_real(&(springs - before), &loads);
        let factor = mu.filter(|mu| mu.is_finite() && *mu > 1e-9);
        return (factor.map(|mu| 1.0 / mu), Vec::new());
    }
    let stress = null.transpose() * stress * &null;
    let stiff = -(null.transpose() * at_rest * &null);
    let (mu, mode) = share_to_buckling(&stress, &stiff);
    // Values that are positive only by rounding destabilise nothing.
    let (opposite, _) = share_to_buckling(&-stress, &stiff);
    let least = 1e-9 * opposite.filter(|o| o.is_finite()).unwrap_or(0.0).max(0.0);
    match (mu, mode) {
        (Some(mu), Some(v)) if mu > least && mu.is_finite() => {
            let mut whole = DVector::zeros(m + 1);
            whole.rows_mut(r, n).copy_from(&(&null * v));
            (Some(1.0 / mu), largest_one(&system.motion(&whole)))
        }
        _ => (None, Vec::new()),
    }
}

/// A motion with its largest component 1.
pub(crate) fn largest_one(motion: &[f64]) -> Vec<f64> {
    let most = motion
        .iter()
        .copied()
        .fold(0.0_f64, |a, x| if x.abs() > a.abs() { x } else { a });
    let most = if most == 0.0 { 1.0 } else { most };
    motion.iter().map(|x| x / most).collect()
}
