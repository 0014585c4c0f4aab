//! Rotary axes: how tool and part stand, what is refused, and that corrected programs keep the angles.

use std::sync::Arc;

use kinetostat_program::{
    Carries, Knowledge, Path, Program, ProgramError, ReadOptions, Request, RotaryAxes, RotaryAxis,
    ToolCentrePoint, Unwatched, WriteOptions, interpret, verify_written, write_corrected,
};
use nalgebra::{Point3, UnitQuaternion, Vector3};

fn axis(letter: char, carries: Carries, direction: Vector3<f64>, point: [f64; 3]) -> RotaryAxis {
    RotaryAxis {
        letter,
        carries,
        direction: nalgebra::Unit::new_normalize(direction),
        point_mm: point.into(),
        limits_deg: None,
    }
}

/// A trunnion: a cradle about x, 50 mm below the part's zero, that carries a table about z.
fn trunnion() -> ReadOptions {
    with(vec![
        axis('A', Carries::Part, Vector3::x(), [0.0, 0.0, -50.0]),
        axis('C', Carries::Part, Vector3::z(), [0.0; 3]),
    ])
}

/// A head about z that carries one about x.
fn fork() -> ReadOptions {
    with(vec![
        axis('C', Carries::Tool, Vector3::z(), [0.0; 3]),
        axis('A', Carries::Tool, Vector3::x(), [0.0; 3]),
    ])
}

fn with(axes: Vec<RotaryAxis>) -> ReadOptions {
    let mut options = ReadOptions::default();
    options.rotary = Some(Arc::new(RotaryAxes {
        axes,
        tool_at_zero: UnitQuaternion::identity(),
    }));
    options
}

