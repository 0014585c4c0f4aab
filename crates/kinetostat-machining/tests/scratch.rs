#[path = "../../kinetostat/tests/common/mod.rs"]
mod common;
use common::*;
use kinetostat::*;
use kinetostat_machining::*;
use kinetostat_program as kp;
use nalgebra::vector;

fn run(text: &[u8], load: ProgramLoad, place: Placement) {
    let machine = Orthoglide { line_error: 1f64.to_radians(), ..Default::default() }.build().with_tool(&straight_tool(0.1));
    let program = kp::Program::read(text).unwrap();
    let reading = kp::ReadOptions::default();
    let path = kp::interpret(&program, &reading).unwrap();
    let task = Task { mechanism: &machine, program: &program, reading, path: &path, placement: place, load, writing: Default::default(), question: Default::default() };
    let t = std::time::Instant::now();
    let r = compensate_program(&task, &Unwatched).map_err(|e| println!("{e}")).unwrap();
    println!("{:?}\n{:#?}\n{:?}", t.elapsed(), r.result.summary, r.result.warnings.len());
    println!("{}", String::from_utf8_lossy(&r.written.unwrap().bytes[..600]));
}
#[test]
fn groove() {
    let load = ProgramLoad::new(CuttingLoad::Milling { radial: 215., tangential: -10., axial: -25. });
    run(b"G21 G90 G17\nG0 X25 Y0 Z5\nG1 Z-2 F300\nG3 X25 Y0 I-25 J0 F600\nG0 Z5\nM2\n", load, Placement::at(vector![0.0,0.0,0.1]));
}
#[test]
fn pocket() {
    let b = std::fs::read("../../../shared/data/gcode/tball-pocket.gcode").unwrap();
    let load = ProgramLoad::new(CuttingLoad::Constant { axes: LoadAxes::Base, wrench: Wrench::new(vector![215.,-10.,-25.],vector![0.,0.,0.])});
    run(&b, load, Placement::at(vector![-0.08,0.05,0.1]));
    let load = ProgramLoad::new(CuttingLoad::Milling { radial: 215., tangential: -10., axial: -25. });
    run(&b, load, Placement::at(vector![-0.08,0.05,0.1]));
}
