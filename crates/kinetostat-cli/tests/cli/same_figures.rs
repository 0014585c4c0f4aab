//! The figures of a program without compensation do not depend on the command that computes them.

use std::path::Path;

use crate::common::{run, workplace};
use kinetostat_machining::number::{largest_length, mean_length};
use serde_json::Value;

/// A plunge, a line, an arc, far apart rapids and a short block: unlike lengths, in which places lie unlike.
const UNEVEN: &str = "G21 G90 G17\nG0 X0 Y0 Z5\nG1 Z0 F300\nG1 X20 Y7 F600\nG2 X30 Y17 I10 J0\nG1 X30.2 Y17\n\
                      G0 Z5\nG0 X-30 Y-30\nG1 Z0 F300\nG1 X-10 Y-30 F600\nG0 Z5\nM2\n";

fn json(here: &Path, line: &str) -> Value {
    let words: Vec<&str> = line.split(' ').collect();
    let said = run(here, &words);
    // A tolerance that is missed, or rests on assumptions, is an answer, too.
    assert!([0, 3, 4].contains(&said.code), "{line}: {said:?}");
    serde_json::from_str(&said.out).expect("JSON")
}

/// Where the tool's tip is at home, mm.
fn home(here: &Path, preset: &str) -> [f64; 3] {
    let answer = json(
        here,
        &format!("deflect {preset} --tool-length-mm 100 --json"),
    );
    let place = &answer["place"]["position_mm"];
    [0, 1, 2].map(|k| place[k].as_f64().expect("a number"))
}

#[test]
fn deflect_and_compensate_agree_before_compensation() {
    let here = workplace();
    let here = here.path();
    std::fs::write(here.join("uneven.ngc"), UNEVEN).expect("a program");
    for preset in ["scara", "orthoglide", "heavy_6r", "prs3", "hexapod"] {
        let [x, y, z] = match preset {
            "scara" => [400.0, 100.0, 230.0],
            _ => home(here, preset),
        };
        let query = format!(
            "--weight all --program uneven.ngc --tool-length-mm 100 --part-origin-mm {x} {y} {z} --milling 20 -5 -10 --json"
        );
        let plain = json(here, &format!("deflect {preset} {query}"));
        let line = format!("compensate --model {preset} {query} - --out o.ngc --force-overwrite");
        let corrected = json(here, &line);
        let [plain, corrected] = [&plain["summary"], &corrected["summary"]];
        let number = |of: &Value, name: &str| of[name].as_f64().unwrap_or(f64::NAN);
        // A written program is looked at in more places than the one as given: in one of them the error may be a
        // little larger.
        let [a, b] = [plain, corrected].map(|of| number(of, "max_position_error_before_mm"));
        assert!(a > 0.0 && b >= a * (1.0 - 1e-9), "{preset}: {a} {b}");
        assert!(b <= a * (1.0 + 1e-4), "{preset}: {a} {b}");
        // Without compensation: the same figure to the last digit shown.
        for (name, shown) in [
            (
                "rms_position_error_before_mm",
                mean_length as fn(f64) -> String,
            ),
            ("feed_length_mm", mean_length),
            ("max_error_by_own_weight_mm", largest_length),
        ] {
            if plain[name].is_null() && corrected[name].is_null() {
                continue;
            }
            let [a, b] = [plain, corrected].map(|of| number(of, name));
            assert!(a > 0.0, "{preset} {name}: {a}");
            assert_eq!(shown(a), shown(b), "{preset} {name}: {a} {b}");
        }
        // What depends on where the machine stands moves with the correction, here by less than 0.1 %.
        for name in [
            "smallest_stiffness_n_per_mm",
            "largest_share_to_buckling",
            "max_residual_rotation_deg",
            "max_tool_turn_deg",
        ] {
            assert_eq!(
                plain[name].is_null(),
                corrected[name].is_null(),
                "{preset} {name}"
            );
            if plain[name].is_null() {
                continue;
            }
            let [a, b] = [plain, corrected].map(|of| number(of, name));
            assert!(
                (a - b).abs() <= 1e-3 * a.abs() + 1e-9,
                "{preset} {name}: {a} {b}"
            );
        }
    }
}

