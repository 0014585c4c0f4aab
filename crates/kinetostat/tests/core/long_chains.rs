//! Chains long enough to be solved by sweeps along them: checked by the oracle's kinematics and dense
//! matrices, by known closed forms, and by differences.

use kinetostat::{chain::Residual, model::LinkConvention, spatial::moved, *};
use kinetostat_testing::LargestEntry;
use nalgebra::{DMatrix, DVector, Matrix6, Rotation3, Vector3, vector};

use crate::common::invariants::assert_chain_equilibrium;
use crate::common::random::{RandomChain, Rng};
use crate::oracle::{Frames, chain_stiffness, springs};

fn bar() -> BeamSection {
    BeamSection::tube(2.1e11, 8.0e10, 0.03, 0.024)
}

/// Off-axis chain of links in segments, drives and joints, with nodes and masses; `stages` of about
/// ten coordinates each; every fourth link is of the convention `bent`.
fn long_chain(rng: &mut Rng, stages: usize, passive: usize, bent: LinkConvention) -> RandomChain {
    let mut builder = Chain::builder("long");
    for k in 0..stages {
        builder = builder.rigid(rng.pose(0.15, 1.0));
        let mut drive = ActuatorSpec::new(MotionKind::Revolute, rng.axis(), 8e4);
        drive.rest = 0.01 * rng.signed();
        builder = builder.actuator(&format!("a{k}"), drive);
        let link = LinkSpec::beam(bar(), rng.between(0.2, 0.5)).segments(1 + rng.below(2));
        let link = link.convention(
            [
                LinkConvention::TranslationsFirst,
                LinkConvention::RotationsFirst,
                LinkConvention::Middle,
                bent,
            ][k % 4],
        );
        builder = builder
            .link_with(&format!("l{k}"), &link)
            .node(&format!("n{k}"))
            .body(
                &format!("m{k}"),
                rng.between(2.0, 9.0),
                rng.vector(0.1),
                nalgebra::Matrix3::identity(),
            );
        if k < passive {
            let kind = if k == 2 {
                MotionKind::Prismatic
            } else {
                MotionKind::Revolute
            };
            builder = builder.passive(&format!("q{k}"), kind, rng.axis(), 0.0);
        }
    }
    let chain = builder.rigid(rng.pose(0.2, 1.0)).build().unwrap();
    RandomChain {
        base: rng.pose(0.5, 2.0),
        commands: chain
            .actuators()
            .iter()
            .map(|_| 0.4 * rng.signed())
            .collect(),
        posture: chain.home_coordinates(),
        chain,
    }
}

fn loads(rng: &mut Rng, chain: &Chain, moments: f64) -> Vec<Load> {
    let inner = chain.node("n2").unwrap();
    vec![
        Load::gravity(vector![0.0, 0.0, -9.81]),
        Load::dead(inner, rng.wrench(300.0, moments)),
    ]
}

/// Wrenches on all nodes, the end's included.
fn wrenches(problem: &ChainProblem<'_>, e: &Equilibrium) -> Vec<(usize, Wrench)> {
    let mut all = crate::common::invariants::node_wrenches(problem);
    all.push((problem.chain.tip(), e.wrench));
    all
}

/// What deflection changed in the springs' tangent: the tangent less the one at rest.
fn at_rest(chain: &Chain, posture: &[f64]) -> DMatrix<f64> {
    let n = chain.coordinate_count();
    let mut k = DMatrix::zeros(n, n);
    for block in chain.springs() {
        let own = block.stiffness_at(posture);
        k.view_mut((block.first, block.first), own.shape())
            .copy_from(&own);
    }
    k
}

/// Largest eigenvalue of `(N^T H N) v = mu (N^T K N) v`, dense, from the oracle's derivatives.
fn oracle_share(problem: &ChainProblem<'_>, e: &Equilibrium) -> f64 {
    let chain = problem.chain;
    let frames = Frames::new(chain, &problem.base, &e.coordinates, &problem.commands);
    let (_, tangent, _) = springs(chain, &e.coordinates, &problem.posture);
    let rest = at_rest(chain, &problem.posture);
    let h = frames.hessian(&wrenches(problem, e));
    let n = chain.coordinate_count();
    let h = 0.5 * (h.view((0, 0), (n, n)) + h.view((0, 0), (n, n)).transpose()) - (tangent - &rest);
    // Passive joints in the unit of a typical turn.
    let unit: Vec<f64> = (0..n)
        .map(|i| {
            if rest[(i, i)] > 0.0 {
                rest[(i, i)].sqrt().recip()
            } else {
                1e-2
            }
        })
        .collect();
    let scaled = |m: &DMatrix<f64>| DMatrix::from_fn(n, n, |i, j| m[(i, j)] * unit[i] * unit[j]);
    let j = frames.jacobian(frames.tip());
    let mut columns = DMatrix::zeros(n, n + 6);
    for i in 0..n {
        for k in 0..6 {
            columns[(i, k)] = j[(k, i)] * unit[i];
        }
        columns[(i, 6 + i)] = 1.0;
    }
    let null = columns.qr().q().columns(6, n - 6).into_owned();
    let a = null.transpose() * scaled(&h) * &null;
    let b = null.transpose() * scaled(&rest) * &null;
    let l = b.cholesky().unwrap().l();
    let half = l.solve_lower_triangular(&a).unwrap();
    let reduced = l.solve_lower_triangular(&half.transpose()).unwrap();
    (0.5 * (&reduced + reduced.transpose()))
        .symmetric_eigenvalues()
        .max()
}

