//! Random programs: read, written, corrected, read again.

use proptest::prelude::*;

use super::random::{check, kind, program};
use crate::harness::{Chance, corrections, divide_and_read, read_files, write_and_read};

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn whole_programs_come_back_and_take_corrections(seed in any::<u64>()) {
        let mut chance = Chance::new(seed);
        let (text, kind) = (program(&mut chance), kind());
        let read = read_files(&kind, &[text.as_bytes().to_vec()]);
        let program = read.map_err(|errors| TestCaseError::fail(format!("{errors:?}\n{text}")))?;
        let pieces = corrections(&mut chance, &program, &kind);
        write_and_read(&program, &pieces, &kind).map_err(TestCaseError::fail)?;
        divide_and_read(&mut chance, &program, &kind).map_err(TestCaseError::fail)?;
    }

    #[test]
    fn broken_programs_are_refused_with_a_place_or_come_back(seed in any::<u64>()) {
        check(seed).map_err(TestCaseError::fail)?;
    }
}
