//! The answers of a batch are the same bits from any number of threads and in calls of any size.

use kinetostat::batch::{Batch, Status};
use kinetostat::{Mechanism, Pose, Twist, Wrench, spatial::moved};
use kinetostat_model::Model;
use nalgebra::{Vector3, Vector6};

/// Numbers between -1 and 1 with nothing special about them.
fn irregular(i: usize) -> f64 {
    2.0 * ((i + 1) as f64 * 0.618_033_988_749_895).fract() - 1.0
}

/// Poses around home; one in a thousand is out of reach.
fn poses(mechanism: &Mechanism, count: usize) -> Vec<Pose> {
    let home = mechanism.platforms()[mechanism.tool()].home;
    let length = mechanism.limbs()[0].nominal.scale().length;
    (0..count)
        .map(|i| {
            let reach = if i % 1000 == 999 { 50.0 } else { 0.03 };
            let shift = Vector3::from_fn(|k, _| reach * length * irregular(3 * i + k));
            moved(
                &home,
                &Twist(Vector6::new(shift.x, shift.y, shift.z, 0.0, 0.0, 0.0)),
            )
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

/// All numbers of an answer as bits, posture after posture, and how each was found.
#[derive(Debug, PartialEq)]
struct Bits(Vec<Vec<u64>>, Vec<Status>);

fn unloaded(batch: &Batch, poses: &[Pose]) -> Bits {
    let all = batch.stiffness(poses);
    let row = |i| all.stiffness.row(i).map(f64::to_bits).collect();
    Bits((0..poses.len()).map(row).collect(), all.status)
}

fn loaded(batch: &Batch, poses: &[Pose], wrenches: &[Wrench]) -> Bits {
    let all = batch
        .equilibrium(poses, wrenches, kinetostat::batch::Details::Stiffness)
        .expect("as many wrenches as poses");
    let row = |i| {
        let numbers = all.tool.row(i).chain(all.coordinates.row(i));
        let numbers = numbers.chain(all.stiffness.row(i));
        numbers.map(f64::to_bits).collect()
    };
    Bits((0..poses.len()).map(row).collect(), all.status)
}

fn on_threads<T: Send>(threads: usize, work: impl Fn() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .expect("threads")
        .install(work)
}

#[test]
fn one_two_and_three_threads_give_the_same_bits() {
    let count = 5000;
    let mut lost = 0;
    for name in ["heavy_6r", "stewart_gough_b", "puu3"] {
        let model = Model::preset(name).expect("a preset");
        let batch = Batch::new(&model.mechanism);
        let poses = poses(&model.mechanism, count);
        let one = on_threads(1, || unloaded(&batch, &poses));
        let not = one.1.iter().filter(|f| **f == Status::Unsolved).count();
        lost += not;
        assert!(not < count / 10, "{name}: {not} not found");
        assert_eq!(one, on_threads(2, || unloaded(&batch, &poses)), "{name}");
        assert_eq!(one, on_threads(3, || unloaded(&batch, &poses)), "{name}");
        // Fewer under load, still several for each thread; tangents that no kernel knows are slow.
        let (poses, wrenches) = (&poses[500..1500], wrenches(1000));
        let one = on_threads(1, || loaded(&batch, poses, &wrenches));
        assert_eq!(
            one,
            on_threads(2, || loaded(&batch, poses, &wrenches)),
            "{name}"
        );
        assert_eq!(
            one,
            on_threads(3, || loaded(&batch, poses, &wrenches)),
            "{name}"
        );
    }
    assert!(lost > 0, "none was out of reach");
}

#[test]
fn calls_of_any_size_give_the_same_bits() {
    let count = 300;
    for name in ["heavy_6r", "stewart_gough_b", "puu3"] {
        let model = Model::preset(name).expect("a preset");
        let batch = Batch::new(&model.mechanism);
        let (poses, wrenches) = (poses(&model.mechanism, count), wrenches(count));
        let (free, bent) = (unloaded(&batch, &poses), loaded(&batch, &poses, &wrenches));
        for size in [1, 7, 64] {
            for first in (0..count).step_by(size).take(12) {
                let own = first..(first + size).min(count);
                let part = unloaded(&batch, &poses[own.clone()]);
                assert_eq!(part.0, free.0[own.clone()], "{name}, {size} from {first}");
                let part = loaded(&batch, &poses[own.clone()], &wrenches[own.clone()]);
                assert_eq!(part.0, bent.0[own], "{name}, {size} from {first}");
            }
        }
    }
}
