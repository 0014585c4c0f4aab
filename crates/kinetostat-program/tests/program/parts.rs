//! Programs that are read and written part by part: what comes is what comes of the whole.

use std::io::{Cursor, Write};
use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use kinetostat_program::*;
use nalgebra::Vector3;

/// Programs of the shared data, or nothing (said plainly) where it is absent.
fn real_programs() -> Vec<(String, Vec<u8>)> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/gcode");
    let Ok(entries) = std::fs::read_dir(&folder) else {
        let _ = writeln!(
            std::io::stderr(),
            "SKIPPED: no shared data beside the checkout, the real programs were not read in parts"
        );
        return Vec::new();
    };
    let paths = entries.map(|entry| entry.unwrap().path());
    let gcode = paths.filter(|path| path.extension().is_some_and(|end| end == "gcode"));
    let named = gcode.map(|path| (path.display().to_string(), std::fs::read(&path).unwrap()));
    let mut programs: Vec<(String, Vec<u8>)> = named.collect();
    programs.sort();
    assert!(programs.len() >= 8, "the shared data has become smaller");
    programs
}

/// Modes, offsets, units, increments, arcs, dwells, tape marks and line endings of all kinds.
const MODES: &str = "%\r\nO0007\r\nG21 G90 G17 (part)\r\nG0 X0 Y0 Z5\r\nG1 Z-1 F300\r\nX10\rY10\nG2 X20 Y0 I0 J-10 F600\n\
G1 G91 X1 Y1\nX1 Y-1\nG90 G92 X0\nX5 Y5\n(still)\nG4 P1\nG20\nX1 Y1 F20\nG93 X2 F3\nX3 F2\nG94 F25\nG21\nY3 F500\nG92.1\n\
G54 X1\nG0 Z5\nS1000 M3\nG1 Z-1\nG3 X11 I5 J0\nX1 I-5\nG1 X7\nM5\nM2\n%\nnobody reads this\n";

fn programs() -> Vec<(String, Vec<u8>)> {
    let mut all = real_programs();
    let lines: String = (0..400)
        .map(|i| format!("G1 X{:.3} Y{:.3}\n", f64::from(i % 20), 0.3 * f64::from(i)))
        .collect();
    all.push(("modes".to_owned(), MODES.as_bytes().to_vec()));
    let zigzag = format!("G21 G90 G0 X0 Y0 Z2\nG1 Z0 F1000\n{lines}G0 Z5\nM30\n");
    all.push(("zigzag".to_owned(), zigzag.into_bytes()));
    all
}

fn readings() -> ReadOptions {
    let mut reading = ReadOptions::default();
    reading.units = Some(Units::Millimetres);
    reading
}

fn length(own: usize, beside: usize) -> PartLength {
    PartLength { own, beside }
}

/// The whole path and what a survey says, of programs that can be read; the others are refused on the same line.
fn whole(name: &str, text: &[u8], reading: &ReadOptions) -> Option<(Program, Path, Survey)> {
    let survey = Survey::of(text, reading, PartLength::default());
    let read = Program::read(text);
    let read = read.and_then(|program| interpret(&program, reading).map(|path| (program, path)));
    match (read, survey) {
        (Ok((program, path)), Ok(survey)) => Some((program, path, survey)),
        (Err(error), Err(PartError::Program(found))) => {
            // A survey goes line by line: it finds the first fault of all, where the whole first tells what it cannot divide into
            // words.
            let first = &faults(text, reading)[0];
            assert_eq!(first.line, found.line, "{name}");
            assert!(found.line <= error.line, "{name}");
            None
        }
        (path, survey) => panic!("{name}: {:?} {:?}", path.err(), survey.err()),
    }
}

#[test]
fn a_survey_tells_what_the_whole_does() {
    let reading = readings();
    let mut read = 0;
    for (name, text) in programs() {
        let Some((program, path, survey)) = whole(&name, &text, &reading) else {
            continue;
        };
        read += 1;
        assert_eq!(survey.lines, program.line_count(), "{name}");
        assert_eq!(survey.blocks, program.block_count(), "{name}");
        assert_eq!(survey.bytes, text.len() as u64, "{name}");
        assert_eq!(survey.moves, path.moves.len(), "{name}");
        assert_eq!(survey.stated, path.stated, "{name}");
        assert_eq!(survey.warnings, path.warnings, "{name}");
        let feed = path.moves.iter().filter(|motion| motion.is_known_feed());
        let feed_mm: f64 = feed.map(Move::length_mm).sum();
        assert!((survey.feed_mm - feed_mm).abs() <= 1e-9 * feed_mm, "{name}");
    }
    assert!(read >= 2);
}

