//! A load that comes and goes in the air: the written program neither jumps nor goes back, and in the cut nothing is lost.

use kinetostat::{Directions, Mechanism};
use kinetostat_cutting::{Linear, Shape, Stock, StockSettings, Tool};
use kinetostat_machining::{
    Bounds, CutQuestion, CuttingLoad, CuttingTool, EngagementSource, ForceAlongPath, ForceChoice,
    ForceOrigin, Placement, ProgramLoad, Run, RunInputs, Task, Unwatched, WarningCode,
    WeightCorrection, analyse, compensate_program, straight_tool,
};
use kinetostat_model::Model;
use kinetostat_program::{Gcode, MoveKind, Path, Program, ReadOptions, WriteOptions, interpret};
use nalgebra::{Vector3, vector};
use std::sync::Arc;

fn machine() -> Mechanism {
    let model = Model::preset("orthoglide").expect("preset");
    model.mechanism.with_tool(&straight_tool(0.06))
}

fn read(text: &str) -> (Program, Path) {
    let program = Program::read(text).expect("program");
    let path = interpret(&program, &ReadOptions::default()).expect("path");
    (program, path)
}

/// Asks for a program under a load.
fn with_task<T>(
    text: &str,
    load: ProgramLoad,
    cut: Option<&ForceAlongPath>,
    ask: impl FnOnce(&Task<'_>) -> T,
) -> T {
    let (program, path) = read(text);
    let mechanism = machine();
    ask(&Task {
        mechanism: &mechanism,
        program: &Gcode {
            program: &program,
            path: &path,
            reading: &ReadOptions::default(),
        },
        corrected: Directions::POSITION,
        placement: Placement::at(vector![0.01, -0.02, 0.1]),
        load,
        tools: &[],
        weight: WeightCorrection::All,
        cut,
        writing: WriteOptions::default(),
        run_inputs: RunInputs::default(),
        bounds: Bounds::default(),
        places: 0,
        compliances: false,
    })
}

fn run(text: &str, load: ProgramLoad, cut: Option<&ForceAlongPath>) -> Run {
    with_task(text, load, cut, |task| {
        compensate_program(task, &Unwatched).unwrap_or_else(|e| panic!("{e}"))
    })
}

/// Ends of the written feed moves.
fn written(run: &Run) -> Vec<Vector3<f64>> {
    let bytes = run.written.as_ref().expect("written").bytes.clone();
    let (_, path) = read(std::str::from_utf8(&bytes).expect("text"));
    let feeds = path.moves.iter().filter(|m| m.kind == MoveKind::Feed);
    let mut ends: Vec<_> = feeds.clone().take(1).map(|m| m.start).collect();
    ends.extend(feeds.map(|m| m.end));
    ends
}

/// Largest change of the correction per mm of a straight program along an axis, with the digits that were written.
fn steepest(places: &[Vector3<f64>], axis: usize) -> f64 {
    let across = |v: Vector3<f64>| {
        let mut v = v;
        v[axis] = 0.0;
        v.norm()
    };
    let pieces = places
        .windows(2)
        .filter(|p| (p[1][axis] - p[0][axis]).abs() > 0.02);
    let steps = pieces.map(|p| across(p[1] - p[0]) / (p[1][axis] - p[0][axis]).abs());
    let steepest = steps.reduce(|a, b| if a > b { a } else { b });
    steepest.expect("no pieces")
}

const PLUNGE: &str = "G21 G90 G17\nG0 X5 Y-10 Z20\nG1 Z-6 F300\nG0 Z20\nM2\n";

/// A force along the tool that pushes it up by tenths of a millimetre: at once, the program would go up at the surface.
#[test]
fn a_plunge_goes_down_and_never_up() {
    let load = |below_z_mm, largest_step| ProgramLoad {
        below_z_mm,
        largest_step,
        ..ProgramLoad::new(CuttingLoad::Milling {
            radial: 0.0,
            tangential: 0.0,
            axial: -300.0,
        })
    };
    for below in [Some(0.0), None] {
        let slow = run(PLUNGE, load(below, 0.2), None);
        assert_eq!(slow.result.holds_tolerance(), Some(true));
        assert_eq!(slow.result.summary.corner_steps, 0);
        assert_eq!(slow.result.summary.entry_steps, 0);
        assert_eq!(slow.result.summary.largest_backward_step_mm, 0.0);
        let places = written(&slow);
        assert!(places.windows(2).all(|p| p[1].z < p[0].z), "{places:?}");
        assert!(places.len() > 2);
        // At the bottom all of the force acts, whenever it came.
        let at_once = run(PLUNGE, load(below, f64::INFINITY), None);
        let bottom = |run: &Run| *written(run).last().expect("written");
        assert!((bottom(&slow) - bottom(&at_once)).norm() < 1e-3);
        // Before, it came at once: the program stood at the surface, or went up.
        let jumped = written(&at_once);
        let summary = &at_once.result.summary;
        let steps = match below {
            Some(_) => summary.corner_steps,
            None => summary.entry_steps,
        };
        assert!(steps > 0, "{jumped:?}");
    }
}

/// Below the surface all of the force acts: it came in the air above.
#[test]
fn a_stated_height_keeps_all_of_the_force_below_it() {
    let load = ProgramLoad {
        below_z_mm: Some(0.0),
        ..ProgramLoad::new(CuttingLoad::Milling {
            radial: 0.0,
            tangential: 0.0,
            axial: -300.0,
        })
    };
    let run = run(PLUNGE, load, None);
    let (mut below, mut above, mut far) = (0, 0, 0);
    for point in run.points.iter().filter(|p| p.position_mm[2] < 19.0) {
        let force = point.force_n[2];
        let z = point.position_mm[2];
        if z < 0.0 {
            assert!((force + 300.0).abs() < 0.1, "{z}: {force}");
            below += 1;
        } else if z < 0.3 {
            assert!(force < -100.0, "{z}: {force}");
            above += 1;
        } else if z > 10.0 {
            assert!(force.abs() < 1e-9, "{z}: {force}");
            far += 1;
        }
    }
    assert!(below > 5 && above > 0 && far > 5, "{below} {above} {far}");
}

fn tool() -> CuttingTool {
    let law = Linear::new([400.0, 800.0, 250.0], [10.0, 20.0, 4.0]).unwrap();
    let tool = Tool::new(Shape::Flat, 6.0, 2).unwrap();
    CuttingTool::new(tool, Arc::new(law))
}

fn forces(text: &str, stock: Stock) -> ForceAlongPath {
    let question = CutQuestion {
        tools: vec![tool()],
        engagement: EngagementSource::Stock(Box::new(stock)),
        choice: ForceChoice::Mean,
        rpm: None,
        rotation: None,
        spindle: None,
    };
    let (_, path) = read(text);
    question.along(&path, &Unwatched).expect("forces")
}

fn block(corners: [[f64; 3]; 2]) -> Stock {
    let settings = StockSettings::for_tool(&tool().tool);
    Stock::block(corners[0], corners[1], &settings).unwrap()
}

/// A flat tool touches the block with all of its end at once.
#[test]
fn a_plunge_into_a_block_is_met_from_the_air() {
    let text = "G21 G90 G17\nS10000 M3\nG0 X0 Y0 Z15\nG1 Z-4 F600\nG0 Z15\nM2\n";
    let along = forces(text, block([[-20.0, -20.0, -10.0], [20.0, 20.0, 0.0]]));
    let load = |largest_step| ProgramLoad {
        largest_step,
        ..ProgramLoad::new(CuttingLoad::FromCut {
            largest: along.largest(),
            origin: ForceOrigin::Computed,
        })
    };
    let run = |step| run(text, load(step), Some(&along));
    let slow = run(0.05);
    let places = written(&slow);
    assert_eq!(slow.result.holds_tolerance(), Some(true));
    assert!(places.windows(2).all(|p| p[1].z < p[0].z), "{places:?}");
    assert_eq!(slow.result.summary.corner_steps, 0);
    assert!(
        !slow
            .result
            .warnings
            .iter()
            .any(|w| w.code == WarningCode::ForceChangesFast)
    );
    // As deep as the tool cuts, the force is that of the cut.
    let of_cut = along.largest().force().z;
    let deep = slow.points.iter().filter(|p| p.position_mm[2] < -0.5);
    let compared = deep
        .map(|p| assert!((p.force_n[2] - of_cut).abs() < 0.02 * of_cut.abs()))
        .count();
    assert!(compared > 3);
}

/// A step in the block: the force is twice as large from one millimetre to the next, in the middle of the cut.
#[test]
fn a_jump_inside_a_cut_is_named_with_its_line() {
    let text = "G21 G90 G17\nS10000 M3\nG0 X-40 Y0 Z-4\nG1 X40 F600\nG1 X41 F100\nG0 Z15\nM2\n";
    // The feed falls to a sixth in the slot, and with it the force, at one place.
    let text = text
        .replace("G1 X40 F600", "G1 X0 F600")
        .replace("G1 X41 F100", "G1 X40 F100");
    let along = forces(&text, block([[-20.0, -20.0, -10.0], [20.0, 20.0, 0.0]]));
    let step = 0.06;
    let load = ProgramLoad {
        largest_step: step,
        ..ProgramLoad::new(CuttingLoad::FromCut {
            largest: along.largest(),
            origin: ForceOrigin::Computed,
        })
    };
    let found = run(&text, load, Some(&along));
    let warned = found
        .result
        .warnings
        .iter()
        .find(|w| w.code == WarningCode::ForceChangesFast)
        .expect("the jump is not named");
    assert!([4, 5].contains(&warned.line.unwrap()), "{warned:?}");
    let missed = found
        .result
        .tolerance
        .missed
        .clone()
        .expect("the tolerance cannot be met");
    assert!([4, 5].contains(&missed.line), "{missed:?}");
    assert!(missed.reason.contains("faster"), "{missed:?}");
    // At the jump about half of it is left, and no more.
    let jump = (along.wrench(1, 0.95).force() - along.wrench(2, 0.05).force()).norm();
    assert!(jump > 10.0, "{jump}");
    let off = jump / found.result.summary.smallest_stiffness_n_per_mm;
    let there = found.points.iter().filter(|p| p.position_mm[0].abs() < 3.0);
    let errors = there.map(|p| Vector3::from(p.error_after_mm).norm());
    let left = errors.reduce(|a, b| if a > b { a } else { b });
    let left = left.expect("no places there");
    assert!(left > 0.05 * off && left < 0.6 * off, "{left} {off}");
    let steepest = steepest(&written(&found), 0);
    assert!(steepest < 1.1 * step, "{steepest}");
    // At the default rate the change is over before it matters where it is.
    let load = ProgramLoad {
        largest_step: 0.5,
        ..load
    };
    let found = run(&text, load, Some(&along));
    assert_eq!(found.result.holds_tolerance(), Some(true));
}

/// What is said of the program as it is does not depend on whether another is written.
#[test]
fn an_analysis_has_the_same_load() {
    let load = ProgramLoad::new(CuttingLoad::Milling {
        radial: 120.0,
        tangential: -30.0,
        axial: -300.0,
    });
    let [analysed, written] = with_task(PLUNGE, load, None, |task| {
        let written = compensate_program(task, &Unwatched).expect("program");
        [analyse(task, &Unwatched).expect("analysis"), written]
    });
    let mut compared = 0;
    for point in &analysed.points {
        let same = written
            .points
            .iter()
            .find(|p| (p.line, p.share) == (point.line, point.share));
        let same = same.expect("a place of the program that was not looked at");
        assert!((same.force_n[2] - point.force_n[2]).abs() < 1e-9);
        compared += 1;
    }
    assert!(compared > 10);
}
