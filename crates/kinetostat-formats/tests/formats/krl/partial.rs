//! Ends that state only some of X, Y, Z, A, B, C: what is missing is that of before, also where that is corrected.

use kinetostat_formats::*;
use nalgebra::{UnitQuaternion, Vector3};
use proptest::prelude::*;

use super::{line_with, main_with, written};
use crate::harness::{Chance, corrections, write_and_read};
use crate::paths::corrected;

/// Rz(A) Ry(B) Rx(C), by hand.
fn abc([a, b, c]: [f64; 3]) -> UnitQuaternion<f64> {
    let about = |axis, degrees: f64| UnitQuaternion::from_axis_angle(&axis, degrees.to_radians());
    about(Vector3::z_axis(), a) * about(Vector3::y_axis(), b) * about(Vector3::x_axis(), c)
}

const START: &str = "$VEL.CP=0.02\nPTP {X 1,Y 2,Z 30,A 0,B 0,C 180}\n";

fn at(motion: usize, place: [f64; 3]) -> Piece {
    Piece::to(motion, Vector3::from(place))
}

#[test]
fn a_corrected_end_states_its_place_and_keeps_the_rest() {
    let program = main_with(
        "",
        &format!("{START}LIN {{ Z 20 }} C_DIS ; in\nLIN {{X 5,Z 20}}\nLIN {{Y 8}}"),
    );
    let text = written(&program, &[at(1, [1.25, 2.0, 20.125])]);
    assert_eq!(
        line_with(&text, "LIN { "),
        "LIN { X 1.250,Y 2,Z 20.125 } C_DIS ; in"
    );
    // What goes on from it keeps Y, which is as it was, and states X and Z itself.
    assert!(text.contains("\nLIN {X 5,Z 20}\nLIN {Y 8}\n"), "{text}");
    // Where Y of before is another, it is stated; the one behind that keeps it.
    let text = written(&program, &[at(1, [1.0, 2.5, 20.0])]);
    assert!(
        text.contains("LIN { X 1,Y 2.500,Z 20 } C_DIS ; in\nLIN {X 5,Y 2,Z 20}\nLIN {Y 8}\n"),
        "{text}"
    );
    // The corrected start of the program.
    let text = written(&program, &[at(0, [1.1, 2.0, 30.1])]);
    assert!(
        text.contains("LIN { X 1,Z 20 } C_DIS ; in\nLIN {X 5,Z 20}\n"),
        "{text}"
    );
}

#[test]
fn angles_are_stated_where_they_no_longer_are_those_of_before() {
    let program = main_with(
        "",
        &format!("{START}LIN {{Z 20,A 10}}\nLIN {{X 5}}\nLIN {{Y 5}}"),
    );
    let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), 0.5_f64.to_radians());
    let mut piece = at(1, [1.0, 2.0, 20.0]);
    piece.orientation = Some(turn * abc([10.0, 0.0, 180.0]));
    let text = written(&program, &[piece]);
    assert!(
        text.contains(
            "LIN {X 1,Y 2,Z 20,A 10.50000,B 0,C 180}\nLIN {X 5,A 10,B 0,C 180}\nLIN {Y 5}\n"
        ),
        "{text}"
    );
    // Its place alone: all its angles or none.
    let text = written(
        &program,
        &[at(1, [1.0, 2.0, 20.5]), at(2, [5.0, 2.0, 20.5])],
    );
    assert!(
        text.contains(
            "LIN {X 1,Y 2,Z 20.500,A 10,B 0,C 180}\nLIN {X 5,Y 2,Z 20.500}\nLIN {Y 5,Z 20}\n"
        ),
        "{text}"
    );
}

