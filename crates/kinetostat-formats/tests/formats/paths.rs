//! Programs as paths: arcs through three points, corrections of the path written, read again and asked for again in other places.

use std::io::Write as _;

use kinetostat_formats::*;
use kinetostat_program::{
    Correction, CorrectionField, Curve, FieldFailure, NoCorrection, Request, Unwatched,
    WriteOptions as PathWriteOptions, verify_against_field,
};
use nalgebra::{Rotation3, Unit, UnitQuaternion, Vector3};
use proptest::prelude::*;

use crate::correcting::written_and_checked;
use crate::real_files::{programs, stated};

/// Sags and turns the tool by what depends on the place alone.
struct Bending {
    turns: bool,
}

impl CorrectionField for Bending {
    fn corrections(&self, requests: &[Request]) -> Vec<Result<Correction, FieldFailure>> {
        let at = |request: &Request| {
            let p = request.position_mm / 300.0;
            let shift_mm = Vector3::new(p.y.sin(), (p.x + p.z).cos(), (2.0 * p.x).sin()) * 0.2;
            let turn = match (self.turns, request.orientation) {
                (true, Some(_)) => Vector3::new(p.z.cos(), p.x.sin(), -p.y.cos()) * 1e-3,
                _ => Vector3::zeros(),
            };
            Ok(Correction { shift_mm, turn })
        };
        requests.iter().map(at).collect()
    }
}

fn writing() -> PathWriteOptions {
    let mut writing = PathWriteOptions::default();
    writing.tolerance_mm = 0.005;
    writing.chord_tolerance_mm = 0.01;
    writing
}

/// Whether a program is corrected and keeps all promises; why not, where its own words say so.
pub fn corrected(
    language: Language,
    name: &str,
    bytes: &[u8],
    options: &ReadOptions,
) -> Result<usize, String> {
    corrected_files(language, vec![SourceFile::new(name, bytes)], options)
}

/// The same of several files, of which the first has the motions.
pub fn corrected_files(
    language: Language,
    files: Vec<SourceFile>,
    options: &ReadOptions,
) -> Result<usize, String> {
    let (name, bytes) = (files[0].name().to_owned(), files[0].bytes().to_vec());
    let program = read(language, files, options).map_err(|all| all[0].to_string())?;
    let making = PathOptions::default();
    let path = path_of(&program, &making).map_err(|all| all[0].to_string())?;
    let writing = writing();
    let write = |field: &dyn CorrectionField| {
        written_and_checked((&program, &path), (options, &making), field, &writing)
    };
    let same = write(&NoCorrection).unwrap();
    assert!(same.bytes == bytes, "{name}: without a correction");
    for turns in [false, true] {
        let field = Bending { turns };
        let written = write(&field)?;
        if !path.path.moves.is_empty() {
            verify_against_field(&path.path, &written, &field, &writing, &Unwatched)
                .unwrap_or_else(|error| panic!("{name}: {error}"));
        }
    }
    Ok(path.path.moves.len())
}

#[test]
fn fixtures_with_everything_are_corrected_along_their_paths() {
    let text = include_bytes!("fixtures/nx.cls");
    let moves = corrected(Language::Apt, "nx.cls", text, &stated());
    assert!(moves.is_ok(), "{moves:?}");
    // Up to where the tool leans: programs of three axes.
    let text = include_str!("fixtures/everything.mpf");
    let text = format!("{}M30\n", text.split("N310").next().unwrap());
    let moves = corrected(Language::Siemens, "a.mpf", text.as_bytes(), &stated());
    assert!(moves.is_ok(), "{moves:?}");
}

/// Real files that are corrected along their paths with all stated; the others are refused in words.
pub fn real(language: Language, folder: &str, least: usize) {
    let all = programs(folder);
    let (mut done, mut refused) = (Vec::new(), Vec::new());
    for (name, bytes) in &all {
        match corrected(language, name, bytes, &stated()) {
            Ok(moves) if moves > 0 => done.push((name, moves)),
            Ok(_) => refused.push((name, "no motion".to_owned())),
            Err(why) => refused.push((name, why)),
        }
    }
    let _ = writeln!(
        std::io::stderr(),
        "{} of {} {folder} files are corrected along their paths: {done:?}; refused: {refused:#?}",
        done.len(),
        all.len()
    );
    assert!(all.is_empty() || done.len() >= least, "{}", done.len());
}

