//! Every construct is read, and without pieces every byte comes back.

use kinetostat_formats::*;
use nalgebra::Vector3;

const SOURCE: &str = include_str!("../fixtures/everything.src");
const DATA: &str = include_str!("../fixtures/everything.dat");
const CONFIG: &str = include_str!("../fixtures/$config.dat");

fn read_all(change: impl Fn(&str) -> Vec<u8>) -> (RobotProgram, Vec<(String, Vec<u8>)>) {
    let texts = [
        ("R1/everything.src", SOURCE),
        ("R1/Everything.DAT", DATA),
        ("$config.dat", CONFIG),
    ];
    let bytes: Vec<(String, Vec<u8>)> = texts
        .iter()
        .map(|(name, text)| ((*name).to_owned(), change(text)))
        .collect();
    let files = bytes
        .iter()
        .map(|(name, bytes)| SourceFile::new(name.clone(), bytes.clone()))
        .collect();
    let program =
        read_krl(files, &ReadOptions::default()).unwrap_or_else(|errors| panic!("{errors:#?}"));
    (program, bytes)
}

#[test]
fn every_motion_is_found_with_what_it_says() {
    let (program, _) = read_all(|text| text.as_bytes().to_vec());
    let words: Vec<&str> = program
        .motions
        .iter()
        .map(|motion| SOURCE[motion.span.clone()].split(' ').next().unwrap())
        .collect();
    assert_eq!(
        words.join(" "),
        "PTP PTP LIN LIN LIN lin LIN CIRC LIN LIN PTP SPTP SLIN SCIRC LIN LIN LIN LIN LIN"
    );
}

#[test]
fn what_is_in_force_is_known_at_each_motion() {
    let (program, _) = read_all(|text| text.as_bytes().to_vec());
    let place = |index: usize| program.motions[index].target.pose().unwrap().position_mm;
    let places = [
        (1, [100.5, 0.0, 50.0]),
        (2, [100.5, 0.0, 5.0]),
        (3, [10.0, 20.5, -3.0]),
        (4, [11.0, 0.5, 3.25]),
        // What is not stated is that of before.
        (5, [11.0, 0.5, 5.0]),
        (6, [1.0, 2.0, 3.0]),
        (8, [20.0, 30.0, 3.0]),
        // The axes of the pose are turned a quarter about Z and a half about X: its Y is X of the base.
        (9, [24.0, 30.0, 3.0]),
        (17, [7.0, 8.0, 9.0]),
    ];
    for (index, expected) in places {
        assert!(
            (place(index) - Vector3::from(expected)).norm() < 1e-9,
            "motion {index}: {}",
            place(index)
        );
    }
    let MotionKind::Circular { via } = &program.motions[7].kind else {
        panic!("no circle")
    };
    assert_eq!(
        via.pose().unwrap().position_mm,
        Vector3::new(15.5, 5.0, 3.0)
    );
    let home = Target::Joints {
        values_deg: vec![0.0, -90.0, 90.0, 0.0, 0.0, 0.0],
    };
    assert_eq!(program.motions[0].target, home);
    let zones: Vec<Zone> = program.motions.iter().map(|motion| motion.zone).collect();
    let expected = [
        Zone::Exact,
        Zone::Percent(40.0),
        Zone::Radius(3.5),
        Zone::Radius(0.5),
        Zone::Exact,
    ];
    assert_eq!(zones[..5], expected);
    assert_eq!((zones[9], zones[12]), (Zone::Unstated, Zone::Radius(3.5)));
    let speeds: Vec<Option<f64>> = program
        .motions
        .iter()
        .map(|motion| motion.speed.mm_per_s)
        .collect();
    assert_eq!(
        (speeds[1], speeds[2], speeds[3], speeds[12]),
        (None, Some(50.0), Some(20.0), Some(300.0))
    );
    assert_eq!(speeds[17], Some(100.0));
    for motion in &program.motions[1..10] {
        assert_eq!(
            (motion.tool.name.as_str(), motion.work_object.name.as_str()),
            ("TOOL_DATA[1]", "BASE_DATA[2]")
        );
    }
    // A quarter turn about z: x of this base is y of the world.
    let base = program.motions[3].base_pose().unwrap().translation.vector;
    assert!((base - Vector3::new(1000.0 - 20.5, 10.0, 497.0)).norm() < 1e-9);
    let configuration = &program.motions[4].target.pose().unwrap().configuration;
    assert_eq!(
        (
            configuration.text.as_str(),
            configuration.numbers.as_slice()
        ),
        ("S 'B010',T 'B00100011'", &[2.0, 35.0][..])
    );
    assert_eq!(
        program.motions[4].target.pose().unwrap().external,
        [Some(0.0); 6]
    );
}
