//! A program that is run in parts has the figures of the whole.

use kinetostat::{Directions, Mechanism, Pose};
use kinetostat_machining::{
    Bounds, CuttingLoad, MergedRun, OfWhole, Placement, ProgramLoad, Run, RunInputs, Task,
    Unwatched, WeightCorrection, analyse, analyse_part, compensate_part, compensate_program,
    look_at_part, straight_tool,
};
use kinetostat_model::Model;
use kinetostat_program::{
    Gcode, GcodePart, MachineProgram, PartLength, Parts, PartsInOrder, Program, ReadOptions,
    Survey, WriteOptions, WrittenSoFar, interpret,
};
use nalgebra::{Vector3, vector};

fn orthoglide() -> Mechanism {
    let mut model = Model::preset("orthoglide").expect("preset");
    for leg in ["leg x", "leg y", "leg z"] {
        let turned = Pose::rotation(Vector3::x() * 1_f64.to_radians());
        model = model
            .with_deviation(leg, "line", &turned)
            .expect("deviation");
    }
    model.mechanism.with_tool(&straight_tool(0.1))
}

/// A wavy surface in zigzag, with a rapid between every two rows.
fn surface() -> String {
    let mut text = String::from("%\nO7\nG21 G90 G17\nG0 X-10 Y-5 Z5\n");
    for row in 0..12 {
        let y = -5.0 + 0.8 * f64::from(row);
        text.push_str(&format!("G0 Y{y:.3}\nG1 Z-1 F300\n"));
        for i in 0..=25 {
            let x = -10.0 + 0.8 * f64::from(if row % 2 == 0 { i } else { 25 - i });
            let z = -1.0 + 0.3 * (0.4 * x).sin() * (0.5 * y).cos();
            text.push_str(&format!("G1 X{x:.3} Z{z:.4} F800\n"));
        }
        text.push_str("G0 Z5\n");
    }
    text.push_str("M2\n%\n");
    text
}

