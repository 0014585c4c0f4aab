//! A linear motion of a robot that only turns the tool: divided, written, read again, and sampled between its targets with
//! quaternions that are interpolated here.

use kinetostat_formats::*;
use kinetostat_program::{Request, WriteOptions as PathWriteOptions};
use nalgebra::{UnitQuaternion, Vector3};

use crate::correcting::written_and_checked;

const RAPID: &str = "MODULE M\nPROC main()\n\
    MoveJ [[0,0,50],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,z10,tool0;\n\
    MoveL [[10,20,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,fine,tool0;\n\
    MoveL [[10,20,0],[0,0.6,0.8,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,fine,tool0;\n\
    ENDPROC\nENDMODULE\n";

/// A tool that is bent by 0.2 mm in its own axes.
fn bent(orientation: &UnitQuaternion<f64>) -> Vector3<f64> {
    orientation * Vector3::new(0.2, 0.0, 0.05)
}

#[test]
fn a_linear_motion_that_only_turns_is_divided() {
    let reading = ReadOptions::default();
    let making = PathOptions::default();
    let program = read_rapid(vec![SourceFile::new("m.mod", RAPID)], &reading).unwrap();
    let path = path_of(&program, &making).unwrap();
    assert!(path.path.moves[2].turns_in_place());
    // From (0, 1, 0, 0) to (0, 0.6, 0.8, 0): twice the angle between the quaternions.
    let degrees = 2.0 * 0.6_f64.acos().to_degrees();
    assert!((path.path.moves[2].turn_deg() - degrees).abs() < 1e-9);
    let field = |request: &Request| Ok(bent(&request.orientation.unwrap()));
    let mut writing = PathWriteOptions::default();
    writing.header = None;
    writing.tolerance_mm = 0.002;
    let written =
        written_and_checked((&program, &path), (&reading, &making), &field, &writing).unwrap();
    let again = vec![SourceFile::new("m.mod", written.bytes.clone())];
    let again = read_rapid(again, &reading).unwrap();
    let again = path_of(&again, &making).unwrap().path;
    let pieces = &again.moves[2..];
    assert!(pieces.len() > 5, "{}", pieces.len());
    let place = Vector3::new(10.0, 20.0, 0.0);
    let mut worst = 0.0;
    for piece in pieces {
        let turn = piece.tool_turn.as_ref().unwrap();
        for k in 0..=20 {
            let share = f64::from(k) / 20.0;
            let orientation = turn.start.slerp(&turn.end, share);
            let at = piece.start + (piece.end - piece.start) * share;
            let off = (at - place - bent(&orientation)).norm();
            assert!(off.is_finite());
            worst = if off > worst { off } else { worst };
        }
    }
    // The tolerance, and the digits of places and quaternions.
    assert!(worst < 0.002 * 1.1 + 2e-4, "{worst}");
    let end = pieces.last().unwrap().orientation(1.0).unwrap();
    let wanted = UnitQuaternion::new_normalize(nalgebra::Quaternion::new(0.0, 0.6, 0.8, 0.0));
    assert!(end.angle_to(&wanted) < 1e-6);
}
