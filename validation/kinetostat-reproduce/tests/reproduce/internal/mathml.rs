//! Formulas set by themselves.

use kinetostat_reproduce::internal::formula_in_mathml as math;

/// The formula without what is only there for machines to read.
fn set(text: &str) -> String {
    let math = math(text).unwrap_or_else(|| panic!("{text} is no formula"));
    math.replace("<mo>&#x2062;</mo>", "")
        .replace("<mo>&#x2061;</mo>", "")
        .replace("<mrow>", "")
        .replace("</mrow>", "")
        .replace("<mspace width=\"0.17em\"/>", "")
        .replace("<mo stretchy=\"false\">", "<mo>")
        .replace("<math displaystyle=\"true\">", "")
        .replace("</math>", "")
}

#[test]
fn fractions_end_at_blanks() {
    assert_eq!(
        set("K/L (a - a0)"),
        "<mfrac><mi>K</mi><mi>L</mi></mfrac><mo>(</mo><mi>a</mi><mo>\u{2212}</mo>\
         <msub><mi>a</mi><mn>0</mn></msub><mo>)</mo>"
    );
    // Brackets that only hold a denominator together are not needed.
    assert_eq!(
        set("-G/(4L sin^3 a)"),
        "<mo>\u{2212}</mo><mfrac><mi>G</mi><mn>4</mn><mi>L</mi><msup><mi>sin</mi><mn>3</mn></msup>\
         <mi>a</mi></mfrac>"
    );
    assert_eq!(
        set("K_j1 K_1k / K_11"),
        "<mfrac><msub><mi>K</mi><mi>j</mi><mn>1</mn></msub><msub><mi>K</mi><mn>1</mn><mi>k</mi></msub>\
         <msub><mi>K</mi><mn>1</mn><mn>1</mn></msub></mfrac>"
    );
}

#[test]
fn names_are_letters_with_indices() {
    assert_eq!(
        set("3K11/L^2 -rhd_a"),
        "<mfrac><mn>3</mn><msub><mi>K</mi><mn>11</mn></msub><msup><mi>L</mi><mn>2</mn></msup></mfrac>\
         <mo>(</mo><mo>\u{2212}</mo><mi>r</mi><mi>h</mi><msub><mi>d</mi><mi>a</mi></msub><mo>)</mo>"
    );
    assert_eq!(
        set("sqrt 3 phi0"),
        "<msqrt><mn>3</mn></msqrt><msub><mi>\u{3c6}</mi><mn>0</mn></msub>"
    );
    assert_eq!(
        set("4c^2-2c"),
        "<mn>4</mn><msup><mi>c</mi><mn>2</mn></msup><mo>\u{2212}</mo><mn>2</mn><mi>c</mi>"
    );
}

#[test]
fn what_is_no_formula_is_refused() {
    for text in ["", "K/", "(a", "a)", "G*", "-", "a <b>", "1 +"] {
        assert_eq!(math(text), None, "{text}");
    }
}
