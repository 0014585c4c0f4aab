//! Which shapes hold: the inertia of the bordered matrix, the share mu of the way to buckling and the null-space criterion
//! by brute force say the same on both sides of every buckling load [R 5.16-5.21].

use crate::common::{
    Recipe, Rng, assert_chain_equilibrium, cases, close, golden, number, planar_column,
    random_chain,
};
use crate::oracle::{self, Frames};
use kinetostat::{
    BeamSection, Chain, ChainProblem, DirectionKind, EndCondition, Equilibrium, Load, MotionKind,
    Pose, PostureRequest, Prescribed, Settings, Twist, Wrench, solve_chain, spatial::moved,
};
use kinetostat::{Limb, Mechanism, Platform, machine::LimbPosture};
use kinetostat_testing::LargestEntry;
use nalgebra::{DMatrix, Matrix6, Vector3, vector};
use proptest::prelude::*;

/// Null space of the Jacobian from the eigenvectors of `J^T J`, scaled by the springs' size.
struct Brute {
    /// Eigenvalues of `N^T (H - K) N`, scaled.
    criterion: Vec<f64>,
    /// Eigenvalues of the pencil, if `N^T K N` is definite.
    shares_to_buckling: Option<Vec<f64>>,
}

fn brute(problem: &ChainProblem<'_>, e: &Equilibrium) -> Brute {
    let chain = problem.chain;
    let n = chain.coordinate_count();
    let frames = Frames::new(chain, &problem.base, &e.coordinates, &problem.commands);
    let (_, k, _) = oracle::springs(chain, &e.coordinates, &problem.posture);
    let mut wrenches = crate::common::invariants::node_wrenches(problem);
    wrenches.push((frames.tip(), e.wrench));
    let h = frames.hessian(&wrenches);
    let scale = chain.scale();
    let unit: Vec<f64> = (0..n)
        .map(|i| {
            if k[(i, i)] > 0.0 {
                1.0 / k[(i, i)].sqrt()
            } else {
                1.0 / (scale.stiffness.sqrt() * scale.length)
            }
        })
        .collect();
    let scaled = |m: &DMatrix<f64>| DMatrix::from_fn(n, n, |i, j| m[(i, j)] * unit[i] * unit[j]);
    let (h, k) = (scaled(&h), scaled(&k));
    let j = frames.jacobian(frames.tip());
    let row = |i: usize| if i < 3 { 1.0 } else { scale.length };
    let j = DMatrix::from_fn(6, n, |i, c| j[(i, c)] * row(i) * unit[c]);
    let eigen = (j.transpose() * &j).symmetric_eigen();
    let most = eigen.eigenvalues.largest_entry();
    let null: Vec<_> = (0..n)
        .filter(|&i| eigen.eigenvalues[i] < 1e-14 * most)
        .map(|i| eigen.eigenvectors.column(i).into_owned())
        .collect();
    if null.is_empty() {
        return Brute {
            criterion: vec![],
            shares_to_buckling: Some(vec![]),
        };
    }
    let null = DMatrix::from_columns(&null);
    let a = null.transpose() * (&h + h.transpose()) * 0.5 * &null;
    let b = null.transpose() * &k * &null;
    let shares_to_buckling = b.clone().cholesky().map(|c| {
        let inverse = c.l().try_inverse().unwrap();
        let m = &inverse * &a * inverse.transpose();
        let mut v: Vec<f64> = (0.5 * (&m + m.transpose()))
            .symmetric_eigenvalues()
            .iter()
            .copied()
            .collect();
        v.sort_by(f64::total_cmp);
        v
    });
    let criterion = (a - b).symmetric_eigenvalues().iter().copied().collect();
    Brute {
        criterion,
        shares_to_buckling,
    }
}

