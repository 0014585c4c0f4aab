//! Absurd questions that were once answered without a word, with a program written: each is refused with the number, what is
//! allowed and what to do, and no output is left.

use std::path::Path;

use crate::absurd::{ARM_JOB, arm, compensated};
use crate::common::{Said, run, workplace};
use crate::cut;

const GCODE: &str = "G21 G90\nG0 X0 Y0 Z5\nG1 Z-1 F300\nG1 X40 F600\nG0 Z5\nM2\n";

const CELL: &str = "schema = 1\ntool_orientation = { a_b_c_kuka_deg = [0, 0, 180] }\n[base]\nnumber = 1\npose = { position_mm = [900, 0, 700] }\n[tool]\nnumber = 1\npose = { position_mm = [0, 0, 180] }\n[zones]\nfeeds_mm = 0.3\n";

fn in_one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn command(here: &Path, line: &str) -> Said {
    run(here, &line.split(' ').collect::<Vec<_>>())
}

/// Refused with exit code 1, all of these words, and without the output.
#[track_caller]
fn refused(here: &Path, said: &Said, output: &str, needles: &[&str]) {
    assert_eq!(said.code, 1, "{said:?}");
    let text = in_one_line(&said.err);
    for needle in needles {
        assert!(text.contains(needle), "{needle}: {text}");
    }
    assert!(!here.join(output).exists(), "{output} was written: {text}");
}

/// The limits of `compensate` hold for `convert`.
#[test]
fn conversions_of_absurd_cells_are_refused() {
    let here = workplace();
    let here = here.path();
    std::fs::write(here.join("part.ngc"), GCODE).unwrap();
    let line = "convert part.ngc --to krl --out new.src --template cell.toml";
    let cases: [(&str, &str, &[&str]); 6] = [
        (
            "[900, 0, 700]",
            "[0.9, 0, 0.8]",
            &[
                "is 1.2 mm, less than the 10 mm",
                "millimetres, not metres",
                "--limit nearest_base_mm=",
            ],
        ),
        (
            "[0, 0, 180] }\n[zones]",
            "[0, 0, 0.18] }\n[zones]",
            &[
                "the tool's length is 0.18 mm, less than the 1 mm",
                "--limit shortest_tool_mm=",
            ],
        ),
        (
            "a_b_c_kuka_deg = [0, 0, 180]",
            "a_b_c_kuka_deg = [0, 0, 3.14159]",
            &[
                "3.14159 degrees are exactly 180 degrees in radians",
                "cell.toml",
            ],
        ),
        (
            "feeds_mm = 0.3",
            "feeds_mm = 15",
            &[
                "(feeds_mm) ([zones]) is 15 mm, more than the 5 mm",
                "--limit zone_mm=",
            ],
        ),
        (
            "[0, 0, 180] }\n[base]",
            "[0, 0, 0] }\n[base]",
            &["the tool points up", "(0, 0, -180) mm", "tool_orientation"],
        ),
        (
            "[0, 0, 180] }\n[zones]",
            "[0, 0, -180] }\n[zones]",
            &["the tool points up", "the sign of the tool's pose"],
        ),
    ];
    for (old, new, needles) in cases {
        assert!(CELL.contains(old), "{old}");
        std::fs::write(here.join("cell.toml"), CELL.replace(old, new)).unwrap();
        let said = command(here, line);
        // A length below zero is beyond the shortest tool, too.
        match new.contains("-180") {
            true => {
                refused(here, &said, "new.src", &["-180 mm"]);
                let allowed = command(here, &format!("{line} --limit shortest_tool_mm=-200"));
                refused(here, &allowed, "new.src", needles);
            }
            false => refused(here, &said, "new.src", needles),
        }
    }
    std::fs::write(
        here.join("cell.toml"),
        CELL.replace("feeds_mm = 0.3", "feeds_mm = 15"),
    )
    .unwrap();
    command(here, &format!("{line} --limit zone_mm=20")).answered();
    std::fs::remove_file(here.join("new.src")).unwrap();
    // The option has no file to be read again: the turn itself tells.
    let said = command(
        here,
        "convert part.ngc --to krl --out new.src --tool-orientation a_b_c_kuka_deg=0,0,3.14159",
    );
    refused(
        here,
        &said,
        "new.src",
        &[
            "turns by 3.1416 deg, which is 179.9998 deg in radians",
            "_rad",
        ],
    );
}

