//! Programs that are run once and written flat.

use kinetostat_formats::internal::expand_siemens_within as expand_within;
use kinetostat_formats::*;
use kinetostat_testing::largest_size;

fn flat_of(files: &[(&str, &str)]) -> FlatText {
    let files: Vec<SourceFile> = files
        .iter()
        .map(|(name, text)| SourceFile::new(*name, *text))
        .collect();
    expand_siemens(&files).unwrap_or_else(|errors| panic!("{errors:?}"))
}

fn flat(text: &str) -> String {
    let found = flat_of(&[("main.mpf", text)]);
    assert!(found.changed);
    let lines = found
        .file
        .bytes()
        .iter()
        .filter(|byte| **byte == b'\n')
        .count();
    assert_eq!(lines, found.origins.len());
    String::from_utf8(found.file.bytes().to_vec()).unwrap()
}

fn fault(text: &str) -> String {
    let files = [SourceFile::new("main.mpf", text)];
    expand_within(&files, 10_000).unwrap_err()[0].to_string()
}

#[test]
fn what_runs_straight_on_comes_back_byte_for_byte() {
    for text in [
        super::EVERYTHING,
        "",
        "G1 X1\r\n; a\r\n",
        "\n\n",
        "R1=5\nX=R1",
        "CYCLE90(1)\n",
    ] {
        let found = flat_of(&[("main.mpf", text), ("other.spf", "M17")]);
        assert!(!found.changed, "{text}");
        assert_eq!(found.file.bytes(), text.as_bytes());
        assert_eq!(found.origins.len(), found.file.line_count());
    }
}

#[test]
fn loops_and_branches() {
    let cases = [
        ("FOR R1=1 TO 3\nX=R1*10\nENDFOR\n", "X=10\nX=20\nX=30\n"),
        ("FOR R1=5 TO 3\nX1\nENDFOR\nX2\n", "X2\n"),
        ("R1=0\nWHILE R1<2\nX=R1\nR1=R1+1\nENDWHILE\n", "X=0\nX=1\n"),
        (
            "R1=0\nREPEAT\nR1=R1+1 X=R1\nUNTIL R1>=2\nY1\n",
            " X=1\n X=2\nY1\n",
        ),
        (
            "R1=0\nLOOP\nR1=R1+1\nIF R1>2 GOTOF OUT\nX=R1\nENDLOOP\nOUT: Y1\n",
            "X=1\nX=2\nY1\n",
        ),
        (
            "R1=2\nIF R1==1\nX1\nELSE\nIF (R1==2) AND NOT (R1==3)\nX2\nENDIF\nENDIF\nX3\n",
            "X2\nX3\n",
        ),
        ("R1=1\nIF R1==1\nX1\nELSE\nX2\nENDIF\n", "X1\n"),
        ("GOTOF N30\nN20 X2\nN30 X3\n", "N30 X3\n"),
        (
            "R1=0\nMARK:\nX=R1\nR1=R1+1\nIF R1<2 GOTOB MARK\n",
            "X=0\nX=1\n",
        ),
        (
            "R1=2\nCASE R1 OF 1 GOTOF ALL 2 GOTOF BIT DEFAULT GOTOF CUT\nALL: X1\nBIT: X2\nCUT: X3\n",
            "X2\nX3\n",
        ),
        (
            "BEGIN: X1\nX2\nREPEAT BEGIN P=2\nX3\n",
            "X1\nX2\nX1\nX2\nX1\nX2\nX3\n",
        ),
        (
            "AA: X1\nX2\nBB: X3\nX4\nREPEAT AA BB\nX5\n",
            "X1\nX2\nX3\nX4\nX1\nX2\nX3\nX5\n",
        ),
        ("AA: X1\nX2\nREPEATB AA P=2\nX5\n", "X1\nX2\nX1\nX1\nX5\n"),
        (
            "AA: X1\nENDLABEL: X2\nX3\nREPEAT AA\nX5\n",
            "X1\nX2\nX3\nX1\nX2\nX5\n",
        ),
        (
            "DEF INT IDX, A[2]\nA[1]=2.6\nFOR IDX=0 TO 1\nX=A[IDX]\nENDFOR\n",
            "X=0\nX=3\n",
        ),
    ];
    for (text, expected) in cases {
        assert_eq!(flat(text), expected, "{text}");
    }
}

