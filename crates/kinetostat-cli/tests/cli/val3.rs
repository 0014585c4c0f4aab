//! A program of Staubli with the data of its application, which lie in its folder.

#![allow(clippy::unwrap_used, reason = "a failing test may panic")]

use std::path::Path;

use crate::common::run;

const DATA: &str = r#"<?xml version="1.0" encoding="utf-8" ?>
<Database xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xmlns="http://www.staubli.com/robotics/VAL3/Data/2">
  <Datas>
    <Data name="fPart" access="public" xsi:type="array" type="frame" size="1">
      <Value key="0" x="1800" z="900" fatherId="world[0]" />
    </Data>
    <Data name="tMill" access="public" xsi:type="array" type="tool" size="1">
      <Value key="0" z="180" fatherId="flange[0]" />
    </Data>
    <Data name="mCut" access="public" xsi:type="array" type="mdesc" size="1">
      <Value key="0" tmax="20" blend="off" />
    </Data>
    <Data name="pA" access="public" xsi:type="array" type="pointRx" size="1">
      <Value key="0" x="0" y="0" z="50" rx="180" ry="0" rz="0" fatherId="fPart[0]" />
    </Data>
    <Data name="pB" access="public" xsi:type="array" type="pointRx" size="2">
      <Value key="0" x="50" y="10" z="0" rx="180" ry="0" rz="0" fatherId="fPart[0]" />
      <Value key="1" x="80" y="0" z="0" rx="180" ry="0" rz="0" fatherId="fPart[0]" />
    </Data>
    <Data name="nI" access="public" xsi:type="array" type="num" size="1" />
  </Datas>
</Database>
"#;

const PROJECT: &str = "<?xml version=\"1.0\" encoding=\"utf-8\" ?>\n<Project xmlns=\"http://www.staubli.com/robotics/VAL3/Project/3\">\n  <Parameters version=\"s7.3.1\" stackSize=\"5000\" millimeterUnit=\"true\" />\n</Project>\n";

fn program(statements: &str) -> String {
    format!(
        "<?xml version=\"1.0\" encoding=\"utf-8\" ?>\n<Programs xmlns=\"http://www.staubli.com/robotics/VAL3/Program/2\">\n  <Program name=\"part\">\n    <Code><![CDATA[begin\n{statements}\nend]]></Code>\n  </Program>\n</Programs>\n"
    )
}

fn read(here: &Path, name: &str) -> String {
    std::fs::read_to_string(here.join(name)).unwrap()
}

#[test]
fn a_program_is_compensated_with_the_data_of_its_folder_and_verified() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    let put = |name: &str, text: &str| std::fs::write(here.join(name), text).unwrap();
    let statements = "  movej(pA,tMill,mCut)\n  movel(appro(pB[0],{0,0,-5,0,0,0}),tMill,mCut)\n  movel(pB[0],tMill,mCut)\n  movel(pB[1],tMill,mCut)\n  waitEndMove()";
    put("part.pgx", &program(statements));
    put("cell.dtx", DATA);
    put("cell.pjx", PROJECT);
    let job = |more: &str| {
        let text = format!(
            "schema = 1\nmodel = \"heavy_6r\"\nprogram = \"part.pgx\"\n[load]\nforce_n = [100, 50, -80]\nweight = \"all\"\n{more}"
        );
        put("job.toml", &text);
    };
    job("");
    let said = run(here, &["compensate", "job.toml"]).answered();
    assert!(!said.out.contains("lengths are taken"), "{said:?}");
    let (output, data) = (
        read(here, "compensated/part.pgx"),
        read(here, "compensated/cell.dtx"),
    );
    assert!(output.contains("movel(appro(pB[0],{"), "{output}");
    assert_ne!(data, DATA);
    let verify = ["verify", "compensated/part.pgx", "--job", "job.toml"];
    let verified = run(here, &verify).answered();
    assert!(verified.out.contains("VERIFIED"), "{verified:?}");
    // Another description of motion, and a loop around it all.
    let differs = |name: &str, from: [&str; 2], to: [&str; 2], words: &str| {
        let name = format!("compensated/{name}");
        let before = read(here, &name);
        let changed = before.replace(from[0], to[0]).replace(from[1], to[1]);
        put(&name, &changed);
        let said = run(here, &verify);
        let shown: Vec<&str> = said.out.split_whitespace().collect();
        assert!(
            said.code == 3 && shown.join(" ").contains(words),
            "{said:?}"
        );
        put(&name, &before);
    };
    let slower = ["tmax=\"20\" accel=\"50\"", "\u{0}"];
    differs("cell.dtx", ["tmax=\"20\"", "\u{0}"], slower, "ACCEL 50");
    let again = ["begin\nwhile true", "\nendWhile\nend]]>"];
    let around = ["begin", "\nend]]>"];
    differs("part.pgx", around, again, "A LOOP WITHOUT END");
    // A loop whose runs need different corrections is written flat.
    let again = "  movej(pA,tMill,mCut)\n  for nI=0 to 1\n    movel(pB[nI],tMill,mCut)\n  endFor";
    put("part.pgx", &program(again));
    job("[expand]\n");
    run(here, &["compensate", "job.toml", "--force-overwrite"]).answered();
    let output = read(here, "compensated/part.pgx");
    assert!(
        !output.contains("for ") && output.contains("nI=1"),
        "{output}"
    );
    let verified = run(here, &verify).answered();
    assert!(verified.out.contains("VERIFIED"), "{verified:?}");
    // Another language from it.
    put("part.pgx", &program(statements));
    let line = "convert part.pgx --to krl --out part.src --rapid-from-mm-per-s 150";
    let words: Vec<&str> = line.split_whitespace().collect();
    run(here, &words).answered();
    assert!(read(here, "part.src").contains("LIN {"));
}
