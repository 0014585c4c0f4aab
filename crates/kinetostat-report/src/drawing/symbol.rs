//! Symbols of joints, drives and supports, on the drawing: x right, y down, z to the eye, pixels.

use nalgebra::Vector3;

use crate::drawing::order::rim;
use crate::svg::Pixel;
use crate::svg::{Svg, pixel};

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
