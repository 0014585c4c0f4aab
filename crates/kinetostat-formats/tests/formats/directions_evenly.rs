//! Directions of the tool between which the rotary axes turn evenly, in three languages: random programs, corrected, against a control
//! and machines that are written here.
//!
//! The control reads the directions of the written text, takes the nearest angles and turns each axis evenly; the tool stands as closed
//! forms say. In every piece it must stand as in the undivided block of the input, and its tip must be where the field wants it.

use std::collections::BTreeMap;
use std::sync::Arc;

use kinetostat_formats::*;
use kinetostat_program::{
    Carries, Corrected, CorrectionField, MachineProgram, Path, Program,
    ReadOptions as GcodeReading, Request, RotaryAxes, RotaryAxis, Unwatched,
    WriteOptions as PathWriteOptions, interpret, verify_written, write_corrected,
};
use kinetostat_testing::Worst;
use nalgebra::{Unit, UnitQuaternion, Vector3};

use crate::chance::Chance;

/// Random programs for each machine and language; of 800 one in eighty is refused, for a tilt of a thousandth of a degree over the pole.
const SEEDS: u64 = 40;

/// A machine of this test: a tilt axis and C.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Machine {
    /// B on C, both heads.
    Fork,
    /// A head about x above a table that turns the part about -z.
    Portal,
    /// A cradle about x that carries a table about z.
    Cradle,
}

const MACHINES: [Machine; 3] = [Machine::Fork, Machine::Portal, Machine::Cradle];

impl Machine {
    /// The letters of the tilt axis and of the other one.
    fn letters(self) -> [char; 2] {
        match self {
            Self::Fork => ['B', 'C'],
            Self::Portal | Self::Cradle => ['A', 'C'],
        }
    }

    /// The tool's axis in the part at angles of the tilt axis and of C, deg, by hand.
    fn axis(self, [tilt, c]: [f64; 2]) -> Vector3<f64> {
        let (tilt, c) = (tilt.to_radians(), c.to_radians());
        match self {
            // Rz(c) Ry(b) z
            Self::Fork => Vector3::new(tilt.sin() * c.cos(), tilt.sin() * c.sin(), tilt.cos()),
            // Rz(c) Rx(a) z
            Self::Portal => Vector3::new(tilt.sin() * c.sin(), -tilt.sin() * c.cos(), tilt.cos()),
            // Rz(-c) Rx(-a) z
            Self::Cradle => Vector3::new(tilt.sin() * c.sin(), tilt.sin() * c.cos(), tilt.cos()),
        }
    }

    /// The angles that a control takes for a direction: of both sets of angles and all their turns within the limits of C, the nearest.
    /// None where two are as near.
    fn towards(self, d: &Vector3<f64>, from: [f64; 2], limits: [f64; 2]) -> Option<[f64; 2]> {
        let d = d.normalize();
        let across = d.x.hypot(d.y);
        let tilt = across.atan2(d.z).to_degrees();
        let azimuth = match self {
            Self::Fork => d.y.atan2(d.x),
            Self::Portal => d.x.atan2(-d.y),
            Self::Cradle => d.x.atan2(d.y),
        };
        let azimuth = azimuth.to_degrees();
        let mut found: Vec<(f64, [f64; 2])> = Vec::new();
        for [tilt, c] in [[tilt, azimuth], [-tilt, azimuth + 180.0]] {
            let turns = (-4..=4).map(|turn| c + 360.0 * f64::from(turn));
            let turns: Vec<f64> = match across < 1e-7 {
                true => vec![from[1]],
                false => turns.collect(),
            };
            for c in turns {
                if (limits[0] - 1e-6..=limits[1] + 1e-6).contains(&c) {
                    let way = (tilt - from[0]).abs() + (c - from[1]).abs();
                    found.push((way, [tilt, c]));
                }
            }
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        let [(first, angles), rest @ ..] = found.as_slice() else {
            return None;
        };
        let same = rest.iter().take(1).any(|(way, other)| {
            let apart = (other[0] - angles[0]).abs() + (other[1] - angles[1]).abs();
            way - first < 1e-3 && apart > 1e-6
        });
        (!same).then_some(*angles)
    }

    fn axes(self, limits: [f64; 2]) -> Arc<RotaryAxes> {
        let (head, table) = (Carries::Tool, Carries::Part);
        let (x, y, z) = (Vector3::x(), Vector3::y(), Vector3::z());
        let axis = |letter, carries, direction: Vector3<f64>, limits_deg| RotaryAxis {
            letter,
            carries,
            direction: Unit::new_normalize(direction),
            point_mm: Vector3::new(3.0, -5.0, -40.0),
            limits_deg,
        };
        let axes = match self {
            Self::Fork => vec![axis('C', head, z, Some(limits)), axis('B', head, y, None)],
            Self::Portal => vec![axis('A', head, x, None), axis('C', table, -z, Some(limits))],
            Self::Cradle => vec![axis('A', table, x, None), axis('C', table, z, Some(limits))],
        };
        Arc::new(RotaryAxes {
            axes,
            tool_at_zero: UnitQuaternion::identity(),
        })
    }
}

/// The three languages.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Dialect {
    Gcode,
    Siemens,
    Heidenhain,
}

