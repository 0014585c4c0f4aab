//! Programs that are run once and written flat.

use kinetostat_formats::*;
use nalgebra::Vector3;

const END: &str = ",[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]";

fn flat(text: &str) -> FlatText {
    let files = vec![SourceFile::new("m.mod", text)];
    let done = expand(Language::Rapid, files, &ReadOptions::default());
    done.unwrap_or_else(|faults| panic!("{faults:?}")).unwrap()
}

/// Ends of the motions of a program, with their tools and speeds.
fn motions(text: &str) -> Vec<(Vector3<f64>, String, Option<f64>)> {
    let program = super::program(text);
    let all = program.motions.iter().map(|motion| {
        let end = motion.target.pose().unwrap().position_mm;
        (end, motion.tool.name.clone(), motion.speed.mm_per_s)
    });
    all.collect()
}

#[test]
fn loops_and_calls_become_statements_one_after_the_other() {
    let text = format!(
        "MODULE M\nCONST robtarget p:=[[1,2,3]{END};\nVAR num n:=0;\nPROC main()\n  VAR speeddata s:=v20;\n  ! begins\n  MoveJ p,v500,fine,tool0;\n\
         \x20 FOR i FROM 1 TO 2 DO\n    cut i*10,s;\n    SetDO doRun, i;\n  ENDFOR\n  IF di1=1 THEN\n    Set doDust;\n  ENDIF\n  n:=n+1;\n  MoveL p,s,fine,tool0;\n\
         ENDPROC\nPROC cut(num depth, speeddata fast)\n  MoveL Offs(p,0,0,-depth),fast,z1,tool0;\n  MoveL [[depth,0,0]{END},fast,z1,tool0;\nENDPROC\nENDMODULE\n"
    );
    let found = flat(&text);
    assert!(found.changed);
    let written = String::from_utf8(found.file.bytes().to_vec()).unwrap();
    assert_eq!(motions(&written), motions(&text), "{written}");
    assert_eq!(motions(&written).len(), 6);
    for (part, count) in [
        ("FOR", 0),
        ("PROC cut", 0),
        ("MoveL Offs(p,0,0,-10),[20,500,5000,1000],z1,tool0;", 1),
        ("SetDO doRun, 2;", 1),
        ("IF di1=1 THEN\n    Set doDust;\n  ENDIF\n", 1),
        ("n:=n+1;", 1),
    ] {
        assert_eq!(written.matches(part).count(), count, "{part}: {written}");
    }
    // Each line says where it is from.
    let lines: Vec<&str> = written.lines().collect();
    assert_eq!(found.origins.len(), lines.len());
    let source: Vec<&str> = text.lines().collect();
    for (line, (file, from)) in lines.iter().zip(&found.origins) {
        assert_eq!(*file, 0);
        let words = line.trim().split(['(', ' ', ',']).next().unwrap();
        assert!(
            source[from - 1].contains(words),
            "{line}: {}",
            source[from - 1]
        );
    }
}

/// Local routines go as a whole, a name that `main` sees stays a name, and lines are those of the source.
#[test]
fn names_and_lines_of_flat_programs_are_those_of_the_source() {
    let text = format!(
        "MODULE M\nPERS tooldata T1:=[TRUE,[[0,0,9],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];\nVAR num n;\nPROC main()\nMoveL [[0,0,0]{END},v20,z1,T1;\n\
         MoveL [[1,0,0]{END},v20,z1,T1;\ncut T1,n,z5;\nMoveL [[3,0,0]{END},v20,z1,T1;\nENDPROC\nLOCAL PROC cut(PERS tooldata t, INOUT num m, zonedata z)\nm:=m+1;\n\
         MoveL [[2,0,0]{END},v20,z,t;\nERROR\nRETRY;\nENDPROC\nENDMODULE\n"
    );
    let found = flat(&text);
    let written = String::from_utf8(found.file.bytes().to_vec()).unwrap();
    assert_eq!(motions(&written), motions(&text), "{written}");
    assert!(
        !written.contains("LOCAL") && written.contains("n:=1;"),
        "{written}"
    );
    assert!(
        written.contains(",v20,[FALSE,5,8,8,0.8,8,0.8],T1;"),
        "{written}"
    );
    let at = written
        .lines()
        .position(|line| line.contains("[[3,0,0]"))
        .unwrap();
    assert_eq!(found.origins[at], (0, 8));
    let said = found
        .findings
        .iter()
        .any(|finding| finding.message.contains("error handler"));
    assert!(said, "{:?}", found.findings);
}

/// What needs another correction at each run is written once it is flat.
#[test]
fn runs_of_one_statement_are_corrected_apart() {
    let text = format!(
        "MODULE M\nPROC main()\nFOR i FROM 1 TO 3 DO\nMoveL [[i,0,0]{END},v20,fine,tool0;\nENDFOR\nENDPROC\nENDMODULE\n"
    );
    let correct = |text: &str| {
        let program = super::program(text);
        let pieces: Vec<Piece> = (0..3)
            .map(|index| {
                Piece::to(
                    index,
                    Vector3::new(index as f64 + 1.0, 0.0, 0.1 * index as f64),
                )
            })
            .collect();
        write(&program, &pieces, &WriteOptions::default())
    };
    let refused = correct(&text).unwrap_err().to_string();
    assert!(
        refused.contains("line 4") && refused.contains("--expand"),
        "{refused}"
    );
    let found = flat(&text);
    let written = String::from_utf8(found.file.bytes().to_vec()).unwrap();
    let files = correct(&written).unwrap();
    let again = motions(std::str::from_utf8(&files[0].1).unwrap());
    let heights: Vec<f64> = again.iter().map(|(end, ..)| end.z).collect();
    assert_eq!(heights, [0.0, 0.1, 0.2]);
}

#[test]
fn what_cannot_be_written_flat_is_refused_by_line() {
    for (body, line) in [
        ("part 1;\nENDPROC\nPROC part(num n)\nIF di1=n Set do1;", 7),
        (
            "part 1;\nENDPROC\nPROC part(num n)\nVAR num m;\nm:=DInput(di1);\nSetDO do1,m;",
            9,
        ),
    ] {
        let text = format!("MODULE M\nVAR num g;\nPROC main()\n{body}\nENDPROC\nENDMODULE\n");
        let files = vec![SourceFile::new("m.mod", text)];
        let faults = expand(Language::Rapid, files, &ReadOptions::default()).unwrap_err();
        assert_eq!((faults.len(), faults[0].line), (1, line), "{faults:?}");
        assert!(
            faults[0].reason.contains("cannot be written flat"),
            "{}",
            faults[0]
        );
    }
    let text = "MODULE M\nPROC other()\nENDPROC\nENDMODULE\n";
    let files = vec![SourceFile::new("m.mod", text)];
    let faults = expand(Language::Rapid, files, &ReadOptions::default()).unwrap_err();
    assert!(faults[0].reason.contains("no PROC main"), "{faults:?}");
}