fn path(text: &str, options: &ReadOptions) -> Path {
    let program = Program::read(text).unwrap();
    interpret(&program, options).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn fault(text: &str, options: &ReadOptions) -> ProgramError {
    let program = Program::read(text).unwrap();
    interpret(&program, options).unwrap_err()
}

const BEGIN: &str = "G21 G90 G94\nG0 X0 Y0 Z50 A0 C0\nG43.4 H1 Z50\n";

#[test]
fn a_fork_head_points_the_tool_where_its_angles_say() {
    let path = path(&format!("{BEGIN}G1 X10 A30 C90 F100\n"), &fork());
    let turn = path.moves.last().unwrap();
    // Rz(90) Rx(30) z: x' = sin 30 after the turn about z, by hand.
    let tilted = path.tool_direction(path.moves.len() - 1, 1.0);
    assert!(
        (tilted - Vector3::new(0.5, 0.0, 0.75_f64.sqrt())).norm() < 1e-12,
        "{tilted}"
    );
    // Half way Rz(45) Rx(15): axes turn evenly, which is not the shorter way of the tool.
    let half = path.tool_direction(path.moves.len() - 1, 0.5);
    let (sine, cosine) = 15.0_f64.to_radians().sin_cos();
    let along = 0.5_f64.sqrt();
    assert!(
        (half - Vector3::new(sine * along, -sine * along, cosine)).norm() < 1e-12,
        "{half}"
    );
    assert!(turn.part_turn(0.5).is_none());
}

#[test]
fn a_trunnion_turns_the_part_and_the_tool_the_other_way_in_it() {
    let path = path(&format!("{BEGIN}G1 X10 A90 C90 F100\n"), &trunnion());
    let index = path.moves.len() - 1;
    let part = path.moves[index].part_turn(1.0).unwrap();
    // C carries x to y, A carries y to z and the origin 50 mm above its axis to -y and down by 50 mm.
    let x = part * Point3::new(1.0, 0.0, 0.0);
    assert!((x - Point3::new(0.0, -50.0, -49.0)).norm() < 1e-12, "{x}");
    let tilted = path.tool_direction(index, 1.0);
    // The spindle is along z of the machine, which is now x of the part.
    assert!((tilted - Vector3::x()).norm() < 1e-12, "{tilted}");
    // A whole turn is one, not none.
    let path = self::path(&format!("{BEGIN}G1 X10 F100\nC360\n"), &trunnion());
    let turned = path.moves.last().unwrap().part_turn(0.25).unwrap();
    assert!((turned.rotation.angle().to_degrees() - 90.0).abs() < 1e-9);
    assert_eq!(path.warnings, []);
}

#[test]
fn increments_of_angles_add_up() {
    let path = path(
        &format!("{BEGIN}G91 G1 A10 X5 F100\nA10 X5\nG90 C-30\n"),
        &fork(),
    );
    let rotary = |index: usize| {
        let turn = path.moves[index].tool_turn.as_ref().unwrap();
        turn.rotary.as_ref().unwrap().angles_deg(1.0)
    };
    let last = path.moves.len() - 1;
    assert_eq!(rotary(last - 1), [0.0, 20.0]);
    assert_eq!(rotary(last), [-30.0, 20.0]);
}

#[test]
fn without_tool_centre_point_control_turned_places_are_those_of_the_machine() {
    let turned = "G21 G90 G94\nG0 X0 Y0 Z50 A0 C0\nG0 A30 C10\nX5 Y5\n";
    let cut = fault(&format!("{turned}G1 X9 F100\n"), &trunnion());
    assert_eq!(cut.line, 5);
    assert!(
        cut.to_string()
            .contains("axis A stands at 30 deg, and tool centre point control is off"),
        "{cut}"
    );
    assert!(cut.remedy.contains("--tool-centre-point"), "{cut}");
    let program = Program::read(turned).unwrap();
    let carried = interpret(&program, &trunnion()).unwrap();
    let warned = carried
        .warnings
        .iter()
        .find(|w| w.text.contains("machine's slides"));
    let warned = warned.unwrap();
    assert!(
        (
            warned.line,
            warned.text.starts_with("line 3 turned a rotary axis")
        ) == (3, true),
        "{warned:?}"
    );
    // Behind it the line that turned the axis is named, and not the last one at an angle.
    let back = fault(&format!("{turned}G0 A0 C0\nG1 X9 F100\n"), &trunnion());
    assert!(
        back.reason.starts_with("line 3 turned a rotary axis"),
        "{back}"
    );
    // With it on all along the same program cuts.
    let mut throughout = trunnion();
    throughout.tool_centre_point = ToolCentrePoint::Throughout;
    assert_eq!(
        path(&format!("{turned}G1 X9 F100\n"), &throughout)
            .moves
            .len(),
        4
    );
    // Turned back, places that are stated count again.
    let back = path(
        &format!("{turned}G0 A0 C0\nG0 X1 Y2 Z30\nG1 X9 F100\n"),
        &trunnion(),
    );
    let known: Vec<Knowledge> = back.moves.iter().map(|motion| motion.known).collect();
    let [first, nothing, whole] = [Knowledge::End, Knowledge::Nothing, Knowledge::Whole];
    assert_eq!(known, [first, nothing, nothing, nothing, first, whole]);
    assert_eq!(back.moves[5].start, Vector3::new(1.0, 2.0, 30.0));
    // Off again, at an angle: where the slides are is not where the tip is.
    let off = fault(
        &format!("{BEGIN}G1 X9 A30 F100\nG49\nG1 X10\n"),
        &trunnion(),
    );
    assert_eq!(off.line, 6, "{off}");
}

#[test]
fn what_cannot_be_followed_is_refused_by_line() {
    for (text, line, expected) in [
        ("G21 G90\nG0 X0 Y0 Z50 B10\n", 2, "axis B changes"),
        (
            "G21 G90\nG0 X0 Y0 Z50\nG43.4 H1 Z40\nG1 X9 F100\n",
            4,
            "where axis A stands is not stated",
        ),
        (
            "G21 G90\nG0 X0 Y0 Z50 A5\nG92 A0\n",
            3,
            "another angle than the machine's",
        ),
    ] {
        let found = fault(text, &trunnion());
        assert_eq!(found.line, line, "{found}");
        assert!(found.to_string().contains(expected), "{found}");
    }
    let none = fault(
        "G21 G90\nG0 X0 Y0 Z50\nG43.4 H1 Z40\n",
        &ReadOptions::default(),
    );
    assert!(none.to_string().contains("[[rotary_axis]]"), "{none}");
}

#[test]
fn corrected_programs_keep_the_angles() {
    let text = format!(
        "{BEGIN}G0 X3 Y4\nG1 Z0 F300\nX80 Y20 A-25 C200\nX0 Y0 Z2 A10\nG91 X9 C-40\nG90 G0 Z50\nM30\n"
    );
    // A correction that changes with the place and with the share of the block, in all three directions.
    let field = |request: &Request| {
        let p = request.position_mm;
        let bend = Vector3::new(p.y * p.y, -p.x * p.y, p.x * p.x) * 2e-5;
        Ok(bend + Vector3::new(0.01, 0.02, -0.03) * (request.share - 0.5))
    };
    for options in [fork(), trunnion()] {
        let program = Program::read(text.clone()).unwrap();
        let path = interpret(&program, &options).unwrap();
        let mut writing = WriteOptions::default();
        writing.header = None;
        let written = write_corrected(&program, &path, &field, &writing, &Unwatched).unwrap();
        verify_written(&program, &path, &written, &options, &writing).unwrap();
        let output = String::from_utf8(written.bytes.clone()).unwrap();
        let again = Program::read(output.clone()).unwrap();
        let again = interpret(&again, &options).unwrap_or_else(|error| panic!("{error}\n{output}"));
        // Where a block ends the axes stand as in the program; within it they are shared out evenly.
        let angles = |motion: &kinetostat_program::Move| {
            let turn = motion.tool_turn.as_ref()?;
            Some(turn.rotary.as_ref()?.angles_deg(1.0))
        };
        let mut ends = 0;
        for piece in &written.pieces {
            let source = &path.moves[piece.move_index];
            let Some(turn) = source
                .tool_turn
                .as_ref()
                .and_then(|turn| turn.rotary.as_ref())
            else {
                continue;
            };
            let read = again
                .moves
                .iter()
                .rev()
                .find(|m| m.line == piece.output_line)
                .unwrap();
            if piece.corner_step {
                continue;
            }
            let wanted = turn.angles_deg(piece.share_to);
            let found = angles(read).unwrap();
            for (wanted, found) in wanted.iter().zip(&found) {
                assert!((wanted - found).abs() < 1e-5, "{output}");
            }
            ends += usize::from(piece.share_to == 1.0);
        }
        assert!(ends >= 6, "{ends}\n{output}");
        assert!(written.pieces.len() > 12, "{output}");
    }
}
