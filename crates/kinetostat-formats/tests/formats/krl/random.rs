//! Random programs: pieces of KRL put together by chance, and broken by chance. Whatever they are, they are read or refused
//! with a line; what is read comes back byte for byte, and with corrections is read again with those corrections.

use kinetostat_formats::*;
use kinetostat_testing::Worst;
use nalgebra::{UnitQuaternion, Vector3};

use crate::chance::Chance;

fn number(chance: &mut Chance, size: f64) -> String {
    let value = chance.within(size);
    match chance.below(5) {
        0 => format!("{value:.0}"),
        1 => format!("{value:.1}"),
        2 => format!("{value:.6}"),
        3 => format!("{value:+.3}"),
        _ => format!("{value:.2}"),
    }
}

fn pose(chance: &mut Chance) -> String {
    let place: Vec<String> = (0..3).map(|_| number(chance, 2000.0)).collect();
    let angles = [180.0, 89.0, 180.0].map(|size| number(chance, size));
    let comma = chance.of(&[",", ", ", " , "]);
    let start = chance.of(&["{", "{ ", "{E6POS: ", "{POS:"]);
    let end = chance.of(&[
        "",
        ",S 2,T 35",
        ",S 'B010',T 'B00100011',E1 0.0,E2 0,E3 0,E4 0,E5 0,E6 0",
    ]);
    let members = [
        format!("X {}", place[0]),
        format!("Y {}", place[1]),
        format!("Z {}", place[2]),
        format!("A {}", angles[0]),
        format!("B {}", angles[1]),
        format!("C {}", angles[2]),
    ];
    format!("{start}{}{end}}}", members.join(comma))
}

/// Names of declared targets.
const NAMES: [&str; 7] = ["XP1", "xp2", "XP_3", "way[1]", "way[ 2 ]", "XG", "XH"];

fn end(chance: &mut Chance) -> String {
    let name = chance.of(&NAMES).to_owned();
    match chance.below(4) {
        0 | 1 => name,
        2 => {
            let (x, y, turn) = (
                number(chance, 50.0),
                number(chance, 50.0),
                number(chance, 180.0),
            );
            format!("{name}:{{X {x},Y {y},Z 0.0,A {turn},B 0,C 0}}")
        }
        _ => pose(chance),
    }
}

fn motion(chance: &mut Chance) -> String {
    let word = chance.of(&["LIN", "LIN", "lin", "PTP", "CIRC", "SLIN", "SCIRC", "SPTP"]);
    let via = match word {
        "CIRC" | "SCIRC" => end(chance) + chance.of(&[",", ", "]),
        _ => String::new(),
    };
    let rest = chance.of(&["", " C_DIS", " c_vel ; part", " ; groove"]);
    let text = format!("{word} {via}{}{rest}\n", end(chance));
    match (word, chance.below(4)) {
        ("LIN", 0) => {
            let point = chance.of(&["P1", "P2"]);
            format!(
                ";FOLD LIN {point} Vel=0.5 m/s CPDAT1 Tool[1] Base[2];%{{PE}}%P 1:LIN, 2:{point}\n$BWDSTART=FALSE\nLDAT_ACT=LCPDAT1\n\
                 FDAT_ACT=F{point}\nBAS(#CP_PARAMS,0.5)\nLIN X{point} C_DIS\n;ENDFOLD\n"
            )
        }
        _ => text,
    }
}

fn statements(chance: &mut Chance, depth: usize) -> String {
    let mut text = String::new();
    for _ in 0..chance.below(7) {
        text += &match chance.below(13) {
            0 if depth < 3 => format!(
                "IF $IN[1] THEN\n{}ELSE\n{}ENDIF\n",
                statements(chance, depth + 1),
                statements(chance, depth + 1)
            ),
            1 if depth < 3 => format!("FOR i = 1 TO 3\n{}ENDFOR\n", statements(chance, depth + 1)),
            2 if depth < 3 => format!("REPEAT\n{}UNTIL TRUE\n", statements(chance, depth + 1)),
            3 => "$OUT[1]=TRUE\nWAIT SEC 0.5\n".to_owned(),
            4 => "sub()\n".to_owned(),
            5 => format!("  $VEL.CP={}\n", chance.of(&["0.02", "1", "20/1000.0"])),
            6 => format!(
                "$BASE={}\n",
                chance.of(&["BASE_DATA[2]", "$NULLFRAME", "{X 1,Y 2,Z 3,A 0,B 0,C 0}"])
            ),
            7 => format!(
                "$TOOL=TOOL_DATA[{}]\n$APO.CDIS=0.5\n",
                chance.of(&["0", "1"])
            ),
            _ => motion(chance),
        };
    }
    text
}

