//! Joint compliances of arm H6 and of a hexapod: reference values P1 to P3, P5, P11 to P13.

use kinetostat::{Mechanism, Pose, PostureRequest};
use kinetostat_identification::{
    Axes, Body, Branch, Finding, Fit, FitOptions, Knowledge, Observation, Reading, ReadingOf,
    Start, TestLoad, Theory, Unknowns, identification, identified_model, identify, observations,
    predict, read_table,
};
use kinetostat_model::Model;
use nalgebra::{Vector3, vector};

use crate::support::{
    self, H6, MARKERS, Random, TOOL, angles, asked, h6, pulls, three_markers, tracker, worst,
};

type Outcome = anyhow::Result<()>;

/// What the model itself shows, as if it had been read.
fn read(
    model: &Model,
    observations: &mut [Observation],
    theory: Theory,
    noise: impl FnMut(&Reading) -> f64,
) -> anyhow::Result<()> {
    let unknowns = Unknowns::matching(model, &["joints"])?;
    support::read(&unknowns, observations, theory, noise)
}

/// The fit, from a model whose joints are all wrong.
fn fitted(
    model: &Model,
    observations: &[Observation],
    theory: Theory,
    robust: bool,
) -> anyhow::Result<Fit> {
    let numbers = Unknowns::matching(model, &["joints"])?;
    let wrong: Vec<(String, f64)> = (numbers.list().iter().zip([1.3, 0.7, 1.2, 0.8, 1.4, 0.75]))
        .map(|(u, factor)| (u.parameter.path.clone(), u.parameter.value * factor))
        .collect();
    let wrong: Vec<(&str, f64)> = wrong.iter().map(|(p, v)| (p.as_str(), *v)).collect();
    let model = model.with_parameters(&wrong)?;
    let unknowns = Unknowns::matching(&model, &["joints"])?;
    Ok(identify(
        &unknowns,
        observations,
        &FitOptions {
            theory,
            robust,
            prior: None,
        },
    )?)
}

/// Where the markers are, base axes, m.
fn markers_at(mechanism: &Mechanism, commands: &[f64]) -> anyhow::Result<Vec<Vector3<f64>>> {
    let posture = mechanism.posture(PostureRequest::commands(commands))?;
    let pose: &Pose = posture.target();
    Ok(MARKERS
        .iter()
        .map(|m| (pose * nalgebra::Point3::from(*m)).coords)
        .collect())
}

#[test]
fn joints_without_noise_are_found_exactly() -> Outcome {
    // P1.
    let model = h6(false);
    let mut random = Random::new(11);
    let mut observations: Vec<Observation> = (0..12)
        .map(|i| {
            let commands = angles(&mut random);
            let load = TestLoad::force_at(TOOL, random.vector(2000.0));
            asked(
                i,
                commands,
                load,
                Reading::displacement(TOOL, &Vector3::zeros(), 1e-5).into(),
            )
        })
        .collect();
    read(&model, &mut observations, Theory::SmallLoads, |_| 0.0)?;
    let first: Vec<f64> = observations[0].readings.iter().map(|r| r.value).collect();
    assert!(
        worst(&first, &[-1.780226119e-3, 1.484242967e-3, 1.007066861e-3]) < 1e-9,
        "{first:?}"
    );
    let found = fitted(&model, &observations, Theory::SmallLoads, false)?;
    assert!(worst(found.linear.estimate.as_slice(), &H6) < 1e-9);
    Ok(())
}

/// P2: twenty postures, three markers, a tracker.
fn twenty_postures(model: &Model) -> anyhow::Result<Vec<Observation>> {
    let mut random = Random::new(12);
    let mut observations = Vec::new();
    for i in 0..20 {
        let commands = angles(&mut random);
        let load = TestLoad::force_at(TOOL, random.vector(2000.0));
        let mut readings = three_markers(0.0);
        for (marker, at) in markers_at(&model.mechanism, &commands)?.iter().enumerate() {
            readings[3 * marker..3 * marker + 3]
                .iter_mut()
                .for_each(|r| r.deviation = tracker(at));
        }
        observations.push(asked(i, commands, load, readings));
    }
    read(model, &mut observations, Theory::SmallLoads, |r| {
        r.deviation * random.normal()
    })?;
    Ok(observations)
}