#[test]
fn numbers_of_expressions() {
    let cases = [
        ("SIN(30)", "0.5"),
        ("ATAN2(1,1)", "45"),
        ("POT(3)+SQRT(16)", "13"),
        ("ACOS(0)-ASIN(1)+TAN(45)", "1"),
        ("7 DIV 2 + 7 MOD 4", "6"),
        ("ROUND(2.5)+TRUNC(-2.7)+ABS(-1)", "2"),
        ("-R9*2", "-10"),
        ("2+3*4", "14"),
        ("'H1F'+'B101'", "36"),
        ("1.5EX2+0", "150"),
        ("R[9]", "5"),
        ("MINVAL(3,2)*MAXVAL(3,2)", "6"),
        ("1/3", "0.333333333"),
    ];
    for (expression, expected) in cases {
        let text = format!("R9=5\nFOR R8=1 TO 1\nX={expression} Y1 ; note\nENDFOR\n");
        assert_eq!(
            flat(&text),
            format!("X={expected} Y1 ; note\n"),
            "{expression}"
        );
    }
}

#[test]
fn subprograms_by_name_and_number() {
    let main = "%_N_MAIN_MPF\n;$PATH=/_N_MPF_DIR\nDEF REAL FOUND\nHOLE(5,FOUND) ; twice\nX=FOUND\nL10 P2\nL10\nCALLED\nM30\n";
    let hole = "%_N_HOLE_SPF\nPROC HOLE(REAL DEPTH, VAR REAL BACK, INT COUNT=2) SAVE\nG91 G1 Z=-DEPTH\nBACK=DEPTH*COUNT\nM17\n";
    let found = flat_of(&[
        ("HOLE.SPF", hole),
        ("MAIN.MPF", main),
        ("L10.SPF", "Y1\nRET\n"),
        ("_N_CALLED_SPF", "; nothing\nG0 Y2 M17"),
    ]);
    let text = String::from_utf8(found.file.bytes().to_vec()).unwrap();
    assert_eq!(
        text,
        "%_N_MAIN_MPF\n;$PATH=/_N_MPF_DIR\nG91 G1 Z=-5\nG90\nX=10\nY1\nY1\nY1\n; nothing\nG0 Y2\nM30\n"
    );
    assert_eq!(found.origins[2], (0, 3));
    assert_eq!(found.origins[9], (3, 2));
    // SAVE puts codes back that were stated before.
    let found = flat_of(&[
        ("m.mpf", "G90 G0 X1\nSUB1\nX2\n"),
        ("SUB1.SPF", "PROC SUB1 SAVE\nG91 G1 X5\nRET\n"),
    ]);
    assert_eq!(found.file.bytes(), b"G90 G0 X1\nG91 G1 X5\nG0 G90\nX2\n");
}

