//! The bordered system of a long chain, solved by sweeps: steps of Newton's method, the tangent at
//! the end, and what holds the shape.

use std::ops::Deref;

use nalgebra::{DMatrix, DVector, Dyn, LU, Matrix6, Vector6};

use crate::chain::sweep::factor::{END_SPRINGS, EndSpring, Factored};
use crate::chain::sweep::stages::{Form, Sweep, column};
use crate::linalg::complement::complement;
use crate::linalg::saddle::{Inertia, RANK_TOLERANCE, Saddle, column_space};
use crate::number::{larger, largest_size};

/// Six conditions on motion `t` and wrench `F` of the end, `motion t + wrench F = right`, scaled;
/// every row with an entry of the size one.
#[derive(Clone, Copy)]
pub struct EndRows {
    /// Factor of `t`.
    pub motion: Matrix6<f64>,
    /// Factor of `F`.
    pub wrench: Matrix6<f64>,
}

impl EndRows {
    /// Rows with a wrench are stated in its unit, `1 / size`.
    pub fn unit(&self, k: usize, size: f64) -> f64 {
        match self.wrench.row(k).amax() > 0.0 {
            true => size,
            false => 1.0,
        }
    }

    /// The motions in `range` (orthonormal columns) are given, nothing reacts in the others.
    pub fn held(range: &DMatrix<f64>) -> Self {
        let r = range.ncols();
        let mut rows = Self {
            motion: Matrix6::zeros(),
            wrench: Matrix6::zeros(),
        };
        rows.motion
            .rows_mut(0, r)
            .copy_from(&range.transpose().view((0, 0), (r, 6)));
        if r < 6 {
            let rest = complement(range).transpose();
            rows.wrench.rows_mut(r, 6 - r).copy_from(&rest);
        }
        rows
    }
}

/// `[0 J; J^T M]` with the rows of an end condition, ready for right-hand sides. Holds its stages or
/// borrows them.
pub struct Bordered<S> {
    sweep: S,
    pub(crate) factored: Factored,
    form: Form,
    rows: EndRows,
    /// Factored 12 x 12 system of the end's wrench (in units of `1 / size`) and motion.
    end: Saddle,
    /// Largest entry of `E`.
    size: f64,
    /// See [`EndSpring::lost`].
    lost: f64,
}

impl<S: Deref<Target = Sweep>> Bordered<S> {
    /// `None` where a pivot is lost in rounding.
    pub fn new(sweep: S, form: Form, rows: EndRows, spring: EndSpring) -> Option<Self> {
        let factored = Factored::new(&sweep, form, spring)?;
        let size = factored.end.amax().max(f64::MIN_POSITIVE);
        let mut a = DMatrix::zeros(12, 12);
        a.view_mut((0, 0), (6, 6))
            .copy_from(&(-factored.end / size));
        a.view_mut((0, 6), (6, 6))
            .copy_from(&(Matrix6::identity() - factored.end * factored.spring));
        a.view_mut((6, 0), (6, 6)).copy_from(&rows.wrench);
        for k in 0..6 {
            let motion = rows.motion.row(k) * rows.unit(k, size);
            a.view_mut((6 + k, 6), (1, 6)).copy_from(&motion);
        }
        let end = Saddle::new(a, &[1.0; 12], &[1.0; 12]);
        Some(Self {
            sweep,
            factored,
            form,
            rows,
            end,
            size,
            lost: spring.lost,
        })
    }

    /// Wrench on the end and coordinates for given right-hand sides, once.
    fn once(&self, torque: &[f64], right: &Vector6<f64>) -> (Vector6<f64>, Vec<f64>) {
        let mut x = torque.to_vec();
        let start = if torque.iter().all(|v| *v == 0.0) {
            Vector6::zeros()
        } else {
            self.factored.solve(&self.sweep, &mut x)
        };
        let mut b = DMatrix::zeros(12, 1);
        for k in 0..6 {
            b[(k, 0)] = start[k];
            b[(6 + k, 0)] = right[k] * self.rows.unit(k, self.size);
        }
        self.end.solve(&mut b);
        let wrench = Vector6::from_fn(|i, _| b[(i, 0)] / self.size);
        let motion = Vector6::from_fn(|i, _| b[(6 + i, 0)]);
        let pulled = wrench + self.factored.spring * motion;
        self.factored.add_response(&pulled, &mut x);
        (wrench, x)
    }

