//! The other commands: they answer, at 80 columns, in the same words everywhere.

use std::sync::Arc;

use crate::common::{contents, run, shell, workplace};
use kinetostat_machining::Unwatched;
use kinetostat_model::{PresetKind, preset_names};
use serde_json::Value;

#[track_caller]
fn narrow(text: &str) {
    let wide: Vec<&str> = text.lines().filter(|l| l.chars().count() > 80).collect();
    assert!(wide.is_empty(), "{wide:#?}");
    assert!(!text.contains('\u{1b}'));
}

#[test]
fn every_preset_is_checked_and_shown() {
    let here = workplace();
    let list = run(here.path(), &["model", "list"]).answered();
    narrow(&list.out);
    for kind in PresetKind::ALL {
        assert!(list.out.contains(kind.heading()), "{}", list.out);
    }
    for preset in preset_names().iter().map(|p| p.name) {
        assert!(list.out.contains(preset), "{}", list.out);
        let said = run(here.path(), &["check", preset]).answered();
        narrow(&said.out);
        let shown = run(here.path(), &["model", "show", preset]).answered();
        // What is shown is a model file.
        std::fs::write(here.path().join("own.toml"), &shown.out).unwrap();
        let said = run(here.path(), &["stiffness", preset]).answered();
        narrow(&said.out);
        let json = run(here.path(), &["check", "own.toml", "--json"]).answered();
        let found: Value = serde_json::from_str(&json.out).expect("JSON");
        assert_eq!(found["schema"], 3);
    }
    let schema = run(here.path(), &["model", "schema"]).answered();
    serde_json::from_str::<Value>(&schema.out).expect("JSON");
}

#[test]
fn check_counts_mobility_and_over_constraint() {
    let here = workplace();
    let said = run(here.path(), &["check", "orthoglide", "--json"]).answered();
    let found: Value = serde_json::from_str(&said.out).unwrap();
    assert_eq!(found["home"]["mobility"], 3);
    assert_eq!(found["home"]["degrees_of_over_constraint"], 3);
    assert_eq!(found["home"]["stiffness_rank"], 6);
    let said = run(here.path(), &["check", "stewart_gough_b", "--json"]).answered();
    let found: Value = serde_json::from_str(&said.out).unwrap();
    assert_eq!(found["home"]["mobility"], 6);
    assert_eq!(found["home"]["degrees_of_over_constraint"], 0);
}

#[test]
fn stiffness_has_units_axes_and_point() {
    let here = workplace();
    let said = run(
        here.path(),
        &["stiffness", "orthoglide", "--at", "0", "0", "0"],
    )
    .answered();
    narrow(&said.out);
    for needle in [
        "Base axes",
        "per mm",
        "per rad",
        "Compliance",
        "Principal directions",
    ] {
        assert!(said.out.contains(needle), "{}", said.out);
    }
    let args = [
        "stiffness",
        "orthoglide",
        "--at",
        "20",
        "20",
        "120",
        "--tool-length-mm",
        "100",
        "--force",
        "215",
        "-10",
        "-25",
        "--moment",
        "0",
        "0",
        "3",
        "--json",
    ];
    let said = run(here.path(), &args).answered();
    narrow(&said.err);
    assert!(said.err.contains("not symmetric"), "{}", said.err);
    let k: Value = serde_json::from_str(&said.out).unwrap();
    let entry = |i: usize, j: usize| k["stiffness_n_m_rad"][i][j].as_f64().unwrap();
    assert!((entry(3, 4) - entry(4, 3) - 3.0).abs() < 1e-6);
    assert!((entry(0, 5) - entry(5, 0)).abs() < 1e-6);
}

#[test]
fn deflect_at_a_place() {
    let here = workplace();
    // `kinetostat/tests/golden/orthoglide_milling.json`: Q0 under (215, -10, -25) N and (1, 21.5, 0) N m.
    let said = run(
        here.path(),
        &[
            "deflect",
            "orthoglide",
            "--at",
            "0",
            "0",
            "0",
            "--force",
            "215",
            "-10",
            "-25",
            "--moment",
            "1",
            "21.5",
            "0",
            "--json",
        ],
    )
    .answered();
    narrow(&said.err);
    let d: Value = serde_json::from_str(&said.out).unwrap();
    for (k, expected) in [0.07073714, -0.003349638, -0.009003996]
        .into_iter()
        .enumerate()
    {
        let found = d["displacement_mm"][k].as_f64().unwrap();
        assert!((found - expected).abs() < 1e-6, "{found} {expected}");
    }
    for (k, expected) in [214.9902, -10.02927, -25.3176].into_iter().enumerate() {
        let found = d["actuators"][k]["force"].as_f64().unwrap();
        assert!((found - expected).abs() < 1e-3, "{found} {expected}");
    }
    assert_eq!(d["stable"], true);

    // A rotation by a named convention; a file as output.
    run(
        here.path(),
        &[
            "deflect",
            "heavy_6r",
            "--at",
            "1000",
            "0",
            "1200",
            "--rotation",
            "a_b_c_kuka_deg=0,90,0",
            "--force",
            "0",
            "0",
            "-500",
            "--json",
            "d.json",
        ],
    )
    .answered();
    assert!(here.path().join("d.json").exists());
}

