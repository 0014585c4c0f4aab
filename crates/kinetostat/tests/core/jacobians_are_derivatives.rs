//! `J_j` of every node is the derivative of that node's pose by coordinates, commands and motions of
//! the base, on random spatial chains with off-axis geometry.

use crate::common::{Recipe, Rng, cases, random_chain};
use kinetostat::{Kinematics, Twist, moved, pose_residual};
use nalgebra::Vector6;
use proptest::prelude::*;

proptest! {
    #![proptest_config(cases(24))]
    #[test]
    fn jacobians_at_every_node_agree_with_differences(seed in any::<u64>()) {
        let mut rng = Rng(seed);
        let r = random_chain(&mut rng, &Recipe { passive: 5, ..Recipe::default() });
        let (n, c) = (r.chain.coordinate_count(), r.commands.len());
        let x: Vec<f64> = r.posture.iter().map(|v| v + 0.3 * rng.signed()).collect();
        let kinematics = Kinematics::new(&r.chain, &r.base, &x, &r.commands, true);
        prop_assert_eq!(kinematics.velocity_count(), n + c + 6);
        let at = |index: usize, s: f64| {
            let (mut x, mut commands, mut base) = (x.clone(), r.commands.clone(), r.base);
            if index < n {
                x[index] += s;
            } else if index < n + c {
                commands[index - n] += s;
            } else {
                let mut t = Vector6::zeros();
                t[index - n - c] = s;
                base = moved(&base, &Twist(t));
            }
            Kinematics::new(&r.chain, &base, &x, &commands, true)
        };
        let h = 2e-3;
        for index in 0..n + c + 6 {
            let near: Vec<_> = [-2.0, -1.0, 1.0, 2.0].iter().map(|s| at(index, s * h)).collect();
            for node in 0..r.chain.nodes().len() {
                let centre = kinematics.node_pose(node);
                let d: Vec<_> =
                    near.iter().map(|k| pose_residual(&k.node_pose(node), &centre).0).collect();
                let column = (8.0 * (d[2] - d[1]) - (d[3] - d[0])) / (12.0 * h);
                let own = kinematics.jacobian(node).column(index).into_owned();
                prop_assert!((column - own).amax() < 2e-10, "node {node} velocity {index}: {:e}", (column - own).amax());
            }
        }
    }
}

#[test]
fn tiny_rigid_rotations_are_kept() {
    for angle in [1e-7, 2e-8, 1e-9] {
        let chain = kinetostat::Chain::builder("c")
            .rigid(kinetostat::Pose::rotation(nalgebra::Vector3::z() * angle))
            .translation(nalgebra::Vector3::x() * 2.0)
            .build()
            .unwrap();
        let tip = kinetostat::unloaded_tip(&chain, &kinetostat::Pose::identity(), &[], &[]);
        let found = tip.translation.vector.y;
        assert!(
            (found / (2.0 * angle) - 1.0).abs() < 1e-6,
            "{angle:e}: {found:e}"
        );
    }
}
