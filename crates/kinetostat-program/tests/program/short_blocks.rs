//! Blocks that are too short for a controller: shared out where the tolerance allows, and named.

use crate::writing::{at_origin, bare, written_with};
use kinetostat_program::*;
use kinetostat_testing::least;
use nalgebra::Vector3;

/// The correction bends more and more along x.
fn bend(request: &Request) -> Result<Vector3<f64>, FieldFailure> {
    let x = request.position_mm.x;
    Ok(Vector3::new(0.0, 0.0, 1e-7 * x * x * x))
}

#[test]
fn what_is_left_over_is_shared_with_the_piece_before_it() {
    let mut improved = 0;
    for length in 40..=120 {
        let text = format!("G21 G90\nG0 X0 Y0 Z0\nG1 X{length} F600\nM2\n");
        let (_, free) = written_with(&text, &bend, &at_origin(), &bare());
        let Some(smallest) = free.accounting.smallest_piece_mm else {
            continue;
        };
        let mut writing = bare();
        writing.min_block_mm = Some(1.05 * smallest);
        let program = Program::read(text.as_bytes()).unwrap();
        let path = interpret(&program, &at_origin()).unwrap();
        let (output, held) = written_with(&text, &bend, &at_origin(), &writing);
        verify_against_field(&path, &held, &bend, &writing, &Unwatched).unwrap();
        let now = held.accounting.smallest_piece_mm.unwrap();
        let named = held
            .accounting
            .warnings
            .iter()
            .filter(|w| w.text.contains("shorter than"));
        // Either it is longer now, or the line is named.
        match now >= 1.05 * smallest {
            true => improved += 1,
            false => {
                assert_eq!(named.count(), 1, "{output}");
                assert!(held.pieces.len() <= free.pieces.len());
            }
        }
    }
    assert!(improved >= 8, "{improved}");
}

#[test]
fn short_blocks_are_named_with_their_length_time_and_remedy() {
    let text = "G21 G90\nG0 X0 Y0 Z0\nG1 X5 F6000\nX5.02\nX5.03\nX20\nM2\n";
    let raised = |_: &Request| Ok(Vector3::new(0.0, 0.0, 0.25));
    let said = |min_block_mm: Option<f64>, max_blocks_per_s: Option<f64>| {
        let mut writing = bare();
        writing.min_block_mm = min_block_mm;
        writing.max_blocks_per_s = max_blocks_per_s;
        let (_, result) = written_with(text, &raised, &at_origin(), &writing);
        let warnings = result.accounting.warnings.into_iter();
        warnings
            .filter(|w| w.text.contains("shorter than the controller takes"))
            .map(|w| format!("{}: {}", w.line, w.text))
            .collect::<Vec<_>>()
    };
    assert!(said(None, None).is_empty());
    assert!(said(Some(0.005), Some(2e4)).is_empty());
    assert_eq!(
        said(Some(0.1), None),
        [
            "5: 2 blocks of the input, carried as they are, on the lines 4, 5 are shorter than the controller takes (0.1 mm), the shortest here with \
             0.0100 mm, 0.100 ms: let the CAM system write longer ones (a wider tolerance of its chords)"
        ]
    );
    // 0.01 mm at 6000 mm/min take 0.1 ms, 0.02 mm 0.2 ms.
    assert!(
        said(None, Some(7000.0))[0]
            .starts_with("5: 1 block of the input, carried as it is, on line 5 is shorter")
    );
}

/// A sentence names some lines; the account has every one of them.
#[test]
fn every_line_of_short_blocks_is_in_the_account() {
    let mut text = "G21 G90\nG0 X0 Y0 Z0\nG1 X5 F6000\n".to_owned();
    for step in 1..=12 {
        text.push_str(&format!("X{:.3}\n", 5.0 + 0.01 * f64::from(step)));
    }
    text.push_str("X20\nM2\n");
    let still = |_: &Request| Ok(Vector3::zeros());
    let mut writing = bare();
    writing.min_block_mm = Some(0.1);
    let (_, result) = written_with(&text, &still, &at_origin(), &writing);
    let short = &result.accounting.short_blocks;
    let lines: Vec<usize> = short.iter().map(|of| of.line).collect();
    assert_eq!(lines, (4..=15).collect::<Vec<_>>());
    for of in short {
        assert_eq!(of.blocks, 1);
        assert!((of.shortest_mm - 0.01).abs() < 1e-9, "{of:?}");
    }
    let said: Vec<&str> = result
        .accounting
        .warnings
        .iter()
        .filter(|w| w.text.contains("shorter than"))
        .map(|w| w.text.as_str())
        .collect();
    assert_eq!(said.len(), 1, "{said:?}");
    assert!(
        said[0].contains(
            "on the lines 4, 5, 6, 7, 8 and 7 more (short_blocks in the JSON result lists every line) are shorter"
        ),
        "{said:?}"
    );
    // Pieces of a block that is divided are counted on its line.
    let raised = |at: &Request| Ok(Vector3::z() * (0.02 * at.position_mm.x).sin());
    writing.min_block_mm = Some(1e3);
    let text = "G21 G90\nG0 X0 Y0 Z0\nG1 X100 F600\nM2\n";
    let (_, result) = written_with(text, &raised, &at_origin(), &writing);
    let [of] = result.accounting.short_blocks.as_slice() else {
        panic!("{:?}", result.accounting.short_blocks);
    };
    assert!(of.line == 3 && of.blocks > 3, "{of:?}");
}

