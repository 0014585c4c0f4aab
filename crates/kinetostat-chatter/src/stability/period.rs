//! One period of the cut at a speed: stretches of time with what a force on them does.

use std::array;
use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector, Vector3};

use crate::cut::{Cut, Piece};
use crate::error::{ChatterError, ChatterErrorKind, Result};
use crate::number::{Complex64, larger};
use crate::response::ToolResponse;
use crate::stability::legendre::{Answer, Chebyshev};
use crate::stability::states::State;

/// A stretch of time without a tooth that comes or goes.
#[derive(Clone, Debug)]
pub(crate) struct Stretch {
    /// Factor of each mode's state over the stretch, without force.
    pub(crate) decay: Vec<Complex64>,
    /// Response in the cut; `None` in air.
    pub(crate) cutting: Option<Cutting>,
}

/// One period.
#[derive(Clone, Debug)]
pub(crate) struct Period {
    /// Length, s.
    pub(crate) delay: f64,
    pub(crate) states: Vec<State>,
    pub(crate) stretches: Vec<Stretch>,
}

impl Period {
    /// The period of a cut at a speed and, for helical teeth, a depth, with `fineness` times the usual points.
    pub(crate) fn new(
        response: &ToolResponse,
        states: Vec<State>,
        cut: &Cut,
        speed_rpm: f64,
        depth: f64,
        fineness: f64,
    ) -> Result<Self> {
        let delay = cut.delay(speed_rpm)?;
        let speed = TAU * speed_rpm / 60.0;
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
                    false => Some(Cutting::new(
                        response, cut, piece, begins, duration, &states, fineness,
                    )?),
                };
                Ok(Stretch { decay, cutting })
            })
            .collect::<Result<Vec<_>>>()?;
        Ok(Self {
            delay,
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

/// Vectors at a node, for each difference: the force on the tool by depth and difference, N/m^2, and the direction of
/// the displacement.
type Factors = Vec<(Vector3<f64>, Vector3<f64>)>;

/// Response of a stretch in the cut: displacements along the chip at its nodes are `state u_0 + force (a d)`, where `d`
/// is their difference from one period before.
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
    /// Factors at each node.
    pub(crate) factors: Vec<Factors>,
    /// Weights of an integral over the stretch, s.
    pub(crate) weights: DVector<f64>,
}

impl Cutting {
    /// A piece of a cut with its begin and duration, s.
    pub(crate) fn new(
        response: &ToolResponse,
        cut: &Cut,
        piece: &Piece,
        begins: f64,
        duration: f64,
        states: &[State],
        fineness: f64,
    ) -> Result<Self> {
        let chebyshev = Chebyshev::new(points(states, duration, piece.length, fineness)?);
        let factors: Vec<Factors> = chebyshev
            .nodes
            .iter()
            .map(|share| cut.factors(piece, piece.start + piece.length * share))
            .collect();
        let through = Through::states(&chebyshev, states, duration, &factors).ok_or_else(|| {
            ChatterError::new(
                ChatterErrorKind::NotConverged,
                "collocation of a stretch of the cut",
                "a singular matrix",
                "modes and speeds of ordinary size",
            )
        })?;
        let times = chebyshev.nodes.iter();
        Ok(Self {
            state: free(&chebyshev, states, duration, &factors),
            force: through.displacements(&factors, response),
            end: through.end(&factors, states),
            times: times.map(|share| begins + duration * share).collect(),
            factors,
            weights: chebyshev.weights(duration),
        })
    }
}

/// Product of a real vector and a complex one.
fn scaled(real: &Vector3<f64>, complex: &Vector3<Complex64>) -> Complex64 {
    complex.x * real.x + complex.y * real.y + complex.z * real.z
}

/// Displacements by the states at the beginning, without force.
fn free(
    chebyshev: &Chebyshev,
    states: &[State],
    duration: f64,
    factors: &[Factors],
) -> DMatrix<f64> {
    let kinds = factors[0].len();
    let mut free = DMatrix::zeros(kinds * factors.len(), 2 * states.len());
    for (m, mode) in states.iter().enumerate() {
        for (i, (share, factors)) in chebyshev.nodes.iter().zip(factors).enumerate() {
            let turned = (mode.root * (duration * share)).exp();
            for (k, (_, along)) in factors.iter().enumerate() {
                let moved = scaled(along, &mode.direction) * turned;
                // Im((x + i y) moved) = x Im moved + y Re moved
                free[(kinds * i + k, 2 * m)] = moved.im;
                free[(kinds * i + k, 2 * m + 1)] = moved.re;
            }
        }
    }
    free
}

/// States as functions of the forces at the nodes.
///
/// Modes add up as coefficients of polynomials, one matrix for each direction of the force and each of the
/// displacement: the transformations between nodes and coefficients are done once for all modes.
struct Through {
    /// Displacement along an axis (row) at the nodes by a force along an axis (column) at the nodes, m/N.
    axes: [[Option<DMatrix<f64>>; 3]; 3],
    /// State of each mode (real and imaginary part) at the end by what drives it at the nodes, s.
    end: DMatrix<f64>,
}

impl Through {
    fn states(
        chebyshev: &Chebyshev,
        states: &[State],
        duration: f64,
        factors: &[Factors],
    ) -> Option<Self> {
        let n = chebyshev.nodes.len();
        let all = || factors.iter().flatten();
        let pushes: [bool; 3] = array::from_fn(|b| all().any(|(pushed, _)| pushed[b] != 0.0));
        let counts: [bool; 3] = array::from_fn(|a| all().any(|(_, along)| along[a] != 0.0));
        let coefficients = chebyshev.coefficients()?;
        let mut end = DMatrix::zeros(2 * states.len(), n);
        let mut axes: [[Option<DMatrix<f64>>; 3]; 3] = Default::default();
        for (m, mode) in states.iter().enumerate() {
            let answer = Answer::of(mode.root * duration, n)?;
            // Every polynomial is 1 at the end.
            for (row, part) in [(2 * m, &answer.real), (2 * m + 1, &answer.imaginary)] {
                end.set_row(row, &(part.column_sum() * duration).transpose());
            }
            for (a, axes) in axes.iter_mut().enumerate() {
                for (b, sum) in axes.iter_mut().enumerate() {
                    let share = mode.direction[a] * mode.gain[b] * duration;
                    if share == Complex64::default() || !counts[a] || !pushes[b] {
                        continue;
                    }
                    let sum = sum.get_or_insert_with(|| DMatrix::zeros(n, n + 1));
                    sum.zip_apply(&answer.imaginary, |sum, value| *sum += share.re * value);
                    if share.im != 0.0 {
                        sum.zip_apply(&answer.real, |sum, value| *sum += share.im * value);
                    }
                }
            }
        }
        let values = chebyshev.polynomials(n);
        let at_nodes = |by_coefficients: DMatrix<f64>| {
            let of_coefficients = &values * by_coefficients.transpose();
            of_coefficients * &coefficients
        };
        Some(Self {
            axes: axes.map(|axes| axes.map(|sum| sum.map(at_nodes))),
            end: end * &coefficients,
        })
    }

    /// Displacements along the chip by depth times differences.
    fn displacements(&self, factors: &[Factors], response: &ToolResponse) -> DMatrix<f64> {
        let (n, kinds) = (factors.len(), factors[0].len());
        let mut force = DMatrix::zeros(kinds * n, kinds * n);
        for (a, axes) in self.axes.iter().enumerate() {
            for (b, moved) in axes.iter().enumerate() {
                let Some(moved) = moved else { continue };
                for j in 0..n {
                    for (l, (pushed, _)) in factors[j].iter().enumerate() {
                        for i in 0..n {
                            for (k, (_, along)) in factors[i].iter().enumerate() {
                                force[(kinds * i + k, kinds * j + l)] +=
                                    along[a] * moved[(i, j)] * pushed[b];
                            }
                        }
                    }
                }
            }
        }
        // Response without inertia.
        let at_once = response.at_once();
        for (i, factors) in factors.iter().enumerate() {
            for (k, (_, along)) in factors.iter().enumerate() {
                for (l, (pushed, _)) in factors.iter().enumerate() {
                    force[(kinds * i + k, kinds * i + l)] += along.dot(&(at_once * pushed));
                }
            }
        }
        force
    }

    /// State at the end by depth times differences.
    fn end(&self, factors: &[Factors], states: &[State]) -> DMatrix<f64> {
        let (n, kinds) = (factors.len(), factors[0].len());
        DMatrix::from_fn(2 * states.len(), kinds * n, |row, column| {
            let (pushed, _) = &factors[column / kinds][column % kinds];
            let gain = scaled(pushed, &states[row / 2].gain);
            let [real, imaginary] =
                [0, 1].map(|part| self.end[(row - row % 2 + part, column / kinds)]);
            match row % 2 {
                0 => gain.re * real - gain.im * imaginary,
                _ => gain.re * imaginary + gain.im * real,
            }
        })
    }
}

/// Points of a stretch beside those for its vibrations.
const LEAST_POINTS: f64 = 14.0;
/// Points for each vibration of the fastest mode: pi of them begin to resolve one.
const POINTS_PER_CYCLE: f64 = 5.0;
/// Share of the largest peak of all states from which a state is resolved: what a stretch makes of a smaller one, which is small
/// and acts through itself once more, is off by about the square of its share. More points show whether that is so.
const RESOLVED: f64 = 1e-3;
/// Maximum number of points: more cost more than a stretch is worth.
const MOST_POINTS: f64 = 400.0;

/// Factor on the points by which a result is checked.
const CHECKED: f64 = 4.0 / 3.0;

/// Maximum number of cycles of a mode on a stretch with so many times the usual points.
fn most_cycles(fineness: f64) -> f64 {
    (MOST_POINTS / fineness - LEAST_POINTS) / POINTS_PER_CYCLE
}

/// Frequency of the fastest mode, Hz, that the stretches of a cut resolve at a speed for all depths up to one, m.
pub(crate) fn resolved_hz(cut: &Cut, speed_rpm: f64, up_to: f64) -> f64 {
    let turn = cut.longest(up_to);
    let cycles = most_cycles(CHECKED) - turn / TAU;
    cycles * (TAU * speed_rpm / 60.0) / turn
}

/// Number of nodes of a stretch.
pub(crate) fn points(states: &[State], duration: f64, turn: f64, fineness: f64) -> Result<usize> {
    // Decay counts like oscillation; a state that only decays is a boundary layer at the beginning, of which
    // polynomials need the square root (the coefficients of exp(-a x) fall as exp(-n^2/a)).
    let cycles_of = |state: &State| match state.root.im == 0.0 {
        true => (state.root.norm() * duration).sqrt(),
        false => state.root.norm() * duration / TAU,
    };
    let peak = |state: &State| state.gain.norm() / state.root.re.abs();
    let largest = states.iter().map(peak).fold(0.0, larger);
    let resolved = (states.iter()).filter(|state| peak(state) >= RESOLVED * largest);
    let most = resolved.map(cycles_of).fold(0.0, larger);
    let fastest = most / duration;
    let cycles = most + turn / TAU;
    let wanted = fineness * (LEAST_POINTS + POINTS_PER_CYCLE * cycles);
    match wanted <= MOST_POINTS {
        true => Ok(wanted.ceil() as usize),
        false => Err(ChatterError::new(
            // With the points of a check, a single speed has no answer; the request itself is valid.
            match fineness > CHECKED {
                true => ChatterErrorKind::NotConverged,
                false => ChatterErrorKind::Setting,
            },
            "mode against spindle speed",
            format!(
                "a mode at {fastest:.0} Hz vibrates {cycles:.0} times while a tooth is in the cut"
            ),
            format!(
                "at most about {:.0} times with as many points as the limit wants: take faster modes as springs (modes up to a lower frequency), or a higher speed",
                most_cycles(larger(fineness, CHECKED))
            ),
        )),
    }
}
