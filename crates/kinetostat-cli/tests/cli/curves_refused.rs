//! `kinetostat curve` and `kinetostat equilibria`: what is refused, what is said where a curve ends
//! early, and what an interrupt leaves.

use crate::common::chains::{curve_along, workplace};
use crate::common::{command, run, shell};

#[test]
fn wrong_questions_are_refused_with_what_to_do() {
    let here = workplace();
    let with = |more: &[&'static str]| curve_along("z.toml", ["1", "0", "0"], ["0", "10"], more);
    let cases: Vec<(Vec<&str>, &[&str])> = vec![
        (vec!["curve", "z.toml"], &["--direction", "--factor"]),
        (
            vec!["curve", "z.toml", "--direction", "1", "0", "0"],
            &["how far", "--displacement-mm"],
        ),
        (
            curve_along("z.toml", ["0", "0", "0"], ["0", "1"], &[]),
            &["no direction"],
        ),
        (
            curve_along("z.toml", ["1", "0", "0"], ["5", "5"], &[]),
            &["equal ends"],
        ),
        (
            curve_along("z.toml", ["nan", "0", "0"], ["0", "1"], &[]),
            &["finite"],
        ),
        (
            curve_along("z.toml", ["0", "0", "1"], ["0", "1"], &[]),
            &["rigid in z, rx, ry"],
        ),
        (with(&["--free", "sideways"]), &["'sideways'", "rx"]),
        (with(&["--free", "x"]), &["free in 'x'", "others"]),
        (
            with(&["--constant-force", "0", "5", "0"]),
            &["constant load", "'y'", "--free y"],
        ),
        (
            with(&["--load", "middle=0,0,1"]),
            &["no node 'middle'", "first, second"],
        ),
        (with(&["--load", "first=0,0"]), &["three numbers"]),
        (with(&["--load", "first"]), &["first=0,0,-100"]),
        (with(&["--force", "1", "0", "0"]), &["--factor"]),
        (
            vec!["curve", "z.toml", "--factor", "0", "1"],
            &["which load", "--force"],
        ),
        (
            vec![
                "curve", "z.toml", "--factor", "0", "1", "--force", "1", "0", "0", "--hold", "x",
            ],
            &["growing load", "'x'"],
        ),
        (
            vec!["equilibria", "z.toml", "--displaced-mm", "0", "0", "5"],
            &["plane"],
        ),
        (
            vec![
                "equilibria",
                "z.toml",
                "--displaced-mm",
                "5",
                "0",
                "0",
                "--free",
                "x",
            ],
            &["displaced in 'x'"],
        ),
        (vec!["equilibria", "z.toml", "--starts", "0"], &["--starts"]),
        (
            vec!["equilibria", "z.toml", "--free", "others"],
            &["'others'"],
        ),
        (
            with(&["--plot", "nowhere/z.svg"]),
            &["does not exist", "create it"],
        ),
        (with(&["--csv", "z.toml"]), &["input"]),
    ];
    for (arguments, words) in cases {
        let said = run(here.path(), &arguments);
        assert_eq!(said.code, 1, "{arguments:?}: {said:?}");
        assert!(said.out.is_empty(), "{arguments:?}");
        for word in words {
            assert!(
                said.err.contains(word),
                "{arguments:?}: no '{word}' in {}",
                said.err
            );
        }
    }
    let said = run(
        here.path(),
        &[
            "curve", "z.toml", "--force", "0", "0", "5", "--factor", "0", "1",
        ],
    );
    assert_eq!(said.code, 1);
    assert!(said.err.contains("does nothing"), "{}", said.err);
    // A range beyond reach is answered as far as it goes, and that is said.
    let said = run(
        here.path(),
        &curve_along("z.toml", ["1", "0", "0"], ["-50", "200"], &[]),
    )
    .answered();
    let text = said.out.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        text.contains("followed only from -50.0000 to 90.68"),
        "{text}"
    );
    // Out of reach: the question is right and has no answer.
    let said = run(
        here.path(),
        &curve_along("z.toml", ["1", "0", "0"], ["200", "300"], &[]),
    );
    assert_eq!(said.code, 2, "{said:?}");
}

#[test]
fn small_loads_are_not_called_nothing() {
    let here = workplace();
    let pushed = ["--force", "-1e-6", "0", "0", "--factor", "0", "2e-6"];
    let list: Vec<&str> = ["curve", "scara"].into_iter().chain(pushed).collect();
    // A second equilibrium is found near the start, or not.
    let said = run(here.path(), &list);
    assert!([0, 2].contains(&said.code), "{said:?}");
    let said = said.out.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        said.contains("grows from 0 to 2.000e-6 times the force (-1.000e-6, 0, 0) N"),
        "{said}"
    );
}