#[track_caller]
fn same_stability(label: &str, problem: &ChainProblem<'_>, e: &Equilibrium) {
    let b = brute(problem, e);
    let stable = b.criterion.iter().all(|x| *x < 0.0);
    let s = &e.stability;
    assert_eq!(
        s.stable, stable,
        "{label}: criterion {:?}, share {:?}",
        b.criterion, s.share_to_buckling
    );
    if let (Some(shares_to_buckling), Some(mu)) = (&b.shares_to_buckling, s.share_to_buckling) {
        close(
            &format!("{label}: mu"),
            mu,
            *shares_to_buckling.last().unwrap(),
            1e-7 * mu.abs().max(1.0),
        );
    }
    assert_eq!(
        s.share_to_buckling.is_none(),
        b.criterion.is_empty(),
        "{label}"
    );
    let rank = 6 - e.stiffness.count(DirectionKind::Rigid);
    if s.neutral.is_empty() {
        assert_eq!(
            s.inertia.positive == rank,
            stable,
            "{label}: inertia {:?}, rank {rank}",
            s.inertia
        );
    }
}

/// End on its line, pressed with `p`, free to turn.
fn pressed(chain: &Chain, x: f64, p: f64) -> ChainProblem<'_> {
    let mut end = EndCondition::pose(Pose::translation(x, 0.0, 0.0));
    end.prescribed[0] = Prescribed::Wrench;
    end.prescribed[5] = Prescribed::Wrench;
    end.wrench = Wrench::new(vector![-p, 0.0, 0.0], Vector3::zeros());
    ChainProblem::new(chain, end)
}

/// A passive motion that nothing pushes is taken out although others of the same joints are held by
/// the load: spin of a hanging ball, a hinge at a pulled tip, spin of a strut between two balls.
#[test]
fn what_is_neutral_is_taken_out_beside_what_the_load_holds() {
    let z = Vector3::z();
    let pendulum = Chain::builder("pendulum")
        .passive_spherical("ball")
        .spring("stretch", MotionKind::Prismatic, z, 1e5, 0.0)
        .translation(vector![0.0, 0.0, -1.0])
        .build()
        .unwrap();
    let pulled = Chain::builder("pulled")
        .passive("q", MotionKind::Revolute, z, 0.0)
        .translation(vector![1.0, 0.0, 0.0])
        .spring("t", MotionKind::Revolute, z, 10.0, 0.0)
        .translation(vector![1.0, 0.0, 0.0])
        .passive("e", MotionKind::Revolute, z, 0.0)
        .build()
        .unwrap();
    let rod = kinetostat::LinkSpec::beam(BeamSection::tube(2.1e11, 8.1e10, 0.02, 0.0), 1.0);
    let strut = Chain::builder("strut")
        .passive_spherical("a")
        .link_with("rod", &rod.segments(4))
        .passive_spherical("b")
        .build()
        .unwrap();
    // Everything free: all of it hangs on the load.
    for (chain, force) in [
        (&pendulum, vector![0.0, 0.0, -100.0]),
        (&pulled, vector![5.0, 0.0, 0.0]),
        (&strut, vector![8000.0, 0.0, 0.0]),
    ] {
        let end = EndCondition::wrench(Wrench::new(force, Vector3::zeros()));
        let problem = ChainProblem::new(chain, end);
        let search = kinetostat::equilibrium::SearchSettings::default()
            .with_fruitless(30)
            .with_starts(60);
        let bounds = kinetostat::equilibrium::Bounds::of(chain);
        let all = kinetostat::equilibria(&problem, &bounds, &search).unwrap();
        let lowest = &all.found[0];
        assert!(lowest.stable, "{}: the lowest must be stable", chain.name());
        let criterion =
            kinetostat::reference::shape_criterion(&problem, &lowest.equilibrium, 1.0).unwrap();
        let own = &criterion.eigenvalues;
        assert!(criterion.neutral > 0, "{}: {own:?}", chain.name());
        assert!(criterion.holds(), "{}: {own:?}", chain.name());
    }
    // Held in place, free to turn, pressed below and above Euler's load.
    let section = BeamSection::tube(2.1e11, 8.1e10, 0.02, 0.0);
    let euler = std::f64::consts::PI.powi(2) * 2.1e11 * section.second_moment_y;
    for (share, stable) in [(-3.0, true), (0.5, true), (0.99, true), (1.01, false)] {
        let force = vector![-share * euler, 0.0, 0.0];
        let mut end = EndCondition::wrench(Wrench::new(force, Vector3::zeros()));
        for k in [1, 2, 3, 4, 5] {
            end.prescribed[k] = Prescribed::Pose;
        }
        end.pose = Pose::translation(1.0, 0.0, 0.0);
        let e = solve_chain(&ChainProblem::new(&strut, end), &Settings::default()).unwrap();
        let s = &e.stability;
        assert_eq!(s.stable, stable, "{share}: {s:?}");
        assert!(!s.neutral.is_empty(), "{share}");
    }
}

