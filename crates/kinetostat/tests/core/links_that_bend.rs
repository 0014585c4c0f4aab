//! Links in segments, bent: the elastica, roll-up, the bend in space, stiffness, refusals and axial loads.
//!
//! Closed forms: the inextensible elastica, a circle. Published values name their source where they stand. How
//! straight links buckle is in `straight_links_buckle`.

use crate::common::{close, same_stiffness};
use LinkConvention::{
    Bowing, ConstantStrain, Exponential, Middle, RotationsFirst, TranslationsFirst,
};
use kinetostat::{
    BeamSection, Chain, ChainProblem, EndCondition, Equilibrium, LinkSpec, Load, Pose, Settings,
    Twist, Wrench,
    model::{BowingLaw, LinkConvention, SpringLaw},
    solve_chain,
    spatial::{hat, moved, shift_matrix},
    unloaded_stiffness,
};
use nalgebra::{Matrix3, Matrix6, Vector3, vector};
use std::f64::consts::PI;

/// `EI = 1` in the plane x y, everything else (almost) rigid.
pub fn flat() -> BeamSection {
    BeamSection {
        youngs_modulus: 1.0,
        shear_modulus: 1.0,
        area: 1e6,
        second_moment_y: 1e4,
        second_moment_z: 1.0,
        torsion_constant: 1e4,
    }
}

/// A section with six different stiffnesses.
pub fn general() -> BeamSection {
    BeamSection {
        youngs_modulus: 2.1e11,
        shear_modulus: 8.0e10,
        area: 6e-4,
        second_moment_y: 3e-8,
        second_moment_z: 7e-8,
        torsion_constant: 9e-8,
    }
}

pub fn link(n: usize, convention: LinkConvention) -> LinkSpec {
    LinkSpec::beam(flat(), 1.0)
        .segments(n)
        .convention(convention)
}

fn cantilever(spec: &LinkSpec) -> Chain {
    Chain::builder("cantilever")
        .link_with("link", spec)
        .build()
        .unwrap()
}

pub fn solve(problem: &ChainProblem<'_>) -> Equilibrium {
    solve_chain(problem, &Settings::default()).unwrap_or_else(|e| panic!("{e}"))
}

fn force(x: f64, y: f64, z: f64) -> EndCondition {
    EndCondition::wrench(Wrench::new(vector![x, y, z], Vector3::zeros()))
}

/// Error of the deflection at the end of a cantilever under `P L^2 / EI = 10`, exact 0.810609024880.
pub fn elastica(n: usize, convention: LinkConvention) -> f64 {
    let chain = cantilever(&link(n, convention));
    let e = solve(&ChainProblem::new(&chain, force(0.0, 10.0, 0.0)));
    e.tip.translation.y - 0.810_609_024_880
}

#[test]
fn the_elastica_converges_with_the_square_of_the_segments() {
    for (convention, expected, digits) in [
        (
            TranslationsFirst,
            [0.139, 0.0259, 0.0065],
            [5e-4, 5e-5, 5e-5],
        ),
        (Middle, [0.009, -0.0081, -0.0028], [5e-4, 5e-5, 5e-5]),
        (Bowing, [0.152, 0.0168, 0.0019], [5e-4, 5e-5, 5e-5]),
    ] {
        for (k, n) in [2, 4, 8].into_iter().enumerate() {
            let found = elastica(n, convention);
            close(
                &format!("{convention:?} {n}"),
                found,
                expected[k],
                digits[k],
            );
        }
    }
    // What the documentation of `LinkSpec::segments` recommends.
    close("32 segments", elastica(32, Bowing), 0.0, 1e-4);
}

/// A cantilever under the end moment that rolls it up to a full circle; it has a node in its middle.
pub fn rolled_up(n: usize, convention: LinkConvention) -> (Chain, Equilibrium) {
    let half = LinkSpec::beam(flat(), 0.5)
        .segments(n / 2)
        .convention(convention);
    let chain = Chain::builder("roll")
        .link_with("first", &half)
        .node("middle")
        .link_with("second", &half)
        .build()
        .unwrap();
    let moment = Wrench::new(Vector3::zeros(), vector![0.0, 0.0, 2.0 * PI]);
    let e = solve(&ChainProblem::new(&chain, EndCondition::wrench(moment)));
    (chain, e)
}

