//! A feed that turns in place: divided by its angle, in inverse time, read and checked again; against a correction that is stated
//! by hand and sampled apart from the division.

use std::sync::Arc;

use kinetostat_program::{
    Carries, Corrected, FeedMode, Path, Program, ReadOptions, Request, RotaryAxes, RotaryAxis,
    Unwatched, WriteError, WriteOptions, interpret, verify_against_field, verify_written,
    write_corrected,
};
use nalgebra::{UnitQuaternion, Vector3};

/// A table about z.
fn table() -> ReadOptions {
    let mut options = ReadOptions::default();
    options.rotary = Some(Arc::new(RotaryAxes {
        axes: vec![RotaryAxis {
            letter: 'C',
            carries: Carries::Part,
            direction: Vector3::z_axis(),
            point_mm: Vector3::zeros(),
            limits_deg: None,
        }],
        tool_at_zero: UnitQuaternion::identity(),
    }));
    options
}

/// A spindle that gives way by 0.2 mm to one side of the machine: seen from the part that turns, the other way round.
fn bent(degrees: f64) -> Vector3<f64> {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    Vector3::new(0.2 * cosine, -0.2 * sine, 0.05)
}

struct Written {
    path: Path,
    corrected: Corrected,
    again: Path,
    text: String,
}

fn written(text: &str, writing: &WriteOptions) -> Result<Written, WriteError> {
    let options = table();
    let program = Program::read(text).unwrap();
    let path = interpret(&program, &options).unwrap_or_else(|error| panic!("{error}"));
    let angle = |request: &Request| {
        let turn = path.moves[request.move_index].tool_turn.as_ref();
        let rotary = turn.and_then(|turn| turn.rotary.as_ref());
        rotary.map_or(0.0, |rotary| rotary.angles_deg(request.share)[0])
    };
    let field = |request: &Request| Ok(bent(angle(request)));
    let corrected = write_corrected(&program, &path, &field, writing, &Unwatched)?;
    verify_written(&program, &path, &corrected, &options, writing)?;
    verify_against_field(&path, &corrected, &field, writing, &Unwatched)?;
    let text = String::from_utf8(corrected.bytes.clone()).unwrap();
    let again = interpret(&Program::read(text.clone()).unwrap(), &options).unwrap();
    Ok(Written {
        path,
        corrected,
        again,
        text,
    })
}

fn plain() -> WriteOptions {
    let mut writing = WriteOptions::default();
    writing.header = None;
    writing
}

const BEGIN: &str = "G21 G90 G94\nG0 X30 Y0 Z5 C0\nG43.4 H1 Z5\nG1 Z0 F300\n";

/// Farthest that the tool is from where the bent spindle wants it, on blocks that turn, and how many places were looked at.
fn farthest(made: &Written) -> (f64, usize) {
    let (mut worst, mut count) = (0.0, 0);
    for motion in made
        .again
        .moves
        .iter()
        .filter(|motion| motion.turn_deg() > 0.0)
    {
        let turn = motion.tool_turn.as_ref().unwrap();
        for k in 0..=50 {
            let share = f64::from(k) / 50.0;
            let degrees = turn.rotary.as_ref().unwrap().angles_deg(share)[0];
            let wanted = Vector3::new(30.0, 0.0, 0.0) + bent(degrees);
            let off = (motion.point(share) - wanted).norm();
            assert!(off.is_finite());
            worst = if off > worst { off } else { worst };
            count += 1;
        }
    }
    (worst, count)
}

#[test]
fn it_is_divided_and_sampled_between() {
    for text in [
        "C180",
        "C-720",
        "G91 C90 F90\nG90",
        "G93 C180 F2\nG94 F300",
        "C0.02",
    ] {
        let made = written(&format!("{BEGIN}{text}\nX31\nM30\n"), &plain()).unwrap();
        let (worst, count) = farthest(&made);
        assert!(count > 50, "{}", made.text);
        // The tolerance, and half a digit of three words at both ends.
        assert!(worst < 0.0005 * 1.1 + 1e-4, "{worst}\n{}", made.text);
        let least = usize::from(text != "C0.02");
        assert!(
            made.corrected.pieces.len() >= made.path.moves.len() + 10 * least,
            "{}",
            made.text
        );
    }
}

