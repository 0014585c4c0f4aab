//! Equilibria, stability and curves of chains by sweeps against the same by dense matrices, and which of the two
//! methods a chain gets.

use crate::internal::sweeps::{Rng, loads, random, two};
use kinetostat::{
    continuation::LoadPattern,
    internal::{
        ChainCurve, ChainMethod, CurveState, EndMotions, SWEEP_FROM, System, chain_stiffness,
        column_space, scaled_jacobian, scales_of, shape, solve_along, stability_within,
        swept_stiffness,
    },
    model::unloaded_tip,
    *,
};
use kinetostat_testing::{LargestEntry, Worst, largest_size};
use nalgebra::{DMatrix, DVector, Vector3, Vector6, vector};

#[track_caller]
fn assert_same(a: &Equilibrium, b: &Equilibrium, chain: &Chain, case: &str) {
    let scale = chain.scale();
    let unit = |i: usize| if i < 3 { 1.0 } else { scale.length };
    let close = |a: f64, b: f64, size: f64, what: &str| {
        assert!(
            (a - b).abs() <= 1e-9 * size,
            "{case}, {what}: {a:e} {b:e} of {size:e}"
        );
    };
    let most = |v: &[f64]| largest_size(v.iter().copied());
    for (x, y) in a.coordinates.iter().zip(&b.coordinates) {
        close(*x, *y, most(&a.coordinates), "coordinate");
    }
    let scaled = |e: &Equilibrium| {
        let m = e.stiffness.cartesian.matrix;
        nalgebra::Matrix6::from_fn(|i, j| m[(i, j)] / (unit(i) * unit(j)))
    };
    let (ka, kb) = (scaled(a), scaled(b));
    for (x, y) in ka.iter().zip(kb.iter()) {
        close(*x, *y, ka.largest_entry(), "stiffness");
    }
    for (x, y) in [
        (&a.stiffness.springs, &b.stiffness.springs),
        (&a.stiffness.passive, &b.stiffness.passive),
    ] {
        assert_eq!(x.shape(), y.shape());
        if !x.is_empty() {
            assert!(
                (x - y).largest_entry() <= 1e-9 * x.largest_entry(),
                "{case}: motions of coordinates"
            );
        }
    }
    assert_eq!(a.stiffness.rank, b.stiffness.rank, "{case}");
    assert_eq!(a.stability.inertia, b.stability.inertia, "{case}");
    assert_eq!(a.stability.stable, b.stability.stable, "{case}");
    let (ma, mb) = (
        a.stability.share_to_buckling.expect("a share"),
        b.stability.share_to_buckling.expect("a share"),
    );
    close(ma, mb, ma.abs().max(1.0), "a share");
}

/// Cosine of the angle between two modes in the given units.
fn alignment(a: &[f64], b: &[f64], scales: &[f64]) -> f64 {
    let v = |m: &[f64]| DVector::from_fn(m.len(), |i, _| m[i] / scales[6 + i]);
    v(a).normalize().dot(&v(b).normalize()).abs()
}

#[test]
fn equilibria_and_stability_are_those_of_the_dense_path() {
    let mut rng = Rng(4);
    let (mut held, mut free) = (0, 0);
    for case in 0..60 {
        let passive = case % 5;
        let chain = random(&mut rng, 4 + case % 6, passive, 1.0);
        let wrench = rng.wrench(400.0, if case % 2 == 0 { 80.0 } else { 0.0 });
        let moved = Pose::new(rng.vector(0.004), rng.vector(0.02));
        let tip = unloaded_tip(
            &chain,
            &Pose::identity(),
            &chain.home_coordinates(),
            &chain.home_commands(),
        );
        let mut end = EndCondition::pose(moved * tip);
        end.wrench = wrench;
        if case % 3 == 0 {
            end.axes = nalgebra::Rotation3::new(rng.vector(1.0));
            for k in 0..6 {
                if (case / 3 + k) % 2 == 0 && passive == 0 {
                    end.prescribed[k] = Prescribed::Wrench;
                }
            }
        }
        let mut problem = ChainProblem::new(&chain, end);
        problem.loads = loads(&mut rng, &chain, case % 2 == 0);
        let both = [ChainMethod::Dense, ChainMethod::Sweep]
            .map(|method| solve_along(&problem, &Settings::default(), Some(method)));
        let [Ok((dense, _)), Ok((swept, method))] = both else {
            continue;
        };
        assert_eq!(method, ChainMethod::Sweep, "{case}");
        assert_same(&dense, &swept, &chain, &format!("case {case}"));
        let scales = scales_of(&chain, &problem.posture);
        let cosine = alignment(&dense.stability.mode, &swept.stability.mode, &scales);
        assert!(cosine > 1.0 - 1e-6, "{case}: mode {cosine}");
        if passive > 0 { held += 1 } else { free += 1 }
    }
    assert!(held > 30 && free > 8, "{held} {free}");
}

