//! Random programs: pieces of RAPID put together by chance, and broken by chance. Whatever they are, they are read or refused
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

fn target(chance: &mut Chance) -> String {
    let place: Vec<String> = (0..3).map(|_| number(chance, 2000.0)).collect();
    let angles = [0, 1, 2].map(|_| chance.within(3.0));
    let q = UnitQuaternion::from_euler_angles(angles[0], angles[1], angles[2]);
    let comma = chance.of(&[",", ", ", " ,\n  "]);
    let external = chance.of(&["9E9,9E9,9E9,9E9,9E9,9E9", "9E+09,9e9,9E9,9E9,9E9,9E9"]);
    format!(
        "[[{}],[{:.7},{:.7},{:.7},{:.7}],[0,-1,0,1],[{external}]]",
        place.join(comma),
        q.w,
        q.i,
        q.j,
        q.k
    )
}

/// Names of declared targets.
const NAMES: [&str; 6] = ["p1", "p2", "P_3", "row{1}", "row{ 2 }", "inner"];

fn end(chance: &mut Chance) -> String {
    let name = chance.of(&NAMES).to_owned();
    match chance.below(5) {
        0 => name,
        1 => {
            let (x, y, z) = (
                number(chance, 50.0),
                number(chance, 50.0),
                number(chance, 50.0),
            );
            format!("Offs({name},{x}, {y},{z})")
        }
        2 => {
            let (x, z, turn) = (
                number(chance, 50.0),
                number(chance, 50.0),
                number(chance, 180.0),
            );
            match chance.below(2) {
                0 => format!("RelTool({name},{x},0,{z})"),
                _ => format!("RelTool({name},{x},0,{z}\\Ry:={turn})"),
            }
        }
        _ => target(chance),
    }
}

fn motion(chance: &mut Chance) -> String {
    let word = chance.of(&["MoveL", "MoveL", "MOVEL", "MoveJ", "MoveC", "ArcL"]);
    let via = match word {
        "MoveC" => end(chance) + ", ",
        _ => String::new(),
    };
    let speed = chance.of(&["v20", "vCut", "[33.3,500,5000,1000]", "v1000"]);
    let between = match word {
        "ArcL" => "seam1, weld1\\Weave:=w1, ",
        _ => "",
    };
    let rest = chance.of(&[
        "z1, tool0;",
        "fine,tMill\\WObj:=wTable;",
        "z10 , tMill,\\WObj:=wTable ; ! part",
    ]);
    format!("{word} {via}{}, {speed}, {between}{rest}\n", end(chance))
}

fn statements(chance: &mut Chance, depth: usize) -> String {
    let mut text = String::new();
    for _ in 0..chance.below(6) {
        text += &match chance.below(10) {
            0 if depth < 3 => format!(
                "IF di1=1 THEN\n{}ELSE\n{}ENDIF\n",
                statements(chance, depth + 1),
                statements(chance, depth + 1)
            ),
            1 if depth < 3 => format!(
                "FOR i FROM 1 TO 3 DO\n{}ENDFOR\n",
                statements(chance, depth + 1)
            ),
            2 => "Set do1; WaitTime 0.5;\n".to_owned(),
            3 => "part;\n".to_owned(),
            _ => motion(chance),
        };
    }
    text
}

/// A module that is understood.
pub fn module(chance: &mut Chance) -> String {
    let mut text = String::from("MODULE Part\n");
    for name in ["p1", "p2", "P_3"] {
        let change = chance.of(&["CONST", "LOCAL CONST", "PERS"]);
        text += &format!("  {change} robtarget {name}:={};\n", target(chance));
    }
    text += &format!(
        "CONST robtarget row{{2}}:=[{},{}];\n",
        target(chance),
        target(chance)
    );
    text += "CONST speeddata vCut:=[12,500,5000,1000];\n";
    text += "PERS tooldata tMill:=[TRUE,[[0,0,150],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];\n";
    text += "PERS wobjdata wTable:=[FALSE,TRUE,\"\",[[1,2,3],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];\n";
    for (name, depth) in [("main", 0), ("part", 2)] {
        let inner = target(chance);
        text += &format!(
            "PROC {name}()\nCONST robtarget inner:={inner};\n{}ENDPROC\n",
            statements(chance, depth)
        );
    }
    text += "ENDMODULE\n";
    match chance.below(3) {
        0 => text.replace('\n', "\r\n"),
        _ => text,
    }
}

/// Bytes of a text, some of them lost, doubled or changed.
pub fn broken(chance: &mut Chance, text: &str) -> Vec<u8> {
    let mut bytes = text.as_bytes().to_vec();
    for _ in 0..chance.below(6) {
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
                let symbols = b";,:[](){}\\\"!%=\n+-.E9\xffA ";
                bytes[at] = symbols[chance.below(symbols.len())];
            }
            3 => {
                let words = [
                    "ENDPROC",
                    "IF ",
                    " THEN ",
                    "ENDIF",
                    "MODULE",
                    "PROC ",
                    "TEST n CASE 1:",
                    "MoveL ",
                    "VAR num ",
                    ":=",
                    "ERROR ",
                ];
                bytes.splice(at..at, chance.of(&words).bytes());
            }
            _ => bytes.truncate(at.max(1)),
        }
        if bytes.is_empty() {
            break;
        }
    }
    bytes
}