    /// Solves for wrench on the end and coordinates; corrected once by what is left over, if it
    /// matters. `None` if that does not help.
    pub fn solve(&self, torque: &[f64], right: &Vector6<f64>) -> Option<(Vector6<f64>, Vec<f64>)> {
        let (mut wrench, mut x) = self.once(torque, right);
        let mut motions = Vec::with_capacity(self.sweep.stages.len());
        let mut left = vec![0.0; x.len()];
        for attempt in 0..3 {
            let tip = self.sweep.product(self.form, &x, &mut motions, &mut left);
            // If only passive joints move, all torques are rounding.
            let moved = largest_size(x.iter());
            let (mut worst, mut size) = (0.0_f64, RANK_TOLERANCE * moved);
            for own in 0..x.len() {
                let pull = column(&self.sweep.twists, own).dot(&wrench);
                let given = torque[own];
                for part in [pull, given, left[own]] {
                    size = larger(size, part.abs());
                }
                left[own] = given - pull - left[own];
                worst = larger(worst, left[own].abs());
            }
            if !worst.is_finite() {
                return None;
            }
            if worst <= 1e-14 * size {
                break;
            }
            if attempt == 2 {
                if worst > self.lost * size {
                    return None;
                }
                break;
            }
            let rest = right - self.rows.motion * tip - self.rows.wrench * wrench;
            let (dw, dx) = self.once(&left, &rest);
            wrench += dw;
            for (x, d) in x.iter_mut().zip(dx) {
                *x += d;
            }
        }
        x.iter()
            .chain(wrench.iter())
            .all(|v| v.is_finite())
            .then_some((wrench, x))
    }
}

/// Wrench and coordinates per unit motion of the tip, (6 + n) x 6, scaled, over the motions in
/// `range` that the chain can make.
pub(crate) fn unit_motions(sweep: &Sweep, range: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    END_SPRINGS
        .into_iter()
        .find_map(|spring| unit_motions_by(sweep, range, spring))
}

fn unit_motions_by(sweep: &Sweep, range: &DMatrix<f64>, spring: EndSpring) -> Option<DMatrix<f64>> {
    let bordered = Bordered::new(sweep, Form::Exact, EndRows::held(range), spring)?;
    unit_motions_of(&bordered, range)
}

/// Unit motions by a system whose end is held in `range`.
pub(crate) fn unit_motions_of<S: Deref<Target = Sweep>>(
    bordered: &Bordered<S>,
    range: &DMatrix<f64>,
) -> Option<DMatrix<f64>> {
    let n = bordered.sweep.count();
    let mut answer = DMatrix::zeros(6 + n, 6);
    let torque = vec![0.0; n];
    for j in 0..6 {
        let right = Vector6::from_fn(|k, _| {
            if k < range.ncols() {
                range[(j, k)]
            } else {
                0.0
            }
        });
        if right.iter().all(|x| x.abs() <= RANK_TOLERANCE) {
            continue;
        }
        let (wrench, x) = bordered.solve(&torque, &right)?;
        answer.view_mut((0, j), (6, 1)).copy_from(&wrench);
        for (i, value) in x.into_iter().enumerate() {
            answer[(6 + i, j)] = value;
        }
    }
    Some(answer)
}

/// Possible motions of a chain's end, scaled, orthonormal columns.
pub struct EndMotions {
    /// The motions that the chain can make.
    range: DMatrix<f64>,
    /// Free motions among them.
    free: DMatrix<f64>,
}

impl EndMotions {
    /// Holds all motions that the end can make, the columns of `range`.
    pub fn held(range: DMatrix<f64>) -> Self {
        let free = DMatrix::zeros(6, 0);
        Self { range, free }
    }

    /// Holds the directions `held` only.
    pub fn held_in(range: DMatrix<f64>, held: &DMatrix<f64>) -> Self {
        let own = column_space(&(range.transpose() * held));
        let free = &range * complement(&own);
        Self { range, free }
    }

