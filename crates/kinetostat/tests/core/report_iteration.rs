//! The report's own iteration by name: its rate is max |mu|, it cannot stay on unstable shapes, and
//! under tension it alternates; exact Newton beside it is quadratic, also where `H` is not symmetric
//! (the book, errata of 4.16).

use crate::common::{Recipe, Rng, assert_chain_equilibrium, close, planar_column, random_chain};
use crate::curves_and_bifurcations::{held, z_chain, z_unloaded};
use crate::oracle::{self, Frames};
use kinetostat::{
    ChainProblem, EndCondition, Equilibrium, Settings, Twist,
    model::Kinematics,
    reference::{
        ChainState, IterationOutcome, IterationSettings, ReportIteration, newton_iteration,
        report_iteration,
    },
    solve_chain,
    spatial::moved,
};
use kinetostat_testing::{LargestEntry, Worst, largest, largest_size};
use nalgebra::DMatrix;

/// One row of the table.
pub struct Row {
    pub name: &'static str,
    /// Stable or not, F_x, max |mu|; as printed in the table.
    pub force: f64,
    pub mu: f64,
    /// Observed ratio and steps of the report's iteration, `None` where it does not converge.
    pub rate: Option<f64>,
    pub steps: Option<usize>,
    pub newton_steps: usize,
}

const ROWS: [Row; 5] = [
    Row {
        name: "S stable, Delta 0.2",
        force: -1.03473,
        mu: 0.33259,
        rate: Some(0.3326),
        steps: Some(17),
        newton_steps: 4,
    },
    Row {
        name: "S stable, Delta 1",
        force: -1.20920,
        mu: 0.30230,
        rate: Some(0.3023),
        steps: Some(16),
        newton_steps: 3,
    },
    Row {
        name: "S unstable, Delta 0.2",
        force: -3.10655,
        mu: 3.00669,
        rate: None,
        steps: None,
        newton_steps: 4,
    },
    Row {
        name: "Z stable, Delta 0.05",
        force: -0.61121,
        mu: 0.59723,
        rate: Some(0.5972),
        steps: Some(34),
        newton_steps: 4,
    },
    Row {
        name: "Z stable under tension, x = 2.98",
        force: 3.41882,
        mu: 3.40746,
        rate: None,
        steps: None,
        newton_steps: 4,
    },
];

/// What was measured for a row: worst over several directions of the first error, 0.02 rad.
pub struct Measured {
    pub row: &'static Row,
    pub exact: Equilibrium,
    pub report: Vec<ReportIteration>,
    pub newton: Vec<ReportIteration>,
}

/// Largest difference of the coordinates. The last hinge of the planar chains turns the end, which
/// is free to turn: it has no equilibrium of its own and does not count.
fn error(state: &ChainState, exact: &Equilibrium) -> f64 {
    let count = exact.coordinates.len();
    let count = if count == 4 { 3 } else { count };
    let pairs = state.coordinates.iter().zip(&exact.coordinates).take(count);
    largest_size(pairs.map(|(a, b)| a - b))
}

/// Steps after which the error is below 1e-10.
pub fn steps_to(path: &[ChainState], exact: &Equilibrium) -> Option<usize> {
    path.iter().position(|s| error(s, exact) < 1e-10)
}

pub fn table() -> Vec<Measured> {
    let (s, z) = (planar_column(3, 1.0, 1.0), z_chain());
    ROWS.iter()
        .map(|row| {
            let (chain, delta) = match row.name {
                "S stable, Delta 1" => (&s, 1.0),
                name if name.starts_with('S') => (&s, 0.2),
                "Z stable, Delta 0.05" => (&z, 0.05),
                _ => (&z, z_unloaded() - 2.98),
            };
            let x = if row.name.starts_with('S') {
                3.0 - delta
            } else {
                z_unloaded() - delta
            };
            let mut problem = held(chain, x);
            // Near the shape that is meant: arch, zigzag, or the Z as it is assembled.
            problem.posture = match row.name {
                name if name.starts_with("S stable") => {
                    let a = (1.0 - 0.5 * delta).acos();
                    vec![a, -a, -a, a]
                }
                name if name.starts_with('S') => {
                    let a = (delta / 3.0_f64).sqrt();
                    vec![0.58 * a, -1.74 * a, 1.74 * a, -0.58 * a]
                }
                _ => {
                    let q = 10_f64.to_radians();
                    vec![q, -3.0 * q, 3.0 * q, -q]
                }
            };
            let exact = to_rounding(&problem);
            let mut rng = Rng(0x4_15);
            let (mut report, mut newton) = (Vec::new(), Vec::new());
            for _ in 0..5 {
                let start = off(&mut rng, &exact, 0.02);
                let settings = IterationSettings::default().with_tolerance(1e-12);
                report.push(report_iteration(&problem, Some(start.clone()), &settings).unwrap());
                newton.push(newton_iteration(&problem, Some(start), &settings).unwrap());
            }
            Measured {
                row,
                exact,
                report,
                newton,
            }
        })
        .collect()
}

