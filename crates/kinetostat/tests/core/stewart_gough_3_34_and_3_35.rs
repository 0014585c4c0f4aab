//! Platforms on six two-force legs [R 3.34, 3.35]: spherical joints at both ends of an axial spring,
//! legs that end at different points of the platform.

use crate::beam_tables_3_2_and_3_3::expand;
use crate::common::{close, golden, number, numbers};
use kinetostat::{ActuatorSpec, Chain, DirectionKind, Limb, Mechanism, MotionKind, Platform, Pose};
use nalgebra::Vector3;
use serde_json::Value;

pub fn machine(file: &Value, case: &Value, arm_in_chain: bool) -> Mechanism {
    let (r_base, r_top, h) = (number(&file["R"]), number(&file["r"]), number(&file["h"]));
    let mut builder = Mechanism::builder("stewart");
    let tool = builder.platform(Platform::new("tool", Pose::translation(0.0, 0.0, h)));
    let angles = numbers(&case["base_deg"])
        .into_iter()
        .zip(numbers(&case["platform_deg"]));
    for (i, (f, s)) in angles.enumerate() {
        let b = Vector3::new(f.to_radians().cos(), f.to_radians().sin(), 0.0) * r_base;
        let a = Vector3::new(s.to_radians().cos(), s.to_radians().sin(), 0.0) * r_top;
        let span = a - b + Vector3::new(0.0, 0.0, h);
        // Universal joint, slide with its spring, spherical joint; starts on the way up.
        let mut drive =
            ActuatorSpec::new(MotionKind::Prismatic, Vector3::z(), number(&file["K11"]));
        drive.home = span.norm();
        let mut chain = Chain::builder(format!("leg {i}"))
            .translation(b)
            .passive_universal("u", Vector3::x(), Vector3::y())
            .actuator("slide", drive)
            .passive_spherical("s");
        if arm_in_chain {
            chain = chain.translation(-a);
        }
        let chain = chain.build().unwrap();
        let tip = if arm_in_chain { Vector3::zeros() } else { a };
        builder = builder.limb(
            Limb::between(format!("leg {i}"), 0, tool, chain)
                .fixed_at(Pose::translation(tip.x, tip.y, tip.z)),
        );
    }
    builder.build().unwrap()
}

#[test]
fn six_two_force_legs_have_the_stiffness_of_eqs_3_34_and_3_35() {
    let file = golden("stewart_gough.json");
    for arm_in_chain in [false, true] {
        for case in file["cases"].as_array().unwrap() {
            let label = format!("{} arm in chain: {arm_in_chain}", case["name"]);
            let machine = machine(&file, case, arm_in_chain);
            let home = machine.platforms()[machine.tool()].home;
            let k = machine.posture(&home).unwrap().stiffness().unwrap();
            let expected = expand(&case["computed"]);
            for i in 0..6 {
                for j in 0..6 {
                    let found = k.cartesian.matrix[(i, j)];
                    close(
                        &format!("{label} K{}{}", i + 1, j + 1),
                        found,
                        expected[(i, j)],
                        1e-5,
                    );
                }
            }
            let rank = case["rank"].as_u64().unwrap() as usize;
            assert_eq!(k.rank(), rank, "{label}");
            let free = k
                .directions
                .iter()
                .filter(|d| d.kind == DirectionKind::Free)
                .count();
            assert_eq!(free, 6 - rank, "{label}");
            for limb in &k.limbs {
                assert_eq!(limb.rank, 1, "{label}: a leg takes one force");
            }
        }
    }
}