fn read_bytes(bytes: &[u8]) -> Result<RobotProgram, Vec<ProgramError>> {
    read_rapid(
        vec![SourceFile::new("a.mod", bytes)],
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
        let near = |place: Vector3<f64>| place.norm() < 9e5;
        if near(piece.position_mm) && piece.via_mm.is_none_or(near) {
            pieces.push(piece);
        }
    }
    pieces
}

/// What is wrong with the writing of a program, if anything: the farthest place in mm and the largest turn in rad.
pub fn write_and_read(program: &RobotProgram, pieces: &[Piece]) -> Result<(f64, f64), String> {
    let files =
        write(program, pieces, &WriteOptions::default()).map_err(|error| error.to_string())?;
    let again = read_bytes(&files[0].1).map_err(|errors| format!("read again: {}", errors[0]))?;
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
        if (after.speed.mm_per_s.unwrap_or(0.0) - speed).abs() > 1e-4 {
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

/// Straight motions and circles divided: whether what is written again goes through all places, in their order.
pub fn divide_and_read(chance: &mut Chance, program: &RobotProgram) -> Result<(), String> {
    let mut pieces = Vec::new();
    let mut places = Vec::new();
    for (index, motion) in program.motions.iter().enumerate() {
        let Some(end) = motion
            .target
            .pose()
            .filter(|end| end.position_mm.norm() < 9e5)
        else {
            places.push(None);
            continue;
        };
        let divisible = motion.kind != MotionKind::Joint && motion.target.pose().is_some();
        let count = match chance.below(3) {
            0 if divisible => 2 + chance.below(3),
            _ => 0,
        };
        let mut own = Vec::new();
        for step in 1..count {
            own.push(end.position_mm + Vector3::new(chance.within(5.0), step as f64, 0.0));
        }
        own.push(end.position_mm);
        if count > 0 {
            pieces.extend(own.iter().map(|place| Piece::to(index, *place)));
        }
        places.extend(own.into_iter().map(Some));
    }
    let files = match write(program, &pieces, &WriteOptions::default()) {
        Ok(files) => files,
        // What cannot be divided says so.
        Err(WriteError::Motion { .. }) => return Ok(()),
        Err(error) => return Err(error.to_string()),
    };
    let again = read_bytes(&files[0].1).map_err(|errors| format!("divided: {}", errors[0]))?;
    let found: Vec<Option<Vector3<f64>>> = again
        .motions
        .iter()
        .map(|motion| motion.target.pose().map(|pose| pose.position_mm))
        .collect();
    let near = |(found, place): (&Option<Vector3<f64>>, &Option<Vector3<f64>>)| match (found, place)
    {
        (Some(found), Some(place)) => (found - place).norm() <= PLACE_MM,
        (found, place) => place.is_none() || found.is_none(),
    };
    match found.len() == places.len() && found.iter().zip(&places).all(near) {
        true => Ok(()),
        false => Err(format!(
            "divided: {} motions instead of {}, or elsewhere",
            found.len(),
            places.len()
        )),
    }
}

/// One case of the fuzz: whether it was read.
pub fn check(seed: u64) -> Result<bool, String> {
    let mut chance = Chance::new(seed);
    let whole = module(&mut chance);
    let bytes = broken(&mut chance, &whole);
    let at = |what: String| format!("case {seed}: {what}");
    let program = match read_bytes(&bytes) {
        Ok(program) => program,
        Err(errors) => {
            let lines = bytes.iter().filter(|byte| **byte == b'\n').count() + 1;
            let fits = |error: &ProgramError| {
                (1..=lines).contains(&error.line) && error.span.end <= bytes.len()
            };
            return match !errors.is_empty() && errors.iter().all(fits) {
                true => Ok(false),
                false => Err(at("an error has no place".to_owned())),
            };
        }
    };
    let same =
        write(&program, &[], &WriteOptions::default()).map_err(|error| at(error.to_string()))?;
    if same[0].1 != bytes {
        return Err(at("bytes changed without pieces".to_owned()));
    }
    let pieces = corrections(&mut chance, &program);
    let (place, turn) = write_and_read(&program, &pieces).map_err(at)?;
    divide_and_read(&mut chance, &program).map_err(at)?;
    match place <= PLACE_MM && turn <= TURN_RAD {
        true => Ok(true),
        false => Err(at(format!("{place} mm and {turn} rad away"))),
    }
}

/// Half of the third decimal along each axis, in the axes of a tool anywhere: times the root of three.
pub const PLACE_MM: f64 = 0.866e-3 + 1e-6;

/// Half of the seventh decimal in each of four parts, doubled.
pub const TURN_RAD: f64 = 4e-7;
