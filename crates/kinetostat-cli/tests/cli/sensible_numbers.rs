//! No command tells a person a number that no person reads: `5.0000e1 mm`, `6.4e-15 deg`, `0.0000 mm away`.

use crate::common::{run, workplace};

/// Two arms of 390 and 500 mm in a plane, that meet in a hinge.
const FIVE_BARS: &str = r#"schema = 1
[mechanism]
name = "five bars"
[section.tube]
tube = { outer_diameter_mm = 60, inner_diameter_mm = 50 }
material = "steel"
[chain.left]
elements = [
  { actuator = "revolute", name = "motor", axis = "z", stiffness_n_m_per_rad = 2.0e5, home_deg = 112.62 },
  { link = "tube", name = "arm", length_mm = 390 },
  { passive = "revolute", name = "elbow", axis = "z", home_deg = -59.49 },
  { link = "tube", name = "forearm", length_mm = 500 },
]
[chain.right]
elements = [
  { actuator = "revolute", name = "motor", axis = "z", stiffness_n_m_per_rad = 2.0e5, home_deg = 67.38 },
  { link = "tube", name = "arm", length_mm = 390 },
  { passive = "revolute", name = "elbow", axis = "z", home_deg = 59.49 },
  { link = "tube", name = "forearm", length_mm = 500 },
  { passive = "revolute", name = "hinge", axis = "z", home_deg = -73.74 },
]
[[platform]]
name = "head"
home = { position_mm = [0, 760, 0], x_axis = [3, 4, 0] }
[[limb]]
name = "left"
from = "base"
to = "head"
chain = "left"
start = { position_mm = [-150, 0, 0] }
[[limb]]
name = "right"
from = "base"
to = "head"
chain = "right"
start = { position_mm = [150, 0, 0] }
"#;

/// Numbers with a power of ten are in steps of three; lengths and angles are not below what the formatter tells.
fn look_at(line: &str, text: &str) -> usize {
    let clean = |word: &str| -> String {
        let ends = |c: char| "()[],;:.'\"`".contains(c);
        word.trim_start_matches(ends)
            .trim_end_matches(ends)
            .to_owned()
    };
    let words: Vec<String> = text.split_whitespace().map(clean).collect();
    let mut numbers = 0;
    for (k, word) in words.iter().enumerate() {
        let Ok(value) = word.parse::<f64>() else {
            continue;
        };
        if !word.starts_with(|c: char| c.is_ascii_digit() || c == '-' || c == '.') {
            continue;
        }
        numbers += 1;
        if let Some((mantissa, power)) = word.split_once(['e', 'E']) {
            let power: i32 = power.parse().expect("a power");
            assert_eq!(power % 3, 0, "{line}: {word} in {text}");
            let size = mantissa.parse::<f64>().expect("a number").abs();
            assert!((1.0..1000.0).contains(&size), "{line}: {word} in {text}");
        }
        let smallest = match words.get(k + 1).map(String::as_str) {
            Some("deg" | "degrees") => 1e-4,
            Some("mm") => 1e-6,
            Some("um") => 1e-3,
            _ => continue,
        };
        assert!(
            value == 0.0 || value.abs() >= smallest,
            "{line}: {word} in {text}"
        );
        let away = words.get(k + 2).is_some_and(|next| next == "away");
        assert!(
            !(away && value == 0.0 && word.contains('.')),
            "{line}: {word} in {text}"
        );
    }
    numbers
}

