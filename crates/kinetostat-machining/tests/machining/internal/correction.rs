//! A correction that is large or small is said with the digits of the table.

use kinetostat::number::largest_length;
use kinetostat_machining::{Limits, odd_correction};

/// A largest figure is never stated too small, and a length has a smallest figure as everywhere.
#[test]
fn an_odd_correction_has_the_digits_of_the_table() {
    let limits = Limits::default();
    for (mm, said) in [
        (1.0204, "up to 1.03 mm are large"),
        (0.000_301, "correction, 0.301 um, is"),
        (5.31e-8, "correction, 0.001 um, is"),
    ] {
        let found = odd_correction(&limits, mm, None, 0.0005).map(|w| w.message);
        let found = found.unwrap_or_default();
        assert!(found.contains(said), "{found}");
        assert!(found.contains(&largest_length(mm)), "{found}");
    }
}
