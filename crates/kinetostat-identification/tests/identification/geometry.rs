//! Geometry together with compliances from absolute places: reference value P7.

use anyhow::{Context, Result};
use kinetostat::spatial::hat;
use kinetostat::{PostureRequest, Wrench};
use kinetostat_identification::{
    Finding, FitOptions, Gauge, IdentificationError as Error, Knowledge, MARKER_ERROR, Observation,
    Reading, TestLoad, Theory, Unknowns, identification, identified_model, identify, predict,
};
use kinetostat_model::Model;
use kinetostat_testing::{Worst, largest_size};
use nalgebra::{DVector, Matrix3, Vector3, vector};

use crate::support::{H6, MARKERS, Random, TOOL, angles, asked, h6, put, worst};

const OPTIONS: FitOptions = FitOptions {
    theory: Theory::Loaded,
    robust: false,
    prior: None,
};
/// Standard deviation of a place, m.
const DEVIATION: f64 = 30e-6;

/// The error behind the last joint.
const FLANGE: &str = "deviation.arm.to end 5";

/// Compliances of joints 2 to 6, errors of seven links and places of three markers.
fn unknowns(model: &Model, observations: &[Observation]) -> Result<Unknowns> {
    let joint = |i| format!("chain.arm.A{i}.stiffness_n_m_per_rad");
    let joints: Vec<String> = (2..=6).map(joint).collect();
    let mut patterns: Vec<&str> = joints.iter().map(String::as_str).collect();
    // The reference has an error behind the last joint, too, and compares all lengths with a millimetre.
    let flange = ["translation_mm", "rotation_vector_deg"]
        .iter()
        .flat_map(|key| ["x", "y", "z"].map(|axis| format!("{FLANGE}.{key}.{axis}")));
    let flange: Vec<String> = flange.collect();
    patterns.push("geometry");
    patterns.extend(flange.iter().map(String::as_str));
    Ok(Unknowns::matching(model, &patterns)?.with_markers(observations, 1e-3))
}

/// Places of three markers, in postures under a weight (N) at the tool point.
fn places(postures: &[Vec<f64>], weight: f64) -> Vec<Observation> {
    let own = postures.iter().enumerate().map(|(i, commands)| {
        let load = TestLoad::force_at(TOOL, vector![0.0, 0.0, -weight]);
        let read = |m: Vector3<f64>| Reading::place(m, &Vector3::zeros(), DEVIATION);
        let readings = MARKERS.into_iter().flat_map(read).collect();
        asked(i, commands.clone(), load, readings)
    });
    own.collect()
}

fn postures(random: &mut Random, count: usize) -> Vec<Vec<f64>> {
    (0..count).map(|_| angles(random)).collect()
}

/// P7: the machine as it is, and what was read of it.
struct Problem {
    unknowns: Unknowns,
    truth: DVector<f64>,
    gauge: Gauge,
    read: Vec<Observation>,
    /// Postures that were not measured, under the load.
    validation: Vec<Observation>,
}

/// Draws P7. The reference leaves two choices open, under which its figures hold: joint 1 has its nominal compliance in truth, and the
/// noise is drawn after the postures of validation, for all readings without the load first.
fn drawn(noise: f64) -> Result<Problem> {
    let mut random = Random::new(51);
    let irreducible = places(&postures(&mut Random::new(7), 30), 0.0);
    let unknowns = unknowns(&h6(true), &irreducible)?;
    let gauge = Gauge::of(&unknowns, &irreducible)?.context("no gauge")?;
    assert_eq!((gauge.numbers, gauge.directions), (51, 33));
    let mut errors = DVector::zeros(56);
    for i in 0..51 {
        let size = [2e-3, 5e-4, 1e-3][usize::from(i > 5) + usize::from(i > 41)];
        errors[5 + i] = size * random.normal();
    }
    errors = gauge.free_part(&errors);
    let factors: Vec<f64> = (0..6).map(|_| 0.15 * random.normal()).collect();
    (0..5).for_each(|i| errors[i] = factors[i + 1] * H6[i + 1]);
    for at in (5..47).step_by(6) {
        let (v, w) = (errors.fixed_rows::<3>(at), errors.fixed_rows::<3>(at + 3));
        let shift = exponential_shift(&w.into_owned()) * v;
        errors.rows_mut(at, 3).copy_from(&shift);
    }
    let (measured, validation) = (postures(&mut random, 24), postures(&mut random, 10));
    let mut read = [places(&measured, 0.0), places(&measured, 2600.0)].concat();
    let truth = unknowns.nominal() + errors;
    let exact = predict(&unknowns, &truth, &read, Theory::Loaded)?;
    put(&mut read, &exact, &mut |_| noise * random.normal());
    Ok(Problem {
        unknowns,
        truth,
        gauge,
        read,
        validation: places(&validation, 2600.0),
    })
}

