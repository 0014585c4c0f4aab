//! Files that are wrong: each is refused in words, with line, column, element and what to do, and
//! without using much memory.

use std::time::Instant;

use kinetostat_import::{
    JointStiffness, LoopFile, MOST_URDF_BYTES, UrdfOptions, import_urdf, read_text,
};

use crate::between;

/// Two links and a tip: right.
const GOOD: &str = r#"<?xml version="1.0"?>
<robot name="r">
  <link name="base"/>
  <link name="arm">
    <inertial><origin xyz="0.5 0 0"/><mass value="12"/><inertia ixx="0.1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
  </link>
  <link name="tool"/>
  <joint name="shoulder" type="revolute">
    <origin xyz="0 0 1" rpy="0 0 0"/>
    <parent link="base"/>
    <child link="arm"/>
    <axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
  <joint name="slide" type="prismatic">
    <origin xyz="1 0 0"/>
    <parent link="arm"/>
    <child link="tool"/>
    <axis xyz="1 0 0"/>
    <limit lower="0" upper="0.5" effort="1" velocity="1"/>
  </joint>
</robot>
"#;

fn refused(text: &str) -> String {
    match import_urdf(text, "broken.urdf", &between("base", "tool")) {
        Ok(_) => panic!("imported: {text:.400}"),
        Err(e) => e.to_string(),
    }
}

