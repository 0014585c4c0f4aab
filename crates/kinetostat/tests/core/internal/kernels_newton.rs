//! Loads under which `theta <- K^-1 tau(theta)` does not contract.

use kinetostat::batch::{Batch, Details, Engine, Status};
use kinetostat::{
    ActuatorSpec, BeamSection, Chain, Mechanism, MotionKind, Pose, Wrench, model::Kinematics,
};
use kinetostat_testing::Worst;
use nalgebra::{DVector, Matrix3, Matrix6, Rotation3, UnitQuaternion, Vector3};

use super::posture_at_joints;

const EA: f64 = 1e6;

/// Stiffness of a segment of a slender beam of unit bending stiffness.
fn segment(length: f64) -> Matrix6<f64> {
    let section = BeamSection {
        youngs_modulus: 1.0,
        shear_modulus: 1.0,
        area: EA,
        second_moment_y: 1.0,
        second_moment_z: 1.0,
        torsion_constant: 0.8,
    };
    section.cantilever(length).unwrap()
}

/// A cantilever of unit length along x.
fn cantilever(segments: usize) -> Mechanism {
    let length = 1.0 / segments as f64;
    let mut chain = Chain::builder("cantilever");
    for i in 0..segments {
        chain = chain.translation(Vector3::new(length, 0.0, 0.0)).spring6(
            &format!("s{i}"),
            &segment(length),
            [0.0; 6],
        );
    }
    let chain = chain.build().expect("a chain");
    Mechanism::serial(chain, Pose::translation(1.0, 0.0, 0.0), Vector3::zeros()).expect("a machine")
}

