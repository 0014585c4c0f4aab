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

#[track_caller]
fn refused(statement: &str, other: &str, line: usize, name: &str) {
    let (found, first) = read_with(statement, other);
    let errors = found.err().unwrap_or_default();
    let is_said = format!("`{name}` is changed while the program runs");
    let lines: Vec<usize> = errors.iter().map(|error| error.line - first).collect();
    assert_eq!(lines, [line], "{statement}: {errors:?}");
    assert!(errors[0].reason.contains(&is_said), "{}", errors[0]);
}

#[test]
fn components_and_whole_data_that_are_assigned_are_refused_where_motions_need_them() {
    for statement in [
        "p10.trans.x := 5;",
        "p10.trans := [1,2,3];",
        "p10.rot := OrientZYX(0,0,1);",
        "p10.robconf.cf6 := 1;",
        "p10.extax.eax_a := 5;",
        "p10 := Offs(p11,0,0,1);",
        "p10 := p11;",
        "p10 := CRobT();",
        "IF n=1 p10.trans.x := 4;",
        "FOR i FROM 1 TO 2 DO\np10.trans.x:=p10.trans.x+1;\nENDFOR",
        "Incr p10.trans.x;",
        "Decr p10.trans.x;",
        "Clear p10.trans.x;",
        "Add p10.trans.x, 3;",
        "GetDataVal \"p11\", p10;",
    ] {
        refused(statement, "", 1, "p10");
    }
    refused("pa{1}.trans.x := 3;", "", 2, "pa");
    refused("pa{n} := p11;", "", 2, "pa");
    refused("tool1.tframe.trans.z := 200;", "", 0, "tool1");
    refused("wobj1.uframe.trans.x := 3;", "", 0, "wobj1");
    refused("wobj1.oframe := [[1,2,3],[1,0,0,0]];", "", 0, "wobj1");
    for other in [
        "PROC sub()\np10.trans.x:=3;\nENDPROC",
        "TRAP t\np10:=p11;\nENDTRAP",
    ] {
        refused("", other, 1, "p10");
    }
}

#[test]
fn what_routines_and_functions_may_change_is_refused() {
    for statement in [
        "ok := f(p10);",
        "IF f(p10) n := 1;",
        "IF n=2 THEN\nELSEIF f(p10) THEN\nENDIF",
        "WHILE NOT f(p10) DO\nENDWHILE",
        "TEST f(p10)\nCASE TRUE:\nENDTEST",
        "RETURN;\nok := (n=1 AND f(p10));",
    ] {
        refused(statement, CHANGING, 1, "p10");
    }
    // Of the controller, and of a module that is not given.
    refused("ok := StrToVal(s,p10);", "", 1, "p10");
    refused("ok := ownFunction(p10);", "", 1, "p10");
    // Of which routine this is, the run decides.
    refused("%s% p10;", CHANGING, 1, "p10");
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

/// What of speed and zone is known is known of no datum that changes.
#[test]
fn speeds_and_zones_that_change_are_not_known() {
    for statement in [
        "speed1.v_tcp := 70;",
        "speed1 := v100;",
        "Incr speed1.v_tcp;",
    ] {
        let (found, _) = read_with(statement, "");
        assert_eq!(
            found.unwrap().motions[1].speed.mm_per_s,
            None,
            "{statement}"
        );
    }
    let (found, _) = read_with("zone1.pzone_tcp := 50;", "");
    let program = found.unwrap();
    assert_eq!(program.motions[1].zone, Zone::Unstated);
    assert_eq!(program.motions[1].speed.mm_per_s, Some(50.0));
}
