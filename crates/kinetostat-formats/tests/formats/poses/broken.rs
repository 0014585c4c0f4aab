//! Files that are refused: line, what is said, and all of it in one run.

use kinetostat_formats::*;

use super::{RASTERS, read_with};

fn errors(name: &str, text: &str) -> Vec<(usize, String)> {
    let found =
        read_with(name, text.as_bytes(), &ReadOptions::default()).expect_err("it is refused");
    found
        .iter()
        .map(|error| (error.line, error.to_string()))
        .collect()
}

#[test]
fn names_that_are_not_enough_or_too_many_are_refused() {
    for (names, part) in [
        ("x_mm,y_mm", "not stated: z; state all of them"),
        ("x_mm,y_mm,z_mm,qw,qx,qz", "not stated: qy"),
        ("x_mm,y_mm,z_mm,rx_deg", "not stated: ry_deg, rz_deg"),
        (
            "note,other",
            "no place is named; name the columns with their units",
        ),
        (
            "x_mm,y_mm,z_mm,x_mm",
            "it is stated a second time: `x_mm` stands before",
        ),
        ("x_mm,y_mm,z_mm,note,note", "it is stated a second time"),
        (
            "x_mm,y_mm,z_m",
            "a coordinate in another unit than the one before",
        ),
        (
            "x_mm,y_mm,z_mm,qw,qx,qy,qz,rx_deg,ry_deg,rz_deg",
            "a second orientation beside another one",
        ),
        (
            "x_mm,y_mm,z_mm,rx,ry,rz",
            "an orientation whose convention is not stated",
        ),
        (
            "x_mm,y_mm,z_mm,rx_rad,ry_rad,rz_rad",
            "an orientation whose convention is not stated",
        ),
        (
            "x_in,y_in,z_in",
            "a length without its unit, or with another than mm and m",
        ),
        (
            "x_mm,y_mm,z_mm,speed",
            "a speed without its unit; name it with its unit: speed_mm_per_s",
        ),
        (
            "x_mm,y_mm,z_mm,time_s",
            "a time at which the pose is reached",
        ),
        ("x_mm,y_mm,z_mm,dx_mm", "an offset, which moves the pose"),
        (
            "x_mm,y_mm,z_mm,tool_offset_mm",
            "an offset, which moves the pose",
        ),
        ("x_mm,y_mm,z_mm,interpolation", "which way the tool takes"),
        ("x_mm,y_mm,z_mm,joint_1_deg", "joint values beside poses"),
        (
            "joint_1_deg,joint_3_deg",
            "the joints are not numbered 1, 2, 3",
        ),
        ("joint_1,joint_2", "a joint without its unit"),
        ("x_mm,y_mm,z_mm,\"note", "a quote is not closed"),
        ("1.0,2.0,3.0", "the first line holds numbers"),
        (
            "x_mm,y_mm,z_mm,speed_mm_per_s,feed_mm_per_min",
            "a second speed",
        ),
    ] {
        let found = errors("a.csv", &format!("# head\n{names}\n1,2,3\n"));
        let hit = found.iter().all(|(line, _)| *line == 2)
            && found.iter().any(|(_, message)| message.contains(part));
        assert!(hit, "{names}: {found:?}");
    }
    assert!(errors("a.csv", "")[0].1.contains("the table is empty"));
    assert!(
        errors("a.csv", "# only words\n\n")[0]
            .1
            .contains("the table is empty")
    );
}

#[test]
fn rows_that_are_wrong_are_refused_by_line_all_at_once() {
    let text = "x_mm,y_mm,z_mm,qw,qx,qy,qz,rapid,speed_mm_per_s,external_1_mm\n\
        1,2,3,1,0,0,0,1,,0\n\
        1,two,3,1,0,0,0,0,20,0\n\
        1,2,3,1,0,0.1,0,0,20,0\n\
        1,2,3,1,0,0,0,0,20\n\
        1,2,3,1,0,0,0,maybe,20,0\n\
        1,2,inf,1,0,0,0,0,20,0\n\
        1,2,1e999,1,0,0,0,0,20,0\n\
        1,2,,1,0,0,0,0,20,0\n\
        1,2,3,1,0,0,0,0,fast,0\n\
        1,2,3,1,0,0,0,0,20,\"0\n\
        1,2,3,1,0,0,0,0,20,5\n";
    let found = errors("a.csv", text);
    let lines: Vec<usize> = found.iter().map(|(line, _)| *line).collect();
    assert_eq!(lines, [3, 4, 5, 6, 7, 8, 9, 10, 11, 12]);
    for (index, part) in [
        "`two`: it is no number; write a finite number with a decimal point",
        "the quaternion has the length 1.004988 instead of 1 (within 0.001)",
        "it has 9 cells, the line of names has 10",
        "`maybe`: whether the pose is reached in air is neither 0 nor 1",
        "`inf`: it is no number",
        "`1e999`: it is no number",
        "`1,2,,1,0,0,0,0,20,0`: it is no number",
        "`fast`: it is no number",
        "a quote is not closed on its line",
        "an external axis moves here",
    ]
    .iter()
    .enumerate()
    {
        assert!(found[index].1.contains(part), "{part}: {}", found[index].1);
    }
    let found = errors(
        "a.csv",
        "x_mm,y_mm,z_mm,rx_deg,ry_deg,rz_deg\n1,2,3,0,4e4,0\n",
    );
    assert!(
        found[0]
            .1
            .contains("`4e4`: the angle is more than a hundred turns"),
        "{found:?}"
    );
    // Commas of decimals beside points of decimals, or of thousands.
    let found = errors("a.csv", "x_mm;y_mm;z_mm\n1,5;2.0;3\n");
    assert!(found[0].1.contains("`1,5`: it is no number"), "{found:?}");
    let found = errors("a.csv", "x_mm,y_mm,z_mm\n1,5,2,3\n");
    assert!(
        found[0]
            .1
            .contains("a decimal comma cannot stand beside commas"),
        "{found:?}"
    );
    let mut options = ReadOptions::default();
    options.external_axes = ExternalAxes::Carried;
    let text = "x_mm,y_mm,z_mm,external_1_mm\n1,2,3,0\n1,2,3,5\n";
    read_with("a.csv", text.as_bytes(), &options).unwrap();
}

