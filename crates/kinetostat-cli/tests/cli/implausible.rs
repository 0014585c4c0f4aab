//! What every command says of loads, weights, angles, origins and outputs beyond what is usual: the reason is named,
//! and what is innocent is not blamed.

use crate::absurd::{ARM_JOB, HEAVY, arm, compensated};
use crate::common::{run, workplace};
use kinetostat_testing::Worst;
use serde_json::Value;

/// An arm sags under its own weight and a spindle: that is no fault, and no wrong unit of the cutting force.
#[test]
fn a_heavy_arm_with_a_spindle_is_not_refused_for_its_own_weight() {
    let here = workplace();
    // KR 270 class, 250 kg at the flange, 1.9 m from its first axis.
    let kuka = include_str!("../../../kinetostat-model/models/kuka_kr270_like.toml");
    let with = |kg: f64| {
        let platform = "[[platform]]\nname = \"tool\"\n";
        assert!(kuka.contains(platform));
        kuka.replace(platform, &format!("{platform}mass_kg = {kg}\n"))
    };
    let job = ARM_JOB.replace("[1050, 0, 1000]", "[1900, 0, 1300]");
    let result = || -> Value {
        let text = std::fs::read(here.path().join("r.json")).expect("JSON");
        serde_json::from_slice(&text).expect("JSON")
    };
    let (said, codes) = compensated(here.path(), &job, &with(250.0), &[]);
    assert_eq!(said.code, 4, "{said:?}");
    assert!(
        !codes.iter().any(|code| code == "large_correction"),
        "{codes:?}"
    );
    let found = result();
    let own = found["summary"]["max_error_by_own_weight_mm"]
        .as_f64()
        .expect("a figure");
    let total = found["summary"]["max_correction_mm"]
        .as_f64()
        .expect("a figure");
    assert!(own > 2.0 && own < 5.0 && total > 2.0, "{own} {total}");
    // The figure is the difference of two independent answers: with and without what acts in the model.
    let bare = with(250.0).replace("[0, 0, -9.81]", "[0, 0, 0]");
    let cut = bare
        .find("[[limb.load]]")
        .map_or(bare.as_str(), |at| &bare[..at]);
    std::fs::write(here.path().join("bare.toml"), cut).expect("a model");
    let shift = |model: &str, at: &[&str]| -> Vec<f64> {
        let mut words = vec![
            "deflect",
            model,
            "--tool-length-mm",
            "180",
            "--force",
            "0",
            "0",
            "0",
            "--json",
            "--at",
        ];
        words.extend(at);
        let said = run(here.path(), &words).answered();
        let found: Value = serde_json::from_str(&said.out).expect("JSON");
        found["displacement_mm"]
            .as_array()
            .expect("a vector")
            .iter()
            .map(|x| x.as_f64().expect("mm"))
            .collect()
    };
    let mut largest = Worst::new();
    for place in [
        ["1920", "0", "1299"],
        ["1900", "20", "1299"],
        ["1880", "0", "1299"],
    ] {
        let both = [shift("arm.toml", &place), shift("bare.toml", &place)];
        let off = (0..3)
            .map(|k| (both[0][k] - both[1][k]).powi(2))
            .sum::<f64>()
            .sqrt();
        assert!(off.is_finite());
        largest.add(off);
    }
    let largest = largest.value();
    assert!((largest - own).abs() < 0.02 * own, "{largest} {own}");
    let flat = said.out.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        flat.contains("the machine's own weight") && flat.contains("all of it is corrected"),
        "{flat}"
    );
    // A mass in the wrong unit is still found, and so is a force.
    let (said, _) = compensated(here.path(), &job, &with(1000.0), &[]);
    assert!(
        said.code == 1 && said.err.contains("--limit own_weight_mm="),
        "{said:?}"
    );
    let strong = job.replace("radial_n = 215.0", "radial_n = 3000.0");
    let (said, _) = compensated(here.path(), &strong, &with(250.0), &[]);
    assert!(
        said.code == 1 && said.err.contains("--limit correction_mm="),
        "{said:?}"
    );
    assert!(!said.err.contains("own_weight_mm"), "{said:?}");
}

