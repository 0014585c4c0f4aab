//! Controller coordinates on the command line: places by what the controller shows, two models of one machine, the
//! table of points. Poses come from a product written out here. Jogged poses are in `controller_poses`.

use crate::common::{Said, run, workplace};
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use serde_json::Value;

/// Axis before and way behind every joint, mm: an elbow arm.
const JOINTS: [(char, [f64; 3]); 6] = [
    ('z', [350.0, 0.0, 750.0]),
    ('y', [0.0, 0.0, 1250.0]),
    ('y', [300.0, 0.0, -55.0]),
    ('x', [800.0, 0.0, 0.0]),
    ('y', [150.0, 0.0, 0.0]),
    ('x', [80.0, 20.0, 0.0]),
];

fn axis(letter: char) -> Vector3<f64> {
    match letter {
        'x' => Vector3::x(),
        'y' => Vector3::y(),
        _ => Vector3::z(),
    }
}

/// The tool in the base, mm, for joints in degrees.
pub fn tool(joints: [f64; 6]) -> Isometry3<f64> {
    let each = JOINTS.iter().zip(joints);
    each.fold(Isometry3::identity(), |pose, ((letter, offset), q)| {
        pose * UnitQuaternion::from_scaled_axis(axis(*letter) * q.to_radians())
            * Translation3::new(offset[0], offset[1], offset[2])
    })
}

/// The same arm as a model; `change` rewrites the axis of a joint.
pub fn model(change: impl Fn(usize) -> String, controller: &str) -> String {
    let mut elements = String::new();
    for (i, (_, offset)) in JOINTS.iter().enumerate() {
        elements.push_str(&format!(
            "  {{ actuator = \"revolute\", name = \"joint_{}\", {}, stiffness_n_m_per_rad = 1e6 }},\n  {{ rigid = {{ translation_mm = {offset:?} }} }},\n",
            i + 1,
            change(i),
        ));
    }
    let home = tool([0.0; 6]).translation.vector;
    format!(
        "schema = 1\n[mechanism]\nname = \"arm\"\n[[platform]]\nname = \"tool\"\nhome = {{ position_mm = [{}, {}, {}] }}\n[chain.arm]\nelements = [\n{elements}]\n[[limb]]\nname = \"arm\"\nfrom = \"base\"\nto = \"tool\"\nchain = \"arm\"\n{controller}",
        home.x, home.y, home.z
    )
}

pub fn plain(i: usize) -> String {
    format!("axis = \"{}\"", JOINTS[i].0)
}

fn reversed(i: usize) -> String {
    format!("axis = \"-{}\"", JOINTS[i].0)
}