#[test]
fn an_end_moment_rolls_a_cantilever_up_to_a_circle() {
    for (convention, n, tolerance) in [
        (Bowing, 16, 1e-3),
        (Bowing, 32, 2e-4),
        (Exponential, 16, 1e-2),
    ] {
        let (chain, e) = rolled_up(n, convention);
        let label = format!("{convention:?} {n}");
        // Angles of the segments add up to a full turn, and the end comes back to the root.
        let angle: f64 = e.coordinates.iter().skip(5).step_by(6).sum();
        close(&label, angle, 2.0 * PI, 1e-9);
        close(&label, e.tip.translation.vector.norm(), 0.0, 1e-9);
        let middle = e.nodes[chain.node("middle").unwrap()].translation;
        close(&label, middle.x, 0.0, tolerance);
        close(&label, middle.y, 1.0 / PI, tolerance);
        close(&label, e.energy, 0.5 * (2.0 * PI).powi(2), 1e-6);
    }
}

/// The end of a cantilever put where a pure moment would bring it: the solver has to find the arc,
/// although the straight way there presses the chain beyond its buckling load.
#[test]
fn an_end_that_is_put_on_an_arc_takes_a_pure_moment() {
    // Eight segments of 15 degrees and more lie too near to buckling of their own to be reached.
    let some: &[f64] = &[0.5, 1.0];
    for (n, arcs) in [(8, some), (32, &[0.5, 1.0, 1.5, 2.0, 2.5])] {
        let chain = cantilever(&link(n, Bowing));
        for &arc in arcs {
            let place = vector![arc.sin() / arc, (1.0 - arc.cos()) / arc, 0.0];
            let turn = Pose::rotation(vector![0.0, 0.0, arc]);
            let end = EndCondition::pose(Pose::from_parts(place.into(), turn.rotation));
            let label = format!("{n} segments, arc {arc}");
            let e = solve(&ChainProblem::new(&chain, end));
            assert!(e.stability.stable, "{label}");
            close(&label, e.wrench.moment().z, arc, 2e-3);
            assert!(e.wrench.force().norm() < 0.05, "{label}: {:?}", e.wrench);
        }
    }
}

/// Stiffness at the end of a cantilever that shears, from its compliance.
fn shearing(section: &BeamSection, shear: f64, length: f64) -> Matrix6<f64> {
    let mut compliance = section.cantilever(length).unwrap().try_inverse().unwrap();
    compliance[(1, 1)] += length / shear;
    compliance[(2, 2)] += length / shear;
    compliance.try_inverse().unwrap()
}

/// End of the 45-degree arc (radius 100, in the plane x y, root along x) under a dead force on it, by
/// shooting: `dr/ds = R (e1 + C_n^-1 R^T f)`, `dR/ds = R hat(k0 + C_m^-1 R^T m)`,
/// `m = (r_end - r) x f`, Runge-Kutta in s and Newton in `r_end`. No kinetostat in it.
fn arc_by_shooting(stretch: Vector3<f64>, bend: Vector3<f64>, f: Vector3<f64>) -> Vector3<f64> {
    let steps = 400;
    let ds = 25.0 * PI / f64::from(steps);
    let reached = |end: &Vector3<f64>| {
        let rates = |r: &Vector3<f64>, q: &Matrix3<f64>| {
            let force = q.transpose() * f;
            let moment = q.transpose() * (end - r).cross(&f);
            let strain = Vector3::x() + force.component_div(&stretch);
            let curvature = vector![0.0, 0.0, 0.01] + moment.component_div(&bend);
            (q * strain, q * hat(&curvature))
        };
        let (mut r, mut q) = (Vector3::zeros(), Matrix3::identity());
        for _ in 0..steps {
            let (r1, q1) = rates(&r, &q);
            let (r2, q2) = rates(&(r + r1 * (0.5 * ds)), &(q + q1 * (0.5 * ds)));
            let (r3, q3) = rates(&(r + r2 * (0.5 * ds)), &(q + q2 * (0.5 * ds)));
            let (r4, q4) = rates(&(r + r3 * ds), &(q + q3 * ds));
            r += (r1 + (r2 + r3) * 2.0 + r4) * (ds / 6.0);
            q += (q1 + (q2 + q3) * 2.0 + q4) * (ds / 6.0);
        }
        r
    };
    let mut end = vector![70.0, 29.0, 0.0];
    for load in 0..60 {
        let residual = reached(&end) - end;
        if load > 3 && residual.norm() < 1e-11 {
            return end;
        }
        let slope = Matrix3::from_columns(&[0, 1, 2].map(|k| {
            let mut moved = end;
            moved[k] += 1e-5;
            (reached(&moved) - moved - residual) / 1e-5
        }));
        let step = -(slope.try_inverse().unwrap() * residual);
        end += step * (5.0 / step.norm()).min(1.0);
    }
    panic!("shooting: no convergence")
}

