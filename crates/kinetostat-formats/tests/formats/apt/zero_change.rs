//! The four kinds of files are read, and without pieces every byte comes back.

use kinetostat_formats::*;
use nalgebra::{Isometry3, Vector3};

use super::{CATIA, NX, OTHER, SOLIDWORKS, place, program, read_with};

#[test]
fn every_byte_comes_back_with_any_line_ending() {
    for text in [SOLIDWORKS, NX, CATIA, OTHER] {
        for bytes in [
            text.as_bytes().to_vec(),
            text.replace('\n', "\r\n").into_bytes(),
            text.trim_end().as_bytes().to_vec(),
            [text.as_bytes(), b"\n$$ \xff\xfe\n\n"].concat(),
        ] {
            let program = read_with(&bytes, &ReadOptions::default()).unwrap();
            let files = write(&program, &[], &WriteOptions::default()).unwrap();
            assert_eq!(files, [("part.apt".to_owned(), bytes)]);
        }
    }
}

#[test]
fn each_kind_is_recognised() {
    let first = |text: &str| program(text).findings[0].message.clone();
    assert_eq!(first(SOLIDWORKS), "written by SOLIDWORKS CAM");
    assert_eq!(
        first(NX),
        "written by Siemens NX; no unit is stated: taken as mm"
    );
    assert_eq!(
        first(CATIA),
        "written by CATIA; no unit is stated: taken as mm"
    );
    assert_eq!(
        first(OTHER),
        "written by no system that is known by its words"
    );
}

#[test]
fn texts_and_comments_are_never_words() {
    let text =
        "PARTNO GOTO/1,2,3 $\nPPRINT GOTO/4,5,6 $$\n$$ GOTO/7,8,9\nGOTO/1,2,$\n 3 $$ GOTO/9,9,9\n";
    let program = program(text);
    assert_eq!(program.motions.len(), 1);
    assert_eq!(place(&program, 0), [1.0, 2.0, 3.0]);
    assert_eq!(program.motions[0].line, 4);
}

#[test]
fn axes_and_feeds_hold_on_and_rapid_does_not() {
    let program = program(SOLIDWORKS);
    let speeds: Vec<(Option<f64>, &str)> = (program.motions[..4].iter())
        .map(|motion| {
            (
                motion
                    .speed
                    .mm_per_s
                    .map(|speed| (speed * 60.0 * 1e6).round() / 1e6),
                motion.speed.text.as_str(),
            )
        })
        .collect();
    assert_eq!(
        speeds,
        [
            (None, "RAPID/"),
            (Some(125.0), "FEDRAT/125.,MMPM"),
            (Some(444.49999), "FEDRAT/444.49999,MMPM"),
            (Some(444.49999), "FEDRAT/444.49999,MMPM"),
        ]
    );
    let last = program.motions.last().unwrap().target.pose().unwrap();
    assert_eq!(last.position_mm.as_slice(), [1.0, 0.25, 0.0]);
    let axis = last.orientation * Vector3::z();
    assert!((axis - Vector3::new(0.6, 0.0, 0.8)).norm() < 1e-12);
    // NX states the unit first; CATIA's feed of 0.1 mm a turn is a speed at 70 turns a minute.
    let of_nx = super::program(NX);
    assert_eq!(of_nx.motions[1].speed.mm_per_s, Some(10.35));
    let of_catia = super::program(CATIA);
    let speed = of_catia.motions[2].speed.mm_per_s.unwrap();
    assert!((speed - 7.0 / 60.0).abs() < 1e-12, "{speed}");
    assert_eq!(place(&of_catia, 2), [-0.4, 0.0, -19.0]);
}

#[test]
fn steps_and_home_are_places() {
    let program = program(NX);
    let count = program.motions.len();
    assert_eq!(place(&program, count - 2), [20.0, 0.0, 565.5]);
    assert_eq!(place(&program, count - 1), [650.0, -393.0, 964.0]);
    assert_eq!(program.motions[count - 1].follows, Some(count - 2));
    assert_eq!(program.motions[0].follows, None);
}

#[test]
fn inches_are_mm() {
    let program = program(OTHER);
    assert_eq!(place(&program, 1), [254.0, 254.0, 0.0]);
    // 20 inches a minute.
    assert!((program.motions[1].speed.mm_per_s.unwrap() - 8.466_666_666_666_667).abs() < 1e-12);
}

#[test]
fn places_of_nx_are_in_msys_in_the_part() {
    let mut options = ReadOptions::default();
    assert_eq!(program(NX).motions[0].base_pose(), None);
    options
        .frames
        .insert("part".into(), Isometry3::translation(1000.0, 0.0, 0.0));
    let program = read_with(NX.as_bytes(), &options).unwrap();
    let base = program.motions[0].base_pose().unwrap().translation.vector;
    // X of MSYS is the part's Y, Y its -X: (20, 0, 469) from (393, -297.5, 3).
    let expected = Vector3::new(1000.0 + 393.0, -297.5 + 20.0, 472.0);
    assert!((base - expected).norm() < 1e-9, "{base}");
}