/// `$VEL.CP` is in m/s, and F in mm/min.
#[test]
fn speeds_have_a_limit_in_every_command_that_writes_a_program() {
    let here = workplace();
    let here = here.path();
    let krl = "DEF part()\n$BASE={X 900,Y 0,Z 700,A 0,B 0,C 0}\n$TOOL={X 0,Y 0,Z 180,A 0,B 0,C 0}\n$VEL.CP=16.67\nPTP {X 0,Y 0,Z 5,A 0,B 0,C 180}\nLIN {X 0,Y 0,Z -1,A 0,B 0,C 180}\nLIN {X 40,Y 0,Z -1,A 0,B 0,C 180}\nEND\n";
    std::fs::write(here.join("part.src"), krl).unwrap();
    let said = command(here, "convert part.src --to rapid --out new.mod");
    refused(
        here,
        &said,
        "new.mod",
        &[
            "the speed at feed is 16670 mm/s, more than the 3000 mm/s",
            "m/s",
            "--limit speed_mm_per_s=",
        ],
    );
    std::fs::write(here.join("part.src"), krl.replace("16.67", "0.01667")).unwrap();
    command(here, "convert part.src --to rapid --out new.mod").answered();
    std::fs::write(here.join("part.ngc"), GCODE.replace("F600", "F600000")).unwrap();
    let (said, _) = compensated(here, ARM_JOB, &arm(), &[]);
    refused(
        here,
        &said,
        "out.ngc",
        &["is 10000 mm/s, more than the 3000 mm/s"],
    );
}

#[test]
fn a_part_far_below_the_base_and_a_negative_cutter_are_refused() {
    let here = workplace();
    let here = here.path();
    std::fs::write(here.join("part.ngc"), GCODE).unwrap();
    let below = ARM_JOB.replace("[1050, 0, 1000]", "[1050, 0, -500]");
    let (said, _) = compensated(here, &below, &arm(), &[]);
    refused(
        here,
        &said,
        "out.ngc",
        &[
            "below the machine's base is 500 mm, more than the 400 mm",
            "the sign of part_origin_mm",
        ],
    );
    let contour = "G21 G90 F300\nG0 X0 Y-20 Z5\nG1 Z-1\nG41.1 D-6\nG1 X0 Y0\nY10\nG40\nG0 Z5\nM2\n";
    std::fs::write(here.join("radius.ngc"), contour).unwrap();
    let said = command(here, "expand radius.ngc --out flat.ngc");
    refused(
        here,
        &said,
        "flat.ngc",
        &["line 4", "a tool of -6 mm in diameter", "G42 for G41"],
    );
}

fn groove(off_mm: f64) -> String {
    let rows = (0..=40).map(|x| format!("{x},{off_mm},0\n"));
    std::iter::once("x_mm,y_mm,z_mm\n".to_owned())
        .chain(rows)
        .collect()
}

