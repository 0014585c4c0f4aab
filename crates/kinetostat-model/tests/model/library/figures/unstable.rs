//! A compensator mounted so that it pushes its joint away is reported, with limb, joint and load.

use kinetostat::Wrench;
use kinetostat_model::Model;
use kinetostat_model::schema::{Element, LoadTable};

use crate::library::preset;

/// The KUKA-like arm with a soft drive at A2 (its brake slips, say) and the lug of the compensator in
/// front of the joint, so that the spring pulls across it at its dead centre.
fn across(preload_n: f64) -> Model {
    let mut document = preset("kuka_kr270_like").document;
    let chain = document.chain.get_mut("arm").expect("the arm");
    for element in &mut chain.elements {
        if let Element::Actuator(joint) = element
            && joint.name.as_deref() == Some("A2")
        {
            joint.stiffness_n_m_per_rad = Some(2.0e4);
        }
    }
    let LoadTable::Spring(spring) = &mut document.limb[0].load[0] else {
        panic!("a spring");
    };
    spring.to.position_mm = Some([16.0, 0.0, -184.3]);
    spring.preload_n = Some(preload_n);
    Model::from_document(&document, "across").unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn a_compensator_that_beats_its_joint_is_named() {
    let model = across(200e3);
    let m = &model.mechanism;
    let posture = m.posture(&m.platforms()[1].home).expect("home");
    let rest = posture
        .deflected_by(&Wrench::zero())
        .expect("an equilibrium");
    assert!(!rest.stable() && !rest.platform.stable);
    let found = posture.negative_net_stiffnesses(&rest).expect("springs");
    let worst = &found[0];
    assert_eq!((worst.limb, worst.coordinate.as_str()), (0, "A2"));
    assert!(worst.spring == 2.0e4 && worst.by_all < -2.0e4, "{worst:?}");
    let [compensator] = worst.by_load[..] else {
        panic!("{worst:?}");
    };
    assert!((compensator + worst.by_gravity - worst.by_all).abs() < 1e-6 * worst.by_all.abs());

    // By hand: near its dead centre a pull T between a and b from the joint has T a b / (a + b).
    let angle = rest.limbs[0].coordinates[1] - 95f64.to_radians();
    let (s, c) = angle.sin_cos();
    let lug = [0.0160 * c - 0.1843 * s, -0.0160 * s - 0.1843 * c];
    let anchor = [-0.68593, -0.12030];
    let energy = |turn: f64| {
        let (s, c) = turn.sin_cos();
        let at = [lug[0] * c + lug[1] * s, lug[1] * c - lug[0] * s];
        let length = (anchor[0] - at[0]).hypot(anchor[1] - at[1]);
        200e3 * (length - 0.458) + 0.5 * 100e3 * (length - 0.458).powi(2)
    };
    let step = 1e-3;
    let by_hand = (energy(step) - 2.0 * energy(0.0) + energy(-step)) / (step * step);
    assert!(
        (compensator - by_hand).abs() < 1e-4 * by_hand.abs(),
        "{compensator} {by_hand}"
    );

    // The arm as it is, and the same mounting with a spring that is too weak to do harm, are stable.
    for model in [preset("kuka_kr270_like"), across(0.0)] {
        let m = &model.mechanism;
        let posture = m.posture(&m.platforms()[1].home).expect("home");
        let rest = posture.deflected_by(&Wrench::zero()).expect("at rest");
        assert!(rest.stable());
        assert!(
            posture
                .negative_net_stiffnesses(&rest)
                .expect("none")
                .is_empty()
        );
    }
}