#[test]
fn a_tracker_weighs_what_is_near_more() -> Outcome {
    let model = h6(false);
    let observations = twenty_postures(&model)?;
    let found = fitted(&model, &observations, Theory::SmallLoads, false)?.linear;
    let c = [
        2.494710954e-7,
        3.006691322e-7,
        3.999169165e-7,
        2.965682762e-6,
        3.298172290e-6,
        2.420750505e-6,
    ];
    let std = [
        1.702553749e-9,
        1.296922883e-9,
        1.863170542e-9,
        3.717578140e-8,
        2.639209079e-8,
        2.858662853e-7,
    ];
    assert!(worst(found.estimate.as_slice(), &c) < 1e-6);
    assert!(worst(found.deviations().as_slice(), &std) < 1e-4);
    assert!(worst(&[found.chi_squared()], &[159.7038466]) < 1e-6);
    assert_eq!(found.degrees_of_freedom(), 174);
    let mut unweighted = observations;
    unweighted
        .iter_mut()
        .flat_map(|o| &mut o.readings)
        .for_each(|r| r.deviation = 1e-5);
    let found = fitted(&model, &unweighted, Theory::SmallLoads, false)?.linear;
    let wrong = [
        2.487044218e-7,
        3.001038760e-7,
        4.002264708e-7,
        2.969779562e-6,
        3.304898100e-6,
        2.425065747e-6,
    ];
    assert!(worst(found.estimate.as_slice(), &wrong) < 1e-6);
    Ok(())
}

#[test]
fn turns_and_displacements_are_weighed_by_their_deviations() -> Outcome {
    // P3.
    let model = h6(false);
    let mut random = Random::new(13);
    let mut observations: Vec<Observation> = (0..20)
        .map(|i| {
            let commands = angles(&mut random);
            let load = TestLoad::force_at(TOOL, random.vector(2000.0));
            let mut readings: Vec<Reading> =
                Reading::displacement(TOOL, &Vector3::zeros(), 30e-6).into();
            readings.extend(Reading::turn(Body::Tool, &Vector3::zeros(), 20e-6));
            asked(i, commands, load, readings)
        })
        .collect();
    read(&model, &mut observations, Theory::SmallLoads, |r| {
        r.deviation * random.normal()
    })?;
    let found = fitted(&model, &observations, Theory::SmallLoads, false)?.linear;
    let c = [
        2.514374885e-7,
        3.026549174e-7,
        3.991298680e-7,
        2.984598853e-6,
        3.285912414e-6,
        2.405114406e-6,
    ];
    assert!(worst(found.estimate.as_slice(), &c) < 1e-6);
    assert!(worst(&[found.chi_squared()], &[119.3248750]) < 1e-6);
    assert_eq!(found.degrees_of_freedom(), 114);
    Ok(())
}

/// P5: weights act in both states, 7 kN.
fn heavy(noise: bool) -> anyhow::Result<(Model, Vec<Observation>)> {
    let model = h6(true);
    let mut random = Random::new(31);
    let postures: Vec<Vec<f64>> = (0..20).map(|_| angles(&mut random)).collect();
    let mut observations: Vec<Observation> = postures
        .into_iter()
        .enumerate()
        .map(|(i, commands)| {
            let load = TestLoad::force_at(TOOL, random.vector(7000.0));
            asked(i, commands, load, three_markers(15e-6))
        })
        .collect();
    let on = f64::from(u8::from(noise));
    read(&model, &mut observations, Theory::Loaded, |r| {
        on * r.deviation * random.normal()
    })?;
    Ok((model, observations))
}

