//! D2 and D3: arms, the knee and the frame against independent programs.

use crate::common::*;
use kinetostat::model::LinkMass;
use kinetostat::*;
use kinetostat_dynamics::{Held, LinearDynamics};
use kinetostat_testing::Worst;
use nalgebra::{Matrix3, Vector3, vector};

fn diagonal(x: f64, y: f64, z: f64) -> Matrix3<f64> {
    Matrix3::from_diagonal(&vector![x, y, z])
}

fn frequencies_are(found: &[f64], expected: &[f64], most: f64) {
    let mut worst = Worst::new();
    for (found, expected) in found.iter().zip(expected) {
        worst.add(relative(*found, *expected));
    }
    assert!(worst.of(expected.len()) < most, "{found:?} {expected:?}");
}

#[test]
fn two_link_arm_in_gravity() {
    for (g, f) in [
        (9.81, [5.80196867, 17.6659799]),
        (0.0, [5.79969876, 17.6637327]),
    ] {
        let (a, b): (f64, f64) = (0.4, 0.4 - 0.9);
        let second = g * (7.0 * 0.3 + 5.0 * 0.6) * b.cos();
        let first = second + g * (12.0 * 0.35 + 12.0 * 0.8) * a.cos();
        // k (q - rest) = -moment of the weights
        let chain = Chain::builder("2R")
            .spring(
                "shoulder",
                MotionKind::Revolute,
                Vector3::z(),
                3e4,
                0.4 + first / 3e4,
            )
            .home("shoulder", 0.4)
            .body(
                "upper",
                12.0,
                vector![0.35, 0.0, 0.0],
                diagonal(0.9, 0.9, 0.9),
            )
            .translation(vector![0.8, 0.0, 0.0])
            .spring(
                "elbow",
                MotionKind::Revolute,
                Vector3::z(),
                1.2e4,
                -0.9 + second / 1.2e4,
            )
            .home("elbow", -0.9)
            .body("fore", 7.0, vector![0.3, 0.0, 0.0], diagonal(0.4, 0.4, 0.4))
            .translation(vector![0.6, 0.0, 0.0])
            .body("tip mass", 5.0, Vector3::zeros(), Matrix3::zeros())
            .build()
            .unwrap();
        let mut problem = ChainProblem::new(&chain, EndCondition::wrench(Wrench::zero()));
        if g > 0.0 {
            problem.loads.push(Load::gravity(vector![0.0, -g, 0.0]));
        }
        let at = solve_chain(&problem, &Settings::default()).unwrap();
        assert!((at.coordinates[0] - 0.4).abs() < 1e-12 && (at.coordinates[1] + 0.9).abs() < 1e-12);
        let d = LinearDynamics::of_chain(&problem, &at.coordinates, &at.wrench, &Held::nothing())
            .unwrap();
        let m = rows("17.9523373  5.36616867\n5.36616867  2.83");
        assert!(apart(d.mass(), &m, &m) < 1e-8);
        if g > 0.0 {
            let k = rows("29971.2675  23.9861391\n23.9861391  12023.9861");
            assert!(apart(d.tangent(), &k, &k) < 1e-8);
        }
        frequencies_are(&d.modes().unwrap().frequencies_hz(), &f, 1e-8);
        assert!(d.asymmetry() < 1e-12);
    }
}

#[test]
fn pendulums_hang_and_stand() {
    for (up, expected) in [(-1.0, 41.2251701), (1.0, 13.1965986)] {
        let chain = Chain::builder("pendulum")
            .spring("pivot", MotionKind::Revolute, Vector3::y(), 40.0, 0.0)
            .body("bob", 3.0, vector![0.0, 0.0, up * 0.7], Matrix3::zeros())
            .build()
            .unwrap();
        let mut problem = ChainProblem::new(&chain, EndCondition::wrench(Wrench::zero()));
        problem.loads.push(Load::gravity(down()));
        let modes = about(&problem, &Held::nothing()).modes().unwrap();
        assert!((modes.modes[0].squared / expected - 1.0).abs() < 1e-8);
    }
    // Softer, it falls: the sign stays.
    let chain = Chain::builder("pendulum")
        .spring("pivot", MotionKind::Revolute, Vector3::y(), 10.0, 0.0)
        .body("bob", 3.0, vector![0.0, 0.0, 0.7], Matrix3::zeros())
        .build()
        .unwrap();
    let mut problem = ChainProblem::new(&chain, EndCondition::wrench(Wrench::zero()));
    problem.loads.push(Load::gravity(down()));
    let d = LinearDynamics::of_chain(&problem, &[0.0], &Wrench::zero(), &Held::nothing()).unwrap();
    let modes = d.modes().unwrap();
    let squared = (10.0 - 3.0 * 9.81 * 0.7) / (3.0 * 0.49);
    assert!(
        (modes.modes[0].squared / squared - 1.0).abs() < 1e-12
            && modes.counts.unstable == 1
            && !modes.stable()
    );
    assert!(modes.frequencies_hz()[0] < 0.0);
}

