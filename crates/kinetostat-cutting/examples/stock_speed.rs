//! Memory of a stock, and its blocks per second: a pocket in small moves of random length. `cargo xtask figures` reads the
//! memory.
//!
//! `cargo run --release -p kinetostat-cutting --example stock_speed`

#![allow(clippy::print_stdout)]

use std::time::Instant;

use kinetostat_cutting::{Probe, Result, Shape, Stock, StockSettings, Tool};
use kinetostat_testing::figure::{at_most, computed_s, peak_memory_mb};

/// A spiral out from the middle of a pocket, `over` mm per turn, with moves of 0.3 to 1 mm.
fn spiral(over: f64, widest: f64, z: f64) -> Vec<[f64; 3]> {
    let mut state = 1_u64;
    let mut random = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut angle = 0.5_f64;
    let mut places = Vec::new();
    while angle * over / std::f64::consts::TAU < widest {
        let radius = angle * over / std::f64::consts::TAU;
        places.push([radius * angle.cos(), radius * angle.sin(), z]);
        angle += (0.3 + 0.7 * random()) / (radius + 0.5);
    }
    places
}

/// A block of 500 mm with a pass across it, in cells of a twentieth of a tool of 6 mm.
fn memory() -> Result<()> {
    let tool = Tool::new(Shape::Flat, 6.0, 2)?;
    let settings = StockSettings::for_tool(&tool);
    let mut stock = Stock::block([0.0; 3], [500.0, 500.0, 20.0], &settings)?;
    Probe::new(&tool).cut(&mut stock, [-9.0, 9.0, 15.0], [509.0, 480.0, 15.0])?;
    let name = "stock of 500 x 500 mm, cells of 0.3 mm";
    let own = 1e-6 * stock.memory_bytes() as f64;
    at_most(&format!("{name}: its own memory"), own, 500.0, "MB");
    if let Some(all) = peak_memory_mb() {
        at_most(&format!("{name}: peak of the program"), all, 500.0, "MB");
    }
    Ok(())
}

fn main() -> Result<()> {
    memory()?;
    let start = Instant::now();
    let shapes = [
        (Shape::Flat, 3.0, 3.0),
        (Shape::Ball, 1.0, 1.0),
        (
            Shape::Bull {
                corner_radius_mm: 1.0,
            },
            3.0,
            2.0,
        ),
    ];
    for (shape, depth, over) in shapes {
        for divisor in [10.0, 20.0, 40.0] {
            let tool = Tool::new(shape, 6.0, 2)?;
            let settings = StockSettings::with_cell_mm(6.0 / divisor)?;
            let mut stock = Stock::block([-110.0, -110.0, 0.0], [110.0, 110.0, 10.0], &settings)?;
            let mut probe = Probe::new(&tool);
            let places = spiral(over, 100.0, 10.0 - depth);
            let mut removing = stock.clone();
            let before = computed_s(start);
            probe.cut_along(&mut removing, &places)?;
            let cut = computed_s(start) - before;
            let (mut stations, mut met) = (0, 0);
            let before = computed_s(start);
            for ends in places.windows(2) {
                probe.walk(&mut stock, ends[0], ends[1], |_, engagement| {
                    stations += 1;
                    met += usize::from(!engagement.is_air());
                })?;
            }
            let both = computed_s(start) - before;
            let blocks = places.len() as f64;
            println!(
                "{shape:?}, {depth} mm deep, {over} mm over, cells of d/{divisor}: {:.0} blocks/s ({:.0} with removal alone), {stations} stations, {met} in contact",
                blocks / both,
                blocks / cut
            );
        }
    }
    Ok(())
}