/// FANUC's third joint is shown less the second; the fourth counts the other way.
pub const CONTROLLER: &str = "
[controller]
axis = [
  { name = \"J1\", joint = \"joint_1\" },
  { name = \"J2\", joint = \"joint_2\" },
  { name = \"J3\", joint = \"joint_3\", coupled = [{ joint = \"joint_2\", ratio = -1 }] },
  { name = \"J4\", joint = \"joint_4\", reversed = true },
  { name = \"J5\", joint = \"joint_5\" },
  { name = \"J6\", joint = \"joint_6\" },
]
";

/// Poses with every joint elsewhere, degrees.
pub const POSES: [[f64; 6]; 3] = [
    [12.0, -25.0, 34.0, 41.0, -52.0, 63.0],
    [-37.0, 18.0, -23.0, -64.0, 35.0, -81.0],
    [71.0, 33.0, 12.0, 27.0, 66.0, 19.0],
];

pub const NAMES: [&str; 6] = [
    "joint_1", "joint_2", "joint_3", "joint_4", "joint_5", "joint_6",
];

#[test]
fn a_place_is_given_by_joints_of_the_model_or_of_the_controller() {
    let here = workplace();
    std::fs::write(here.path().join("arm.toml"), model(plain, CONTROLLER)).expect("written");
    let q = [10.0, 31.324, -2.018, 40.0, -50.0, 60.0];
    let joints = NAMES.iter().zip(q).map(|(n, x)| format!("{n}={x}"));
    let shown = [10.0, 31.324, -33.342, -40.0, -50.0, 60.0];
    let axes = ["J1", "J2", "J3", "J4", "J5", "J6"];
    let pendant = axes.iter().zip(shown).map(|(n, x)| format!("{n}={x}deg"));
    for (flag, words) in [
        ("--joints", joints.collect::<Vec<_>>()),
        ("--controller", vec![pendant.collect::<Vec<_>>().join(",")]),
    ] {
        for command in ["stiffness", "deflect"] {
            let mut line = vec![command, "arm.toml", "--json", flag];
            if command == "deflect" {
                line = vec![
                    command, "arm.toml", "--json", "--force", "100", "0", "0", flag,
                ];
            }
            line.extend(words.iter().map(String::as_str));
            let said = run(here.path(), &line).answered();
            let json: Value = serde_json::from_str(&said.out).expect("JSON");
            let found = &json["place"]["position_mm"];
            let expected = tool(q).translation.vector;
            for i in 0..3 {
                let difference = found[i].as_f64().expect("a number") - expected[i];
                assert!(difference.abs() < 1e-9, "{flag}: {found} {expected}");
            }
            for (axis, value) in json["pendant"].as_array().expect("axes").iter().zip(shown) {
                let difference = axis["value"].as_f64().expect("a number") - value;
                assert!(difference.abs() < 1e-9 && axis["unit"] == "deg", "{axis}");
            }
            assert!(said.err.contains("J3 -33.342 deg"), "{}", said.err);
        }
    }
    // The name of the option before is taken, and said to be old.
    let [now, before] = ["--controller", "--pendant"]
        .map(|option| run(here.path(), &["stiffness", "arm.toml", option, "J1=10"]).answered());
    assert_eq!(now.out, before.out);
    assert!(before.err.contains("--pendant is called --controller now"));
    assert!(!now.err.contains("is called"));
    // What is not named stays at home.
    let said = run(
        here.path(),
        &["stiffness", "arm.toml", "--controller", "J2=0.5rad"],
    )
    .answered();
    assert!(
        said.out.contains("J2 28.6479 deg, J3 -28.6479 deg") || said.out.contains("J3 0 deg"),
        "{}",
        said.out
    );
    for (words, needle) in [
        (["--joints", "joint_7=3"], "did you mean 'joint_"),
        (["--joints", "joint_1"], "as in J1=10"),
        (["--joints", "joint_1=3mm"], "in deg or rad"),
        (["--joints", "joint_1=1,joint_1=2"], "is given twice"),
        (["--controller", "joint_1=3"], "There are J1, J2"),
    ] {
        let said = run(here.path(), &["stiffness", "arm.toml", words[0], words[1]]);
        assert_eq!(said.code, 1, "{said:?}");
        assert!(said.err.contains(needle), "{words:?}: {said:?}");
    }
    let said = run(
        here.path(),
        &["stiffness", "heavy_6r", "--controller", "J1=3"],
    );
    assert!(said.err.contains("no [controller]"), "{said:?}");
}

fn compare(a: &str, b: &str) -> (Said, Value) {
    let here = workplace();
    std::fs::write(here.path().join("a.toml"), a).expect("written");
    std::fs::write(here.path().join("b.toml"), b).expect("written");
    let said = run(
        here.path(),
        &["model", "compare", "a.toml", "b.toml", "--json"],
    )
    .answered();
    let json = serde_json::from_str(&said.out).expect("JSON");
    (said, json)
}

#[test]
fn two_models_of_one_machine_are_mapped_on_each_other() {
    let a = model(plain, "");
    let (said, json) = compare(&a, &a);
    assert_eq!(json["same"], true, "{}", said.err);
    assert!(
        said.err.contains("all joints: the same signs and zeros"),
        "{}",
        said.err
    );
    assert!(said.err.contains("equally stiff"), "{}", said.err);
    // KUKA's way: A1, A4 and A6 count the other way; and a zero, a pedestal and a flange.
    let b = model(
        |i| {
            if [0, 3, 5].contains(&i) {
                reversed(i)
            } else {
                plain(i)
            }
        },
        "",
    );
    let (said, json) = compare(&a, &b);
    assert_eq!(json["same"], true, "{}", said.err);
    let signs: Vec<bool> = json["joints"]
        .as_array()
        .expect("joints")
        .iter()
        .map(|j| j["reversed"].as_bool().expect("yes or no"))
        .collect();
    assert_eq!(
        signs,
        [true, false, false, true, false, true],
        "{}",
        said.err
    );
    // The second joint's zero upright, the base on a pedestal, turned.
    let b = b
        .replace(
            "elements = [\n",
            "elements = [\n  { rigid = { translation_mm = [10, 20, -400], rotation_vector_deg = [0, 0, 30] } },\n",
        )
        .replace(
            "  { rigid = { translation_mm = [0.0, 0.0, 1250.0] } },",
            "  { rigid = { rotation_vector_deg = [0, 90, 0] } },\n  { rigid = { translation_mm = [0.0, 0.0, 1250.0] } },",
        );
    let (said, json) = compare(&a, &b);
    assert_eq!(json["same"], true, "{}", said.err);
    assert!(json["left_mm"].as_f64().expect("mm") < 1e-6, "{}", said.err);
    let offset = &json["joints"][1]["offset"];
    assert!(
        (offset.as_f64().expect("deg") + 90.0).abs() < 1e-6,
        "{}",
        said.err
    );
}

#[test]
fn machines_of_other_lengths_are_not_one() {
    let a = model(plain, "");
    let b = a.replace("[300.0, 0.0, -55.0]", "[310.0, 0.0, -55.0]");
    assert_ne!(a, b);
    let (said, json) = compare(&a, &b);
    assert_eq!(json["same"], false, "{}", said.err);
    let left = json["left_mm"].as_f64().expect("mm");
    assert!((0.1..12.0).contains(&left), "{}", said.err);
    assert!(
        said.err
            .contains("No constant offsets map one on the other"),
        "{}",
        said.err
    );
    let here = workplace();
    let said = run(here.path(), &["model", "compare", "heavy_6r", "orthoglide"]);
    assert_eq!(said.code, 1, "{said:?}");
    assert!(
        said.err.contains("3 that slide and 0 that turn"),
        "{said:?}"
    );
    let said = run(
        here.path(),
        &["model", "compare", "orthoglide", "orthoglide"],
    )
    .answered();
    assert!(said.out.contains("The same machine"), "{said:?}");
}

/// An arm of `../shared`, imported; `None` where it is not there.
fn imported(here: &std::path::Path, name: &str) -> Option<String> {
    let urdf = std::path::Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../../shared/data/urdf")
        .join(format!("{name}.urdf"));
    if !urdf.is_file() {
        return None;
    }
    let out = format!("{name}.toml");
    let urdf = urdf.display().to_string();
    let line = [
        "import",
        "urdf",
        &urdf,
        "--base",
        "base_link",
        "--tip",
        "tool0",
        "--joint-stiffness",
        "2e6",
        "-o",
        &out,
    ];
    run(here, &line).answered();
    Some(std::fs::read_to_string(here.join(out)).expect("a model"))
}

#[test]
fn arms_of_real_files_are_compared() {
    let here = workplace();
    let (Some(kuka), Some(_), Some(_)) = (
        imported(here.path(), "kuka_kr210l150"),
        imported(here.path(), "abb_irb6640"),
        imported(here.path(), "abb_irb6640_185_280"),
    ) else {
        println!("SKIPPED: there is no ../shared/data/urdf");
        return;
    };
    // KUKA counts A1, A4 and A6 the other way; the zeros of A2 and A3 are upright.
    let mut changed = String::new();
    for line in kuka.lines() {
        let mut line = line.to_owned();
        let turned = ["joint_a1", "joint_a4", "joint_a6"];
        if turned
            .iter()
            .any(|j| line.contains(&format!("name = \"{j}\",")))
        {
            line = match line.contains("axis = \"-") {
                true => line.replace("axis = \"-", "axis = \""),
                false => line.replace("axis = \"", "axis = \"-"),
            };
        }
        for (joint, turn) in [("joint_a2", 90), ("joint_a3", -90)] {
            if line.contains("actuator") && line.contains(&format!("name = \"{joint}\",")) {
                line =
                    format!("  {{ rigid = {{ rotation_vector_deg = [0, {turn}, 0] }} }},\n{line}");
            }
        }
        changed.push_str(&line);
        changed.push('\n');
    }
    // Limits are those of the other way of counting: they do not matter here.
    let bare = |text: &str| -> String {
        text.lines()
            .map(|l| match (l.find(", limits_rad"), l.rfind(" }")) {
                (Some(from), Some(to)) => format!("{}{}\n", &l[..from], &l[to..]),
                _ => format!("{l}\n"),
            })
            .collect()
    };
    std::fs::write(here.path().join("a.toml"), bare(&kuka)).expect("written");
    std::fs::write(here.path().join("b.toml"), bare(&changed)).expect("written");
    let said = run(
        here.path(),
        &["model", "compare", "a.toml", "b.toml", "--json"],
    )
    .answered();
    let json: Value = serde_json::from_str(&said.out).expect("JSON");
    assert_eq!(json["same"], true, "{}", said.err);
    assert!(json["left_mm"].as_f64().expect("mm") < 1e-6, "{}", said.err);
    let found: Vec<(bool, f64)> = json["joints"]
        .as_array()
        .expect("joints")
        .iter()
        .map(|j| {
            let offset = j["offset"].as_f64().expect("deg");
            (j["reversed"].as_bool().expect("yes or no"), offset)
        })
        .collect();
    let expected = [
        (true, 0.0),
        (false, -90.0),
        (false, 90.0),
        (true, 0.0),
        (false, 0.0),
        (true, 0.0),
    ];
    for (found, expected) in found.iter().zip(expected) {
        assert!(
            found.0 == expected.0 && (found.1 - expected.1).abs() < 1e-6,
            "{}",
            said.err
        );
    }
    // Two variants of one series have arms of different lengths.
    let line = [
        "model",
        "compare",
        "abb_irb6640.toml",
        "abb_irb6640_185_280.toml",
    ];
    let said = run(here.path(), &line).answered();
    assert!(
        said.out
            .contains("No constant offsets map one on the other"),
        "{}",
        said.out
    );
}

/// The table of points: joint values as commanded, pendant values by the declared map, and few bytes a cell.
#[test]
fn the_table_of_points_has_controller_coordinates() {
    let here = workplace();
    let at = [10.0, 20.0, 30.0, 15.0, -40.0, 25.0];
    let pose = tool(at);
    let turn = pose.rotation.scaled_axis();
    let p = pose.translation.vector;
    std::fs::write(here.path().join("arm.toml"), model(plain, CONTROLLER)).expect("a model");
    let mut program = String::from("G21 G90\nG0 X0 Y0 Z5\nG1 Z-1 F300\n");
    for i in 0..120 {
        let angle = f64::from(i) * 0.2;
        program.push_str(&format!(
            "G1 X{:.3} Y{:.3} F600\n",
            25.0 * angle.cos(),
            17.3 * (1.3 * angle).sin()
        ));
    }
    std::fs::write(here.path().join("part.ngc"), program).expect("a program");
    let job = format!(
        "schema = 1\nmodel = \"arm.toml\"\nprogram = \"part.ngc\"\n[placement]\npart_origin_mm = [{}, {}, {}]\ntool_orientation = {{ rotation_vector_rad = [{}, {}, {}] }}\n[load]\nforce_n = [120, -40, 60]\n[output]\nprogram = \"out.ngc\"\npoints = \"p.csv\"\n",
        p.x, p.y, p.z, turn.x, turn.y, turn.z
    );
    std::fs::write(here.path().join("job.toml"), job).expect("a job");
    run(here.path(), &["compensate", "job.toml"]).answered();
    let text = std::fs::read_to_string(here.path().join("p.csv")).expect("a table");
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().expect("names").split(',').collect();
    let column = |name: &str| {
        header
            .iter()
            .position(|h| *h == name)
            .unwrap_or_else(|| panic!("{name}: {header:?}"))
    };
    let joints: Vec<usize> = (1..=6)
        .map(|i| column(&format!("joint_{i}_command_deg")))
        .collect();
    let shown: Vec<usize> = (1..=6)
        .map(|i| column(&format!("pendant_J{i}_deg")))
        .collect();
    let mut rows = 0;
    for line in lines {
        let cells: Vec<&str> = line.split(',').collect();
        let read = |at: usize| cells[at].parse::<f64>().expect("a number");
        let q: Vec<f64> = joints.iter().map(|at| read(*at)).collect();
        // J3 is shown less the second, J4 the other way round.
        let expected = [q[0], q[1], q[2] - q[1], -q[3], q[4], q[5]];
        for (at, expected) in shown.iter().zip(expected) {
            assert!((read(*at) - expected).abs() < 2e-5, "{line}");
        }
        // Every joint stands near where the product written out above has it.
        for (q, near) in q.iter().zip(at) {
            assert!((q - near).abs() < 15.0, "{line}");
        }
        let place: Vec<f64> = ["x_mm", "y_mm", "z_mm"]
            .iter()
            .map(|name| read(column(name)))
            .collect();
        let correction: Vec<f64> = ["x", "y", "z"]
            .iter()
            .map(|axis| read(column(&format!("correction_{axis}_mm"))))
            .collect();
        let joints: [f64; 6] = q.clone().try_into().expect("six");
        let reached = tool(joints).translation.vector - p;
        for k in 0..3 {
            let off = reached[k] - place[k] - correction[k];
            assert!(off.abs() < 5e-3, "{off}: {line}");
        }
        rows += 1;
    }
    assert!(rows > 100, "{rows}");
    // The share of a table below 8 MB: at most nine bytes a cell on the average, the comma included.
    let cells = header.len() * (rows + 1);
    assert!(
        text.len() <= 9 * cells,
        "{} bytes in {cells} cells",
        text.len()
    );
}
