//! D1: beams with mass along them against the continuum.

use crate::common::*;
use kinetostat::chain::Prescribed;
use kinetostat::model::{LinkMass, MassModel};
use kinetostat::*;
use kinetostat_dynamics::Held;
use kinetostat_testing::Worst;
use nalgebra::{Matrix3, Matrix6, Vector3, vector};

fn end(prescribed: &[usize], wrench: Wrench, at: f64) -> EndCondition {
    let mut end = EndCondition::wrench(wrench);
    end.pose = Pose::translation(at, 0.0, 0.0);
    for k in prescribed {
        end.prescribed[*k] = Prescribed::Pose;
    }
    end
}

fn push(force: f64) -> Wrench {
    Wrench::new(vector![-force, 0.0, 0.0], Vector3::zeros())
}

fn pe() -> f64 {
    std::f64::consts::PI.powi(2) * 14700.0
}

fn clamped(segments: usize, stretch: f64) -> Chain {
    Chain::builder("beam")
        .link_with("beam", &thin_link(1.0, segments, stretch))
        .build()
        .unwrap()
}

fn pinned(segments: usize, stretch: f64) -> Chain {
    Chain::builder("beam")
        .passive("pin", MotionKind::Revolute, Vector3::z(), 0.0)
        .link_with("beam", &thin_link(1.0, segments, stretch))
        .build()
        .unwrap()
}

fn frequencies(chain: &Chain, end: EndCondition, probe: &str) -> Vec<f64> {
    let held = Held::of_end(&end);
    let mut problem = ChainProblem::new(chain, end);
    problem.posture = chain.home_coordinates();
    plane_frequencies(&about(&problem, &held), probe)
}

const PIN: [usize; 4] = [1, 2, 3, 4];

#[test]
fn eight_segments_meet_the_continuum() {
    let mut worst = Worst::new();
    let free = || end(&[], Wrench::zero(), 1.0);
    let middle = "beam.4.far";
    let cases: [(Chain, EndCondition, &str, [f64; 2]); 4] = [
        (clamped(8, 1.0), free(), "tip", [31.2621684, 195.916665]),
        (
            pinned(8, 1.0),
            end(&PIN, Wrench::zero(), 1.0),
            "beam.3.far",
            [87.7542363, 351.016945],
        ),
        (
            clamped(8, 1.0),
            end(&[0, 1, 2, 3, 4, 5], Wrench::zero(), 1.0),
            "beam.3.far",
            [198.929004, 548.355461],
        ),
        (
            clamped(8, 1.0),
            end(&PIN, Wrench::zero(), 1.0),
            middle,
            [137.088865, 444.25573],
        ),
    ];
    for (chain, end, probe, expected) in cases {
        let found = frequencies(&chain, end, probe);
        worst.add(relative(found[0], expected[0]));
        assert!(relative(found[1], expected[1]).abs() < 1e-3);
    }
    println!("worst f1, f2: {}", worst.measured().unwrap());
    assert!(worst.of(4) < 2e-4);
}

#[test]
fn tip_masses_and_root_springs() {
    let tipped = |inertia: f64| {
        Chain::builder("beam")
            .link_with("beam", &thin_link(1.0, 8, 1.0))
            .body(
                "tip mass",
                2.0,
                Vector3::zeros(),
                Matrix3::identity() * inertia,
            )
            .build()
            .unwrap()
    };
    let sprung = Chain::builder("beam")
        .spring("root", MotionKind::Revolute, Vector3::z(), 2e4, 0.0)
        .link_with("beam", &thin_link(1.0, 8, 1.0))
        .build()
        .unwrap();
    let mut worst = Worst::new();
    for (chain, expected) in [
        (tipped(0.0), [18.9162649, 152.038633]),
        (tipped(0.01), [18.8524089, 144.224157]),
        (sprung, [15.6174473, 146.730208]),
    ] {
        let found = frequencies(&chain, end(&[], Wrench::zero(), 1.0), "tip");
        worst.add(relative(found[0], expected[0]));
        worst.add(relative(found[1], expected[1]));
    }
    assert!(worst.of(6) < 2e-4, "{worst}");
}

