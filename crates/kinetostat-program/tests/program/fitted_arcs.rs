//! Arcs that are fitted to corrected curves: every form of arc under fields of every kind, read again by code of the tests.

// Helpers of tests, which clippy does not count as tests.
use crate::arcs::cases;
use crate::support::plain_reader::read_plainly;
use crate::writing::{at_origin, bare, straight, written, written_with};
use kinetostat_program::*;
use kinetostat_testing::Worst;
use nalgebra::Vector3;

/// A field of corrections with its name, and whether one arc follows it exactly.
type Field = (&'static str, bool, fn(&Vector3<f64>) -> Vector3<f64>);

const FIELDS: [Field; 5] = [
    ("constant", true, |_| Vector3::new(0.3, -0.1, 0.05)),
    ("larger", true, |p| p * 2e-3),
    ("turned", false, |p| {
        Vector3::new(-p.y, p.x, 0.0) * 3e-4 + Vector3::new(0.0, 0.0, 0.1)
    }),
    ("linear", false, |p| {
        Vector3::new(1e-4 * p.x - 5e-5 * p.y, 1e-4 * p.z, 1e-4 * p.x - 5e-5 * p.y)
    }),
    ("quadratic", false, |p| {
        Vector3::new(p.x * p.y, p.y * p.z - p.x * p.x, p.z * p.z) * 5e-6
    }),
];

#[test]
fn every_form_of_arc_follows_every_kind_of_field_with_few_arcs() {
    let (mut arcs, mut samples) = (0, 0);
    let (mut worst, mut radii) = (Worst::new(), Worst::new());
    let mut sum_of_radii = 0.0;
    for case in &cases() {
        for (name, exact, field) in &FIELDS {
            let text = case.text();
            let program = Program::read(text.as_bytes()).unwrap();
            let reading = ReadOptions::default();
            let path = interpret(&program, &reading).unwrap();
            let answer = |request: &Request| Ok(field(&request.position_mm));
            let result = write_corrected(&program, &path, &answer, &bare(), &Unwatched).unwrap();
            let output = std::str::from_utf8(&result.bytes).unwrap();
            let fail = |what: &str| -> () { panic!("{what}: {name}\n{text}\n{output}") };
            if let Err(error) = verify_written(&program, &path, &result, &reading, &bare()) {
                fail(&error.to_string());
            }
            let looked = verify_against_field(&path, &result, &answer, &bare(), &Unwatched);
            if let Err(error) = looked {
                fail(&error.to_string());
            }
            let reached = read_plainly(output);
            assert_eq!(reached.len(), result.pieces.len());
            let digit = if case.inches { 25.4e-5 } else { 1e-4 };
            // Tolerances of path and chords, the rounding of the ends and of the centre, and that of the input's words.
            let allowed = 0.0005 + 0.0004 + 0.5 * 3.0_f64.sqrt() * digit + digit + 1e-4;
            let mut from = reached[0].place;
            let mut pieces = 0;
            for (motion, piece) in reached.iter().zip(&result.pieces).skip(1) {
                let Some(arc) = motion.arc else {
                    fail("a straight piece");
                    continue;
                };
                let ends = [from, motion.place];
                for k in 0..=40 {
                    let part = f64::from(k) / 40.0;
                    let share = piece.share_from + (piece.share_to - piece.share_from) * part;
                    let place = case.place(share);
                    let wanted = place + field(&place);
                    let off = (arc.beside(ends, part, &wanted) - wanted).norm();
                    if off.is_nan() || off > allowed {
                        fail(&format!("{off} mm off at {share}"));
                    }
                    worst.add(off / allowed);
                    samples += 1;
                }
                let [first, last] = arc.radii(ends);
                radii.add((first - last).abs() / digit);
                sum_of_radii += (first - last).abs() / digit;
                arcs += 1;
                pieces += 1;
                from = motion.place;
            }
            let most = match (*exact, case.sweep < 5.0) {
                (true, true) => 1,
                (true, false) => 2,
                (false, _) => 3,
            };
            assert!(result.accounting.blocks_out <= 2 * result.accounting.blocks_in);
            if pieces > most {
                fail(&format!("{pieces} pieces"));
            }
            // The form of the block is kept.
            let block = output.lines().nth(3).unwrap().split('(').next().unwrap();
            assert_eq!(block.contains('R'), case.by_radius, "{output}");
        }
    }
    let (worst, radii) = (worst.of(samples), radii.of(arcs));
    let mean = sum_of_radii / arcs as f64;
    println!(
        "{arcs} arcs, {samples} places: worst {worst:.3} of what is allowed; radii differ by {radii:.3} last digits at most, {mean:.4} on average"
    );
    assert!(arcs > 2000 && worst <= 1.0);
    assert!(radii < 1.0 && mean < 0.2, "{radii} {mean}");
}

#[test]
fn words_that_hold_are_kept_and_a_full_circle_becomes_two_halves() {
    let shift = |_: &Request| Ok(Vector3::new(0.01, 0.0, 0.0));
    assert_eq!(
        written(
            "G21 G90 G17\nG0 X10 Y0 Z0\nG3 X0 Y10 I-10 J0 F600 (quarter)\nX-10 Y0 J-10\nG02 I10 (round) M8\nG1 X5\nM2\n",
            &shift
        ),
        "G21 G90 G17\nG0 X10.0100 Y0 Z0\nG3 X0.0100 Y10 I-10 J0 F600 (quarter)\nX-9.9900 Y0 J-10\n\
         G02 X10.0100 I10 (round) M8\nX-9.9900 I-10.0000 J0.0000\nG1 X5.0100\nM2\n"
    );
}

#[test]
fn a_jump_at_the_start_of_an_arc_is_a_straight_step_before_it() {
    // The load acts along the arc only.
    let field = |request: &Request| {
        let cut = request.move_index == 2;
        Ok(Vector3::new(0.0, 0.0, if cut { 0.05 } else { 0.0 }))
    };
    let text = "G21 G90 G17\nG0 X10 Y0 Z0\nG1 X20 F600\nG3 X10 Y10 I-10 J0 (cut)\nG1 X0\n";
    let (output, result) = written_with(text, &field, &at_origin(), &bare());
    assert_eq!(
        output,
        "G21 G90 G17\nG0 X10 Y0 Z0\nG1 X20 F600\nG1 X20.0000 Y0.0000 Z0.0500 (cut)\n\
         G3 X10.0000 Y10.0000 I-10.0000 J0.0000\nG1 X10.0000 Z0.0000\nG1 X0.0000\n"
    );
    assert_eq!(result.accounting.corner_steps, 2);
    let arcs = result.pieces.iter().filter(|piece| piece.arc.is_some());
    assert_eq!(arcs.count(), 1);
}

#[test]
fn lines_are_written_where_they_are_asked_for() {
    let grow = |request: &Request| Ok(request.position_mm * 1e-3);
    let text = "G21 G90 G17\nG0 X10 Y0 Z0\nG3 X0 Y10 I-10 J0 F600\nM2\n";
    let (output, result) = written_with(text, &grow, &at_origin(), &straight());
    assert!(
        !output.contains("G3") && result.accounting.pieces > 40,
        "{output}"
    );
    let (output, result) = written_with(text, &grow, &at_origin(), &bare());
    assert_eq!(output.matches("G3").count(), 1);
    assert_eq!(result.accounting.pieces, 2, "{output}");
}

#[test]
fn a_tolerance_that_is_wider_needs_fewer_arcs() {
    let field = |request: &Request| {
        let p = request.position_mm / 30.0;
        Ok(Vector3::new(p.y.sin(), (2.0 * p.x).cos(), p.x.sin()) * 0.1)
    };
    let text = "G21 G90 G17\nG0 X25 Y0 Z0\nG3 I-25 F600\nM2\n";
    let count = |tolerance_mm: f64, arcs: Arcs| {
        let mut writing = bare();
        writing.tolerance_mm = tolerance_mm;
        writing.chord_tolerance_mm = 0.8 * tolerance_mm;
        writing.arcs = arcs;
        written_with(text, &field, &at_origin(), &writing)
            .1
            .accounting
            .pieces
    };
    let fitted: Vec<usize> = [0.0005, 0.005, 0.05]
        .map(|mm| count(mm, Arcs::Fit))
        .to_vec();
    let lines: Vec<usize> = [0.0005, 0.005, 0.05]
        .map(|mm| count(mm, Arcs::Lines))
        .to_vec();
    println!("pieces at 0.5, 5 and 50 um: {fitted:?} with arcs, {lines:?} with lines");
    assert!(fitted[0] > fitted[1] && fitted[1] > fitted[2]);
    assert!(
        fitted
            .iter()
            .zip(&lines)
            .all(|(arcs, lines)| 3 * arcs < *lines)
    );
}
