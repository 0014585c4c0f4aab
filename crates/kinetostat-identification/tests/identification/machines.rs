//! Other machines than arms, other columns than the product's own, chance, and the way from a plan to a compensated machine.

use std::fmt::Write;

use kinetostat::{Pose, PostureRequest};
use kinetostat_identification::{
    Body, BodyPoint, FitOptions, Observation, PlanTask, Purpose, Reading, Room, Start, TestLoad,
    Theory, Unknowns, identify, least_squares, plan, predict,
};
use kinetostat_model::Model;
use nalgebra::{DMatrix, DVector, Rotation3, Translation3, UnitQuaternion, Vector3, vector};

use crate::regressors::Arm;
use crate::support::{
    H6, MARKERS, Random, TOOL, angles, asked, h6, pulls, put, three_markers, worst,
};

type Outcome = anyhow::Result<()>;

const SMALL: FitOptions = FitOptions {
    theory: Theory::SmallLoads,
    robust: false,
    prior: None,
};
const LOADED: FitOptions = FitOptions {
    theory: Theory::Loaded,
    robust: false,
    prior: None,
};

/// Hexapod of P13: legs between points on two circles.
fn hexapod(stiffness: &[f64; 6]) -> anyhow::Result<Model> {
    let base = [0.0_f64, 20.0, 120.0, 140.0, 240.0, 260.0].map(f64::to_radians);
    let top = [-20.0_f64, 40.0, 100.0, 160.0, 220.0, 280.0].map(f64::to_radians);
    let height = 1.05;
    let mut chains = String::new();
    let mut limbs = String::new();
    for i in 0..6 {
        let from = vector![base[i].cos(), base[i].sin(), 0.0];
        let on_platform = vector![0.5 * top[i].cos(), 0.5 * top[i].sin(), 0.0];
        let leg = on_platform + vector![0.0, 0.0, height] - from;
        let x = leg.normalize();
        let y = Vector3::z().cross(&x).normalize();
        let axes = format!("x_axis = {:?}, y_axis = {:?}", x.as_slice(), y.as_slice());
        let _ = write!(
            chains,
            "[chain.leg{i}]\nelements = [\n{{ passive = \"universal\", name = \"foot\", axes = [\"y\", \"z\"] }},\n{{ actuator = \"prismatic\", name = \"leg\", axis = \"x\", stiffness_n_per_m = {:e}, home_m = {} }},\n{{ passive = \"spherical\", name = \"head\" }},\n]\n",
            stiffness[i],
            leg.norm()
        );
        let _ = write!(
            limbs,
            "[[limb]]\nname = \"leg {i}\"\nfrom = \"base\"\nto = \"tool\"\nchain = \"leg{i}\"\nstart = {{ position_m = {:?}, {axes} }}\nend = {{ position_m = {:?}, {axes} }}\n",
            from.as_slice(),
            on_platform.as_slice()
        );
    }
    let text = format!(
        "schema = 1\n[mechanism]\nname = \"hexapod\"\ngravity_m_per_s2 = [0, 0, 0]\n[[platform]]\nname = \"tool\"\nhome = {{ position_m = [0, 0, {height}] }}\n{chains}{limbs}"
    );
    Ok(Model::from_toml(&text, "hexapod.toml")?)
}

#[test]
fn legs_of_a_hexapod_are_found_from_its_platform() -> Outcome {
    // P13.
    let model = hexapod(&[22e6, 18e6, 25e6, 20e6, 16e6, 24e6])?;
    let mut random = Random::new(101);
    let mut observations = Vec::new();
    for i in 0..20 {
        let at = vector![
            random.between(-0.2, 0.2),
            random.between(-0.2, 0.2),
            random.between(0.9, 1.2)
        ];
        let about_z = Rotation3::from_axis_angle(&Vector3::z_axis(), random.between(-0.3, 0.3));
        let turn =
            about_z * Rotation3::from_axis_angle(&Vector3::x_axis(), random.between(-0.2, 0.2));
        let pose = Pose::from_parts(
            Translation3::from(at),
            UnitQuaternion::from_rotation_matrix(&turn),
        );
        let commands = model.mechanism.posture(&pose)?.commands();
        let load = TestLoad {
            force: random.vector(500.0),
            moment: random.vector(150.0),
            at: BodyPoint::default(),
        };
        let mut readings: Vec<Reading> =
            Reading::displacement(Vector3::zeros(), &Vector3::zeros(), 4e-6).into();
        readings.extend(Reading::turn(Body::Tool, &Vector3::zeros(), 6e-6));
        observations.push(asked(i, commands, load, readings));
    }
    let unknowns = Unknowns::matching(&model, &["joints"])?;
    let predictions = predict(
        &unknowns,
        &unknowns.nominal(),
        &observations,
        Theory::SmallLoads,
    )?;
    put(&mut observations, &predictions, &mut |r| {
        r.deviation * random.normal()
    });
    // From a machine whose legs are all alike.
    let alike = hexapod(&[20e6; 6])?;
    let found = identify(
        &Unknowns::matching(&alike, &["joints"])?,
        &observations,
        &SMALL,
    )?;
    let legs = [
        4.112851156e-8,
        6.003454362e-8,
        4.144485671e-8,
        5.136438185e-8,
        6.058974009e-8,
        4.392358212e-8,
    ];
    assert!(
        worst(found.linear.estimate.as_slice(), &legs) < 1e-6,
        "{}",
        found.linear.estimate
    );
    Ok(())
}

