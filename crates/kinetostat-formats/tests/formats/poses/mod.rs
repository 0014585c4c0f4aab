//! Lists of poses: tables and YAML.

mod broken;
mod corrections;
mod joints;
#[cfg(feature = "parquet")]
mod parquet;
pub mod random;
pub mod real;
mod units;
mod zero_change;

use kinetostat_formats::*;

/// A slot with all columns that are understood, and two that are carried.
pub const TABLE: &str = "\
# slot, by hand
note,x_mm,y_mm,z_mm,qw,qx,qy,qz,speed_mm_per_s,rapid,tool,frame,external_1_mm,seen
above,0,0,20,0,0,1,0,,1,tMill,wPart,9E9,\"a, \"\"b\"\"\"
# down
in,0,0,-1,0,0,1,0,20,0,tMill,wPart,9E9,
along, 60.00,0,-1,0,0,1,0,20,0,tMill,wPart,9E9,\"\"
up,60,0,20,0,0,1,0,,1,tMill,wPart,9E9,last
";

/// Two rasters of ROS with keys in any order.
const RASTERS: &str = "\
- header:
    stamp: {sec: 1, nsec: 2}
    frame_id: \"\"
  paths:
    - header:
        frame_id: 0
      poses:
        - position:
            x: 0.1
            z: -0.02
            y: 0.25   # measured
          orientation:
            y: 1
            w: 6.123233995736766e-17
            x: 0
            z: 0
        - orientation: {w: 0, x: 0, y: 1, z: 0}
          position: {z: -0.02, y: 0.30, x: 0.1}
          dwell: 0
    - poses:
        - position:
            x: 0.2
            y: .35
            z: -2e-2
          orientation:
            w: 0
            x: 0
            y: 1
            z: 0
  tool_offset:
    position:
      x: 0
      y: 0
      z: 0
";

fn read_with(
    name: &str,
    text: &[u8],
    options: &ReadOptions,
) -> Result<RobotProgram, Vec<ProgramError>> {
    read_poses(vec![SourceFile::new(name, text)], options)
}

fn program(name: &str, text: &str) -> RobotProgram {
    read_with(name, text.as_bytes(), &ReadOptions::default())
        .unwrap_or_else(|errors| panic!("{errors:#?}"))
}

fn written(program: &RobotProgram, pieces: &[Piece]) -> String {
    let files = write(program, pieces, &WriteOptions::default()).unwrap();
    String::from_utf8(files[0].1.clone()).unwrap()
}

fn place(program: &RobotProgram, motion: usize) -> [f64; 3] {
    let pose = program.motions[motion].target.pose().unwrap();
    pose.position_mm.into()
}
