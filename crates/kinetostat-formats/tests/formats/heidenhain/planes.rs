//! Arcs and polar places in every working plane: by the tool's axis, and by the two axes of CC.

use nalgebra::{Rotation3, Unit, Vector3};

use super::*;

/// Where the arcs of a program end, by their centre, axis and angle, beside where their blocks say so; how far they are from each other, mm.
fn ends_of_arcs(program: &RobotProgram) -> Vec<(f64, [f64; 3])> {
    let mut at = Vector3::zeros();
    let mut found = Vec::new();
    for (index, motion) in program.motions.iter().enumerate() {
        // Where the tool is, is not known before its height is stated.
        if motion.target.pose().is_none() {
            continue;
        }
        let end = Vector3::from(place(program, index));
        if let MotionKind::Arc {
            centre_mm,
            axis,
            angle_rad,
        } = &motion.kind
        {
            let turned = Rotation3::from_axis_angle(&Unit::new_normalize(*axis), *angle_rad);
            let by_angle = centre_mm + turned * (at - centre_mm);
            let rise = axis * (end - by_angle).dot(axis);
            found.push(((by_angle + rise - end).norm(), end.into()));
        }
        at = end;
    }
    found
}

fn near(found: [f64; 3], wanted: [f64; 3]) -> bool {
    (0..3).all(|axis| (found[axis] - wanted[axis]).abs() < 1e-9)
}

/// A quarter of a circle in each plane, by `C` and by `CP IPA`, with `CC` of two axes.
#[test]
fn two_axes_of_cc_say_the_plane() {
    for (first, second, third, axis) in [("X", "Y", "Z", 2), ("Y", "Z", "X", 0), ("Z", "X", "Y", 1)]
    {
        for tool in ["X", "Y", "Z"] {
            for end in [
                format!("C {second}+20 {first}+10 DR+"),
                "CP IPA+90 DR+".to_owned(),
                "CP PA+90 DR+".to_owned(),
            ] {
                let text = format!(
                    "0 BEGIN PGM A MM\n1 TOOL CALL 1 {tool} S100\n2 L {first}+20 {second}+10 {third}+5 R0 FMAX M3\n\
                    12 CC {first}+10 {second}+10\n13 {end} F200\nLP PR+5 PA+180\n20 END PGM A MM\n"
                );
                let program = program(&text);
                let [(off, place)] = ends_of_arcs(&program)[..] else {
                    panic!("{text}");
                };
                let across = |first: f64, second: f64| {
                    let mut place = [5.0; 3];
                    (place[(axis + 1) % 3], place[(axis + 2) % 3]) = (first, second);
                    place
                };
                assert!(
                    off < 1e-9 && near(place, across(10.0, 20.0)),
                    "{text}: {off}, {place:?}"
                );
                // A polar place counts from the first axis of the plane.
                assert!(near(super::place(&program, 2), across(5.0, 10.0)), "{text}");
                let MotionKind::Arc {
                    axis: normal,
                    angle_rad,
                    ..
                } = &program.motions[1].kind
                else {
                    panic!("{text}");
                };
                assert!((normal[axis] - 1.0).abs() < 1e-12, "{text}");
                assert!(
                    (angle_rad.to_degrees() - 90.0).abs() < 1e-9,
                    "{text}: {angle_rad}"
                );
            }
        }
    }
}

#[test]
fn arcs_of_a_lead_in_beside_the_working_plane() {
    let text = "0 BEGIN PGM T MM\n1 BLK FORM 0.1 Z X+0 Y+0 Z-20\n3 TOOL CALL 1 Z S2000 F300\n4 L X+0 Y+0 R0 FMAX M3\n\
        5 L Z+20 R0 FMAX\n6 L Y+10 Z-2 F300\n7 CC Y+10 Z+3\n8 CP IPA+90 DR+\n9 L X+50\n10 CC X+50 Z+8\n11 C X+55 Z+8 DR-\n12 END PGM T MM\n";
    let program = program(text);
    let found = ends_of_arcs(&program);
    assert!(near(found[0].1, [0.0, 15.0, 3.0]), "{found:?}");
    assert!(near(found[1].1, [55.0, 15.0, 8.0]), "{found:?}");
    assert!(found.iter().all(|(off, _)| *off < 1e-9), "{found:?}");
}

