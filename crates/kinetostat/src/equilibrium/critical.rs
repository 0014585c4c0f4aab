//! Critical load factor of a load pattern: how many times a pattern of loads can grow until the
//! chain loses its stability, by the eigenvalue of the first load step and by following the path.
//!
//! Loads without a potential (forces that follow the chain, moments about axes that turn) make the
//! tangent `T = N^T (K - H) N` unsymmetric. Then a neighbouring equilibrium, and with it divergence,
//! exists where `det T = 0`, not where the symmetric part of `T` is indefinite; and the chain may start
//! to swing with growing amplitude (flutter) before, which depends on its masses and is not answered
//! here (Ziegler 1952; Bolotin, Nonconservative Problems of the Theory of Elastic Stability, 1963).

use std::cell::RefCell;

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use crate::chain::equilibrium::Equilibrium;
use crate::chain::potential::is_conservative;
use crate::chain::problem::ChainProblem;
use crate::chain::stability::share_to_buckling;
use crate::continuation::chain_system::ChainSystem;
use crate::continuation::curve::CurvePoint;
use crate::continuation::curve::SpecialKind;
use crate::continuation::follow::follow_until;
use crate::continuation::parameter::{LoadPattern, Parameter};
use crate::continuation::settings::CurveSettings;
use crate::continuation::tracer::Tracer;
use crate::equilibrium::chain::solve_chain;
use crate::error::Result;
use crate::linalg::complement::complement;
use crate::linalg::saddle::{Saddle, column_space};
use crate::linalg::singular_values::SingularValues;
use crate::spatial::Wrench;

/// What must stay stable.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Judged {
    /// The shape, with the whole end held where the load has brought it.
    Shape,
    /// The shape and the end, under the conditions as prescribed.
    ShapeAndEnd,
}

/// Where stability is lost.
#[derive(Clone, Debug)]
pub struct CriticalPoint {
    /// Load factor.
    pub factor: f64,
    /// What happens there; `None` where the held shape alone becomes critical, which is no special
    /// point of the path.
    pub kind: Option<SpecialKind>,
    /// Motion of all coordinates in the critical mode (m, rad), largest component 1.
    pub mode: Vec<f64>,
    /// The equilibrium there.
    pub equilibrium: Equilibrium,
}

/// Critical load factor of a pattern.
#[derive(Clone, Debug)]
pub struct CriticalLoad {
    /// Linear prediction: `1/mu` of the stresses of the first load step in the unloaded posture;
    /// `None` if that load never destabilises it.
    pub linear: Option<f64>,
    /// Mode of the linear prediction (m, rad), largest component 1; empty without one.
    pub linear_mode: Vec<f64>,
    /// First loss of stability on the path; `None` if there is none up to `reached`.
    pub exact: Option<CriticalPoint>,
    /// Largest load factor to which the path was followed.
    pub reached: f64,
    /// All loads have a potential. If not, `exact` is the first divergence (a zero of the tangent's
    /// determinant), and flutter, for which masses are needed, may come before.
    pub conservative: bool,
    /// Without a potential: the factor at which the symmetric part of the tangent turns indefinite. Below
    /// it nothing goes away, whatever the masses are (every small motion takes work on the straight path
    /// there). `None` with a potential (then `exact` says it), or if it stays definite up to `reached`.
    pub definite_until: Option<f64>,
}

impl CriticalLoad {
    /// What a load without a potential leaves open; `None` for one that has a potential.
    #[must_use]
    pub fn caution(&self) -> Option<String> {
        if self.conservative {
            return None;
        }
        let safe = match self.definite_until {
            Some(factor) => {
                format!("up to the factor {factor:.6} nothing goes away, whatever the masses are")
            }
            None => format!("up to the factor {:.6} neither can happen", self.reached),
        };
        Some(format!(
            "the loads follow the chain and have no potential: the critical factor is that of divergence (the tangent's determinant is zero); flutter, a swing that grows, may come before it and depends on masses and damping, which are not asked for here; {safe}"
        ))
    }
}