#[test]
fn loaded_equilibria_are_fitted_as_they_are() -> Outcome {
    let (model, observations) = heavy(true)?;
    let found = fitted(&model, &observations, Theory::Loaded, false)?;
    let c = [
        2.499683864e-7,
        2.999657054e-7,
        4.001737629e-7,
        2.996241300e-6,
        3.298511543e-6,
        2.356880384e-6,
    ];
    assert!(
        worst(found.linear.estimate.as_slice(), &c) < 1e-6,
        "{}",
        found.linear.estimate
    );
    assert!(worst(&[found.linear.chi_squared()], &[177.2265750]) < 1e-6);
    assert!(found.steps <= 7, "{} steps", found.steps);
    let small = fitted(&model, &observations, Theory::SmallLoads, false)?;
    let biased = [
        2.495512271e-7,
        3.019608183e-7,
        4.006540318e-7,
        3.017652520e-6,
        3.301425402e-6,
        2.343655211e-6,
    ];
    assert!(worst(small.linear.estimate.as_slice(), &biased) < 1e-6);
    let (model, observations) = heavy(false)?;
    let exact = fitted(&model, &observations, Theory::Loaded, false)?;
    assert!(
        worst(exact.linear.estimate.as_slice(), &H6) < 1e-8,
        "{}",
        exact.linear.estimate
    );
    Ok(())
}

#[test]
fn what_a_posture_shares_widens_the_deviation() -> Outcome {
    // P11.
    let model = h6(false);
    let mut random = Random::new(81);
    let mut observations = pulls(&mut random, 12);
    read(&model, &mut observations, Theory::SmallLoads, |r| {
        r.deviation * random.normal()
    })?;
    let found = fitted(&model, &observations, Theory::SmallLoads, false)?;
    assert_eq!(found.linear.degrees_of_freedom(), 102);
    assert!(worst(&[20e-6 * found.linear.sigma_factor()], &[1.935889340e-5]) < 1e-6);
    let covariance = found
        .linear
        .covariance_by_postures(&found.postures, None)
        .ok_or_else(|| anyhow::anyhow!("one posture"))?;
    let std: Vec<f64> = covariance.diagonal().iter().map(|v| v.sqrt()).collect();
    let wanted = [
        8.763058537e-10,
        6.365658024e-10,
        1.324960321e-9,
        1.921821440e-8,
        1.845988177e-8,
        1.652777394e-7,
    ];
    assert!(worst(&std, &wanted) < 1e-4, "{std:?}");
    let out: Vec<f64> = found
        .linear
        .left_out(&found.postures)
        .into_iter()
        .flatten()
        .flat_map(|r| r.as_slice().to_vec())
        .collect();
    assert_eq!(out.len(), 108);
    let rms = 20e-6 * (out.iter().map(|r| r * r).sum::<f64>() / 108.0).sqrt();
    assert!(worst(&[rms], &[2.002600563e-5]) < 1e-6, "{rms}");
    Ok(())
}

#[test]
fn jumps_of_whole_postures_count_less() -> Outcome {
    // P12.
    let model = h6(false);
    let mut random = Random::new(82);
    let mut observations = pulls(&mut random, 24);
    read(&model, &mut observations, Theory::SmallLoads, |r| {
        r.deviation * random.normal()
    })?;
    let mut jumps = Random::new(89);
    for _ in 0..3 {
        jumps.unit();
    }
    for posture in [17, 19, 21] {
        let jump = Vector3::from_fn(|_, _| 1e-3 * jumps.normal());
        for (k, reading) in observations[posture].readings.iter_mut().enumerate() {
            reading.value += jump[k % 3];
        }
    }
    let plain = fitted(&model, &observations, Theory::SmallLoads, false)?.linear;
    let squares = [
        2.093945328e-7,
        2.758178195e-7,
        4.140988753e-7,
        3.060691210e-6,
        3.522950082e-6,
        2.212367869e-6,
    ];
    assert!(worst(plain.estimate.as_slice(), &squares) < 1e-6);
    let robust = fitted(&model, &observations, Theory::SmallLoads, true)?.linear;
    let huber = [
        2.495173882e-7,
        2.984187160e-7,
        4.014481178e-7,
        3.000742919e-6,
        3.304057541e-6,
        2.188052705e-6,
    ];
    assert!(
        worst(robust.estimate.as_slice(), &huber) < 1e-6,
        "{}",
        robust.estimate
    );
    Ok(())
}

