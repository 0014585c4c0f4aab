//! A beam with one passive joint: [R 3.25], [R 3.26], Tables 3.2 and 3.3.

use crate::common::{close, golden, number, rank};
use kinetostat::{BeamSection, Chain, MotionKind, Pose, unloaded_stiffness};
use kinetostat_testing::LargestEntry;
use nalgebra::{Matrix6, Vector3};
use serde_json::Value;

pub fn section(beam: &Value) -> (BeamSection, f64) {
    let n = |key: &str| number(&beam[key]);
    (
        BeamSection {
            youngs_modulus: n("E"),
            shear_modulus: n("G"),
            area: n("A"),
            second_moment_y: n("Iy"),
            second_moment_z: n("Iz"),
            torsion_constant: n("J"),
        },
        n("L"),
    )
}

/// A beam with the case's joint at its root or at its end.
pub fn beam(case: &Value, section: &BeamSection, length: f64, at_root: bool) -> Chain {
    let (kind, axis) = joint(case);
    let builder = Chain::builder("beam");
    if at_root {
        builder
            .passive("q", kind, axis, 0.0)
            .link("beam", section, length)
    } else {
        builder
            .link("beam", section, length)
            .passive("q", kind, axis, 0.0)
    }
    .build()
    .unwrap()
}

fn joint(case: &Value) -> (MotionKind, Vector3<f64>) {
    let kind = match case["kind"].as_str().unwrap() {
        "prismatic" => MotionKind::Prismatic,
        _ => MotionKind::Revolute,
    };
    let axis = match case["axis"].as_str().unwrap() {
        "x" => Vector3::x(),
        "y" => Vector3::y(),
        _ => Vector3::z(),
    };
    (kind, axis)
}

pub fn expand(entries: &Value) -> Matrix6<f64> {
    let mut m = Matrix6::zeros();
    for (key, value) in entries.as_object().unwrap() {
        let digit = |i: usize| key[i..=i].parse::<usize>().unwrap() - 1;
        m[(digit(0), digit(1))] = number(value);
        m[(digit(1), digit(0))] = number(value);
    }
    m
}

fn compare(case: &Value, chain: &Chain, k0: &Matrix6<f64>) {
    let label = case["joint"].as_str().unwrap();
    let home = chain.home_coordinates();
    let k = unloaded_stiffness(chain, &Pose::identity(), &home, &[]).unwrap();
    let ratios = expand(&case["printed"]);
    for i in 0..6 {
        for j in 0..6 {
            let size = (k0[(i, i)] * k0[(j, j)]).sqrt();
            let expected = ratios[(i, j)] * k0[(i, j)];
            let found = k.cartesian.matrix[(i, j)];
            close(
                &format!("{label} K{}{}", i + 1, j + 1),
                found,
                expected,
                1e-10 * size,
            );
        }
    }
    assert_eq!(k.rank, 5, "{label}");
    assert_eq!(rank(&k.cartesian.matrix, 0.7), 5, "{label}");
}

#[test]
fn a_beam_has_the_corrected_stiffness_of_eq_3_26() {
    let file = golden("table_3_2.json");
    let (section, length) = section(&file["beam"]);
    let k = section.cantilever(length).unwrap();
    let expected = expand(&file["computed_beam"]);
    for i in 0..6 {
        for j in 0..6 {
            let size = (k[(i, i)] * k[(j, j)]).sqrt();
            close(
                &format!("K{}{}", i + 1, j + 1),
                k[(i, j)],
                expected[(i, j)],
                1e-11 * size,
            );
        }
    }
    let chain = Chain::builder("beam")
        .link("beam", &section, length)
        .build()
        .unwrap();
    let own = unloaded_stiffness(&chain, &Pose::identity(), &[0.0; 6], &[]).unwrap();
    assert!((own.cartesian.matrix - k).largest_entry() < 1e-9 * k.largest_entry());
    assert_eq!(own.rank, 6);
}

#[test]
fn trivial_passive_joints_change_a_beam_as_in_table_3_2() {
    let file = golden("table_3_2.json");
    let (section, length) = section(&file["beam"]);
    let k0 = section.cantilever(length).unwrap();
    for case in file["cases"].as_array().unwrap() {
        compare(case, &beam(case, &section, length, false), &k0);
    }
}

#[test]
fn quasi_trivial_passive_joints_change_a_beam_as_in_table_3_3() {
    let file = golden("table_3_3.json");
    let (section, length) = section(&file["beam"]);
    let k0 = section.cantilever(length).unwrap();
    for case in file["cases"].as_array().unwrap() {
        compare(case, &beam(case, &section, length, true), &k0);
    }
}
