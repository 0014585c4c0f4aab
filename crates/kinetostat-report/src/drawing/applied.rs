//! Arrows of the force and the moment on the tool.
//!
//! A force is an arrow along it, a moment one with two heads along its axis (right-hand screw). An
//! arrow starts or ends at the tool, on the side where less is in its way: a force may be moved along
//! its line of action. What points to the eye or away from it is a ring with a point or a cross.

use kinetostat::Wrench;
use nalgebra::Vector3;

use crate::chart::point_names::{Beside, Names};
use crate::drawing::symbol::{self, Point};
use crate::number;
use crate::svg::Pixel;
use crate::svg::Svg;

/// Length of an arrow that lies on the drawing, and the least that is drawn, pixels.
const LENGTH: f64 = 66.0;
const SHORTEST: f64 = 40.0;
/// Share of a direction that lies on the drawing, below which it is one to the eye.
const TO_THE_EYE: f64 = 0.15;
/// Gaps between the tool and an arrow: close to it, and beyond the axes of its frame.
const GAPS: [f64; 2] = [7.0, 58.0];
/// Room that the head needs at the edge, pixels.
const HEAD: f64 = 14.0;
const RING: f64 = 8.5;

/// Force or moment on the tool, as it is drawn.
struct Kind {
    class: &'static str,
    heads: usize,
    /// Size, and the component square to the drawing.
    label: String,
}

/// Draws force and moment on the tool at this point of the drawing; `see` projects a direction.
pub(super) fn draw(
    svg: &mut Svg,
    names: &mut Names,
    tool: Pixel,
    wrench: &Wrench,
    see: impl Fn(&Vector3<f64>) -> Point,
) {
    for (vector, class, heads, name, unit) in [
        (wrench.force(), "force", 1, "force", "N"),
        (wrench.moment(), "moment", 2, "moment", "N m"),
    ] {
        let size = vector.norm();
        if size <= 0.0 || !size.is_finite() {
            continue;
        }
        let seen = see(&(vector / size));
        let digit = 10_f64.powf(size.log10().floor() - 3.0);
        let amount = number::with_unit(&number::setting((size / digit).round() * digit), unit);
        let kind = Kind {
            class,
            heads,
            label: format!("{name} {amount}"),
        };
        if seen.xy().norm() < TO_THE_EYE {
            ring(svg, names, tool, &kind, seen.z);
        } else {
            let (from, to) = arrow_at(names, tool, &seen);
            // The line of action, where the arrow is away from the tool.
            let away = |p: Pixel| (p[0] - tool[0]).hypot(p[1] - tool[1]);
            let near = if away(from) < away(to) { from } else { to };
            svg.line("action", tool, near);
            arrow(svg, names, &kind, from, to);
        }
    }
}

/// Ends of the arrow: on the side of the tool on which less is in the way.
fn arrow_at(names: &Names, tool: Pixel, seen: &Point) -> (Pixel, Pixel) {
    let share = seen.xy().norm();
    let (x, y) = (seen.x / share, seen.y / share);
    let length = (LENGTH * share).max(SHORTEST);
    let at = |s: f64| [tool[0] + s * x, tool[1] + s * y];
    let mut best: Option<(f64, (Pixel, Pixel))> = None;
    for (rank, gap) in GAPS.into_iter().enumerate() {
        for (from, to) in [(-gap - length, -gap), (gap, gap + length)] {
            let ends = (at(from), at(to));
            let room = names.room_for(ends.0, HEAD) && names.room_for(ends.1, HEAD);
            let cost = names.in_the_way(ends.0, ends.1, 4.0)
                + 12.0 * rank as f64
                + if room { 0.0 } else { 1e6 };
            if best.as_ref().is_none_or(|b| cost < b.0) {
                best = Some((cost, ends));
            }
        }
    }
    best.map_or((tool, tool), |b| b.1)
}

fn arrow(svg: &mut Svg, names: &mut Names, kind: &Kind, from: Pixel, to: Pixel) {
    let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
    let length = dx.hypot(dy).max(1e-9);
    let (x, y) = (dx / length, dy / length);
    let back = |s: f64| [to[0] - s * x, to[1] - s * y];
    svg.line("case", from, to);
    svg.line(kind.class, from, back(11.0));
    for k in 0..kind.heads {
        let tip = 9.0 * k as f64;
        let wing = |s: f64| {
            let root = back(tip + 14.0);
            [root[0] - 5.5 * s * y, root[1] + 5.5 * s * x]
        };
        let corners = [back(tip), wing(1.0), wing(-1.0)];
        svg.path(
            &format!("{} head", kind.class),
            &symbol::polygon(corners.into_iter()),
        );
    }
    names.bar(from, to, 7.0);
    // Placed at the tail, away from the head.
    let beside = Beside {
        at: from,
        radius: 5.0,
        toward: [-x, -y],
    };
    let class = format!("mark-name {}-name", kind.class);
    names.write_as(svg, &class, &beside, &kind.label);
}

/// Arrow along the line of sight: its tip if it points to the eye, else its feathers.
fn ring(svg: &mut Svg, names: &mut Names, at: Pixel, kind: &Kind, toward: f64) {
    svg.path(
        &format!("{} ring", kind.class),
        &symbol::circle(at, RING + (kind.heads as f64 - 1.0) * 4.0),
    );
    let words = if toward > 0.0 {
        svg.path(&format!("{} head", kind.class), &symbol::circle(at, 2.8));
        "towards the eye"
    } else {
        let r = 0.7 * RING;
        for s in [-1.0, 1.0] {
            svg.line(
                kind.class,
                [at[0] - r, at[1] - s * r],
                [at[0] + r, at[1] + s * r],
            );
        }
        "away from the eye"
    };
    names.mark(at, RING + 3.0);
    let class = format!("mark-name {}-name", kind.class);
    let label = format!("{}, {words}", kind.label);
    names.write_as(svg, &class, &Beside::point(at, RING + 2.0), &label);
}
