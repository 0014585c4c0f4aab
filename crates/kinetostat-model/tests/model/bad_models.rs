//! Wrong models: each message says where, what, and what to do.

use kinetostat_model::{Model, TextStyle, read_model};

const GOOD: &str = r#"schema = 1

[mechanism]
name = "arm"
gravity_m_per_s2 = [0, 0, -9.81]

[[platform]]
name = "tool"
home = { position_mm = [800, 0, 0] }
mass_kg = 2

[section.tube]
tube = { outer_diameter_mm = 60, inner_diameter_mm = 50 }
youngs_modulus_gpa = 70
shear_modulus_gpa = 26

[stiffness.flange]
diagonal_n_m_rad = [1e8, 1e8, 1e8, 1e5, 1e5, 1e5]

[chain.arm]
elements = [
  { rigid = { translation_mm = [0, 0, 100] }, name = "foot" },
  { actuator = "revolute", name = "shoulder", axis = "z", stiffness_n_m_per_rad = 2e5, limits_deg = [-90, 90] },
  { passive = "universal", name = "cross", axes = ["y", "z"], homes_deg = [0, 0] },
  { link = "tube", name = "boom", length_mm = 800 },
  { spring6 = "flange", name = "flange" },
  { node = "end of boom" },
  { body = "boom", mass_kg = 5, centre_of_mass_mm = [-400, 0, 0] },
  { rigid = { translation_mm = [0, 0, -100] } },
]

[[limb]]
name = "arm"
from = "base"
to = "tool"
chain = "arm"

[[limb.load]]
spring = "balancer"
from = { node = "base", position_mm = [0, 0, 500] }
to = { node = "shoulder", position_mm = [200, 0, 0] }
stiffness_n_per_mm = 5
free_length_mm = 300

[[limb.load]]
wrench = "hose"
node = "boom"
axes = "base"
force_n = [0, 0, -20]

[[deviation]]
limb = "arm"
at = "foot"
moved_by = { rotation_vector_deg = [0, 1, 0] }
"#;

fn message(text: &str) -> String {
    match Model::from_toml(text, "bad.toml") {
        Ok(_) => panic!("this was accepted:\n{text}"),
        Err(error) => {
            for problem in error.problems() {
                assert!(
                    !problem.message.is_empty() && !problem.help.is_empty(),
                    "{problem}"
                );
            }
            error.to_string()
        }
    }
}

fn edited(from: &str, to: &str) -> String {
    assert_eq!(GOOD.matches(from).count(), 1, "'{from}' must occur once");
    GOOD.replace(from, to)
}

/// What is replaced, and by what. The messages are in `bad_models.txt`, in the same order.
type Case = (&'static str, &'static str);

