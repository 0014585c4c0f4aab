//! What comes back behind a subprogram with SAVE.

use kinetostat_formats::*;

fn expanded(main: &str, sub: &str) -> Result<FlatText, Vec<ProgramError>> {
    expand_siemens(&[
        SourceFile::new("m.mpf", main),
        SourceFile::new("POCK.SPF", sub),
    ])
}

/// Ends of the motions of the flat program in the part's axes.
fn ends(main: &str, sub: &str) -> Vec<[f64; 3]> {
    let flat = expanded(main, sub).unwrap();
    let text = String::from_utf8_lossy(flat.file.bytes()).into_owned();
    let program = super::program(&text);
    (0..program.motions.len())
        .map(|motion| super::place(&program, motion))
        .collect()
}

fn check(main: &str, sub: &str, expected: &[[f64; 3]]) {
    let found = ends(main, sub);
    assert_eq!(found.len(), expected.len(), "{main}: {found:?}");
    for (found, expected) in found.iter().zip(expected) {
        for axis in 0..3 {
            let apart = (found[axis] - expected[axis]).abs();
            assert!(apart < 1e-9, "{main}: {found:?}, {expected:?}");
        }
    }
}

#[test]
fn the_programmable_frame_comes_back() {
    let sub = "PROC POCK SAVE DISPLOF\nATRANS X1 Y2\nAROT Z90\nG1 X5 Y0\nM17\n";
    let head = "G90 G71 G94 G17 G54\nG1 X0 Y0 Z0 F500\n";
    // Within: 1, 2 further on and turned by 90 deg, 5 along the new X.
    check(
        &format!("{head}POCK\nX0 Y0\nTRANS X50\nPOCK\nTRANS X100\nPOCK\nG1 X0 Y0\nM30\n"),
        sub,
        &[
            [0.0, 0.0, 0.0],
            [1.0, 7.0, 0.0],
            [0.0, 0.0, 0.0],
            [51.0, 7.0, 0.0],
            [101.0, 7.0, 0.0],
            [100.0, 0.0, 0.0],
        ],
    );
    // A frame of several statements, with values that the program computes, and a subprogram that takes it back.
    check(
        &format!("{head}R1=10\nTRANS X=R1 ; shift\nN5 AROT Z90\nPOCK P2\nX3 Y0\nM30\n"),
        "PROC POCK SAVE\nTRANS\nG1 X7 Y8\nRET\n",
        &[
            [0.0, 0.0, 0.0],
            [7.0, 8.0, 0.0],
            [7.0, 8.0, 0.0],
            [10.0, 3.0, 0.0],
        ],
    );
    // ATRANS without TRANS before it, and calls within calls.
    let flat = expand_siemens(&[
        SourceFile::new("m.mpf", "ATRANS X1\nAA\nX0 Y0 Z0\nM30\n"),
        SourceFile::new("AA.SPF", "PROC AA SAVE\nATRANS X10\nBB\nG1 X0 Y0 Z0\nM17\n"),
        SourceFile::new("BB.SPF", "PROC BB SAVE\nATRANS X100\nG1 X0 Y0 Z0\nM17\n"),
    ]);
    let flat = flat.unwrap();
    let program = super::program(&String::from_utf8_lossy(flat.file.bytes()));
    let x: Vec<f64> = (0..3).map(|at| super::place(&program, at)[0]).collect();
    assert_eq!(x, [111.0, 11.0, 1.0]);
    // Without SAVE the frame stays.
    check(
        &format!("{head}POCK\nX0 Y0\nM30\n"),
        "PROC POCK\nTRANS X10\nM17\n",
        &[[0.0, 0.0, 0.0], [10.0, 0.0, 0.0]],
    );
}

#[test]
fn a_frame_comes_back_in_its_own_unit_and_plane() {
    check(
        "G70\nTRANS X1\nG71\nPOCK\nG1 X1 Y0 Z0\nM30\n",
        "PROC POCK SAVE\nTRANS X2\nM17\n",
        &[[26.4, 0.0, 0.0]],
    );
    check(
        "G18\nROT RPL=90\nG17\nPOCK\nG1 X1 Y0 Z0\nM30\n",
        "PROC POCK SAVE\nROT\nM17\n",
        &[[0.0, 0.0, -1.0]],
    );
}

#[test]
fn codes_and_the_settable_zero_come_back() {
    let text = |main: &str, sub: &str| {
        let flat = expanded(main, sub).unwrap();
        String::from_utf8(flat.file.bytes().to_vec()).unwrap()
    };
    assert_eq!(
        text(
            "G54\nG1 X1\nPOCK\nX2\n",
            "PROC POCK SAVE\nG505 X1\nG91 G18\nM17\n"
        ),
        "G54\nG1 X1\nG505 X1\nG91 G18\nG17 G90 G54\nX2\n"
    );
    // What the program did not state before, is what programs begin with, where that is known.
    assert_eq!(
        text("G1 X1\nPOCK\nX2\n", "PROC POCK SAVE\nG0 G91 X1\nM17\n"),
        "G1 X1\nG0 G91 X1\nG1 G90\nX2\n"
    );
    for code in ["G55", "ORIAXES"] {
        let faults = expanded(
            "G1 X1\nPOCK\nX2\n",
            &format!("PROC POCK SAVE\n{code}\nM17\n"),
        );
        let fault = faults.unwrap_err()[0].to_string();
        assert_eq!(
            fault,
            format!(
                "m.mpf, line 2: `POCK`: the subprogram states {code} and gives back at its end (SAVE) what was before, which the program does not state; state the code that holds before the call"
            )
        );
    }
}