/// The reference values have links bend by turns one after the other, the core by the rotation vector of the turns (which
/// converges faster where links twist as they bend), so that numbers of coarse links differ by second order in the turns.
/// Without a force on the tip these are small; under the force the frequencies converge with the second power, as there.
#[test]
fn frame_under_gravity_and_force() {
    let found = |segments: usize, force: [f64; 3]| {
        let mass = LinkMass::of_section(&section(), DENSITY);
        let link = |length| {
            LinkSpec::beam(section(), length)
                .segments(segments)
                .with_mass(mass)
        };
        let chain = Chain::builder("frame")
            .link_with("one", &link(0.8))
            .rigid(Pose::rotation(vector![0.0, 0.0, -1.2]))
            .link_with("two", &link(0.6))
            .body(
                "tip body",
                4.0,
                Vector3::zeros(),
                diagonal(0.02, 0.03, 0.01),
            )
            .build()
            .unwrap();
        let end = EndCondition::wrench(Wrench::new(Vector3::from(force), Vector3::zeros()));
        let mut problem = ChainProblem::new(&chain, end);
        problem.loads.push(Load::gravity(down()));
        let at = solve_chain(&problem, &Settings::default()).unwrap();
        let d = LinearDynamics::of_chain(&problem, &at.coordinates, &at.wrench, &Held::nothing())
            .unwrap();
        assert!(d.asymmetry() < 1e-12, "{}", d.asymmetry());
        (
            d.modes().unwrap().frequencies_hz()[..4].to_vec(),
            at.tip.translation.vector,
        )
    };
    for (segments, f, tip, most) in [
        (
            1,
            [6.6955746, 10.174389, 31.525368, 38.890749],
            [1.017406971, -0.559209752, -0.006382611],
            2e-5,
        ),
        (
            2,
            [6.6954568, 10.174174, 31.452907, 38.871993],
            [1.017401866, -0.559210057, -0.00638254],
            1e-5,
        ),
        (
            4,
            [6.6954596, 10.174158, 31.445643, 38.870189],
            [1.017399887, -0.559211232, -0.006382525],
            5e-6,
        ),
    ] {
        let (own, at) = found(segments, [0.0; 3]);
        frequencies_are(&own, &f, most);
        assert!((at - Vector3::from(tip)).norm() < most);
    }
    let [one, two, four, eight] = [1, 2, 4, 8].map(|n| found(n, [-1500.0, 800.0, -600.0]).0[0]);
    let orders = [(one - two) / (two - four), (two - four) / (four - eight)];
    assert!(
        orders.iter().all(|ratio| (3.8..4.2).contains(ratio)),
        "{orders:?}"
    );
    // What the reference tends to, whose own steps fall by a factor of three and more.
    assert!((eight / 6.1627074 - 1.0).abs() < 4e-3);
}

pub fn arm6() -> Chain {
    let joints = [
        (
            [0.0, 0.0, 0.4],
            2,
            300.0,
            [0.1, 0.0, 0.2],
            [15.0, 18.0, 14.0],
            4.2e6,
            0.2,
        ),
        (
            [0.35, 0.0, 0.4],
            1,
            220.0,
            [0.0, 0.05, 0.55],
            [28.0, 27.0, 4.0],
            3.9e6,
            0.35,
        ),
        (
            [0.0, 0.0, 1.15],
            1,
            180.0,
            [0.35, -0.04, 0.1],
            [4.0, 14.0, 13.0],
            2.6e6,
            -0.1,
        ),
        (
            [0.6, 0.0, 0.12],
            0,
            60.0,
            [0.35, 0.0, 0.0],
            [0.8, 2.6, 2.6],
            7.5e5,
            0.3,
        ),
        (
            [0.6, 0.0, 0.0],
            1,
            30.0,
            [0.05, 0.0, 0.0],
            [0.3, 0.35, 0.3],
            6e5,
            0.9,
        ),
        (
            [0.2, 0.0, 0.0],
            0,
            45.0,
            [0.15, 0.02, -0.12],
            [0.9, 1.0, 0.5],
            3.5e5,
            -0.4,
        ),
    ];
    let mut chain = Chain::builder("arm6");
    for (i, (p, axis, mass, centre, inertia, k, q)) in joints.into_iter().enumerate() {
        let axis = Matrix3::identity().column(axis).into_owned();
        let name = format!("q{}", i + 1);
        let mut drive = ActuatorSpec::new(MotionKind::Revolute, axis, k);
        drive.home = q;
        chain = chain
            .translation(Vector3::from(p))
            .actuator(&name, drive)
            .body(
                &format!("link {}", i + 1),
                mass,
                Vector3::from(centre),
                Matrix3::from_diagonal(&Vector3::from(inertia)),
            );
    }
    chain
        .translation(vector![0.25, 0.0, -0.30])
        .build()
        .unwrap()
}

