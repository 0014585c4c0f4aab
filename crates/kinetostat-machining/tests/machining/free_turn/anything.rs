//! Whatever is asked: an answer that keeps what was asked, or words; never a panic.

use std::f64::consts::PI;

use kinetostat_machining::{Placement, TurnBand, TurnError, TurnTask, choose_turns, with_turns};
use kinetostat_program::irregular;
use nalgebra::{UnitQuaternion, Vector3};

use super::moved::{Wrists, arm};
use super::path_of;

/// What became of a question.
#[derive(Clone, Copy, PartialEq)]
enum Answer {
    Turns,
    NoWay,
    Refused,
}

fn asked(sample: u64) -> Answer {
    let mut next = 0;
    let mut number = |low: f64, high: f64| {
        next += 1;
        low + (high - low) * irregular(11, sample, next)
    };
    let place = [number(0.3, 1.1), number(-0.5, 0.5), number(0.1, 1.0)];
    let tilts = [number(-0.6, 0.6), number(-0.6, 0.6), number(-3.0, 3.0)];
    let band = (number(-200.0, 200.0), number(5.0, 360.0), number(3.0, 40.0));
    let count = number(1.0, 6.0) as usize;
    let ends: Vec<[f64; 3]> = (0..count)
        .map(|_| {
            [
                number(-150.0, 150.0),
                number(-150.0, 150.0),
                number(-60.0, 60.0),
            ]
        })
        .collect();
    let (station_mm, rate, bound) = (number(4.0, 40.0), number(0.3, 8.0), number(0.02, 0.3));
    let free = number(0.0, 1.0) < 0.5;
    let mechanism = arm(
        &kinetostat::Pose::identity(),
        match free {
            true => Wrists::TurnOn,
            false => Wrists::Limited,
        },
    );
    let mut text = "G21 G90\nG0 X0 Y0 Z0\nF600\n".to_owned();
    for (k, [x, y, z]) in ends.iter().enumerate() {
        // Ways that nobody knows, too.
        let word = if k % 4 == 3 { "G53 G0 Z0\nG0" } else { "G1" };
        text.push_str(&format!("{word} X{x:.3} Y{y:.3} Z{z:.3}\n"));
    }
    let path = path_of(&text);
    let mut placement = Placement::at(Vector3::from(place));
    placement.tool_orientation = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), tilts[2])
        * UnitQuaternion::from_euler_angles(PI + tilts[0], tilts[1], 0.0);
    let mut task = TurnTask::new(&mechanism, &path, placement);
    task.station_mm = station_mm;
    task.band = TurnBand {
        from_deg: band.0,
        to_deg: band.0 + band.1,
        step_deg: band.2,
    };
    task.bounds.rate_deg_per_mm = rate;
    task.bounds.least_singular_value = bound;
    match choose_turns(&task) {
        Ok(choice) => {
            assert!(choice.smallest_singular_value >= bound);
            assert!(choice.largest_rate_deg_per_mm <= rate * (1.0 + 1e-6));
            for pair in choice
                .stations
                .windows(2)
                .filter(|pair| !pair[1].after_break)
            {
                let (way, turn) = (
                    pair[1].way_mm - pair[0].way_mm,
                    pair[1].turn_deg - pair[0].turn_deg,
                );
                assert!(way > 0.0 && way <= station_mm * (1.0 + 1e-9));
                assert!(turn.abs() <= rate * way * (1.0 + 1e-6));
            }
            for station in &choice.stations {
                // On the whole circle it goes on at the other end.
                let inside =
                    station.turn_deg >= band.0 - 1e-9 && station.turn_deg <= band.0 + band.1 + 1e-9;
                assert!(inside || band.1 > 359.0, "{}", station.turn_deg);
                assert!(
                    station
                        .nearest_limit
                        .is_some_and(|(_, far)| far >= 1.0 - 1e-9)
                );
            }
            assert!(
                choice
                    .nearest_limit
                    .is_some_and(|(_, far, _)| far >= 1.0 - 1e-9)
            );
            let best = choice.best_constant.and_then(|constant| constant.cost);
            assert!(choice.broken_links > 0 || best.is_none_or(|cost| cost >= choice.cost - 1e-12));
            let turned = with_turns(&task, &choice).expect("a path");
            assert!(
                turned
                    .path
                    .moves
                    .iter()
                    .all(|motion| motion.tool_turn.is_some())
            );
            assert!(turned.axis_off_deg < 1e-5);
            Answer::Turns
        }
        Err(TurnError::NoWay(found)) => {
            let words = found.to_string();
            let begins = format!("line {}: at X", found.line);
            assert!(
                words.starts_with(&begins) && !words.contains("NaN"),
                "{words}"
            );
            assert!(found.line >= 3 && !found.barriers.is_empty(), "{words}");
            Answer::NoWay
        }
        Err(TurnError::Input { what }) => {
            assert!(
                what.contains("could never turn")
                    || what.contains("no length")
                    || what.contains("too far apart"),
                "{what}"
            );
            Answer::Refused
        }
        Err(other) => panic!("{other}"),
    }
}

#[test]
fn an_answer_keeps_what_was_asked() {
    let answers: Vec<Answer> = (0..120).map(asked).collect();
    for (answer, least) in [(Answer::Turns, 8), (Answer::NoWay, 8), (Answer::Refused, 3)] {
        let count = answers.iter().filter(|other| **other == answer).count();
        assert!(count >= least, "{count} of {least}");
    }
}