/// A program and its data list that are understood.
pub fn module(chance: &mut Chance) -> [String; 2] {
    let mut source = String::from("&ACCESS RVP\n");
    for (name, depth) in [("part", 0), ("sub", 2)] {
        source += &format!("DEF {name}()\nINT i\n{}END\n", statements(chance, depth));
    }
    let mut data = String::from("&ACCESS RVP\nDEFDAT part\n");
    for name in ["XP1", "XP2", "XP_3"] {
        let declared = chance.of(&["DECL", "DECL GLOBAL", "GLOBAL"]);
        data += &format!("  {declared} E6POS {name}={}\n", pose(chance));
    }
    data += "DECL FDAT FP1={TOOL_NO 1,BASE_NO 2,IPO_FRAME #BASE,POINT2[] \" \"}\nDECL FDAT FP2={TOOL_NO 1,BASE_NO 2}\n";
    data += "DECL LDAT LCPDAT1={VEL 2,ACC 100,APO_DIST 3.5}\n";
    data += &format!(
        "POS XG={},XH={}\nDECL FRAME way[2]\n",
        pose(chance),
        pose(chance)
    );
    data += &format!("way[1]={}\n  way[2]={}\nENDDAT", pose(chance), pose(chance));
    match chance.below(3) {
        0 => [source.replace('\n', "\r\n"), data.replace('\n', "\r\n")],
        _ => [source, data],
    }
}

/// Bytes of a text, some of them lost, doubled or changed.
pub fn broken(chance: &mut Chance, text: &str) -> Vec<u8> {
    let mut bytes = text.as_bytes().to_vec();
    for _ in 0..chance.below(4) {
        if bytes.is_empty() {
            break;
        }
        let at = chance.below(bytes.len());
        let end = (at + chance.below(40)).min(bytes.len());
        match chance.below(5) {
            0 => drop(bytes.drain(at..end)),
            1 => {
                let copy = bytes[at..end].to_vec();
                let to = chance.below(bytes.len());
                bytes.splice(to..to, copy);
            }
            2 => {
                let symbols = b";,:[](){}'\"!%=\n+-.E9\xffA &$#";
                bytes[at] = symbols[chance.below(symbols.len())];
            }
            3 => {
                let words = [
                    "\nEND\n",
                    "\nIF ",
                    " THEN\n",
                    "\nENDIF\n",
                    "DEF x()\n",
                    "CASE 1\n",
                    "LIN ",
                    "DECL POS ",
                    "=",
                    "\n;FOLD ",
                    "\n;ENDFOLD",
                    "\nGOTO a\na:\n",
                    " CA 30",
                    " C_DIS ",
                    "WITH $VEL.CP=0.1,",
                ];
                bytes.splice(at..at, chance.of(&words).bytes());
            }
            _ => bytes.truncate(at.max(1)),
        }
    }
    bytes
}

/// The program that bytes are.
pub fn read_bytes(files: &[Vec<u8>; 2]) -> Result<RobotProgram, Vec<ProgramError>> {
    let [source, data] = files.clone();
    read_krl(
        vec![
            SourceFile::new("part.src", source),
            SourceFile::new("part.dat", data),
        ],
        &ReadOptions::default(),
    )
}

/// Corrections by chance for the motions of a program.
pub fn corrections(chance: &mut Chance, program: &RobotProgram) -> Vec<Piece> {
    let mut pieces = Vec::new();
    for (index, motion) in program.motions.iter().enumerate() {
        let Some(end) = motion.target.pose().filter(|_| chance.below(3) > 0) else {
            continue;
        };
        let mut shift = || Vector3::new(chance.within(0.5), chance.within(0.5), chance.within(0.5));
        let mut piece = Piece::to(index, end.position_mm + shift());
        if let MotionKind::Circular { via } = &motion.kind {
            piece.via_mm = via.pose().map(|via| via.position_mm + shift());
        }
        if chance.below(2) == 0 {
            let turn = UnitQuaternion::from_euler_angles(
                chance.within(1e-2),
                chance.within(1e-2),
                chance.within(1e-2),
            );
            piece.orientation = Some(turn * end.orientation);
        }
        if chance.below(4) == 0 && motion.speed.mm_per_s.is_some() {
            piece.speed_factor = 1.0 + chance.within(0.1);
        }
        pieces.push(piece);
    }
    pieces
}

