//! How blocks are divided where the correction bends or jumps: their pieces, their feeds, and the extra axes and arcs
//! among them.

use crate::writing::{at_origin, bare, bend, straight, written, written_with};
use kinetostat_program::*;
use nalgebra::Vector3;

#[test]
fn a_block_is_split_where_the_correction_bends_and_its_comment_and_stop_stay_in_place() {
    let text = "G21 G90\nG0 X0 Y0 Z0\nN30 G1 X100 F600 (cut) M0\nX0\n";
    let (output, result) = written_with(text, &bend, &at_origin(), &bare());
    let lines: Vec<&str> = output.lines().collect();
    assert!(lines[2].starts_with("N30 G1 X"), "{output}");
    assert!(lines[2].ends_with(" F600 (cut)"), "{output}");
    let stop = lines.iter().position(|line| line.ends_with(" M0")).unwrap();
    assert_eq!(lines[stop], "X100.0000 Z0.1000 M0");
    // A parabola of 1e-5 x^2 leaves its chord of length l by 1e-5 l^2 / 4: 0.5 um allow 14 mm, and
    // halving 100 mm gives 12.5 mm.
    assert_eq!(stop - 1, 8, "{output}");
    assert_eq!(result.accounting.blocks_split, 2);
    assert_eq!(result.accounting.blocks_in, 4);
    assert_eq!(result.accounting.blocks_out, 2 + 8 + 8);
    assert_eq!(result.accounting.smallest_piece_mm, Some(12.5));
    assert!((result.accounting.largest_correction_mm - 0.1).abs() < 1e-12);
    assert_eq!(result.accounting.largest_correction_line, Some(3));
}

#[test]
fn a_program_that_names_every_motion_names_it_in_every_piece() {
    // Most printers' firmwares have no modal motion.
    let (output, result) = written_with(
        "G21 G90\nG0 X0\nG1 X100 F600\ng2 X90 I-5\n",
        &bend,
        &at_origin(),
        &straight(),
    );
    assert!(result.accounting.pieces > 20);
    for line in output.lines().skip(2) {
        assert!(line.starts_with("G1 ") || line.starts_with("g1 "), "{line}");
    }
}

#[test]
fn a_piece_that_only_the_last_bit_moves_keeps_the_feed() {
    // Found by comparing with LinuxCNC: a piece of 1e-14 mm was written with F0.000000000001.
    let text = "G20\nG00 X-0.389864 Y-0.78 Z.759\nG2 X-0.79967 Y-.28141 J.41771\nG1 Z1.00232\nG91\n\
                G03 Y.12721 Z0.20134 R-0.24247\nY-.68257 Z.72885 R-.68404\nY0.2 G92\nG90.1 G19 G01 Y+0.0333\n\
                G3 Y-0.10384 Z.14075 J0.086 K1.93251\nG01 G90 Z2.2457 Y.72635\nR-0.01334 G3 Z2.25054\n\
                R-0.85653 Z3.46143 F0.0100\n";
    let field = |request: &Request| {
        let at = &request.position_mm;
        let smooth = Vector3::new(
            0.21 * (at.x / 31.0).sin() + 0.04,
            0.16 * (at.y / 27.0).cos() - 0.05 * (at.x / 90.0).sin(),
            0.12 * ((at.x + at.y) / 43.0).sin() - 0.002 * at.z,
        );
        let steps = Vector3::new((at.x / 17.0).floor(), (at.y / 11.0).floor(), 0.0) * 0.011;
        Ok(smooth + steps + request.tangent.unwrap_or_default() * 0.07)
    };
    let (output, _) = written_with(text, &field, &ReadOptions::default(), &bare());
    assert!(!output.contains("F0.0000"), "{output}");
}

#[test]
fn a_jump_of_the_correction_becomes_a_corner_step_of_the_next_feed_block() {
    // Air cutting, then load on the feed blocks along x, turned to y.
    let field = |request: &Request| Ok(request.tangent.unwrap_or_default() * -0.02);
    let text = "G21 G90\nG1 X10 F600\nX20\nY10 (turn)\nG0 Z5\n";
    let (output, result) = written_with(text, &field, &at_origin(), &bare());
    assert_eq!(
        output,
        "G21 G90\nG1 X-0.0200 F600\nX9.9800\nX19.9800\nY-0.0200 X20.0000 (turn)\nY9.9800\nG0 Z4.9800 Y10.0000\n",
    );
    // The first is where the program begins, without a correction.
    let accounting = &result.accounting;
    assert_eq!((accounting.entry_steps, accounting.corner_steps), (1, 1));
    assert!((accounting.largest_entry_step_mm - 0.02).abs() < 1e-9);
    assert!((accounting.largest_corner_step_mm - 0.02 * 2.0_f64.sqrt()).abs() < 1e-9);
    assert!(result.pieces[0].corner_step && !result.pieces[1].corner_step);
}

