//! The free turn of a round tool, chosen for a spindle square to the flange of an arm that mills a long row of lines; with how long that
//! takes.
//!
//! `cargo run --release -p kinetostat-machining --example free_turn`, with `RAYON_NUM_THREADS=1` on one core.

#![allow(clippy::print_stdout, reason = "an example shows its answer")]

use std::error::Error;
use std::f64::consts::{FRAC_PI_2, PI};
use std::time::Instant;

use kinetostat_machining::{Placement, TurnTask, choose_turns, with_turns};
use kinetostat_program::{Program, ReadOptions, interpret};
use nalgebra::{UnitQuaternion, vector};

fn main() -> Result<(), Box<dyn Error>> {
    let square = UnitQuaternion::from_euler_angles(0.0, FRAC_PI_2, 0.0);
    let tool = kinetostat::Pose::from_parts(vector![0.2, 0.0, 0.1].into(), square); // m
    let arm = kinetostat_model::Model::preset("heavy_6r")?.mechanism;
    let arm = arm.with_tool(&tool);
    let mut text = "G21 G90\nG0 X0 Y-300 Z0\nF3000\n".to_owned();
    for row in 0..10 {
        let side = match row % 2 {
            0 => 300,
            _ => -300,
        };
        text.push_str(&format!("G1 Y{side}\nG1 X{}\n", 30 * (row + 1)));
    }
    let program = Program::read(text)?;
    let path = interpret(&program, &ReadOptions::default())?;
    let mut placement = Placement::at(vector![1.2, 0.0, 0.9]); // m
    placement.tool_orientation = UnitQuaternion::from_euler_angles(PI, 0.0, 0.0);
    let task = TurnTask::new(&arm, &path, placement);
    let start = Instant::now();
    let choice = choose_turns(&task)?;
    let seconds = start.elapsed().as_secs_f64();
    let turned = with_turns(&task, &choice)?;
    println!("{}.", choice.description());
    let (turns, postures) = choice.tried;
    let places = turns * choice.stations.len();
    println!(
        "{} stations x {turns} turns, {postures} postures, {} links broken: {seconds:.2} s, {:.0} stations x turns a second.",
        choice.stations.len(),
        choice.broken_links,
        places as f64 / seconds
    );
    println!(
        "{} moves instead of {}.",
        turned.path.moves.len(),
        path.moves.len()
    );
    Ok(())
}