/// A column of links in segments between hinges about y and z, pushed together.
fn column(segments: usize, shortening: f64) -> (Chain, EndCondition) {
    let (b, h) = (0.01_f64, 0.012_f64);
    let bar = BeamSection {
        youngs_modulus: 2.1e11,
        shear_modulus: 8.0e10,
        area: b * h,
        second_moment_y: b * h.powi(3) / 12.0,
        second_moment_z: h * b.powi(3) / 12.0,
        torsion_constant: 0.2 * h * b.powi(3),
    };
    let chain = Chain::builder("column")
        .passive_universal("root", Vector3::y(), Vector3::z())
        .link_with("bar", &LinkSpec::beam(bar, 1.0).segments(segments))
        .passive_universal("head", Vector3::y(), Vector3::z())
        .build()
        .expect("column");
    (
        chain,
        EndCondition::pose(Pose::translation(1.0 - shortening, 0.0, 0.0)),
    )
}

#[test]
fn buckled_and_straight_columns_get_the_same_stability() {
    for (segments, share) in [
        (4, -0.5),
        (4, 0.5),
        (8, 0.97),
        (8, 1.02),
        (12, 3.0),
        (16, 6.0),
    ] {
        // Shortening under the Euler load of the softer plane.
        let euler = std::f64::consts::PI.powi(2) * 0.01_f64.powi(2) / 12.0;
        let (chain, end) = column(segments, share * euler);
        let problem = ChainProblem::new(&chain, end);
        let [dense, swept] = [ChainMethod::Dense, ChainMethod::Sweep].map(|method| {
            solve_along(&problem, &Settings::default(), Some(method)).expect("equilibrium")
        });
        assert_eq!(swept.1, ChainMethod::Sweep);
        assert_same(&dense.0, &swept.0, &chain, &format!("{segments} {share}"));
        assert_eq!(swept.0.stability.stable, share < 1.0, "{share}");
        println!(
            "{segments} {share}: {:?}",
            swept.0.stability.share_to_buckling
        );
    }
}

#[test]
fn an_unstable_inertia_is_counted_whatever_the_shape() {
    // States, not equilibria: far from rest, many eigenvalues of both signs.
    let mut rng = Rng(5);
    let mut unstable = 0;
    for case in 0..40 {
        let chain = random(&mut rng, 3 + case % 4, case % 3, 1.0);
        let loads = loads(&mut rng, &chain, true);
        let (dense, swept, scales) = two(&mut rng, &chain, &loads, 12.0);
        let jacobian = scaled_jacobian(&dense, &scales);
        let sweep = swept.sweep.as_ref().expect("stages");
        let range = column_space(&jacobian);
        // The whole end held, some directions of it, nothing.
        let mut directions = Rng(100 + case as u64);
        for k in 0..=6 {
            let held = DMatrix::from_fn(6, k, |_, _| directions.next()).qr().q();
            let expected = stability_within(
                &chain,
                &dense,
                &scales,
                &(held.transpose() * &jacobian),
                true,
            );
            let ends = match k {
                6 => EndMotions::held(range.clone()),
                _ => EndMotions::held_in(range.clone(), &held),
            };
            assert_eq!(ends.held_count(), k.min(range.ncols()), "{case} {k}");
            let share_to_buckling = expected.share_to_buckling.expect("share_to_buckling");
            let Some(shape) = shape(sweep, &ends) else {
                // A passive joint that only the end held.
                assert!(k < 6 && case % 3 > 0, "{case} {k}");
                continue;
            };
            assert_eq!(expected.inertia, shape.inertia, "{case} {k}");
            unstable += usize::from(k == 6 && share_to_buckling > 1.0);
            let off = (share_to_buckling - shape.share_to_buckling).abs()
                / share_to_buckling.abs().max(1.0);
            assert!(
                off < 1e-8,
                "{case} {k}: {share_to_buckling} {}",
                shape.share_to_buckling
            );
        }
    }
    println!("{unstable} of 40 unstable");
    assert!((5..40).contains(&unstable), "{unstable}");
}

