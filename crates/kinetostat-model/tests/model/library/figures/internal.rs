//! Machines whose limbs hold just what must be held take errors of manufacture without a fight;
//! over-constrained ones do not.

use kinetostat::{Pose, Wrench};
use kinetostat_model::Model;
use kinetostat_testing::{LargestEntry, Worst, largest, least};
use nalgebra::vector;
use serde_json::json;

use crate::library::{figure, preset};

/// The machine without weights, every limb that starts at the base mounted a little askew.
fn askew(name: &str) -> Model {
    let mut document = preset(name).document;
    document.mechanism.gravity_m_per_s2 = Some([0.0; 3]);
    let mut model = Model::from_document(&document, name).expect("without weights");
    let limbs = document.limb.iter().filter(|l| l.from == "base");
    for (i, limb) in limbs.enumerate() {
        let size = 1.0 + 0.4 * i as f64;
        let motion = Pose::new(
            vector![2e-4, -1e-4, 3e-4] * size,
            vector![1e-3, 2e-3, -1e-3] * size,
        );
        let moved = model.with_deviation(&limb.name, "start", &motion);
        model = moved.expect("a deviation");
    }
    model
}

/// Degree of over-constraint, and the largest wrench in a limb of the machine at rest as a share of its
/// stiffness times its shift.
fn internal(name: &str) -> (usize, f64) {
    let model = askew(name);
    let mechanism = &model.mechanism;
    let home = mechanism.platforms()[mechanism.tool()].home;
    let posture = mechanism.posture(&home).expect("home");
    let rest = posture.deflected_by(&Wrench::zero()).expect("rest");
    let wrenches = rest.limbs.iter().map(|l| l.wrench.0.norm());
    let most = largest(wrenches);
    assert!(rest.displacement.0.norm() > 1e-5, "{name} moves");
    let size = rest
        .limbs
        .iter()
        .map(|l| l.stiffness.cartesian.matrix.largest_entry());
    let size = largest(size) * rest.displacement.0.norm();
    (posture.overconstraint().degree, most / size)
}

#[test]
fn only_over_constrained_robots_carry_internal_wrenches() {
    let mut determinate = Worst::new();
    let free = [
        "puu3",
        "stewart_gough_b",
        "hexapod",
        "cubic_hexapod",
        "hexaglide",
        "delta",
        "prs3",
    ];
    for name in free {
        let (degree, share) = internal(name);
        assert_eq!(degree, 0, "{name}");
        determinate.add(share);
    }
    let determinate = determinate.of(free.len());
    figure(
        &format!(
            "Library: internal wrenches of {} statically determinate machines with errors",
            free.len()
        ),
        json!(determinate),
        "at most 1e-9",
        "of stiffness times shift",
        determinate <= 1e-9,
    );
    let mut shares = Vec::new();
    // Tripteron and Orthoglide: 3 x 3 held directions for 6; planar 3-RRR: 3 x 4 with the drives.
    for (name, expected) in [("orthoglide", 3), ("tripteron", 3), ("rrr3_planar", 6)] {
        let (degree, share) = internal(name);
        assert_eq!(degree, expected, "{name}");
        shares.push(share);
    }
    let least = least(shares);
    figure(
        "Library: internal wrenches of three over-constrained machines with errors, least",
        json!(least),
        "more than 1e-6",
        "of stiffness times shift",
        least > 1e-6,
    );
}