#[test]
fn limits_out_of_range_are_refused() {
    for (min_block_mm, max_blocks_per_s) in [
        (Some(0.0), None),
        (Some(f64::NAN), None),
        (None, Some(-1.0)),
        (None, Some(f64::INFINITY)),
    ] {
        let mut writing = bare();
        writing.min_block_mm = min_block_mm;
        writing.max_blocks_per_s = max_blocks_per_s;
        let program = Program::read("G21\nG0 X0\n").unwrap();
        let path = interpret(&program, &ReadOptions::default()).unwrap();
        let refused = write_corrected(&program, &path, &NoCorrection, &writing, &Unwatched);
        assert!(matches!(refused, Err(WriteError::Option { .. })));
    }
}

/// A correction that bends more and more along an arc about the origin, and its height is a wave.
fn wave(request: &Request) -> Result<Vector3<f64>, FieldFailure> {
    let at = request.position_mm;
    let angle = at.y.atan2(at.x);
    Ok(Vector3::new(0.0, 0.0, 0.02 * (2.0 * angle * angle).sin()) + at * 1e-3)
}

/// Lengths of the pieces at feed, and the lines of the warning of short ones.
fn lengths(text: &str, writing: &WriteOptions) -> (Vec<f64>, Vec<usize>) {
    let program = Program::read(text.as_bytes()).unwrap();
    let path = interpret(&program, &at_origin()).unwrap();
    let (_, written) = written_with(text, &wave, &at_origin(), writing);
    verify_against_field(&path, &written, &wave, writing, &Unwatched).unwrap();
    let pieces = written.pieces.iter().filter(|piece| piece.move_index > 0);
    let lengths = pieces
        .map(|piece| piece.length_mm(&path.moves[piece.move_index]))
        .collect();
    let named = written.accounting.warnings.iter();
    let named = named.filter(|warning| warning.text.contains("shorter than"));
    (lengths, named.map(|warning| warning.line).collect())
}

#[test]
fn arcs_and_their_chords_are_longer_than_asked_or_their_line_is_named() {
    let mut held = [0; 2];
    for (kind, arcs) in [Arcs::Fit, Arcs::Lines].into_iter().enumerate() {
        for radius in [8, 31] {
            let text = format!(
                "G21 G90 G17\nG0 X{radius} Y0 Z0\nG3 X-{radius} Y0 I-{radius} J0 F600\nM2\n"
            );
            let mut writing = bare();
            writing.arcs = arcs;
            let (free, named) = lengths(&text, &writing);
            assert!(named.is_empty() && free.len() > 3, "{free:?}");
            let shortest = least(free.iter().copied());
            let mean = free.iter().sum::<f64>() / free.len() as f64;
            for part in [0.1, 0.3, 0.6, 1.2] {
                let shortest_mm = shortest + part * (mean - shortest);
                for by_time in [false, true] {
                    let mut writing = writing.clone();
                    match by_time {
                        // 600 mm/min are 10 mm/s.
                        true => writing.max_blocks_per_s = Some(10.0 / shortest_mm),
                        false => writing.min_block_mm = Some(shortest_mm),
                    }
                    let (now, named) = lengths(&text, &writing);
                    let now = least(now);
                    assert!(now.is_finite());
                    // The speed is that along the part, on which the corrected arc is a little longer.
                    match now >= shortest_mm * (1.0 - if by_time { 2e-3 } else { 1e-9 }) {
                        true => held[kind] += usize::from(now > shortest),
                        false => assert_eq!(named, [3], "{now} {shortest_mm}"),
                    }
                }
            }
        }
    }
    println!(
        "longer than asked: {} of 16 with arcs, {} of 16 with chords",
        held[0], held[1]
    );
    assert!(held[0] >= 8 && held[1] >= 12, "{held:?}");
}
