//! Prints what programs mean, one line of JSON for each motion, so that another interpreter can be
//! compared with this crate (`validation/scripts/compare_with_linuxcnc.py` does).
//!
//! `moves [--offsets] [--machine] [--correct none|smooth|jumps FOLDER] PROGRAM...`: with `-` the names are read
//! from the standard input. `--offsets` gives each work coordinate system an origin of its own, `--machine` says that the
//! machine's zero is the part's, and where its reference points are,
//! `--correct` writes each program with a made-up field of corrections into the folder and prints the
//! pieces written. Lengths in mm, angles in radians, feeds in mm/min, 1/min or mm per revolution.

use std::error::Error;
use std::io::{BufRead, Write};
use std::path::{Path as FilePath, PathBuf};

use kinetostat_program::*;
use nalgebra::Vector3;

fn main() -> Result<(), Box<dyn Error>> {
    let mut reading = ReadOptions::default();
    let mut correct = None;
    let mut programs = Vec::new();
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--offsets" => {
                for (index, origin) in reading.work_offsets_mm.iter_mut().enumerate() {
                    let k = index as f64;
                    *origin = Some(Vector3::new(12.7 * k, -2.54 * (k + 1.0), 0.254 * k * k));
                }
            }
            "--machine" => {
                reading.machine_zero_mm = Some(Vector3::zeros());
                reading.reference_points_mm = [
                    Some(Vector3::new(-12.5, 60.25, 110.0)),
                    Some(Vector3::new(33.0, -8.75, 95.5)),
                ];
            }
            "--correct" => {
                let field = arguments.next().ok_or("--correct FIELD FOLDER")?;
                let folder = arguments.next().ok_or("--correct FIELD FOLDER")?;
                correct = Some((field, PathBuf::from(folder)));
            }
            "-" => programs.extend(
                std::io::stdin()
                    .lock()
                    .lines()
                    .collect::<Result<Vec<_>, _>>()?,
            ),
            _ => programs.push(argument),
        }
    }
    let mut out = std::io::BufWriter::new(std::io::stdout().lock());
    for name in &programs {
        let text = match &correct {
            None => read(name, &reading).map(|(_, path)| of_path(&path)),
            Some((field, folder)) => corrected(name, &reading, field, folder),
        };
        match text {
            Ok(text) => writeln!(out, "{{\"file\":{name:?},\"error\":null}}\n{text}")?,
            Err(error) => writeln!(
                out,
                "{{\"file\":{name:?},\"error\":{}}}\n",
                quoted(&error.to_string())
            )?,
        }
    }
    Ok(())
}

fn read(name: &str, reading: &ReadOptions) -> Result<(Program, Path), Box<dyn Error>> {
    let program = Program::read(std::fs::read(name)?)?;
    let path = interpret(&program, reading)?;
    Ok((program, path))
}

fn quoted(text: &str) -> String {
    let mut json = String::from("\"");
    for character in text.chars() {
        match character {
            '"' | '\\' => json.extend(['\\', character]),
            _ if character.is_control() => json.push('?'),
            _ => json.push(character),
        }
    }
    json + "\""
}

fn point(point: &Vector3<f64>) -> String {
    format!("[{:?},{:?},{:?}]", point.x, point.y, point.z)
}

fn feed(feed: Option<Feed>) -> String {
    feed.map_or("null".to_owned(), |feed| {
        let mode = match feed.mode {
            FeedMode::PerMinute => "G94",
            FeedMode::InverseTime => "G93",
            FeedMode::PerRevolution => "G95",
        };
        format!("[\"{mode}\",{:?}]", feed.value)
    })
}

fn kind(kind: MoveKind) -> &'static str {
    match kind {
        MoveKind::Rapid => "rapid",
        MoveKind::Feed => "feed",
    }
}

fn knowledge(motion: &Move) -> String {
    let known = match motion.known {
        Knowledge::Whole => "whole",
        Knowledge::End => "end",
        Knowledge::Nothing => "nothing",
    };
    let machine = motion.words.is_to_machine();
    format!("\"knowledge\":\"{known}\",\"machine\":{machine}")
}

