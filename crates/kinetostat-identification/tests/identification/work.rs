//! From a plan over measurements to a compensated machine, a hundred times; intervals by resampled postures.

use kinetostat_identification::{
    FitOptions, Observation, PlanTask, Purpose, Reading, Room, TestLoad, Theory, Unknowns,
    identification, identified_model, plan, predict,
};
use kinetostat_model::Model;
use kinetostat_testing::Worst;
use nalgebra::{DVector, Vector3, vector};

use crate::support::{Random, angles, asked, h6, put};

type Outcome = anyhow::Result<()>;

const OPTIONS: FitOptions = FitOptions {
    theory: Theory::Loaded,
    robust: false,
    prior: Some(0.3),
};

/// The preset, with links that bend and twist behind axes 2 and 4.
fn arm() -> anyhow::Result<Model> {
    let mut text = Model::preset("kuka_kr270_like")?.text;
    for (behind, name, stiffness) in [
        ("name = \"upper arm\"", "upper arm", 8e6),
        ("name = \"forearm\"", "forearm", 3e6),
    ] {
        let at = text
            .find(behind)
            .and_then(|at| Some(at + text[at..].find('\n')?));
        let at = at.ok_or_else(|| anyhow::anyhow!("no {name}"))?;
        let springs = [("twists", "x"), ("bends", "z")].map(|(how, axis)| {
            format!("\n  {{ spring = \"revolute\", name = \"{name} {how}\", axis = \"{axis}\", stiffness_n_m_per_rad = {stiffness:e} }},")
        });
        text.insert_str(at, &springs.concat());
    }
    Ok(Model::from_toml(&text, "arm.toml")?)
}

fn at_work() -> Vec<Observation> {
    let postures = [
        [0.0, -95.0, 105.0, 0.0, 80.0, 0.0],
        [25.0, -75.0, 95.0, 20.0, 60.0, 40.0],
        [-30.0, -60.0, 70.0, -10.0, 75.0, 10.0],
    ];
    let load = TestLoad::force_at(Vector3::zeros(), vector![1000.0, -625.0, -1125.0]);
    let one = |(i, deg): (usize, &[f64; 6])| {
        let commands = deg.iter().map(|q| q.to_radians()).collect();
        let tip = Reading::displacement(Vector3::zeros(), &Vector3::zeros(), 1.0);
        asked(i, commands, load, tip.into())
    };
    postures.iter().enumerate().map(one).collect()
}

