//! Holes of cycles written as plain motions.

use kinetostat_formats::*;
use nalgebra::Vector3;

use super::{OTHER, SOLIDWORKS};

fn flat(text: &str) -> String {
    let found =
        expand_apt(&[SourceFile::new("a.apt", text)]).unwrap_or_else(|all| panic!("{all:?}"));
    let text = String::from_utf8(found.file.bytes().to_vec()).unwrap();
    assert_eq!(text.lines().count(), found.origins.len());
    text
}

/// Places of motions with their speeds in mm/s, none of rapids.
type Places = Vec<([f64; 3], Option<f64>)>;

fn motions(text: &str) -> Places {
    let files = vec![SourceFile::new("a.apt", flat(text))];
    let program = read_apt(files, &ReadOptions::default()).unwrap();
    let motions = program.motions.iter();
    motions
        .map(|one| {
            (
                one.target.pose().unwrap().position_mm.into(),
                one.speed.mm_per_s,
            )
        })
        .collect()
}

fn holes(cycle: &str) -> Places {
    motions(&format!(
        "UNITS/MM\nSPINDL/500,RPM,CLW\nFEDRAT/600,MMPM\nGOTO/0,0,20\n{cycle}\nGOTO/10,0,0\nGOTO/20,5,-1\nCYCLE/OFF\nGOTO/30,0,20\n"
    ))
}

fn assert_same(found: &[([f64; 3], Option<f64>)], expected: &[([f64; 3], Option<f64>)], of: &str) {
    assert_eq!(found.len(), expected.len(), "{of}: {found:?}");
    for ((place, speed), (wanted, feed)) in found.iter().zip(expected) {
        let off = (Vector3::from(*place) - Vector3::from(*wanted)).norm();
        let same = match (speed, feed) {
            (Some(a), Some(b)) => (a - b).abs() < 1e-12,
            (a, b) => a.is_none() && b.is_none(),
        };
        assert!(off < 1e-9 && same, "{of}: {found:?}");
    }
}

#[test]
fn each_place_becomes_a_hole() {
    let drilled = [
        ([0.0, 0.0, 20.0], Some(10.0)),
        ([10.0, 0.0, 20.0], None),
        ([10.0, 0.0, 3.0], None),
        ([10.0, 0.0, -10.0], Some(2.5)),
        ([10.0, 0.0, 3.0], None),
        // Across at the height where it is, and down along the axis.
        ([20.0, 5.0, 3.0], None),
        ([20.0, 5.0, 2.0], None),
        ([20.0, 5.0, -11.0], Some(2.5)),
        ([20.0, 5.0, 2.0], None),
        ([30.0, 0.0, 20.0], Some(10.0)),
    ];
    for cycle in [
        "CYCLE/DRILL,DEPTH,10,MMPM,150,CLEAR,3",
        "CYCLE / DRILL, 10.0, 150.0, MMPM, 3.0",
        "CYCLE/FACE,10,MMPM,150,3",
        "CYCLE/DRILL,RAPTO,3.0000,FEDTO,-10.0000,MMPM,150.0000",
        "CYCLE/DRILL,RAPTO,3,FEDTO,-10,$\n MMPM,150",
        "CYCLE/DRILL,FEDTO,10,MMPM,150,CLEAR,3,RTRCTO,1",
    ] {
        assert_same(&holes(cycle), &drilled, cycle);
    }
    // At feed by turns, out to a height, and at feed out of a bore.
    let bored = [
        ([0.0, 0.0, 20.0], Some(10.0)),
        ([10.0, 0.0, 20.0], None),
        ([10.0, 0.0, 3.0], None),
        ([10.0, 0.0, -10.0], Some(0.1 * 500.0 / 60.0)),
        ([10.0, 0.0, 3.0], Some(0.1 * 500.0 / 60.0)),
        ([10.0, 0.0, 8.0], None),
        ([20.0, 5.0, 8.0], None),
        ([20.0, 5.0, 2.0], None),
        ([20.0, 5.0, -11.0], Some(0.1 * 500.0 / 60.0)),
        ([20.0, 5.0, 2.0], Some(0.1 * 500.0 / 60.0)),
        ([20.0, 5.0, 7.0], None),
        ([30.0, 0.0, 20.0], Some(10.0)),
    ];
    for cycle in [
        "CYCLE/BORE,DEPTH,10,MMPR,0.1,CLEAR,3,RETURN,8",
        "CYCLE/REAM,RAPTO,3,FEDTO,-10,RTRCTO,8,MMPR,0.1",
        "CYCLE/TAP,DEPTH,10,MMPR,0.1,CLEAR,3,RTRCTO,8",
    ] {
        assert_same(&holes(cycle), &bored, cycle);
    }
}

