//! An independent sampler over programs compensated for a model: the written bytes are read, and the core
//! is asked where the tool goes in random places that neither the division nor the check chose.

// Helpers of tests, which clippy does not count as tests.
use kinetostat::{Directions, Mechanism, Pose, Wrench};
use kinetostat_machining::number::largest_length;
use kinetostat_machining::{
    Bounds, CornerLoad, CuttingLoad, LoadAlongPath, LoadAxes, Placement, ProgramLoad, Run,
    RunInputs, Task, Unwatched, WarningCode, WeightCorrection, compensate_program, straight_tool,
};
use kinetostat_model::Model;
use kinetostat_program::{Gcode, Piece, Program, ReadOptions, WriteOptions, interpret, irregular};
use kinetostat_testing::{Worst, largest};
use nalgebra::{UnitQuaternion, Vector3, vector};
use rayon::prelude::*;

/// 12, or as many as `KINETOSTAT_CASES` says.
fn cases() -> u64 {
    let setting = std::env::var("KINETOSTAT_CASES").ok();
    setting.and_then(|cases| cases.parse().ok()).unwrap_or(12)
}

/// The `k`th random number of a case.
struct Random(u64, u64);

impl Random {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.1 += 1;
        low + (high - low) * irregular(0x5eed, self.0, self.1)
    }
}

/// Long and short lines, gentle and sharp corners, arcs.
fn program(random: &mut Random) -> String {
    let mut text = "G21 G90 G17\nG0 X0 Y0 Z3\nG1 Z-1 F400\n".to_owned();
    let (mut x, mut y, mut heading) = (0.0_f64, 0.0_f64, random.between(0.0, 6.0));
    for _ in 0..3 + random.between(0.0, 5.0) as usize {
        let length = 10_f64.powf(random.between(-1.0, 1.9));
        heading += if random.between(0.0, 1.0) < 0.5 {
            random.between(-0.5, 0.5)
        } else {
            random.between(-3.0, 3.0)
        };
        if random.between(0.0, 1.0) < 0.2 {
            let radius = random.between(1.0, 15.0);
            text.push_str(&format!("G3 X{x:.4} Y{y:.4} I{radius:.4} J0\n"));
            continue;
        }
        x = (x + length * heading.cos()).clamp(-45.0, 45.0);
        y = (y + length * heading.sin()).clamp(-45.0, 45.0);
        let z = random.between(-2.0, -0.5);
        text.push_str(&format!("G1 X{x:.4} Y{y:.4} Z{z:.4}\n"));
    }
    text.push_str("G0 Z3\nM2\n");
    text
}

fn run(
    mechanism: &Mechanism,
    text: &str,
    placement: Placement,
    load: ProgramLoad,
) -> (Run, kinetostat_program::Path) {
    let program = Program::read(text).expect("program");
    let reading = ReadOptions::default();
    let path = interpret(&program, &reading).expect("path");
    let task = Task {
        mechanism,
        program: &Gcode {
            program: &program,
            path: &path,
            reading: &reading,
        },
        corrected: Directions::POSITION,
        placement,
        load,
        tools: &[],
        weight: WeightCorrection::All,
        cut: None,
        writing: WriteOptions::default(),
        run_inputs: RunInputs::default(),
        bounds: Bounds::default(),
        places: 0,
        compliances: false,
    };
    let run = compensate_program(&task, &Unwatched).unwrap_or_else(|e| panic!("{e}\n{text}"));
    (run, path)
}