/// A table of three slides of 1000 N/mm: where 20 N act on it, it is 0.02 mm off, elsewhere nowhere. The mean of
/// the squares along the path counts every millimetre alike, in however many blocks it is cut.
#[test]
fn the_mean_is_that_of_the_path_and_not_of_the_places() {
    let here = workplace();
    let here = here.path();
    let model = r#"schema = 1
[mechanism]
name = "table"
[[platform]]
name = "tool"
home = { position_mm = [300, 0, 0] }
[chain.arm]
elements = [
  { actuator = "prismatic", name = "x", axis = "x", stiffness_n_per_mm = 1000 },
  { actuator = "prismatic", name = "y", axis = "y", stiffness_n_per_mm = 1000 },
  { actuator = "prismatic", name = "z", axis = "z", stiffness_n_per_mm = 1000 },
  { rigid = { translation_mm = [300, 0, 0] } },
]
[[limb]]
name = "arm"
from = "base"
to = "tool"
chain = "arm"
"#;
    std::fs::write(here.join("table.toml"), model).expect("a model");
    // 10 mm without a load, then 30 mm with it, in one block and in many, and a long rapid between.
    let short: String = (1..=60)
        .map(|k| format!("G1 X{}\n", 10.0 + 0.5 * f64::from(k)))
        .collect();
    let long = "G1 X40\n".to_owned();
    for cut in [short, long] {
        let program =
            format!("G21 G90 G17\nG0 X0 Y0 Z5\nG1 X10 F600\nG0 Z-1\n{cut}G0 Z50\nG0 X0\nM2\n");
        std::fs::write(here.join("two.ngc"), program).expect("a program");
        let query =
            "--program two.ngc --part-origin-mm 300 0 0 --force 0 20 0 --below-z-mm 0 --json";
        let most = 20.0 / 1000.0;
        // The load comes over the first millimetres of the cut: 20 N at half a millimetre per mm and 1000 N/mm.
        let comes_over = 20.0 / (0.5 * 1000.0);
        let own: f64 = most * ((30.0_f64 - comes_over * 2.0 / 3.0) / 40.0).sqrt();
        for line in [
            format!("deflect table.toml {query}"),
            format!("compensate --model table.toml {query} - --out o.ngc --force-overwrite"),
        ] {
            let summary = &json(here, &line)["summary"];
            let number = |name: &str| summary[name].as_f64().expect("a number");
            let largest = number("max_position_error_before_mm");
            assert!((largest - most).abs() < 1e-9, "{line}: {largest}");
            let mean = number("rms_position_error_before_mm");
            // Over that length by the places that are looked at.
            let known = most * comes_over / 40.0;
            assert!((mean - own).abs() < known, "{line}: {mean} {own}");
        }
    }
}

/// Arcs divided within a tolerance would put the tool farther off than a small load does.
#[test]
fn no_program_is_made_worse_by_its_compensation() {
    let here = workplace();
    let here = here.path();
    std::fs::write(here.join("uneven.ngc"), UNEVEN).expect("a program");
    let [x, y, z] = home(here, "orthoglide");
    let (mut as_it_is, mut corrected) = (0, 0);
    for (force, tolerance) in [
        ("0 0 -0.05", 0.5),
        ("0 0 -0.2", 0.5),
        ("0.5 1 -0.5", 0.5),
        ("3 -2 -9", 0.5),
        ("3 -2 -9", 4.0),
        ("100 50 -30", 20.0),
        ("100 50 -30", 500.0),
    ] {
        let line = format!(
            "compensate --model orthoglide --program uneven.ngc --tool-length-mm 100 --part-origin-mm {x} {y} {z} --force {force} --tolerance-um {tolerance} --json - --out o.ngc --force-overwrite"
        );
        let answer = json(here, &line);
        let number = |name: &str| answer["summary"][name].as_f64().unwrap_or(f64::NAN);
        let [before, after] =
            ["before", "after"].map(|when| number(&format!("max_position_error_{when}_mm")));
        assert!(after <= before, "{line}: {before} {after}");
        let unchanged = std::fs::read(here.join("o.ngc")).expect("written") == UNEVEN.as_bytes();
        assert_eq!(answer["summary"]["unchanged"], unchanged, "{line}");
        if before > 1e-4 {
            // Within the tolerance (and that of chords, and the last digit) nothing is touched.
            assert_eq!(
                answer["summary"]["within_tolerance_before"], unchanged,
                "{line}"
            );
        }
        match unchanged {
            true => as_it_is += 1,
            false => corrected += 1,
        }
    }
    assert!(as_it_is >= 3 && corrected >= 3, "{as_it_is} {corrected}");
}

