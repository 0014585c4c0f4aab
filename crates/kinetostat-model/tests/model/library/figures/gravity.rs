//! Torques of weights and compensators at the joints of arms, against statics done by hand.
//!
//! The hand's side knows lengths, masses and the spring from the drawing, and nothing of the crate:
//! sums of weight times lever arm and spring force times lever arm in the vertical plane of the arm.

use kinetostat::{
    Mechanism, Pose, PostureRequest, Wrench,
    machine::LimbPosture,
    model::{Kinematics, Role},
};
use kinetostat_model::Model;
use kinetostat_model::schema::LoadTable;
use kinetostat_testing::{Worst, largest};
use nalgebra::{Vector2, vector};
use serde_json::json;

use crate::library::{figure, preset};

/// Weights and springs are taken so small that nothing bends. In a closed loop, rounding of the closure
/// times the stiffness of its bars counts against such small forces.
const SMALL: f64 = 1e-8;
const G: f64 = 9.81;

/// A point of a link, (forwards, up), turned about the horizontal axis so that it tips forwards.
fn tipped(pitch: f64, x: f64, z: f64) -> Vector2<f64> {
    let (s, c) = pitch.sin_cos();
    vector![x * c + z * s, z * c - x * s]
}

/// Torque of a force at a point, positive where it tips forwards.
fn torque(at: Vector2<f64>, force: Vector2<f64>) -> f64 {
    at.y * force.x - at.x * force.y
}

/// An arm in its plane: masses per link with their places, seen from joint 2 at (0, 0).
struct Hand {
    /// Joints 3 and 5.
    elbow: Vector2<f64>,
    wrist: Vector2<f64>,
    upper_arm: Vec<(f64, Vector2<f64>)>,
    forearm: Vec<(f64, Vector2<f64>)>,
    hand: Vec<(f64, Vector2<f64>)>,
    /// Force of the compensator on the upper arm, and where.
    compensator: (Vector2<f64>, Vector2<f64>),
}

impl Hand {
    /// Torques of weights about joints 2, 3 and 5, and of the compensator about joint 2.
    fn torques(&self) -> [f64; 4] {
        let weights = |list: &[(f64, Vector2<f64>)], about: Vector2<f64>| -> f64 {
            let each = list.iter();
            each.map(|(m, at)| torque(at - about, vector![0.0, -m * G]))
                .sum()
        };
        let beyond =
            |about: Vector2<f64>| weights(&self.forearm, about) + weights(&self.hand, about);
        let (at, force) = self.compensator;
        [
            weights(&self.upper_arm, Vector2::zeros()) + beyond(Vector2::zeros()),
            beyond(self.elbow),
            weights(&self.hand, self.wrist),
            torque(at, force),
        ]
    }
}

/// Pull of `tension` on a lug towards an anchor.
fn pull(anchor: Vector2<f64>, lug: Vector2<f64>, tension: impl Fn(f64) -> f64) -> Vector2<f64> {
    let line = anchor - lug;
    line.normalize() * tension(line.norm())
}

fn kuka(q: &[f64]) -> Hand {
    let (arm, fore) = (q[1], q[1] + q[2]);
    let tool = fore + q[4];
    let elbow = tipped(arm, 1.150, 0.0);
    let wrist = elbow + tipped(fore, 1.200, -0.041);
    let lug = tipped(arm, 0.0, 0.18472);
    let force = pull(vector![-0.68593, -0.12030], lug, |s| 100e3 * (s - 0.458));
    Hand {
        elbow,
        wrist,
        upper_arm: vec![(150.0, tipped(arm, 0.550, 0.0))],
        forearm: vec![
            (190.0, elbow + tipped(fore, -0.040, -0.011)),
            (70.0, elbow + tipped(fore, 0.800, -0.041)),
        ],
        hand: vec![
            (35.0, wrist + tipped(tool, 0.035, 0.0)),
            (12.0, wrist + tipped(tool, 0.185, 0.0)),
        ],
        compensator: (lug, force),
    }
}

