//! Programs made of a path: read again by the readers of their languages and compared with the path here, apart from the
//! comparison that `make` does itself.

mod arcs;
mod comments;
mod ends;
mod events;
mod hidden;
mod machine_words;
mod machines;
mod of_robots;
mod parts;
mod properties;
mod reconfigured;
mod refused;
mod round_trips;
mod running;
mod same_language;
mod statements;
mod tools;

use kinetostat_formats::*;
use kinetostat_program::{Path, Program, ReadOptions as Reading, interpret};
use nalgebra::{UnitQuaternion, Vector3};

pub const ROBOTS: [(MakeLanguage, Language); 3] = [
    (MakeLanguage::Krl, Language::Krl),
    (MakeLanguage::Rapid, Language::Rapid),
    (MakeLanguage::FanucLs, Language::FanucLs),
];

pub fn gcode(text: &str) -> (Program, Path) {
    let program = Program::read(text).unwrap();
    let path = interpret(&program, &Reading::default()).unwrap();
    (program, path)
}

/// The tool's z points down, and it is turned a little, so that no angle is a round number.
pub fn turned() -> UnitQuaternion<f64> {
    let down = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI);
    down * UnitQuaternion::from_euler_angles(0.02, -0.31, 1.234_567_890_123)
}

pub fn cell() -> Template {
    let mut template = Template::default();
    template.tool_orientation = Some(turned());
    template
}

pub fn made(text: &str, template: &Template, language: MakeLanguage) -> Made {
    let (program, path) = gcode(text);
    make(&path, &events_of_gcode(&program, &path), template, language).unwrap()
}

/// A robot's program in another language, without a template.
pub fn of_robot(from: Language, text: &str, into: MakeLanguage) -> Made {
    let files = vec![SourceFile::new("source", text)];
    let program = read(from, files, &ReadOptions::default()).unwrap();
    let robot = path_of(&program, &PathOptions::default()).unwrap();
    make_of_robot(&program, &robot, &cell(), into).unwrap()
}

pub fn found(made: &Made, words: &str) -> bool {
    let mut findings = made.findings.iter();
    findings.any(|finding| finding.message.contains(words))
}

pub fn text_of(made: &Made, file: usize) -> String {
    String::from_utf8(made.files[file].1.clone()).unwrap()
}

pub fn read_made(made: &Made, language: Language) -> RobotProgram {
    let files = made
        .files
        .iter()
        .map(|(name, bytes)| SourceFile::new(name.clone(), bytes.clone()));
    read(language, files.collect(), &ReadOptions::default()).unwrap()
}
