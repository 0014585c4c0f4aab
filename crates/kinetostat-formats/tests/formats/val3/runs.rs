//! What a program does: frames, tools, speeds, loops, calls, arrays, and what the controller alone knows.

use std::collections::BTreeMap;

use kinetostat_formats::*;
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};

use super::{DATA, assert_close, data_of, files_with, places, program, program_of, read_with};

#[test]
fn a_motion_has_its_point_its_fathers_its_tool_and_its_description() {
    let program = program(
        "  movej(jHome,flange,mFast)\n  movel(pA, tMill, mCut) // groove\n  movej(pA[0],tMill,mFast)",
    );
    assert_eq!(program.motions.len(), 3);
    let [home, cut, back] = &program.motions[..] else {
        unreachable!()
    };
    assert_eq!(
        home.target,
        Target::Joints {
            values_deg: vec![0.0, 0.0, 90.0, 0.0, -45.5, 0.0]
        }
    );
    assert_eq!(
        (cut.line, &cut.kind, cut.zone, cut.follows),
        (6, &MotionKind::Linear, Zone::Exact, Some(0))
    );
    assert_eq!(
        (cut.speed.mm_per_s, back.speed.mm_per_s, back.zone),
        (Some(20.0), None, Zone::Unstated)
    );
    assert_eq!(
        (cut.tool.name.as_str(), cut.work_object.name.as_str()),
        ("tMill", "fPart[1]")
    );
    assert_eq!(cut.tool.known().unwrap().translation.z, 150.0);
    assert!(
        program
            .findings
            .iter()
            .any(|finding| finding.message.contains("`world` is taken as the base"))
    );
    let mut options = ReadOptions::default();
    options
        .frames
        .insert("world".into(), Isometry3::translation(0.0, 0.0, 375.0));
    let files = files_with("  movel(pA,tMill,mCut)", &[]);
    let raised = read_val3(files, &options).unwrap();
    assert_eq!(
        raised.motions[0].work_object.known().unwrap().translation.z,
        405.0
    );
    assert!(
        !raised
            .findings
            .iter()
            .any(|finding| finding.message.contains("`world`"))
    );
    // Behind a quarter turn about z.
    let father = cut.work_object.known().unwrap();
    assert_close(
        father.translation.vector.as_slice(),
        &[80.0, 10.0, 30.0],
        1e-9,
    );
    assert_eq!(
        cut.target.pose().unwrap().configuration.text,
        "lefty epositive wpositive"
    );
    assert!(
        program
            .findings
            .iter()
            .any(|finding| finding.message.contains("lengths are taken to be in mm"))
    );
}

#[test]
fn angles_turn_about_x_the_new_y_and_the_new_z() {
    for angles in [
        [10.0, 20.0, 30.0],
        [-170.0, 89.0, 5.0],
        [180.0, -60.0, 91.5],
        [33.0, 90.0, 12.0],
    ] {
        let [x, y, z] = angles.map(f64::to_radians);
        let about = |axis, angle| UnitQuaternion::from_axis_angle(&axis, angle);
        let expected =
            about(Vector3::x_axis(), x) * about(Vector3::y_axis(), y) * about(Vector3::z_axis(), z);
        let read = OrientationText::Xyz.rotation_of(&angles).unwrap();
        assert!(read.angle_to(&expected) < 1e-12, "{angles:?}");
        let back = OrientationText::Xyz.numbers_of(&read, &angles);
        assert_close(&back, &angles, 1e-6);
    }
}

#[test]
fn points_are_moved_by_appro_and_compose() {
    let program = program(
        "  movel(appro(pA,{0,0,-50,0,0,0}),tMill,mCut)\n  movel(compose(pA,fCell,{1,2,3,0,0,90}),tMill,mCut)",
    );
    // The tool points down: back along its z is up.
    assert_close(&places(&program)[0], &[600.5, 10.0, 100.0], 1e-9);
    let trsf = |x: f64, y: f64, z: f64, turn: f64| {
        let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), turn.to_radians());
        Isometry3::from_parts(Translation3::new(x, y, z), turn)
    };
    let (cell, part) = (trsf(100.0, 0.0, 0.0, 90.0), trsf(10.0, 20.0, 30.0, 0.0));
    let place = nalgebra::Point3::new(600.5, 10.0, 50.0);
    let moved = part.inverse() * trsf(1.0, 2.0, 3.0, 90.0) * part * place;
    assert_close(&places(&program)[1], moved.coords.as_slice(), 1e-9);
    assert_eq!(
        program.motions[1].base_pose().unwrap().translation.vector,
        (cell * part * moved).coords
    );
}