/// A tolerance of chords allows nothing on a program without arcs.
#[test]
fn straight_lines_are_corrected_whatever_chords_may_do() {
    let here = workplace();
    let here = here.path();
    let lines = "G21 G90 G17\nG0 X0 Y0 Z5\nG1 Z-1 F300\nX40 F600\nY20\nX0\nG0 Z5\nM2\n";
    std::fs::write(here.join("lines.ngc"), lines).expect("a program");
    for chord in ["0.4", "50", "1000"] {
        let line = format!(
            "compensate --model orthoglide --program lines.ngc --tool-length-mm 100 --part-origin-mm 0 0 100 --force 215 -10 -25 --tolerance-um 0.5 --chord-tolerance-um {chord} --json - --out o.ngc --force-overwrite"
        );
        let answer = json(here, &line);
        let number = |group: &str, name: &str| answer[group][name].as_f64().unwrap_or(f64::NAN);
        assert!(number("summary", "max_position_error_before_mm") > 0.05);
        assert!(number("summary", "max_position_error_after_mm") < 6e-4);
        assert!(number("tolerance", "allowed_mm") < 6e-4, "{answer}");
        assert_eq!(answer["summary"]["unchanged"], false);
    }
}

/// Limits and the usual tolerance are those of the machine, in which a program may be scaled.
#[test]
fn limits_are_millimetres_of_the_machine() {
    let here = workplace();
    let here = here.path();
    std::fs::write(
        here.join("s.ngc"),
        "G21 G90 G17\nG0 X0 Y0 Z0\nG1 X20 F600\nM2\n",
    )
    .expect("a program");
    for (scale, shown) in [("1", "3.6"), ("10", "4.1")] {
        let line = format!(
            "compensate --model kuka_kr270_like --weight all --program s.ngc --force 2500 -1200 150 --tool-length-mm 150 --part-origin-mm 1500 200 1000 --scale {scale} --out o.ngc --force-overwrite"
        );
        let said = run(here, &line.split(' ').collect::<Vec<_>>());
        assert_eq!(said.code, 1, "{line}: {said:?}");
        assert!(
            said.err.contains("correction_mm") && said.err.contains(shown),
            "{line}: {said:?}"
        );
    }
    let line = "compensate --model kuka_kr270_like --weight all --program s.ngc --force 250 -120 15 --tool-length-mm 150 --part-origin-mm 1500 200 1000 --out o.ngc --force-overwrite --json -";
    let [one, ten] = ["1", "10"].map(|scale| {
        let answer = json(here, &format!("{line} --scale {scale}"));
        answer["question"]["tolerance_mm"]
            .as_f64()
            .expect("a number")
    });
    assert!((one - 10.0 * ten).abs() < 1e-12, "{one} {ten}");
}

/// A folded arm has fewer motions than its neighbours.
#[test]
fn folded_arms_are_answered() {
    let here = workplace();
    for line in [
        "stiffness two_link --at 0 0 0",
        "deflect two_link --at 0 0 0",
    ] {
        let words: Vec<&str> = line.split(' ').collect();
        let said = run(here.path(), &words);
        assert!([0, 2].contains(&said.code), "{line}: {said:?}");
    }
}

/// The scale of a program is no way to a question without sense.
#[test]
fn a_scale_out_of_range_is_refused() {
    let here = workplace();
    std::fs::write(here.path().join("uneven.ngc"), UNEVEN).expect("a program");
    for scale in ["1e-5", "1e9", "0"] {
        let line = format!(
            "compensate --model orthoglide --program uneven.ngc --force 1 2 3 --scale {scale} --out o.ngc"
        );
        let words: Vec<&str> = line.split(' ').collect();
        let said = run(here.path(), &words);
        assert_eq!(said.code, 1, "{line}: {said:?}");
        assert!(said.err.contains("--scale is"), "{line}: {said:?}");
    }
}