#[test]
fn moves_of_parts_are_those_of_the_whole_bit_by_bit() {
    let reading = readings();
    for (name, text) in programs() {
        let Some((_, path, _)) = whole(&name, &text, &reading) else {
            continue;
        };
        for (own, beside) in [(1, 0), (2, 3), (7, 7), (50, 1), (1000, 64)] {
            if text.len() > 200_000 && own < 50 {
                continue;
            }
            let (mut moves, mut next, mut pauses) = (Vec::new(), 1, 0);
            let survey = Survey::of(text.as_slice(), &reading, length(own, beside)).unwrap();
            for part in Parts::of(&survey, &reading).in_order(Cursor::new(&text)) {
                let part = part.unwrap_or_else(|error| panic!("{name}: {error}"));
                assert_eq!(part.first_line(), next, "{name}");
                next = part.next_line();
                let own_moves = part.path.own_moves();
                assert_eq!(
                    part.path.part.as_ref().unwrap().moves_before + own_moves.start,
                    moves.len()
                );
                let lines = part.first_line()..part.next_line();
                pauses += part
                    .path
                    .pauses
                    .iter()
                    .filter(|p| lines.contains(&p.line))
                    .count();
                moves.extend_from_slice(&part.path.moves[own_moves]);
            }
            assert_eq!(next, survey.lines + 1, "{name}");
            assert_eq!(pauses, path.pauses.len(), "{name}");
            // Debug tells every bit of a number.
            assert!(
                format!("{moves:?}") == format!("{:?}", path.moves),
                "{name}, {own} lines"
            );
        }
    }
}

/// Written and checked part by part.
fn in_parts(
    (name, text): (&str, &[u8]),
    field: &dyn CorrectionField,
    (reading, writing): (&ReadOptions, &WriteOptions),
    length: PartLength,
) -> (Vec<u8>, usize) {
    let survey = Survey::of(text, reading, length).unwrap();
    let order = PartsInOrder::from(0, WrittenSoFar::nothing(&survey, reading));
    let mut bytes = Vec::new();
    let mut pieces = 0;
    let parts = Parts::of(&survey, reading).in_order(Cursor::new(text));
    for (index, part) in parts.enumerate() {
        let part = part.unwrap();
        let place = order.place(index);
        let program = GcodePart {
            part: &part,
            place: &place,
        };
        let written = program.write(field, writing, &Unwatched).unwrap();
        let found = program.verify(&written, writing);
        let found = found.unwrap_or_else(|error| {
            panic!(
                "{name}: {error}\n{}",
                String::from_utf8_lossy(&written.bytes)
            )
        });
        assert_eq!(found.moves, written.pieces.len());
        assert_eq!(written.pieces_before(), pieces);
        pieces += written.pieces.len();
        assert_eq!(place.wait_for_turn(), Standing::Next);
        bytes.extend_from_slice(&written.bytes);
        place.taken();
    }
    (bytes, pieces)
}

/// A smooth field of some tenths of a millimetre.
fn smooth(request: &Request) -> Result<Vector3<f64>, FieldFailure> {
    let p = request.position_mm / 60.0;
    let field = Vector3::new(
        (p.x + p.y).sin(),
        (p.y - p.z).cos(),
        (0.7 * p.x + 1.0).sin(),
    );
    Ok(0.1 * field)
}

/// A field that turns with the feed: it jumps at corners.
fn beside_the_feed(request: &Request) -> Result<Vector3<f64>, FieldFailure> {
    let along = request.tangent.unwrap_or_default();
    Ok(Vector3::z().cross(&along) * 0.05 + 1e-4 * request.position_mm)
}

