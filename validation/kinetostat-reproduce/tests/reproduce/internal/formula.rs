//! Formulas in the text of a page.

use kinetostat_reproduce::internal::formula_in_html as html;

#[test]
fn indices_powers_and_greek_letters_are_set() {
    for (plain, set) in [
        ("K22 / (EI_z/L^3)", "K22 / (EI<sub>z</sub>/L<sup>3</sup>)"),
        (
            "J_th^(G), theta1",
            "J<sub>\u{3b8}</sub><sup>(G)</sup>, \u{3b8}1",
        ),
        ("H_thth^(F)", "H<sub>\u{3b8}\u{3b8}</sub><sup>(F)</sup>"),
        (
            "K d0^3/(sqrt 3 L^2)",
            "K d0<sup>3</sup>/(\u{221a} 3 L<sup>2</sup>)",
        ),
        ("x^-1 < 2 & y", "x<sup>-1</sup> &lt; 2 &amp; y"),
        ("joint_values", "joint_values"),
        ("the path", "the path"),
        ("J^T J, row 2", "J<sup>T</sup> J, row 2"),
    ] {
        assert_eq!(html(plain), set, "{plain}");
    }
}