/// Largest distance of the tool from its place, in random places of what was written, and their number.
fn sampled(
    mechanism: &Mechanism,
    run: &Run,
    path: &kinetostat_program::Path,
    placement: Placement,
    load: ProgramLoad,
    random: &mut Random,
) -> (f64, usize) {
    let written = run.written.as_ref().expect("written");
    let output = Program::read(written.bytes.clone()).expect("written program");
    let output = interpret(&output, &ReadOptions::default()).expect("written path");
    let load = LoadAlongPath::new(load, path);
    let (mut worst, mut places) = (Worst::new(), 0);
    assert_eq!(output.moves.len(), written.pieces.len());
    let stride = (written.pieces.len() / 60).max(1);
    for (piece, motion) in written.pieces.iter().zip(&output.moves).step_by(stride) {
        let original = &path.moves[piece.move_index];
        if !piece.corrected
            || piece.corner_step
            || original.feed.is_none()
            || original.kind != motion.kind
        {
            continue;
        }
        if original.kind == kinetostat_program::MoveKind::Rapid {
            continue;
        }
        // A fitted arc stands for many straight pieces.
        let count = if piece.arc.is_some() { 20 } else { 2 };
        for _ in 0..count {
            let part = random.between(0.0, 1.0);
            let share = piece.share_from + part * (piece.share_to - piece.share_from);
            let turned = piece.arc.map_or(part, |arc| arc.turned(part));
            let commanded = placement.tool_pose(&motion.point(turned));
            let wanted = placement.tool_pose(&original.point(share));
            let wrench = load.wrench(&placement, piece.move_index, share);
            let tool = mechanism
                .posture(&commanded)
                .expect("posture")
                .deflected_by(&wrench)
                .expect("equilibrium")
                .tool;
            let off = 1e3 * (tool.translation.vector - wanted.translation.vector).norm();
            assert!(off.is_finite());
            worst.add(off);
            places += 1;
        }
    }
    (if places > 0 { worst.of(places) } else { 0.0 }, places)
}

/// What a case came to.
struct Looked {
    /// Largest distance of the tool from its place, mm.
    off: f64,
    /// How much that is more than what the run itself found, mm.
    beyond_claim: f64,
    places: usize,
    divided_again: bool,
    /// The run says that it holds its tolerance.
    claimed: bool,
}

/// A random program under a random load.
fn look(case: u64, (mechanism, placement): &(Mechanism, Placement)) -> Looked {
    let mut random = Random(case, 0);
    let text = program(&mut random);
    let mut force = || random.between(-250.0, 250.0);
    let cutting = match case % 3 {
        0 => CuttingLoad::Milling {
            radial: force(),
            tangential: force(),
            axial: force(),
        },
        1 => CuttingLoad::Constant {
            axes: LoadAxes::Base,
            wrench: Wrench::new(vector![force(), force(), force()], Vector3::zeros()),
        },
        _ => CuttingLoad::Constant {
            axes: LoadAxes::Feed,
            wrench: Wrench::new(vector![force(), force(), force()], Vector3::z()),
        },
    };
    // At once, as the places that are looked at by themselves take it.
    let load = ProgramLoad {
        largest_step: f64::INFINITY,
        ..ProgramLoad::new(cutting)
    };
    let (run, path) = run(mechanism, &text, *placement, load);
    let (off, places) = sampled(mechanism, &run, &path, *placement, load, &mut random);
    let result = &run.result;
    let again = |w: &kinetostat_machining::Warning| w.code == WarningCode::DividedAgain;
    Looked {
        off,
        beyond_claim: off - result.summary.max_position_error_after_mm,
        places,
        divided_again: result.warnings.iter().any(again),
        claimed: result.holds_tolerance() == Some(true),
    }
}

