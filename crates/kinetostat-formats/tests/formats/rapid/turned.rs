//! Corrections that turn the tool where it does not turn evenly: refused by line, or written so that it does, and read again.

use kinetostat_formats::*;
use kinetostat_program::{
    Correction, CorrectionField, FieldFailure, Request, WriteOptions as PathWriteOptions,
};
use nalgebra::{UnitQuaternion, Vector3};

use crate::correcting::written_and_checked;

/// Shifts by little, and turns the tool by what grows with x.
struct Turning {
    rad_per_mm: f64,
}

impl CorrectionField for Turning {
    fn corrections(&self, requests: &[Request]) -> Vec<Result<Correction, FieldFailure>> {
        let at = |request: &Request| {
            let x = request.position_mm.x;
            Ok(Correction {
                shift_mm: Vector3::new(0.0, 1e-3 * x, 0.02),
                turn: Vector3::new(0.0, self.rad_per_mm * x, 0.0),
            })
        };
        requests.iter().map(at).collect()
    }
}

const TURNING: Turning = Turning { rad_per_mm: 1e-5 };
const SHIFTING: Turning = Turning { rad_per_mm: 0.0 };

fn target(x: f64, y: f64) -> String {
    format!("[[{x},{y},3],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]")
}

/// A line from 0 to 60, behind it a half circle from 60 to 100, and a line back, with statements between them.
fn text(before: &str, between: &str, behind: &str) -> String {
    let [a, b, via, c, d] = [
        target(0.0, 7.0),
        target(60.0, 7.0),
        target(80.0, 27.0),
        target(100.0, 7.0),
        target(100.0, 50.0),
    ];
    format!(
        "MODULE M\nPROC main()\nMoveJ {a},v500,fine,tool0;\n{before}\nMoveL {b},v20,fine,tool0;\n{between}\n\
         MoveC {via},{c},v20,fine,tool0;\n{behind}\nMoveL {d},v20,fine,tool0;\nENDPROC\nENDMODULE\n"
    )
}

/// What is written of a RAPID module, read again by the reader that a user has; or why it is not.
fn corrected(text: &str, field: &Turning) -> Result<String, String> {
    let (reading, making) = (ReadOptions::default(), PathOptions::default());
    let read = |text: &str| {
        let program = read_rapid(vec![SourceFile::new("m.mod", text)], &reading).unwrap();
        let path = path_of(&program, &making).unwrap();
        (program, path)
    };
    let (program, path) = read(text);
    let mut writing = PathWriteOptions::default();
    writing.header = None;
    let written = written_and_checked((&program, &path), (&reading, &making), field, &writing)?;
    let output = String::from_utf8(written.bytes.clone()).unwrap();
    let (_, again) = read(&output);
    // Where each piece ends the tool stands as the field wants it there.
    assert_eq!(again.path.moves.len(), written.pieces.len());
    for (made, piece) in again.path.moves.iter().zip(&written.pieces) {
        let own = &path.path.moves[piece.move_index];
        let wanted = own.point(piece.share_to);
        let turn = UnitQuaternion::from_scaled_axis(Vector3::y() * (field.rad_per_mm * wanted.x));
        let stands = turn * own.orientation(piece.share_to).unwrap();
        assert!(made.orientation(1.0).unwrap().angle_to(&stands) < 1e-6);
        let shifted = wanted + Vector3::new(0.0, 1e-3 * wanted.x, 0.02);
        assert!((made.end - shifted).norm() < 1e-3);
    }
    Ok(output)
}

