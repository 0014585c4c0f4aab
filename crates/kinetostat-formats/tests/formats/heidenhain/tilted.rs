//! Tilted planes, the rotary axes that follow them, blocks behind a slash, cycles of the machine's builder.

use nalgebra::Vector3;

use super::*;

fn options(letters: &[char], slash: SlashBlocks) -> ReadOptions {
    let mut options = ReadOptions::default();
    options.rotary_axes = letters.to_vec();
    options.slash_blocks = slash;
    options
}

fn text_of(body: &str) -> String {
    format!("BEGIN PGM A MM\nTOOL CALL 1 Z S100\nL X+0 Y+0 Z+50 R0 FMAX M3\n{body}\nEND PGM A MM\n")
}

fn faults(body: &str) -> Vec<String> {
    let options = options(&['A', 'C'], SlashBlocks::Refused);
    let read = read_with(text_of(body).as_bytes(), &options);
    let faults = read.err().unwrap_or_default();
    faults.iter().map(ToString::to_string).collect()
}

/// The last motion of a program: its end and the tool's axis, as they stand in the axes of the preset.
fn last_of(body: &str) -> [Vector3<f64>; 2] {
    let options = options(&['A', 'C'], SlashBlocks::Refused);
    let program = read_with(text_of(body).as_bytes(), &options);
    let program = program.unwrap_or_else(|errors| panic!("{body}: {errors:#?}"));
    let pose = program.motions.last().unwrap().target.pose().unwrap();
    [pose.position_mm, pose.orientation * Vector3::z()]
}

const THERE: &str = "L X+1 Y+2 FMAX\nL Z+9 FMAX\nL Z+3 F100";
const SHIFT: &str = "CYCL DEF 7.0\nCYCL DEF 7.1 X+10\nCYCL DEF 7.2 Y+20\nCYCL DEF 7.3 Z+30\n";

/// A first, then B, then C, about the axes that are not tilted; the datum shift counts in them.
#[test]
fn places_of_a_tilted_plane_are_turned_about_the_datum() {
    let turned = |a: f64, b: f64, c: f64| {
        let about =
            |axis, degrees: f64| nalgebra::Rotation3::from_axis_angle(&axis, degrees.to_radians());
        about(Vector3::z_axis(), c) * about(Vector3::y_axis(), b) * about(Vector3::x_axis(), a)
    };
    for (plane, turn) in [
        (
            "SPATIAL SPA+90 SPB+0 SPC+180 TURN FMAX SEQ- TABLE ROT",
            turned(90.0, 0.0, 180.0),
        ),
        (
            "SPATIAL SPA+20 SPB-30 SPC+40 MOVE DIST50 F2000 COORD ROT",
            turned(20.0, -30.0, 40.0),
        ),
        (
            "SPATIAL SPA+0 SPB+10 SPC+30 STAY\nL A+Q120 C+Q122 R0 FMAX M126",
            turned(0.0, 10.0, 30.0),
        ),
        (
            "VECTOR BX1 BY0.5 BZ0 NX0 NY-2 NZ0 STAY\nL C+Q122 A+Q120 FMAX",
            turned(90.0, 0.0, 0.0),
        ),
    ] {
        let [place, axis] = last_of(&format!("{SHIFT}PLANE {plane}\n{THERE}"));
        let wanted = turn * Vector3::new(1.0, 2.0, 3.0) + Vector3::new(10.0, 20.0, 30.0);
        assert!((place - wanted).norm() < 1e-9, "{plane}: {place}");
        assert!(
            (axis - turn * Vector3::z()).norm() < 1e-9,
            "{plane}: {axis}"
        );
        // And back.
        let back = format!("{SHIFT}PLANE {plane}\n{THERE}\nPLANE RESET TURN FMAX\n{THERE}");
        let [place, axis] = last_of(&back);
        assert!(
            (place - Vector3::new(11.0, 22.0, 33.0)).norm() < 1e-9,
            "{place}"
        );
        assert!((axis - Vector3::z()).norm() < 1e-12, "{axis}");
    }
    // Behind a reset that leaves the axes turned, M128 counts in the axes of the part, and the same plane needs no turn.
    let stay = "PLANE SPATIAL SPA+90 SPB+0 SPC+0 STAY\n";
    let turn = "L A+Q120 C+Q122 FMAX\nPLANE RESET STAY\n";
    let [place, axis] = last_of(&format!("{stay}{turn}M128\n{THERE}"));
    assert!(
        (place - Vector3::new(1.0, 2.0, 3.0)).norm() < 1e-9,
        "{place}"
    );
    assert!((axis + Vector3::y()).norm() < 1e-9, "{axis}");
    let [place, _] = last_of(&format!("{stay}{turn}M128\n{THERE}\nM129\n{stay}{THERE}"));
    assert!(
        (place - Vector3::new(1.0, -3.0, 2.0)).norm() < 1e-9,
        "{place}"
    );
}

