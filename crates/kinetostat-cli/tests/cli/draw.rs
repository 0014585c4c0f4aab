//! `kinetostat model draw`: drawings of machines, of their motions and deflections.

use crate::common::{run, workplace};
use kinetostat_model::{Model, preset_names};

fn words(line: &str) -> Vec<&str> {
    line.split(' ').collect()
}

#[test]
fn every_preset_is_drawn_at_home_moved_and_bent() {
    let here = workplace();
    for preset in preset_names() {
        let name = preset.name;
        let limbs = Model::preset(name).expect("a preset");
        let limbs = limbs.mechanism.limbs();
        for more in ["", " --motion", " --force 10 20 -30"] {
            let line = format!("model draw {name}{more}");
            let said = run(here.path(), &words(&line));
            // A force along a free direction has no answer.
            if said.code == 2 && more.contains("force") {
                continue;
            }
            let said = said.answered();
            assert!(said.out.starts_with("<svg ") && said.out.ends_with("</svg>\n"));
            assert!(
                !said.out.contains("NaN") && said.out.len() < 200_000,
                "{line}"
            );
            if limbs.len() > 1 && limbs.len() <= 14 {
                // A limb without length (a hinge) has no name in the drawing.
                let named = limbs.iter().filter(|l| said.out.contains(&l.name));
                assert!(2 * named.count() > limbs.len(), "{line}");
            }
        }
    }
}

#[test]
fn a_free_motion_is_reported_by_limb_and_joint() {
    let here = workplace();
    let line = "model draw stewart_gough_a --motion --out free.svg";
    let said = run(here.path(), &words(line)).answered();
    for needle in [
        "free direction: the tool turns about z",
        "leg 2: head",
        "free.svg",
    ] {
        assert!(said.out.contains(needle), "{needle}: {}", said.out);
    }
    let svg = std::fs::read_to_string(here.path().join("free.svg")).expect("a drawing");
    assert!(svg.contains("class=\"moved\""));
    let said = run(here.path(), &words("check stewart_gough_a")).answered();
    assert!(
        said.out.contains("model draw stewart_gough_a --motion"),
        "{}",
        said.out
    );
}

#[test]
fn wrong_questions_are_refused_in_words() {
    let here = workplace();
    for (line, code, needle) in [
        ("model draw puu3 --motion 9", 1, "1 (the softest) to 6"),
        ("model draw puu3 --motion 0", 1, "numbered 1"),
        ("model draw puu3 --scale 10", 1, "give --force or --moment"),
        (
            "model draw puu3 --motion --force 1 0 0",
            1,
            "cannot be used with",
        ),
        ("model draw puu3 --at 9999 0 0", 2, "reach"),
        ("model draw nothing_such", 1, "no preset"),
        ("model draw puu3 --view back", 1, "front"),
        (
            "model draw model.toml --out model.toml",
            1,
            "inputs are never overwritten",
        ),
    ] {
        let said = run(here.path(), &words(line));
        assert_eq!(said.code, code, "{line}: {said:?}");
        assert!(said.err.contains(needle), "{line}: {said:?}");
        assert!(said.out.is_empty(), "{line}: {said:?}");
    }
}

#[test]
fn files_are_overwritten_with_leave_only() {
    let here = workplace();
    let line = "model draw two_link --out two.svg";
    run(here.path(), &words(line)).answered();
    let said = run(here.path(), &words(line));
    assert_eq!(said.code, 1, "{said:?}");
    run(here.path(), &words(&format!("{line} --force-overwrite"))).answered();
}