fn scaled(m: &Matrix6<f64>, length: f64) -> Matrix6<f64> {
    let unit = |i: usize| if i < 3 { 1.0 } else { 1.0 / length };
    Matrix6::from_fn(|i, j| m[(i, j)] * unit(i) * unit(j))
}

#[test]
fn equilibria_of_long_chains_hold_before_the_oracle() {
    let mut rng = Rng(0x10c);
    let mut solved = 0;
    for case in 0..10 {
        let moments = if case % 2 == 0 { 60.0 } else { 0.0 };
        let r = long_chain(&mut rng, 7 + case % 3, case % 5, LinkConvention::Middle);
        let mut end = EndCondition::pose(Pose::new(rng.vector(0.01), rng.vector(0.03)) * r.tip());
        end.wrench = rng.wrench(300.0, moments);
        if case % 3 == 1 {
            end.axes = Rotation3::new(rng.vector(2.0));
            end.prescribed[case % 6] = Prescribed::Wrench;
            end.prescribed[(case + 3) % 6] = Prescribed::Wrench;
        }
        let mut problem = r.problem(end);
        problem.loads = loads(&mut rng, &r.chain, moments);
        assert!(r.chain.coordinate_count() >= 60);
        let Ok(e) = solve_chain(&problem, &Settings::default()) else {
            continue;
        };
        solved += 1;
        assert_chain_equilibrium(&problem, &e);
        let frames = Frames::new(&r.chain, &r.base, &e.coordinates, &r.commands);
        let (_, k, _) = springs(&r.chain, &e.coordinates, &r.posture);
        let all = wrenches(&problem, &e);
        let expected = chain_stiffness(&r.chain, &frames, &k, &all);
        let length = r.chain.scale().length;
        let (found, expected) = (
            scaled(&e.stiffness.cartesian.matrix, length),
            scaled(&expected, length),
        );
        let off = (found - expected).largest_entry();
        assert!(
            off < 1e-8 * expected.largest_entry(),
            "{case}: K_C off by {off:.2e}"
        );
        let (found, expected) = (
            e.stability.share_to_buckling.unwrap(),
            oracle_share(&problem, &e),
        );
        assert!(
            (found - expected).abs() < 1e-9 * expected.abs().max(1.0),
            "{case}: mu {found} {expected}"
        );
        let mode = DVector::from_row_slice(&e.stability.mode);
        let moved = frames.jacobian(frames.tip()) * mode;
        assert!(
            moved.largest_entry() < 1e-8 * length,
            "{case}: the mode moves the end"
        );
    }
    assert!(solved >= 8, "{solved} of 10 solved");
}