/// What is wrong with the writing of a program, if anything: the farthest place in mm and the largest turn in rad.
pub fn write_and_read(program: &RobotProgram, pieces: &[Piece]) -> Result<(f64, f64), String> {
    let files =
        write(program, pieces, &WriteOptions::default()).map_err(|error| error.to_string())?;
    let again = read_bytes(&[files[0].1.clone(), files[1].1.clone()])
        .map_err(|errors| format!("read again: {}", errors[0]))?;
    if again.motions.len() != program.motions.len() {
        return Err("another number of motions".to_owned());
    }
    let (mut place, mut turn) = (Worst::new(), Worst::new());
    let mut compare = |found: &PoseTarget, to: Vector3<f64>, orientation: UnitQuaternion<f64>| {
        place.add((found.position_mm - to).norm());
        turn.add(found.orientation.angle_to(&orientation));
    };
    for (index, (before, after)) in program.motions.iter().zip(&again.motions).enumerate() {
        let (Some(old), Some(new)) = (before.target.pose(), after.target.pose()) else {
            continue;
        };
        let piece = pieces.iter().find(|piece| piece.motion == index);
        let to = piece.map_or(old.position_mm, |piece| piece.position_mm);
        compare(
            new,
            to,
            piece
                .and_then(|piece| piece.orientation)
                .unwrap_or(old.orientation),
        );
        if let (MotionKind::Circular { via: old }, MotionKind::Circular { via: new }) =
            (&before.kind, &after.kind)
            && let (Some(old), Some(new)) = (old.pose(), new.pose())
        {
            let to = piece
                .and_then(|piece| piece.via_mm)
                .unwrap_or(old.position_mm);
            compare(new, to, old.orientation);
        }
        let speed =
            before.speed.mm_per_s.unwrap_or(0.0) * piece.map_or(1.0, |piece| piece.speed_factor);
        // A speed that is stated and restored in a loop is not that of every way any more, as far as the reader looks.
        let stated = pieces.iter().any(|piece| piece.speed_factor != 1.0);
        // And one that was known by two ways with different words may be known with the words of the restored one.
        let open = stated && (after.speed.mm_per_s.is_none() || before.speed.mm_per_s.is_none());
        if !open && (after.speed.mm_per_s.unwrap_or(0.0) - speed).abs() > 1e-4 {
            return Err(format!("motion {index}: another speed"));
        }
        if (before.zone, &before.tool, &before.work_object, before.runs)
            != (after.zone, &after.tool, &after.work_object, after.runs)
        {
            return Err(format!("motion {index}: another zone, tool or work object"));
        }
    }
    let largest = |worst: &Worst| worst.measured().unwrap_or(0.0);
    Ok((largest(&place), largest(&turn)))
}

/// One case of the fuzz: whether it was read.
pub fn check(seed: u64) -> Result<bool, String> {
    let mut chance = Chance::new(seed);
    let [source, data] = module(&mut chance);
    let bytes = [broken(&mut chance, &source), broken(&mut chance, &data)];
    let at = |what: String| format!("case {seed}: {what}");
    let program = match read_bytes(&bytes) {
        Ok(program) => program,
        Err(errors) => {
            let fits = |error: &ProgramError| {
                let of = &bytes[usize::from(error.file == "part.dat")];
                let lines = of.iter().filter(|byte| **byte == b'\n').count() + 1;
                (1..=lines).contains(&error.line) && error.span.end <= of.len()
            };
            return match !errors.is_empty() && errors.iter().all(fits) {
                true => Ok(false),
                false => Err(at("an error has no place".to_owned())),
            };
        }
    };
    let same =
        write(&program, &[], &WriteOptions::default()).map_err(|error| at(error.to_string()))?;
    if same
        .iter()
        .zip(&bytes)
        .any(|((_, written), given)| written != given)
    {
        return Err(at("bytes changed without pieces".to_owned()));
    }
    let pieces = corrections(&mut chance, &program);
    // Ends that leave something open go with the motion before, which is said.
    if program
        .findings
        .iter()
        .any(|finding| finding.message.contains("states only some of"))
    {
        return Ok(true);
    }
    let said = [
        "states only some of",
        "states no orientation",
        "a piece has no finite place",
        "its speed cannot be changed",
    ];
    let (place, turn) = match write_and_read(&program, &pieces) {
        Err(what) if said.iter().any(|reason| what.contains(reason)) => return Ok(true),
        found => found.map_err(at)?,
    };
    match place <= PLACE_MM && turn <= TURN_RAD {
        true => Ok(true),
        false => Err(at(format!("{place} mm and {turn} rad away"))),
    }
}

/// Half of the third decimal along each axis, in the axes of a tool anywhere: times the root of three.
pub const PLACE_MM: f64 = 0.866e-3 + 1e-6;

/// Half of the fifth decimal of a degree about each of three axes, which may add up.
pub const TURN_RAD: f64 = 3.0e-7;
