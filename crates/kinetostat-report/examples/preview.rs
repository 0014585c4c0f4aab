//! Draws the picture of the README from a run's `result.json`:
//! `cargo run -p kinetostat-report --example preview -- kinetostat-demo/result.json docs/preview.svg`

use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let mut words = std::env::args().skip(1);
    let (Some(from), Some(to)) = (words.next(), words.next()) else {
        return Err("give the result's JSON file and the SVG file to write".into());
    };
    let result = serde_json::from_str(&std::fs::read_to_string(from)?)?;
    std::fs::write(to, kinetostat_report::plot_preview_svg(&result))?;
    Ok(())
}