fn abb(q: &[f64]) -> Hand {
    let (arm, fore) = (q[1], q[1] + q[2]);
    let tool = fore + q[4];
    let elbow = tipped(arm, 0.0, 1.075);
    let wrist = elbow + tipped(fore, 1.392, 0.200);
    let lug = tipped(arm, -0.220, -0.0672);
    let anchor = vector![-0.6847, -0.1455];
    let force = pull(anchor, lug, |s| 6000.0 + 75e3 * (s - 0.47125));
    Hand {
        elbow,
        wrist,
        upper_arm: vec![(180.0, tipped(arm, 0.0, 0.515))],
        forearm: vec![
            (240.0, elbow + tipped(fore, -0.070, 0.190)),
            (80.0, elbow + tipped(fore, 0.772, 0.200)),
        ],
        hand: vec![
            (35.0, wrist + tipped(tool, 0.050, 0.0)),
            (12.0, wrist + tipped(tool, 0.175, 0.0)),
        ],
        compensator: (lug, force),
    }
}

/// Joints 3 and 5 turn the other way; a gas spring pushes.
fn fanuc(q: &[f64]) -> Hand {
    let (arm, fore) = (q[1], q[1] - q[2]);
    let tool = fore - q[4];
    let elbow = tipped(arm, 0.0, 1.075);
    let wrist = elbow + tipped(fore, 1.280, 0.225);
    let lug = tipped(arm, 0.0, 0.270);
    let gas = |s: f64| -8500.0 * 0.700 / (0.700 - (0.870 - s));
    Hand {
        elbow,
        wrist,
        upper_arm: vec![(150.0, tipped(arm, 0.0, 0.515))],
        forearm: vec![
            (200.0, elbow + tipped(fore, -0.060, 0.215)),
            (70.0, elbow + tipped(fore, 0.720, 0.225)),
        ],
        hand: vec![
            (32.0, wrist + tipped(tool, 0.050, 0.0)),
            (11.0, wrist + tipped(tool, 0.190, 0.0)),
        ],
        compensator: (lug, pull(vector![0.0, -0.600], lug, gas)),
    }
}

/// The machine with weights and compensators a hundred millionth of what they are.
fn unbent(name: &str) -> Mechanism {
    let mut document = preset(name).document;
    document.mechanism.gravity_m_per_s2 = Some([0.0, 0.0, -G * SMALL]);
    for load in document.limb.iter_mut().flat_map(|l| &mut l.load) {
        match load {
            LoadTable::Spring(l) => {
                let stiffness = l.stiffness_n_per_mm.as_mut().expect("N/mm");
                *stiffness *= SMALL;
                l.preload_n = l.preload_n.map(|f| f * SMALL);
            }
            LoadTable::GasSpring(l) => l.force_n *= SMALL,
            LoadTable::Counterweight(_) => {} // weighs as gravity lets it
            other => panic!("{}", other.word()),
        }
    }
    Model::from_document(&document, name)
        .unwrap_or_else(|e| panic!("{e}"))
        .mechanism
}

/// Torques of all loads on the actuators at commands, as the crate finds them in equilibrium.
fn found(mechanism: &Mechanism, commands: &[f64]) -> Vec<f64> {
    let limb = &mechanism.limbs()[0];
    let rest = limb.nominal.home_coordinates();
    let k = Kinematics::new(&limb.nominal, &Pose::identity(), &rest, commands);
    let target = k.tip_pose() * limb.platform_from_tip.inverse();
    let joints = LimbPosture {
        commands: commands.to_vec(),
        coordinates: rest,
    };
    let posture = mechanism
        .posture(PostureRequest::joints(&target, vec![joints]))
        .expect("a posture");
    let held = posture.deflected_by(&Wrench::zero()).expect("at rest");
    held.actuator_forces().iter().map(|t| t / SMALL).collect()
}