#[test]
fn joints_links_and_a_compensator_are_found_and_compensated() -> Outcome {
    let drawn = arm()?;
    let compensator = "limb.arm.load.compensator.stiffness_n_per_mm";
    let patterns = ["joints", "chain.arm.*twists*", "chain.arm.*bends*"];
    let numbers = Unknowns::matching(&drawn, &patterns)?;
    // Softer everywhere, so that the errors do not balance each other.
    let own = numbers.list().iter();
    let mut changes: Vec<(&str, f64)> = own
        .map(|u| (u.parameter.path.as_str(), 0.8 * u.parameter.value))
        .collect();
    let own = drawn.parameters();
    let spring = own.iter().find(|p| p.path == compensator);
    let spring = spring.ok_or_else(|| anyhow::anyhow!("no {compensator}"))?;
    changes.push((compensator, 1.2 * spring.value));
    let built = drawn.with_parameters(&changes)?;

    let work = at_work();
    let marker = vector![0.15, 0.1, 0.0];
    let loads = [
        vector![0.0, 0.0, -2500.0],
        vector![1500.0, 0.0, 0.0],
        vector![0.0, 1500.0, 0.0],
    ];
    let task = PlanTask {
        model: &drawn,
        unknowns: &numbers,
        loads: loads
            .map(|force| TestLoad::force_at(vector![0.1, 0.0, 0.1], force))
            .into(),
        markers: vec![marker],
        deviation: 30e-6,
        count: 30,
        given: Vec::new(),
        candidates: 100,
        seed: 0,
        room: Room {
            bounds: [None, None, Some((0.3, 3.0))],
            tracker: Some(vector![4.0, -2.0, 1.5]),
        },
        purpose: Purpose::Compensation(work.clone()),
        theory: Theory::Loaded,
    };
    let planned = plan(&task)?;
    let efficiency = planned.efficiency.unwrap_or(f64::NAN);
    assert!((0.8..=1.0).contains(&efficiency), "{efficiency}");
    assert!(planned.gain.is_some_and(|g| g > 1.2), "{:?}", planned.gain);
    for m in &planned.measurements {
        assert!((0.3..=3.0).contains(&m.position.z), "{}", m.position);
    }
    let mut observations: Vec<Observation> = (planned.measurements.iter().enumerate())
        .map(|(i, m)| {
            let readings = Reading::displacement(marker, &Vector3::zeros(), 30e-6);
            asked(i, m.shown.clone(), m.load, readings.into())
        })
        .collect();
    let truth = Unknowns::matching(&built, &["joints"])?;
    let of_truth = |asked: &[Observation]| predict(&truth, &truth.nominal(), asked, Theory::Loaded);
    let (shown, true_work) = (of_truth(&observations)?, of_truth(&work)?);
    // Errors of each place that a model which compensates leaves.
    let left = |model: &Model| -> anyhow::Result<Vec<DVector<f64>>> {
        let own = Unknowns::matching(model, &["joints"])?;
        let said = predict(&own, &own.nominal(), &work, Theory::Loaded)?;
        Ok((said.iter().zip(&true_work))
            .map(|(a, b)| &a.values - &b.values)
            .collect())
    };
    let before = left(&drawn)?;
    assert!(before.iter().all(|e| e.norm() > 0.3e-3), "{before:?}");

    let mut random = Random::new(3);
    let (mut worst, mut inside) = (Worst::new(), 0);
    for _ in 0..100 {
        put(&mut observations, &shown, &mut |r| {
            r.deviation * random.normal()
        });
        let found = identification(&numbers, &observations, &OPTIONS)?;
        let stated = found.at_work(&numbers, &work, Theory::Loaded)?;
        let errors = left(&identified_model(&drawn, &found, "plan.csv")?)?;
        for (error, stated) in errors.iter().zip(&stated) {
            worst.add(error.norm());
            inside += usize::from(
                stated
                    .after_mm
                    .is_some_and(|most| 1e3 * error.norm() < most),
            );
        }
    }
    assert!(worst.of(300) < 0.03e-3, "{:e}", worst.of(300));
    assert!(inside >= 285, "{inside} of 300 within what was stated");
    Ok(())
}

#[test]
fn nothing_bounds_an_error_by_what_no_reading_shows() -> Outcome {
    // Weights do not show joint 1, which a push from the side turns.
    let drawn = h6(false);
    let numbers = Unknowns::matching(&drawn, &["joints"])?;
    let mut random = Random::new(1);
    let under = |force| TestLoad::force_at(vector![0.2, 0.1, 0.0], force);
    let one = |i, random: &mut Random, force| {
        let commands = angles(random);
        let readings = Reading::displacement(Vector3::zeros(), &Vector3::zeros(), 2e-5);
        asked(i, commands, under(force), readings.into())
    };
    let down = vector![0.0, 0.0, -1500.0];
    let mut observations: Vec<Observation> = (0..12).map(|i| one(i, &mut random, down)).collect();
    let shown = predict(&numbers, &numbers.nominal(), &observations, Theory::Loaded)?;
    put(&mut observations, &shown, &mut |r| {
        r.deviation * random.normal()
    });
    let options = FitOptions {
        prior: None,
        ..OPTIONS
    };
    let found = identification(&numbers, &observations, &options)?;
    let work = [
        one(0, &mut random, down),
        one(1, &mut random, vector![0.0, 500.0, 0.0]),
    ];
    let stated = found.at_work(&numbers, &work, Theory::Loaded)?;
    assert!(stated[0].after_mm.is_some() && stated[1].after_mm.is_none());
    let believed = identification(&numbers, &observations, &OPTIONS)?;
    let stated = believed.at_work(&numbers, &work, Theory::Loaded)?;
    assert!(
        stated
            .iter()
            .all(|s| s.after_mm.is_some_and(|most| most > 0.0))
    );
    Ok(())
}