#[test]
fn axial_loads_change_frequencies_as_in_the_continuum() {
    let mut worst = Worst::new();
    for (load, expected) in [
        (0.6, [55.5006522, 323.621633]),
        (-2.0, [151.994796, 429.906203]),
    ] {
        let chain = pinned(8, 1e5);
        let found = frequencies(&chain, end(&PIN, push(load * pe()), 1.0), "beam.3.far");
        worst.add(relative(found[0], expected[0]));
        worst.add(relative(found[1], expected[1]));
    }
    for (load, expected) in [(0.5, 22.5356951), (0.9, 10.2541964), (-2.0, 51.0940929)] {
        let found = frequencies(
            &clamped(8, 1e5),
            end(&[], push(load * pe() / 4.0), 1.0),
            "tip",
        );
        worst.add(relative(found[0], expected));
    }
    println!("axial loads: {}", worst.measured().unwrap());
    assert!(worst.of(7) < 5e-4, "{worst}");
}

#[test]
fn pinned_columns_under_load_by_segments() {
    let mut worst = Worst::new();
    for (load, two, four, eight) in [
        (0.0, 1.0079094, 1.0005194, 1.0000329),
        (0.3, 0.7077960, 0.7005172, 0.7000329),
        (0.6, 0.4076811, 0.4005151, 0.4000328),
        (0.9, 0.1075645, 0.1005129, 0.1000328),
        (-1.0, 2.0082775, 2.0005266, 2.0000330),
    ] {
        for (segments, expected) in [(2, two), (4, four), (8, eight)] {
            let probe = format!("beam.{}.far", segments / 2);
            let found = frequencies(
                &pinned(segments, 1e5),
                end(&PIN, push(load * pe()), 1.0),
                &probe,
            );
            worst.apart((found[0] / 87.7542363).powi(2), expected);
        }
    }
    println!("columns: {}", worst.measured().unwrap());
    assert!(worst.of(15) < 2e-7, "{worst}");
}

#[test]
fn orders_of_convergence() {
    let f1 = |segments: usize, model: MassModel| {
        let mass = LinkMass::of_section(&section(), DENSITY)
            .thin()
            .with_model(model);
        let spec = LinkSpec::beam(section(), 1.0)
            .segments(segments)
            .with_mass(mass);
        let chain = Chain::builder("beam")
            .link_with("beam", &spec)
            .build()
            .unwrap();
        relative(
            frequencies(&chain, end(&[], Wrench::zero(), 1.0), "tip")[0],
            31.2621684,
        )
    };
    let errors = [1, 2, 4, 8, 16].map(|n| f1(n, MassModel::Consistent));
    for (found, expected) in errors
        .iter()
        .zip([4.75e-3, 4.83e-4, 3.27e-5, 2.08e-6, 1.31e-7])
    {
        assert!((found / expected - 1.0).abs() < 0.02, "{errors:?}");
    }
    assert!((errors[2] / errors[3]).log2() >= 3.8 && (errors[3] / errors[4]).log2() >= 3.8);
    let errors = [1, 2, 4, 8, 16].map(|n| f1(n, MassModel::HalvesAtEnds));
    for (found, expected) in errors
        .iter()
        .zip([-3.03e-1, -1.02e-1, -2.79e-2, -7.12e-3, -1.79e-3])
    {
        assert!((found / expected - 1.0).abs() < 0.01, "{errors:?}");
    }
    for k in 2..4 {
        let order = (errors[k] / errors[k + 1]).log2();
        assert!((1.9..2.1).contains(&order), "{order}");
    }
}