#[test]
fn drilling_cycles() {
    let drilled = |call: &str| flat(&format!("G17 G0 X0 Y0 Z10 F100\n{call}\nX9\n"));
    let head = "G17 G0 X0 Y0 Z10 F100\n";
    assert_eq!(
        drilled("CYCLE82(10,0,2,-8,,0.5)"),
        format!("{head}G0 Z=AC(2)\nG1 Z=AC(-8)\nG4 F0.5\nG0 Z=AC(10)\nX9\n")
    );
    // DPR counts from the reference plane.
    assert_eq!(
        drilled("CYCLE81(10,1,2,,8)"),
        format!("{head}G0 Z=AC(3)\nG1 G9 Z=AC(-7)\nG0 Z=AC(10)\nX9\n")
    );
    // Three steps of 10; the last two are equal where the rest is shorter than the least.
    assert_eq!(
        drilled("CYCLE83(5,0,1,-30,,-10,,0,0,0,1,1)"),
        format!(
            "{head}G0 Z=AC(1)\nG1 Z=AC(-10)\nG0 Z=AC(1)\nG0 Z=AC(-9.4)\nG1 Z=AC(-20)\nG0 Z=AC(1)\nG0 Z=AC(-19.4)\n\
             G1 Z=AC(-25)\nG0 Z=AC(1)\nG0 Z=AC(-24.4)\nG1 Z=AC(-30)\nG0 Z=AC(5)\nX9\n"
        )
    );
    // Steps that become shorter, chips broken: back by 1 mm at the feed of the program.
    assert_eq!(
        drilled("CYCLE83(5,0,1,-20,,,10,3,0,0,0.5,0)"),
        format!(
            "{head}G0 Z=AC(1)\nG1 Z=AC(-10) F50\nG1 Z=AC(-9) F100\nG1 Z=AC(-17)\nG1 Z=AC(-16)\nG1 Z=AC(-20)\nG0 Z=AC(5)\nX9\n"
        )
    );
    // The last bits of sums make no further step: 0.05, 0.03, 0.02 and 0.02 are 0.12.
    assert_eq!(
        drilled("CYCLE83(5,1.17,1,,0.12,,0.05,0.02,0,0,1,0)"),
        format!(
            "{head}G0 Z=AC(2.17)\nG1 Z=AC(1.12)\nG1 Z=AC(2.12)\nG1 Z=AC(1.09)\nG1 Z=AC(2.09)\nG1 Z=AC(1.07)\nG1 Z=AC(2.07)\nG1 Z=AC(1.05)\nG0 Z=AC(5)\nX9\n"
        )
    );
    // _VRT states by how much; in inches 1 mm and 0.6 mm are that, too.
    assert_eq!(
        drilled("CYCLE83(5,0,1,-12,,,10,0,0,0,1,0,3,0,0.25,0,0)"),
        format!("{head}G0 Z=AC(1)\nG1 Z=AC(-10)\nG1 Z=AC(-9.75)\nG1 Z=AC(-12)\nG0 Z=AC(5)\nX9\n")
    );
    let places = |call: &str| {
        let text = flat(&format!("G70\n{call}\n"));
        let lines = text.lines().skip(1);
        let places = lines.map(|line| line[8..line.len() - 1].parse::<f64>().unwrap());
        places.collect::<Vec<_>>()
    };
    for (vari, between) in [
        (0, vec![-1.0 + 1.0 / 25.4]),
        (1, vec![0.5, -1.0 + 0.6 / 25.4]),
    ] {
        let found = places(&format!("CYCLE83(2,0,0.5,-1.5,,,1,0,0,0,1,{vari})"));
        let expected = [vec![0.5, -1.0], between, vec![-1.5, 2.0]].concat();
        assert_eq!(found.len(), expected.len(), "{found:?}");
        let off = largest_size(found.iter().zip(&expected).map(|(a, b)| a - b));
        assert!(off < 1e-9, "{found:?} {expected:?}");
    }
    // At each place, until MCALL alone; the code of before is stated again.
    assert_eq!(
        flat("G18 G1 X0 F100\nMCALL CYCLE81(10,0,2,-5)\nX10\nZ20 M8\nMCALL\nX30\n"),
        "G18 G1 X0 F100\nX10\nG0 Y=AC(2)\nG1 G9 Y=AC(-5)\nG0 Y=AC(10)\nG1\nZ20 M8\nG0 Y=AC(2)\nG1 G9 Y=AC(-5)\nG0 Y=AC(10)\nG1\nX30\n"
    );
}

#[test]
fn what_cannot_be_run_is_refused_by_line() {
    let cases = [
        (
            "LOOP\nR1=1\nENDLOOP\n",
            "line 3: `ENDLOOP`: the loop that goes back here does not end",
        ),
        (
            "AA:\nX1\nGOTOB AA\n",
            "line 3: `GOTOB AA`: the loop that goes back here does not end",
        ),
        // The outer one, and not what runs in it, or is called there.
        (
            "X1\nLOOP\nFOR R1=1 TO 3\nX=R1\nENDFOR\nENDLOOP\n",
            "line 6: `ENDLOOP`",
        ),
        ("IF R1==1\nX1\n", "line 1: `IF R1==1`: it is not closed"),
        ("ENDWHILE\n", "nothing that it closes is open"),
        (
            "IF R1==1 GOTOF AA\nX1\n",
            "`R1` has no value that this program gives it",
        ),
        ("GOTOF AA\nX1\n", "the jump has no destination"),
        ("CALL \"A\"\n", "what is called is stated by a text"),
        (
            "MCALL DRILL(5)\n",
            "what it calls at each place, is not followed",
        ),
        ("CYCLE81(10,0,2)\n", "no depth is stated (DP or DPR)"),
        (
            "CYCLE81(10,0,2,5)\n",
            "the hole does not go from the reference plane away",
        ),
        (
            "CYCLE82(10,0,2,-5,,0,0,1,1)\n",
            "an argument behind those that are followed is not zero",
        ),
        ("CYCLE83(10,0,2,-5)\n", "no first depth is stated"),
        (
            "CYCLE83(5,0,1,-20,,,10,-0.1,0,0,1,0)\n",
            "more than 1000 steps",
        ),
        (
            "FOR R1=1 TO 2\nDEF AXIS ALL\nENDFOR\n",
            "variables of axes and frames are not followed",
        ),
        ("GOTOS\n", "it is not followed"),
        (
            "AA: X1\nREPEAT AA P=10000000\n",
            "line 2: `REPEAT AA P=10000000`: it is to run 10000000 times, and that is no whole number from 1 to 9999",
        ),
        ("AA: X1\nREPEAT AA P=4e9\n", "line 2"),
        ("AA: X1\nREPEAT AA P=10000\n", "from 1 to 9999"),
        ("AA: X1\nREPEAT AA P=0\n", "it is to run 0 times"),
        ("AA: X1\nREPEATB AA P=-1\n", "it is to run -1 times"),
        ("AA: X1\nREPEAT AA P=2.5\n", "it is to run 2.5 times"),
        (
            "R1=0\nAA: X1\nREPEAT AA P=R1\n",
            "line 3: `REPEAT AA P=R1`: it is to run 0 times",
        ),
        ("N10 X1\nGOTOF N20.5\nN20 X2\n", "line 2"),
        ("REPEAT AA P=2\n", "the label of the section is not there"),
        ("X1 GOTOF AA\nAA:\n", "it does not stand alone in its block"),
    ];
    for (text, part) in cases {
        let found = fault(text);
        assert!(found.contains(part), "{text}: {found}");
    }
}