/// Registration is a choice, and what it takes away is in the headline.
#[test]
fn mirror_asks_how_points_are_registered_and_keeps_the_limits() {
    let here = workplace();
    let here = here.path();
    std::fs::write(
        here.join("groove.ngc"),
        "G21 G90\nG0 X0 Y0 Z0\nG1 X40 F600\nM30\n",
    )
    .unwrap();
    std::fs::write(here.join("t.csv"), groove(0.17)).unwrap();
    let line = "mirror groove.ngc --measured t.csv --out next.ngc";
    refused(
        here,
        &command(here, line),
        "next.ngc",
        &[
            "--register none",
            "translation",
            "rigid",
            "is not corrected",
        ],
    );
    let said = command(here, &format!("{line} --register none")).answered();
    assert!(
        said.out.contains("0.170 mm") && !said.out.contains("registration"),
        "{said:?}"
    );
    for how in ["translation", "rigid"] {
        let said = command(here, &format!("{line} --register {how} --force-overwrite")).answered();
        let text = in_one_line(&said.out);
        let head = text.split("points count").next().unwrap_or_default();
        assert!(
            head.contains(&format!(
                "The registration ({how}) moved the points by up to 0.170"
            )),
            "{text}"
        );
    }
    std::fs::remove_file(here.join("next.ngc")).unwrap();
    // A turn is a deviation where a shift alone is taken away: 0.2 mm at both ends of 40 mm.
    let turned: String = (0..=40)
        .map(|x| format!("{x},{},0\n", 0.17 + 0.01 * (f64::from(x) - 20.0)))
        .collect();
    std::fs::write(here.join("turned.csv"), format!("x_mm,y_mm,z_mm\n{turned}")).unwrap();
    let largest = |how: &str| {
        let line = format!(
            "mirror groove.ngc --measured turned.csv --out o.ngc --force-overwrite --json --register {how}"
        );
        let said = command(here, &line).answered();
        let found: serde_json::Value = serde_json::from_str(&said.out).unwrap();
        found["measurements"][0]["figures"]["largest_mm"]
            .as_f64()
            .unwrap()
    };
    for (how, expected) in [("none", 0.37), ("translation", 0.2), ("rigid", 0.0)] {
        assert!(
            (largest(how) - expected).abs() < 1e-6,
            "{how}: {}",
            largest(how)
        );
    }
    // Deviations of 3 to 9 mm, with a window that holds them.
    for mm in [3.0, 9.0] {
        std::fs::write(here.join("t.csv"), groove(mm)).unwrap();
        let wide = format!("{line} --register none --window-mm 10");
        refused(
            here,
            &command(here, &wide),
            "next.ngc",
            &[
                "more than the 2 mm that are allowed",
                "--limit correction_mm=",
            ],
        );
        command(
            here,
            &format!("{wide} --limit correction_mm=10 --force-overwrite"),
        )
        .answered();
        std::fs::remove_file(here.join("next.ngc")).unwrap();
    }
    std::fs::write(here.join("t.csv"), groove(0.05)).unwrap();
    let said = command(
        here,
        &format!("{line} --register none --repeatability-um 1000000"),
    );
    refused(
        here,
        &said,
        "next.ngc",
        &["--repeatability-um 1000000", "0.001 to 1000 um"],
    );
}

/// What scatters by nothing, or by more than it is.
#[test]
fn spreads_of_nothing_and_of_too_much_are_refused() {
    let here = workplace();
    let here = here.path();
    let row = |what: &str| format!("schema = 1\n[[uncertain]]\n{what}\n");
    let line = "tolerance orthoglide --uncertain u.toml --force 215 -10 -25 --machines 64";
    let cases: [(&str, &[&str]); 5] = [
        (
            "parameter = \"chain.leg.q2.length_mm\"\nnormal = 0",
            &["a spread of 0", "leave out the table"],
        ),
        (
            "parameter = \"chain.leg.q2.length_mm\"\nnormal = 20",
            &[
                "is 310 mm; a spread of 20 mm is more than the 3 mm",
                "check the unit",
            ],
        ),
        (
            "load = \"force_n.x\"\nuniform_percent = 5000",
            &[
                "a spread of 10750 N is more than the 217 N",
                "the percentage",
            ],
        ),
        (
            "load = \"factor\"\nuniform_percent = 5000",
            &["with this spread some machines have a"],
        ),
        (
            "load = \"force_n.x\"\nnormal = 10\neach = true",
            &["'each' is for a number that several limbs share"],
        ),
    ];
    for (what, needles) in cases {
        std::fs::write(here.join("u.toml"), row(what)).unwrap();
        refused(here, &command(here, line), "none", needles);
    }
}

/// Three legs of one chain: together they are one number, by themselves three.
#[test]
fn numbers_that_limbs_share_scatter_together_or_each_by_itself() {
    let here = workplace();
    let here = here.path();
    let file = |each: &str| {
        let text = format!(
            "schema = 1\n[[uncertain]]\nparameter = \"chain.leg.q2.length_mm\"\nnormal = 0.02\n{each}"
        );
        std::fs::write(here.join("u.toml"), text).unwrap();
    };
    let asked = |more: &str| {
        let line =
            format!("tolerance orthoglide --uncertain u.toml --machines 1024 --only error{more}");
        command(here, &line).answered()
    };
    let numbers = || {
        let found: serde_json::Value = serde_json::from_str(&asked(" --json").out).unwrap();
        let spread =
            found["places"][0]["results"][1]["draws"]["standard_deviation"]["value"].as_f64();
        (
            found["uncertain"].as_array().unwrap().len(),
            spread.unwrap(),
            found["warnings"].to_string(),
        )
    };
    file("");
    let text = in_one_line(&asked("").out);
    assert!(
        text.contains(
            "is one number of 3 limbs (leg x, leg y, leg z) and scatters in all of them together"
        ) && text.contains("each = true"),
        "{text}"
    );
    // Errors of zero at home: no percentage of a zero.
    assert!(
        text.contains("NO (a length at 0)") && !text.contains("%)"),
        "{text}"
    );
    let (count, together, warnings) = numbers();
    assert!(
        count == 1 && warnings.contains("shared_number"),
        "{count} {warnings}"
    );
    file("each = true\n");
    let (count, each, warnings) = numbers();
    assert!(count == 3 && warnings == "[]", "{count} {warnings}");
    // At its home each leg of the Orthoglide moves the tool along its own axis.
    assert!(
        (together - 0.02).abs() < 1e-3 && (each - 0.02).abs() < 1e-3,
        "{together} {each}"
    );
}