/// Place of the end of the 45-degree bend under a load across its plane, in `n` straight links.
pub fn bend(load: f64, n: u32) -> Vector3<f64> {
    let section = BeamSection {
        youngs_modulus: 1e7,
        shear_modulus: 5e6,
        area: 1.0,
        second_moment_y: 1.0 / 12.0,
        second_moment_z: 1.0 / 12.0,
        torsion_constant: 1.0 / 6.0,
    };
    let turn = 0.25 * PI / f64::from(n);
    let chord = 200.0 * (0.5 * turn).sin();
    let spec = LinkSpec::matrix(shearing(&section, 5e6, chord), chord);
    let half_turn = Pose::rotation(vector![0.0, 0.0, 0.5 * turn]);
    let mut b = Chain::builder("bend");
    for k in 0..n {
        b = b
            .rigid(half_turn)
            .link_with(&format!("arc {k}"), &spec)
            .rigid(half_turn);
    }
    let chain = b.build().unwrap();
    let e = solve(&ChainProblem::new(&chain, force(0.0, 0.0, load)));
    e.tip.translation.vector
}

/// The same by shooting.
pub fn bend_by_shooting(load: f64) -> Vector3<f64> {
    arc_by_shooting(
        vector![1e7, 5e6, 5e6],
        vector![1e7 / 6.0 / 2.0, 1e7 / 12.0, 1e7 / 12.0],
        vector![0.0, 0.0, load],
    )
}

/// Bathe and Bolourchi (1979): a cantilever bent to 45 degrees, radius 100 in, section 1 in x 1 in,
/// E = 1e7 psi, no Poisson effect, a force across its plane at the end. Published places of the end:
/// theirs, and Simo and Vu-Quoc (1986, example 7.5, eight elements).
#[test]
fn the_45_degree_bend_of_bathe_and_bolourchi() {
    for (load, bathe, simo) in [
        (300.0, [59.2, 22.5, 39.5], [58.84, 22.33, 40.08]),
        (600.0, [47.2, 15.9, 53.4], [47.23, 15.79, 53.37]),
    ] {
        let exact = bend_by_shooting(load);
        let mut errors = Vec::new();
        for n in [8, 16, 32] {
            let end = bend(load, n);
            errors.push((end - exact).norm());
            if n == 32 {
                for k in 0..3 {
                    let found = end[k];
                    close("Bathe, Bolourchi", found, bathe[k], 0.7);
                    close("Simo, Vu-Quoc", found, simo[k], 0.12);
                }
            }
        }
        println!("45-degree bend, {load} lb: {exact:?}, errors with 8, 16, 32 links: {errors:?}");
        for (error, most) in errors.iter().zip([0.06, 0.015, 0.004]) {
            assert!(*error < most, "{errors:?}");
        }
    }
}

/// A cantilever's matrix with principal axes turned about x, shear, and an eccentric axis.
fn coupled(length: f64) -> Matrix6<f64> {
    let straight = shearing(&general(), 2e7, length);
    let turn = Pose::rotation(vector![0.4, 0.0, 0.0]);
    let turn = kinetostat::spatial::turn_matrix(&turn.rotation.to_rotation_matrix());
    let shift = shift_matrix(&vector![0.0, 0.02, -0.01]);
    shift.transpose() * turn * straight * turn.transpose() * shift
}