#[test]
fn steps_are_drilled_and_a_tap_turns_back() {
    let found = holes("CYCLE/DEEP,10,STEP,4,MMPM,150,3");
    let heights: Vec<f64> = found[1..10].iter().map(|(place, _)| place[2]).collect();
    let expected = [20.0, 3.0, -4.0, 3.0, -3.0, -8.0, 3.0, -7.0, -10.0];
    assert!(
        heights
            .iter()
            .zip(expected)
            .all(|(a, b)| (a - b).abs() < 1e-9),
        "{heights:?}"
    );
    // The first step of DEEP2 is one of its own, and may be deeper than the hole.
    for (first, expected) in [
        (
            5,
            &[20.0, 3.0, -5.0, 3.0, -4.0, -9.0, 3.0, -8.0, -10.0, 3.0][..],
        ),
        (12, &[20.0, 3.0, -10.0, 3.0]),
    ] {
        let found = holes(&format!(
            "CYCLE/DEEP2,FEDTO,10,1STPECK,{first},SUBPECK,4,MMPM,150,RAPTO,3,RTRCTO,3"
        ));
        let heights = found[1..].iter().map(|(place, _)| place[2]);
        let near = |(a, b): (f64, &f64)| (a - b).abs() < 1e-9;
        assert!(heights.zip(expected).all(near), "{first}: {found:?}");
    }
    let found = holes("CYCLE/DRILL,BRKCHP,FEDTO,-10,INCR,5,MMPM,150,RAPTO,3");
    let heights: Vec<f64> = found[1..7].iter().map(|(place, _)| place[2]).collect();
    let expected = [20.0, 3.0, -5.0, -4.0, -10.0, 3.0];
    assert!(
        heights
            .iter()
            .zip(expected)
            .all(|(a, b)| (a - b).abs() < 1e-9),
        "{heights:?}"
    );
    let text = flat(
        "SPINDL/300,RPM,CLW\nGOTO/0,0,9\nCYCLE/TAP,DEPTH,5,MMPR,1.25,CLEAR,2,DWELL,0.5\nGOTO/1,2,0\nCYCLE/OFF\n",
    );
    let expected = "FEDRAT/1.25,MMPR\nGOTO/1.0,2.0,-5.0\nDELAY/0.5\nSPINDL/300,RPM,CCLW\nGOTO/1.0,2.0,2.0\nSPINDL/300,RPM,CLW\n";
    assert!(text.ends_with(expected), "{text}");
}

#[test]
fn holes_lie_along_the_axis_of_the_tool() {
    let text = "UNITS/INCH\nMULTAX\nRAPID\nGOTO/0,0,10,0.6,0,0.8\nCYCLE/DRILL,RAPTO,1,FEDTO,-2,RTRCTO,AUTO,IPM,5\nGOTO/1,2,3\nCYCLE/OFF\nRAPID\nGOTO/0,0,10\n";
    let found = motions(text);
    let axis = Vector3::new(0.6, 0.0, 0.8);
    let hole = Vector3::new(1.0, 2.0, 3.0);
    let height = (Vector3::new(0.0, 0.0, 10.0) - hole).dot(&axis);
    for (index, along) in [(1, height), (2, 1.0), (3, -2.0), (4, height)] {
        let expected: Vector3<f64> = (hole + axis * along) * 25.4;
        let off = (Vector3::from(found[index].0) - expected).norm();
        assert!(off < 1e-5, "{index}: {found:?}");
    }
    assert!((found[3].1.unwrap() - 5.0 * 25.4 / 60.0).abs() < 1e-12);
    assert!(found[4].1.is_none() && found[5].1.is_none());
}