#[test]
fn real_rapid_programs_are_corrected_along_their_paths() {
    real(Language::Rapid, "rapid", 8);
}

#[test]
fn real_tp_programs_are_corrected_along_their_paths() {
    real(Language::FanucLs, "ls", 8);
}

#[test]
fn real_krl_programs_are_corrected_along_their_paths() {
    real(Language::Krl, "krl", 8);
}

#[test]
fn real_apt_programs_are_corrected_along_their_paths() {
    real(Language::Apt, "apt", 8);
}

#[test]
fn rasters_of_poses_are_corrected_along_their_paths() {
    for (name, bytes, poses, _) in crate::poses::real::files() {
        let moves = corrected(Language::Poses, &name, &bytes, &ReadOptions::default());
        assert_eq!(moves, Ok(poses), "{name}");
    }
    let text = "x_mm,y_mm,z_mm,rx_deg,ry_deg,rz_deg,speed_mm_per_s,rapid\n0,0,20,180,0,0,,1\n0,0,0,180,0,0,20,0\n90,5,0,178,1,20,20,0\n90,50,3,178,-1,40,20,0\n";
    let moves = corrected(
        Language::Poses,
        "a.csv",
        text.as_bytes(),
        &ReadOptions::default(),
    );
    assert_eq!(moves, Ok(4));
}

/// A number with so many decimals.
fn rounded(value: f64, decimals: i32) -> f64 {
    let size = 10_f64.powi(decimals);
    (value * size).round() / size
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// The circle through three of its points is the circle, whichever way it goes and however it lies.
    #[test]
    fn circles_go_through_their_points(
        axis in prop::array::uniform3(-1.0..1.0_f64),
        centre in prop::array::uniform3(-500.0..500.0_f64),
        radius in 1.0..400.0_f64,
        from in 0.0..6.2_f64,
        via in 0.1..0.9_f64,
        sweep in 0.2..6.0_f64,
    ) {
        prop_assume!(Vector3::from(axis).norm() > 0.1);
        let axis = Unit::new_normalize(Vector3::from(axis));
        let across = axis.cross(&Vector3::new(0.3, -0.7, 0.6));
        prop_assume!(across.norm() > 0.1);
        let first = across.normalize() * radius;
        let at = |share: f64| {
            Vector3::from(centre) + Rotation3::from_axis_angle(&axis, from + share * sweep) * first
        };
        let target = |p: Vector3<f64>| {
            let p = p.map(|x| rounded(x, 6));
            format!("[[{},{},{}],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]", p.x, p.y, p.z)
        };
        let text = format!(
            "MODULE M\nPROC main()\nMoveJ {},v500,fine,tool0;\nMoveC {},{},v20,fine,tool0;\nENDPROC\nENDMODULE\n",
            target(at(0.0)), target(at(via)), target(at(1.0))
        );
        let program = read_rapid(vec![SourceFile::new("m.mod", text)], &ReadOptions::default()).unwrap();
        let path = path_of(&program, &PathOptions::default()).unwrap().path;
        let motion = &path.moves[1];
        prop_assert!(matches!(motion.curve, Curve::Arc(_)));
        // Digits of the points count by the sharpness of the triangle.
        let slack = 1e-4 * (1.0 + radius / (sweep * sweep));
        for share in [0.0, 0.2, 0.5, 0.8, 1.0] {
            let off = (motion.point(share) - at(share)).norm();
            prop_assert!(off < slack, "{share}: {off}");
        }
    }

    /// A program that turns its tool from motion to motion is where the field wants it, with its orientation.
    #[test]
    fn random_programs_are_where_the_field_wants_them(
        poses in prop::collection::vec((prop::array::uniform3(-300.0..300.0_f64), prop::array::uniform3(-0.6..0.6_f64)), 2..7),
        turns in any::<bool>(),
    ) {
        let mut text = "MODULE M\nPROC main()\n".to_owned();
        for (k, (at, turn)) in poses.iter().enumerate() {
            let q = UnitQuaternion::from_scaled_axis(Vector3::from(*turn));
            let word = if k == 0 { "MoveJ" } else { "MoveL" };
            text.push_str(&format!(
                "  {word} [[{:.3},{:.3},{:.3}],[{:.9},{:.9},{:.9},{:.9}],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v50,z1,tool0;\n",
                at[0], at[1], at[2], q.w, q.i, q.j, q.k
            ));
        }
        text.push_str("ENDPROC\nENDMODULE\n");
        let options = ReadOptions::default();
        let program = read_rapid(vec![SourceFile::new("m.mod", text)], &options).unwrap();
        let making = PathOptions::default();
        let path = path_of(&program, &making).unwrap();
        let (field, writing) = (Bending { turns }, writing());
        let written = written_and_checked((&program, &path), (&options, &making), &field, &writing).unwrap();
        verify_against_field(&path.path, &written, &field, &writing, &Unwatched).unwrap();
        for (piece, orientation) in written.pieces.iter().zip(&written.orientations) {
            let motion = &path.path.moves[piece.move_index];
            let programmed = motion.orientation(piece.share_to).unwrap();
            let request = Request {
                move_index: piece.move_index,
                share: piece.share_to,
                position_mm: motion.point(piece.share_to),
                tangent: None,
                orientation: Some(programmed),
                turning: None,
            };
            let wanted = field.corrections(&[request])[0].clone().unwrap();
            prop_assert!((piece.commanded_to - motion.point(piece.share_to) - wanted.shift_mm).norm() < 1e-3);
            prop_assert!(orientation.angle_to(&wanted.turned(&programmed)) < 1e-5);
        }
    }
}

