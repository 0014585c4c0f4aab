//! APT and CLDATA.

mod arcs;
mod broken;
mod corrections;
mod creo;
mod feeds;
mod holes;
pub mod random;
mod zero_change;

use kinetostat_formats::*;

const SOLIDWORKS: &str = include_str!("../fixtures/solidworks.apt");
const NX: &str = include_str!("../fixtures/nx.cls");
const CATIA: &str = include_str!("../fixtures/catia.aptsource");
const OTHER: &str = "PARTNO / TEST\nUNITS / INCH\nFROM / 0, 0, 10\nRAPID\nGOTO / 5, 5, 1\nFEDRAT / 20\nGOTO / 10, 10, 0\nDELAY / 2.5\nFINI\n";

/// The file of Siemens NX.
pub fn nx() -> &'static str {
    NX
}

fn read_with(text: &[u8], options: &ReadOptions) -> Result<RobotProgram, Vec<ProgramError>> {
    read_apt(vec![SourceFile::new("part.apt", text)], options)
}

fn program(text: &str) -> RobotProgram {
    read_with(text.as_bytes(), &ReadOptions::default())
        .unwrap_or_else(|errors| panic!("{errors:#?}"))
}

fn written(program: &RobotProgram, pieces: &[Piece]) -> String {
    let files = write(program, pieces, &WriteOptions::default()).unwrap();
    String::from_utf8(files[0].1.clone()).unwrap()
}

fn place(program: &RobotProgram, motion: usize) -> [f64; 3] {
    program.motions[motion]
        .target
        .pose()
        .unwrap()
        .position_mm
        .into()
}
