//! How fast the written correction changes, and what is said of it: on springs, where it is a force over a stiffness.

use std::sync::Arc;

use kinetostat::{Directions, Wrench};
use kinetostat_cutting::{Engagement, Linear, Shape, Side, Stock, StockSettings, Tool};
use kinetostat_machining::{
    Bounds, CutQuestion, CuttingLoad, CuttingTool, EngagementSource, ForceChoice, ForceOrigin,
    LoadAxes, LoadBegins, Placement, PointKind, ProgramLoad, Run, RunInputs, Task, Unwatched,
    Warning, WarningCode, WeightCorrection, compensate_program,
};
use kinetostat_program::{Gcode, MoveKind, Path, Program, ReadOptions, WriteOptions, interpret};
use nalgebra::{Vector3, vector};

use crate::springs::{self, STIFF};

/// Stiffness, N/mm.
const K: f64 = 400.0;

fn read(text: &str) -> (Program, Path) {
    let program = Program::read(text).expect("program");
    let path = interpret(&program, &ReadOptions::default()).expect("path");
    (program, path)
}

fn run(text: &str, stiffness: [f64; 3], load: CuttingLoad) -> Run {
    run_with(text, stiffness, ProgramLoad::new(load), None)
}

fn run_with(
    text: &str,
    stiffness: [f64; 3],
    load: ProgramLoad,
    source: Option<EngagementSource>,
) -> Run {
    let (program, path) = read(text);
    let forces = source.map(|engagement| {
        let law = Linear::new([800.0, 300.0, 200.0], [0.0; 3]).expect("law");
        let tool = Tool::new(Shape::Flat, 6.0, 2).expect("tool");
        let question = CutQuestion {
            tools: vec![CuttingTool::new(tool, Arc::new(law))],
            engagement,
            choice: ForceChoice::Mean,
            rpm: None,
            rotation: None,
            spindle: None,
        };
        question.along(&path, &Unwatched).expect("forces")
    });
    let load = match &forces {
        Some(forces) => ProgramLoad {
            cutting: CuttingLoad::FromCut {
                largest: forces.largest(),
                origin: ForceOrigin::Computed,
            },
            ..load
        },
        None => load,
    };
    let mechanism = springs::machine(stiffness);
    let task = Task {
        mechanism: &mechanism,
        program: &Gcode {
            program: &program,
            path: &path,
            reading: &ReadOptions::default(),
        },
        corrected: Directions::POSITION,
        placement: Placement::at(Vector3::zeros()),
        load,
        tools: &[],
        weight: WeightCorrection::All,
        cut: forces.as_ref(),
        writing: WriteOptions::default(),
        run_inputs: RunInputs::default(),
        bounds: Bounds::default(),
        places: 0,
        compliances: false,
    };
    compensate_program(&task, &Unwatched).unwrap_or_else(|e| panic!("{e}"))
}

fn along_y(force: f64) -> CuttingLoad {
    CuttingLoad::Constant {
        axes: LoadAxes::Base,
        wrench: Wrench::new(vector![0.0, force, 0.0], Vector3::zeros()),
    }
}

/// Of a program along z and x under a force along y: places of the written feed moves with the length of path up to them, and
/// largest change of y between two of them per mm of path.
fn by_hand(run: &Run) -> (Vec<[f64; 2]>, f64) {
    let bytes = &run.written.as_ref().expect("written").bytes;
    let (_, path) = read(std::str::from_utf8(bytes).expect("text"));
    let mut list: Vec<[f64; 2]> = Vec::new();
    for motion in path.moves.iter().filter(|m| m.kind == MoveKind::Feed) {
        let way = motion.end - motion.start;
        if list.is_empty() {
            list.push([0.0, motion.start.y]);
        }
        let before = list[list.len() - 1][0];
        list.push([before + way.x.hypot(way.z), motion.end.y]);
    }
    let changes = list
        .windows(2)
        .filter(|p| p[1][0] - p[0][0] > 0.01)
        .map(|p| (p[1][1] - p[0][1]).abs() / (p[1][0] - p[0][0]));
    let fastest = changes.reduce(|a, b| if b > a { b } else { a });
    (list, fastest.expect("no written feed move"))
}

