//! A loaded machine of six elastic legs, off every axis, against `validation/scripts/platform_modes.py`: a program that knows energies
//! and nothing of Jacobians, tangents or multipliers' geometric stiffness. The numbers below are what it prints. It takes the strain of
//! links from the library (rotation vector, not the three turns of the theory): see there.

use kinetostat::model::LinkMass;
use kinetostat::*;
use kinetostat_dynamics::{Damping, Held, LinearDynamics, ModalResponse};
use kinetostat_testing::Worst;
use nalgebra::{Matrix3, Matrix6, UnitQuaternion, Vector3, vector};

use crate::common::{DENSITY, section};

pub const GROUND: [[f64; 3]; 6] = [
    [0.62, 0.05, 0.01],
    [0.28, 0.55, -0.02],
    [-0.35, 0.52, 0.03],
    [-0.6, -0.08, 0.0],
    [-0.27, -0.58, 0.02],
    [0.38, -0.5, -0.03],
];
pub const ANCHOR: [[f64; 3]; 6] = [
    [0.21, 0.19, 0.02],
    [0.13, 0.24, -0.01],
    [-0.25, 0.12, 0.0],
    [-0.27, 0.03, 0.03],
    [0.02, -0.3, -0.02],
    [0.16, -0.22, 0.01],
];
const LINKS: [f64; 6] = [0.45, 0.5, 0.55, 0.6, 0.52, 0.47];
pub const REST: [f64; 6] = [0.004, -0.002, 0.003, 0.001, -0.003, 0.002];

const TRANSLATION: [f64; 3] = [0.02205983525, -0.0186501045, 0.5502318348];
#[rustfmt::skip]
const ROTATION: [f64; 9] = [
    0.9997859879, -0.01014333427, 0.0180302831,
    0.01013350762, 0.9999484523, 0.0006362894404,
    -0.01803580777, -0.0004534432556, 0.9998372388,
];
#[rustfmt::skip]
const FREQUENCIES: [f64; 42] = [
    15.27509138, 20.7228062, 28.56300868, 68.90185491, 71.0017296, 75.61704338,
    96.90343427, 99.33010539, 104.6503018, 105.0170171, 106.2756182, 106.5503303,
    114.4125161, 120.0366467, 123.1712693, 125.9199478, 129.530029, 132.6448499,
    155.4676155, 159.1669843, 169.7602676, 170.0484769, 170.1905964, 170.2975947,
    283.1363484, 293.2195197, 312.7583907, 316.1152973, 324.3414085, 329.754385,
    452.253266, 466.268572, 492.744226, 500.9821616, 514.2624656, 526.1122476,
    2480.647755, 2733.356245, 2850.786823, 2956.919851, 3162.639193, 3345.066922,
];
#[rustfmt::skip]
const STIFFNESS: [f64; 36] = [
    2859657.861, 94471.3272, 197625.838, -448007.1015, 919146.6924, -20229.79546,
    94471.3272, 2918166.132, 47355.2787, -863944.428, -398538.1938, 18480.20379,
    197625.838, 47355.2787, 11989426.52, 93894.47224, -62950.6188, 846545.2953,
    -448007.1015, -863944.428, 93894.47224, 473891.5693, 25661.3799, -11509.68615,
    919146.6924, -398538.1938, -62950.6188, 25661.3799, 479967.1881, -43119.1132,
    -20229.79546, 18480.20379, 846545.2953, -11509.68615, -43119.1132, 192512.66,
];
#[rustfmt::skip]
const RECEPTANCE: [f64; 36] = [
    -3.592908831e-07, 2.083273221e-09, 1.816823317e-08, -5.034641373e-07, 8.344581125e-07, 1.443913867e-08,
    2.083273221e-09, -4.862366758e-07, -3.49910967e-08, -9.613576989e-07, -4.434563692e-07, 5.413986084e-07,
    1.816823317e-08, -3.49910967e-08, 2.421609323e-08, -3.769208134e-08, 6.417731516e-08, 9.579597051e-07,
    -5.034641373e-07, -9.613576989e-07, -3.769208134e-08, 2.983117144e-07, 8.258771356e-08, 5.37088231e-07,
    8.344581125e-07, -4.434563692e-07, 6.417731516e-08, 8.258771356e-08, 4.295918685e-07, -8.175068864e-07,
    1.443913867e-08, 5.413986084e-07, 9.579597051e-07, 5.37088231e-07, -8.175068864e-07, -1.004122832e-05,
];

pub fn home() -> Vector3<f64> {
    vector![0.03, -0.02, 0.55]
}

fn leg(k: usize) -> Limb {
    let (ground, anchor) = (Vector3::from(GROUND[k]), Vector3::from(ANCHOR[k]));
    let way = home() + anchor - ground;
    let turn = UnitQuaternion::rotation_between(&Vector3::x(), &way).unwrap();
    let name = ["a", "b", "c", "d", "e", "f"][k];
    let beam =
        LinkSpec::beam(section(), LINKS[k]).with_mass(LinkMass::of_section(&section(), DENSITY));
    let inertia = Matrix3::new(
        0.02, 0.003, -0.002, 0.003, 0.03, 0.004, -0.002, 0.004, 0.025,
    );
    let chain = Chain::builder(name)
        .rigid(Pose::from_parts(ground.into(), turn))
        .passive_universal("foot", Vector3::y(), Vector3::z())
        .translation(vector![way.norm() - LINKS[k], 0.0, 0.0])
        .spring("drive", MotionKind::Prismatic, Vector3::x(), 3e6, REST[k])
        .link_with("link", &beam)
        .body("clevis", 2.5, vector![0.05, 0.02, -0.03], inertia)
        .passive_spherical("ball")
        .rigid(Pose::rotation(turn.scaled_axis()).inverse())
        .build()
        .unwrap();
    Limb::between(name, 0, 1, chain).fixed_at(Pose::translation(anchor.x, anchor.y, anchor.z))
}

