//! G43.5: directions of the tool in place of angles, against rotations and great circles computed apart.

use std::sync::Arc;

use kinetostat_program::{
    Carries, Correction, CorrectionField, FieldFailure, Path, Program, ReadOptions, Request,
    RotaryAxes, RotaryAxis, Unwatched, WriteOptions, interpret, verify_written, write_corrected,
};
use nalgebra::{Unit, UnitQuaternion, Vector3};

fn axis(letter: char, carries: Carries, direction: Vector3<f64>) -> RotaryAxis {
    RotaryAxis {
        letter,
        carries,
        direction: Unit::new_normalize(direction),
        point_mm: Vector3::new(2.0, -3.0, -40.0),
        limits_deg: None,
    }
}

fn with(axes: Vec<RotaryAxis>) -> ReadOptions {
    let mut options = ReadOptions::default();
    options.rotary = Some(Arc::new(RotaryAxes {
        axes,
        tool_at_zero: UnitQuaternion::identity(),
    }));
    options
}

/// A head about z that carries one about y; a head about x above a table about z; a cradle about x with a table about z.
fn machines() -> Vec<(&'static str, ReadOptions)> {
    let (head, table) = (Carries::Tool, Carries::Part);
    let (x, y, z) = (Vector3::x(), Vector3::y(), Vector3::z());
    vec![
        ("C0 B20", with(vec![axis('C', head, z), axis('B', head, y)])),
        (
            "A20 C0",
            with(vec![axis('A', head, x), axis('C', table, -z)]),
        ),
        (
            "A20 C0",
            with(vec![axis('A', table, x), axis('C', table, z)]),
        ),
    ]
}

