//! Materials: what the library says, what a user's file may say, and factors of a cut.

use kinetostat_cutting::{
    Coolant, Correction, CutErrorKind, CuttingMaterial, ForceLaw, Group, Law, Materials, Process,
};
use proptest::prelude::*;

const MINIMAL: &str = r#"
[[material]]
name = "wax"
group = "other"
spread_percent = 40
source = "our dynamometer"
measured_in = { process = "milling" }
[material.law.kienzle]
specific_n_per_mm2 = [20, 8, 5]
exponent = [0.2, 0.2, 0.2]
"#;

fn refused(text: &str) -> kinetostat_cutting::CutError {
    Materials::read("ours.toml", text).unwrap_err()
}

#[test]
fn the_library_is_there_and_every_entry_says_where_it_comes_from() {
    let materials = Materials::library();
    assert_eq!(materials.iter().count(), 33);
    for material in materials.iter() {
        let name = &material.name;
        assert!(material.source.len() > 30, "{name}: {}", material.source);
        assert!(!material.assumptions.is_empty(), "{name}");
        assert!(
            material.assumptions.iter().all(|a| a.ends_with('.')),
            "{name}"
        );
        assert!(
            (0.05..=0.5).contains(&material.spread),
            "{name}: {}",
            material.spread
        );
        // No metal is cut at 0.1 mm with less than 200 or more than 8000 N/mm2.
        let force = material.edge_force(0.1);
        let specific = force.tangential / 0.1;
        assert!(
            (200.0..8000.0).contains(&specific),
            "{name}: {specific} N/mm2"
        );
        for part in [force.radial, force.axial.abs()] {
            assert!(part > 0.0 && part < force.tangential, "{name}: {force:?}");
        }
        // Of milling, a helix that lifts the chip draws the tool to the part; the reference forces have the other sign.
        let milled = material.for_milling(&Correction::default()).unwrap().law;
        let is_reference = material.source.starts_with("shared/theory");
        let axial = milled.edge_force(0.1).axial;
        assert_eq!(axial > 0.0, is_reference, "{name}: {axial}");
        assert!((axial.abs() / (milled.factor * force.axial.abs()) - 1.0).abs() < 1e-12);
    }
}

/// Oblique cutting from geometry alone. The edge of a helix leans back against the turn as it rises, so that its rake face looks ahead
/// and up: what presses on it pushes the tool down. Against the edge the chip slides up along it and (Stabler) leaves it at the angle of
/// the helix: what rubs pushes the tool up, by less than that with friction below 1.
#[test]
fn a_helix_that_lifts_the_chip_draws_the_tool_to_the_part() {
    for (helix_deg, friction) in [10.0, 30.0, 45.0, -30.0]
        .into_iter()
        .flat_map(|helix| [0.0, 0.3, 0.6, 0.9].map(|friction| (helix, friction)))
    {
        let (sin, cos) = f64::to_radians(helix_deg).sin_cos();
        // Ahead with the tooth, and up to the spindle.
        let (edge, face) = ([-sin, cos], [cos, sin]);
        let work: [f64; 2] = [-1.0, 0.0];
        let along_edge = work[0] * edge[0] + work[1] * edge[1];
        let up = -face[1] + friction * along_edge * edge[1];
        let lifts_the_chip = helix_deg > 0.0;
        assert_eq!(up < 0.0, lifts_the_chip, "{helix_deg} {friction}: {up}");
    }
    let materials = Materials::library();
    let steel = materials.find("C45").unwrap();
    let milled = steel.for_milling(&Correction::default()).unwrap();
    assert!(milled.law.edge_force(0.1).axial < 0.0);
}

#[test]
fn table_2_2_of_the_report_is_in_the_library() {
    let materials = Materials::library();
    let table = [
        ("Monel 400", 2600.0, 0.19, Group::Nickel),
        ("Inconel 718", 2088.0, 0.29, Group::Nickel),
        ("Ti Al 6 V 4", 1370.0, 0.21, Group::Titanium),
        ("Al Mg 4.5 Mn", 780.0, 0.23, Group::Aluminium),
    ];
    for (name, specific, exponent, group) in table {
        let material = materials.find(name).unwrap();
        let Law::Kienzle(law) = material.law else {
            panic!("{name}: {:?}", material.law);
        };
        assert_eq!(
            (law.specific_n_per_mm2[0], law.exponent[0]),
            (specific, exponent)
        );
        assert_eq!(material.group, group);
        // The table has no other components: they are said to be assumed.
        let said = |a: &String| a.starts_with("Radial and axial parts are assumed");
        assert!(material.assumptions.iter().any(said), "{name}");
    }
}