#[test]
fn the_zero_frequency_load_is_the_singular_load() {
    for (segments, expected) in [
        (1, 1.0075223),
        (2, 1.0005124),
        (4, 1.0000328),
        (8, 1.0000021),
    ] {
        let chain = clamped(segments, 1e5);
        let dynamics = |load: f64| {
            let problem = ChainProblem::new(&chain, end(&[], push(load * pe() / 4.0), 1.0));
            // Straight all the way: the axis shortens, nothing bends.
            let mut x = vec![0.0; chain.coordinate_count()];
            for k in 0..segments {
                x[6 * k] = -load * pe() / 4.0 / segments as f64 / (2.1e11 * 60.0);
            }
            kinetostat_dynamics::LinearDynamics::of_chain(
                &problem,
                &x,
                &push(load * pe() / 4.0),
                &Held::nothing(),
            )
            .unwrap()
        };
        let bisect = |below: &dyn Fn(f64) -> bool| {
            let (mut low, mut high) = (0.9, 1.05);
            for _ in 0..50 {
                let middle = 0.5 * (low + high);
                if below(middle) {
                    low = middle
                } else {
                    high = middle
                }
            }
            low
        };
        // The plane bent about y is softer and buckles at 3/7 of this load: the determinant is that of the plane x-y alone.
        let plane: Vec<usize> = (0..segments).flat_map(|k| [6 * k + 1, 6 * k + 5]).collect();
        let part = |a: &nalgebra::DMatrix<f64>| a.select_rows(&plane).select_columns(&plane);
        let singular = bisect(&|load| part(dynamics(load).tangent()).determinant() > 0.0);
        let zero = bisect(&|load| {
            let d = dynamics(load);
            let modes = d.modes().unwrap();
            let tip = d.motions(d.tool());
            let first = modes.modes.iter().find(|m| {
                let t = &tip * &m.shape;
                t[1].abs() > 1e3 * t[2].abs()
            });
            first.unwrap().squared > 0.0
        });
        println!("{segments}: {singular:.10} {zero:.10}");
        assert!((singular - expected).abs() < 5e-7);
        assert!((zero / singular - 1.0).abs() < 1e-9, "{zero} {singular}");
    }
}

/// The stiffness at the end of a beam of section S with shear (kappa 5/6), x along it.
fn with_shear(length: f64) -> Matrix6<f64> {
    let s = section();
    let mut k = Matrix6::zeros();
    k[(0, 0)] = s.youngs_modulus * s.area / length;
    k[(3, 3)] = s.shear_modulus * s.torsion_constant / length;
    let shear = s.shear_modulus * s.area * 5.0 / 6.0;
    for (across, turn, second_moment, sign) in [
        (1, 5, s.second_moment_z, -1.0),
        (2, 4, s.second_moment_y, 1.0),
    ] {
        let ei = s.youngs_modulus * second_moment;
        let phi = 12.0 * ei / (shear * length * length);
        let by = ei / (1.0 + phi);
        k[(across, across)] = 12.0 * by / length.powi(3);
        k[(across, turn)] = sign * 6.0 * by / length.powi(2);
        k[(turn, across)] = k[(across, turn)];
        k[(turn, turn)] = (4.0 + phi) * by / length;
    }
    k
}

/// A beam six times as long as high: shear and rotary inertia count, and convergence is of the second order once a
/// segment is shorter than 1.8 heights.
#[test]
fn stubby_beams_meet_timoshenkos_frequencies() {
    let found = |length: f64, segments: usize| {
        let mass = LinkMass::of_section(&section(), DENSITY);
        let spec = LinkSpec::matrix(with_shear(length), length)
            .segments(segments)
            .with_mass(mass);
        let chain = Chain::builder("beam")
            .link_with("beam", &spec)
            .build()
            .unwrap();
        frequencies(&chain, end(&[], Wrench::zero(), length), "tip")
    };
    let stubby = [1325.54187, 6702.47966, 15341.5592];
    let errors = [2, 4, 8, 16, 32].map(|n| relative(found(0.15, n)[0], stubby[0]));
    assert!(
        errors[0].abs() < 4e-3 && errors[2].abs() < 2.5e-4,
        "{errors:?}"
    );
    for k in 2..4 {
        let order = (errors[k] / errors[k + 1]).log2();
        assert!((1.9..2.1).contains(&order), "{errors:?}");
    }
    // What they tend to.
    let fine = (found(0.15, 16), found(0.15, 32));
    for (k, expected) in stubby.iter().enumerate() {
        let limit = fine.1[k] + (fine.1[k] - fine.0[k]) / 3.0;
        assert!(relative(limit, *expected).abs() < 1e-5, "{k} {limit}");
    }
    // A slender one is as good as without shear.
    let slender = found(1.0, 8);
    assert!(relative(slender[0], 31.2270642).abs() < 2e-5, "{slender:?}");
    assert!(relative(slender[1], 194.398167).abs() < 5e-4, "{slender:?}");
}
