//! Time of lobe diagrams of 200 speeds on this thread: `RAYON_NUM_THREADS=1 cargo run --release -p kinetostat-chatter --example lobes_speed`.
#![allow(clippy::print_stdout)] // what was asked for

use std::time::Instant;

use kinetostat_chatter::{Arc, Coefficients, LobeRequest, Milled, MillingCut, Mode, Regeneration, Result, ToolResponse};
use nalgebra::Vector3;

fn main() -> Result<()> {
    let coefficients = Coefficients::new(6e8, 2e8, 0.0)?;
    let one = ToolResponse::new(vec![Mode::along(Vector3::x(), 0.03993, 922.0, 0.011)?])?;
    // Frequencies of a six-axis arm, in directions of no order.
    let arm = [(9.99, 0.4, 0.9), (11.5, 1.0, -0.3), (23.2, 0.5, 0.7), (49.0, -0.8, 0.6), (53.7, 0.6, 0.8), (126.5, 1.0, 0.2)];
    let modes = arm.map(|(hz, x, y)| Mode::with_stiffness(Vector3::new(x, y, 0.1), 3e6, hz, 0.03));
    let arm = ToolResponse::new(modes.into_iter().collect::<Result<Vec<_>>>()?)?;
    let half = Arc::straight(Milled::Up, 0.5)?;
    let cases = [
        ("one mode, slot, straight", one.clone(), MillingCut::new(2, Arc::slot(), coefficients)?, (5000.0, 21000.0), 4e-3),
        ("one mode, half up, helix 30", one, MillingCut::new(2, half, coefficients)?.with_helix(0.52, 0.0127)?, (5000.0, 21000.0), 4e-3),
        ("six modes, half up, straight", arm, MillingCut::new(2, half, coefficients)?, (600.0, 6000.0), 4e-3),
    ];
    for (name, tool, cut, (from, to), up_to) in cases {
        let machine = Regeneration::new(tool, cut.into())?;
        let start = Instant::now();
        let lobes = machine.lobes(&LobeRequest::new(from, to, 200, up_to))?;
        let crossings: usize = lobes.points.iter().map(|p| p.exact.crossings.len()).sum();
        println!("{name}: {:.2} s by the wall, {crossings} crossings", start.elapsed().as_secs_f64());
    }
    Ok(())
}