#[test]
fn metres_and_millimetres_give_the_same() -> Outcome {
    let model = h6(false);
    let observations = twenty_postures(&model)?;
    let unknowns = Unknowns::matching(&model, &["joints"])?;
    let found = identify(
        &unknowns,
        &observations,
        &FitOptions {
            theory: Theory::SmallLoads,
            robust: false,
            prior: None,
        },
    )?;
    // Rows in units of a micrometre instead of a standard deviation differ by a factor only.
    let mut scaled = found.postures.clone();
    for posture in &mut scaled {
        posture.rows *= 1e3;
        posture.values *= 1e3;
    }
    let sizes = unknowns.sizes();
    let nominal = unknowns.nominal();
    let start = Start {
        from: &nominal,
        sizes: &sizes,
        constraints: &[],
    };
    let again = kinetostat_identification::least_squares(&scaled, &start, false)?;
    assert!(worst(again.estimate.as_slice(), found.linear.estimate.as_slice()) < 1e-9);
    Ok(())
}

#[test]
fn derivatives_are_those_of_the_prediction() -> Outcome {
    let (model, mut observations) = heavy(false)?;
    observations.truncate(3);
    observations[1].load.moment = vector![300.0, -200.0, 100.0];
    observations[2].readings.push(Reading {
        of: ReadingOf::About(Vector3::y()),
        marker: Vector3::zeros().into(),
        value: 0.0,
        deviation: 1e-5,
    });
    let unknowns = Unknowns::matching(&model, &["joints"])?;
    let at = unknowns.nominal();
    for (theory, tolerance) in [(Theory::Loaded, 1e-6), (Theory::SmallLoads, 1e-7)] {
        let found = predict(&unknowns, &at, &observations, theory)?;
        for k in 0..6 {
            let step = 1e-3 * at[k];
            let moved = |sign: f64| {
                let mut moved = at.clone();
                moved[k] += sign * step;
                predict(&unknowns, &moved, &observations, theory)
            };
            for ((more, less), own) in moved(1.0)?.iter().zip(&moved(-1.0)?).zip(&found) {
                let slope = (&more.values - &less.values) / (2.0 * step);
                let size = own.derivatives.column(k).norm().max(1e-9);
                let off = (slope - own.derivatives.column(k)).norm() / size;
                assert!(off < tolerance, "{theory:?} joint {k}: {off:e}");
            }
        }
    }
    Ok(())
}

#[test]
fn what_cannot_be_seen_is_named() -> Outcome {
    // A weight never turns joint 1, whose axis is vertical; a force through axis 6 never turns joint 6.
    let model = h6(false);
    let mut random = Random::new(3);
    let mut observations: Vec<Observation> = (0..12)
        .map(|i| {
            let load = TestLoad::force_at(vector![0.25, 0.0, 0.0], vector![0.0, 0.0, -2500.0]);
            asked(i, angles(&mut random), load, three_markers(20e-6))
        })
        .collect();
    read(&model, &mut observations, Theory::SmallLoads, |r| {
        r.deviation * random.normal()
    })?;
    let unknowns = Unknowns::matching(&model, &["joints"])?;
    let options = FitOptions {
        theory: Theory::SmallLoads,
        robust: false,
        prior: None,
    };
    let found = identification(&unknowns, &observations, &options)?;
    assert_eq!((found.rank, found.degrees_of_freedom), (4, 104));
    let knowledge: Vec<Knowledge> = found.numbers.iter().map(|n| n.knowledge).collect();
    let joints = [
        Knowledge::Unseen,
        Knowledge::Identified,
        Knowledge::Identified,
        Knowledge::Identified,
        Knowledge::Identified,
        Knowledge::Unseen,
    ];
    assert_eq!(knowledge, joints);
    let unseen: Vec<&Finding> = found
        .findings
        .iter()
        .filter(|f| matches!(f, Finding::Unseen { .. }))
        .collect();
    assert_eq!(unseen.len(), 2, "{:?}", found.findings);
    assert!(
        worst(
            &[found.numbers[0].identified.unwrap_or(0.0)],
            &[1.0 / H6[0]]
        ) < 1e-12,
        "it keeps its value"
    );
    Ok(())
}