#[test]
fn corrections_that_turn_the_tool_are_refused_where_the_wrist_turns_evenly() {
    for mode in ["SingArea\\Wrist;", "SingArea\\LockAxis4;"] {
        let line = text(mode, "SingArea\\Off;CirPathMode\\ObjectFrame;", "");
        let error = corrected(&line, &TURNING).unwrap_err();
        assert!(error.starts_with("line 5: the correction turns the tool by 0.0344 deg on its way, and the joints of the wrist turn evenly (SingArea\\Wrist"), "{error}");
        assert!(
            error.contains("write SingArea\\Off")
                && error.ends_with("or correct the position alone"),
            "{error}"
        );
        // The place alone is corrected, and what is written is read again.
        assert!(corrected(&line, &SHIFTING).is_ok());
    }
    // Circles, too: another statement would not help them.
    let all = text(
        "CirPathMode\\ObjectFrame;SingArea\\Wrist;",
        "",
        "SingArea\\Off;",
    );
    let error = corrected(&all, &TURNING).unwrap_err();
    assert!(error.contains("(so it is on lines 5, 7)"), "{error}");
    let circle = text("", "SingArea\\Wrist;", "SingArea\\Off;");
    let error = corrected(&circle, &TURNING).unwrap_err();
    assert!(
        error.starts_with("line 7: the correction turns the tool"),
        "{error}"
    );
    // Along y this correction does not turn: the last line is written.
    let last = text("", "CirPathMode\\ObjectFrame;", "SingArea\\Wrist;");
    assert!(corrected(&last, &TURNING).is_ok());
}

#[test]
fn circles_state_their_frame_where_nothing_else_depends_on_it() {
    let output = corrected(&text("", "", ""), &TURNING).unwrap();
    assert!(
        output.contains("CirPathMode\\ObjectFrame;\nMoveC"),
        "{output}"
    );
    assert!(
        !corrected(&text("", "", ""), &SHIFTING)
            .unwrap()
            .contains("CirPathMode")
    );
    // Circles of what the run computes would turn otherwise behind it; what has a name is taken not to move the tool.
    assert!(corrected(&text("", "", "ownGrinding;"), &TURNING).is_ok());
    let called = text("", "", "%\"own\"%;");
    let error = corrected(&called, &TURNING).unwrap_err();
    assert!(
        error.starts_with("line 7: ")
            && error.contains("circles of what line 8 calls, which is computed"),
        "{error}"
    );
    assert!(corrected(&called, &SHIFTING).is_ok());
    let stated = text("CirPathMode\\ObjectFrame;", "", "%\"own\"%;");
    assert!(corrected(&stated, &TURNING).is_ok());
}

/// A TP program: `Wjnt` is an option of one motion.
#[test]
fn corrections_of_tp_motions_with_wjnt_turn_nothing() {
    let point = |number: usize, x: f64| {
        format!(
            "P[{number}]{{\n   GP1:\n\tUF : 1, UT : 1,\t\tCONFIG : 'N U T, 0, 0, 0',\n\tX =  {x:.3} mm,\tY =  7.000 mm,\tZ =  3.000 mm,\n\tW =  180.000 deg,\tP =  0.000 deg,\tR =  0.000 deg\n}};\n"
        )
    };
    let program = |option: &str| {
        format!(
            "/PROG A\n/MN\n   1:  UFRAME_NUM=1 ;\n   2:  UTOOL_NUM=1 ;\n   3:J P[1] 50% FINE ;\n   4:L P[2] 20mm/sec FINE{option} ;\n/POS\n{}{}/END\n",
            point(1, 0.0),
            point(2, 60.0)
        )
    };
    let (reading, making) = (crate::real_files::stated(), PathOptions::default());
    let written = |text: &str, field: &Turning| {
        let files = |text: &str| vec![SourceFile::new("a.ls", text)];
        let program = read_ls(files(text), &reading).unwrap();
        let path = path_of(&program, &making).unwrap();
        let mut writing = PathWriteOptions::default();
        writing.header = None;
        let written = written_and_checked((&program, &path), (&reading, &making), field, &writing)?;
        let output = String::from_utf8(written.bytes.clone()).unwrap();
        let again = read_ls(files(&output), &reading).unwrap();
        path_of(&again, &making).unwrap();
        Ok::<_, String>(output)
    };
    let error = written(&program(" Wjnt"), &TURNING).unwrap_err();
    assert!(error.starts_with("line 6: the correction turns the tool by 0.0344 deg on its way, and the joints of the wrist turn evenly (Wjnt)"), "{error}");
    assert!(
        written(&program(" Wjnt"), &SHIFTING)
            .unwrap()
            .contains("Wjnt")
    );
    assert!(written(&program(""), &TURNING).is_ok());
}