/// Takes `v` to the translation of the exponential of `[v; w]`: `I + (1 - cos t)/t^2 W + (t - sin t)/t^3 W^2`, by its series.
fn exponential_shift(w: &Vector3<f64>) -> Matrix3<f64> {
    let (cross, square) = (hat(w), w.norm_squared());
    Matrix3::identity()
        + cross * (0.5 - square / 24.0)
        + cross * cross * (1.0 - square / 20.0) / 6.0
}

/// What a machine shows of all readings.
fn shown(unknowns: &Unknowns, values: &DVector<f64>, of: &[Observation]) -> Result<DVector<f64>> {
    let each = predict(unknowns, values, of, Theory::Loaded)?;
    let all: Vec<f64> = each.iter().flat_map(|p| p.values.iter().copied()).collect();
    Ok(DVector::from_vec(all))
}

impl Problem {
    /// Error of the predicted places of validation, root mean square, m.
    fn error(&self, values: &DVector<f64>) -> Result<f64> {
        let of = |values| shown(&self.unknowns, values, &self.validation);
        Ok(((of(values)? - of(&self.truth)?).norm_squared() / 30.0).sqrt())
    }
}

#[test]
fn geometry_and_compliances_of_p7() -> Result<()> {
    let problem = drawn(DEVIATION)?;
    let found = identify(&problem.unknowns, &problem.read, &OPTIONS)?.linear;
    assert_eq!((found.rank, found.degrees_of_freedom()), (38, 394));
    let c = [0.3210843, 0.4375407, 2.386355, 3.335449, 2.521452].map(|c| 1e-6 * c);
    let std = [4.238e-10, 8.476e-10, 1.659e-8, 1.084e-8, 1.452e-7];
    let off = (0..5).map(|i| (found.estimate[i] - c[i]) / std[i]);
    assert!(largest_size(off) < 0.1, "{}", found.estimate);
    // The reference states four digits.
    assert!(worst(&found.deviations().as_slice()[..5], &std) < 5e-4);
    let squares = found.chi_squared();
    assert!((squares - 384.89).abs() < 0.005, "{squares}");
    let shown = shown(&problem.unknowns, &found.estimate, &problem.validation)?;
    let off = (shown.fixed_rows::<3>(0) - vector![-0.2112631, -0.6948600, 3.4364841]).norm();
    assert!(off < 3e-6, "{off}");
    let before = problem.error(&problem.unknowns.nominal())?;
    let after = problem.error(&found.estimate)?;
    assert!(before > 2e-3 && after < 30e-6, "{before} {after}");
    Ok(())
}

/// The same observations with readings of displacements instead of places.
fn displaced(observations: &[Observation]) -> Vec<Observation> {
    let mut all = observations.to_vec();
    for observation in &mut all {
        let read = |m| Reading::displacement(m, &Vector3::zeros(), DEVIATION);
        observation.readings = MARKERS.into_iter().flat_map(read).collect();
    }
    all
}