#[test]
fn stiffness_names_what_moves_and_what_nothing_moves() {
    let here = workplace();
    let said = run(here.path(), &["stiffness", "three_link_z", "--json"]).answered();
    narrow(&said.err);
    for line in [
        "rigid: nothing moves along z",
        "rigid: nothing turns about x",
        "free: turns about z by arm: e",
        "free: moves along y by arm: q, arm: e",
        "moves along x by arm: th1",
        "up to free motions",
    ] {
        assert!(
            said.err.replace("\n", " ").contains(line),
            "{line}: {}",
            said.err
        );
    }
    let k: Value = serde_json::from_str(&said.out).unwrap();
    let kinds: Vec<&str> = k["principal_directions"]
        .as_array()
        .unwrap()
        .iter()
        .map(|d| d["kind"].as_str().unwrap())
        .collect();
    assert_eq!(kinds, ["rigid", "rigid", "rigid", "finite", "free", "free"]);
    assert_eq!(k["rigid_directions"], 3);
    assert_eq!(k["free_directions"], 2);
    // Table 5.1: K = 16.92820323; its inverse is the compliance besides the free motions.
    assert!(k["compliance_m_rad_per_n"].is_null());
    let c = &k["compliance_besides_free_motions_m_rad_per_n"][0][0];
    assert!((c.as_f64().unwrap() * 16.92820323 - 1.0).abs() < 1e-8);
    let shares: f64 = k["principal_directions"][3]["behind"]
        .as_array()
        .unwrap()
        .iter()
        .map(|b| b["share"].as_f64().unwrap())
        .sum();
    assert!((shares - 1.0).abs() < 1e-9);
}

#[test]
fn deflect_gives_the_load_of_links_and_both_stabilities() {
    let here = workplace();
    // A pushed Z: its shape holds, but nothing keeps its end on the line.
    let args = [
        "deflect",
        "three_link_z",
        "--force",
        "-0.5",
        "0",
        "0",
        "--json",
    ];
    let said = run(here.path(), &args).answered();
    narrow(&said.err);
    assert!(said.err.contains("keeps its shape"), "{}", said.err);
    assert!(said.err.contains("platform does NOT stay"), "{}", said.err);
    let d: Value = serde_json::from_str(&said.out).unwrap();
    assert_eq!(d["shapes_stable"], true);
    assert_eq!(d["platform_stable"], false);
    assert_eq!(d["stable"], false);
    assert_eq!(d["negative_directions"].as_array().unwrap().len(), 1);
    assert_eq!(d["conservative"], true);

    let args = [
        "deflect",
        "compensated_arm",
        "--force",
        "0",
        "0",
        "-300",
        "--moment",
        "0",
        "0",
        "3",
        "--json",
    ];
    let said = run(here.path(), &args).answered();
    narrow(&said.err);
    for words in ["Euler load, N", "upper arm", "not conservative"] {
        assert!(said.err.contains(words), "{words}: {}", said.err);
    }
    let d: Value = serde_json::from_str(&said.out).unwrap();
    assert_eq!(d["conservative"], false);
    let links = d["limbs"][0]["links"].as_array().unwrap();
    assert_eq!(links.len(), 2);
    for link in links {
        let (force, euler, share) = (
            link["axial_force_n"].as_f64().unwrap(),
            link["euler_load_n"].as_f64().unwrap(),
            link["share_of_euler_load"].as_f64().unwrap(),
        );
        assert!((share - (-force / euler).max(0.0)).abs() < 1e-15);
        assert!((1e6..1e8).contains(&euler));
    }
}

