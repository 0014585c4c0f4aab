//! Damping that couples modes, that is none, or that is too much: `modes`, `frf` and `lobes` on machines of two masses.

use std::path::Path;

use kinetostat_testing::Worst;
use serde_json::Value;

use crate::common::{Said, run, workplace};

/// Two slides after one another along x, two masses; along y and z nothing gives way.
const TWO_MASSES: &str = r#"schema = 1

[mechanism]
name = "two masses"
gravity_m_per_s2 = [0, 0, 0]

[[platform]]
name = "tool"
home = { position_m = [0, 0, 0.3] }

[chain.line]
elements = [
  { rigid = { translation_m = [0, 0, 0.3] } },
  { actuator = "prismatic", name = "near", axis = "x", stiffness_n_per_mm = 4000 },
  { body = "near mass", mass_kg = 40, centre_of_mass_m = [0, 0, 0], inertia_kg_m2 = [[1, 0, 0], [0, 1, 0], [0, 0, 1]] },
  { actuator = "prismatic", name = "far", axis = "x", stiffness_n_per_mm = 1500 },
  { body = "far mass", mass_kg = 10, centre_of_mass_m = [0, 0, 0], inertia_kg_m2 = [[1, 0, 0], [0, 1, 0], [0, 0, 1]] },
  { actuator = "prismatic", name = "across", axis = "y", stiffness_n_per_mm = 250000 },
  { body = "head", mass_kg = 5, centre_of_mass_m = [0, 0, 0], inertia_kg_m2 = [[1, 0, 0], [0, 1, 0], [0, 0, 1]] },
]

[[limb]]
name = "line"
from = "base"
to = "tool"
chain = "line"
"#;

fn two_masses() -> tempfile::TempDir {
    let here = workplace();
    std::fs::write(here.path().join("two.toml"), TWO_MASSES).expect("written");
    here
}

fn said(here: &Path, line: &str) -> Said {
    run(here, &line.split(' ').collect::<Vec<_>>())
}

fn json(here: &Path, line: &str) -> Value {
    serde_json::from_str(&said(here, line).answered().out).expect("JSON")
}

const CUT: &str = "--teeth 2 --coefficients-n-per-mm2 800 240 0";

/// A damper at one joint couples the modes: the response is that of the two masses, by hand, and not of modes with their own
/// ratios.
#[test]
fn dampers_at_joints_are_solved_directly() {
    let here = two_masses();
    let line = "frf two.toml --viscous near=9000 --frequencies 20 90 8 --from x --to x --json";
    let answer = json(here.path(), line);
    assert_eq!(answer["solution"], "direct");
    let by_modes = json(here.path(), &format!("{line} --modes 3"));
    assert_eq!(by_modes["solution"], "modes");
    let told = by_modes["warnings"].to_string();
    assert!(told.contains("what couples modes"), "{told}");
    let list = |of: &Value, name: &str| -> Vec<f64> {
        let all = of["curves"][0][name].as_array().expect("a list").iter();
        all.map(|x| x.as_f64().expect("a number")).collect()
    };
    let hz = answer["frequencies_hz"].as_array().expect("a list");
    let (mut worst, mut worst_of_modes) = (Worst::new(), Worst::new());
    for (i, hz) in hz.iter().enumerate() {
        let w = std::f64::consts::TAU * hz.as_f64().expect("a number");
        // By hand: near mass z1 = k1 + k2 + i w c - w^2 m1, far mass z2 = k2 - w^2 m2, coupled by k2.
        let (k1, k2, c, m1, m2) = (4e6, 1.5e6, 9000.0, 40.0, 15.0);
        let (a, b) = (k1 + k2 - w * w * m1, w * c);
        let z2 = k2 - w * w * m2;
        // G = z1 / (z1 z2 - k2^2)
        let (re, im) = (a * z2 - k2 * k2, b * z2);
        let size = re * re + im * im;
        let (g_re, g_im) = ((a * re + b * im) / size, (b * re - a * im) / size);
        let off = |of: &Value| {
            let (x, y) = (list(of, "real")[i], list(of, "imaginary")[i]);
            (x - g_re).hypot(y - g_im) / g_re.hypot(g_im)
        };
        worst.add(off(&answer));
        worst_of_modes.add(off(&by_modes));
    }
    let (worst, worst_of_modes) = (worst.of(hz.len()), worst_of_modes.of(hz.len()));
    assert!(worst < 1e-9, "{worst}");
    assert!(
        worst_of_modes > 0.1,
        "{worst_of_modes}: the case is too tame to tell"
    );
    let lobes = said(
        here.path(),
        &format!("lobes two.toml --viscous near=9000 across=500 {CUT} --rpm 1000 2000 3 --json"),
    )
    .answered();
    // What couples modes is in the lobes: there is nothing to tell.
    assert!(!lobes.out.contains("not all in the modes"), "{}", lobes.out);
}

/// A damper that a mode does not move gives it no damping: rounding is none, and no cut is stable then.
#[test]
fn damping_of_a_rounding_is_none() {
    let here = two_masses();
    let line = format!("lobes two.toml --viscous across=500 {CUT} --rpm 1000 2000 3");
    let said = said(here.path(), &line);
    assert_eq!(said.code, 1, "{said:?}");
    assert!(
        said.err
            .contains("without damping the smallest cut chatters"),
        "{}",
        said.err
    );
}