#[test]
fn what_a_sweep_cannot_do_is_done_densely() {
    let mut rng = Rng(6);
    let method = |chain: &Chain, loads: Vec<Load>| {
        let mut problem = ChainProblem::new(chain, EndCondition::wrench(Wrench::zero()));
        problem.end.wrench = Wrench::new(vector![1.0, 2.0, 3.0], Vector3::zeros());
        problem.loads = loads;
        let (e, method) = solve_along(&problem, &Settings::default(), None).expect("equilibrium");
        assert!(e.stiffness.cartesian.matrix.iter().all(|x| x.is_finite()));
        method
    };
    let long = random(&mut rng, 8, 0, 0.0);
    assert_eq!(method(&long, Vec::new()), ChainMethod::Sweep);
    assert_eq!(
        method(&random(&mut rng, 2, 0, 0.0), Vec::new()),
        ChainMethod::Dense
    );
    let nodes = [
        long.node("n1").expect("node"),
        long.node("n5").expect("node"),
    ];
    let across = Load::spring_between(Anchor::node(nodes[0]), Anchor::node(nodes[1]), 1e3, 0.1);
    assert_eq!(method(&long, vec![across]), ChainMethod::Dense);
    // One coordinate, two motions.
    let bar = BeamSection::tube(2.1e11, 8.0e10, 0.03, 0.024);
    let coupled = Chain::builder("coupled")
        .link_with("a", &LinkSpec::beam(bar, 0.5).segments(12))
        .spring("c", MotionKind::Revolute, Vector3::z(), 1e4, 0.0)
        .link("b", &bar, 0.3)
        .coupled("c", MotionKind::Revolute, Vector3::z(), -1.0)
        .build()
        .expect("chain");
    assert_eq!(method(&coupled, Vec::new()), ChainMethod::Dense);
    // A strut that spins between its balls.
    let strut = Chain::builder("strut")
        .passive_spherical("foot")
        .link_with("bar", &LinkSpec::beam(bar, 1.0).segments(12))
        .passive_spherical("head")
        .build()
        .expect("chain");
    let mut problem = ChainProblem::new(
        &strut,
        EndCondition::pose(Pose::translation(1.0 - 1e-5, 0.0, 0.0)),
    );
    problem.posture[0] = 0.0;
    let (e, method) = solve_along(&problem, &Settings::default(), None).expect("equilibrium");
    assert_eq!(method, ChainMethod::Dense);
    assert_eq!(e.stability.neutral.len(), 2, "{:?}", e.stability.neutral);
}

#[test]
fn planar_chains_of_joints_have_rigid_directions_on_both_paths() {
    let mut builder = Chain::builder("planar");
    for k in 0..20 {
        builder = builder
            .spring(
                &format!("j{k}"),
                MotionKind::Revolute,
                Vector3::z(),
                50.0,
                0.0,
            )
            .translation(vector![0.05, 0.0, 0.0]);
    }
    let chain = builder.build().expect("chain");
    let mut problem = ChainProblem::new(&chain, EndCondition::wrench(Wrench::zero()));
    problem.end.wrench = Wrench::new(vector![-3.0, 8.0, 0.0], vector![0.0, 0.0, 2.0]);
    for held in [false, true] {
        if held {
            problem.end =
                EndCondition::pose(Pose::new(vector![0.8, 0.2, 0.0], vector![0.0, 0.0, 0.6]));
        }
        let [dense, swept] = [ChainMethod::Dense, ChainMethod::Sweep].map(|method| {
            solve_along(&problem, &Settings::default(), Some(method)).expect("equilibrium")
        });
        assert_eq!(swept.1, ChainMethod::Sweep);
        assert_same(&dense.0, &swept.0, &chain, &format!("planar, held {held}"));
        assert_eq!(swept.0.stiffness.count(DirectionKind::Rigid), 3);
    }
}

