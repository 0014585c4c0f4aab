//! Angles of rotary axes under TRAORI and M128: the same tool poses as G-code with G43.4, closed forms, pieces, what is refused.

use std::sync::Arc;

use kinetostat_formats::*;
use kinetostat_program::{
    Carries, Correction, CorrectionField, FieldFailure, Knowledge, MachineProgram, Move, Path,
    Program, ReadOptions as GcodeReading, Request, RotaryAxes, RotaryAxis, Unwatched,
    WriteOptions as PathWriteOptions, interpret,
};
use kinetostat_testing::Worst;
use nalgebra::{Point3, Unit, UnitQuaternion, Vector3};

use crate::chance::Chance;

/// A fork head about x above a table that turns the part about -z, 100 mm beside the part's zero.
fn axes() -> Arc<RotaryAxes> {
    let axis = |letter, carries, direction| RotaryAxis {
        letter,
        carries,
        direction: Unit::new_normalize(direction),
        point_mm: Vector3::new(100.0, 0.0, 0.0),
        limits_deg: None,
    };
    Arc::new(RotaryAxes {
        axes: vec![
            axis('A', Carries::Tool, Vector3::x()),
            axis('C', Carries::Part, -Vector3::z()),
        ],
        tool_at_zero: UnitQuaternion::identity(),
    })
}

/// The tool's axis in the part at angles A and C, by hand: Rz(c) Rx(a) z.
fn axis_at(a: f64, c: f64) -> Vector3<f64> {
    let (a, c) = (a.to_radians(), c.to_radians());
    Vector3::new(a.sin() * c.sin(), -a.sin() * c.cos(), a.cos())
}

/// Where a place of the part lies in the machine at an angle C, by hand: turned by -c about the table's axis.
fn in_machine(place: &Vector3<f64>, c: f64) -> Vector3<f64> {
    let (sine, cosine) = (-c.to_radians()).sin_cos();
    let x = place.x - 100.0;
    Vector3::new(
        100.0 + cosine * x - sine * place.y,
        sine * x + cosine * place.y,
        place.z,
    )
}

fn making() -> PathOptions {
    let mut making = PathOptions::default();
    making.rotary = Some(axes());
    making
}

fn reading() -> ReadOptions {
    let mut reading = ReadOptions::default();
    reading.rotary_axes = vec!['A', 'C'];
    reading
}

pub fn read_as(language: Language, text: &str) -> Result<RobotProgram, Vec<ProgramError>> {
    read(language, vec![SourceFile::new("a.txt", text)], &reading())
}

pub fn robot(language: Language, text: &str) -> RobotPath {
    let program = read_as(language, text).unwrap_or_else(|all| panic!("{}\n{text}", all[0]));
    path_of(&program, &making()).unwrap_or_else(|all| panic!("{}\n{text}", all[0]))
}

const BEGIN_SIEMENS: &str = "G90 G71 G94 G17\nTRAORI\nORIAXES\nG0 X0 Y0 Z50 A0 C0\n";
const BEGIN_HEIDENHAIN: &str =
    "BEGIN PGM A MM\nL X+0 Y+0 Z+50 A+0 C+0 R0 FMAX\nM128\nL X+0 Y+0 Z+50 FMAX\n";

pub fn siemens(body: &str) -> String {
    format!("{BEGIN_SIEMENS}{body}G0 Z50 A0 C0\nTRAFOOF\nM30\n")
}

pub fn heidenhain(body: &str) -> String {
    format!("{BEGIN_HEIDENHAIN}{body}L Z+50 A+0 C+0 FMAX\nM129\nL Z+99 FMAX M30\nEND PGM A MM\n")
}