const DIALECTS: [Dialect; 3] = [Dialect::Gcode, Dialect::Siemens, Dialect::Heidenhain];

impl Dialect {
    fn words(self) -> [&'static str; 3] {
        match self {
            Self::Gcode => ["I", "J", "K"],
            Self::Siemens => ["A3=", "B3=", "C3="],
            Self::Heidenhain => ["TX", "TY", "TZ"],
        }
    }

    fn program(self, machine: Machine, rows: &[Row]) -> String {
        let [tilt, c] = machine.letters();
        let [i, j, k] = self.words();
        let mut text = match self {
            Self::Gcode => format!("G21 G90 G94\nG0 X0 Y0 Z50 {tilt}0 {c}0\nG43.5 H1 X0 Y0 Z50\n"),
            Self::Siemens => "G90 G71 G94 G17\nTRAORI\nORIAXES\n".to_owned(),
            Self::Heidenhain => {
                format!("BEGIN PGM A MM\nL X+0 Y+0 Z+50 {tilt}+0 {c}+0 R0 FMAX\nM128\n")
            }
        };
        for (
            index,
            Row {
                place: [x, y, z],
                direction: d,
            },
        ) in rows.iter().enumerate()
        {
            text += &match (self, index) {
                (Self::Gcode, 0) => format!("G0 X{x} Y{y} Z{z} {i}{} {j}{} {k}{}\n", d.x, d.y, d.z),
                (Self::Siemens, 0) => {
                    format!("G0 X{x} Y{y} Z{z} {i}{} {j}{} {k}{}\n", d.x, d.y, d.z)
                }
                (Self::Gcode | Self::Siemens, _) => {
                    format!("G1 X{x} Y{y} Z{z} {i}{} {j}{} {k}{} F600\n", d.x, d.y, d.z)
                }
                (Self::Heidenhain, _) => {
                    let feed = if index == 0 { "FMAX" } else { "F600" };
                    format!(
                        "LN X{x:+} Y{y:+} Z{z:+} {i}{:+} {j}{:+} {k}{:+} {feed}\n",
                        d.x, d.y, d.z
                    )
                }
            };
        }
        text + match self {
            Self::Gcode => "G49\nM30\n",
            Self::Siemens => "TRAFOOF\nM30\n",
            Self::Heidenhain => "M129\nEND PGM A MM\n",
        }
    }
}

/// Where a block ends.
struct Row {
    place: [f64; 3],
    direction: Vector3<f64>,
}

