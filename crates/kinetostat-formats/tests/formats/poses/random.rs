//! Random lists of poses, as tables and as YAML, broken by chance.

use kinetostat_formats::*;
use nalgebra::{UnitQuaternion, Vector3};

use crate::harness::{Chance, Kind, read_files};

pub fn kind() -> Kind {
    let mut options = ReadOptions::default();
    options.length_unit = Some(LengthUnit::Metre);
    Kind {
        turns: true,
        words: &[
            "x_mm,",
            "y_m;",
            "qw,",
            "speed_mm_per_s,",
            "rapid,",
            "time,",
            "\"",
            "#",
            "1,2,3\n",
            ",,",
            "- ",
            "position:",
            "orientation: {w: 1, x: 0, y: 0, z: 0}\n",
            "- [1, 2, 3]\n",
            "{",
            "]",
            ": ",
            "&a ",
            "*a",
            "---\n",
            "|\n",
            "  ",
            "1e-3",
            "-.5",
            "poses:\n",
        ],
        own: turned_where_all_can_be,
        ..Kind::of(Language::Poses, options, |chance| vec![program(chance)])
    }
}

/// Numbers of a pose with names, for a unit of so many mm: places, then the orientation.
struct Pose {
    place: [f64; 3],
    q: UnitQuaternion<f64>,
}

impl Pose {
    fn next(chance: &mut Chance) -> Self {
        let place = [0, 1, 2].map(|_| (chance.within(900.0) * 1e4).round() / 1e4);
        let turn = Vector3::new(chance.within(3.0), chance.within(1.0), chance.within(3.0));
        Self {
            place,
            q: UnitQuaternion::from_scaled_axis(turn),
        }
    }

    /// Values of columns by their names.
    fn value(&self, name: &str) -> String {
        let (roll, pitch, yaw) = self.q.euler_angles();
        let at = |axis: usize, mm: f64| match mm == 1.0 {
            true => format!("{:.4}", self.place[axis]),
            false => format!("{:.7}", self.place[axis] / mm),
        };
        match name {
            "x_mm" => at(0, 1.0),
            "y_mm" => at(1, 1.0),
            "z_mm" => at(2, 1.0),
            "x_m" | "x" => at(0, 1000.0),
            "y_m" | "y" => at(1, 1000.0),
            "z_m" | "z" => at(2, 1000.0),
            "qw" => format!("{:.9}", self.q.w),
            "qx" => format!("{:.9}", self.q.i),
            "qy" => format!("{:.9}", self.q.j),
            "qz" => format!("{:.9}", self.q.k),
            "rx_deg" | "c_deg" => format!("{:.6}", roll.to_degrees()),
            "ry_deg" | "b_deg" => format!("{:.6}", pitch.to_degrees()),
            "rz_deg" | "a_deg" => format!("{:.6}", yaw.to_degrees()),
            "speed_mm_per_s" => "20".to_owned(),
            _ => "note \u{e9}".to_owned(),
        }
    }
}

fn shuffled(chance: &mut Chance, names: &mut [&str]) {
    for at in 0..names.len() {
        let other = chance.below(names.len());
        names.swap(at, other);
    }
}

fn orientation(chance: &mut Chance) -> &'static [&'static str] {
    let all: [&[&str]; 3] = [
        &["qw", "qx", "qy", "qz"],
        &["rx_deg", "ry_deg", "rz_deg"],
        &["a_deg", "b_deg", "c_deg"],
    ];
    all[chance.below(3)]
}

fn table(chance: &mut Chance) -> String {
    let place: [&str; 3] = [["x_m", "y_m", "z_m"], ["x", "y", "z"]][chance.below(2)];
    let mut names = place.to_vec();
    names.extend(orientation(chance));
    if chance.below(2) == 0 {
        names.push("note");
    }
    if chance.below(2) == 0 {
        names.push("speed_mm_per_s");
    }
    let rapid = chance.below(3) == 0;
    shuffled(chance, &mut names);
    let separator = chance.of(&[",", ";", "\t", ", "]);
    let mut text = "# poses\n".to_owned();
    text += &names.join(separator);
    text += match rapid {
        true => [separator, "rapid\n"].concat(),
        false => "\n".to_owned(),
    }
    .as_str();
    for row in 0..=chance.below(9) {
        let pose = Pose::next(chance);
        let mut cells: Vec<String> = names.iter().map(|name| pose.value(name)).collect();
        if rapid {
            cells.push(u8::from(row == 0 || chance.below(3) == 0).to_string());
        }
        text += &cells.join(separator);
        text += chance.of(&["\n", "\n", " \n", "\n\n", "\n# word\n"]);
    }
    text
}

fn yaml(chance: &mut Chance) -> String {
    let mut text = "- header: {stamp: 1, frame_id: \"\"}\n  paths:\n".to_owned();
    for _ in 0..=chance.below(2) {
        text += "    - header:\n        seq: 1\n      poses:\n";
        for _ in 0..=chance.below(5) {
            let pose = Pose::next(chance);
            let (mut place, mut turned) = (["x", "y", "z"], ["qw", "qx", "qy", "qz"]);
            shuffled(chance, &mut place);
            shuffled(chance, &mut turned);
            let in_line = chance.below(3) == 0;
            let map = |names: &[&str]| {
                let pairs = names
                    .iter()
                    .map(|name| format!("{}: {}", name.trim_start_matches('q'), pose.value(name)));
                match in_line {
                    true => format!(" {{{}}}\n", pairs.collect::<Vec<_>>().join(", ")),
                    false => pairs.fold("\n".to_owned(), |text, pair| {
                        format!("{text}            {pair}\n")
                    }),
                }
            };
            let parts = [
                format!("position:{}", map(&place)),
                format!("orientation:{}", map(&turned)),
            ];
            let first = chance.below(2);
            text += &format!("        - {}          {}", parts[first], parts[1 - first]);
        }
    }
    text
}

/// A list that is understood.
pub fn program(chance: &mut Chance) -> String {
    let text = match chance.below(2) {
        0 => table(chance),
        _ => yaml(chance),
    };
    match chance.below(3) {
        0 => text.replace('\n', "\r\n"),
        _ => text,
    }
}

/// Where a pose lost its orientation, none can be turned.
fn turned_where_all_can_be(
    _: &mut Chance,
    kind: &mut Kind,
    files: &[Vec<u8>],
) -> Result<(), String> {
    kind.turns = read_files(kind, files).is_ok_and(|program| {
        (program.motions.iter().enumerate()).all(|(index, motion)| {
            motion.target.pose().is_none_or(|pose| {
                let mut piece = Piece::to(index, Vector3::zeros());
                piece.orientation =
                    Some(pose.orientation * UnitQuaternion::from_euler_angles(0.1, 0.1, 0.1));
                write(&program, &[piece], &WriteOptions::default()).is_ok()
            })
        })
    });
    Ok(())
}