/// One path in three languages: places and angles are absolute, or steps.
fn in_three(chance: &mut Chance) -> [String; 3] {
    let mut text = [
        "G21 G90 G94\nG0 X0 Y0 Z50 A0 C0\nG43.4 H1 Z50\nG0 X0 Y0 Z50\n".to_owned(),
        String::new(),
        String::new(),
    ];
    for index in 0..25 {
        let mut number = |most: f64| (chance.within(most) * 1e3).round() / 1e3;
        let [x, y, z, a, c] = [60.0, 60.0, 5.0, 80.0, 500.0].map(&mut number);
        let feed = if index == 0 { " F600" } else { "" };
        match chance.below(5) {
            0 => {
                text[0] += &format!("G91 G1 X{x} A{a}{feed}\nG90\n");
                text[1] += &format!("G1 X=IC({x}) A=IC({a}){feed}\n");
                text[2] += &format!("L IX{x:+} IA{a:+}{feed}\n");
            }
            1 => {
                text[0] += &format!("G1 C{c}{feed}\n");
                text[1] += &format!("G1 C{c}{feed}\n");
                text[2] += &format!("L C{c:+}{feed}\n");
            }
            2 => {
                text[0] += &format!("G1 Z{z}{feed}\n");
                text[1] += &format!("G1 Z{z}{feed}\n");
                text[2] += &format!("L Z{z:+}{feed}\n");
            }
            _ => {
                text[0] += &format!("G1 X{x} Y{y} Z{z} A{a} C{c}{feed}\n");
                text[1] += &format!("G1 X{x} Y{y} Z{z} A={a} C=AC({c}){feed}\n");
                text[2] += &format!("L X{x:+} Y{y:+} Z{z:+} A{a:+} C{c:+}{feed}\n");
            }
        }
    }
    text[0] += "G0 Z50\nG49\nM30\n";
    [text[0].clone(), siemens(&text[1]), heidenhain(&text[2])]
}

pub fn feeds(path: &Path) -> Vec<&Move> {
    let feed = |motion: &&Move| motion.feed.is_some() && motion.is_known_feed();
    path.moves.iter().filter(feed).collect()
}

#[test]
fn three_languages_give_the_same_tool_poses() {
    let mut worst = Worst::new();
    let mut count = 0;
    for seed in 0..40 {
        let [gcode, siemens, heidenhain] = in_three(&mut Chance::new(seed));
        let mut options = GcodeReading::default();
        options.rotary = Some(axes());
        let gcode = interpret(&Program::read(gcode).unwrap(), &options).unwrap();
        let others = [
            robot(Language::Siemens, &siemens),
            robot(Language::Heidenhain, &heidenhain),
        ];
        for other in &others {
            assert_eq!(other.path.tool_axis, gcode.tool_axis);
            let (one, two) = (feeds(&gcode), feeds(&other.path));
            assert_eq!((one.len(), two.len()), (25, 25), "seed {seed}");
            for (one, two) in one.iter().zip(&two) {
                for share in [0.0, 0.3, 0.5, 0.9, 1.0] {
                    worst.add((one.point(share) - two.point(share)).norm());
                    let [a, b] = [one, two].map(|m| m.orientation(share).unwrap());
                    worst.add(a.angle_to(&b));
                    let [a, b] = [one, two].map(|m| m.part_turn(share).unwrap());
                    let far = Point3::new(300.0, -200.0, 50.0);
                    worst.add((a * far - b * far).norm());
                    count += 3;
                }
            }
        }
    }
    assert!(worst.of(count) < 1e-9);
}

#[test]
fn closed_forms_of_head_and_table_at_points_and_between() {
    let body = "G1 X50 Y20 Z0 A20 C30 F600\nX80 Y-10 A-35 C=IC(90)\nC450\n";
    let turned = "L X+50 Y+20 Z+0 A+20 C+30 F600\nL X+80 Y-10 A-35 IC+90\nL C+450\n";
    let ends = [[0.0, 0.0], [20.0, 30.0], [-35.0, 120.0], [-35.0, 450.0]];
    let places = [
        [0.0, 0.0, 50.0],
        [50.0, 20.0, 0.0],
        [80.0, -10.0, 0.0],
        [80.0, -10.0, 0.0],
    ];
    let (mut worst, mut count) = (Worst::new(), 0);
    for robot in [
        robot(Language::Siemens, &siemens(body)),
        robot(Language::Heidenhain, &heidenhain(turned)),
    ] {
        let cuts: Vec<usize> = (0..robot.path.moves.len())
            .filter(|index| robot.path.moves[*index].is_known_feed())
            .collect();
        assert_eq!(cuts.len(), 3);
        for (k, index) in cuts.into_iter().enumerate() {
            for share in [0.0, 0.125, 0.5, 0.77, 1.0] {
                let at = |from: f64, to: f64| from + (to - from) * share;
                let [a, c] = [0, 1].map(|i| at(ends[k][i], ends[k + 1][i]));
                let tip = Vector3::from_fn(|i, _| at(places[k][i], places[k + 1][i]));
                let motion = &robot.path.moves[index];
                let axis = robot.path.tool_direction(index, share);
                worst.add((axis - axis_at(a, c)).norm() * 100.0);
                worst.add((motion.point(share) - tip).norm());
                let part = motion.part_turn(share).unwrap();
                let machine = (part * Point3::from(motion.point(share))).coords;
                worst.add((machine - in_machine(&tip, c)).norm());
                count += 3;
            }
        }
    }
    assert!(worst.of(count) < 1e-9);
}