/// Taps and borings are the control's own: their calls stay, over each hole.
#[test]
fn cycles_of_the_control_stay_over_their_holes() {
    let text = "G90 G0 X0 Y0 Z50\nR1=3\nG1 F60\nMCALL CYCLE84(R1,0,2,-30,,,3,,1.25,0,500,500)\nX10\nY55\nMCALL\nX70\nM30\n";
    let flat = flat_of(&[("m.mpf", text)]);
    let hole = "G0 Z=AC(2)\nCYCLE84(3,0,2,-30,,,3,,1.25,0,500,500)\nG0 Z=AC(3)\nG1\n";
    let expected = format!("G90 G0 X0 Y0 Z50\nG1 F60\nX10\n{hole}Y55\n{hole}X70\nM30\n");
    assert_eq!(String::from_utf8_lossy(flat.file.bytes()), expected);
    let program = read_siemens(vec![flat.file], &ReadOptions::default()).unwrap();
    let ends: Vec<[f64; 3]> = program
        .motions
        .iter()
        .map(|motion| motion.target.pose().unwrap().position_mm.into())
        .collect();
    let over = |x: f64, y: f64| [[x, y, 2.0], [x, y, 3.0]];
    assert_eq!(ends[..2], [[0.0, 0.0, 50.0], [10.0, 0.0, 50.0]]);
    assert_eq!(ends[2..4], over(10.0, 0.0));
    assert_eq!(ends[5..7], over(10.0, 55.0));
    assert_eq!(ends[7], [70.0, 55.0, 3.0]);
    // The way from the end of the cycle, which the control knows, is not known.
    assert_eq!(program.motions[3].follows, None);
    let told = program
        .findings
        .iter()
        .filter(|told| told.message.contains("CYCLE84 stays"));
    assert_eq!(told.count(), 2);
    let path = path_of(&program, &PathOptions::default()).unwrap().path;
    assert_eq!(path.unjudged_feed_on, Some(5));
    for text in [
        "G0 X0 Z5\nCYCLE84(3,0,2,-30)\n",
        "G91 G0 X0 Y0 Z5\nCYCLE84(3,0,2,-30)\n",
    ] {
        let files = vec![SourceFile::new("m.mpf", text)];
        let refused = read_siemens(files, &ReadOptions::default()).unwrap_err();
        assert!(refused.iter().any(|fault| fault.line == 2), "{refused:?}");
    }
}