/// Largest difference of derivatives from differences of predictions, of every fifth unknown, relative to the derivatives.
fn off_differences(own: &Unknowns, at: &DVector<f64>, read: &[Observation]) -> Result<f64> {
    let exact = predict(own, at, read, Theory::Loaded)?;
    let mut off = Worst::new();
    for column in (0..at.len()).step_by(5) {
        let step = 0.01 * own.sizes()[column];
        let moved = |sign: f64| {
            let mut values = at.clone();
            values[column] += sign * step;
            shown(own, &values, read)
        };
        let difference = (moved(1.0)? - moved(-1.0)?) / (2.0 * step);
        let exact = exact
            .iter()
            .flat_map(|p| p.derivatives.column(column).data.into_slice());
        let exact = DVector::from_iterator(difference.len(), exact.copied());
        let name = || &own.list()[column].parameter.path;
        off.add_at((difference - &exact).norm() / exact.norm(), name);
    }
    Ok(off.value())
}

#[test]
fn derivatives_by_the_geometry_are_those_of_differences() -> Result<()> {
    let problem = drawn(0.0)?;
    let places = &problem.validation[..2];
    let read = [places, &displaced(places)].concat();
    let off = off_differences(&problem.unknowns, &problem.truth, &read)?;
    assert!(off < 1e-7, "{off}");
    // Errors of the legs of a parallel machine.
    let model = Model::preset("orthoglide")?;
    let load = TestLoad::force_at(Vector3::zeros(), vector![150.0, -80.0, -200.0]);
    let read = Reading::place(vector![0.05, 0.0, 0.02], &Vector3::zeros(), DEVIATION);
    let read = [asked(0, vec![-0.35, -0.34, -0.36], load, read.into())];
    for number in ["foot arm.translation_mm.y", "line.rotation_vector_deg.z"] {
        let path = format!("deviation.leg y.{number}");
        let unknowns = Unknowns::matching(&model, &[&path])?.with_markers(&read, MARKER_ERROR);
        let off = off_differences(&unknowns, &unknowns.nominal(), &read)?;
        assert!(off < 1e-7, "{path}: {off}");
    }
    Ok(())
}

#[test]
fn places_and_displacements_without_noise_give_the_machine_back() -> Result<()> {
    let mut problem = drawn(0.0)?;
    // A machine that differs in free directions only.
    let nominal = problem.unknowns.nominal();
    problem.truth = &nominal + problem.gauge.free_part(&(&problem.truth - &nominal));
    // Places without the load, and displacements by it.
    let (unloaded, loaded) = problem.read.split_at(24);
    let mixed = [unloaded, &displaced(loaded)].concat();
    for mut read in [problem.read.clone(), mixed] {
        let exact = predict(&problem.unknowns, &problem.truth, &read, Theory::Loaded)?;
        put(&mut read, &exact, &mut |_| 0.0);
        let fit = identify(&problem.unknowns, &read, &OPTIONS)?.linear;
        let off = (&fit.estimate - &problem.truth).component_div(&problem.unknowns.sizes());
        assert!(
            off.norm() < 1e-8 && problem.error(&fit.estimate)? < 1e-11,
            "{off}"
        );
    }
    Ok(())
}

#[test]
fn the_identified_geometry_is_a_model() -> Result<()> {
    let (problem, model) = (drawn(DEVIATION)?, h6(true));
    let found = identification(&problem.unknowns, &problem.read, &OPTIONS)?;
    let free = |f: &Finding| matches!(f, Finding::Geometry { directions: 33, .. });
    assert!(found.findings.iter().any(free), "{:?}", found.findings);
    // A shift of the base along axis 1 is not told from one behind that axis.
    let shift = &found.numbers[7];
    assert_eq!(shift.number, "deviation.arm.link 0.translation_mm.z");
    assert_eq!(shift.knowledge, Knowledge::Unseen);
    assert_eq!(found.numbers[2].knowledge, Knowledge::Identified);
    let identified = identified_model(&model, &found, "places.csv")?;
    assert_eq!(identified.document.deviation.len(), 7);
    let numbers = unknowns(&identified, &problem.read)?;
    // Stiffnesses are written with nine digits.
    for (number, own) in found.numbers.iter().zip(numbers.list()).take(47) {
        let identified = number.identified.context("no value")?;
        assert!((own.parameter.value / identified - 1.0).abs() < 1e-8);
    }
    // A model that has these deviations is edited where they are.
    let again = identification(&numbers, &problem.read, &OPTIONS)?;
    let again = identified_model(&identified, &again, "places.csv")?;
    assert_eq!(again.document.deviation.len(), 7);
    Ok(())
}