#[test]
fn written_programs_are_within_their_bound_in_random_places() {
    let orthoglide = Model::preset("orthoglide").expect("preset").mechanism;
    let arm = Model::preset("heavy_6r").expect("preset").mechanism;
    let home = arm.platforms()[arm.tool()].home;
    let machines = [
        (
            orthoglide.with_tool(&straight_tool(0.1)),
            Placement::at(vector![0.0, 0.0, 0.1]),
        ),
        (
            arm,
            Placement {
                base_from_part: Pose::from_parts(home.translation, UnitQuaternion::identity()),
                tool_orientation: home.rotation,
                scale: 1.0,
                orientation_follows: false,
            },
        ),
    ];
    let writing = WriteOptions::default();
    // Path with the tenth that may be unknown, chords, rounding.
    let allowed = 1.1 * writing.tolerance_mm + 1.2 * writing.chord_tolerance_mm + 0.9e-4;
    // One after the other they would wait for each other: a short program does not keep all cores busy.
    let looked: Vec<Looked> = (0..cases())
        .into_par_iter()
        .map(|case| {
            let machine = &machines[(case % 2) as usize];
            let looked = look(case, machine);
            assert!(
                looked.off <= allowed,
                "case {case}: {} mm, {allowed} allowed",
                looked.off
            );
            looked
        })
        .collect();
    let most = |of: fn(&Looked) -> f64| largest(looked.iter().map(of));
    let (worst, beyond_claim) = (most(|l| l.off), most(|l| l.beyond_claim));
    let places: usize = looked.iter().map(|l| l.places).sum();
    let again = looked.iter().filter(|l| l.divided_again).count();
    let missed = looked.iter().filter(|l| !l.claimed).count();
    let cases = looked.len();
    println!(
        "{cases} programs, {places} places, worst {worst:.6} mm of {allowed:.6} allowed, beyond what the run itself \
         found by {beyond_claim:.6} mm at most; {again} divided again, {missed} miss their tolerance by their own account"
    );
    assert!(
        places > 30 * cases && worst > 0.3 * allowed,
        "{places} {worst}"
    );
}

const SQUARE: &str = "G21 G90\nG0 X0 Y0 Z5\nG1 Z-2 F300\nG1 X30\nG1 Y20\nG1 X0\nG1 Y0\nG0 Z5\n";

fn milling() -> ProgramLoad {
    ProgramLoad::new(CuttingLoad::Milling {
        radial: 215.0,
        tangential: -10.0,
        axial: -25.0,
    })
}

/// A straight cut with a move of 0.2 micrometres across it: no swing of the tool.
#[test]
fn the_noise_of_a_cam_system_makes_no_corner() {
    const NOISY: &str =
        "G21 G90 G17\nG0 X0 Y0 Z20\nG1 Z-2 F500\nG1 X15 F1200\nG1 Y0.0002\nG1 X30\nG0 Z20\n";
    let machine = Model::preset("orthoglide").expect("preset").mechanism;
    let machine = machine.with_tool(&straight_tool(0.1));
    let place = Placement::at(vector![0.0, 0.0, 0.1]);
    let (found, _) = run(&machine, NOISY, place, milling());
    let pieces = &found.written.as_ref().expect("written").pieces;
    // Where the tool already cuts along x.
    let cut = |p: &&Piece| (2..=4).contains(&p.move_index) && p.commanded_from.x > 1.0;
    let across = pieces
        .iter()
        .filter(cut)
        .map(|p| (p.commanded_to.y - p.commanded_from.y).abs())
        .max_by(f64::total_cmp)
        .expect("pieces");
    assert!(pieces.iter().filter(cut).count() >= 2);
    assert!(across < 0.01, "{across} mm across the cut");
}

