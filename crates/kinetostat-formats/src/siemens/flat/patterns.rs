//! Patterns of holes under MCALL: HOLES1 (a row) and HOLES2 (a circle), as blocks.
//!
//! HOLES1(SPCA, SPCO, STA1, FDIS, DBH, NUM): a row through (SPCA, SPCO) at the angle STA1 to the first axis of the plane, its first hole FDIS from
//! there, its holes DBH apart. HOLES2(CPA, CPO, RAD, STA1, INDA, NUM): a circle about (CPA, CPO), its first hole at the angle STA1, the
//! others INDA apart; with INDA = 0 they share the circle evenly. Source: Siemens, SINUMERIK 840D sl / 828D, Programming Manual Cycles, "Row
//! of holes - HOLES1", "Circle of holes - HOLES2". From which end a row is drilled the control chooses: the holes are the same.

use crate::siemens::block::{Item, What};
use crate::siemens::flat::runner::{Fault, Runner};
use crate::siemens::place::number_text;
use crate::siemens::values::whole;

/// Limit of the holes of a pattern.
const MOST_HOLES: u32 = 1000;

impl Runner<'_> {
    /// Drills at each place of a pattern by the cycle in force.
    pub(super) fn holes(&mut self, item: &Item) -> Result<(), Fault> {
        let fault = |reason: &str| self.fault(&item.span, reason, "mend the call of the pattern");
        let Some(drilling) = self.drilling.clone() else {
            return Err(fault("no cycle is in force (MCALL)"));
        };
        let What::Call(arguments) = &item.what else {
            return Err(fault("the pattern has no arguments"));
        };
        let mut numbers = [0.0; 6];
        for (number, argument) in numbers.iter_mut().zip(arguments) {
            if let Some(value) = &argument.value {
                *number = self.number(value)?;
            }
        }
        if arguments.len() > numbers.len() {
            return Err(fault("it has more than six arguments"));
        }
        let [first, second, third, fourth, fifth, count] = numbers;
        let Some(count) = whole(count).filter(|count| (1..=MOST_HOLES).contains(count)) else {
            return Err(fault("the number of its holes (NUM) is not from 1 to 1000"));
        };
        let is_row = self.file().part(&item.name).eq_ignore_ascii_case(b"HOLES1");
        let place = |hole: u32| {
            let hole = f64::from(hole);
            let (radius, angle) = match is_row {
                true => (fourth + hole * fifth, third),
                false if fifth == 0.0 => (third, fourth + hole * 360.0 / f64::from(count)),
                false => (third, fourth + hole * fifth),
            };
            let (sine, cosine) = angle.to_radians().sin_cos();
            [first + radius * cosine, second + radius * sine]
        };
        let axes = match self.modes.normal() {
            'X' => ['Y', 'Z'],
            'Y' => ['Z', 'X'],
            _ => ['X', 'Y'],
        };
        for hole in 0..count {
            let words = axes.iter().zip(place(hole));
            let words = words.map(|(axis, at)| format!(" {axis}=AC({})", number_text(at)));
            self.write_line(format!("G0{}", words.collect::<String>()).as_bytes());
            self.drill_here(&drilling)?;
        }
        Ok(())
    }
}