#[test]
fn a_joint_that_a_weight_hardly_turns_does_not_keep_the_fit_from_settling() -> Result<()> {
    // Only the errors of the geometry let a weight turn joint 1, which is rigid here: noise decides whether it seems to give way.
    let problem = drawn(DEVIATION)?;
    let mut read = problem.read.clone();
    let all = Unknowns::matching(&h6(true), &["joints", "geometry"])?;
    let all = all.with_markers(&read, MARKER_ERROR);
    let truth = problem.truth.clone().remove_rows(5 + 36, 6);
    let truth = truth.insert_row(0, 1e-4 * H6[0]);
    let exact = predict(&all, &truth, &read, Theory::Loaded)?;
    let mut random = Random::new(1);
    let mut rigid = 0;
    for _ in 0..6 {
        put(&mut read, &exact, &mut |_| DEVIATION * random.normal());
        let found = identification(&all, &read, &OPTIONS)?;
        let first = &found.numbers[0];
        assert!(first.at_bound || first.knowledge == Knowledge::Weak);
        rigid += usize::from(first.at_bound);
        for (number, truth) in found.numbers.iter().zip(truth.iter()).take(4).skip(1) {
            let identified = number.identified.context("no value")?;
            assert!((identified * truth - 1.0).abs() < 0.03, "{number:?}");
        }
    }
    assert!((1..6).contains(&rigid), "{rigid} of 6");
    Ok(())
}

#[test]
fn what_places_cannot_tell_is_refused() -> Result<()> {
    let read = places(&postures(&mut Random::new(7), 1), 0.0);
    let model = h6(true);
    let joints = Unknowns::matching(&model, &["joints"])?;
    let refused = predict(&joints, &joints.nominal(), &read, Theory::SmallLoads);
    assert!(matches!(refused, Err(Error::PlacesNeedLoads { .. })));
    let unnamed = model
        .text
        .replace("name = \"to end 2\"", "")
        .replace("name = \"link 3\"", "");
    let refused = Unknowns::matching(&Model::from_toml(&unnamed, "arm.toml")?, &["geometry"]);
    assert!(matches!(refused, Err(Error::NoPlace { joint, .. }) if joint == "A4"));
    Ok(())
}

#[test]
fn misplaced_markers_leave_the_tool_where_it_is() -> Result<()> {
    // The arm is as it was drawn; only the markers are elsewhere, by some millimetres.
    let model = h6(true);
    let mut random = Random::new(3);
    let mut read = places(&postures(&mut random, 20), 0.0);
    let unknowns = Unknowns::matching(&model, &["geometry"])?.with_markers(&read, MARKER_ERROR);
    let mut truth = unknowns.nominal();
    for at in 36..45 {
        truth[at] += 4e-3 * random.normal();
    }
    let exact = predict(&unknowns, &truth, &read, Theory::Loaded)?;
    put(&mut read, &exact, &mut |_| 0.0);
    let found = identification(&unknowns, &read, &OPTIONS)?;
    let identified = identified_model(&model, &found, "places.csv")?;
    let commands = angles(&mut random);
    let tip = |model: &Model| -> Result<Vector3<f64>> {
        let posture = model
            .mechanism
            .posture(PostureRequest::commands(&commands))?;
        let tool = posture.deflected_by(&Wrench::zero())?.tool;
        Ok(tool.translation.vector + tool.rotation * vector![0.0, 0.0, 0.2])
    };
    let off = (tip(&identified)? - tip(&model)?).norm();
    assert!(off < 10e-6, "{off:e}");
    Ok(())
}