#[test]
fn yaml_that_says_no_pose_or_a_doubtful_one_is_refused_by_line() {
    for (from, to, line, part) in [
        ("x: 0.1\n", "x: zero\n", 9, "`zero`: it is no number"),
        ("x: 0.1\n", "x: \"0.1\"\n", 9, "it is no number"),
        ("x: 0.1\n", "x: .inf\n", 9, "it is no number"),
        ("x: 0.1\n", "x: 0x10\n", 9, "it is no number"),
        ("x: 0.1\n", "x:\n", 8, "it is no number"),
        ("x: 0.1\n            ", "", 8, "not stated: x"),
        (
            "x: 0.1\n",
            "x: 0.1\n            x: 0.1\n",
            10,
            "it is stated a second time",
        ),
        (
            "x: 0.1\n",
            "x: 0.1\n            u: 7\n",
            10,
            "what this is of a pose is not known",
        ),
        (
            "y: 1\n            w",
            "y: 1.1\n            w",
            13,
            "the quaternion has the length 1.1",
        ),
        (
            "w: 6.123233995736766e-17\n            ",
            "",
            8,
            "not stated: qw",
        ),
        (
            "dwell: 0",
            "time_from_start: 1",
            19,
            "a time at which the pose is reached",
        ),
        ("dwell: 0", "rx_deg: 1", 19, "a second orientation"),
        (
            "orientation: {w: 0, x: 0, y: 1, z: 0}",
            "orientation: [0, 0, 1, 0]",
            17,
            "whether w is the first or the last",
        ),
        (
            "position: {z: -0.02, y: 0.30, x: 0.1}",
            "position: here",
            18,
            "the place is not x, y, z",
        ),
        (
            "- orientation: {w: 0, x: 0, y: 1, z: 0}\n          position: {z: -0.02, y: 0.30, x: 0.1}",
            "- name: gap",
            17,
            "it has no `position`",
        ),
        (
            "      z: 0\n",
            "      z: 0.1\n",
            31,
            "`tool_offset` moves the tool",
        ),
        ("  tool_offset:", "\ttool_offset:", 30, "it is no YAML"),
        ("  paths:", "  paths: {", 5, "it is no YAML"),
        ("{z: -0.02, y: 0.30, x: 0.1}", "*there", 18, "it is no YAML"),
    ] {
        assert!(RASTERS.contains(from), "{from}");
        let at = match from.starts_with("      z: 0") {
            true => RASTERS.rfind(from).unwrap(),
            false => RASTERS.find(from).unwrap(),
        };
        let text = [&RASTERS[..at], to, &RASTERS[at + from.len()..]].concat();
        let found = errors("a.yaml", &text);
        let hit = found
            .iter()
            .any(|(own, message)| own.abs_diff(line) <= 1 && message.contains(part));
        assert!(hit, "{to}: {found:?}");
    }
    for (text, part) in [
        ("", "no list of poses stands in the file"),
        ("a: 1\n", "no list of poses stands in the file"),
        (
            "points:\n- positions: [1, 2]\n  time_from_start: 1\n",
            "no list of poses",
        ),
        (
            "- [1, 2, 3, 1, 0, 0, 0]\n",
            "7 numbers without names: which of them are the orientation",
        ),
        (
            "a: &p {x: 1, y: 2, z: 3}\nposes:\n- position: *p\n",
            "an alias: what it stands for is written elsewhere",
        ),
        ("a: &p [1]\nb: *p\n", "an alias"),
    ] {
        let found = errors("a.yaml", text);
        assert!(
            found.iter().any(|(_, message)| message.contains(part)),
            "{text}: {found:?}"
        );
    }
}

#[test]
fn parquet_is_refused_with_the_way_out() {
    assert_eq!(language_of("a.parquet", b"PAR1"), Some(Language::Poses));
    let found = errors("a.parquet", "PAR1\u{15}\u{4}\n\u{15}PAR1");
    assert!(found[0].1.contains("write it as CSV"), "{found:?}");
}

#[test]
fn large_and_deep_files_end() {
    let deep = "[".repeat(100_000);
    for text in [
        deep.as_str(),
        &"- ".repeat(100_000),
        &"{a: ".repeat(100_000),
    ] {
        let found = errors("a.yaml", text);
        assert!(
            found[0].1.contains("deep") || found[0].1.contains("no YAML"),
            "{found:?}"
        );
    }
    let wide = format!("x_mm,y_mm,z_mm\n{}", "x,,\"\n".repeat(200_000));
    let found = read_with("a.csv", wide.as_bytes(), &ReadOptions::default()).unwrap_err();
    assert_eq!(found.len(), 100_000);
}

#[test]
fn names_stand_once_in_their_table() {
    let mut names: Vec<&str> = POSES_STATEMENTS.iter().map(|row| row.name).collect();
    names.sort_unstable();
    assert!(names.windows(2).all(|pair| pair[0] != pair[1]));
}