#[test]
fn the_unloaded_stiffness_is_exact_for_any_number_of_segments() {
    let length = 0.7;
    for convention in [
        TranslationsFirst,
        RotationsFirst,
        Middle,
        Exponential,
        Bowing,
    ] {
        for n in [1, 2, 7] {
            for (exact, spec) in [
                (
                    general().cantilever(length).unwrap(),
                    LinkSpec::beam(general(), length),
                ),
                (
                    general().cantilever(length).unwrap(),
                    LinkSpec::matrix(general().cantilever(length).unwrap(), length),
                ),
                (coupled(length), LinkSpec::matrix(coupled(length), length)),
            ] {
                let chain = cantilever(&spec.segments(n).convention(convention));
                let zero = vec![0.0; 6 * n];
                let k = unloaded_stiffness(&chain, &Pose::identity(), &zero, &[]).unwrap();
                same_stiffness(
                    &format!("{convention:?} {n}"),
                    &k.cartesian.matrix,
                    &exact,
                    1e-9,
                );
            }
        }
    }
    // A constant strain is too stiff for one segment: 4 EI / L^3 instead of 3.
    let lateral = |n: usize| {
        let chain = cantilever(&link(n, ConstantStrain));
        let k = unloaded_stiffness(&chain, &Pose::identity(), &vec![0.0; 6 * n], &[]).unwrap();
        1.0 / k.cartesian.compliance().unwrap()[(1, 1)]
    };
    close("1", lateral(1), 4.0, 1e-4);
    close("16", lateral(16), 3.0, 1e-2);
}

#[test]
fn only_beams_are_divided_and_the_refusal_says_so() {
    let build = |spec: LinkSpec| Chain::builder("c").link_with("rod", &spec).build();
    let error = |spec: LinkSpec| build(spec).unwrap_err().to_string();
    let mut tapered = general().cantilever(0.7).unwrap();
    tapered[(1, 5)] *= 1.05;
    tapered[(5, 1)] *= 1.05;
    assert!(build(LinkSpec::matrix(tapered, 0.7)).is_ok());
    let text = error(LinkSpec::matrix(tapered, 0.7).segments(4));
    assert!(
        text.contains("link 'rod'") && text.contains("uniform beam"),
        "{text}"
    );
    let mut stiff = general().cantilever(0.7).unwrap().try_inverse().unwrap();
    stiff[(1, 1)] *= 0.9;
    let text = error(LinkSpec::matrix(stiff.try_inverse().unwrap(), 0.7).segments(2));
    assert!(text.contains("uniform beam"), "{text}");
    let text = error(LinkSpec::matrix(-Matrix6::identity(), 0.7).segments(2));
    assert!(text.contains("positive definite"), "{text}");
    let text = error(LinkSpec::matrix(-Matrix6::identity(), 0.7));
    assert!(text.contains("not positive"), "{text}");
    let text = error(LinkSpec::beam(general(), 0.7).segments(0));
    assert!(text.contains("at least 1"), "{text}");
    let text = error(LinkSpec::beam(general(), f64::NAN));
    assert!(text.contains("length is NaN"), "{text}");
    let law = SpringLaw::Bowing(Box::new(BowingLaw {
        matrix: Matrix6::identity(),
        length: 0.0,
    }));
    let text = Chain::builder("c")
        .springs("s", &[0, 1, 2, 3, 4, 5], law.clone(), vec![0.0; 6])
        .build()
        .unwrap_err()
        .to_string();
    assert!(text.contains("length"), "{text}");
    let text = Chain::builder("c")
        .springs("s", &[0, 1], law, vec![0.0; 2])
        .build()
        .unwrap_err()
        .to_string();
    assert!(text.contains("'s'"), "{text}");
}