#[test]
fn six_axis_arm() {
    let chain = arm6();
    for (gravity, force, f) in [
        (
            true,
            0.0,
            [
                9.98746752, 11.5425353, 23.2012812, 49.0179614, 53.7168096, 126.52171,
            ],
        ),
        (
            false,
            0.0,
            [
                9.98843848, 11.548195, 23.2094663, 49.0171568, 53.7168814, 126.524245,
            ],
        ),
        (
            true,
            -9000.0,
            [
                10.0068189, 11.523062, 23.1889537, 49.2481057, 53.8574826, 126.550804,
            ],
        ),
    ] {
        let end = EndCondition::wrench(Wrench::new(vector![0.0, 0.0, force], Vector3::zeros()));
        let mut problem = ChainProblem::new(&chain, end);
        if gravity {
            problem.loads.push(Load::gravity(down()));
        }
        let at = solve_chain(&problem, &Settings::default()).unwrap();
        let d = LinearDynamics::of_chain(&problem, &at.coordinates, &at.wrench, &Held::nothing())
            .unwrap();
        frequencies_are(&d.modes().unwrap().frequencies_hz(), &f, 1e-8);
        assert!(d.asymmetry() < 1e-12);
        if gravity && force == 0.0 {
            let m = rows(ARM6_MASS);
            assert!(apart(d.mass(), &m, &m) < 1e-8);
            let k = rows(ARM6_TANGENT);
            assert!(apart(d.tangent(), &k, &k) < 1e-8);
            let tip = vector![1.819546714, 0.4130091718, 1.1629274663];
            assert!((at.tip.translation.vector - tip).norm() < 1e-9);
            shares_add_to_one(&d);
        }
    }
}

/// D3: a rotor of 0.012 kg m^2 at 18000 rpm, its spin along z of the tool.
#[test]
fn a_spinning_tool_parts_the_frequencies_of_the_arm() {
    let chain = arm6();
    let mut problem = ChainProblem::new(&chain, EndCondition::wrench(Wrench::zero()));
    problem.loads.push(Load::gravity(down()));
    let at = solve_chain(&problem, &Settings::default()).unwrap();
    let d =
        LinearDynamics::of_chain(&problem, &at.coordinates, &at.wrench, &Held::nothing()).unwrap();
    let speed = 18000.0 * std::f64::consts::TAU / 60.0;
    let momentum = at.tip.rotation * vector![0.0, 0.0, 0.012 * speed];
    let spin = d.gyroscopic_matrix(d.tool(), &momentum).unwrap();
    assert_eq!(spin, -spin.transpose());
    let modes = d.complex_modes(Some(&spin), 6).unwrap();
    let found: Vec<f64> = modes.modes.iter().map(|m| m.frequency_hz()).collect();
    frequencies_are(
        &found,
        &[
            9.98744687, 11.542535, 23.2010453, 48.9994062, 53.7350309, 126.528254,
        ],
        1e-8,
    );
    // Nothing is lost.
    assert!(modes.modes.iter().all(|m| m.damping_ratio().abs() < 1e-9));
    assert!(
        d.gyroscopic_matrix(d.tool(), &vector![0.0, f64::NAN, 0.0])
            .is_err()
    );
}

fn shares_add_to_one(d: &LinearDynamics) {
    for mode in &d.modes().unwrap().modes {
        for shares in [d.kinetic_shares(mode), d.elastic_shares(mode)] {
            assert_eq!(shares.len(), 6);
            assert!((shares.iter().map(|s| s.share).sum::<f64>() - 1.0).abs() < 1e-12);
            assert!(shares.iter().all(|s| s.share >= 0.0));
        }
        assert!(((d.mass() * &mode.shape).dot(&mode.shape) - 1.0).abs() < 1e-12);
    }
}

const ARM6_MASS: &str = "
789.146107  0.0280298263  1.98720369  31.7422675  5.37671721  9.76615551
0.0280298263  823.723046  268.608782  -5.45517259  -5.72428325  -1.88851941
1.98720369  268.608782  223.632019  -5.02772704  12.8132746  -0.65343233
31.7422675  -5.45517259  -5.02772704  7.32389979  0.0186039709  2.43313675
5.37671721  -5.72428325  12.8132746  0.0186039709  7.49159452  0.445920745
9.76615551  -1.88851941  -0.65343233  2.43313675  0.445920745  1.566";

const ARM6_TANGENT: &str = "
4200000  0  0  0  0  0
7.25772277e-15  3895908.84  360.547516  -9.1724335  175.118875  7.48645011
-6.36238947e-14  360.547516  2600360.55  -9.1724335  175.118875  7.48645011
7.73254009e-14  -9.1724335  -9.1724335  750156.263  18.3920894  50.5481299
5.15502673e-14  175.118875  175.118875  18.3920894  600168.698  10.9939799
-7.73254009e-14  7.48645011  7.48645011  50.5481299  10.9939799  350023.422";
