//! Symbols of joints, drives and supports, and arrows of the force and the moment on the tool, on the drawing: x right, y down, z to
//! the eye, pixels.

use kinetostat::Wrench;
use nalgebra::Vector3;

use crate::chart::label::{Beside, Names};
use crate::drawing::order::rim;
use crate::number;
use crate::svg::{Pixel, Svg, pixel};

/// A point of the drawing with its depth, pixels.
pub(super) type Point = Vector3<f64>;

/// Radius of passive joints.
pub(super) const JOINT: f64 = 5.0;
/// Radius of turning drives.
pub(super) const MOTOR: f64 = 9.5;
/// Half width of sliding drives.
pub(super) const SLEEVE: f64 = 6.5;

pub(super) fn flat(p: &Point) -> Pixel {
    [p.x, p.y]
}

/// A closed polygon as path data.
pub(super) fn polygon(points: impl Iterator<Item = Pixel>) -> String {
    let mut data = String::new();
    for (k, p) in points.enumerate() {
        let letter = if k == 0 { 'M' } else { 'L' };
        data.push_str(&format!("{letter}{} {}", pixel(p[0]), pixel(p[1])));
    }
    if !data.is_empty() {
        data.push('z');
    }
    data
}

pub(super) fn circle(at: Pixel, radius: f64) -> String {
    let (r, d) = (pixel(radius), pixel(2.0 * radius));
    format!(
        "M{} {}a{r} {r} 0 1 0 {d} 0a{r} {r} 0 1 0 -{d} 0z",
        pixel(at[0] - radius),
        pixel(at[1])
    )
}

/// A curve with directions at its ends; straight where they lie along it.
pub(super) fn curve(ends: &[Point; 2], tangents: &[Point; 2]) -> String {
    let [a, b] = ends;
    let (c, d) = (a + tangents[0] / 3.0, b - tangents[1] / 3.0);
    let chord = b - a;
    let bent = |t: &Point| t.xy().perp(&chord.xy()).abs() > 0.3 * chord.xy().norm().max(1.0);
    if bent(&tangents[0]) || bent(&tangents[1]) {
        format!(
            "M{} {}C{} {} {} {} {} {}",
            pixel(a.x),
            pixel(a.y),
            pixel(c.x),
            pixel(c.y),
            pixel(d.x),
            pixel(d.y),
            pixel(b.x),
            pixel(b.y)
        )
    } else {
        format!(
            "M{} {}L{} {}",
            pixel(a.x),
            pixel(a.y),
            pixel(b.x),
            pixel(b.y)
        )
    }
}

/// A coil between two points, seen from the side.
pub(super) fn coil(from: &Point, to: &Point) -> String {
    let along = (to - from).xy();
    let length = along.norm();
    if length < 1.0 {
        return String::new();
    }
    let u = along / length;
    let side = nalgebra::Vector2::new(-u.y, u.x) * 5.0;
    let lead = (0.12 * length).min(14.0);
    let turns = ((length - 2.0 * lead) / 7.0).round().clamp(4.0, 40.0) as usize;
    let mut data = format!("M{} {}", pixel(from.x), pixel(from.y));
    let mut to_point = |p: nalgebra::Vector2<f64>| {
        data.push_str(&format!("L{} {}", pixel(p.x), pixel(p.y)));
    };
    to_point(from.xy() + u * lead);
    for k in 0..turns {
        let share = (k as f64 + 0.5) / turns as f64;
        let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
        to_point(from.xy() + u * (lead + share * (length - 2.0 * lead)) + side * sign);
    }
    to_point(to.xy() - u * lead);
    to_point(to.xy());
    data
}

/// A cylinder about an axis: `axis` and `across` are unit vectors of space as the drawing sees
/// them, one pixel long.
pub(super) fn motor(svg: &mut Svg, at: &Point, axis: &Point, across: &Point, half: f64) {
    let other = axis.cross(across);
    let ring = |end: f64| -> Vec<Point> {
        (0..24)
            .map(|k| {
                let (s, c) = (f64::from(k) * std::f64::consts::TAU / 24.0).sin_cos();
                at + axis * (end * half) + (across * c + other * s) * MOTOR
            })
            .collect()
    };
    let (near, far) = if axis.z >= 0.0 {
        (ring(1.0), ring(-1.0))
    } else {
        (ring(-1.0), ring(1.0))
    };
    let all: Vec<_> = near.iter().chain(&far).map(|p| p.xy()).collect();
    let outline = rim(&all);
    svg.path(
        "drive",
        &polygon(outline.iter().map(|&i| [all[i].x, all[i].y])),
    );
    svg.path("drive face", &polygon(near.iter().map(flat)));
    if axis.z.abs() > 0.5 {
        let middle = at + axis * (half * axis.z.signum());
        svg.path("hub", &circle(flat(&middle), 2.2));
    }
}

