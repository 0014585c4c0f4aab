//! Random programs: read, written, corrected, read again.

use proptest::prelude::*;

use kinetostat_formats::{WriteOptions, write};

use crate::harness::{Chance, corrections, read_files, write_and_read};

use super::random::{check, kind, module, unless_said};

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn whole_programs_come_back_and_take_corrections(seed in any::<u64>()) {
        let mut chance = Chance::new(seed);
        let kind = kind();
        let bytes = module(&mut chance).map(String::into_bytes);
        let program = read_files(&kind, &bytes).map_err(|errors| TestCaseError::fail(errors[0].to_string()))?;
        let files = write(&program, &[], &WriteOptions::default()).map_err(|error| TestCaseError::fail(error.to_string()))?;
        prop_assert!(files.iter().zip(&bytes).all(|((_, written), given)| written == given));
        let pieces = corrections(&mut chance, &program, &kind);
        unless_said(write_and_read(&program, &pieces, &kind)).map_err(TestCaseError::fail)?;
    }

    #[test]
    fn broken_programs_are_refused_with_a_place_or_come_back(seed in any::<u64>()) {
        check(seed).map_err(TestCaseError::fail)?;
    }
}