fn with_task<R>(
    machine: &Mechanism,
    program: &dyn MachineProgram,
    work: impl FnOnce(&Task<'_>) -> R,
) -> R {
    let milling = CuttingLoad::Milling {
        radial: 215.0,
        tangential: -10.0,
        axial: -25.0,
    };
    work(&Task {
        mechanism: machine,
        program,
        corrected: Directions::POSITION,
        placement: Placement::at(vector![0.0, 0.0, 0.1]),
        load: ProgramLoad::new(milling),
        tools: &[],
        weight: WeightCorrection::All,
        cut: None,
        writing: WriteOptions::default(),
        run_inputs: RunInputs::default(),
        bounds: Bounds::default(),
        places: 0,
        compliances: false,
    })
}

fn whole(machine: &Mechanism, text: &str, compensate: bool) -> Run {
    let program = Program::read(text).expect("program");
    let reading = ReadOptions::default();
    let path = interpret(&program, &reading).expect("path");
    let gcode = Gcode {
        program: &program,
        path: &path,
        reading: &reading,
    };
    let run = with_task(machine, &gcode, |task| match compensate {
        true => compensate_program(task, &Unwatched),
        false => analyse(task, &Unwatched),
    });
    run.expect("run")
}

/// The merged result, the written bytes, and all points.
fn in_parts(
    machine: &Mechanism,
    text: &str,
    compensate: bool,
) -> (MergedRun, Vec<u8>, Vec<kinetostat_machining::PointResult>) {
    let reading = ReadOptions::default();
    let length = PartLength {
        own: 77,
        beside: 40,
    };
    let survey = Survey::of(text.as_bytes(), &reading, length).expect("survey");
    let parts = || Parts::of(&survey, &reading).in_order(std::io::Cursor::new(text));
    let order = || PartsInOrder::from(0, WrittenSoFar::nothing(&survey, &reading));
    let mut of_whole = OfWhole {
        moves: survey.moves,
        ..OfWhole::default()
    };
    let none_written = order();
    for part in parts() {
        let part = part.expect("part");
        let program = GcodePart {
            part: &part,
            place: &none_written.place(0),
        };
        let looked = with_task(machine, &program, |task| {
            look_at_part(of_whole, task, compensate, &Unwatched).expect("look")
        });
        of_whole.add(&looked);
    }
    let (mut merged, mut bytes, mut points) = (MergedRun::default(), Vec::new(), Vec::new());
    let order = order();
    for (index, part) in parts().enumerate() {
        let part = part.expect("part");
        let place = order.place(index);
        let program = GcodePart {
            part: &part,
            place: &place,
        };
        let run = with_task(machine, &program, |task| {
            let run = match compensate {
                true => compensate_part(task, Some(&of_whole), &Unwatched),
                false => analyse_part(task, Some(&of_whole), &Unwatched),
            };
            let run = run.expect("run");
            merged.add(task, &run);
            run
        });
        if let Some(written) = &run.written {
            bytes.extend_from_slice(&written.bytes);
        }
        place.taken();
        points.extend(run.points);
    }
    (merged, bytes, points)
}

fn close(a: f64, b: f64, relative: f64, what: &str) {
    assert!(
        (a - b).abs() <= relative * b.abs() + 1e-12,
        "{what}: {a} {b}"
    );
}

#[test]
fn figures_of_parts_together_are_those_of_the_whole() {
    let (machine, text) = (orthoglide(), surface());
    let all = whole(&machine, &text, false);
    let (merged, bytes, points) = in_parts(&machine, &text, false);
    assert!(bytes.is_empty());
    assert_eq!(points.len(), all.points.len());
    for (a, b) in points.iter().zip(&all.points) {
        assert_eq!((a.line, a.kind, a.share), (b.line, b.kind, b.share));
        close(a.path_mm, b.path_mm, 1e-12, "path");
        for axis in 0..3 {
            // Each part begins its solutions anew.
            let difference = (a.error_before_mm[axis] - b.error_before_mm[axis]).abs();
            assert!(difference < 1e-9, "line {}: {difference}", a.line);
        }
    }
    let found = merged.finish(Vec::new()).expect("result").summary;
    let wanted = &all.result.summary;
    assert_eq!(
        (found.points, found.blocks, found.bytes_in),
        (wanted.points, wanted.blocks, wanted.bytes_in)
    );
    close(found.feed_length_mm, wanted.feed_length_mm, 1e-12, "length");
    close(
        found.max_position_error_before_mm,
        wanted.max_position_error_before_mm,
        1e-6,
        "largest error",
    );
    close(
        found.rms_position_error_before_mm,
        wanted.rms_position_error_before_mm,
        1e-3,
        "mean error",
    );
}

#[test]
fn what_is_compensated_in_parts_is_one_program_within_the_tolerance() {
    let (machine, text) = (orthoglide(), surface());
    let all = whole(&machine, &text, true);
    let (merged, bytes, points) = in_parts(&machine, &text, true);
    let reading = ReadOptions::default();
    let program = Program::read(bytes.clone()).expect("one program");
    interpret(&program, &reading).expect("one path");
    let written = all.written.as_ref().expect("written");
    assert!(
        bytes == written.bytes,
        "other bytes than those of the whole"
    );
    assert!(!merged.leaves_as_it_is());
    // As it is kept between two parts.
    let kept = merged.clone();
    assert_eq!(kept, merged);
    let result = merged.finish(Vec::new()).expect("result");
    assert_eq!(result.tolerance.held, Some(true), "{:?}", result.tolerance);
    assert!(result.summary.max_position_error_after_mm < 1e-3);
    assert_eq!(result.summary.bytes_out, bytes.len());
    assert_eq!(result.summary.blocks_out, program.block_count());
    let last = points.last().expect("points");
    assert!(
        points
            .windows(2)
            .all(|pair| pair[0].output_line <= pair[1].output_line)
    );
    assert!(last.output_line < program.line_count());
    assert_eq!(result.summary.entry_steps, all.result.summary.entry_steps);
}
