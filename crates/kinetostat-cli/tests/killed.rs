//! kill -9 at any moment: no half file, nothing left for ever, no new program beside an old report
//! without a word. `KINETOSTAT_KILLS=500 cargo test --workspace --test killed` kills more often.
//!
//! A binary of its own: it measures how long a run takes and kills within that time, so that no other
//! test may run beside it.

#![cfg(unix)]

#[path = "cli/common/mod.rs"]
mod common;

use std::collections::BTreeMap;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

use common::{command, contents, run, shell, workplace};

const OUTPUTS: [&str; 4] = ["out.ngc", "report.html", "result.json", "points.csv"];

/// Arguments of a run with four outputs; other digits give other bytes in all of them.
fn arguments(digits: &'static str) -> Vec<&'static str> {
    vec![
        "compensate",
        "job.toml",
        "--force-overwrite",
        "--decimals",
        digits,
        "--report",
        "report.html",
        "--json",
        "result.json",
        "--points",
        "points.csv",
    ]
}

fn start(here: &Path, digits: &'static str) -> Child {
    command(here)
        .args(arguments(digits))
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("the command starts")
}

/// Files that are no outputs.
fn ours(here: &Path) -> Vec<PathBuf> {
    contents(here)
        .into_keys()
        .filter(|p| {
            let name = p.file_name().expect("a name").to_string_lossy();
            name.starts_with(".kinetostat-")
        })
        .collect()
}

fn outputs(here: &Path) -> BTreeMap<&'static str, Vec<u8>> {
    OUTPUTS
        .into_iter()
        .filter_map(|name| Some((name, std::fs::read(here.join(name)).ok()?)))
        .collect()
}

/// All outputs of a whole run.
fn whole(here: &Path, digits: &'static str) -> (BTreeMap<&'static str, Vec<u8>>, Duration) {
    let begun = Instant::now();
    run(here, &arguments(digits)).answered();
    let time = begun.elapsed();
    assert_eq!(ours(here), Vec::<PathBuf>::new());
    (outputs(here), time)
}

fn kills() -> u32 {
    std::env::var("KINETOSTAT_KILLS")
        .ok()
        .and_then(|n| n.parse().ok())
        .unwrap_or(16)
}

/// The next run in a directory, whatever it does.
const DRAW: [&str; 6] = [
    "model",
    "draw",
    "orthoglide",
    "--out",
    "o.svg",
    "--force-overwrite",
];

#[test]
fn a_kill_at_any_moment_leaves_nothing_half_and_nothing_unsaid() {
    let here = workplace();
    let here = here.path();
    let (new, time) = whole(here, "5");
    let (old, _) = whole(here, "4");
    assert_eq!(old.len(), OUTPUTS.len());
    for name in OUTPUTS {
        assert_ne!(old[name], new[name], "{name} must tell the runs apart");
    }
    let (mut mixed, mut left) = (0, 0);
    for i in 0..kills() {
        let mut child = start(here, "5");
        if i % 2 == 0 {
            // Spread over the whole run.
            let share = f64::from(i % 32) / 32.0 * 1.1;
            std::thread::sleep(time.mul_f64(share));
        } else {
            // Just as files begin to be put in place: seen by the second names of the old ones.
            let kept = |here: &Path| {
                std::fs::read_dir(here).is_ok_and(|mut list| {
                    list.any(|e| {
                        e.is_ok_and(|e| e.file_name().to_string_lossy().ends_with(".kept"))
                    })
                })
            };
            let begun = Instant::now();
            while !kept(here) && begun.elapsed() < 20 * time.max(Duration::from_millis(200)) {
                if child.try_wait().expect("a child").is_some() {
                    break;
                }
            }
        }
        let _ = child.kill();
        child.wait().expect("a child");
        left += usize::from(!ours(here).is_empty());
        let found = outputs(here);
        let mut states = Vec::new();
        for name in OUTPUTS {
            // Whole, old or new.
            let is_new = found[name] == new[name];
            assert!(is_new || found[name] == old[name], "{name} is neither");
            states.push(is_new);
        }
        let apart = states.contains(&true) && states.contains(&false);
        mixed += usize::from(apart);
        // The next run in that directory, whatever it does.
        for _ in 0..2 {
            let said = run(here, &DRAW);
            let said = said.answered();
            let flat = said.err.split_whitespace().collect::<Vec<_>>().join(" ");
            assert_eq!(flat.contains("do not belong together"), apart, "{flat}");
            if apart {
                let (news, olds) = flat.split_once("from another time").expect("both lists");
                for (name, is_new) in OUTPUTS.iter().zip(&states) {
                    assert!((if *is_new { news } else { olds }).contains(name), "{flat}");
                }
            }
            let rest = ours(here);
            assert_eq!(rest.len(), usize::from(apart), "{rest:?}");
        }
        // A whole run settles it.
        assert_eq!(whole(here, "4").0, old);
    }
    eprintln!(
        "{} kills: {left} left files, {mixed} between renames",
        kills()
    );
    assert!(left > 0, "no kill came while the command was at work");
}

