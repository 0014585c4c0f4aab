//! View of the machine: parallel projection along a direction.

use nalgebra::Vector3;

use crate::drawing::View;
use crate::drawing::order::crossing;
use crate::drawing::parts::{BarKind, BlobKind, Scene};
use crate::drawing::scene::corners;

/// Directions of the drawing in base axes: unit vectors, square to each other.
#[derive(Clone, Copy, Debug)]
pub(super) struct Camera {
    right: Vector3<f64>,
    up: Vector3<f64>,
    /// Direction to the eye.
    pub(super) toward: Vector3<f64>,
}

impl Camera {
    /// Camera from a direction about the vertical (degrees from x to y) and a height above the horizon.
    fn from_angles(azimuth: f64, elevation: f64) -> Self {
        let (sa, ca) = azimuth.to_radians().sin_cos();
        let (se, ce) = elevation.to_radians().sin_cos();
        let toward = Vector3::new(ce * ca, ce * sa, se);
        let right = Vector3::new(-sa, ca, 0.0);
        Self {
            right,
            up: toward.cross(&right),
            toward,
        }
    }

    /// `motions` are the motions and forces that are to be seen, one kind in each list.
    pub(super) fn of(view: Option<View>, scene: &Scene, motions: &[Vec<Vector3<f64>>]) -> Self {
        match view {
            None => Self::flat(scene)
                .filter(|c| motions.iter().all(|w| c.hidden(w) < 0.7))
                .unwrap_or_else(|| Self::clearest(scene, motions)),
            Some(View::Iso) => Self::clearest(scene, motions),
            Some(View::Front) => Self::from_angles(-90.0, 0.0),
            Some(View::Side) => Self::from_angles(0.0, 0.0),
            Some(View::Top) => Self {
                right: Vector3::x(),
                up: Vector3::y(),
                toward: Vector3::z(),
            },
        }
    }

    /// A machine in one plane is looked at square to it.
    fn flat(scene: &Scene) -> Option<Self> {
        let (low, high) = corners(scene.bars.iter().flat_map(|b| b.ends))?;
        let room = high - low;
        let turns = || {
            let turns = scene.blobs.iter();
            turns.filter(|b| !matches!(b.kind, BlobKind::Sleeve | BlobKind::Slide))
        };
        let thin = (0..3)
            .find(|&i| room[i] < 1e-3 * scene.size && turns().all(|b| b.axis[i].abs() > 0.999))?;
        Some(match thin {
            0 => Self::from_angles(0.0, 0.0),
            1 => Self::from_angles(-90.0, 0.0),
            _ => Self::of(Some(View::Top), scene, &[]),
        })
    }

    /// Picks, among some oblique views, the one with the fewest overlaps.
    fn clearest(scene: &Scene, motions: &[Vec<Vector3<f64>>]) -> Self {
        let mut best: Option<(f64, Self)> = None;
        for (turn, azimuth) in [-62.0, -50.0, -38.0, -72.0, -26.0, -118.0, -130.0, 28.0]
            .into_iter()
            .enumerate()
        {
            for (tilt, elevation) in [24.0, 32.0, 18.0].into_iter().enumerate() {
                let camera = Self::from_angles(azimuth, elevation);
                let cost = camera.clutter(scene)
                    + 5.0
                        * motions
                            .iter()
                            .map(|w| camera.hidden(w).powi(2))
                            .sum::<f64>()
                    + 0.25 * (turn + tilt) as f64;
                if best.as_ref().is_none_or(|b| cost < b.0) {
                    best = Some((cost, camera));
                }
            }
        }
        best.map_or_else(|| Self::from_angles(-60.0, 25.0), |b| b.1)
    }

    /// Right, down, towards the eye; m.
    pub(super) fn project(&self, p: &Vector3<f64>) -> Vector3<f64> {
        Vector3::new(p.dot(&self.right), -p.dot(&self.up), p.dot(&self.toward))
    }

    /// Share of vectors that goes to the eye, 0 to 1.
    fn hidden(&self, motions: &[Vector3<f64>]) -> f64 {
        let all: f64 = motions.iter().map(|w| w.norm()).sum();
        let seen: f64 = motions.iter().map(|w| self.project(w).xy().norm()).sum();
        if all > 0.0 { 1.0 - seen / all } else { 0.0 }
    }

    /// Amount of a scene that lies behind or along something else.
    fn clutter(&self, scene: &Scene) -> f64 {
        let size = scene.size;
        let mut cost = 0.0;
        // Joints on top of each other although they are apart.
        let places: Vec<_> = scene.blobs.iter().take(200).map(|b| b.at).collect();
        let flat: Vec<_> = places.iter().map(|p| self.project(p)).collect();
        for i in 0..places.len() {
            for j in 0..i {
                if (places[i] - places[j]).norm() < 0.06 * size {
                    continue;
                }
                let away = (flat[i] - flat[j]).xy().norm() / size;
                if away < 0.04 {
                    cost += 1.0 - away / 0.04;
                }
            }
        }
        // Limbs that point to the eye as a whole.
        let limbs = scene.bars.iter().filter_map(|b| b.limb).max();
        for limb in limbs.map_or(0..0, |last| 0..last + 1) {
            let (mut long, mut seen) = (0.0, 0.0);
            for bar in &scene.bars {
                if bar.limb == Some(limb) && bar.kind != BarKind::Rail {
                    let [a, b] = bar.ends.map(|p| self.project(&p));
                    long += bar.length();
                    seen += (a - b).xy().norm();
                }
            }
            if seen < 0.4 * long {
                cost += 20.0 * (1.0 - seen / (0.4 * long));
            }
        }
        let bars: Vec<_> = scene
            .bars
            .iter()
            .filter(|b| {
                !matches!(b.kind, BarKind::Rod | BarKind::Twice) && b.length() > 0.05 * size
            })
            .take(120)
            .map(|b| (b.length(), b.ends.map(|p| self.project(&p)), b.limb))
            .collect();
        for (i, (length, ends, limb)) in bars.iter().enumerate() {
            // Bars that point to the eye.
            let seen = (ends[1] - ends[0]).xy().norm() / length;
            if seen < 0.35 {
                cost += 4.0 * length / size * (1.0 - seen / 0.35) + 0.5;
            }
            // Bars along each other.
            for (_, other, owner) in &bars[..i] {
                if limb != owner && crossing(ends, other).is_some() {
                    cost += 0.4;
                }
                let inside = [0.25, 0.5, 0.75].iter().filter(|&&t| {
                    let p = ends[0] + (ends[1] - ends[0]) * t;
                    distance(&p, other) < 0.012 * size
                });
                let hidden = inside.count();
                if hidden > 1 {
                    cost += hidden as f64;
                }
            }
        }
        cost
    }
}

/// Distance on the drawing of a point from a straight piece.
pub(super) fn distance(p: &Vector3<f64>, ends: &[Vector3<f64>; 2]) -> f64 {
    let (from, along) = (ends[0].xy(), (ends[1] - ends[0]).xy());
    let square = along.norm_squared();
    let t = if square > 0.0 {
        ((p.xy() - from).dot(&along) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (p.xy() - from - along * t).norm()
}
