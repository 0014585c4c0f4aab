//! Places that follow no pattern, the same in every run: a check that looks where a division looked
//! sees no more than the division did.

/// The `k`th irregular number for something numbered `index`, between 0 and 1 (both excluded).
///
/// It depends on the two numbers and the `seed` and on nothing else. The mixing is that of `SplitMix64`
/// (Steele, Lea, Flood: Fast splittable pseudorandom number generators, 2014).
pub fn irregular(seed: u64, index: u64, k: u64) -> f64 {
    let mut state = seed;
    for number in [index, k] {
        state = mixed(
            state
                .wrapping_add(0x9e37_79b9_7f4a_7c15)
                .wrapping_add(number),
        );
    }
    // 52 bits and a half: never 0, never 1.
    ((state >> 12) as f64 + 0.5) / (1_u64 << 52) as f64
}

fn mixed(mut state: u64) -> u64 {
    state = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    state = (state ^ (state >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    state ^ (state >> 31)
}

#[cfg(test)]
mod tests {
    use super::irregular;

    #[test]
    fn they_are_spread_evenly_and_repeat() {
        let mut tenths = [0; 10];
        for index in 0..5000 {
            for k in 0..2 {
                let place = irregular(7, index, k);
                assert!(place > 0.0 && place < 1.0);
                assert_eq!(place.to_bits(), irregular(7, index, k).to_bits());
                tenths[(place * 10.0) as usize] += 1;
            }
        }
        assert!(
            tenths.iter().all(|count| (900..1100).contains(count)),
            "{tenths:?}"
        );
    }
}
