//! Machines built with other numbers than those of the drawing, their joints known from it: against the general engine posture by
//! posture, and bit by bit against machines that are compiled one by one.

use kinetostat::batch::{Batch, BatchEquilibrium, Details, LoadedBatch, Status};
use kinetostat::spatial::pose_residual;
use kinetostat::{Mechanism, Pose, Wrench};
use kinetostat_model::Model;
use kinetostat_testing::Worst;
use nalgebra::{UnitQuaternion, Vector3};

/// A preset, numbers of it that are built otherwise, and how far places lie from home, m.
type Built = (&'static str, &'static [(&'static str, f64)], f64);

const MACHINES: [Built; 3] = [
    (
        "orthoglide",
        &[
            ("chain.leg.q2.length_mm", 310.05),
            ("section.foot beam.scale", 1.03),
            ("deviation.leg y.foot arm.rotation_vector_deg.z", 0.01),
        ],
        0.05,
    ),
    (
        "heavy_6r",
        &[("chain.arm.joint 2.stiffness_n_m_per_rad", 6.1e6)],
        0.2,
    ),
    (
        "hexapod",
        &[("deviation.leg 1.end.translation_mm.x", 0.2)],
        0.02,
    ),
];

/// Around home, and one that no machine reaches; not a multiple of what lies side by side.
fn places(machine: &Mechanism, size: f64) -> Vec<Pose> {
    let home = machine.platforms()[machine.tool()].home;
    let at = |i: usize| {
        let [x, y, z] = [0, 1, 2].map(|k| ((7 * i + 3 * k) % 11) as f64 / 5.5 - 1.0);
        let turn = UnitQuaternion::from_scaled_axis(Vector3::zeros());
        let shift = if i == 9 { 50.0 } else { size };
        Pose::from_parts((shift * Vector3::new(x, y, z)).into(), turn)
    };
    (0..21)
        .map(|i| {
            let by = at(i);
            Pose::from_parts(
                (home.translation.vector + by.translation.vector).into(),
                home.rotation,
            )
        })
        .collect()
}

#[test]
fn machines_with_other_numbers_answer_as_those_compiled_one_by_one() {
    let load = Wrench::new(
        Vector3::new(215.0, -10.0, -25.0),
        Vector3::new(1.0, 2.0, -0.5),
    );
    for (name, changes, size) in MACHINES {
        let model = Model::preset(name).expect("a preset");
        let paths: Vec<&str> = changes.iter().map(|(path, _)| *path).collect();
        let parametric = model.parametric(&paths).expect("parameters");
        let nominal: Vec<f64> = parametric.parameters().iter().map(|p| p.value).collect();
        let as_drawn = parametric.mechanism(&nominal).expect("a machine");
        let drawn = Batch::new(&as_drawn);
        let poses = places(&as_drawn, size);
        let known = drawn.commanded(&poses);
        let loads = vec![load; poses.len()];
        let mut started = drawn.commanded_under(&poses, &loads).expect("equilibria");
        // By how much all numbers and the load are more than drawn, as one number.
        let at = |share: f64| {
            let both = nominal.iter().zip(changes);
            let numbers: Vec<f64> = both.map(|(x, (_, to))| x + share * (to - x)).collect();
            let built = parametric.mechanism(&numbers).expect("a machine");
            (
                built,
                vec![Wrench(load.0 * (1.0 + 0.2 * share)); poses.len()],
            )
        };
        let [more, less] = [0.7, -0.7].map(at);
        let [above, below] = [&more.0, &less.0].map(|m| drawn.built(m).expect("as drawn"));
        let plain = started.clone();
        let [above, below] = [(&above, &more), (&below, &less)].map(|(batch, at)| LoadedBatch {
            batch,
            wrenches: &at.1,
        });
        started.go_along(above, below, 1.4).expect("equilibria");
        let mut found = BatchEquilibrium::default();
        let mut from_drawn = BatchEquilibrium::default();
        let mut from_plain = BatchEquilibrium::default();
        let (mut worst_from_drawn, mut from_drawn_solved) = (Worst::new(), 0);
        let (mut worst, mut solved) = (Worst::new(), 0);
        // More and less than drawn, one after the other in the same rooms.
        for share in [1.0, -1.0, 0.5] {
            // Loaded otherwise than where the drawn machine was looked at.
            let (built, others) = at(share);
            let built = &built;
            drawn
                .built(built)
                .and_then(|b| {
                    b.equilibrium_commanded_into(&known, &loads, Details::Stability, &mut found)
                })
                .expect("answers");
            let b = drawn.built(built).expect("as drawn");
            b.equilibrium_commanded_into(&plain, &others, Details::Rest, &mut from_plain)
                .expect("answers");
            let out = &mut from_drawn;
            b.equilibrium_foretold_into(&started, &[share], &others, Details::Stiffness, out)
                .expect("answers");
            let alone = built.commanded_as(&as_drawn).expect("as drawn");
            let compiled = Batch::new(&alone)
                .equilibrium(&poses, &loads, Details::Stability)
                .expect("answers");
            assert_eq!(found.status, compiled.status, "{name}");
            for i in 0..poses.len() {
                let bits = |of: &BatchEquilibrium| -> Vec<u64> {
                    let rows = of.tool.row(i).chain(of.stiffness.row(i));
                    let rows = rows.chain(of.commands.row(i)).chain(of.stability.row(i));
                    rows.map(f64::to_bits).collect()
                };
                assert_eq!(bits(&found), bits(&compiled), "{name}, place {i}");
                if from_drawn.status[i] == Status::Vectorised {
                    from_drawn_solved += 1;
                    let posture = alone.posture(&poses[i]).expect("a posture");
                    let general = posture.deflected_by(&others[i]).expect("an equilibrium");
                    let off = pose_residual(&from_drawn.tool_pose(i), &general.tool);
                    worst_from_drawn.add_at(off.0.norm(), || format!("{name}, place {i}"));
                    // Without derivatives it takes more passes to the same place.
                    let off = pose_residual(&from_plain.tool_pose(i), &general.tool);
                    worst_from_drawn.add_at(off.0.norm(), || format!("{name}, place {i}, plain"));
                }
                if found.status[i] != Status::Vectorised {
                    continue;
                }
                solved += 1;
                let posture = alone.posture(&poses[i]).expect("a posture");
                let general = posture.deflected_by(&load).expect("an equilibrium");
                let off = pose_residual(&found.tool_pose(i), &general.tool);
                worst.add_at(off.0.norm(), || format!("{name}, place {i}"));
            }
        }
        assert!(solved >= 3 * 15, "{name}: only {solved} are vectorised");
        assert!(worst.value() < 1e-12, "{name}: {worst:?}");
        assert_eq!(from_drawn_solved, solved, "{name}");
        assert!(
            worst_from_drawn.value() < 1e-12,
            "{name}: {worst_from_drawn:?}"
        );
    }
}

/// What corrects the drawn machine is no good for one of other stiffness by far: it is left over, and found from the start.
#[test]
fn machines_far_from_the_drawn_one_are_found_as_well() {
    let load = Wrench::new(
        Vector3::new(215.0, -10.0, -25.0),
        Vector3::new(1.0, 2.0, -0.5),
    );
    let model = Model::preset("orthoglide").expect("a preset");
    let paths = ["section.foot beam.scale", "stiffness.bar.scale"];
    let parametric = model.parametric(&paths).expect("parameters");
    let as_drawn = parametric.mechanism(&[1.0, 1.0]).expect("a machine");
    let drawn = Batch::new(&as_drawn);
    let poses = places(&as_drawn, 0.05);
    let loads = vec![load; poses.len()];
    let started = drawn.commanded_under(&poses, &loads).expect("equilibria");
    let (mut worst, mut solved) = (Worst::new(), 0);
    for numbers in [[5.0, 4.0], [0.5, 3.0], [4.0, 0.6], [0.6, 0.5]] {
        let built = parametric.mechanism(&numbers).expect("a machine");
        let mut found = BatchEquilibrium::default();
        let batch = drawn.built(&built).expect("as drawn");
        batch
            .equilibrium_commanded_into(&started, &loads, Details::Stiffness, &mut found)
            .expect("answers");
        for (i, pose) in poses.iter().enumerate() {
            if i == 9 {
                assert_eq!(found.status[i], Status::Unsolved);
                continue;
            }
            solved += usize::from(found.status[i] == Status::Vectorised);
            let posture = built.posture(pose).expect("a posture");
            let general = posture.deflected_by(&load).expect("an equilibrium");
            let off = pose_residual(&found.tool_pose(i), &general.tool);
            worst.add_at(off.0.norm(), || format!("{numbers:?}, place {i}"));
        }
    }
    assert!(solved >= 4 * 15, "only {solved} are vectorised");
    assert!(worst.value() < 1e-12, "{worst:?}");
}
