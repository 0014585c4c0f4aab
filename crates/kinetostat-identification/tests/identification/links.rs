//! Link matrices of arm H6: what any experiment can tell of them.

use kinetostat_identification::{
    Body, Identifiability, Observation, PostureRows, Reading, TestLoad, Theory, Unknowns, predict,
};
use kinetostat_model::Model;
use nalgebra::{DVector, Matrix6, Vector3, vector};

use crate::support::{FLANGE, H6, JOINTS, Random, TOOL, angles, arm, asked};

type Outcome = anyhow::Result<()>;

/// Compliance at the free end of an Euler-Bernoulli tube of 1 m along x, and its inverse as a model file has it.
fn tube() -> Matrix6<f64> {
    let (outer, inner, e, g) = (0.25_f64, 0.21_f64, 2.06e11, 7.9e10);
    let area = std::f64::consts::FRAC_PI_4 * (outer.powi(2) - inner.powi(2));
    let second = std::f64::consts::PI / 64.0 * (outer.powi(4) - inner.powi(4));
    let mut c = Matrix6::zeros();
    let entries = [
        (0, 0, 1.0 / (e * area)),
        (1, 1, 1.0 / (3.0 * e * second)),
        (2, 2, 1.0 / (3.0 * e * second)),
    ];
    let more = [
        (3, 3, 1.0 / (2.0 * g * second)),
        (4, 4, 1.0 / (e * second)),
        (5, 5, 1.0 / (e * second)),
    ];
    let coupled = [(1, 5, 0.5 / (e * second)), (2, 4, -0.5 / (e * second))];
    for (i, j, value) in entries.into_iter().chain(more).chain(coupled) {
        c[(i, j)] = value;
        c[(j, i)] = value;
    }
    c
}

/// A serial arm with an elastic matrix at the end of the base and of each link.
fn complete(joints: &[(&str, [f64; 3])], flange: [f64; 3], compliances: &[f64]) -> Model {
    let stiffness = tube().try_inverse().unwrap_or_default();
    let rows: Vec<Vec<f64>> = (0..6)
        .map(|i| {
            (0..6)
                .map(|j| 0.5 * (stiffness[(i, j)] + stiffness[(j, i)]))
                .collect()
        })
        .collect();
    arm(joints, flange, compliances, false, &|i| {
        format!("  {{ spring6 = {{ matrix_n_m_rad = {rows:?} }}, name = \"L{i}\" }},\n")
    })
}

#[derive(Clone, Copy, Debug)]
enum Loads {
    Wrench,
    Force,
    Weight,
}

fn experiment(
    loads: Loads,
    full_pose: bool,
    at: Vector3<f64>,
    joints: usize,
    postures: usize,
) -> Vec<Observation> {
    let mut random = Random::new(5);
    let observation = |i| {
        let mut commands = angles(&mut random);
        commands.truncate(joints);
        commands.resize_with(joints, || random.between(-2.0, 2.0));
        let mut load = TestLoad::force_at(at, random.vector(2000.0));
        match loads {
            Loads::Wrench => load.moment = random.vector(600.0),
            Loads::Force => {}
            Loads::Weight => load.force = vector![0.0, 0.0, -2500.0],
        }
        let mut readings: Vec<Reading> = Reading::displacement(at, &Vector3::zeros(), 20e-6).into();
        if full_pose {
            readings.extend(Reading::turn(Body::Tool, &Vector3::zeros(), 20e-6));
        }
        asked(i, commands, load, readings)
    };
    (0..postures).map(observation).collect()
}

fn seen(
    model: &Model,
    unknowns: &[&str],
    observations: &[Observation],
) -> anyhow::Result<Identifiability> {
    let unknowns = Unknowns::matching(model, unknowns)?;
    let predictions = predict(
        &unknowns,
        &unknowns.nominal(),
        observations,
        Theory::SmallLoads,
    )?;
    let rows: Vec<PostureRows> = predictions
        .into_iter()
        .map(|p| PostureRows {
            rows: p.derivatives / 20e-6,
            values: DVector::zeros(p.values.len()),
        })
        .collect();
    Ok(Identifiability::of(&rows, &unknowns.sizes()))
}

#[test]
fn as_many_combinations_are_seen_as_the_theorem_says() -> Outcome {
    // 21 (n + 1) less 7 for each revolute joint; the joints' own springs add nothing; a rigid base takes 14 n + 7.
    let model = complete(&JOINTS, FLANGE, &H6);
    let all = experiment(Loads::Wrench, true, TOOL, 6, 40);
    let links = seen(&model, &["chain.arm.L*.matrix_n_m_rad.*"], &all)?;
    assert_eq!((links.rank, links.seen_alone.len()), (105, 147));
    assert_eq!(
        seen(&model, &["joints", "chain.arm.L*.matrix_n_m_rad.*"], &all)?.rank,
        105
    );
    let moving: Vec<String> = (1..7)
        .map(|i| format!("chain.arm.L{i}.matrix_n_m_rad"))
        .collect();
    let moving: Vec<&str> = moving.iter().map(String::as_str).collect();
    assert_eq!(seen(&model, &moving, &all)?.rank, 91);
    let gap = links.singular_values[104] / links.singular_values[0];
    let noise = links.singular_values[105] / links.singular_values[0];
    assert!(gap > 1e-6 && noise < 1e-10, "{gap:e} {noise:e}");
    Ok(())
}

#[test]
fn other_joints_hide_other_combinations() -> Outcome {
    let joints = [
        ("z", [0.0, 0.0, 0.0]),
        ("y", [0.1, 0.2, 0.7]),
        ("x", [0.3, -0.1, 1.4]),
    ];
    let model = complete(&joints, [0.9, 0.3, 1.6], &[1e-6, 1e-6, 1e-6]);
    let all = experiment(Loads::Wrench, true, TOOL, 3, 60);
    assert_eq!(
        seen(&model, &["chain.arm.L*.matrix_n_m_rad.*"], &all)?.rank,
        21 * 4 - 7 * 3
    );
    Ok(())
}

/// A point on the last axis is a point of the link before it as well, so that force and position at it show of both links only
/// what one link would show: of the last link 6 numbers of which 2 are invariant under the turn, of the link before 6 of 21, and the
/// like. That is 10, and with either a moment or a turn 4, less than for a point beside the axis.
#[test]
fn poorer_experiments_see_less() -> Outcome {
    let model = complete(&JOINTS, FLANGE, &H6);
    let places = [Vector3::zeros(), vector![0.25, 0.0, 0.0], TOOL];
    let table = [
        (Loads::Wrench, true, [105, 105, 105]),
        (Loads::Wrench, false, [95, 95, 99]),
        (Loads::Force, true, [95, 95, 99]),
        (Loads::Force, false, [80, 80, 90]),
        (Loads::Weight, true, [85, 85, 89]),
        (Loads::Weight, false, [70, 70, 80]),
    ];
    for (loads, full_pose, ranks) in table {
        for (at, rank) in places.iter().zip(ranks) {
            let observations = experiment(loads, full_pose, *at, 6, 80);
            let found = seen(
                &model,
                &["joints", "chain.arm.L*.matrix_n_m_rad.*"],
                &observations,
            )?;
            assert_eq!(
                found.rank, rank,
                "{loads:?}, full pose {full_pose}, at {at:?}"
            );
            let (least, rounding) = (found.singular_values[rank - 1], found.singular_values[rank]);
            assert!(least > 1e9 * rounding, "{least:e} beside {rounding:e}");
        }
    }
    Ok(())
}
