//! Data that statements change while the program runs: what rests on them is refused by line, and what they leave is followed.

use kinetostat_formats::*;

const DATA: &str = "RECORD rec\n robtarget p;\nENDRECORD\n\
    PERS tooldata tool1:=[TRUE,[[0,0,100],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];\n\
    PERS wobjdata wobj1:=[FALSE,TRUE,\"\",[[0,0,0],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];\n\
    VAR speeddata speed1:=[50,500,5000,1000];\n\
    VAR zonedata zone1:=[FALSE,5,5,5,1,5,1];\n\
    VAR robtarget p10:=[[10,20,30],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
    VAR robtarget pa{1}:=[[[1,2,3],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]];\n\
    CONST robtarget p11:=[[11,0,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
    VAR num n:=1;\nVAR bool ok;\nVAR string s;";
const CHANGING: &str = "FUNC bool f(INOUT robtarget p)\np.trans.x:=3;\nRETURN TRUE;\nENDFUNC";

/// A program with a statement before three motions, and with a further routine; the lines of the motions behind the statement.
fn read_with(statement: &str, other: &str) -> (Result<RobotProgram, Vec<ProgramError>>, usize) {
    let head = format!("MODULE M\n{DATA}\nPROC main()\n{statement}\n");
    let first = head.lines().count() + 1;
    let text = format!(
        "{head}MoveJ p11,v500,fine,tool1\\WObj:=wobj1;\nMoveL p10,speed1,zone1,tool0;\nMoveL pa{{1}},v50,z1,tool0;\n\
         ENDPROC\n{other}\nENDMODULE\n"
    );
    let files = vec![SourceFile::new("m.mod", text)];
    (read_rapid(files, &ReadOptions::default()), first)
}

#[test]
fn components_and_whole_data_that_are_assigned_are_known() {
    for (statement, place) in [
        ("p10.trans.x := 5;", [5.0, 20.0, 30.0]),
        ("p10.trans := [1,2,3];", [1.0, 2.0, 3.0]),
        ("p10.trans := p11.trans + 2*[1,2,3];", [13.0, 4.0, 6.0]),
        ("p10.rot := OrientZYX(0,0,1);", [10.0, 20.0, 30.0]),
        ("p10.robconf.cf6 := 1;", [10.0, 20.0, 30.0]),
        ("p10 := Offs(p11,0,0,1);", [11.0, 0.0, 1.0]),
        ("p10 := p11;", [11.0, 0.0, 0.0]),
        ("IF n=1 p10.trans.x := 4;", [4.0, 20.0, 30.0]),
        (
            "FOR i FROM 1 TO 2 DO\np10.trans.x:=p10.trans.x+1;\nENDFOR",
            [12.0, 20.0, 30.0],
        ),
        ("Incr p10.trans.x;", [11.0, 20.0, 30.0]),
        ("Decr p10.trans.x;", [9.0, 20.0, 30.0]),
        ("Clear p10.trans.x;", [0.0, 20.0, 30.0]),
        ("Add p10.trans.x, 3;", [13.0, 20.0, 30.0]),
    ] {
        let program = read_with(statement, "").0.unwrap();
        let found = program.motions[1].target.pose().unwrap().position_mm;
        assert_eq!(found.as_slice(), place, "{statement}");
        // A correction is written in place of the name: what assigns it stays.
        let text = String::from_utf8(program.files[0].bytes().to_vec()).unwrap();
        let piece = Piece::to(1, found + nalgebra::Vector3::new(0.0, 0.0, 0.125));
        let written = super::written(&program, std::slice::from_ref(&piece));
        assert!(written.contains(statement) && written != text, "{written}");
        let again = super::program(&written).motions[1]
            .target
            .pose()
            .unwrap()
            .clone();
        assert!(
            (again.position_mm - piece.position_mm).norm() < 1e-9,
            "{written}"
        );
        let before = program.motions[1].target.pose().unwrap();
        assert!(again.orientation.angle_to(&before.orientation) < 2e-7);
        assert_eq!(again.configuration.numbers, before.configuration.numbers);
    }
    for statement in ["pa{1}.trans.x := 3;", "pa{n}.trans.x := 3;"] {
        let program = read_with(statement, "").0.unwrap();
        let found = program.motions[2].target.pose().unwrap().position_mm;
        assert_eq!(found.as_slice(), [3.0, 2.0, 3.0], "{statement}");
    }
    let frames = |statement: &str| {
        let program = read_with(statement, "").0.unwrap();
        let motion = &program.motions[0];
        let of = |frame: &FrameUse| frame.known().unwrap().translation.vector;
        (of(&motion.tool).z, of(&motion.work_object).x)
    };
    assert_eq!(frames("tool1.tframe.trans.z := 200;"), (200.0, 0.0));
    assert_eq!(frames("wobj1.uframe.trans.x := 3;"), (100.0, 3.0));
    assert_eq!(frames("wobj1.oframe := [[1,2,3],[1,0,0,0]];"), (100.0, 1.0));
}

#[test]
fn what_only_the_controller_knows_is_refused_where_motions_need_it() {
    for (statement, reason) in [
        (
            "p10 := CRobT();",
            "`CRobT` is computed while the program runs",
        ),
        (
            "GetDataVal \"p11\", p10;",
            "`p10` is changed while the program runs",
        ),
        (
            "ok := StrToVal(s,p10);",
            "`p10` is changed while the program runs",
        ),
        (
            "ok := ownFunction(p10);",
            "`p10` is changed while the program runs",
        ),
        (
            "IF di1=1 p10.trans.x := 4;",
            "`p10` is changed while the program runs",
        ),
        // Of which routine this is, the run decides.
        ("%s% p10;", "`p10` is changed while the program runs"),
    ] {
        let (found, first) = read_with(statement, "");
        let errors = found.unwrap_err();
        assert_eq!(
            (errors.len(), errors[0].line),
            (1, first + 1),
            "{statement}: {errors:?}"
        );
        assert!(
            errors[0].reason.contains(reason),
            "{statement}: {}",
            errors[0]
        );
    }
    let (found, _) = read_with("", "TRAP t\np10:=p11;\nENDTRAP");
    let errors = found.unwrap_err();
    assert!(errors[0].reason.contains("by an interrupt"), "{errors:?}");
}

#[test]
fn what_routines_and_functions_change_is_followed() {
    for statement in [
        "ok := f(p10);",
        "IF f(p10) n := 1;",
        "IF n=2 THEN\nELSEIF f(p10) THEN\nENDIF",
        "WHILE NOT f(p10) DO\nENDWHILE",
        "TEST f(p10)\nCASE TRUE:\nENDTEST",
    ] {
        let (found, _) = read_with(statement, CHANGING);
        let program = found.unwrap_or_else(|errors| panic!("{statement}: {errors:?}"));
        let place = program.motions[1].target.pose().unwrap().position_mm;
        assert_eq!(place.as_slice(), [3.0, 20.0, 30.0], "{statement}");
    }
}

#[test]
fn functions_that_leave_their_arguments_are_followed() {
    for statement in [
        "n := Distance(p10.trans,p11.trans);",
        "s := ValToStr(p10);",
        "n := NumToStr(Abs(p10.trans.x)+(p10.trans.y),3);",
        "IF p10.trans.x>5 AND (p10.trans.y>3) n := 1;",
        "ok := g(p10);",
        "TPWrite \"x\"\\Pos:=p10.trans;",
        "VelSet 50, speed1.v_tcp;",
        "sub Offs(p10,0,0,3);",
    ] {
        let own = "FUNC bool g(robtarget p)\nRETURN p.trans.x>3;\nENDFUNC";
        let (found, _) = read_with(statement, own);
        let program = found.unwrap_or_else(|errors| panic!("{statement}: {errors:?}"));
        let place = program.motions[1].target.pose().unwrap().position_mm;
        assert_eq!(place.as_slice(), [10.0, 20.0, 30.0], "{statement}");
    }
}

#[test]
fn data_that_are_set_by_texts_are_refused_by_line() {
    for statement in [
        "SetDataVal \"p10\", p11;",
        "SetAllDataVal \"robtarget\", p11;",
    ] {
        let (found, first) = read_with(statement, "");
        let errors = found.unwrap_err();
        assert_eq!((errors.len(), errors[0].line), (1, first - 1), "{errors:?}");
        assert!(
            errors[0].reason.contains("by names that are texts"),
            "{}",
            errors[0]
        );
    }
}

#[test]
fn speeds_and_zones_that_change_are_known() {
    for (statement, known) in [
        ("speed1.v_tcp := 70;", Some(70.0)),
        ("speed1 := v100;", Some(100.0)),
        ("speed1.v_tcp := 30*n;\nn:=n+1;", Some(30.0)),
        ("Incr speed1.v_tcp;", Some(51.0)),
        ("own speed1;", None),
    ] {
        let (found, _) = read_with(statement, "");
        assert_eq!(
            found.unwrap().motions[1].speed.mm_per_s,
            known,
            "{statement}"
        );
    }
    let (found, _) = read_with("zone1.pzone_tcp := 50;", "");
    let program = found.unwrap();
    assert_eq!(program.motions[1].zone, Zone::Radius(50.0));
    assert_eq!(program.motions[1].speed.mm_per_s, Some(50.0));
}

/// Speeds, mm/s, of the motions of a program in RAPID.
fn speeds(text: &str) -> Vec<Option<f64>> {
    let text = format!(
        "MODULE M\nCONST robtarget a:=[[1,2,3],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n{text}\nENDMODULE\n"
    );
    let files = vec![SourceFile::new("m.mod", text)];
    let program = read_rapid(files, &ReadOptions::default()).unwrap();
    program
        .motions
        .iter()
        .map(|motion| motion.speed.mm_per_s)
        .collect()
}

#[test]
fn speeds_that_are_assigned_in_straight_lines_are_followed() {
    let move_s = "MoveL a,s,fine,tool0;";
    let s = "VAR speeddata s:=[500,501,502,503];\n";
    let text = format!(
        "{s}PROC main()\n{move_s}\ns.v_tcp:=20;\n{move_s}\ns:=[200,30,502,503];\n{move_s}\ns:=v50;\n{move_s}\ns.v_ori:=9;\n{move_s}\nENDPROC"
    );
    assert_eq!(speeds(&text), [500.0, 20.0, 200.0, 50.0, 50.0].map(Some));
    // Every routine of a program that sets the speed of the tip itself.
    let parts = format!(
        "{s}PROC main()\none;\ntwo;\nENDPROC\nPROC one()\ns.v_tcp:=20;\n{move_s}\nENDPROC\nPROC two()\ns.v_tcp:=30;\n{move_s}\nENDPROC"
    );
    assert_eq!(speeds(&parts), [20.0, 30.0].map(Some));
    for (body, known) in [
        ("IF ok s.v_tcp:=20;\nMOVE", Some(500.0)),
        (
            "s.v_tcp:=20;\nsub;\nMOVE\nENDPROC\nPROC sub()\ns.v_tcp:=30;",
            Some(30.0),
        ),
        ("s.v_tcp:=20;\nsub;\nENDPROC\nPROC sub()\nMOVE", Some(20.0)),
        ("s.v_tcp:=n+7;\nMOVE", Some(7.0)),
        (
            "s.v_tcp:=20;\nsub s;\nMOVE\nENDPROC\nPROC sub(INOUT speeddata p)\np.v_tcp:=30;",
            Some(30.0),
        ),
        (
            "s.v_tcp:=20;\nMOVE\nENDPROC\nTRAP t\ns.v_tcp:=30;\nENDTRAP\nPROC other()",
            None,
        ),
        ("s.v_tcp:=DInput(di1);\nMOVE", None),
        ("s.v_tcp:=20;\nMOVE", Some(20.0)),
    ] {
        let body = body.replace("MOVE", move_s);
        let text = format!("{s}VAR bool ok;\nVAR num n;\nPROC main()\n{body}\nENDPROC");
        assert_eq!(speeds(&text), [known], "{body}");
    }
}

/// Constants stand for numbers and their lists.
#[test]
fn constants_are_followed() {
    let read = |data: &str, motion: &str| {
        let text = format!("MODULE M\n{data}\nPROC main()\n{motion}\nENDPROC\nENDMODULE\n");
        read_rapid(
            vec![SourceFile::new("m.mod", text)],
            &ReadOptions::default(),
        )
    };
    let none = "[9E9,9E9,9E9,9E9,9E9,9E9]";
    let data = format!(
        "CONST num cz:=5;\nCONST num dz:=cz;\nVAR num v:=7;\nCONST pos place:=[1,2,cz];\nCONST orient down:=[0,1,0,0];\nCONST confdata c:=[0,-1,0,1];\n\
         CONST extjoint no:={none};\nCONST robtarget p1:=[[1,2,dz],[0,1,0,0],[0,-1,0,1],{none}];\nCONST robtarget p2:=p1;\nPERS num q:=5;"
    );
    for end in [
        format!("[[1,2,cz],[0,1,0,0],[0,-1,0,1],{none}]"),
        format!("[[1,2,dz],down,[0,-1,0,1],{none}]"),
        "[place,down,c,no]".to_owned(),
        "p1".to_owned(),
        "p2".to_owned(),
        "Offs(p2,0,0,dz)".to_owned(),
        "RelTool([place,down,c,no],0,0,-cz)".to_owned(),
        format!("[[1,2,5],OrientZYX(0,0,180),c,{none}]"),
    ] {
        let end = end.replace("-cz", "-5");
        let program = read(&data, &format!("MoveL {end},v100,fine,tool0;"));
        let program = program.unwrap_or_else(|errors| panic!("{end}: {errors:?}"));
        let pose = program.motions[0].target.pose().unwrap();
        let z = if end.starts_with("Offs") || end.starts_with("Rel") {
            10.0
        } else {
            5.0
        };
        let place: [f64; 3] = pose.position_mm.into();
        assert!(
            place
                .iter()
                .zip([1.0, 2.0, z])
                .all(|(one, other)| (one - other).abs() < 1e-12),
            "{end}: {place:?}"
        );
        assert_eq!(pose.configuration.numbers, [0.0, -1.0, 0.0, 1.0], "{end}");
        let down = nalgebra::UnitQuaternion::from_axis_angle(
            &nalgebra::Vector3::x_axis(),
            std::f64::consts::PI,
        );
        assert!(pose.orientation.angle_to(&down) < 1e-12, "{end}");
    }
    // About z, then the new y, then the new x: the new x of the tool is that of the first two turns.
    let end = format!("[place,OrientZYX(90,30,20),c,{none}]");
    let program = read(&data, &format!("MoveL {end},v100,fine,tool0;")).unwrap();
    let turn = program.motions[0].target.pose().unwrap().orientation;
    let x = turn * nalgebra::Vector3::x();
    let (sine, cosine) = 30_f64.to_radians().sin_cos();
    assert!(
        (x - nalgebra::Vector3::new(0.0, cosine, -sine)).norm() < 1e-12,
        "{x}"
    );
    let y = turn * nalgebra::Vector3::y();
    // The new y lay along -x; it is raised by 20 deg towards the z of before.
    assert!((y.x + 20_f64.to_radians().cos()).abs() < 1e-12, "{y}");
    // Variables as they are then, and what is kept in the controller with a word.
    for (z, of, findings) in [("q", 5.0, 1), ("v", 8.0, 0), ("cz*2+v", 18.0, 0)] {
        let motion =
            format!("v:=v+1;\nMoveL [[1,2,{z}],[0,1,0,0],[0,0,0,0],{none}],v100,fine,tool0;");
        let program = read(&data, &motion).unwrap();
        let pose = program.motions[0].target.pose().unwrap();
        assert_eq!(pose.position_mm.z, of, "{z}");
        assert_eq!(program.findings.len(), findings, "{:?}", program.findings);
        // Numbers of the statement are changed in place, and names beside them stay.
        let written = super::written(&program, &[Piece::to(0, pose.position_mm)]);
        assert!(written.contains("],[0,1,0,0],[0,0,0,0],["), "{written}");
    }
    for end in [
        "[place,OrientZYX(1,2),c,no]".to_owned(),
        "[place,down,c]".to_owned(),
    ] {
        let program = read(&data, &format!("v:=v+1;\nMoveL {end},v100,fine,tool0;"));
        assert!(program.is_err(), "{end}");
    }
    // A constant that names itself ends.
    assert!(
        read(
            "CONST num a:=b;\nCONST num b:=a;",
            &format!("MoveL [[1,2,a],[0,1,0,0],[0,0,0,0],{none}],v100,fine,tool0;")
        )
        .is_err()
    );
}