#[test]
fn straight_columns_buckle_at_two_one_minus_cosine() {
    for n in 2..=6 {
        let (l, k) = (0.4, 50.0);
        let chain = planar_column(n, l, k);
        let loads: Vec<f64> = (1..n)
            .map(|m| 2.0 * (1.0 - (m as f64 * std::f64::consts::PI / n as f64).cos()) * k / l)
            .collect();
        for share in [-3.0, -0.5, 0.1, 0.9, 0.999, 1.001, 1.5, 10.0] {
            let p = share * loads[0];
            let problem = pressed(&chain, n as f64 * l, p);
            let e = solve_chain(&problem, &Settings::default()).unwrap();
            assert_chain_equilibrium(&problem, &e);
            let label = format!("{n} links at {share} of the first load");
            assert!(
                e.coordinates.iter().all(|x| x.abs() < 1e-9),
                "{label}: not straight"
            );
            // Compression: the lowest mode leads; tension: mu = P / P_last is the largest of negatives.
            let expected = if p > 0.0 {
                p / loads[0]
            } else {
                p / loads[n - 2]
            };
            close(
                &label,
                e.stability.share_to_buckling.unwrap(),
                expected,
                1e-9 * expected.abs().max(1.0),
            );
            assert_eq!(e.stability.stable, share < 1.0, "{label}");
            let beyond = loads.iter().filter(|c| p > **c).count();
            let rank = 6 - e.stiffness.count(DirectionKind::Rigid);
            assert_eq!(
                rank, 2,
                "{label}: a straight rigid chain moves along y and about z only"
            );
            assert_eq!(e.stability.inertia.positive, rank + beyond, "{label}");
            same_stability(&label, &problem, &e);
        }
    }
}

#[test]
fn three_link_shapes_of_figure_5_7() {
    let file = golden("figure_5_7.json");
    let chain = planar_column(3, 1.0, 1.0);
    for case in file["cases"].as_array().unwrap() {
        let delta = number(&case["delta"]);
        // Arch (both springs bend the same way) and zigzag.
        for (shape, sign) in [("stable", 1.0), ("unstable", -1.0)] {
            let own = &case[shape];
            let label = format!("{shape} at {delta}");
            let mut end = EndCondition::pose(Pose::translation(3.0 - delta, 0.0, 0.0));
            end.prescribed[5] = Prescribed::Wrench;
            let mut problem = ChainProblem::new(&chain, end);
            let a = if sign > 0.0 {
                (1.0 - 0.5 * delta).acos()
            } else {
                (delta / 3.0).sqrt()
            };
            problem.posture = if sign > 0.0 {
                vec![a, -a, -a, a]
            } else {
                vec![0.58 * a, -1.74 * a, 1.74 * a, -0.58 * a]
            };
            let e = solve_chain(&problem, &Settings::default())
                .unwrap_or_else(|x| panic!("{label}: {x}"));
            assert_chain_equilibrium(&problem, &e);
            close(&label, e.wrench.0[0], number(&own["F_x"]), 2e-8);
            close(
                &label,
                e.stiffness.cartesian.matrix[(0, 0)],
                number(&own["K_x"]),
                3e-8 * 10.0,
            );
            assert_eq!(e.stability.stable, shape == "stable", "{label}");
            same_stability(&label, &problem, &e);
            close(
                &label,
                shape_criterion(&problem, &e),
                number(&own["S_c"]),
                2e-7,
            );
        }
    }
}