#[test]
fn a_jump_where_a_rapid_ends_is_no_corner() {
    let field = |request: &Request| Ok(request.tangent.unwrap_or_default() * -0.02);
    let text = "G21 G90\nG0 X1\nG1 X10 F600\nY10\nG0 Z5\nG1 Z4\n";
    let after_rapids = |request: &Request| match request.move_index {
        0 | 3 => Ok(Vector3::zeros()),
        _ => field(request),
    };
    let (_, result) = written_with(text, &after_rapids, &at_origin(), &bare());
    let a = &result.accounting;
    assert_eq!((a.corner_steps, a.entry_steps), (1, 2));
    assert!((a.largest_corner_step_mm - 0.02 * 2.0_f64.sqrt()).abs() < 1e-9);
    assert!((a.largest_entry_step_mm - 0.02).abs() < 1e-9);
    assert_eq!(a.largest_entry_step_line, Some(3));
    let steps = result.pieces.iter().filter(|piece| piece.corner_step);
    assert_eq!(steps.count(), 3);
}

#[test]
fn smaller_jumps_than_requested_get_no_step_and_are_accounted_for() {
    let field = |request: &Request| Ok(request.tangent.unwrap_or_default() * -0.02);
    let writing = {
        let mut writing = bare();
        writing.corner_step_mm = Some(0.025);
        writing
    };
    let (output, result) = written_with(
        "G21 G90\nG1 X10 F600\nX20\nY10\n",
        &field,
        &at_origin(),
        &writing,
    );
    assert_eq!(
        output,
        "G21 G90\nG1 X9.9800 F598.8\nX19.9800 F600\nY-0.0200 X20.0000\nY9.9800\n"
    );
    assert_eq!(result.accounting.corner_steps, 1);
    assert!((result.accounting.largest_jump_taken_up_mm - 0.02).abs() < 1e-12);
}

#[test]
fn a_jump_inside_a_block_becomes_a_step_at_its_place() {
    let field = |request: &Request| {
        Ok(if request.position_mm.z < -1.0 {
            Vector3::new(0.05, 0.0, 0.0)
        } else {
            Vector3::zeros()
        })
    };
    let (output, result) =
        written_with("G21 G90\nG1 Z-5 F100\nX10\n", &field, &at_origin(), &bare());
    assert_eq!(result.accounting.corner_steps, 1);
    // One piece before the step, one after it, and not the trail of the search for its place.
    assert_eq!(result.pieces.len(), 4, "{output}");
    let step = result
        .pieces
        .iter()
        .find(|piece| piece.corner_step)
        .unwrap();
    assert!((step.commanded_to.z + 1.0).abs() < 1.1e-3, "{output}");
    assert!(
        !output.contains("F5"),
        "the step keeps the programmed feed: {output}"
    );
}

#[test]
fn the_speed_along_the_part_is_kept_and_the_feed_restored() {
    // Everything 1 % longer in x.
    let field = |request: &Request| Ok(Vector3::new(0.01 * request.position_mm.x, 0.0, 0.0));
    let text = "G21 G90\nG1 X100 F1000\nX200\nY50\nY60 F500\nG0 X0\nG1 Y0\n";
    assert_eq!(
        written(text, &field),
        "G21 G90\nG1 X101.0000 F1010\nX202.0000\nY50 F1000\nY60 F500\nG0 X0\nG1 Y0\n"
    );
}

#[test]
fn inverse_time_is_shared_out_by_length() {
    let text = "G21 G90 G93\nG0 X0\nG1 X100 F6 (ten seconds)\nY10 F60\n";
    let (output, result) = written_with(text, &bend, &at_origin(), &bare());
    let lines: Vec<&str> = output.lines().collect();
    let pieces = result.accounting.pieces - 2;
    assert_eq!(pieces, 8);
    for line in &lines[2..2 + pieces] {
        assert!(
            line.contains("F48"),
            "eight equal pieces of 1/6 min: {output}"
        );
    }
    assert_eq!(lines[2 + pieces], "Y10 F60");
}