/// Random blocks: wide turns of the azimuth, tilts over the pole, beside it and at it.
fn rows(machine: Machine, chance: &mut Chance) -> Vec<Row> {
    let mut tilt = 15.0 + chance.within(10.0);
    let mut azimuth = chance.within(180.0);
    let mut place = [0.0, 0.0, 50.0];
    let mut rows = Vec::new();
    for index in 0..5 {
        if index > 0 {
            azimuth += match chance.below(3) {
                0 => chance.within(350.0),
                1 => 110.0 + chance.within(20.0),
                _ => chance.within(60.0),
            };
            tilt = match chance.below(8) {
                0 => 0.0,
                1 => 0.02,
                2 => 1e-3,
                3 => tilt,
                _ => 30.0 + chance.within(29.0),
            };
            let mut number = |size: f64| (chance.within(size) * 1e3).round() / 1e3;
            place = [number(60.0), number(60.0), number(5.0)];
            if number(1.0) > 0.8 {
                place = rows.last().map_or(place, |row: &Row| row.place);
            }
        }
        let axis = machine.axis([tilt, azimuth]);
        let digits = [1e4, 1e6, 1e9][chance.below(3)];
        let direction = axis.map(|part| (part * digits).round() / digits);
        rows.push(Row { place, direction });
    }
    rows
}

/// What is added to a place of the tip, mm.
fn wanted_shift(place: &Vector3<f64>) -> Vector3<f64> {
    let p = place / 30.0;
    Vector3::new(p.y * p.y, -p.x * p.y, p.x * p.x + p.y) * 0.02
}

fn field() -> impl CorrectionField {
    |request: &Request| Ok(wanted_shift(&request.position_mm))
}

/// A written program, its account and the path of the input.
struct Written {
    corrected: Corrected,
    path: Path,
}

fn written(
    dialect: Dialect,
    axes: &Arc<RotaryAxes>,
    text: &str,
    tolerance_mm: f64,
) -> Result<Written, String> {
    let mut writing = PathWriteOptions::default();
    writing.header = None;
    writing.tolerance_mm = tolerance_mm;
    if dialect == Dialect::Gcode {
        let mut reading = GcodeReading::default();
        reading.rotary = Some(Arc::clone(axes));
        let program = Program::read(text.to_owned()).map_err(|error| error.to_string())?;
        let path = interpret(&program, &reading).map_err(|error| error.to_string())?;
        let corrected = write_corrected(&program, &path, &field(), &writing, &Unwatched)
            .map_err(|error| error.to_string())?;
        verify_written(&program, &path, &corrected, &reading, &writing)
            .map_err(|error| error.to_string())?;
        return Ok(Written { corrected, path });
    }
    let language = match dialect {
        Dialect::Siemens => Language::Siemens,
        _ => Language::Heidenhain,
    };
    let mut reading = ReadOptions::default();
    reading.rotary_axes = axes.axes.iter().map(|axis| axis.letter).collect();
    let mut making = PathOptions::default();
    making.rotary = Some(Arc::clone(axes));
    let first = |all: Vec<String>| all.into_iter().next().unwrap_or_default();
    let program = read(language, vec![SourceFile::new("a.txt", text)], &reading)
        .map_err(|all| first(all.iter().map(ToString::to_string).collect()))?;
    let path = path_of(&program, &making)
        .map_err(|all| first(all.iter().map(ToString::to_string).collect()))?;
    let correctable = Correctable {
        program: &program,
        path: &path,
        reading: &reading,
        making: &making,
        writing: &WriteOptions::default(),
    };
    let corrected = correctable
        .write(&field(), &writing, &Unwatched)
        .map_err(|error| error.to_string())?;
    correctable
        .verify(&corrected, &writing)
        .map_err(|error| error.to_string())?;
    Ok(Written {
        corrected,
        path: path.path,
    })
}

/// Places and directions of the motions of a text, by its line: words that are missing stay as they were.
fn stated(dialect: Dialect, text: &str) -> BTreeMap<usize, (Vector3<f64>, Option<Vector3<f64>>)> {
    let mut place = Vector3::zeros();
    let mut all = BTreeMap::new();
    for (index, line) in text.lines().enumerate() {
        if !line.contains('X') || line.starts_with("G43") {
            // A turn in place names no axis in the pieces of some languages.
            if !dialect.words().iter().all(|word| line.contains(word)) {
                continue;
            }
        }
        let number = |word: &str| -> Option<f64> {
            let words = line.split_whitespace();
            let own = words.filter_map(|own| own.strip_prefix(word));
            let mut numbers = own.filter_map(|number| number.trim_start_matches('=').parse().ok());
            numbers.next()
        };
        for (axis, letter) in ["X", "Y", "Z"].iter().enumerate() {
            place[axis] = number(letter).unwrap_or(place[axis]);
        }
        let [i, j, k] = dialect.words().map(number);
        let direction = match (i, j, k) {
            (None, None, None) => None,
            (i, j, k) => Some(Vector3::new(
                i.unwrap_or(0.0),
                j.unwrap_or(0.0),
                k.unwrap_or(0.0),
            )),
        };
        all.insert(index + 1, (place, direction));
    }
    all
}

