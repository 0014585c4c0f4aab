//! Broken files are refused by line, and end.

use kinetostat_formats::*;

use super::{DATA, data_of, files_with, program_of, read_with};
use crate::chance::Chance;
use crate::harness::{Kind, PLACE_MM, broken};

fn read_texts(start: &str, data: &str) -> Result<RobotProgram, Vec<ProgramError>> {
    let files = vec![
        SourceFile::new("start.pgx", start),
        SourceFile::new("cell.dtx", data),
    ];
    read_val3(files, &ReadOptions::default())
}

#[test]
fn broken_programs_are_refused_by_line() {
    for (statements, line, said) in [
        (
            "  if 1==1\n    movel(pA,tMill,mCut)",
            5,
            "no `ENDIF` ends it",
        ),
        ("  endWhile", 5, "nothing is open that it ends"),
        ("  movel pA", 5, "no statement begins so"),
        (
            "  if nCount==1 movel(pA,tMill,mCut)\n  endIf",
            5,
            "no expression",
        ),
        ("  while ()\n  endWhile", 5, "no expression"),
        ("  nCount=", 5, "no expression"),
        (
            "  switch nCount\n    case 1\n      delay(1)\n    case 2\n  endSwitch",
            6,
            "no `break` ends the case",
        ),
        ("  put(\"open)", 5, "no statement begins so"),
        ("end\n  movel(pA,tMill,mCut)", 6, "stands behind"),
    ] {
        let errors = read_with(statements).expect_err(statements);
        let is_it = |error: &ProgramError| error.line == line && error.reason.contains(said);
        assert!(errors.iter().any(is_it), "{statements}: {errors:#?}");
    }
}

#[test]
fn broken_files_are_refused_by_line() {
    let (start, data) = (
        program_of("start", "", "  movel(pA,tMill,mCut)"),
        data_of(DATA),
    );
    assert!(read_texts(&start, &data).is_ok());
    let no_data = "<Database><Datas></Datas></Database>";
    for (start, data, file, said) in [
        (
            start.replace("</Program>", ""),
            &*data,
            "start.pgx",
            "it is no XML",
        ),
        (
            start.clone(),
            &*data.replace("</Datas>", ""),
            "cell.dtx",
            "it is no XML",
        ),
        (
            start.replace("begin", ""),
            &*data,
            "start.pgx",
            "no `begin` opens",
        ),
        (
            start.replace("Programs", "Other"),
            &*data,
            "start.pgx",
            "no part of an application",
        ),
        (
            start.replace("<Programs", "<!DOCTYPE a><Programs"),
            &*data,
            "start.pgx",
            "it is no XML",
        ),
        (
            start.replace("Code>", "Text>"),
            &*data,
            "start.pgx",
            "no text of a program",
        ),
        (
            start
                .replace("movel", "<b/>movel")
                .replace("<![CDATA[", "")
                .replace("]]>", ""),
            &*data,
            "start.pgx",
            "no text of a program",
        ),
        (
            start.clone(),
            &*data.replace("\"pRow\"", "\"pA\""),
            "cell.dtx",
            "declared twice",
        ),
        (
            start.clone(),
            &*data.replace("\"10.000\"", "\"ten\""),
            "start.pgx",
            "it is no point",
        ),
        (start.clone(), no_data, "start.pgx", "no `pA` is declared"),
    ] {
        let errors = read_texts(&start, data).expect_err(said);
        let is_it = |error: &ProgramError| {
            error.file == file && error.reason.contains(said) && error.line > 0
        };
        assert!(errors.iter().any(is_it), "{said}: {errors:#?}");
    }
}

#[test]
fn nesting_and_loops_have_bounds() {
    let deep = format!("{}{}", "  if true\n".repeat(5000), "  endIf\n".repeat(5000));
    assert!(
        read_with(&deep)
            .unwrap_err()
            .iter()
            .any(|error| error.reason.contains("deeper than 100"))
    );
    assert!(
        read_with(&format!(
            "  nCount={}1{}",
            "(".repeat(50_000),
            ")".repeat(50_000)
        ))
        .is_err()
    );
    assert!(
        read_with("  do\n    nCount=nCount+0\n    movel(pA,tMill,mCut)\n  until nCount==5")
            .is_err()
    );
    let again = ("again", "", "  call again()");
    assert!(
        read_val3(
            files_with("  call again()", &[again]),
            &ReadOptions::default()
        )
        .is_err()
    );
    let elements = format!(
        "<Database>{}{}</Database>",
        "<a>".repeat(20_000),
        "</a>".repeat(20_000)
    );
    drop(read_texts(&program_of("start", "", ""), &elements));
    let huge = DATA.replace("size=\"3\"", "size=\"4000000000\"");
    assert!(
        read_texts(
            &program_of("start", "", "  movel(pRow[0],tMill,mCut)"),
            &data_of(&huge)
        )
        .is_err()
    );
    let round = DATA.replace("fatherId=\"world[0]\"", "fatherId=\"fPart[1]\"");
    let program = read_texts(
        &program_of("start", "", "  movel(pA,tMill,mCut)"),
        &data_of(&round),
    )
    .unwrap();
    assert!(program.motions[0].work_object.known().is_none());
}

#[test]
fn whatever_the_bytes_are_they_are_read_or_refused_with_a_line() {
    let kind = Kind {
        language: Language::Val3,
        options: ReadOptions::default(),
        turns: true,
        speeds: false,
        words: &[
            "\nendIf\n",
            "if ",
            "]]>",
            "<Value key=\"1\"/>",
            "movel(",
            "[0]",
            "&lt;",
            "<!--",
            "call start()\n",
        ],
        place_mm: PLACE_MM,
        turn_rad: 3.0e-7,
    };
    let statements = "  for nCount=0 to 2\n    movel(appro(pRow[nCount],{0,0,1,0,0,0}),tMill,mCut)\n  endFor\n  if bGo==true\n    put(\"a\")\n  endIf\n  movel(pA,tMill,mCut)";
    let texts = [program_of("start", "", statements), data_of(DATA)];
    for seed in 0..400 {
        let mut chance = Chance::new(seed);
        let files: Vec<SourceFile> = (["start.pgx", "cell.dtx"].iter().zip(&texts))
            .map(|(name, text)| SourceFile::new(*name, broken(&mut chance, text, &kind)))
            .collect();
        let bytes: Vec<Vec<u8>> = files.iter().map(|file| file.bytes().to_vec()).collect();
        match read(Language::Val3, files, &kind.options) {
            Ok(program) => {
                let written = write(&program, &[], &WriteOptions::default()).unwrap();
                let texts: Vec<Vec<u8>> = written.into_iter().map(|(_, bytes)| bytes).collect();
                assert_eq!(texts, bytes);
            }
            Err(errors) => assert!(errors.iter().all(|error| error.line > 0), "{errors:#?}"),
        }
    }
}
