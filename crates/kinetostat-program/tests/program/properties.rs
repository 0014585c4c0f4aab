//! The promises of a written program, over generated programs and random fields.

// Helpers of tests, which clippy does not count as tests.
use crate::support::generator::generate;
use crate::support::operations::{Op, Style, op, style};
use crate::support::plain_reader::read_plainly;
use crate::support::truth::Generated;
use crate::support::{MACHINE_ZERO, REFERENCES, START, WORK};
use kinetostat_program::*;
use nalgebra::Vector3;
use proptest::prelude::*;

fn reading(machine_is_known: bool) -> ReadOptions {
    let mut work_offsets_mm = [None; 9];
    for (offset, given) in work_offsets_mm.iter_mut().zip(WORK) {
        *offset = Some(Vector3::from(given));
    }
    {
        let mut reading = ReadOptions::default();
        reading.work_offsets_mm = work_offsets_mm;
        reading.start_position_mm = Some(Vector3::from(START));
        if machine_is_known {
            reading.machine_zero_mm = Some(Vector3::from(MACHINE_ZERO));
            reading.reference_points_mm = REFERENCES.map(|point| Some(Vector3::from(point)));
        }
        reading
    }
}

/// A random field: waves, and steps where it is to jump.
#[derive(Debug, Clone)]
struct Waves {
    size_mm: f64,
    wave_mm: f64,
    phase: f64,
    /// Turns with the direction of motion and with the kind of block, so it jumps at corners.
    turns: bool,
    /// Jumps inside a block where the tool passes this height.
    below_mm: Option<f64>,
}

impl Waves {
    fn at(&self, request: &Request) -> Vector3<f64> {
        let p = request.position_mm / self.wave_mm;
        let wave = Vector3::new(
            (p.x + self.phase).sin(),
            (p.y - p.z).cos(),
            (p.z + p.x * 0.5).sin(),
        );
        let mut value = wave * (0.5 * self.size_mm);
        if self.turns {
            value += request.tangent.unwrap_or_default() * (0.25 * self.size_mm);
        }
        if self
            .below_mm
            .is_some_and(|height| request.position_mm.z < height)
        {
            value.z += 0.25 * self.size_mm;
        }
        value
    }

    fn is_continuous(&self) -> bool {
        !self.turns && self.below_mm.is_none()
    }
}

impl CorrectionField for Waves {
    fn corrections(&self, requests: &[Request]) -> Vec<Result<Correction, FieldFailure>> {
        requests
            .iter()
            .map(|request| Ok(Correction::from(self.at(request))))
            .collect()
    }
}

fn waves() -> impl Strategy<Value = Waves> {
    (
        0.001..0.5_f64,
        40.0..400.0_f64,
        0.0..6.0_f64,
        any::<bool>(),
        prop::option::of(-50.0..50.0_f64),
    )
        .prop_map(|(size_mm, wave_mm, phase, turns, below_mm)| Waves {
            size_mm,
            wave_mm,
            phase,
            turns,
            below_mm,
        })
}

/// The path read is the path the generator meant.
fn check_interpretation(generated: &Generated, path: &Path) {
    assert_eq!(path.moves.len(), generated.truths.len());
    assert_eq!(path.moves.len(), generated.facts.len());
    for ((motion, truth), fact) in path
        .moves
        .iter()
        .zip(&generated.truths)
        .zip(&generated.facts)
    {
        let [before, after] = fact.known.map(|known| known == [true; 3]);
        let known = match (fact.machine, before, after) {
            (false, true, _) => Knowledge::Whole,
            (false, false, true) => Knowledge::End,
            _ => Knowledge::Nothing,
        };
        assert_eq!(motion.known, known, "line {}", motion.line);
        assert_eq!(motion.words.is_to_machine(), fact.machine);
        if known != Knowledge::Whole {
            for axis in (0..3).filter(|axis| fact.known[1][*axis]) {
                let off = (motion.end - truth.point(1.0))[axis].abs();
                assert!(off <= 1e-6, "line {}: {off} mm", motion.line);
            }
            continue;
        }
        // An arc by radius is rounded in R, which moves its middle by a little more than the rounding.
        let tolerance = if motion.curve == Curve::Line {
            1e-6
        } else {
            4e-3
        };
        for share in [0.0, 0.3, 0.5, 0.9, 1.0] {
            let distance = (motion.point(share) - truth.point(share)).norm();
            assert!(
                distance <= tolerance,
                "line {}: {distance} mm at {share}",
                motion.line
            );
        }
        for share in [0.2, 0.7] {
            if let Some(tangent) = motion.tangent(share).filter(|_| motion.length_mm() > 1e-3) {
                let step = motion.point(share + 1e-5) - motion.point(share - 1e-5);
                assert!(
                    (tangent - step.normalize()).norm() < 1e-3,
                    "line {}",
                    motion.line
                );
            }
        }
    }
}

