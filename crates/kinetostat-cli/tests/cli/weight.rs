//! Own weight along programs: stated in the job or by options, refused where nobody says it, told in the headline.

use crate::common::{Said, run, workplace};
use serde_json::Value;
use std::path::Path;

const JOB: &str = "schema = 1\nmodel = \"arm.toml\"\nprogram = \"part.ngc\"\n[placement]\npart_origin_mm = [1500, 0, 900]\n[tool]\nlength_mm = 180\n[load]\nforce_n = [100, 0, -50]\n[output]\nprogram = \"out.ngc\"\n";

fn here(job: &str, model: &str) -> tempfile::TempDir {
    let here = workplace();
    std::fs::write(here.path().join("job.toml"), job).expect("written");
    std::fs::write(here.path().join("arm.toml"), model).expect("written");
    here
}

fn arm() -> &'static str {
    include_str!("../../../kinetostat-model/models/heavy_6r.toml")
}

fn said(here: &Path, line: &str) -> Said {
    run(here, &line.split(' ').collect::<Vec<_>>())
}

fn flat(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Largest displacement by own weight, the part of it that is an error, and the headline.
fn deflected(here: &Path, more: &str) -> ([f64; 2], String) {
    let found = said(here, &format!("deflect job.toml --json{more}")).answered();
    let json: Value = serde_json::from_str(&found.out).expect("JSON");
    let of = |name: &str| json["summary"][name].as_f64().expect("a figure");
    let both = [
        "max_displacement_by_weight_mm",
        "max_error_by_own_weight_mm",
    ]
    .map(of);
    (both, flat(&found.err))
}

/// Frequencies of the arm with its tool, Hz.
fn modes(here: &Path, more: &str) -> Vec<f64> {
    let line = format!("modes arm.toml --tool-length-mm 180 --json{more}");
    let json: Value = serde_json::from_str(&said(here, &line).answered().out).expect("JSON");
    let modes = json["modes"].as_array().expect("modes").iter();
    let hz = modes.map(|mode| mode["frequency_hz"].as_f64().expect("a figure"));
    hz.collect()
}

#[test]
fn every_command_along_a_program_asks_what_becomes_of_own_weight() {
    let here = here(JOB, arm());
    std::fs::copy(here.path().join("part.ngc"), here.path().join("other.ngc")).expect("a copy");
    for line in [
        "compensate job.toml",
        "deflect job.toml",
        "verify other.ngc --job job.toml",
        "place job.toml --x-mm 1400 1600",
        "check job.toml",
    ] {
        let found = said(here.path(), line);
        let text = flat(&found.err);
        assert_eq!(found.code, 1, "{line}: {found:?}");
        for word in [
            "own weight",
            "\"touch-off\"",
            "\"all\"",
            "\"none\"",
            "--weight",
        ] {
            assert!(text.contains(word), "{line}: {text}");
        }
    }
    assert!(!here.path().join("out.ngc").exists());
}

#[test]
fn options_and_job_say_the_same_and_the_headline_tells_it() {
    let here = here(JOB, arm());
    let of_option = |more: &str| deflected(here.path(), more);
    let ([whole, error], text) = of_option(" --weight all");
    assert!(
        whole > 0.1 && (whole - error).abs() < 1e-9,
        "{whole} {error}"
    );
    assert!(text.contains("all of it counts as an error"), "{text}");
    let ([same, error], text) = of_option(" --weight none");
    assert!(
        (same - whole).abs() < 1e-9 && error < 1e-9,
        "{same} {error}"
    );
    assert!(text.contains("none of it counts as an error"), "{text}");
    let touched = " --weight touch-off --touch-off 0 0 0";
    let ([same, error], text) = of_option(touched);
    assert!(
        (same - whole).abs() < 1e-9 && error < 0.2 * whole,
        "{same} {error}"
    );
    assert!(text.contains("only its change"), "{text}");
    let in_job = "[load]\nweight = \"touch-off\"\ntouch_off_mm = [[0, 0, 0]]\n";
    let job = JOB.replace("[load]\n", in_job);
    std::fs::write(here.path().join("job.toml"), job).expect("written");
    assert_eq!(deflected(here.path(), "").0, [same, error]);
    // An option goes over the job.
    assert!(deflected(here.path(), " --weight none").0[1] < 1e-9);
    for (line, word) in [
        (
            " --weight touch-off --touch-off 0 0 0 --touch-off 50 0 0",
            "on one line",
        ),
        (" --weight all --touch-off 0 0 0", "leave the places out"),
    ] {
        let found = said(here.path(), &format!("deflect job.toml{line}"));
        assert!(found.code == 1 && found.err.contains(word), "{found:?}");
    }
}

/// A tool of 80 kg in the job is that of a model whose flange carries it.
#[test]
fn the_mass_of_the_tool_is_carried() {
    let carried = "mass_kg = 80\ncentre_of_mass_mm = [10, 0, 70]\n";
    let job = JOB.replace("[load]\n", "[load]\nweight = \"all\"\n");
    let of_job = here(
        &job.replace("length_mm = 180\n", &format!("length_mm = 180\n{carried}")),
        arm(),
    );
    let platform = "[[platform]]\nname = \"tool\"\n";
    assert!(arm().contains(platform), "the preset has another form");
    let of_model = here(
        &job,
        &arm().replace(platform, &format!("{platform}{carried}")),
    );
    let bare = here(&job, arm());
    // Of a tool by its number, beside one that is lighter.
    let numbered = format!("[[tools]]\nnumber = 1\nlength_mm = 180\n{carried}");
    let numbered = job.replace(
        "[tool]\nlength_mm = 180\n",
        &format!("[tool]\nmass_kg = 5\n{numbered}"),
    );
    let by_number = here(&numbered, arm());
    let part = by_number.path().join("part.ngc");
    let program = std::fs::read_to_string(&part).expect("a program");
    std::fs::write(&part, format!("T1 M6\n{program}")).expect("written");
    let [of_job, of_number, of_model, bare] =
        [&of_job, &by_number, &of_model, &bare].map(|here| deflected(here.path(), "").0[0]);
    for own in [of_job, of_number] {
        assert!((own - of_model).abs() < 1e-9, "{own} {of_model}");
    }
    assert!(of_job > bare + 0.05, "{of_job} {bare}");
}

/// Vibrations with a tool by its mass are those of a model whose flange carries it.
#[test]
fn modes_take_the_mass_of_the_tool() {
    let platform = "[[platform]]\nname = \"tool\"\n";
    let carried = "mass_kg = 80\ncentre_of_mass_mm = [10, 0, 70]\n";
    let model = arm().replace(platform, &format!("{platform}{carried}"));
    let [carrying, bare] = [here(JOB, &model), here(JOB, arm())];
    let stated = " --tool-mass-kg 80 --tool-centre-of-mass-mm 10 0 70";
    let [of_model, of_option, without] = [
        modes(carrying.path(), ""),
        modes(bare.path(), stated),
        modes(bare.path(), ""),
    ];
    assert_eq!(of_model.len(), 8);
    for (model, option) in of_model.iter().zip(&of_option) {
        assert!((model - option).abs() < 1e-6 * model, "{model} {option}");
    }
    assert!(
        of_option[0] < 0.99 * without[0],
        "{of_option:?} {without:?}"
    );
    for (line, word) in [
        (" --tool-mass-kg 0", "from 0.001 to 5000 kg"),
        (" --tool-centre-of-mass-mm 0 0 1", "--tool-mass-kg"),
    ] {
        let found = said(bare.path(), &format!("modes arm.toml{line}"));
        assert!(found.code == 1 && found.err.contains(word), "{found:?}");
    }
}

/// Mass, centre and inertia of the tool are those of a body behind the last element of the chain.
#[test]
fn a_tool_is_a_body_on_the_last_element() {
    let carried = "mass_kg = 80\ncentre_of_mass_mm = [10, 0, 70]\ninertia_kg_m2 = [[1.2, 0, -0.1], [0, 0.9, 0], [-0.1, 0, 0.5]]\n";
    // The x axis of the chain's end is z of the flange, its z axis is -x.
    let body = "  { body = \"spindle\", mass_kg = 80, centre_of_mass_mm = [70, 0, -10], inertia_kg_m2 = [[0.5, 0, 0.1], [0, 0.9, 0], [0.1, 0, 1.2]] },\n]\n\n[[limb]]";
    let job = JOB.replace("[load]\n", "[load]\nweight = \"all\"\n");
    let tool = "length_mm = 180\n";
    let of_job = here(&job.replace(tool, &format!("{tool}{carried}")), arm());
    let of_model = here(&job, &arm().replace("]\n\n[[limb]]", body));
    let near = |a: f64, b: f64| assert!((a - b).abs() <= 1e-12 * a.abs(), "{a} {b}");
    let [a, b] = [&of_job, &of_model].map(|here| deflected(here.path(), "").0);
    near(a[0], b[0]);
    near(a[1], b[1]);
    let mass = " --tool-mass-kg 80 --tool-centre-of-mass-mm 10 0 70";
    let inertia = " --tool-inertia-kg-m2 1.2 0.9 0.5 0 -0.1 0";
    let by_body = modes(of_model.path(), "");
    let by_option = modes(of_job.path(), &format!("{mass}{inertia}"));
    for (a, b) in by_option.iter().zip(&by_body) {
        near(*a, *b);
    }
    let as_point = modes(of_job.path(), mass);
    assert!(
        by_option[7] < 0.999 * as_point[7],
        "{by_option:?} {as_point:?}"
    );
}

#[test]
fn faults_of_a_tool_with_mass_are_named_with_their_line() {
    let cases = "\
mass_kg = -1 => from 0.001 to 5000 kg
mass_kg = 9 => the model states no gravity
inertia_kg_m2 = [[1, 0, 0], [0, 1, 0], [0, 0, 1]] => an inertia and no mass
mass_kg = 9; inertia_kg_m2 = [[1, 0, 0], [0, 1, 0], [0, 0, 3]] => cannot exceed the sum
mass_kg = 9; inertia_kg_m2 = [[1, 2, 0], [0, 1, 0], [0, 0, 1]] => not symmetric
mass_kg = 9; inertia_kg_m2 = [[1, 2, 0], [2, 1, 0], [0, 0, 1]] => negative about some axis";
    for (written, words) in cases.lines().filter_map(|case| case.split_once(" => ")) {
        let written = written.replace("; ", "\n");
        let job = JOB.replace("length_mm = 180", &format!("length_mm = 180\n{written}"));
        let model = match words.contains("gravity") {
            true => include_str!("../../../kinetostat-model/models/orthoglide.toml"),
            false => arm(),
        };
        let here = here(&job, model);
        let found = said(here.path(), "deflect job.toml");
        let line = 7 + written.lines().count();
        let text = flat(&found.err);
        assert!(found.code == 1 && text.contains(words), "{written}: {text}");
        assert!(text.contains(&format!("job.toml:{line}:")), "{text}");
    }
}

/// Own weight and load are told apart at a place, too.
#[test]
fn a_place_tells_what_the_load_moves() {
    let here = here(JOB, arm());
    let line = "deflect arm.toml --force 0 0 -100 --json";
    let json: Value = serde_json::from_str(&said(here.path(), line).answered().out).expect("JSON");
    let of = |name: &str| json[name].as_f64().expect("a figure");
    let [all, by_load, unloaded] = [
        "displacement_size_mm",
        "displacement_by_load_size_mm",
        "displacement_without_load_size_mm",
    ]
    .map(of);
    // Both point down, so that their sizes add up nearly.
    assert!(
        (all - by_load - unloaded).abs() < 0.05 * all,
        "{all} {by_load} {unloaded}"
    );
    assert!(by_load < 0.2 * all, "{by_load} {all}");
    let text = flat(
        &said(here.path(), "deflect arm.toml --force 0 0 -100")
            .answered()
            .out,
    );
    assert!(
        text.contains("The load moves it by") && text.contains("own weight moves it by"),
        "{text}"
    );
}
