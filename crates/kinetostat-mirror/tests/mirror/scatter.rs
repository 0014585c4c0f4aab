//! The scatter of a point, told by neighbours: waves have none, noise has its own.

use kinetostat_mirror::{DeviationFigures, MeasuredPoints, NominalPath, measure};
use nalgebra::Vector3;

use crate::machine::{Noise, SETTINGS, read};

/// A line along no axis, a circle in another plane's height, and a short line: three contours.
const CONTOURS: &str = "G21 G90\nG0 X0 Y0 Z0\nG1 X160 Y120 Z60 F600\nG0 Z90\nG0 X300 Y0 Z20\nG1 Z10\nG2 X300 Y0 I-40 J0\nG0 Z90\nG0 X0 Y200 Z0\nG1 X60 Y200\nM2\n";

fn figures(program: &str, points: &[Vector3<f64>]) -> DeviationFigures {
    let (_, path) = read(program);
    let nominal = NominalPath::new(&path).expect("feed moves");
    let points = MeasuredPoints::at(points).expect("points");
    measure(&nominal, &points, &SETTINGS)
        .expect("a measurement")
        .figures
}

/// Places on all contours, from about 0.2 to 1.8 mm apart.
fn uneven(noise: &mut Noise) -> Vec<Vector3<f64>> {
    let mut places = Vec::new();
    let mut along = |length: f64, at: &dyn Fn(f64) -> Vector3<f64>| {
        let mut way = 0.0;
        while way < length {
            places.push(at(way));
            way += 0.2 + 1.6 * noise.uniform();
        }
    };
    let direction = Vector3::new(160.0, 120.0, 60.0).normalize();
    along(Vector3::new(160.0, 120.0, 60.0).norm(), &|way| {
        direction * way
    });
    along(80.0 * std::f64::consts::PI, &|way| {
        let (sine, cosine) = (way / 40.0).sin_cos();
        Vector3::new(260.0 + 40.0 * cosine, -40.0 * sine, 10.0)
    });
    along(60.0, &|way| Vector3::new(way, 200.0, 0.0));
    places
}

/// Waves of 40 mm and more, with a height of 0.3 mm.
fn wave(p: &Vector3<f64>) -> Vector3<f64> {
    let angle = std::f64::consts::TAU * (0.8 * p.x + 0.6 * p.y) / 40.0;
    Vector3::new(
        0.3 * angle.sin(),
        0.2 * angle.cos(),
        0.3 * (0.7 * angle).cos(),
    )
}

#[test]
fn a_wave_has_no_scatter() {
    let line = "G21 G90\nG0 X0 Y0 Z0\nG1 X400 F600\nM2\n";
    for (apart, most) in [(1.0, 1e-5), (2.0, 1e-4), (3.0, 5e-4)] {
        let places = (0..(400.0 / apart) as usize).map(|k| apart * k as f64);
        let points: Vec<_> = places
            .map(|x| {
                let angle = std::f64::consts::TAU * x / 40.0;
                Vector3::new(x, 0.3 * angle.sin(), 0.3 * angle.cos())
            })
            .collect();
        let found = figures(line, &points);
        assert!(
            found.scatter_mm < most && !found.scatter_has_bends,
            "{apart}: {found:?}"
        );
    }
    let points: Vec<_> = uneven(&mut Noise(3)).iter().map(|p| p + wave(p)).collect();
    let found = figures(CONTOURS, &points);
    assert!(
        found.scatter_mm < 1e-3 && !found.scatter_has_bends,
        "{found:?}"
    );
}

#[test]
fn noise_has_its_own_scatter_on_every_contour_with_a_wave_and_without() {
    for seed in 1..6 {
        for (sigma, height) in [(0.01, 0.0), (0.01, 1.0), (0.002, 0.0), (0.002, 1.0)] {
            let mut noise = Noise(seed);
            let points: Vec<_> = uneven(&mut noise)
                .iter()
                .map(|p| p + wave(p) * height + noise.vector(sigma))
                .collect();
            let found = figures(CONTOURS, &points);
            // Some 470 points: the median is known to about 5 %.
            assert!(
                (found.scatter_mm / sigma - 1.0).abs() < 0.15 && !found.scatter_has_bends,
                "seed {seed}, {sigma} mm, wave {height}: {found:?}"
            );
        }
    }
    // Of many points it is known well.
    let line = "G21 G90\nG0 X0 Y0 Z0\nG1 X4000 F600\nM2\n";
    let mut noise = Noise(9);
    let points: Vec<_> = (0..8000)
        .map(|k| Vector3::new(0.5 * f64::from(k), 0.1, 0.0) + noise.vector(0.01))
        .collect();
    let found = figures(line, &points);
    assert!((found.scatter_mm / 0.01 - 1.0).abs() < 0.04, "{found:?}");
}

/// One of ten is off by so little that it counts, and one by so much that it would not.
#[test]
fn outliers_are_no_scatter() {
    for off in [0.04, 0.3] {
        let mut noise = Noise(17);
        let points: Vec<_> = uneven(&mut noise)
            .iter()
            .map(|p| {
                let out = if noise.uniform() < 0.1 { off } else { 0.0 };
                p + noise.vector(0.01) + Vector3::z() * out
            })
            .collect();
        let found = figures(CONTOURS, &points);
        assert!(
            (found.scatter_mm / 0.01 - 1.0).abs() < 0.4,
            "{off}: {found:?}"
        );
    }
}

/// Points at the same place differ by their scatter alone; points far apart tell no scatter, and it is said so.
#[test]
fn places_that_come_twice_tell_a_scatter_and_places_far_apart_none() {
    let line = "G21 G90\nG0 X0 Y0 Z0\nG1 X400 F600\nM2\n";
    let mut noise = Noise(23);
    let twice: Vec<_> = (0..800)
        .map(|k| {
            Vector3::new(f64::from(k / 2), 0.0, 0.0)
                + noise
                    .vector(0.01)
                    .component_mul(&Vector3::new(0.0, 1.0, 1.0))
        })
        .collect();
    let found = figures(line, &twice);
    assert!((found.scatter_mm / 0.01 - 1.0).abs() < 0.12, "{found:?}");
    let far: Vec<_> = (0..50)
        .map(|k| Vector3::new(8.0 * f64::from(k), 0.0, 0.0) + noise.vector(0.01))
        .collect();
    let found = figures(line, &far);
    assert!(
        found.scatter_has_bends && found.scatter_mm.is_finite(),
        "{found:?}"
    );
}