/// The solver stops at 1e-10 of the loads; errors below that need it to rounding.
fn to_rounding(problem: &ChainProblem<'_>) -> Equilibrium {
    let found = solve_chain(problem, &Settings::default()).unwrap();
    assert_chain_equilibrium(problem, &found);
    let state = ChainState {
        coordinates: found.coordinates.clone(),
        wrench: found.wrench,
    };
    let converged = newton_iteration(problem, Some(state), &IterationSettings::default());
    converged.unwrap().equilibrium.unwrap()
}

/// The exact state with its coordinates moved by `size` in a random direction.
fn off(rng: &mut Rng, exact: &Equilibrium, size: f64) -> ChainState {
    let span: Vec<f64> = exact.coordinates.iter().map(|_| rng.signed()).collect();
    let norm = span.iter().map(|x| x * x).sum::<f64>().sqrt();
    ChainState {
        coordinates: exact
            .coordinates
            .iter()
            .zip(span)
            .map(|(x, w)| x + size * w / norm)
            .collect(),
        wrench: exact.wrench,
    }
}

#[test]
fn the_table_of_iterations() {
    for m in table() {
        let row = m.row;
        close(row.name, m.exact.wrench.0[0], row.force, 6e-6);
        let mut counts = Vec::new();
        for (report, newton) in m.report.iter().zip(&m.newton) {
            println!("{}: {}", row.name, report.words());
            let expected = report.rate_at_start.unwrap();
            close(row.name, expected, row.mu, 6e-6);
            assert_eq!(newton.outcome, IterationOutcome::Converged, "{}", row.name);
            let steps = steps_to(&newton.path, &m.exact).unwrap();
            assert!(steps <= row.newton_steps, "{}: {steps}", row.name);
            match row.rate {
                Some(rate) => {
                    assert_eq!(report.outcome, IterationOutcome::Converged, "{}", row.name);
                    close(row.name, report.observed_rate.unwrap(), rate, 6e-5);
                    close(row.name, report.observed_rate.unwrap(), expected, 1e-6);
                    counts.push(steps_to(&report.path, &m.exact).unwrap());
                }
                None => assert_ne!(report.outcome, IterationOutcome::Converged, "{}", row.name),
            }
        }
        if let Some(steps) = row.steps {
            // They depend on the direction of the first error: how much of it is slow.
            let (least, most) = (counts.iter().min().unwrap(), counts.iter().max().unwrap());
            assert!(
                (*least..=*most).contains(&steps),
                "{}: {counts:?}",
                row.name
            );
        }
    }
}

#[test]
fn an_unstable_shape_is_left_for_the_stable_one() {
    for m in table().iter().filter(|m| m.row.name.contains("unstable")) {
        assert!(!m.exact.stability.stable);
        for report in &m.report {
            assert_eq!(report.outcome, IterationOutcome::Leaves);
            let end = report.equilibrium.as_ref().unwrap();
            assert!(end.stability.stable);
            // S stable, Delta 0.2.
            close("F_x", end.wrench.0[0], -1.03473, 6e-6);
            close("rate", report.expected_rate.unwrap(), 0.33259, 6e-6);
            assert!(report.words().contains("left the equilibrium"));
        }
    }
}

#[test]
fn under_tension_it_alternates_although_the_shape_is_stable() {
    for m in table().iter().filter(|m| m.row.name.contains("tension")) {
        assert!(m.exact.stability.stable);
        for report in &m.report {
            let IterationOutcome::Cycle(two) = &report.outcome else {
                panic!("{}", report.words());
            };
            let apart = |a: &ChainState, b: &ChainState| {
                let pairs = a.coordinates.iter().zip(&b.coordinates);
                largest_size(pairs.map(|(a, b)| a - b))
            };
            assert!(apart(&two[0], &two[1]) > 1e-3);
            // One more step from either lands on the other.
            let next = &report.path[report.path.len() - 3];
            assert!(apart(next, &two[1]) < 1e-9);
            assert!(report.words().contains("cycle of period 2"));
            assert!(report.equilibrium.is_none());
        }
    }
}