/// Angles at both ends of a motion, and where it ends.
type Turned = ([f64; 2], [f64; 2], Vector3<f64>);

/// The angles at the ends of the motions of a text, by its line; none where a control would have to choose between two ways.
fn run(
    (dialect, machine, limits): (Dialect, Machine, [f64; 2]),
    text: &str,
) -> Option<BTreeMap<usize, Turned>> {
    let mut now = [0.0; 2];
    let mut all = BTreeMap::new();
    for (line, (place, direction)) in stated(dialect, text) {
        let from = now;
        if let Some(direction) = direction {
            now = machine.towards(&direction, now, limits)?;
        }
        all.insert(line, (from, now, place));
    }
    Some(all)
}

fn between(from: [f64; 2], to: [f64; 2], part: f64) -> [f64; 2] {
    [0, 1].map(|k| from[k] + (to[k] - from[k]) * part)
}

#[test]
fn pieces_turn_the_axes_as_the_undivided_blocks_do() {
    let tolerance_mm = 0.002;
    let (mut passed, mut refused, mut checked, mut over_poles) = (0, 0, 0, 0);
    let (mut tilted, mut turned, mut off) = (Worst::new(), Worst::new(), Worst::new());
    for seed in 0..SEEDS {
        for machine in MACHINES {
            let mut chance = Chance::new(seed);
            let limits = [[-200.0, 200.0], [-1e4, 1e4]][chance.below(2)];
            let rows = rows(machine, &mut chance);
            for dialect in DIALECTS {
                let text = dialect.program(machine, &rows);
                let of = (dialect, machine, limits);
                let axes = machine.axes(limits);
                let written = match written(dialect, &axes, &text, tolerance_mm) {
                    Ok(written) => written,
                    Err(said) => {
                        let by_line = said.contains("line ") && !said.contains("report");
                        assert!(by_line, "seed {seed} {of:?}: {said}\n{text}");
                        refused += 1;
                        continue;
                    }
                };
                passed += 1;
                let output = String::from_utf8(written.corrected.bytes.clone()).unwrap();
                let (Some(own), Some(again)) = (run(of, &text), run(of, &output)) else {
                    continue;
                };
                for piece in &written.corrected.pieces {
                    let motion = &written.path.moves[piece.move_index];
                    let (Some((a, b, _)), Some((c, d, place))) =
                        (own.get(&motion.line), again.get(&piece.output_line))
                    else {
                        continue;
                    };
                    if !motion.is_known_feed() || piece.corner_step {
                        continue;
                    }
                    over_poles += usize::from(c[0] * d[0] < 0.0);
                    for part in [0.0, 0.1, 0.5, 0.9, 1.0] {
                        let share = piece.share_from + part * (piece.share_to - piece.share_from);
                        let [is, meant] = [between(*c, *d, part), between(*a, *b, share)];
                        tilted.add((machine.axis(is) - machine.axis(meant)).norm());
                        turned.add((is[0] - meant[0]).abs());
                        turned.add((is[1] - meant[1]).abs());
                        checked += 1;
                    }
                    let on_path = motion.start + (motion.end - motion.start) * piece.share_to;
                    off.add((place - on_path - wanted_shift(&on_path)).norm());
                }
            }
        }
    }
    assert!(
        passed > 20 * refused && over_poles > passed / 20,
        "{passed} {refused} {over_poles}"
    );
    assert!(tilted.of(checked) < 1e-4, "the tool leans otherwise");
    assert!(turned.of(2 * checked) < 0.1, "the axes stand otherwise");
    assert!(off.of(checked / 5) < 2e-4);
}