#[test]
fn the_words_say_how_far_a_branch_was_followed() {
    let here = workplace();
    let pushed = |to: &'static str, more: &[&'static str]| {
        let list = curve_along("z.toml", ["-1", "0", "0"], ["0", to], more);
        let said = run(here.path(), &list).answered().out;
        said.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    // A tiny part of what was requested is still given in numbers.
    let said = pushed("1e7", &["--points", "40", "--branches", "1"]);
    assert!(said.contains("was followed only from 0 to "), "{said}");
    assert!(said.contains("as many points as --points allows"), "{said}");
    assert!(!said.contains("from 0 to 0 mm"), "{said}");
    assert!(!said.contains("all along"), "{said}");
    // Out of reach without any load: nothing is said of one that is too large.
    let said = run(
        here.path(),
        &curve_along("z.toml", ["1", "0", "0"], ["200", "300"], &[]),
    );
    assert_eq!(said.code, 2, "{}", said.err);
    assert!(
        said.err.contains("200.000 mm from the commanded place"),
        "{}",
        said.err
    );
    assert!(!said.err.contains("can carry"), "{}", said.err);
}

#[test]
fn an_interrupt_ends_a_search_and_writes_nothing() {
    let here = workplace();
    let mut child = command(here.path())
        .args([
            "equilibria",
            "heavy_6r",
            "--starts",
            "10000000",
            "--fruitless",
            "10000000",
            "--plot",
            "a.svg",
        ])
        .stdout(std::process::Stdio::null())
        .stderr(std::process::Stdio::null())
        .spawn()
        .expect("the command starts");
    std::thread::sleep(std::time::Duration::from_millis(700));
    shell(here.path(), &format!("kill -INT {}", child.id()));
    let status = child.wait().expect("an end");
    assert_eq!(status.code(), Some(130), "{status:?}");
    let left: Vec<_> = std::fs::read_dir(here.path())
        .expect("a directory")
        .filter_map(Result::ok)
        .map(|e| e.file_name())
        .collect();
    assert_eq!(left.len(), 2, "{left:?}");
}

/// The size of a direction does not matter, however large or small; a node that is missing is missed where it was sought.
#[test]
fn directions_of_any_size_and_nodes_of_limbs() {
    let here = workplace();
    let curve = |size: &str| {
        let words = [
            "curve",
            "orthoglide",
            "--displacement-mm",
            "-1",
            "1",
            "--direction",
            "0",
            "0",
            size,
        ];
        run(here.path(), &words).answered().out
    };
    let usual = curve("1");
    for size in ["1e300", "1e-300"] {
        assert_eq!(curve(size), usual, "{size}");
    }
    let words = [
        "curve",
        "orthoglide",
        "--force",
        "0",
        "0",
        "1",
        "--factor",
        "0",
        "1",
    ];
    let load = ["--load", "leg x:nosuch=0,0,1"];
    let said = run(here.path(), &[&words[..], &load[..]].concat());
    assert_eq!(said.code, 1, "{said:?}");
    assert!(
        said.err
            .contains("the limb 'leg x' has no node 'nosuch'. It has: tip."),
        "{said:?}"
    );
}

/// A curve that ends where it starts says why, and shows no rounding; a turn is at most half a one.
#[test]
fn a_start_outside_the_force_limits_is_named() {
    let here = workplace();
    let words = [
        "curve",
        "heavy_6r",
        "--direction",
        "1",
        "0",
        "0",
        "--displacement-mm",
        "0",
        "5",
    ];
    let limits = ["--force-limits", "-10", "10"];
    let said = run(here.path(), &[&words[..], &limits[..]].concat()).answered();
    let flat = said.out.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        flat.contains("the curve ends where it starts: the load there is 1007"),
        "{flat}"
    );
    assert!(flat.contains("outside --force-limits -10 10"), "{flat}");
    assert!(!flat.contains("e-15"), "{flat}");
    let slope = said
        .out
        .lines()
        .find(|line| line.trim_start().starts_with("A "))
        .expect("point A");
    assert!(slope.contains(" 614"), "{slope}");
    let words = ["equilibria", "heavy_6r", "--turned-deg", "0", "0", "720"];
    let said = run(here.path(), &words);
    assert!(
        said.code == 1 && said.err.contains("180 degrees"),
        "{said:?}"
    );
}