#[test]
fn its_pieces_have_their_time_and_the_feed_comes_back() {
    for (text, seconds) in [
        ("C180 F360", 30.0),
        ("G1 G94 C180", 36.0),
        ("N7 c180 (half a turn)", 36.0),
        ("G93 C180 F2", 30.0),
        ("G20\nC180 F360", 30.0),
        ("/C180 F90", 120.0),
    ] {
        let made = written(
            &format!("{BEGIN}{text}\nG94 G1 X1 F250\nX2\nM30\n"),
            &plain(),
        )
        .unwrap();
        let mut time = 0.0;
        for motion in made
            .again
            .moves
            .iter()
            .filter(|motion| motion.turn_deg() > 0.0)
        {
            let feed = motion.feed.unwrap();
            assert_eq!(feed.mode, FeedMode::InverseTime, "{}", made.text);
            time += 60.0 / feed.value;
        }
        assert!((time / seconds - 1.0).abs() < 1e-3, "{time}\n{}", made.text);
        let last = made.again.moves.last().unwrap().feed.unwrap();
        assert_eq!(last.mode, FeedMode::PerMinute);
        assert!(
            made.corrected.accounting.feed_time_out_s.unwrap() > seconds,
            "{}",
            made.text
        );
    }
    // The next block has no F of its own.
    let made = written(&format!("{BEGIN}C180 F360\nX31\nM30\n"), &plain()).unwrap();
    assert!(made.text.contains("\nG94 F360\nX30.8"), "{}", made.text);
}

#[test]
fn without_a_correction_it_stays_byte_for_byte() {
    let text = format!("{BEGIN}C180 F360\nM30\n");
    let program = Program::read(text.clone()).unwrap();
    let options = table();
    let path = interpret(&program, &options).unwrap();
    let nothing = |_: &Request| Ok(Vector3::zeros());
    let made = write_corrected(&program, &path, &nothing, &plain(), &Unwatched).unwrap();
    assert_eq!(made.bytes, text.as_bytes());
    // A correction that does not change with the angle needs one block, whose feed counts degrees.
    let constant = |_: &Request| Ok(Vector3::new(0.1, 0.0, 0.0));
    let made = write_corrected(&program, &path, &constant, &plain(), &Unwatched).unwrap();
    verify_written(&program, &path, &made, &options, &plain()).unwrap();
    let made = String::from_utf8(made.bytes).unwrap();
    assert!(made.contains("\nC180 F360\nM30\n"), "{made}");
}

#[test]
fn the_program_may_end_in_its_block() {
    let made = written(&format!("{BEGIN}C90 M30\n"), &plain()).unwrap();
    assert!(
        made.text.ends_with("M30\n") && made.text.contains("G93"),
        "{}",
        made.text
    );
    let made = written(&format!("{BEGIN}C90"), &plain()).unwrap();
    assert!(made.text.ends_with("\nG94 F300"), "{}", made.text);
}

#[test]
fn a_feed_per_revolution_is_refused() {
    let program = Program::read(format!("{BEGIN}G95 C90 F0.1\n")).unwrap();
    let fault = interpret(&program, &table()).unwrap_err();
    assert_eq!(fault.line, 5);
    assert!(
        fault.to_string().contains("rotary axes turn alone"),
        "{fault}"
    );
}

#[test]
fn a_tampered_time_is_found() {
    let text = format!("{BEGIN}C180 F360\nX31\nM30\n");
    let made = written(&text, &plain()).unwrap();
    let (program, options) = (Program::read(text).unwrap(), table());
    let tampered = |from: &str, to: &str| {
        let mut corrected = made.corrected.clone();
        let bytes = made.text.replacen(from, to, 1);
        assert_ne!(bytes, made.text);
        corrected.bytes = bytes.into_bytes();
        corrected.accounting.bytes_out = corrected.bytes.len();
        verify_written(&program, &made.path, &corrected, &options, &plain())
            .unwrap_err()
            .to_string()
    };
    let word = made.text.lines().find(|line| line.contains("G93")).unwrap();
    let feed = word
        .split_whitespace()
        .find(|word| word.starts_with('F'))
        .unwrap();
    assert!(tampered(feed, "F1").contains("time of a turn in place"));
    assert!(tampered("\nG94 F360\n", "\nG94 F36\n").contains("speed"));
    let broken = tampered("\nG94 F360\n", "\nM8 F360\n");
    assert!(!broken.is_empty());
}
