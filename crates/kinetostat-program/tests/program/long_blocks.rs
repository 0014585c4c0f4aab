//! With a shortest block stated every block is that long, or its line is named with the number of pieces that it needs.

use crate::support::plain_reader::read_plainly;
use crate::writing::{at_origin, bare, written_with};
use kinetostat_program::*;
use kinetostat_testing::least;
use nalgebra::Vector3;
use proptest::prelude::*;

/// Lines that the warnings of short blocks name.
fn named(accounting: &Accounting) -> Vec<usize> {
    let texts = accounting.warnings.iter().map(|warning| &warning.text);
    let short = texts.filter(|text| text.contains("shorter than the controller takes"));
    let lines = short.flat_map(|text| {
        let (before, _) = text.split_once(" shorter than").unwrap();
        let (_, lines) = before.split_once(" on ").unwrap();
        assert!(!lines.contains("more"), "{text}");
        let numbers = lines.split(|c: char| !c.is_ascii_digit());
        numbers
            .filter_map(|number| number.parse().ok())
            .collect::<Vec<usize>>()
    });
    lines.collect()
}

/// A straight block under a correction that bends evenly: as many pieces as a parabola needs, made longer where there is room.
#[test]
fn a_line_has_the_fewest_pieces_of_a_parabola_and_says_so_where_they_are_too_short() {
    let length = 100.0;
    for bend in [1e-6, 4e-6, 2e-5, 1e-4, 7e-4] {
        let field = |request: &Request| {
            let x = request.position_mm.x;
            Ok(Vector3::new(0.0, 0.0, 0.5 * bend * x * x))
        };
        let text = format!("G21 G90\nG0 X0 Y0 Z0\nG1 X{length} F600\nM2\n");
        // A chord of length h leaves a parabola by bend h^2 / 8.
        let pieces = |part: f64| {
            let longest = (8.0 * part * bare().tolerance_mm / bend).sqrt();
            (length / longest).ceil()
        };
        // Between all of the tolerance and what is kept of it for what is not known of the correction.
        let (fewest, enough) = (pieces(1.0), pieces(0.84));
        for (part, long) in [(0.97, true), (1.04, false)] {
            let count = if long { enough } else { fewest };
            let mut writing = bare();
            writing.min_block_mm = Some(part * length / count);
            let (output, written) = written_with(&text, &field, &at_origin(), &writing);
            let path = interpret(&Program::read(text.as_str()).unwrap(), &at_origin()).unwrap();
            verify_against_field(&path, &written, &field, &writing, &Unwatched).unwrap();
            let found = written.pieces.len() - 1;
            assert!(found as f64 >= fewest && found as f64 <= enough, "{output}");
            let lines = named(&written.accounting);
            if long {
                assert!(lines.is_empty(), "{bend} {lines:?} {output}");
                continue;
            }
            assert_eq!(lines, [3], "{bend} {output}");
            let warning = written.accounting.warnings.last().unwrap();
            let needs = format!("the block here needs {found} pieces within the tolerances");
            assert!(
                found == 1 || warning.text.contains(&needs),
                "{}",
                warning.text
            );
        }
    }
}

/// A motion of a random program: how far it goes along x and y, and the sweep of an arc, 0 for a straight one.
type Motion = (f64, f64, f64);

fn program(motions: &[Motion], feed: f64) -> String {
    let mut text = format!("G21 G90 G17 G94\nG0 X10 Y-5 Z1 F{feed}\n");
    let mut at = [10.0, -5.0];
    for (dx, dy, sweep) in motions {
        let rounded = |value: f64| (value * 1e3).round() / 1e3;
        let to = [rounded(at[0] + dx), rounded(at[1] + dy)];
        let way = [to[0] - at[0], to[1] - at[1]];
        let line = match *sweep == 0.0 {
            true => format!("G1 X{} Y{}\n", to[0], to[1]),
            false => {
                // The centre is on the bisector of the chord.
                let height = 0.5 / (0.5 * sweep).tan();
                let centre = [
                    0.5 * way[0] - height * way[1],
                    0.5 * way[1] + height * way[0],
                ];
                let code = if *sweep > 0.0 { 3 } else { 2 };
                format!(
                    "G{code} X{} Y{} I{:.4} J{:.4}\n",
                    to[0], to[1], centre[0], centre[1]
                )
            }
        };
        text += &line;
        at = to;
    }
    text + "M2\n"
}

fn motion() -> impl Strategy<Value = Motion> {
    let way = || prop_oneof![-30.0..-0.5_f64, 0.5..30.0_f64];
    let sweep = prop_oneof![
        2 => Just(0.0),
        3 => prop_oneof![-3.0..-0.3_f64, 0.3..3.0_f64],
    ];
    (way(), way(), sweep)
}