/// From one limit to the other in 13 steps.
fn steps(mechanism: &Mechanism, joint: usize, share: f64) -> Vec<f64> {
    let actuators = mechanism.limbs().iter().flat_map(|l| l.nominal.actuators());
    let list: Vec<_> = actuators.collect();
    let (low, high) = list[joint].limits.expect("limits");
    let middle = 0.5 * (low + high);
    (0..13)
        .map(|i| middle + share * (high - low) * (f64::from(i) / 12.0 - 0.5))
        .collect()
}

#[test]
fn torques_of_weights_and_compensators_are_those_of_the_hand() {
    let (mut worst, mut count) = (Worst::new(), 0);
    for (name, hand, signs) in [
        (
            "kuka_kr270_like",
            kuka as fn(&[f64]) -> Hand,
            [1.0, 1.0, 1.0],
        ),
        ("abb_irb6640_like", abb, [1.0, 1.0, 1.0]),
        ("fanuc_r2000ic_like", fanuc, [1.0, -1.0, -1.0]),
    ] {
        let mechanism = unbent(name);
        let (mut largest, mut apart) = (Worst::new(), Worst::new());
        let (mut bare, mut relieved) = (Worst::new(), Worst::new());
        for &j2 in &steps(&mechanism, 1, 1.0) {
            for &j3 in &steps(&mechanism, 2, 0.8) {
                for &j5 in steps(&mechanism, 4, 0.9).iter().step_by(4) {
                    let q = [0.4, j2, j3, 0.0, j5, 0.0];
                    let [second, third, fifth, spring] = hand(&q).torques();
                    let wanted = [second + spring, third, fifth];
                    let torques = found(&mechanism, &q);
                    for (joint, (want, sign)) in [1, 2, 4].into_iter().zip(wanted.iter().zip(signs))
                    {
                        apart.add((torques[joint] - sign * want).abs());
                        largest.add(want.abs());
                    }
                    // About the upright axis weights do nothing.
                    apart.add(torques[0].abs());
                    bare.add(second.abs());
                    relieved.add((second + spring).abs());
                    count += 1;
                }
            }
        }
        worst.add(apart.value() / largest.value());
        let (bare, relieved) = (bare.value(), relieved.value());
        figure(
            &format!(
                "Library: largest torque at axis 2 of {name}, weights alone and with compensator"
            ),
            json!([bare.round(), relieved.round()]),
            "shown; the second is smaller",
            "N m",
            relieved < bare,
        );
    }
    let worst = worst.of(3);
    figure(
        &format!(
            "Library: torques of weights and compensators at {count} postures minus hand statics"
        ),
        json!(worst),
        "at most 1e-9",
        "of the largest",
        worst <= 1e-9,
    );
}