#[rustfmt::skip]
const CASES: &[Case] = &[
    // Syntax
    ("name = \"tool\"", "name = \"tool"),
    ("home = { position_mm = [800, 0, 0] }", "home = { position_mm = [800, 0, 0 }"),
    ("mass_kg = 2", "mass_kg = 2\nmass_kg = 3"),
    ("mass_kg = 2", "mass_kg = 2,5"),
    // Keys
    ("length_mm = 800", "lenght_mm = 800"),
    ("length_mm = 800", "length = 800"),
    ("length_mm = 800", "length_inch = 31.5"),
    ("mass_kg = 2", "mass = 2"),
    ("mass_kg = 2", "colour = \"red\""),
    ("[section.tube]", "[sections.tube]"),
    ("rotation_vector_deg", "rpy_deg"),
    ("rotation_vector_deg", "rotation_xyz_deg"),
    ("stiffness_n_m_per_rad", "stiffness_nm_per_rad"),
    ("stiffness_n_m_per_rad", "stiffness_n_per_mm"),
    ("{ link = \"tube\"", "{ lnik = \"tube\""),
    ("{ node = \"end of boom\" }", "{ }"),
    ("{ node = \"end of boom\" }", "{ node = \"end of boom\", body = \"x\", mass_kg = 1 }"),
    ("to = \"tool\"\n", ""),
    ("[[limb]]", "[limb]"),
    ("schema = 1", ""),
    ("schema = 1", "schema = 2"),
    // Values
    ("\"revolute\"", "\"revolut\""),
    ("axis = \"z\"", "axis = \"w\""),
    ("axis = \"z\"", "axis = [0, 0, 0]"),
    ("axis = \"z\"", "axis = [0, 1]"),
    ("length_mm = 800", "length_mm = \"800\""),
    ("length_mm = 800", "length_mm = nan"),
    ("length_mm = 800", "length_mm = 1e999"),
    ("length_mm = 800", "length_mm = -800"),
    ("length_mm = 800", "length_mm = 800, length_m = 0.8"),
    ("length_mm = 800", "assumption = \"long\""),
    ("[800, 0, 0]", "[800, 0]"),
    ("stiffness_n_m_per_rad = 2e5", "stiffness_n_m_per_rad = -2e5"),
    ("stiffness_n_m_per_rad = 2e5, ", ""),
    ("stiffness_n_m_per_rad = 2e5", "stiffness_n_m_per_rad = 2e5, rigid_drive = true"),
    ("[-90, 90]", "[90, -90]"),
    ("[-90, 90]", "[10, 90]"),
    ("limits_deg = [-90, 90]", "limits_mm = [-90, 90]"),
    ("homes_deg = [0, 0]", "homes_deg = [0, 0, 0]"),
    ("axes = [\"y\", \"z\"]", "axes = [\"y\", \"-y\"]"),
    ("axes = [\"y\", \"z\"], ", ""),
    ("mass_kg = 5", "mass_kg = -5"),
    ("gravity_m_per_s2 = [0, 0, -9.81]\n", ""),
    ("inner_diameter_mm = 50", "inner_diameter_mm = 70"),
    ("shear_modulus_gpa = 26", ""),
    ("shear_modulus_gpa = 26", "poissons_ratio = 0.7"),
    ("shear_modulus_gpa = 26", "shear_modulus_gpa = 26\nround = { diameter_mm = 3 }"),
    ("diagonal_n_m_rad = [1e8,", "diagonal_n_m_rad = [0,"),
    ("diagonal_n_m_rad = [1e8, 1e8, 1e8, 1e5, 1e5, 1e5]", "matrix_n_m_rad = [[2,1,0,0,0,0],[0,2,0,0,0,0],[0,0,2,0,0,0],[0,0,0,2,0,0],[0,0,0,0,2,0],[0,0,0,0,0,2]]"),
    ("diagonal_n_m_rad = [1e8, 1e8, 1e8, 1e5, 1e5, 1e5]", "matrix_n_m_rad = [[2,3,0,0,0,0],[3,2,0,0,0,0],[0,0,2,0,0,0],[0,0,0,2,0,0],[0,0,0,0,2,0],[0,0,0,0,0,2]]"),
    ("{ rotation_vector_deg = [0, 1, 0] }", "{ quaternion_wxyz = [1, 1, 0, 0] }"),
    ("{ rotation_vector_deg = [0, 1, 0] }", "{ x_axis = \"x\", y_axis = [1, 1, 0] }"),
    ("{ rotation_vector_deg = [0, 1, 0] }", "{ rotation_vector_deg = [0, 1, 0], a_b_c_kuka_deg = [0, 0, 0] }"),
    ("stiffness_n_m_per_rad = 2e5", "stiffness_n_mm_per_rad = 1.7e308, stiffness_n_m_per_rad = 1"),
    ("length_mm = 800", "length_m = 1e-200"),
    ("{ rotation_vector_deg = [0, 1, 0] }", "{ rotation_vector_deg = [1e308, 1e308, 0] }"),
    // Names
    ("{ link = \"tube\"", "{ link = \"tub\""),
    ("{ spring6 = \"flange\"", "{ spring6 = \"tube\""),
    ("chain = \"arm\"", "chain = \"leg\""),
    ("to = \"tool\"", "to = \"tolo\""),
    ("to = \"tool\"", "to = \"base\""),
    ("from = \"base\"", "from = \"tool\""),
    ("at = \"foot\"", "at = \"food\""),
    ("limb = \"arm\"", "limb = \"ram\""),
    ("name = \"cross\"", "name = \"shoulder\""),
    ("{ node = \"end of boom\" }", "{ node = \"tip\" }"),
    ("{ node = \"end of boom\" }", "{ coupled = \"shulder\", motion = \"revolute\", axis = \"z\", ratio = -1 }"),
    ("name = \"tool\"\n", "name = \"base\"\n"),
    ("[[limb]]\nname = \"arm\"", "[[limb]]\nname = \" arm\""),
    ("[[deviation]]", "[[deviation]]\nlimb = \"arm\"\nat = \"foot\"\nmoved_by = { }\n[[deviation]]"),
    ("[[limb]]", "[[platform]]\nname = \"second\"\nhome = { }\n\n[[limb]]"),
    // Links
    ("length_mm = 800", "length_mm = 800, segments = 0"),
    ("length_mm = 800", "length_mm = 800, segments = 2.5"),
    ("length_mm = 800", "length_mm = 800, convention = \"bowed\""),
    ("length_mm = 800", "length_mm = 800, segmnets = 4"),
    ("length_mm = 800", "length_mm = 800, density_kg_m3 = -7850"),
    ("length_mm = 800", "length_mm = 800, density_kg_m3 = 7.85"),
    ("length_mm = 800", "length_mm = 800, density_kg_m3 = nan"),
    ("length_mm = 800", "length_mm = 800, density = 7850"),
    ("length_mm = 800", "length_mm = 800, mass_kg_per_m = 0"),
    ("length_mm = 800", "length_mm = 800, density_kg_m3 = 7850, mass_kg_per_m = 5"),
    ("length_mm = 800", "length_mm = 800, mass_model = \"halves_at_ends\""),
    ("length_mm = 800", "length_mm = 800, mass_kg_per_m = 5, mass_model = \"half\""),
    ("{ link = \"tube\"", "{ link = \"flange\", density_kg_m3 = 7850"),
    // Loads
    ("spring = \"balancer\"", "sprnig = \"balancer\""),
    ("spring = \"balancer\"", ""),
    ("spring = \"balancer\"", "spring = \"balancer\"\nwrench = \"another\""),
    ("spring = \"balancer\"", "spring = \"hose\""),
    ("spring = \"balancer\"", "spring = \" \""),
    ("node = \"shoulder\"", "node = \"shulder\""),
    ("node = \"shoulder\"", "node = \"elbow\""),
    ("node = \"shoulder\"", "node = \"base\""),
    ("stiffness_n_per_mm = 5", "stiffness = 5"),
    ("stiffness_n_per_mm = 5", "stiffness_n_per_mm = -5"),
    ("stiffness_n_per_mm = 5\n", ""),
    ("free_length_mm = 300", "free_length_mm = -300"),
    ("free_length_mm = 300\n", ""),
    ("free_length_mm = 300", "free_length_mm = 300\nfree_length_m = 0.3"),
    ("position_mm = [200, 0, 0]", "position = [200, 0, 0]"),
    ("node = \"boom\"", "node = \"base\""),
    ("axes = \"base\"", "axes = \"world\""),
    ("axes = \"base\"\n", ""),
    ("force_n = [0, 0, -20]\n", ""),
    ("force_n = [0, 0, -20]", "force_kn = [0, 0, -0.02]"),
    ("axes = \"base\"\nforce_n", "axes = \"node\"\nmoment_n_m = [0, 0]\nforce_n"),
    ("wrench = \"hose\"\nnode = \"boom\"\naxes = \"base\"\nforce_n = [0, 0, -20]", "counterweight = \"ballast\"\nat = { node = \"tip\" }\nmass_kg = -3"),
    ("wrench = \"hose\"\nnode = \"boom\"\naxes = \"base\"\nforce_n = [0, 0, -20]", "gas_spring = \"lifter\"\nfrom = { node = \"base\" }\nto = { node = \"tip\" }\nforce_n = 200\nlength_mm = 700\nexponent = 1.2"),
    ("wrench = \"hose\"\nnode = \"boom\"\naxes = \"base\"\nforce_n = [0, 0, -20]", "gas_spring = \"lifter\"\nfrom = { node = \"base\" }\nto = { node = \"tip\" }\nforce_n = -200\nlength_mm = 700\ncolumn_mm = 900\nexponent = 1.2"),
];

