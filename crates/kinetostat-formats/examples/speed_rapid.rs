//! How many statements a second are read and written: `speed_rapid [STATEMENTS]`, one core.

#![allow(clippy::print_stdout, reason = "a tool for developers")]

use std::error::Error;
use std::time::Instant;

use kinetostat_formats::{Piece, ReadOptions, SourceFile, WriteOptions, read_rapid, write};
use nalgebra::Vector3;

fn main() -> Result<(), Box<dyn Error>> {
    let count: usize = match std::env::args().nth(1) {
        Some(word) => word.parse()?,
        None => 200_000,
    };
    let mut text = String::from("MODULE Long\n");
    let external = "[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]";
    for index in 0..count / 4 {
        text += &format!(
            "CONST robtarget p{index}:=[[{index}.25,0,5],[0,0,1,0],[0,0,0,0],{external}];\n"
        );
    }
    text += "PROC main()\n";
    for index in 0..count {
        text += &match index % 4 {
            0 => format!("  MoveL p{},v20,z1,tool0\\WObj:=wobj0;\n", index / 4),
            1 => "  SetDO doSpindle, 1;\n".to_owned(),
            _ => format!(
                "  MoveL [[{index}.091, -40.594, 15.000],[0.000000, 0.000000, 1.000000, 0.000000],[-1,0,-1,0],{external}],v20,fine,tool0,\\WObj:=wobj0;\n"
            ),
        };
    }
    text += "ENDPROC\nENDMODULE\n";
    println!("{count} statements, {:.1} MB", text.len() as f64 / 1e6);
    let files = vec![SourceFile::new("long.mod", text)];
    let start = Instant::now();
    let program =
        read_rapid(files, &ReadOptions::default()).map_err(|errors| format!("{errors:?}"))?;
    let rate = |start: Instant| count as f64 / start.elapsed().as_secs_f64();
    println!("read: {:.0} statements/s", rate(start));
    let mut pieces = Vec::new();
    for (index, motion) in program.motions.iter().enumerate() {
        if let Some(end) = motion.target.pose() {
            let mut piece = Piece::to(index, end.position_mm + Vector3::new(0.01, 0.02, 0.03));
            piece.orientation = Some(end.orientation);
            pieces.push(piece);
        }
    }
    let start = Instant::now();
    let written = write(&program, &pieces, &WriteOptions::default())?;
    println!(
        "written: {:.0} statements/s, {} bytes",
        rate(start),
        written[0].1.len()
    );
    Ok(())
}
