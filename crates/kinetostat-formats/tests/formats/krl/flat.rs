//! Programs that are run once and written flat.

use kinetostat_formats::*;

fn files(source: &str, data: &str) -> Vec<SourceFile> {
    vec![
        SourceFile::new("part.src", source),
        SourceFile::new("part.dat", data),
    ]
}

/// The places, angles, frames, tools, speeds and zones of the motions of a program, to a nanometre.
fn way(program: &RobotProgram) -> Vec<String> {
    let pose = |pose: Option<nalgebra::Isometry3<f64>>| {
        let matrix = pose.map(|pose| pose.to_homogeneous());
        matrix.map(|matrix| matrix.map(|number| (1e6 * number).round() as i64))
    };
    let motions = program.motions.iter();
    motions
        .map(|motion| {
            let via = match &motion.kind {
                MotionKind::Circular { via } => via.pose().map(|via| via.position_mm),
                _ => None,
            };
            format!(
                "{:?} {via:?} {:?} {:?} {:?} {:?}",
                pose(motion.base_pose()),
                motion.zone,
                motion.speed.mm_per_s,
                pose(motion.tool.known().copied()),
                std::mem::discriminant(&motion.kind)
            )
        })
        .collect()
}

#[test]
fn a_flat_program_goes_where_the_program_goes() {
    let data = "DEFDAT part\nDECL E6POS XP1={X 1,Y 2,Z 3,A 10,B 0,C 180,S 2,T 35}\nDECL E6POS way[3]\n\
        way[1]={X 5,Y 0,Z 3,A 0,B 0,C 180}\nway[2]={X 7,Y 0,Z 3,A 0,B 0,C 180}\nDECL INT count=0\nENDDAT\n";
    let source = "DEF part()\nINT i\nDECL E6POS p\nREAL speed\n$TOOL={X 0,Y 0,Z 100,A 0,B 0,C 0}\n$BASE=$NULLFRAME\n\
        speed=0.02\n$VEL.CP=speed ; own\nPTP XP1\nFOR i=1 TO 2\n  LIN way[i] C_DIS\nENDFOR\nFOR count=1 TO 2\n  groove(way[count], 2.5*i)\nENDFOR\n\
        p=XP1\np.Z=p.Z+20\nLIN p\nSLIN XP1 WITH $VEL.CP=speed*2\nIF $IN[1] THEN\n$OUT[2]=TRUE\nENDIF\n\
        sub()\nLOOP\n EXIT\nENDLOOP\nEND\n\
        DEF groove(at :IN, deep :IN)\nDECL E6POS at\nREAL deep\nLIN at:{X 0,Y 0,Z 1,A 0,B 0,C 0}\nCIRC {X 9,Y 1,Z 3},{X 10,Y 0,Z 3}\nPULSE($OUT[1],TRUE,0.5)\nEND\n\
        DEF sub()\nWAIT SEC 0.5\nLIN_REL {Z 5}\nEND\n";
    let options = ReadOptions::default();
    let program = read_krl(files(source, data), &options).unwrap();
    let flat = expand(Language::Krl, files(source, data), &options)
        .unwrap()
        .unwrap();
    let text = String::from_utf8_lossy(flat.file.bytes()).into_owned();
    assert!(
        flat.changed && !text.contains("FOR") && !text.contains("groove"),
        "{text}"
    );
    assert_eq!(flat.origins.len(), text.lines().count(), "{text}");
    let read = read_krl(files(&text, data), &options)
        .unwrap_or_else(|errors| panic!("{text}\n{errors:#?}"));
    assert_eq!(way(&program), way(&read), "{text}");
    // Each run has numbers of its own.
    assert!(
        read.motions.iter().all(|motion| motion.runs == Runs::Once),
        "{text}"
    );
    assert!(stays_beside_flat(Language::Krl, &files(source, data)[1]));
}

/// Runs that need different corrections are refused, and written in the flat program.
#[test]
fn different_corrections_of_one_statement_need_the_flat_program() {
    let data = "DEFDAT part\nENDDAT\n";
    let source = "DEF part()\n$TOOL=$NULLFRAME\n$BASE=$NULLFRAME\n$VEL.CP=0.02\nINT i\nPTP {X 0,Y 0,Z 5,A 0,B 0,C 180}\n\
        FOR i=1 TO 2\n  LIN {X 10,Y 0,Z 0,A 0,B 0,C 180}\n  LIN {X 0,Y 0,Z 0,A 0,B 0,C 180}\nENDFOR\nEND\n";
    let options = ReadOptions::default();
    let pieces = |program: &RobotProgram| {
        let motions = program.motions.iter().enumerate().skip(1);
        let pieces = motions.map(|(index, motion)| {
            let mut place = motion.target.pose().unwrap().position_mm;
            place.z += 0.01 * index as f64;
            Piece::to(index, place)
        });
        pieces.collect::<Vec<Piece>>()
    };
    let program = read_krl(files(source, data), &options).unwrap();
    let refused = write(&program, &pieces(&program), &WriteOptions::default()).unwrap_err();
    assert!(refused.to_string().contains("--expand"), "{refused}");
    let flat = expand(Language::Krl, files(source, data), &options)
        .unwrap()
        .unwrap();
    let text = String::from_utf8_lossy(flat.file.bytes()).into_owned();
    let program = read_krl(files(&text, data), &options).unwrap();
    let written = write(&program, &pieces(&program), &WriteOptions::default()).unwrap();
    let written = String::from_utf8_lossy(&written[0].1).into_owned();
    assert_eq!(written.matches("LIN {X").count(), 4, "{written}");
    assert!(
        written.contains("Z 0.010") && written.contains("Z 0.040"),
        "{written}"
    );
}

/// Files of the names that a program calls belong to it; its own routines, arrays and remarks name none.
#[test]
fn files_beside_are_those_that_are_called() {
    let text = "DEF part()\nBAS(#INITMOV,0)\nway[1]={X 5}\nGroove (1,2)\n; other()\nsub()\nx=half(3)\nEND\nDEF sub()\nEND\nDEFFCT REAL half(x:IN)\nEND\n";
    let file = SourceFile::new("main.src", text);
    assert_eq!(called_files(Language::Krl, &file), ["Groove.src"]);
    let folder = ["part.src", "groove.src", "sub.src", "other.src", "main.dat"].map(String::from);
    assert_eq!(
        Language::Krl.files_beside(&file, &folder),
        ["main.dat", "groove.src"]
    );
}
