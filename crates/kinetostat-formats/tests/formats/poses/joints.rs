//! Tables of joint values with an arm.

use std::sync::Arc;

use kinetostat_formats::*;
use nalgebra::{Isometry3, UnitQuaternion, Vector3};

/// Two turning joints and a slide in a plane: 800 mm and 500 mm, and up along z.
#[derive(Debug)]
struct Scara;

const LINKS: [f64; 2] = [800.0, 500.0];

impl JointArm for Scara {
    fn joint_count(&self) -> usize {
        3
    }

    fn tool_pose(&self, joints: &[f64]) -> Isometry3<f64> {
        let [a, b] = [joints[0].to_radians(), (joints[0] + joints[1]).to_radians()];
        let x = LINKS[0] * a.cos() + LINKS[1] * b.cos();
        let y = LINKS[0] * a.sin() + LINKS[1] * b.sin();
        let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), b);
        Isometry3::from_parts(Vector3::new(x, y, joints[2]).into(), turn)
    }

    fn joints_near(&self, tool: &Isometry3<f64>, near: &[f64]) -> Option<Vec<f64>> {
        let p = tool.translation.vector;
        let cosine = (p.xy().norm_squared() - LINKS[0].powi(2) - LINKS[1].powi(2))
            / (2.0 * LINKS[0] * LINKS[1]);
        let elbow = match near[1] < 0.0 {
            true => -cosine.acos(),
            false => cosine.acos(),
        };
        let own = (LINKS[1] * elbow.sin()).atan2(LINKS[0] + LINKS[1] * elbow.cos());
        let first = p.y.atan2(p.x) - own;
        let found = vec![first.to_degrees(), elbow.to_degrees(), p.z];
        found.iter().all(|joint| joint.is_finite()).then_some(found)
    }
}

fn options(between: BetweenRows) -> ReadOptions {
    let mut options = ReadOptions::default();
    let arm = Arc::new(Scara);
    options.arm = Some(TableArm { arm, between });
    options
}

const TABLE: &str = "q1_rad;q2_deg;lift_mm;speed_mm_per_s;note\n0.100000;-40;20;;above\n0.10;-40.5;-1;20;\"in; it goes\"\n0.11;-41.25;-1;20;along\n";

fn read_it(text: &str, between: BetweenRows) -> Result<RobotProgram, Vec<ProgramError>> {
    read_poses(vec![SourceFile::new("q.csv", text)], &options(between))
}

#[test]
fn rows_are_poses_and_become_joint_values_again() {
    let program = read_it(TABLE, BetweenRows::Linear).unwrap();
    let path = path_of(&program, &PathOptions::default()).unwrap();
    assert_eq!(path.path.moves.len(), 3);
    let files = write(&program, &[], &WriteOptions::default()).unwrap();
    assert_eq!(files[0].1, TABLE.as_bytes());
    // Two pieces on the way to the last row; the second one ends 0.2 mm beside it and goes slower.
    let [from, to] = [1, 2].map(|k| program.motions[k].target.pose().unwrap().position_mm);
    let mut first = Piece::to(2, 0.5 * (from + to));
    first.speed_factor = 0.5;
    let last = Piece::to(2, to + Vector3::new(0.0, 0.2, 0.05));
    let wanted = [first.position_mm, last.position_mm];
    let files = write(&program, &[first, last], &WriteOptions::default()).unwrap();
    let output = String::from_utf8(files[0].1.clone()).unwrap();
    let lines: Vec<&str> = output.lines().collect();
    assert_eq!(lines.len(), 5, "{output}");
    assert!(TABLE.starts_with(&lines[..3].join("\n")), "{output}");
    assert!(lines[3].ends_with(";10;along"), "{output}");
    assert!(lines[4].ends_with(";-0.950000;20;along"), "{output}");
    let again = read_it(&output, BetweenRows::Linear).unwrap();
    for (k, wanted) in wanted.iter().enumerate() {
        let found = again.motions[2 + k].target.pose().unwrap().position_mm;
        // 1e-8 rad at 1.3 m, and the digits of the lift.
        assert!((found - wanted).norm() < 1e-4, "{found} {wanted}");
    }
    // Out of reach.
    let far = Piece::to(2, Vector3::new(2000.0, 0.0, 0.0));
    let error = write(&program, &[far], &WriteOptions::default()).unwrap_err();
    assert!(error.to_string().contains("no joint values"), "{error}");
}

#[test]
fn rows_that_are_far_apart_or_of_another_arm_are_refused_by_line() {
    let said = |text: &str, between| {
        let errors = read_it(text, between).unwrap_err();
        assert_eq!(errors.len(), 1, "{errors:#?}");
        errors[0].to_string()
    };
    assert!(read_it(TABLE, BetweenRows::Joint).is_ok());
    let wide = format!("{TABLE}0.5;-41.25;-1;20;far\n");
    let error = said(&wide, BetweenRows::Joint);
    assert!(error.contains("leaves the straight way"), "{error}");
    assert!(error.contains("line 5"), "{error}");
    assert!(read_it(&wide, BetweenRows::Linear).is_ok());
    let two = "q1_rad;q2_deg\n0.1;3\n";
    let error = said(two, BetweenRows::Linear);
    assert!(error.contains("2 joints, the arm 3"), "{error}");
    let error = said(&TABLE.replace("-41.25", "1e30"), BetweenRows::Linear);
    assert!(error.contains("beyond"), "{error}");
    // A bow that is small enough is told of.
    let program = read_it(&TABLE.replace("0.11;", "0.125;"), BetweenRows::Joint).unwrap();
    let told = program.findings.iter().find(|f| f.line == 4).unwrap();
    assert!(told.message.contains("all joints move in step"), "{told:?}");
}

#[test]
fn numbers_in_names_count_and_not_the_order_of_columns() {
    let there = read_it(
        "A2_deg,A1_deg,A3_mm\n-40,10,20\n-41,11,20\n",
        BetweenRows::Linear,
    );
    let program = there.unwrap();
    let path = path_of(&program, &PathOptions::default()).unwrap();
    let end = path.path.moves[1].end;
    let by_hand = Scara.tool_pose(&[11.0, -41.0, 20.0]).translation.vector;
    assert!((end - by_hand).norm() < 1e-9, "{end}");
    for names in [
        "A1_deg,A2_deg,E1_mm",
        "A1_deg,A3_deg,A4_mm",
        "A2_deg,A3_deg,A4_mm",
        "A2_deg,A1_deg,lift_mm",
    ] {
        let text = format!("{names}\n10,-40,20\n");
        let refused = read_it(&text, BetweenRows::Linear).unwrap_err();
        assert!(
            refused[0].reason.contains("not numbered 1, 2, 3"),
            "{names}: {refused:?}"
        );
    }
}