#[test]
fn the_good_model_is_good() {
    match Model::from_toml(GOOD, "good.toml") {
        Ok(model) => assert!(model.warnings.is_empty(), "{}", model.warnings[0]),
        Err(error) => panic!("{error}"),
    }
}

/// Every message as the user sees it. `UPDATE_MESSAGES=1` writes the file anew; read the difference.
#[test]
fn every_mistake_has_its_message() {
    let mut found = String::new();
    for (from, to) in CASES {
        let text = message(&edited(from, to));
        assert!(
            text.contains("--> bad.toml:") && text.contains("= help: "),
            "{text}"
        );
        found.push_str(&format!("#### {from} -> {to}\n{text}\n\n"));
    }
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/model/bad_models.txt");
    if std::env::var_os("UPDATE_MESSAGES").is_some() {
        std::fs::write(path, &found).expect("written");
    }
    let expected = include_str!("bad_models.txt").replace("\r\n", "\n");
    for (found, expected) in found.split("#### ").zip(expected.split("#### ")) {
        assert_eq!(found, expected);
    }
    assert_eq!(found.len(), expected.len());
    assert!(CASES.len() >= 30);
}

#[test]
fn all_mistakes_are_shown_at_once_in_the_order_of_the_file() {
    let text = edited("length_mm = 800", "length_mm = -1")
        .replace("mass_kg = 5", "mass_kg = -5")
        .replace("to = \"tool\"\n", "to = \"tooll\"\n");
    let error = Model::from_toml(&text, "bad.toml").expect_err("three mistakes");
    let lines: Vec<_> = error
        .problems()
        .iter()
        .map(|p| (p.line, p.column))
        .collect();
    assert_eq!(
        lines,
        [
            (Some(25), Some(47)),
            (Some(28), Some(30)),
            (Some(35), Some(6))
        ]
    );
    assert_eq!(error.problems()[0].path, "chain.arm.elements[4].length_mm");
    assert!(
        error.rendered(TextStyle::Terminal).contains('\u{1b}')
            && !error.to_string().contains('\u{1b}')
    );
}