/// What a kill between two renames leaves, made by hand: a journal of the new contents, and only the first
/// files in place. The next run names what does not belong together; a whole run settles it.
#[test]
fn a_state_between_the_renames_is_named_by_the_next_run() {
    let here = workplace();
    let here = here.path();
    let (new, _) = whole(here, "5");
    let (old, _) = whole(here, "4");
    let check = |bytes: &[u8]| {
        bytes.iter().fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
            (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3)
        })
    };
    let list: Vec<serde_json::Value> = OUTPUTS
        .iter()
        .map(|name| {
            let bytes = &new[name];
            serde_json::json!({ "path": name, "contents": { "bytes": bytes.len(), "fnv1a": check(bytes) } })
        })
        .collect();
    let journal = here.join(".kinetostat-dead12.journal");
    for in_place in 0..=OUTPUTS.len() {
        for (i, name) in OUTPUTS.iter().enumerate() {
            let bytes = if i < in_place { &new[name] } else { &old[name] };
            std::fs::write(here.join(name), bytes).expect("a file");
        }
        let text = serde_json::to_vec(&list).expect("JSON");
        std::fs::write(&journal, text).expect("a journal");
        let said = run(here, &DRAW);
        let said = said.answered();
        let flat = said.err.split_whitespace().collect::<Vec<_>>().join(" ");
        let apart = in_place > 0 && in_place < OUTPUTS.len();
        assert_eq!(
            flat.contains("do not belong together"),
            apart,
            "{in_place}: {flat}"
        );
        if apart {
            let (news, olds) = flat.split_once("from another time").expect("both lists");
            for (i, name) in OUTPUTS.iter().enumerate() {
                let own = if i < in_place { news } else { olds };
                assert!(own.contains(name), "{in_place} {name}: {flat}");
            }
        }
        assert_eq!(journal.exists(), apart, "{in_place}");
        assert_eq!(whole(here, "4").0, old);
    }
}

#[test]
fn a_living_run_keeps_its_files() {
    let here = workplace();
    let here = here.path();
    let mut text = String::from("G21 G90\nG0 X0 Y0 Z5\nG1 Z0 F500\n");
    for i in 0..4000 {
        let angle = f64::from(i) * 0.01;
        let (x, y) = (30.0 * angle.cos(), 30.0 * angle.sin());
        text.push_str(&format!("G1 X{x:.3} Y{y:.3}\n"));
    }
    std::fs::write(here.join("part.ngc"), text).expect("a program");
    let mut child = start(here, "4");
    let begun = Instant::now();
    while ours(here).len() < 5 {
        assert!(
            begun.elapsed() < Duration::from_secs(60),
            "{:?}",
            ours(here)
        );
        assert!(child.try_wait().expect("a child").is_none(), "ended early");
        std::thread::sleep(Duration::from_millis(2));
    }
    let signal = |name: &str| shell(here, &format!("kill -{name} {}", child.id())).answered();
    signal("STOP");
    let before = ours(here);
    run(here, &["model", "draw", "orthoglide", "--out", "o.svg"]).answered();
    assert_eq!(ours(here), before);
    signal("CONT");
    let code = child.wait().expect("a child").code();
    assert!(matches!(code, Some(0 | 4)), "{code:?}");
    assert_eq!(ours(here), Vec::<PathBuf>::new());
    assert_eq!(outputs(here).len(), OUTPUTS.len());
}

#[test]
fn an_overwritten_file_keeps_its_mode() {
    let here = workplace();
    let here = here.path();
    whole(here, "4");
    let modes = [0o600, 0o640, 0o755, 0o444];
    for (name, mode) in OUTPUTS.iter().zip(modes) {
        let mode = std::fs::Permissions::from_mode(mode);
        std::fs::set_permissions(here.join(name), mode).expect("a mode");
    }
    whole(here, "5");
    for (name, mode) in OUTPUTS.iter().zip(modes) {
        let found = std::fs::metadata(here.join(name)).expect("a file");
        assert_eq!(found.permissions().mode() & 0o777, mode, "{name}");
    }
}

/// Files of others that look alike stay.
#[test]
fn only_own_names_are_removed() {
    let here = workplace();
    let here = here.path();
    let others = [
        "download.part",
        ".out.ngc.x7y8.part",
        ".kinetostat-notes.txt",
        ".kinetostat-.part",
        ".kinetostat-a-b.part",
    ];
    for name in others {
        std::fs::write(here.join(name), name).expect("a file");
    }
    std::fs::write(here.join(".kinetostat-dead12-1.part"), "half").expect("a file");
    run(here, &["compensate", "job.toml"]).answered();
    for name in others {
        assert!(here.join(name).exists(), "{name}");
    }
    assert!(!here.join(".kinetostat-dead12-1.part").exists());
}