/// The report's `S_c`: unit null vector of the rows x, y in order (th1, th2, q).
fn shape_criterion(problem: &ChainProblem<'_>, e: &Equilibrium) -> f64 {
    let frames = Frames::new(
        problem.chain,
        &problem.base,
        &e.coordinates,
        &problem.commands,
    );
    let (_, k, _) = oracle::springs(problem.chain, &e.coordinates, &problem.posture);
    let h = frames.hessian(&[(frames.tip(), e.wrench)]) - k;
    let j = frames.jacobian(frames.tip());
    let row = |i: usize| Vector3::new(j[(i, 0)], j[(i, 1)], j[(i, 2)]);
    let v = row(0).cross(&row(1)).normalize();
    (v.transpose() * h.fixed_view::<3, 3>(0, 0) * v)[0]
}

#[test]
fn all_equilibria_of_the_z_chain() {
    let file = golden("z_chain.json");
    let chain = Chain::builder("z")
        .passive("q", MotionKind::Revolute, Vector3::z(), 0.0)
        .translation(vector![1.0, 0.0, 0.0])
        .spring(
            "th1",
            MotionKind::Revolute,
            Vector3::z(),
            1.0,
            -30_f64.to_radians(),
        )
        .translation(vector![1.0, 0.0, 0.0])
        .spring(
            "th2",
            MotionKind::Revolute,
            Vector3::z(),
            1.0,
            30_f64.to_radians(),
        )
        .translation(vector![1.0, 0.0, 0.0])
        .passive("e", MotionKind::Revolute, Vector3::z(), 0.0)
        .build()
        .unwrap();
    let unloaded = (5.0 + 4.0 * 30_f64.to_radians().cos()).sqrt();
    for case in file["cases"].as_array().unwrap() {
        let n = |key: &str| number(&case[key]);
        let label = format!("delta {}, q {}", n("delta"), n("q_deg"));
        let mut end = EndCondition::pose(Pose::translation(unloaded - n("delta"), 0.0, 0.0));
        end.prescribed[5] = Prescribed::Wrench;
        let mut problem = ChainProblem::new(&chain, end);
        let (q, a, b) = (
            n("q_deg").to_radians(),
            n("theta1_deg").to_radians(),
            n("theta2_deg").to_radians(),
        );
        problem.posture = vec![q, a, b, -q - a - b];
        let e =
            solve_chain(&problem, &Settings::default()).unwrap_or_else(|x| panic!("{label}: {x}"));
        assert_chain_equilibrium(&problem, &e);
        close(&label, e.coordinates[0].to_degrees(), n("q_deg"), 2e-6);
        close(&label, e.wrench.0[0], n("F_x"), 2e-8);
        close(&label, e.stiffness.cartesian.matrix[(0, 0)], n("K_x"), 1e-6);
        close(
            &label,
            e.stability.share_to_buckling.unwrap(),
            n("mu"),
            1e-7,
        );
        close(&label, shape_criterion(&problem, &e), n("S_c"), 1e-7);
        assert_eq!(
            e.stability.stable,
            case["stable"].as_bool().unwrap(),
            "{label}"
        );
        same_stability(&label, &problem, &e);
    }
}

