//! Random programs: read, written, corrected, read again; written flat.

use kinetostat_formats::*;
use proptest::prelude::*;

use super::random::{check, kind, program, repeating};
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
        let shown = |what: String| TestCaseError::fail(format!("{what}\n{text}"));
        write_and_read(&program, &pieces, &kind).map_err(shown)?;
        divide_and_read(&mut chance, &program, &kind).map_err(shown)?;
    }

    #[test]
    fn broken_programs_are_refused_with_a_place_or_come_back(seed in any::<u64>()) {
        check(seed).map_err(TestCaseError::fail)?;
    }

    #[test]
    fn flat_programs_go_where_the_repeating_ones_go(seed in any::<u64>()) {
        let (text, places) = repeating(&mut Chance::new(seed));
        let files = vec![SourceFile::new("r.h", text.clone())];
        let options = ReadOptions::default();
        let flat = expand_heidenhain(files, &options).unwrap();
        // What is flat stays.
        let again = expand_heidenhain(vec![flat.file.clone()], &options).unwrap();
        prop_assert!(!again.changed && again.file == flat.file);
        let program = read_heidenhain(vec![flat.file], &options).unwrap();
        prop_assert_eq!(program.motions.len(), places.len(), "{}", text);
        for (motion, place) in program.motions.iter().zip(places) {
            let found = motion.target.pose().unwrap().position_mm;
            let away = (found - nalgebra::Vector3::from(place)).norm();
            prop_assert!(away < 1e-9, "{found} {place:?}\n{text}");
        }
    }
}
