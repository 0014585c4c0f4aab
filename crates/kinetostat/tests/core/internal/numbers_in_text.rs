//! Numbers in text: digits, units, bounds.

use kinetostat::number::*;

#[test]
fn digits_that_mean_something() {
    use Rounding::{Down, Nearest, Up};
    assert_eq!(significant(0.7583, 2, Up), "0.76");
    assert_eq!(significant(0.76, 2, Up), "0.76");
    assert_eq!(significant(0.7583, 3, Nearest), "0.758");
    assert_eq!(significant(9.996, 3, Up), "10.0");
    assert_eq!(significant(1543.0, 2, Down), "1500");
    assert_eq!(significant(1543.0, 2, Nearest), "1543");
    assert_eq!(significant(323.52, 4, Nearest), "323.5");
    assert_eq!(significant(-0.021, 1, Up), "-0.03");
    assert_eq!(significant(12.5e12, 3, Nearest), "12.5e12");
    assert_eq!(significant(1.25e8, 1, Nearest), "100e6");
    assert_eq!(significant(3.2352e-7, 4, Nearest), "323.5e-9");
    assert_eq!(significant(0.0, 3, Up), "0");
    assert_eq!(setting(0.5), "0.5");
    assert_eq!(setting(1500.0), "1500");
    assert_eq!(fixed(-0.0004, 3), "0.000");
    assert_eq!(fixed(-1234.56, 1), "-1234.6");
}

#[test]
fn zeros_of_a_power_of_ten_are_never_cut() {
    for power in -300..=300 {
        for lead in ["1", "-1", "2.5", "100"] {
            let value: f64 = format!("{lead}e{power}").parse().unwrap();
            for text in [short(value), setting(value), trimmed(value, 12)] {
                let read: f64 = text.parse().unwrap();
                assert!((read / value - 1.0).abs() < 1e-9, "{value:e}: {text}");
            }
            let shown = fixed(value, 4);
            let read: f64 = without_zeros(&shown).parse().unwrap();
            let least = 0.5e-4 + 1e-9 * value.abs();
            assert!((read - value).abs() <= least, "{value:e}: {shown}");
        }
    }
}

#[test]
fn extremes_keep_nan() {
    for order in [
        [1.0, f64::NAN, 3.0],
        [f64::NAN, 3.0, 1.0],
        [3.0, 1.0, f64::NAN],
    ] {
        assert!(order.into_iter().fold(0.0, larger).is_nan());
        assert!(order.into_iter().fold(9.0, smaller).is_nan());
    }
    assert_eq!([1.0, 3.0, 2.0].into_iter().fold(0.0, larger), 3.0);
    assert_eq!(
        [2.0, 1.0, f64::INFINITY].into_iter().fold(9.0, smaller),
        1.0
    );
}

/// What is read from a table and added to a place of 100 mm comes back with the rounding of that place.
#[test]
fn a_round_number_with_the_noise_of_a_place_stays_round() {
    for (tenths, place) in (1..10).flat_map(|k| [50.0, 99.9999, 777.7].map(|p| (k, p))) {
        let mm = 1e-4 * f64::from(tenths);
        for value in [mm, (place + mm) - place, place - (place - mm)] {
            let up = significant(1e3 * value, 3, Rounding::Up);
            let down = significant(1e3 * value, 3, Rounding::Down);
            let um = 0.1 * f64::from(tenths);
            assert_eq!(
                up.parse::<f64>().unwrap(),
                (1e3 * um).round() / 1e3,
                "{value}"
            );
            assert_eq!(down, up, "{value}");
        }
    }
}

#[test]
fn lengths_choose_their_unit() {
    assert_eq!(largest_length(0.000_538_2), "0.539 um");
    assert_eq!(largest_length(0.758_31), "0.759 mm");
    assert_eq!(least_length(0.0), "0 mm");
    assert_eq!(length_setting(0.0005), "0.5 um");
    assert_eq!(largest_length(f64::NAN), MISSING);
    assert_eq!(share(0.086), "8.60 %");
    assert_eq!(share(0.0), "0 %");
}