#[test]
fn rows_and_circles_of_holes() {
    let hole = "G0 Z=AC(2)\nG1 G9 Z=AC(-5)\nG0 Z=AC(10)\n";
    let of = |pattern: &str| {
        let text = format!("G0 X0 Y0 Z10 F100\nMCALL CYCLE81(10,0,2,-5)\n{pattern}\nMCALL\nM30\n");
        let flat = flat_of(&[("m.mpf", &text)]);
        let text = String::from_utf8_lossy(flat.file.bytes()).replace(hole, "");
        let places = text.strip_prefix("G0 X0 Y0 Z10 F100\n").unwrap();
        places.strip_suffix("M30\n").unwrap().to_owned()
    };
    assert_eq!(
        of("HOLES1(20,30,90,10,25,3)"),
        "G0 X=AC(20) Y=AC(40)\nG0 X=AC(20) Y=AC(65)\nG0 X=AC(20) Y=AC(90)\n"
    );
    assert_eq!(
        of("HOLES2(5,6,10,0,,4)"),
        "G0 X=AC(15) Y=AC(6)\nG0 X=AC(5) Y=AC(16)\nG0 X=AC(-5) Y=AC(6)\nG0 X=AC(5) Y=AC(-4)\n"
    );
    assert_eq!(
        of("HOLES2(0,0,10,90,90,2)"),
        "G0 X=AC(0) Y=AC(10)\nG0 X=AC(-10) Y=AC(0)\n"
    );
    assert!(fault("HOLES1(20,30,90,10,25,3)\n").contains("no cycle is in force"));
    assert!(fault("MCALL CYCLE81(10,0,2,-5)\nHOLES1(20,30,90,10,25,0)\n").contains("(NUM)"));
}

/// A subprogram under MCALL runs behind each block with a place, and not within itself.
#[test]
fn a_subprogram_runs_at_each_place() {
    let main = "G0 X0 Y0 Z9\nMCALL DRILL(4)\nX10\nF100\nY20\nMCALL\nX30\nM30\n";
    let sub = "PROC DRILL(REAL DEPTH)\nG1 X=IC(1) Z=-DEPTH\nG0 Z9\nRET\n";
    let flat = flat_of(&[("m.mpf", main), ("DRILL.SPF", sub)]);
    let expected =
        "G0 X0 Y0 Z9\nX10\nG1 X=IC(1) Z=-4\nG0 Z9\nF100\nY20\nG1 X=IC(1) Z=-4\nG0 Z9\nX30\nM30\n";
    assert_eq!(String::from_utf8_lossy(flat.file.bytes()), expected);
    let main = SourceFile::new("m.mpf", main);
    assert_eq!(called_files(Language::Siemens, &main), ["DRILL.SPF"]);
}

#[test]
fn calls_without_a_file_stay_with_their_values() {
    let text = "G0 X1\nR1=5\nHOLE(R1,\"A\")\nIF R1==5\nPCALL OTHER P2\nENDIF\nL6\nM30\n";
    let flat = flat_of(&[("m.mpf", text)]);
    let expected = "G0 X1\nHOLE(5,\"A\")\nPCALL OTHER P2\nL6\nM30\n";
    assert_eq!(String::from_utf8_lossy(flat.file.bytes()), expected);
    // What is not run calls nothing.
    let text = "R1=0\nIF R1==1\nHOLE(5)\nENDIF\nM30\n";
    assert_eq!(flat_of(&[("m.mpf", text)]).file.bytes(), b"M30\n");
}

#[test]
fn values_that_the_machine_alone_knows_may_be_stated() {
    let text = "N1 G0 X0 Y0 Z5\nIF $AC_MEA==1 GOTOF AWAY\nG1 Z=-R7 F100\nWIDTH=WIDTH+1\nX=WIDTH\nAWAY: M30\n";
    let mut options = ReadOptions::default();
    for (name, value) in [("$ac_mea", 0.0), ("R7", 2.5), ("Width", 20.0), ("R9", 1.0)] {
        let value = StatedValue::Number(value);
        options.values.insert(name.to_owned(), value);
    }
    let files = vec![SourceFile::new("m.mpf", text)];
    let flat = expand(Language::Siemens, files.clone(), &options)
        .unwrap()
        .unwrap();
    let expected = "N1 G0 X0 Y0 Z5\nG1 Z=-2.5 F100\nX=21\nM30\n";
    assert_eq!(String::from_utf8_lossy(flat.file.bytes()), expected);
    let told: Vec<&str> = flat
        .findings
        .iter()
        .map(|told| told.message.as_str())
        .collect();
    assert!(
        told.iter()
            .any(|told| told.starts_with("`R7` is 2.5, as is stated")),
        "{told:?}"
    );
    assert!(
        told.contains(&"a value of `R9` is stated, and the program does not name it"),
        "{told:?}"
    );
    let without = expand(Language::Siemens, files, &ReadOptions::default()).unwrap_err();
    assert_eq!(without[0].line, 2);
}

