//! Every construct is read, and without pieces every byte comes back.

use kinetostat_formats::*;

use super::{EVERYTHING, decided, read_with};

#[test]
fn every_construct_is_what_the_manual_says() {
    let program = read_with(EVERYTHING.as_bytes(), &decided()).unwrap();
    assert_eq!(program.motions.len(), 15);
    let motions = &program.motions;
    let speeds: Vec<Option<f64>> = motions.iter().map(|motion| motion.speed.mm_per_s).collect();
    // 60 cm/min, 30 inch/min.
    assert_eq!(
        speeds[..8],
        [
            None,
            None,
            Some(2000.0),
            Some(10.0),
            Some(20.0),
            None,
            Some(12.7),
            None
        ]
    );
    let zones: Vec<Zone> = motions.iter().map(|motion| motion.zone).collect();
    assert_eq!(
        zones[2..7],
        [
            Zone::Percent(100.0),
            Zone::Exact,
            Zone::Percent(50.0),
            Zone::Unstated,
            Zone::Radius(10.0)
        ]
    );
    assert_eq!(
        motions[1].target,
        Target::Joints {
            values_deg: vec![6.428, -7.0, 8.0, 9.0, 10.0, 11.0]
        }
    );
    let MotionKind::Circular { via } = &motions[4].kind else {
        panic!("C is a circle")
    };
    assert_eq!(
        via.pose().unwrap().position_mm.as_slice(),
        [110.0, 10.0, 5.0]
    );
    let pose = motions[3].target.pose().unwrap();
    assert_eq!(pose.configuration.text, "F U T, 0, 0, -1");
    assert_eq!(pose.configuration.numbers, [0.0, 0.0, -1.0]);
    // Rz(0) Ry(0) Rx(180): Z points down.
    let down = pose.orientation * nalgebra::Vector3::z();
    assert!((down + nalgebra::Vector3::z()).norm() < 1e-12);
    let external = &motions[4].target.pose().unwrap().external;
    assert_eq!(external[..], [Some(12.5), Some(0.0), Some(0.0)]);
    // Behind a CALL of what is not read, `UF : F` says nothing.
    assert_eq!(motions[12].work_object.known(), None);
    for motion in &motions[..11] {
        assert_eq!(
            (motion.work_object.name.as_str(), motion.tool.name.as_str()),
            ("UF:2", "UT:1")
        );
    }
}

#[test]
fn runs_and_starts_follow_branches_loops_and_jumps() {
    let program = read_with(EVERYTHING.as_bytes(), &decided()).unwrap();
    let lines: Vec<(usize, Runs)> = (program.motions.iter())
        .map(|motion| (motion.line, motion.runs))
        .collect();
    let (once, again) = (Runs::Once, Runs::Repeatedly);
    assert!(lines[..8].iter().all(|(_, runs)| *runs == once));
    // The first arm of IF, the loop three times, LBL[2], and once more from LBL[1]: R[1] stays 3.
    assert_eq!(
        lines[8..],
        [
            (39, once),
            (44, again),
            (44, again),
            (44, again),
            (52, again),
            (50, once),
            (52, again)
        ]
    );
    for (index, motion) in program.motions.iter().enumerate() {
        assert_eq!(motion.follows, index.checked_sub(1), "{index}");
    }
}
