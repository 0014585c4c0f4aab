//! The eight ways of an arm to a pose.

use std::f64::consts::TAU;

use kinetostat::spatial::pose_residual;
use kinetostat_machining::internal::{configuration_at, ways_of_arm};
use kinetostat_program::irregular;
use kinetostat_testing::{Worst, largest, least};

use super::{milling_arm, tool_at};

/// From joint values to a pose and back: they are among the ways found, and all ways lead to the pose, each in another configuration.
#[test]
fn all_ways_lead_to_the_pose_and_one_is_where_it_came_from() {
    for (model, name) in [
        "heavy_6r",
        "kuka_kr270_like",
        "abb_irb6640_like",
        "fanuc_r2000ic_like",
    ]
    .into_iter()
    .enumerate()
    {
        let mechanism = milling_arm(name);
        let (mut off, mut back, mut looked) = (Worst::new(), Worst::new(), 0);
        let mut most = 0;
        for sample in 0..300 {
            let spans = [3.0, 1.1, 2.0, 3.0, 2.0, 3.0];
            let mut joint = 0;
            let joints = spans.map(|span| {
                joint += 1;
                span * (2.0 * irregular(model as u64, sample, joint) - 1.0)
            });
            let here = configuration_at(&mechanism, &joints).expect("an arm");
            let singular = here
                .wrist_from_singular_deg
                .min(here.elbow_from_singular_deg)
                < 3.0
                || here.shoulder_from_singular_mm < 50.0;
            if singular {
                continue;
            }
            looked += 1;
            let pose = tool_at(&mechanism, &joints);
            let ways = ways_of_arm(&mechanism, &pose).expect("an arm");
            let mut numbers: Vec<u8> = Vec::new();
            let mut nearest = f64::INFINITY;
            for way in &ways {
                off.add(pose_residual(&tool_at(&mechanism, way), &pose).0.norm());
                numbers.push(configuration_at(&mechanism, way).expect("an arm").number);
                let apart = way.iter().zip(&joints).map(|(a, b)| {
                    let turn = a - b;
                    (turn - TAU * (turn / TAU).round()).abs()
                });
                nearest = least([nearest, largest(apart)]);
            }
            back.add(nearest);
            let count = numbers.len();
            numbers.sort_unstable();
            numbers.dedup();
            assert_eq!(numbers.len(), count, "{name}: {joints:?}");
            if count > most {
                most = count;
            }
        }
        assert!(off.value() < 1e-9, "{name}: {off:?}");
        assert!(back.of(looked) < 1e-9, "{name}: {back:?}");
        assert!(
            looked > 150 && most == 8,
            "{name}: {looked} looked at, {most} ways"
        );
    }
}