/// The drives of a parallelogram arm, by virtual work: turning J2 alone keeps the forearm's direction,
/// turning J3 alone keeps the upper arm's.
#[test]
fn torques_of_the_parallelogram_arm_are_those_of_the_hand() {
    let mechanism = unbent("fanuc_m900ib_like");
    let (mut largest, mut apart) = (Worst::new(), Worst::new());
    let (mut bare, mut relieved, mut count) = (Worst::new(), Worst::new(), 0);
    for &j2 in &steps(&mechanism, 1, 0.8) {
        for pitch in [-0.5, -0.2, 0.1, 0.4, 0.7] {
            for j5 in [-1.4, -0.9] {
                // Upper arm and rod, forearm and crank, hand.
                let (arm, fore): (f64, f64) = (j2, pitch);
                let tool = fore - j5;
                let wrist = tipped(fore, 1.285, 0.250);
                // Weights that turn with the forearm about the elbow.
                let turned = [
                    (620.0, tipped(fore, -0.180, 0.120)),
                    (210.0, tipped(fore, 0.725, 0.250)),
                    (110.0, wrist + tipped(tool, 0.080, 0.0)),
                    (40.0, wrist + tipped(tool, 0.260, 0.0)),
                ];
                let carried: f64 = turned.iter().map(|(m, _)| m).sum();
                let elbow = tipped(arm, 0.0, 1.120);
                // The rod turns with the arm about the crank's pin, the forearm moves with the elbow.
                let second = G
                    * (330.0 * tipped(arm, 0.0, 0.550).x
                        + carried * elbow.x
                        + 60.0 * tipped(arm, 0.0, 0.560).x);
                let pin = tipped(fore, -0.750, 0.0);
                let third = G
                    * (turned.iter().map(|(m, at)| m * at.x).sum::<f64>()
                        + 90.0 * tipped(fore, -0.300, 0.0).x
                        + 60.0 * pin.x);
                let force = pull(vector![0.0, 0.235], elbow, |s| 12e3 + 30e3 * (s - 0.885));
                let balanced = second + 2.0 * torque(elbow, force);
                let fifth =
                    G * (110.0 * tipped(tool, 0.080, 0.0).x + 40.0 * tipped(tool, 0.260, 0.0).x);

                // J3, J5 turn the other way; J3 is the pitch of the crank.
                let target = forearm_tool(j2, pitch, j5);
                let commands = [vec![0.0], vec![j2], vec![-pitch], vec![0.0, j5, 0.0]];
                let limbs = mechanism.limbs().iter().zip(commands);
                let joints = limbs.map(|(limb, commands)| {
                    let mut coordinates = limb.nominal.home_coordinates();
                    // Elbow and pins turn by the angle between upper arm and forearm.
                    for i in limb.nominal.indices_of(Role::Passive) {
                        coordinates[i] = j2 - pitch;
                    }
                    LimbPosture {
                        commands,
                        coordinates,
                    }
                });
                let posture = mechanism
                    .posture(PostureRequest::joints(&target, joints.collect()))
                    .expect("a posture");
                let held = posture.deflected_by(&Wrench::zero()).expect("at rest");
                let torques: Vec<f64> = held.actuator_forces().iter().map(|t| t / SMALL).collect();
                let wanted = [balanced, -third, -fifth];
                for (joint, want) in [1, 2, 4].into_iter().zip(wanted) {
                    apart.add((torques[joint] - want).abs());
                    largest.add(want.abs());
                }
                bare.add(second.abs());
                relieved.add(balanced.abs());
                count += 1;
            }
        }
    }
    let (bare, relieved) = (bare.of(count), relieved.of(count));
    figure(
        "Library: largest torque at J2 of fanuc_m900ib_like, weights alone and with balancers",
        json!([bare.round(), relieved.round()]),
        "shown; the second is smaller",
        "N m",
        relieved < bare,
    );
    let share = apart.of(3 * count) / largest.of(3 * count);
    figure(
        &format!(
            "Library: torques of the parallelogram arm at {count} postures minus hand statics"
        ),
        json!(share),
        "at most 1e-8",
        "of the largest",
        share <= 1e-8,
    );
}

