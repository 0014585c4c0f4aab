//! Time of one mean force, by kind of cut, as `cargo xtask figures` reads it: `cargo run --release -p kinetostat-cutting --example force_speed`.

#![allow(clippy::print_stdout, reason = "a tool for developers")]

use std::hint::black_box;
use std::time::Instant;

use kinetostat_cutting::{
    Engagement, Feed, ForceLaw, Kienzle, Linear, MeanTable, Milling, Rotation, RunOut, Shape, Side,
    Tool,
};
use kinetostat_testing::figure::{at_most, computed_s};

/// Calls between two looks at the clock.
const BATCH: u32 = 1000;
/// Shortest time of all, s: long against the steps in which a system counts time.
const LEAST_S: f64 = 0.2;
/// Largest time of one mean force, us.
const MOST_US: f64 = 5.0;

/// Time of one call, us.
fn time_us(mut call: impl FnMut()) -> f64 {
    let start = Instant::now();
    let (before, mut calls) = (computed_s(start), 0.0);
    loop {
        (0..BATCH).for_each(|_| call());
        calls += f64::from(BATCH);
        let used = computed_s(start) - before;
        if used > LEAST_S {
            return 1e6 * used / calls;
        }
    }
}

fn main() -> kinetostat_cutting::Result<()> {
    let linear = Linear::new([796.0, 168.0, 222.0], [27.7, 30.8, 1.4])?;
    let kienzle = Kienzle::new([780.0, 300.0, 120.0], [0.23, 0.4, 0.3])?;
    let laws: [(&str, &dyn ForceLaw); 2] = [("linear", &linear), ("Kienzle", &kienzle)];
    let out = RunOut {
        offset_mm: 0.02,
        angle: 0.3,
    };
    for (shape, name) in [(Shape::Flat, "flat"), (Shape::Ball, "ball")] {
        for (run_out, with) in [(RunOut::default(), ""), (out, ", run-out")] {
            let tool = Tool::new(shape, 6.0, 4)?
                .with_helix(0.5)?
                .with_run_out(run_out)?;
            for (law_name, law) in laws {
                let engagement = Engagement::straight(3.0, 2.0, 2.5, Side::Right)?;
                let feed = Feed::level(0.05)?;
                let us = time_us(|| {
                    let feed = black_box(feed);
                    black_box(Milling::new(&tool, law, &engagement, feed).mean());
                });
                let table = MeanTable::new(&tool, law, 0.05, Rotation::Clockwise)?;
                let by_table = time_us(|| {
                    black_box(table.mean(black_box(&engagement)));
                });
                let case = format!("mean force, {name}, {law_name}{with}");
                println!("{case}: {us:.2} us by quadrature, {by_table:.3} us by table");
                let faster = if by_table < us { by_table } else { us };
                let name = format!("{case}: by quadrature or table, the faster");
                at_most(&name, faster, MOST_US, "us");
            }
        }
    }
    Ok(())
}