#[test]
fn what_is_declared_is_stated_in_the_motion() {
    let data = "DECL POS up={Z 50}\nDECL FRAME side={E6POS: X 4,Y 5,Z 6}";
    let program = main_with(
        data,
        &format!("{START}LIN up\nLIN {{X 9}}\nLIN up C_DIS\nLIN side"),
    );
    let text = written(&program, &[at(3, [9.0, 2.0, 50.5])]);
    assert!(
        text.contains("LIN up\nLIN {X 9}\nLIN {X 9,Y 2,Z 50.500} C_DIS\nLIN side\n"),
        "{text}"
    );
    assert!(text.contains(data));
    let mut piece = at(3, [9.0, 2.0, 50.0]);
    piece.orientation = Some(abc([1.0, 0.0, 180.0]));
    let text = written(&program, &[piece]);
    assert!(
        text.contains(
            "LIN {X 9,Y 2,Z 50,A 1.00000,B 0,C 180} C_DIS\nLIN {E6POS: X 4,Y 5,Z 6,A 0,B 0,C 180}\n"
        ),
        "{text}"
    );
}

#[test]
fn circles_through_places_that_are_left_open() {
    let program = main_with(
        "",
        &format!("{START}CIRC {{X 11,Y 12}},{{X 21}}\nLIN {{X 0}}"),
    );
    let mut piece = at(1, [21.0, 2.5, 30.5]);
    piece.via_mm = Some(Vector3::new(11.0, 12.5, 30.25));
    let text = written(&program, &[piece]);
    assert!(
        text.contains(
            "CIRC {X 11,Y 12.500,Z 30.250},{X 21,Y 2.500,Z 30.500}\nLIN {X 0,Y 2,Z 30}\n"
        ),
        "{text}"
    );
    // A start that moves takes neither with it.
    let text = written(&program, &[at(0, [1.0, 2.5, 31.0])]);
    assert!(
        text.contains("CIRC {X 11,Y 12,Z 30},{X 21,Y 2,Z 30}\nLIN {X 0}\n"),
        "{text}"
    );
}

/// The two triples of angles of one orientation differ where only some are kept.
#[test]
fn angles_that_are_kept_are_those_that_were_written() {
    let end = |statements: &str| {
        let text = format!("DEF part()\n{statements}\nEND\n");
        let files = vec![SourceFile::new("part.src", text)];
        read_krl(files, &ReadOptions::default())
    };
    for (before, stated, wanted) in [
        ([100.0, 0.0, 180.0], "A 110", [110.0, 0.0, 180.0]),
        ([-180.0, 20.0, 180.0], "A 10", [10.0, 20.0, 180.0]),
        ([-170.0, -35.0, 175.0], "B 12,C -20", [-170.0, 12.0, -20.0]),
        ([10.0, 89.0, -120.0], "C 30", [10.0, 89.0, 30.0]),
    ] {
        let [a, b, c] = before;
        let program = end(&format!(
            "LIN {{X 0,Y 0,Z 0,A {a},B {b},C {c}}}\nLIN_REL {{X 3}}\nLIN {{X 5,{stated}}}"
        ))
        .unwrap_or_else(|errors| panic!("{errors:#?}"));
        let found = program.motions[2].target.pose().unwrap().orientation;
        assert!(found.angle_to(&abc(wanted)) < 1e-9, "{before:?} {stated}");
    }
    // With B beyond 90 degrees a controller may say the same orientation otherwise.
    for b in ["90", "-90", "135"] {
        let found = end(&format!(
            "LIN {{X 0,Y 0,Z 0,A 5,B {b},C 7}}\nLIN {{X 3}}\nLIN {{X 5,A 10}}"
        ));
        let errors = found.expect_err("it is refused");
        assert_eq!((errors.len(), errors[0].line), (1, 4));
        assert!(
            errors[0].reason.contains("a B of 90 degrees or beyond"),
            "{}",
            errors[0]
        );
        // Where all or none of the angles are stated that says nothing.
        end(&format!("LIN {{X 0,Y 0,Z 0,A 5,B {b},C 7}}\nLIN {{X 3}}\nLIN {{X 5,A 10,B 0,C 3}}\nLIN {{X 8,A 10}}")).unwrap();
    }
}

/// A pose in braces of which some members are missing; at least one is there.
fn some(chance: &mut Chance) -> String {
    let sizes = [
        ("X", 300.0),
        ("Y", 300.0),
        ("Z", 90.0),
        ("A", 180.0),
        ("B", 80.0),
        ("C", 180.0),
    ];
    loop {
        let kept: Vec<String> = (sizes.iter())
            .filter_map(|(name, size)| {
                let value = chance.within(*size);
                (chance.below(2) == 0).then(|| format!("{name} {value:.2}"))
            })
            .collect();
        if !kept.is_empty() {
            return format!("{{{}}}", kept.join(chance.of(&[",", ", "])));
        }
    }
}

