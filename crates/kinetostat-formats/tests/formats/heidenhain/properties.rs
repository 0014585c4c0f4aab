//! Random programs that repeat, written flat.

use kinetostat_formats::*;
use proptest::prelude::*;

use super::random::repeating;
use crate::harness::Chance;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

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
