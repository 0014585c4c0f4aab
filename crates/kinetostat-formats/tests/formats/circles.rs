//! Corrected circles of robots: written as circles, read again, asked for again in other places.

use kinetostat_formats::*;
use kinetostat_program::{
    Arcs, Corrected, Correction, CorrectionField, FieldFailure, Path, Request, Unwatched,
    WriteOptions as PathWriteOptions, verify_against_field,
};
use kinetostat_testing::Worst;
use nalgebra::{Isometry3, Vector3};

use crate::correcting::written_and_checked;

/// The plane of the circle leans and is bent a little, as on an Orthoglide under a milling force; or the tool is turned, too.
struct Leaning {
    turns: bool,
}

fn shift(place: &Vector3<f64>) -> Vector3<f64> {
    let angle = place.y.atan2(place.x);
    let (sine, cosine) = angle.sin_cos();
    let (twice_sine, twice_cosine) = (2.0 * angle).sin_cos();
    Vector3::new(
        -0.01 - 0.521 * cosine + 0.167 * sine - 0.0216 * twice_cosine + 0.0123 * twice_sine,
        -0.147 - 0.204 * cosine - 0.551 * sine + 0.0016 * twice_cosine + 0.0089 * twice_sine,
        -0.114 + 0.01 * cosine - 0.159 * sine + 0.0094 * twice_cosine + 0.0055 * twice_sine,
    )
}

impl CorrectionField for Leaning {
    fn corrections(&self, requests: &[Request]) -> Vec<Result<Correction, FieldFailure>> {
        let at = |request: &Request| {
            let turn = match self.turns && request.orientation.is_some() {
                true => request.position_mm.cross(&Vector3::z()) * 4e-5,
                false => Vector3::zeros(),
            };
            Ok(Correction {
                shift_mm: shift(&request.position_mm),
                turn,
            })
        };
        requests.iter().map(at).collect()
    }
}

const PLACES: [[f64; 2]; 5] = [
    [25.0, 0.0],
    [0.0, 25.0],
    [-25.0, 0.0],
    [0.0, -25.0],
    [25.0, 0.0],
];

fn rapid() -> String {
    let target =
        |[x, y]: [f64; 2]| format!("[[{x},{y},-2],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]");
    let [start, up, left, down, end] = PLACES.map(target);
    format!(
        "MODULE M\nCONST robtarget up:={up};\nPROC main() CirPathMode\\ObjectFrame;\n  MoveL {start},v10,fine,tool0;\n  MoveC up,{left},v10,z1,tool0;\n\
         \x20 MoveC {down}, {end}, v10, fine, tool0; ! closed\nENDPROC\nENDMODULE\n"
    )
}

fn krl() -> String {
    let target = |[x, y]: [f64; 2]| format!("{{X {x},Y {y},Z -2,A 0,B 0,C 180}}");
    let [start, up, left, down, end] = PLACES.map(target);
    format!(
        "DEF part()\n$TOOL={{X 0,Y 0,Z 0,A 0,B 0,C 0}}\n$BASE={{X 0,Y 0,Z 0,A 0,B 0,C 0}}\n$VEL.CP=0.01\n\
         LIN {start}\nCIRC {up},{left} C_DIS\nCIRC {down}, {end} ; closed\nEND\n"
    )
}

fn urscript() -> String {
    let target = |[x, y]: [f64; 2]| format!("p[{},{},-0.002,3.14159265359,0,0]", x / 1e3, y / 1e3);
    let [start, up, left, down, end] = PLACES.map(target);
    format!(
        "def m():\n  set_tcp(p[0,0,0,0,0,0])\n  movel({start},v=0.01)\n  movec({up},{left},1.2,0.01,0.001,0)\n\
         \x20 movec({down}, {end}, v=0.01) # closed\nend\n"
    )
}

