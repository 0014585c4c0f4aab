//! Everything that is refused in a program.

use std::collections::BTreeSet;

use crate::error::{ProgramError, ProgramErrorKind};
use crate::reading::block::Block;
use crate::reading::interpreting::Interpreter;
use crate::reading::options::{ReadOptions, Units};
use crate::text::library::only_definitions;
use crate::text::program::Program;

/// Everything that is refused in a program, in the order of its lines, at most one fault a line; empty
/// where [`Program::read`] and [`crate::interpret`] take it.
///
/// The understood words of a refused line are followed: its end and its modes. Lines with variables are one fault, at
/// the first of them, with their number.
///
/// ```
/// use kinetostat_program::{ReadOptions, faults};
///
/// let text = "G21 G90\nG0 X0 Y0 Z0\nG41 D1 G1 X10 F100\nG3 X20 Y10 J10\nG1 X[#1]\nY#2\n";
/// let found = faults(text, &ReadOptions::default());
/// assert_eq!(found.iter().map(|fault| fault.line).collect::<Vec<_>>(), [3, 5]);
/// assert!(found[1].reason.contains("on 2 lines"));
/// ```
pub fn faults(bytes: impl Into<Vec<u8>>, options: &ReadOptions) -> Vec<ProgramError> {
    let (program, mut found) = Program::read_with_faults(bytes.into());
    if let Some(library) = only_definitions(program.bytes()) {
        return vec![library];
    }
    let unread: BTreeSet<usize> = found.iter().map(|fault| fault.line).collect();
    let mut interpreter = Interpreter::new(options);
    for index in 0..program.lines().len() {
        let unsure = interpreter.places.unsure;
        let in_plane = interpreter.modes.plane;
        if let Err(fault) = interpreter.run_line(&program, index) {
            take_over_understood(&mut interpreter, &program, index);
            let from_nowhere = in_plane[..2].iter().any(|axis| unsure[*axis]);
            if fault.kind != ProgramErrorKind::Arc || !from_nowhere {
                found.push(fault);
            }
        }
        if unread.contains(&(index + 1)) {
            interpreter.places.doubt();
        }
    }
    if found.is_empty() {
        found.extend(interpreter.finish(&program).err());
    }
    // The stable sort keeps the fault of reading before others of its line.
    found.sort_by_key(|fault| fault.line);
    found.dedup_by_key(|fault| fault.line);
    of_variables_once(found)
}

/// Takes over what is understood of a refused line, so that the lines behind it have no fault because of it.
pub(crate) fn take_over_understood(
    interpreter: &mut Interpreter<'_>,
    program: &Program,
    index: usize,
) {
    interpreter.modes.go_on_after_fault();
    interpreter.places.take_as_known();
    let block = Block::understood(program, index);
    // A fault of the modes is the one that is reported already.
    let _ = interpreter.modes.set(&block);
    let codes = &block.codes;
    if codes.tool_centre_point {
        interpreter.modes.doubt_axes(codes.by_direction);
    }
    let elsewhere = codes.position_offset.is_some() || codes.machine.is_some();
    if block.is_vendor() || elsewhere || codes.dwell && !block.dwells_before_motion() {
        return;
    }
    let plane = interpreter.modes.plane;
    let axes: &[usize] = match ends_of(&block.refused_codes()) {
        Ends::AllAxes => &[0, 1, 2],
        Ends::Plane => &plane[..2],
        Ends::Nowhere => return,
    };
    let offset = interpreter.work_offset_mm() + interpreter.offset.active_mm;
    let unit = interpreter.modes.units().map_or(1.0, Units::mm_per_unit);
    for axis in axes.iter().copied() {
        let Some(value) = block.value(b"XYZ"[axis]) else {
            continue;
        };
        if interpreter.modes.incremental {
            interpreter.places.position[axis] += value * unit;
        } else {
            interpreter.places.position[axis] = value * unit + offset[axis];
            interpreter.places.state(axis);
        }
    }
}

/// Meaning of the axis words of a line with refused codes.
enum Ends {
    /// The end of its motion.
    AllAxes,
    /// In the plane the end of its motion, across it a depth.
    Plane,
    /// Something else.
    Nowhere,
}

/// Selects it by the G codes in tenths.
fn ends_of(refused: &[u32]) -> Ends {
    let mut ends = Ends::AllAxes;
    for code in refused {
        match code {
            // Splines, threads, cutter compensation.
            50 | 51 | 52 | 330 | 331 | 410 | 411 | 420 | 421 => {}
            730..=890 => ends = Ends::Plane,
            _ => return Ends::Nowhere,
        }
    }
    ends
}

/// One fault for all lines with variables.
fn of_variables_once(found: Vec<ProgramError>) -> Vec<ProgramError> {
    let is_one = |fault: &ProgramError| fault.kind == ProgramErrorKind::Variables;
    let count = found.iter().filter(|fault| is_one(fault)).count();
    let mut first = true;
    let mut kept = Vec::with_capacity(found.len());
    for mut fault in found {
        if is_one(&fault) {
            if !std::mem::take(&mut first) {
                continue;
            }
            if count > 1 {
                fault.reason.push_str(&format!(", on {count} lines"));
            }
        }
        kept.push(fault);
    }
    kept
}
