//! Writes pictures of lobes and of a receptance into a directory: `cargo run -p kinetostat-report --example vibration DIR`.

use kinetostat_chatter::{
    Arc, Coefficients, LobeRequest, Milled, MillingCut, Mode, Regeneration, ToolResponse,
};
use kinetostat_report::{DrawnMotion, ReceptanceCurve, lobes_svg, receptance_svg};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let directory = std::env::args().nth(1).unwrap_or_else(|| ".".into());
    let directory = std::path::Path::new(&directory);
    let mode =
        |direction: [f64; 3], frequency| Mode::along(direction.into(), 0.03993, frequency, 0.011);
    let tool = ToolResponse::new(vec![mode([1.0, 0.0, 0.0], 922.0)?])?;
    let coefficients = Coefficients::new(6e8, 2e8, 0.0)?;
    for (name, immersion, up_to) in [("half", 0.5, 4e-3), ("low", 0.05, 2e-2)] {
        let cut = MillingCut::new(2, Arc::straight(Milled::Down, immersion)?, coefficients)?
            .with_helix(30_f64.to_radians(), 0.0127)?;
        let machine = Regeneration::new(tool.clone(), cut.into())?;
        let lobes = machine.lobes(&LobeRequest::new(5000.0, 21000.0, 161, up_to).refined(3))?;
        let title = format!("Down milling, a/D = {immersion}, 2 teeth, helix 30 deg");
        std::fs::write(
            directory.join(format!("lobes-{name}.svg")),
            lobes_svg(&lobes, &title),
        )?;
    }
    let tool = ToolResponse::new(vec![
        mode([1.0, 0.2, 0.0], 922.0)?,
        mode([-0.3, 1.0, 0.0], 1400.0)?,
    ])?;
    let frequencies: Vec<f64> = (0..800)
        .map(|i| 100.0 * 30_f64.powf(f64::from(i) / 799.0))
        .collect();
    let curve = |name: &str, i: usize, j: usize| ReceptanceCurve {
        name: name.into(),
        dashed: i != j,
        frequencies_hz: frequencies.clone(),
        receptance: frequencies
            .iter()
            .map(|f| tool.receptance(*f)[(i, j)])
            .collect(),
    };
    let curves = [
        curve("x by force along x", 0, 0),
        curve("y by force along y", 1, 1),
        curve("y by force along x", 1, 0),
    ];
    std::fs::write(
        directory.join("receptance.svg"),
        receptance_svg(&curves, DrawnMotion::Receptance, "Receptance of the tool"),
    )?;
    Ok(())
}