#[test]
fn pinned_columns_of_tr_springs_have_the_stated_critical_loads() {
    let file = golden("pinned_column.json");
    let (length, ei) = (1.0_f64, 1.0_f64);
    let euler = std::f64::consts::PI.powi(2) * ei / length.powi(2);
    for case in file["cases"].as_array().unwrap() {
        let n = case["segments"].as_u64().unwrap() as usize;
        let section = BeamSection {
            youngs_modulus: 1.0,
            shear_modulus: 1.0,
            area: 1e7,
            second_moment_y: 1e4,
            second_moment_z: ei,
            torsion_constant: 1e4,
        };
        let mut b = Chain::builder("column").passive("q", MotionKind::Revolute, Vector3::z(), 0.0);
        for i in 0..n {
            b = b.link(&format!("s{i}"), &section, length / n as f64);
        }
        let chain = b
            .passive("e", MotionKind::Revolute, Vector3::z(), 0.0)
            .build()
            .unwrap();
        // The share grows with the load: bisect mu = 1 from both stabilities.
        let share_to_buckling = |p: f64| {
            let problem = pressed(&chain, length, p);
            let e = solve_chain(&problem, &Settings::default()).unwrap();
            assert_chain_equilibrium(&problem, &e);
            if e.stability.share_to_buckling.unwrap().abs() < 0.999
                || e.stability.share_to_buckling.unwrap() > 1.001
            {
                same_stability(&format!("{n} segments at {p}"), &problem, &e);
            }
            (e.stability.share_to_buckling.unwrap(), e.stability.stable)
        };
        for (key, sign) in [("compression", 1.0), ("tension", -1.0)] {
            let Some(critical) = case[key].as_f64() else {
                if key == "compression" {
                    assert!(
                        share_to_buckling(50.0 * euler).1,
                        "one TR segment never buckles"
                    );
                }
                continue;
            };
            let (low, high) = (0.9 * critical * euler * sign, 1.1 * critical * euler * sign);
            assert!(
                share_to_buckling(low).1 && !share_to_buckling(high).1,
                "{n} segments, {key}"
            );
            let (mut a, mut c) = (low, high);
            for _ in 0..40 {
                let middle = 0.5 * (a + c);
                if share_to_buckling(middle).1 {
                    a = middle
                } else {
                    c = middle
                }
            }
            let found = 0.5 * (a + c) * sign / euler;
            // One unit of the last stated digit (the prototype had its own axial stiffness).
            let digits = case[key].to_string().split('.').nth(1).map_or(0, str::len);
            close(
                &format!("{n} segments, {key}"),
                found,
                critical,
                1.0 * 0.1_f64.powi(digits as i32),
            );
        }
    }
}

proptest! {
    #![proptest_config(cases(32))]
    #[test]
    fn stability_agrees_on_random_loaded_chains(seed in any::<u64>()) {
        let mut rng = Rng(seed);
        // Soft, so that some shapes are beyond buckling.
        let r = random_chain(&mut rng, &Recipe { stages: 2, passive: 2, k_t: 2e4, k_r: 60.0, preload: 0.0 });
        let target = moved(&r.tip(), &Twist::new(rng.vector(0.02), rng.vector(0.08)));
        let mut problem = r.problem(EndCondition::pose(target));
        problem.loads = vec![
            Load::Dead { node: rng.below(r.chain.nodes().len()), wrench: Wrench::new(rng.vector(150.0), Vector3::zeros()) },
        ];
        let Ok(e) = solve_chain(&problem, &Settings::default()) else { return Ok(()); };
        assert_chain_equilibrium(&problem, &e);
        same_stability("random", &problem, &e);
    }
}

