//! Programs with several tools: each block has the length and the load of its own tool.

use kinetostat::{Directions, Mechanism};
use kinetostat_machining::{
    Bounds, CornerLoad, CuttingLoad, Placement, ProgramLoad, Run, RunError, RunInputs, Task, Tool,
    Unwatched, WeightCorrection, analyse, compensate_program, straight_tool,
};
use kinetostat_model::Model;
use kinetostat_program::{Gcode, Program, ReadOptions, WriteOptions, interpret};
use kinetostat_testing::Worst;
use nalgebra::vector;

/// Tool 1 cuts on lines 4 to 6, tool 2 on 10 to 12, tool 1 once more on 16.
const TWO_TOOLS: &str = "G21 G90\nT1 M6\nG0 X0 Y0 Z5\nG1 Z-2 F300\nG1 X40\nG3 X40 Y20 I0 J10\nG0 Z5\nT2 M6\nG0 X5 Y5\nG1 Z-3 F300\nG1 X-30\nG1 Y30\nG0 Z5\nT1 M6\nG0 X0 Y0\nG1 X20 F300\nG0 Z5\nM2\n";

fn machine(length: f64) -> Mechanism {
    let model = Model::preset("heavy_6r").expect("preset");
    model.mechanism.with_tool(&straight_tool(length))
}

fn milling(radial: f64) -> ProgramLoad {
    let load = ProgramLoad::new(CuttingLoad::Milling {
        radial,
        tangential: -30.0,
        axial: -25.0,
    });
    // It comes at once on every machine: how soon it may come differs from one to the other.
    ProgramLoad {
        largest_step: f64::INFINITY,
        ..load
    }
}

/// The same for all tools: near the home of the middle one.
fn placement() -> Placement {
    let machine = machine(0.2);
    let home = &machine.platforms()[machine.tool()].home;
    let mut placement = Placement::at(home.translation.vector + vector![0.0, 0.0, -0.05]);
    placement.tool_orientation = home.rotation;
    placement
}