/// With preloaded springs (rest of the Z chain at 30 degrees) a step from the exact solution stays
/// there; without the term `- J_th th0`, as 4.16 is printed, it leaves by 0.52 rad.
#[test]
fn from_the_exact_solution_a_step_stays_there() {
    for m in table() {
        let (s, z) = (planar_column(3, 1.0, 1.0), z_chain());
        let chain = if m.row.name.starts_with('S') { &s } else { &z };
        let mut problem = held(chain, m.exact.tip.translation.vector.x);
        problem.posture.clone_from(&m.exact.coordinates);
        let exact = ChainState {
            coordinates: m.exact.coordinates.clone(),
            wrench: kinetostat::Wrench::zero(),
        };
        let settings = IterationSettings::default().with_steps(1);
        let one = report_iteration(&problem, Some(exact), &settings).unwrap();
        let moved = error(&one.path[1], &m.exact);
        assert!(moved < 1e-12, "{}: {moved:e}", m.row.name);
    }
}

/// A spatial chain of 15 coordinates (two full 6 x 6 springs, three passive joints) held with its
/// end turned: an end moment acts.
fn spatial(seed: u64) -> Option<(crate::common::RandomChain, EndCondition)> {
    let mut rng = Rng(seed);
    let recipe = Recipe {
        stages: 2,
        passive: 3,
        preload: 0.02,
        ..Recipe::default()
    };
    let r = random_chain(&mut rng, &recipe);
    let span = Twist::new(rng.axis() * 0.03, rng.axis() * 0.08);
    let end = EndCondition::pose(moved(&r.tip(), &span));
    (r.chain.coordinate_count() >= 15).then_some((r, end))
}

/// A spatial chain under an end moment, iterated both ways.
pub struct SpatialRun {
    pub moment: f64,
    /// Largest `|H_ij - H_ji - m.(w_j x w_i)|` as a share of the largest entry of `H`.
    pub rule: f64,
    /// Largest `|H_ij - H_ji|` as such a share.
    pub asymmetry: f64,
    pub report: ReportIteration,
    pub newton_errors: Vec<f64>,
    /// max |mu| by the oracle's matrices.
    pub mu: f64,
}

pub fn spatial_runs() -> Vec<SpatialRun> {
    (0..60)
        .filter_map(spatial)
        .filter_map(|(r, end)| {
            let problem = r.problem(end);
            let exact = solve_chain(&problem, &Settings::default()).ok()?;
            if !exact.stability.stable {
                return None;
            }
            assert_chain_equilibrium(&problem, &exact);
            Some(spatial_run(&problem, &exact))
        })
        .take(12)
        .collect()
}

fn spatial_run(problem: &ChainProblem<'_>, exact: &Equilibrium) -> SpatialRun {
    let chain = problem.chain;
    let n = chain.coordinate_count();
    let kinematics = Kinematics::new(chain, &problem.base, &exact.coordinates, &problem.commands);
    let h = kinematics.hessian(&[(chain.tip(), exact.wrench)]);
    let j = kinematics.jacobian(chain.tip());
    let w = |i: usize| j.fixed_view::<3, 1>(3, i).into_owned();
    let size = h.view((0, 0), (n, n)).largest_entry();
    let (mut rule, mut asymmetry) = (Worst::new(), Worst::new());
    // The rule speaks of elementary motions; a coordinate that drives two has no single axis.
    let single = |i: usize| {
        let drives = chain.elements().iter().filter(|e| {
            matches!(e, kinetostat::model::Element::Motion(m)
                if m.coordinate.is_some_and(|d| d.index == i))
        });
        drives.count() == 1
    };
    for a in (0..n).filter(|&i| single(i)) {
        for b in (0..n).filter(|&i| single(i)) {
            let expected = exact.wrench.moment().dot(&w(b).cross(&w(a)));
            let difference = h[(a, b)] - h[(b, a)];
            rule.add((difference - expected).abs() / size);
            asymmetry.add(difference.abs() / size);
        }
    }
    let mut rng = Rng(n as u64);
    let start = off(&mut rng, exact, 0.02);
    let settings = IterationSettings::default();
    let report = report_iteration(problem, Some(start.clone()), &settings).unwrap();
    let newton = newton_iteration(problem, Some(start), &settings).unwrap();
    SpatialRun {
        moment: exact.wrench.moment().norm(),
        rule: rule.value(),
        asymmetry: asymmetry.value(),
        report,
        newton_errors: newton.path.iter().map(|s| error(s, exact)).collect(),
        mu: oracle_rate(problem, exact),
    }
}