/// Smallest positive factor of `pattern` at which the chain becomes unstable, on the path from the
/// problem's own equilibrium (its loads count, the pattern comes on top).
/// `settings.range.1` is the largest factor tried, infinity if need be.
///
/// # Errors
/// Wrong input, or no equilibrium at factor 0. A chain that is unstable at factor 0 has the
/// critical factor 0.
pub fn critical_load_factor(
    problem: &ChainProblem<'_>,
    pattern: &LoadPattern,
    judged: Judged,
    settings: &CurveSettings,
) -> Result<CriticalLoad> {
    settings.check(&format!("chain '{}'", problem.chain.name()))?;
    let parameter = Parameter::Load(pattern.clone());
    let start = solve_chain(problem, &settings.solver)?;
    let mut system = ChainSystem::new(problem, Some(&parameter), &settings.solver)?;
    let z = system.start(&start.coordinates, &start.wrench, 0.0)?;
    let mut whole = problem.clone();
    whole.loads.extend(pattern.loads.iter().cloned());
    whole.end.wrench = Wrench(whole.end.wrench.0 + pattern.end.0);
    let conservative = is_conservative(problem) && is_conservative(&whole);
    let (linear, linear_mode) = linear_prediction(&mut system, &z, judged, conservative);

    let mut settings = settings.clone();
    settings.branches = 1;
    settings.range.0 = settings.range.0.min(-1e-9);
    if settings.largest_change.is_none() {
        settings.largest_change = linear.map(|f| f / 6.0);
    }
    let stability = move |p: &CurvePoint| match judged {
        Judged::Shape => p.equilibrium.stability.clone(),
        Judged::ShapeAndEnd => p.dead.clone(),
    };
    // Of the symmetric part, below whose critical factor nothing happens.
    let indefinite = move |p: &CurvePoint| {
        let stability = stability(p);
        !stability.stable || stability.may_flutter()
    };
    let mut system_there = ChainSystem::new(problem, Some(&parameter), &settings.solver)?;
    system_there.start(&start.coordinates, &start.wrench, 0.0)?;
    let system_there = RefCell::new(system_there);
    let diverged_before = {
        let mut system_there = system_there.borrow_mut();
        let (springs, loads) = Tangent::at(&mut system_there, &z, &z, judged).at_start();
        largest_real(&springs, &loads).is_some_and(|mu| mu >= 1.0)
    };
    let unstable = |p: &CurvePoint| {
        let diverges = || {
            diverges(&Tangent::at(
                &mut system_there.borrow_mut(),
                &p.z,
                &z,
                judged,
            ))
        };
        !stability(p).stable && (conservative || diverged_before || diverges())
    };
    let curves = follow_until(problem, &parameter, &start, 0.0, &settings, Some(&unstable))?;
    let points = &curves.branches[0].points;
    let mut reached = points.iter().map(|p| p.parameter).fold(0.0, f64::max);
    let at_change = |i: usize, unstable: &dyn Fn(&CurvePoint) -> bool| -> Result<CurvePoint> {
        let mut tracer = Tracer {
            system: ChainSystem::new(problem, Some(&parameter), &settings.solver)?,
            settings: &settings,
            specials: Vec::new(),
        };
        tracer
            .system
            .start(&start.coordinates, &start.wrench, 0.0)?;
        Ok(tracer.stability_change(&points[i - 1], &points[i], unstable))
    };
    let mode = |p: &CurvePoint| match conservative {
        true => mode_of(p, judged),
        false => {
            let mut system_there = system_there.borrow_mut();
            let tangent = Tangent::at(&mut system_there, &p.z, &z, judged);
            let mut motion = DVector::zeros(system_there.count() + 1);
            let first = system_there.reactions();
            if let Some(v) = tangent.mode() {
                motion.rows_mut(first, v.len()).copy_from(&v);
            }
            largest_one(&system_there.motion(&motion))
        }
    };
    let definite_until = match points.iter().position(indefinite) {
        _ if conservative => None,
        Some(0) => Some(0.0),
        Some(i) => Some(at_change(i, &indefinite)?.parameter),
        None => None,
    };
    let exact = match points.iter().position(&unstable) {
        None => None,
        Some(0) => Some(CriticalPoint {
            factor: 0.0,
            kind: None,
            mode: mode(&points[0]),
            // The first point of a curve may lie a little beside its start, where a motion is free.
            equilibrium: Equilibrium {
                conservative,
                ..start.clone()
            },
        }),
        Some(i) => {
            let special = curves.specials.iter().find(|s| {
                judged == Judged::ShapeAndEnd
                    && s.kind != SpecialKind::DisplacementLimit
                    && between(&points[i - 1], &s.point, &points[i])
            });
            Some(match special {
                Some(s) => CriticalPoint {
                    factor: s.point.parameter,
                    kind: Some(s.kind),
                    mode: s.mode.clone(),
                    equilibrium: s.point.equilibrium.clone(),
                },
                None => {
                    let p = at_change(i, &unstable)?;
                    CriticalPoint {
                        factor: p.parameter,
                        kind: None,
                        mode: mode(&p),
                        equilibrium: p.equilibrium,
                    }
                }
            })
        }
    };
    if let Some(exact) = &exact {
        reached = reached.max(exact.factor);
    }
    Ok(CriticalLoad {
        linear,
        linear_mode,
        exact,
        reached,
        conservative,
        definite_until,
    })
}