#[test]
fn an_inverse_time_step_at_a_corner_has_the_programmed_speed() {
    let field = |request: &Request| Ok(request.tangent.unwrap_or_default() * 0.1);
    let output = written("G21 G90 G93\nG1 X100 F2\n", &field);
    // 200 mm/min over 0.1 mm is 2000 blocks in a minute.
    assert_eq!(output, "G21 G90 G93\nG1 X0.1000 F2000\nG1 X100.1000 F2\n");
}

#[test]
fn a_program_without_a_feed_gets_none_and_a_warning() {
    let field = |request: &Request| Ok(Vector3::new(0.01 * request.position_mm.x, 0.0, 0.0));
    let (output, result) = written_with("G21\nG1 X100\nX200\n", &field, &at_origin(), &bare());
    assert_eq!(output, "G21\nG1 X101.0000\nX202.0000\n");
    assert!(
        result
            .accounting
            .warnings
            .iter()
            .any(|warning| warning.line == 2 && warning.text.contains("F"))
    );
}

#[test]
fn extra_axes_are_shared_out_absolute_and_relative() {
    let text =
        "G21 G90\nM82\nG92 E1 A0\nG0 X0\nG1 X100 E3.5 A90 F600\nM83\nG1 X0 E2.5\nG1 E-1 F300\nX5\n";
    let (output, result) = written_with(text, &bend, &at_origin(), &bare());
    assert!(
        output.contains(
            "G1 X12.5000 Z0.0016 E1.31250 A11.25000 F600\nX25.0000 Z0.0063 E1.62500 A22.50000\n"
        ),
        "{output}"
    );
    assert!(output.contains("X100.0000 Z0.1000 E3.5 A90\n"), "{output}");
    let relative: f64 = output
        .lines()
        .skip_while(|line| *line != "M83")
        .take_while(|line| !line.starts_with("G1 E-1"))
        .filter_map(|line| {
            line.split('E')
                .nth(1)?
                .split(' ')
                .next()?
                .parse::<f64>()
                .ok()
        })
        .sum();
    assert!((relative - 2.5).abs() < 1e-9, "{relative}");
    assert_eq!(result.accounting.blocks_split, 2);
    assert!(
        output.contains("\nG1 E-1 F300\n"),
        "a block without X Y Z is carried"
    );
}

#[test]
fn an_extra_axis_that_cannot_be_shared_out_is_refused_by_line() {
    let refused = |text: &str| {
        let program = Program::read(text).unwrap();
        let path = interpret(&program, &at_origin()).unwrap();
        write_corrected(&program, &path, &bend, &bare(), &Unwatched)
            .unwrap_err()
            .to_string()
    };
    let message = refused("G21 G90\nG0 X0\nG1 X100 A90 F600\n");
    assert!(
        message.starts_with("line 3: the block must be split, but its A word cannot be"),
        "{message}"
    );
    assert!(
        message.contains("a block with its place, or G92"),
        "{message}"
    );
    let message = refused("G21 M82 G90\nM83\nG90\nG0 X0\nG1 X100 E5 F600\n");
    assert!(message.starts_with("line 5: "), "{message}");
    assert!(message.contains("write M82 or M83 again"), "{message}");
}

#[test]
fn a_field_without_end_is_stopped_at_the_largest_number_of_pieces() {
    let noise = |request: &Request| {
        Ok(Vector3::new(
            (request.position_mm.x * 1e6).sin() * 0.1,
            0.0,
            0.0,
        ))
    };
    let program = Program::read("G21\nG0 X0\nG1 X100 F100\n").unwrap();
    let path = interpret(&program, &at_origin()).unwrap();
    let writing = {
        let mut writing = bare();
        writing.max_pieces = 1000;
        writing
    };
    let error = write_corrected(&program, &path, &noise, &writing, &Unwatched).unwrap_err();
    assert_eq!(
        error,
        WriteError::TooManyPieces {
            line: 3,
            limit: 1000
        }
    );
}

#[test]
fn the_feed_mode_may_change_and_each_feed_is_shared_out_in_its_own_way() {
    let stretch = |request: &Request| Ok(Vector3::new(0.01 * request.position_mm.x, 0.0, 0.0));
    let text = "G21 G90\nG1 X100 F1000\nG94\nG1 X200\nG93\nG1 X100 F2\nG95\nG1 X0 F0.2\n";
    assert_eq!(
        written(text, &stretch),
        "G21 G90\nG1 X101.0000 F1010\nG94\nG1 X202.0000\nG93\nG1 X101.0000 F2\nG95\nG1 X0 F0.202\n"
    );
}

