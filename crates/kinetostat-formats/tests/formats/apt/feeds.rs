//! Speeds that FEDRAT states, and turns of the spindle.

use kinetostat_formats::*;
use kinetostat_program::SpindleRotation;

use super::program;

/// A feed by minutes or by turns, in each unit, to mm/s by hand.
#[test]
fn feeds_are_speeds_by_their_units() {
    for (unit, feed, mm_per_s) in [
        ("MM", "FEDRAT/600.,MMPM", Some(10.0)),
        ("MM", "FEDRAT/MMPM,600.0000", Some(10.0)),
        ("MM", "FEDRAT/600", Some(10.0)),
        ("INCH", "FEDRAT/12,IPM", Some(5.08)),
        ("MM", "FEDRAT/12,IPM", Some(5.08)),
        ("INCH", "FEDRAT/12", Some(5.08)),
        ("INCH", "FEDRAT/600,MMPM", Some(10.0)),
        // 1200 turns a minute are 20 a second.
        ("MM", "FEDRAT/.25,MMPR", Some(5.0)),
        ("MM", "FEDRAT/MMPR,0.25", Some(5.0)),
        ("MM", "FEDRAT/0.01,IPR", Some(5.08)),
        ("INCH", "FEDRAT/0.01,PERREV", Some(5.08)),
        ("MM", "FEDRAT/2,INVERS", None),
    ] {
        let text = format!(
            "UNITS/{unit}\n{feed}\nSPINDL/1200,RPM,CLW\nGOTO/1,0,0\nRAPID\nGOTO/2,0,0\nGOTO/3,0,0\n"
        );
        let program = program(&text);
        let speeds = [0, 1, 2].map(|index| program.motions[index].speed.mm_per_s);
        let near = |is: Option<f64>| match (is, mm_per_s) {
            (Some(is), Some(wanted)) => (is - wanted).abs() < 1e-12,
            (None, None) => true,
            _ => false,
        };
        assert!(
            near(speeds[0]) && near(speeds[2]),
            "{unit} {feed}: {speeds:?}"
        );
        // RAPID holds for one GOTO.
        assert_eq!(speeds[1], None);
        let robot = path_of(&program, &PathOptions::default()).unwrap();
        let wanted = mm_per_s.map(|speed| 60.0 * speed);
        let is = robot.path.moves[2].feed.map(|feed| feed.value);
        assert!(
            is.zip(wanted)
                .is_none_or(|(is, wanted)| (is - wanted).abs() < 1e-9)
        );
        assert_eq!(is.is_some(), wanted.is_some());
    }
}

#[test]
fn the_spindle_turns_as_is_stated() {
    use SpindleRotation::{Clockwise, CounterClockwise, Stopped};
    let text = "UNITS/MM\nGOTO/0,0,0\nSPINDL/3500,RPM,CLW\nGOTO/1,0,0\nSPINDL/ RPM, 900, CCLW, RANGE, 2\nGOTO/2,0,0\nSPINDL/OFF\nGOTO/3,0,0\n\
        SPINDL/ON\nFEDRAT/.1,MMPR\nGOTO/4,0,0\nSPINDL/400,SFM,CLW\nGOTO/5,0,0\nSPINDL/ 120\nGOTO/6,0,0\n";
    let program = program(text);
    let robot = path_of(&program, &PathOptions::default()).unwrap();
    let turns: Vec<_> = (robot.path.moves.iter())
        .map(|motion| {
            let spindle = robot.path.spindle_on(motion.line);
            (spindle.rotation, spindle.rpm())
        })
        .collect();
    let wanted = [
        (Stopped, Some(0.0)),
        (Clockwise, Some(3500.0)),
        (CounterClockwise, Some(900.0)),
        (Stopped, Some(0.0)),
        (Clockwise, Some(900.0)),
        (Clockwise, None),
        (Clockwise, Some(120.0)),
    ];
    assert_eq!(turns, wanted);
    // By turns a feed is known while those are.
    let speeds: Vec<_> = program.motions.iter().map(|m| m.speed.mm_per_s).collect();
    assert!((speeds[4].unwrap() - 1.5).abs() < 1e-12);
    assert_eq!(speeds[5], None);
    assert!((speeds[6].unwrap() - 0.2).abs() < 1e-12);
    // What drives on is written back as it was.
    let same = write(&program, &[], &WriteOptions::default()).unwrap();
    assert_eq!(same[0].1, text.as_bytes());
}