fn warned(run: &Run) -> Option<&Warning> {
    let code = WarningCode::CorrectionChangesFast;
    run.result.warnings.iter().find(|w| w.code == code)
}

/// 400 N on 400 N/mm: a correction of 1 mm, that comes over 2 mm of path where there are as many.
#[test]
fn a_load_comes_over_the_stated_length_or_over_all_the_feed_there_is() {
    for (length, change) in [
        (0.2, 5.0),
        (1.9, 1.0 / 1.9),
        (2.1, 0.5),
        (3.0, 0.5),
        (30.0, 0.5),
    ] {
        let text = format!("G21 G90\nG0 X0 Y0 Z0\nG1 Z-{length} F300\nG0 Z20\nM2\n");
        let run = run(&text, [STIFF, K, STIFF], along_y(400.0));
        let found = run
            .result
            .summary
            .largest_change_mm_per_mm
            .expect("a change");
        let (places, fastest) = by_hand(&run);
        assert!((found.value - change).abs() < 0.02, "{length}: {found:?}");
        assert!((found.value - fastest).abs() < 0.02, "{length}: {fastest}");
        assert_eq!((found.line, found.stated), (3, Some(0.5)));
        // At the end all of it is there.
        let [way, last] = places[places.len() - 1];
        assert!(
            (way - length).abs() < 1e-6 && (last + 1.0).abs() < 1e-3,
            "{places:?}"
        );
        assert_eq!(
            run.result.summary.corner_steps + run.result.summary.entry_steps,
            0
        );
        let faster = change > 0.52;
        assert_eq!(found.lines_beyond, usize::from(faster), "{length}");
        let ramp = run.result.summary.load_ramp.expect("a ramp");
        assert_eq!(ramp.begins, LoadBegins::AfterRapid);
        let expected = if length < 2.0 { length } else { 2.0 };
        assert!((ramp.length_mm - expected).abs() < 1e-6, "{ramp:?}");
        let text = run.result.ramp_text().expect("a sentence");
        assert!(
            text.contains("after a rapid") && text.contains("until the next"),
            "{text}"
        );
        match warned(&run) {
            Some(warning) => {
                assert!(faster && warning.line == Some(3), "{length}: {warning}");
                assert!(warning.message.contains("between two rapids"), "{warning}");
            }
            None => assert!(!faster, "{length}"),
        }
    }
}

/// Round a corner, and past a move that is too short to have a direction.
#[test]
fn it_goes_on_coming_in_the_moves_that_follow() {
    for text in [
        "G21 G90\nG0 X0 Y0 Z0\nG1 Z-0.2 F300\nG1 X20\nG0 Z20\nM2\n",
        "G21 G90\nG0 X0 Y0 Z0\nG1 X0.005 F300\nG1 X20\nG0 Z20\nM2\n",
        "G21 G90\nG0 X0 Y0 Z0\nG1 X0.3 F300\nG1 X0.305\nG1 X0.308\nG1 X20\nG0 Z20\nM2\n",
    ] {
        let run = run(text, [STIFF, K, STIFF], along_y(400.0));
        let summary = &run.result.summary;
        let found = summary.largest_change_mm_per_mm.expect("a change");
        let (places, fastest) = by_hand(&run);
        assert!(
            (found.value - 0.5).abs() < 0.02 && fastest < 0.52,
            "{text}: {found:?} {fastest}"
        );
        assert_eq!((found.lines_beyond, warned(&run)), (0, None));
        assert_eq!(
            (summary.corner_steps, summary.entry_steps),
            (0, 0),
            "{text}"
        );
        // Half of it after half of the length.
        let after = places.partition_point(|p| p[0] < 1.0);
        let (a, b) = (places[after - 1], places[after]);
        let half = a[1] + (b[1] - a[1]) * (1.0 - a[0]) / (b[0] - a[0]);
        assert!((half + 0.5).abs() < 2e-3, "{text}: {half}");
    }
}

