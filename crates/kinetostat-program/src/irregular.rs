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
