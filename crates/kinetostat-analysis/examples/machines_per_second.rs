//! How many machines a second: `cargo run --release -p kinetostat-tolerance --example machines_per_second -- [MACHINES] [PLACES]`.
//! For 100 places it prints the figure that `cargo xtask figures --python` reads: how long 1e5 machines take.

use std::time::Instant;

use kinetostat::nalgebra::Vector3;
use kinetostat::{Pose, Wrench};
use kinetostat_analysis::tolerance::{
    Draws, Quantity, UncertainMachine, UncertaintyFile, monte_carlo,
};
use kinetostat_machining::Unwatched;
use kinetostat_model::Model;
use kinetostat_testing::figure;

const SPREAD: &str = r#"
schema = 1
[[uncertain]]
parameter = "chain.leg.q2.length_mm"
normal = 0.02
[[uncertain]]
parameter = "section.foot beam.scale"
normal_percent = 2
[[uncertain]]
parameter = "deviation.leg y.foot arm.rotation_vector_deg.z"
normal = 0.01
"#;

#[expect(clippy::print_stdout, reason = "what it is for")]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut words = std::env::args().skip(1);
    let mut number = |usual: usize| words.next().map_or(Ok(usual), |w| w.parse::<usize>());
    let (machines, places) = (number(10_000)?, number(100)?);
    let model = Model::preset("orthoglide")?;
    let wrench = Wrench::new(Vector3::new(215.0, -10.0, -25.0), Vector3::zeros());
    let file = UncertaintyFile::read(SPREAD, "spread.toml", &model, &wrench)?;
    let at = |i: usize| {
        let [x, y] = [i % 10, i / 10 % 10].map(|k| 0.01 * k as f64 - 0.045);
        Pose::translation(x, y, 0.001 * (i / 100) as f64)
    };
    let poses: Vec<Pose> = (0..places).map(at).collect();
    for (quantities, most) in [
        (&[Quantity::Compensated][..], 60.0),
        (&[Quantity::DeflectionByLoad], 120.0),
        (&Quantity::ALL, 150.0),
    ] {
        let tool = Pose::identity();
        let machine = UncertainMachine::new(&model, &tool, &file, &poses, wrench, quantities)?;
        let draws = Draws::new(machines, 0);
        let begun = Instant::now();
        let found = monte_carlo(&machine, &file.uncertainties, &draws, &Unwatched)?;
        let seconds = begun.elapsed().as_secs_f64();
        let rate = draws.len() as f64 / seconds;
        println!(
            "{quantities:?}: {} machines at {places} places in {seconds:.2} s, {rate:.0} machines/s, {:.0} places/s; {:?}",
            draws.len(),
            rate * places as f64,
            found.failures
        );
        if places == 100 {
            let name =
                format!("tolerances: 1e5 machines of orthoglide at 100 places, {quantities:?}");
            figure::at_most(&name, 1e5 / rate, most, "s");
        }
    }
    Ok(())
}
