//! A singular posture planted on the way: gone around, smoothly, and looked at between the stations by the mechanism's own inverse
//! kinematics and differences of its forward kinematics.

use kinetostat::{Mechanism, PostureRequest};
use kinetostat_machining::internal::configuration_at;
use kinetostat_machining::{
    Placement, TurnBounds, TurnChoice, TurnTask, TurnedPath, choose_turns, with_turns,
};
use kinetostat_testing::figure::{at_least, at_most};
use kinetostat_testing::{Worst, largest};
use nalgebra::{UnitQuaternion, Vector3};

use super::{across_a_straight_wrist, around_the_base, singular_value_by_differences, task_around};

/// What an arm does along a path that states its orientations, followed from joint values (rad) at its start.
struct Followed {
    least: f64,
    samples: usize,
    /// Largest turn of a joint from one sample to the next, rad.
    largest_step: f64,
    numbers: Vec<u8>,
}

fn follow(
    mechanism: &Mechanism,
    placement: &Placement,
    turned: &TurnedPath,
    start: &[f64; 6],
    per_move: usize,
) -> Followed {
    let mut near = mechanism
        .posture(PostureRequest::commands(start))
        .expect("a posture");
    let mut found = Followed {
        least: f64::INFINITY,
        samples: 0,
        largest_step: 0.0,
        numbers: Vec::new(),
    };
    for motion in turned
        .path
        .moves
        .iter()
        .filter(|motion| motion.is_known_feed())
    {
        for sample in 0..=per_move {
            let share = sample as f64 / per_move as f64;
            let pose = placement.pose(
                &motion.point(share),
                placement.orientation_on(motion, share),
            );
            let posture = mechanism
                .posture(PostureRequest::pose(&pose).near(&near))
                .expect("a posture");
            posture.within_limits().expect("inside its limits");
            let joints: [f64; 6] = posture.commands().try_into().expect("six joints");
            let least = singular_value_by_differences(mechanism, &joints);
            assert!(least.is_finite());
            found.least = found.least.min(least);
            found
                .numbers
                .push(configuration_at(mechanism, &joints).expect("an arm").number);
            for (a, b) in near.commands().iter().zip(&joints) {
                found.largest_step = kinetostat::number::larger(found.largest_step, (a - b).abs());
            }
            found.samples += 1;
            near = posture;
        }
    }
    found.numbers.sort_unstable();
    found.numbers.dedup();
    found
}

fn start_of(choice: &TurnChoice) -> [f64; 6] {
    choice.stations[0].joints_deg.map(f64::to_radians)
}

/// At constant turn the wrist is straight in the middle of the line. The turns that are chosen stay away from that, and keep the rate.
#[test]
fn figure_a_planted_singular_posture_is_gone_around() {
    let (mechanism, path, placement) = across_a_straight_wrist();
    let mut task = TurnTask::new(&mechanism, &path, placement);
    task.bounds = TurnBounds {
        rate_deg_per_mm: 1.5,
        least_singular_value: 0.1,
        ..TurnBounds::default()
    };
    // As the program is: singular within a millimetre of the middle.
    let straight = mechanism
        .posture(PostureRequest::commands(&super::STRAIGHT))
        .expect("a posture");
    let joints: [f64; 6] = straight.commands().try_into().expect("six");
    assert!(singular_value_by_differences(&mechanism, &joints) < 1e-8);

    let choice = choose_turns(&task).expect("a way");
    let programmed = choice.as_programmed.expect("no turn is in the band");
    assert!(
        programmed.cost.is_none() && programmed.ends_on_line.is_some(),
        "{programmed:?}"
    );
    let turned = with_turns(&task, &choice).expect("a path");
    let found = follow(&mechanism, &placement, &turned, &start_of(&choice), 300);
    assert!(found.samples > 900, "{}", found.samples);
    let name = "free turn: smallest singular value beside a planted singular posture";
    assert!(at_least(name, found.least, 0.1, "1"), "{}", found.least);
    // What is reported is what is there, but for places between those that were looked at.
    assert!(
        (found.least - choice.smallest_singular_value).abs() < 2e-3,
        "{} {}",
        found.least,
        choice.smallest_singular_value
    );
    assert_eq!(found.numbers, [choice.configuration]);
    assert!(found.largest_step < 0.1, "{}", found.largest_step);
}

/// Where no turn that stays the same goes all the way.
#[test]
fn the_tool_turns_where_it_must() {
    let (mechanism, path, placement) = around_the_base();
    let task = task_around(&mechanism, &path, placement);
    let choice = choose_turns(&task).expect("a way");
    let best = choice.best_constant.expect("a band");
    assert!(best.cost.is_none() && best.share_of_way < 0.99, "{best:?}");
    assert!(choice.description().contains("No constant turn"));
    let turned = with_turns(&task, &choice).expect("a path");
    let found = follow(&mechanism, &placement, &turned, &start_of(&choice), 200);
    assert!(found.samples > 900, "{}", found.samples);
    // Between the places that were looked at, 10 mm apart, it may be a thousandth less.
    assert!(found.least >= 0.099, "{}", found.least);
    assert_eq!(found.numbers, [choice.configuration]);
}

/// Between any two samples of the path that is written the tool turns no faster than allowed, and about nothing but its axis.
#[test]
fn figure_no_step_is_above_the_rate() {
    let (mechanism, path, placement) = around_the_base();
    let mut by_rate = Worst::new();
    for (rate, station_mm) in [(0.06, 50.0), (0.045, 60.0), (0.1, 37.0)] {
        let mut task = task_around(&mechanism, &path, placement);
        task.station_mm = station_mm;
        task.bounds.rate_deg_per_mm = rate;
        let choice = choose_turns(&task).expect("a way");
        let turned = with_turns(&task, &choice).expect("a path");
        let (mut fastest, mut steps, mut axis) = (0.0_f64, 0, Worst::new());
        let mut last: Option<(Vector3<f64>, UnitQuaternion<f64>)> = None;
        let mut turned_by = 0.0;
        for motion in turned.path.moves.iter().filter(|m| m.is_known_feed()) {
            for sample in 0..=100 {
                let share = f64::from(sample) / 100.0;
                let orientation = motion.orientation(share).expect("stated");
                let here = (motion.point(share), orientation);
                if let Some((point, before)) = last {
                    // Along an arc of 1500 mm.
                    let chord: f64 = (here.0 - point).norm();
                    let way = 3000.0 * (chord / 3000.0).asin();
                    let turn = before.angle_to(&orientation).to_degrees();
                    assert!(
                        turn <= rate * way * (1.0 + 1e-6) + 1e-5,
                        "{turn} deg on {way} mm"
                    );
                    if way > 1e-3 {
                        fastest = largest([fastest, turn / way]);
                        by_rate.add(turn / way / rate);
                        turned_by += turn;
                    }
                    steps += 1;
                }
                axis.add((orientation * Vector3::z() + Vector3::z()).norm());
                last = Some(here);
            }
        }
        assert!(steps > 500 && axis.value() < 1e-12, "{axis:?}");
        // It does turn, and what is reported is the fastest.
        assert!(turned_by > 10.0, "{turned_by}");
        let reported = choice.largest_rate_deg_per_mm;
        assert!(
            (fastest - reported).abs() < 1e-3 * rate,
            "{fastest} {reported}"
        );
    }
    let name = "free turn: fastest turn along the written path, share of the rate allowed";
    assert!(at_most(name, by_rate.value(), 1.001, "1"), "{by_rate:?}");
}