#[test]
fn files_without_holes_come_back_byte_for_byte() {
    let texts = [
        SOLIDWORKS,
        OTHER,
        "",
        "GOTO/1,2,3",
        "CYCLE/DRILL,DEPTH,5,CLEAR,1\nCYCLE/OFF\n",
    ];
    for text in texts {
        let found = expand_apt(&[SourceFile::new("a.apt", text)]).unwrap();
        assert!(
            !found.changed && found.file.bytes() == text.as_bytes(),
            "{text}"
        );
    }
    // Beside holes, everything stays.
    let text = "PARTNO/A\n$$ note\n\nGOTO/0,0,5\r\nCYCLE/DRILL,DEPTH,5,CLEAR,1\nCOOLNT/ON\nGOTO/1,1,0\nRAPID\nCYCLE/OFF\nGOTO/0,0,5\nFINI";
    let flat = flat(text);
    assert!(
        flat.starts_with("PARTNO/A\n$$ note\n\nGOTO/0,0,5\r\nCOOLNT/ON\nRAPID"),
        "{flat:?}"
    );
    assert!(
        flat.contains("\nRAPID") && flat.ends_with("\nGOTO/0,0,5\nFINI"),
        "{flat:?}"
    );
    assert!(
        flat.replace('\r', "").contains("RAPID\nGOTO/0,0,5\nFINI"),
        "{flat:?}"
    );
}

#[test]
fn cycles_that_are_not_followed_are_refused_by_line() {
    for (cycle, part) in [
        ("CYCLE/DRILL,CLEAR,3", "its depth is not stated"),
        (
            "CYCLE/DRILL,DEPTH,10",
            "where the rapid to the hole ends, is not stated",
        ),
        (
            "CYCLE/DRILL,DEPTH,10,FEDTO,-5,CLEAR,3",
            "DEPTH and FEDTO both state",
        ),
        ("CYCLE/DEEP,DEPTH,10,CLEAR,3", "by which steps it drills"),
        (
            "CYCLE/DEEP2,DEPTH,10,1STPECK,0,SUBPECK,2,CLEAR,3",
            "by which steps it drills",
        ),
        (
            "CYCLE/BORE,BACK,DEPTH,10,CLEAR,3",
            "what BACK says of the cycle is not followed",
        ),
        ("CYCLE/MILL,DEPTH,10,CLEAR,3", "what MILL says of the cycle"),
        ("CYCLE/DRILL,DEPTH,CLEAR,3", "no number stands behind DEPTH"),
        (
            "CYCLE/TAP,DEPTH,10,CLEAR,3",
            "how the spindle turns is not stated",
        ),
        (
            "CYCLE/DEEP,DEPTH,10,STEP,0.0001,CLEAR,3",
            "more than 10 000 steps",
        ),
        (
            "CYCLE/DRILL,DEPTH,10,1,2,3,4",
            "more numbers than depth, feed and clearance",
        ),
    ] {
        let text = format!("GOTO/0,0,9\n{cycle}\nGOTO/1,2,0\nCYCLE/OFF\n");
        let files = vec![SourceFile::new("a.apt", text)];
        let found = expand(Language::Apt, files, &ReadOptions::default()).unwrap_err();
        assert_eq!(found.len(), 1, "{cycle}: {found:?}");
        assert!(found[0].to_string().contains(part), "{cycle}: {}", found[0]);
    }
    // As it stands, the reader says what to do.
    let text = "GOTO/0,0,9\nCYCLE/DRILL,DEPTH,5,CLEAR,1\nGOTO/1,2,0\n";
    let found = read_apt(
        vec![SourceFile::new("a.apt", text)],
        &ReadOptions::default(),
    );
    assert!(found.unwrap_err()[0].to_string().contains("(--expand)"));
}
