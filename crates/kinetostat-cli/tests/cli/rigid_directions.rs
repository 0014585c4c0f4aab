//! Where a machine is rigid, the compliance holds and the stiffness is null, in every command; what each limb gives to a stiffness
//! adds up to it.

use crate::common::{run, workplace};
use nalgebra::{DMatrix, Matrix3, Matrix6, Vector3, Vector6};
use serde_json::Value;

fn stiffness(words: &[&str]) -> Value {
    let here = workplace();
    let said = run(
        here.path(),
        &[&["stiffness"][..], words, &["--json"]].concat(),
    )
    .answered();
    serde_json::from_str(&said.out).expect("JSON")
}

fn entries(rows: &Value) -> Matrix6<Option<f64>> {
    Matrix6::from_fn(|i, j| rows[i][j].as_f64())
}

fn numbers(rows: &Value) -> Matrix6<f64> {
    entries(rows).map(|x| x.expect("a number"))
}

/// At A5 = 0 the wrist is stretched: C = J K^-1 J^T has rank 5, whatever the unit of length.
#[test]
fn a_stretched_wrist_is_rigid_with_and_without_a_load() {
    let load: &[&str] = &["--force", "100", "0", "0"];
    for extra in [&[][..], load] {
        let answer = stiffness(&[&["kuka_kr270_like", "--joints", "A5=0"][..], extra].concat());
        assert_eq!(answer["rigid_directions"], 1, "{extra:?}");
        let c = numbers(&answer["compliance_m_rad_per_n"]);
        // The axes of A2, A3 and A5 are parallel to y; the other three are across it.
        let about_y = 1.0 / 3.31e6 + 1.0 / 2.46e6 + 1.0 / 3.03e5;
        assert!((c[(4, 4)] / about_y - 1.0).abs() < 1e-3, "{}", c[(4, 4)]);
        let w = Vector6::from_fn(|i, _| {
            let own = &answer["constraint_wrenches_n_n_m"][0][i];
            own.as_f64().expect("a number")
        });
        assert!((c * w).norm() < 1e-7 * c.norm() * w.norm(), "{w}");
        let k = entries(&answer["stiffness_n_m_rad"]);
        let (moving, locked) = ([0, 2, 4], [1, 3, 5]);
        let part = Matrix3::from_fn(|i, j| c[(moving[i], moving[j])]);
        let part = part.try_inverse().expect("regular");
        for (i, row) in moving.into_iter().enumerate() {
            for (j, column) in moving.into_iter().enumerate() {
                let found = k[(row, column)].expect("a number");
                let size = (part[(i, i)] * part[(j, j)]).sqrt();
                assert!(
                    (found - part[(i, j)]).abs() < 1e-3 * size,
                    "{row} {column}: {found}"
                );
            }
            for other in locked {
                assert_eq!((k[(row, other)], k[(other, row)]), (None, None));
            }
        }
        for i in locked {
            assert!(locked.iter().all(|&j| k[(i, j)].is_none()));
        }
        let kinds = answer["principal_directions"].as_array().expect("a list");
        let rigid: Vec<&Value> = kinds.iter().filter(|d| d["kind"] == "rigid").collect();
        assert_eq!(rigid.len(), 1);
        assert!(rigid[0]["stiffness_n_per_mm"].is_null());
    }
    let unloaded = stiffness(&["kuka_kr270_like", "--joints", "A5=0"]);
    assert!(unloaded["at_rest"]["stiffness_n_m_rad"][1][1].is_null());
    // Away from it there are numbers.
    let bent = stiffness(&["kuka_kr270_like", "--joints", "A5=20"]);
    let (k, c) = (
        numbers(&bent["stiffness_n_m_rad"]),
        numbers(&bent["compliance_m_rad_per_n"]),
    );
    let left = k * c - Matrix6::identity();
    assert!(kinetostat_testing::largest_size(left.iter().copied()) < 1e-6);
}

#[test]
fn limbs_add_up_to_the_stiffness_of_the_tool() {
    for model in ["orthoglide", "stewart_gough_b"] {
        for load in [
            &[][..],
            &[
                "--force", "300", "-200", "-900", "--moment", "20", "-30", "10",
            ],
        ] {
            let answer = stiffness(&[&[model][..], load].concat());
            let mut sum = Matrix6::zeros();
            for limb in answer["limbs"].as_array().expect("a list") {
                let s = Vector3::from_fn(|k, _| limb["arm_m"][k].as_f64().expect("a number"));
                let mut to_end = Matrix6::identity();
                to_end
                    .fixed_view_mut::<3, 3>(0, 3)
                    .copy_from(&-s.cross_matrix());
                let own = entries(&limb["stiffness_n_m_rad"]).map(|x| x.unwrap_or(f64::NAN));
                sum += to_end.transpose() * own * to_end;
                let lever = &limb["lever_n_m_per_rad"];
                let lever = Matrix3::from_fn(|i, j| lever[i][j].as_f64().expect("a number"));
                let mut turns = sum.fixed_view_mut::<3, 3>(3, 3);
                turns += lever;
                let rows = |name: &str| limb[name].as_array().map_or(0, Vec::len);
                assert!(rows("springs") > 0 && rows("passive_joints") > 0, "{model}");
            }
            let k = numbers(&answer["stiffness_n_m_rad"]);
            let scale = DMatrix::from_fn(6, 6, |i, j| (k[(i, i)] * k[(j, j)]).abs().sqrt());
            for i in 0..6 {
                for j in 0..6 {
                    let off = (sum[(i, j)] - k[(i, j)]).abs();
                    assert!(off < 1e-8 * scale[(i, j)] + 1e-3, "{model} {i} {j}: {off}");
                }
            }
        }
    }
}