/// Bent along x and y; the tool leans, too, where it is asked to.
struct Bent {
    turns: bool,
}

impl CorrectionField for Bent {
    fn corrections(&self, requests: &[Request]) -> Vec<Result<Correction, FieldFailure>> {
        let at = |request: &Request| {
            let p = request.position_mm / 40.0;
            let lean = 1e-3 * (1.0 + request.share);
            Ok(Correction {
                shift_mm: Vector3::new(p.y * p.y, -p.x, 1.0 + p.x * p.y) * 0.05,
                turn: match self.turns && request.orientation.is_some() {
                    true => Vector3::new(lean, 0.5 * lean, 0.0),
                    false => Vector3::zeros(),
                },
            })
        };
        requests.iter().map(at).collect()
    }

    fn turns_tool(&self) -> bool {
        self.turns
    }
}

pub fn corrected(language: Language, text: &str, turns: bool) -> Result<Written, String> {
    let program = read_as(language, text).map_err(|all| all[0].to_string())?;
    let (reading, making) = (reading(), making());
    let path = path_of(&program, &making).map_err(|all| all[0].to_string())?;
    let correctable = Correctable {
        program: &program,
        path: &path,
        reading: &reading,
        making: &making,
        writing: &WriteOptions::default(),
    };
    let mut writing = PathWriteOptions::default();
    writing.header = None;
    writing.tolerance_mm = 0.002;
    let written = correctable
        .write(&Bent { turns }, &writing, &Unwatched)
        .map_err(|error| error.to_string())?;
    correctable
        .verify(&written, &writing)
        .map_err(|error| error.to_string())?;
    let text = String::from_utf8(written.bytes.clone()).unwrap();
    let again = robot(language, &text);
    Ok(Written {
        path,
        written,
        again,
        text,
    })
}

pub struct Written {
    pub path: RobotPath,
    pub written: kinetostat_program::Corrected,
    pub again: RobotPath,
    pub text: String,
}

#[test]
fn pieces_share_the_angles_out_and_end_where_the_block_does() {
    let bodies = [
        (
            Language::Siemens,
            siemens(
                "G1 X50 Y20 Z0 A20 C=IC(30) F600\nX80 Y-10 A=IC(-55) C90\nG91 X5 C33.3\nG90 C=DC(350)\nX10 Y30 C=ACP(10.5)\nX60 A.5\nA-1\n",
            ),
        ),
        (
            Language::Heidenhain,
            heidenhain(
                "L X+50 Y+20 Z+0 A+20 IC+30 F600\nL X+80 Y-10 IA-55 C+90\nL IX+5 IC+33.3\nL C-10 M126\nL X+10 Y+30 C+10.5\nL X+60 A+0.5 M127\nL A-1\n",
            ),
        ),
        // The great circle: other angles on the way.
        (
            Language::Siemens,
            siemens("ORIVECT\nG1 X50 Y20 Z0 A20 C30 F600\nX80 Y-10 A30 C60\nX10 A5\n"),
        ),
        // From the pole, where C turns at once to where the way leads, and back.
        (
            Language::Siemens,
            siemens("G1 Z0 F600\nX50 Y40 A20 C30\nX0 Y-20 A0\n").replace("ORIAXES\n", ""),
        ),
    ];
    for (language, text) in bodies {
        let made =
            corrected(language, &text, false).unwrap_or_else(|error| panic!("{error}\n{text}"));
        let (mut worst, mut count) = (Worst::new(), 0);
        for (index, piece) in made.written.pieces.iter().enumerate() {
            let motion = &made.path.path.moves[piece.move_index];
            if motion.known != Knowledge::Whole || piece.corner_step {
                continue;
            }
            for part in [0.0, 0.25, 0.5, 0.75, 1.0] {
                let share = piece.share_from + part * (piece.share_to - piece.share_from);
                let wanted = made.path.path.tool_direction(piece.move_index, share);
                worst.add(made.again.path.tool_direction(index, part).angle(&wanted));
                count += 1;
            }
        }
        assert!(
            made.written.pieces.len() > made.path.path.moves.len() + 3,
            "{}",
            made.text
        );
        assert!(worst.of(count) < 3e-6, "{}", made.text);
        // Whole turns and all: the last cut ends at the very angles.
        let last = |robot: &RobotPath| {
            let cuts = feeds(&robot.path);
            let turn = cuts.last().unwrap().tool_turn.as_ref().unwrap();
            turn.rotary.as_ref().unwrap().end_deg.clone()
        };
        let both = last(&made.path).into_iter().zip(last(&made.again));
        assert!(
            both.into_iter().all(|(a, b)| (a - b).abs() < 2e-4),
            "{}",
            made.text
        );
    }
}