/// The two readings of the load at corners: the same bytes, the claims exchanged.
#[test]
fn the_claim_at_corners_is_reported_by_both_readings() {
    let machine = Model::preset("orthoglide").expect("preset").mechanism;
    let machine = machine.with_tool(&straight_tool(0.1));
    let place = Placement::at(vector![0.0, 0.0, 0.1]);
    let (turns, path) = run(&machine, SQUARE, place, milling());
    let mut other = milling();
    other.at_corners = CornerLoad::FollowsFeed;
    let (follows, _) = run(&machine, SQUARE, place, other);
    let bytes = |run: &Run| run.written.as_ref().expect("written").bytes.clone();
    assert_eq!(bytes(&turns), bytes(&follows));
    let (a, b) = (&turns.result.summary, &follows.result.summary);
    let (reported, measured) = (
        a.max_corner_error_if_load_follows_feed_mm.expect("steps"),
        b.max_corner_error_if_load_follows_feed_mm.expect("steps"),
    );
    // The batch and the search from neighbour to neighbour agree to 1e-8 mm.
    assert!((reported - measured).abs() < 1e-7, "{reported} {measured}");
    assert!((b.max_position_error_after_mm - measured).abs() < 1e-12);
    let both = (
        a.max_corner_error_if_load_turns_mm.expect("steps"),
        b.max_corner_error_if_load_turns_mm.expect("steps"),
    );
    assert!((both.0 - both.1).abs() < 1e-7 && both.0 < 1e-3, "{both:?}");
    // By hand: on one step, the force of a cut along the step, solved by the core.
    let written = turns.written.as_ref().expect("written");
    let step = written
        .pieces
        .iter()
        .find(|p| p.corner_step && p.move_index == 3)
        .expect("a step");
    let along = (step.commanded_to - step.commanded_from).normalize();
    let (right, ahead) = (
        vector![along.y, -along.x, 0.0],
        vector![along.x, along.y, 0.0],
    );
    let flat = along.xy().norm();
    let force = (right * 215.0 - ahead * 10.0) / flat + vector![0.0, 0.0, -25.0];
    let tool = machine
        .posture(&place.tool_pose(&step.commanded_to))
        .expect("posture")
        .deflected_by(&Wrench::new(force, Vector3::zeros()))
        .expect("equilibrium")
        .tool;
    let wanted = place.tool_pose(&path.moves[3].point(step.share_to));
    let by_hand = 1e3 * (tool.translation.vector - wanted.translation.vector).norm();
    assert!(
        by_hand > 0.05 && by_hand <= reported + 1e-6,
        "{by_hand} {reported}"
    );
    assert!(a.corner_steps > 3 && a.corner_points_percent > 0.0);
    let words = turns.result.corners_text().expect("steps");
    assert!(
        words.contains(&format!("{} off there", largest_length(reported)))
            && words.contains(&a.corner_steps.to_string()),
        "{words}"
    );
    assert!(a.largest_backward_step_mm > 0.05 && a.backward_steps > 0);
    assert!(
        turns
            .result
            .warnings
            .iter()
            .any(|w| w.message.contains("cuts backwards"))
    );
}

/// Without any load nothing changes, arcs and header included.
#[test]
fn a_program_on_which_no_load_acts_comes_back_byte_for_byte() {
    let machine = Model::preset("orthoglide").expect("preset").mechanism;
    let text = "%\nG21 G90 G17\nG0 X25 Y0 Z5\nG1 Z-2 F300\nG3 X25 Y0 I-25 J0 F600 (round)\nG2 X20 I-2.5\nG0 Z5\nM2\n%\n";
    let place = Placement::at(vector![0.0, 0.0, 0.1]);
    let (whole, _) = run(&machine, text, place, ProgramLoad::new(CuttingLoad::None));
    assert_eq!(whole.written.expect("written").bytes, text.as_bytes());
    assert!(whole.result.summary.unchanged && whole.result.unchanged_text().is_some());
    assert_eq!(
        whole.result.summary.blocks_unchanged,
        whole.result.summary.blocks
    );
    // A load that acts below a height that is never reached is no load.
    let mut high = milling();
    high.below_z_mm = Some(-10.0);
    let (never, _) = run(&machine, text, place, high);
    assert_eq!(never.written.expect("written").bytes, text.as_bytes());
    // Half of the program is cut: the arcs of the other half stay arcs.
    let mut half = milling();
    half.below_z_mm = Some(-1.0);
    let text = "G21 G90 G17\nG0 X25 Y0 Z0\nG3 X25 Y0 I-25 J0 F600\nG1 Z-2 F300\nG3 X25 Y0 I-25 J0\nG1 Z0\nG3 X25 Y0 I-25 J0 F600\nM2\n";
    let (mixed, _) = run(&machine, text, place, half);
    let written = mixed.written.expect("written");
    let output = String::from_utf8(written.bytes).expect("text");
    assert_eq!(
        output.matches("G3 X25 Y0 I-25 J0 F600\n").count(),
        2,
        "{output}"
    );
    // The arc in the cut has become several (hundreds of straight pieces before arcs were fitted).
    let lines = output.lines().count();
    assert!(
        !mixed.result.summary.unchanged && (11..100).contains(&lines),
        "{output}"
    );
}
