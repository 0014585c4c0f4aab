//! Numbers and shares as they are written.

use kinetostat_program::internal::{at_most, feed, fixed, least_percent};

#[test]
fn numbers_are_fixed_point_without_a_negative_zero() {
    assert_eq!(fixed(-0.00001, 4), "0.0000");
    assert_eq!(fixed(-12.34567, 4), "-12.3457");
    assert_eq!(fixed(1e9, 1), "1000000000.0");
    assert_eq!(at_most(0.029_41), "0.0295");
    assert_eq!(at_most(0.1 + 0.2), "0.300");
    assert_eq!(at_most(123.41), "124");
    assert_eq!(feed(900.0), "900");
    assert_eq!(feed(900.27), "900.3");
}

#[test]
fn a_feed_is_rounded_by_at_most_one_part_in_ten_thousand() {
    let mut value = 1.234_567e-4;
    while value < 1e7 {
        let read: f64 = feed(value).parse().unwrap();
        assert!(
            (read / value - 1.0).abs() <= 1e-4,
            "{value} was written as {read}"
        );
        value *= 1.37;
    }
}

#[test]
fn the_slowest_speed_is_never_nothing_and_never_too_large() {
    for (share, shown) in [
        (0.999, "99"),
        (0.5, "50"),
        (0.058_26, "5.8"),
        (0.001_999, "0.19"),
        (4.3e-5, "0.0043"),
        (1e-9, "less than 0.001"),
        (0.0, "less than 0.001"),
    ] {
        assert_eq!(least_percent(share), shown, "{share}");
    }
}