fn tp() -> String {
    let mut text = "/PROG  PART\n/ATTR\nLINE_COUNT\t= 3;\n/MN\n   1:L P[1] 10mm/sec FINE ;\n\
        \x20  2:C P[2]    \n    :  P[3] 10mm/sec CNT50    ;\n   3:C P[4]    \n    :  P[5] 10mm/sec FINE    ;\n/POS\n"
        .to_owned();
    for (number, [x, y]) in (1..).zip(PLACES) {
        text += &format!(
            "P[{number}]{{\n   GP1:\n\tUF : 2, UT : 1,\t\tCONFIG : 'N U T, 0, 0, 0',\n\tX = {x:9.3}  mm,\tY = {y:9.3}  mm,\tZ =    -2.000  mm,\n\
             \tW =   180.000 deg,\tP =      .000 deg,\tR =     0.000 deg\n}};\n"
        );
    }
    text + "/END\n"
}

const SIEMENS: &str = "G90 G17 G71 G94\nG0 X25 Y0 Z-2\nN10 G3 X-25 Y0 I-25 J0 F600 ; one half\nN20 X25 Y0 I25 J0 M9\nG0 Z10\nM30\n";

/// What is written, checked against the field, and its path read again.
fn corrected_anywhere(
    (language, text): (Language, &str),
    field: &Leaning,
    writing: &PathWriteOptions,
) -> (String, Corrected, Path) {
    let mut options = ReadOptions::default();
    for frame in ["UF:2", "UT:1"] {
        options.frames.insert(frame.into(), Isometry3::identity());
    }
    let program = read(language, vec![SourceFile::new("a", text)], &options).unwrap();
    let making = PathOptions::default();
    let path = path_of(&program, &making).unwrap();
    let written =
        written_and_checked((&program, &path), (&options, &making), field, writing).unwrap();
    verify_against_field(&path.path, &written, field, writing, &Unwatched).unwrap();
    let output = String::from_utf8(written.bytes.clone()).unwrap();
    let again = read(
        language,
        vec![SourceFile::new("a", output.clone())],
        &options,
    )
    .unwrap();
    let again = path_of(&again, &making).unwrap().path;
    (output, written, again)
}

/// The same of a program around the circle, and how far its motions are from where the field wants them, mm.
fn corrected(
    program: (Language, &str),
    field: &Leaning,
    writing: &PathWriteOptions,
) -> (String, Corrected, f64) {
    let (output, written, again) = corrected_anywhere(program, field, writing);
    // The place of the corrected circle that is nearest to a place of the written one.
    let mut worst = Worst::new();
    let mut count = 0;
    for (made, piece) in again.moves.iter().zip(&written.pieces) {
        if piece.circle.is_none() {
            continue;
        }
        for k in 0..=50 {
            let at = made.point(f64::from(k) / 50.0);
            let wanted = |angle: f64| {
                let place = Vector3::new(25.0 * angle.cos(), 25.0 * angle.sin(), -2.0);
                place + shift(&place)
            };
            let mut angle = at.y.atan2(at.x);
            for _ in 0..6 {
                let along = (wanted(angle + 1e-4) - wanted(angle - 1e-4)) / 2e-4;
                angle += (at - wanted(angle)).dot(&along) / along.norm_squared();
            }
            worst.add((at - wanted(angle)).norm());
            count += 1;
        }
    }
    (output, written, worst.of(count))
}