/// Every two of these mistakes, of form and of meaning, are shown together, in the order of lines.
#[test]
fn every_pair_of_mistakes_is_shown_in_one_run() {
    let text = GOOD;
    // What is written, what goes there instead, and a word of the message.
    let mistakes = [
        (
            "mass_kg = 2\n",
            "mass_kg = 2\nwait = 1\n",
            "unknown key 'wait'",
        ),
        ("length_mm = 800", "length_mm = -1", "-1"),
        ("length_mm = 800", "length_mm = \"800\"", "needs a number"),
        ("length_mm = 800", "lenght_mm = 800", "lenght_mm"),
        ("mass_kg = 5", "mass_kg = -5", "-5"),
        ("mass_kg = 5", "mass_kg = true", "needs a number"),
        ("to = \"tool\"\n", "to = \"tooll\"\n", "tooll"),
        ("youngs_modulus_gpa = 70", "youngs_modulus_gpa = -70", "-70"),
        (
            "youngs_modulus_gpa = 70",
            "youngs_modulus_gpa = [70]",
            "needs a number",
        ),
        ("youngs_modulus_gpa = 70", "", "youngs"),
        (
            "position_mm = [800, 0, 0]",
            "position_mm = [800, 0]",
            "3 entries",
        ),
    ];
    let mut pairs = 0;
    for (i, one) in mistakes.iter().enumerate() {
        for other in &mistakes[i + 1..] {
            if one.0 == other.0 {
                continue;
            }
            assert!(
                text.contains(one.0) && text.contains(other.0),
                "{one:?} {other:?}"
            );
            let bad = text.replacen(one.0, one.1, 1).replacen(other.0, other.1, 1);
            let error = Model::from_toml(&bad, "bad.toml").expect_err("two mistakes");
            for word in [one.2, other.2] {
                let shown = |p: &kinetostat_model::Problem| format!("{} {}", p.message, p.help);
                assert!(
                    error.problems().iter().any(|p| shown(p).contains(word)),
                    "{word} is missing:\n{error}"
                );
            }
            assert_eq!(error.problems().len(), 2, "{one:?} {other:?}:\n{error}");
            assert!(
                error.problems()[0].line <= error.problems()[1].line,
                "{error}"
            );
            pairs += 1;
        }
    }
    assert_eq!(pairs, 48);
}

#[test]
fn text_of_megabytes_is_not_shown_whole() {
    let long = "x".repeat(10_000_000);
    let spaced = "x y ".repeat(2_500_000);
    for text in [long, spaced] {
        for bad in [
            edited("mass_kg = 2\n", &format!("\"{text}\" = 2\n")),
            edited("name = \"tool\"\n", &format!("name = \"{text}\"\n")),
            edited("to = \"tool\"\n", &format!("to = \"{text}\"\n")),
            edited("mass_kg = 2\n", &format!("mass_kg = \"{text}\"\n")),
            edited("[[limb]]\n", &format!("[\"{text}\"]\na = 1\n[[limb]]\n")),
        ] {
            let error = Model::from_toml(&bad, "bad.toml").expect_err("a mistake");
            for shown in [error.to_string(), error.rendered(TextStyle::Terminal)] {
                assert!(shown.len() < 20_000, "{} bytes", shown.len());
            }
            for p in error.problems() {
                assert!(p.message.len() + p.help.len() + p.path.len() < 20_000);
            }
        }
    }
}