/// A box about an axis.
pub(super) fn sleeve(
    svg: &mut Svg,
    class: &str,
    at: &Point,
    axis: &Point,
    across: &Point,
    half: f64,
) {
    let other = axis.cross(across);
    let sides = [(*axis, half), (*across, SLEEVE), (other, SLEEVE)];
    for (k, (normal, out)) in sides.iter().enumerate() {
        if normal.z.abs() < 0.02 {
            continue;
        }
        let middle = at + normal * (out * normal.z.signum());
        let (a, b) = (sides[(k + 1) % 3], sides[(k + 2) % 3]);
        let corners = [(1.0, 1.0), (1.0, -1.0), (-1.0, -1.0), (-1.0, 1.0)]
            .map(|(s, t)| middle + a.0 * (a.1 * s) + b.0 * (b.1 * t));
        // The side that looks up is the lightest.
        let up = -normal.y * normal.z.signum();
        let light = if up > 0.3 { " face" } else { "" };
        svg.path(
            &format!("{class}{light}"),
            &polygon(corners.iter().map(flat)),
        );
    }
}

/// A passive joint about one axis, which is seen as a line.
pub(super) fn turn(svg: &mut Svg, at: Pixel, axis: &Point) {
    let (x, y) = (axis.x * 10.0, axis.y * 10.0);
    if x.hypot(y) > JOINT + 1.0 {
        svg.line("pin", [at[0] - x, at[1] - y], [at[0] + x, at[1] + y]);
    }
    svg.path("joint", &circle(at, JOINT));
}

/// A universal joint.
pub(super) fn universal(svg: &mut Svg, at: Pixel) {
    let r = 0.7 * JOINT;
    svg.path("joint", &circle(at, JOINT + 0.5));
    svg.line("cross", [at[0] - r, at[1] - r], [at[0] + r, at[1] + r]);
    svg.line("cross", [at[0] - r, at[1] + r], [at[0] + r, at[1] - r]);
}

/// A ball in its socket.
pub(super) fn spherical(svg: &mut Svg, at: Pixel) {
    svg.path("joint", &circle(at, JOINT + 0.5));
    svg.path("ball", &circle(at, 2.6));
}

/// A joint that only a spring holds.
pub(super) fn spring_joint(svg: &mut Svg, at: Pixel) {
    svg.path("joint", &circle(at, JOINT + 3.0));
    let mut data = String::new();
    for k in 0..=22 {
        let angle = f64::from(k) * 0.55;
        let r = 0.8 + 0.42 * angle;
        let letter = if k == 0 { 'M' } else { 'L' };
        data.push_str(&format!(
            "{letter}{} {}",
            pixel(at[0] + r * angle.cos()),
            pixel(at[1] + r * angle.sin())
        ));
    }
    svg.path("coil fine", &data);
}

/// Symbol of an attachment to the base; `away` leads into the ground.
pub(super) fn ground(svg: &mut Svg, at: Pixel, away: &Point) {
    let length = away.xy().norm();
    // Seen from above, the ground is below on the paper too.
    let u = if length > 0.2 {
        away.xy() / length
    } else {
        nalgebra::Vector2::y()
    };
    let v = nalgebra::Vector2::new(-u.y, u.x);
    let p = nalgebra::Vector2::new(at[0], at[1]);
    let put = |x: nalgebra::Vector2<f64>| [x.x, x.y];
    let foot = p + u * 13.0;
    svg.path(
        "foot",
        &polygon([put(p), put(foot + v * 8.0), put(foot - v * 8.0)].into_iter()),
    );
    svg.line("ground-line", put(foot - v * 14.0), put(foot + v * 14.0));
    for k in 0..5 {
        let start = foot + v * (-11.0 + 6.0 * f64::from(k));
        svg.line("hatch", put(start), put(start + u * 6.0 - v * 4.0));
    }
}

/// A thin arrow.
pub(super) fn arrow(svg: &mut Svg, class: &str, from: Pixel, to: Pixel) {
    svg.line(class, from, to);
    let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
    let length = dx.hypot(dy);
    if length < 7.0 {
        return;
    }
    let (x, y) = (dx / length, dy / length);
    let wing = |s: f64| [to[0] - 6.5 * x - 2.8 * s * y, to[1] - 6.5 * y + 2.8 * s * x];
    svg.path(
        &format!("{class} head"),
        &polygon([to, wing(1.0), wing(-1.0)].into_iter()),
    );
}

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
///
/// A force is an arrow along it, a moment one with two heads along its axis (right-hand screw). An
/// arrow starts or ends at the tool, on the side where less is in its way: a force may be moved along
/// its line of action. What points to the eye or away from it is a ring with a point or a cross.
pub(super) fn wrench_arrows(
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
            named_arrow(svg, names, &kind, from, to);
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

fn named_arrow(svg: &mut Svg, names: &mut Names, kind: &Kind, from: Pixel, to: Pixel) {
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
            &polygon(corners.into_iter()),
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
        &circle(at, RING + (kind.heads as f64 - 1.0) * 4.0),
    );
    let words = if toward > 0.0 {
        svg.path(&format!("{} head", kind.class), &circle(at, 2.8));
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
