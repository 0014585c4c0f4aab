//! One 6 x 6 spring whose principal stiffnesses differ by up to 1e14, against values known exactly.
//!
//! `M = [-2 2 -1; -1 -2 -2; -2 -1 2]` is three times a rotation (its columns are square to each other and of length
//! three), so `M diag(d) M^T` of whole numbers is a matrix of whole numbers, held exactly up to 2^53, whose
//! eigenvalues are exactly `9 d`.

use kinetostat::{chain::uneven_springs, *};
use kinetostat_testing::LargestEntry;
use nalgebra::{Matrix3, Matrix6, Rotation3, UnitQuaternion, Vector3, vector};

use crate::fuzz_short::fuzz::rod::slender;

fn turn() -> Matrix3<f64> {
    Matrix3::new(-2.0, 2.0, -1.0, -1.0, -2.0, -2.0, -2.0, -1.0, 2.0)
}

/// Translations and rotations with the same principal stiffnesses, N/m and N m/rad.
fn blocks(k: &Matrix3<f64>) -> Matrix6<f64> {
    let mut both = Matrix6::zeros();
    both.fixed_view_mut::<3, 3>(0, 0).copy_from(k);
    both.fixed_view_mut::<3, 3>(3, 3).copy_from(k);
    both
}

/// Principal stiffnesses of a machine that is one spring, from the softest; what is said of its springs.
fn principal(chain: Chain) -> (Vec<f64>, Vec<String>) {
    let machine = Mechanism::serial(chain, Pose::identity(), Vector3::zeros()).unwrap();
    let k = machine
        .posture(&Pose::identity())
        .unwrap()
        .stiffness()
        .unwrap();
    assert_eq!(k.rank(), 6, "{:?}", k.directions);
    let mut values: Vec<f64> = k.directions.iter().map(|d| d.stiffness_n_per_m).collect();
    values.sort_by(f64::total_cmp);
    (values, uneven_springs(&machine))
}

/// Largest relative error.
fn off(found: &[f64], expected: [f64; 3]) -> f64 {
    let mut expected: Vec<f64> = expected.into_iter().chain(expected).collect();
    expected.sort_by(f64::total_cmp);
    assert_eq!(found.len(), 6);
    let both = found.iter().zip(&expected);
    let errors = both.map(|(a, b)| (a / b - 1.0).abs());
    errors.fold(0.0, |most, e| if e > most || e.is_nan() { e } else { most })
}

#[test]
fn a_full_matrix_is_exact_or_says_what_it_holds() {
    let (mut refused, mut said) = (0, 0);
    for decade in 0..=14 {
        let ratio = 10_f64.powi(decade);
        for d in [
            [ratio, 1.0, 2.0],
            [ratio, ratio, 1.0],
            [ratio, ratio.sqrt().round(), 1.0],
        ] {
            let k = blocks(&(turn() * Matrix3::from_diagonal(&d.into()) * turn().transpose()));
            assert!(
                k.largest_entry() < 9e15 && k.iter().all(|x| x.fract() == 0.0),
                "not exact"
            );
            let built = Chain::builder("one").spring6("wire", &k, [0.0; 6]).build();
            let chain = match built {
                Ok(chain) => chain,
                Err(error) => {
                    let words = error.to_string();
                    for part in ["spring 'wire'", "16 digits", "principal axes"] {
                        assert!(words.contains(part), "{words}");
                    }
                    assert!(ratio >= 1e11, "{d:?} is refused: {words}");
                    refused += 1;
                    continue;
                }
            };
            let (values, words) = principal(chain);
            let error = off(&values, d.map(|d| 9.0 * d));
            // Elimination loses what the ratio is in units of rounding.
            assert!(
                error <= 1e-14 + 8.0 * f64::EPSILON * ratio,
                "{d:?}: {error:e}"
            );
            match words.as_slice() {
                [] => assert!(error <= 1e-8, "{d:?}: {error:e} without a word"),
                [one] => {
                    assert!(one.contains("limb 'one', spring 'wire'"), "{one}");
                    assert!(one.contains("principal axes"), "{one}");
                    said += 1;
                }
                more => panic!("{more:?}"),
            }
        }
    }
    assert!(refused >= 6 && said >= 12, "{refused} {said}");
}

