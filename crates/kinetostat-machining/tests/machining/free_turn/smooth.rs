//! The smooth curve against a dense search that is written apart, and against the steps that it is made from.

use kinetostat::number::larger;
use kinetostat_machining::internal::{TurnPosture, turn_postures};
use kinetostat_machining::{
    TurnBand, TurnBounds, TurnChoice, TurnCurve, TurnTask, choose_turns, with_turns,
};
use kinetostat_testing::figure::at_most;

use super::{
    across_a_straight_wrist, around_the_base, downwards, milling_arm, path_of, task_around,
};

const RATE: f64 = 0.4;

/// What a turn costs: nearness to limits and to singular postures at a station, and evenness, all with the weight 1.
fn at_station(share_of_range: f64, least: f64, singular_value: f64) -> f64 {
    share_of_range.powi(2) + (least / singular_value).powi(2)
}

/// The cheapest sequence on a grid of turns in one configuration, by going from station to station.
fn dense(stations: &[(f64, Vec<TurnPosture>)], number: u8, step_deg: f64, least: f64) -> f64 {
    let all = stations[stations.len() - 1].0;
    let mut values: Vec<(u32, [f64; 6], f64)> = Vec::new();
    for (index, (at, postures)) in stations.iter().enumerate() {
        let before = stations[index.saturating_sub(1)].0;
        let behind = stations[(index + 1).min(stations.len() - 1)].0;
        let share = 0.5 * (behind - before) / all;
        let mut next = Vec::new();
        for posture in postures.iter().filter(|p| p.configuration == number) {
            let own = share * at_station(posture.share_of_range, least, posture.singular_value);
            let way = at - before;
            let from = values.iter().filter_map(|(turn, joints, value)| {
                let turned = step_deg * (f64::from(posture.turn) - f64::from(*turn));
                let jumps = (joints.iter().zip(&posture.joints)).any(|(a, b)| (a - b).abs() > 0.3);
                let allowed = turned.abs() <= RATE * way * (1.0 + 1e-9) && !jumps;
                allowed.then(|| value + (turned / (RATE * way)).powi(2) * way / all)
            });
            let best = match index {
                0 => 0.0,
                _ => from.fold(f64::INFINITY, kinetostat::number::smaller),
            };
            if best.is_finite() {
                next.push((posture.turn, posture.joints, best + own));
            }
        }
        values = next;
    }
    let ends = values.iter().map(|(_, _, value)| *value);
    ends.fold(f64::INFINITY, kinetostat::number::smaller)
}

/// What a choice costs, from its stations alone; limits of the heavy arm by hand.
fn cost_of(choice: &TurnChoice, least: f64) -> f64 {
    let (spans, middles) = (
        [185.0, 70.0, 135.0, 350.0, 125.0, 350.0],
        [0.0, 5.0, 15.0, 0.0, 0.0, 0.0],
    );
    let stations = &choice.stations;
    let all = stations[stations.len() - 1].way_mm;
    let mut cost = 0.0;
    for (index, station) in stations.iter().enumerate() {
        let before = &stations[index.saturating_sub(1)];
        let behind = &stations[(index + 1).min(stations.len() - 1)];
        let shares = station.joints_deg.iter().zip(spans).zip(middles);
        let share_of_range = shares
            .map(|((joint, span), middle)| (joint - middle).abs() / span)
            .fold(0.0, larger);
        let own = at_station(share_of_range, least, station.smallest_singular_value);
        cost += 0.5 * (behind.way_mm - before.way_mm) / all * own;
        if index > 0 {
            let way = station.way_mm - before.way_mm;
            let turned = station.turn_deg - before.turn_deg;
            cost += (turned / (RATE * way)).powi(2) * way / all;
        }
    }
    cost
}

