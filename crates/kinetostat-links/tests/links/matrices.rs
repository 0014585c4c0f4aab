//! 6 x 6 matrices from CSV and JSON, the table that comes out, and what is said of them.

use kinetostat::BeamSection;
use kinetostat_links::{
    Grade, SYMMETRIC_TO, Units, check_stiffness, in_n_mm, read_matrix, stiffness_table, symmetrised,
};
use nalgebra::Matrix6;

use crate::{apart, text};

fn bar() -> Matrix6<f64> {
    BeamSection::tube(2.1e11, 8.0e10, 0.06, 0.04)
        .cantilever(0.4)
        .expect("a section")
}

/// A CSV of the bar in N and mm with rows and columns in the given order.
fn csv(order: &[usize; 6]) -> String {
    let names = ["x", "y", "z", "rx", "ry", "rz"];
    let k = in_n_mm(&bar());
    let mut out = String::from("# forearm\nsource,FEA 2024\nstiffness_n_mm_rad");
    for i in order {
        out += &format!(",{}", names[*i]);
    }
    for i in order.iter().rev() {
        out += &format!("\n{}", names[*i]);
        for j in order {
            out += &format!(",{:e}", k[(*i, *j)]);
        }
    }
    out + "\n"
}

#[test]
fn csv_in_any_order_and_json_say_the_same() {
    for order in [[0, 1, 2, 3, 4, 5], [3, 4, 5, 0, 1, 2], [5, 0, 3, 2, 1, 4]] {
        let read = read_matrix(&text("m.csv", &csv(&order)), None).expect("reads");
        assert!(apart(&read.at_link_end(), &bar()) < 1e-14);
        assert_eq!(read.source.as_deref(), Some("FEA 2024"));
    }
    let rows: Vec<Vec<f64>> = (0..6)
        .map(|i| (0..6).map(|j| bar()[(i, j)]).collect())
        .collect();
    let json = serde_json::json!({ "stiffness_n_m_rad": rows }).to_string();
    let read = read_matrix(&text("m.json", &json), None).expect("reads");
    assert!(apart(&read.at_link_end(), &bar()) < 1e-14);
    // A compliance in pounds and inches is inverted.
    let pound = Units::named("lbf-in").expect("known");
    let c = bar().try_inverse().expect("regular");
    let rows: Vec<Vec<f64>> = (0..6)
        .map(|i| {
            (0..6)
                .map(|j| {
                    let lengths = i32::from(i >= 3) + i32::from(j >= 3) - 1;
                    c[(i, j)] * pound.force_n * pound.length_m.powi(lengths)
                })
                .collect()
        })
        .collect();
    let json = serde_json::json!({ "compliance_lbf_in_rad": rows }).to_string();
    let read = read_matrix(&text("m.json", &json), None).expect("reads");
    assert!(read.was_compliance && apart(&read.at_link_end(), &bar()) < 1e-11);
}

/// The matrix of the same bar as a program would give it at another point and in other axes: the
/// file's point is 30 mm beyond the end, its x points along the link's y.
#[test]
fn point_and_axes_of_the_file_are_taken_into_account() {
    // By hand: the compliance at a point p beyond the end is T C T^T, T = [I, -hat(p)].
    let p = nalgebra::vector![0.03, -0.02, 0.05];
    let mut t = Matrix6::identity();
    t.fixed_view_mut::<3, 3>(0, 3).copy_from(&-p.cross_matrix());
    let there = t * bar().try_inverse().expect("regular") * t.transpose();
    // Own axes x, y, z along y, -x, z of the link.
    let mut r = Matrix6::zeros();
    for b in [0, 3] {
        r[(b, b + 1)] = 1.0;
        r[(b + 1, b)] = -1.0;
        r[(b + 2, b + 2)] = 1.0;
    }
    let own = (r * there * r.transpose()).try_inverse().expect("regular");
    let rows: Vec<Vec<f64>> = (0..6)
        .map(|i| (0..6).map(|j| own[(i, j)]).collect())
        .collect();
    let json = serde_json::json!({
        "stiffness_n_m_rad": rows, "reference_point_mm": [30.0, -20.0, 50.0],
        "x_axis": [0, 1, 0], "y_axis": [-1, 0, 0],
    });
    let read = read_matrix(&text("m.json", &json.to_string()), None).expect("reads");
    assert!(apart(&read.at_link_end(), &bar()) < 1e-11);
}

#[test]
fn findings_name_what_a_matrix_is_not() {
    let refused = |k: &Matrix6<f64>, word: &str| {
        let checked = check_stiffness(k, SYMMETRIC_TO);
        assert!(!checked.is_stiffness(), "{word}");
        let all: Vec<String> = checked
            .findings
            .iter()
            .map(|f| format!("{}; {}", f.message, f.help))
            .collect();
        assert!(all.iter().any(|m| m.contains(word)), "{word}: {all:?}");
    };
    let mut k = bar();
    k[(1, 5)] *= 1.01;
    refused(&k, "row rz column y");
    assert!(check_stiffness(&symmetrised(&k), SYMMETRIC_TO).is_stiffness());
    let mut k = bar();
    k[(1, 5)] *= -1.2;
    k[(5, 1)] *= -1.2;
    refused(&k, "not positive semi-definite");
    let mut k = bar();
    k[(2, 2)] = -1.0;
    refused(&k, "entry z, z is negative");
    let mut k = bar();
    k[(0, 3)] = f64::NAN;
    refused(&k, "row 1 column 4");
    // A hinge at the end about z: rank 5, a finding and no refusal.
    let k = bar();
    let column = k.column(5).into_owned();
    let hinged = k - column * column.transpose() / k[(5, 5)];
    let checked = check_stiffness(&hinged, SYMMETRIC_TO);
    assert!(checked.is_stiffness() && checked.rank == 5 && !checked.is_definite());
    assert!(
        checked.findings[0].message.contains("rank is 5")
            && checked.findings[0].message.contains("rz")
    );
    // N and mm read as N and m.
    let checked = check_stiffness(&in_n_mm(&bar()), SYMMETRIC_TO);
    assert!(
        checked
            .findings
            .iter()
            .any(|f| f.grade == Grade::Doubtful && f.help.contains("units"))
    );
    let checked = check_stiffness(&bar(), SYMMETRIC_TO);
    assert!(checked.findings.is_empty() && (0.05..0.4).contains(&checked.natural_length));
}

#[test]
fn the_table_is_symmetric_toml_with_escaped_words() {
    let mut k = bar();
    k[(1, 5)] *= 1.0 + 1e-13;
    let table = stiffness_table("upper arm", &k, "FEA \"v2\"\n\\share", Some("rigid flange"));
    assert!(table.starts_with("[stiffness.\"upper arm\"]\nmatrix_n_mm_rad = [\n"));
    assert!(
        table.contains("source = \"FEA \\\"v2\\\" \\\\share\"\nassumption = \"rigid flange\"\n")
    );
    let rows: Vec<Vec<f64>> = table
        .lines()
        .filter_map(|l| l.trim().strip_prefix('[')?.strip_suffix("],"))
        .map(|l| l.split(", ").map(|x| x.parse().expect("number")).collect())
        .collect();
    assert_eq!(rows.len(), 6);
    let mm = in_n_mm(&bar());
    for i in 0..6 {
        for j in 0..6 {
            assert_eq!(rows[i][j], rows[j][i]);
            assert!((rows[i][j] - mm[(i, j)]).abs() <= 1e-11 * (mm[(i, i)] * mm[(j, j)]).sqrt());
        }
    }
}