/// A program of straight motions and so many sorts of circular ones, most of which leave something open.
fn chain(chance: &mut Chance, circular: usize) -> String {
    let mut text =
        "DEF part()\n$VEL.CP=0.02\nPTP {X 10,Y 20,Z 30,A 100.5,B -20,C 170}\n".to_owned();
    for _ in 0..2 + chance.below(8) {
        text += &match chance.below(5 + circular) {
            5 => format!("CIRC {},{} C_DIS\n", some(chance), some(chance)),
            1 => format!("SLIN {}\n", some(chance)),
            2 => format!("LIN_REL {{X {:.1}}}\n", chance.within(30.0)),
            3 => "LIN XP1 ; declared\n".to_owned(),
            4 => "IF $IN[1] THEN\n$OUT[2]=TRUE\nENDIF\n".to_owned(),
            0 => format!("LIN {{A {:.1}}}\nLIN {{X 5}}\n", chance.within(170.0)),
            _ => format!("LIN {} ; groove\n", some(chance)),
        };
    }
    text + "LIN {Z 90}\nEND\n"
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn corrected_ends_are_where_they_are_to_be_and_all_others_where_they_were(seed in any::<u64>()) {
        let mut chance = Chance::new(seed);
        let data = format!("DEFDAT part\nDECL POS XP1={}\nENDDAT\n", some(&mut chance));
        let files = [chain(&mut chance, 1), data].map(String::into_bytes);
        let kind = super::random::kind();
        let program = crate::harness::read_files(&kind, &files).map_err(|errors| TestCaseError::fail(errors[0].to_string()))?;
        prop_assert!(program.motions.iter().all(|motion| motion.target.pose().is_some()));
        let pieces = corrections(&mut chance, &program, &kind);
        write_and_read(&program, &pieces, &kind).map_err(TestCaseError::fail)?;
        crate::harness::divide_and_read(&mut chance, &program, &kind).map_err(TestCaseError::fail)?;
    }

    #[test]
    fn programs_of_such_ends_are_corrected_along_their_paths(seed in any::<u64>()) {
        let mut chance = Chance::new(seed);
        let text = chain(&mut chance, 0).replace("XP1", "{X 100,Z 55}");
        let found = corrected(Language::Krl, "part.src", text.as_bytes(), &ReadOptions::default());
        prop_assert!(found.is_ok(), "{found:?}\n{text}");
    }
}

/// A routine whose end keeps X and Y of before, called twice, states them once; a value that rests on itself ends in words.
#[test]
fn an_end_that_keeps_numbers_of_before_states_them_once() {
    let cut = "LIN {X 10,Y 20,Z 5,A 0,B 0,C 180}\nLIN {Z 1}\n";
    let text = format!("DEF part()\nINT i\nFOR i=1 TO 2\n{cut}ENDFOR\nEND\n");
    let program = super::read_both(&text, "DEFDAT part\nENDDAT\n");
    assert_eq!(program.motions.len(), 4);
    let to = |motion: usize, z: f64| Piece::to(motion, nalgebra::Vector3::new(10.25, 20.0, z));
    let pieces = [to(0, 5.0), to(1, 1.0), to(2, 5.0), to(3, 1.0)];
    let written = super::written(&program, &pieces);
    assert!(written.contains("LIN {X 10.250,Y 20,Z 1}"), "{written}");

    let itself = "DECL FRAME way[2]\nway[1]={X 1,Y 2,Z way[2]}\nway[2]={X way[1],Y 2,Z way[1]}\n";
    let files = vec![
        SourceFile::new("part.src", "DEF part()\nLIN way[1]\nEND\n"),
        SourceFile::new("part.dat", format!("DEFDAT part\n{itself}ENDDAT\n")),
    ];
    let errors = read_krl(files, &ReadOptions::default()).unwrap_err();
    assert_eq!(errors[0].line, 2, "{errors:?}");
}