#[test]
fn a_first_motion_turns_by_nothing() {
    let text = "x_mm,y_mm,z_mm,rx_deg,ry_deg,rz_deg\n0,0,0,180,0,0\n9,0,0,180,0,0\n";
    let file = SourceFile::new("a.csv", text);
    let program = read_poses(vec![file], &ReadOptions::default()).unwrap();
    let path = path_of(&program, &PathOptions::default()).unwrap().path;
    assert!(!path.moves[0].turns_in_place());
    let says_so = |text: &str| text.contains("turns at one place");
    assert!(
        !path.warnings.iter().any(|warning| says_so(&warning.text)),
        "{:?}",
        path.warnings
    );
}

/// A wrong unit or a mistyped number is named by its line, in every language, before anything is solved.
#[test]
fn places_that_no_machine_reaches_are_refused_by_line() {
    let target = |x: &str| format!("[[{x},0,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]");
    let rapid = format!(
        "MODULE M\nPROC main()\nMoveL {},v20,fine,tool0;\nMoveL {},v20,fine,tool0;\nMoveC {},{},v20,fine,tool0;\nMoveL {},v20,fine,tool0;\nENDPROC\nENDMODULE\n",
        target("1E6"),
        target("9E9"),
        target("-2000000"),
        target("5"),
        target("7"),
    );
    let csv = "x_mm,y_mm,z_mm,qw,qx,qy,qz,speed_mm_per_s\n0,0,0,1,0,0,0,5\n1e300,0,0,1,0,0,0,5\n1,0,0,1,0,0,0,5\n";
    let apt = "UNITS/MM\nFEDRAT/100,MMPM\nGOTO/0,0,0\nGOTO/0,5000000,0\nGOTO/1,0,0\n";
    for (language, name, text, expected) in [
        (Language::Rapid, "m.mod", rapid.as_str(), &[4, 5][..]),
        (Language::Poses, "m.csv", csv, &[3]),
        (Language::Apt, "m.apt", apt, &[4]),
    ] {
        let files = vec![SourceFile::new(name, text)];
        let program = read(language, files, &ReadOptions::default()).unwrap();
        let faults = path_of(&program, &PathOptions::default()).unwrap_err();
        let lines: Vec<usize> = faults.iter().map(|fault| fault.line).collect();
        assert_eq!(lines, expected, "{faults:?}");
        assert!(
            faults
                .iter()
                .all(|fault| fault.reason.contains("farther than any machine"))
        );
    }
}
