//! Numbers printed as the text printed them.

use kinetostat_formats::internal::{Width, printed};

fn text(original: &str, value: f64, least: usize, width: Width) -> String {
    let old = original.trim().parse().unwrap();
    String::from_utf8(printed(original.as_bytes(), old, value, least, width)).unwrap()
}

#[test]
fn decimals_signs_and_missing_zeros_are_those_of_the_text() {
    let cases = [
        ("25", 25.1, "25.100"),
        ("25", 25.0004, "25"),
        ("25.50", 25.5, "25.50"),
        ("25.123456", 25.2, "25.200000"),
        ("+1.5", 2.0, "+2.000"),
        ("+1.5", -2.0, "-2.000"),
        (".450", 0.4512, ".451"),
        ("-.450", -0.4512, "-.451"),
        (".450", 1.25, "1.250"),
        ("-0.001", 0.0002, "0.000"),
        ("1e2", 100.5, "100.500"),
        ("9E+02", 900.0, "9E+02"),
    ];
    for (original, value, expected) in cases {
        assert_eq!(
            text(original, value, 3, Width::Free),
            expected,
            "{original} to {value}"
        );
    }
}

#[test]
fn columns_stay_where_the_number_fits() {
    let cases = [
        ("  417.118", 417.2, "  417.200"),
        ("  417.118", -1417.2, "-1417.200"),
        ("   -.000", 0.5, "    .500"),
        ("  9.5", -100.25, "-100.250"),
    ];
    for (original, value, expected) in cases {
        assert_eq!(
            text(original, value, 3, Width::Kept),
            expected,
            "{original} to {value}"
        );
    }
}