/// What the words advise: the same spring between two rotations, its matrix diagonal.
#[test]
fn in_its_principal_axes_a_spring_of_any_ratio_is_exact() {
    let rotation = Rotation3::from_matrix_unchecked(turn() / 3.0);
    let there = Pose::from_parts(
        Vector3::zeros().into(),
        UnitQuaternion::from_rotation_matrix(&rotation),
    );
    for decade in 0..=14 {
        let ratio = 10_f64.powi(decade);
        for d in [
            [ratio, 1.0, 2.0],
            [ratio, ratio, 1.0],
            [ratio, ratio.sqrt(), 1.0],
        ] {
            let chain = Chain::builder("one")
                .rigid(there)
                .spring6(
                    "wire",
                    &blocks(&Matrix3::from_diagonal(&d.into())),
                    [0.0; 6],
                )
                .rigid(there.inverse());
            let (values, words) = principal(chain.build().unwrap());
            let error = off(&values, d);
            assert!(error <= 1e-8, "{d:?}: {error:e}");
            assert!(words.is_empty(), "{words:?}");
        }
    }
}

/// A hinged column, its end pressed: the force `P` takes `P / L` off what the hinge holds across, whatever it is
/// along. With the hinge's stiffness `c` at `L` from the end `K = c / L^2 - P / L`.
#[test]
fn a_soft_direction_that_a_load_makes_negative_is_not_free() {
    for decade in [3, 6, 9, 11, 12] {
        for share in [0.5, 0.9999, 1.0001, 1.22, 3.0] {
            let (along, hinge, length) = (10_f64.powi(decade), 0.3, 0.7);
            let push = share * hinge / length;
            let left = length - push / along;
            let across = hinge / (left * left) - push / left;
            let there = Pose::translation(length, 0.0, 0.0);
            let (slide, turn) = (MotionKind::Prismatic, MotionKind::Revolute);
            let [x, y, z] = [Vector3::x(), Vector3::y(), Vector3::z()];
            let chain = Chain::builder("column")
                .spring("across", turn, y, hinge, 0.0)
                .spring("aside", turn, z, 2.0 * hinge, 0.0)
                .rigid(there)
                .spring("along", slide, x, along, 0.0)
                .passive("roll", turn, x, 0.0)
                .passive("pitch", turn, y, 0.0)
                .passive("yaw", turn, z, 0.0)
                .build()
                .unwrap();
            let machine = Mechanism::serial(chain, there, Vector3::zeros()).unwrap();
            let end = Wrench::new(Vector3::new(-push, 0.0, 0.0), Vector3::zeros());
            let found = machine.posture(&there).unwrap().deflected_by(&end).unwrap();
            let aside = 2.0 * hinge / (left * left) - push / left;
            let mut expected = [along, across, aside];
            expected.sort_by(f64::total_cmp);
            let mut values: Vec<f64> = (found.directions.iter())
                .filter(|d| d.kind != DirectionKind::Free)
                .map(|d| d.stiffness_n_per_m)
                .collect();
            values.sort_by(f64::total_cmp);
            assert_eq!(values.len(), 3, "{:?}", found.directions);
            for (value, expected) in values.iter().zip(expected) {
                let error = (value - expected).abs() / expected.abs().max(1e-4 * hinge);
                assert!(error < 1e-6, "1e{decade}, {share}: {value} {expected}");
            }
            // The end turns as it likes.
            assert_eq!(found.platform.free, 3, "1e{decade}, {share}");
            assert_eq!(found.platform.stable, across > 0.0, "1e{decade}, {share}");
        }
    }
}

/// A rod of unit length and bending stiffness that begins at a place of the base.
fn rod(axial: f64, name: &str, from: Pose) -> Chain {
    let link = LinkSpec::beam(slender(axial), 1.0).segments(12);
    let chain = Chain::builder(name).rigid(from).link_with("rod", &link);
    chain.build().unwrap()
}

/// A tool on such rods that begin at these places.
fn tool_on(axial: f64, places: &[Vector3<f64>], home: Pose) -> Mechanism {
    let mut builder = Mechanism::builder("rods");
    let tool = builder.platform(Platform::new("tool", home));
    for (i, place) in places.iter().enumerate() {
        let from = Pose::from_parts((*place).into(), UnitQuaternion::identity());
        let tip = from * Pose::translation(1.0, 0.0, 0.0);
        let name = format!("rod {i}");
        let chain = rod(axial, &name, from);
        builder = builder.limb(Limb::between(name, 0, tool, chain).fixed_at(home.inverse() * tip));
    }
    builder.build().unwrap()
}