/// The machine with its legs in an order.
pub fn machine(order: [usize; 6]) -> Mechanism {
    let mut m = Mechanism::builder("six legs").gravity(vector![1.2, -0.7, -9.6]);
    m.platform(Platform {
        mass: 35.0,
        centre_of_mass: vector![0.02, -0.03, 0.07],
        inertia: Matrix3::new(1.1, 0.1, -0.05, 0.1, 1.3, 0.08, -0.05, 0.08, 1.9),
        ..Platform::new("platform", Pose::translation(0.03, -0.02, 0.55))
    });
    for k in order {
        m = m.limb(leg(k));
    }
    m.build().unwrap()
}

pub fn force() -> Wrench {
    Wrench::new(vector![2500.0, -1800.0, -4000.0], Vector3::zeros())
}

/// Equilibrium and linear dynamics at home under a wrench.
pub fn loaded<T>(
    machine: &Mechanism,
    wrench: &Wrench,
    then: impl FnOnce(&Posture, &MechanismEquilibrium, LinearDynamics) -> T,
) -> T {
    let posture = machine.posture(&machine.platforms()[1].home).unwrap();
    let at = posture.deflected_by(wrench).unwrap();
    let dynamics = LinearDynamics::of_machine(&posture, &at, &Held::nothing()).unwrap();
    then(&posture, &at, dynamics)
}

/// Largest difference of matrices in units of the geometric mean of the diagonal of the expected one.
fn apart(found: &Matrix6<f64>, expected: &Matrix6<f64>, worst: &mut Worst) {
    for i in 0..6 {
        for j in 0..6 {
            let size = (expected[(i, i)] * expected[(j, j)]).abs().sqrt();
            worst.add_at((found[(i, j)] - expected[(i, j)]) / size, || {
                format!("{i} {j}")
            });
        }
    }
}

#[test]
fn a_loaded_machine_off_every_axis() {
    let machine = machine([0, 1, 2, 3, 4, 5]);
    loaded(&machine, &force(), |_, at, dynamics| {
        let mut place = Worst::new();
        place.all_apart(at.tool.translation.vector.as_slice(), &TRANSLATION);
        let rotation = at.tool.rotation.to_rotation_matrix();
        place.all_apart(rotation.matrix().transpose().as_slice(), &ROTATION);
        assert!(place.of(12) < 1e-9, "{place}");

        assert!((dynamics.total_mass() - 64.5539).abs() < 1e-9);
        let modes = dynamics.modes().unwrap();
        assert_eq!(modes.counts.vibrating, 42);
        let mut frequencies = Worst::new();
        for (k, (found, expected)) in modes.frequencies_hz().iter().zip(FREQUENCIES).enumerate() {
            frequencies.add_at(found / expected - 1.0, || {
                format!("mode {k}: {found} {expected}")
            });
        }
        assert!(frequencies.of(42) < 1e-8, "{frequencies}");

        // The statics, the direct solution at rest, and the sum of modes at rest all say the same stiffness.
        let (mut statics, mut direct, mut sum) = (Worst::new(), Worst::new(), Worst::new());
        let expected = Matrix6::from_row_slice(&STIFFNESS);
        apart(&at.stiffness.matrix, &expected, &mut statics);
        assert!(statics.of(36) < 1e-8, "{statics}");
        let tool = dynamics.tool();
        let undamped = Damping::Undamped;
        let at_rest = dynamics
            .direct(&modes, &undamped)
            .unwrap()
            .at_hz(tool, tool, 0.0)
            .unwrap();
        apart(
            &at_rest.map(|x| x.re).try_inverse().unwrap(),
            &expected,
            &mut direct,
        );
        assert!(direct.of(36) < 1e-8, "{direct}");
        let few = ModalResponse::new(&dynamics, &modes, &undamped, tool, tool, 3).unwrap();
        apart(
            &few.at_hz(0.0).map(|x| x.re).try_inverse().unwrap(),
            &expected,
            &mut sum,
        );
        assert!(sum.of(36) < 1e-8, "{sum}");

        // 37 Hz lies between the third and the fourth mode: by all modes and directly.
        let expected = Matrix6::from_row_slice(&RECEPTANCE);
        let all = ModalResponse::new(&dynamics, &modes, &undamped, tool, tool, usize::MAX).unwrap();
        for (way, found) in [
            ("sum of modes", all.at_hz(37.0)),
            (
                "direct",
                dynamics
                    .direct(&modes, &undamped)
                    .unwrap()
                    .at_hz(tool, tool, 37.0)
                    .unwrap(),
            ),
        ] {
            let mut worst = Worst::new();
            apart(&found.map(|x| x.re), &expected, &mut worst);
            assert!(worst.of(36) < 1e-7, "{way}: {worst}");
        }
    });
}
