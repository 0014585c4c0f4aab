//! Primal-dual interior-point iteration on the reduced problem.

use nalgebra::{DMatrix, DVector};

use super::ConeError;
use super::ordering::Block;
use super::reduction::Reduced;
use super::reflection::{reflect_rows, reflect_vector};
use super::scaling::Scaling;
use super::symmetric::{symmetric_from_triangle, triangle_from_symmetric};

/// Duality gap, relative to the objective, at which the iteration ends.
const GAP: f64 = 1e-15;

/// Duality gap, relative to the squared length of the data, at which the iteration ends: data without residuals.
const SMALLEST_GAP: f64 = 1e-24;

/// Largest acceptable gap if rounding errors end the iteration early, and its floor for data without residuals.
const ACCEPTABLE: f64 = 1e-7;
const ACCEPTABLE_FLOOR: f64 = 1e-18;

/// Fraction of the way to the boundary that a step may use.
const TO_BOUNDARY: f64 = 0.99;

/// Limits of the iteration: steps in all, and steps without halving the gap.
const STEPS: usize = 100;
const IDLE_STEPS: usize = 6;

/// Optimum of the reduced problem.
pub(super) struct Optimum {
    /// Scaled unknowns.
    pub u: DVector<f64>,
    /// Dual matrices as triangles; zero for free unknowns.
    pub dual: DVector<f64>,
    /// Duality gap, scaled.
    pub gap: f64,
    /// Newton steps made.
    pub steps: usize,
}

impl Optimum {
    /// Optimum at which no constraint is active.
    pub fn interior(u: DVector<f64>) -> Self {
        let dual = DVector::zeros(u.len());
        let (gap, steps) = (0.0, 0);
        Self {
            u,
            dual,
            gap,
            steps,
        }
    }
}

/// Minimises the reduced objective over its blocks.
pub(super) fn minimise(problem: &Reduced) -> Result<Optimum, ConeError> {
    let (p, cone) = (problem.triangle.ncols(), problem.constrained());
    let order: usize = problem.blocks.iter().map(|b| b.order).sum();
    // Start: multiples of the identity as large as the unconstrained answer and its gradient.
    let size = |v: f64| (v / (order as f64).sqrt()).clamp(1e-3, 1e3);
    let x = size(problem.unconstrained.rows(0, cone).norm());
    let z = size(problem.triangle.tr_mul(&problem.data).norm());
    let start = problem.blocks.iter();
    let mut scalings: Vec<Scaling> = start
        .map(|b| Scaling::of_multiples(x, z, b.order))
        .collect();
    let mut free = DVector::<f64>::zeros(p - cone);
    let mut best: Option<Optimum> = None;
    let (mut idle, mut relative) = (0, f64::INFINITY);
    for steps in 0..=STEPS {
        let (mut u, mut dual) = (DVector::zeros(p), DVector::zeros(p));
        for (block, scaling) in problem.blocks.iter().zip(&scalings) {
            u.rows_range_mut(block.columns())
                .copy_from(&scaling.primal());
            dual.rows_range_mut(block.columns())
                .copy_from(&scaling.dual());
        }
        u.rows_range_mut(cone..).copy_from(&free);
        let residual = &problem.data - &problem.triangle * &u;
        // The sum of squares is <u, dual>, without the rounding errors of a product of matrices.
        let product = scalings.iter().map(|s| s.s.norm_squared()).sum();
        let gap = duality_gap(problem, product, &dual, &residual);
        let least = best.as_ref().map_or(f64::INFINITY, |b| b.gap);
        idle = if gap <= 0.5 * least { 0 } else { idle + 1 };
        if gap < least {
            let objective = 0.5 * (residual.norm_squared() + problem.residual.powi(2));
            relative = gap / (objective + ACCEPTABLE_FLOOR / ACCEPTABLE);
            let is_last = gap <= GAP * objective || gap <= SMALLEST_GAP;
            best = Some(Optimum {
                u,
                dual,
                gap,
                steps,
            });
            if is_last {
                break;
            }
        }
        if idle >= IDLE_STEPS {
            break;
        }
        let Some((next, change)) = newton_step(problem, &scalings, &residual) else {
            break;
        };
        scalings = next;
        free += change;
    }
    match best {
        Some(best) if relative <= ACCEPTABLE => Ok(snap_to_zero(problem, best)),
        best => Err(ConeError::NotConverged {
            steps: best.map_or(0, |b| b.steps),
            gap: relative,
        }),
    }
}

/// Upper bound of the distance to the minimum: objective minus the Lagrangian dual function of `dual`.
///
/// It is `product + 1/2 |T^-T d|^2` with the triangle T, `product = <u, dual>` and `d = T^T (T u - data) - dual`, for every positive
/// semi-definite dual.
fn duality_gap(
    problem: &Reduced,
    product: f64,
    dual: &DVector<f64>,
    residual: &DVector<f64>,
) -> f64 {
    // T^-T d = -residual - T^-T dual.
    let mut back = dual.clone();
    if !problem.triangle.tr_solve_upper_triangular_mut(&mut back) {
        return f64::NAN;
    }
    product + 0.5 * (residual + back).norm_squared()
}

/// Replaces non-negative unknowns at their bound by exact zeros if this does not widen the gap.
fn snap_to_zero(problem: &Reduced, optimum: Optimum) -> Optimum {
    let mut u = optimum.u.clone();
    for block in problem.blocks.iter().filter(|b| b.order == 1) {
        let curvature = problem.triangle.column(block.start).norm_squared();
        let value = &mut u[block.start];
        if *value * curvature <= optimum.dual[block.start] {
            *value = 0.0;
        }
    }
    let residual = &problem.data - &problem.triangle * &u;
    let gap = duality_gap(problem, u.dot(&optimum.dual), &optimum.dual, &residual);
    let gap = gap.max(optimum.gap);
    let objective = 0.5 * (residual.norm_squared() + problem.residual.powi(2));
    if gap <= (2.0 * optimum.gap).max(1e2 * GAP * objective) {
        Optimum { u, gap, ..optimum }
    } else {
        optimum
    }
}