/// An analysis answers loads that a program would be refused for, and says so; at a place as on a map.
#[test]
fn a_load_beyond_the_limits_is_reported_wherever_it_is_given() {
    let here = workplace();
    let place: &[&[&str]] = &[
        &["deflect", "hexapod"],
        &["stiffness", "hexapod"],
        &["map", "orthoglide", "--x", "-10", "10", "3"],
    ];
    for command in place {
        for (load, reported) in [
            (["--force", "0", "0", "-4999"], false),
            (["--force", "0", "0", "-6000"], true),
            (["--moment", "0", "0", "199"], false),
            (["--moment", "0", "0", "250"], true),
        ] {
            let words = [command, &load[..], &["--json"]].concat();
            let said = run(here.path(), &words);
            let answer: Value = serde_json::from_str(&said.out).expect("JSON");
            let list = answer["warnings"].as_array().expect("a list");
            let found = list.iter().find(|w| w["code"] == "over_limit");
            assert_eq!(found.is_some(), reported, "{words:?}: {said:?}");
            if let Some(warning) = found {
                let message = warning["message"].as_str().expect("a text");
                assert!(message.contains("that are allowed. Usual: "), "{message}");
                assert!(!message.contains("--limit"), "{message}");
                assert!(said.err.contains("more than the"), "{}", said.err);
            }
        }
    }
    let said = run(
        here.path(),
        &["deflect", "hexapod", "--force", "0", "0", "-1e7"],
    );
    let shown = format!("{}{}", said.out, said.err);
    assert!(shown.contains("more than the 5000 N"), "{said:?}");
}

/// Where the load is the reason, the place is not blamed.
#[test]
fn a_map_without_an_equilibrium_blames_the_load() {
    let here = workplace();
    let at = ["map", "orthoglide", "--x", "0", "--y", "0", "--z", "0"];
    for force in ["1e12", "1e300"] {
        let words = [&at[..], &["--force", "0", "0", force]].concat();
        let said = run(here.path(), &words);
        if said.code == 0 {
            continue;
        }
        assert_eq!(said.code, 2, "{said:?}");
        assert!(
            said.err.contains("no equilibrium was found"),
            "{}",
            said.err
        );
        assert!(!said.err.contains("choose places"), "{}", said.err);
    }
    let said = run(
        here.path(),
        &["map", "orthoglide", "--x", "5000", "--force", "0", "0", "1"],
    );
    assert!(said.err.contains("choose places"), "{}", said.err);
}

/// Angles of a job that are shares of pi are most likely radians, whatever the key.
#[test]
fn angles_in_radians_under_degrees_are_implausible_in_every_command() {
    let here = workplace();
    let at = "[placement]\n";
    for (key, list, odd) in [
        (
            "part_orientation = { a_b_c_kuka_deg",
            "[1.5708, 0, 0]",
            true,
        ),
        ("part_orientation = { a_b_c_kuka_deg", "[90, 0, 0]", false),
        (
            "part_orientation = { a_b_c_kuka_deg",
            "[0.3, 1.2, 7]",
            false,
        ),
        (
            "tool_orientation = { rotation_vector_deg",
            "[0, 3.1416, 0]",
            true,
        ),
        (
            "part_orientation = { rotation_vector_rad",
            "[0, 0, 90]",
            true,
        ),
        (
            "part_orientation = { rotation_vector_rad",
            "[0, 0, 1.5708]",
            false,
        ),
    ] {
        let job = ARM_JOB.replace(at, &format!("{at}{key} = {list} }}\n"));
        let line = 1 + job[..job.find(key).expect("the key")].matches('\n').count();
        compensated(here.path(), &job, &arm(), &[]);
        for words in [
            &["check", "job.toml"][..],
            &["deflect", "job.toml", "--force-overwrite"],
            &["compensate", "job.toml", "--force-overwrite"],
        ] {
            let said = run(here.path(), words);
            // A place that cannot be reached so is reported as that.
            if matches!(said.code, 1 | 2) {
                continue;
            }
            let shown = crate::common::checks::flat(&format!("{}{}", said.out, said.err));
            let named = shown.contains(&format!("job.toml, line {line}:"))
                && shown.contains("this looks like");
            assert_eq!(named, odd, "{words:?} {key} {list}: {said:?}");
        }
    }
}

