//! One rule for all languages: what a program calls and none of its files holds is taken not to move the tool, and said so; the caller may say
//! that it moves.

use kinetostat_formats::*;

/// A program with a call: its language and file, the text before the call, the call, the text behind it; the name that is called.
type Calling = (Language, &'static str, [&'static str; 3], &'static str);

const PROGRAMS: [Calling; 7] = [
    (
        Language::Siemens,
        "a.mpf",
        ["G90 G0 X0 Y0 Z5\n", "WARM(3)\n", "G1 Z-1 F600\nX10\nM30\n"],
        "WARM",
    ),
    (
        Language::Siemens,
        "a.mpf",
        [
            "G90 G0 X0 Y0 Z5\n",
            "PCALL L6 P2\n",
            "G1 Z-1 F600\nX10\nM30\n",
        ],
        "L6",
    ),
    (
        Language::Heidenhain,
        "a.h",
        [
            "BEGIN PGM A MM\nL X+0 Y+0 Z+5 R0 FMAX\n",
            "CALL PGM TNC:\\WARM.H\n",
            "L Z-1 F600\nL X+10\nEND PGM A MM\n",
        ],
        "TNC:\\WARM.H",
    ),
    (
        Language::Krl,
        "a.src",
        [
            "DEF a()\nLIN {X 0,Y 0,Z 5,A 0,B 0,C 180}\n",
            "WARM(3)\n",
            "LIN {X 0,Y 0,Z -1,A 0,B 0,C 180}\nEND\n",
        ],
        "WARM",
    ),
    (
        Language::Rapid,
        "a.mod",
        [
            "MODULE M\nPROC main()\nMoveL [[0,0,5],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,fine,tool0;\n",
            "WARM 3;\n",
            "MoveL [[0,0,-1],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,fine,tool0;\nENDPROC\nENDMODULE\n",
        ],
        "WARM",
    ),
    (
        Language::UrScript,
        "a.script",
        [
            "movel(p[0.4,0,0.3,3.14159,0,0],1.2,0.1)\n",
            "warm(3)\n",
            "movel(p[0.4,0,0.2,3.14159,0,0],1.2,0.1)\n",
        ],
        "warm",
    ),
    (
        Language::FanucLs,
        "a.ls",
        [
            "/PROG A\n/MN\n:L P[1] 10mm/sec FINE ;\n",
            ":CALL WARM(3) ;\n",
            ":L P[2] 10mm/sec FINE ;\n/POS\nP[1]{\nGP1:\nUF : 0, UT : 1, CONFIG : 'N U T, 0, 0, 0',\nX = 0 mm, Y = 0 mm, Z = 5 mm,\nW = 180 deg, P = 0 deg, R = 0 deg\n};\n\
             P[2]{\nGP1:\nUF : 0, UT : 1, CONFIG : 'N U T, 0, 0, 0',\nX = 0 mm, Y = 0 mm, Z = -1 mm,\nW = 180 deg, P = 0 deg, R = 0 deg\n};\n/END\n",
        ],
        "WARM",
    ),
];

#[test]
fn what_no_file_holds_is_taken_not_to_move_the_tool() {
    for (language, name, [before, call, behind], called) in PROGRAMS {
        let of = |text: String, options: &ReadOptions| {
            read(language, vec![SourceFile::new(name, text)], options)
        };
        let options = ReadOptions::default();
        let with = of([before, call, behind].concat(), &options).unwrap();
        let without = of([before, behind].concat(), &options).unwrap();
        let targets = |program: &RobotProgram| {
            let motions = program.motions.iter();
            motions
                .map(|motion| motion.target.clone())
                .collect::<Vec<_>>()
        };
        assert!(targets(&with).len() > 1);
        assert_eq!(targets(&with), targets(&without), "{call}");
        let line = before.lines().count() + 1;
        let told: Vec<(String, usize)> = (with.calls_taken_to_stay().into_iter())
            .map(|(name, line)| (name.to_ascii_uppercase(), line))
            .collect();
        assert_eq!(told, [(called.to_ascii_uppercase(), line)], "{call}");
        assert!(without.calls_taken_to_stay().is_empty());
        let mut moves = ReadOptions::default();
        moves.moving_calls.insert(called.to_ascii_lowercase());
        let refused = of([before, call, behind].concat(), &moves).unwrap_err();
        assert_eq!(refused[0].line, line, "{call}");
        assert!(
            refused[0].reason.contains("moves the tool, as is stated"),
            "{refused:?}"
        );
    }
}

/// A file of that name is run, or the program is refused: its motions are not passed over.
#[test]
fn what_a_file_holds_is_not_passed_over() {
    let sub = [
        ("WARM.SPF", "PROC WARM(INT N)\nG1 X5\nRET\n"),
        ("L6.SPF", "G1 X5\nRET\n"),
        ("WARM.H", "BEGIN PGM WARM MM\nL X+5\nEND PGM WARM MM\n"),
    ];
    for ((language, name, parts, _), (file, text)) in PROGRAMS.into_iter().zip(sub) {
        let files = vec![
            SourceFile::new(name, parts.concat()),
            SourceFile::new(file, text),
        ];
        assert!(read(language, files.clone(), &ReadOptions::default()).is_err());
        let flat = expand(language, files, &ReadOptions::default())
            .unwrap()
            .unwrap();
        let flat = String::from_utf8_lossy(flat.file.bytes()).into_owned();
        assert!(flat.contains("X5") || flat.contains("X+5"), "{flat}");
    }
}
