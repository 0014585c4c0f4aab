//! Paths that cannot be followed: where they end, why, and what helps.

use kinetostat_machining::{NoWay, TurnBand, TurnBarrier, TurnError, TurnTask, choose_turns};
use nalgebra::vector;

use super::{across_a_straight_wrist, downwards, milling_arm, path_of};

fn refused(task: &TurnTask<'_>) -> NoWay {
    match choose_turns(task) {
        Err(TurnError::NoWay(found)) => *found,
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_place_out_of_reach_is_named_with_its_line() {
    let mechanism = milling_arm("heavy_6r");
    let path = path_of("G21 G90\nG0 X0 Y0 Z0\nG1 X200 F600\nG1 X300\nG1 X2500\nG1 X100\n");
    let mut task = TurnTask::new(&mechanism, &path, downwards(vector![1.3, 0.0, 0.8], 0.0));
    task.station_mm = 20.0;
    task.band.step_deg = 15.0;
    let found = refused(&task);
    assert_eq!(found.line, 5, "{found:?}");
    let barriers: Vec<&TurnBarrier> = found.barriers.iter().map(|b| &b.0).collect();
    assert!(barriers.contains(&&TurnBarrier::OutOfReach), "{barriers:?}");
    let shares: f64 = found.barriers.iter().map(|b| b.1).sum();
    assert!((shares - 1.0).abs() < 1e-9);
    // Nowhere can the arm go from there: no division helps.
    assert!(found.parts.is_empty() && found.wider_band_deg.is_none());
    let words = found.to_string();
    assert!(
        words.starts_with("line 5: at X") && words.contains("move the part"),
        "{words}"
    );
    assert!(found.way_mm > 300.0 && found.position_mm[0] > 300.0);
}

/// A band that is too narrow to go around the straight wrist; the whole circle is not.
#[test]
fn a_narrow_band_ends_at_the_singular_posture_and_a_wider_one_helps() {
    let (mechanism, path, placement) = across_a_straight_wrist();
    let mut task = TurnTask::new(&mechanism, &path, placement);
    task.band = TurnBand {
        from_deg: -1.0,
        to_deg: 1.0,
        step_deg: 0.5,
    };
    task.bounds.least_singular_value = 0.01;
    let found = refused(&task);
    assert_eq!(found.line, 4, "{found:?}");
    assert!(found.position_mm[1].abs() < 200.0, "{found:?}");
    assert_eq!(found.barriers[0].0, TurnBarrier::Singular, "{found:?}");
    let [from, to] = found.wider_band_deg.expect("a wider band");
    let words = found.to_string();
    assert!(
        words.contains("widen the band") && words.contains("singular"),
        "{words}"
    );
    // Each turn that stays the same is shown with what it covers.
    assert_eq!(found.constant.len(), 5);
    let longest = found.constant[0];
    assert!(
        longest.to_mm - longest.from_mm > 100.0 && longest.to_mm - longest.from_mm < 999.0,
        "{longest:?}"
    );
    // And it does help.
    task.band = TurnBand {
        from_deg: from.floor(),
        to_deg: to.ceil(),
        step_deg: 1.0,
    };
    choose_turns(&task).expect("a way in the band that was named");
}

/// A limit: the arm cannot turn joint 1 so far.
#[test]
fn a_limit_is_named_with_its_joint() {
    let mechanism = milling_arm("heavy_6r");
    // Around the base, farther than joint 1 goes, and no joint but it can help.
    let path = path_of(
        "G21 G90 G17\nG0 X1500 Y0 Z0\nG3 X0 Y1500 I-1500 J0 F900\nG3 X-1500 Y0 I0 J-1500\nG3 X0 Y-1500 I1500 J0\n",
    );
    let mut task = TurnTask::new(&mechanism, &path, downwards(vector![0.0, 0.0, 0.8], 0.0));
    task.station_mm = 40.0;
    task.band.step_deg = 20.0;
    task.bounds.configuration = Some(0);
    let found = refused(&task);
    assert_eq!(found.line, 5, "{found:?}");
    let limits = found
        .barriers
        .iter()
        .filter_map(|(barrier, _)| match barrier {
            TurnBarrier::Limit { joint } => Some(joint.as_str()),
            _ => None,
        });
    assert!(limits.clone().any(|joint| joint == "joint 1"), "{found}");
    // Divided, it goes.
    assert!(found.parts.len() >= 2, "{found:?}");
    assert!(
        found
            .parts
            .windows(2)
            .all(|pair| pair[0].to_mm == pair[1].from_mm)
    );
    assert!(found.to_string().contains("Divided before line"), "{found}");
}

/// In a configuration that cannot reach the place the others are offered.
#[test]
fn another_configuration_is_offered() {
    let (mechanism, path, placement) = across_a_straight_wrist();
    let mut task = TurnTask::new(&mechanism, &path, placement);
    task.bounds.configuration = Some(1);
    task.station_mm = 10.0;
    task.band.step_deg = 10.0;
    let found = refused(&task);
    let other = found.other_configuration.expect("another one");
    assert_ne!(other, 1);
    assert!(
        found
            .to_string()
            .contains(&format!("With configuration {other}")),
        "{found}"
    );
}