/// The linear actuator at the shoulder: moments about the shoulder, and about its own foot for the pull
/// across it by its own weight. The crank's drive: virtual work as above, with its counterweight.
#[test]
fn forces_of_the_linear_actuator_are_those_of_the_hand() {
    let mechanism = unbent("counterweight_arm");
    let (mut apart, mut share) = (<[Worst; 2]>::default(), <[Worst; 2]>::default());
    for arm in [-0.5, -0.3, -0.1, 0.2, 0.5, 0.7_f64] {
        for fore in [-0.3, 0.0, 0.3, 0.6_f64] {
            let elbow = tipped(arm, 0.0, 1.400);
            let j5 = 1.2;
            let wrist = tipped(fore, 1.600, 0.250);
            let turned = [
                (480.0, tipped(fore, 0.100, 0.130)),
                (230.0, tipped(fore, 0.900, 0.250)),
                (110.0, wrist + tipped(fore + j5, 0.100, 0.0)),
                (40.0, wrist + tipped(fore + j5, 0.300, 0.0)),
            ];
            let carried: f64 = turned.iter().map(|(m, _)| m).sum();
            let second = G
                * (450.0 * tipped(arm, 0.0, 0.680).x
                    + carried * elbow.x
                    + 70.0 * tipped(arm, 0.0, 0.700).x);
            let third = G
                * (turned.iter().map(|(m, at)| m * at.x).sum::<f64>()
                    + 70.0 * tipped(fore, -0.600, 0.0).x
                    + 620.0 * tipped(fore, -0.950, 0.0).x);

            let (foot, lug) = (vector![-0.750, -0.450], tipped(arm, -0.180, 0.500));
            let (line, length) = ((lug - foot).normalize(), (lug - foot).norm());
            let across = vector![-line.y, line.x];
            // Cylinder and rod hang between foot and lug: their share across the lug presses on the arm.
            let weights = [(90.0, 0.250), (40.0, length - 0.350)];
            let own: f64 = weights
                .iter()
                .map(|(m, at)| -m * G * across.y * at / length)
                .sum();
            let moment = second + torque(lug, across * own);
            // The push along the line that holds this moment; the rod's weight comes on top.
            let push = -moment / torque(lug, line);
            let wanted = [-(push + 40.0 * G * line.y), third];

            let tool = fore + j5;
            let at = vector![0.500, 1.000] + elbow + wrist + tipped(tool, 0.350, 0.0);
            let half_turn = std::f64::consts::FRAC_PI_2;
            let turn = nalgebra::Vector3::y() * (tool + half_turn);
            let target = Pose::new(vector![at.x, 0.0, at.y], turn);
            let pitch = -line.y.atan2(line.x);
            let joints = [
                (vec![0.0], vec![]),
                (vec![], vec![arm]),
                (vec![length], vec![pitch, arm - pitch]),
                (vec![], vec![fore - arm]),
                (vec![fore], vec![arm - fore, fore - arm]),
                (vec![0.0, j5, 0.0], vec![]),
            ];
            let limbs = mechanism.limbs().iter().zip(joints);
            let joints = limbs.map(|(limb, (commands, passive))| {
                let mut coordinates = limb.nominal.home_coordinates();
                let places = limb.nominal.indices_of(Role::Passive);
                assert_eq!(places.len(), passive.len());
                for (i, value) in places.into_iter().zip(passive) {
                    coordinates[i] = value;
                }
                LimbPosture {
                    commands,
                    coordinates,
                }
            });
            let posture = mechanism
                .posture(PostureRequest::joints(&target, joints.collect()))
                .expect("a posture");
            let held = posture.deflected_by(&Wrench::zero()).expect("at rest");
            let found = held.actuator_forces();
            for (k, want) in wanted.into_iter().enumerate() {
                apart[k].add((found[1 + k] / SMALL - want).abs());
                share[k].add(want.abs());
            }
        }
    }
    let worst = largest([0, 1].map(|k| apart[k].of(24) / share[k].of(24)));
    figure(
        "Library: linear actuator and crank with counterweight at 24 postures minus hand statics",
        json!(worst),
        "at most 1e-8",
        "of the largest",
        worst <= 1e-8,
    );
}

/// Tool of the parallelogram arm with J1, J4 and J6 at zero, from the drawing.
fn forearm_tool(j2: f64, pitch: f64, j5: f64) -> Pose {
    let tool = pitch - j5;
    let at = vector![0.410, 0.940]
        + tipped(j2, 0.0, 1.120)
        + tipped(pitch, 1.285, 0.250)
        + tipped(tool, 0.300, 0.0);
    let turn = nalgebra::UnitQuaternion::from_scaled_axis(nalgebra::Vector3::y() * tool);
    let pi = std::f64::consts::PI;
    let end = nalgebra::UnitQuaternion::from_euler_angles(pi, -0.5 * pi, 0.0);
    Pose::from_parts(nalgebra::Translation3::new(at.x, 0.0, at.y), turn * end)
}
