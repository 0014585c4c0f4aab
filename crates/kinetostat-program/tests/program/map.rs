//! Corrections from a table.

// Helpers of tests, which clippy does not count as tests.
use kinetostat_program::*;
use nalgebra::Vector3;

#[test]
fn between_the_nodes_of_a_grid_the_correction_is_trilinear() {
    // A field that is linear in each coordinate is met exactly, at uneven spacing and in any order.
    let truth =
        |x: f64, y: f64, z: f64| Vector3::new(0.01 * x * y, 0.002 * z - 0.1, 0.001 * x * y * z);
    let mut rows = Vec::new();
    for x in [0.0, 10.0, 25.0] {
        for y in [-5.0, 5.0] {
            for z in [0.0, 1.0, 7.0] {
                let d = truth(x, y, z);
                rows.push(format!("{z},{x},{y},{},{},{}", d.z, d.x, d.y));
            }
        }
    }
    rows.reverse();
    let table = format!("z_mm,x_mm,y_mm,dz_mm,dx_mm,dy_mm\n{}\n", rows.join("\n"));
    let map = CorrectionMap::read(table.as_bytes()).unwrap();
    assert_eq!(
        map.bounds_mm(),
        [Vector3::new(0.0, -5.0, 0.0), Vector3::new(25.0, 5.0, 7.0)]
    );
    for (x, y, z) in [
        (0.0, -5.0, 0.0),
        (25.0, 5.0, 7.0),
        (3.0, 1.0, 0.5),
        (11.0, -4.5, 6.0),
        (10.0, 0.0, 1.0),
    ] {
        let value = map.at(&Vector3::new(x, y, z)).unwrap();
        assert!((value - truth(x, y, z)).norm() < 1e-12);
    }
}

#[test]
fn outside_the_grid_there_is_no_correction_and_the_message_names_axis_and_range() {
    let map = CorrectionMap::read(b"x_mm,y_mm,z_mm,dx_mm,dy_mm,dz_mm\n0,0,0,0,0,0\n10,0,0,0,0,1\n")
        .unwrap();
    let failure = map.at(&Vector3::new(10.5, 0.0, 0.0)).unwrap_err();
    assert_eq!(
        failure.message,
        "x 10.5000 mm is outside the map, which reaches from 0 to 10 mm; extend the map or move the part"
    );
    // Along axes with one value only the correction does not vary.
    assert_eq!(
        map.at(&Vector3::new(5.0, 77.0, -9.0)).unwrap(),
        Vector3::new(0.0, 0.0, 0.5)
    );
    assert!(map.at(&Vector3::new(f64::NAN, 0.0, 0.0)).is_err());
}

#[test]
fn a_map_corrects_a_program() {
    let map = CorrectionMap::read(b"\xef\xbb\xbf# measured\nx_mm, y_mm, z_mm, dx_mm, dy_mm, dz_mm\n0,0,0,0,0,0\n100,0,0,0.02,0,-0.1\n").unwrap();
    let program = Program::read("G21 G90\nG0 X0 Y0 Z0\nG1 X100 F500\n").unwrap();
    let reading = ReadOptions::default();
    let path = interpret(&program, &reading).unwrap();
    let writing = {
        let mut writing = WriteOptions::default();
        writing.header = None;
        writing
    };
    let written = write_corrected(&program, &path, &map, &writing, &Unwatched).unwrap();
    verify_written(&program, &path, &written, &reading, &writing).unwrap();
    assert_eq!(
        String::from_utf8(written.bytes).unwrap(),
        "G21 G90\nG0 X0 Y0 Z0\nG1 X100.0200 Z-0.1000 F500\n"
    );
}

