//! The modes of a tool as complex states, each of its own: with damping that couples the modes, those of the complex modes [D 8].
//!
//! Modes and directions without mass `y` obey `M y'' + R y' + K y = P^T F`, where `M` has ones for modes and zeros for the others, `K` the
//! squares of frequencies and ones, and `R` is symmetric. A root `s` with `(s^2 M + s R + K) y = 0` adds
//! `p p^T / (y^T (2 s M + R) y) / (i w - s)` to the receptance, with `p = P y`: a state `u` with `u' = s u + F . p / (..)` moves the tool by
//! `p u`, and its conjugate by the conjugate of that. There is no other part: what is at once is residual flexibility.

use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

use crate::error::{ChatterError, ChatterErrorKind, Result};
use crate::number::{Complex64, larger};
use crate::response::{Coupling, Mode, ToolResponse, first_order};
use crate::stability::eigenvalues::{by_qr, start};

/// A mode as a complex state `u` of the size of a displacement: the point moves by `Im(direction u)`, and a force `F` drives
/// `u' = root u + gain . F`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct State {
    pub(crate) root: Complex64,
    /// Unit vector; real where the mode has its own damping alone.
    pub(crate) direction: Vector3<Complex64>,
    /// m/(N s).
    pub(crate) gain: Vector3<Complex64>,
}

/// The states of all modes that move the tool.
///
/// # Errors
/// Complex modes that do not make the response they were computed from.
pub(crate) fn states(response: &ToolResponse) -> Result<Vec<State>> {
    match response.coupling() {
        None => Ok(of_modes(response.modes())),
        Some(coupling) => of_complex_modes(response, coupling),
    }
}

/// States of modes with their own damping alone.
fn of_modes(modes: &[Mode]) -> Vec<State> {
    let moving = modes.iter().filter(|mode| mode.shape().norm() > 0.0);
    let state = |mode: &Mode| {
        let (root, size) = (mode.root(), mode.shape().norm());
        State {
            root,
            direction: (mode.shape() / size).map(Complex64::from),
            gain: (mode.shape() * (size / root.im)).map(Complex64::from),
        }
    };
    moving.map(state).collect()
}

/// Roots nearer than this, as a share, are looked at together: their shapes are made independent of one another.
const CLOSE: f64 = 1e-6;
/// Steps of inverse iteration to a shape.
const STEPS: usize = 3;
/// Tolerance of the states' receptance, as a share of the response.
const MISSED: f64 = 1e-7;

/// A root with its shape in the modes.
struct Root {
    value: Complex64,
    shape: DVector<Complex64>,
}

fn of_complex_modes(response: &ToolResponse, coupling: &Coupling) -> Result<Vec<State>> {
    let fault = |found: String| {
        ChatterError::new(
            ChatterErrorKind::NotConverged,
            "complex modes with the damping that couples the tool's modes",
            found,
            "roots that make up the response: change the damping a little (two roots may meet exactly), or take fewer modes",
        )
    };
    let modes = response.modes();
    let squares = modes.iter().map(|m| m.angular_frequency().powi(2));
    let pencil = Pencil {
        squares: squares.collect(),
        rates: coupling.rates(),
    };
    let all = by_qr(&first_order(response, &Matrix3::zeros()))
        .ok_or_else(|| fault("no convergence of the QR iteration".to_owned()))?;
    // Keeps one root of each conjugate pair.
    let roots: Vec<Complex64> = all.into_iter().filter(|root| root.im >= 0.0).collect();
    let mut found: Vec<Root> = Vec::with_capacity(roots.len());
    for (index, root) in roots.into_iter().enumerate() {
        let root = pencil
            .with_shape(root, index, &found)
            .ok_or_else(|| fault(format!("no shape of the root {root:.6e} 1/s")))?;
        found.push(root);
    }
    let state = |root: &Root| {
        let shape = &root.shape;
        let along = |axis: usize| {
            let each = shape.iter().enumerate();
            each.map(|(k, share)| *share * coupling.point(modes, k)[axis])
                .sum::<Complex64>()
        };
        let point = Vector3::new(along(0), along(1), along(2));
        let norm = pencil.product(shape, shape, root.value + root.value);
        // A pair moves the tool by twice the real part of `p u`, a single root by `p u`.
        let pair = if root.value.im == 0.0 { 1.0 } else { 2.0 };
        let size = pair * point.norm();
        State {
            root: root.value,
            direction: point * (Complex64::i() * pair / size),
            gain: point * (Complex64::from(size) / norm),
        }
    };
    let moves = |state: &State| state.direction.iter().all(|x| x.is_finite());
    let states: Vec<State> = found.iter().map(state).filter(moves).collect();
    let missed = missed(response, &states);
    // False for NaN.
    match missed <= MISSED {
        true => Ok(states),
        false => Err(fault(format!(
            "a response that is {missed:.1e} of itself off"
        ))),
    }
}

