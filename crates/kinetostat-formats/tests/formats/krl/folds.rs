//! Inline forms whose points become others: what the pendant shows goes with what runs.

use kinetostat_formats::*;
use kinetostat_program::{
    Correction, CorrectionField, FieldFailure, MachineProgram as _, Request, Unwatched,
    WriteOptions as PathWriteOptions,
};
use nalgebra::{Isometry3, Vector3};

use crate::paths::corrected_files;

const DATA: &str = "DEFDAT part\n\
    DECL E6POS XP1={X 0.0,Y 0.0,Z 20.000,A 0,B 0,C 180,S 2,T 2}\n\
    DECL FDAT FP1={TOOL_NO 1,BASE_NO 1,IPO_FRAME #BASE,POINT2[] \" \"}\n\
    DECL E6POS XP2={X 0.0,Y 0.0,Z -1.0,A 0,B 0,C 180,S 2,T 2}\n\
    DECL FDAT FP2={TOOL_NO 1,BASE_NO 1,IPO_FRAME #BASE,POINT2[] \" \"}\n\
    DECL LDAT LCPDAT2={VEL 2,ACC 100,APO_DIST 3.5,ORI_TYP #VAR,CIRC_TYP #BASE,JERK_FAC 50.0}\nENDDAT\n";

/// As KSS 5 writes it.
fn old_form(word: &str, point: &str) -> String {
    format!(
        ";FOLD {word} {point} Vel=0.02 m/s CPDAT2 Tool[1] Base[1];%{{PE}}%R 5.5,%MKUKATPBASIS,%CMOVE,%V{word},%P 1:{word}, 2:{point}, 3:, 5:0.02, 7:CPDAT2\n\
         $BWDSTART=FALSE\nLDAT_ACT=LCPDAT2\nFDAT_ACT=F{point}\nBAS(#CP_PARAMS,0.02)\n{word} X{point}\n;ENDFOLD\n"
    )
}

/// As KSS 8 writes it.
fn new_form(point: &str) -> String {
    format!(
        ";FOLD SLIN {point} Vel=0.02 m/s CPDAT2 Tool[1] Base[1] ;%{{PE}}\n;FOLD Parameters ;%{{h}}\n\
         ;Params IlfProvider=kukaroboter.basistech.inlineforms.movement.spline; Kuka.PointName={point}; Kuka.MovementParameterFieldEnabled=True\n\
         ;ENDFOLD\nSLIN X{point} WITH $VEL = SVEL_CP(0.02, , LCPDAT2), $TOOL = STOOL2(F{point}), $BASE = SBASE(F{point}.BASE_NO), $IPO_MODE = SIPO_MODE(F{point}.IPO_FRAME), \
         $LOAD = SLOAD(F{point}.TOOL_NO), $ACC = SACC_CP(LCPDAT2), $ORI_TYPE = SORI_TYP(LCPDAT2), $APO = SAPO(LCPDAT2), $JERK = SJERK(LCPDAT2), $COLLMON_TOL_PRO[1] = USE_CM_PRO_VALUES(0)\n;ENDFOLD\n"
    )
}

const FAR: &str = "LIN {X 200,Y 100,Z -1,A 0,B 0,C 180}\n";

fn program_of(statements: &str) -> Vec<SourceFile> {
    let source = format!(
        "DEF part( )\n$BASE=BASE_DATA[1]\n$TOOL=TOOL_DATA[1]\n$VEL.CP=0.02\nPTP {{X 0,Y 0,Z 50,A 0,B 0,C 180}}\n{statements}END\n"
    );
    vec![
        SourceFile::new("part.src", source),
        SourceFile::new("part.dat", DATA),
    ]
}

/// Where base and tool are.
fn stated() -> ReadOptions {
    let mut options = ReadOptions::default();
    for name in ["BASE_DATA[1]", "TOOL_DATA[1]"] {
        options
            .frames
            .insert(name.to_owned(), Isometry3::translation(0.0, 0.0, 180.0));
    }
    options
}

