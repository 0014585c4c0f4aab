//! The spread of the force's coefficients through to the errors, on machines whose answer is known in closed form.

use std::sync::Arc;

use kinetostat::{Directions, Mechanism};
use kinetostat_cutting::{Engagement, Linear, Shape, Side, Tool};
use kinetostat_machining::{
    Bounds, CutQuestion, CuttingLoad, CuttingTool, EngagementSource, ForceChoice, ForceOrigin,
    Placement, ProgramLoad, Run, RunInputs, Task, Unwatched, WeightCorrection, analyse,
    compensate_program, cut_places, cutting_result,
};
use kinetostat_model::Model;
use kinetostat_program::{Gcode, Program, ReadOptions, WriteOptions, interpret};
use nalgebra::{Vector3, vector};

use crate::springs::{self, STIFF};

const PROGRAM: &str = "G21 G90\nS10000 M3\nG0 X0 Y0 Z0\nG1 X40 F600\nG1 Y30\nG0 Z5\n";

/// That along y gives way alone.
fn machine() -> Mechanism {
    springs::machine([STIFF, 400.0, STIFF])
}

/// The force of the law times `factor`, known to `spread`.
fn question(factor: f64, spread: f64) -> CutQuestion {
    let tool = Tool::new(Shape::Flat, 6.0, 2).expect("tool");
    let law = Linear::new([800.0, 300.0, 0.0].map(|k| factor * k), [0.0; 3]).expect("law");
    let engagement = Engagement::straight(3.0, 2.0, 3.0, Side::Right).expect("engagement");
    CutQuestion {
        tools: vec![CuttingTool {
            spread,
            ..CuttingTool::new(tool, Arc::new(law))
        }],
        engagement: EngagementSource::Constant(engagement),
        choice: ForceChoice::Mean,
        rpm: None,
        rotation: None,
        spindle: None,
    }
}

fn run(
    machine: &Mechanism,
    origin: Vector3<f64>,
    question: &CutQuestion,
    work: fn(
        &Task<'_>,
        &dyn kinetostat_machining::Watch,
    ) -> Result<Run, kinetostat_machining::RunError>,
) -> Run {
    let program = Program::read(PROGRAM).expect("program");
    let reading = ReadOptions::default();
    let path = interpret(&program, &reading).expect("path");
    let forces = question.along(&path, &Unwatched).expect("forces");
    let task = Task {
        mechanism: machine,
        program: &Gcode {
            program: &program,
            path: &path,
            reading: &reading,
        },
        corrected: Directions::POSITION,
        placement: Placement::at(origin),
        load: ProgramLoad::new(CuttingLoad::FromCut {
            largest: forces.largest(),
            origin: ForceOrigin::Computed,
        }),
        tools: &[],
        weight: WeightCorrection::All,
        cut: Some(&forces),
        writing: WriteOptions::default(),
        run_inputs: RunInputs::default(),
        bounds: Bounds::default(),
        places: 0,
        compliances: false,
    };
    work(&task, &Unwatched).expect("run")
}

