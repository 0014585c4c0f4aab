//! Extremes that do not lose a NaN on their way, and integration between breaks.

/// The larger of two numbers, NaN where one of them is: `f64::max` forgets it.
#[inline]
pub(crate) fn larger(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}

/// The smaller of two numbers, NaN where one of them is.
#[inline]
pub(crate) fn smaller(a: f64, b: f64) -> f64 {
    if b < a || b.is_nan() { b } else { a }
}

/// A number without the last digits that arithmetic leaves in it.
pub(crate) fn plain(value: f64) -> f64 {
    format!("{value:.11e}").parse().unwrap_or(value)
}

/// Nodes and weights of Gauss and Legendre on 0 to 1, twelve of them: `(node, weight)`.
const GAUSS: [(f64, f64); 12] = [
    (0.009_219_682_876_640_375, 0.023_587_668_193_255_914),
    (0.047_941_371_814_762_57, 0.053_469_662_997_659_21),
    (0.115_048_662_902_847_66, 0.080_039_164_271_673_11),
    (0.206_341_022_856_691_3, 0.101_583_713_361_532_96),
    (0.316_084_250_500_909_9, 0.116_746_268_269_177_4),
    (0.437_383_295_744_265_54, 0.124_573_522_906_701_39),
    (0.562_616_704_255_734_5, 0.124_573_522_906_701_39),
    (0.683_915_749_499_090_1, 0.116_746_268_269_177_4),
    (0.793_658_977_143_308_7, 0.101_583_713_361_532_96),
    (0.884_951_337_097_152_3, 0.080_039_164_271_673_11),
    (0.952_058_628_185_237_4, 0.053_469_662_997_659_21),
    (0.990_780_317_123_359_6, 0.023_587_668_193_255_914),
];

/// Calls `at(place, weight)` at the nodes between two places.
///
/// Places are drawn to both ends by `s = u^2 (3 - 2 u)`: chips begin and end there with a power of their thickness that is
/// no whole number, which no polynomial follows.
#[inline]
pub(crate) fn integrate(from: f64, to: f64, mut at: impl FnMut(f64, f64)) {
    let length = to - from;
    for (node, weight) in GAUSS {
        let share = node * node * (3.0 - 2.0 * node);
        at(
            from + length * share,
            length * weight * 6.0 * node * (1.0 - node),
        );
    }
}