#[test]
fn the_tools_axis_says_the_plane_of_arcs_without_a_pole_and_how_the_tool_stands() {
    for (tool, words, radius) in [
        ("X", "Y+20 Z+0", ["Y+10 Z+10", "Y+0 Z+20"]),
        ("Y", "Z+20 X+0", ["Z+10 X+10", "Z+0 X+20"]),
    ] {
        let text = format!(
            "BEGIN PGM A MM\nTOOL CALL 1 {tool} S100\nL X+0 Y+0 Z+0 R0 FMAX M3\nL {words} F200\nCR {} R+10 DR+\nCT {}\nEND PGM A MM\n",
            radius[0], radius[1]
        );
        let program = program(&text);
        let found = ends_of_arcs(&program);
        assert_eq!(found.len(), 2, "{text}");
        assert!(
            found.iter().all(|(off, _)| *off < 1e-9),
            "{text}: {found:?}"
        );
        let stands = program.motions[1].target.pose().unwrap().orientation * Vector3::z();
        let along = ["X", "Y"].iter().position(|axis| *axis == tool).unwrap();
        assert!((stands[along] - 1.0).abs() < 1e-12, "{text}: {stands}");
    }
}

#[test]
fn poles_take_one_word_steps_or_none() {
    let end = |blocks: &str| {
        let text = format!(
            "BEGIN PGM A MM\nTOOL CALL 1 Z S100\nL X+20 Y+0 Z+0 R0 FMAX M3\n{blocks}\nEND PGM A MM\n"
        );
        let program = program(&text);
        place(&program, program.motions.len() - 1)
    };
    // The word that is missing is that of before; a step is from where the tool is; alone it is where the tool is.
    assert!(near(
        end("CC X+0 Y+5\nCC Y+0\nCP IPA+90 DR+ F100"),
        [0.0, 20.0, 0.0]
    ));
    assert!(near(
        end("CC IX-10 IY+0\nCP IPA+180 DR- F100"
            .replace("IPA+180", "IPA-180")
            .as_str()),
        [0.0, 0.0, 0.0]
    ));
    assert!(near(end("CC\nLP PR+5 PA+90 F100"), [20.0, 5.0, 0.0]));
    let fault = |blocks: &str| {
        let text = format!("BEGIN PGM A MM\nL X+20 Y+0 Z+0 R0 FMAX\n{blocks}\nEND PGM A MM\n");
        read_with(text.as_bytes(), &ReadOptions::default()).unwrap_err()[0].to_string()
    };
    for (blocks, part) in [
        ("CC X+0 Y+0 Z+0", "line 3"),
        (
            "CC Z+0",
            "the pole is stated by other axes than two of a plane",
        ),
        ("CC X+0 X+1", "the pole is not stated by two of X, Y and Z"),
        // X of before is of another plane.
        (
            "CC Z+0 X+0\nCC X+10\nC X+0 Y+0 DR+",
            "line 5: `C X+0 Y+0 DR+`: the centre of the circle is not known",
        ),
        (
            "CC Z+0 X+0\nC X+0 Y+20 DR+",
            "line 4: `C X+0 Y+20 DR+`: the circle states an axis across the plane of its CC",
        ),
    ] {
        let found = fault(blocks);
        assert!(found.contains(part), "{blocks}: {found}");
    }
}

#[test]
fn corrected_circles_stay_in_their_plane() {
    let text = "0 BEGIN PGM A MM\n1 TOOL CALL 1 Z S100\n2 L X+5 Y+25 Z+0 R0 FMAX M3\n3 CC Y+0 Z+0\n4 C Y+0 Z+25 DR+ F600\n\
        5 LP PR+25 PA+180\n6 L Z+50 FMAX\n7 END PGM A MM\n";
    let program = program(text);
    for end in [[5.0, 0.01, 25.02], [5.3, 0.01, 25.02]] {
        let mut piece = Piece::to(1, Vector3::from(end));
        piece.centre_mm = Some(Vector3::new(5.0, 0.005, 0.025));
        let output = written(&program, &[piece]);
        let again = super::program(&output);
        let off: f64 = (0..3)
            .map(|axis| (place(&again, 1)[axis] - end[axis]).abs())
            .sum();
        assert!(off < 0.002, "{output}");
        assert!(
            matches!(again.motions[1].kind, MotionKind::Arc { .. }),
            "{output}"
        );
        assert!(ends_of_arcs(&again)[0].0 < 0.002, "{output}");
        // The polar block counts from the pole of the program.
        for motion in [2, 3] {
            let [a, b] = [&program, &again].map(|one| Vector3::from(place(one, motion)));
            let allowed = if motion == 2 && end[0] > 5.0 {
                0.4
            } else {
                1e-3
            };
            assert!(a.metric_distance(&b) < allowed, "{output}");
        }
    }
}

#[test]
fn holes_go_along_the_tools_axis() {
    let text = "BEGIN PGM A MM\nTOOL CALL 1 X S100\nL X+50 Y+1 Z+2 R0 FMAX M3\nCYCL DEF 200 DRILLING ~\n Q200=+2 ~\n Q201=-5 ~\n Q206=+100 ~\n Q202=+5 ~\n Q203=+0 ~\n Q204=+20\nCYCL CALL\nEND PGM A MM\n";
    let flat = flat(text);
    assert!(
        flat.contains("L X-5 R0 F100") && !flat.contains("L Z"),
        "{flat}"
    );
}