/// Printed rows of the table of specific cutting forces in the vendor's norm, kN/mm2 at feeds of 0.16 to 1.6 mm and 45 degrees.
#[test]
fn fitted_entries_follow_the_printed_table() {
    let materials = Materials::library();
    let feeds = [0.16, 0.25, 0.4, 0.63, 1.0, 1.6];
    let rows = [
        ("St 42", [2.60, 2.40, 2.20, 2.05, 1.90, 1.80]),
        ("E295", [3.50, 3.10, 2.75, 2.45, 2.15, 1.95]),
        ("C45", [3.05, 2.80, 2.60, 2.40, 2.20, 2.05]),
        ("E360", [4.35, 3.80, 3.30, 2.90, 2.50, 2.20]),
        ("42CrMo4", [4.35, 3.90, 3.45, 3.10, 2.75, 2.45]),
        ("16MnCr5", [3.75, 3.30, 2.95, 2.60, 2.30, 2.05]),
        ("GE240", [2.30, 2.10, 1.95, 1.80, 1.70, 1.60]),
        ("GG-25", [2.05, 1.80, 1.60, 1.45, 1.30, 1.15]),
    ];
    let mut compared = 0;
    for (name, row) in rows {
        let material = materials.find(name).unwrap();
        for (feed, printed) in feeds.iter().zip(row) {
            let chip = feed * std::f64::consts::FRAC_1_SQRT_2;
            let specific = material.edge_force(chip).tangential / chip / 1000.0;
            assert!(
                (specific / printed - 1.0).abs() < 0.016,
                "{name} at {feed}: {specific}"
            );
            let (from, to) = material.known_between_mm().unwrap();
            assert!(from - 0.001 < chip && chip < to + 0.001);
            compared += 1;
        }
    }
    assert_eq!(compared, 48);
}

#[test]
fn spelling_does_not_matter() {
    let materials = Materials::library();
    let spellings = [
        ("ti6al4v", "Ti-6Al-4V"),
        ("TI 6AL 4V", "Ti-6Al-4V"),
        ("TiAl6V4", "Ti-6Al-4V"),
        ("almg4,5mn", "AlMg4.5Mn"),
        ("EN-AW 5083", "AlMg4.5Mn"),
        ("1.0503", "C45"),
        ("INCONEL-718", "Inconel 718"),
        ("x5crni18 10", "austenitic stainless steel"),
    ];
    for (spelling, name) in spellings {
        assert_eq!(materials.find(spelling).unwrap().name, name);
    }
}

#[test]
fn an_unknown_name_is_answered_with_the_nearest_ones() {
    let materials = Materials::library();
    let error = materials.find("42CrMo").unwrap_err();
    assert_eq!(error.kind, CutErrorKind::Material);
    assert!(
        error.expected.starts_with("did you mean 42CrMo4"),
        "{error}"
    );
    let error = materials.find("unobtainium, of the best").unwrap_err();
    assert!(error.expected.contains("Monel 400"), "{error}");
    for nothing in ["", " - . ", "\u{feff}"] {
        assert!(materials.find(nothing).is_err());
    }
}

#[test]
fn entries_of_a_user_come_first() {
    let mut materials = Materials::library();
    let ours = MINIMAL.replace("\"wax\"", "\"our steel\"\naliases = [\"C 45\"]");
    materials.with(Materials::read("ours.toml", &ours).unwrap());
    assert_eq!(materials.find("1.0503").unwrap().name, "C45");
    assert_eq!(materials.find("C45").unwrap().name, "our steel");
    assert_eq!(materials.iter().next().unwrap().name, "our steel");
    assert_eq!(materials.iter().count(), 34);
}

