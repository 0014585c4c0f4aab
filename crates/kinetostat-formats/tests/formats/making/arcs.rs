//! Arcs, full circles, helices: what they become, and how far that is from them.

use kinetostat_formats::*;
use kinetostat_testing::Worst;
use nalgebra::Vector3;

use super::{ROBOTS, cell, made, read_made};

/// The motions of a program behind the first, which leads to its start.
fn motions(text: &str, into: MakeLanguage, language: Language) -> (Made, Vec<Motion>) {
    let made = made(text, &cell(), into);
    let program = read_made(&made, language);
    (made, program.motions[1..].to_vec())
}

#[test]
fn a_full_circle_is_two_halves() {
    let text = "G21 G90\nG0 X30 Y0 Z0\nG2 X30 Y0 I-10 J0 F600\n";
    for (into, language) in ROBOTS {
        let (made, motions) = motions(text, into, language);
        assert_eq!((motions.len(), made.kept.moves), (2, 2));
        let mut places = Vec::new();
        for motion in &motions {
            let MotionKind::Circular { via } = &motion.kind else {
                panic!("{into:?}: {motion:?}");
            };
            places.push(via.pose().unwrap().position_mm);
            places.push(motion.target.pose().unwrap().position_mm);
        }
        // Clockwise about (20, 0), by quarters.
        let wanted = [[20.0, -10.0], [10.0, 0.0], [20.0, 10.0], [30.0, 0.0]];
        let mut worst = Worst::default();
        for (place, [x, y]) in places.iter().zip(wanted) {
            worst.add((place - Vector3::new(x, y, 0.0)).norm());
        }
        assert!(worst.value() < 1e-6, "{into:?} {worst:?}");
    }
}

#[test]
fn a_helix_is_followed_by_lines_within_the_tolerance() {
    let text = "G21 G90\nG0 X20 Y0 Z0\nG3 X20 Y0 Z-4 I-20 J0 F600\n";
    for (into, language) in ROBOTS {
        let (made, motions) = motions(text, into, language);
        assert!(
            motions
                .iter()
                .all(|motion| motion.kind == MotionKind::Linear)
        );
        let mut before = Vector3::new(20.0, 0.0, 0.0);
        let (mut ends, mut middles) = (Worst::default(), Worst::default());
        for motion in &motions {
            let end = motion.target.pose().unwrap().position_mm;
            // Places of the helix of radius 20 and pitch 4, and how far the chord's middle is inside.
            ends.add(end.xy().norm() - 20.0);
            let angle = end.y.atan2(end.x).rem_euclid(std::f64::consts::TAU);
            let turned = match angle < 1e-6 {
                true => std::f64::consts::TAU,
                false => angle,
            };
            ends.add(end.z + 4.0 * turned / std::f64::consts::TAU);
            middles.add(20.0 - (0.5 * (before + end)).xy().norm());
            before = end;
        }
        assert!(ends.value() < 1e-6, "{ends:?}");
        assert!(
            middles.value() < 1.001e-3 && middles.value() > 0.8e-3,
            "{middles:?}"
        );
        assert!((made.kept.chord_mm - middles.value()).abs() < 1e-5);
        let said = made
            .findings
            .iter()
            .find(|finding| finding.line == Some(3))
            .unwrap();
        assert!(
            said.message
                .contains("circles of robots are flat, and this climbs"),
            "{said:?}"
        );
    }
    // G-code has helices.
    let (_, path) = super::gcode(text);
    let back = make(&path, &[], &Template::default(), MakeLanguage::Gcode).unwrap();
    assert_eq!(back.kept.motions, 3); // two halves
    assert!(back.kept.arc_mm < 1e-5 && back.kept.chord_mm == 0.0);
}

#[test]
fn arcs_in_other_planes_stay_arcs_for_robots() {
    let text = "G21 G90\nG0 X0 Y0 Z0\nG18 G3 X10 Z-10 I0 K-10 F600\nG19 G3 Y10 Z0 J0 K10\n";
    for (into, language) in ROBOTS {
        let (made, motions) = motions(text, into, language);
        assert_eq!(motions.len(), 2);
        assert!(made.kept.arc_mm < 1e-5, "{:?}", made.kept);
        assert!(
            motions
                .iter()
                .all(|motion| matches!(motion.kind, MotionKind::Circular { .. }))
        );
    }
    let (_, path) = super::gcode(text);
    let flat = make(&path, &[], &Template::default(), MakeLanguage::Gcode).unwrap();
    assert!(
        flat.findings
            .iter()
            .any(|f| f.message.contains("it does not lie about the z axis"))
    );
}

#[test]
fn an_arc_that_a_controller_takes_for_none_is_lines() {
    // 0.05 mm from start to end: MoveC refuses it.
    let text = "G21 G90\nG0 X0 Y0 Z0\nG3 X0.05 Y0.05 I0 J0.05 F600\n";
    let (made, motions) = motions(text, MakeLanguage::Rapid, Language::Rapid);
    assert!(
        motions
            .iter()
            .all(|motion| motion.kind == MotionKind::Linear)
    );
    assert!(
        made.findings
            .iter()
            .any(|f| f.message.contains("too small for a circle"))
    );
    let (_, motions) = self::motions(text, MakeLanguage::Krl, Language::Krl);
    assert!(matches!(motions[0].kind, MotionKind::Circular { .. }));
}