/// The same of forces of an engagement that is stated, which also turn at the corner.
#[test]
fn stated_engagements_come_round_a_corner() {
    let engagement = Engagement::straight(3.0, 2.0, 3.0, Side::Right).expect("engagement");
    let text = "G21 G90\nS10000 M3\nG0 X0 Y0 Z0\nG1 X0.1 F300\nG1 Y0.1 F300\nG1 X-20\nG0 Z20\nM2\n";
    let load = ProgramLoad {
        largest_step: 0.05,
        ..ProgramLoad::new(CuttingLoad::None)
    };
    let source = EngagementSource::Constant(engagement);
    let run = run_with(text, [20.0; 3], load, Some(source));
    let found = run.result.summary.largest_change_mm_per_mm;
    let found = found.expect("a change");
    // Components come one by one, each as fast as they may all together.
    assert!(
        found.value < 0.05 + 0.018 && found.value > 0.02,
        "{found:?}"
    );
    assert_eq!((found.lines_beyond, warned(&run)), (0, None));
    assert!(run.result.summary.corner_steps >= 1 && run.result.summary.entry_steps == 0);
    let most = run.result.summary.max_correction_mm;
    assert!(most > 0.1, "{most}");
    let ramp = run.result.summary.load_ramp.expect("a ramp");
    assert!(ramp.length_mm > 2.0 && ramp.length_mm < 15.0, "{ramp:?}");
    // Round the corner behind that, all of it acts, and does not come again.
    let text = "G21 G90\nS10000 M3\nG0 X0 Y0 Z0\nG1 X20 F300\nG1 Y20\nG0 Z20\nM2\n";
    let engagement = Engagement::straight(3.0, 2.0, 3.0, Side::Right).expect("engagement");
    let source = EngagementSource::Constant(engagement);
    let run = run_with(text, [20.0; 3], load, Some(source));
    let forces: Vec<(usize, f64, f64)> = run
        .points
        .iter()
        .filter(|p| p.kind == PointKind::Feed)
        .map(|p| (p.line, p.share, Vector3::from(p.force_n).norm()))
        .collect();
    let of = |line: usize, from: f64, to: f64| {
        let there = |p: &&(usize, f64, f64)| p.0 == line && p.1 >= from && p.1 <= to;
        let found: Vec<f64> = forces.iter().filter(there).map(|p| p.2).collect();
        assert!(!found.is_empty(), "{line} {from}");
        found
    };
    let full = of(5, 0.9, 1.0)[0];
    let after = of(5, 0.0, 1.0).into_iter().chain(of(4, 0.95, 1.0));
    assert!(
        after.into_iter().all(|f| (f / full - 1.0).abs() < 0.02),
        "{forces:?}"
    );
    assert!(
        of(4, 0.0, 0.05).iter().all(|f| *f < 0.5 * full),
        "{forces:?}"
    );
}

/// A force of one size that turns with an arc: over an angle of 1/R per mm of path.
#[test]
fn an_arc_turns_the_correction_as_fast_as_it_is_small() {
    let milling = CuttingLoad::Milling {
        radial: 60.0,
        tangential: -80.0,
        axial: 0.0,
    };
    let force = 100.0;
    for radius in [0.3, 0.4, 4.0] {
        // Along the tangent to a circle, and out along it.
        let text = format!(
            "G21 G90 G17\nG0 X-20 Y0 Z0\nG1 X0 F600\nG3 X0 Y0 I0 J{radius}\nG1 X20\nG0 Z20\nM2\n"
        );
        let run = run(&text, [K; 3], milling);
        let found = run.result.summary.largest_change_mm_per_mm;
        let found = found.expect("a change");
        let turns = force / K / radius;
        let expected = if turns > 0.5 { turns } else { 0.5 };
        assert!(
            (found.value / expected - 1.0).abs() < 0.03,
            "{radius}: {found:?}"
        );
        assert_eq!(found.line, if turns > 0.5 { 4 } else { 3 });
        match warned(&run) {
            Some(warning) => {
                assert!(turns > 0.5 && warning.line == Some(4), "{warning}");
                assert!(
                    warning.message.contains("direction of the force"),
                    "{warning}"
                );
            }
            None => assert!(turns < 0.5, "{radius}"),
        }
    }
}

