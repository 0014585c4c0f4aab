//! What people wrote beside settings and positions comes along as comments.

use kinetostat_formats::*;

use super::text_of;

fn made(program: &RobotProgram, into: MakeLanguage) -> String {
    let robot = path_of(program, &PathOptions::default()).unwrap();
    text_of(
        &make_of_robot(program, &robot, &Template::default(), into).unwrap(),
        0,
    )
}

#[test]
fn comments_behind_settings_come_along() {
    let text = "DEF part()\n$BASE=$NULLFRAME ; the table\n$TOOL=$NULLFRAME;mill\n$VEL.CP=0.02 ; slow\n\
        LIN {X 0,Y 0,Z 50,A 0,B 0,C 180} ; above\nBAS(#VEL_CP,0.1) ;\nLIN {X 9,Y 0,Z 0,A 0,B 0,C 180}\nEND\n";
    let files = vec![SourceFile::new("part.src", text)];
    let program = read_krl(files, &ReadOptions::default()).unwrap();
    let rapid = made(&program, MakeLanguage::Rapid);
    let comments: Vec<&str> = (rapid.lines().map(str::trim))
        .filter(|line| line.starts_with("! line"))
        .collect();
    assert_eq!(
        comments,
        [
            "! line 2: the table",
            "! line 3: mill",
            "! line 4: slow",
            "! line 5: above"
        ]
    );
    let text = "MODULE M\nPERS tooldata t1:=[TRUE,[[0,0,1],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]]; ! the \"mill\"\n\
        CONST string s:=\"! no comment\";\nPROC main()\n\
        MoveL [[0,0,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,fine,t1;\nENDPROC\nENDMODULE\n";
    let files = vec![SourceFile::new("m.mod", text)];
    let program = read_rapid(files, &ReadOptions::default()).unwrap();
    let krl = made(&program, MakeLanguage::Krl);
    assert!(
        krl.contains("; line 2: ! the  mill\n") && !krl.contains("no comment"),
        "{krl}"
    );
}

#[test]
fn names_of_positions_come_along() {
    let head = "/PROG  PART\n/MN\n   1:  UFRAME_NUM=0 ;\n   2:  UTOOL_NUM=0 ;\n   3:J P[1:start] 10% FINE ;\n   4:L P[2] 20mm/sec FINE ;\n   5:L P[3] 20mm/sec FINE ;\n/POS\n";
    let position = |name: &str, x: u32| {
        format!(
            "P[{name}]{{\n   GP1:\n\tUF : 0, UT : 0,\t\tCONFIG : 'N U T, 0, 0, 0',\n\tX = {x} mm,\tY = 2 mm,\tZ = 3 mm,\n\tW = 180 deg,\tP = 0 deg,\tR = 0 deg\n}};\n"
        )
    };
    let positions = [
        position("1:\"start\"", 1),
        position("2:\"corner A\"", 5),
        position("3:\"\"", 9),
    ];
    let text = format!("{head}{}/END\n", positions.concat());
    let files = vec![SourceFile::new("part.ls", text)];
    let program = read_ls(files, &ReadOptions::default()).unwrap();
    let krl = made(&program, MakeLanguage::Krl);
    let lines: Vec<&str> = krl.lines().collect();
    let at = |says: &str| {
        lines
            .iter()
            .position(|line| line.starts_with(says))
            .unwrap()
    };
    assert_eq!(at("PTP {X 1.0"), at("; line 5: P[1]: start") + 1);
    assert!(at("; line 6: P[2]: corner A") < at("LIN {X 5.0"));
    assert_eq!(krl.matches(": P[").count(), 2, "{krl}");
}

#[test]
fn refused_lines_ascend() {
    let text = "DEF part()\n$BASE=$NULLFRAME\n$TOOL=$NULLFRAME\n$VEL.CP=0.02\n\
        LIN {X 1,Y 2,Z 3,A 0,B 0,C 0}\nEND\nDEF one()\n$BASE=$NULLFRAME\n$TOOL=$NULLFRAME\nLIN {X 5,Y 2,Z 3,A 0,B 0,C 0}\nEND\nDEF two()\n$BASE=$NULLFRAME\n$TOOL=$NULLFRAME\nLIN {X 5,Y 2,Z 3,A 0,B 0,C 0}\nEND\n";
    let files = vec![SourceFile::new("part.src", text)];
    let program = read_krl(files, &ReadOptions::default()).unwrap();
    let robot = path_of(&program, &PathOptions::default()).unwrap();
    let made = make_of_robot(&program, &robot, &Template::default(), MakeLanguage::Rapid);
    let lines: Vec<Option<usize>> = made.unwrap_err().iter().map(|fault| fault.line).collect();
    assert_eq!(lines, [Some(10), Some(15)]);
}
