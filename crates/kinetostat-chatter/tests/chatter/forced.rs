//! Forced vibration against time stepping.

use std::f64::consts::TAU;

use kinetostat_chatter::{
    Coefficients, Milled, MillingCut, PeriodicForce, ToolResponse, Vibration,
};
use kinetostat_cutting::{Engagement, Feed, Linear, Milling, Shape, Side, Tool, Wall};
use kinetostat_testing::Worst;
use nalgebra::{Matrix3, Vector3};

use crate::support::{aluminium, arc, arc_of, cut, one_direction, two_modes};

const FEED: f64 = 1e-4;

/// Force of one straight tooth of `teeth` on a half-immersion up cut, written down here again, N.
fn tooth_force(turn: f64, tooth: usize, teeth: usize, depth: f64, k: [f64; 2]) -> Vector3<f64> {
    let phi = (turn + TAU * tooth as f64 / teeth as f64).rem_euclid(TAU);
    if phi >= 0.5 * std::f64::consts::PI {
        return Vector3::zeros();
    }
    let (s, c) = phi.sin_cos();
    let h = depth * FEED * s;
    Vector3::new(-k[0] * c - k[1] * s, k[0] * s - k[1] * c, 0.0) * h
}

/// Steady displacement over a revolution by small steps of the modes.
fn stepped(tool: &ToolResponse, speed: f64, depth: f64, revolutions: usize) -> Vec<Vector3<f64>> {
    let per_tooth = 4000;
    let step = 30.0 / speed / per_tooth as f64;
    let mut modes = vec![(0.0_f64, 0.0_f64); tool.modes().len()];
    let mut track = vec![Vector3::<f64>::zeros(); 2 * per_tooth];
    for i in 0..revolutions * 2 * per_tooth {
        let at = i % (2 * per_tooth);
        let turn = TAU * (at as f64 + 0.5) / (2 * per_tooth) as f64;
        // Mid-step displacement by the velocity.
        track[at] = tool
            .modes()
            .iter()
            .zip(&modes)
            .fold(Vector3::zeros(), |sum, (mode, (q, v))| {
                sum + mode.shape() * (*q + 0.5 * step * *v)
            });
        let force = (0..2)
            .map(|j| tooth_force(turn, j, 2, depth, [6e8, 2e8]))
            .sum::<Vector3<f64>>();
        for (mode, (q, v)) in tool.modes().iter().zip(&mut modes) {
            // Exact for a force that is constant over the step.
            let (w, z) = (mode.angular_frequency(), mode.damping_ratio());
            let wd = w * (1.0 - z * z).sqrt();
            let rest = mode.shape().dot(&force) / (w * w);
            let (x, decay) = (*q - rest, (-z * w * step).exp());
            let (s, c) = (wd * step).sin_cos();
            let slope = (*v + z * w * x) / wd;
            *q = rest + decay * (x * c + slope * s);
            *v = decay * (*v * c - (w * w * x + z * w * *v) / wd * s);
        }
    }
    track
}

fn worst_apart(vibration: &Vibration, track: &[Vector3<f64>]) -> f64 {
    let mut sizes = Worst::new();
    track.iter().for_each(|r| sizes.add(r.norm()));
    let size = sizes.value();
    let mut worst = Worst::new();
    for (i, expected) in track.iter().enumerate().step_by(97) {
        let turn = TAU * (i as f64 + 0.5) / track.len() as f64;
        worst.add((vibration.at(turn) - expected).norm() / size);
    }
    worst.value()
}

#[test]
fn harmonics_agree_with_time_stepping() {
    let half = cut(2, arc("up", 0.5), aluminium());
    let tool = two_modes();
    let force = PeriodicForce::of_chips(&half, 1e-3, FEED, 400).unwrap();
    let vibration = Vibration::new(&tool, &force, 4000.0).unwrap();
    let track = stepped(&tool, 4000.0, 1e-3, 60);
    let apart = worst_apart(&vibration, &track);
    assert!(apart < 2e-4, "{apart}");
    // The mean is the static deflection.
    let expected = tool.compliance() * force.mean();
    assert!((vibration.mean() - expected).norm() < 1e-12 * expected.norm());
}

#[test]
fn a_stiff_tool_leaves_the_static_surface() {
    // Far below all modes the tool follows the force: the wall shows the deflection at the moment a tooth makes it.
    let compliance = Matrix3::new(2e-7, 3e-8, 0.0, 3e-8, 4e-7, 1e-8, 0.0, 1e-8, 1e-7);
    let tool = one_direction();
    let of_modes = tool.compliance() - tool.residual();
    let stiff = tool.with_residual(compliance - of_modes).unwrap();
    let tool = Tool::new(Shape::Flat, 12.0, 4)
        .unwrap()
        .with_helix(38_f64.to_radians())
        .unwrap();
    let law = Linear::new([796.0, 168.0, 222.0], [27.7, 30.8, 1.4]).unwrap();
    for (side, wall, milled) in [
        (Side::Right, Wall::Right, Milled::Down),
        (Side::Left, Wall::Left, Milled::Up),
    ] {
        let engagement = Engagement::straight(6.0, 4.0, 8.0, side).unwrap();
        let milling = Milling::new(&tool, &law, &engagement, Feed::level(0.1).unwrap());
        let samples: Vec<_> = (milling.revolution().forces.iter().map(|f| f.force_n)).collect();
        let force = PeriodicForce::sampled(1, &samples, 600).unwrap();
        let vibration = Vibration::new(&stiff, &force, 1.0).unwrap();
        let arc = arc_of(&engagement);
        let chip = 1e-4 * arc.mean_sine();
        let coefficients = Coefficients::linearised(&law, chip).unwrap().coefficients;
        let cut = MillingCut::of_tool(&tool, arc, coefficients).unwrap();
        let heights = [1e-3, 3e-3, 5e-3, 7e-3];
        let found = vibration.surface_error(&cut, milled, &heights).unwrap();
        let mut worst = Worst::new();
        for (height, found) in heights.into_iter().zip(found) {
            let force = milling.at_wall(wall, 1e3 * height).force_n;
            let into = if milled == Milled::Up { 1.0 } else { -1.0 };
            worst.add(found / (into * (compliance * force).y) - 1.0);
        }
        assert!(worst.of(4) < 0.02, "{milled:?} {worst}");
    }
}
