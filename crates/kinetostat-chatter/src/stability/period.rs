//! One period of the cut at a speed: stretches of time with what a force on them does.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector, Vector3};

use crate::cut::{Cut, Piece};
use crate::error::{ChatterError, ChatterErrorKind, Result};
use crate::number::{Complex64, larger};
use crate::response::ToolResponse;
use crate::stability::collocation::Chebyshev;

/// Points of a stretch beside those for its vibrations.
const LEAST_POINTS: f64 = 14.0;
/// Points for each vibration of the fastest mode: pi of them begin to resolve one.
const POINTS_PER_CYCLE: f64 = 5.0;
/// More points than this cost more than a stretch is worth.
const MOST_POINTS: f64 = 400.0;

/// A mode as a complex state `u` of the size of a displacement: the point moves by `direction Im u`, and a force `F` drives
/// `u' = root u + gain . F`.
#[derive(Clone, Debug)]
pub(crate) struct State {
    pub(crate) root: Complex64,
    /// Unit vector of the shape.
    pub(crate) direction: Vector3<f64>,
    /// m/(N s).
    pub(crate) gain: Vector3<f64>,
}

/// What a stretch in the cut does: displacements along the chip at its nodes are `state u_0 + force (a d)`, where `d` is
/// their difference from one period before.
#[derive(Clone, Debug)]
pub(crate) struct Cutting {
    /// Displacements by the state at the beginning (real and imaginary parts in turn).
    pub(crate) state: DMatrix<f64>,
    /// Displacements by depth times differences, 1/m.
    pub(crate) force: DMatrix<f64>,
    /// State at the end by depth times differences, 1/m.
    pub(crate) end: DMatrix<f64>,
    /// Times of the nodes from the beginning of the period, s.
    pub(crate) times: Vec<f64>,
    /// Force on the tool at each node by depth and each difference, N/m^2, and the direction of that displacement.
    pub(crate) factors: Vec<Vec<(Vector3<f64>, Vector3<f64>)>>,
    /// Weights of an integral over the stretch, s.
    pub(crate) weights: DVector<f64>,
}

/// A stretch of time without a tooth that comes or goes.
#[derive(Clone, Debug)]
pub(crate) struct Stretch {
    /// Time at which it begins, from the beginning of the period, s.
    pub(crate) begins: f64,
    /// Its length, s.
    pub(crate) duration: f64,
    /// By what each mode's state is multiplied over it, without force.
    pub(crate) decay: Vec<Complex64>,
    /// In the cut; `None` in air.
    pub(crate) cutting: Option<Cutting>,
}

/// One period.
#[derive(Clone, Debug)]
pub(crate) struct Period {
    /// Length, s.
    pub(crate) delay: f64,
    /// Turn of the spindle at which it begins, rad.
    pub(crate) starts: f64,
    pub(crate) states: Vec<State>,
    pub(crate) stretches: Vec<Stretch>,
}

impl Period {
    /// The period of a cut at a speed and, for helical teeth, a depth, with `fineness` times the usual points.
    pub(crate) fn new(
        response: &ToolResponse,
        cut: &Cut,
        speed_rpm: f64,
        depth: f64,
        fineness: f64,
    ) -> Result<Self> {
        let delay = cut.delay(speed_rpm)?;
        let speed = TAU * speed_rpm / 60.0;
        let states: Vec<State> = response
            .modes()
            .iter()
            .filter(|mode| mode.shape().norm() > 0.0)
            .map(|mode| {
                let root = mode.root();
                let size = mode.shape().norm();
                State {
                    root,
                    direction: mode.shape() / size,
                    gain: mode.shape() * (size / root.im),
                }
            })
            .collect();
        let pieces = cut.pieces(depth);
        let starts = pieces.first().map_or(0.0, |piece| piece.start);
        let stretches = pieces
            .iter()
            .map(|piece| {
                let begins = (piece.start - starts) / speed;
                let duration = piece.length / speed;
                let decay = states
                    .iter()
                    .map(|state| (state.root * duration).exp())
                    .collect();
                let cutting = match piece.active.is_empty() {
                    true => None,
                    false => Some(cutting(
                        response,
                        cut,
                        (piece, begins, duration),
                        &states,
                        fineness,
                    )?),
                };
                Ok(Stretch {
                    begins,
                    duration,
                    decay,
                    cutting,
                })
            })
            .collect::<Result<Vec<_>>>()?;
        Ok(Self {
            delay,
            starts,
            states,
            stretches,
        })
    }

