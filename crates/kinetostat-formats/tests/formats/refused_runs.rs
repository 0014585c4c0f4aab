//! Programs that are run once: all that is refused comes in one run, in the order of lines.

use kinetostat_formats::*;

/// Lines and reasons, of files by their names.
fn refused(language: Language, files: &[(&str, &str)]) -> Vec<(String, usize, String)> {
    let files = files.iter();
    let files = files.map(|(name, text)| SourceFile::new(*name, *text));
    let faults = expand(language, files.collect(), &ReadOptions::default()).unwrap_err();
    let all = faults.into_iter();
    all.map(|fault| (fault.file, fault.line, fault.reason))
        .collect()
}

fn lines(found: &[(String, usize, String)]) -> Vec<usize> {
    found.iter().map(|(_, line, _)| *line).collect()
}

#[test]
fn all_of_a_heidenhain_program() {
    let text = "BEGIN PGM X MM\nTOOL CALL 1 Z S5000\nL X+0 Y+0 Z+50 R0 FMAX M3\nCYCL DEF 208 BORE MILLING ~\nQ200=2 ~\nQ201=-10\n\
        L X+10 Y+10 M99\nL X+5\nFPOL X+0 Y+0\nCYCL DEF 262 THREAD MILLING ~\nQ335=10\nL X+20 Y+10 M99\n\
        TCH PROBE 0.0 REF. PLANE Q5 X-\nTCH PROBE 0.1 X+5 Y+0 Z-5\nPLANE RELATIV SPB+10 STAY\n\
        CALL PGM NOWHERE\nAPPR LT X+1 Y+1 LEN5 RL\nL X+3 Y+3 Z+0 F100\nEND PGM X MM\n";
    let found = refused(Language::Heidenhain, &[("x.h", text)]);
    assert_eq!(lines(&found), [7, 9, 12, 13, 14, 15, 17], "{found:?}");
    assert!(found[3].2.contains("probe"), "{found:?}");
    // A definition that is refused says nothing of its calls, and a value ends the list.
    let text = "BEGIN PGM A MM\nCYCL DEF 200 DRILLING ~\n Q200=Q9 ~\n Q201=-10\nL X+1 Y+1 Z+1 FMAX M99\nL X+2 M99\nL X+Q8\nQ1 = Q2\nL X+Q1\nEND PGM A MM\n";
    let files = vec![SourceFile::new("a.h", text)];
    let faults = expand(Language::Heidenhain, files, &ReadOptions::default()).unwrap_err();
    let found: Vec<usize> = faults.iter().map(|fault| fault.line).collect();
    assert_eq!(found, [2, 7, 8], "{faults:?}");
    assert!(
        faults[2]
            .remedy
            .ends_with("(the lines behind this one were not run: what they do depends on it)")
    );
    // In programs that are called, at their lines.
    let main = "BEGIN PGM A MM\nCALL PGM B\nL X+Q7\nEND PGM A MM\n";
    let sub = "BEGIN PGM B MM\nL X+Q9\nPLANE RELATIV SPB+10 STAY\nEND PGM B MM\n";
    let found = refused(Language::Heidenhain, &[("a.h", main), ("b.h", sub)]);
    let places: Vec<(&str, usize)> = found.iter().map(|(f, l, _)| (f.as_str(), *l)).collect();
    assert_eq!(places, [("a.h", 3), ("b.h", 2), ("b.h", 3)]);
}

#[test]
fn all_of_a_sinumerik_program() {
    let text = "G90 G17 G54\nG1 X0 Y0 Z0 F100\nNOSUCH\nCYCLE81(10,0,2)\nG1 X10 Y0 Z0\nBSPLINE X5\nX5 Y5\nMCALL POCKET3(1)\n\
        R1=5\nG1 X=R2\nIF R1==5\nTRAANG(5)\nENDIF\nX=R1 SCALE Z2\nL10 P2\nX(\nM30\n";
    let sub = "G1 X1\nX=R7\nRET\n";
    let found = refused(Language::Siemens, &[("m.mpf", text), ("L10.SPF", sub)]);
    let places: Vec<(&str, usize)> = found.iter().map(|(f, l, _)| (f.as_str(), *l)).collect();
    let main = [4, 6, 8, 10, 12, 14, 16].map(|line| ("m.mpf", line));
    assert_eq!(places, [&main[..], &[("L10.SPF", 2)]].concat(), "{found:?}");
    // What runs, or a value, depends on it.
    let found = refused(
        Language::Siemens,
        &[
            ("m.mpf", "BSPLINE\nL10\nIF R1==5\nX1\nENDIF\nBSPLINE\n"),
            ("L10.SPF", "RET\n"),
        ],
    );
    assert_eq!(lines(&found), [1, 3], "{found:?}");
    // A condition that cannot be read leaves nothing alone that closes it.
    let text = "L10\nIF (R1==\nX1\nELSE\nX2\nENDIF\nM30\n";
    let found = refused(Language::Siemens, &[("m.mpf", text), ("L10.SPF", "RET\n")]);
    assert_eq!(lines(&found), [2], "{found:?}");
}

#[test]
fn all_of_a_list_of_poses() {
    let text = "x_mm,y_mm,z_mm,qw,qx,qy,qz,speed_mm_per_s\n0,0,0,0,1,0,0,20\n1,nan,0,0,1,0,0,20\n2,0,0,0,1,0,0,-20\n3,0,0,0,1,0,0,0\n4,0,0,0,2,0,0,5\n";
    let files = vec![SourceFile::new("p.csv", text)];
    let faults = all_faults(Language::Poses, files, &ReadOptions::default());
    let found: Vec<usize> = faults.iter().map(|fault| fault.place().1).collect();
    assert_eq!(found, [3, 4, 5, 6], "{faults:?}");
}

/// A speed of zero keeps a motion out of the path, beside what reading refuses.
#[test]
fn speeds_come_with_what_reading_refuses() {
    let cases = [
        (
            Language::Siemens,
            "m.mpf",
            "G1 X0 Y0 Z0 F0\nBSPLINE\nG1 X5 F100\n",
            [1, 2],
        ),
        (
            Language::Heidenhain,
            "a.h",
            "BEGIN PGM A MM\nL X+1 Y+1 Z+1 F0\nFPOL X+0 Y+0\nEND PGM A MM\n",
            [2, 3],
        ),
        (
            Language::Apt,
            "a.apt",
            "UNITS/MM\nFEDRAT/0,MMPM\nGOTO/1,2,3\nGOFWD/L1\n",
            [3, 4],
        ),
    ];
    for (language, name, text, lines) in cases {
        let files = vec![SourceFile::new(name, text)];
        let faults = all_faults(language, files, &ReadOptions::default());
        let found: Vec<usize> = faults.iter().map(|fault| fault.place().1).collect();
        assert_eq!(found, lines, "{faults:?}");
    }
}
