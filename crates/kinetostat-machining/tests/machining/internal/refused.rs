//! Rates of blocks beyond their limit.

use kinetostat_machining::{Limits, of_accounting};
use kinetostat_program::Accounting;

/// A program of a few blocks has no row of sixteen; its limit holds all the same.
#[test]
fn the_rate_of_a_short_program_has_its_limit() {
    let limits = Limits {
        blocks_per_second: 0.3,
        ..Limits::default()
    };
    for (peak, mean, before, refused) in [
        (None, Some(0.5), None, true),
        (None, Some(0.5), Some(0.1), true),
        (None, Some(0.5), Some(0.49), false),
        (None, Some(0.2), None, false),
        (None, None, None, false),
        (Some(0.5), Some(0.1), None, true),
        (Some(0.2), Some(0.1), None, false),
    ] {
        let accounting = Accounting {
            peak_blocks_per_second: peak,
            mean_blocks_per_second: mean,
            mean_blocks_per_second_in: before,
            ..Accounting::default()
        };
        let found = of_accounting(&limits, &accounting);
        assert_eq!(!found.is_empty(), refused, "{peak:?} {mean:?} {before:?}");
    }
}