/// Tables of spreadsheets in German: semicolons and decimal commas give what points give.
#[test]
fn decimal_commas_are_read_in_tables() {
    let here = workplace();
    let here = here.path();
    std::fs::write(
        here.join("groove.ngc"),
        "G21 G90\nG0 X0 Y0 Z0\nG1 X40 F600\nM30\n",
    )
    .unwrap();
    let german = |text: &str| text.replace(',', ";").replace('.', ",");
    let both = |name: &str, text: &str, line: &str| {
        let answers = [text.to_owned(), german(text)].map(|text| {
            std::fs::write(here.join(name), text).unwrap();
            command(here, line).answered().out
        });
        assert_eq!(answers[0], answers[1], "{line}");
    };
    both(
        "t.csv",
        &groove(0.0525),
        "mirror groove.ngc --measured t.csv --out n.ngc --register none --force-overwrite",
    );
    let map = "x_mm,y_mm,z_mm,dx_mm,dy_mm,dz_mm\n-0.5,0,0,0.1,0,0\n40.5,0,0,0.15,0,0\n";
    both(
        "map.csv",
        map,
        "compensate --program groove.ngc --map map.csv --out m.ngc --force-overwrite",
    );
    // A fault keeps its line.
    std::fs::write(here.join("t.csv"), "x_mm;y_mm;z_mm\n0,5;0;0\n1.234,5;0;0\n").unwrap();
    let said = command(
        here,
        "mirror groove.ngc --measured t.csv --out q.ngc --register none",
    );
    refused(here, &said, "q.ngc", &["t.csv:3: x is `1.234,5`"]);
}

/// Two errors of one element: none is dropped.
#[test]
fn an_error_given_twice_is_refused() {
    let here = workplace();
    let words = |second: &str| {
        let first = "leg x:line:0.5mm along z";
        run(
            here.path(),
            &[
                "assemble",
                "orthoglide",
                "--deviation",
                first,
                "--deviation",
                second,
            ],
        )
    };
    refused(
        here.path(),
        &words("leg x:line:1deg about x"),
        "none",
        &[
            "the limb 'leg x' has a deviation at 'line' already",
            "[[deviation]]: moved_by",
        ],
    );
    words("leg y:line:1deg about x").answered();
}

const SLOT: &str = "MODULE Slot\n  PERS tooldata tMill:=[TRUE,[[0,0,180],[1,0,0,0]],[5,[0,0,60],[1,0,0,0],0,0,0]];\n  PERS wobjdata wPart:=[FALSE,TRUE,\"\",[[1800,0,900],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];\n  PROC main()\n    MoveJ [[0,0,20],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,z10,tMill\\WObj:=wPart;\n    MoveL [[0,0,-1],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,z1,tMill\\WObj:=wPart;\n    MoveL [[60,0,-1],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,fine,tMill\\WObj:=wPart;\n  ENDPROC\nENDMODULE\n";

