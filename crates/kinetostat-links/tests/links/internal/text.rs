//! Numbers as programs of several languages write them.

use kinetostat_links::number;

#[test]
fn numbers_of_fortran_nastran_and_c() {
    for (text, value) in [
        ("1.5", 1.5),
        (" -2 ", -2.0),
        ("1.5D+03", 1500.0),
        ("0.123-100", 1.23e-101),
        ("-2.261491337E+08", -2.261_491_337e8),
        ("7.+5", 7e5),
        (".5e-1", 0.05),
    ] {
        assert_eq!(number(text), Some(value), "{text}");
    }
    for text in [
        "", "nan", "inf", "1e999", "1,5", "1e5e5", "0x10", "--1", "1+2+3", "e5",
    ] {
        assert_eq!(number(text), None, "{text}");
    }
}