#[test]
fn messages_have_numbers_that_people_read() {
    let here = workplace();
    let here = here.path();
    let put = |name: &str, text: &str| std::fs::write(here.join(name), text).expect("a file");
    put("five.toml", FIVE_BARS);
    put(
        "map.csv",
        "x_mm,y_mm,z_mm,dx_mm,dy_mm,dz_mm\n-30,0,0,3e-5,0,0\n30,0,0,4e-5,0,0\n",
    );
    put(
        "outside.csv",
        "x_mm,y_mm,z_mm,dx_mm,dy_mm,dz_mm\n-3,0,0,3e-5,0,0\n3,0,0,4e-5,0,0\n",
    );
    put("far.ngc", "G21 G90 G17\nG0 X0 Y0 Z5\nG1 X9000 F600\nM2\n");
    for (placement, name) in [("[0, 0, 700]", "a.toml"), ("[0, 0, 1e-7]", "b.toml")] {
        put(
            name,
            &format!(
                "schema = 1\nmodel = \"prs3\"\nprogram = \"part.ngc\"\n[placement]\npart_origin_mm = {placement}\norientation = \"held\"\n[load]\nweight = \"all\"\nforce_n = [10, 0, 0]\n"
            ),
        );
    }
    let program = "--program part.ngc --force-overwrite";
    let mut seen = 0;
    for line in [
        format!("compensate --model five.toml {program} --tool-length-mm 50 --part-origin-mm 0 300 0 --milling 50 -5 -10 --out o.ngc"),
        format!("deflect five.toml {program} --tool-length-mm 50 --part-origin-mm 0 300 0 --milling 50 -5 -10"),
        "deflect five.toml --tool-length-mm 50 --at 0 400 0 --force 1 0 0".to_owned(),
        "deflect five.toml --at 0 400 1e-7 --force 1 0 0".to_owned(),
        "deflect five.toml --at 0 4000 0".to_owned(),
        "deflect five.toml --at 0 400 20 --rotation rotation_vector_deg=0,0,0".to_owned(),
        "check five.toml".to_owned(),
        format!("deflect a.toml {}", "--force-overwrite"),
        "compensate a.toml --out o.ngc --force-overwrite".to_owned(),
        "compensate b.toml --out o.ngc --force-overwrite".to_owned(),
        "deflect tricept_like --force 215e6 0 0".to_owned(),
        "deflect rrr3_planar --force 10 0 0".to_owned(),
        format!("deflect rrr3_planar {program} --force 10 0 0"),
        "deflect rrr3_planar --at 0 0 5".to_owned(),
        "deflect scara --at 9000 0 0".to_owned(),
        "deflect orthoglide --force 1e9 0 0".to_owned(),
        "deflect orthoglide --force 1e-9 0 0".to_owned(),
        "stiffness orthoglide --at 0 0 1e5".to_owned(),
        "equilibria two_link --at 1e6 0 0".to_owned(),
        "compensate --map map.csv --program part.ngc --out o.ngc --force-overwrite".to_owned(),
        "compensate --map outside.csv --program part.ngc --out o.ngc --force-overwrite".to_owned(),
        "compensate --model orthoglide --program far.ngc --force 100 0 0 --out o.ngc --force-overwrite".to_owned(),
        format!("compensate --model orthoglide {program} --force 1e6 0 0 --out o.ngc"),
        format!("compensate --model orthoglide {program} --milling 215 -10 -25 --tolerance-um 1e-4 --out o.ngc"),
        format!("compensate --model orthoglide {program} --milling 215 -10 -25 --max-feed-factor 1 --out o.ngc"),
    ] {
        let words: Vec<&str> = line.split(' ').collect();
        let said = run(here, &words);
        assert!((0..=4).contains(&said.code), "{line}: {said:?}");
        let count = look_at(&line, &said.out) + look_at(&line, &said.err);
        assert!(count > 0, "{line} tells no number: {said:?}");
        assert!(!said.err.contains("at 0 %") && !said.out.contains("at 0 %"), "{line}: {said:?}");
        seen += count;
    }
    assert!(seen > 300, "{seen} numbers");
}

/// A target beside the plane that a machine moves in is reported to be that, with the nearest place.
#[test]
fn a_place_outside_the_plane_of_a_machine_is_reported_to_be_that() {
    let here = workplace();
    let here = here.path();
    std::fs::write(here.join("five.toml"), FIVE_BARS).expect("a model");
    for (line, beside, nearest) in [
        (
            "deflect five.toml --tool-length-mm 50 --at 0 400 0",
            true,
            "(0, 400, 50) mm",
        ),
        (
            "compensate --model five.toml --program part.ngc --tool-length-mm 50 --part-origin-mm 0 400 0 --force 1 0 0 --out o.ngc",
            true,
            "50.000) mm in base axes",
        ),
        // In the plane, but too far.
        ("deflect five.toml --at 0 4000 0", false, "0) mm"),
    ] {
        let words: Vec<&str> = line.split(' ').collect();
        let said = run(here, &words);
        assert_eq!(said.code, 2, "{line}: {said:?}");
        let reported = said.err.contains("stays in a surface (here square to z)");
        assert_eq!(reported, beside, "{line}: {said:?}");
        assert!(said.err.contains(nearest), "{line}: {said:?}");
    }
}
