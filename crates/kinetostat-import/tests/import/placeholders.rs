//! What looks wrong but can be imported is noticed in words.

use crate::{between, import, notices};

/// An arm of three links with these inertials.
fn arm(inertials: [&str; 3]) -> String {
    let mut text = String::from("<robot name='r'><link name='l0'/>");
    for (i, inertial) in inertials.iter().enumerate() {
        let (a, b) = (i, i + 1);
        text.push_str(&format!(
            "<link name='l{b}'>{inertial}<visual><geometry><mesh filename='package://m/{b}.stl'/></geometry></visual></link>
             <joint name='j{b}' type='revolute'><origin xyz='0.5 0 0'/><parent link='l{a}'/><child link='l{b}'/>
             <axis xyz='0 1 0'/><limit lower='-1' upper='1' effort='1' velocity='1'/></joint>"
        ));
    }
    text + "</robot>"
}

fn inertial(mass: f64, i: f64) -> String {
    format!(
        "<inertial><origin xyz='0.2 0 0'/><mass value='{mass}'/><inertia ixx='{i}' ixy='0' ixz='0' iyy='{i}' iyz='0' izz='{i}'/></inertial>"
    )
}

#[test]
fn inertials_that_were_never_meant() {
    let good = [inertial(20.0, 0.4), inertial(12.0, 0.2), inertial(8.0, 0.1)];
    let with = |k: usize, text: &str| {
        let mut all: Vec<&str> = good.iter().map(String::as_str).collect();
        all[k] = text;
        notices(&import(
            &arm([all[0], all[1], all[2]]),
            &between("l0", "l3"),
        ))
    };
    let plain = with(0, &good[0]);
    for word in ["placeholder", "weigh", "mass", "unit matrix"] {
        assert!(!plain.contains(word), "{word}: {plain}");
    }
    for (text, needle) in [
        (inertial(0.0, 0.0), "the mass is zero"),
        (inertial(20.0, 1.0), "the inertia is the unit matrix"),
        (inertial(4e4, 100.0), "much for an arm of"),
        (inertial(20.0, 4e5), "check its unit: kg m^2"),
        (String::new(), "links with a shape but without a mass: 'l1'"),
        (
            inertial(20.0, 0.4).replace("0.2 0 0", "200 0 0"),
            "are these millimetres?",
        ),
        (
            inertial(20.0, 0.4).replace("izz='0.4'", "izz='4'"),
            "no rigid body has this inertia",
        ),
        // A ten-thousandth too large.
        (
            inertial(20.0, 0.4).replace("izz='0.4'", "izz='0.80008'"),
            "no rigid body has this inertia",
        ),
        (
            inertial(20.0, 0.4).replace("izz='0.4'", "izz='-0.4'"),
            "one is below zero",
        ),
        (
            inertial(20.0, 0.4).replace("ixy='0'", "ixy='7'"),
            "the model is written without it",
        ),
        (
            "<inertial><mass value='20'/></inertial>".into(),
            "the inertia is missing",
        ),
    ] {
        let said = with(0, &text);
        assert!(said.contains(needle), "{needle}: {said}");
    }
    let same = inertial(2.0, 0.01);
    let said = notices(&import(&arm([&same, &same, &same]), &between("l0", "l3")));
    assert!(
        said.contains("all 3 bodies of this limb have the same mass, 2 kg"),
        "{said}"
    );
}

#[test]
fn implausible_units() {
    let none = arm(["", "", ""]);
    for (from, to, needle) in [
        ("xyz='0.5 0 0'", "xyz='500 0 0'", "are these millimetres?"),
        (
            "<origin xyz='0.5 0 0'/>",
            "<origin xyz='0.5 0 0' rpy='0 90 0'/>",
            "are these degrees?",
        ),
        (
            "lower='-1' upper='1'",
            "lower='-180' upper='180'",
            "are these degrees?",
        ),
        (
            "xyz='0 1 0'",
            "xyz='0 2 0'",
            "the axis has the length 2.0000",
        ),
        ("lower='-1' upper='1'", "", "are missing"),
        (
            "<limit lower='-1' upper='1' effort='1' velocity='1'/>",
            "",
            "there is no <limit>",
        ),
        (
            "lower='-1' upper='1'",
            "lower='0' upper='0'",
            "the joint does not move",
        ),
    ] {
        let wrong = none.replacen(from, to, 1);
        assert_ne!(wrong, none);
        let said = notices(&import(&wrong, &between("l0", "l3")));
        assert!(said.contains(needle), "{needle}: {said}");
    }
}

/// A single odd offset is noticed; an arm of kilometres is refused.
#[test]
fn an_arm_in_millimetres_is_refused() {
    let text = arm(["", "", ""]);
    let millimetres = text.replace("xyz='0.5 0 0'", "xyz='700 0 0'");
    assert_ne!(millimetres, text);
    let said = kinetostat_import::import_urdf(&millimetres, "mm.urdf", &between("l0", "l3"))
        .expect_err("millimetres")
        .to_string();
    assert!(said.contains("divide all lengths by 1000"), "{said}");
}

#[test]
fn what_neither_moves_nor_bends_is_skipped_aloud() {
    let extras = "<material name='m'><color rgba='1 0 0 1'/></material><transmission name='t'><type>x</type></transmission>
        <gazebo reference='l1'/><ros2_control name='c' type='system'/><frobnicator/></robot>";
    let text = arm(["", "", ""]).replace("</robot>", extras);
    let said = notices(&import(&text, &between("l0", "l3")));
    for needle in [
        "<material> 1x",
        "<transmission> 1x",
        "<gazebo> 1x",
        "<ros2_control> 1x",
        "<visual> 3x",
        "the element <frobnicator> is not read",
    ] {
        assert!(said.contains(needle), "{needle}: {said}");
    }
}