    /// Numbers of all nodes' differences.
    pub(crate) fn differences(&self) -> usize {
        self.stretches
            .iter()
            .filter_map(|stretch| stretch.cutting.as_ref())
            .map(|cutting| cutting.force.nrows())
            .sum()
    }
}

/// Number of nodes of a stretch.
fn points(states: &[State], duration: f64, turn: f64, fineness: f64) -> Result<usize> {
    // How fast it dies away counts as how fast it swings.
    let fastest = states
        .iter()
        .map(|state| state.root.norm() / TAU)
        .fold(0.0, larger);
    let cycles = fastest * duration + turn / TAU;
    let wanted = fineness * (LEAST_POINTS + POINTS_PER_CYCLE * cycles);
    match wanted <= MOST_POINTS {
        true => Ok(wanted.ceil() as usize),
        false => Err(ChatterError::new(
            ChatterErrorKind::Setting,
            "mode against spindle speed",
            format!(
                "a mode at {fastest:.0} Hz vibrates {cycles:.0} times while a tooth is in the cut"
            ),
            "at most about 75 times: take faster modes as springs (modes up to a lower frequency), or a higher speed",
        )),
    }
}

fn cutting(
    response: &ToolResponse,
    cut: &Cut,
    (piece, begins, duration): (&Piece, f64, f64),
    states: &[State],
    fineness: f64,
) -> Result<Cutting> {
    let chebyshev = Chebyshev::new(points(states, duration, piece.length, fineness)?);
    let n = chebyshev.nodes.len();
    let factors: Vec<Vec<_>> = chebyshev
        .nodes
        .iter()
        .map(|share| cut.factors(piece, piece.start + piece.length * share))
        .collect();
    let kinds = factors[0].len();
    let (mut state, mut force, mut end) = (
        DMatrix::zeros(kinds * n, 2 * states.len()),
        DMatrix::zeros(kinds * n, kinds * n),
        DMatrix::zeros(2 * states.len(), kinds * n),
    );
    let fault = || {
        ChatterError::new(
            ChatterErrorKind::NotConverged,
            "collocation of a stretch of the cut",
            "a singular matrix",
            "modes and speeds of ordinary size",
        )
    };
    for (m, mode) in states.iter().enumerate() {
        let convolution = chebyshev
            .convolution(mode.root, duration)
            .ok_or_else(fault)?;
        for i in 0..n {
            let free = (mode.root * (duration * chebyshev.nodes[i])).exp();
            for (k, (_, along)) in factors[i].iter().enumerate() {
                let row = kinds * i + k;
                let moved = along.dot(&mode.direction);
                // Im((x + i y) free) = x Im free + y Re free
                state[(row, 2 * m)] = moved * free.im;
                state[(row, 2 * m + 1)] = moved * free.re;
                for j in 0..n {
                    for (l, (pushed, _)) in factors[j].iter().enumerate() {
                        force[(row, kinds * j + l)] +=
                            moved * convolution[(i, j)].im * mode.gain.dot(pushed);
                    }
                }
            }
        }
        for j in 0..n {
            for (l, (pushed, _)) in factors[j].iter().enumerate() {
                let driven = convolution[(n - 1, j)] * mode.gain.dot(pushed);
                end[(2 * m, kinds * j + l)] = driven.re;
                end[(2 * m + 1, kinds * j + l)] = driven.im;
            }
        }
    }
    for i in 0..n {
        for (k, (_, along)) in factors[i].iter().enumerate() {
            for (l, (pushed, _)) in factors[i].iter().enumerate() {
                force[(kinds * i + k, kinds * i + l)] += along.dot(&(response.residual() * pushed));
            }
        }
    }
    Ok(Cutting {
        state,
        force,
        end,
        times: chebyshev
            .nodes
            .iter()
            .map(|share| begins + duration * share)
            .collect(),
        factors,
        weights: chebyshev.weights(duration).ok_or_else(fault)?,
    })
}