#[test]
fn the_identified_model_has_the_numbers_and_their_source() -> Outcome {
    let model = h6(false);
    let observations = twenty_postures(&model)?;
    let unknowns = Unknowns::matching(&model, &["joints"])?;
    let options = FitOptions {
        theory: Theory::SmallLoads,
        robust: false,
        prior: None,
    };
    let found = identification(&unknowns, &observations, &options)?;
    let identified = identified_model(&model, &found, "pulls.csv")?;
    let text = &identified.text;
    assert!(
        text.contains("identified from pulls.csv, standard deviation"),
        "{text}"
    );
    let again = Unknowns::matching(&identified, &["joints"])?;
    let numbers: Vec<f64> = found
        .numbers
        .iter()
        .map(|n| n.identified.unwrap_or(f64::NAN))
        .collect();
    let stiffnesses: Vec<f64> = again.nominal().iter().map(|c| 1.0 / c).collect();
    assert!(worst(&stiffnesses, &numbers) < 1e-8, "nine digits");
    // Standard deviations and correlations stand in the model, once, however often it is identified.
    let again = identified_model(&identified, &found, "more.csv")?;
    for (model, source) in [(&identified, "pulls.csv"), (&again, "more.csv")] {
        let document = &model.document;
        let deviations: Vec<f64> = document.uncertain.iter().filter_map(|u| u.normal).collect();
        let wanted = found.numbers.iter().filter_map(|n| n.deviation);
        assert!(worst(&deviations, &wanted.collect::<Vec<_>>()) < 1e-12);
        assert_eq!(document.correlation.len(), 15, "{}", model.text);
        let first = &document.correlation[0];
        let of = |k: usize| found.covariance[k][k].sqrt();
        let coefficient = found.covariance[1][0] / (of(0) * of(1));
        assert_eq!(first.between[1], found.numbers[1].number);
        assert!((first.coefficient - coefficient).abs() < 1e-6);
        assert!(model.text.contains(&format!("identified from {source}")));
    }
    Ok(())
}

