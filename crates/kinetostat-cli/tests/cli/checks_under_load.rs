//! `check --force` answers with the equilibrium under the load that `deflect` finds, and both tell the
//! same share of the way to instability.

use crate::common::checks::{flat, of, warnings};
use crate::common::{run, workplace};
use serde_json::Value;

/// A spring hinge before a spring slide: along `-x` it is stable below `P (1 - P/500) = 100`, as the
/// load shortens its own lever.
const SOFT_COLUMN: &str = r#"schema = 1
[mechanism]
name = "soft column"
[[platform]]
name = "tool"
home = { position_mm = [1000, 0, 0] }
[chain.c]
elements = [
  { spring = "revolute", name = "z", axis = "z", stiffness_n_m_per_rad = 100.0 },
  { spring = "prismatic", name = "s", axis = "x", stiffness_n_per_mm = 0.5, home_mm = 0 },
  { rigid = { translation_mm = [1000, 0, 0] } },
]
[[limb]]
name = "c"
from = "base"
to = "tool"
chain = "c"
"#;

const SHARE: &str = "share_to_instability_of_free_machine";

fn under(command: &str, model: &str, force: [f64; 3]) -> Option<(Value, String)> {
    let here = workplace();
    std::fs::write(here.path().join("soft.toml"), SOFT_COLUMN).expect("a file");
    let force = force.map(|f| format!("{f}"));
    let mut words = vec![command, model, "--json", "--force"];
    words.extend(force.iter().map(String::as_str));
    let said = run(here.path(), &words);
    (said.code == 0).then(|| of(said))
}

/// The largest share of the limbs of an answer of `deflect`.
fn of_limbs(found: &Value) -> Option<f64> {
    let limbs = found["limbs"].as_array().expect("limbs");
    let shares = limbs.iter().filter_map(|l| l["share_to_buckling"].as_f64());
    shares.max_by(f64::total_cmp)
}

/// Machines, a direction, and loads from small to far beyond what they carry.
fn cases() -> Vec<(&'static str, [f64; 3], Vec<f64>)> {
    let z = [0.0, 0.0, 1.0];
    vec![
        ("delta", z, vec![1e3, 3e5, 4e5, 5e5, 5.1e5, 5.5e5, 1e6]),
        ("orthoglide", z, vec![100.0, 2470.0, 2600.4, 3000.0, 1e12]),
        ("orthoglide", [1.0; 3], vec![2500.0, 3000.0, 2e4]),
        ("tripteron", z, vec![-1e3, -1e6, -3e7]),
        ("puu3", z, vec![-1e3, -1e5, -1e7]),
        ("heavy_6r", z, vec![-1e3, -1.5e6]),
        ("prs3", z, vec![-1e3, -1e6, -1e8]),
        ("hexaglide", z, vec![-1e3, -1e6, -1e8]),
        (
            "soft.toml",
            [-1.0, 0.0, 0.0],
            vec![1.0, 130.0, 138.0, 138.4, 150.0],
        ),
    ]
}

#[test]
fn check_tells_under_a_load_what_deflect_tells() {
    let mut unstable = 0;
    for (model, load_direction, loads) in cases() {
        for size in loads {
            let force = load_direction.map(|x| x * size);
            let at = format!("{model} {force:?}");
            let (checked, words) = under("check", model, force).expect("an answer");
            let a = &checked["assumptions"];
            let words = flat(&words);
            let Some((reported, _)) = under("deflect", model, force) else {
                assert!(a["reference_stable"].is_null(), "{at}: {words}");
                assert!(a["largest_share_to_buckling"].is_null(), "{at}");
                assert!(words.contains("no equilibrium"), "{at}: {words}");
                assert!(!words.contains("Nothing looks wrong"), "{at}");
                assert!(!words.contains("the load brings"), "{at}: {words}");
                continue;
            };
            assert_eq!(a["reference_stable"], reported["stable"], "{at}: {words}");
            let share = a["largest_share_to_buckling"].as_f64();
            assert_eq!(share, of_limbs(&reported), "{at}");
            assert_eq!(a[format!("largest_{SHARE}")], reported[SHARE], "{at}");
            // What one warns of the load the other does too.
            for code in ["not_stable", "near_buckling", "snaps", "large_displacement"] {
                let has = |found: &Value| {
                    let list = found["warnings"].as_array().expect("warnings");
                    list.iter().any(|w| w["code"] == code)
                };
                assert_eq!(has(&checked), has(&reported), "{at}: {code}");
            }
            if reported["stable"] == false {
                unstable += 1;
                assert!(!words.contains("Nothing looks wrong"), "{at}");
                assert!(!words.contains("far from buckling"), "{at}: {words}");
                assert!(
                    warnings(&checked)[0].contains("NOT STABLE"),
                    "{at}: {words}"
                );
            }
        }
    }
    assert!(unstable >= 8, "{unstable}");
}

#[test]
fn a_share_of_the_way_grows_to_one_and_is_never_below_that_of_a_limb() {
    for (model, load_direction, loads) in cases() {
        let mut before = 0.0_f64;
        for size in loads {
            let at = format!("{model} {load_direction:?} times {size}");
            let Some((reported, words)) = under("deflect", model, load_direction.map(|x| x * size))
            else {
                continue;
            };
            let share = reported[SHARE].as_f64();
            if reported["stable"] == false {
                assert!(share.is_none_or(|s| s >= 1.0), "{at}: {share:?}");
                assert!(!flat(&words).contains("tool free is"), "{at}: {words}");
                continue;
            }
            let share = share.expect("a share");
            assert!(share < 1.0, "{at}: {share}");
            assert!(
                of_limbs(&reported).is_none_or(|s| s <= share),
                "{at}: {share}"
            );
            // Behind a snap it is that of another equilibrium; shares near nothing may fall as a load
            // stretches a limb.
            let warned = reported["warnings"].as_array().expect("warnings");
            if !warned.iter().any(|w| w["code"] == "snaps") {
                assert!(share >= before - 1e-3, "{at}: {before} {share}");
                before = share;
            }
        }
    }
}

#[test]
fn a_soft_column_is_critical_where_the_closed_form_says() {
    // P (1 - P/500) = 100.
    let critical = 250.0 - (250.0_f64.powi(2) - 50_000.0).sqrt();
    for (share, stable) in [(0.5, true), (0.999, true), (1.001, false), (1.2, false)] {
        let load = share * critical;
        let (found, words) = under("check", "soft.toml", [-load, 0.0, 0.0]).expect("an answer");
        let a = &found["assumptions"];
        assert_eq!(a["reference_stable"], stable, "{words}");
        let reported = a[format!("largest_{SHARE}")].as_f64();
        let exact = load * (1.0 - load / 500.0) / 100.0;
        assert!(
            (reported.expect("a share") - exact).abs() < 1e-6,
            "{reported:?} {exact}"
        );
    }
}

#[test]
fn a_load_out_of_all_bounds_is_no_load_of_an_answer() {
    for model in ["orthoglide", "delta", "heavy_6r"] {
        for size in [1e300, -1e200, 1e60] {
            let (found, words) = under("check", model, [size, 0.0, 0.0]).expect("an answer");
            let words = flat(&words);
            assert!(!words.contains("Nothing looks wrong"), "{words}");
            assert!(
                !words.contains("infinite") && !words.contains("not available"),
                "{words}"
            );
            assert!(
                found["assumptions"]["reference_stable"].is_null(),
                "{words}"
            );
            assert!(warnings(&found)[0].contains("no equilibrium"), "{words}");
        }
    }
}
