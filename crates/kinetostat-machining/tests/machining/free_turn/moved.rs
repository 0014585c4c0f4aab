//! The choice does not depend on where base and part stand together.

use std::f64::consts::PI;

use kinetostat::{ActuatorSpec, Chain, Mechanism, MotionKind, Pose};
use kinetostat_machining::{Placement, TurnTask, choose_turns};
use nalgebra::{UnitQuaternion, Vector3, vector};
use proptest::prelude::*;

use super::path_of;

/// What joints 4 and 6 are allowed.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Wrists {
    Limited,
    TurnOn,
}

/// An arm of round figures whose base stands anywhere.
pub(super) fn arm(base: &Pose, wrists: Wrists) -> Mechanism {
    let hinge = |axis, low: f64, high: f64, home| ActuatorSpec {
        limits: (high < 5.0 || wrists == Wrists::Limited).then_some((low, high)),
        home,
        ..ActuatorSpec::new(MotionKind::Revolute, axis, 1e6)
    };
    let (x, y, z) = (Vector3::x(), Vector3::y(), Vector3::z());
    let chain = Chain::builder("arm")
        .rigid(*base)
        .translation(vector![0.0, 0.0, 0.1])
        .actuator("1", hinge(z, -3.0, 3.0, 0.2))
        .translation(vector![0.2, 0.0, 0.5])
        .actuator("2", hinge(y, -1.2, 1.3, -0.3))
        .translation(vector![0.0, 0.0, 0.7])
        .actuator("3", hinge(y, -2.0, 2.5, 0.4))
        .translation(vector![0.6, 0.03, -0.04])
        .actuator("4", hinge(x, -6.0, 6.0, 0.3))
        .actuator("5", hinge(y, -2.1, 2.1, 0.8))
        .actuator("6", hinge(x, -6.0, 6.0, 0.1))
        .rigid(Pose::new(vector![0.2, 0.02, 0.05], vector![0.1, 1.2, 0.2]))
        .build()
        .expect("a chain");
    let home = kinetostat::model::unloaded_tip(
        &chain,
        &Pose::identity(),
        &chain.home_coordinates(),
        &chain.home_commands(),
    );
    Mechanism::serial(chain, home, Vector3::zeros()).expect("an arm")
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]
    #[test]
    fn base_and_part_may_be_moved_together(
        shift in prop::array::uniform3(-3.0..3.0_f64),
        turn in prop::array::uniform3(-3.0..3.0_f64),
        x_deg in -180.0..180.0_f64,
        tilt in -0.3..0.3_f64,
        turned_on in any::<bool>(),
    ) {
        let path = path_of("G21 G90 G17\nG0 X0 Y-60 Z0\nG1 X30 Y10 F600\nG3 X0 Y60 Z-10 I-40 J10\n");
        let orientation = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), x_deg.to_radians())
            * UnitQuaternion::from_euler_angles(PI + tilt, 0.5 * tilt, 0.0);
        let part = Pose::new(vector![0.75, 0.1, 0.45], vector![0.1, -0.2, 0.3]);
        let own = Placement { base_from_part: part, tool_orientation: orientation, orientation_follows: false, scale: 1.1 };
        let motion = Pose::new(Vector3::from(shift), Vector3::from(turn));
        let moved = Placement { base_from_part: motion * part, tool_orientation: motion.rotation * orientation, ..own };
        let wrists = match turned_on {
            true => Wrists::TurnOn,
            false => Wrists::Limited,
        };
        let (here, there) = (arm(&Pose::identity(), wrists), arm(&motion, wrists));
        let choice = |mechanism: &Mechanism, placement| {
            let mut task = TurnTask::new(mechanism, &path, placement);
            task.station_mm = 8.0;
            task.band.step_deg = 10.0;
            task.bounds.rate_deg_per_mm = 2.5;
            choose_turns(&task).map_err(|error| error.to_string())
        };
        match (choice(&here, own), choice(&there, moved)) {
            (Ok(a), Ok(b)) => {
                prop_assert!((a.cost - b.cost).abs() < 1e-9 * a.cost, "{} {}", a.cost, b.cost);
                // Two postures may cost the same to the last digit: a wrist that is flipped, where another joint is nearest to its limit.
                let off = |k: usize| {
                    let joints = a.stations[k].joints_deg.iter().zip(&b.stations[k].joints_deg);
                    joints.map(|(a, b)| (a - b).abs()).fold(0.0, kinetostat::number::larger)
                };
                let same = off(0) < 1e-6;
                for (k, (a, b)) in a.stations.iter().zip(&b.stations).enumerate() {
                    prop_assert!((a.turn_deg - b.turn_deg).abs() < 1e-9, "{} {}", a.turn_deg, b.turn_deg);
                    prop_assert!(!same || off(k) < 1e-6, "{}", off(k));
                }
            }
            (Err(a), Err(b)) => prop_assert_eq!(a.split(':').next().map(str::to_owned), b.split(':').next().map(str::to_owned)),
            (a, b) => prop_assert!(false, "{a:?} {b:?}"),
        }
    }
}