#[test]
fn friction_makes_one_branch_too_stiff_and_is_found_from_both() -> Outcome {
    // P8.
    let model = h6(false);
    let mut random = Random::new(61);
    let postures: Vec<Vec<f64>> = (0..8).map(|_| angles(&mut random)).collect();
    let loads: Vec<Vector3<f64>> = (0..8).map(|_| random.vector(3000.0)).collect();
    let arm = crate::regressors::Arm::h6();
    let torques: Vec<Vec<f64>> = postures
        .iter()
        .zip(&loads)
        .map(|(q, f)| {
            let posture = arm.at(q);
            let jacobian = posture.jacobian(posture.point(TOOL));
            jacobian
                .column_iter()
                .map(|j| j.fixed_rows::<3>(0).dot(f))
                .collect()
        })
        .collect();
    let friction: Vec<f64> = (0..6)
        .map(|j| 0.15 * torques.iter().map(|t| t[j].abs()).sum::<f64>() / 8.0)
        .collect();
    let fractions = [0.25, 0.5, 0.75, 1.0, 0.75, 0.5, 0.25, 0.0];
    let mut observations = Vec::new();
    for (i, (q, force)) in postures.iter().zip(&loads).enumerate() {
        let posture = arm.at(q);
        let jacobian = posture.jacobian(posture.point(TOOL));
        for (step, fraction) in fractions.iter().enumerate() {
            let unloading = step > 3;
            let sign = if unloading { -1.0 } else { 1.0 };
            let turns = (0..6).map(|j| {
                H6[j] * (torques[i][j] * fraction - friction[j] * sign * torques[i][j].signum())
            });
            let turns = nalgebra::DVector::from_iterator(6, turns);
            let twist = &jacobian * turns;
            let mut readings = Vec::new();
            for marker in MARKERS {
                let arm = posture.rotation * (marker - TOOL);
                let (v, w) = (
                    twist.fixed_rows::<3>(0).into_owned(),
                    twist.fixed_rows::<3>(3).into_owned(),
                );
                readings.extend(Reading::displacement(marker, &(v + w.cross(&arm)), 20e-6));
            }
            let mut own = asked(
                i,
                q.clone(),
                TestLoad::force_at(TOOL, force * *fraction),
                readings,
            );
            own.branch = Some(Branch {
                unloading,
                whole: TestLoad::force_at(TOOL, *force),
            });
            observations.push(own);
        }
    }
    let loading: Vec<Observation> = observations
        .iter()
        .filter(|o| o.branch.is_some_and(|b| !b.unloading))
        .cloned()
        .collect();
    let one = fitted(&model, &loading, Theory::SmallLoads, false)?
        .linear
        .estimate;
    let too_stiff = [
        2.341694638e-7,
        2.412016111e-7,
        3.602119186e-7,
        2.555843058e-6,
        2.546756217e-6,
        1.615728056e-6,
    ];
    assert!(worst(one.as_slice(), &too_stiff) < 1e-6, "{one}");
    let both = fitted(&model, &observations, Theory::SmallLoads, false)?
        .linear
        .estimate;
    let mean = [
        2.456825810e-7,
        2.839640758e-7,
        3.891487051e-7,
        2.878866289e-6,
        3.094569877e-6,
        2.186107652e-6,
    ];
    assert!(worst(both.as_slice(), &mean) < 1e-6, "{both}");
    let unknowns = Unknowns::matching(&model, &["joints"])?.with_friction(&model);
    let options = FitOptions {
        theory: Theory::SmallLoads,
        robust: false,
        prior: None,
    };
    let found = identify(&unknowns, &observations, &options)?
        .linear
        .estimate;
    let offsets = [
        8.062775251e-5,
        1.842047388e-4,
        1.588621546e-4,
        3.407962130e-4,
        3.405809327e-4,
        6.927364129e-5,
    ];
    assert!(worst(&found.as_slice()[..6], &H6) < 1e-8, "{found}");
    assert!(worst(&found.as_slice()[6..], &offsets) < 1e-6, "{found}");
    Ok(())
}

#[test]
fn exchanged_markers_are_named() -> Outcome {
    let model = h6(false);
    let mut random = Random::new(23);
    let mut observations: Vec<Observation> = Vec::new();
    for i in 0..8 {
        let commands = angles(&mut random);
        let load = TestLoad::force_at(TOOL, random.vector(2000.0));
        for marker in [vector![0.3, 0.3, 0.0], vector![-0.3, -0.3, 0.1]] {
            let readings = Reading::displacement(marker, &Vector3::zeros(), 10e-6).into();
            observations.push(asked(i, commands.clone(), load, readings));
        }
    }
    read(&model, &mut observations, Theory::SmallLoads, |r| {
        r.deviation * random.normal()
    })?;
    let unknowns = Unknowns::matching(&model, &["joints"])?;
    let options = FitOptions {
        theory: Theory::SmallLoads,
        robust: true,
        prior: None,
    };
    let exchanged = |observations: &[Observation]| -> anyhow::Result<Vec<String>> {
        let found = identification(&unknowns, observations, &options)?;
        let names = found.findings.into_iter().filter_map(|f| match f {
            Finding::Exchanged { posture, .. } => Some(posture),
            _ => None,
        });
        Ok(names.collect())
    };
    assert!(exchanged(&observations)?.is_empty());
    let values: Vec<f64> = observations[6].readings.iter().map(|r| r.value).collect();
    for k in 0..3 {
        observations[6].readings[k].value = observations[7].readings[k].value;
        observations[7].readings[k].value = values[k];
    }
    assert_eq!(exchanged(&observations)?, ["3"]);
    // As a table has them: both markers read in one equilibrium.
    let together = observations.chunks(2).map(|pair| {
        let mut both = pair[0].clone();
        both.readings.extend(pair[1].readings.iter().copied());
        both
    });
    assert_eq!(exchanged(&together.collect::<Vec<_>>())?, ["3"]);
    Ok(())
}