/// Least-squares system of one Newton step.
///
/// With `u = W v`, `W` the map of the scalings, the step is the answer of `v = target`, `T W v = residual`; free unknowns have no
/// target. Dual matrices follow from the linearised complementarity as `D = target - S - V`.
struct System<'a> {
    problem: &'a Reduced,
    scalings: &'a [Scaling],
    residual: &'a DVector<f64>,
    /// Reflections that eliminate `T W`, with their factors.
    rows: DMatrix<f64>,
    factors: Vec<f64>,
    /// Rows of each column of `T W`: T is upper triangular, W mixes the columns of a block.
    heights: Vec<usize>,
    triangle: DMatrix<f64>,
}

/// Matrices of the blocks.
type Matrices = Vec<DMatrix<f64>>;

impl<'a> System<'a> {
    fn new(problem: &'a Reduced, scalings: &'a [Scaling], residual: &'a DVector<f64>) -> Self {
        let p = problem.triangle.ncols();
        let mut heights: Vec<usize> = (1..=p).collect();
        let mut rows = problem.triangle.clone();
        let mut triangle = DMatrix::zeros(p, p);
        for (block, scaling) in problem.blocks.iter().zip(scalings) {
            let columns = block.columns();
            let (place, shape) = ((0, columns.start), (columns.end, columns.len()));
            let mixed = problem.triangle.view(place, shape) * scaling.map();
            rows.view_mut(place, shape).copy_from(&mixed);
            for k in columns.clone() {
                heights[k] = columns.end;
                triangle[(k, k)] = 1.0;
            }
        }
        let factors = reflect_rows(&mut triangle, &mut rows, p, |k| heights[k]);
        Self {
            problem,
            scalings,
            residual,
            rows,
            factors,
            heights,
            triangle,
        }
    }

    /// Step `v` for targets of the blocks, with its primal and dual matrices.
    fn solve(&self, targets: &[DMatrix<f64>]) -> Option<(DVector<f64>, Matrices, Matrices)> {
        let blocks = &self.problem.blocks;
        let mut v = DVector::zeros(self.heights.len());
        for (block, target) in blocks.iter().zip(targets) {
            v.rows_range_mut(block.columns())
                .copy_from(&triangle_from_symmetric(target));
        }
        let mut bottom = self.residual.clone();
        let height = |k: usize| self.heights[k];
        reflect_vector(&self.rows, &self.factors, height, &mut v, &mut bottom);
        let solved = self.triangle.solve_upper_triangular_mut(&mut v);
        if !solved || !v.iter().all(|v| v.is_finite()) {
            return None;
        }
        let matrix = |b: &Block| symmetric_from_triangle(&v.as_slice()[b.columns()], b.order);
        let primal: Matrices = blocks.iter().map(matrix).collect();
        let dual = (self.scalings.iter().zip(targets).zip(&primal))
            .map(|((s, target), x)| target - s.point() - x)
            .collect();
        Some((v, primal, dual))
    }

    /// Longest common step that keeps all primal and dual matrices semi-definite.
    fn longest_step(&self, primal: &[DMatrix<f64>], dual: &[DMatrix<f64>]) -> f64 {
        let pairs = self.scalings.iter().zip(primal.iter().zip(dual));
        pairs.fold(f64::INFINITY, |step, (s, (x, z))| {
            step.min(s.longest_step(x)).min(s.longest_step(z))
        })
    }
}

/// Predictor and corrector of one Newton step: scalings after it and the change of the free unknowns.
///
/// The predictor aims at `mu = 0`. Its success decides how far the corrector reduces `mu` (Mehrotra 1992), to second order.
fn newton_step(
    problem: &Reduced,
    scalings: &[Scaling],
    residual: &DVector<f64>,
) -> Option<(Vec<Scaling>, DVector<f64>)> {
    let system = System::new(problem, scalings, residual);
    let zeros: Matrices = (problem.blocks.iter())
        .map(|b| DMatrix::zeros(b.order, b.order))
        .collect();
    let (_, primal, dual) = system.solve(&zeros)?;
    let length = system.longest_step(&primal, &dual).min(1.0);
    let (mut order, mut now, mut predicted) = (0, 0.0, 0.0);
    for (s, (x, z)) in scalings.iter().zip(primal.iter().zip(&dual)) {
        let point = s.point();
        order += s.s.len();
        now += s.s.norm_squared();
        predicted += (&point + x * length).dot(&(&point + z * length));
    }
    let mu = now / order as f64 * (predicted / now).clamp(0.0, 1.0).powi(3);
    let pairs = scalings.iter().zip(primal.iter().zip(&dual));
    let targets: Matrices = pairs
        .map(|(s, (x, z))| {
            let n = s.s.len();
            let product = x * z;
            let second_order = (&product + product.transpose()) * 0.5;
            s.divide(&(DMatrix::identity(n, n) * mu - second_order))
        })
        .collect();
    let (v, primal, dual) = system.solve(&targets)?;
    let length = (TO_BOUNDARY * system.longest_step(&primal, &dual)).min(1.0);
    let pairs = scalings.iter().zip(primal.iter().zip(&dual));
    let next: Option<Vec<_>> = pairs.map(|(s, (x, z))| s.step(x, z, length)).collect();
    Some((next?, v.rows_range(problem.constrained()..) * length))
}
