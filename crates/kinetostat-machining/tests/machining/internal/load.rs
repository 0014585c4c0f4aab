//! A load of one place is large where that of a program is refused.

use kinetostat::Wrench;
use kinetostat_machining::{Limits, large_load};
use nalgebra::Vector3;

#[test]
fn a_load_of_a_place_is_large_where_that_of_a_program_is_refused() {
    let limits = Limits::default();
    let count = |force: f64, moment: f64| {
        let wrench = Wrench::new(Vector3::z() * force, Vector3::x() * moment);
        large_load(&wrench).len()
    };
    assert_eq!(count(limits.force_n, limits.moment_n_m), 0);
    assert_eq!(count(-1.001 * limits.force_n, 0.0), 1);
    assert_eq!(count(1e300, -1.001 * limits.moment_n_m), 2);
}