/// Steps, tangents and determinants of curves, by a sweep and dense, far from equilibrium too.
#[test]
fn curves_are_alike_by_sweeps_and_dense() {
    let mut rng = Rng(17);
    let (mut signs, mut worst) = ([0, 0], Worst::new());
    for case in 0..40 {
        let chain = random(&mut rng, 11 + case % 4, case % 3, 1.0);
        assert!(chain.coordinate_count() >= SWEEP_FROM);
        let mut wrench = Vector6::from_fn(|_, _| 30.0 * rng.next());
        let mut problem = ChainProblem::new(&chain, EndCondition::wrench(Wrench(wrench)));
        problem.loads = loads(&mut rng, &chain, true);
        for k in 0..6 {
            if (case + k) % 3 == 0 {
                problem.end.prescribed[k] = Prescribed::Pose;
                wrench[k] = 0.0;
            }
        }
        problem.end.wrench = Wrench(wrench);
        let held: Vec<usize> = (0..6)
            .filter(|&k| problem.end.prescribed[k] == Prescribed::Pose)
            .collect();
        let moved = held[case % held.len()];
        let parameter = match case % 2 {
            0 => Parameter::along(&problem.end.axes, moved),
            _ => Parameter::Load(LoadPattern {
                end: Wrench(wrench * 0.3),
                loads: loads(&mut rng, &chain, true),
            }),
        };
        let mut dense = ChainCurve::dense(&problem, &parameter).unwrap();
        let mut swept = ChainCurve::swept(&problem, &parameter).unwrap();
        let m = dense.count();
        let mut direction = || {
            let v = DVector::from_fn(m + 1, |_, _| rng.next());
            v.normalize()
        };
        let (z, guide, residual) = (direction() * 4.0, direction(), direction());
        let right = residual.rows(0, m).into_owned();
        let (x, y) = (dense.linearised(&z), swept.linearised(&z));
        assert!(y.is_swept(), "{case}");
        assert!((&x.residual - &y.residual).norm() < 1e-12, "{case}");
        assert!((x.gradient() - y.gradient()).norm() < 1e-10, "{case}");
        let (p, q) = (x.tangent(&guide).unwrap(), y.tangent(&guide).unwrap());
        assert!(p.sign == q.sign, "{case}");
        signs[usize::from(p.sign > 0.0)] += 1;
        assert!((p.logarithm - q.logarithm).abs() < 1e-8, "{case}");
        let step = |at: &CurveState| at.step(&guide, &right, 0.3).unwrap();
        let (s, t) = (step(&x), step(&y));
        worst.add((&p.direction - q.direction).norm());
        worst.add((&s - t).norm() / s.norm());
    }
    println!("apart {worst}, signs {signs:?}");
    assert!(worst.of(80) < 1e-9, "{worst}");
    assert!(signs[0] > 5 && signs[1] > 5, "{signs:?}");
}