#[test]
fn what_is_written_in_parts_is_what_is_written_of_the_whole() {
    let reading = readings();
    let mut written_anew = 0;
    let mut wide = WriteOptions::default();
    wide.tolerance_mm = 0.01;
    let mut straight = wide.clone();
    straight.arcs = Arcs::Lines;
    let fields: [&dyn CorrectionField; 2] = [&smooth, &beside_the_feed];
    for (name, text) in programs() {
        let Some((program, path, _)) = whole(&name, &text, &reading) else {
            continue;
        };
        if text.len() > 200_000 {
            continue;
        }
        for (field, writing) in fields.iter().zip([&wide, &straight]) {
            let all = write_corrected(&program, &path, *field, writing, &Unwatched);
            let Ok(all) = all else { continue };
            written_anew += 1;
            for (own, beside) in [(40, 8), (333, 20)] {
                let found = in_parts(
                    (&name, &text),
                    *field,
                    (&reading, writing),
                    length(own, beside),
                );
                assert_eq!(found.1, all.pieces.len(), "{name}");
                let same = found.0 == all.bytes;
                assert!(
                    same,
                    "{name}, {own} lines: {}",
                    first_difference(&found.0, &all.bytes)
                );
            }
        }
    }
    assert!(written_anew >= 4);
}

fn first_difference(a: &[u8], b: &[u8]) -> String {
    let [a, b] = [a, b].map(|bytes| String::from_utf8_lossy(bytes).into_owned());
    let both = a.lines().zip(b.lines()).enumerate();
    let found = both.into_iter().find(|(_, (a, b))| a != b);
    format!("{found:?}")
}

#[test]
fn an_interrupted_program_is_written_on_from_the_state_that_was_kept() {
    let reading = readings();
    let writing = WriteOptions::default();
    let (_, text) = programs().pop().unwrap();
    let survey = Survey::of(text.as_slice(), &reading, length(50, 8)).unwrap();
    let (whole, _) = in_parts(
        ("zigzag", &text),
        &smooth,
        (&reading, &writing),
        length(50, 8),
    );
    for stop in [1, 4, 7] {
        let mut order = PartsInOrder::from(0, WrittenSoFar::nothing(&survey, &reading));
        let mut bytes = Vec::new();
        let mut kept = None;
        let parts = Parts::of(&survey, &reading).in_order(Cursor::new(&text));
        for (index, part) in parts.enumerate() {
            let part = part.unwrap();
            if index == stop {
                // All that is left are the bytes and the state of the writer.
                let mut so_far = WrittenSoFar::nothing(&survey, &reading);
                so_far
                    .go_on(bytes.as_slice(), kept.take().unwrap())
                    .unwrap();
                order = PartsInOrder::from(stop, so_far);
            }
            let place = order.place(index);
            let program = GcodePart {
                part: &part,
                place: &place,
            };
            let written = program.write(&smooth, &writing, &Unwatched).unwrap();
            program.verify(&written, &writing).unwrap();
            bytes.extend_from_slice(&written.bytes);
            kept = written.writer.map(|writer| *writer);
            place.taken();
        }
        assert!(bytes == whole);
    }
}

/// One of several threads: every so often it writes its part with other corrections first, as a run does whose check finds that a
/// part is to be divided again.
fn one_of_several<'a>(
    order: &PartsInOrder<'a>,
    parts: &Mutex<impl Iterator<Item = (usize, Part)>>,
    writing: &WriteOptions,
    (bytes, agains): (&Mutex<Vec<u8>>, &AtomicUsize),
    (seed, every): (usize, usize),
) {
    let strong = |request: &Request| smooth(request).map(|correction| 3.0 * correction);
    let mut random = seed;
    loop {
        let next = parts.lock().unwrap().next();
        let Some((index, part)) = next else { return };
        loop {
            let place = order.place(index);
            let program = GcodePart {
                part: &part,
                place: &place,
            };
            random = random
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            std::thread::sleep(std::time::Duration::from_micros((random >> 54) as u64));
            let write = |field: &dyn CorrectionField| {
                let written = program.write(field, writing, &Unwatched)?;
                program.verify(&written, writing)?;
                Ok::<_, WriteError>(written)
            };
            if index % every == 0 && write(&strong).is_ok() {
                std::thread::sleep(std::time::Duration::from_micros((random >> 54) as u64));
            }
            // Behind what is written anew it may be wrong, which nobody hears of.
            let written = write(&smooth);
            match place.wait_for_turn() {
                Standing::Next => {
                    let written = written.unwrap();
                    bytes.lock().unwrap().extend_from_slice(&written.bytes);
                    place.taken();
                    break;
                }
                Standing::Again => _ = agains.fetch_add(1, Ordering::Relaxed),
                Standing::Ended => panic!("nobody ended it"),
            }
        }
    }
}

