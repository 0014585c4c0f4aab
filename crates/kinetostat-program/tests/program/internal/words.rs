//! The tokens of a line.

use kinetostat_program::internal::tokens;

fn words(line: &str) -> Vec<(char, f64)> {
    let tokens = tokens(line.as_bytes());
    let end = tokens.iter().fold(0, |end, (span, _)| {
        assert_eq!(span.start, end, "no byte is skipped in {line:?}");
        span.end
    });
    assert_eq!(end, line.len(), "no byte is lost in {line:?}");
    tokens.into_iter().filter_map(|(_, word)| word).collect()
}

#[test]
fn words_need_no_spaces_and_numbers_need_no_leading_digit() {
    let expected = vec![
        ('N', 10.0),
        ('G', 1.0),
        ('X', -0.5),
        ('Y', 3.0),
        ('F', 1200.0),
    ];
    assert_eq!(words("n10g1x-.5Y+3.F1200"), expected);
    assert_eq!(words("N10 G 1 X -.5\tY+3. F1200 ; X9"), expected);
    assert_eq!(words("N10 (X7) G1 X-.5(Y8)Y3 F1200 (open"), expected);
}
