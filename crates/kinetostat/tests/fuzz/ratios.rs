//! Stiffnesses of very different size in one chain, and links that hardly stretch.

use kinetostat::{
    Chain, ChainProblem, DirectionKind, EndCondition, LinkSpec, MotionKind, Pose, Settings, Wrench,
    solve_chain, unloaded_stiffness,
};
use kinetostat_testing::{largest, least};
use nalgebra::{Matrix6, Rotation3, Vector3, Vector6};

use super::random::Random;

/// Six springs along and about the axes of a turned frame, or one 6 x 6 spring with turned principal
/// axes: every principal stiffness is known.
pub fn case(random: &mut Random) {
    let decades = random.between(0.0, 14.0);
    // One stiff axis, one soft axis, or spread evenly.
    let style = random.below(3);
    let stiffness = |random: &mut Random, i: usize| match style {
        0 => 10_f64.powf(if i == 2 {
            decades
        } else {
            random.between(0.0, 0.5)
        }),
        1 => 10_f64.powf(if i == 4 { 0.0 } else { decades }),
        _ => 10_f64.powf(decades * random.between(0.0, 1.0)),
    };
    let values: Vec<f64> = (0..6).map(|i| stiffness(random, i)).collect();
    let turn = match random.below(3) {
        0 => Rotation3::identity(),
        _ => Rotation3::new(random.axis() * random.between(0.0, 3.0)),
    };
    let axes = *turn.matrix();
    let (most, least) = (
        largest(values.iter().copied()),
        least(values.iter().copied()),
    );
    let mut builder = Chain::builder("ratio");
    let whole = random.once_in(2) && most / least < 1e9;
    if whole {
        let mut k = Matrix6::zeros();
        for (i, value) in values.iter().enumerate() {
            let axis = axes.column(i % 3);
            let mut v = Vector6::zeros();
            v.fixed_rows_mut::<3>(3 * (i / 3)).copy_from(&axis);
            k += *value * v * v.transpose();
        }
        builder = builder.spring6("spring", &k, [0.0; 6]);
    } else {
        for (i, value) in values.iter().enumerate() {
            let kind = [MotionKind::Prismatic, MotionKind::Revolute][i / 3];
            let axis = axes.column(i % 3).into_owned();
            builder = builder.spring(&format!("s{i}"), kind, axis, *value, 0.0);
        }
    }
    let chain = builder.build().expect("a chain");
    let home = (chain.home_coordinates(), chain.home_commands());
    let k = unloaded_stiffness(&chain, &Pose::identity(), &home.0, &home.1).expect("a stiffness");
    assert_eq!(
        k.count(DirectionKind::Finite),
        6,
        "{values:?}: {:?}",
        k.directions
    );
    let mut found: Vec<f64> = k.directions.iter().map(|d| d.stiffness_n_per_m).collect();
    let mut expected = values.clone();
    found.sort_by(f64::total_cmp);
    expected.sort_by(f64::total_cmp);
    // A full matrix holds its softest value to the rounding of its stiffest one.
    let held = if whole { 1e-14 * most / least } else { 0.0 };
    for (a, b) in found.iter().zip(&expected) {
        let off = (a / b - 1.0).abs();
        assert!(
            off <= 1e-9 + held,
            "{a:e} instead of {b:e} among {expected:?}"
        );
    }
}

/// A cantilever that hardly stretches, under a moment and a force at its end: whole loads that bend it
/// far, so that a chain of stiff directions must follow.
pub fn stiff_link(random: &mut Random) {
    let bending = 1.0;
    let axial = random.power(6.0, 13.0);
    let length = 1.0;
    let mut k = Matrix6::zeros();
    k[(0, 0)] = axial / length;
    for (i, j) in [(1, 5), (2, 4)] {
        let sign = if i == 1 { -1.0 } else { 1.0 };
        k[(i, i)] = 12.0 * bending;
        k[(j, j)] = 4.0 * bending;
        k[(i, j)] = sign * 6.0 * bending;
        k[(j, i)] = k[(i, j)];
    }
    k[(3, 3)] = bending;
    let segments = 4 + random.below(12);
    let spec = LinkSpec::matrix(k, length).segments(segments);
    let chain = Chain::builder("stiff").link_with("wire", &spec).build();
    let chain = chain.expect("a chain");
    let home = (chain.home_coordinates(), chain.home_commands());
    let found = unloaded_stiffness(&chain, &Pose::identity(), &home.0, &home.1);
    let found = found.expect("a stiffness");
    assert_eq!(
        found.count(DirectionKind::Finite),
        6,
        "{:?}",
        found.directions
    );
    // One segment or many: the same cantilever.
    let soft = found.directions.iter().map(|d| d.stiffness_n_per_m);
    let soft = least(soft);
    let own = k.fixed_view::<6, 6>(0, 0).symmetric_eigenvalues().min();
    let one = Chain::builder("one").link_with("wire", &LinkSpec::matrix(k, length));
    let one = one.build().expect("a chain");
    let home = (one.home_coordinates(), one.home_commands());
    let once = unloaded_stiffness(&one, &Pose::identity(), &home.0, &home.1).expect("a stiffness");
    let once = once.directions.iter().map(|d| d.stiffness_n_per_m);
    let once = least(once);
    assert!((once / own - 1.0).abs() < 1e-6, "{once:e} {own:e}");
    assert!(
        (soft / own - 1.0).abs() < 1e-6,
        "{segments}: {soft:e} {own:e}"
    );
    // A small force: the deflection of the beam.
    let force = 1e-6 * bending;
    let wrench = Wrench::new(Vector3::new(0.0, force, 0.0), Vector3::zeros());
    let problem = ChainProblem::new(&chain, EndCondition::wrench(wrench));
    let e = solve_chain(&problem, &Settings::default()).expect("an equilibrium");
    let moved = e.tip.translation.vector.y;
    let expected = force * length.powi(3) / (3.0 * bending);
    assert!(
        (moved / expected - 1.0).abs() < 1e-6,
        "{moved:e} instead of {expected:e}"
    );
}