/// What is replaced, by what, what the message must hold, and the line that it must name.
const EDITS: &[(&str, &str, &str, usize)] = &[
    // The tree.
    (
        "<parent link=\"base\"/>",
        "<parent link=\"tool\"/>",
        "go in a circle",
        4,
    ),
    (
        "<child link=\"tool\"/>",
        "<child link=\"arm\"/>",
        "joins 'arm' to itself",
        15,
    ),
    (
        "<parent link=\"arm\"/>",
        "<parent link=\"elbow\"/>",
        "there is no link 'elbow'",
        17,
    ),
    (
        "<child link=\"tool\"/>",
        "<child link=\"tol\"/>",
        "did you mean 'tool'?",
        18,
    ),
    (
        "<link name=\"tool\"/>",
        "<link name=\"tool\"/><link name=\"stray\"/>",
        "2 links without a parent: 'base', 'stray'",
        7,
    ),
    (
        "<link name=\"tool\"/>",
        "<link name=\"arm\"/>",
        "another link of this name",
        7,
    ),
    (
        "name=\"slide\"",
        "name=\"shoulder\"",
        "another joint of this name",
        15,
    ),
    (
        "<link name=\"tool\"/>",
        "<link name=\"tool\"/><joint name=\"loop\" type=\"fixed\"><parent link=\"base\"/><child link=\"tool\"/></joint>",
        "already the child of the joint",
        18,
    ),
    ("<parent link=\"base\"/>", "", "<parent> is missing", 8),
    (
        "<child link=\"arm\"/>",
        "<child/>",
        "the link is not named",
        11,
    ),
    (
        "<child link=\"arm\"/>",
        "<child link=\"arm\"/><child link=\"tool\"/>",
        "<child> is written twice",
        11,
    ),
    // Numbers.
    (
        "<axis xyz=\"0 1 0\"/>",
        "<axis xyz=\"0 0 0\"/>",
        "the axis has no direction",
        12,
    ),
    (
        "<axis xyz=\"0 1 0\"/>",
        "<axis xyz=\"0 1\"/>",
        "needs three numbers",
        12,
    ),
    (
        "<axis xyz=\"0 1 0\"/>",
        "<axis xyz=\"0,1,0\"/>",
        "spaces between them",
        12,
    ),
    (
        "<axis xyz=\"0 1 0\"/>",
        "<axis xyz=\"0 NaN 0\"/>",
        "the value is NaN",
        12,
    ),
    ("ixx=\"0.1\"", "ixx=\"nan\"", "the value is NaN", 5),
    ("izz=\"1\"", "", "the attribute 'izz' is missing", 5),
    ("value=\"12\"", "value=\"-12\"", "the mass is -12 kg", 5),
    ("value=\"12\"", "value=\"inf\"", "the value is inf", 5),
    ("value=\"12\"", "value=\"12 kg\"", "'12 kg' is no number", 5),
    ("value=\"12\"", "value=\"${m}\"", "xacro expression", 5),
    ("<mass value=\"12\"/>", "", "the mass is missing", 5),
    ("xyz=\"0 0 1\"", "xyz=\"0 0 1e400\"", "the value is inf", 9),
    ("rpy=\"0 0 0\"", "rpy=\"0 0 pi\"", "'pi' is no number", 9),
    (
        "lower=\"-1\" upper=\"1\"",
        "lower=\"1\" upper=\"-1\"",
        "is above the upper limit",
        13,
    ),
    // Words.
    (
        "type=\"revolute\"",
        "type=\"revolut\"",
        "did you mean 'revolute'?",
        8,
    ),
    (
        "type=\"revolute\"",
        "type=\"screw\"",
        "the type 'screw' is unknown",
        8,
    ),
    ("type=\"revolute\"", "", "the type is missing", 8),
    (
        "type=\"revolute\"",
        "type=\"floating\"",
        "a floating joint lies between",
        8,
    ),
    (
        "type=\"prismatic\"",
        "type=\"planar\"",
        "a planar joint lies between",
        15,
    ),
    (
        "<origin xyz=\"0 0 1\" rpy",
        "<orign xyz=\"0 0 1\" rpy",
        "did you mean <origin>?",
        9,
    ),
    (
        "xyz=\"0 0 1\" rpy",
        "xzy=\"0 0 1\" rpy",
        "did you mean 'xyz'?",
        9,
    ),
    (
        "<joint name=\"slide\"",
        "<joint",
        "this joint has no name",
        15,
    ),
    (
        "<link name=\"tool\"/>",
        "<link/>",
        "this link has no name",
        7,
    ),
    (
        "name=\"arm\"",
        "name=\" arm\"",
        "begins or ends with a space",
        4,
    ),
    // Mimic joints.
    (
        "<axis xyz=\"1 0 0\"/>",
        "<axis xyz=\"1 0 0\"/><mimic joint=\"sholder\"/>",
        "did you mean 'shoulder'?",
        19,
    ),
    (
        "<axis xyz=\"1 0 0\"/>",
        "<axis xyz=\"1 0 0\"/><mimic joint=\"slide\"/>",
        "follows itself",
        19,
    ),
    (
        "<axis xyz=\"1 0 0\"/>",
        "<axis xyz=\"1 0 0\"/><mimic/>",
        "is not named",
        19,
    ),
    (
        "<axis xyz=\"1 0 0\"/>",
        "<axis xyz=\"1 0 0\"/><mimic joint=\"shoulder\" multiplier=\"NaN\"/>",
        "the value is NaN",
        19,
    ),
    // XML.
    ("</robot>", "", "before <robot> is closed", 21),
    ("</joint>\n  <joint", "\n  <joint", "is needed", 22),
    (
        "name=\"tool\"",
        "name=\"tool\" name=\"tool\"",
        "is written twice",
        7,
    ),
    (
        "name=\"tool\"",
        "name=\"&tool;\"",
        "&tool; is not defined",
        7,
    ),
    (
        "<link name=\"tool\"/>",
        "<link name=\"tool\">",
        "is needed",
        22,
    ),
    (
        "<robot name=\"r\">",
        "<robot name=\"r\"><xacro:include filename=\"a\"/>",
        "expand it first: xacro broken.urdf > broken_expanded.urdf",
        2,
    ),
    (
        "<link name=\"tool\"/>",
        "<link name=\"tool\"><xacro:mass xmlns:xacro=\"http://www.ros.org/wiki/xacro\"/></link>",
        "this is a xacro file",
        7,
    ),
    (
        "<robot name=\"r\">",
        "<robot name=\"r\" xmlns:xacro=\"http://www.ros.org/wiki/xacro\"><xacro:property name=\"a\"/>",
        "this is a xacro file",
        2,
    ),
    (
        "<robot name=\"r\">",
        "<!DOCTYPE robot><robot name=\"r\">",
        "document type definition",
        2,
    ),
];

#[test]
fn figure_broken_files_are_refused_with_line_and_advice() {
    for (from, to, needle, line) in EDITS {
        let wrong = GOOD.replacen(from, to, 1);
        assert_ne!(wrong, GOOD, "{from}");
        let said = refused(&wrong);
        assert!(
            said.contains(needle),
            "{from} -> {to}: '{needle}' is not in\n{said}"
        );
        assert!(
            said.contains(&format!("broken.urdf:{line}:")),
            "{from} -> {to}: line {line} is not in\n{said}"
        );
        assert!(said.contains("help: "), "{said}");
    }
    crate::figure_at_least(
        "URDF: broken files refused with line, element and advice",
        EDITS.len(),
        30,
    );
}

