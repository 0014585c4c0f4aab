//! Random programs: read, written, corrected, read again.

use proptest::prelude::*;

use crate::chance::Chance;

use super::random::{
    PLACE_MM, TURN_RAD, check, corrections, divide_and_read, module, write_and_read,
};
use super::{program, written};

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn whole_programs_come_back_and_take_corrections(seed in any::<u64>()) {
        let mut chance = Chance::new(seed);
        let text = module(&mut chance);
        let program = program(&text);
        prop_assert_eq!(written(&program, &[]), text);
        let pieces = corrections(&mut chance, &program);
        let (place, turn) = write_and_read(&program, &pieces).map_err(TestCaseError::fail)?;
        prop_assert!(place <= PLACE_MM, "{} mm away", place);
        prop_assert!(turn <= TURN_RAD, "{} rad away", turn);
        divide_and_read(&mut chance, &program).map_err(TestCaseError::fail)?;
    }

    #[test]
    fn broken_programs_are_refused_with_a_place_or_come_back(seed in any::<u64>()) {
        check(seed).map_err(TestCaseError::fail)?;
    }
}
