//! Congruence, order of limbs, condensation and compensation, measured on fixed seeds.

use super::properties::{LEAST, OF, one_degree, seeds};
use super::{Figures, Worst};
use crate::change_of_frame_and_reference_point::{extended, reordered, turned};
use crate::common::{Rng, golden, orthoglide_point};
use crate::compensation_closes::{heavy_arm, reachable};
use crate::condensed_equals_flattened::{Apart, apart, cut};
use crate::orthoglide_reference::milling;
use kinetostat::{
    Directions, PostureRequest, Settings, compensate, compensation::compensate_from,
    spatial::pose_residual,
};

const TEST: &str = "relative (test's tolerance)";

#[test]
fn congruence_under_change_of_frame_and_reference_point() {
    let [mut wrench, mut stiffness, mut energy] = [(); 3].map(|()| Worst::new());
    let mut found = 0;
    for d in seeds().filter_map(turned) {
        found += 1;
        wrench.add(d.wrench);
        stiffness.add(d.stiffness);
        energy.add(d.energy);
    }
    let mut f = Figures::new();
    let name = "Change of frame, random chains under load";
    f.at_most(&format!("{name}: K_C"), &stiffness, 1e-8, TEST);
    f.at_most(&format!("{name}: wrench"), &wrench, 1e-7, TEST);
    f.at_most(&format!("{name}: energy"), &energy, 1e-8, TEST);
    f.at_least(&format!("{name}: equilibria found"), found, LEAST, OF);

    let [mut wrench, mut stiffness] = [(); 2].map(|()| Worst::new());
    for d in seeds().map(extended) {
        wrench.add(d.wrench);
        stiffness.add(d.stiffness);
    }
    let name = "Change of reference point, random chains under load";
    f.at_most(&format!("{name}: K_C"), &stiffness, 1e-9, TEST);
    f.at_most(&format!("{name}: wrench"), &wrench, 1e-7, TEST);
    f.finish();
}

#[test]
fn order_of_the_limbs() {
    let d = reordered();
    let mut f = Figures::new();
    let mut put = |what: &str, deviation: f64, most: f64, unit: &str| {
        let mut worst = Worst::new();
        worst.add(deviation);
        f.at_most(
            &format!("Order of the limbs, Orthoglide, all orders: {what}"),
            &worst,
            most,
            &format!("{unit} (test's tolerance)"),
        );
    };
    put("tool", d.tool, 1e-13, "m, rad");
    put("K_C", d.stiffness, 1e-11, "relative");
    put("wrenches of the limbs", d.wrench, 1e-8, "N, N m");
    f.finish();
}

#[test]
fn condensed_minus_flattened() {
    let wrench = milling(&golden("orthoglide_milling.json"));
    let machine = one_degree();
    let orthoglide = (0..5).map(|index| {
        let posture = machine.posture(&orthoglide_point(index)).unwrap();
        apart(&format!("Q{index}"), &posture, &wrench)
    });
    let parts = seeds().take(12).map(|seed| {
        let mut rng = Rng(seed);
        let c = cut(&mut rng, 0, 5.0);
        let posture = c
            .parts
            .posture(PostureRequest::joints(&c.target, c.part_posture));
        apart("parts", &posture.unwrap(), &rng.wrench(100.0, 12.0))
    });
    let mut f = Figures::new();
    for (what, all) in [
        ("Orthoglide", orthoglide.collect::<Vec<Apart>>()),
        ("two random limbs over a free platform", parts.collect()),
    ] {
        let mut put = |quantity: &str, of: fn(&Apart) -> f64, most: f64, unit: &str| {
            let mut worst = Worst::new();
            all.iter().for_each(|d| worst.add(of(d)));
            f.at_most(
                &format!("Condensed minus flattened, {what}: {quantity}"),
                &worst,
                most,
                &format!("{unit} (test's tolerance)"),
            );
        };
        put("tool", |d| d.tool, 1e-10, "m, rad");
        put("coordinates", |d| d.coordinates, 1e-10, "m, rad");
        put("wrenches of the limbs", |d| d.wrench, 1e-8, "relative");
        put("K_C", |d| d.stiffness, 1e-8, "relative");
    }
    f.finish();
}

#[test]
fn compensation_closes() {
    let wrench = milling(&golden("orthoglide_milling.json"));
    let machine = one_degree();
    let [mut orthoglide, mut arm_p, mut arm_r] = [(); 3].map(|()| Worst::new());
    let position = Directions::POSITION;
    for index in 0..5 {
        let desired = orthoglide_point(index);
        let c = compensate(&machine, &desired, &wrench, position, &Settings::default()).unwrap();
        // Not the compensator's own word: the loaded machine is solved again.
        let again = c.posture.deflected_by(&wrench).unwrap();
        orthoglide.add(pose_residual(&again.tool, &desired).linear().norm());
    }
    let machine = heavy_arm();
    let mut rng = Rng(0xf1_6000);
    for _ in 0..8 {
        let (desired, joints) = reachable(&machine, &mut rng);
        let posture = machine
            .posture(PostureRequest::joints(&desired, vec![joints]))
            .unwrap();
        let wrench = rng.wrench(2000.0, 300.0);
        let start = posture.rest_state();
        let c = compensate_from(&posture, &desired, &wrench, Directions::ALL, start).unwrap();
        let again = c.posture.deflected_by(&wrench).unwrap();
        let residual = pose_residual(&again.tool, &desired);
        arm_p.add(residual.linear().norm());
        arm_r.add(residual.angular().norm());
    }
    let mut f = Figures::new();
    let (m, rad) = ("m (test's tolerance)", "rad (test's tolerance)");
    let name = "Compensation closes, Orthoglide with 1 deg errors under load";
    f.at_most(
        &format!("{name}: position left over"),
        &orthoglide,
        1e-12,
        m,
    );
    let name = "Compensation closes, 6R arm under weight and 2 kN";
    f.at_most(&format!("{name}: position left over"), &arm_p, 5e-12, m);
    f.at_most(&format!("{name}: rotation left over"), &arm_r, 5e-12, rad);
    f.finish();
}
