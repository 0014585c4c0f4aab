//! Straight and tapered links against closed forms, quadrature in 30 digits, and fine segmentation.

use kinetostat_links::{Properties, SectionShape, Shear, cantilever, cantilever_by};
use kinetostat_testing::Worst;
use nalgebra::{Matrix6, Vector3, Vector6};
use serde_json::Value;

use crate::{apart, at_most};

const E: f64 = 7.0e10;
const NU: f64 = 0.3;
const L: f64 = 0.45;

fn golden() -> Value {
    serde_json::from_str(include_str!("../../data/sections.json")).expect("golden")
}

#[test]
fn a_prismatic_link_without_shear_is_the_core_s_cantilever() {
    let shape = SectionShape::HollowBox {
        width: 0.08,
        height: 0.12,
        side_wall: 0.004,
        top_wall: 0.006,
    };
    let p = shape.properties(NU).expect("section");
    let core = p
        .section(E, E / (2.0 + 2.0 * NU))
        .cantilever(L)
        .expect("a section");
    let k = cantilever(&shape, &shape, L, E, NU, Shear::None).expect("link");
    at_most(
        "prismatic cantilever 6 x 6 against closed form",
        apart(&k, &core),
        1e-12,
        "of the diagonal",
    );
}

/// [Przemieniecki1968], the 12 x 12 of a beam with shear: its last block, `phi = 12 E I / G A_s L^2`.
#[test]
fn timoshenko_s_cantilever_is_the_textbook_s() {
    let shape = SectionShape::Rectangle {
        width: 0.05,
        height: 0.09,
    };
    let p = shape.properties(NU).expect("section");
    let g = E / (2.0 + 2.0 * NU);
    let mut wanted = Matrix6::zeros();
    wanted[(0, 0)] = E * p.area / L;
    wanted[(3, 3)] = g * p.torsion_constant / L;
    for (d, r, inertia, shear, sign) in [
        (1, 5, p.second_moment_z, p.shear_area_y, -1.0),
        (2, 4, p.second_moment_y, p.shear_area_z, 1.0),
    ] {
        let phi = 12.0 * E * inertia / (g * shear * L * L);
        let unit = E * inertia / ((1.0 + phi) * L.powi(3));
        wanted[(d, d)] = 12.0 * unit;
        wanted[(r, r)] = (4.0 + phi) * L * L * unit;
        wanted[(d, r)] = sign * 6.0 * L * unit;
        wanted[(r, d)] = wanted[(d, r)];
    }
    let k = cantilever(&shape, &shape, L, E, NU, Shear::Timoshenko).expect("link");
    at_most(
        "Timoshenko cantilever 6 x 6 against closed form",
        apart(&k, &wanted),
        1e-12,
        "of the diagonal",
    );
    let stiffer = cantilever(&shape, &shape, L, E, NU, Shear::None).expect("link");
    assert!(stiffer[(2, 2)] > 1.02 * k[(2, 2)]);
}

#[test]
fn a_tapered_rectangle_agrees_with_quadrature_in_thirty_digits() {
    let golden = &golden()["tapered_rectangle_compliance_si"];
    let root = SectionShape::Rectangle {
        width: 0.06,
        height: 0.10,
    };
    let tip = SectionShape::Rectangle {
        width: 0.03,
        height: 0.04,
    };
    let k = cantilever(&root, &tip, 0.5, 70e9, 0.0, Shear::Timoshenko).expect("link");
    let c = k.try_inverse().expect("regular");
    let mut worst = Worst::new();
    for (name, i, j) in [
        ("xx", 0, 0),
        ("yy", 1, 1),
        ("zz", 2, 2),
        ("rxrx", 3, 3),
        ("ryry", 4, 4),
        ("rzrz", 5, 5),
        ("yrz", 1, 5),
        ("zry", 2, 4),
    ] {
        let wanted = golden[name].as_f64().expect("number");
        worst.add((c[(i, j)] / wanted - 1.0).abs());
    }
    at_most(
        "tapered rectangle against quadrature in 30 digits",
        worst.of(8),
        1e-11,
        "relative",
    );
}