/// A clamped rod of length L with a rigid tool of length a ahead, pressed along by a dead force: it goes away at
/// `k L tan(k L) = L / a`, `P = k^2 EI` (Timoshenko and Gere, Theory of Elastic Stability, 1961, 2.4).
#[test]
fn a_pressed_rod_with_a_tool_goes_away_at_its_load() {
    let home = Pose::translation(1.2, 0.0, 0.0);
    // kL tan(kL) = 5.
    let (mut low, mut high) = (1.0_f64, 1.5_f64);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        match middle * middle.tan() < 5.0 {
            true => low = middle,
            false => high = middle,
        }
    }
    let critical = low * low;
    assert!((critical - 1.726).abs() < 1e-3);
    for axial in [1e4, 1e6, 1e8, 1e10, 1e12] {
        let machine = tool_on(axial, &[Vector3::zeros()], home);
        for share in [0.5, 0.97, 1.03, 1.4] {
            let force = Wrench::new(vector![-share * critical, 0.0, 0.0], Vector3::zeros());
            let found = machine
                .posture(&home)
                .unwrap()
                .deflected_by(&force)
                .unwrap();
            let case = format!("EA {axial:e}, {share} of the load");
            assert_eq!(found.platform.stable, share < 1.0, "{case}");
            assert_eq!(found.platform.free, 0, "{case}");
            // In both planes.
            let negative = found
                .directions
                .iter()
                .filter(|d| d.stiffness_n_per_m < 0.0);
            assert_eq!(negative.count(), if share < 1.0 { 0 } else { 2 }, "{case}");
        }
    }
}

/// Principal directions, however they are found, are those of the matrix as far as that holds them.
#[test]
fn principal_directions_are_those_of_the_loaded_matrix() {
    let (mut negative, mut seen) = (0, 0);
    let aside = [
        vector![0.0, 0.1, -0.2],
        vector![0.0, -0.3, 0.05],
        vector![0.1, 0.2, 0.3],
    ];
    let even = [vector![0.0, 0.2, 0.0], vector![0.0, -0.2, 0.0]];
    let bent = Pose::new(vector![1.3, -0.1, 0.2], vector![0.3, -0.2, 0.1]);
    let straight = Pose::translation(1.3, 0.0, 0.0);
    let pushed = vector![-1.3, 0.2, 0.3];
    for axial in [1e4, 1e7, 1e8] {
        for (places, home, force, last) in [
            (&aside[..1], bent, pushed, 1.0),
            (&aside[..2], bent, pushed, 1.0),
            (&aside[..], bent, pushed, 1.0),
            // Straight until long after it does not hold.
            (&[Vector3::zeros()][..], straight, -Vector3::x(), 60.0),
            (&even[..], straight, -Vector3::x(), 60.0),
        ] {
            let machine = tool_on(axial, places, home);
            for size in [0.3, 4.0, last] {
                let moment = vector![0.1, -0.2, 0.15] * size * force.y;
                let load = Wrench::new(force * size, moment);
                let Ok(found) = machine.posture(&home).unwrap().deflected_by(&load) else {
                    continue;
                };
                let case = format!("EA {axial:e}, {} rods, load {size}", places.len());
                let matrix = found.stiffness.symmetric();
                let length = found.length;
                let unit = |i: usize| if i < 3 { 1.0 } else { length };
                let scaled = Matrix6::from_fn(|i, j| matrix[(i, j)] / (unit(i) * unit(j)));
                let mut expected: Vec<f64> =
                    scaled.symmetric_eigenvalues().iter().copied().collect();
                expected.sort_by(f64::total_cmp);
                let mut values: Vec<f64> = found
                    .directions
                    .iter()
                    .map(|d| d.stiffness_n_per_m)
                    .collect();
                values.sort_by(f64::total_cmp);
                assert_eq!(values.len(), 6, "{case}");
                for (value, expected) in values.iter().zip(&expected) {
                    let error = (value - expected).abs();
                    let held = 1e-13 * scaled.largest_entry() + 1e-9 * expected.abs();
                    assert!(error <= held, "{case}: {values:?} {expected}");
                }
                negative += usize::from(expected[0] < 0.0);
                seen += 1;
            }
        }
    }
    assert!(seen >= 35 && negative >= 6, "{seen} {negative}");
}