/// What is beyond its limits by far is refused before the program is solved everywhere, with what is
/// implausible in the
/// model; a place is questioned as a program is.
#[test]
fn a_hopeless_program_is_refused_with_what_is_implausible_in_the_model() {
    let here = workplace();
    let soft = arm().replace(
        "stiffness_n_m_per_rad = 4.7e5",
        "stiffness_n_m_per_rad = 0.47",
    );
    assert_ne!(soft, arm());
    let (said, _) = compensated(here.path(), ARM_JOB, &soft, &[]);
    assert_eq!(said.code, 1, "{said:?}");
    for words in [
        "--limit correction_mm=",
        "Perhaps the reason",
        "softer than any machine's",
    ] {
        assert!(said.err.contains(words), "{words}: {}", said.err);
    }
    for (length, odd) in [("-180", true), ("0.18", true), ("5", true), ("180", false)] {
        for command in ["stiffness", "deflect"] {
            let words = [command, "heavy_6r", "--tool-length-mm", length];
            let place = ["--at", "1500", "0", "1000", "--force", "0", "0", "-100"];
            let said = run(here.path(), &[&words[..], &place[..]].concat());
            assert_eq!(said.code, 0, "{said:?}");
            assert_eq!(
                said.out.contains("Usual:") || said.out.contains("check the unit"),
                odd,
                "{said:?}"
            );
        }
    }
}

/// A text, an option or a file is wrong by itself, however implausible the model is.
#[test]
fn what_is_wrong_without_the_model_is_not_put_down_to_it() {
    let here = workplace();
    let soft = arm().replace(
        "stiffness_n_m_per_rad = 4.7e5",
        "stiffness_n_m_per_rad = 0.47",
    );
    assert_ne!(soft, arm());
    std::fs::write(here.path().join("model.toml"), soft).unwrap();
    for (program, words) in [
        (
            "(kinetostat: compensated program)\nG21 G90 G17\nG0 X0 Y0 Z5\nG1 X9 F600\nM2\n",
            "marked as compensated already",
        ),
        ("G21 G90 G17\nG0 X0 Y0 Z5\nG1 X9 X8 F600\nM2\n", "line 3"),
    ] {
        std::fs::write(here.path().join("part.ngc"), program).unwrap();
        let line = "compensate --model model.toml --program part.ngc --force 0 0 -100 --part-origin-mm 1050 0 1000 --tool-length-mm 180 --out new.ngc";
        let said = run(here.path(), &line.split(' ').collect::<Vec<_>>());
        assert_ne!(said.code, 0, "{said:?}");
        assert!(said.err.contains(words), "{words}: {}", said.err);
        assert!(!said.err.contains("Perhaps the reason"), "{}", said.err);
    }
}

/// Where the machine's own loads have no equilibrium, the load on the tool is not blamed.
#[test]
fn a_machine_that_its_own_weight_folds_is_reported_as_that() {
    let here = workplace();
    let heavy = HEAVY.replace("[0, 0, -9.81]", "[0, 0, -9.81e6]");
    assert_ne!(heavy, HEAVY);
    std::fs::write(here.path().join("heavy.toml"), heavy).expect("a model");
    for force in ["0", "-100"] {
        let said = run(
            here.path(),
            &["deflect", "heavy.toml", "--force", "0", "0", force],
        );
        assert_eq!(said.code, 2, "{said:?}");
        assert!(
            said.err.contains("without any load on the tool"),
            "{said:?}"
        );
        assert!(!said.err.contains("try a part of it"), "{said:?}");
    }
}

/// An origin of the part in metres puts a large machine's base into the part.
#[test]
fn an_origin_in_metres_is_implausible_in_every_command() {
    let here = workplace();
    std::fs::write(here.path().join("arm.toml"), arm()).expect("a model");
    let advice = "check the unit of part_origin_mm";
    for (origin, implausible) in [
        ("[1.05, 0, 1.0]", true),
        ("[1.05, -0.03, 0.9]", true),
        ("[0, 0, 0.5]", true),
        ("[1050, 0, 1000]", false),
        ("[0, 0, 0]", false),
        ("[12, 0, 1000]", false),
    ] {
        let job = ARM_JOB.replace("[1050, 0, 1000]", origin);
        std::fs::write(here.path().join("job.toml"), job).expect("a job");
        for words in [
            vec!["check", "job.toml"],
            vec!["deflect", "job.toml"],
            vec!["compensate", "job.toml", "--force-overwrite"],
        ] {
            let said = run(here.path(), &words);
            let text = format!("{} {}", said.out, said.err);
            let flat: Vec<&str> = text.split_whitespace().collect();
            let reported = flat.join(" ").contains(advice);
            assert_eq!(reported, implausible, "{origin} {words:?}: {said:?}");
        }
    }
}