/// A slender cantilever from rest to far beyond small deflections: nowhere is its curve's matrix made
/// dense, and its direction is found to be the only one.
#[test]
fn a_cantilever_bent_far_stays_with_sweeps() {
    for segments in [32, 100] {
        let rod = BeamSection {
            youngs_modulus: 1.0,
            shear_modulus: 0.4,
            area: 1e6,
            second_moment_y: 1.0,
            second_moment_z: 1.0,
            torsion_constant: 0.8,
        };
        let link = LinkSpec::beam(rod, 1.0).segments(segments);
        let builder = Chain::builder("rod").link_with("rod", &link);
        let chain = builder.build().expect("chain");
        let mut problem = ChainProblem::new(&chain, EndCondition::wrench(Wrench::zero()));
        let grown = Wrench::new(vector![0.0, 10.0, 0.0], Vector3::zeros());
        let parameter = Parameter::end_wrench(grown);
        let settings = Settings::default();
        let rest = solve_chain(&problem, &settings).expect("rest");
        let mut reduced = ChainCurve::swept(&problem, &parameter).expect("curve");
        reduced
            .start(&rest.coordinates, &rest.wrench, 0.0)
            .expect("start");
        let mut loaded = problem.clone();
        for share in [0.0, 0.1, 0.3, 1.0] {
            loaded.end.wrench = grown * share;
            let here = solve_chain(&loaded, &settings).expect("bent");
            let z = reduced.state(&here.coordinates, &here.wrench, share);
            let matrix = reduced.linearised(&z);
            let case = format!("{segments} {share}");
            assert!(matrix.is_swept(), "{case}");
            assert!(matrix.only_direction().is_some(), "{case}");
            let tangent = matrix.only_direction().expect("one");
            assert!(
                matrix
                    .step(&tangent, &DVector::from_element(z.len() - 1, 1e-3), 0.0)
                    .is_some()
            );
        }
        problem.end.wrench = Wrench::zero();
    }
}

/// Slender rods, pushed along and bent: the stiffness of an end that is far stiffer along than across.
#[test]
fn uneven_stiffnesses_are_alike_by_sweeps_and_dense() {
    let mut worst = [Worst::new(), Worst::new()];
    for (segments, axial) in [(11, 1e5), (16, 1e7), (16, 1e9), (24, 1e11)] {
        for push in [[-1.0, 0.0, 0.0], [-2.0, 0.3, 0.1], [3.0, 5.0, -2.0]] {
            let rod = BeamSection {
                youngs_modulus: 1.0,
                shear_modulus: 1.0,
                area: axial,
                second_moment_y: 1.0,
                second_moment_z: 1.3,
                torsion_constant: 0.8,
            };
            let link = LinkSpec::beam(rod, 1.0).segments(segments);
            let builder = Chain::builder("rod").link_with("rod", &link);
            let chain = builder.build().expect("chain");
            let posture = chain.home_coordinates();
            let scales = scales_of(&chain, &posture);
            let force = Wrench::new(Vector3::from(push), Vector3::zeros());
            let problem = ChainProblem::new(&chain, EndCondition::wrench(force));
            let here = solve_chain(&problem, &Settings::default()).expect("equilibrium");
            let [dense, swept] = [ChainMethod::Dense, ChainMethod::Sweep].map(|method| {
                let mut system =
                    System::of_chain(&chain, &problem.base, &posture, &[], &scales, Some(method));
                system.evaluate_problem(&problem, &here.coordinates, &here.wrench, 1.0);
                system
            });
            let case = format!("{segments} {axial:e} {push:?}");
            let sweep = swept.sweep.as_ref().expect("stages");
            let by_sweep = swept_stiffness(&chain, &swept, sweep, &scales, None);
            let (a, b) = (
                chain_stiffness(&chain, &dense, &scales, None),
                by_sweep.expect(&case),
            );
            assert_eq!(
                (a.rank, a.directions.len()),
                (b.rank, b.directions.len()),
                "{case}"
            );
            for (x, y) in a.directions.iter().zip(&b.directions) {
                assert_eq!(x.kind, y.kind, "{case}");
                let off = (x.stiffness_n_per_m / y.stiffness_n_per_m - 1.0).abs();
                worst[0].add(off);
            }
            let (x, y) = (&a.cartesian.matrix, &b.cartesian.matrix);
            worst[1].add((x - y).largest_entry() / x.largest_entry());
        }
    }
    let [directions, matrices] = worst;
    println!("directions apart {directions}, matrices {matrices}");
    assert!(directions.value() < 1e-7, "{directions}");
    assert!(matrices.of(12) < 1e-9, "{matrices}");
}