/// Modes above the band are springs, however they are damped; one inside it that is damped beyond critical is named.
#[test]
fn modes_beyond_critical_damping() {
    let here = two_masses();
    // Ratio of Rayleigh's damping by stiffness alone: b w / 2.
    let modes = json(here.path(), "modes two.toml --rayleigh 0 0.0005 --json");
    let list = modes["modes"].as_array().expect("modes");
    let number = |mode: &Value, name: &str| mode[name].as_f64().expect("a number");
    for mode in list {
        let by_hand = 0.0005 * std::f64::consts::PI * number(mode, "frequency_hz");
        assert!((number(mode, "damping_ratio") / by_hand - 1.0).abs() < 1e-9);
    }
    let highest = &list[list.len() - 1];
    assert!(number(highest, "damping_ratio") > 1.0);
    assert!(modes["warnings"].to_string().contains("beyond critical"));
    let lobes = format!("lobes two.toml --rayleigh 0 0.0005 {CUT} --rpm 1000 2000 3 --json");
    let up_to =
        0.5 * (number(&list[list.len() - 2], "frequency_hz") + number(highest, "frequency_hz"));
    let below = json(here.path(), &format!("{lobes} --modes-up-to-hz {up_to}"));
    assert_eq!(
        below["modes_hz"].as_array().expect("modes").len(),
        list.len() - 1
    );
    let all = said(here.path(), &format!("{lobes} --modes-up-to-hz 2000"));
    assert_eq!(all.code, 1, "{all:?}");
    let named = format!("of the mode at {:.4} Hz", number(highest, "frequency_hz"));
    assert!(all.err.contains(&named), "{}", all.err);
    let none = said(here.path(), &format!("{lobes} --modes-up-to-hz 5"));
    assert_ne!(none.code, 0);
    assert!(
        none.err.contains("lowest mode of the machine"),
        "{}",
        none.err
    );
}

/// Two masses, a spring with a damper in series with one without mass, and dampers that hold two of three modes beyond critical:
/// limits by another program (Chebyshev collocation of the state space of these seven states, written without sight of this one).
#[test]
fn limits_with_strong_dampers_and_springs_without_mass_are_those_of_another_program() {
    let here = workplace();
    let model = |a: f64, b: f64, c: f64, y: f64| {
        format!(
            "schema = 1\n[mechanism]\nname = \"two\"\ngravity_m_per_s2 = [0, 0, 0]\n[[platform]]\nname = \"tool\"\nhome = {{ position_mm = [0, 0, 0] }}\n\
             [chain.arm]\nelements = [\n\
             {{ spring = \"prismatic\", name = \"xa\", axis = \"x\", stiffness_n_per_m = 4.0e6, damping_n_s_per_m = {a} }},\n\
             {{ body = \"m1\", mass_kg = 40 }},\n\
             {{ spring = \"prismatic\", name = \"xb\", axis = \"x\", stiffness_n_per_m = 9.0e6, damping_n_s_per_m = {b} }},\n\
             {{ spring = \"prismatic\", name = \"xc\", axis = \"x\", stiffness_n_per_m = 3.0e7, damping_n_s_per_m = {c} }},\n\
             {{ spring = \"prismatic\", name = \"ya\", axis = \"y\", stiffness_n_per_m = 6.0e6, damping_n_s_per_m = {y} }},\n\
             {{ body = \"m2\", mass_kg = 12 }},\n]\n\
             [[limb]]\nname = \"arm\"\nfrom = \"base\"\nto = \"tool\"\nchain = \"arm\"\n"
        )
    };
    let half_up = "--teeth 2 --immersion 0.5 --up";
    let little_down = "--teeth 3 --immersion 0.1 --climb";
    let series = [0.0, 1.5e4, 0.0, 300.0];
    let held = [2e5, 2e5, 50.0, 200.0];
    let cases = [
        (held, half_up, 1500, 2.107678338),
        (held, half_up, 3000, 3.203670893),
        (held, half_up, 6000, 3.508482356),
        ([600.0, 2e4, 0.0, 500.0], half_up, 6000, 6.918415050),
        (series, little_down, 3000, 1.060696296),
        (series, little_down, 4500, 0.640423333),
        (series, little_down, 6000, 0.752463837),
    ];
    let mut worst = Worst::new();
    let all = cases.len();
    for ([a, b, c, y], cut, rpm, expected) in cases {
        std::fs::write(here.path().join("held.toml"), model(a, b, c, y)).expect("written");
        let line = format!(
            "lobes held.toml {cut} --coefficients-n-per-mm2 800 240 0 --rpm {rpm} {rpm} 1 --tool-axis 0 0 1 --depth-mm 12 --json"
        );
        let answer = json(here.path(), &line);
        let found = answer["points"][0]["limit_mm"].as_f64().expect("a limit");
        worst.add_at(found / expected - 1.0, || {
            format!("{line}: {found} {expected}")
        });
    }
    assert!(worst.of(all) < 1e-6, "{worst}");
}

/// A dead moment has no potential: complex modes say whether it flutters, and the response is solved directly.
#[test]
fn loads_without_a_potential_are_judged() {
    let here = workplace();
    std::fs::write(
        here.path().join("arm6.toml"),
        include_str!("vibration_models/arm6.toml"),
    )
    .expect("written");
    let line = "modes arm6.toml --moment 800 0 0 --json";
    let answer = json(here.path(), line);
    assert_eq!(
        answer["circulatory"]["verdict"], "stable",
        "{}",
        answer["circulatory"]
    );
    assert_eq!(answer["stable"], true);
    let text = said(here.path(), "modes arm6.toml --moment 800 0 0").answered();
    assert!(text.out.contains("stable under them"), "{}", text.out);
    let frf =
        "frf arm6.toml --moment 800 0 0 --damping 0.03 --frequencies 5 30 4 --from x --to x --json";
    assert_eq!(json(here.path(), frf)["solution"], "direct");
    let none = json(here.path(), "modes arm6.toml --json");
    assert!(none["circulatory"].is_null());
}