/// Spectral radius of `(N^T K N)^-1 N^T H N` with the oracle's kinematics and plain algebra.
fn oracle_rate(problem: &ChainProblem<'_>, e: &Equilibrium) -> f64 {
    let chain = problem.chain;
    let frames = Frames::new(chain, &problem.base, &e.coordinates, &problem.commands);
    let (_, k, _) = oracle::springs(chain, &e.coordinates, &problem.posture);
    let h = frames.hessian(&[(frames.tip(), e.wrench)]);
    let j = frames.jacobian(frames.tip());
    // Rotations and slides in comparable sizes.
    let n = k.nrows();
    let unit: Vec<f64> = (0..n)
        .map(|i| {
            if k[(i, i)] > 0.0 {
                k[(i, i)].powf(-0.5)
            } else {
                0.02
            }
        })
        .collect();
    let scaled = DMatrix::from_fn(6, n, |r, c| j[(r, c)] * unit[c]);
    let eigen = (scaled.transpose() * &scaled).symmetric_eigen();
    let most = eigen.eigenvalues.largest_entry();
    let null: Vec<_> = (0..n)
        .filter(|&i| eigen.eigenvalues[i] < 1e-13 * most)
        .map(|i| eigen.eigenvectors.column(i).into_owned())
        .collect();
    assert_eq!(null.len(), n - 6);
    let null = DMatrix::from_columns(&null);
    let scaled = |m: &DMatrix<f64>| DMatrix::from_fn(n, n, |a, b| m[(a, b)] * unit[a] * unit[b]);
    let below = null.transpose() * scaled(&k) * &null;
    let above = null.transpose() * scaled(&h) * &null;
    let m = below.lu().solve(&above).unwrap();
    // With an end: at equal absolute values the iteration may go on for ever.
    let schur = nalgebra::linalg::Schur::try_new(m, f64::EPSILON, 10_000);
    let eigenvalues = schur.expect("a Schur form").complex_eigenvalues();
    largest(eigenvalues.iter().map(|mu| mu.norm()))
}

/// Largest `e_{k+1} / e_k^2` where rounding plays no part, and the last error.
pub fn quadratic(errors: &[f64]) -> (f64, f64) {
    let constants = errors.windows(2).filter(|w| w[0] > 1e-7 && w[1] > 1e-13);
    let worst = largest(constants.map(|w| w[1] / (w[0] * w[0])));
    (worst, *errors.last().unwrap())
}

fn words(errors: &[f64]) -> String {
    let list: Vec<String> = errors.iter().map(|e| format!("{e:.1e}")).collect();
    list.join(" ")
}

#[test]
fn newton_is_quadratic_on_planar_and_spatial_chains() {
    let m = &table()[0];
    for newton in &m.newton {
        let errors: Vec<f64> = newton.path.iter().map(|s| error(s, &m.exact)).collect();
        let (constant, last) = quadratic(&errors);
        println!("S stable: {}", words(&errors));
        assert!(constant < 3.0 && last < 1e-12, "{}", words(&errors));
        assert!(errors.len() <= 6, "{}", words(&errors));
    }
    let runs = spatial_runs();
    assert!(runs.len() >= 8, "{}", runs.len());
    for run in runs {
        let (constant, last) = quadratic(&run.newton_errors);
        println!(
            "moment {:.1} N m, H - H^T {:.1e}, Newton {}, {}",
            run.moment,
            run.asymmetry,
            words(&run.newton_errors),
            run.report.words()
        );
        assert!(run.moment > 1.0 && run.asymmetry > 1e-4 && run.rule < 1e-12);
        assert!(
            constant < 20.0 && last < 1e-12,
            "{}",
            words(&run.newton_errors)
        );
        assert!(
            run.newton_errors.len() <= 6,
            "{}",
            words(&run.newton_errors)
        );
        assert_eq!(run.report.outcome, IterationOutcome::Converged);
        let (expected, observed) = (run.report.expected_rate, run.report.observed_rate);
        close("mu", expected.unwrap(), run.mu, 1e-7);
        // A fast iteration is over before its slowest mode is alone: then it is faster yet.
        let observed = observed.unwrap();
        assert!(observed < 1.05 * run.mu, "{observed} {}", run.mu);
        if run.mu > 0.1 {
            close("rate", observed, run.mu, 0.03 * run.mu);
        }
    }
}