#[test]
fn the_good_one_is_good() {
    let imported = crate::import(GOOD, &between("base", "tool"));
    assert_eq!(imported.actuators, ["shoulder", "slide"]);
    // A platform may not be called like the base, a body not like the tip.
    let renamed = GOOD
        .replace("\"base\"", "\"x\"")
        .replace("\"tool\"", "\"base\"")
        .replace("\"arm\"", "\"tip\"")
        .replace("\"shoulder\"", "\"start\"");
    let imported = crate::import(&renamed, &between("x", "base"));
    assert_eq!(imported.actuators.len(), 2);
}

#[test]
fn mimic_joints_that_follow_each_other_are_refused() {
    let wrong = GOOD
        .replace(
            "<axis xyz=\"1 0 0\"/>",
            "<axis xyz=\"1 0 0\"/><mimic joint=\"shoulder\"/>",
        )
        .replace(
            "<axis xyz=\"0 1 0\"/>",
            "<axis xyz=\"0 1 0\"/><mimic joint=\"slide\"/>",
        );
    let said = refused(&wrong);
    assert!(said.contains("follow each other in a circle"), "{said}");
}

#[test]
fn a_xacro_file_is_refused_with_the_command_that_expands_it() {
    let text = GOOD.replace(
        "<robot name=\"r\">",
        "<robot name=\"r\" xmlns:xacro=\"http://ros.org/wiki/xacro\"><xacro:include filename=\"a.xacro\"/>",
    );
    for (file, command) in [
        ("arm.urdf.xacro", "xacro arm.urdf.xacro > arm.urdf"),
        ("arm.xacro", "xacro arm.xacro > arm.urdf"),
        ("arm.urdf", "xacro arm.urdf > arm_expanded.urdf"),
    ] {
        for text in [
            text.clone(),
            GOOD.replace("value=\"12\"", "value=\"${mass}\""),
        ] {
            let refused = import_urdf(&text, file, &between("base", "tool"));
            let said = refused.unwrap_err().to_string();
            assert!(said.contains(command), "{said}");
        }
    }
    // The name of the space alone, as files have it that were expanded.
    let plain = text.replace("<xacro:include filename=\"a.xacro\"/>", "");
    assert!(import_urdf(&plain, "arm.urdf", &between("base", "tool")).is_ok());
}

#[test]
fn other_formats_are_named() {
    for (text, needle) in [
        ("", "the file is empty"),
        ("  \n", "the file is empty"),
        ("schema = 1\n[mechanism]\n", "this is no XML"),
        ("<sdf version='1.9'><model name='a'/></sdf>", "this is SDF"),
        ("<mujoco/>", "this is MJCF"),
        ("<html></html>", "not <robot>"),
        ("<robot name='r'/>", "has no links"),
        (
            "<robot name='r'><joint name='a' type='fixed'><parent link='b'/><child link='c'/></joint></robot>",
            "has no links",
        ),
    ] {
        let said = refused(text);
        assert!(said.contains(needle), "{needle}: {said}");
    }
}

#[test]
fn the_wrong_ends_are_refused() {
    for (base, tip, needle) in [
        ("bas", "tool", "did you mean 'base'?"),
        ("base", "flange", "there is no link 'flange'"),
        ("base", "base", "nothing moves between"),
    ] {
        let said = import_urdf(GOOD, "good.urdf", &between(base, tip))
            .unwrap_err()
            .to_string();
        assert!(said.contains(needle), "{needle}: {said}");
    }
    let branched = GOOD.replace(
        "</robot>",
        "<link name='side'/><joint name='s' type='fixed'><parent link='arm'/><child link='side'/></joint></robot>",
    );
    let said = import_urdf(&branched, "good.urdf", &UrdfOptions::default())
        .unwrap_err()
        .to_string();
    assert!(said.contains("'tool', 'side'"), "{said}");
}

/// A text of a billion characters in 1 kB.
fn entity_bomb() -> String {
    let mut text = String::from("<!DOCTYPE r [<!ENTITY a0 \"aaaaaaaaaa\">");
    for k in 1..10 {
        let before = format!("&a{};", k - 1).repeat(10);
        text.push_str(&format!("<!ENTITY a{k} \"{before}\">"));
    }
    text + "]><robot name='&a9;'><link name='a'/></robot>"
}

/// Most memory that this process has held, bytes; zero where that cannot be read.
fn memory() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find(|l| l.starts_with("VmHWM:"));
    line.and_then(|l| l.split_whitespace().nth(1)?.parse().ok())
        .map_or(0, |kb: u64| kb * 1024)
}