/// Corrects only where the tool is below the surface.
fn below(request: &Request) -> Result<Vector3<f64>, FieldFailure> {
    Ok(match request.position_mm.z < -0.5 {
        true => Vector3::new(0.02, 0.0, 0.0),
        false => Vector3::zeros(),
    })
}

#[test]
fn an_arc_without_correction_stays_an_arc_among_blocks_that_are_corrected() {
    let text = "G21 G90\nG0 X10 Y0 Z0\nG3 X-10 I-10 F300\nG1 Z-1\nG1 Y5 F200\nG1 Z0 F300\nG2 X10 Y5 I10\nI-5\nM2\n";
    let (output, result) = written_with(text, &below, &at_origin(), &WriteOptions::default());
    for kept in ["\nG3 X-10 I-10 F300\n", "\nG2 X10 Y5 I10\nI-5\nM2\n"] {
        assert!(output.contains(kept), "{output}");
    }
    assert!(output.contains("X-9.9800"), "{output}");
    assert_eq!(
        result.pieces.iter().filter(|piece| piece.kept_arc).count(),
        3
    );
}

#[test]
fn an_arc_is_named_again_where_the_arc_before_it_was_divided() {
    // Both circles are G2 by the first word; the first lies where corrections are.
    let field = |request: &Request| {
        let far = request.position_mm.x < 49.0;
        Ok(Vector3::new(0.0, 0.0, if far { 0.03 } else { 0.0 }))
    };
    let text = "G21 G90 G17\nG0 X0 Y0 Z0\nG2 I5 F300\nG0 X50\nG2 I5\nG1 X40\nG2 I1\nG0 X60\nG2 X62 R1\nX60 R1\nM2\n";
    let (output, _) = written_with(text, &field, &at_origin(), &bare());
    assert!(output.contains("\nG2 I5\nG1 X"), "{output}");
    assert!(output.ends_with("\nG2 X62 R1\nX60 R1\nM2\n"), "{output}");
}

#[test]
fn the_feed_is_not_raised_beyond_its_factor_and_the_pieces_are_counted() {
    // 40 mm of correction over 10 mm of part: five times the feed would be needed.
    let field = |request: &Request| Ok(Vector3::new(4.0 * request.position_mm.x, 0.0, 0.0));
    let text = "G21 G90\nG0 X0 Y0 Z0\nG1 X10 F100\nG93\nX0 F2\nM2\n";
    let (output, result) = written_with(text, &field, &at_origin(), &bare());
    assert_eq!(
        output,
        "G21 G90\nG0 X0 Y0 Z0\nG1 X50.0000 F120\nG93\nX0 F0.48\nM2\n"
    );
    let account = &result.accounting;
    assert_eq!(
        (account.feed_limited_pieces, account.feed_limited_line),
        (2, Some(3))
    );
    assert!((account.slowest_limited_speed.unwrap() - 0.24).abs() < 1e-12);
    assert_eq!(
        (account.feed_length_in_mm, account.feed_length_out_mm),
        (20.0, 100.0)
    );
    let seconds = (
        account.feed_time_in_s.unwrap(),
        account.feed_time_out_s.unwrap(),
    );
    assert!(
        (seconds.0 - 36.0).abs() < 1e-9 && (seconds.1 - 150.0).abs() < 1e-9,
        "{seconds:?}"
    );
    let free = {
        let mut writing = bare();
        writing.max_feed_factor = 10.0;
        writing
    };
    let (output, _) = written_with(text, &field, &at_origin(), &free);
    assert!(output.contains("G1 X50.0000 F500\nG93\nX0 F2"), "{output}");
}

#[test]
fn a_step_that_cuts_backwards_is_warned_of_with_its_line() {
    let field = |request: &Request| Ok(request.tangent.unwrap_or_default() * -0.2);
    let text = "G21 G90\nG0 X0 Y0 Z0\nG1 X10 F100\nY10\nX0\n";
    let (_, result) = written_with(text, &field, &at_origin(), &bare());
    let account = &result.accounting;
    assert!(
        (account.largest_backward_mm - 0.2).abs() < 1e-9,
        "{account:?}"
    );
    assert_eq!(
        (account.backward_steps, account.largest_backward_line),
        (3, Some(3))
    );
    assert!(
        account
            .warnings
            .iter()
            .any(|warning| warning.line == 3 && warning.text.contains("cuts backwards"))
    );
    let wide = {
        let mut writing = bare();
        writing.backward_step_mm = 0.3;
        writing
    };
    let (_, result) = written_with(text, &field, &at_origin(), &wide);
    assert!(
        result.accounting.warnings.is_empty(),
        "{:?}",
        result.accounting
    );
}