/// Pieces are where path and field want them, to the rounding, or within the tolerances between two arcs, and straight between.
fn check_places(path: &Path, written: &Corrected, waves: &Waves, writing: &WriteOptions) {
    let reached = read_plainly(std::str::from_utf8(&written.bytes).unwrap());
    for (piece, reached) in written.pieces.iter().zip(&reached) {
        let motion = &path.moves[piece.move_index];
        let unit = motion.words.mm_per_unit;
        let decimals = i32::from(writing.decimals.unwrap_or(4)) + i32::from(unit > 1.0);
        let half = 0.5 * unit * 10_f64.powi(-decimals);
        let rounding = half * 3.0_f64.sqrt() * 1.001 + 1e-9;
        let correction = |share: f64| {
            let whole = motion.known == Knowledge::Whole;
            waves.at(&Request {
                move_index: piece.move_index,
                share,
                position_mm: motion.point(share),
                tangent: motion.tangent(share).filter(|_| whole),
                orientation: None,
                turning: None,
            })
        };
        if motion.known == Knowledge::Nothing {
            assert!(!piece.corrected, "line {}", motion.line);
            continue;
        }
        if !piece.corrected {
            assert_eq!(
                motion.length_mm(),
                0.0,
                "line {} is not corrected",
                motion.line
            );
            continue;
        }
        let target = motion.point(piece.share_to) + correction(piece.share_to);
        let distance = (piece.commanded_to - target).norm();
        // Between two arcs of a move the end may leave the curve as the arcs do.
        let at_end = match piece.arc.is_some() && piece.share_to < 1.0 {
            true => rounding + writing.tolerance_mm + writing.chord_tolerance_mm,
            false => rounding,
        };
        if waves.below_mm.is_none() || distance < at_end {
            assert!(
                distance <= at_end,
                "line {}: {distance} mm off at {}",
                motion.line,
                piece.share_to
            );
        } else {
            // At the place of a jump the piece ends on one of its two sides.
            assert!(
                distance <= 0.26 * waves.size_mm + 0.01,
                "line {}: {distance}",
                motion.line
            );
        }
        if waves.is_continuous() && motion.kind == MoveKind::Feed && !piece.corner_step {
            let chord = if motion.curve == Curve::Line {
                0.0
            } else {
                2.0 * writing.chord_tolerance_mm
            };
            for part in [0.13, 0.37, 0.5, 0.61, 0.94] {
                let share = piece.share_from + (piece.share_to - piece.share_from) * part;
                let wanted = motion.point(share) + correction(share);
                let ends = [piece.commanded_from, piece.commanded_to];
                let commanded = match reached.arc {
                    Some(arc) => arc.beside(ends, part, &wanted),
                    None => ends[0].lerp(&ends[1], part),
                };
                let distance = (commanded - wanted).norm();
                let allowed = 1.3 * writing.tolerance_mm + chord + 2.0 * rounding;
                // The first piece starts where the block before ended, within the tolerance.
                let allowed = allowed
                    + if piece.share_from == 0.0 {
                        writing.tolerance_mm
                    } else {
                        0.0
                    };
                assert!(
                    distance <= allowed,
                    "line {}: {distance} > {allowed} mm",
                    motion.line
                );
            }
        }
    }
}

