//! Bars under their own weight in the kernels, against closed forms and a shooting.

use kinetostat::batch::{Batch, Details, Status};
use kinetostat::model::{LinkConvention, LinkMass};
use kinetostat::{ActuatorSpec, BeamSection, Chain, LinkSpec, Mechanism, MotionKind, Pose, Wrench};
use nalgebra::Vector3;

use super::masses_along_links::CONVENTIONS;

/// A bar on a hinge that a drive holds: what its own weight bends it by, in closed form, in one segment.
#[test]
fn a_bar_bends_under_its_own_weight() {
    let (length, drive) = (1.3, 4e4); // m, N m/rad
    let section = BeamSection::tube(2.1e11, 8.1e10, 0.04, 0.0);
    let bending = section.youngs_modulus * section.second_moment_y;
    // Light, so that what is of second order is less than what is asked for.
    let mass = LinkMass::of_section(&section, 2.0);
    let load = mass.per_length * 9.81; // N/m
    for convention in CONVENTIONS {
        if convention == LinkConvention::ConstantStrain {
            // One segment bends to a circle.
            continue;
        }
        let spec = LinkSpec::beam(section, length).convention(convention);
        let chain = Chain::builder("bar")
            .actuator(
                "hinge",
                ActuatorSpec::new(MotionKind::Revolute, Vector3::y(), drive),
            )
            .link_with("bar", &spec.with_mass(mass))
            .build()
            .expect("a bar");
        let home = Pose::translation(length, 0.0, 0.0);
        let gravity = Vector3::new(0.0, 0.0, -9.81);
        let machine = Mechanism::serial(chain, home, gravity).expect("a machine");
        let found = Batch::new(&machine)
            .equilibrium_at_joints(&[0.0], &[Wrench::zero()], Details::Rest)
            .expect("sizes");
        assert_eq!(found.status[0], Status::Vectorised, "{convention:?}");
        let moment = load * length.powi(2) / 2.0;
        let turned = moment / drive;
        let sunk = load * length.powi(4) / (8.0 * bending) + turned * length;
        let slope = load * length.powi(3) / (6.0 * bending) + turned;
        let tool = found.tool_pose(0);
        let (gone, turned) = (-tool.translation.z, tool.rotation.scaled_axis().y);
        assert!(
            (gone / sunk - 1.0).abs() < 1e-6,
            "{convention:?}: {gone} {sunk}"
        );
        assert!(
            (turned / slope - 1.0).abs() < 1e-6,
            "{convention:?}: {turned} {slope}"
        );
        let borne = found.actuator_forces.get(0, 0).abs();
        assert!(
            (borne / moment - 1.0).abs() < 1e-6,
            "{convention:?}: {borne} {moment}"
        );
    }
}

/// `q L^3 / E I` at which a column clamped at both ends buckles under its own weight: `t'' + q (1 - x) t = c` for the
/// slope `t`, which is zero at both ends and on average; shooting on `c`.
fn heavy_column() -> f64 {
    let closure = |q: f64| {
        let end = |start: f64, shear: f64| {
            let steps = 2000;
            let h = 1.0 / f64::from(steps);
            let rate = |x: f64, z: [f64; 3]| [z[1], shear - q * (1.0 - x) * z[0], z[0]];
            let mut z = [0.0, start, 0.0];
            for i in 0..steps {
                let x = f64::from(i) * h;
                let step = |k: [f64; 3], by: f64| [0, 1, 2].map(|i| z[i] + by * k[i]);
                let a = rate(x, z);
                let b = rate(x + 0.5 * h, step(a, 0.5 * h));
                let c = rate(x + 0.5 * h, step(b, 0.5 * h));
                let d = rate(x + h, step(c, h));
                z = [0, 1, 2].map(|i| z[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
            }
            (z[0], z[2])
        };
        let (one, other) = (end(1.0, 0.0), end(0.0, 1.0));
        one.0 * other.1 - one.1 * other.0
    };
    let (mut low, mut high) = (50.0, 90.0);
    let sign = closure(low).signum();
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if closure(middle).signum() == sign {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

#[test]
fn a_column_buckles_under_its_own_weight() {
    let critical = heavy_column();
    assert!((critical - 74.6).abs() < 0.1, "{critical}"); // Timoshenko and Gere
    let section = BeamSection::tube(2.1e11, 8.1e10, 0.04, 0.0);
    let bending = section.youngs_modulus * section.second_moment_y;
    // Without its upper end held the column would go away beyond 7.84.
    let share = 0.03;
    let mass = LinkMass {
        per_length: share * critical * bending / 9.81,
        rotary: [0.0; 3],
        ..LinkMass::of_section(&section, 1.0)
    };
    let mut errors = Vec::new();
    for segments in [8, 16] {
        let spec = LinkSpec::beam(section, 1.0)
            .segments(segments)
            .with_mass(mass);
        let chain = Chain::builder("column").link_with("bar", &spec).build();
        let gravity = Vector3::new(-9.81, 0.0, 0.0);
        let home = Pose::translation(1.0, 0.0, 0.0);
        let machine = Mechanism::serial(chain.expect("a column"), home, gravity);
        let found = Batch::new(&machine.expect("a machine"))
            .equilibrium(&[home], &[Wrench::zero()], Details::Stability)
            .expect("sizes");
        assert_eq!(found.status[0], Status::Vectorised);
        let own = found.stability(0).and_then(|s| s.share_to_buckling);
        errors.push((own.expect("inner motions") / share - 1.0).abs());
    }
    println!("share to buckling of a heavy column of 8 and 16 segments is off by {errors:?}");
    assert!(
        errors[1] < 2e-3 && errors[0] > 6.0 * errors[1],
        "{errors:?}"
    );
}