#[test]
fn figure_bombs_are_refused_quickly_and_in_bounded_memory() {
    let many = 8_000_000 / 4;
    let bombs: [(&str, String, &str); 8] = [
        ("entities", entity_bomb(), "document type definition"),
        (
            "an external entity",
            "<!DOCTYPE r SYSTEM 'file:///etc/passwd'><robot name='r'/>".into(),
            "document type definition",
        ),
        (
            "depth",
            format!("<robot name='r'>{}", "<a>".repeat(many / 2)),
            "deep in each other",
        ),
        (
            "elements",
            format!("<robot name='r'>{}</robot>", "<a/>".repeat(many - 10)),
            "more than 200000 elements",
        ),
        (
            "attributes",
            format!(
                "<robot name='r' {}></robot>",
                (0..300_000)
                    .map(|i| format!("a{i}='' "))
                    .collect::<String>()
            ),
            "this tag is longer than",
        ),
        (
            "an open quote",
            format!("<robot name='{}", "r".repeat(7_000_000)),
            "this tag is longer than",
        ),
        (
            "links",
            format!(
                "<robot name='r'>{}</robot>",
                (0..50_000)
                    .map(|i| format!("<link name='l{i}'/>"))
                    .collect::<String>()
            ),
            "more than 1000 links",
        ),
        (
            "size",
            format!(
                "<robot name='r'>{}</robot>",
                " ".repeat(MOST_URDF_BYTES as usize)
            ),
            "larger than 8 MB",
        ),
    ];
    for (name, text, needle) in bombs {
        let clock = Instant::now();
        let said = refused(&text);
        assert!(said.contains(needle), "{name}: {said:.600}");
        assert!(
            said.len() < 10_000,
            "{name}: the message has {} bytes",
            said.len()
        );
        println!(
            "{name}: {} kB refused in {:.2} s",
            text.len() >> 10,
            clock.elapsed().as_secs_f64()
        );
    }
    crate::figure_at_most(
        "URDF: most memory of the process that refuses bombs of 8 MB",
        memory() as f64 / 1e6,
        1000.0,
        "MB",
    );
}

#[test]
fn a_file_of_200_mb_is_refused_before_it_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("large.urdf");
    // A file with a hole: it takes no room on disk.
    let file = std::fs::File::create(&path).unwrap();
    file.set_len(200 << 20).unwrap();
    let clock = Instant::now();
    let said = read_text("URDF file", &path).unwrap_err().to_string();
    assert!(
        said.contains("209.7 MB, more than 8 MB are not read"),
        "{said}"
    );
    println!("200 MB: refused in {:.3} s", clock.elapsed().as_secs_f64());
    let bytes: [(&[u8], &str); 3] = [
        (&[0xff, 0xfe, 0x3c, 0], "UTF-16"),
        (b"<robot\0>", "binary"),
        (b"<robot>\n\xe4</robot>", "line 2 is not UTF-8"),
    ];
    for (bytes, needle) in bytes {
        std::fs::write(&path, bytes).unwrap();
        let said = read_text("URDF file", &path).unwrap_err().to_string();
        assert!(said.contains(needle), "{said}");
    }
    for (path, needle) in [("none.urdf", "no such file"), (".", "this is no file")] {
        let said = read_text("URDF file", &folder.path().join(path))
            .unwrap_err()
            .to_string();
        assert!(said.contains(needle), "{said}");
    }
}

#[test]
fn tables_of_stiffnesses_that_are_wrong() {
    for (text, needle) in [
        ("", "the table is empty"),
        (
            "joint,k\nshoulder,1\n",
            "the first line is not 'name,value,unit'",
        ),
        ("name,value,unit\nshoulder,1\n", "three fields"),
        (
            "name,value,unit\nshoulder,-1,N m/rad\n",
            "no number above zero",
        ),
        (
            "name,value,unit\nshoulder,NaN,N m/rad\n",
            "no number above zero",
        ),
        (
            "name,value,unit\nshoulder,1,kg\n",
            "the unit 'kg' is unknown",
        ),
        ("name,value,unit\nshoulder,1,N/m\n", "the unit does not fit"),
        (
            "name,value,unit\nsholder,1,N m/rad\n",
            "did you mean 'shoulder'?",
        ),
        (
            "name,value,unit\nshoulder,1,N m/rad\nshoulder,1,N m/rad\n",
            "written twice",
        ),
    ] {
        let options = {
            let mut options = between("base", "tool");
            options.stiffness = JointStiffness::Table {
                file: "k.csv".into(),
                text: text.into(),
            };
            options
        };
        let said = import_urdf(GOOD, "good.urdf", &options)
            .unwrap_err()
            .to_string();
        assert!(said.contains(needle), "{needle}: {said}");
        assert!(said.contains("k.csv"), "{said}");
    }
}