/// Receptance of the states at an angular frequency, rad/s: a sum, whereas the response itself solves a system of
/// equations.
pub(crate) fn receptance(states: &[State], w: f64) -> Matrix3<Complex64> {
    // Im(direction u) of a force that turns: half of both, the second from the conjugate.
    let half = Complex64::new(0.0, -0.5);
    let at = Complex64::new(0.0, w);
    let each = states.iter().map(|state| {
        let (own, conjugate) = (half / (at - state.root), half / (-at - state.root).conj());
        let product = state.direction * state.gain.transpose();
        product.map(|x| x * own - x.conj() * conjugate)
    });
    each.sum()
}

/// The largest share by which states miss the flexible part of a response, at the frequencies of the modes.
fn missed(response: &ToolResponse, states: &[State]) -> f64 {
    let residual = response.at_once().map(Complex64::from);
    let of = |w: f64| {
        let wanted = response.at(w) - residual;
        let off = receptance(states, w) - wanted;
        off.map(|x| x.norm()).norm() / wanted.map(|x| x.norm()).norm()
    };
    let hz = response
        .modes()
        .iter()
        .map(|mode| of(mode.angular_frequency()));
    hz.fold(0.0, larger)
}

/// `s^2 M + s R + K`.
struct Pencil<'r> {
    /// Squares of the angular frequencies of the modes, which come before what has no mass.
    squares: Vec<f64>,
    rates: &'r DMatrix<f64>,
}

impl Pencil<'_> {
    /// Mass and stiffness of a row.
    fn own(&self, k: usize) -> (f64, f64) {
        match self.squares.get(k) {
            Some(square) => (1.0, *square),
            None => (0.0, 1.0),
        }
    }

    fn at(&self, s: Complex64) -> DMatrix<Complex64> {
        let n = self.rates.nrows();
        DMatrix::from_fn(n, n, |i, j| {
            let (mass, stiffness) = self.own(i);
            let own = if i == j {
                s * s * mass + stiffness
            } else {
                Complex64::default()
            };
            own + s * self.rates[(i, j)]
        })
    }

    /// `x^T (sum M + R) y`: none for shapes of two roots with this sum.
    fn product(&self, x: &DVector<Complex64>, y: &DVector<Complex64>, sum: Complex64) -> Complex64 {
        let m = self.squares.len();
        let damped = self.rates.map(Complex64::from) * y;
        x.rows(0, m).dot(&y.rows(0, m)) * sum + x.dot(&damped)
    }

    /// A root with its shape, by inverse iteration from numbers without order, apart from those of the roots that are close.
    fn with_shape(&self, root: Complex64, index: usize, found: &[Root]) -> Option<Root> {
        let is_close = |other: &&Root| (other.value - root).norm() <= CLOSE * root.norm();
        let close: Vec<&Root> = found.iter().filter(is_close).collect();
        let mut value = root;
        let n = self.rates.nrows();
        let begin = start(2 * n * (index + 1));
        let at = |k: usize| Complex64::new(begin[2 * n * index + k], begin[2 * n * index + n + k]);
        let mut shape = DVector::from_fn(n, |k, _| at(k));
        // Shifted beside the root, where the matrix would be singular.
        let beside = self.at(root * (1.0 + 1e-11)).lu();
        for _ in 0..STEPS {
            shape = beside.solve(&shape)?;
            for other in &close {
                let sum = value + other.value;
                let own = self.product(&other.shape, &other.shape, other.value + other.value);
                let share = self.product(&other.shape, &shape, sum) / own;
                shape -= &other.shape * share;
            }
            let size = shape.norm();
            if !(size.is_finite() && size > 0.0) {
                return None;
            }
            shape /= Complex64::from(size);
        }
        if root.im > 0.0 {
            value = self.refined(root, &shape);
        } else {
            // Shapes of single roots are real but for a factor.
            let largest = shape.icamax();
            let turn = shape[largest] / shape[largest].norm();
            shape.apply(|x| *x = Complex64::from((*x / turn).re));
        }
        Some(Root { value, shape })
    }

    /// The root of `y^T (s^2 M + s R + K) y` beside one: twice as exact as the shape.
    fn refined(&self, root: Complex64, y: &DVector<Complex64>) -> Complex64 {
        let sum = |of: &dyn Fn(usize) -> f64| -> Complex64 {
            y.iter().enumerate().map(|(k, y)| y * y * of(k)).sum()
        };
        let (two, none) = (sum(&|k| self.own(k).0), sum(&|k| self.own(k).1));
        let one = y.dot(&(self.rates.map(Complex64::from) * y));
        let slope = two * root * 2.0 + one;
        let step = (two * root * root + one * root + none) / slope;
        match step.norm() <= CLOSE * root.norm() {
            true => root - step,
            false => root,
        }
    }
}