    /// Number of motions that are held.
    pub fn held_count(&self) -> usize {
        self.range.ncols() - self.free.ncols()
    }
}

/// The pencil `H' - mu K'` with motions of the end held, at one `mu`.
///
/// Motions `C u` that are not held are unknowns beside the wrench `F`. Since `J x = C u`, nothing
/// changes if `-(J x - C u)^T S (J x - C u) / 2` is added to the quadratic form; without `x` it is
///
/// ```text
/// | E             E S C - C           |  | F |
/// | (E S C - C)^T  C^T (S E S - S) C   |  | u |
/// ```
struct Shifted<'s> {
    sweep: &'s Sweep,
    factored: Factored,
    ends: &'s EndMotions,
    /// The matrix above, `F` over the range, scaled by `units`.
    end: LU<f64, Dyn, Dyn>,
    /// Units of `F` and `u` by the spring at the end: of the size of what the chain answers, in every
    /// direction, however many springs it has.
    units: DVector<f64>,
    /// Eigenvalues of the pencil above `mu`.
    above: usize,
    inertia: Inertia,
}

/// Share of the largest eigenvalue below which the sign of another is rounding: the spring at the end is up to
/// 1e7 times stiffer in one direction than in another.
const LOST_SIGN: f64 = 1e-9;

impl<'s> Shifted<'s> {
    /// `None` where a pivot is lost in rounding.
    fn new(sweep: &'s Sweep, ends: &'s EndMotions, form: Form) -> Option<Self> {
        let mut springs = END_SPRINGS.into_iter();
        let factored = springs.find_map(|spring| Factored::new(sweep, form, spring))?;
        let (range, free) = (&ends.range, &ends.free);
        let (r, c) = (range.ncols(), free.ncols());
        if r == 0 {
            return None;
        }
        let (own, spring) = (factored.end, factored.spring);
        let mut end = DMatrix::zeros(r + c, r + c);
        let within = range.transpose() * spring * range;
        let between = free.transpose() * spring * free;
        let units = DVector::from_fn(r + c, |i, _| match i < r {
            true => within[(i, i)].sqrt(),
            false => between[(i - r, i - r)].sqrt().recip(),
        });
        end.view_mut((0, 0), (r, r))
            .copy_from(&(range.transpose() * own * range));
        if c > 0 {
            let across = range.transpose() * (own * spring * free - free);
            end.view_mut((0, r), (r, c)).copy_from(&across);
            end.view_mut((r, 0), (c, r)).copy_from(&across.transpose());
            let along = free.transpose() * (spring * own * spring - spring) * free;
            end.view_mut((r, r), (c, c)).copy_from(&along);
        }
        let end = DMatrix::from_fn(r + c, r + c, |i, j| {
            0.5 * (end[(i, j)] + end[(j, i)]) * units[i] * units[j]
        });
        let values = end.symmetric_eigenvalues();
        let most = values.amax();
        let mut inertia = factored.inertia;
        for value in values.iter() {
            if value.is_nan() || value.abs() <= LOST_SIGN * most {
                inertia.zero += 1;
            } else if *value > 0.0 {
                inertia.positive += 1;
            } else {
                inertia.negative += 1;
            }
        }
        // Each motion that is free adds one of either sign.
        inertia.positive = inertia.positive.saturating_sub(c);
        inertia.negative = inertia.negative.saturating_sub(c);
        Some(Self {
            sweep,
            above: inertia.positive.saturating_sub(ends.held_count()),
            inertia,
            factored,
            ends,
            end: end.lu(),
            units,
        })
    }

    /// `x` such that `(H' - mu K') x = torque` but for reactions, the held motions zero. Near an
    /// eigenvalue it is huge, and what rounding spoils is along the eigenvector. `None` on one.
    fn solve(&self, torque: &[f64]) -> Option<Vec<f64>> {
        let (range, free) = (&self.ends.range, &self.ends.free);
        let (r, c) = (range.ncols(), free.ncols());
        let mut x = torque.to_vec();
        let start = self.factored.solve(self.sweep, &mut x);
        let mut b = DMatrix::zeros(r + c, 1);
        b.rows_mut(0, r).copy_from(&(range.transpose() * start));
        if c > 0 {
            let pulled = free.transpose() * (self.factored.spring * start);
            b.rows_mut(r, c).copy_from(&pulled);
        }
        b.column_mut(0).component_mul_assign(&self.units);
        let mut held = self.end.solve(&b)?;
        held.column_mut(0).component_mul_assign(&self.units);
        let mut wrench = -(range * held.rows(0, r));
        if c > 0 {
            let moved = free * held.rows(r, c);
            wrench -= self.factored.spring * moved;
        }
        let wrench = Vector6::from_fn(|i, _| wrench[(i, 0)]);
        self.factored.add_response(&wrench, &mut x);
        x.iter().all(|v| v.is_finite()).then_some(x)
    }
}

