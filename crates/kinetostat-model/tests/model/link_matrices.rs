//! Matrices of links that are positive definite and yet belong to no link.

use kinetostat::BeamSection;
use kinetostat_model::{Model, doubts_of_link_matrix};
use nalgebra::Matrix6;

const MODEL: &str = r#"schema = 1
[mechanism]
name = "boom"
gravity_m_per_s2 = [0, 0, -9.81]
[[platform]]
name = "tool"
home = { position_mm = [600, 0, 0] }
mass_kg = 2
[chain.arm]
elements = [
  { actuator = "revolute", name = "shoulder", axis = "z", stiffness_n_m_per_rad = 5e5 },
  { link = "boom", name = "boom", length_mm = 600 },
]
[[limb]]
name = "arm"
from = "base"
to = "tool"
chain = "arm"
[stiffness.boom]
matrix_n_mm_rad = MATRIX
"#;

/// A boom of 600 mm, N and mm.
fn boom() -> [[f64; 6]; 6] {
    let mut k = [[0.0; 6]; 6];
    for (i, d) in [420e3, 1900.0, 2600.0, 81e6, 312e6, 228e6]
        .into_iter()
        .enumerate()
    {
        k[i][i] = d;
    }
    (k[1][5], k[5][1]) = (-570e3, -570e3);
    (k[2][4], k[4][2]) = (780e3, 780e3);
    k
}

/// What a model with this matrix is warned of.
fn said(k: [[f64; 6]; 6]) -> String {
    let text = MODEL.replace("MATRIX", &format!("{k:?}"));
    let model = Model::from_toml(&text, "boom.toml").unwrap_or_else(|e| panic!("{e}"));
    let all: Vec<String> = model.warnings.iter().map(ToString::to_string).collect();
    all.join("\n")
}

#[test]
fn a_boom_says_nothing() {
    assert_eq!(said(boom()), "");
}

#[test]
fn a_direction_that_is_nearly_free_is_named() {
    for (i, value, name) in [
        (0, 1e-12, "x (1.00e-12 N/mm)"),
        (3, 1e-6, "rx (1.00e-6 N mm/rad)"),
    ] {
        let mut k = boom();
        k[i][i] = value;
        let said = said(k);
        assert!(
            said.contains(&format!("nearly free in direction {name}")),
            "{said}"
        );
    }
    // Soft is not free: a leaf spring.
    let mut k = boom();
    k[3][3] = 81e2;
    assert_eq!(said(k), "");
}

#[test]
fn couplings_of_the_wrong_end() {
    let mut k = boom();
    for (i, j) in [(1, 5), (5, 1), (2, 4), (4, 2)] {
        k[i][j] = -k[i][j];
    }
    assert!(said(k).contains("stiffness at the near end"), "{}", said(k));
    for (i, j, plane) in [(1, 5, "y, rz"), (2, 4, "z, ry")] {
        let mut k = boom();
        (k[i][j], k[j][i]) = (-k[i][j], -k[j][i]);
        let said = said(k);
        let wanted = [
            &format!("the coupling {plane} has the wrong sign"),
            "no beam has one",
        ];
        assert!(wanted.iter().all(|w| said.contains(*w)), "{said}");
    }
}

#[test]
fn sizes_that_do_not_fit_the_length() {
    let soft = boom().map(|row| row.map(|x| 1e-6 * x));
    assert!(said(soft).contains("is 0.42 N/mm"), "{}", said(soft));
    // A link of 6 m in a model that says 600 mm.
    let long = BeamSection::tube(7e10, 2.6e10, 0.2, 0.15)
        .cantilever(6.0)
        .expect("a section");
    let doubts = doubts_of_link_matrix(&long, Some(0.6));
    assert!(doubts[0].0.contains("3000 mm behind the end"), "{doubts:?}");
}

#[test]
fn beams_of_all_lengths_say_nothing() {
    for length in [0.02, 0.3, 2.0, 8.0] {
        for share in [0.02, 0.1, 0.5] {
            let bar = BeamSection::tube(2.1e11, 8e10, share * length, 0.0)
                .cantilever(length)
                .expect("a section");
            for known in [None, Some(length)] {
                assert_eq!(doubts_of_link_matrix(&bar, known), [], "{length} {share}");
            }
        }
    }
    let diagonal = Matrix6::from_diagonal(&[4e8, 4e8, 4e8, 8e4, 8e4, 8e4].into());
    assert_eq!(doubts_of_link_matrix(&diagonal, Some(0.6)), []);
}