/// What a compensation refuses of its outputs, the check of the job refuses too.
#[test]
fn a_check_refuses_the_outputs_that_a_compensation_refuses() {
    let here = workplace();
    std::fs::write(here.path().join("arm.toml"), arm()).expect("a model");
    std::fs::create_dir(here.path().join("folder")).expect("a directory");
    for (outputs, refused) in [
        ("program = \"part.ngc\"", true),
        ("program = \"./part.ngc\"", true),
        ("program = \"arm.toml\"", true),
        ("program = \"job.toml\"", true),
        ("program = \"out.ngc\"\nreport = \"out.ngc\"", true),
        (
            "program = \"out.ngc\"\nreport = \"folder/../out.ngc\"",
            true,
        ),
        ("program = \"out.ngc\"\njson = \"r\"\npoints = \"r\"", true),
        ("report = \"part-compensated.ngc\"", true),
        ("program = \"folder\"", true),
        ("program = \"gone/out.ngc\"", true),
        (
            "program = \"out.ngc\"\nreport = \"r.html\"\njson = \"r.json\"",
            false,
        ),
    ] {
        let job = ARM_JOB.replace("program = \"out.ngc\"", outputs);
        std::fs::write(here.path().join("job.toml"), job).expect("a job");
        let checked = run(here.path(), &["check", "job.toml"]);
        assert_eq!(checked.code == 1, refused, "{outputs}: {checked:?}");
        let made = run(here.path(), &["compensate", "job.toml"]);
        assert_eq!(made.code == 1, refused, "{outputs}: {made:?}");
        assert!(!refused || checked.err == made.err, "{checked:?} {made:?}");
    }
}

/// The limit of blocks per second holds in programs that are shorter than the row that a peak is taken over.
#[test]
fn a_limit_of_blocks_per_second_holds_in_short_programs() {
    let here = workplace();
    let limit = ["--limit", "blocks_per_second=0.1"];
    let (said, _) = compensated(here.path(), ARM_JOB, &arm(), &limit);
    let refused = said.err.contains("--limit blocks_per_second=");
    let result = compensated(here.path(), ARM_JOB, &arm(), &[]).0;
    assert_eq!(result.code, 4, "{result:?}");
    let text = std::fs::read_to_string(here.path().join("r.json")).expect("a result");
    let summary: Value = serde_json::from_str::<Value>(&text).expect("JSON")["summary"].take();
    let [before, after] = ["before", "after"].map(|when| {
        let rate = |kind: &str| summary[format!("{kind}_blocks_per_second_{when}")].as_f64();
        rate("peak")
            .or_else(|| rate("mean"))
            .expect("feeds per minute")
    });
    assert_eq!(refused, after > 0.1 && after > 1.05 * before, "{summary}");
}

/// A force whose square is no number is a wrong number, and is named as it was written.
#[test]
fn a_force_that_nothing_carries_is_refused_with_its_number() {
    let here = workplace();
    let strong = ARM_JOB.replace("radial_n = 215.0", "radial_n = 1e300");
    assert_ne!(strong, ARM_JOB);
    let (said, _) = compensated(here.path(), &strong, HEAVY, &[]);
    assert_eq!(said.code, 1, "{said:?}");
    assert!(said.err.contains("1e300 N"), "{said:?}");
    for word in ["infinite", "not available"] {
        assert!(!said.err.contains(word), "{said:?}");
    }
}

/// The energy of a shape that nothing strains is shown as zero, not as what rounding leaves.
#[test]
fn the_energy_of_an_unstrained_shape_is_zero() {
    let here = workplace();
    let said = run(
        here.path(),
        &["equilibria", "two_link", "--at", "150", "0", "0"],
    )
    .answered();
    let first = said.out.lines().find(|line| line.starts_with("  1 "));
    let energy = first.and_then(|line| line.split_whitespace().nth(1));
    assert_eq!(energy, Some("0"), "{}", said.out);
    assert!(said.out.contains("0.0450846"), "{}", said.out);
}

/// What a compensation refuses, because an actuator would leave its limits, is not called reached by `check`.
#[test]
fn an_end_of_the_program_outside_a_limit_is_not_reached() {
    let here = workplace();
    run(here.path(), &["demo", "--out", "d"]).answered();
    let job = std::fs::read_to_string(here.path().join("d/job.toml")).expect("the job");
    let off = job.replace("[20, 20, 120]", "[0.02, 0.02, 0.12]");
    assert_ne!(job, off);
    std::fs::write(here.path().join("d/job.toml"), off).expect("a job");
    let said = run(here.path(), &["check", "d/job.toml"]);
    let flat = format!("{} {}", said.out, said.err);
    let flat = flat.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(flat.contains("outside its limits"), "{flat}");
    assert_ne!(said.code, 0, "{flat}");
    let said = run(
        here.path(),
        &["compensate", "d/job.toml", "--force-overwrite"],
    );
    assert!(
        said.code != 0 && said.err.contains("outside its limits"),
        "{said:?}"
    );
}