#[test]
fn the_way_of_orivect_is_the_great_circle_to_the_stated_angles() {
    let text = siemens("ORIVECT\nG1 X50 A20 C30 F600\nX80 A30 C60\n");
    let robot = robot(Language::Siemens, &text);
    let index = robot
        .path
        .moves
        .iter()
        .rposition(Move::is_known_feed)
        .unwrap();
    let (from, to) = (axis_at(20.0, 30.0), axis_at(30.0, 60.0));
    let across = from.cross(&to).normalize();
    for share in [0.2, 0.5, 0.8] {
        let axis = robot.path.tool_direction(index, share);
        assert!(axis.dot(&across).abs() < 1e-9);
        assert!((axis.angle(&from) - share * from.angle(&to)).abs() < 1e-9);
    }
    // Other angles of the same direction are not on that way.
    let fault = |body: &str| {
        let program = read_as(Language::Siemens, &siemens(body)).unwrap();
        path_of(&program, &making()).unwrap_err()[0].to_string()
    };
    let said = fault("ORIVECT\nG1 X50 A20 C30 F600\nX80 A-30 C240\n");
    assert!(said.contains("line 7: the tool's axis goes on the great circle (ORIVECT, the basic setting), and so the axes come to A30.000 C60.000, not to A-30.000 C240.000"), "{said}");
    assert!(said.contains("write ORIAXES"), "{said}");
}

#[test]
fn angles_are_corrected_with_the_pose_and_brought_back_by_the_rapid() {
    for (language, text) in [
        (
            Language::Siemens,
            siemens("G0 A20\nG1 X50 Y20 Z0 A30 C30 F600\nX80 Y-10 C=IC(60)\n"),
        ),
        (
            Language::Heidenhain,
            heidenhain("L A+20 FMAX\nL X+50 Y+20 Z+0 A+30 C+30 F600\nL X+80 Y-10 IC+60\n"),
        ),
    ] {
        let made =
            corrected(language, &text, true).unwrap_or_else(|error| panic!("{error}\n{text}"));
        let (mut worst, mut count) = (Worst::new(), 0);
        for (index, piece) in made.written.pieces.iter().enumerate() {
            let motion = &made.path.path.moves[piece.move_index];
            if !motion.is_known_feed() || piece.corner_step {
                continue;
            }
            // The tilt of the field, by hand, upon the angles of the program, by hand.
            let angles = &motion.tool_turn.as_ref().unwrap().rotary.as_ref().unwrap();
            let [a, c] = angles.angles_deg(piece.share_to)[..] else {
                panic!()
            };
            let lean = 1e-3 * (1.0 + piece.share_to);
            let tilt = UnitQuaternion::from_scaled_axis(Vector3::new(lean, 0.5 * lean, 0.0));
            let axis = made.again.path.tool_direction(index, 1.0);
            worst.add(axis.angle(&(tilt * axis_at(a, c))));
            count += 1;
        }
        // The angles have five digits or four behind the point.
        assert!(count > 6 && worst.of(count) < 4e-6, "{}", made.text);
        assert_eq!(made.written.rotary_deg.len(), made.written.pieces.len());
        let back = made
            .again
            .path
            .moves
            .iter()
            .rfind(|m| m.tool_turn.is_some())
            .unwrap();
        let back = back.tool_turn.as_ref().unwrap().rotary.as_ref().unwrap();
        assert_eq!(back.end_deg, [0.0, 0.0], "{}", made.text);
    }
    let text = siemens("G0 A20\nG1 X50 Y20 Z0 A30 C30 F600\n")
        .replace("G0 Z50 A0 C0\nTRAFOOF\n", "TRAFOOF\nG0 Z90\n");
    let said = corrected(Language::Siemens, &text, true)
        .map(|made| made.text)
        .unwrap_err();
    assert!(
        said.contains("line 8: the angles of the rotary axes are corrected up to here"),
        "{said}"
    );
}