/// Corners of 25 degrees every 0.05 mm: gentle ones, over which the force turns evenly.
#[test]
fn short_blocks_turn_it_too() {
    let (turn, block, force) = (25_f64.to_radians(), 0.05, 100.0);
    let mut text = "G21 G90\nG0 X-20 Y0 Z0\nG1 X0 F600\n".to_owned();
    let mut place = Vector3::zeros();
    for i in 1..=14 {
        let angle = turn * f64::from(i);
        place += block * vector![angle.cos(), angle.sin(), 0.0];
        text += &format!("G1 X{:.5} Y{:.5}\n", place.x, place.y);
    }
    text += "G0 Z20\nM2\n";
    let milling = CuttingLoad::Milling {
        radial: force,
        tangential: 0.0,
        axial: 0.0,
    };
    let run = run(&text, [K; 3], milling);
    let found = run.result.summary.largest_change_mm_per_mm;
    let found = found.expect("a change");
    let least = 2.0 * (0.5 * turn).sin() * force / K / block;
    let most = turn * force / K / block;
    assert!(
        found.value > 0.97 * least && found.value < 1.02 * most + 0.02,
        "{found:?} {least} {most}"
    );
    assert!(found.lines_beyond >= 10 && found.line > 3, "{found:?}");
    let warning = warned(&run).expect("it is not said");
    assert!(
        warning.message.contains("direction of the force"),
        "{warning}"
    );
}

/// A rapid into the block: the force of the slot is there at once, 6 mm wide.
#[test]
fn a_step_where_a_rapid_ends_is_no_corner() {
    let settings = StockSettings::for_tool(&Tool::new(Shape::Flat, 6.0, 2).unwrap());
    let stock = Stock::block([-20.0, -20.0, -10.0], [20.0, 20.0, 0.0], &settings).unwrap();
    let source = EngagementSource::Stock(Box::new(stock));
    let text = "G21 G90\nS10000 M3\nG0 X0 Y0 Z-4\nG1 X10 F600\nG0 Z20\nM2\n";
    let load = ProgramLoad::new(CuttingLoad::None);
    let run = run_with(text, [K; 3], load, Some(source));
    let summary = &run.result.summary;
    assert_eq!((summary.entry_steps, summary.corner_steps), (1, 0));
    let there = run
        .points
        .iter()
        .find(|p| p.line == 4 && p.kind == PointKind::Feed);
    let force = Vector3::from(there.expect("a place").force_n).norm();
    let step = summary.largest_entry_step_mm;
    assert!(
        force > 10.0 && (step - force / K).abs() < 0.05 * step,
        "{step} {force}"
    );
    let words = run.result.corners_text().expect("a sentence");
    assert!(words.starts_with("Where a rapid ends"), "{words}");
    assert!(
        words.contains("1 step where a rapid ends") && !words.contains("corner"),
        "{words}"
    );
}

/// Blocks of 0.003 mm while a correction of a few digits comes: a digit more or less is a tenth of their length.
#[test]
fn rounding_is_no_change() {
    let mut text = "G21 G90\nG0 X0 Y0 Z0\nG1 X0.003 F600\n".to_owned();
    for i in 2..=600 {
        text += &format!("X{:.3}\n", 0.003 * f64::from(i));
    }
    text += "G0 Z20\nM2\n";
    let load = ProgramLoad {
        largest_step: 0.01,
        ..ProgramLoad::new(along_y(4.0))
    };
    let run = run_with(&text, [STIFF, K, STIFF], load, None);
    let found = run.result.summary.largest_change_mm_per_mm;
    let found = found.expect("a change");
    // 0.01 mm over 1 mm; as written, from block to block, by whole digits or not at all.
    assert!(found.value >= 0.01 && found.value < 0.0275, "{found:?}");
    assert_eq!((found.lines_beyond, warned(&run)), (0, None));
    let bytes = &run.written.as_ref().expect("written").bytes;
    let (_, path) = read(std::str::from_utf8(bytes).expect("text"));
    let jumps = path.moves.iter().filter(|m| m.kind == MoveKind::Feed);
    let jumps = jumps
        .filter(|m| (m.end.y - m.start.y).abs() > 0.9e-4)
        .count();
    assert!((90..=110).contains(&jumps), "{jumps}");
}