#[test]
fn a_groove_has_at_most_five_circles_for_each_of_two_in_every_language() {
    for (language, text, word) in [
        (Language::Rapid, rapid(), "MoveC"),
        (Language::Krl, krl(), "CIRC"),
        (Language::FanucLs, tp(), ":C P["),
        (Language::UrScript, urscript(), "movec"),
        (Language::Siemens, SIEMENS.to_owned(), "CIP"),
    ] {
        for turns in [false, true] {
            let field = Leaning { turns };
            let mut writing = PathWriteOptions::default();
            writing.header = None;
            let (output, written, off) = corrected((language, &text), &field, &writing);
            let circles = written.pieces.iter().filter(|piece| piece.circle.is_some());
            let count = circles.count();
            println!(
                "{language:?}, turned {turns}: {count} circles, {:.3} um off",
                1e3 * off
            );
            // The code of SINUMERIK stays in force on the next block of the program.
            let stated = if language == Language::Siemens {
                count - 1
            } else {
                count
            };
            assert_eq!(output.matches(word).count(), stated, "{output}");
            let others = if language == Language::Siemens { 2 } else { 1 };
            assert_eq!(written.pieces.len(), others + count, "{output}");
            // Turns that vary need more pieces than places that do.
            assert!(count <= if turns { 30 } else { 10 }, "{count}");
            assert!(off < 0.0011, "{off}");
            // Speeds along the part are kept.
            let accounting = &written.accounting;
            let seconds =
                [accounting.feed_time_in_s, accounting.feed_time_out_s].map(Option::unwrap);
            assert!((seconds[1] / seconds[0] - 1.0).abs() < 1e-3, "{seconds:?}");

            writing.arcs = Arcs::Lines;
            let (output, written, _) = corrected_anywhere((language, &text), &field, &writing);
            assert!(!output.contains(word) && written.pieces.len() > 200);
        }
    }
}

#[test]
fn what_a_circle_says_beside_its_places_stays() {
    let mut writing = PathWriteOptions::default();
    writing.header = None;
    writing.tolerance_mm = 0.02;
    let field = Leaning { turns: false };
    let (output, ..) = corrected((Language::Rapid, &rapid()), &field, &writing);
    let circles: Vec<&str> = output
        .lines()
        .filter(|line| line.contains("MoveC"))
        .collect();
    assert!(circles.len() <= 6, "{output}");
    // The name of the place between stays with the last one, and so do the blanks and the comment of the other.
    assert!(
        circles.iter().any(|line| line.contains("MoveC up,[[")),
        "{output}"
    );
    assert!(
        circles.last().unwrap().ends_with(", fine, tool0; ! closed"),
        "{output}"
    );
    assert_eq!(output.matches("CONST robtarget").count(), 1);
    // In a program of positions every circle has two of its own, and lines are numbered.
    let (output, written, _) = corrected((Language::FanucLs, &tp()), &field, &writing);
    let count = written.pieces.len();
    assert!(
        output.contains(&format!("LINE_COUNT\t= {count};")),
        "{output}"
    );
    assert_eq!(
        output.matches("CONFIG").count(),
        1 + 2 * (count - 1),
        "{output}"
    );
}

#[test]
fn sinumerik_programs_go_through_places_and_their_codes_and_feeds_are_taken_back() {
    let mut writing = PathWriteOptions::default();
    writing.header = None;
    writing.tolerance_mm = 0.02;
    let field = Leaning { turns: false };
    let (output, written, _) = corrected((Language::Siemens, SIEMENS), &field, &writing);
    let blocks: Vec<&str> = output.lines().collect();
    let first = blocks
        .iter()
        .position(|block| block.starts_with("N10 CIP X"))
        .unwrap();
    assert!(
        blocks[first].contains(" I1=AC(") && blocks[first].ends_with(" ; one half"),
        "{output}"
    );
    assert!(
        !output.contains("I-25") && !output.contains("J0"),
        "{output}"
    );
    assert!(
        blocks[first + 1].starts_with("CIP X") && blocks[first + 1].contains(" K1=-2."),
        "{output}"
    );
    assert!(
        blocks.iter().any(|block| block.starts_with("G0 Z")),
        "{output}"
    );
    assert_eq!(output.matches("M9").count(), 1);
    assert!(written.pieces.len() <= 8);
    // Steps, and a point that is there already.
    let text = "G90 G94\nG0 X25 Y0 Z-2\nG91 CIP X-50 Y0 I1=-25 J1=25 F600\nG90 G1 Z5\nM30\n";
    let (output, ..) = corrected((Language::Siemens, text), &field, &writing);
    assert!(
        output.contains("G91 CIP X=AC(") || output.contains("G91 CIP X-"),
        "{output}"
    );
    assert!(
        output
            .lines()
            .any(|block| block.starts_with("CIP X=AC(") && block.contains("J1=AC(")),
        "{output}"
    );
    // In inches and in a turned frame.
    let text =
        "G90 G94 G70\nROT Z30\nG0 X1 Y0 Z-0.1\nG2 X-1 Y0 I-1 J0 F20\nG2 X1 Y0 CR=-1.5\nM30\n";
    let (output, written, _) = corrected_anywhere((Language::Siemens, text), &field, &writing);
    assert!(
        written
            .pieces
            .iter()
            .filter(|piece| piece.circle.is_some())
            .count()
            >= 2,
        "{output}"
    );
}