#[test]
fn without_a_correction_nothing_changes() {
    for seed in 0..40 {
        let [_, siemens, heidenhain] = in_three(&mut Chance::new(seed));
        for (language, text) in [
            (Language::Siemens, siemens),
            (Language::Heidenhain, heidenhain),
        ] {
            let program = read_as(language, &text).unwrap();
            let files = write(&program, &[], &WriteOptions::default()).unwrap();
            assert_eq!(files[0].1, text.as_bytes());
        }
    }
}

#[test]
fn what_is_not_known_is_refused_by_line() {
    let cases: [(Language, String, usize, &str); 13] = [
        (
            Language::Siemens,
            siemens("G0 C=DC(180)\nG1 X5 C=DC(0) F9\n"),
            6,
            "axis C turns by half a turn, and which way is the shorter one is open",
        ),
        (
            Language::Siemens,
            siemens("").replace(" C0\n", "\nG1 X5 A3 F1\n"),
            5,
            "where axis C stands is not stated before this block cuts",
        ),
        (
            Language::Siemens,
            "G0 X0 Y0 Z5 A20 C0\nG1 X9 F100\nM30\n".to_owned(),
            2,
            "axis A stands at 20 deg, and tool centre point control is off",
        ),
        (
            Language::Siemens,
            siemens("TRAFOOF\nG0 A20\nG1 X5 F1\n"),
            7,
            "let the CAM system write places of the tool's tip in the part (TRAORI)",
        ),
        (
            Language::Siemens,
            siemens("G1 A3 A3=0 B3=0 C3=1 F100\n"),
            5,
            "an angle and a direction of the tool stand in one block",
        ),
        (
            Language::Siemens,
            siemens("G1 A3 A4 F100\n"),
            5,
            "the word stands twice",
        ),
        (
            Language::Siemens,
            siemens("TRANS C30\n"),
            5,
            "the frame shifts where a rotary axis counts from",
        ),
        (
            Language::Siemens,
            siemens("G1 C=DC(400) F9\n"),
            5,
            "axis C is sent to 400 deg of one turn",
        ),
        (
            Language::Siemens,
            siemens("G1 B20 F9\n"),
            5,
            "the axis B moves",
        ),
        (
            Language::Heidenhain,
            heidenhain("L B+20 F9\n"),
            5,
            "describe the rotary axes of the machine in the model",
        ),
        (
            Language::Heidenhain,
            heidenhain("M129\nL A+20 FMAX\nL X+5 F9\n"),
            7,
            "axis A stands at 20 deg, and tool centre point control is off",
        ),
        (
            Language::Heidenhain,
            heidenhain("FUNCTION TCPM F TCP AXIS SPAT PATHCTRL AXIS\nL A+20 F9\n"),
            6,
            "angles in space here (AXIS SPAT)",
        ),
        (
            Language::Heidenhain,
            heidenhain("CC X+0 Y+50\nC X+0 Y+100 DR+ A+20 F9\n"),
            6,
            "a rotary axis turns on an arc",
        ),
    ];
    for (language, text, line, words) in cases {
        let errors = read_as(language, &text).map(|_| text.clone()).unwrap_err();
        let said = errors[0].to_string();
        assert!(
            said.contains(words) && errors[0].line == line,
            "{said}\n{text}"
        );
        // And nothing that only follows from it.
        let same = errors.iter().all(|error| error.to_string().contains(words));
        assert!(same, "{errors:?}");
    }
    // Without these axes in the model the words are refused as before.
    let none = ReadOptions::default();
    let siemens = siemens("G1 X5 A3 F1\n");
    assert!(read_siemens(vec![SourceFile::new("a.mpf", siemens)], &none).is_err());
    let heidenhain = heidenhain("L A+20 F9\n");
    assert!(read_heidenhain(vec![SourceFile::new("a.h", heidenhain)], &none).is_err());
}

#[test]
fn axes_of_another_machine_are_refused() {
    let program = read_as(Language::Siemens, &siemens("G1 X5 A3 F1\n")).unwrap();
    let said = path_of(&program, &PathOptions::default()).unwrap_err()[0].to_string();
    assert!(
        said.contains("line 4: angles of rotary axes say how the tool stands"),
        "{said}"
    );
}