#[test]
fn points_of_inline_forms_that_become_others_are_corrected_and_checked() {
    let (p1, p2) = (old_form("LIN", "P1"), old_form("LIN", "P2"));
    // Points that are gone to twice from different sides, points that something rests on, a sum, a circle through one.
    let cases = [
        (format!("{p2}{FAR}{p2}"), 4),
        (format!("{p1}{p2}{FAR}{p1}"), 5),
        (
            format!("{p2}LIN XP2:{{X 10,Y 0,Z 0,A 0,B 0,C 0}} C_DIS\n"),
            3,
        ),
        (format!("{}{FAR}{}", new_form("P2"), new_form("P2")), 4),
        (format!("$H_POS=XP2\n{p2}"), 2),
        (format!("{p2}{FAR}{}", p2.replace('\n', "\r\n")), 4),
    ];
    for (statements, motions) in cases {
        let files = program_of(&statements);
        let found = corrected_files(Language::Krl, files, &stated());
        assert_eq!(found, Ok(motions), "{statements}");
    }
}

/// Sags the deeper the later it is asked: the same point twice is another one.
struct Later;

impl CorrectionField for Later {
    fn corrections(&self, requests: &[Request]) -> Vec<Result<Correction, FieldFailure>> {
        let at = |request: &Request| {
            Ok(Correction {
                shift_mm: Vector3::z() * (0.1 + 0.1 * request.move_index as f64),
                turn: Vector3::zeros(),
            })
        };
        requests.iter().map(at).collect()
    }
}

/// A program whose second use of P2 gets a point of its own, as the writer writes it and with a text changed by hand.
fn checked(statements: &str, change: (&str, &str)) -> Result<(), String> {
    let program = read_krl(program_of(statements), &stated()).unwrap();
    let making = PathOptions::default();
    let path = path_of(&program, &making).unwrap();
    let robot = Correctable {
        program: &program,
        path: &path,
        reading: &stated(),
        making: &making,
        writing: &WriteOptions::default(),
    };
    let options = PathWriteOptions::default();
    let mut written = robot.write(&Later, &options, &Unwatched).unwrap();
    let text = String::from_utf8(written.bytes.clone()).unwrap();
    assert!(text.contains(change.0), "{text}");
    written.bytes = text.replace(change.0, change.1).into_bytes();
    let found = robot.verify(&written, &options);
    found.map(|_| ()).map_err(|error| error.to_string())
}

#[test]
fn a_fold_that_shows_another_point_than_runs_breaks_the_check() {
    let old = format!("{0}{FAR}{0}", old_form("LIN", "P2"));
    let new = format!("{0}{FAR}{0}", new_form("P2"));
    assert_eq!(checked(&old, ("P2_2", "P2_2")), Ok(()));
    assert_eq!(checked(&new, ("P2_2", "P2_2")), Ok(()));
    // Data that the program changes stay those of both points.
    let own = format!("FP2.TOOL_NO=1\n{old}");
    let kept = "2:P2_2, 3:, 5:0.02, 7:CPDAT2\n$BWDSTART=FALSE\nLDAT_ACT=LCPDAT2\nFDAT_ACT=FP2\n";
    assert_eq!(checked(&own, (kept, kept)), Ok(()));
    for (statements, change) in [
        // The name that is shown stayed, is a third one, or something else changed with it.
        (&old, ("2:P2_2", "2:P2")),
        (&old, ("FOLD LIN P2_2 ", "FOLD LIN P7 ")),
        (&old, ("2:P2_2, 3:", "2:P2_2, 4:")),
        (&old, ("FDAT_ACT=FP2_2", "FDAT_ACT=FP1")),
        (&old, ("FDAT_ACT=FP2_2", "FDAT_ACT = FP2_2")),
        (&new, ("PointName=P2_2;", "PointName=P2;")),
        (
            &new,
            (
                "MovementParameterFieldEnabled=True",
                "MovementParameterFieldEnabled=False",
            ),
        ),
    ] {
        let said = checked(statements, change).unwrap_err();
        assert!(said.contains("is not there"), "{change:?}: {said}");
    }
}
