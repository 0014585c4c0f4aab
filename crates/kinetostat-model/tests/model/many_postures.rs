//! Every preset, many postures at once against the general engine posture by posture.

use kinetostat::batch::{Batch, Status};
use kinetostat::{Mechanism, Pose, Twist, Wrench, spatial::moved};
use kinetostat_model::{Model, preset_names};
use kinetostat_testing::{LargestEntry, Worst};
use nalgebra::{Matrix6, Vector3, Vector6};

use crate::many_loaded::OUT_OF_REACH;

/// Numbers between -1 and 1 with nothing special about them.
fn irregular(i: usize) -> f64 {
    2.0 * ((i + 1) as f64 * 0.618_033_988_749_895).fract() - 1.0
}

/// Poses around home, some of them out of reach.
fn poses(mechanism: &Mechanism, count: usize) -> Vec<Pose> {
    let home = mechanism.platforms()[mechanism.tool()].home;
    let length = mechanism.limbs()[0].nominal.scale().length;
    (0..count)
        .map(|i| {
            let x = Vector6::from_fn(|k, _| irregular(6 * i + k));
            let shift = Vector6::from_fn(|k, _| if k < 3 { 0.05 * length * x[k] } else { 0.0 });
            moved(&home, &Twist(shift))
        })
        .collect()
}

fn wrenches(count: usize) -> Vec<Wrench> {
    let vector =
        |i: usize, size: f64| size * Vector3::new(irregular(i), irregular(i + 1), irregular(i + 2));
    (0..count)
        .map(|i| Wrench::new(vector(5 * i, 200.0), vector(7 * i, 20.0)))
        .collect()
}

#[test]
fn every_preset_gives_the_same_scalar_and_vectorised() {
    let count = 19;
    let (mut vectorised, mut without) = (0, Vec::new());
    for preset in preset_names() {
        let model = Model::preset(preset.name).expect("a preset");
        let mechanism = &model.mechanism;
        let batch = Batch::new(mechanism);
        let poses = poses(mechanism, count);
        let wrenches = wrenches(count);
        let found = batch.stiffness(&poses);
        let loaded = batch
            .equilibrium(&poses, &wrenches, kinetostat::batch::Details::Rest)
            .expect("as many wrenches as poses");
        let (mut worst, mut worst_loaded) = (Worst::new(), Worst::new());
        for i in 0..count {
            let posture = mechanism.posture(&poses[i]);
            let scalar = posture.as_ref().ok().and_then(|p| p.stiffness().ok());
            assert_eq!(
                scalar.is_some(),
                found.status[i] != Status::Unsolved,
                "{}",
                preset.name
            );
            if let Some(scalar) = scalar {
                let k = scalar.cartesian.matrix;
                let mine = Matrix6::from_fn(|r, c| found.stiffness.get(i, 6 * r + c));
                worst.add((k - mine).largest_entry() / k.largest_entry());
            }
            if loaded.status[i] == Status::Vectorised {
                let posture = posture.expect("a posture");
                let scalar = posture.deflected_by(&wrenches[i]).expect("an equilibrium");
                let p = Vector3::from_fn(|k, _| loaded.tool.get(i, 9 + k));
                // Of the machine's size: the general engine closes its loops to 1e-12 of it.
                let length = mechanism.limbs()[0].nominal.scale().length;
                let apart = (p - scalar.tool.translation.vector).norm();
                worst_loaded.add(apart / length);
                vectorised += 1;
            }
        }
        let of = |found: &[Status]| found.iter().filter(|f| **f == Status::Vectorised).count();
        let solved = found.status.iter().filter(|f| f.is_solved()).count();
        if solved == 0 {
            without.push(preset.name);
        }
        let worst = worst.of_all(solved);
        let worst_loaded = worst_loaded.of_all(of(&loaded.status));
        println!(
            "{}: {} and {} of {count} together, apart {worst:.1e} and {worst_loaded:.1e} {}",
            preset.name,
            of(&found.status),
            of(&loaded.status),
            batch
                .engine()
                .reason()
                .map_or_else(String::new, ToString::to_string)
        );
        assert!(worst < 1e-11, "{}: {worst:e}", preset.name);
        assert!(worst_loaded < 3e-12, "{}: {worst_loaded:e}", preset.name);
    }
    assert!(vectorised > 0);
    assert_eq!(without, OUT_OF_REACH);
}