#[test]
fn a_file_may_give_any_law_and_ranges() {
    let laws = [
        (
            "linear",
            "cutting_n_per_mm2 = [800, 200, 100]\nedge_n_per_mm = [20, 30, 1]",
            100.0,
        ),
        (
            "exponential",
            "cutting_n_per_mm2 = [800, 200, 100]\nedge_n_per_mm = [20, 30, 1]\nedge_thickness_mm = 0.001",
            100.0,
        ),
        (
            "rational",
            "a_1_n_per_mm2 = [2000, 1, 1]\na_2_n_per_mm3 = [1e5, 1, 1]\na_3_per_mm = [100, 0, 0]",
            1200.0 / 11.0,
        ),
    ];
    for (name, keys, tangential) in laws {
        let head = MINIMAL.split("[material.law").next().unwrap();
        let text = format!(
            "{head}chip_mm = [0.01, 0.3]\nspeed_m_per_min = [100, 400]\n[material.law.{name}]\n{keys}"
        );
        let materials = Materials::read("ours.toml", &text).unwrap();
        let material = materials.find("WAX").unwrap();
        assert!(
            (material.edge_force(0.1).tangential - tangential).abs() < 1e-9,
            "{name}"
        );
        assert_eq!(material.known_between_mm(), Some((0.01, 0.3)));
        assert_eq!(material.speed_m_per_min, Some((100.0, 400.0)));
        assert_eq!(material.spread, 0.4);
        assert_eq!(material.measured_in.process, Process::Milling);
    }
}

#[test]
fn faults_of_a_file_name_its_line_and_what_was_meant() {
    let cases = [
        // What is replaced, by what, in which line, what the message says.
        ("source =", "sorce =", 6, "did you mean `source`?"),
        ("kienzle", "kinzle", 8, "did you mean `kienzle`?"),
        ("exponent", "exponents", 10, "did you mean `exponent`?"),
        ("\"milling\"", "\"miling\"", 7, "did you mean `milling`?"),
        ("\"other\"", "\"steal\"", 4, "did you mean `steel`?"),
        ("= 40", "= -40", 5, "0 to 100 %"),
        ("= 40", "= nan", 5, "0 to 100 %"),
        ("[20, 8", "[-20, 8", 9, "1 to 100000 N/mm2"),
        ("[20, 8", "[inf, 8", 9, "1 to 100000 N/mm2"),
        ("= \"wax\"", "= \" . \"", 3, "letters or digits"),
        (
            "= 40",
            "= \"forty\"",
            5,
            "the text \"forty\"; expected a number",
        ),
        ("= 40", "40", 5, "key with no value; expected `=`"),
        (
            "group",
            "chip_mm = [0.3, 0.1]\ngroup",
            4,
            "begins below its end",
        ),
        ("process =", "rake_deg = 300, process =", 7, "-30 to 40 deg"),
    ];
    for (from, to, line, expected) in cases {
        assert!(MINIMAL.contains(from));
        let error = refused(&MINIMAL.replace(from, to));
        assert_eq!(error.file.as_deref(), Some("ours.toml"), "{to}");
        assert!(error.to_string().contains(expected), "{to}: {error}");
        // A law is one value: its line is where its keys begin, or the line of its name.
        let tolerance = usize::from(to.starts_with('['));
        assert!(
            error.line.unwrap().abs_diff(line) <= tolerance,
            "{to}: {error}"
        );
    }
    let error = refused(&MINIMAL.replace("source = \"our dynamometer\"\n", ""));
    assert!(
        error.to_string().contains("material: no `source`"),
        "{error}"
    );
    let error = refused(&format!(
        "{MINIMAL}{}",
        MINIMAL.replace("\"wax\"", "\"W. A. X.\"")
    ));
    assert_eq!(error.line, Some(13));
    assert!(error.to_string().contains("names two materials"), "{error}");
}

#[test]
fn a_file_is_bounded() {
    let entry = |i: usize| MINIMAL.replace("wax", &format!("wax {i}"));
    let many: String = (0..10_001).map(entry).collect();
    assert!(
        refused(&many)
            .to_string()
            .contains("at most 10000 materials")
    );
    let long = format!("{MINIMAL}# {}", "x".repeat(10_000_001));
    assert!(
        refused(&long)
            .to_string()
            .contains("at most 10000000 bytes")
    );
    assert_eq!(Materials::read("ours.toml", "").unwrap().iter().count(), 0);
}

