//! Values of arrays at their definition: SET and REP (SINUMERIK, job planning: definition and initialization of array variables).

use kinetostat_formats::*;

use super::{fault, place, program};

fn at(define: &str, words: &str) -> [f64; 3] {
    let program = program(&format!("{define}\nG17 G90 G54\nG1 F100 {words}\nM30\n"));
    place(&program, 0)
}

#[test]
fn set_and_rep_give_arrays_their_values() {
    let all = "X=A[0] Y=A[1] Z=A[2]";
    for (define, expected) in [
        ("DEF REAL A[3]=SET(1.5,2,-3)", [1.5, 2.0, -3.0]),
        ("DEF REAL B=7, a[3]=set(1,B,3*2), C=9", [1.0, 7.0, 6.0]),
        ("DEF REAL A[3]=REP(7.25)", [7.25, 7.25, 7.25]),
        ("DEF REAL A[3]=REP(7.25,2)", [7.25, 7.25, 0.0]),
        // What is not named is zero.
        ("DEF REAL A[3]=SET(4)", [4.0, 0.0, 0.0]),
        ("DEF INT A[3]=SET(1.4,2.6,-1)", [1.0, 3.0, -1.0]),
        ("DEF REAL A[3]", [0.0, 0.0, 0.0]),
    ] {
        let found = at(define, all);
        let mut off = found.iter().zip(expected);
        assert!(
            off.all(|(a, b)| (a - b).abs() < 1e-12),
            "{define}: {found:?}"
        );
        // Run once and written flat they are the same.
        let text = format!("{define}\nG17 G90 G54\nFOR R1=1 TO 1\nG1 F100 {all}\nENDFOR\nM30\n");
        let flat = expand_siemens(&[SourceFile::new("a.mpf", text)]).unwrap();
        let again = read_siemens(vec![flat.file], &ReadOptions::default()).unwrap();
        let found = place(&again, 0);
        let mut off = found.iter().zip(expected);
        assert!(
            off.all(|(a, b)| (a - b).abs() < 1e-9),
            "{define}: {found:?}"
        );
    }
    // The last index runs first.
    let found = at("DEF REAL A[2,2]=SET(1,2,3,4)", "X=A[0,1] Y=A[1,0] Z=A[1,1]");
    assert!(
        found
            .iter()
            .zip([2.0, 3.0, 4.0])
            .all(|(a, b)| (a - b).abs() < 1e-12)
    );
}

#[test]
fn values_that_are_not_sure_are_refused_and_never_zero() {
    for (text, part) in [
        ("DEF REAL A[3]=5", "an array begins with one value"),
        (
            "DEF REAL A[2]=SET(1,2,3)",
            "more values than the array has elements",
        ),
        (
            "DEF REAL A[2]=REP(1,3)",
            "more values than the array has elements",
        ),
        (
            "DEF REAL A[2]=SET(1,$P_UIFR)",
            "a value of the array is not known here",
        ),
        ("DEF REAL A=SET(1)", "SET and REP are for arrays"),
        ("DEF REAL A=\"one\"", "its value is of another type"),
        (
            "DEF REAL A=$AA_IW[X]\nG1 X=A F100",
            "`A` has no value that this program gives it",
        ),
    ] {
        let found = fault(&format!("G17 G90 G54\nG0 X0 Y0 Z0\n{text}\nM30\n"));
        assert!(found.contains(part), "{text}: {found}");
    }
    // What only the machine knows may be assigned later, or never used.
    let found = at("DEF REAL A=$P_TOOLR, B\nA=4", "X=A Y0 Z0");
    assert!((found[0] - 4.0).abs() < 1e-12, "{found:?}");
}