#[test]
fn stiffness_of_long_chains_is_the_derivative_of_the_wrench() {
    let mut rng = Rng(0x20c);
    for case in 0..3 {
        let r = long_chain(&mut rng, 7, case, LinkConvention::Bowing);
        let target = Pose::new(rng.vector(0.005), rng.vector(0.02)) * r.tip();
        let mut problem = r.problem(EndCondition::pose(target));
        problem.loads = loads(&mut rng, &r.chain, 40.0);
        let here = solve_chain(&problem, &Settings::default()).unwrap();
        let k = here.stiffness.cartesian.matrix;
        let length = r.chain.scale().length;
        for direction in 0..6 {
            let unit = if direction < 3 { length } else { 1.0 };
            let mut at = |share: f64| {
                let mut twist = Twist::zero();
                twist.0[direction] = share * 2e-4 * unit;
                problem.end.pose = moved(&target, &twist);
                solve_chain(&problem, &Settings::default())
                    .unwrap()
                    .wrench
                    .0
            };
            let slope = (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / (24e-4 * unit);
            let column = k.column(direction);
            for i in 0..6 {
                let arm = if i < 3 { 1.0 } else { length };
                let size = scaled(&k, length).largest_entry()
                    * arm
                    * if direction < 3 { 1.0 } else { length };
                assert!(
                    (slope[i] - column[i]).abs() < 1e-7 * size,
                    "{case}, {i} {direction}: {} {}",
                    slope[i],
                    column[i]
                );
            }
        }
    }
}

#[test]
fn a_column_of_many_segments_buckles_at_eulers_load() {
    let section = bar();
    let stiff = section.youngs_modulus * section.second_moment_y;
    let euler = std::f64::consts::PI.powi(2) * stiff;
    for segments in [12, 40, 120] {
        let chain = Chain::builder("column")
            .passive("foot", MotionKind::Revolute, Vector3::z(), 0.0)
            .link_with("bar", &LinkSpec::beam(section, 1.0).segments(segments))
            .build()
            .unwrap();
        // Pushed along x, free to turn about z, held sideways.
        let mut end = EndCondition::pose(Pose::translation(1.0, 0.0, 0.0));
        end.prescribed[5] = Prescribed::Wrench;
        end.prescribed[0] = Prescribed::Wrench;
        end.wrench = Wrench::new(vector![-0.5 * euler, 0.0, 0.0], Vector3::zeros());
        end.pose = Pose::identity();
        end.prescribed[1] = Prescribed::Pose;
        let problem = ChainProblem::new(&chain, end);
        let e = solve_chain(&problem, &Settings::default()).unwrap();
        // Held at both ends against turning about y, hinged about z; the tip held fast for the
        // stability of the shape: hinged and clamped in the plane of the hinge, 2.0457 Euler loads.
        let share_to_buckling = e.stability.share_to_buckling.unwrap();
        let expected = 0.5 / 2.045_748;
        assert!(
            (share_to_buckling - expected).abs() < 2e-3 * expected,
            "{segments}: {share_to_buckling} {expected}"
        );
        assert!(e.stability.stable);
        assert_eq!(e.nodes.len(), chain.nodes().len());
    }
}

#[test]
fn answers_converge_as_the_same_bar_gets_more_segments() {
    let at = |segments: usize| {
        let chain = Chain::builder("bar")
            .link_with("bar", &LinkSpec::beam(bar(), 1.0).segments(segments))
            .build()
            .unwrap();
        let mut end = EndCondition::wrench(Wrench::new(
            vector![-2000.0, 1500.0, 900.0],
            vector![30.0, 0.0, 20.0],
        ));
        end.pose = Pose::identity();
        let problem = ChainProblem::new(&chain, end);
        let e = solve_chain(&problem, &Settings::default()).unwrap();
        assert!(e.residual.torque < 1e-9 && e.residual.closure_m < 1e-12);
        assert_eq!(e.stiffness.rank, 6);
        let place = e.tip.translation.vector;
        [
            place.x,
            place.y,
            place.z,
            e.stability.share_to_buckling.unwrap(),
            e.energy,
        ]
    };
    let [few, more, most] = [20, 60, 180].map(at);
    for k in 0..5 {
        // At least linear in the length of a segment.
        let (coarse, fine) = ((few[k] - most[k]).abs(), (more[k] - most[k]).abs());
        assert!(fine < 0.3 * coarse + 1e-9, "{k}: {coarse:.2e} {fine:.2e}");
        assert!(
            fine < 1e-2 * most[k].abs(),
            "{k}: {fine:.2e} of {:.2e}",
            most[k]
        );
    }
}

#[test]
fn newton_is_quadratic_where_some_rotations_are_free_and_large() {
    // Two rotations held, the third free and turned by more than a radian; short and long.
    for segments in [4, 16] {
        let soft = BeamSection {
            youngs_modulus: 1.0,
            shear_modulus: 1.0,
            area: 1e4,
            second_moment_y: 1.0,
            second_moment_z: 1.0,
            torsion_constant: 1.0,
        };
        let chain = Chain::builder("soft")
            .link_with("bar", &LinkSpec::beam(soft, 1.0).segments(segments))
            .build()
            .unwrap();
        let mut end =
            EndCondition::wrench(Wrench::new(vector![0.0, 0.4, 0.3], vector![0.0, 0.0, 1.4]));
        end.pose = Pose::new(Vector3::zeros(), vector![0.2, 0.1, 0.0]);
        end.prescribed[3] = Prescribed::Pose;
        end.prescribed[4] = Prescribed::Pose;
        let problem = ChainProblem::new(&chain, end);
        let e = solve_chain(&problem, &Settings::default()).unwrap();
        let turned = e.tip.rotation.angle();
        println!("{segments}: {turned} rad, {:?}", e.residual);
        assert!(turned > 1.0, "{turned}");
        assert!(e.residual.rate.unwrap() < 0.02, "{:?}", e.residual);
        assert!(e.residual.iterations <= 14, "{:?}", e.residual);
    }
}

#[test]
fn the_rate_observed_falls_towards_zero_for_newton() {
    let mut rng = Rng(0x30c);
    let r = long_chain(&mut rng, 7, 0, LinkConvention::Bowing);
    let mut problem = r.problem(EndCondition::wrench(rng.wrench(500.0, 80.0)));
    problem.loads = loads(&mut rng, &r.chain, 40.0);
    let newton = solve_chain(&problem, &Settings::default()).unwrap();
    assert!(
        newton.residual.rate.unwrap() < 1e-2,
        "{:?}",
        newton.residual
    );
    // The report's own steps converge at a rate; it is max |mu| of the shape with its end free.
    let settings = Settings::default().with_picard_steps(usize::MAX);
    let report = solve_chain(&problem, &settings).unwrap();
    let rate = report.residual.rate.unwrap();
    assert!(
        rate > newton.residual.rate.unwrap() && rate < 1.0,
        "{:?}",
        report.residual
    );
    assert!(report.residual.iterations > newton.residual.iterations);
    // Files written before the field existed are still read.
    let old = r#"{"closure_m":0.0,"torque":1e-12,"iterations":4}"#;
    let read: Residual = serde_json::from_str(old).unwrap();
    assert_eq!((read.iterations, read.rate), (4, None));
}

#[test]
fn absurd_questions_to_long_chains_end_in_words() {
    let mut rng = Rng(0x40c);
    let (mut answered, mut refused) = (0, 0);
    for case in 0..6 {
        let r = long_chain(&mut rng, 7, case, LinkConvention::Bowing);
        let force = [1e5, 1e8, 1e20, 1e120, 1e200, 1e300][case];
        let mut end = EndCondition::wrench(rng.wrench(force, force));
        end.pose = r.tip();
        if case % 2 == 0 {
            end.prescribed[case] = Prescribed::Pose;
        }
        let settings = Settings::default()
            .with_iterations(15)
            .with_smallest_load_step(0.1);
        match solve_chain(&r.problem(end), &settings) {
            Ok(e) => {
                answered += 1;
                assert!(e.coordinates.iter().all(|x| x.is_finite()));
                assert!(e.stiffness.cartesian.matrix.iter().all(|x| x.is_finite()));
                assert!(!e.stability.share_to_buckling.unwrap_or(0.0).is_nan());
            }
            Err(error) => {
                refused += 1;
                assert!(error.to_string().len() > 20, "{error}");
            }
        }
    }
    println!("{answered} answered, {refused} refused");
}

/// Cantilever of unit bending stiffness and length, `EA L^2 / EI = 1e6`.
fn slender(segments: usize) -> Chain {
    let rod = BeamSection {
        youngs_modulus: 1.0,
        shear_modulus: 0.4,
        area: 1e6,
        second_moment_y: 1.0,
        second_moment_z: 1.0,
        torsion_constant: 0.8,
    };
    Chain::builder("rod")
        .link_with("rod", &LinkSpec::beam(rod, 1.0).segments(segments))
        .build()
        .unwrap()
}

#[test]
fn iterations_do_not_grow_with_the_number_of_segments() {
    // Loads on the tip from moderate to far beyond anything linear, in a plane and in space.
    let across = |p: f64| Wrench::new(vector![0.0, p, 0.0], Vector3::zeros());
    let askew = |p: f64| {
        Wrench::new(
            vector![0.1, 0.8, 0.6] * p,
            vector![0.3, -0.1, 0.2] * p.sqrt(),
        )
    };
    let turn = std::f64::consts::TAU;
    let rolled = |share: f64| Wrench::new(Vector3::zeros(), vector![0.0, 0.0, share * turn]);
    for (wrench, most) in [
        (across(1.0), 4),
        (across(10.0), 6),
        (across(100.0), 11),
        (askew(1.0), 4),
        (askew(10.0), 8),
        (askew(100.0), 14),
        (rolled(0.5), 2),
        (rolled(0.99), 2),
    ] {
        let solved = [8, 32, 128, 256].map(|segments| {
            let chain = slender(segments);
            let problem = ChainProblem::new(&chain, EndCondition::wrench(wrench));
            let e = solve_chain(&problem, &Settings::default()).unwrap();
            assert!(e.residual.torque < 1e-9, "{segments}: {:?}", e.residual);
            assert!(e.stability.stable, "{segments}");
            (e.residual.iterations, e.tip.translation.vector)
        });
        println!("{:?}: {:?}", wrench.0, solved.map(|s| s.0));
        assert!(solved.iter().all(|s| s.0 <= most), "{wrench:?}: {solved:?}");
        // All on one branch.
        let end = solved[3].1;
        assert!(solved[1..].iter().all(|s| (s.1 - end).norm() < 5e-4));
    }
    // Published elastica, P L^2 / EI = 10.
    let chain = slender(256);
    let problem = ChainProblem::new(&chain, EndCondition::wrench(across(10.0)));
    let e = solve_chain(&problem, &Settings::default()).unwrap();
    assert!((e.tip.translation.vector.y - 0.810_609_024_880).abs() < 1e-4);
}