/// The bytes mean the pieces, to a reader that shares no code with the crate.
fn check_plainly(generated: &Generated, path: &Path, written: &Corrected, waves: &Waves) {
    let text = std::str::from_utf8(&written.bytes).unwrap();
    let reached = read_plainly(text);
    assert_eq!(reached.len(), written.pieces.len());
    let input = read_plainly(&generated.text);
    for (reached, piece) in reached.iter().zip(&written.pieces) {
        assert_eq!(reached.line, piece.output_line);
        let fact = &generated.facts[piece.move_index];
        let off = reached.place - piece.commanded_to;
        for axis in (0..3).filter(|axis| fact.known[1][*axis]) {
            assert!(off[axis].abs() < 1e-6, "output line {}", piece.output_line);
        }
        if path.moves[piece.move_index].known == Knowledge::Nothing {
            // On the machine the axes that move are where they were to be, and those that do not are off
            // by no more than a correction.
            let line = path.moves[piece.move_index].line;
            let meant = input.iter().find(|reached| reached.line == line).unwrap();
            let off = reached.place - meant.place;
            for axis in 0..3 {
                let allowed = match (fact.machine, fact.named[axis]) {
                    (true, true) => 1e-9,
                    (false, true) => 0.5e-4 * 2.54 + 1e-9,
                    (_, false) => 2.0 * waves.size_mm + 1e-3,
                };
                assert!(
                    off[axis].abs() <= allowed,
                    "output line {}: {off}",
                    piece.output_line
                );
            }
        }
        let motion = &path.moves[piece.move_index];
        if let (MoveKind::Feed, Some(feed), false) = (motion.kind, motion.feed, piece.corner_step) {
            // The time the piece takes is the time the part's stretch should take.
            let part = motion.length_between_mm(piece.share_from, piece.share_to);
            let ends = [piece.commanded_from, piece.commanded_to];
            let length = match &reached.arc {
                Some(arc) => arc.length(ends),
                None => (ends[1] - ends[0]).norm(),
            };
            let speed = reached.speed.unwrap();
            let (is, wanted) = match feed.mode {
                FeedMode::InverseTime => (1.0 / speed, part / motion.length_mm() / feed.value),
                _ => (length / speed / motion.words.mm_per_unit, part / feed.value),
            };
            if part > 0.0 && length > 0.0 {
                // Along its own path the tool is no faster than 1.2 times as programmed; where that
                // limits it, the part is cut more slowly, and nowhere else.
                let longer = length / part;
                assert_eq!(piece.feed_limited, longer > 1.2);
                let wanted = if longer > 1.2 {
                    wanted * longer / 1.2
                } else {
                    wanted
                };
                assert!(
                    (is / wanted - 1.0).abs() < 1e-3,
                    "output line {}: {is} {wanted}",
                    piece.output_line
                );
            }
        }
    }
    for (index, line) in text.lines().enumerate() {
        assert!(line.len() <= 250, "output line {}", index + 1);
    }
}

fn check_one(ops: &[Op], style: &Style, waves: &Waves, machine_is_known: bool) {
    let generated = generate(ops, style, machine_is_known);
    let program = Program::read(generated.text.as_bytes()).unwrap();
    assert_eq!(program.bytes(), generated.text.as_bytes());
    let reading = reading(machine_is_known);
    let path =
        interpret(&program, &reading).unwrap_or_else(|error| panic!("{error}\n{}", generated.text));
    check_interpretation(&generated, &path);

    // Where nothing is to be corrected the bytes are the same: arcs stay arcs, no header.
    let writing = WriteOptions::default();
    let unchanged = write_corrected(&program, &path, &NoCorrection, &writing, &Unwatched).unwrap();
    assert_eq!(String::from_utf8_lossy(&unchanged.bytes), generated.text);
    verify_written(&program, &path, &unchanged, &reading, &writing).unwrap();

    for (decimals, arcs) in [(None, Arcs::Lines), (None, Arcs::Fit), (Some(6), Arcs::Fit)] {
        let writing = {
            let mut writing = WriteOptions::default();
            writing.arcs = arcs;
            writing.decimals = decimals;
            writing.header = Some(vec![
                "model (heavy), 500 N".to_owned(),
                "\u{e9}t\u{e9} ".repeat(100),
            ]);
            writing
        };
        let written = write_corrected(&program, &path, waves, &writing, &Unwatched).unwrap();
        let output = String::from_utf8_lossy(&written.bytes).into_owned();
        verify_written(&program, &path, &written, &reading, &writing).unwrap_or_else(|error| {
            panic!(
                "{error}\n--- input\n{}\n--- output\n{output}",
                generated.text
            )
        });
        check_places(&path, &written, waves, &writing);
        check_plainly(&generated, &path, &written, waves);
        let again = write_corrected(&program, &path, waves, &writing, &Unwatched).unwrap();
        assert!(again == written, "two runs differ");
        if written.bytes == program.bytes() {
            assert_eq!(written.accounting.header_lines, 0);
            continue;
        }
        let marked = Program::read(written.bytes).unwrap();
        let marked_path = interpret(&marked, &reading).unwrap();
        let refused = write_corrected(&marked, &marked_path, waves, &writing, &Unwatched);
        assert!(matches!(
            refused,
            Err(WriteError::AlreadyCompensated { .. })
        ));
    }
}

/// 150, or as many as `PROPTEST_CASES` says.
fn cases() -> u32 {
    let setting = std::env::var("PROPTEST_CASES").ok();
    setting.and_then(|cases| cases.parse().ok()).unwrap_or(150)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn every_written_program_keeps_every_promise(
        ops in prop::collection::vec(op(), 1..25), style in style(), waves in waves(), machine_is_known in any::<bool>(),
    ) {
        check_one(&ops, &style, &waves, machine_is_known);
    }
}
