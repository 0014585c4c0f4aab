//! The report's criterion of a shape, `S_c` [R 5.16-5.21].
//!
//! `S_c = V^T (H - K) V`, where the columns of `V` span the motions that the end condition leaves. Its
//! sign tells whether the shape holds; its size depends on what is taken as the unit of a motion: here
//! a turn of one radian and a slide of a stated length count alike, and `V` is orthonormal. The share of
//! the way to buckling `mu` of [`crate::chain::ShapeStability`] depends on no such choice: prefer it.
//!
//! `H` is the whole Hessian with the terms of loads on nodes [R 5.23], which the print leaves out of
//! [R 5.10-5.21] and of Table 5.2 (erratum).

use nalgebra::DMatrix;

use crate::chain::equilibrium::{Equilibrium, System};
use crate::chain::problem::{ChainProblem, Prescribed};
use crate::chain::stability::neutral_motions;
use crate::error::{Error, Result};
use crate::linalg::complement::complement;
use crate::linalg::saddle::column_space;
use crate::spatial::MotionKind;

/// `S_c` with the basis it is written in.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ShapeCriterion {
    /// `S_c`, k x k, J: symmetric, negative definite if the shape holds.
    pub matrix: DMatrix<f64>,
    /// Eigenvalues, J, from the smallest to the largest; they do not depend on the choice of the orthonormal basis.
    pub eigenvalues: Vec<f64>,
    /// The motions `V`, n x k, in rad and in units of [`length`](Self::length): orthonormal columns.
    pub basis: DMatrix<f64>,
    /// The slide that counts as much as a turn of one radian, m.
    pub length: f64,
    /// Neutral motions of passive joints (a strut that spins) that were taken out.
    pub neutral: usize,
}

impl ShapeCriterion {
    /// All eigenvalues are negative: no neighbouring shape has less energy. True without inner
    /// freedom.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.eigenvalues.iter().all(|value| *value < 0.0)
    }
}

/// `S_c` at an equilibrium of `problem`, for motions that leave the prescribed directions of the pose
/// as they are (a direction whose wrench is prescribed moves freely). A slide of `length` metres
/// counts as much as a turn of one radian.
///
/// # Errors
/// [`Error::Model`] if `length` is not positive, [`Error::Size`] if the equilibrium belongs to another
/// chain.
///
/// ```
/// use kinetostat::{*, reference::{ShapeCriterion, shape_criterion}};
/// use nalgebra::{Vector3, vector};
///
/// // Figure 5.7 of the report: three links of 1 m, two springs of 1 N m/rad, pushed by 0.2 m.
/// let spring = |c: ChainBuilder, name: &str| {
///     c.translation(vector![1.0, 0.0, 0.0])
///         .spring(name, MotionKind::Revolute, Vector3::z(), 1.0, 0.0)
/// };
/// let chain = Chain::builder("S").passive("q", MotionKind::Revolute, Vector3::z(), 0.0);
/// let chain = spring(spring(chain, "th1"), "th2").translation(vector![1.0, 0.0, 0.0]).build()?;
/// let mut end = EndCondition::pose(Pose::translation(2.8, 0.0, 0.0));
/// end.prescribed[5] = Prescribed::Wrench; // free to turn
/// let mut problem = ChainProblem::new(&chain, end);
/// problem.posture = vec![0.5, -0.5, -0.5];
/// let bent = solve_chain(&problem, &Settings::default())?;
/// let criterion = shape_criterion(&problem, &bent, 1.0)?;
/// assert!((criterion.matrix[(0, 0)] + 0.627_396_80).abs() < 1e-8);
/// # Ok::<(), Error>(())
/// ```
pub fn shape_criterion(
    problem: &ChainProblem<'_>,
    equilibrium: &Equilibrium,
    length: f64,
) -> Result<ShapeCriterion> {
    let chain = problem.chain;
    let n = chain.coordinate_count();
    let place = || chain.place().during(crate::error::SHAPE_CRITERION);
    if !(length > 0.0 && length.is_finite()) {
        return Err(Error::Model {
            place: place(),
            reason: format!("the length is {length} m, a positive one is needed"),
        });
    }
    if equilibrium.coordinates.len() != n {
        return Err(Error::Size {
            place: place(),
            what: "the equilibrium",
            expected: n,
            found: equilibrium.coordinates.len(),
        });
    }
    let mut system = System::new(
        chain,
        &problem.base,
        &problem.posture,
        &problem.commands,
        false,
    );
    let state = &equilibrium.coordinates;
    system.evaluate_problem(problem, state, &equilibrium.wrench, 1.0);
    let unit: Vec<f64> = chain
        .coordinates()
        .iter()
        .map(|c| match c.kind {
            MotionKind::Revolute => 1.0,
            MotionKind::Prismatic => length,
        })
        .collect();
    // Rows of the prescribed directions, in the frame where they are stated; lengths in units.
    let held: Vec<usize> = (0..6)
        .filter(|&k| problem.end.prescribed[k] == Prescribed::Pose)
        .collect();
    let axes = problem.end.axes.inverse();
    let mut rows = DMatrix::zeros(held.len(), n);
    for j in 0..n {
        let column = system.jacobian.column(j);
        let linear = axes * column.fixed_rows::<3>(0).into_owned();
        let angular = axes * column.fixed_rows::<3>(3).into_owned();
        for (row, &k) in held.iter().enumerate() {
            let value = if k < 3 {
                linear[k] / length
            } else {
                angular[k - 3]
            };
            rows[(row, j)] = value * unit[j];
        }
    }
    let hessian = DMatrix::from_fn(n, n, |i, j| {
        0.5 * (system.hessian[(i, j)] + system.hessian[(j, i)]) * unit[i] * unit[j]
    });
    let rows = column_space(&rows).transpose() * rows;
    let spin = neutral_motions(chain, &rows, &rows, &hessian);
    let neutral = spin.ncols();
    let mut taken_out = DMatrix::zeros(n, rows.nrows() + neutral);
    taken_out
        .columns_mut(0, rows.nrows())
        .copy_from(&rows.transpose());
    taken_out
        .columns_mut(rows.nrows(), neutral)
        .copy_from(&spin);
    let basis = complement(&taken_out);
    let tangent = DMatrix::from_fn(n, n, |i, j| {
        hessian[(i, j)] - system.spring_tangent[(i, j)] * unit[i] * unit[j]
    });
    let matrix = basis.transpose() * tangent * &basis;
    // No inner freedom, no eigenvalue; the iteration for them takes no empty matrix.
    let mut eigenvalues: Vec<f64> = if matrix.is_empty() {
        Vec::new()
    } else {
        let all = matrix.clone().symmetric_eigenvalues();
        all.iter().copied().collect()
    };
    eigenvalues.sort_by(f64::total_cmp);
    Ok(ShapeCriterion {
        matrix,
        eigenvalues,
        basis,
        length,
        neutral,
    })
}
