//! Places that are irregular and repeat.

use kinetostat_program::irregular;

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
