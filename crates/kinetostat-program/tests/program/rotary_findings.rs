//! What is said of rotary axes: angles beyond limits, angles that no direction says, and one fault for a refused G43.5.

use std::sync::Arc;

use kinetostat_program::{
    Carries, Program, ReadOptions, RotaryAxes, RotaryAxis, faults, interpret,
};
use nalgebra::{UnitQuaternion, Vector3};

/// A head about x above a table about -z.
fn portal(limits_of_c: Option<[f64; 2]>) -> ReadOptions {
    let axis = |letter, carries, direction, limits_deg| RotaryAxis {
        letter,
        carries,
        direction: nalgebra::Unit::new_normalize(direction),
        point_mm: Vector3::zeros(),
        limits_deg,
    };
    let mut options = ReadOptions::default();
    options.rotary = Some(Arc::new(RotaryAxes {
        axes: vec![
            axis('A', Carries::Tool, Vector3::x(), None),
            axis('C', Carries::Part, -Vector3::z(), limits_of_c),
        ],
        tool_at_zero: UnitQuaternion::identity(),
    }));
    options
}

fn warnings(text: &str, options: &ReadOptions) -> Vec<(usize, String)> {
    let path = interpret(&Program::read(text).unwrap(), options).unwrap();
    let all = path.warnings.into_iter();
    all.map(|warning| (warning.line, warning.text)).collect()
}

#[test]
fn angles_beyond_limits_are_warned_of_by_line() {
    let text = "G21 G90 G94\nG0 X0 Y0 Z50 A0 C0\nG43.4 H1 Z50\nG1 A20 C60 F100\nC61\nX10 C-60.5\nC0\nG0 Z50\nG49\n";
    let found = warnings(text, &portal(Some([-60.0, 60.0])));
    let said: Vec<&(usize, String)> = found
        .iter()
        .filter(|(_, text)| text.contains("it reaches"))
        .collect();
    assert_eq!(said.len(), 1, "{found:?}");
    assert_eq!(said[0].0, 5);
    assert!(
        said[0]
            .1
            .starts_with("axis C is sent to 61 deg, and it reaches -60 to 60 deg")
            && said[0].1.ends_with("(and in 1 more block)"),
        "{found:?}"
    );
    assert_eq!(warnings(text, &portal(None)), []);
}

#[test]
fn an_angle_that_no_direction_says_is_warned_of_where_it_matters() {
    let text = |law: &str| {
        format!(
            "G21 G90 G94\nG0 X0 Y0 Z50 A0 C0\nG43.5 {law} H1 Z50\nG0 I0 J0 K1\nG1 Z0 F600\nG1 X0 Y60 I0.3 J0 K0.95\nG1 X-60 Y0 I-0.3 J0 K0.95\nG0 Z50\nG49\nM30\n"
        )
    };
    let found = warnings(&text("P0"), &portal(None));
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(found[0].0, 6);
    assert!(
        found[0].1.contains("the tool lies along axis C, and no direction says its angle there: it is taken to stay at 0 deg until then"),
        "{found:?}"
    );
    // On the great circle the angle at the pole follows from where the way leads.
    assert_eq!(warnings(&text("P1"), &portal(None)), []);
}

#[test]
fn what_follows_from_a_refused_g43_5_is_not_repeated() {
    let text = "G21 G90 G94\nG0 X0 Y0 Z50\nG43.5 H1 Z50\nG0 I0 J0 K1\nG1 Z0 F600\nG1 X0 Y60 I0.3 J0 K0.95\nG1 X-60 Y0 I-0.3 J0 K0.95\nG0 Z50\nG49\nG1 X5 I1\nM30\n";
    let found = faults(text, &portal(None));
    let lines: Vec<usize> = found.iter().map(|fault| fault.line).collect();
    // Line 10 has a word that means nothing without G43.5.
    assert_eq!(lines, [3, 10], "{found:?}");
    assert!(
        found[0]
            .reason
            .contains("where axis A stands is not stated before G43.5")
    );
}