fn run(
    mechanism: &Mechanism,
    load: ProgramLoad,
    tools: &[Tool<'_>],
    write: bool,
) -> Result<Run, RunError> {
    let program = Program::read(TWO_TOOLS).expect("program");
    let reading = {
        let mut reading = ReadOptions::default();
        reading.tools = (!tools.is_empty()).then(|| tools.iter().map(|tool| tool.number).collect());
        reading
    };
    let path = interpret(&program, &reading).expect("path");
    let task = Task {
        mechanism,
        program: &Gcode {
            program: &program,
            path: &path,
            reading: &reading,
        },
        corrected: Directions::POSITION,
        placement: placement(),
        load,
        tools,
        weight: WeightCorrection::All,
        cut: None,
        writing: WriteOptions::default(),
        run_inputs: RunInputs::default(),
        bounds: Bounds::default(),
        places: 0,
        compliances: false,
    };
    if write {
        compensate_program(&task, &Unwatched)
    } else {
        analyse(&task, &Unwatched)
    }
}

/// Whether tool 2 makes the block on a line.
fn second(line: usize) -> bool {
    (8..14).contains(&line)
}

#[test]
fn each_block_has_the_length_and_the_load_of_its_own_tool() {
    let (short, long) = (machine(0.1), machine(0.35));
    let (light, heavy) = (milling(200.0), milling(900.0));
    let tools = [
        Tool {
            number: 2,
            mechanism: &long,
            load: heavy,
        },
        Tool {
            number: 1,
            mechanism: &short,
            load: light,
        },
    ];
    // What [tool] and [load] say does not matter: every block is made with a tool of the table.
    let other = machine(1.0);
    let several = run(&other, milling(5000.0), &tools, false).expect("several tools");
    let of_first = run(&short, light, &[], false).expect("tool 1");
    let of_second = run(&long, heavy, &[], false).expect("tool 2");
    let (mut compared, mut apart) = (0, Worst::new());
    assert_eq!(several.points.len(), of_first.points.len());
    for ((point, first), second_run) in several
        .points
        .iter()
        .zip(&of_first.points)
        .zip(&of_second.points)
    {
        let (own, wrong) = if second(point.line) {
            (second_run, first)
        } else {
            (first, second_run)
        };
        assert_eq!((point.line, point.share), (own.line, own.share));
        for axis in 0..3 {
            let difference = (point.error_before_mm[axis] - own.error_before_mm[axis]).abs();
            assert!(difference < 1e-6, "line {}: {difference} mm", point.line);
            let difference = (point.error_before_mm[axis] - wrong.error_before_mm[axis]).abs();
            assert!(difference.is_finite());
            assert!(difference.is_finite());
            apart.add(difference);
            let difference = (point.force_n[axis] - own.force_n[axis]).abs();
            assert!(difference < 1e-9, "line {}: {difference} N", point.line);
            compared += 1;
        }
    }
    let apart = apart.of(compared);
    assert!(
        compared > 30 && apart > 0.1,
        "{compared} numbers, {apart} mm apart"
    );
}

#[test]
fn the_written_program_is_right_for_both_tools() {
    let (short, long) = (machine(0.1), machine(0.35));
    let (light, heavy) = (milling(200.0), milling(900.0));
    let tools = [
        Tool {
            number: 1,
            mechanism: &short,
            load: light,
        },
        Tool {
            number: 2,
            mechanism: &long,
            load: heavy,
        },
    ];
    let run = run(&short, light, &tools, true).expect("run");
    let summary = &run.result.summary;
    assert!(summary.max_position_error_before_mm > 0.1, "{summary:?}");
    assert!(summary.max_position_error_after_mm < 2e-3, "{summary:?}");
    assert!(
        run.result
            .run_inputs
            .load
            .contains("tool 2: milling: 900 N"),
        "{}",
        run.result.run_inputs.load
    );
    // An independent look: command the ends of the written program, ask each tool's own machine.
    let written = run.written.expect("written");
    let input = interpret(
        &Program::read(TWO_TOOLS).expect("program"),
        &ReadOptions::default(),
    )
    .expect("path");
    let place = placement();
    let mut looked_at = 0;
    for piece in written
        .pieces
        .iter()
        .filter(|piece| piece.share_to == 1.0 && !piece.corner_step)
    {
        let motion = &input.moves[piece.move_index];
        // Straight cuts along x and y: the force is known without the code's own rule.
        let along = (motion.end - motion.start).xy();
        if motion.kind == kinetostat_program::MoveKind::Rapid
            || motion.curve != kinetostat_program::Curve::Line
            || along.norm() < 1.0
        {
            continue;
        }
        let along = along.normalize();
        let (machine, radial) = if second(motion.line) {
            (&long, 900.0)
        } else {
            (&short, 200.0)
        };
        let force = vector![
            radial * along.y - 30.0 * along.x,
            -radial * along.x - 30.0 * along.y,
            -25.0
        ];
        let load = kinetostat::Wrench::new(force, vector![0.0, 0.0, 0.0]);
        let tool = machine
            .posture(&place.tool_pose(&piece.commanded_to))
            .expect("posture")
            .deflected_by(&load)
            .expect("equilibrium")
            .tool;
        let error = tool.translation.vector - place.tool_pose(&motion.end).translation.vector;
        assert!(
            error.norm() < 3e-6,
            "line {}: {} m",
            motion.line,
            error.norm()
        );
        looked_at += 1;
    }
    assert_eq!(looked_at, 4);
}

/// What the load is on a corner step belongs to the tool that steps there.
#[test]
fn each_tool_has_its_own_reading_of_the_load_at_corners() {
    let (short, long) = (machine(0.1), machine(0.35));
    let written = |first: CornerLoad, second: CornerLoad| {
        let load = |radial: f64, at_corners: CornerLoad| ProgramLoad {
            at_corners,
            ..milling(radial)
        };
        let tools = [
            Tool {
                number: 1,
                mechanism: &short,
                load: load(200.0, first),
            },
            Tool {
                number: 2,
                mechanism: &long,
                load: load(900.0, second),
            },
        ];
        run(&short, milling(50.0), &tools, true).expect("run")
    };
    let turns = written(CornerLoad::Turns, CornerLoad::Turns);
    let follows = written(CornerLoad::FollowsFeed, CornerLoad::FollowsFeed);
    let mixed = written(CornerLoad::Turns, CornerLoad::FollowsFeed);
    let bytes = |run: &Run| run.written.as_ref().expect("written").bytes.clone();
    assert_eq!(bytes(&turns), bytes(&mixed));
    assert_eq!(bytes(&follows), bytes(&mixed));

    let (mut steps, mut apart) = ([0, 0], <[Worst; 2]>::default());
    let both = turns.points.iter().zip(&follows.points);
    for (point, (turning, following)) in mixed.points.iter().zip(both) {
        if !point.kind.is_step() {
            continue;
        }
        let tool = usize::from(second(point.line));
        let (own, wrong) = match tool {
            0 => (turning, following),
            _ => (following, turning),
        };
        for axis in 0..3 {
            let difference = (point.force_n[axis] - own.force_n[axis]).abs();
            assert!(difference < 1e-9, "line {}: {difference} N", point.line);
            let difference = (point.error_after_mm[axis] - own.error_after_mm[axis]).abs();
            assert!(difference < 1e-7, "line {}: {difference} mm", point.line);
            let difference = (point.force_n[axis] - wrong.force_n[axis]).abs();
            assert!(difference.is_finite(), "line {}", point.line);
            apart[tool].add(difference);
        }
        steps[tool] += 1;
    }
    assert!(steps.iter().all(|count| *count >= 2), "{steps:?}");
    let apart = [0, 1].map(|tool| apart[tool].of(3 * steps[tool]));
    assert!(apart.iter().all(|newton| *newton > 10.0), "{apart:?}");

    // By one reading for all tools, the claim is the same whichever was chosen for each.
    let summary = |run: &Run| {
        let s = &run.result.summary;
        let turns = s.max_corner_error_if_load_turns_mm.expect("steps");
        let follows = s.max_corner_error_if_load_follows_feed_mm.expect("steps");
        (turns, follows)
    };
    for other in [summary(&turns), summary(&follows)] {
        let mixed = summary(&mixed);
        assert!((mixed.0 - other.0).abs() < 1e-7, "{mixed:?} {other:?}");
        assert!((mixed.1 - other.1).abs() < 1e-7, "{mixed:?} {other:?}");
    }
    let words = mixed.result.corners_text().expect("steps");
    assert!(
        words.contains(
            "turns or comes evenly while the tool steps (tool 1), or follows the feed on the steps (tool 2)"
        ),
        "{words}"
    );
}
