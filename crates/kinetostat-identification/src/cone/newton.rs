//! Primal-dual interior-point iteration on the reduced problem.

use nalgebra::{DMatrix, DVector};

use super::ConeError;
use super::reduced::{Block, Reduced};
use super::scaling::Scaling;

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

/// Minimises the reduced objective over its blocks. Makes no step if the answer without constraints meets them.
pub(super) fn minimise(problem: &Reduced<'_>) -> Result<Optimum, ConeError> {
    if problem.is_feasible(&problem.unconstrained) {
        return Ok(Optimum {
            u: problem.unconstrained.clone(),
            dual: DVector::zeros(problem.data.len()),
            gap: 0.0,
            steps: 0,
        });
    }
    let order: usize = problem.blocks.iter().map(|b| b.sizes.len()).sum();
    // Start: multiples of the identity as large as the unconstrained answer and its gradient.
    let size = |v: f64| (v / (order as f64).sqrt()).clamp(1e-3, 1e3);
    let square = |b: &Block<'_>| b.matrix(&problem.unconstrained).norm_squared();
    let x = size(problem.blocks.iter().map(square).sum::<f64>().sqrt());
    let z = size(problem.triangle.tr_mul(&problem.data).norm());
    let start = |b: &Block<'_>| Scaling::of_multiples(x, z, b.sizes.len());
    let mut scalings: Vec<Scaling> = problem.blocks.iter().map(start).collect();
    // Unknowns of blocks follow from the scalings.
    let mut free = DVector::<f64>::zeros(problem.data.len());
    let mut best: Option<Optimum> = None;
    let (mut idle, mut relative) = (0, f64::INFINITY);
    for steps in 0..=STEPS {
        let (mut u, mut dual) = (free.clone(), DVector::zeros(free.len()));
        for (block, scaling) in problem.blocks.iter().zip(&scalings) {
            let [x, z] = scaling.pair();
            block.set(&mut u, &x);
            block.set(&mut dual, &z);
        }
        let residual = problem.residual_at(&u);
        // The sum of squares is <u, dual>, without the rounding errors of a product of matrices.
        let product = scalings.iter().map(|s| s.s.norm_squared()).sum();
        let gap = duality_gap(problem, product, &dual, &residual);
        let least = best.as_ref().map_or(f64::INFINITY, |b| b.gap);
        idle = if gap <= 0.5 * least { 0 } else { idle + 1 };
        if gap < least {
            let objective = problem.objective(&residual);
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
    problem: &Reduced<'_>,
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
fn snap_to_zero(problem: &Reduced<'_>, optimum: Optimum) -> Optimum {
    let mut u = optimum.u.clone();
    for block in &problem.blocks {
        if let [k] = *block.columns
            && u[k] * problem.triangle.column(k).norm_squared() <= optimum.dual[k]
        {
            u[k] = 0.0;
        }
    }
    let residual = problem.residual_at(&u);
    let gap = duality_gap(problem, u.dot(&optimum.dual), &optimum.dual, &residual);
    let gap = gap.max(optimum.gap);
    if gap <= (2.0 * optimum.gap).max(1e2 * GAP * problem.objective(&residual)) {
        Optimum { u, gap, ..optimum }
    } else {
        optimum
    }
}

/// Predictor and corrector of one Newton step: scalings after it and the change of the free
/// unknowns.
///
/// The predictor aims at `mu = 0`. Its success decides how far the corrector reduces `mu` (Mehrotra 1992), to second order.
fn newton_step(
    problem: &Reduced<'_>,
    scalings: &[Scaling],
    residual: &DVector<f64>,
) -> Option<(Vec<Scaling>, DVector<f64>)> {
    // With u = W v, W the map of the scalings, the step is the least-squares answer of v = target, T W v = residual; free unknowns
    // have no target.
    let p = residual.len();
    let mut rows = DMatrix::zeros(2 * p, p);
    rows.rows_mut(p, p).copy_from(&problem.triangle);
    for (block, scaling) in problem.blocks.iter().zip(scalings) {
        let mixed = problem.triangle.select_columns(block.columns) * scaling.map();
        for (column, &k) in mixed.column_iter().zip(block.columns) {
            rows[(k, k)] = 1.0;
            rows.view_mut((p, k), (p, 1)).copy_from(&column);
        }
    }
    let rows = rows.qr();
    let triangle = rows.r();
    // Step v, primal and dual matrices of the blocks, and the longest step that keeps all of them semi-definite.
    let solve = |targets: &[DMatrix<f64>]| {
        let mut right = DVector::zeros(2 * p);
        right.rows_mut(p, p).copy_from(residual);
        for (block, target) in problem.blocks.iter().zip(targets) {
            block.set(&mut right, target);
        }
        rows.q_tr_mul(&mut right);
        let v = triangle.solve_upper_triangular(&right.rows(0, p))?;
        let (mut pairs, mut longest) = (Vec::new(), f64::INFINITY);
        for ((block, s), target) in problem.blocks.iter().zip(scalings).zip(targets) {
            let primal = block.matrix(&v);
            // Linearised complementarity.
            let dual = target - s.point() - &primal;
            longest = longest
                .min(s.longest_step(&primal))
                .min(s.longest_step(&dual));
            pairs.push((primal, dual));
        }
        let is_finite = v.iter().all(|v| v.is_finite());
        is_finite.then_some((v, pairs, longest))
    };
    let zeros = |b: &Block<'_>| DMatrix::zeros(b.sizes.len(), b.sizes.len());
    let (_, pairs, longest) = solve(&problem.blocks.iter().map(zeros).collect::<Vec<_>>())?;
    let length = longest.min(1.0);
    let (mut order, mut now, mut predicted) = (0, 0.0, 0.0);
    for (s, (x, z)) in scalings.iter().zip(&pairs) {
        let point = s.point();
        order += s.s.len();
        now += s.s.norm_squared();
        predicted += (&point + x * length).dot(&(&point + z * length));
    }
    let mu = now / order as f64 * (predicted / now).clamp(0.0, 1.0).powi(3);
    let target = |(s, (x, z)): (&Scaling, &(DMatrix<f64>, DMatrix<f64>))| {
        let product = x * z;
        let second_order = (&product + product.transpose()) * 0.5;
        s.divide(&(DMatrix::identity(s.s.len(), s.s.len()) * mu - second_order))
    };
    let targets: Vec<_> = scalings.iter().zip(&pairs).map(target).collect();
    let (v, pairs, longest) = solve(&targets)?;
    let length = (TO_BOUNDARY * longest).min(1.0);
    let steps = scalings.iter().zip(&pairs);
    let next: Option<Vec<_>> = steps.map(|(s, (x, z))| s.step(x, z, length)).collect();
    Some((next?, v * length))
}
