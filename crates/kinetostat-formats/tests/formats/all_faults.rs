//! All faults of a program in one run: of its text and of its path, in order of lines.

use kinetostat_formats::*;

fn lines(language: Language, text: &str) -> Vec<(usize, String)> {
    let options = ReadOptions::default();
    let file = || vec![SourceFile::new("part.txt", text)];
    let all = all_faults(language, file(), &options);
    // What reading alone refuses is among them.
    match read(language, file(), &options) {
        Ok(program) => {
            let path = path_of(&program, &PathOptions::default());
            let of_path = path.err().unwrap_or_default();
            let all: Vec<String> = all.iter().map(ProgramFault::to_string).collect();
            let of_path: Vec<String> = of_path.iter().map(PathError::to_string).collect();
            assert_eq!(all, of_path);
        }
        Err(refused) => {
            for fault in &refused {
                let same = |own: &ProgramFault| own.to_string() == fault.to_string();
                assert!(all.iter().any(same), "{fault} is not among {all:#?}");
            }
        }
    }
    let of = |fault: &ProgramFault| (fault.place().1, fault.reason().to_owned());
    all.iter().map(of).collect()
}

#[track_caller]
fn assert_faults(language: Language, text: &str, expected: &[(usize, &str)]) {
    let found = lines(language, text);
    let are_those = found.len() == expected.len()
        && (found.iter().zip(expected))
            .all(|((line, reason), (at, part))| line == at && reason.contains(part));
    assert!(are_those, "{found:#?}");
}

#[test]
fn faults_of_text_and_path_come_together_in_order_of_lines() {
    let target = |x: f64| format!("[[{x},0,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]");
    let text = format!(
        "MODULE M\nPROC main()\nMoveL {0},[0,1,1,1],fine,tool0;\nMoveL nowhere,v20,fine,tool0;\nMoveL {1},v20,fine,tool0;\nMoveL {0},v20,fine,tool0;\nMoveC {2},{0},v20,fine,tool0;\nSearchL \\Stop,di1,p1,p2,v10,tool0;\nMoveC {2},{0},v20,fine,tool0;\nENDPROC\nENDMODULE\n",
        target(0.0),
        target(1e7),
        target(7.0)
    );
    assert_faults(
        Language::Rapid,
        &text,
        &[
            (3, "its speed is 0 mm/s"),
            (4, "no `nowhere` is declared"),
            (5, "farther"),
            (7, "a circle through a place that ends where it begins"),
            (8, "it ends where a signal changes"),
        ],
    );
    let place = |x: f64| format!("{{X {x},Y 0,Z 0,A 0,B 0,C 0}}");
    let text = format!(
        "DEF m()\n$BASE=$NULLFRAME\n$TOOL=$NULLFRAME\n$VEL.CP=-1\nLIN {0}\nLIN XNO\n$VEL.CP=0.1\nLIN {0}\nCIRC {1},{0}\nLIN {2}\nEND\n",
        place(0.0),
        place(5.0),
        place(2e6)
    );
    assert_faults(
        Language::Krl,
        &text,
        &[
            (5, "its speed is -1000 mm/s"),
            (6, "XNO"),
            (9, "a circle through a place that ends where it begins"),
            (10, "farther"),
        ],
    );
    let position = |number: usize, x: f64| {
        format!(
            "P[{number}]{{\n   GP1:\n\tUF : 0, UT : 0,\t\tCONFIG : 'N U T, 0, 0, 0',\n\tX = {x:.3}  mm,\tY = .000  mm,\tZ = .000  mm,\n\tW = 180.000 deg,\tP = .000 deg,\tR = .000 deg\n}};\n"
        )
    };
    let text = format!(
        "/PROG M\n/MN\n   1:L P[1] 0mm/sec FINE ;\n   2:L P[9] 20mm/sec FINE ;\n   3:L P[2] 20mm/sec FINE ;\n/POS\n{}{}/END\n",
        position(1, 0.0),
        position(2, 2e6)
    );
    assert_faults(
        Language::FanucLs,
        &text,
        &[
            (3, "its speed is 0 mm/s"),
            (4, "position P[9] is not in /POS"),
            (5, "farther"),
        ],
    );
}

/// Beside a motion that is refused nothing is said of what would follow from it.
#[test]
fn what_only_follows_from_a_fault_is_not_named() {
    let target = |x: f64| format!("[[{x},0,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]");
    // From where the circle starts, the motion between would say.
    let text = format!(
        "MODULE M\nPROC main()\nMoveL {0},v20,fine,tool0;\nMoveL nowhere,v20,fine,tool0;\nMoveC {1},{0},v20,fine,tool0;\nENDPROC\nENDMODULE\n",
        target(0.0),
        target(10.0)
    );
    assert_faults(Language::Rapid, &text, &[(4, "no `nowhere` is declared")]);
}

#[test]
fn programs_without_faults_and_other_languages() {
    for (language, text, expected) in [
        (
            Language::Krl,
            "DEF m()\nLIN {X 1,Y 2,Z 3,A 0,B 0,C 0}\nEND\n",
            0,
        ),
        (Language::Krl, "", 1),
        (Language::FanucLs, "", 1),
        (Language::Rapid, "", 1),
        (Language::Apt, "UNITS/MM\nGOTO/1,2,3\nGOTO/x,y,z\n", 1),
        (Language::Siemens, "G1 X1 F100\nG200\nG3 Q\n", 3),
    ] {
        let found = lines(language, text);
        assert_eq!(found.len(), expected, "{text}: {found:#?}");
    }
}
