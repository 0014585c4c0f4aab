//! Motions whose start is corrected and whose end is not: they become longer or shorter, and the part is to be cut as fast as before.

use kinetostat_formats::*;
use kinetostat_program::{Request, WriteOptions as PathWriteOptions};
use nalgebra::Vector3;

use crate::correcting::written_and_checked;

/// Ends of three straight motions: the second one is corrected, the others are not.
const ENDS: [[f64; 2]; 3] = [[0.0, 0.0], [60.0, 40.0], [0.0, 40.0]];

/// By how much.
const SHIFT_MM: [f64; 2] = [1.5, 0.8];

fn joined(of: impl Fn(usize, [f64; 2]) -> String) -> String {
    let ends = ENDS.iter().enumerate();
    ends.map(|(index, end)| of(index + 1, *end)).collect()
}

fn krl() -> String {
    let lines = joined(|_, [x, y]| format!("LIN {{X {x},Y {y},Z 0,A 0,B 0,C 180}}\n"));
    format!(
        "DEF a( )\n$BASE={{X 0,Y 0,Z 0,A 0,B 0,C 0}}\n$TOOL={{X 0,Y 0,Z 150,A 0,B 0,C 0}}\n$VEL.CP=0.02\n{lines}END\n"
    )
}

fn rapid() -> String {
    let lines = joined(|_, [x, y]| {
        format!(
            "MoveL [[{x},{y},0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,fine,tool0;\n"
        )
    });
    format!("MODULE M\nPROC main()\n{lines}ENDPROC\nENDMODULE\n")
}

fn ls() -> String {
    let lines = joined(|number, _| format!("{number:>4}:L P[{number}] 20mm/sec FINE    ;\n"));
    let positions = joined(|number, [x, y]| {
        format!(
            "P[{number}]{{\n   GP1:\n\tUF : 0, UT : 0,\t\tCONFIG : 'N U T, 0, 0, 0',\n\tX = {x:9.3}  mm,\tY = {y:9.3}  mm,\tZ =      .000  mm,\n\tW =   180.000 deg,\tP =      .000 deg,\tR =      .000 deg\n}};\n"
        )
    });
    format!("/PROG A\n/ATTR\n/MN\n{lines}/POS\n{positions}/END\n")
}

fn siemens() -> String {
    let lines = joined(|_, [x, y]| format!("G1 X{x} Y{y}\n"));
    format!("G17 G90 G71 G94 F1200\nG0 X0 Y0 Z0\n{lines}M30\n")
}

fn heidenhain() -> String {
    let lines = joined(|number, [x, y]| format!("{number} L X{x:+} Y{y:+} Z+0 R0 F1200\n"));
    format!("0 BEGIN PGM A MM\n{lines}4 END PGM A MM\n")
}

fn poses() -> String {
    let rows = joined(|_, [x, y]| format!("{x},{y},0,180,0,0,20\n"));
    format!("x_mm,y_mm,z_mm,rx_deg,ry_deg,rz_deg,speed_mm_per_s\n{rows}")
}

#[test]
fn the_feed_along_the_part_is_kept() {
    for (language, name, text) in [
        (Language::Krl, "a.src", krl()),
        (Language::Rapid, "a.mod", rapid()),
        (Language::FanucLs, "a.ls", ls()),
        (Language::Siemens, "a.mpf", siemens()),
        (Language::Heidenhain, "a.h", heidenhain()),
        (Language::Poses, "a.csv", poses()),
    ] {
        let (reading, making) = (ReadOptions::default(), PathOptions::default());
        let program = read(language, vec![SourceFile::new(name, text)], &reading);
        let program = program.unwrap_or_else(|faults| panic!("{name}: {faults:?}"));
        let path = path_of(&program, &making).unwrap();
        // Nothing but near the second end; along the ways there it grows evenly.
        let field = |request: &Request| {
            let [x, y] = [request.position_mm.x, request.position_mm.y];
            let share = (x / 60.0).min(y / 40.0);
            Ok(Vector3::new(SHIFT_MM[0], SHIFT_MM[1], 0.0) * share)
        };
        let mut writing = PathWriteOptions::default();
        writing.header = None;
        let written = written_and_checked((&program, &path), (&reading, &making), &field, &writing);
        let written = written.unwrap_or_else(|error| panic!("{name}: {error}"));
        let files = vec![SourceFile::new(name, written.bytes)];
        let again = read(language, files, &reading).unwrap();
        let last = again.motions.last().unwrap();
        let end = last.target.pose().unwrap().position_mm;
        assert!(
            (end - Vector3::new(0.0, 40.0, 0.0)).norm() < 1e-9,
            "{name}: {end}"
        );
        // Its way by hand: from (61.5, 40.8) to (0, 40).
        let length = (61.5_f64 * 61.5 + 0.8 * 0.8).sqrt();
        let speed = last.speed.mm_per_s.unwrap();
        assert!(
            (speed / 20.0 - length / 60.0).abs() < 1e-4,
            "{name}: {speed}"
        );
    }
}