/// Stability as in [`crate::chain::stability::ShapeStability`], in scaled coordinates.
pub struct SweptStability {
    pub inertia: Inertia,
    /// Largest eigenvalue of the pencil.
    pub share_to_buckling: f64,
    /// Eigenvector.
    pub mode: Vec<f64>,
}

/// Vector of the pencil whose springs store one half, and what acts on it.
struct Trial {
    v: Vec<f64>,
    /// `K' v`.
    springs: Vec<f64>,
    /// `H' v`.
    loads: Vec<f64>,
    /// Rayleigh quotient.
    quotient: f64,
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

impl Trial {
    fn new(sweep: &Sweep, mut v: Vec<f64>) -> Option<Self> {
        let mut springs = vec![0.0; v.len()];
        sweep.spring_product(&v, &mut springs);
        let stored = dot(&v, &springs);
        if !(stored.is_finite() && stored > 0.0) {
            return None;
        }
        let unit = 1.0 / stored.sqrt();
        v.iter_mut().chain(&mut springs).for_each(|x| *x *= unit);
        let mut loads = vec![0.0; v.len()];
        let mut motions = Vec::with_capacity(sweep.stages.len() + 1);
        sweep.product(Form::Pencil(0.0), &v, &mut motions, &mut loads);
        Some(Self {
            quotient: dot(&v, &loads),
            v,
            springs,
            loads,
        })
    }
}

/// Steps of Lanczos' method before shifts take over.
const LANCZOS: usize = 16;

/// Share of the quotients below which a further vector adds less than its square to the largest one.
const EXHAUSTED: f64 = 1e-6;

/// Share of a quotient by which it may exceed the largest eigenvalue; the larger ones where a sweep so near to an
/// eigenvalue loses a pivot or the sign of one.
const EXCEEDED: [f64; 3] = [1e-6, 1e-4, 1e-2];

/// Lanczos' method for `K'^-1 H'` with motions of the end held, in the energy of the springs
/// without geometric stiffness: a vector near the largest eigenvalue, and how near its quotient may be.
fn lanczos(sweep: &Sweep, ends: &EndMotions) -> Option<(Trial, f64)> {
    let n = sweep.count();
    let material = Shifted::new(sweep, ends, Form::Material)?;
    // If the end is not held, passive joints may move that no spring holds.
    if ends.free.ncols() > 0
        && material.inertia.positive + material.inertia.zero > ends.held_count()
    {
        return None;
    }
    // Any start that no eigenvector is orthogonal to.
    #[allow(clippy::cast_precision_loss)]
    let start: Vec<f64> = (0..n)
        .map(|i| (i as f64 * 0.618_033_988_749_895 + 0.25).fract() - 0.4)
        .collect();
    let mut basis: Vec<Trial> = Vec::with_capacity(LANCZOS);
    basis.push(Trial::new(sweep, material.solve(&start)?)?);
    let mut beyond = 0.0;
    let mut couplings = Vec::with_capacity(LANCZOS);
    while let Some(last) = basis.last() {
        // -K' x = -H' v, but for reactions.
        let torque: Vec<f64> = last.loads.iter().map(|x| -x).collect();
        let mut next = material.solve(&torque)?;
        for _ in 0..2 {
            for other in &basis {
                let share = dot(&next, &other.springs);
                for (x, o) in next.iter_mut().zip(&other.v) {
                    *x -= share * o;
                }
            }
        }
        let mut springs = vec![0.0; n];
        sweep.spring_product(&next, &mut springs);
        beyond = dot(&next, &springs).max(0.0).sqrt();
        let size = basis.iter().map(|t| t.quotient.abs()).fold(1e-3, larger);
        // Equal eigenvalues (a round rod) exhaust the space early: what is left is rounding.
        if basis.len() == LANCZOS || beyond <= EXHAUSTED * size {
            break;
        }
        couplings.push(beyond);
        basis.push(Trial::new(sweep, next)?);
    }
    let m = basis.len();
    let reduced = DMatrix::from_fn(m, m, |i, j| {
        if i == j {
            basis[i].quotient
        } else if i.abs_diff(j) == 1 {
            couplings[i.min(j)]
        } else {
            0.0
        }
    });
    if !reduced.iter().all(|x| x.is_finite()) {
        return None;
    }
    let eigen = reduced.symmetric_eigen();
    let top = eigen.eigenvalues.imax();
    let mut v = vec![0.0; n];
    for (k, trial) in basis.iter().enumerate() {
        let share = eigen.eigenvectors[(k, top)];
        for (x, o) in v.iter_mut().zip(&trial.v) {
            *x += share * o;
        }
    }
    let off = beyond * eigen.eigenvectors[(m - 1, top)].abs();
    Some((Trial::new(sweep, v)?, off))
}

/// Largest eigenvalue of the pencil while motions of the end are held. Rayleigh quotients bound
/// it from below, the count of eigenvalues above a shift from above; each shift costs one sweep, and
/// inverse iteration at the shift improves the quotient. `None` where a sweep loses a pivot.
pub fn shape(sweep: &Sweep, ends: &EndMotions) -> Option<SweptStability> {
    let at_one = Shifted::new(sweep, ends, Form::Pencil(1.0))?;
    let inertia = at_one.inertia;
    let (mut best, mut off) = lanczos(sweep, ends)?;
    if sweep.unloaded() {
        return Some(SweptStability {
            inertia,
            share_to_buckling: 0.0,
            mode: best.v,
        });
    }
    // Largest eigenvalue: above `low`, not above `high`.
    let (mut low, mut high) = (best.quotient, f64::INFINITY);
    if at_one.above == 0 {
        high = 1.0;
    } else {
        low = larger(low, 1.0);
    }
    let mut lost = 0;
    for _ in 0..60 {
        let scale = best.quotient.abs().max(1e-2);
        if high - best.quotient <= 1e-9 * scale {
            break;
        }
        let near = low - best.quotient <= 1e-9 * scale;
        // Just above what the quotient still may grow by.
        let mut ahead = if near {
            (3.0 * off).max(3e-10 * scale)
        } else {
            f64::INFINITY
        };
        if high.is_finite() {
            ahead = ahead.min(0.5 * (high - low));
        } else if ahead.is_infinite() {
            ahead = low.abs().max(scale);
        }
        let shift = low + ahead;
        let Some(next) = Shifted::new(sweep, ends, Form::Pencil(shift)) else {
            // An eigenvalue lies too near.
            lost += 1;
            if lost > 12 {
                return None;
            }
            off = 4.0 * off + 1e-9 * scale;
            continue;
        };
        if next.above > 0 {
            low = shift;
            off *= 4.0;
            if low > 1e9 {
                return None;
            }
        } else {
            high = shift;
        }
        // The nearest eigenvalue grows in the vector from either side; only a larger quotient is accepted.
        let mut v = next.solve(&best.springs)?;
        let mut trial = Trial::new(sweep, v)?;
        v = next.solve(&trial.springs)?;
        trial = Trial::new(sweep, v)?;
        if trial.quotient > best.quotient - 1e-12 * scale {
            off = (trial.quotient - best.quotient).abs();
            best = trial;
            low = larger(low, best.quotient);
        }
    }
    // A vector that leaves what is held, by rounding, has any quotient.
    let size = best.quotient.abs().max(1e-2);
    let reached = EXCEEDED.into_iter().any(|share| {
        let below = Form::Pencil(best.quotient - share * size);
        Shifted::new(sweep, ends, below).is_some_and(|shifted| shifted.above > 0)
    });
    reached.then_some(SweptStability {
        inertia,
        share_to_buckling: best.quotient,
        mode: best.v,
    })
}