/// Waves along arcs of about their own length: what is fitted is within the tolerances at places that nobody looked at.
#[test]
fn arcs_keep_the_tolerances_where_the_correction_waves() {
    let mut looked = 0;
    for case in 0..400 {
        let part =
            |k: usize| f64::from(u32::try_from((case * 37 + k * 101) % 256).unwrap()) / 256.0;
        // The first one was found by chance.
        let (motion, height, per_mm, phase) = match case {
            0 => (
                (14.498552466140113, 26.553341665282606, -1.3173275907229625),
                0.002904183355833057,
                0.5317544676356066,
                5.386343205265299,
            ),
            _ => (
                (5.0 + 25.0 * part(0), 30.0 * part(1), 0.5 + 2.0 * part(2)),
                0.001 + 0.01 * part(3),
                0.2 + 0.4 * part(4),
                6.0 * part(5),
            ),
        };
        let field = |request: &Request| {
            let at = request.position_mm;
            let along: f64 = per_mm * (at.x + 0.6 * at.y) + phase;
            Ok(Vector3::new(0.3 * along.cos(), 0.5 * (0.7 * along).sin(), along.sin()) * height)
        };
        let text = program(&[motion], 100.0);
        let (output, written) = written_with(&text, &field, &at_origin(), &bare());
        let path = interpret(&Program::read(text.as_str()).unwrap(), &at_origin()).unwrap();
        let found = verify_against_field(&path, &written, &field, &bare(), &Unwatched);
        assert!(found.is_ok(), "{case}: {found:?}\n{text}\n{output}");
        looked += written.pieces.len();
    }
    assert!(looked > 1000, "{looked}");
}

#[test]
fn every_block_is_long_enough_or_its_line_is_named() {
    use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
    let (blocks, told, longer) = (
        AtomicUsize::new(0),
        AtomicUsize::new(0),
        AtomicUsize::new(0),
    );
    let waves = (0.001..0.05_f64, 0.02..0.6_f64, 0.0..6.0_f64);
    let config = ProptestConfig {
        failure_persistence: None,
        ..ProptestConfig::with_cases(96)
    };
    proptest!(config, |(
        motions in prop::collection::vec(motion(), 1..5),
        (height, per_mm, phase) in waves,
        feed in (100..4000_u32).prop_map(f64::from),
        (part, by_length, by_time) in (0.0..1.5_f64, any::<bool>(), any::<bool>()),
        fits in any::<bool>(),
    )| {
        let text = program(&motions, feed);
        let field = |request: &Request| {
            let at = request.position_mm;
            let along: f64 = per_mm * (at.x + 0.6 * at.y) + phase;
            Ok(Vector3::new(0.3 * along.cos(), 0.5 * (0.7 * along).sin(), along.sin()) * height)
        };
        let mut writing = bare();
        writing.arcs = if fits { Arcs::Fit } else { Arcs::Lines };
        let (_, free) = written_with(&text, &field, &at_origin(), &writing);
        let path = interpret(&Program::read(text.as_str()).unwrap(), &at_origin()).unwrap();
        // Between the shortest block without a limit and half as long again as the mean.
        let lengths = |result: &Corrected, index: Option<usize>| {
            let own = result.pieces.iter().filter(|piece| index.is_none_or(|index| piece.move_index == index));
            let own = own.filter(|piece| piece.move_index > 0);
            own.map(|piece| piece.length_mm(&path.moves[piece.move_index])).collect::<Vec<f64>>()
        };
        let of_all = lengths(&free, None);
        let shortest = least(of_all.iter().copied());
        let mean = of_all.iter().sum::<f64>() / of_all.len() as f64;
        let asked_mm = (shortest + part * (mean - shortest)).max(0.001);
        let min_block_mm = by_length.then_some(asked_mm);
        let max_blocks_per_s = by_time.then_some(feed / 60.0 / asked_mm);
        writing.min_block_mm = min_block_mm;
        writing.max_blocks_per_s = max_blocks_per_s;
        let (output, written) = written_with(&text, &field, &at_origin(), &writing);
        let looked = verify_against_field(&path, &written, &field, &writing, &Unwatched);
        prop_assert!(looked.is_ok(), "{looked:?}\n{text}\n{output}");
        let lines = named(&written.accounting);
        let reached = read_plainly(&output);
        prop_assert_eq!(reached.len(), written.pieces.len());
        let mut short_now = vec![0; path.moves.len()];
        for (piece, reached) in written.pieces.iter().zip(&reached).skip(1) {
            let motion = &path.moves[piece.move_index];
            let length_mm = piece.length_mm(motion);
            // Of an arc as read by other code, its chord at least.
            prop_assert!(length_mm >= (piece.commanded_to - piece.commanded_from).norm() * (1.0 - 1e-9));
            prop_assert!((piece.commanded_to - reached.place).norm() < 1e-6);
            let seconds = 60.0 * length_mm / reached.speed.unwrap();
            let long = min_block_mm.is_none_or(|least| length_mm >= least * (1.0 - 1e-9))
                && max_blocks_per_s.is_none_or(|most| seconds * most >= 1.0 - 1.1e-3);
            blocks.fetch_add(1, Relaxed);
            if !long {
                short_now[piece.move_index] += 1;
                prop_assert!(lines.contains(&motion.line), "{length_mm} mm, {seconds} s\n{text}\n{output}");
            }
        }
        // No line is named in vain, and nothing is worse than without limits.
        for (index, motion) in path.moves.iter().enumerate() {
            prop_assert!(short_now[index] > 0 || !lines.contains(&motion.line) || max_blocks_per_s.is_some());
            if short_now[index] > 0 {
                told.fetch_add(1, Relaxed);
                let counts = [&written, &free].map(|result| lengths(result, Some(index)).len());
                prop_assert!(counts[0] <= counts[1], "{counts:?} {text}\n{output}");
            } else if (by_length || by_time) && lengths(&free, Some(index)).iter().any(|mm| *mm < 0.99 * asked_mm) {
                longer.fetch_add(1, Relaxed);
            }
        }
    });
    let [blocks, told, longer] = [blocks, told, longer].map(AtomicUsize::into_inner);
    println!("{blocks} blocks; {told} moves named, {longer} made long enough");
    assert!(
        blocks > 500 && told > 20 && longer > 8,
        "{blocks} {told} {longer}"
    );
}
