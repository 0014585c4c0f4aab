//! Own weight: which part of the displacement by it is an error depends on how the part frame was measured. What is expected comes from
//! single postures of the general engine.

use kinetostat::{Directions, Mechanism, Wrench};
use kinetostat_machining::{
    Bounds, CuttingLoad, Grid, LoadAxes, MapTask, Placement, ProgramLoad, Run, RunError, RunInputs,
    Task, TouchOff, Unwatched, Variable, WeightCorrection, analyse, compensate_program, map,
    straight_tool,
};
use kinetostat_model::Model;
use kinetostat_program::{Gcode, Program, ReadOptions, WriteOptions, interpret};
use nalgebra::{Vector3, vector};

/// A triangle, 300 mm wide and 200 mm deep.
const TRIANGLE: &str =
    "G21 G90\nG0 X0 Y0 Z10\nG1 Z0 F600\nG1 X300\nG1 X150 Y200\nG1 X0 Y0\nG0 Z10\nM2\n";

const PUSH: Vector3<f64> = vector![200.0, -100.0, 50.0];

fn arm() -> Mechanism {
    let arm = Model::preset("heavy_6r").expect("preset").mechanism;
    arm.with_tool(&straight_tool(0.18))
}

fn placement(arm: &Mechanism) -> Placement {
    let home = arm.platforms()[arm.tool()].home;
    Placement {
        tool_orientation: home.rotation,
        ..Placement::at(vector![1.5, -0.1, 0.9])
    }
}

fn run(weight: WeightCorrection, push: Vector3<f64>, write: bool) -> Result<Run, RunError> {
    let arm = arm();
    let program = Program::read(TRIANGLE).expect("program");
    let reading = ReadOptions::default();
    let path = interpret(&program, &reading).expect("path");
    let load = CuttingLoad::Constant {
        axes: LoadAxes::Base,
        wrench: Wrench::new(push, Vector3::zeros()),
    };
    let task = Task {
        mechanism: &arm,
        program: &Gcode {
            program: &program,
            path: &path,
            reading: &reading,
        },
        corrected: Directions::POSITION,
        placement: placement(&arm),
        load: ProgramLoad::new(load),
        tools: &[],
        weight,
        cut: None,
        writing: WriteOptions::default(),
        run_inputs: RunInputs::default(),
        bounds: Bounds::default(),
        places: 0,
        compliances: false,
    };
    match write {
        true => compensate_program(&task, &Unwatched),
        false => analyse(&task, &Unwatched),
    }
}

/// From where the tool is commanded to where it is, mm.
fn moved(arm: &Mechanism, place_mm: [f64; 3], wrench: &Wrench) -> Vector3<f64> {
    let pose = placement(arm).tool_pose(&place_mm.into());
    let posture = arm.posture(&pose).expect("a posture");
    let found = posture.deflected_by(wrench).expect("an equilibrium");
    found.displacement.linear() * 1e3
}

fn touched(places: &[[f64; 3]]) -> WeightCorrection {
    WeightCorrection::TouchOff(TouchOff::at(places.to_vec()).expect("places"))
}

#[test]
fn only_the_part_of_the_weight_that_the_frame_does_not_contain_is_an_error() {
    let arm = arm();
    let corner = [0.0, 0.0, 0.0];
    for weight in [
        WeightCorrection::All,
        WeightCorrection::None,
        touched(&[corner]),
    ] {
        let run = run(weight.clone(), PUSH, true).expect("a run");
        for point in &run.points {
            let wrench = Wrench::new(point.force_n.into(), Vector3::zeros());
            let at = point.position_mm;
            let contained = match weight {
                WeightCorrection::None => moved(&arm, at, &Wrench::zero()),
                WeightCorrection::TouchOff(_) => moved(&arm, corner, &Wrench::zero()),
                _ => Vector3::zeros(),
            };
            let expected = moved(&arm, at, &wrench) - contained;
            let off = (Vector3::from(point.error_before_mm) - expected).norm();
            assert!(off < 1e-7, "{weight:?} {point:?} {expected}");
            // The written program brings the tool onto the part as it was measured.
            let commanded: Vector3<f64> = Vector3::from(at) + Vector3::from(point.correction_mm);
            let found = moved(&arm, commanded.into(), &wrench) + commanded;
            let left = (found - Vector3::from(at) - contained).norm();
            let reported = Vector3::from(point.error_after_mm).norm();
            assert!(
                (left - reported).abs() < 1e-7,
                "{weight:?} {left} {reported}"
            );
            assert!(left < 2e-3, "{weight:?} {left}");
        }
        let s = &run.result.summary;
        let whole = s.max_displacement_by_weight_mm.expect("weight");
        let error = s.max_error_by_own_weight_mm.expect("weight");
        assert!(whole > 0.3, "{whole}");
        match weight {
            WeightCorrection::All => assert!((error - whole).abs() < 1e-9),
            WeightCorrection::None => assert!(error < 1e-9),
            _ => assert!(
                error < 0.5 * whole && error > 0.01 * whole,
                "{error} {whole}"
            ),
        }
        let said = run.result.own_weight_text().expect("a sentence");
        assert!(said.contains(weight.word()), "{said}");
    }
}

