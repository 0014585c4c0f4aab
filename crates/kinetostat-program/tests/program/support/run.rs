//! Each operation of the generator.

use super::WORK;
use super::generator::Generator;
use super::operations::{Op, REMARKS};

impl Generator<'_> {
    /// The text does not say where the tool is.
    pub(super) fn is_lost(&self) -> bool {
        self.known != [true; 3]
    }

    pub(super) fn run(&mut self, op: &Op) {
        match op.clone() {
            Op::Reference { second, by } => self.reference(second, by),
            Op::Machine(to) => self.machine(to),
            Op::Length { tool, height } => self.length(tool, height),
            Op::Arc { .. } if self.is_lost() => {
                // States all axes again.
                let to = [Some(11.0), Some(-7.0), Some(5.0)];
                self.straight((false, to), None, None, false);
            }
            Op::Straight {
                feed,
                to,
                speed,
                extruded,
                pause,
            } => self.straight((feed, to), speed, extruded, pause),
            Op::Arc {
                clockwise,
                radius,
                angle,
                sweep,
                rise,
                by_radius,
                full,
                speed,
            } => {
                self.arc(
                    clockwise, radius, angle, sweep, rise, by_radius, full, speed,
                );
            }
            Op::Incremental(on) => {
                self.incremental = on;
                self.push(&[if on { "G91" } else { "G90" }.to_owned()]);
                // Both kinds of firmware agree again.
                let word = if self.relative_extruder { "M83" } else { "M82" };
                self.push(&[word.to_owned()]);
            }
            Op::AbsoluteCentre(on) => {
                self.absolute_centre = on;
                self.push(&[if on { "G90.1" } else { "G91.1" }.to_owned()]);
            }
            Op::Plane(plane) => {
                self.plane = plane;
                self.push(&[format!("G{}", 17 + plane)]);
            }
            Op::Inches(on) => {
                if on != self.inches {
                    self.speed_known = false;
                    self.extruder *= if on { 1.0 / 25.4 } else { 25.4 };
                }
                self.inches = on;
                self.push(&[if on { "G20" } else { "G21" }.to_owned()]);
            }
            Op::InverseTime(on) => {
                if on != self.inverse_time {
                    self.speed_known = false;
                }
                self.inverse_time = on;
                self.push(&[if on { "G93" } else { "G94" }.to_owned()]);
            }
            Op::RelativeExtruder(on) => {
                self.relative_extruder = on;
                self.push(&[if on { "M83" } else { "M82" }.to_owned()]);
            }
            Op::Work(work) => {
                self.work = work;
                self.push(&[format!("G{}", 54 + work)]);
            }
            Op::Here(coordinates) => self.here(coordinates),
            Op::ForgetHere => {
                self.here = [0.0; 3];
                self.push(&["G92.1".to_owned()]);
            }
            Op::Remark(index) => {
                if REMARKS[index] == "F777" {
                    if self.inverse_time {
                        return;
                    }
                    self.speed_known = true;
                }
                self.lines.push(REMARKS[index].to_owned());
            }
        }
    }

    /// G92.
    fn here(&mut self, mut coordinates: [Option<f64>; 3]) {
        for axis in (0..3).filter(|axis| !self.known[*axis]) {
            coordinates[axis] = None;
        }
        if coordinates.iter().all(Option::is_none) {
            return;
        }
        let mut words = vec!["G92".to_owned()];
        for axis in 0..3 {
            if let Some(coordinate) = coordinates[axis] {
                let (text, value) = self.number(coordinate / self.scale());
                words.push(format!("{}{text}", ["X", "Y", "Z"][axis]));
                self.here[axis] = self.place[axis] - WORK[self.work][axis] - value * self.scale();
            }
        }
        self.push(&words);
    }
}
