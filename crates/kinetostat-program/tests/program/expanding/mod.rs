//! Programs that are run once and written flat.

mod all_faults;
mod beside_calls;
mod bounds;
mod broken;
mod control;
mod coordinates;
mod cycles;
mod expressions;
mod fanuc;
mod fanuc_cycles;
mod fanuc_values;
mod messages;
mod mirrors;
mod modes;
mod offsets;
mod polar;
pub mod random;
mod rotary;
mod splines;
mod tapes;
mod turns;

use kinetostat_program::{ExpandOptions, NoSubprograms, ProgramError, expand};

/// The flat program.
fn flat(text: &str) -> String {
    let expanded = expand(text, &ExpandOptions::default(), &NoSubprograms);
    let expanded = expanded.unwrap_or_else(|error| panic!("{error}\n{text}"));
    String::from_utf8(expanded.program.bytes().to_vec()).unwrap()
}

/// The refusal of a program.
fn refused(text: &str) -> ProgramError {
    match expand(text, &ExpandOptions::default(), &NoSubprograms) {
        Err(error) => error,
        Ok(expanded) => panic!(
            "not refused: {}",
            String::from_utf8_lossy(expanded.program.bytes())
        ),
    }
}

#[test]
fn random_programs_are_expanded_or_refused() {
    let mut expanded = 0;
    for seed in 0..20_000 {
        match random::check(seed) {
            Ok(taken) => expanded += usize::from(taken),
            Err(what) => panic!("{what}"),
        }
    }
    assert!(expanded > 500, "{expanded}");
}
