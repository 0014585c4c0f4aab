//! Numbers of long tables are those that the standard library writes.

use kinetostat::number::{MISSING, fixed_and_short};

#[test]
fn decimals_are_those_of_the_standard_library() {
    let halves = [
        0.5,
        1.5,
        0.125,
        2.000_05,
        0.000_000_5,
        1.005,
        -0.045,
        4_095.999_95,
    ];
    let mut state = 0x2545_f491_4f6c_dd1d_u64;
    let mut random = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut numbers: Vec<f64> = halves.to_vec();
    for size in [1e-7, 1e-3, 1.0, 37.0, 1e4, 3e8, 2e10] {
        numbers.extend((0..4000).map(|_| size * (2.0 * random() - 1.0)));
        // Numbers of few digits, as programs have them.
        numbers.extend((0..1000).map(|_| (size * 1e4 * random()).round() * 1e-4));
    }
    for value in numbers.into_iter().filter(|x| x.abs() < 1e9) {
        for decimals in 0..=8 {
            let text = format!("{value:.decimals$}");
            let text = match text.contains('.') {
                true => text.trim_end_matches('0').trim_end_matches('.'),
                false => &text,
            };
            let wanted = if text == "-0" { "0" } else { text };
            assert_eq!(
                fixed_and_short(value, decimals),
                wanted,
                "{value:e} {decimals}"
            );
        }
    }
    assert_eq!(fixed_and_short(f64::NAN, 3), MISSING);
}