/// Energy is work, and the stiffness the derivative of the wrench, in space and far from straight.
#[test]
fn stiffness_and_work_of_bent_links_agree_with_differences() {
    for convention in [Bowing, Exponential, ConstantStrain, RotationsFirst, Middle] {
        for spec in [
            LinkSpec::beam(general(), 0.7),
            LinkSpec::matrix(coupled(0.7), 0.7),
        ] {
            let chain = cantilever(&spec.segments(3).convention(convention));
            let push = Wrench::new(vector![-900.0, 1500.0, -900.0], vector![60.0, 100.0, -50.0]);
            let bent = solve(&ChainProblem::new(&chain, EndCondition::wrench(push)));
            let held = bent.tip;
            let at = |pose: Pose| {
                let mut problem = ChainProblem::new(&chain, EndCondition::pose(pose));
                problem.posture.clone_from(&bent.coordinates);
                solve(&problem)
            };
            let e = at(held);
            let k = e.stiffness.cartesian.matrix;
            let mut found = Matrix6::zeros();
            for j in 0..6 {
                let step = 1e-5;
                let mut twist = nalgebra::Vector6::zeros();
                twist[j] = step;
                let (up, down) = (
                    at(moved(&held, &Twist(twist))),
                    at(moved(&held, &Twist(-twist))),
                );
                let column = (up.wrench.0 - down.wrench.0) / (2.0 * step);
                found.set_column(j, &column);
                let work = e.wrench.0[j];
                let size = if j < 3 {
                    e.wrench.force().norm()
                } else {
                    e.wrench.moment().norm()
                };
                close(
                    &format!("{convention:?} work {j}"),
                    (up.energy - down.energy) / (2.0 * step),
                    work,
                    3e-4 * size,
                );
            }
            same_stiffness(&format!("{convention:?}"), &k, &found, 1e-5);
        }
    }
}

#[test]
fn a_preloaded_bent_link_rests_where_its_spring_does() {
    let rest = vec![1e-4, 0.02, -0.01, 0.03, 0.02, 0.05];
    let law = SpringLaw::Bowing(Box::new(BowingLaw {
        matrix: general().cantilever(0.7).unwrap(),
        length: 0.7,
    }));
    let chain = Chain::builder("bent")
        .translation(vector![0.7, 0.0, 0.0])
        .springs("s", &[0, 1, 2, 3, 4, 5], law, rest.clone())
        .build()
        .unwrap();
    let e = solve(&ChainProblem::new(&chain, force(0.0, 0.0, 0.0)));
    for (x, r) in e.coordinates.iter().zip(&rest) {
        close("rest", *x, *r, 1e-9);
    }
    close("energy", e.energy, 0.0, 1e-9);
}

#[test]
fn every_link_reports_its_axial_load() {
    let slim = LinkSpec::beam(general(), 1.0).segments(2);
    let chain = Chain::builder("two")
        .link_with("lower", &slim)
        .node("knee")
        .link_with(
            "upper",
            &LinkSpec::matrix(general().cantilever(0.5).unwrap(), 0.5),
        )
        .link("plain", &general(), 0.1)
        .build()
        .unwrap();
    let mut problem = ChainProblem::new(&chain, force(-100.0, 0.0, 0.0));
    problem.loads = vec![Load::Dead {
        node: chain.node("knee").unwrap(),
        wrench: Wrench::new(vector![300.0, 0.0, 0.0], Vector3::zeros()),
    }];
    let loads = solve(&problem).link_loads(&chain);
    let names: Vec<&str> = loads.iter().map(|l| l.link.as_str()).collect();
    assert_eq!(names, ["lower", "upper", "plain"]);
    close("lower", loads[0].axial_force, 200.0, 1e-6);
    close("lower", loads[0].share, 0.0, 0.0);
    close("upper", loads[1].axial_force, -100.0, 1e-6);
    let euler = PI * PI * 2.1e11 * 3e-8;
    close("upper", loads[1].euler_load, euler / 0.25, 1e-6 * euler);
    close("upper", loads[1].share, 100.0 * 0.25 / euler, 1e-9);
    close("plain", loads[2].euler_load, euler / 0.01, 1e-6 * euler);
}
