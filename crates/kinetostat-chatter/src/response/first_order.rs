//! A tool with a force by displacement as a system of first order: of its modes, and of what has no mass but dampers.

use nalgebra::{DMatrix, Matrix3};

use crate::response::tool::ToolResponse;

/// The matrix of `W q`, `q'` and `z`, in which its entries are of one size; `force` is the force on the tool by displacement, N/m.
pub(crate) fn first_order(response: &ToolResponse, force: &Matrix3<f64>) -> DMatrix<f64> {
    let modes = response.modes();
    let m = modes.len();
    let own = |i: usize, j: usize| match i == j {
        true => modes[i].rate(),
        false => 0.0,
    };
    let coupling = response.coupling();
    let held = coupling.map_or(0, |coupling| coupling.held().len());
    let rates = coupling.map_or_else(|| DMatrix::from_fn(m, m, own), |c| c.rates().clone());
    let point = |k: usize| coupling.map_or_else(|| modes[k].shape(), |c| c.point(modes, k));
    let w = |k: usize| modes[k].angular_frequency();
    let pushed = |i: usize, j: usize| point(i).dot(&(force * point(j)));
    // R_zz z' = H^T F - z - R_zq q'
    let n = 2 * m + held;
    let mut relaxing = DMatrix::zeros(held, n);
    for i in 0..held {
        for j in 0..m {
            relaxing[(i, j)] = pushed(m + i, j) / w(j);
            relaxing[(i, m + j)] = -rates[(m + i, j)];
        }
        for j in 0..held {
            relaxing[(i, 2 * m + j)] = pushed(m + i, m + j) - f64::from(u8::from(i == j));
        }
    }
    if held > 0 {
        // Times of relaxation are positive: there is a solution.
        let times = rates.view((m, m), (held, held)).into_owned().lu();
        times.solve_mut(&mut relaxing);
    }
    // q'' = Phi^T F - W^2 q - R_qq q' - R_qz z'
    let mut driven = -(rates.view((0, m), (m, held)) * &relaxing);
    let mut matrix = DMatrix::zeros(n, n);
    for i in 0..m {
        matrix[(i, m + i)] = w(i);
        driven[(i, i)] -= w(i);
        for j in 0..m {
            driven[(i, j)] += pushed(i, j) / w(j);
            driven[(i, m + j)] -= rates[(i, j)];
        }
        for j in 0..held {
            driven[(i, 2 * m + j)] += pushed(i, m + j);
        }
    }
    matrix.view_mut((m, 0), (m, n)).copy_from(&driven);
    matrix.view_mut((2 * m, 0), (held, n)).copy_from(&relaxing);
    matrix
}