/// What one command refused or warned of, and its siblings answered without a word: the good question says nothing of it.
#[test]
fn siblings_ask_the_same_of_an_absurd_question() {
    let here = workplace();
    let here = here.path();
    let put = |name: &str, text: &str| std::fs::write(here.join(name), text).unwrap();
    put("part.ngc", GCODE);
    put("on.ngc", &GCODE.replace("G90\n", "G90\nS8000 M3\n"));
    put("off.ngc", &GCODE.replace("G90\n", "G90\nS8000\n"));
    put("z1.mod", SLOT);
    put("z200.mod", &SLOT.replace("v20,z1", "v20,z200"));
    put("cell.toml", CELL);
    put(
        "side.toml",
        &CELL.replace("[0, 0, 180] }\n[base]", "[0, 90, 0] }\n[base]"),
    );
    put("pass.ngc", cut::PASS);
    let block = |mm: &str| cut::JOB.replace("-20, -12]", &format!("-20, {mm}]"));
    put("cut.toml", &block("-70"));
    put("deep.ngc", &cut::PASS.replace("Z-2 ", "Z-60 "));

    let arm = "heavy_6r --tool-length-mm 200 --force-overwrite";
    let placed = "--part-origin-mm 1200 0 900";
    let milling = "--milling 215 -10 25 --weight all";
    let made = format!("compensate --out x.ngc --model {arm} {milling}");
    let of_part = format!("{made} {placed} --program");
    let solved = format!("deflect {arm} {placed} {milling} --program");
    let of_slot = format!("{milling} --force-overwrite --program");
    let fixed = "compensate --model orthoglide --part-origin-mm 0 0 100 --tool-length-mm 100 --milling 215 -10 25 --program part.ngc --out x.ngc --force-overwrite";
    let lobes = "lobes heavy_6r --tool-length-mm 150 --damping 0.03 --teeth 2 --rpm 2000 2100 2 --coefficients-n-per-mm2";
    // What both begin with, the good end, the absurd one, whether that is refused, and what is said of it.
    let cases: [(&str, &str, &str, bool, &str); 15] = [
        (
            &format!("compensate --model heavy_6r --out x.mod {of_slot}"),
            "z1.mod",
            "z200.mod",
            true,
            "is 200 mm, more than the 5 mm",
        ),
        (
            &format!("deflect heavy_6r {of_slot}"),
            "z1.mod",
            "z200.mod",
            false,
            "--limit zone_mm=",
        ),
        (
            &format!("verify z1.mod --model heavy_6r {milling} --against"),
            "z1.mod",
            "z200.mod",
            true,
            "is 200 mm, more than the 5 mm",
        ),
        (
            &format!("{made} --program part.ngc"),
            placed,
            "--part-orientation a_b_c_kuka_deg=0,0,0",
            false,
            "no place of the part is given",
        ),
        (
            &of_part,
            "part.ngc",
            "part.ngc --part-orientation a_b_c_kuka_deg=0,0,180",
            true,
            "the tool points up",
        ),
        (
            &solved,
            "part.ngc",
            "part.ngc --part-orientation a_b_c_kuka_deg=0,0,180",
            true,
            "the tool points up",
        ),
        (
            &of_part,
            "part.ngc",
            "part.ngc --tool-orientation a_b_c_kuka_deg=0,90,0",
            false,
            "the tool lies on its side",
        ),
        (
            "convert part.ngc --to krl --out x.src --force-overwrite --template",
            "cell.toml",
            "side.toml",
            false,
            "the tool lies on its side",
        ),
        (
            &of_part,
            "part.ngc --part-orientation a_b_c_kuka_deg=90,0,0",
            "part.ngc --part-orientation a_b_c_kuka_deg=1.5708,0,0",
            false,
            "a_b_c_kuka_deg: 1.5708 degrees are exactly",
        ),
        (
            fixed,
            "--decimals 4",
            "--weight all",
            false,
            "the model has none",
        ),
        (
            &format!("deflect {arm} {placed} --program part.ngc --weight"),
            "all",
            "none",
            false,
            "no load on the tool is given",
        ),
        (
            "deflect orthoglide --part-origin-mm 0 0 100 --program part.ngc",
            "--force 100 0 0",
            "--threads 1",
            false,
            "no load on the tool is given",
        ),
        (
            lobes,
            "796 168 222",
            "168 796 222",
            false,
            "K_rc = 796 N/mm^2 is above K_tc = 168 N/mm^2",
        ),
        (
            "engagement cut.toml --program",
            "pass.ngc",
            "deep.ngc",
            false,
            "10 times the tool's diameter",
        ),
        (
            &of_part,
            "on.ngc",
            "off.ngc",
            false,
            "never starts it: add M3",
        ),
    ];
    for (line, good, absurd, is_refused, needle) in cases {
        for (end, is_absurd) in [(good, false), (absurd, true)] {
            let said = command(here, &format!("{line} {end}"));
            let text = in_one_line(&format!("{} {}", said.out, said.err));
            assert_eq!(text.contains(needle), is_absurd, "{line} {end}: {text}");
            assert_eq!(
                said.code == 1,
                is_absurd && is_refused,
                "{line} {end}: {text}"
            );
        }
    }
}