#[test]
fn bad_maps_are_refused_with_line_reason_and_remedy() {
    let head = "x_mm,y_mm,z_mm,dx_mm,dy_mm,dz_mm\n";
    let cases: &[(String, u64, &str, &str)] = &[
        ("".into(), 1, "a column is missing", "x_mm,y_mm,z_mm"),
        (head.into(), 1, "says nothing", "at least one row"),
        (
            "x_mm,y_mm,z_mm,dx_mm,dy_mm,dz_um\n0,0,0,0,0,0\n".into(),
            1,
            "not known",
            "convert its numbers",
        ),
        (
            "x,y_mm,z_mm,dx_mm,dy_mm,dz_mm\n0,0,0,0,0,0\n".into(),
            1,
            "not known",
            "did you mean `x_mm`?",
        ),
        (
            "x_mm,x_mm,z_mm,dx_mm,dy_mm,dz_mm\n0,0,0,0,0,0\n".into(),
            1,
            "twice",
            "keep one",
        ),
        (
            "x_mm,y_mm,z_mm,dx_mm,dy_mm\n0,0,0,0,0\n".into(),
            1,
            "a column is missing",
            "dz_mm",
        ),
        (
            format!("{head}0,0,0,0,0,nan\n"),
            2,
            "no finite number",
            "decimal point",
        ),
        (
            format!("{head}0,0,0,0,0,0\n1,0,0,0,abc,0\n"),
            3,
            "no finite number",
            "decimal point",
        ),
        (
            format!("{head}0,0,0,0,0\n"),
            2,
            "5 cells, the header has 6",
            "six numbers",
        ),
        (
            format!("{head}0,0,0,0,0,0\n0,0,0,1,0,0\n"),
            3,
            "twice",
            "keep one row",
        ),
        (
            format!("{head}0,0,0,0,0,0\n1,1,0,0,0,0\n"),
            3,
            "no full grid",
            "full grid",
        ),
        (
            format!("{head}0,0,0,0,0,0\n10.0,0,0,0,0,0\n10.0009,0,0,1,0,0\n"),
            4,
            "at least 0.001 mm apart",
            "same digits",
        ),
        (
            format!("{head}0,0.1,0,0,0,0\n0,0.10000000000001,0,0,0,0\n1,0.1,0,0,0,0\n"),
            3,
            "at least 0.001 mm apart",
            "same digits",
        ),
        (
            format!("{head}0,0,0,0,0,\u{1}0\n"),
            2,
            "no finite number",
            "decimal point",
        ),
    ];
    for (text, line, reason, remedy) in cases {
        let error = CorrectionMap::read(text.as_bytes()).unwrap_err();
        let message = error.to_string();
        println!("{message}");
        assert_eq!(error.line, *line, "{message}");
        assert!(error.reason.contains(reason), "{message}");
        assert!(error.remedy.contains(remedy), "{message}");
        assert!(!message.contains('\u{1}'));
    }
    let error = CorrectionMap::read(b"\xff\xfe\x00").unwrap_err();
    assert!(error.to_string().contains("UTF-8"), "{error}");
}

/// All faults of a table in one run, in the order of its lines, and never more than requested.
#[test]
fn every_wrong_row_of_a_table_is_found_at_once() {
    use proptest::prelude::*;
    let wrong = prop_oneof![
        Just("0,0,0,0,0,nan"),
        Just("0,0,0,0,0"),
        Just("0,0,0,0,0,0,0"),
        Just("0,1e400,0,0,0,0"),
        Just("0,0,x,y,0,0"),
    ];
    let rows = proptest::collection::vec(proptest::option::of(wrong), 1..60);
    proptest!(|(rows in rows, most in 1..20_usize, crlf in any::<bool>())| {
        let mut text = "# a comment\n\nx_mm,y_mm,z_mm,dx_mm,dy_mm,dz_mm\n".to_owned();
        let mut lines = Vec::new();
        for (k, row) in rows.iter().enumerate() {
            if k % 7 == 3 {
                text.push_str("# a comment, another\n\n");
            }
            if row.is_some() {
                lines.push(text.lines().count() as u64 + 1);
            }
            text.push_str(&row.map_or_else(|| format!("{k},0,0,0,0,0"), str::to_owned));
            text.push('\n');
        }
        if crlf {
            text = text.replace('\n', "\r\n");
        }
        let found: Vec<u64> = CorrectionMap::faults(text.as_bytes(), most).iter().map(|fault| fault.line).collect();
        let wanted: Vec<u64> = lines.iter().copied().take(most).collect();
        prop_assert_eq!(&found, &wanted, "{}", text);
        let first = CorrectionMap::read(text.as_bytes()).err();
        prop_assert_eq!(first.map(|fault| fault.line), lines.first().copied());
    });
    let lines = |text: &str| -> Vec<(u64, String)> {
        let all = CorrectionMap::faults(text.as_bytes(), 100);
        all.into_iter()
            .map(|fault| (fault.line, fault.found))
            .collect()
    };
    assert_eq!(
        lines("x_mm,y,z_mm,z_mm,dx_mm,dz\n"),
        [(1, "column `y`"), (1, "column `z_mm`"), (1, "column `dz`")]
            .map(|(line, found)| (line, found.to_owned()))
    );
    let missing = lines("# measured\n\nx_mm,y_mm,dx_mm\n");
    let at: Vec<u64> = missing.iter().map(|(line, _)| *line).collect();
    assert_eq!(at, [3; 3]);
    let doubled =
        "x_mm,y_mm,z_mm,dx_mm,dy_mm,dz_mm\n0,0,0,0,0,0\n0,0,0,1,0,0\n1,0,0,0,0,0\n1,0,0,0,0,0\n";
    let found: Vec<u64> = lines(doubled).iter().map(|(line, _)| *line).collect();
    assert_eq!(found, [3, 5]);
}
