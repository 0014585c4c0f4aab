//! Arcs that stay arcs: the demonstration's groove with fitted arcs and with straight pieces.

use kinetostat::{Directions, Mechanism, Pose};
use kinetostat_machining::{
    Bounds, CuttingLoad, Placement, ProgramLoad, Run, RunInputs, Task, Unwatched, WeightCorrection,
    compensate_program, straight_tool,
};
use kinetostat_model::Model;
use kinetostat_program::{
    Arcs, Gcode, MachineProgram, Program, ReadOptions, WriteOptions, interpret,
};
use nalgebra::{Vector3, vector};

/// As `kinetostat demo` writes it.
const GROOVE: &str = "(circular groove, radius 25 mm, depth 2 mm)\nG21 G90 G17 G94\nT1 M6 (end mill, 8 mm)\nS8000 M3\nG0 X25 Y0 Z10\n\
    G0 Z2\nG1 Z-2 F200 (plunge)\nG3 X-25 Y0 I-25 J0 F600\nG3 X25 Y0 I25 J0\nG0 Z10\nM5\nM30\n";

/// With legs that were assembled one degree askew.
fn orthoglide() -> Mechanism {
    let mut model = Model::preset("orthoglide").expect("preset");
    for leg in ["leg x", "leg y", "leg z"] {
        let askew = Pose::rotation(Vector3::x() * 1_f64.to_radians());
        model = model
            .with_deviation(leg, "line", &askew)
            .expect("deviation");
    }
    model.mechanism.with_tool(&straight_tool(0.1))
}

/// With a tolerance of the path, and 0.8 of it for chords.
fn run(machine: &Mechanism, arcs: Arcs, tolerance_mm: f64) -> Run {
    let program = Program::read(GROOVE).expect("program");
    let reading = ReadOptions::default();
    let path = interpret(&program, &reading).expect("path");
    let gcode = Gcode {
        program: &program,
        path: &path,
        reading: &reading,
    };
    let mut writing = WriteOptions::default();
    writing.arcs = arcs;
    writing.tolerance_mm = tolerance_mm;
    writing.chord_tolerance_mm = 0.8 * tolerance_mm;
    let task = Task {
        mechanism: machine,
        program: &gcode,
        corrected: Directions::POSITION,
        placement: Placement::at(vector![0.02, 0.02, 0.12]),
        load: ProgramLoad::new(CuttingLoad::Milling {
            radial: 215.0,
            tangential: -10.0,
            axial: -25.0,
        }),
        tools: &[],
        weight: WeightCorrection::All,
        cut: None,
        writing: writing.clone(),
        run_inputs: RunInputs::default(),
        bounds: Bounds::default(),
        places: 0,
        compliances: false,
    };
    let run = compensate_program(&task, &Unwatched).expect("run");
    let written = run.written.as_ref().expect("written");
    gcode.verify(written, &writing).expect("verified");
    run
}

/// The height of an arc grows evenly, and the correction of the height on this circle is a wave of 0.16 mm: an arc over the
/// angle `a` leaves it by `0.16 a^2 / 8`. So eight arcs a turn are 12 um off, and 0.9 um need more than twenty.
#[test]
fn the_groove_of_the_demonstration_has_few_arcs_and_the_residual_of_straight_pieces() {
    let machine = orthoglide();
    for (tolerance_mm, times) in [
        (0.0005, 4.0),
        (0.001, 4.0),
        (0.005, 2.5),
        (0.01, 2.0),
        (0.02, 2.0),
    ] {
        let both = [Arcs::Fit, Arcs::Lines].map(|arcs| {
            let run = run(&machine, arcs, tolerance_mm);
            let summary = &run.result.summary;
            assert!(summary.max_speed_deviation_percent <= 0.1);
            let residual = [
                summary.max_position_error_before_mm,
                summary.max_position_error_after_mm,
            ];
            (run.written.expect("written").accounting, residual)
        });
        let [
            (arcs, [before, after]),
            (lines, [before_lines, after_lines]),
        ] = &both;
        println!(
            "tolerance {:.1} um: {} blocks become {} with arcs (residual {:.2} um of {:.1} um, {} places solved), {} with \
             straight pieces ({:.2} um, {} places)",
            1e3 * tolerance_mm,
            arcs.blocks_in,
            arcs.blocks_out,
            1e3 * after,
            1e3 * before,
            arcs.evaluations,
            lines.blocks_out,
            1e3 * after_lines,
            lines.evaluations,
        );
        assert!((before - before_lines).abs() < 1e-5);
        assert!(arcs.blocks_out as f64 <= times * arcs.blocks_in as f64);
        assert!(2 * arcs.blocks_out < lines.blocks_out);
        // Path and chords together, with the rounding, hold for both.
        let allowed = 1.8 * tolerance_mm + 2e-4;
        assert!(
            *after < allowed && *after_lines < allowed,
            "{after} {after_lines}"
        );
        assert!(arcs.evaluations < lines.evaluations);
    }
}