#[test]
fn loops_calls_branches_and_arrays_are_run() {
    let row = (
        "row",
        "    <Parameters xmlns=\"http://www.staubli.com/robotics/VAL3/Param/1\">\n      <Parameter name=\"x_p\" type=\"pointRx\" use=\"reference\" xsi:type=\"element\" />\n      <Parameter name=\"x_n\" type=\"num\" use=\"value\" xsi:type=\"element\" />\n    </Parameters>\n    <Locals>\n      <Local name=\"l_p\" type=\"pointRx\" xsi:type=\"array\" size=\"1\" />\n    </Locals>\n",
        "  l_p = x_p\n  l_p.trsf.z = l_p.trsf.z + x_n\n  switch x_n\n    case 0, 1\n      movel(l_p,tMill,mCut)\n    break\n    default\n      movej(l_p,tMill,mFast)\n    break\n  endSwitch",
    );
    let start = "  for nCount = 0 to 2 step 2\n    call row(pRow[nCount],nCount)\n  endFor\n  nCount=1\n  while nCount<3 and !(nCount==2)\n    movel(pRow[nCount],tMill,mCut)\n    nCount=nCount+1\n  endWhile\n  do\n    nCount=nCount-1\n  until nCount<=0\n  if nCount!=0\n    movel(pA,tMill,mCut)\n  elseIf nCount==0\n    movel(pRow,tMill,mCut)\n  endIf";
    let read = read_val3(files_with(start, &[row]), &ReadOptions::default());
    let program = read.unwrap_or_else(|errors| panic!("{errors:#?}"));
    assert_eq!(
        places(&program),
        [
            [610.0, 0.0, 50.0],
            [630.0, 0.0, 2.0],
            [620.0, 0.0, 50.0],
            [610.0, 0.0, 50.0]
        ]
    );
    let kinds: Vec<bool> = program
        .motions
        .iter()
        .map(|motion| motion.kind == MotionKind::Joint)
        .collect();
    assert_eq!(kinds, [false, true, false, false]);
}

#[test]
fn files_of_older_controllers_are_read_alike() {
    let data = "<?xml version=\"1.0\"?>\n<dataList xmlns=\"DataNameSpace\">\n <frameSection><frame name=\"fP\"><fFather alias=\"\" name=\"world\" fatherIndex=\"0\"/><valueFrame index=\"0\"><tfValue x=\"1\" y=\"2\" z=\"3\" rx=\"0\" ry=\"0\" rz=\"0\"/></valueFrame></frame></frameSection>\n <mdescSection><mdesc name=\"m\"><valueMdesc index=\"0\"><mdescValue accel=\"100\" vel=\"10\" decel=\"100\" tmax=\"99999\" rmax=\"99999\" blend=\"joint\" leave=\"5\" reach=\"8\"/></valueMdesc></mdesc></mdescSection>\n <pointSection><point name=\"p\"><pFather alias=\"\" name=\"fP\" fatherIndex=\"0\"/><valuePoint index=\"0\"><tpValue x=\"10.5\" y=\"20\" z=\"30\" rx=\"0\" ry=\"0\" rz=\"0\"/><cpValue shoulder=\"ssame\" elbow=\"esame\" wrist=\"wsame\"/></valuePoint></point></pointSection>\n</dataList>\n";
    let start = "<?xml version=\"1.0\"?>\n<programList xmlns=\"ProgramNameSpace\">\n <program name=\"start\"><description/><paramSection/><localSection/><source><code>begin\n  if 1 &lt;= 2 and 3&gt;2\n    put(&quot;a &lt; b // no comment&quot;)\n    movel(p,flange,m)\n  endIf\nend\n</code></source></program>\n</programList>\n";
    let files = vec![
        SourceFile::new("start.pgx", start),
        SourceFile::new("cell.dtx", data),
    ];
    let program =
        read_val3(files, &ReadOptions::default()).unwrap_or_else(|errors| panic!("{errors:#?}"));
    let motion = &program.motions[0];
    assert_eq!(
        (motion.zone, motion.speed.mm_per_s),
        (Zone::Radius(8.0), None)
    );
    assert_eq!(
        motion.base_pose().unwrap().translation.vector,
        Vector3::new(11.5, 22.0, 33.0)
    );
    let text = super::written(&program, &[Piece::to(0, Vector3::new(10.6, 20.0, 30.0))]);
    assert_eq!(
        text,
        [start.to_owned(), data.replace("x=\"10.5\"", "x=\"10.600\"")]
    );
}

