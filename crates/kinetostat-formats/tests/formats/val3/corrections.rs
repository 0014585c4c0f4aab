//! Where a correction goes in the text.

use kinetostat_formats::*;
use nalgebra::{UnitQuaternion, Vector3};

use super::{DATA, assert_close, data_of, files_with, places, program, program_of, written};

fn at(motion: usize, place: [f64; 3]) -> Piece {
    Piece::to(motion, Vector3::from(place))
}

/// The program of written files.
fn again(texts: &[String]) -> RobotProgram {
    let names = ["start.pgx", "cell.dtx"];
    let files = names.iter().zip(texts);
    let files = files.map(|(name, text)| SourceFile::new(*name, text.as_str()));
    let read = read_val3(files.collect(), &ReadOptions::default());
    read.unwrap_or_else(|errors| panic!("{errors:#?}"))
}

#[test]
fn without_corrections_all_bytes_come_back() {
    let statements = "  movel(pA,tMill,mCut)\r\n\tmovec(pRow[0], pRow[1] ,tMill,mCut) // \u{fc}\r\n  movel(appro(pA,{0,0,-50,0,0,0}),tMill,mCut)";
    let files = files_with(statements, &[]);
    let program = read_val3(files.clone(), &ReadOptions::default()).unwrap();
    let bytes: Vec<Vec<u8>> = files.iter().map(|file| file.bytes().to_vec()).collect();
    let texts: Vec<Vec<u8>> = written(&program, &[])
        .into_iter()
        .map(String::into_bytes)
        .collect();
    assert_eq!(texts, bytes);
}

#[test]
fn numbers_of_a_point_are_edited_in_the_data() {
    let program = program("  movel(pA,tMill,mCut)");
    let end = program.motions[0].target.pose().unwrap().orientation;
    let mut piece = at(0, [600.4876, 10.0123, 50.5]);
    piece.orientation =
        Some(UnitQuaternion::from_axis_angle(&Vector3::x_axis(), 0.01_f64.to_radians()) * end);
    let texts = written(&program, &[piece.clone()]);
    assert_eq!(texts[0], program_of("start", "", "  movel(pA,tMill,mCut)"));
    let line =
        "x=\"600.488\" y=\"10.012\" z=\"50.500\" rx=\"180.01000\" ry=\"0\" rz=\"-90.00\" shoulder";
    assert!(texts[1].contains(line), "{}", texts[1]);
    let read = again(&texts);
    assert_close(&places(&read)[0], &[600.4876, 10.0123, 50.5], 5e-4);
    let turned = read.motions[0].target.pose().unwrap().orientation;
    assert!(turned.angle_to(&piece.orientation.unwrap()) < 1e-6);
}

#[test]
fn uses_that_differ_get_copies_in_the_data() {
    let program = program(
        "  movel(pA,tMill,mCut)\n  movel(pRow[1],tMill,mCut)\n  movel(pA[0],tMill,mCut)\n  movel(pRow[1],tMill,mCut)",
    );
    let wanted = [
        [600.0, 1.0, 2.0],
        [620.1, 0.0, 50.0],
        [600.0, 3.0, 4.0],
        [620.2, 0.0, 50.0],
    ];
    let pieces: Vec<Piece> = wanted
        .iter()
        .enumerate()
        .map(|(motion, place)| at(motion, *place))
        .collect();
    let texts = written(&program, &pieces);
    assert!(texts[0].contains("  movel(pA,tMill,mCut)\n  movel(pRow[1],tMill,mCut)\n  movel(pA_2[0],tMill,mCut)\n  movel(pRow_2,tMill,mCut)"), "{}", texts[0]);
    assert!(texts[1].contains("<Data name=\"pA_2\" access=\"private\" xsi:type=\"array\" type=\"pointRx\" size=\"1\">\n"), "{}", texts[1]);
    let row = "<Data access=\"private\" xsi:type=\"array\" type=\"pointRx\" size=\"1\" name=\"pRow_2\"><Value key=\"0\" x=\"620.200\" y=\"0\" z=\"50\" rx=\"180\" ry=\"0\" rz=\"0\" fatherId=\"fPart[1]\" /></Data>\n";
    assert!(texts[1].contains(row), "{}", texts[1]);
    for (found, place) in places(&again(&texts)).iter().zip(wanted) {
        assert_close(found, &place, 1e-9);
    }
}

#[test]
fn computed_and_incomplete_points_are_moved_by_appro() {
    let statements = "  movel(appro(pA,{0,0,-50,0,0,0}),tMill,mCut)\n  movel(pRow[2],tMill,mCut)\n  movel(compose(pA,fCell,{1,0,0,0,0,0}),tMill,mCut)";
    let program = program(statements);
    let mut wanted = places(&program);
    wanted.iter_mut().for_each(|place| place[2] += 0.125);
    let pieces: Vec<Piece> = wanted
        .iter()
        .enumerate()
        .map(|(motion, place)| at(motion, *place))
        .collect();
    let texts = written(&program, &pieces);
    assert!(
        texts[0].contains("movel(appro(pA,{0,0,-50.125,0,0,0}),tMill,mCut)"),
        "{}",
        texts[0]
    );
    assert!(
        texts[0].contains("movel(appro(pRow[2],{0,0,0.125,0,0,0}),tMill,mCut)"),
        "{}",
        texts[0]
    );
    assert!(
        texts[0].contains(
            "movel(appro(compose(pA,fCell,{1,0,0,0,0,0}),{0,0,-0.125,0,0,0}),tMill,mCut)"
        ),
        "{}",
        texts[0]
    );
    assert_eq!(texts[1], data_of(DATA));
    for (found, place) in places(&again(&texts)).iter().zip(&wanted) {
        assert_close(found, place, 1e-9);
    }
}