/// The tangent among the motions that nothing holds: springs, loads that stay, and loads that grow, apart.
struct Tangent {
    /// `N`, balanced coordinates.
    null: DMatrix<f64>,
    /// `N^T K N`.
    springs: DMatrix<f64>,
    /// `N^T H N` of the loads and reactions at factor 0; unsymmetric without a potential.
    staying: DMatrix<f64>,
    /// The same of what has come on top.
    growing: DMatrix<f64>,
}

impl Tangent {
    /// At the state `z` of a path that starts at `start`.
    fn at(
        system: &mut ChainSystem<'_, '_>,
        z: &DVector<f64>,
        start: &DVector<f64>,
        judged: Judged,
    ) -> Self {
        let (r, n) = (system.reactions(), system.coordinates_count());
        let last = system.count();
        // This posture under what acts at the start.
        let mut before = z.clone();
        before.rows_mut(0, r).copy_from(&start.rows(0, r));
        before[last] = start[last];
        system.linearised_densely(&before);
        let staying = system.load_hessian();
        let (_, _, matrix) = system.linearised_densely(z);
        let rows = match judged {
            Judged::ShapeAndEnd => matrix.view((0, r), (r, n)).into_owned(),
            Judged::Shape => {
                crate::chain::passive::balanced_jacobian(&system.equations, &system.scaling)
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
    fn at_start(self) -> (DMatrix<f64>, DMatrix<f64>) {
        (self.springs, self.staying)
    }

    /// Motion of the coordinates that meets the least resistance.
    fn mode(&self) -> Option<DVector<f64>> {
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
fn diverges(tangent: &Tangent) -> bool {
    let springs = &tangent.springs - &tangent.staying;
    largest_real(&springs, &tangent.growing).is_some_and(|mu| mu >= 1.0)
}

/// Largest real eigenvalue of `A^-1 G`, neither symmetric. Where `A` is singular (passive motions that
/// strain no spring), the sign of the determinant of `A - G` decides: infinity if it is negative.
fn largest_real(springs: &DMatrix<f64>, loads: &DMatrix<f64>) -> Option<f64> {
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
        let most = all.iter().fold(0.0_f64, |m, x| m.max(x.norm()));
        let real = all.iter().filter(|x| x.im.abs() <= 1e-6 * most);
        Some(real.fold(f64::NEG_INFINITY, |m, x| m.max(x.re)))
    });
    found.or_else(|| {
        let sign = (springs - loads).determinant();
        (sign < 0.0).then_some(f64::INFINITY)
    })
}

fn mode_of(p: &CurvePoint, judged: Judged) -> Vec<f64> {
    match judged {
        Judged::Shape => p.equilibrium.stability.mode.clone(),
        Judged::ShapeAndEnd => p.dead.mode.clone(),
    }
}

/// True if a state lies on the step from `a` to `b`.
fn between(a: &CurvePoint, s: &CurvePoint, b: &CurvePoint) -> bool {
    let along = (&s.z - &a.z).dot(&a.tangent);
    let step = (&b.z - &a.z).dot(&a.tangent);
    along >= -1e-9 && along <= step + 1e-9
}

/// Largest eigenvalue of the stresses per unit factor against the stiffness, in the posture at
/// factor 0: `(N^T d(H - K)/df N) v = (1/f) (N^T (K - H) N) v`.
fn linear_prediction(
    system: &mut ChainSystem<'_, '_>,
    z: &DVector<f64>,
    judged: Judged,
    conservative: bool,
) -> (Option<f64>, Vec<f64>) {
    let (r, m) = (system.reactions(), system.count());
    let n = system.coordinates_count();
    let (_, _, matrix) = system.linearised_densely(z);
    let at_rest = system.curvature();
    let rows = match judged {
        Judged::ShapeAndEnd => matrix.view((0, r), (r, n)).into_owned(),
        Judged::Shape => {
            crate::chain::passive::balanced_jacobian(&system.equations, &system.scaling)
        }
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
    // What is positive by rounding only destabilises nothing.
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
fn largest_one(motion: &[f64]) -> Vec<f64> {
    let most = motion
        .iter()
        .copied()
        .fold(0.0_f64, |a, x| if x.abs() > a.abs() { x } else { a });
    let most = if most == 0.0 { 1.0 } else { most };
    motion.iter().map(|x| x / most).collect()
}
