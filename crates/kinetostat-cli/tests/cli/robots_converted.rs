//! Programs of robots converted: what counts of them, and what is said where it does not.

#![allow(clippy::unwrap_used, reason = "a failing test may panic")]

use crate::common::run;

fn words(line: &str) -> Vec<&str> {
    line.split_whitespace().collect()
}

/// As one line.
fn flat(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The base of this program is 70, its tool 4 where the program itself says it.
const KRL: &str = "DEF part( )\nTOOL_DATA[4]={X 0,Y 0,Z 180,A 0,B 0,C 0}\nBASE_DATA[70]={X 1700,Y 0,Z 900,A 0,B 0,C 0}\n\
    $BASE=BASE_DATA[70]\n$TOOL=TOOL_DATA[4]\n$VEL.CP=0.01\nPTP {X 0,Y 0,Z 50,A 0,B 0,C 180,S 2,T 3}\n\
    LIN {X 0,Y 0,Z 0,A 0,B 0,C 180}\nLIN {X 10,Y 0,Z 0,A 0,B 0,C 180}\nEND\n";

#[test]
fn tools_that_a_program_assigns_itself_count_in_every_command() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    std::fs::write(here.join("part.src"), KRL).unwrap();
    let line = "convert part.src --to rapid --out a.mod";
    let said = flat(&run(here, &words(line)).answered().out);
    let text = std::fs::read_to_string(here.join("a.mod")).unwrap();
    assert!(
        text.contains("PERS tooldata tool4:=[TRUE,[[0.000000,0.000000,180.000000],"),
        "{text}"
    );
    assert!(!said.contains("is not stated: TOOL_DATA"), "{said}");
    let line = "compensate --model heavy_6r --weight all --program part.src --force 30 0 -20 --correct position --tool-axis -z --out b.src";
    run(here, &words(line)).answered();
}

#[test]
fn a_fault_of_the_program_names_the_program() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    std::fs::write(here.join("part.src"), KRL).unwrap();
    std::fs::write(here.join("cell.toml"), "schema = 1\nrapids = \"joint\"\n").unwrap();
    let line = "convert part.src --to ls --out a.ls --template cell.toml";
    let said = run(here, &words(line));
    assert_eq!(said.code, 1);
    assert!(
        flat(&said.err).contains("part.src: line 7: the number of the base is above 61"),
        "{said:?}"
    );
    assert!(!said.err.contains("cell.toml"), "{said:?}");
    std::fs::write(here.join("cell.toml"), "schema = 1\nspeed_decimals = 77\n").unwrap();
    let said = run(
        here,
        &words("convert part.src --to krl --out b.src --template cell.toml"),
    );
    assert!(
        said.err.contains("cell.toml: speed_decimals is 77"),
        "{said:?}"
    );
}

#[test]
fn calls_of_what_is_not_there_are_named_by_line() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    let text = KRL
        .replace("BASE_DATA[70]", "BASE_DATA[3]")
        .replace("END\n", "SUB1()\nSUB2()\nSUB1()\nEND\n");
    std::fs::write(here.join("part.src"), text).unwrap();
    let said = run(here, &words("convert part.src --to rapid --out a.mod")).answered();
    let said = flat(&said.out);
    for part in [
        "line 10: `SUB1` is in none of the files: it is a note here, and taken not to move the tool and not to change speed, tool or frame, or how motions behind it go (`$ORI_TYPE`, `$CIRC_TYPE`, `$ACC`, `$APO`); state it under [calls] if it moves, or give its file (lines 10, 12)",
        "line 11: `SUB2` is in none of the files: it is a note here, and taken not to move the tool",
    ] {
        assert!(said.contains(part), "{part}: {said}");
    }
}

/// Half a turn may go round on either side, and the poses do not say which; a little less does.
#[test]
fn half_a_turn_is_warned_of() {
    let here = tempfile::tempdir().unwrap();
    let half = "MODULE T\n\
        PERS tooldata tA:=[TRUE,[[0,0,100],[1,0,0,0]],[5,[0,0,60],[1,0,0,0],0,0,0]];\n\
        PROC main()\n\
        MoveJ [[1500,0,800],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,z10,tA;\n\
        MoveL [[1520,0,800],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,fine,tA;\n\
        ENDPROC\nENDMODULE\n";
    // 179 degrees about z.
    let less = half.replace("[0,1,0,0]", "[0,0.9999619230641713,0.008726535498373935,0]");
    for (program, is_warned) in [(half, true), (&less, false)] {
        std::fs::write(here.path().join("t.mod"), program).unwrap();
        let said = run(
            here.path(),
            &[
                "convert",
                "t.mod",
                "--to",
                "csv",
                "--out",
                "t.csv",
                "--force-overwrite",
            ],
        );
        assert_eq!(said.code, 0, "{said:?}");
        let text = said.out.split_whitespace().collect::<Vec<_>>().join(" ");
        let warned = text.contains("line 5: the tool turns by half a turn here");
        assert_eq!(warned, is_warned, "{text}");
    }
}