#[test]
fn what_only_the_controller_knows_is_refused_and_may_be_stated() {
    let statements =
        "  if bGo==true\n    movel(pA,tMill,mCut)\n  endIf\n  movel(pRow[dioGet(dIn)],tMill,mCut)";
    let errors = read_with(statements).unwrap_err();
    let lines: Vec<usize> = errors.iter().map(|error| error.line).collect();
    assert_eq!(lines, [5, 8], "{errors:#?}");
    assert!(errors[0].remedy.contains("--set"));
    let mut options = ReadOptions::default();
    options.values = BTreeMap::from([
        ("bGo".into(), StatedValue::Truth(true)),
        ("dioGet".into(), StatedValue::Number(1.0)),
    ]);
    let program = read_val3(files_with(statements, &[]), &options).unwrap();
    assert_eq!(places(&program), [[600.5, 10.0, 50.0], [620.0, 0.0, 50.0]]);
    // An element is stated by its index, from 0.
    options
        .values
        .insert("nList[1]".into(), StatedValue::Number(2.0));
    let data = format!(
        "{DATA}    <Data name=\"nList\" access=\"private\" xsi:type=\"array\" type=\"num\" size=\"3\" />\n"
    );
    let start = program_of("start", "", "  movel(pRow[nList[1]],tMill,mCut)");
    let files = vec![
        SourceFile::new("start.pgx", start),
        SourceFile::new("cell.dtx", data_of(&data)),
    ];
    assert_eq!(
        places(&read_val3(files, &options).unwrap()),
        [[630.0, 0.0, 0.0]]
    );
}

#[test]
fn what_moves_frames_or_motions_is_refused_by_its_line() {
    let moving = ("work", "", "  movel(pA,tMill,mCut)");
    for (statements, said) in [
        ("  link(pA,fCell)", "frame of points"),
        ("  alterMovel(pA,tMill,mCut)", "not followed"),
        (
            "  movel(pA,tMill,mCut)\n  resetMotion()",
            "drops the motions",
        ),
        ("  taskCreate \"w\",50,work()", "while others run"),
        (
            "  movel(here(tMill,fCell),tMill,mCut)",
            "computed while the program runs",
        ),
        ("  movel(pNone,tMill,mCut)", "no `pNone` is declared"),
        ("  movel(pA,tMill)", "its tool and its description"),
        (
            "  nCount=abs(movel(pA,tMill,mCut))",
            "stands within a statement",
        ),
    ] {
        let files = files_with(statements, &[moving]);
        let errors = read_val3(files, &ReadOptions::default()).expect_err(statements);
        let line = 4 + statements.lines().count();
        assert!(
            errors
                .iter()
                .any(|error| error.line == line && error.reason.contains(said)),
            "{statements}: {errors:#?}"
        );
    }
    // Behind their ends no motions are dropped; the number of a motion is lost.
    let program = program("  nCount=movel(pA,tMill,mCut)\n  waitEndMove()\n  resetMotion()");
    assert_eq!(program.motions.len(), 1);
}

#[test]
fn every_row_is_what_the_reader_does() {
    let (mut carried, mut refused) = (0, 0);
    for row in VAL3_STATEMENTS {
        let found = read_with(&format!("  {}(\"x\")", row.name));
        match row.treatment {
            Treatment::Carried => {
                let program = found.unwrap_or_else(|errors| panic!("{} {errors:?}", row.name));
                assert!(
                    !program
                        .findings
                        .iter()
                        .any(|finding| finding.message.contains("in none of the files")),
                    "{}",
                    row.name
                );
                carried += 1;
            }
            Treatment::Refused { reason, .. } => {
                let errors = found.expect_err(row.name);
                assert_eq!(
                    (errors.len(), errors[0].line, errors[0].reason.as_str()),
                    (1, 5, reason)
                );
                refused += 1;
            }
            Treatment::Understood => {}
        }
    }
    assert!(carried > 35 && refused > 20);
    let names: Vec<String> = VAL3_STATEMENTS
        .iter()
        .map(|row| row.name.to_ascii_uppercase())
        .collect();
    assert!(names.windows(2).all(|pair| pair[0] < pair[1]));
}