/// Series of 4000 short prismatic pieces by compositions of compliances, not by quadrature.
#[test]
fn a_tapered_link_agrees_with_fine_segmentation() {
    let root = SectionShape::IBeam {
        width: 0.12,
        height: 0.2,
        flange: 0.012,
        web: 0.008,
    };
    let tip = SectionShape::IBeam {
        width: 0.06,
        height: 0.1,
        flange: 0.008,
        web: 0.006,
    };
    let k = cantilever(&root, &tip, L, E, NU, Shear::Timoshenko).expect("link");
    let (mut errors, g) = (Vec::new(), E / (2.0 + 2.0 * NU));
    for pieces in [1000, 2000] {
        let h = L / f64::from(pieces);
        let mut compliance = Matrix6::<f64>::zeros();
        for i in 0..pieces {
            let share = (f64::from(i) + 0.5) / f64::from(pieces);
            let p = root
                .towards(&tip, share)
                .expect("same")
                .properties(NU)
                .expect("section");
            // Closed form of a short cantilever, moved to the tip.
            let mut own = p
                .section(E, g)
                .cantilever(h)
                .expect("a section")
                .try_inverse()
                .expect("regular");
            own[(1, 1)] += h / (g * p.shear_area_y);
            own[(2, 2)] += h / (g * p.shear_area_z);
            let t = kinetostat::spatial::shift_matrix(&Vector3::new(
                L - h * f64::from(i + 1),
                0.0,
                0.0,
            ));
            compliance += t * own * t.transpose();
        }
        errors.push(apart(&compliance.try_inverse().expect("regular"), &k));
    }
    at_most(
        "tapered I against 2000 prismatic pieces",
        errors[1],
        1e-6,
        "of the diagonal",
    );
    // The pieces' error is of second order in their length.
    assert!((errors[0] / errors[1] - 4.0).abs() < 0.3, "{errors:?}");
}

#[test]
fn any_change_along_the_link_by_a_function() {
    // Bending stiffness that grows with exp(x): the compliance of the tip is elementary.
    let k = cantilever_by(1.0, |x| {
        let c = (-x).exp();
        Ok(Vector6::new(c, 0.0, 0.0, c, c, c))
    })
    .expect("link");
    let c = k.try_inverse().expect("regular");
    let e = (-1.0_f64).exp();
    assert!((c[(0, 0)] - (1.0 - e)).abs() < 1e-12);
    // int (1-x)^2 e^-x dx = 1 - 2/e; int (1-x) e^-x dx = 1/e.
    assert!((c[(1, 1)] - (1.0 - 2.0 * e)).abs() < 1e-12 && (c[(1, 5)] - e).abs() < 1e-12);
    let error = cantilever_by(1.0, |_| Ok(Vector6::zeros())).expect_err("rigid");
    assert!(error.to_string().contains("compliance"));
    let custom = Properties {
        area: 1e-3,
        second_moment_y: 1e-7,
        second_moment_z: 2e-7,
        torsion_constant: 1e-7,
        shear_area_y: f64::INFINITY,
        shear_area_z: f64::INFINITY,
    };
    let (a, b) = (
        SectionShape::Custom(custom),
        SectionShape::Tube {
            outer: 0.1,
            inner: 0.08,
        },
    );
    let one = cantilever(&a, &a, L, E, NU, Shear::Timoshenko).expect("link");
    assert!(
        apart(
            &one,
            &custom
                .section(E, E / (2.0 + 2.0 * NU))
                .cantilever(L)
                .expect("a section")
        ) < 1e-12
    );
    for (error, word) in [
        (cantilever(&a, &b, L, E, NU, Shear::None), "same kind"),
        (cantilever(&a, &a, -1.0, E, NU, Shear::None), "length"),
        (cantilever(&a, &a, L, 0.0, NU, Shear::None), "modulus"),
        (cantilever(&a, &a, L, E, 0.7, Shear::None), "Poisson"),
    ] {
        assert!(error.expect_err(word).to_string().contains(word));
    }
}