/// The same figure from the written pieces, place by place in small steps.
#[test]
fn the_change_is_that_of_the_written_pieces() {
    let mut text = "G21 G90\nG0 X-2 Y0 Z0\nG1 X0 F600\n".to_owned();
    let (mut place, mut angle, mut state) = (Vector3::zeros(), 0.0_f64, 7_u32);
    let mut random = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(state) / f64::from(u32::MAX)
    };
    for _ in 0..40 {
        angle += 0.8 * (random() - 0.4);
        place += (0.004 + 0.2 * random()) * vector![angle.cos(), angle.sin(), 0.0];
        text += &format!("G1 X{:.4} Y{:.4}\n", place.x, place.y);
    }
    text += "G0 Z20\nM2\n";
    let milling = CuttingLoad::Milling {
        radial: 50.0,
        tangential: -20.0,
        axial: 0.0,
    };
    let run = run(&text, [K; 3], milling);
    let (_, path) = read(&text);
    let written = run.written.as_ref().expect("written");
    let mut pieces = Vec::new();
    let mut way = 0.0;
    for piece in &written.pieces {
        let motion = &path.moves[piece.move_index];
        if motion.kind == MoveKind::Rapid {
            continue;
        }
        assert!(!piece.corner_step, "one stretch is wanted");
        let length = motion.length_mm() * (piece.share_to - piece.share_from);
        let from = piece.commanded_from - motion.point(piece.share_from);
        let to = piece.commanded_to - motion.point(piece.share_to);
        pieces.push((way, length, from, to));
        way += length;
    }
    let correction = |at: f64| {
        let after = pieces.partition_point(|(from, ..)| *from <= at);
        let (start, length, from, to) = pieces[after - 1];
        from.lerp(&to, ((at - start) / length).clamp(0.0, 1.0))
    };
    let (step, window) = (0.000_3, 0.01);
    let mut fastest = 0.0;
    let mut at = 0.0;
    while at + window < way {
        let change = (correction(at + window) - correction(at)).norm() / window;
        fastest = if change > fastest { change } else { fastest };
        at += step;
    }
    let found = run.result.summary.largest_change_mm_per_mm;
    let found = found.expect("a change").value;
    assert!(
        pieces.len() > 40 && fastest > 0.5,
        "{} {fastest}",
        pieces.len()
    );
    assert!(
        found >= fastest && found < 1.02 * fastest,
        "{found} {fastest}"
    );
}

/// Where the height is stated below which the load acts, that is said instead.
#[test]
fn a_stated_height_is_said() {
    let load = ProgramLoad {
        below_z_mm: Some(-1.0),
        ..ProgramLoad::new(along_y(400.0))
    };
    let text = "G21 G90\nG0 X0 Y0 Z5\nG1 Z-4 F300\nG1 X20\nG0 Z20\nM2\n";
    let run = run_with(text, [STIFF, K, STIFF], load, None);
    let ramp = run.result.summary.load_ramp.expect("a ramp");
    assert_eq!(ramp.begins, LoadBegins::BelowHeight);
    assert!((ramp.length_mm - 2.0).abs() < 1e-6, "{ramp:?}");
    let words = run.result.ramp_text().expect("a sentence");
    assert!(words.contains("height"), "{words}");
    assert_eq!(warned(&run), None);
}
