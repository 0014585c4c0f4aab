//! Tasks that make no sense, and machines without a free turn.

use kinetostat::{ActuatorSpec, Chain, Mechanism, MotionKind, Pose};
use kinetostat_machining::{
    TipCompliance, TurnCriterion, TurnError, TurnTask, choose_turns, with_turns,
};
use kinetostat_model::Model;
use nalgebra::{Vector3, vector};

use super::{across_a_straight_wrist, downwards, path_of};

#[test]
fn absurd_numbers_are_refused_in_words() {
    let (mechanism, path, placement) = across_a_straight_wrist();
    let task = TurnTask::new(&mechanism, &path, placement);
    type Change = fn(&mut TurnTask<'_>);
    let cases: [(Change, &str); 26] = [
        (|t| t.station_mm = 0.0, "stations are 0 mm apart"),
        (|t| t.station_mm = f64::NAN, "stations are NaN mm apart"),
        (
            |t| t.station_mm = f64::INFINITY,
            "stations are inf mm apart",
        ),
        (|t| t.station_mm = 1e-9, "may be kept"),
        (|t| t.band.to_deg = -180.0, "is empty"),
        (|t| t.band.to_deg = -190.0, "is empty"),
        (|t| t.band.to_deg = f64::NAN, "two numbers"),
        (|t| t.band.from_deg = -1e9, "two numbers"),
        (|t| t.band.to_deg = 181.0, "more than the whole circle"),
        (|t| t.band.step_deg = 0.0, "in steps of 0 deg"),
        (|t| t.band.step_deg = f64::NAN, "in steps of NaN deg"),
        (|t| t.band.step_deg = 1e-9, "steps"),
        (|t| t.bounds.rate_deg_per_mm = 0.0, "by 0 deg/mm"),
        (|t| t.bounds.rate_deg_per_mm = f64::NAN, "by NaN deg/mm"),
        (|t| t.bounds.rate_deg_per_mm = -1.0, "by -1 deg/mm"),
        (|t| t.bounds.rate_deg_per_mm = 0.01, "could never turn"),
        (|t| t.bounds.least_singular_value = 0.0, "stay above 0"),
        (|t| t.bounds.limit_margin_deg = f64::NAN, "NaN deg inside"),
        (|t| t.bounds.joint_step_deg = 0.0, "turn by 0 deg"),
        (|t| t.bounds.checks_between = 100_000, "at most 1000"),
        (|t| t.bounds.configuration = Some(8), "from 0 to 7"),
        (|t| t.bounds.most_postures = 1000, "most_postures"),
        (|t| t.placement.scale = f64::NAN, "scale"),
        (
            |t| t.placement.base_from_part.translation.vector.x = f64::NAN,
            "not finite",
        ),
        (
            |t| t.criteria.push(TurnCriterion::Turning { weight: -1.0 }),
            "weight -1",
        ),
        (
            |t| {
                let of = TipCompliance::Along(Vector3::zeros());
                t.criteria
                    .push(TurnCriterion::Compliance { weight: 1.0, of });
            },
            "a direction is needed",
        ),
    ];
    for (change, words) in cases {
        let mut task = task.clone();
        change(&mut task);
        let error = choose_turns(&task).expect_err(words);
        assert!(
            matches!(error, TurnError::Input { .. } | TurnError::TooMany { .. }),
            "{error:?}"
        );
        assert!(error.to_string().contains(words), "'{words}' in '{error}'");
    }
}

#[test]
fn paths_without_length_or_feed_are_refused() {
    let (mechanism, _, placement) = across_a_straight_wrist();
    for text in [
        "G21 G90\nM5\n",
        "G21 G90\nG0 X1 Y1 Z1\n",
        "G21 G90\nG0 X1 Y1 Z1\nG1 X1 F100\n",
    ] {
        let path = path_of(text);
        let error =
            choose_turns(&TurnTask::new(&mechanism, &path, placement)).expect_err("no length");
        assert!(error.to_string().contains("no length"), "{error}");
    }
}

#[test]
fn machines_without_a_free_turn_say_so() {
    let path = path_of("G21 G90\nG0 X0 Y0 Z0\nG1 X10 F600\n");
    let placement = downwards(vector![0.5, 0.0, 0.2], 0.0);
    for (name, words) in [
        ("rrr3_planar", "carried by 3 limbs"),
        ("scara", "of which"),
        ("hexapod", "carried by 6 limbs"),
    ] {
        let mechanism = Model::preset(name).expect("preset").mechanism;
        let error = choose_turns(&TurnTask::new(&mechanism, &path, placement)).expect_err(name);
        assert!(matches!(error, TurnError::NoFreedom { .. }), "{error:?}");
        assert!(
            error.to_string().contains(words) && error.to_string().contains(mechanism.name()),
            "{error}"
        );
    }
    let hinge = || ActuatorSpec::new(MotionKind::Revolute, Vector3::z(), 1e5);
    let bar = vector![0.3, 0.0, 0.0];
    let mut chain = Chain::builder("three hinges");
    for name in ["1", "2", "3"] {
        chain = chain.actuator(name, hinge()).translation(bar);
    }
    let home = Pose::translation(0.9, 0.0, 0.0);
    let three = Mechanism::serial(chain.build().expect("a chain"), home, Vector3::zeros());
    let three = three.expect("a machine");
    let error = choose_turns(&TurnTask::new(&three, &path, placement)).expect_err("three joints");
    assert!(error.to_string().contains("it has 3 joints"), "{error}");
    let (mechanism, path, mut placement) = across_a_straight_wrist();
    placement.orientation_follows = true;
    let error = choose_turns(&TurnTask::new(&mechanism, &path, placement)).expect_err("it follows");
    assert!(error.to_string().contains("orientation_follows"), "{error}");
}

#[test]
fn turns_of_another_path_are_refused() {
    let (mechanism, path, placement) = across_a_straight_wrist();
    let task = TurnTask::new(&mechanism, &path, placement);
    let choice = choose_turns(&task).expect("a way");
    let other = path_of("G21 G90\nG0 X0 Y0 Z0\nG1 X10 F600\n");
    let error = with_turns(&TurnTask::new(&mechanism, &other, placement), &choice)
        .expect_err("another path");
    assert!(
        error.to_string().contains("choose them for this path"),
        "{error}"
    );
}

#[test]
fn a_long_path_has_stations_farther_apart() -> Result<(), Box<dyn std::error::Error>> {
    let (mechanism, path, placement) = across_a_straight_wrist();
    let mut task = TurnTask::new(&mechanism, &path, placement);
    let all = choose_turns(&task)?;
    assert_eq!(all.station_mm, 5.0);
    // Room for a third of the postures: four times the distance.
    task.bounds.most_postures = all.tried.1 / 3;
    let fewer = choose_turns(&task)?;
    assert_eq!(fewer.station_mm, 20.0);
    assert!(fewer.tried.1 <= task.bounds.most_postures);
    let [close, far] = [&all, &fewer].map(|choice| choice.stations.len());
    assert!(3 * far < close && close < 5 * far, "{close} and {far}");
    assert!(fewer.smallest_singular_value >= task.bounds.least_singular_value);
    Ok(())
}
