//! Printed digits that are the rounding of a number.

use kinetostat_reproduce::is_rounding;

#[test]
fn digits_agree_when_they_are_the_rounding() {
    assert!(is_rounding("14.9", 14.928_203_23));
    assert!(is_rounding("-0.5", -0.511_717_51));
    assert!(is_rounding("107", 107.171_496_9));
    assert!(!is_rounding("8.67", 7.464_101_615));
    assert!(!is_rounding("0.41", 0.415_001));
    assert!(!is_rounding("Inf", 1.0));
    assert!(!is_rounding("1.0", f64::NAN));
}