#[test]
fn pieces_stand_before_their_motion_and_circles_become_straight() {
    let program = program(
        "  movel(pRow[0],tMill,mCut)\n  movel(pA,tMill,mCut)\n  movec(appro(pA,{5,5,0,0,0,0}), pRow[1], tMill, mCut) // arc",
    );
    // A point of the circle is computed from `pA`, which stays.
    let pieces = [
        at(1, [605.0, 5.0, 50.0]),
        at(1, [600.5, 10.0, 50.1]),
        at(2, [612.0, 5.0, 50.2]),
        at(2, [620.0, 0.0, 50.3]),
    ];
    let texts = written(&program, &pieces);
    let expected = "  movel(pRow[0],tMill,mCut)\n  movel(pA_2,tMill,mCut)\n  movel(pA_3,tMill,mCut)\n  movel(pRow_2, tMill, mCut)\n  movel(pRow[1], tMill, mCut) // arc";
    assert!(texts[0].contains(expected), "{}", texts[0]);
    let read = again(&texts);
    let ends = [
        [610.0, 0.0, 50.0],
        [605.0, 5.0, 50.0],
        [600.5, 10.0, 50.1],
        [612.0, 5.0, 50.2],
        [620.0, 0.0, 50.3],
    ];
    for (found, place) in places(&read).iter().zip(ends) {
        assert_close(found, &place, 1e-9);
    }
    assert!(
        read.motions
            .iter()
            .all(|motion| motion.kind == MotionKind::Linear)
    );
}

#[test]
fn circles_are_divided_into_circles() {
    let program = program(
        "  movel(pRow[0],tMill,mCut)\n  movec(appro(pA,{5,5,0,0,0,0}), pRow[1], tMill, mCut)",
    );
    let mut pieces = [at(1, [612.0, 5.0, 50.0]), at(1, [620.0, 0.0, 50.0])];
    pieces[0].via_mm = Some(Vector3::new(611.0, 3.0, 50.0));
    pieces[1].via_mm = Some(Vector3::new(617.0, 4.0, 50.0));
    let texts = written(&program, &pieces);
    let read = again(&texts);
    assert_eq!(read.motions.len(), 3);
    for (motion, piece) in read.motions[1..].iter().zip(pieces) {
        let MotionKind::Circular { via } = &motion.kind else {
            panic!("{}", texts[0])
        };
        let (via, end) = (via.pose().unwrap(), motion.target.pose().unwrap());
        assert!((via.position_mm - piece.via_mm.unwrap()).norm() < 1e-3);
        assert!((end.position_mm - piece.position_mm).norm() < 1e-3);
    }
}

#[test]
fn an_element_with_its_index_is_moved_by_appro() {
    let data = DATA.replace(" z=\"50\" rx=\"180\" ry=\"0\" rz=\"-90.00\"", "");
    let files = vec![
        SourceFile::new(
            "start.pgx",
            program_of("start", "", "  movel(pA[0] ,tMill,mCut)"),
        ),
        SourceFile::new("cell.dtx", data_of(&data)),
    ];
    let program = read_val3(files, &ReadOptions::default()).unwrap();
    let texts = written(&program, &[at(0, [600.6, 10.1, 0.2])]);
    let line = "  movel(appro(pA[0],{0.1,0.1,0.2,0,0,0}) ,tMill,mCut)";
    assert!(texts[0].contains(line), "{}", texts[0]);
    assert_close(&places(&again(&texts))[0], &[600.6, 10.1, 0.2], 1e-9);
}

#[test]
fn a_program_with_loops_is_written_flat() {
    let row = ("row", "", "  movel(pRow[nCount],tMill,mCut)");
    let files = files_with("  for nCount=0 to 1\n    call row()\n  endFor", &[row]);
    let flat = expand(Language::Val3, files, &ReadOptions::default())
        .unwrap()
        .unwrap();
    let text = String::from_utf8(flat.file.bytes().to_vec()).unwrap();
    let lines: Vec<&str> = text
        .lines()
        .map(str::trim)
        .filter(|line| line.starts_with('n') || line.starts_with("movel"))
        .collect();
    assert_eq!(
        lines,
        [
            "nCount=0",
            "movel(pRow[nCount],tMill,mCut)",
            "nCount=1",
            "movel(pRow[nCount],tMill,mCut)"
        ]
    );
    let program = again(&[text, data_of(DATA)]);
    let texts = written(
        &program,
        &[at(0, [610.1, 0.0, 50.0]), at(1, [620.1, 0.0, 50.0])],
    );
    assert_eq!(
        places(&again(&texts)),
        [[610.1, 0.0, 50.0], [620.1, 0.0, 50.0]]
    );
}
