//! Values that change no faster than they may, against what is asked of them, place by place.

use kinetostat_machining::internal::limited_values;
use proptest::prelude::*;

/// Places along a path with the ways between them; many stand at one place, or nearly.
fn places() -> impl Strategy<Value = Vec<(f64, f64, bool)>> {
    let way = prop_oneof![Just(0.0), 1e-3..0.1, 0.5..5.0];
    let value = prop_oneof![Just(0.0), -50.0..50.0];
    prop::collection::vec((way, value, any::<bool>()), 1..30).prop_map(|list| {
        let mut at = 0.0;
        let place = |(way, value, counts): (f64, f64, bool)| {
            at += way;
            // Air has no force.
            (at, if counts { value } else { 0.0 }, counts)
        };
        list.into_iter().map(place).collect()
    })
}

fn at(found: &[(f64, f64)], place: f64) -> impl Iterator<Item = f64> + '_ {
    let here = found.iter().filter(move |(at, _)| *at == place);
    here.map(|(_, value)| *value)
}

proptest! {
    #[test]
    fn no_change_is_faster_and_what_counts_is_kept(places in places(), rate in 1.0..100.0_f64) {
        let too_fast = places
            .windows(2)
            .any(|p| (p[1].1 - p[0].1).abs() > rate * (p[1].0 - p[0].0) * (1.0 + 1e-12));
        let Some(found) = limited_values(&places, rate, false) else {
            prop_assert!(!too_fast);
            return Ok(());
        };
        for pair in found.windows(2) {
            let way = pair[1].0 - pair[0].0;
            prop_assert!(way >= 0.0);
            prop_assert!((pair[1].1 - pair[0].1).abs() <= rate * way + 1e-9, "{pair:?}");
        }
        // Between two places of the profile too, it is what the cones of all places that count leave of the line between the
        // places that were given.
        for pair in found.windows(2).filter(|p| p[1].0 - p[0].0 > 1e-6) {
            let middle = 0.5 * (pair[0].0 + pair[1].0);
            let next = places.partition_point(|p| p.0 < middle);
            let (a, b) = (places[next - 1], places[next]);
            let own = a.1 + (b.1 - a.1) * (middle - a.0) / (b.0 - a.0);
            let mut low = f64::NEG_INFINITY;
            let mut high = f64::INFINITY;
            for p in places.iter().filter(|p| p.2) {
                let cone = rate * (p.0 - middle).abs();
                low = if p.1 - cone > low { p.1 - cone } else { low };
                high = if p.1 + cone < high { p.1 + cone } else { high };
            }
            if a.2 && b.2 {
                low = if own > low { own } else { low };
                high = if own < high { own } else { high };
            }
            let expected = if low > high {
                0.5 * (low + high)
            } else if own < low {
                low
            } else if own > high {
                high
            } else {
                own
            };
            let found = 0.5 * (pair[0].1 + pair[1].1);
            prop_assert!((found - expected).abs() < 1e-6 * (1.0 + expected.abs()), "{middle}: {found} {expected}");
        }
        for &(place, value, _) in places.iter().filter(|p| p.2) {
            // By how much two values that count are too far apart for the way between them, here half of it is left.
            let counting = || places.iter().filter(|p| p.2);
            let bound = |p: &&(f64, f64, bool), sign: f64| p.1 + sign * rate * (p.0 - place).abs();
            let low = counting().map(|p| bound(&p, -1.0)).reduce(|a, b| if b > a { b } else { a });
            let high = counting().map(|p| bound(&p, 1.0)).reduce(|a, b| if b < a { b } else { a });
            let (low, high) = (low.unwrap(), high.unwrap());
            let expected = if low > high { 0.5 * (low + high) } else { value };
            prop_assert!(at(&found, place).all(|v| (v - expected).abs() < 1e-9), "{place}: {expected}");
            prop_assert!(at(&found, place).count() > 0);
        }
    }
}

/// Into the air before a cut and after it, over the length that the rate asks for.
#[test]
fn the_change_goes_into_the_air() {
    let cut = [
        (0.0, 0.0, false),
        (10.0, 0.0, false),
        (10.0, 40.0, true),
        (12.0, 40.0, true),
        (12.0, 0.0, false),
        (30.0, 0.0, false),
    ];
    let found = limited_values(&cut, 20.0, false).expect("too fast as it is");
    let mut compared = 0;
    for (place, value) in found {
        let expected: f64 = if place < 10.0 {
            40.0 - 20.0 * (10.0 - place)
        } else if place <= 12.0 {
            40.0
        } else {
            40.0 - 20.0 * (place - 12.0)
        };
        let expected = if expected > 0.0 { expected } else { 0.0 };
        assert!((value - expected).abs() < 1e-9, "{place}: {value}");
        compared += 1;
    }
    assert!(compared > 6, "{compared}");
    // Nothing before the beginning: it comes over the first millimetres, over all of the way at most.
    for (length, full_after) in [(100.0, 2.0), (2.5, 2.0), (1.0, 1.0)] {
        let whole = [(0.0, 40.0, true), (length, 40.0, true)];
        let found = limited_values(&whole, 20.0, true).expect("begins");
        let value = |place: f64| {
            let after = found.partition_point(|(at, _)| *at < place);
            let (a, b) = (found[after - 1], found[after]);
            a.1 + (b.1 - a.1) * (place - a.0) / (b.0 - a.0)
        };
        assert_eq!(found[0], (0.0, 0.0));
        for part in [0.25, 0.5, 1.0] {
            let found = value(part * full_after);
            assert!((found - 40.0 * part).abs() < 1e-9, "{part}: {found}");
        }
    }
}
