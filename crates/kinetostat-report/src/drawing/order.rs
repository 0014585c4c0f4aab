//! Order of painting, from back to front. If two things cross on the drawing, the depths at the crossing decide; else
//! those of their middles.

use nalgebra::{Vector2, Vector3};

/// A thing on the drawing: x right, y down, z towards the eye.
pub(super) enum Thing {
    Line([Vector3<f64>; 2]),
    /// A joint of a radius; those of a higher rank lie on top of others at the same place.
    Joint(Vector3<f64>, f64, u8),
    /// Corners of a flat or nearly flat convex thing, in order.
    Plate(Vec<Vector3<f64>>),
}

impl Thing {
    fn depth(&self) -> f64 {
        match self {
            Self::Line([a, b]) => 0.5 * (a.z + b.z),
            Self::Joint(p, radius, _) => p.z + radius,
            Self::Plate(points) => {
                points.iter().map(|p| p.z).sum::<f64>() / points.len().max(1) as f64
            }
        }
    }
}

/// Indices, the farthest first.
pub(super) fn painting_order(things: &[Thing]) -> Vec<usize> {
    let n = things.len();
    let mut after: Vec<Vec<usize>> = vec![Vec::new(); n];
    let mut waits = vec![0_usize; n];
    for i in 0..n {
        for j in 0..i {
            let Some(nearer) = nearer(&things[i], &things[j]).filter(|d| d.abs() > 1e-12) else {
                continue;
            };
            let (back, front) = if nearer > 0.0 { (j, i) } else { (i, j) };
            after[back].push(front);
            waits[front] += 1;
        }
    }
    let depth: Vec<f64> = things.iter().map(Thing::depth).collect();
    let mut left: Vec<usize> = (0..n).collect();
    left.sort_by(|&a, &b| depth[a].total_cmp(&depth[b]));
    let mut order = Vec::with_capacity(n);
    while !left.is_empty() {
        // Things that lie over each other in a ring have no order: the farthest begins.
        let next = left.iter().position(|&i| waits[i] == 0).unwrap_or(0);
        let i = left.remove(next);
        order.push(i);
        for &front in &after[i] {
            waits[front] = waits[front].saturating_sub(1);
        }
    }
    order
}

/// Depth by which the first is nearer where both meet on the drawing; `None` if they do not meet.
fn nearer(a: &Thing, b: &Thing) -> Option<f64> {
    match (a, b) {
        (Thing::Line(a), Thing::Line(b)) => {
            let (s, t) = crossing(a, b)?;
            Some(at(a, s).z - at(b, t).z)
        }
        (Thing::Joint(p, radius, _), Thing::Line(line)) => {
            let t = nearest(p, line);
            let there = at(line, t);
            let close = (there - p).xy().norm() < radius + 3.0;
            close.then(|| p.z + 1.5 * radius - there.z)
        }
        (Thing::Line(_), _) => nearer(b, a).map(|d| -d),
        (Thing::Joint(p, r, rank), Thing::Joint(q, s, other)) => {
            let close = (p - q).xy().norm() < r + s;
            let same = (p.z - q.z).abs() < r.max(*s);
            close.then(|| {
                if same {
                    f64::from(*rank) - f64::from(*other)
                } else {
                    p.z - q.z
                }
            })
        }
        (Thing::Plate(corners), Thing::Line(line)) => {
            let plane = plane(corners)?;
            // Compares the part of the line within the plate.
            let inside = (1..10)
                .map(|k| at(line, f64::from(k) / 10.0))
                .filter(|p| contains(corners, p));
            let gaps: Vec<f64> = inside.map(|p| plane(&p) - p.z).collect();
            let sum: f64 = gaps.iter().sum();
            (!gaps.is_empty()).then_some(sum)
        }
        (Thing::Plate(corners), Thing::Joint(p, radius, _)) => {
            let plane = plane(corners)?;
            contains(corners, p).then(|| plane(p) - p.z - radius)
        }
        (Thing::Joint(..), Thing::Plate(_)) => nearer(b, a).map(|d| -d),
        (Thing::Plate(a), Thing::Plate(b)) => {
            let middle =
                |c: &[Vector3<f64>]| c.iter().sum::<Vector3<f64>>() / c.len().max(1) as f64;
            Some(middle(a).z - middle(b).z)
        }
    }
}

fn at(line: &[Vector3<f64>; 2], t: f64) -> Vector3<f64> {
    line[0] + (line[1] - line[0]) * t
}

fn nearest(p: &Vector3<f64>, line: &[Vector3<f64>; 2]) -> f64 {
    let along = (line[1] - line[0]).xy();
    let square = along.norm_squared();
    if square > 0.0 {
        ((p - line[0]).xy().dot(&along) / square).clamp(0.0, 1.0)
    } else {
        0.0
    }
}

