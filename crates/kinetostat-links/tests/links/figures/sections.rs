//! Sections against independent numbers: integration over the area, shear flow, series.

use kinetostat_links::{MATERIALS, SectionShape, material};
use serde_json::Value;

use crate::at_most;

/// Area and second moments by counting cells.
fn counted(inside: impl Fn(f64, f64) -> bool, width: f64, height: f64) -> [f64; 3] {
    const CELLS: i32 = 1200;
    let (dy, dz) = (width / f64::from(CELLS), height / f64::from(CELLS));
    let mut sums = [0.0; 3];
    for i in 0..CELLS {
        for j in 0..CELLS {
            let (y, z) = (
                (f64::from(i) + 0.5) * dy - 0.5 * width,
                (f64::from(j) + 0.5) * dz - 0.5 * height,
            );
            if inside(y, z) {
                for (sum, f) in
                    sums.iter_mut()
                        .zip([1.0, z * z + dz * dz / 12.0, y * y + dy * dy / 12.0])
                {
                    *sum += f * dy * dz;
                }
            }
        }
    }
    sums
}

#[test]
fn areas_and_second_moments_are_those_of_the_shape() {
    let (w, h) = (0.12_f64, 0.24_f64);
    let within = |y: f64, z: f64, a: f64, b: f64| y.abs() < 0.5 * a && z.abs() < 0.5 * b;
    type Inside = Box<dyn Fn(f64, f64) -> bool>;
    let cases: [(SectionShape, Inside, f64); 4] = [
        (
            SectionShape::IBeam {
                width: w,
                height: h,
                flange: 0.012,
                web: 0.01,
            },
            Box::new(move |y, z| z.abs() > 0.108 || y.abs() < 0.005),
            1e-9,
        ),
        (
            SectionShape::HollowBox {
                width: w,
                height: h,
                side_wall: 0.006,
                top_wall: 0.012,
            },
            Box::new(move |y, z| !within(y, z, w - 0.012, h - 0.024)),
            1e-9,
        ),
        (
            SectionShape::Rectangle {
                width: w,
                height: h,
            },
            Box::new(|_, _| true),
            1e-9,
        ),
        (
            SectionShape::Tube {
                outer: 0.12,
                inner: 0.09,
            },
            Box::new(|y, z| (0.045..0.06).contains(&y.hypot(z))),
            1e-3,
        ),
    ];
    for (shape, inside, tolerance) in cases {
        let height = if matches!(shape, SectionShape::Tube { .. }) {
            w
        } else {
            h
        };
        let p = shape.properties(0.3).expect("section");
        let found = [p.area, p.second_moment_y, p.second_moment_z];
        for (a, b) in found.iter().zip(counted(inside, w, height)) {
            assert!((a / b - 1.0).abs() < tolerance, "{}: {a} {b}", shape.name());
        }
    }
}

#[test]
fn torsion_and_shear_against_series_and_shear_flow() {
    let golden: Value =
        serde_json::from_str(include_str!("../../data/sections.json")).expect("golden");
    let number = |name: &str| golden[name].as_f64().expect("number");
    let rectangle = SectionShape::Rectangle {
        width: 0.03,
        height: 0.1,
    }
    .properties(0.0)
    .expect("section");
    at_most(
        "torsion of a rectangle",
        (rectangle.torsion_constant * 1e12 / number("torsion_100_x_30_mm4") - 1.0).abs(),
        1e-10,
        "relative",
    );
    assert!((rectangle.shear_area_z / rectangle.area - 5.0 / 6.0).abs() < 1e-14);
    let i = SectionShape::IBeam {
        width: 0.08,
        height: 0.12,
        flange: 0.006,
        web: 0.008,
    }
    .properties(0.0)
    .expect("section");
    let b = SectionShape::HollowBox {
        width: 0.08,
        height: 0.12,
        side_wall: 0.004,
        top_wall: 0.006,
    }
    .properties(0.0)
    .expect("section");
    // The I's centre line is 80 wide (flanges end there), the box's 76.
    at_most(
        "shear coefficient of an I (Poisson's ratio 0)",
        (i.shear_area_z / i.area / number("thin_i_kappa_nu_0") - 1.0).abs(),
        1e-12,
        "relative",
    );
    at_most(
        "shear coefficient of a box (Poisson's ratio 0)",
        (b.shear_area_z / b.area / number("thin_box_kappa_nu_0") - 1.0).abs(),
        1e-12,
        "relative",
    );
    // Turned by a right angle, a box is a box.
    let t = SectionShape::HollowBox {
        width: 0.12,
        height: 0.08,
        side_wall: 0.006,
        top_wall: 0.004,
    }
    .properties(0.3)
    .expect("section");
    let b = SectionShape::HollowBox {
        width: 0.08,
        height: 0.12,
        side_wall: 0.004,
        top_wall: 0.006,
    }
    .properties(0.3)
    .expect("section");
    assert!(
        (t.shear_area_y / b.shear_area_z - 1.0).abs() < 1e-14
            && (t.torsion_constant / b.torsion_constant - 1.0).abs() < 1e-14
    );
    // Bredt for a thin square tube: side^3 t. Cowper for a thin round tube: 2 (1 + nu) / (4 + 3 nu).
    let thin = SectionShape::HollowBox {
        width: 0.1001,
        height: 0.1001,
        side_wall: 1e-4,
        top_wall: 1e-4,
    }
    .properties(0.3)
    .expect("section");
    assert!((thin.torsion_constant / (0.1_f64.powi(3) * 1e-4) - 1.0).abs() < 1e-12);
    let tube = SectionShape::Tube {
        outer: 0.1,
        inner: 0.0999,
    }
    .properties(0.3)
    .expect("section");
    assert!((tube.shear_area_y / tube.area - 2.6 / 4.9).abs() < 1e-3);
}

#[test]
fn sections_that_are_none_are_refused_in_words() {
    for (shape, word) in [
        (
            SectionShape::Tube {
                outer: 0.05,
                inner: 0.06,
            },
            "inner diameter",
        ),
        (
            SectionShape::Tube {
                outer: f64::NAN,
                inner: 0.0,
            },
            "outer",
        ),
        (
            SectionShape::Rectangle {
                width: 0.0,
                height: 0.1,
            },
            "width is 0",
        ),
        (
            SectionShape::IBeam {
                width: 0.1,
                height: 0.1,
                flange: 0.05,
                web: 0.01,
            },
            "flanges",
        ),
        (
            SectionShape::HollowBox {
                width: 0.1,
                height: 0.1,
                side_wall: 0.05,
                top_wall: 0.01,
            },
            "walls",
        ),
        (
            SectionShape::HollowBox {
                width: 0.1,
                height: 0.1,
                side_wall: -0.01,
                top_wall: 0.01,
            },
            "side wall",
        ),
    ] {
        let error = shape.properties(0.3).expect_err(word).to_string();
        assert!(error.contains(word) && error.contains("; "), "{error}");
    }
}

#[test]
fn materials_have_sources_and_plausible_moduli() {
    for m in MATERIALS {
        assert!(
            !m.source.is_empty()
                && (1e10..=3e11).contains(&m.youngs_modulus)
                && (1e3..=1e4).contains(&m.density)
        );
        assert_eq!(material(m.name).map(|f| f.source), Some(m.source));
    }
    let steel = material("steel").expect("known");
    assert!((steel.shear_modulus() / 80.77e9 - 1.0).abs() < 1e-4);
    assert!(material("unobtainium").is_none());
}