#[test]
fn too_many_mistakes_are_counted() {
    let many: String = (0..130).map(|i| format!("wrong_{i} = {i}\n")).collect();
    let error = Model::from_toml(&edited("mass_kg = 2\n", &many), "bad.toml").expect_err("wrong");
    assert_eq!(error.problems().len(), 130);
    assert!(
        error.to_string().ends_with("and 30 more problems"),
        "{error}"
    );
}

#[test]
fn long_lines_are_cut_around_the_mistake() {
    let text = edited(
        "name = \"tool\"\n",
        &format!("{}name = 5\n", " ".repeat(100_000)),
    );
    let error = Model::from_toml(&text, "bad.toml").expect_err("wrong");
    let shown = error.to_string();
    assert!(shown.contains("bad.toml:8:100008"), "{shown}");
    assert!(shown.len() < 1000 && shown.contains('…'), "{shown}");
    let text = edited(
        "name = \"tool\"\n",
        &format!("name = [\"{}\"]\n", "ü".repeat(100_000)),
    );
    let shown = message(&text);
    assert!(shown.len() < 1500, "{shown}");
}

#[test]
fn sizes_are_limited_before_anything_is_built() {
    let element = "{ passive = \"spherical\" },\n".repeat(400);
    let text = edited("  { node = \"end of boom\" },\n", &element);
    let shown = message(&text);
    assert!(
        shown.contains("joints and springs, at most 1000 are read"),
        "{shown}"
    );
    let element = "{ rigid = { } },\n".repeat(2000);
    let text = edited("  { node = \"end of boom\" },\n", &element);
    let shown = message(&text);
    assert!(
        shown.contains("needs 1 to 2000 entries, 2007 were found"),
        "{shown}"
    );
    let limbs: String = (0..250)
        .map(|i| {
            format!("[[limb]]\nname = \"l{i}\"\nfrom = \"base\"\nto = \"tool\"\nchain = \"arm\"\n")
        })
        .collect();
    let element = "{ rigid = { } },\n".repeat(100);
    let text = edited("  { node = \"end of boom\" },\n", &element)
        .replace("[[deviation]]", &format!("{limbs}\n[[deviation]]"));
    let shown = message(&text);
    assert!(shown.contains("more than 20000 elements in all"), "{shown}");
}

#[test]
fn a_command_line_names_presets_and_files() {
    assert_eq!(
        Model::open("two_link").map(|m| m.file).ok().as_deref(),
        Some("preset two_link")
    );
    let error = Model::open("two_lnik").expect_err("no preset").to_string();
    assert!(error.contains("did you mean 'two_link'?"), "{error}");
    let error = Model::open("./two_link").expect_err("no file").to_string();
    assert!(error.contains("there is no such file"), "{error}");
    let error = Model::open("arm.toml").expect_err("no file").to_string();
    assert!(
        error.contains("--> arm.toml") && error.contains("there is no such file"),
        "{error}"
    );
}

#[test]
fn a_large_file_full_of_mistakes_is_refused_soon() {
    let mut text = String::from(
        "schema = 1\n[mechanism]\nname = \"x\"\n[[platform]]\nname = \"tool\"\nhome = { }\n[[limb]]\nname = \"l\"\nfrom = \"base\"\nto = \"tool\"\nchain = \"c0\"\n",
    );
    for chain in 0..100 {
        text.push_str(&format!("[chain.c{chain}]\nelements = [\n"));
        for _ in 0..500 {
            text.push_str("{ coupled = \"q\", motion = \"revolute\", axis = \"z\", ratio = 1 },\n");
        }
        text.push_str("]\n");
    }
    let start = std::time::Instant::now();
    let error = Model::from_toml(&text, "large.toml").expect_err("wrong");
    assert!(error.problems().len() <= 110, "{}", error.problems().len());
    println!("refused in {:.1} s", start.elapsed().as_secs_f64());
}