#[test]
fn small_values_follow_one_rule() {
    for nothing in [0.0, -0.0, 1e-13, -1e-13] {
        assert_eq!(largest_length(nothing), "0 mm");
        assert_eq!(least_length(nothing), "0 mm");
        assert_eq!(mean_length(nothing), "0 mm");
        assert_eq!(largest_angle(nothing), "0 deg");
        assert_eq!(share(1e-2 * nothing), "0 %");
        assert_eq!(largest(nothing, "N"), "0 N");
        assert_eq!(least(nothing, "N"), "0 N");
    }
    // A largest value is never stated too small.
    assert_eq!(largest_length(1e-7), "0.001 um");
    assert_eq!(largest_angle(1e-7), "0.0001 deg");
    assert_eq!(share(1e-9), "0.0001 %");
    assert_eq!(largest(1e-7, "N"), "100e-9 N");
    assert_eq!(share(-1e-9), "0 %");
    assert_eq!(share(-0.5), "-50.0 %");
    assert_eq!(apart(3.2391e-3, 6.3611e-15), "3.24 um and 0 deg");
    assert_eq!(apart(50.0, 7.3123), "50.0 mm and 7.31 deg");
    assert_eq!(apart(1e-7, 1e-7), "below 0.001 um and below 0.0001 deg");
    // Neither a mean nor a least value is an upper bound.
    assert_eq!(mean_length(1e-7), "below 0.001 um");
    assert_eq!(least_length(1e-7), "below 0.001 um");
}

/// A simple sequence of numbers over many powers of ten.
fn values() -> impl Iterator<Item = f64> {
    let mut state = 1_u64;
    (0..20_000).map(move |_| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        let unit = (state >> 11) as f64 / (1_u64 << 53) as f64;
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        let power = ((state >> 40) % 24) as i32 - 12;
        unit * 10_f64.powi(power)
    })
}

#[test]
fn what_is_stated_is_a_bound_and_has_its_digits() {
    for value in values().filter(|v| *v > 0.0) {
        let read = |text: String| text.parse::<f64>().unwrap();
        let up = read(significant(value, 3, Rounding::Up));
        let down = read(significant(value, 3, Rounding::Down));
        assert!(up >= value * (1.0 - 1e-8), "{value}: {up}");
        assert!(down <= value * (1.0 + 1e-8), "{value}: {down}");
        assert!((up - value).abs() <= 0.0101 * value, "{value}: {up}");
        assert!((value - down).abs() <= 0.0101 * value, "{value}: {down}");
        let text = significant(value, 3, Rounding::Nearest);
        assert!(text.len() <= 9, "{value}: {text}");
        if let Some((_, power)) = text.split_once('e') {
            assert_eq!(power.parse::<i32>().unwrap() % 3, 0, "{text}");
        }
    }
}

#[test]
fn a_bound_that_is_missed_never_looks_met() {
    let read = |text: &str| {
        let (number, unit) = text.split_once(' ').unwrap();
        number.parse::<f64>().unwrap() * if unit == "um" { 1e-3 } else { 1.0 }
    };
    for value in values().filter(|v| (1e-5..1e3).contains(v)) {
        for near in [1.0 + 1e-7, 1.0 - 1e-7, 1.001, 0.999, 1.3, 0.4] {
            let (shown, bound) = against(value, near * value);
            let missed = value > near * value;
            assert_eq!(
                read(&shown) > read(&bound),
                missed,
                "{shown} against {bound}"
            );
        }
    }
}

#[test]
fn nothing_upsets_the_formatting() {
    for value in [
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::MAX,
        f64::MIN_POSITIVE,
        -5e-324,
        0.0,
        -0.0,
    ] {
        for rounding in [Rounding::Nearest, Rounding::Up, Rounding::Down] {
            for text in [
                significant(value, 3, rounding),
                length(value, 3, rounding),
                fixed(value, 4),
                share(value),
            ] {
                assert!(!text.contains("NaN") && !text.contains('?'), "{text}");
                assert!(text.len() < 24, "{value}: {text}");
            }
        }
    }
}
