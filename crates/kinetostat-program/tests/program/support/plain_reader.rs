//! A reader of programs that shares no code with the crate.

use nalgebra::Vector3;

use super::{LENGTHS, MACHINE_ZERO, REFERENCES, START, WORK};
use crate::sampled::WrittenArc;

/// A motion as the plain reader sees it.
#[derive(Debug)]
pub struct Reached {
    pub place: Vector3<f64>,
    pub speed: Option<f64>,
    pub line: usize,
    pub arc: Option<WrittenArc>,
}

/// The centre from which both ends are a radius away, on the side that the sign and the way round say: seen along the chord,
/// a centre to the left is that of a short way counter-clockwise.
fn centre_by_radius(
    [from, to]: [Vector3<f64>; 2],
    plane: [usize; 3],
    clockwise: bool,
    radius: f64,
) -> [f64; 2] {
    let [first, second, _] = plane;
    let along = [to[first] - from[first], to[second] - from[second]];
    let chord = along[0].hypot(along[1]);
    let away = (radius * radius - 0.25 * chord * chord).max(0.0).sqrt();
    let to_left = (radius > 0.0) != clockwise;
    let left = [-along[1] / chord, along[0] / chord];
    let sign = if to_left { away } else { -away };
    [
        0.5 * (from[first] + to[first]) + sign * left[0],
        0.5 * (from[second] + to[second]) + sign * left[1],
    ]
}

/// Runs the text on the machine, with none of the crate's code: where its motions end.
pub fn read_plainly(text: &str) -> Vec<Reached> {
    let mut reached = Vec::new();
    let mut place = Vector3::from(START);
    let (mut here, mut work) = (Vector3::zeros(), Vector3::from(WORK[0]));
    let (mut scale, mut incremental, mut speed) = (1.0, false, None);
    let mut tool = 0_usize;
    let (mut mode, mut plane, mut absolute_centre) = (0, [0, 1, 2], false);
    for (index, line) in text.trim_start_matches('\u{feff}').lines().enumerate() {
        let mut bare = String::new();
        let mut inside = false;
        for character in line.to_uppercase().chars() {
            match character {
                ';' if !inside => break,
                '(' => inside = true,
                ')' => inside = false,
                ' ' | '\t' | '/' => {}
                _ if inside => {}
                _ => bare.push(character),
            }
        }
        if ["M862", "M115", "M117", "%", "O"]
            .iter()
            .any(|start| bare.starts_with(start))
        {
            continue;
        }
        let mut words: Vec<(char, f64)> = Vec::new();
        let mut rest = bare.as_str();
        while let Some(letter) = rest.chars().next() {
            let end = rest[1..]
                .find(|c: char| c.is_ascii_alphabetic())
                .map_or(rest.len(), |end| end + 1);
            words.push((
                letter,
                rest[1..end].parse().unwrap_or_else(|_| panic!("{line:?}")),
            ));
            rest = &rest[end..];
        }
        let get = |letter: char| {
            words
                .iter()
                .find(|(found, _)| *found == letter)
                .map(|(_, value)| *value)
        };
        let mut is_here = false;
        // Reference point of G28 and G30; zero of G53.
        let mut machine: Option<([f64; 3], bool)> = None;
        for (letter, value) in &words {
            match (letter, value.to_string().as_str()) {
                ('G', "20") => scale = 25.4,
                ('G', "21") => scale = 1.0,
                ('G', "0") => mode = 0,
                ('G', "1") => mode = 1,
                ('G', "2") => mode = 2,
                ('G', "3") => mode = 3,
                ('G', "17") => plane = [0, 1, 2],
                ('G', "18") => plane = [2, 0, 1],
                ('G', "19") => plane = [1, 2, 0],
                ('G', "90.1") => absolute_centre = true,
                ('G', "91.1") => absolute_centre = false,
                ('G', "90") => incremental = false,
                ('G', "91") => incremental = true,
                ('G', "54") => work = Vector3::from(WORK[0]),
                ('G', "55") => work = Vector3::from(WORK[1]),
                ('G', "28") => machine = Some((REFERENCES[0], false)),
                ('G', "30") => machine = Some((REFERENCES[1], false)),
                ('G', "53") => machine = Some(([0.0; 3], true)),
                ('G', "43" | "49") => {
                    let next = get('H').unwrap_or(0.0) as usize;
                    place.z += LENGTHS[tool] - LENGTHS[next];
                    tool = next;
                }
                ('G', "92") => is_here = true,
                ('G', "92.1") => here = Vector3::zeros(),
                _ => {}
            }
        }
        let coordinates = ['X', 'Y', 'Z'].map(get);
        if is_here {
            for axis in 0..3 {
                if let Some(value) = coordinates[axis] {
                    here[axis] = place[axis] - work[axis] - value * scale;
                }
            }
            continue;
        }
        if let Some(value) = get('F') {
            speed = Some(value);
        }
        if let Some((point, counts)) = machine {
            let all = !counts && coordinates.iter().all(Option::is_none);
            for axis in (0..3).filter(|axis| all || coordinates[*axis].is_some()) {
                let word = coordinates[axis].filter(|_| counts).unwrap_or(0.0);
                let length = if axis == 2 { LENGTHS[tool] } else { 0.0 };
                place[axis] = MACHINE_ZERO[axis] + point[axis] + word * scale - length;
            }
            reached.push(Reached {
                place,
                speed,
                line: index + 1,
                arc: None,
            });
            continue;
        }
        // A piece so short that rounding leaves nothing to move may still have its share of E.
        if coordinates.iter().all(Option::is_none) && get('E').is_none() {
            continue;
        }
        let from = place;
        for axis in 0..3 {
            if let Some(value) = coordinates[axis] {
                let origin = if incremental {
                    place[axis]
                } else {
                    work[axis] + here[axis]
                };
                place[axis] = origin + value * scale;
            }
        }
        reached.push(Reached {
            place,
            speed,
            line: index + 1,
            arc: (mode > 1).then(|| {
                let origin = match absolute_centre {
                    true => work + here,
                    false => from,
                };
                let words = ['I', 'J', 'K'].map(get);
                let [first, second, _] = plane;
                let given = |axis: usize| origin[axis] + words[axis].unwrap_or(0.0) * scale;
                let centre = match get('R') {
                    None => [given(first), given(second)],
                    Some(radius) => {
                        centre_by_radius([from, place], plane, mode == 2, radius * scale)
                    }
                };
                WrittenArc {
                    axes: plane,
                    centre,
                    clockwise: mode == 2,
                }
            }),
        });
    }
    reached
}
