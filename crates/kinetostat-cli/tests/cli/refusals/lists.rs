//! Lists of a fixed length: each one of a job and of a file of poses, shorter and longer than it should be.

use std::ops::Range;

use crate::common::{JOB, run, workplace};

/// Every list of numbers that a job can hold, beside words of other kinds.
const JOBS: [&str; 4] = [
    r#"[placement]
part_origin_mm = [0, 0, 100]
part_orientation = { x_axis = [1, 0, 0], y_axis = [0, 1, 0] }
tool_orientation = { rotation_vector_deg = [0, 0, 1] }

[[deviation]]
limb = "leg x"
at = "start"
moved_by = { translation_mm = [0.1, 0, 0], rotation_vector_rad = [0, 0, 0.001] }

[[deviation]]
limb = "leg x"
at = "line"
tilted_by_deg = 0.1
about = [0, 0, 1]

[tool]
pose = { position_mm = [0, 0, 100], quaternion_wxyz = [1, 0, 0, 0] }

[load]
force_n = [10, 0, 5]
moment_n_m = [0, 0, 0.1]

[reading]
start_position_mm = [0, 0, 20]
machine_zero_mm = [0, 0, 320]
g28_mm = [0, 0, 0]
g30_mm = [10, 0, -5]
work_offset_mm = { G54 = [0, 0, 0], "G59.1" = [10, 0, 0] }
"#,
    r#"[[tools]]
number = 1
pose = { translation_m = [0, 0, 0.1], quaternion_xyzw = [0, 0, 0, 1] }
load = { force_n = [1, 2, 3], moment_n_m = [0, 0, 1] }

[placement]
part_orientation = { rotation_intrinsic_xyz_deg = [0, 0, 1] }
tool_orientation = { roll_pitch_yaw_urdf_deg = [0, 0, 1] }
"#,
    r#"[placement]
part_orientation = { a_b_c_kuka_deg = [0, 0, 1] }
tool_orientation = { w_p_r_fanuc_deg = [0, 0, 1] }

[tool]
pose = { position_m = [0, 0, 0.1] }
"#,
    r#"[placement]
part_orientation = { roll_pitch_yaw_urdf_rad = [0, 0, 0.1] }
"#,
];

const POSES: &str = r#"schema = 1

[[pose]]
joints = { x = 0, y = 0, z = 0 }
tool = { position_mm = [0, 0, 0], rotation_vector_deg = [0, 0, 0] }

[[pose]]
joints = { x = 1, y = 2, z = 3 }
tool = { position_m = [0, 0, 0], quaternion_wxyz = [1, 0, 0, 0] }
"#;

/// Where the lists stand, with their brackets; a header of a table is none.
fn lists(text: &str) -> Vec<Range<usize>> {
    let starts = text.match_indices("= [").map(|(at, _)| at + 2);
    starts
        .map(|start| start..start + text[start..].find(']').expect("its end") + 1)
        .collect()
}

/// The same list with another number of entries.
fn resized(list: &str, count: usize) -> String {
    let entries: Vec<&str> = list.trim_matches(['[', ']']).split(',').collect();
    let more = entries.iter().map(|e| e.trim()).cycle().take(count);
    format!("[{}]", more.collect::<Vec<_>>().join(", "))
}

/// Refuses every list of the text in every wrong length, with its line and column; returns how many there are.
fn check(text: &str, arguments: &[&str]) -> usize {
    let here = workplace();
    let found = lists(text);
    for span in &found {
        let list = &text[span.clone()];
        let needed = list.matches(',').count() + 1;
        for given in [0, 1, needed - 1, needed + 1, 2 * needed] {
            let wrong = format!(
                "{}{}{}",
                &text[..span.start],
                resized(list, given),
                &text[span.end..]
            );
            std::fs::write(here.path().join("bad.toml"), &wrong).expect("written");
            let said = run(here.path(), arguments);
            assert_eq!(said.code, 1, "{wrong}\n{said:?}");
            let line = wrong[..span.start].matches('\n').count() + 1;
            let column = span.start - wrong[..span.start].rfind('\n').map_or(0, |at| at + 1) + 1;
            let place = format!("bad.toml:{line}:{column}");
            let what = format!("{needed} values are needed, {given} are given");
            assert!(
                said.err.contains(&place) && said.err.contains(&what),
                "{place}: {what} is not in\n{}",
                said.err
            );
            assert_eq!(said.err.matches("error").count(), 1, "{}", said.err);
            let comma = said.err.contains("a decimal point, not a comma");
            assert_eq!(comma, given > needed, "{}", said.err);
        }
    }
    found.len()
}

#[test]
fn every_list_of_a_job_has_its_length() {
    let head = &JOB[..JOB.find("[placement]").expect("there")];
    let mut count = 0;
    for job in JOBS {
        let text = format!("{head}{job}");
        for command in ["check", "compensate"] {
            count += check(&text, &[command, "bad.toml"]);
        }
    }
    // 27 lists, by two commands: more keys with lists are to be written above.
    assert_eq!(count, 2 * 27);
}

#[test]
fn every_list_of_a_file_of_poses_has_its_length() {
    let count = check(POSES, &["check", "orthoglide", "--pose", "bad.toml"]);
    assert_eq!(count, 4);
}

/// What follows from a refused value is not reported as another fault.
#[test]
fn an_orientation_where_a_word_stands_is_reported_once() {
    let here = workplace();
    for value in [
        "{ a_b_c_kuka_deg = [0, 180, 0] }",
        "{ quaternion_wxyz = [0, 0, 0, 1] }",
        "{}",
        "3",
        "[0, 180, 0]",
    ] {
        let job = JOB.replace(
            "[placement]",
            &format!("[placement]\norientation = {value}"),
        );
        std::fs::write(here.path().join("bad.toml"), job).expect("written");
        for command in ["check", "compensate"] {
            let said = run(here.path(), &[command, "bad.toml"]);
            assert_eq!(said.code, 1, "{said:?}");
            assert!(said.err.contains("held, follows"), "{}", said.err);
            assert!(said.err.contains("bad.toml:6"), "{}", said.err);
            assert!(!said.err.contains("element"), "{}", said.err);
            assert_eq!(said.err.matches("error").count(), 1, "{}", said.err);
            let keys = said.err.contains("tool_orientation");
            assert_eq!(keys, value.starts_with("{ "), "{}", said.err);
        }
    }
}