#[test]
fn columns_are_those_of_a_product_of_exponentials() -> Outcome {
    let model = h6(false);
    let arm = Arm::h6();
    let unknowns = Unknowns::matching(&model, &["joints"])?;
    let mut random = Random::new(17);
    for i in 0..10 {
        let commands = angles(&mut random);
        let force = random.vector(2000.0);
        let own = arm.at(&commands).marker_regressor(TOOL, force, &MARKERS);
        let observation = asked(
            i,
            commands,
            TestLoad::force_at(TOOL, force),
            three_markers(1e-5),
        );
        let found = predict(
            &unknowns,
            &unknowns.nominal(),
            &[observation],
            Theory::SmallLoads,
        )?;
        let off = (&found[0].derivatives - &own).norm() / own.norm();
        assert!(off < 1e-10, "{off:e}");
    }
    Ok(())
}

/// Rows of twelve postures of arm H6, three markers of 20 um, and the true compliances.
fn twelve() -> anyhow::Result<(Vec<DMatrix<f64>>, DVector<f64>)> {
    let model = h6(false);
    let unknowns = Unknowns::matching(&model, &["joints"])?;
    let mut random = Random::new(81);
    let observations = pulls(&mut random, 12);
    let predictions = predict(
        &unknowns,
        &unknowns.nominal(),
        &observations,
        Theory::SmallLoads,
    )?;
    Ok((
        predictions
            .into_iter()
            .map(|p| p.derivatives / 20e-6)
            .collect(),
        unknowns.nominal(),
    ))
}

#[test]
fn deviations_and_regions_are_as_wide_as_chance_makes_them() -> Outcome {
    let (rows, truth) = twelve()?;
    let sizes = truth.clone();
    let start = Start {
        from: &truth,
        sizes: &sizes,
        constraints: &[],
    };
    let mut random = Random::new(4);
    let runs = 2000;
    let (mut squares, mut stated, mut inside) = (DVector::zeros(6), DVector::zeros(6), 0);
    for _ in 0..runs {
        let postures: Vec<kinetostat_identification::PostureRows> = rows
            .iter()
            .map(|a| kinetostat_identification::PostureRows {
                values: a * &truth + DVector::from_fn(a.nrows(), |_, _| random.normal()),
                rows: a.clone(),
            })
            .collect();
        let found = least_squares(&postures, &start, false)?;
        let off = &found.estimate - &truth;
        squares += off.component_mul(&off);
        stated = found.deviations();
        // 6 F(6, 102; 0.95) = 13.137: the region of all six at once.
        let factor = found.sigma_factor().powi(2);
        let precision = found
            .normal_inverse
            .clone()
            .try_inverse()
            .ok_or_else(|| anyhow::anyhow!("singular"))?;
        inside += usize::from(off.dot(&(precision * &off)) <= factor * 13.137);
    }
    for (sum, stated) in squares.iter().zip(stated.iter()) {
        let ratio = (sum / f64::from(runs)).sqrt() / stated;
        assert!((ratio - 1.0).abs() < 0.05, "{ratio}");
    }
    let mean: f64 = squares
        .iter()
        .zip(stated.iter())
        .map(|(sum, s)| (sum / f64::from(runs)).sqrt() / s)
        .sum::<f64>()
        / 6.0;
    assert!((mean - 1.0).abs() < 0.03, "{mean}");
    let share = inside as f64 / f64::from(runs);
    assert!((0.94..0.96).contains(&share), "{share}");
    Ok(())
}

