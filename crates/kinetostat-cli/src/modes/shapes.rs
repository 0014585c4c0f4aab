//! Mode shapes drawn: each in the two phases in which the machine turns back, over the machine at rest.

use kinetostat::Posture;
use kinetostat_analysis::vibration::VibratingMachine;
use kinetostat_dynamics::{Mode, ModeKind};
use kinetostat_report::{Drawing, Magnified, Moved, Placed};

use crate::place::query::PlaceQuery;
use crate::ui::numbers::number;

/// Most modes of one drawing.
const MOST: usize = 6;
/// Size of a drawn phase, px.
const WIDTH: usize = 560;
const HEIGHT: usize = 470;
/// How far a part may move for its path to be straight, times the natural length.
const SMALL: f64 = 1e-6;

/// The lowest modes below each other; phases 90 and 270 degrees side by side.
pub(crate) fn drawn(
    query: &PlaceQuery,
    posture: &Posture,
    machine: &VibratingMachine,
    modes: usize,
) -> String {
    let list: Vec<(usize, &Mode)> = machine
        .modes
        .modes
        .iter()
        .enumerate()
        .take(modes.min(MOST))
        .collect();
    let (width, height) = (2 * WIDTH, HEIGHT * list.len());
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\">\n"
    );
    for (row, (index, mode)) in list.into_iter().enumerate() {
        for (column, sign) in [1.0, -1.0].into_iter().enumerate() {
            let panel = phase(query, posture, machine, (index, mode), sign);
            let place = format!(
                "<svg x=\"{}\" y=\"{}\" width=\"{WIDTH}\" height=\"{HEIGHT}\"",
                column * WIDTH,
                row * HEIGHT
            );
            out.push_str(&nested(&panel, &place));
            out.push('\n');
        }
    }
    out.push_str("</svg>\n");
    out
}

/// A drawing with other sizes in its first element.
fn nested(svg: &str, head: &str) -> String {
    let Some(begin) = svg.find("<svg") else {
        return String::new();
    };
    let Some(end) = svg[begin..].find('>') else {
        return String::new();
    };
    let (own, rest) = svg[begin..].split_at(end);
    let kept = own["<svg".len()..]
        .split_inclusive('"')
        .collect::<Vec<_>>()
        .chunks(2)
        .filter(|pair| {
            let name = pair[0].trim_start();
            !["width=", "height=", "x=", "y="]
                .iter()
                .any(|start| name.starts_with(start))
        })
        .flat_map(|pair| pair.iter().copied())
        .collect::<String>();
    format!("{head}{kept}{rest}")
}

fn phase(
    query: &PlaceQuery,
    posture: &Posture,
    machine: &VibratingMachine,
    (index, mode): (usize, &Mode),
    sign: f64,
) -> String {
    let most = mode.shape.amax();
    let step = sign * SMALL / if most > 0.0 { most } else { 1.0 };
    let from = Placed::solved(posture, &machine.equilibrium.state);
    let to = Placed::solved(posture, &machine.moved_in(posture, mode, step));
    let mut drawing = Drawing::of(&query.mechanism, from.clone());
    let kind = match mode.kind {
        ModeKind::Free => ", free",
        ModeKind::Unstable => ", UNSTABLE",
        _ => "",
    };
    let degrees = if sign > 0.0 { 90 } else { 270 };
    drawing.title = format!(
        "{}, mode {}: {} Hz{kind}, phase {degrees} deg",
        query.name,
        index + 1,
        number(mode.frequency_hz(), 4)
    );
    drawing.moved = Some(Moved {
        from,
        to,
        magnified: Magnified::Direction,
        name: "moved as in the mode".to_owned(),
    });
    drawing.svg().0
}