/// What a spring along y gives way by: on the line along x the force across the feed, on that along y the one along it.
#[test]
fn one_spring_gives_way_by_the_spread() {
    let (machine, spread) = (machine(), 0.25);
    let run = run(
        &machine,
        Vector3::zeros(),
        &question(1.0, spread),
        compensate_program,
    );
    let cutting = run.result.cutting.as_ref().expect("a cut");
    let of_line = |line: usize| {
        let place = cutting.places.iter().find(|p| p.line == line);
        *place.expect("a place")
    };
    let forces = [of_line(4).force_left_n, of_line(5).force_along_feed_n];
    assert!(forces.iter().all(|force| force.abs() > 5.0), "{forces:?}");
    let slack = 1e-3;
    let mut compared = [0; 2];
    for point in &run.points {
        let Some(force) = [4, 5].iter().position(|line| *line == point.line) else {
            continue;
        };
        // On the steps of the corner the force turns: what acts there is stated by the point.
        let across = point.force_n[1];
        let exact = spread * across.abs() / 400.0;
        for found in [
            point.error_if_force_larger_mm,
            point.error_if_force_smaller_mm,
        ] {
            let found = found.expect("solved");
            assert!((found - exact).abs() < slack, "{found} {exact}: {point:?}");
        }
        if point.kind == kinetostat_machining::PointKind::Feed
            && (across.abs() - forces[force].abs()).abs() < 1e-6 * across.abs()
        {
            compared[force] += 1;
        }
    }
    assert!(compared.iter().all(|count| *count > 3), "{compared:?}");
    let band = run.result.force_band.as_ref().expect("a band");
    let largest = forces
        .iter()
        .map(|f| f.abs())
        .fold(0.0, kinetostat::number::larger);
    let error = band.max_error_mm().expect("an error");
    assert!((error - spread * largest / 400.0).abs() < slack, "{error}");
    assert!((band.spread_percent - 25.0).abs() < 1e-12);
    assert_eq!(band.points, band.of_points);
    let text = run.result.force_band_text().expect("a sentence");
    assert!(text.contains("25 % larger or smaller"), "{text}");
}

/// The band of a program as it is: that of a law with so much larger coefficients.
#[test]
fn the_band_is_the_run_with_another_force() {
    let orthoglide = Model::preset("orthoglide").expect("preset").mechanism;
    for (machine, origin) in [
        (machine(), Vector3::zeros()),
        (orthoglide, vector![-0.02, -0.01, 0.1]),
    ] {
        let band = run(&machine, origin, &question(1.0, 0.3), analyse);
        // Nothing is cut in a rapid.
        let rapid = kinetostat_machining::PointKind::Rapid;
        let rapids: Vec<_> = band.points.iter().filter(|p| p.kind == rapid).collect();
        assert!(!rapids.is_empty());
        assert!(rapids.iter().all(|p| p.error_if_force_larger_mm.is_none()));
        let band = band.result.force_band.expect("a band");
        for (factor, found) in [
            (1.3, band.max_error_if_larger_mm),
            (0.7, band.max_error_if_smaller_mm),
        ] {
            let other = run(&machine, origin, &question(factor, 0.0), analyse).result;
            assert!(other.force_band.is_none() && other.force_band_text().is_none());
            let expected = other.summary.max_position_error_before_mm;
            let found = found.expect("an error");
            assert!(expected > 1e-3, "{expected}");
            assert!(
                (found - expected).abs() < 1e-6 * expected,
                "{found} {expected}"
            );
        }
    }
}

/// Of more places than are kept, the largest and the smallest of every stretch stay.
#[test]
fn a_long_program_keeps_its_extremes() {
    let mut text = "G21 G90\nS10000 M3\nG0 X0 Y0 Z0\n".to_owned();
    let count = 9000;
    for i in 0..count {
        // One line in the middle goes faster: its force is the largest.
        let feed = if i == 4321 { 1200 } else { 600 };
        text.push_str(&format!("G1 X{:.3} F{feed}\n", 0.01 * f64::from(i + 1)));
    }
    let path = interpret(
        &Program::read(text).expect("program"),
        &ReadOptions::default(),
    )
    .expect("path");
    let forces = question(1.0, 0.1).along(&path, &Unwatched).expect("forces");
    let all: Vec<_> = cut_places(&forces, &path).collect();
    let result = cutting_result(&forces, &path);
    assert!(all.len() > 2 * count as usize, "{}", all.len());
    assert!(result.places.len() <= kinetostat_machining::CuttingResult::MAX_PLACES);
    assert!(result.places.len() > 400);
    let largest = result.largest_force.expect("a force");
    assert_eq!(largest.line, 4 + 4321);
    assert_eq!(result.worst_lines[0].line, 4 + 4321);
    assert_eq!(result.worst_lines.len(), 10);
    assert!(result.places.contains(&largest));
    assert!(
        (result.cut_length_mm - 90.0).abs() < 1e-6,
        "{}",
        result.cut_length_mm
    );
    let ordered = result
        .places
        .windows(2)
        .all(|p| p[0].path_mm <= p[1].path_mm);
    assert!(ordered);
}
