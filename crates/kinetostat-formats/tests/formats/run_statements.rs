//! Statements beside the motions of a run: values in place of names, loops without an end, accelerations that motions state.

use kinetostat_formats::*;

/// A program, and its statements, each with how many motions run before it.
type Case = (Language, &'static str, &'static [(&'static str, usize)]);

const CASES: [Case; 5] = [
    (
        Language::Krl,
        "DEF a()\nREAL nOwn\n$BASE={X 0,Y 0,Z 0,A 0,B 0,C 0}\n$TOOL={X 0,Y 0,Z 9,A 0,B 0,C 0}\n$VEL.CP=0.1\nnOwn=2\nLOOP\nWAIT SEC nOwn\n\
         $ACC.CP=nOwn*2\nPULSE($OUT[1],TRUE,nOwn)\nLIN {X 9,Y 0,Z 5,A 0,B 0,C 0}\nENDLOOP\nEND\n",
        &[
            ("A LOOP WITHOUT END", 0),
            ("WAIT SEC 2", 0),
            ("$ACC.CP=4", 0),
            ("PULSE($OUT[1],TRUE,2)", 0),
        ],
    ),
    (
        Language::Rapid,
        "MODULE A\nCONST num nRamp:=40;\nCONST num on:=1;\nPROC main()\nAccSet nRamp,50;\nSetDO on,on;\n\
         MoveL [[1,2,3],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v10,fine,tool0;\nWHILE TRUE DO\nmove;\nENDWHILE\nENDPROC\n\
         PROC move()\nSetDO doAir,1;\nMoveL [[9,2,3],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v10,fine,tool0;\nENDPROC\nENDMODULE\n",
        &[
            ("ACCSET 40,50", 0),
            ("SETDO 1,1", 0),
            ("A LOOP WITHOUT END", 1),
            ("SETDO DOAIR,1", 1),
        ],
    ),
    (
        Language::UrScript,
        "def part():\n  quick=2.5\n  movel(p[0.1,0.2,0.3,0,0,0])\n  while True:\n    movej(p[0.2,0.2,0.3,0,0,0])\n    movel(p[0.1,0.2,0.4,0,0,0],a=quick)\n  end\nend\n",
        &[
            ("QUICK=2.5", 0),
            ("ACCELERATION 1.2", 0),
            ("A LOOP WITHOUT END", 1),
            ("ACCELERATION 1.4", 1),
            ("ACCELERATION 2.5", 2),
        ],
    ),
    (
        Language::FanucLs,
        "/PROG A\n/MN\n 1:LBL[1] ;\n 2:DO[7]=ON ;\n 3:L P[1] 20mm/sec FINE ;\n 4:L P[2] 20mm/sec FINE ;\n 5:JMP LBL[1] ;\n/POS\n\
         P[1]{\n GP1:\n UF : 0, UT : 1, CONFIG : 'N U T, 0, 0, 0',\n X = 1 mm, Y = 0 mm, Z = 0 mm,\n W = 0 deg, P = 0 deg, R = 0 deg\n};\n\
         P[2]{\n GP1:\n UF : 0, UT : 1, CONFIG : 'N U T, 0, 0, 0',\n X = 9 mm, Y = 0 mm, Z = 0 mm,\n W = 0 deg, P = 0 deg, R = 0 deg\n};\n/END\n",
        &[("A LOOP WITHOUT END", 0), ("DO[7]=ON", 0)],
    ),
    (
        Language::Krl,
        "DEF a()\n$BASE={X 0,Y 0,Z 0,A 0,B 0,C 0}\n$TOOL={X 0,Y 0,Z 9,A 0,B 0,C 0}\n$VEL.CP=0.1\nSLIN {X 9,Y 0,Z 5,A 0,B 0,C 0}\nEND\n",
        &[],
    ),
];

#[test]
fn statements_have_the_values_of_their_run() {
    for (language, text, wanted) in CASES {
        let name = format!("a.{}", language.endings()[0]);
        let read = read(
            language,
            vec![SourceFile::new(name, text)],
            &ReadOptions::default(),
        );
        let program = read.unwrap_or_else(|errors| panic!("{text}: {errors:#?}"));
        let said = statements_of_run(&program);
        let mut said: Vec<(&str, usize)> = (said.iter())
            .map(|own| (own.text.as_str(), own.motions_before))
            .collect();
        let mut wanted = wanted.to_vec();
        if language == Language::FanucLs {
            said.retain(|(text, _)| !text.starts_with("LBL") && !text.starts_with("JMP"));
            said.sort_unstable();
            wanted.sort_unstable();
        }
        assert_eq!(said, wanted, "{text}");
        let is_spline = text.contains("SLIN");
        let law = options_of_motion(&program, &program.motions[0]);
        assert_eq!(law == "a spline motion", is_spline, "{law}");
    }
}