#[test]
fn a_program_that_calls_itself_ends() {
    let files = [
        SourceFile::new("m.mpf", "SUB1\n"),
        SourceFile::new("SUB1.SPF", "SUB1\n"),
    ];
    let found = expand_siemens(&files).unwrap_err();
    assert!(
        found[0]
            .to_string()
            .contains("more than 18 programs call one another")
    );
}

#[test]
fn a_flat_program_is_read_and_corrected() {
    let text = "R1=0\nG17 G54 G90 G94\nG0 X0 Y0 Z5\nLOOP\nR1=R1+5\nIF R1>20 GOTOF OUT\nTRANS Z=R1/10\nG1 X=R1 Z-1 F600\nENDLOOP\nOUT:\nM30\n";
    let flat = flat_of(&[("m.mpf", text)]);
    let program = read_siemens(vec![flat.file], &ReadOptions::default()).unwrap();
    assert_eq!(program.motions.len(), 5);
    for (index, x) in [5.0, 10.0, 15.0, 20.0].into_iter().enumerate() {
        let [found, _, z] = super::place(&program, index + 1);
        assert!((found - x).abs() < 1e-12 && (z - (x / 10.0 - 1.0)).abs() < 1e-12);
    }
}

/// What of CYCLE83 is not certain is named with its lines, once; what it does not need is not.
#[test]
fn doubts_of_deep_holes_are_noted_by_line() {
    let notes = |text: &str| -> Vec<(usize, String)> {
        let found = flat_of(&[("main.mpf", text)]).findings;
        let notes = found.into_iter().map(|found| (found.line, found.message));
        notes.collect()
    };
    let begun = "G17 G90 G0 X0 Y0 Z10\nF100\n";
    let breaks = "CYCLE83(5,0,1,-30,,-10,,0,0,0,1,0)\n";
    let found = notes(&format!("{begun}{breaks}X5\n{breaks}"));
    assert_eq!(found.len(), 2, "{found:?}");
    for (word, (line, message)) in ["breaks chips (VARI=0)", "without DAM"].iter().zip(found) {
        let fits = message.contains(word) && message.ends_with("(lines 3, 5)");
        assert!(line == 3 && fits, "{message}");
    }
    // Out of the hole by G0, and steps that become shorter; a hole of one step; other cycles.
    for certain in [
        "CYCLE83(5,0,1,-30,,-10,,2,0,0,1,1)\n",
        "CYCLE83(5,0,1,-10,,-10,,0,0,0,1,0)\n",
        "CYCLE81(5,0,1,-10)\n",
    ] {
        assert_eq!(notes(&format!("{begun}{certain}")), [], "{certain}");
    }
}

#[test]
fn a_subprogram_runs_a_whole_number_of_times() {
    let runs = |count: &str| {
        let main = format!("G0 X1\nHOLE {count}\nM30\n");
        let files = [("m.mpf", main.as_str()), ("hole.spf", "X2\nM17\n")];
        expand_siemens(&files.map(|(name, text)| SourceFile::new(name, text)))
    };
    assert_eq!(
        runs("P3").unwrap().file.bytes(),
        b"G0 X1\nX2\nX2\nX2\nM30\n"
    );
    for count in ["P0", "P=-1", "P=2.5", "P10000"] {
        let found = runs(count).unwrap_err();
        assert_eq!((found.len(), found[0].line), (1, 2), "{count}: {found:?}");
        assert!(
            found[0].reason.contains("no whole number from 1 to 9999"),
            "{found:?}"
        );
    }
}

#[test]
fn of_two_subprograms_of_one_name_none_is_taken() {
    let files = [
        ("m.mpf", "G0 X1\nHOLE\nM30\n"),
        ("a/hole.spf", "; a\nPROC HOLE\nX2\nM17\n"),
        ("b/HOLE.SPF", "PROC HOLE\nX3\nM17\n"),
    ];
    let found = expand_siemens(&files.map(|(name, text)| SourceFile::new(name, text))).unwrap_err();
    assert_eq!(found.len(), 1, "{found:?}");
    let both = "b/HOLE.SPF, line 1: `PROC HOLE`: a call cannot tell this program from that of the same name in a/hole.spf, line 2; give one of them alone";
    assert!(found[0].to_string().contains(both), "{found:?}");
}