#[test]
fn limits_of_followers_hold_for_their_leaders() {
    let text = arm(["", "", ""]);
    let follower = "<link name='f'/><joint name='jf' type='revolute'><parent link='l1'/><child link='f'/><axis xyz='0 1 0'/>
        <limit lower='-0.8' upper='0.4' effort='1' velocity='1'/><mimic joint='j2' multiplier='-2' offset='0.1'/></joint></robot>";
    let imported = import(&text.replace("</robot>", follower), &between("l0", "l3"));
    let said = notices(&imported);
    assert!(said.contains("narrower than those of 'j2'"), "{said}");
    let limits = imported.model.mechanism.limbs()[0].nominal.actuators()[1].limits;
    let (low, high) = limits.unwrap_or_default();
    // -0.8 = -2 q + 0.1 and 0.4 = -2 q + 0.1.
    assert!(
        (low + 0.15).abs() < 1e-12 && (high - 0.45).abs() < 1e-12,
        "{low} {high}"
    );
}

/// Noise of programs that compute: no inertia at all, moments a hair below zero, a hair above the sum of the others.
#[test]
fn inertias_that_were_rounded_are_not_judged() {
    for (ixx, ixz, izz) in [
        ("0", "1.35525e-20", "0"),
        ("-3e-7", "0", "0.4"),
        ("0.4", "0", "0.8000004"),
    ] {
        let noisy = inertial(20.0, 0.4)
            .replace("ixx='0.4'", &format!("ixx='{ixx}'"))
            .replace("ixz='0'", &format!("ixz='{ixz}'"))
            .replace("izz='0.4'", &format!("izz='{izz}'"));
        let noisy = match ixz {
            "0" => noisy,
            _ => noisy.replace("iyy='0.4'", "iyy='0'"),
        };
        let imported = import(&arm([&noisy, "", ""]), &between("l0", "l3"));
        let said = notices(&imported);
        assert!(!said.contains("has this inertia"), "{said}");
        assert!(!said.contains("that of no body"), "{said}");
        let has = imported.toml.contains("inertia_kg_m2 = ");
        assert_eq!(has, ixz == "0", "{}", imported.toml);
    }
    // What is left out is an assumption of the model.
    let wrong = inertial(20.0, 0.4).replace("izz='0.4'", "izz='-0.4'");
    let imported = import(&arm([&wrong, "", ""]), &between("l0", "l3"));
    assert!(
        imported
            .toml
            .contains("assumption = \"the inertia of the URDF"),
        "{}",
        imported.toml
    );
}

#[test]
fn limits_that_nothing_reaches_are_none() {
    let text = arm(["", "", ""]);
    let limits = |from: &str, to: &str| {
        let written = format!("lower='{from}' upper='{to}'");
        let imported = import(
            &text.replacen("lower='-1' upper='1'", &written, 1),
            &between("l0", "l3"),
        );
        let limits = imported.model.mechanism.limbs()[0].nominal.actuators()[0].limits;
        (limits, notices(&imported))
    };
    for (from, to) in [
        ("-1e+16", "1e16"),
        ("-inf", "inf"),
        ("-1.8e308", "INF"),
        ("-2e9", "2e9"),
    ] {
        let (limits, said) = limits(from, to);
        assert_eq!(limits, None);
        assert!(!said.contains("degrees"), "{said}");
    }
    let (one_sided, said) = limits("-1", "1e12");
    assert_eq!(one_sided, None);
    assert!(said.contains("end on one side only"), "{said}");
    assert!(limits("-180", "180").0.is_some());
}

/// What hangs beside the way from base to tip does not stop the import, whatever is wrong with it.
#[test]
fn side_branches_do_not_matter() {
    let text = arm(["", "", ""]);
    let limit = "<axis xyz='1 0 0'/><limit lower='0' upper='0.8' effort='1' velocity='1'/>";
    let finger = |name: &str, child: &str, rest: &str| {
        format!(
            "<link name='{child}'/><joint name='{name}' type='revolute'><parent link='l3'/><child link='{child}'/>{limit}{rest}</joint>"
        )
    };
    let lead = finger("finger", "g1", "");
    for (follower, said) in [
        // The limits of the two have nothing in common but zero.
        (
            finger("inner", "g2", "<mimic joint='finger' multiplier='-1'/>"),
            "",
        ),
        (
            finger("inner", "g2", "<mimic joint='fingr'/>"),
            "there is no joint 'fingr'",
        ),
        (
            finger("inner", "g2", "<mimic joint='inner'/>"),
            "follows itself",
        ),
        (
            finger("inner", "g2", "").replace("<link name='g2'/>", ""),
            "there is no link 'g2'",
        ),
    ] {
        let whole = text.replace("</robot>", &format!("{lead}{follower}</robot>"));
        let imported = import(&whole, &between("l0", "l3"));
        assert_eq!(imported.actuators, ["j1", "j2", "j3"]);
        let found = notices(&imported);
        assert!(found.contains(said), "{said}: {found}");
        assert_eq!(
            found.contains("stands still in the model"),
            !said.is_empty(),
            "{found}"
        );
    }
    // On the way it is refused.
    let whole = text.replace(
        "</robot>",
        &format!(
            "{lead}{}</robot>",
            finger("inner", "g2", "<mimic joint='fingr'/>")
        ),
    );
    let refused = kinetostat_import::import_urdf(&whole, "r.urdf", &between("l0", "g2"));
    let said = refused.unwrap_err().to_string();
    assert!(said.contains("there is no joint 'fingr'"), "{said}");
}