/// What a compensation would refuse of a job's load and tool, or warn of, `check` tells.
#[test]
fn a_check_tells_what_a_compensation_refuses_of_load_and_tool() {
    let here = workplace();
    for (from, to, code) in [
        (
            "radial_n = 215.0",
            "radial_n = 215000.0",
            Some("over_limit"),
        ),
        ("length_mm = 180", "length_mm = -100", Some("over_limit")),
        ("axial_n = 25.0", "axial_n = -300.0", Some("pulling_force")),
        ("path_um = 20", "path_um = 200", Some("wide_tolerance")),
        ("radial_n = 215.0", "radial_n = 216.0", None),
    ] {
        let job = ARM_JOB.replace("weight = \"all\"\n", "");
        let job = job.replace(from, to);
        assert_ne!(job, ARM_JOB);
        let (said, codes) = compensated(here.path(), &job, &arm(), &[]);
        let refused = said.code == 1 && said.err.contains("--limit");
        assert_eq!(refused, code == Some("over_limit"), "{to}: {said:?}");
        if let Some(code) = code.filter(|_| !refused) {
            assert!(codes.contains(&code.to_owned()), "{to}: {codes:?}");
        }
        let said = run(here.path(), &["check", "job.toml", "--json"]);
        assert_eq!(said.code == 1, refused, "{said:?}");
        let found: Value = serde_json::from_str(&said.out).expect("JSON");
        let list = found["warnings"].as_array().expect("a list");
        let mut codes: Vec<_> = list.iter().filter_map(|w| w["code"].as_str()).collect();
        // A load far beyond its limit takes others with it.
        codes.dedup();
        assert_eq!(codes, Vec::from_iter(code), "{to}: {said:?}");
    }
}

/// A load that no cutting has folds the machine over: an analysis refuses it at once, with the limit that moves it.
#[test]
fn a_load_that_folds_the_machine_over_is_refused_before_the_program_is_solved() {
    let here = workplace();
    run(here.path(), &["demo", "--out", "d"]).answered();
    let job = std::fs::read_to_string(here.path().join("d/job.toml")).expect("the job");
    for force in ["1e4", "1e5"] {
        let strong = job.replace("radial_n = 215", &format!("radial_n = {force}"));
        assert_ne!(job, strong);
        std::fs::write(here.path().join("d/job.toml"), strong).expect("a job");
        let said = run(here.path(), &["deflect", "d/job.toml"]);
        assert_eq!(said.code, 1, "{said:?}");
        assert!(said.err.contains("--limit force_n="), "{said:?}");
    }
}

#[test]
fn a_machine_without_a_spring_is_refused() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    let urdf = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../../shared/data/urdf/kuka_kr210l150.urdf"
    );
    if !std::path::Path::new(urdf).is_file() {
        println!("SKIPPED: ../shared/data/urdf/kuka_kr210l150.urdf is not there");
        return;
    }
    let import = ["import", "urdf", urdf, "--base", "base_link"];
    let further = ["--tip", "tool0", "-o", "arm.toml"];
    run(here, &[import.as_slice(), &further].concat());
    std::fs::write(
        here.join("a.ngc"),
        "G21 G90\nG0 X0 Y0 Z5\nG1 X40 F600\nM30\n",
    )
    .unwrap();
    let along = "--program a.ngc --force 60 20 100 --part-origin-mm 1800 0 900";
    std::fs::write(here.join("k.toml"), "[[uncertain]]\n").unwrap();
    for line in [
        format!("compensate --model arm.toml {along}").as_str(),
        format!("deflect arm.toml {along}").as_str(),
        "deflect arm.toml --joints A1=0 --force 0 0 -100",
        "stiffness arm.toml",
        "map arm.toml --x 1500 1700 2",
        "shares arm.toml --direction z",
        "tolerance arm.toml --uncertain k.toml",
        "modes arm.toml",
        "equilibria arm.toml",
    ] {
        let said = run(here, &line.split(' ').collect::<Vec<_>>());
        assert_eq!(said.code, 1, "{said:?}");
        let text = said.err.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(
            text.contains("has no spring") && text.contains("FILL IN"),
            "{text}"
        );
    }
}