fn arc(curve: &Curve) -> String {
    match curve {
        Curve::Line => "null".to_owned(),
        Curve::Arc(arc) => format!(
            "{{\"centre\":{},\"axis\":{},\"sweep\":{:?},\"rise\":{:?}}}",
            point(&arc.centre),
            point(&arc.axis),
            arc.sweep,
            arc.rise
        ),
    }
}

fn of_path(path: &Path) -> String {
    let line = |motion: &Move| {
        let arc = arc(&motion.curve);
        format!(
            "{{\"line\":{},\"kind\":\"{}\",\"start\":{},\"end\":{},\"feed\":{},\"length\":{:?},{},\"arc\":{arc}}}\n",
            motion.line,
            kind(motion.kind),
            point(&motion.start),
            point(&motion.end),
            feed(motion.feed),
            motion.length_mm(),
            knowledge(motion)
        )
    };
    path.moves.iter().map(line).collect()
}

fn corrected(
    name: &str,
    reading: &ReadOptions,
    field: &str,
    folder: &FilePath,
) -> Result<String, Box<dyn Error>> {
    let (program, path) = read(name, reading)?;
    let smooth = |at: &Vector3<f64>| {
        Vector3::new(
            0.21 * (at.x / 31.0).sin() + 0.04,
            0.16 * (at.y / 27.0).cos() - 0.05 * (at.x / 90.0).sin(),
            0.12 * ((at.x + at.y) / 43.0).sin() - 0.002 * at.z,
        )
    };
    let answer = |request: &Request| {
        let at = &request.position_mm;
        Ok(match field {
            "none" => Vector3::zeros(),
            "smooth" => smooth(at),
            // The load turns with the direction of motion, and the stiffness changes at planes.
            _ => {
                let steps = Vector3::new((at.x / 17.0).floor(), (at.y / 11.0).floor(), 0.0) * 0.011;
                smooth(at) + steps + request.tangent.unwrap_or_default() * 0.07
            }
        })
    };
    let writing = WriteOptions::default();
    let written = write_corrected(&program, &path, &answer, &writing, &Unwatched)?;
    verify_written(&program, &path, &written, reading, &writing)?;
    let file = folder.join(
        FilePath::new(name)
            .file_name()
            .ok_or("a program has a name")?,
    );
    std::fs::write(file, &written.bytes)?;
    let again = interpret(&Program::read(written.bytes.clone())?, reading)?;
    let is_arc = |piece: &Piece| piece.kept_arc || piece.arc.is_some();
    let line = |(piece, read): (&Piece, &Move)| {
        let motion = &path.moves[piece.move_index];
        let share = (piece.share_from, piece.share_to);
        format!(
            "{{\"line\":{},\"of\":{},\"kind\":\"{}\",\"start\":{},\"end\":{},\"feed\":{},\"length\":{:?},\
             \"programmed\":{},\"part\":{:?},\"whole\":{:?},\"step\":{},\"known\":{},\"limited\":{},{},\"arc\":{}}}\n",
            piece.output_line,
            motion.line,
            kind(motion.kind),
            point(&piece.commanded_from),
            point(&piece.commanded_to),
            feed(read.feed),
            // A piece is straight, unless an arc was kept as it was or fitted.
            if is_arc(piece) {
                read.length_mm()
            } else {
                (piece.commanded_to - piece.commanded_from).norm()
            },
            feed(motion.feed),
            motion.length_between_mm(share.0, share.1),
            motion.length_mm(),
            piece.corner_step,
            motion.known == Knowledge::Whole,
            piece.feed_limited,
            knowledge(motion),
            arc(if is_arc(piece) {
                &read.curve
            } else {
                &Curve::Line
            })
        )
    };
    Ok(written.pieces.iter().zip(&again.moves).map(line).collect())
}