#[test]
fn units_and_signs_that_cannot_be_are_asked_about() -> Outcome {
    let model = h6(false);
    let observations = twenty_postures(&model)?;
    let unknowns = Unknowns::matching(&model, &["joints"])?;
    let options = FitOptions {
        theory: Theory::SmallLoads,
        robust: false,
        prior: None,
    };
    for (factor, asked) in [
        (1.0, false),
        (3.0, false),
        (1e3, true),
        (1e-3, true),
        (-1.0, true),
    ] {
        let mut other = observations.clone();
        other
            .iter_mut()
            .flat_map(|o| &mut o.readings)
            .for_each(|r| r.value *= factor);
        let found = identification(&unknowns, &other, &options)?;
        let is_asked = found
            .findings
            .iter()
            .any(|f| matches!(f, Finding::Scale { .. }));
        assert_eq!(is_asked, asked, "{factor}: {:?}", found.findings);
    }
    Ok(())
}

#[test]
fn a_weight_and_a_pull_in_one_posture_have_loops_of_their_own() -> Outcome {
    let model = h6(false);
    let axes = Axes::of(&model);
    let arm = crate::regressors::Arm::h6();
    let mut random = Random::new(62);
    let friction = [40e-6, 60e-6, 50e-6, 90e-6, 80e-6, 70e-6];
    let mut text = "posture,A1_rad,A2_rad,A3_rad,A4_rad,A5_rad,A6_rad,fx_n,fy_n,fz_n,load_x_m,load_y_m,load_z_m,marker_x_m,marker_y_m,marker_z_m,dx_m,dy_m,dz_m,branch\n".to_owned();
    for i in 0..10 {
        let q = angles(&mut random);
        let posture = arm.at(&q);
        let jacobian = posture.jacobian(posture.point(TOOL));
        let cells: Vec<String> = q.iter().map(ToString::to_string).collect();
        for force in [vector![0.0, 0.0, -2500.0], vector![900.0, 700.0, 0.0]] {
            let torques: Vec<f64> = jacobian
                .column_iter()
                .map(|j| j.fixed_rows::<3>(0).dot(&force))
                .collect();
            for (fraction, unloading) in [(0.5, false), (1.0, false), (0.5, true), (0.0, true)] {
                let sign = if unloading { -1.0 } else { 1.0 };
                let turns = (0..6).map(|j| {
                    let stuck = if torques[j].abs() > 1e-6 {
                        friction[j] * sign * torques[j].signum()
                    } else {
                        0.0
                    };
                    H6[j] * torques[j] * fraction - stuck
                });
                let moved = &jacobian * nalgebra::DVector::from_iterator(6, turns);
                let f = force * fraction;
                text += &format!(
                    "{i},{},{},{},{},0.25,0.1,-0.05,0.25,0.1,-0.05,{},{},{},{}\n",
                    cells.join(","),
                    f.x,
                    f.y,
                    f.z,
                    moved[0],
                    moved[1],
                    moved[2],
                    if unloading { "unloading" } else { "loading" }
                );
            }
        }
    }
    let rows = read_table(&text, &axes).map_err(|f| anyhow::anyhow!("{f:?}"))?;
    let found = observations(&rows, &Vector3::zeros()).map_err(|f| anyhow::anyhow!("{f:?}"))?;
    let unknowns = Unknowns::matching(&model, &["joints"])?.with_friction(&model);
    let options = FitOptions {
        theory: Theory::SmallLoads,
        robust: false,
        prior: None,
    };
    let estimate = identify(&unknowns, &found, &options)?.linear.estimate;
    assert!(worst(&estimate.as_slice()[..6], &H6) < 1e-6, "{estimate}");
    assert!(
        worst(&estimate.as_slice()[6..], &friction) < 1e-6,
        "{estimate}"
    );
    Ok(())
}
