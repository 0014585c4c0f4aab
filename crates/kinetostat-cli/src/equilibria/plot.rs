//! The shapes of equilibrium as a drawing.

use kinetostat_report::{Plot, PlotLine, PlotMark};
use nalgebra::Vector3;

use crate::equilibria::answer::EquilibriaAnswer;
use kinetostat::number::{larger, smaller};

/// Shapes that are drawn, those of least energy: names of more find no room.
const MOST_DRAWN: usize = 32;

/// The shapes over the two axes of the base in which they differ most.
pub(crate) fn plot(a: &EquilibriaAnswer) -> Plot {
    let outlines = &a.outlines[..a.outlines.len().min(MOST_DRAWN)];
    let left_out = match a.outlines.len() - outlines.len() {
        0 => String::new(),
        more => format!(" ({MOST_DRAWN} of least energy, {more} more)"),
    };
    let points = || outlines.iter().flatten();
    let extent = |k: usize| {
        let (low, high) = points().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), p| {
            (smaller(l, p[k]), larger(h, p[k]))
        });
        high - low
    };
    let mut order = [0, 1, 2];
    order.sort_by(|&i, &j| extent(j).total_cmp(&extent(i)));
    let (mut u, mut v) = (order[0], order[1]);
    if v < u {
        (u, v) = (v, u);
    }
    let axes = ["x", "y", "z"];
    let at = |p: &Vector3<f64>| (1e3 * p[u], 1e3 * p[v]);
    let mut lines = Vec::new();
    let mut marks = Vec::new();
    for (e, outline) in a.equilibria.iter().zip(outlines) {
        lines.push(PlotLine {
            name: format!(
                "{}: {}, {} J",
                e.number,
                if e.stable { "stable" } else { "unstable" },
                a.energy(e, 4)
            ),
            colour: e.number - 1,
            dashed: !e.stable,
            points: outline.iter().map(at).collect(),
        });
        // The number stands where this shape is farthest from all others.
        let farthest = outline
            .iter()
            .map(|p| {
                let away = outlines
                    .iter()
                    .filter(|other| *other != outline)
                    .flat_map(|other| other.iter())
                    .map(|q| (p - q).norm())
                    .fold(f64::INFINITY, smaller);
                (away, p)
            })
            .max_by(|x, y| x.0.total_cmp(&y.0));
        if let Some((_, p)) = farthest {
            marks.push(PlotMark {
                at: at(p),
                name: e.number.to_string(),
                detail: format!(
                    "{}: energy {} J, {}",
                    e.number,
                    a.energy(e, 6),
                    if e.stable { "stable" } else { "unstable" }
                ),
            });
        }
    }
    // Ends shared by all shapes.
    for (name, end) in [
        ("base", outlines.first().and_then(|o| o.first())),
        ("tool", outlines.first().and_then(|o| o.last())),
    ] {
        let shared = |p: &Vector3<f64>| {
            outlines.iter().all(|o| {
                [o.first(), o.last()]
                    .iter()
                    .flatten()
                    .any(|q| (p - **q).norm() < 1e-9)
            })
        };
        if let Some(p) = end.filter(|p| shared(p)) {
            marks.push(PlotMark {
                at: at(p),
                name: name.into(),
                detail: format!("{name} of all shapes"),
            });
        }
    }
    Plot {
        title: format!("{}: shapes of equilibrium{left_out}", a.head.model),
        x_label: format!("{}, mm", axes[u]),
        y_label: format!("{}, mm", axes[v]),
        lines,
        marks,
    }
}