#[test]
fn loop_files_that_are_wrong() {
    let right = "schema = 1\npassive = [\"slide\"]\n[[constraint]]\nname = \"c\"\ntype = \"revolute\"\nparent = { link = \"tool\", axis = [0, 1, 0] }\nchild = { link = \"base\", origin_m = [1, 0, 1] }\n";
    for (from, to, needle) in [
        ("schema = 1", "schema = 2", "version 2"),
        ("schema = 1", "scheme = 1", "no loop file"),
        ("\"slide\"", "\"slid\"", "did you mean 'slide'?"),
        (
            "\"revolute\"",
            "\"fixed\"",
            "cannot be closed by a fixed joint",
        ),
        ("\"revolute\"", "\"weld\"", "this closing joint is unknown"),
        ("[0, 1, 0]", "[0, 0, 0]", "no direction"),
        ("[1, 0, 1]", "[1, 0, nan]", "not finite"),
        ("[1, 0, 1]", "[1, 0, 9]", "the loops stay open"),
        ("\"tool\"", "\"tol\"", "did you mean 'tool'?"),
        ("\"base\"", "\"tool\"", "fixed to each other"),
        (
            "name = \"c\"",
            "name = \"slide\"",
            "another joint or constraint",
        ),
        (
            "passive = [\"slide\"]",
            "home_rad = { slide = 0.1 }",
            "under home_rad",
        ),
        (
            "passive = [\"slide\"]",
            "home_m = { slide = 7.0 }",
            "outside the limits",
        ),
    ] {
        let wrong = right.replacen(from, to, 1);
        assert_ne!(wrong, right, "{from}");
        let options = {
            let mut options = between("base", "tool");
            options.loops = Some(LoopFile {
                file: "loops.toml".into(),
                text: wrong,
            });
            options
        };
        let said = import_urdf(GOOD, "good.urdf", &options)
            .unwrap_err()
            .to_string();
        assert!(said.contains(needle), "{needle}: {said}");
    }
}

#[test]
fn a_long_chain_is_imported_in_reasonable_time() {
    let mut text = String::from("<robot name='snake'><link name='l0'/>");
    for i in 1..400 {
        let before = i - 1;
        text.push_str(&format!(
            "<link name='l{i}'><inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link>
             <joint name='j{i}' type='continuous'><origin xyz='0.1 0 0'/><parent link='l{before}'/><child link='l{i}'/><axis xyz='0 1 0'/></joint>
             <link name='s{i}'><inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link>
             <joint name='k{i}' type='fixed'><origin xyz='0 0.1 0'/><parent link='l{i}'/><child link='s{i}'/></joint>"
        ));
    }
    text.push_str("</robot>");
    let clock = Instant::now();
    let imported = import_urdf(&text, "snake.urdf", &between("l0", "l399")).unwrap();
    assert_eq!(
        (imported.actuators.len(), imported.bodies.len()),
        (399, 798)
    );
    println!("399 joints: {:.1} s", clock.elapsed().as_secs_f64());
}

#[test]
fn damaged_files_never_panic() {
    let mut random = crate::Random::new(3);
    let mut below = |n: usize| (0.5 * (random.number() + 1.0) * n as f64) as usize;
    let (mut imported, mut refused) = (0, 0);
    let snippets = [
        "",
        "\"",
        "<",
        ">",
        "/",
        "nan",
        "-1",
        "1e300",
        "0",
        "tool",
        "base",
        "fixed",
        "floating",
        "<mimic joint=\"lift\"/>",
        "<limit lower=\"1\" upper=\"1\"/>",
        "&amp;",
        "\u{fffd}",
        "prismatic",
    ];
    for round in 0..4000 {
        let original = if round % 2 == 0 {
            GOOD
        } else {
            crate::agreement::TREE
        };
        let tip = if round % 2 == 0 { "tool" } else { "hand" };
        let mut text: Vec<char> = original.chars().collect();
        for _ in 0..=below(2) {
            let start = below(text.len());
            let end = (start + below(12)).min(text.len());
            let piece = snippets[below(snippets.len())];
            text.splice(start..end, piece.chars());
        }
        let text: String = text.into_iter().collect();
        let options = {
            let mut options = UrdfOptions::default();
            options.tip = Some(tip.into());
            options
        };
        match import_urdf(&text, "damaged.urdf", &options) {
            Ok(_) => imported += 1,
            Err(e) => {
                refused += 1;
                let said = e.to_string();
                assert!(!said.contains("please report"), "{text}\n{said}");
                assert!(!said.contains("the imported model"), "{text}\n{said}");
            }
        }
    }
    println!("{imported} imported, {refused} refused");
    assert!(imported > 100 && refused > 100);
}
