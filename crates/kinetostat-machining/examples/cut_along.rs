//! Time of the stock and of the forces of a program, the first as `cargo xtask figures` reads it: `cargo run --release -p kinetostat-machining --example cut_along PROGRAM`.

#![allow(clippy::print_stdout)] // what the example is for

use std::sync::Arc;
use std::time::Instant;

use kinetostat_cutting::{Linear, Probe, Rotation, Shape, Stock, StockSettings, Tool};
use kinetostat_machining::{CutQuestion, CuttingTool, EngagementSource, ForceChoice, Unwatched};
use kinetostat_program::{MoveKind, Path, Program, ReadOptions, interpret};
use kinetostat_testing::figure::{at_least, computed_s};
use nalgebra::Vector3;

/// Blocks per second of the stock alone, on one core: where the tool meets it, and what it takes away.
fn stock_alone(
    name: &str,
    path: &Path,
    tool: &Tool,
    mut stock: Stock,
) -> kinetostat_cutting::Result<()> {
    let mut probe = Probe::new(tool);
    let (mut stations, mut met) = (0, 0);
    let start = Instant::now();
    let before = computed_s(start);
    for m in path.moves.iter().filter(|m| m.has_length()) {
        probe.walk(&mut stock, m.start.into(), m.end.into(), |_, engagement| {
            stations += 1;
            met += usize::from(!engagement.is_air());
        })?;
    }
    let rate = path.moves.len() as f64 / (computed_s(start) - before);
    println!("{stations} stations of the stock, {met} in contact");
    let title = format!("stock along {name}, cells of D/20, one core: blocks per second");
    at_least(&title, rate, 1e5, "1/s");
    Ok(())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let file = std::env::args().nth(1).ok_or("which program?")?;
    let ball = std::env::args().nth(2).is_some();
    let name = file.rsplit('/').next().unwrap_or(&file).to_owned();
    let program = Program::read(std::fs::read(&file)?)?;
    let path = interpret(&program, &ReadOptions::default())?;
    let feed = path.moves.iter().filter(|m| m.kind == MoveKind::Feed);
    let (mut low, mut high) = (Vector3::repeat(f64::MAX), Vector3::repeat(f64::MIN));
    for m in feed.clone().filter(|m| m.has_length()) {
        low = low.inf(&m.end);
        high = high.sup(&m.end);
    }
    let shape = if ball { Shape::Ball } else { Shape::Flat };
    let tool = Tool::new(shape, 6.0, 2)?.with_helix(0.5)?;
    let law = Linear::new([796.0, 168.0, 222.0], [27.7, 30.8, 1.4])?;
    let (from, to) = (
        low - Vector3::new(3.0, 3.0, 1.0),
        high + Vector3::new(3.0, 3.0, 0.0),
    );
    let top = if low.z < 0.0 { 0.0 } else { to.z };
    let settings = StockSettings::for_tool(&tool).coarser_if_needed();
    let stock = Stock::block(from.into(), [to.x, to.y, top], &settings)?;
    println!(
        "stock {from:.1} to {to:.1}, {} cells, {:.1} MB",
        stock.cells(),
        1e-6 * stock.memory_bytes() as f64
    );
    stock_alone(&name, &path, &tool, stock.clone())?;
    let question = CutQuestion {
        tools: vec![CuttingTool::new(tool, Arc::new(law))],
        engagement: EngagementSource::Stock(Box::new(stock)),
        choice: ForceChoice::Mean,
        rpm: Some(12_000.0),
        rotation: Some(Rotation::Clockwise),
        spindle: None,
    };
    let start = Instant::now();
    let along = question.along(&path, &Unwatched)?;
    let seconds = start.elapsed().as_secs_f64();
    let stations: usize = (0..path.moves.len()).map(|i| along.stations(i).len()).sum();
    let breaks: usize = (0..path.moves.len()).map(|i| along.breaks(i).len()).sum();
    let largest = along.largest();
    println!(
        "{} moves, {stations} stations, {breaks} breaks: {seconds:.2} s, {:.0} moves/s; largest {:.1} N, moment {:.2} N m",
        path.moves.len(),
        path.moves.len() as f64 / seconds,
        largest.force().norm(),
        largest.moment().norm()
    );
    for finding in &along.findings {
        println!(
            "line {}, {} lines: {:?}: {}",
            finding.line, finding.lines, finding.kind, finding.text
        );
    }
    Ok(())
}