#[test]
fn unlikely_figures_are_warnings() {
    for (from, to, message, help) in [
        (
            "youngs_modulus_gpa = 70",
            "youngs_modulus_pa = 70",
            "a Young's modulus of 70 Pa is no usual solid",
            "check the unit in the key",
        ),
        (
            "length_mm = 800",
            "length_m = 800",
            "the limb 'arm' reaches over 800 m",
            "check the units",
        ),
        (
            "[0, 0, -9.81]",
            "[0, 0, -9810]",
            "gravity is 9810 m/s^2",
            "check the unit",
        ),
        (
            "[800, 0, 0] }\nmass_kg = 2",
            "[800, 0, 0] }\nmass_kg = 2e6",
            "the platform weighs 2000000 kg",
            "check the unit",
        ),
        (
            "[800, 0, 0] }",
            "[700, 0, 0] }",
            "at home the limb 'arm' ends 100 mm and 0 deg away from the platform 'tool'",
            "home values of its joints",
        ),
        (
            "[chain.arm]",
            "[chain.old]\nelements = [{ node = \"x\" }]\n[chain.arm]",
            "nothing uses the chain 'old'",
            "remove it",
        ),
        (
            "[chain.arm]",
            "[section.old]\nround = { diameter_mm = 3 }\nyoungs_modulus_gpa = 70\npoissons_ratio = 0.3\n[chain.arm]",
            "nothing uses the section 'old'",
            "remove it",
        ),
    ] {
        let model =
            Model::from_toml(&edited(from, to), "odd.toml").unwrap_or_else(|e| panic!("{e}"));
        let found = model.warnings.iter().find(|w| w.message == message);
        let found = found.unwrap_or_else(|| panic!("{message}: {:?}", model.warnings));
        assert!(found.help.contains(help) && found.line.is_some(), "{found}");
        assert!(found.to_string().starts_with("warning: "), "{found}");
    }
}

#[test]
fn files_that_are_no_models() {
    let folder = std::env::temp_dir().join(format!("kinetostat-model-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("folder");
    let write = |name: &str, bytes: &[u8]| {
        let path = folder.join(name);
        std::fs::write(&path, bytes).expect("written");
        path
    };
    let latin1: Vec<u8> = GOOD
        .replace("name = \"arm\"\ngravity", "name = \"\u{e4}rm\"\ngravity")
        .chars()
        .map(|c| c as u32 as u8)
        .collect();
    let utf16: Vec<u8> = std::iter::once(0xfeff)
        .chain(GOOD.encode_utf16())
        .flat_map(u16::to_le_bytes)
        .collect();
    for (path, message, help) in [
        (
            folder.join("missing.toml"),
            "there is no such file",
            "kinetostat model list",
        ),
        (
            folder.clone(),
            "this is a directory",
            "name the .toml file in it",
        ),
        (
            write("empty.toml", b""),
            "the file is empty",
            "start from a preset",
        ),
        (
            write("blank.toml", b" \r\n\n"),
            "the file is empty",
            "start from a preset",
        ),
        (
            write("binary.toml", &[0x7f, b'E', b'L', b'F', 0, 0xff, 1]),
            "binary file",
            "name a model file",
        ),
        (
            write("nul.toml", b"schema = 1\0"),
            "binary file",
            "name a model file",
        ),
        (
            write("latin1.toml", &latin1),
            "not UTF-8 text: line 4 holds the byte 0xe4",
            "save it as UTF-8",
        ),
        (write("utf16.toml", &utf16), "UTF-16", "save it as UTF-8"),
        (
            write("large.toml", &vec![b'#'; 17 << 20]),
            "larger than 16 MB",
            "name a model file",
        ),
    ] {
        let error = read_model(&path).expect_err("no model").to_string();
        assert!(error.contains(message) && error.contains(help), "{error}");
        assert!(error.contains(&path.display().to_string()), "{error}");
    }
    for (name, text) in [
        ("bom.toml", format!("\u{feff}{GOOD}")),
        ("crlf.toml", GOOD.replace('\n', "\r\n")),
    ] {
        let path = write(name, text.as_bytes());
        read_model(&path).unwrap_or_else(|e| panic!("{e}"));
    }
    // Lines are counted right with both.
    let text = format!(
        "\u{feff}{}",
        edited("length_mm = 800", "lenght_mm = 800").replace('\n', "\r\n")
    );
    let error = read_model(&write("both.toml", text.as_bytes())).expect_err("wrong");
    assert_eq!(
        (error.problems()[0].line, error.problems()[0].column),
        (Some(25), Some(35))
    );
    std::fs::remove_dir_all(&folder).expect("removed");
}