/// What a correction moves along axes of the part stands in those of the plane.
#[test]
fn a_correction_is_written_in_the_axes_of_the_plane() {
    let text = text_of(&format!(
        "PLANE SPATIAL SPA+90 SPB+0 SPC+0 TURN FMAX\n{THERE}\nL X+5"
    ));
    let program = program(&text);
    let motion = program.motions.len() - 2;
    let place = Vector3::from(self::place(&program, motion));
    let moved = Piece::to(motion, place + Vector3::new(0.1, 0.2, 0.3));
    let found = written(&program, &[moved]);
    let expected = text.replace(
        "L Z+3 F100\nL X+5",
        "L X+1.100 Y+2.300 Z+2.800 F100\nL X+5 Y+2.000 Z+3.000",
    );
    assert_eq!(found, expected);
    assert_eq!(written(&program, &[]), text);
}

#[test]
fn a_cut_before_the_axes_stand_across_the_plane_is_refused() {
    let stay = "PLANE SPATIAL SPA+90 SPB+0 SPC+0 STAY\n";
    let turn = "L A+Q120 C+Q122 FMAX\n";
    for (body, part) in [
        (
            format!("{stay}{THERE}"),
            "do not stand as the plane in force says",
        ),
        (
            format!("{stay}{turn}PLANE RESET STAY\n{THERE}"),
            "do not stand as the plane in force says",
        ),
        (
            format!("{stay}{turn}PLANE RESET STAY\nL A+0 FMAX\n{THERE}"),
            "axis C was sent to a place",
        ),
        (
            format!("{stay}{turn}PLANE RESET STAY\nL A+0 FMAX M91\nM128\n{THERE}"),
            "where axis A stands is not stated",
        ),
        (
            "PLANE SPATIAL SPA+0 SPB+0 SPC+180 TURN FMAX TABLE ROT".to_owned(),
            "the plane is turned about Z alone",
        ),
        (
            format!("{stay}L A+Q120 FMAX\n{THERE}"),
            "not with those of all rotary axes",
        ),
        (
            format!("{stay}L X+1 A+Q120 C+Q122 FMAX\n{THERE}"),
            "beside places",
        ),
        (
            format!("{stay}Q121 = 5\nL A+Q120 C+Q122 FMAX"),
            "no PLANE before it",
        ),
        (
            format!("{stay}{turn}{SHIFT}{THERE}"),
            "the datum was shifted while the plane was tilted",
        ),
        (
            format!("{stay}{turn}{SHIFT}PLANE RESET TURN F900\n{THERE}"),
            "the datum was shifted while",
        ),
        (
            "CYCL DEF 10.0\nCYCL DEF 10.1 ROT+5\nPLANE SPATIAL SPA+9 SPB+0 SPC+0 STAY".to_owned(),
            "it tilts the plane",
        ),
    ] {
        let found = faults(&body);
        assert!(
            found.len() == 1 && found[0].contains(part),
            "{body}: {found:#?}"
        );
    }
    // The shift is stated again behind the reset.
    let again = format!("{SHIFT}{stay}{turn}CYCL DEF 7.1 X+0\nPLANE RESET TURN\n{SHIFT}{THERE}");
    assert_eq!(last_of(&again)[0], Vector3::new(11.0, 22.0, 33.0));
    // Without a model of the axes a plane that is not tilted is followed, and no other.
    let none = format!("PLANE SPATIAL SPA+0 SPB+0 SPC+0 STAY\nL B+Q121 C+Q122 FMAX\n{THERE}");
    assert_eq!(place(&program(&text_of(&none)), 3), [1.0, 2.0, 3.0]);
    let tilted = format!("{stay}L B+Q121 C+Q122 FMAX");
    let refused = read_with(text_of(&tilted).as_bytes(), &ReadOptions::default()).unwrap_err();
    assert!(
        refused[0].to_string().contains("[[rotary_axis]]"),
        "{refused:#?}"
    );
    // A flat program says the angles of the plane as the program does.
    let again =
        text_of("Q5 = 7\nPLANE SPATIAL SPA+0 SPB+0 SPC+0 STAY\nL B+Q121 C+Q122 FMAX\nL X+Q5 F100");
    let wanted = again.replace("Q5 = 7\n", "").replace("X+Q5", "X+7");
    assert_eq!(flat(&again), wanted);
}