/// Three places measure the frame with its orientation: what is left at them has neither a sum nor a moment.
#[test]
fn several_places_take_out_the_rigid_motion_that_fits_best() {
    let places = [[0.0; 3], [300.0, 0.0, 0.0], [150.0, 200.0, 0.0]];
    let run = run(touched(&places), Vector3::zeros(), false).expect("a run");
    let arm = arm();
    let (mut sum, mut moment, mut sizes) = (Vector3::zeros(), Vector3::zeros(), [vec![], vec![]]);
    for place in places {
        let away = |p: &&kinetostat_machining::PointResult| {
            (Vector3::from(p.position_mm) - Vector3::from(place)).norm()
        };
        let nearest = run.points.iter().min_by(|a, b| away(a).total_cmp(&away(b)));
        let nearest = nearest.expect("a point");
        assert!(away(&nearest) < 1e-9, "{nearest:?}");
        let left = Vector3::from(nearest.error_before_mm);
        sum += left;
        let sag = moved(&arm, place, &Wrench::zero());
        // About where the frame has these places.
        moment += (Vector3::from(place) + sag - left).cross(&left);
        sizes[0].push(left.norm());
        sizes[1].push(sag.norm());
    }
    let [left, whole] = sizes.map(kinetostat_testing::largest);
    assert!(whole > 0.3 && left < 0.1 * whole, "{left} {whole}");
    assert!(sum.norm() < 1e-8 && moment.norm() < 1e-5, "{sum} {moment}");
}

#[test]
fn own_weight_of_which_nobody_says_anything_is_refused() {
    for write in [false, true] {
        let error = run(WeightCorrection::NotStated, PUSH, write).expect_err("a question");
        let RunError::WeightNotStated { displacement_mm } = error else {
            panic!("{error}");
        };
        assert!((0.3..3.0).contains(&displacement_mm), "{displacement_mm}");
        let said = error.to_string();
        for word in ["\"touch-off\"", "\"all\"", "\"none\""] {
            assert!(said.contains(word), "{said}");
        }
    }
    let out_of_reach = touched(&[[9000.0, 0.0, 0.0]]);
    let error = run(out_of_reach, PUSH, false).expect_err("out of reach");
    assert!(matches!(error, RunError::TouchOff { .. }), "{error}");
    assert!(TouchOff::at(vec![[0.0; 3], [1.0, 0.0, 0.0]]).is_err());
    assert!(TouchOff::at(Vec::new()).is_err());
}

/// A map tells what the load moves from where own weight has the tool, as single postures do.
#[test]
fn a_map_tells_load_and_weight_apart() {
    let arm = arm();
    let wrench = Wrench::new(PUSH, Vector3::zeros());
    let home = arm.platforms()[arm.tool()].home;
    let task = MapTask {
        mechanism: &arm,
        grid: Grid {
            from_mm: [1450.0, -150.0, 850.0],
            to_mm: [1550.0, 50.0, 950.0],
            counts: [3, 3, 2],
        },
        orientation: home.rotation,
        orientation_follows: false,
        load: Some(wrench),
        further: Vec::new(),
        variables: vec![Variable::DeflectionByLoad, Variable::DeflectionWithoutLoad],
        ratings: Vec::new(),
        first: 0,
    };
    let mut places = Vec::new();
    let put = |block: Vec<kinetostat_machining::MapPlace>| {
        places.extend(block);
        Ok::<(), RunError>(())
    };
    map(&task, &Unwatched, <[_]>::to_vec, put).expect("a map");
    assert_eq!(places.len(), 18);
    for place in places {
        let at = kinetostat::Pose::from_parts(
            (Vector3::from(place.position_mm) * 1e-3).into(),
            home.rotation,
        );
        let of = |wrench: &Wrench| {
            let posture = arm.posture(&at).expect("a posture");
            let found = posture.deflected_by(wrench).expect("an equilibrium");
            found.displacement.linear()
        };
        let unloaded = of(&Wrench::zero());
        let expected = [(of(&wrench) - unloaded).norm(), unloaded.norm()];
        for (value, expected) in place.values.iter().zip(expected) {
            assert!((value - expected).abs() < 1e-10, "{value} {expected}");
        }
        assert!(
            expected[1] > 2e-4 && place.values.len() == 2,
            "{expected:?}"
        );
    }
}
