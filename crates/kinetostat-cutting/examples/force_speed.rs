//! Time of one mean force, by kind of cut: `cargo run --release -p kinetostat-cutting --example force_speed`.

use std::hint::black_box;
use std::time::Instant;

use kinetostat_cutting::{
    Engagement, Feed, ForceLaw, Kienzle, Linear, MeanTable, Milling, Rotation, RunOut, Shape, Side,
    Tool,
};

const REPEATS: u32 = 200_000;

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
                let start = Instant::now();
                for i in 0..REPEATS {
                    let feed = Feed::level(0.05 + 1e-9 * f64::from(i))?;
                    black_box(Milling::new(&tool, law, &engagement, feed).mean());
                }
                let us = 1e6 * start.elapsed().as_secs_f64() / f64::from(REPEATS);
                let table = MeanTable::new(&tool, law, 0.05, Rotation::Clockwise)?;
                let start = Instant::now();
                for _ in 0..REPEATS {
                    black_box(table.mean(black_box(&engagement)));
                }
                let by_table = 1e6 * start.elapsed().as_secs_f64() / f64::from(REPEATS);
                #[allow(clippy::print_stdout)] // what the example is for
                {
                    println!("{name}, {law_name}{with}: {us:.2} us, by table {by_table:.3} us");
                }
            }
        }
    }
    Ok(())
}