/// The lug of the compensator in front of its joint: the spring pulls across it, and a slipping brake
/// does not hold against it.
#[test]
fn a_compensator_that_beats_its_joint_is_named() {
    let here = workplace();
    let shown = run(here.path(), &["model", "show", "kuka_kr270_like"]).answered();
    let mut text = shown.out;
    for (from, to) in [
        (
            "stiffness_n_m_per_rad = 3.31e6",
            "stiffness_n_m_per_rad = 2e4",
        ),
        ("[0, 0, 184.72]", "[16.0, 0, -184.3]"),
        (
            "free_length_mm = 458",
            "free_length_mm = 458\npreload_n = 200000",
        ),
    ] {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    std::fs::write(here.path().join("across.toml"), text).unwrap();
    for command in ["check", "deflect"] {
        let said = run(here.path(), &[command, "across.toml", "--json"]).answered();
        narrow(&said.err);
        let words = said.err.replace("\n    ", " ");
        assert!(
            words.contains("limb 'arm', joint 'A2' runs away: its spring holds with"),
            "{words}"
        );
        assert!(words.contains("'compensator'"), "{words}");
        let found: Value = serde_json::from_str(&said.out).unwrap();
        let found = match command {
            "check" => &found["home"],
            _ => &found,
        };
        assert_eq!(found["stable"], false);
        let joint = &found["overcome_joints"][0];
        assert_eq!(joint["joint"], "A2");
        assert_eq!(joint["unit"], "N m/rad");
        assert_eq!(joint["loads"][0]["name"], "compensator");
    }
    let said = run(here.path(), &["deflect", "kuka_kr270_like", "--json"]).answered();
    let found: Value = serde_json::from_str(&said.out).unwrap();
    assert_eq!(found["overcome_joints"].as_array().unwrap().len(), 0);
}

#[test]
fn check_lists_loads_and_links() {
    let here = workplace();
    let text = run(here.path(), &["model", "show", "compensated_arm"]).answered();
    let follower = "\n[[limb.load]]\nwrench = \"jet\"\nnode = \"hand\"\naxes = \"node\"\nforce_n = [0, 0, 5]\n";
    std::fs::write(here.path().join("own.toml"), text.out + follower).unwrap();
    let said = run(here.path(), &["check", "own.toml", "--json"]).answered();
    narrow(&said.err);
    for words in [
        "link 'upper arm': 900 mm in 2 segments, bows",
        "load 'gravity compensator': spring of 20 N/mm from the base",
        "load 'jet': force (0, 0, 5) N on 'hand' in the axes of its node",
        "(not conservative)",
        "by its own weight and the loads on its limbs",
    ] {
        assert!(
            said.err.replace("\n ", "").contains(words),
            "{words}: {}",
            said.err
        );
    }
    let found: Value = serde_json::from_str(&said.out).unwrap();
    let limb = &found["limbs"][0];
    assert_eq!(limb["links"][0]["convention"], "bowing");
    assert_eq!(limb["loads"][0]["kind"], "spring");
    assert_eq!(limb["loads"][0]["conservative"], true);
    assert_eq!(limb["loads"][1]["conservative"], false);
    assert_eq!(found["home"]["conservative"], false);
}

/// Every command, with those inside it.
fn all_commands(command: &clap::Command, path: &[String], found: &mut Vec<Vec<String>>) {
    for sub in command
        .get_subcommands()
        .filter(|sub| sub.get_name() != "help")
    {
        let mut path = path.to_vec();
        path.push(sub.get_name().to_owned());
        all_commands(sub, &path, found);
        found.push(path);
    }
}

/// Output of a command line, without a process of its own.
fn printed(path: &[String], last: &str) -> String {
    let words = path.iter().map(String::as_str).chain([last]);
    let outcome = kinetostat_cli::run_inside(words.map(Into::into), Arc::new(Unwatched));
    String::from_utf8(outcome.out).expect("text")
}

#[test]
fn the_help_of_every_command_fits_on_a_screen_and_names_every_option() {
    let whole = kinetostat_cli::command();
    let mut commands = Vec::new();
    all_commands(&whole, &[], &mut commands);
    assert!(commands.len() > 30, "{}", commands.len());
    for path in commands {
        let short = printed(&path, "--help");
        assert!(short.lines().count() <= 80, "{path:?}: {short}");
        // The line of usage is not broken.
        let rest: Vec<&str> = short.lines().filter(|l| !l.starts_with("Usage:")).collect();
        narrow(&rest.join("\n"));
        assert_eq!(printed(&path, "-h"), short);
        let long = printed(&path, "--help-all");
        let command = path.iter().fold(&whole, |command, name| {
            command.find_subcommand(name).expect("a command")
        });
        let options = command
            .get_arguments()
            .filter(|option| !option.is_hide_set());
        for name in options.filter_map(clap::Arg::get_long) {
            let name = format!("--{name}");
            let is_named = |text: &str| text.split_whitespace().any(|word| word == name);
            assert!(
                is_named(&short) && is_named(&long),
                "{path:?} {name}: {short}"
            );
        }
    }
}

#[test]
fn help_completions_and_manual_pages() {
    let here = workplace();
    for command in [
        &[][..],
        &["demo"],
        &["compensate"],
        &["deflect"],
        &["stiffness"],
        &["check"],
        &["force"],
        &["model"],
        &["model", "show"],
    ] {
        let mut args = command.to_vec();
        args.push("--help");
        let said = run(here.path(), &args).answered();
        narrow(&said.out);
    }
    let help = run(here.path(), &["--help"]).answered().out;
    assert!(
        help.contains("Exit codes") && help.contains("not converged"),
        "{help}"
    );
    for name in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let said = run(here.path(), &["completions", name]).answered();
        assert!(said.out.contains("kinetostat"), "{name}");
    }
    assert!(
        run(here.path(), &["man"])
            .answered()
            .out
            .contains(".TH kinetostat")
    );
    std::fs::create_dir(here.path().join("man1")).unwrap();
    run(here.path(), &["man", "--out", "man1"]).answered();
    let pages = contents(&here.path().join("man1"));
    assert!(
        pages.keys().any(|p| p.ends_with("kinetostat-model-show.1")),
        "{:?}",
        pages.keys()
    );
}