#[test]
fn parts_that_are_worked_on_side_by_side_are_written_one_behind_the_other() {
    let reading = readings();
    let writing = WriteOptions::default();
    let (mut agains, mut written) = (0, 0);
    for (name, text) in programs() {
        let Some((program, path, _)) = whole(&name, &text, &reading) else {
            continue;
        };
        let all = write_corrected(&program, &path, &smooth, &writing, &Unwatched);
        if text.len() > 200_000 || all.is_err() {
            continue;
        }
        written += 1;
        let length = length(30, 8);
        let (wanted, _) = in_parts((&name, &text), &smooth, (&reading, &writing), length);
        let survey = Survey::of(text.as_slice(), &reading, length).unwrap();
        // One that writes every third part anew, and one that never does.
        for (threads, every) in [(4, 3), (3, usize::MAX)] {
            let order = PartsInOrder::from(0, WrittenSoFar::nothing(&survey, &reading));
            let parts = Parts::of(&survey, &reading).in_order(Cursor::new(&text));
            let parts = Mutex::new(parts.map(Result::unwrap).enumerate());
            let (bytes, again) = (Mutex::default(), AtomicUsize::new(0));
            std::thread::scope(|scope| {
                for seed in 0..threads {
                    let (order, parts, writing, to) = (&order, &parts, &writing, (&bytes, &again));
                    scope.spawn(move || one_of_several(order, parts, writing, to, (seed, every)));
                }
            });
            assert!(bytes.into_inner().unwrap() == wanted, "{name}");
            agains += again.into_inner();
        }
    }
    assert!(agains > 0, "no part was done again");
    assert!(written >= 2, "{written} programs");
}

#[test]
fn nobody_waits_for_a_part_that_failed() {
    let reading = readings();
    let (_, text) = programs().pop().unwrap();
    let survey = Survey::of(text.as_slice(), &reading, length(30, 8)).unwrap();
    let order = PartsInOrder::from(0, WrittenSoFar::nothing(&survey, &reading));
    let parts = Parts::of(&survey, &reading);
    let third = parts.read(2, Cursor::new(&text)).unwrap();
    std::thread::scope(|scope| {
        let waiting = scope.spawn(|| {
            let place = order.place(2);
            let program = GcodePart {
                part: &third,
                place: &place,
            };
            let written = program.write(&smooth, &WriteOptions::default(), &Unwatched);
            (written.unwrap_err(), place.wait_for_turn())
        });
        order.end();
        let (error, standing) = waiting.join().unwrap();
        assert!(matches!(error, WriteError::Cancelled), "{error}");
        assert_eq!(standing, Standing::Ended);
    });
    assert!(order.has_ended() && order.taken() == 0);
}

/// A part is looked for where it was, and known by its bytes.
#[test]
fn a_text_that_was_changed_is_not_read_in_parts() {
    let reading = readings();
    let (_, text) = programs().pop().unwrap();
    let survey = Survey::of(text.as_slice(), &reading, length(30, 8)).unwrap();
    let parts = Parts::of(&survey, &reading);
    let count = survey.part_count();
    let changed = |text: &[u8]| -> Vec<usize> {
        let is_changed = |index: &usize| {
            let part = parts.read(*index, Cursor::new(text));
            matches!(part, Err(PartError::Changed))
        };
        (0..count).filter(is_changed).collect()
    };
    assert_eq!(count, 14);
    assert!(changed(&text).is_empty());
    assert!(matches!(
        parts.read(count, Cursor::new(&text)),
        Err(PartError::Changed)
    ));
    // Line 66 is the sixth of the third part, and beside the second.
    let line = |number: usize| {
        let ends = text.iter().enumerate().filter(|(_, byte)| **byte == b'\n');
        ends.map(|(at, _)| at + 1).nth(number - 2).unwrap()
    };
    let mut other = text.clone();
    other[line(66) + 4] = b'9';
    assert_ne!(other, text);
    assert_eq!(changed(&other), [1, 2]);
    other.clone_from(&text);
    other.extend_from_slice(b"(more)\n");
    assert_eq!(changed(&other), [count - 1]);
    other.truncate(line(300));
    assert_eq!(changed(&other), (9..count).collect::<Vec<_>>());
}