#[test]
fn blocks_behind_a_slash_run_or_not_as_it_is_said() {
    let text = text_of("FN 0: Q1=9\nL X+Q1 F100\n/ L Y+5\n/L X+Q1 Z+1\nL X+1");
    for (slash, places, does) in [
        (
            SlashBlocks::Run,
            vec![
                [9.0, 0.0, 50.0],
                [9.0, 5.0, 50.0],
                [9.0, 5.0, 1.0],
                [1.0, 5.0, 1.0],
            ],
            "runs",
        ),
        (
            SlashBlocks::Skipped,
            vec![[9.0, 0.0, 50.0], [1.0, 0.0, 50.0]],
            "does not run",
        ),
    ] {
        let options = options(&[], slash);
        let flat =
            expand_heidenhain(vec![SourceFile::new("part.h", text.as_str())], &options).unwrap();
        let program = read_with(flat.file.bytes(), &options).unwrap();
        let count = program.motions.len();
        let found: Vec<[f64; 3]> = (1..count).map(|at| place(&program, at)).collect();
        assert_eq!(found, places);
        let said: Vec<&str> = program
            .findings
            .iter()
            .map(|found| found.message.as_str())
            .collect();
        assert_eq!(said, [format!("a block behind a slash {does}")]);
        // The writer reads them alike, and the slash stays.
        let moved = Piece::to(
            count - 1,
            Vector3::from(place(&program, count - 1)) + Vector3::x(),
        );
        let written = written(&program, &[moved]);
        assert!(
            written.contains("/L Y+5") && written.contains("L X+2"),
            "{written}"
        );
    }
}

#[test]
fn a_cycle_of_the_machines_builder_is_carried_and_said_once() {
    let text = text_of("CYCL DEF 392 ATC~\n Q240=0 ;MODE~\n Q241=1\nCYCL DEF 392 ATC\nL X+1 F100");
    let program = program(&text);
    let said: Vec<&str> = program
        .findings
        .iter()
        .map(|found| found.message.as_str())
        .collect();
    assert_eq!(
        said,
        ["cycle 392 is the machine builder's: taken as one that does not move the tool"]
    );
    let called = faults("CYCL DEF 392 ATC\nL X+1 FMAX M99");
    assert!(called[0].contains("a cycle is called"), "{called:?}");
}

/// A parameter that only the machine knows has the value that the caller states; one that the program gives it goes before.
#[test]
fn values_of_the_machine_are_those_that_are_stated() {
    let mut options = options(&[], SlashBlocks::Refused);
    let text = text_of(
        "Q3 = Q13 - Q10\nL X+Q3 F100\nQ10 = 8\nL Y+Q10\nFN18: SYSREAD Q10 = ID270 NR1\nL Z+Q10",
    );
    let flat = |options: &ReadOptions| {
        expand_heidenhain(vec![SourceFile::new("part.h", text.as_str())], options)
    };
    let refused = flat(&options).unwrap_err();
    assert!(refused[0].remedy.contains("--set"), "{refused:?}");
    for (name, value) in [("q13", 5.5), ("Q10", 1.5), ("Q1", 3.0)] {
        options
            .values
            .insert(name.to_owned(), StatedValue::Number(value));
    }
    let found = flat(&options).unwrap();
    let program = read_with(found.file.bytes(), &options).unwrap();
    assert_eq!(place(&program, 3), [4.0, 8.0, 1.5]);
    let said: Vec<&str> = found
        .findings
        .iter()
        .map(|found| found.message.as_str())
        .collect();
    let given = "as is stated, unless the program gives it another value";
    let wanted = [
        "a value of `Q1` is stated, and the program does not name it".to_owned(),
        format!("`Q10` is 1.5, {given}"),
        format!("`Q13` is 5.5, {given}"),
    ];
    assert_eq!(said, wanted);
    options
        .values
        .insert("R5".to_owned(), StatedValue::Number(1.0));
    assert!(flat(&options).unwrap_err()[0].reason.contains("`R5`"));
}
