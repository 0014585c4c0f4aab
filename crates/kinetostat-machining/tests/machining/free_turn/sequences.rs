//! The cheapest way against all sequences, and against a finer grid.

use std::f64::consts::TAU;

use kinetostat_machining::internal::{TurnPosture, turn_postures};
use kinetostat_machining::{
    TipCompliance, TurnBand, TurnCriterion, TurnCurve, TurnTask, choose_turns,
};
use kinetostat_testing::Worst;
use kinetostat_testing::figure::at_most;
use nalgebra::vector;

use super::{
    across_a_straight_wrist, downwards, milling_arm, path_of, singular_value_by_differences,
};

/// All sequences by going on from every posture to every other one, with nothing remembered but what it costs so far.
struct AllSequences<'p> {
    stations: &'p [(f64, Vec<TurnPosture>)],
    rate: f64,
    step_deg: f64,
    joint_step: f64,
    least_singular_value: f64,
    weights: [f64; 4],
    least_compliance: f64,
    circle: Option<i64>,
    best: f64,
    gone: u64,
}

impl AllSequences<'_> {
    fn posture_cost(&self, station: usize, posture: &TurnPosture) -> f64 {
        let at = |station: usize| self.stations[station].0;
        let (first, last) = (
            station.saturating_sub(1),
            (station + 1).min(self.stations.len() - 1),
        );
        let share = 0.5 * (at(last) - at(first)) / at(self.stations.len() - 1);
        let [limits, singularity, _, compliance] = self.weights;
        let singular = self.least_singular_value / posture.singular_value;
        let soft = match self.least_compliance > 0.0 {
            true => posture.compliance / self.least_compliance,
            false => 0.0,
        };
        share
            * (limits * posture.share_of_range.powi(2)
                + singularity * singular.powi(2)
                + compliance * soft)
    }

    fn go_on(&mut self, station: usize, from: Option<&TurnPosture>, cost: f64) {
        let stations = self.stations;
        if station == stations.len() {
            self.gone += 1;
            self.best = self.best.min(cost);
            return;
        }
        for posture in &stations[station].1 {
            let mut next = cost + self.posture_cost(station, posture);
            if let Some(from) = from {
                let way = stations[station].0 - stations[station - 1].0;
                let mut steps = i64::from(posture.turn) - i64::from(from.turn);
                if let Some(count) = self.circle {
                    steps = [steps - count, steps, steps + count]
                        .into_iter()
                        .min_by_key(|steps| steps.abs())
                        .unwrap();
                }
                let turn = self.step_deg * steps as f64;
                let most = self.rate * way;
                let jumps = posture
                    .joints
                    .iter()
                    .zip(&from.joints)
                    .any(|(a, b)| (a - b).abs() > self.joint_step);
                if posture.configuration != from.configuration
                    || turn.abs() > most * (1.0 + 1e-9)
                    || jumps
                {
                    continue;
                }
                let all = stations[stations.len() - 1].0;
                next += self.weights[2] * (turn / most).powi(2) * way / all;
            }
            self.go_on(station + 1, Some(posture), next);
        }
    }
}

#[test]
fn figure_the_choice_is_the_best_of_all_sequences() {
    let (mechanism, _, placement) = across_a_straight_wrist();
    let path = path_of("G21 G90\nG0 X0 Y-30 Z0\nG1 Y-10 F600\nG1 Y10\n");
    let cases = [
        ([1.0, 1.0, 1.0, 0.0], [-60.0, -10.0, 10.0], None),
        ([0.3, 2.0, 0.1, 0.0], [20.0, 70.0, 10.0], None),
        (
            [1.0, 0.0, 0.5, 0.7],
            [30.0, 60.0, 7.5],
            Some(TipCompliance::Along(vector![0.3, 1.0, 0.0])),
        ),
        (
            [0.0, 0.2, 0.5, 2.0],
            [-70.0, -30.0, 10.0],
            Some(TipCompliance::Worst),
        ),
        ([1.0, 0.5, 0.2, 0.0], [-180.0, 180.0, 40.0], None),
    ];
    let mut worst = Worst::new();
    for (weights, [from_deg, to_deg, step_deg], of) in cases {
        let mut task = TurnTask::new(&mechanism, &path, placement);
        task.station_mm = 10.0;
        task.band = TurnBand {
            from_deg,
            to_deg,
            step_deg,
        };
        let [limits, singularity, turning, compliance] = weights;
        task.criteria = vec![
            TurnCriterion::Limits { weight: limits },
            TurnCriterion::Singularity {
                weight: singularity,
            },
            TurnCriterion::Turning { weight: turning },
        ];
        if let Some(of) = of {
            task.criteria.push(TurnCriterion::Compliance {
                weight: compliance,
                of,
            });
        }
        task.bounds.rate_deg_per_mm = 4.0;
        task.bounds.joint_step_deg = 60.0;
        task.curve = TurnCurve::Steps;
        // One configuration after the other, so that all sequences can be gone.
        for number in [0, 4] {
            task.bounds.configuration = Some(number);
            let stations = turn_postures(&task).expect("postures");
            assert_eq!(stations.len(), 5);
            let all = stations.iter().flat_map(|s| &s.1);
            let least = all
                .map(|p| p.compliance)
                .fold(f64::INFINITY, kinetostat::number::smaller);
            let mut brute = AllSequences {
                stations: &stations,
                rate: 4.0,
                step_deg,
                joint_step: 60_f64.to_radians(),
                least_singular_value: task.bounds.least_singular_value,
                weights,
                least_compliance: least,
                circle: (to_deg - from_deg == 360.0).then_some(9),
                best: f64::INFINITY,
                gone: 0,
            };
            brute.go_on(0, None, 0.0);
            let choice = choose_turns(&task).expect("a way");
            assert_eq!(choice.broken_links, 0, "the brute force knows of none");
            assert!(brute.gone > 50, "{} sequences", brute.gone);
            worst.add((choice.cost - brute.best).abs());
            assert!(
                (choice.cost - brute.best).abs() <= 1e-12,
                "{} {} of {}",
                choice.cost,
                brute.best,
                brute.gone
            );
        }
    }
    let name = "free turn: cost, beside the best of all sequences";
    assert!(at_most(name, worst.value(), 1e-12, "1"), "{worst:?}");
}

