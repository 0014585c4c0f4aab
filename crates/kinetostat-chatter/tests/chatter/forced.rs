//! Forced vibration against time stepping, and what regeneration does to it.

use std::f64::consts::TAU;

use kinetostat_chatter::{
    Coefficients, Milled, MillingCut, PeriodicForce, ToolResponse, Vibration,
};
use kinetostat_cutting::{Engagement, Feed, Linear, Milling, Shape, Side, Tool, Wall};
use kinetostat_testing::Worst;
use nalgebra::{Matrix3, Vector3};

use crate::support::{aluminium, arc, arc_of, cut, one_direction, regeneration, two_modes};

const FEED: f64 = 1e-4;

/// Force of one straight tooth of `teeth` on a half-immersion up cut, written down here again, N.
fn tooth_force(
    turn: f64,
    tooth: usize,
    teeth: usize,
    depth: f64,
    k: [f64; 2],
    chip: impl Fn(f64, f64) -> f64,
) -> Vector3<f64> {
    let phi = (turn + TAU * tooth as f64 / teeth as f64).rem_euclid(TAU);
    if phi >= 0.5 * std::f64::consts::PI {
        return Vector3::zeros();
    }
    let (s, c) = phi.sin_cos();
    let h = depth * chip(s, c);
    Vector3::new(-k[0] * c - k[1] * s, k[0] * s - k[1] * c, 0.0) * h
}

/// Steady displacement over a revolution by small steps of the modes, chips with or without the tool's own motion.
fn stepped(
    tool: &ToolResponse,
    speed: f64,
    depth: f64,
    stands_out: [f64; 2],
    regenerates: bool,
    revolutions: usize,
) -> Vec<Vector3<f64>> {
    let per_tooth = 4000;
    let step = 30.0 / speed / per_tooth as f64;
    let mut modes = vec![(0.0_f64, 0.0_f64); tool.modes().len()];
    let mut track = vec![Vector3::<f64>::zeros(); 2 * per_tooth];
    for i in 0..revolutions * 2 * per_tooth {
        let at = i % (2 * per_tooth);
        let turn = TAU * (at as f64 + 0.5) / (2 * per_tooth) as f64;
        let place = |modes: &[(f64, f64)]| {
            tool.modes()
                .iter()
                .zip(modes)
                .fold(Vector3::zeros(), |sum, (mode, (q, _))| {
                    sum + mode.shape() * *q
                })
        };
        let before = track[(at + per_tooth) % (2 * per_tooth)];
        let now = place(&modes);
        // Mid-step displacement by the velocity.
        let speed_now = tool
            .modes()
            .iter()
            .zip(&modes)
            .fold(Vector3::zeros(), |sum, (mode, (_, v))| {
                sum + mode.shape() * *v
            });
        let middle = now + speed_now * (0.5 * step);
        let mut force = Vector3::zeros();
        for j in 0..2 {
            force += tooth_force(turn, j, 2, depth, [6e8, 2e8], |s, c| {
                let n = Vector3::new(s, c, 0.0);
                let regenerated = if regenerates {
                    n.dot(&(middle - before))
                } else {
                    0.0
                };
                FEED * s + regenerated + stands_out[j] - stands_out[1 - j]
            });
        }
        track[at] = middle;
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
    let track = stepped(&tool, 4000.0, 1e-3, [0.0; 2], false, 60);
    let apart = worst_apart(&vibration, &track);
    assert!(apart < 2e-4, "{apart}");
    // The mean is the static deflection.
    let expected = tool.compliance() * force.mean();
    assert!((vibration.mean() - expected).norm() < 1e-12 * expected.norm());
}

#[test]
fn regeneration_leaves_equal_teeth_alone_and_feeds_run_out() {
    let half = cut(2, arc("up", 0.5), aluminium());
    let tool = two_modes();
    let machine = regeneration(tool.clone(), half.clone());
    let (speed, depth) = (4000.0, 0.2e-3);
    let plain = PeriodicForce::of_chips(&half, depth, FEED, 60).unwrap();
    let equal = machine.steady(speed, depth, FEED, &[0.0; 2], 120).unwrap();
    assert!(equal.multiplier < 1.0);
    let mut worst = Worst::new();
    let size = plain.mean().norm();
    for k in 0..=60 {
        let expected = plain.harmonics()[k];
        worst.add((equal.force.harmonics()[2 * k] - expected).norm() / size);
        if k > 0 {
            worst.add(equal.force.harmonics()[2 * k - 1].norm() / size);
        }
    }
    assert!(worst.of(121) < 1e-8, "{worst}");

    let run_out = [1e-5, -1e-5];
    let steady = machine.steady(speed, depth, FEED, &run_out, 800).unwrap();
    let vibration = Vibration::new(&tool, &steady.force, speed).unwrap();
    let track = stepped(&tool, speed, depth, run_out, true, 200);
    let apart = worst_apart(&vibration, &track);
    assert!(apart < 5e-4, "{apart}");
    // Without regeneration it would be another one.
    let track = stepped(&tool, speed, depth, run_out, false, 60);
    assert!(worst_apart(&vibration, &track) > 0.02);
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