#[test]
fn a_prior_keeps_what_readings_do_not_tell() -> Outcome {
    let model = h6(false);
    let unknowns = Unknowns::matching(&model, &["joints"])?;
    let mut random = Random::new(6);
    let mut observations: Vec<Observation> = (0..8)
        .map(|i| {
            asked(
                i,
                angles(&mut random),
                TestLoad::force_at(TOOL, vector![0.0, 0.0, -2000.0]),
                three_markers(20e-6),
            )
        })
        .collect();
    let predictions = predict(
        &unknowns,
        &unknowns.nominal(),
        &observations,
        Theory::SmallLoads,
    )?;
    put(&mut observations, &predictions, &mut |r| {
        r.deviation * random.normal()
    });
    let with = identify(
        &unknowns,
        &observations,
        &FitOptions {
            prior: Some(0.2),
            ..SMALL
        },
    )?;
    let deviations = with.linear.deviations();
    // The weight does not turn joint 1: it is known as well as it was believed.
    assert!((with.linear.estimate[0] / H6[0] - 1.0).abs() < 1e-9);
    assert!((deviations[0] / (0.2 * H6[0]) - 1.0).abs() < 1e-6);
    assert!(deviations[1] < 0.05 * H6[1]);
    // What is stated is what was believed, also by postures.
    let options = FitOptions {
        prior: Some(0.2),
        ..SMALL
    };
    let found = kinetostat_identification::identification(&unknowns, &observations, &options)?;
    let percent = found.numbers[0].deviation_percent.unwrap_or(f64::NAN);
    assert!((percent - 20.0).abs() < 0.1, "{percent} %");
    Ok(())
}

#[test]
fn a_compensator_is_weakly_known_and_its_joint_well() -> Outcome {
    let model = Model::preset("kuka_kr270_like")?;
    let patterns = [
        "chain.arm.A2.stiffness_n_m_per_rad",
        "limb.arm.load.compensator.stiffness_n_per_mm",
    ];
    let all = model.parameters();
    let spring = all
        .iter()
        .find(|p| p.path.contains("compensator") && p.path.ends_with("stiffness_n_per_mm"));
    let spring = spring.map_or(patterns[1], |p| p.path.as_str());
    let unknowns = Unknowns::matching(&model, &[patterns[0], spring])?;
    let mut random = Random::new(9);
    let mut observations: Vec<Observation> = (0..12)
        .map(|i| {
            let mut commands: Vec<f64> = [0.0, -75.0, 75.0, 10.0, 60.0, 0.0_f64]
                .map(f64::to_radians)
                .into();
            commands
                .iter_mut()
                .for_each(|q| *q += random.between(-0.6, 0.6));
            asked(
                i,
                commands,
                TestLoad::force_at(Vector3::zeros(), vector![0.0, 0.0, -2500.0]),
                three_markers(20e-6),
            )
        })
        .collect();
    let at = unknowns.nominal();
    let predictions = predict(&unknowns, &at, &observations, Theory::Loaded)?;
    // Derivatives by the load's own spring are those of solved equilibria.
    let step = 1e-3 * at[1];
    let mut moved = at.clone();
    moved[1] += step;
    let more = predict(&unknowns, &moved, &observations, Theory::Loaded)?;
    moved[1] -= 2.0 * step;
    let less = predict(&unknowns, &moved, &observations, Theory::Loaded)?;
    for ((p, more), less) in predictions.iter().zip(&more).zip(&less) {
        let slope = (&more.values - &less.values) / (2.0 * step);
        let off = (&slope - p.derivatives.column(1)).norm() / slope.norm();
        assert!(off < 1e-3, "{off:e}");
    }
    put(&mut observations, &predictions, &mut |r| {
        r.deviation * random.normal()
    });
    let found = kinetostat_identification::identification(&unknowns, &observations, &LOADED)?;
    let percent: Vec<f64> = found
        .numbers
        .iter()
        .map(|n| n.deviation_percent.unwrap_or(f64::INFINITY))
        .collect();
    assert!(
        percent[0] < 5.0 && percent[1] > 10.0 * percent[0],
        "{percent:?}"
    );
    Ok(())
}

#[test]
fn a_plan_says_what_its_loads_do_not_show() -> Outcome {
    let drawn = Model::preset("kuka_kr270_like")?;
    let numbers = Unknowns::matching(&drawn, &["joints"])?;
    let task = PlanTask {
        model: &drawn,
        unknowns: &numbers,
        loads: vec![TestLoad::force_at(
            Vector3::zeros(),
            vector![0.0, 0.0, -2500.0],
        )],
        markers: vec![Vector3::zeros()],
        deviation: 30e-6,
        count: 10,
        given: Vec::new(),
        candidates: 40,
        seed: 0,
        room: Room::default(),
        purpose: Purpose::Average,
        theory: Theory::SmallLoads,
    };
    let planned = plan(&task)?;
    let seen: Vec<bool> = planned.deviations.iter().map(Option::is_some).collect();
    assert_eq!(seen, [false, true, true, true, true, false]);
    let posture = drawn
        .mechanism
        .posture(PostureRequest::commands(&planned.measurements[0].shown))?;
    assert!(posture.within_limits().is_ok());
    Ok(())
}
