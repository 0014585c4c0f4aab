//! The unit of lengths: a wrong factor of 1000 is the worst fault of a list of poses.

use kinetostat_formats::*;

use super::{RASTERS, place, read_with};

fn stated(unit: Option<LengthUnit>) -> ReadOptions {
    let mut options = ReadOptions::default();
    options.length_unit = unit;
    options
}

fn refusal(name: &str, text: &str, unit: Option<LengthUnit>) -> String {
    let errors = read_with(name, text.as_bytes(), &stated(unit)).expect_err("it is refused");
    errors[0].to_string()
}

#[test]
fn what_is_not_stated_is_refused() {
    let yaml = "- position: {x: 0.1, y: 0.2, z: 0.3}\n- position: {x: 0.4, y: 0.2, z: 0.3}\n";
    for (name, text) in [("a.yaml", yaml), ("a.csv", "x,y,z\n1,2,3\n4,5,6\n")] {
        let said = refusal(name, text, None);
        assert!(
            said.contains("whether lengths are mm or m is not stated"),
            "{said}"
        );
        assert!(said.contains("length_unit"), "{said}");
        let metres = read_with(name, text.as_bytes(), &stated(Some(LengthUnit::Metre))).unwrap();
        let mm = read_with(name, text.as_bytes(), &stated(Some(LengthUnit::Millimetre))).unwrap();
        let (metres, mm) = (place(&metres, 0), place(&mm, 0));
        for axis in 0..3 {
            assert!((metres[axis] - 1000.0 * mm[axis]).abs() < 1e-12);
        }
    }
}

#[test]
fn messages_of_ros_are_in_metres_where_their_size_allows_no_doubt() {
    let large = RASTERS
        .replace("x: 0.1", "x: 100.0")
        .replace("y: 0.30", "y: 300")
        .replace("x: 0.2\n", "x: 200.0\n");
    let said = refusal("a.yaml", &large, None);
    assert!(
        said.contains("the numbers reach 300 from the origin"),
        "{said}"
    );
    // Stated, it is taken, and warned of.
    let metres = read_with("a.yaml", large.as_bytes(), &stated(Some(LengthUnit::Metre))).unwrap();
    let warned = |program: &RobotProgram, part: &str| {
        program
            .findings
            .iter()
            .any(|finding| finding.message.contains(part))
    };
    assert!(warned(&metres, "are they mm?"));
    let mm = read_with(
        "a.yaml",
        RASTERS.as_bytes(),
        &stated(Some(LengthUnit::Millimetre)),
    )
    .unwrap();
    assert!(warned(&mm, "are they metres?"));
}

#[test]
fn names_and_option_must_agree() {
    let text = "x_m,y_m,z_m\n1,2,3\n";
    let said = refusal("a.csv", text, Some(LengthUnit::Millimetre));
    assert!(
        said.contains("another unit of lengths than length_unit"),
        "{said}"
    );
    read_with("a.csv", text.as_bytes(), &stated(Some(LengthUnit::Metre))).unwrap();
    let far = "x_m,y_m,z_m\n1,2,300\n";
    let program = read_with("a.csv", far.as_bytes(), &stated(None)).unwrap();
    assert_eq!(
        program.findings[0].message,
        "the places are stated in m and reach 300.0 m from the origin: are they mm?"
    );
}
