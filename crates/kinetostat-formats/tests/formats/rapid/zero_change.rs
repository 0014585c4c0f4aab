//! Every construct is read, and without pieces every byte comes back.

use kinetostat_formats::*;
use nalgebra::Vector3;

const EVERYTHING: &str = include_str!("../fixtures/everything.mod");

fn read_text(bytes: &[u8]) -> RobotProgram {
    let files = vec![SourceFile::new("everything.mod", bytes)];
    let mut options = ReadOptions::default();
    (options.values).insert("diReady".into(), StatedValue::Number(1.0));
    read_rapid(files, &options).unwrap_or_else(|errors| panic!("{errors:#?}"))
}

#[test]
fn every_motion_is_found_with_what_it_says() {
    let program = read_text(EVERYTHING.as_bytes());
    let lines: Vec<(usize, &str)> = (program.motions.iter())
        .map(|motion| {
            (
                motion.line,
                EVERYTHING[motion.span.clone()]
                    .split([' ', '\\'])
                    .next()
                    .unwrap(),
            )
        })
        .collect();
    let words: Vec<&str> = lines.iter().map(|(_, word)| *word).collect();
    let expected = "MoveAbsJ MoveAbsJ movej MoveL MoveL MoveL MoveC MoveL ArcLStart ArcL ArcLEnd TriggL MoveLDO MoveL MoveL \
                    MoveL MoveL MoveL";
    assert_eq!(words, expected.split(' ').collect::<Vec<_>>());
    let place = |index: usize| program.motions[index].target.pose().unwrap().position_mm;
    let expected = [
        (2, [100.0, 0.0, 30.0]),
        (3, [100.0, 0.0, 5.0]),
        (4, [0.5, -0.25, 3.0]),
        (5, [48.091, -40.594, 15.0]),
        (6, [2.0, 2.0, 2.0]),
        (7, [5.0, 5.0, 5.0]),
        (10, [11.0, 1.0, 1.0]),
        (13, [0.5, -0.25, 13.0]),
        (14, [1.0, 1.0, 1.0]),
        (17, [1.0, 1.0, 1.0]),
    ];
    for (index, place_mm) in expected {
        assert_eq!(place(index), Vector3::from(place_mm), "motion {index}");
    }
    // The tool of p10 points down: back along its axis is up.
    let MotionKind::Circular { via } = &program.motions[6].kind else {
        panic!("no circle")
    };
    let via = via.pose().unwrap();
    assert!((via.position_mm - Vector3::new(100.0, 0.0, 10.0)).norm() < 1e-6);
    // Turned by 10 degrees about its own axis.
    let angle = via
        .orientation
        .angle_to(&program.motions[3].target.pose().unwrap().orientation);
    assert!((angle.to_degrees() - 10.0).abs() < 1e-6);
    let speeds: Vec<Option<f64>> = program.motions.iter().map(|m| m.speed.mm_per_s).collect();
    assert_eq!(
        speeds[..8],
        [
            Some(1000.0),
            Some(1000.0),
            None,
            Some(20.0),
            Some(20.0),
            Some(30.0),
            Some(50.0),
            None
        ]
    );
    let zones: Vec<Zone> = program.motions.iter().map(|m| m.zone).collect();
    assert_eq!(
        zones[2..7],
        [
            Zone::Radius(10.0),
            Zone::Exact,
            Zone::Radius(0.5),
            Zone::Radius(2.0),
            Zone::Radius(1.0)
        ]
    );
    let joints = Target::Joints {
        values_deg: vec![0.0, -30.0, 30.0, 0.0, 60.0, 0.0],
    };
    assert_eq!(program.motions[0].target, joints);
    let configuration = &program.motions[3].target.pose().unwrap().configuration;
    assert_eq!(
        (
            configuration.text.as_str(),
            configuration.numbers.as_slice()
        ),
        ("[0,-1,-1,0]", &[0.0, -1.0, -1.0, 0.0][..])
    );
    assert_eq!(
        program.motions[3].target.pose().unwrap().external,
        [None; 6]
    );
    assert_eq!(
        program.motions[3].tool.known().unwrap().translation.vector,
        Vector3::new(10.0, 0.0, 141.258)
    );
    // A quarter turn about z: x of the work object is y of the base.
    let base = program.motions[3].base_pose().unwrap().translation.vector;
    assert!((base - Vector3::new(226.5, -1879.7, 563.6)).norm() < 1e-4);
}

#[test]
fn runs_and_findings_are_said() {
    let program = read_text(EVERYTHING.as_bytes());
    let runs: Vec<Runs> = program.motions.iter().map(|motion| motion.runs).collect();
    // One motion in a routine that a loop calls four times.
    let mut wanted = [Runs::Once; 18];
    wanted[14..].fill(Runs::Repeatedly);
    assert_eq!(runs, wanted);
    let follows: Vec<Option<usize>> = program.motions.iter().map(|m| m.follows).collect();
    let wanted: Vec<Option<usize>> = (0..18_usize).map(|at| at.checked_sub(1)).collect();
    assert_eq!(follows, wanted);
    let messages: Vec<&str> = program
        .findings
        .iter()
        .map(|f| f.message.as_str())
        .collect();
    assert_eq!(messages.len(), 3, "{messages:?}");
    assert_eq!(messages[0], "`diReady` is 1, as is stated");
    // Of a condition that does not hold.
    assert!(
        messages[1].contains("does not come to the motions on line 62"),
        "{messages:?}"
    );
    assert!(messages[2].starts_with("what is called is computed"));
}