#[test]
fn a_reader_that_leaves_early_is_no_failure() {
    let here = workplace();
    let said = shell(here.path(), "$K model schema | head -1");
    assert_eq!(said.code, 0);
    assert!(said.err.is_empty(), "{}", said.err);
}

#[test]
fn nothing_depends_on_the_locale() {
    let here = workplace();
    let line = |locale: &str, out: &str| {
        let said = shell(
            here.path(),
            &format!("LC_ALL={locale} LANG={locale} $K demo --out {out} --json"),
        );
        assert_eq!(said.code, 0, "{said:?}");
        said.out
    };
    assert_eq!(line("C", "a"), line("de_DE.UTF-8", "b"));
}

/// A single place is not asked on the way whether it should stop; it ends all the same.
#[test]
#[cfg(unix)]
fn an_interrupt_ends_a_single_place() {
    let here = workplace();
    let rod = r#"schema = 1
[mechanism]
name = "rod"
[[platform]]
name = "tip"
home = { position_mm = [1000, 0, 0] }
[section.rod]
rigidities = { axial_n = 1e7, bending_y_n_m2 = 1.0, bending_z_n_m2 = 1.0, torsion_n_m2 = 1.0 }
[chain.rod]
elements = [{ link = "rod", name = "rod", length_mm = 1000, segments = 100 }]
"#;
    // Rods side by side: five seconds and more, so that the signal comes in time where much else runs.
    let limb = |k: usize| {
        format!("[[limb]]\nname = \"rod {k}\"\nfrom = \"base\"\nto = \"tip\"\nchain = \"rod\"\n")
    };
    let limbs: String = (0..24).map(limb).collect();
    let rod = format!("{rod}{limbs}");
    std::fs::write(here.path().join("rod.toml"), rod).unwrap();
    let mut child = crate::common::command(here.path())
        .args(["deflect", "rod.toml", "--force", "0", "1e6", "0"])
        .stderr(std::process::Stdio::piped())
        .stdout(std::process::Stdio::null())
        .spawn()
        .unwrap();
    std::thread::sleep(std::time::Duration::from_millis(300));
    let killed = shell(here.path(), &format!("kill -INT {}", child.id()));
    assert_eq!(killed.code, 0, "{killed:?}");
    assert_eq!(child.wait().unwrap().code(), Some(130));
    let mut said = String::new();
    let mut from = child.stderr.take().unwrap();
    std::io::Read::read_to_string(&mut from, &mut said).unwrap();
    assert!(said.contains("stopped on request"), "{said}");
}

#[test]
#[cfg(unix)]
fn an_interrupt_leaves_nothing_half_written() {
    let here = workplace();
    // Long enough to be still at work when the signal comes.
    let mut text = String::from("G21 G90\nG0 X0 Y0 Z5\nG1 Z0 F500\n");
    for i in 0..60_000 {
        let angle = f64::from(i) * 0.01;
        text.push_str(&format!(
            "G1 X{:.3} Y{:.3}\n",
            30.0 * angle.cos(),
            30.0 * angle.sin()
        ));
    }
    std::fs::write(here.path().join("part.ngc"), text).unwrap();
    let before = contents(here.path());
    let mut child = crate::common::command(here.path())
        .args(["compensate", "job.toml", "--json", "r.json"])
        .stderr(std::process::Stdio::piped())
        .stdout(std::process::Stdio::null())
        .spawn()
        .unwrap();
    std::thread::sleep(std::time::Duration::from_millis(1500));
    let killed = shell(here.path(), &format!("kill -INT {}", child.id()));
    assert_eq!(killed.code, 0, "{killed:?}");
    let status = child.wait().unwrap();
    assert_eq!(status.code(), Some(130), "{status:?}");
    // A long program goes on from what is kept in a folder of its own; nothing else is there.
    let mut after = contents(here.path());
    after.retain(|path, _| !path.to_string_lossy().contains(".kinetostat-part"));
    assert_eq!(after, before);
}
