//! LN blocks under corrections: divided with their own normals and tool axes, tool axes corrected.

use kinetostat_formats::*;
use kinetostat_program::{
    Correction, CorrectionField, FieldFailure, Request, WriteOptions as PathWriteOptions,
};
use kinetostat_testing::Worst;
use nalgebra::Vector3;

use crate::correcting::written_and_checked;

use super::program;

const BLADE: &str = "0 BEGIN PGM A MM\n1 TOOL CALL 1 Z S100\n2 L X+0 Y+0 Z+50 FMAX M3\n3 M128\n\
    4 LN X+0 Y+0 Z+0 NX+0.0 NY+0.0 NZ+1.0 TX+0.0 TY+0.0 TZ+1.0 F500\n\
    5 LN X+80 Y+0 Z+0 NX-0.6 NY+0.0 NZ+0.8 TX+0.6 TY+0.0 TZ+0.8 M8\n\
    6 L X+100\n7 L Z+80 FMAX M9\n8 M129\n9 END PGM A MM\n";

/// Bent along x; the tool leans, too, where it is asked to.
struct Bent {
    turns: f64,
}

impl CorrectionField for Bent {
    fn corrections(&self, requests: &[Request]) -> Vec<Result<Correction, FieldFailure>> {
        let at = |request: &Request| {
            let x = request.position_mm.x / 100.0;
            Ok(Correction {
                shift_mm: Vector3::new(0.0, 0.0, 0.2 * x * x),
                turn: Vector3::y() * self.turns * x,
            })
        };
        requests.iter().map(at).collect()
    }
}

fn corrected(text: &str, field: &Bent) -> Result<(String, RobotPath), String> {
    let program = program(text);
    let (options, making) = (ReadOptions::default(), PathOptions::default());
    let path = path_of(&program, &making).unwrap();
    let mut writing = PathWriteOptions::default();
    writing.header = None;
    let written = written_and_checked((&program, &path), (&options, &making), field, &writing)?;
    let output = String::from_utf8(written.bytes).unwrap();
    let again = super::program(&output);
    Ok((output, path_of(&again, &making).unwrap()))
}

/// The directions that an LN line states.
fn directions(line: &str) -> Option<[Vector3<f64>; 2]> {
    let value = |name: &str| -> Option<f64> {
        let word = line
            .split_whitespace()
            .find(|word| word.starts_with(name))?;
        word[2..].parse().ok()
    };
    let of = |letter: &str| {
        let part = |axis: &str| value(&format!("{letter}{axis}"));
        Some(Vector3::new(part("X")?, part("Y")?, part("Z")?))
    };
    Some([of("N")?, of("T")?])
}

#[test]
fn an_ln_is_divided_with_normals_and_tool_axes_on_great_circles() {
    let (output, again) = corrected(BLADE, &Bent { turns: 0.0 }).unwrap();
    let lines: Vec<&str> = output
        .lines()
        .filter(|line| line.contains(" LN "))
        .collect();
    assert!(lines.len() > 8, "{output}");
    // In the plane of x and z both are turned by angles in proportion to the way: atan(0.6/0.8) at its end.
    let whole = f64::atan2(0.6, 0.8);
    let mut worst = Worst::new();
    for line in &lines {
        let [normal, tool] = directions(line).unwrap();
        let x: f64 = line
            .split("X+")
            .nth(1)
            .unwrap()
            .split(' ')
            .next()
            .unwrap()
            .parse()
            .unwrap();
        let angle = whole * x / 80.0;
        let (sine, cosine) = angle.sin_cos();
        worst.add((tool - Vector3::new(sine, 0.0, cosine)).norm());
        worst.add((normal - Vector3::new(-sine, 0.0, cosine)).norm());
        assert!((normal.norm() - 1.0).abs() < 1e-6 && (tool.norm() - 1.0).abs() < 1e-6);
    }
    assert!(worst.of(2 * lines.len()) < 2e-7, "{output}");
    // Lines behind keep the direction, in which no word changes.
    assert!(
        output.contains(" L X+100") && !output.contains(" L X+100 T"),
        "{output}"
    );
    assert!(
        (again.path.tool_direction(again.path.moves.len() - 1, 1.0) - Vector3::new(0.6, 0.0, 0.8))
            .norm()
            < 1e-9
    );
    assert_eq!(
        (output.matches("M8").count(), output.matches(" M9").count()),
        (1, 1)
    );
}

#[test]
fn a_load_that_turns_the_tool_is_written_in_tool_axes_and_taken_back() {
    let field = Bent { turns: 1e-3 };
    let (output, again) = corrected(BLADE, &field).unwrap();
    // At x = 80 the tool is turned by 0.8 mrad about y, at 100, on lines that state nothing of themselves, by 1 mrad.
    let whole = f64::atan2(0.6, 0.8);
    let mut worst = Worst::new();
    let mut count = 0;
    for (index, one) in again.path.moves.iter().enumerate().skip(1) {
        let x = one.end.x;
        let angle = whole * (x / 80.0).min(1.0) + 1e-3 * x / 100.0;
        let (sine, cosine) = angle.sin_cos();
        worst.add((again.path.tool_direction(index, 1.0) - Vector3::new(sine, 0.0, cosine)).norm());
        count += 1;
    }
    assert!(count > 8 && worst.of(count) < 1e-6, "{output}");
    assert!(
        output.contains(" LN X+100.0000") || output.contains(" LN X+100"),
        "{output}"
    );
}

#[test]
fn where_no_direction_is_stated_the_reason_is_named() {
    let text = "BEGIN PGM A MM\nL X+0 Y+0 Z+50 FMAX\nL X+80 F100\nEND PGM A MM\n";
    let program = program(text);
    let mut piece = Piece::to(1, Vector3::new(80.0, 0.0, 50.0));
    piece.orientation = Some(nalgebra::UnitQuaternion::from_euler_angles(0.01, 0.0, 0.0));
    let error = write(&program, &[piece], &WriteOptions::default())
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("line 3: no block up to here states a direction of the tool (TX, TY, TZ)"),
        "{error}"
    );
    // An arc behind a direction that is corrected.
    let text = BLADE.replace("6 L X+100\n", "6 CC X+100 Y+0\n7 C X+120 Y+0 DR+\n");
    let error = corrected(&text, &Bent { turns: 1e-3 }).unwrap_err();
    assert!(
        error.contains("line 8: ")
            && error.contains("correct places alone (leave out --correct pose)"),
        "{error}"
    );
}
