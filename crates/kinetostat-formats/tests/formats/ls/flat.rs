//! Programs that are run once and written flat.

use kinetostat_formats::*;

use super::{position, stating, with_lines};

const OTHER: &str = "/PROG  GROOVE\n/ATTR\nLINE_COUNT = 4;\n/MN\n   1:L P[AR[1]] 20mm/sec FINE ;\n   2:  R[9]=R[9]+AR[2] ;\n   3:  ! AR[2] ;\n   4:L P[2] R[9]mm/sec FINE ;\n/POS\n";

fn files(lines: &[&str]) -> Vec<SourceFile> {
    let other = OTHER.to_owned()
        + &position(1, [11.0, 0.0, 5.0])
        + &position(2, [12.0, 0.0, 5.0])
        + "/END\n";
    let mut files = vec![SourceFile::new("PART.LS", with_lines(lines))];
    if lines.iter().any(|line| line.contains("GROOVE")) {
        files.push(SourceFile::new("GROOVE.LS", other));
    }
    files
}

fn flat(lines: &[&str], values: &[(&str, &str)]) -> Result<String, String> {
    let flat = expand(Language::FanucLs, files(lines), &stating(values));
    let flat = flat.map_err(|errors| errors[0].to_string())?.unwrap();
    let text = String::from_utf8(flat.file.bytes().to_vec()).unwrap();
    assert_eq!(flat.origins.len(), text.lines().count(), "{text}");
    Ok(text)
}

fn read(text: impl Into<Vec<u8>>) -> RobotProgram {
    read_ls(
        vec![SourceFile::new("PART.LS", text)],
        &ReadOptions::default(),
    )
    .unwrap()
}

/// The lines between /MN and /POS.
fn lines_of(text: &str) -> Vec<&str> {
    let (_, behind) = text.split_once("/MN\n").unwrap();
    behind.split_once("/POS").unwrap().0.lines().collect()
}

#[test]
fn loops_branches_and_calls_are_written_as_they_ran() {
    let text = flat(
        &[
            "  R[9]=5 ;",
            "  FOR R[1]=1 TO 2 ;",
            "L P[R[1]] 20mm/sec FINE ;",
            "  CALL GROOVE(R[1],(-1)) ;",
            "  ENDFOR ;",
            "  IF R[9]=3,JMP LBL[7] ;",
            "L P[4] 20mm/sec FINE ;",
            "  LBL[7] ;",
            "  SELECT R[1]=1,CALL OUTSIDE ;",
            "         =2,CALL SPINDLE_OFF ;",
            "  IF (DI[3]=ON) THEN ;",
            "  DO[1]=ON ;",
            "  ENDIF ;",
            "J P[3] 50% FINE ;",
            "  END ;",
            "L P[4] 20mm/sec FINE ;",
        ],
        &[],
    )
    .unwrap();
    assert_eq!(
        lines_of(&text),
        [
            "   1:  R[9]=5 ;",
            "   2:R[1]=1 ;",
            "   3:L P[R[1]] 20mm/sec FINE ;",
            "   4:L P[5] 20mm/sec FINE ;",
            "   5:  R[9]=R[9]+(-1) ;",
            "   6:  ! AR[2] ;",
            "   7:L P[6] R[9]mm/sec FINE ;",
            "   8:R[1]=2 ;",
            "   9:L P[R[1]] 20mm/sec FINE ;",
            "  10:L P[6] 20mm/sec FINE ;",
            "  11:  R[9]=R[9]+(-1) ;",
            "  12:  ! AR[2] ;",
            "  13:L P[6] R[9]mm/sec FINE ;",
            "  14:CALL SPINDLE_OFF ;",
            "  15:  IF (DI[3]=ON) THEN ;",
            "  16:  DO[1]=ON ;",
            "  17:  ENDIF ;",
            "  18:J P[3] 50% FINE ;",
            "  19:  END ;",
        ]
    );
    assert!(text.contains("LINE_COUNT\t= 19;"), "{text}");
    let program = read(text);
    let ends = program
        .motions
        .iter()
        .map(|motion| motion.target.pose().unwrap().position_mm.x);
    assert_eq!(
        ends.collect::<Vec<_>>(),
        [100.0, 11.0, 12.0, 200.0, 12.0, 12.0, 300.0]
    );
    assert_eq!(program.motions[5].speed.mm_per_s, Some(3.0));
    assert!(
        program
            .motions
            .iter()
            .all(|motion| motion.runs == Runs::Once)
    );
}

/// A loop whose passes need other corrections is written flat, and takes them.
#[test]
fn each_pass_takes_its_own_correction() {
    let lines = [
        "  FOR R[1]=1 TO 3 ;",
        "L P[1] 20mm/sec FINE ;",
        "L P[2] 20mm/sec FINE ;",
        "  ENDFOR ;",
    ];
    let text = flat(&lines, &[]).unwrap();
    let program = read(text);
    let pieces: Vec<Piece> = (program.motions.iter().enumerate())
        .map(|(index, motion)| {
            let mut place = motion.target.pose().unwrap().position_mm;
            place.z += 0.01 * index as f64;
            Piece::to(index, place)
        })
        .collect();
    let written = write(&program, &pieces, &WriteOptions::default()).unwrap();
    let again = read_ls(
        vec![SourceFile::new("PART.LS", written[0].1.clone())],
        &ReadOptions::default(),
    )
    .unwrap();
    let heights = again
        .motions
        .iter()
        .map(|motion| motion.target.pose().unwrap().position_mm.z);
    assert_eq!(
        heights.collect::<Vec<_>>(),
        [5.0, 5.01, 5.02, 5.03, 5.04, 5.05]
    );
}

#[test]
fn what_lines_alone_cannot_say_is_refused() {
    for (lines, why) in [
        (
            &[
                "  LBL[1] ;",
                "  R[5]=R[5]+1 ;",
                "  IF DI[1]=OFF,JMP LBL[1] ;",
                "L P[1] 20mm/sec FINE ;",
            ][..],
            "how often a loop runs",
        ),
        (
            &[
                "  IF DI[1]=OFF,JMP LBL[9] ;",
                "L P[1] 20mm/sec FINE ;",
                "  END ;",
                "  LBL[9] ;",
                "  DO[1]=ON ;",
            ][..],
            "there is no such label",
        ),
        (
            &["  CALL GROOVE(R[3],2) ;"][..],
            "which position it uses is not known",
        ),
    ] {
        let refused = flat(lines, &[]).unwrap_err();
        assert!(refused.contains(why), "{refused}");
    }
    let plain = ["  UFRAME_NUM=2 ;", "L P[1] 20mm/sec FINE ;"];
    let file = SourceFile::new("PART.LS", with_lines(&plain));
    let flat = expand(
        Language::FanucLs,
        vec![file.clone()],
        &ReadOptions::default(),
    );
    let flat = flat.unwrap().unwrap();
    assert!(!flat.changed && flat.file.bytes() == file.bytes());
}