#[test]
fn a_circle_of_nearly_a_whole_turn_becomes_shorter_ones() {
    // 350 degrees through the place half round.
    let angle = 350.0_f64.to_radians();
    let target = |angle: f64| {
        let (y, x) = angle.sin_cos();
        format!(
            "[[{:.4},{:.4},-2],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]",
            25.0 * x,
            25.0 * y
        )
    };
    let text = format!(
        "MODULE M\nPROC main()\n  MoveL {},v10,fine,tool0;\n  MoveC {},{},v10,fine,tool0;\nENDPROC\nENDMODULE\n",
        target(0.0),
        target(0.5 * angle),
        target(angle)
    );
    let mut writing = PathWriteOptions::default();
    writing.tolerance_mm = 0.05;
    let (_, written, _) = corrected(
        (Language::Rapid, &text),
        &Leaning { turns: false },
        &writing,
    );
    let sweeps: Vec<f64> = written
        .pieces
        .iter()
        .filter_map(|piece| Some(piece.circle?.curve.sweep.to_degrees()))
        .collect();
    assert!(
        sweeps.len() >= 2 && sweeps.iter().all(|sweep| *sweep <= 240.0),
        "{sweeps:?}"
    );
    assert!(
        (sweeps.iter().sum::<f64>() - 350.0).abs() < 2.0,
        "{sweeps:?}"
    );
}

/// Where the place on a circle is not known the motion stays a circle: straight, it would cut another way.
#[test]
fn circles_through_a_place_that_is_not_known_stay_circles() {
    let texts = [
        (
            Language::Rapid,
            "MODULE M\nPROC main()\nMoveL [[0,0,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,fine,tool0;\n\
             MoveC OwnPlace(),[[100,0,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,fine,tool0;\nENDPROC\nENDMODULE\n",
            "MoveC OwnPlace(),",
        ),
        (
            Language::Krl,
            "DEF m()\n$BASE=$NULLFRAME\n$TOOL=$NULLFRAME\n$VEL.CP=0.02\nLIN {X 0,Y 0,Z 0,A 0,B 0,C 180}\n\
             CIRC XNO, {X 100,Y 0,Z 0,A 0,B 0,C 180}\nEND\n",
            "CIRC XNO,",
        ),
        (
            Language::Krl,
            "DEF m()\n$BASE=$NULLFRAME\n$TOOL=$NULLFRAME\n$VEL.CP=0.02\nLIN XNO\n\
             CIRC {X 50}, {X 100,Y 0,Z 0,A 0,B 0,C 180}\nEND\n",
            "CIRC {X 50},",
        ),
    ];
    let mut reading = ReadOptions::default();
    reading.unknown_targets = UnknownTargets::LeftAsWritten;
    for (language, text, kept) in texts {
        let files = vec![SourceFile::new("m.txt", text)];
        let program = read(language, files, &reading).unwrap();
        let path = path_of(&program, &PathOptions::default()).unwrap();
        let robot = Correctable {
            program: &program,
            path: &path,
            reading: &reading,
            making: &PathOptions::default(),
            writing: &WriteOptions::default(),
        };
        let field = |_: &kinetostat_program::Request| Ok(nalgebra::Vector3::z() * 0.1);
        let mut writing = kinetostat_program::WriteOptions::default();
        writing.header = None;
        let written = kinetostat_program::MachineProgram::write(
            &robot,
            &field,
            &writing,
            &kinetostat_program::Unwatched,
        );
        match written {
            Ok(written) => {
                let written = String::from_utf8(written.bytes).unwrap();
                assert!(written.contains(kept), "{written}");
            }
            Err(refused) => panic!("{refused}"),
        }
    }
}