#[test]
fn energy_around_a_column_has_a_minimum_below_its_load_and_none_above() {
    // A stable equilibrium of a held chain is a minimum of energy minus work of dead loads: sample
    // the neighbourhood along the most critical mode.
    let chain = planar_column(4, 1.0, 1.0);
    let critical = 2.0 * (1.0 - (std::f64::consts::PI / 4.0).cos());
    for (share, minimum) in [(0.95, true), (1.05, false)] {
        let problem = pressed(&chain, 4.0, share * critical);
        let e = solve_chain(&problem, &Settings::default()).unwrap();
        let mode = &e.stability.mode;
        let energy = |s: f64| {
            let x: Vec<f64> = e
                .coordinates
                .iter()
                .zip(mode)
                .map(|(x, m)| x + s * m)
                .collect();
            let frames = Frames::new(&chain, &problem.base, &x, &[]);
            let stored = oracle::springs(&chain, &x, &problem.posture).2;
            stored + share * critical * frames.position(frames.tip()).x
        };
        let change = energy(1e-3) + energy(-1e-3) - 2.0 * energy(0.0);
        assert_eq!(change > 0.0, minimum, "share {share}: {change:e}");
        let frames = Frames::new(&chain, &problem.base, &e.coordinates, &[]);
        let moved = frames.jacobian(frames.tip()) * nalgebra::DVector::from_row_slice(mode);
        assert!(
            moved.largest_entry() < 1e-9,
            "the mode moves the end: {moved}"
        );
    }
}

/// Two links in a row over a free middle platform with a torsion spring, pressed together by a
/// preloaded guide of the tool: a column whose buckling is the middle platform's affair.
fn pressed_middle_platform(p: f64, k: f64) -> Mechanism {
    let section = BeamSection {
        youngs_modulus: 1.0,
        shear_modulus: 1.0,
        area: 1e9,
        second_moment_y: 1e7,
        second_moment_z: 1e7,
        torsion_constant: 1e7,
    };
    let z = Vector3::z();
    let first = Chain::builder("first")
        .passive("q", MotionKind::Revolute, z, 0.0)
        .link("link", &section, 1.0)
        .spring("th", MotionKind::Revolute, z, k, 0.0)
        .build()
        .unwrap();
    let second = Chain::builder("second")
        .link("link", &section, 1.0)
        .passive("q", MotionKind::Revolute, z, 0.0)
        .build()
        .unwrap();
    let mut stiff = Matrix6::identity() * 1e8;
    stiff[(0, 0)] = 1e3;
    let guide = Chain::builder("guide")
        .translation(vector![2.0, 0.0, 0.0])
        .spring6("guide", &stiff, [-p / 1e3, 0.0, 0.0, 0.0, 0.0, 0.0])
        .build()
        .unwrap();
    let mut builder = Mechanism::builder("pressed");
    let middle = builder.platform(Platform::new("middle", Pose::translation(1.0, 0.0, 0.0)));
    let tool = builder.platform(Platform::new("tool", Pose::translation(2.0, 0.0, 0.0)));
    for (name, from, to, chain) in [
        ("first", 0, middle, first),
        ("second", middle, tool, second),
        ("guide", 0, tool, guide),
    ] {
        builder = builder.limb(Limb::between(name, from, to, chain));
    }
    builder.build().unwrap()
}

#[test]
fn a_middle_platform_that_buckles_makes_the_machine_unstable() {
    for (share, stable) in [(0.5, true), (0.9, true), (1.1, false), (2.0, false)] {
        let k = 100.0;
        let machine = pressed_middle_platform(share * 2.0 * k, k);
        let joints = machine
            .limbs()
            .iter()
            .map(|l| LimbPosture {
                commands: vec![],
                coordinates: l.nominal.home_coordinates(),
            })
            .collect();
        let posture = machine
            .posture(PostureRequest::joints(
                &Pose::translation(2.0, 0.0, 0.0),
                joints,
            ))
            .unwrap();
        let e = posture.deflected_by(&Wrench::zero()).unwrap();
        crate::common::assert_equilibrium(&posture, &e);
        assert!(
            e.state.platforms[1].translation.vector.y.abs() < 1e-9,
            "straight"
        );
        close("press", -e.limbs[0].wrench.0[0], share * 2.0 * k, 1e-3 * k);
        assert_eq!(
            e.stable(),
            stable,
            "{share} of the critical load: {:?}",
            e.platform
        );
    }
}