/// Crossing of two straight segments, away from common ends.
pub(super) fn crossing(a: &[Vector3<f64>; 2], b: &[Vector3<f64>; 2]) -> Option<(f64, f64)> {
    let (u, v) = ((a[1] - a[0]).xy(), (b[1] - b[0]).xy());
    let area = u.perp(&v);
    if area.abs() < 1e-9 {
        return None;
    }
    let gap = (b[0] - a[0]).xy();
    let (s, t) = (gap.perp(&v) / area, gap.perp(&u) / area);
    let within = |x: f64| (0.0..=1.0).contains(&x);
    (within(s) && within(t)).then_some((s, t))
}

/// Depth of the plane through the corners at a place of the drawing; none if it is seen edge-on.
fn plane(corners: &[Vector3<f64>]) -> Option<impl Fn(&Vector3<f64>) -> f64 + use<>> {
    let middle = corners.iter().sum::<Vector3<f64>>() / corners.len().max(1) as f64;
    let mut normal = Vector3::zeros();
    for (k, p) in corners.iter().enumerate() {
        let q = corners[(k + 1) % corners.len()];
        normal += (p - middle).cross(&(q - middle));
    }
    let size = normal.norm();
    (normal.z.abs() > 0.02 * size && size > 0.0).then_some(move |p: &Vector3<f64>| {
        middle.z - normal.xy().dot(&(p - middle).xy()) / normal.z
    })
}

/// True if a place lies within a convex polygon of either orientation.
fn contains(corners: &[Vector3<f64>], p: &Vector3<f64>) -> bool {
    let mut sides = [false; 2];
    for (k, a) in corners.iter().enumerate() {
        let b = corners[(k + 1) % corners.len()];
        let turn = (b - a).xy().perp(&(p - a).xy());
        sides[usize::from(turn > 0.0)] |= turn != 0.0;
    }
    sides != [true, true]
}

/// Indices of the points on the rim of all, in order around it (Andrew's monotone chain).
pub(super) fn rim(points: &[Vector2<f64>]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&i, &j| {
        let (a, b) = (points[i], points[j]);
        a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y))
    });
    if order.len() < 3 {
        return order;
    }
    let half = |list: &mut dyn Iterator<Item = usize>| {
        let mut out: Vec<usize> = Vec::new();
        for i in list {
            while let [.., a, b] = out[..] {
                if (points[b] - points[a]).perp(&(points[i] - points[a])) > 0.0 {
                    break;
                }
                out.pop();
            }
            out.push(i);
        }
        out.pop();
        out
    };
    let mut out = half(&mut order.iter().copied());
    out.extend(half(&mut order.iter().rev().copied()));
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::vector;

    #[test]
    fn the_crossing_decides_and_not_the_middle() {
        // The first is nearer on the whole, but behind where they cross.
        let near = Thing::Line([vector![-1.0, 0.0, 0.0], vector![1.0, 0.0, 10.0]]);
        let far = Thing::Line([vector![-0.8, -1.0, 3.0], vector![-0.8, 1.0, 3.0]]);
        assert_eq!(painting_order(&[near, far]), [0, 1]);
    }

    #[test]
    fn a_joint_lies_on_the_bar_that_it_ends() {
        let bar = Thing::Line([vector![0.0, 0.0, 0.0], vector![100.0, 0.0, 80.0]]);
        let joint = Thing::Joint(vector![0.0, 0.0, 0.0], 5.0, 0);
        assert_eq!(painting_order(&[joint, bar]), [1, 0]);
    }

    #[test]
    fn bars_below_a_plate_come_before_it() {
        let plate = vec![
            vector![0.0, 0.0, 5.0],
            vector![10.0, 0.0, 5.0],
            vector![10.0, 10.0, 5.0],
            vector![0.0, 10.0, 5.0],
        ];
        let below = Thing::Line([vector![5.0, 5.0, 4.0], vector![5.0, 6.0, -40.0]]);
        let above = Thing::Line([vector![5.0, 5.0, 6.0], vector![5.0, 6.0, -1.0]]);
        let order = painting_order(&[Thing::Plate(plate), below, above]);
        assert!(order.iter().position(|&i| i == 1) < order.iter().position(|&i| i == 0));
    }

    #[test]
    fn the_rim_leaves_out_what_lies_within() {
        let points = [
            vector![0.0, 0.0],
            vector![2.0, 0.0],
            vector![1.0, 0.5],
            vector![2.0, 2.0],
            vector![0.0, 2.0],
        ];
        let mut found = rim(&points);
        found.sort_unstable();
        assert_eq!(found, [0, 1, 3, 4]);
    }
}