fn path(text: &str, options: &ReadOptions) -> Path {
    let program = Program::read(text).unwrap();
    interpret(&program, options).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// Between two directions, evenly, by sines.
fn between(from: &Vector3<f64>, to: &Vector3<f64>, share: f64) -> Vector3<f64> {
    let angle = from.dot(to).clamp(-1.0, 1.0).acos();
    if angle < 1e-7 {
        return *from;
    }
    (from * ((1.0 - share) * angle).sin() + to * (share * angle).sin()) / angle.sin()
}

fn begun(angles: &str, more: &str) -> String {
    format!("G21 G90 G94\nG0 X0 Y0 Z50 {angles}\nG43.5 H1 X0 Y0 Z50{more}\nG0 I0.1 J0.3 K0.9\n")
}

const CUTS: &str = "G1 Z0 F600\nX40 I0.3 J0.2 K0.8\nX40 Y40 I-0.2 J0.5 K1\nI0.1 J0.4 K0.7 F900\nX0 F600\nG0 Z50\nG49\nM30\n";

#[test]
fn directions_turn_the_tool_evenly_or_on_the_great_circle() {
    for (angles, options) in machines() {
        for (more, circle) in [("", false), (" P0", false), (" P1", true)] {
            let text = format!("{}{CUTS}", begun(angles, more));
            let path = path(&text, &options);
            let stated = [
                (6, Vector3::new(0.3, 0.2, 0.8)),
                (7, Vector3::new(-0.2, 0.5, 1.0)),
                (8, Vector3::new(0.1, 0.4, 0.7)),
                (9, Vector3::new(0.1, 0.4, 0.7)),
            ];
            let mut from = Vector3::new(0.1, 0.3, 0.9).normalize();
            let mut seen = 0;
            for (line, to) in stated {
                let index = path.moves.iter().position(|m| m.line == line).unwrap();
                let to = to.normalize();
                let turn = path.moves[index].tool_turn.as_ref().unwrap();
                let rotary = turn.rotary.as_ref().unwrap();
                for part in [0.0, 0.2, 0.5, 0.8, 1.0] {
                    let is = path.tool_direction(index, part);
                    let wanted = match circle {
                        true => between(&from, &to, part),
                        // The mean of the angles at both ends, turned one axis after the other.
                        false => {
                            let both = rotary.start_deg.iter().zip(&rotary.end_deg);
                            let mean: Vec<f64> = both.map(|(a, b)| a + (b - a) * part).collect();
                            rotary.axes.tool(&mean) * Vector3::z()
                        }
                    };
                    assert!(
                        (is - wanted).norm() < 1e-9,
                        "{angles}{more} {line} {part}: {is} {wanted}"
                    );
                    seen += 1;
                }
                assert!((path.tool_direction(index, 1.0) - to).norm() < 1e-9);
                from = to;
            }
            assert_eq!(seen, 20);
        }
    }
}

/// Sags with the place, and turns the tool if wanted.
struct Bending(f64);

impl CorrectionField for Bending {
    fn corrections(&self, requests: &[Request]) -> Vec<Result<Correction, FieldFailure>> {
        let at = |request: &Request| {
            let p = request.position_mm / 30.0;
            let shift_mm = Vector3::new(p.y * p.y, -p.x * p.y, p.x * p.x + request.share) * 0.02;
            let turn = Vector3::new(p.x.cos(), p.y.sin(), 0.0) * self.0;
            Ok(Correction { shift_mm, turn })
        };
        requests.iter().map(at).collect()
    }
}

#[test]
fn corrected_programs_keep_the_way_of_the_tool() {
    for (angles, options) in machines() {
        for (more, tilt) in [("", 0.0), (" P1", 0.0), ("", 1e-3), (" P1", 1e-3)] {
            let text = format!("{}{CUTS}", begun(angles, more));
            let program = Program::read(text.clone()).unwrap();
            let path = interpret(&program, &options).unwrap();
            let mut writing = WriteOptions::default();
            writing.header = None;
            writing.tolerance_mm = 0.002;
            let written = write_corrected(&program, &path, &Bending(tilt), &writing, &Unwatched)
                .unwrap_or_else(|error| panic!("{angles}{more}: {error}"));
            verify_written(&program, &path, &written, &options, &writing)
                .unwrap_or_else(|error| panic!("{angles}{more}: {error}"));
            let output = String::from_utf8(written.bytes.clone()).unwrap();
            let again = self::path(&output, &options);
            let mut checked = 0;
            for piece in &written.pieces {
                let motion = &path.moves[piece.move_index];
                let read = again
                    .moves
                    .iter()
                    .position(|m| m.line == piece.output_line)
                    .unwrap();
                if motion.line < 6 || motion.line > 9 {
                    continue;
                }
                for part in [0.1, 0.5, 0.9, 1.0] {
                    let share = piece.share_from + part * (piece.share_to - piece.share_from);
                    let wanted = path.tool_direction(piece.move_index, share);
                    let off = (again.tool_direction(read, part) - wanted).norm();
                    // The field turns by up to the square root of two times the tilt.
                    assert!(off < 1e-7 + 1.6 * tilt, "{angles}{more}: {off}\n{output}");
                    checked += 1;
                }
            }
            assert!(checked > 40, "{checked}\n{output}");
            // Before G49 the tool stands as the program has it.
            let last = path.moves.len() - 1;
            let away =
                again.tool_direction(again.moves.len() - 1, 1.0) - path.tool_direction(last, 1.0);
            assert!(away.norm() < 1e-7, "{output}");
        }
    }
}

#[test]
fn without_a_correction_the_program_stays() {
    let (angles, options) = machines().remove(0);
    let text = format!("{}{CUTS}", begun(angles, " P1"));
    let program = Program::read(text.clone()).unwrap();
    let path = interpret(&program, &options).unwrap();
    let field = |_: &Request| Ok(Vector3::zeros());
    let written = write_corrected(
        &program,
        &path,
        &field,
        &WriteOptions::default(),
        &Unwatched,
    )
    .unwrap();
    assert_eq!(String::from_utf8(written.bytes).unwrap(), text);
}