/// From steps of 5 deg the curve becomes cheaper than the best of all sequences in steps of half a degree, and turns evenly.
#[test]
fn figure_it_costs_no_more_than_a_dense_search() {
    let (mechanism, path, placement) = across_a_straight_wrist();
    let mut task = TurnTask::new(&mechanism, &path, placement);
    task.station_mm = 25.0;
    task.bounds.rate_deg_per_mm = RATE;
    task.bounds.least_singular_value = 0.05;
    task.band = TurnBand {
        from_deg: -100.0,
        to_deg: 100.0,
        step_deg: 5.0,
    };
    let choice = choose_turns(&task).expect("a way");
    let own = cost_of(&choice, 0.05);
    assert!((own - choice.cost).abs() < 1e-9, "{own} {}", choice.cost);

    task.band.step_deg = 0.5;
    let stations = turn_postures(&task).expect("postures");
    assert_eq!(stations.len(), choice.stations.len());
    let dense = dense(&stations, choice.configuration, 0.5, 0.05);
    assert!(dense.is_finite());
    let name = "free turn: cost, by that of a dense search in steps of half a degree";
    let by_dense = choice.cost / dense;
    assert!(
        at_most(name, by_dense, 1.0 + 1e-6, "1"),
        "{} {dense}",
        choice.cost
    );

    let steps = choice.in_steps.expect("it was made from steps");
    assert!(choice.cost < steps.cost, "{} {}", choice.cost, steps.cost);
    let [before, after] = [
        steps.largest_rate_change_deg_per_mm,
        choice.largest_rate_change_deg_per_mm,
    ];
    // A step of 5 deg on 25 mm, and the next station without one.
    assert!(before >= 0.2 - 1e-9, "{before}");
    assert!(after < 0.25 * before, "{after} {before}");
    assert!(choice.largest_rate_deg_per_mm <= RATE * (1.0 + 1e-9));
}

/// Whatever the path, what is asked of the steps holds for the curve: rate, limits, singular postures, one configuration.
#[test]
fn it_keeps_what_the_steps_keep() {
    let (arm, around, placement) = around_the_base();
    let lines = path_of("G21 G90\nG0 X0 Y-150 Z0\nG1 X120 F900\nG1 Y60\nG1 X-40 Y90\nG1 X0\n");
    let other = milling_arm("heavy_6r");
    let mut tasks = vec![task_around(&arm, &around, placement)];
    let mut task = TurnTask::new(
        &other,
        &lines,
        downwards(nalgebra::vector![1.35, 0.1, 0.9], 40.0),
    );
    task.bounds = TurnBounds {
        rate_deg_per_mm: 0.7,
        limit_margin_deg: 5.0,
        ..TurnBounds::default()
    };
    task.station_mm = 8.0;
    tasks.push(task);
    let mut uneven = 0;
    for task in tasks {
        let rate = task.bounds.rate_deg_per_mm;
        let choice = choose_turns(&task).expect("a way");
        let steps = choice.in_steps.expect("steps");
        assert!(choice.cost <= steps.cost && choice.cost > 0.0);
        // Where the steps of the band are one, the curve may turn a little.
        let [own, before] = [
            choice.largest_rate_change_deg_per_mm,
            steps.largest_rate_change_deg_per_mm,
        ];
        assert!(own < 0.5 * before || own < 0.01, "{own} {before}");
        uneven += usize::from(before > 0.0);
        assert!(choice.smallest_singular_value >= task.bounds.least_singular_value);
        let (_, far, _) = choice.nearest_limit.expect("limits");
        assert!(far >= task.bounds.limit_margin_deg - 1e-9, "{far}");
        for pair in choice.stations.windows(2) {
            let turn = (pair[1].turn_deg - pair[0].turn_deg).abs();
            let way = pair[1].way_mm - pair[0].way_mm;
            assert!(turn <= rate * way * (1.0 + 1e-9), "{turn} deg on {way} mm");
        }
        // The steps alone are there for whom wants them, and divide the program no less.
        let mut coarse = task.clone();
        coarse.curve = TurnCurve::Steps;
        let in_steps = choose_turns(&coarse).expect("a way");
        assert_eq!(in_steps.in_steps, None);
        assert!((in_steps.cost - steps.cost).abs() < 1e-12);
        let turned = with_turns(&task, &choice).expect("a path");
        assert!(turned.added < choice.stations.len());
    }
    assert!(uneven > 0, "steps that are worth smoothing");
}