#[test]
fn factors_are_those_of_the_report_and_are_named() {
    let materials = Materials::library();
    let steel = materials.find("mild steel").unwrap(); // turning, rake 6 degrees, speed unknown
    let correction = Correction {
        cutting_speed_m_per_min: Some(1000.0),
        rake_deg: Some(16.0),
        cutting_material: CuttingMaterial::HighSpeedSteel,
        wear: Some(1.4),
        coolant: Coolant::Emulsion,
        ..Correction::default()
    };
    let applied = steel.for_milling(&correction).unwrap();
    let (k_v, k_gamma) = (1.38 / 1000_f64.powf(0.07), (1.09 - 0.192) / (1.09 - 0.072));
    let expected = 1.3 * k_v * k_gamma * 1.05 * 1.4 * 0.9;
    assert!((applied.law.factor / expected - 1.0).abs() < 1e-12);
    let force = applied.law.edge_force(1.0).tangential;
    assert!((force / (1800.0 * expected) - 1.0).abs() < 1e-12);
    let symbols: Vec<&str> = applied.factors.iter().map(|f| f.symbol).collect();
    assert_eq!(symbols, ["K_PRO", "K_V", "K_gamma", "K_CM", "K_TW", "K_CL"]);
    let product: f64 = applied.factors.iter().map(|f| f.value).product();
    assert!((product / applied.law.factor - 1.0).abs() < 1e-12);
    assert!(
        applied.factors[1]
            .to_string()
            .contains("that of the test is not known")
    );
    assert!(
        applied.factors[2]
            .to_string()
            .contains("6 degrees in the test")
    );
    // 25 % of the table and 0.1 of 1.3 of the factor.
    assert!((applied.spread - (0.0625_f64 + 0.01 / 1.69).sqrt()).abs() < 1e-12);
}

#[test]
fn coefficients_of_milling_hold_as_they_are_and_a_given_factor_replaces_the_default() {
    let materials = Materials::library();
    let aluminium = materials.find("linear aluminium").unwrap();
    let applied = aluminium.for_milling(&Correction::default()).unwrap();
    assert_eq!((applied.law.factor, applied.factors.len()), (1.0, 0));
    assert_eq!(applied.spread, aluminium.spread);
    let titanium = materials.find("Ti6Al4V").unwrap();
    let given = Correction {
        process: Some(1.2),
        ..Correction::default()
    };
    let applied = titanium.for_milling(&given).unwrap();
    assert_eq!((applied.law.factor, applied.spread), (1.2, titanium.spread));
    let beyond = Correction {
        wear: Some(f64::NAN),
        ..Correction::default()
    };
    assert!(titanium.for_milling(&beyond).is_err());
}

#[test]
fn the_test_of_the_coefficients_is_divided_out() {
    let text = MINIMAL.replace(
        "process = \"milling\"",
        "process = \"milling\", rake_deg = 8, speed_m_per_min = 400",
    );
    let materials = Materials::read("ours.toml", &text).unwrap();
    let same = Correction {
        cutting_speed_m_per_min: Some(400.0),
        rake_deg: Some(8.0),
        ..Correction::default()
    };
    let applied = materials.find("wax").unwrap().for_milling(&same).unwrap();
    assert!((applied.law.factor - 1.0).abs() < 1e-12);
}

proptest! {
    #[test]
    fn no_text_makes_it_panic(text in "\\PC{0,200}", cut in 0_usize..300) {
        let _ = Materials::read("ours.toml", &text);
        let part: String = MINIMAL.chars().take(cut).chain(text.chars()).collect();
        let _ = Materials::read("ours.toml", &part);
        let _ = Materials::library().find(&text);
    }

    #[test]
    fn signs_and_case_do_not_change_what_is_found(which in 0_usize..33, at in 0_usize..12, sign in "[ .\\-_]") {
        let materials = Materials::library();
        let name = &materials.iter().nth(which).unwrap().name;
        let place = at.min(name.len());
        let spelled = format!("{}{sign}{}", &name[..place], &name[place..]).to_uppercase();
        prop_assert_eq!(&materials.find(&spelled).unwrap().name, name);
    }
}