/// Tip of an extensible elastica under a transverse dead load: shooting on the moment at the base.
fn elastica(load: f64) -> [f64; 2] {
    let rate = |[slope, moment, _, _]: [f64; 4]| {
        let stretch = 1.0 + load * slope.sin() / EA;
        [
            moment,
            -load * slope.cos() * stretch,
            stretch * slope.cos(),
            stretch * slope.sin(),
        ]
    };
    let end = |moment: f64| {
        let steps = 2000;
        let h = 1.0 / f64::from(steps);
        let mut z = [0.0, moment, 0.0, 0.0];
        for _ in 0..steps {
            let step = |k: [f64; 4], by: f64| [0, 1, 2, 3].map(|i| z[i] + by * k[i]);
            let a = rate(z);
            let b = rate(step(a, 0.5 * h));
            let c = rate(step(b, 0.5 * h));
            let d = rate(step(c, h));
            z = [0, 1, 2, 3].map(|i| z[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
        }
        z
    };
    let (mut low, mut high) = (0.2 * load, 0.7 * load);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if end(middle)[1] > 0.0 {
            high = middle;
        } else {
            low = middle;
        }
    }
    let [_, _, x, y] = end(low);
    [x, y]
}

fn force(x: f64, y: f64, z: f64) -> Wrench {
    Wrench::new(Vector3::new(x, y, z), Vector3::zeros())
}

#[test]
fn an_elastica_is_solved_vectorised() {
    let mut errors = Vec::new();
    for segments in [50, 100] {
        let machine = cantilever(segments);
        let batch = Batch::new(&machine);
        let home = machine.platforms()[1].home;
        let load = force(0.0, 10.0, 0.0);
        let one = batch
            .equilibrium(&[home], &[load], Details::Rest)
            .expect("sizes");
        assert_eq!(one.status[0], Status::Vectorised);
        let tip = [one.tool.get(0, 9), one.tool.get(0, 10)];
        let exact = elastica(10.0);
        errors.push((tip[0] - exact[0]).hypot(tip[1] - exact[1]));
        // Residual of K theta = J^T F, from the general engine's Jacobian.
        let chain = &machine.limbs()[0].actual;
        let own: Vec<f64> = one.coordinates.row(0).collect();
        let at = Kinematics::new(chain, &Pose::identity(), &own, &[]);
        let torque = at.jacobian(chain.tip()).transpose() * load.0;
        let k = segment(1.0 / segments as f64);
        let mut unbalanced = torque.clone();
        for i in 0..segments {
            let theta = DVector::from_column_slice(&own[6 * i..6 * i + 6]);
            let mut rows = unbalanced.rows_mut(6 * i, 6);
            rows -= k * theta;
        }
        let residual = unbalanced.norm() / torque.norm();
        assert!(residual < 1e-10, "{residual:e}");
        let scalar = machine.posture(&home).expect("home");
        let scalar = scalar.deflected_by(&load).expect("an equilibrium");
        assert!(scalar.stable());
        let apart =
            scalar.tool.translation.vector - Vector3::from_fn(|k, _| one.tool.get(0, 9 + k));
        assert!(apart.norm() < 1e-9, "{:e}", apart.norm());
        // The same bits beside others, which need fewer steps, more, or no iteration at all.
        let loads: Vec<Wrench> = [0.1, 10.0, 3.0, -20.0, 1.0, 10.0, 17.0, 0.0, -10.0]
            .map(|p| force(0.0, p, 0.3 * p))
            .into();
        let places = vec![home; loads.len()];
        let all = batch
            .equilibrium(&places, &loads, Details::Rest)
            .expect("sizes");
        for i in 0..loads.len() {
            let own = batch.equilibrium(&places[..1], &loads[i..=i], Details::Rest);
            let own = own.expect("sizes");
            assert_eq!(own.status[0], all.status[i]);
            assert!(own.tool.row(0).eq(all.tool.row(i)), "load {i}");
            assert!(
                own.coordinates.row(0).eq(all.coordinates.row(i)),
                "load {i}"
            );
        }
    }
    // Second order in the length of a segment, 4.5e-5 with a hundred.
    println!("elastica, apart from shooting: {errors:?}");
    assert!(
        errors[1] < 5e-5 && errors[0] / errors[1] > 3.5,
        "{errors:?}"
    );
}

/// Springs that are soft for the loads: joints of both kinds, slanted axes, weights, springs of fewer than
/// six directions.
fn soft_arm() -> Mechanism {
    let bar = BeamSection::tube(2.1e9, 8.1e8, 0.02, 0.012)
        .cantilever(0.4)
        .unwrap();
    let turned = UnitQuaternion::from(Rotation3::new(Vector3::new(0.3, -0.5, 0.8)));
    let revolute = |axis: Vector3<f64>| ActuatorSpec::new(MotionKind::Revolute, axis, 150.0);
    let chain = Chain::builder("soft arm")
        .actuator("a", revolute(Vector3::z()))
        .translation(Vector3::new(0.4, 0.05, 0.1))
        .spring6("b", &bar, [0.0; 6])
        .body("m", 1.5, Vector3::new(-0.2, 0.01, 0.02), Matrix3::zeros())
        .actuator("c", revolute(Vector3::new(0.2, 0.9, -0.3)))
        .rigid(Pose::from_parts(Vector3::new(0.1, 0.0, 0.3).into(), turned))
        .actuator(
            "d",
            ActuatorSpec::new(MotionKind::Prismatic, -Vector3::y(), 4e3),
        )
        .spring6("e", &bar, [0.0; 6])
        .translation(Vector3::new(0.2, 0.1, 0.0))
        .body("n", 0.8, Vector3::new(0.02, 0.03, 0.0), Matrix3::zeros())
        .build()
        .expect("an arm");
    Mechanism::serial(chain, Pose::identity(), Vector3::new(1.0, 2.0, -9.0)).expect("a machine")
}

#[test]
fn heavily_loaded_arms_are_solved_vectorised() {
    let machine = soft_arm();
    let batch = Batch::new(&machine);
    assert_eq!(batch.engine(), Engine::Vectorised);
    let irregular = |i: usize| 2.0 * ((i + 1) as f64 * 0.618_033_988_749_895).fract() - 1.0;
    let vector = |i: usize| Vector3::new(irregular(i), irregular(i + 1), irregular(i + 2));
    let count = 24;
    let commands: Vec<f64> = (0..3 * count)
        .map(|i| if i % 3 == 2 { 0.1 } else { 1.0 } * irregular(i))
        .collect();
    let wrenches: Vec<Wrench> = (0..count)
        .map(|i| Wrench::new(30.0 * vector(5 * i), 6.0 * vector(7 * i)))
        .collect();
    let all = batch
        .equilibrium_at_joints(&commands, &wrenches, Details::Rest)
        .expect("sizes");
    let (mut vectorised, mut far) = (0, 0);
    for i in 0..count {
        let posture = posture_at_joints(&machine, &commands[3 * i..3 * i + 3]);
        let Ok(scalar) = posture.deflected_by(&wrenches[i]) else {
            assert_eq!(all.status[i], Status::Unsolved);
            continue;
        };
        println!("{i} {:?} {}", all.status[i], scalar.stable());
        if all.status[i] == Status::Vectorised {
            vectorised += 1;
            assert!(scalar.stable());
        }
        let own = scalar.limbs.iter().flat_map(|l| &l.coordinates);
        let mut most = Worst::new();
        for (a, b) in all.coordinates.row(i).zip(own) {
            assert!((a - b).abs() < 1e-9, "posture {i}: {a} {b}");
            most.add(a);
        }
        if most.value() > 0.12 && all.status[i] == Status::Vectorised {
            far += 1;
        }
    }
    println!("{vectorised} of {count} vectorised, {far} of them far from rest");
    assert!(vectorised > count / 2 && far > count / 4);
}

#[test]
fn a_column_beyond_its_buckling_load_is_as_scalar() {
    let machine = cantilever(20);
    let batch = Batch::new(&machine);
    let home = machine.platforms()[1].home;
    // Euler: 2.47.
    let loads = [-2.0, -2.6, -4.0, -8.0].map(|p| force(p, 0.02, 0.01));
    let found = batch
        .equilibrium(&[home; 4], &loads, Details::Rest)
        .expect("sizes");
    assert_eq!(found.status[0], Status::Vectorised);
    let posture = machine.posture(&home).expect("home");
    for i in 0..4 {
        let scalar = posture.deflected_by(&loads[i]).expect("an equilibrium");
        let tip = Vector3::from_fn(|k, _| found.tool.get(i, 9 + k));
        println!(
            "{} {:?} {tip:?} {}",
            loads[i].0[0],
            found.status[i],
            scalar.stable()
        );
        assert!(
            (tip - scalar.tool.translation.vector).norm() < 1e-9,
            "load {i}"
        );
        assert!(found.status[i] != Status::Vectorised || scalar.stable());
    }
}
