//! The Orthoglide against the reference values (part 2).

mod common;
use common::{Orthoglide, orthoglide_points};
use kinetostat::{Pose, Wrench};
use nalgebra::vector;

#[test]
fn milling_wrench_moves_the_platform_as_in_section_2_5() {
    let machine = Orthoglide::default().build();
    let wrench = Wrench::new(vector![215.0, -10.0, -25.0], vector![1.0, 21.5, 0.0]);
    let p = orthoglide_points()[1];
    let posture = machine
        .posture(&Pose::translation(p.x, p.y, p.z))
        .expect("IK");
    let e = posture.deflected_by(&wrench).expect("equilibrium");
    println!("{:?}\n{:?}", e.displacement, e.actuator_forces());
    println!("{:?} stable {} mu {:?}", e.residual, e.stable(), e.margin());
    let u = posture.stiffness().expect("k");
    println!("{}", u.cartesian.compliance().expect("c"));
    println!("{:?}", posture.correctable());
    let c = kinetostat::compensate(
        &machine,
        &Pose::translation(p.x, p.y, p.z),
        &wrench,
        [true, true, true, false, false, false],
        &Default::default(),
    )
    .expect("comp");
    println!(
        "{:?} {:?} {:?}",
        c.correction, c.left_over, c.equilibrium.residual
    );
    let t = std::time::Instant::now();
    for _ in 0..200 {
        let _ = posture.deflected_by(&wrench).expect("equilibrium");
    }
    println!("deflected_by {:?}", t.elapsed() / 200);
}