/// What is compared above is right by itself: joint values that lead to the pose, singular values and limits by differences and by hand.
#[test]
fn postures_are_what_they_say() {
    let (mechanism, path, placement) = across_a_straight_wrist();
    let mut task = TurnTask::new(&mechanism, &path, placement);
    task.station_mm = 130.0;
    task.band.step_deg = 30.0;
    let (spans, mut looked) = ([185.0, 70.0, 135.0, 350.0, 125.0, 350.0], 0);
    let middles = [0.0, 5.0, 15.0, 0.0, 0.0, 0.0];
    task.bounds.rate_deg_per_mm = 1.0;
    for (at, postures) in turn_postures(&task).expect("postures") {
        for posture in postures {
            looked += 1;
            let tool = super::tool_at(&mechanism, &posture.joints);
            let position = placement.base_from_part.translation.vector
                + vector![0.0, 1e-3 * (at - 500.0), 0.0];
            assert!((tool.translation.vector - position).norm() < 1e-9);
            let turn = -180.0 + 30.0 * f64::from(posture.turn);
            let wanted = placement.tool_orientation
                * nalgebra::UnitQuaternion::from_axis_angle(
                    &nalgebra::Vector3::z_axis(),
                    f64::to_radians(turn),
                );
            assert!(tool.rotation.angle_to(&wanted) < 1e-7);
            let least = singular_value_by_differences(&mechanism, &posture.joints);
            assert!(
                (least - posture.singular_value).abs() < 1e-7,
                "{least} {}",
                posture.singular_value
            );
            let shares = posture.joints.iter().zip(spans).zip(middles);
            let share =
                shares.map(|((joint, span), middle)| (joint.to_degrees() - middle).abs() / span);
            let share = share.fold(0.0, kinetostat::number::larger);
            assert!((share - posture.share_of_range).abs() < 1e-9);
            assert!(posture.joints.iter().all(|joint| joint.abs() < TAU));
        }
    }
    assert!(looked > 100, "{looked}");
}

/// Four times as many stations and turns: the cost is the same within a few percent, and not more.
#[test]
fn a_finer_grid_finds_little_more() {
    let mechanism = milling_arm("heavy_6r");
    let path = path_of(
        "G21 G90 G17\nG0 X0 Y-150 Z0\nG1 X120 Y-150 F900\nG3 X200 Y-70 I0 J80\nG1 Y60\nG3 X120 Y140 I-80 J0\nG1 X0\n",
    );
    let mut task = TurnTask::new(&mechanism, &path, downwards(vector![1.35, 0.1, 0.9], 0.0));
    task.bounds.rate_deg_per_mm = 1.0;
    task.station_mm = 12.0;
    task.band.step_deg = 6.0;
    let coarse = choose_turns(&task).expect("a way");
    task.station_mm = 3.0;
    task.band.step_deg = 1.5;
    let fine = choose_turns(&task).expect("a way");
    assert!(fine.cost > 0.0 && fine.cost.is_finite());
    assert!(
        (coarse.cost / fine.cost - 1.0).abs() < 0.03,
        "{} {}",
        coarse.cost,
        fine.cost
    );
    // Nothing that stays the same is better.
    for choice in [&coarse, &fine] {
        let constant = choice.best_constant.expect("a band");
        assert!(constant.cost.is_none_or(|cost| cost >= choice.cost - 1e-12));
    }
}
