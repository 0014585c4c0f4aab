//! Choices of the import: stiffnesses, sections, bases inside the tree, joints beside the way.

use kinetostat::MotionKind;
use kinetostat_import::{JointStiffness, import_urdf};
use kinetostat_model::schema::{Element, Section, Tube};
use kinetostat_testing::LargestEntry;

use crate::agreement::{TREE, with_oracle};
use crate::{between, import, notices};

/// A chain of three joints, the middle one sliding.
const CHAIN: &str = r#"<robot name="chain">
  <link name="a"/><link name="b"/><link name="c"/><link name="d"/><link name="e"/>
  <joint name="one" type="revolute"><origin xyz="0 0 0.4"/><parent link="a"/><child link="b"/><axis xyz="0 0 1"/><limit lower="-2" upper="2"/></joint>
  <joint name="two" type="prismatic"><origin xyz="0.6 0 0" rpy="0 0.4 0"/><parent link="b"/><child link="c"/><axis xyz="0 0 1"/><limit lower="0" upper="1"/></joint>
  <joint name="three" type="continuous"><origin xyz="0.1 0 0.8"/><parent link="c"/><child link="d"/><axis xyz="0 1 0"/></joint>
  <joint name="end" type="fixed"><origin xyz="0.3 0 0"/><parent link="d"/><child link="e"/></joint>
</robot>"#;

#[test]
fn a_table_of_stiffnesses_is_used() {
    let options = {
        let mut options = between("a", "e");
        options.stiffness = JointStiffness::Table {
            file: "k.csv".into(),
            text: "\u{feff}name, value, unit\r\n# measured in May\r\none, 2.0e9, N mm/rad\r\n\"two\", 5e3, N/mm\r\n"
                .into(),
        };
        options
    };
    let imported = import(CHAIN, &options);
    assert_eq!(imported.rigid_drives, ["three"]);
    let chain = &imported.model.mechanism.limbs()[0].nominal;
    let stiffness = |name: &str| {
        let block = chain.springs().iter().find(|s| s.name == name);
        block.map(|b| b.stiffness_at(&chain.home_coordinates())[(0, 0)])
    };
    assert_eq!(stiffness("one"), Some(2e6));
    assert_eq!(stiffness("two"), Some(5e6));
    assert_eq!(stiffness("three"), None);
    assert!(imported.toml.contains("# FILL IN: stiffness_n_m_per_rad"));
}

#[test]
fn links_can_be_beams() {
    let section = Section {
        tube: Some(Tube {
            outer_diameter_mm: Some(200.0),
            inner_diameter_mm: Some(180.0),
            ..Tube::default()
        }),
        youngs_modulus_gpa: Some(210.0),
        poissons_ratio: Some(0.3),
        ..Section::default()
    };
    let options = {
        let mut options = between("a", "e");
        options.section = Some(section);
        options.stiffness = JointStiffness::All(1e6);
        options
    };
    let imported = import(CHAIN, &options);
    let links = imported.model.document.chain["arm"]
        .elements
        .iter()
        .filter(|e| matches!(e, Element::Link(_)))
        .count();
    assert_eq!(links, 4);
    // The way is the same as with rigid links: offsets first, then their turns.
    let d = with_oracle(CHAIN, &imported, 50);
    assert!(d.pose < 1e-12, "{}", d.pose);
}

#[test]
fn a_base_behind_the_tip_turns_the_way_round() {
    let imported = import(CHAIN, &between("e", "a"));
    assert_eq!(imported.actuators, ["three", "two", "one"]);
    let d = with_oracle(CHAIN, &imported, 200);
    assert!(d.pose < 1e-12, "{}", d.pose);
    assert!(notices(&imported).contains("the base 'e' is above a moving joint"));
}

#[test]
fn joints_beside_the_way_stand_still() {
    let imported = import(TREE, &between("foot", "post"));
    let said = notices(&imported);
    assert_eq!(imported.actuators, ["turn"]);
    // All masses are carried along.
    let mass: f64 = imported.bodies.iter().map(|b| b.1).sum();
    assert!((mass - 331.0).abs() < 1e-9, "{mass}");
    for joint in ["lift", "slide"] {
        assert!(
            said.contains(&format!(
                "joint '{joint}': the joint is not between the base and the tip"
            )),
            "{said}"
        );
    }
    // 'slide' cannot stand at zero: the middle of 0.1 and 0.9.
    assert!(said.contains("it is at rest at 500 mm"), "{said}");
}

#[test]
fn a_follower_before_its_source_leads() {
    // The first joint follows the second: the model commands the first one.
    let text = CHAIN
        .replace("type=\"prismatic\"", "type=\"revolute\"")
        .replace(
            "<axis xyz=\"0 0 1\"/><limit lower=\"-2\"",
            "<axis xyz=\"0 0 1\"/><mimic joint=\"two\" multiplier=\"-2\" offset=\"0.3\"/><limit lower=\"-2\"",
        );
    let imported = import(&text, &between("a", "e"));
    assert_eq!(imported.actuators, ["one", "three"]);
    assert_eq!(imported.coupled_joints, ["two"]);
    let chain = &imported.model.mechanism.limbs()[0].nominal;
    // Limits 0 .. 1 of 'two' are 0.3 .. -1.7 of 'one'.
    let limits = chain.actuators()[0].limits.unwrap();
    assert!((limits.0 + 1.7).abs() < 1e-12 && (limits.1 - 0.3).abs() < 1e-12);
    // one = 0.3 - 2 two: by hand at one = -0.7, two = 0.5.
    let oracle = crate::oracle::Oracle::new(&text);
    let values = [("two", 0.5), ("three", 0.2)].into();
    let wanted = oracle.pose("a", "e", &values);
    let k = kinetostat::model::Kinematics::new(
        chain,
        &kinetostat::Pose::identity(),
        &chain.home_coordinates(),
        &[-0.7, 0.2],
    );
    let difference = (k.tip_pose().to_homogeneous() - wanted).largest_entry();
    assert!(difference < 1e-12, "{difference}");
}

#[test]
fn names_of_a_file_cannot_write_toml() {
    let nasty = "x\"] # [[limb]] '''";
    let text = CHAIN.replace("\"one\"", &format!("'{}'", nasty.replace('\'', "&apos;")));
    let imported = import(&text, &between("a", "e"));
    assert_eq!(imported.actuators[0], nasty);
    assert_eq!(imported.model.mechanism.actuator_names()[0], nasty);
}

#[test]
fn passive_joints_and_homes_can_be_named() {
    let options = {
        let mut options = between("a", "e");
        options.passive = vec!["three".into()];
        options.home = [("one".to_owned(), (MotionKind::Revolute, 0.5))].into();
        options
    };
    let imported = import(CHAIN, &options);
    assert_eq!(imported.actuators, ["one", "two"]);
    assert_eq!(imported.passive_joints, ["three"]);
    assert_eq!(
        imported.model.mechanism.limbs()[0].nominal.home_commands()[0],
        0.5
    );
}

#[test]
fn a_home_of_the_wrong_kind_is_refused() {
    for (joint, kind, value, needle) in [
        ("two", MotionKind::Revolute, 0.3, "needs mm or m"),
        ("one", MotionKind::Prismatic, 0.2, "needs deg or rad"),
        ("one", MotionKind::Revolute, 2.5, "143.2394 deg is outside"),
        (
            "two",
            MotionKind::Prismatic,
            1.2,
            "1200 mm is outside the limits of the joint 'two', 0 to 1000 mm",
        ),
    ] {
        let options = {
            let mut options = between("a", "e");
            options.home = [(joint.to_owned(), (kind, value))].into();
            options
        };
        let said = import_urdf(CHAIN, "chain.urdf", &options)
            .expect_err("refused")
            .to_string();
        assert!(said.contains(needle), "{needle}: {said}");
        assert!(!said.contains("urdf:1:1"), "{said}");
    }
}

#[test]
fn a_stiffness_of_a_follower_is_refused() {
    let urdf = CHAIN.replace(
        "<axis xyz=\"0 1 0\"/></joint>",
        "<axis xyz=\"0 1 0\"/><mimic joint=\"one\"/></joint>",
    );
    let options = {
        let mut options = between("a", "e");
        options.stiffness = JointStiffness::Table {
            file: "k.csv".into(),
            text: "name,value,unit\nthree,1e6,N m/rad\n".into(),
        };
        options
    };
    let said = import_urdf(&urdf, "chain.urdf", &options)
        .expect_err("refused")
        .to_string();
    assert!(
        said.contains("follows the joint 'one'") && said.contains("k.csv:2"),
        "{said}"
    );
}

#[test]
fn a_truncated_file_is_reported_where_it_ends() {
    let short = &CHAIN[..CHAIN.find("xyz=\"0.6").expect("there")];
    let line = short.lines().count();
    let said = import_urdf(short, "short.urdf", &between("a", "e"))
        .expect_err("refused")
        .to_string();
    assert!(said.contains(&format!("short.urdf:{line}:")), "{said}");
    let far = CHAIN.replace("0.6 0 0", "1e300 0 0");
    let said = import_urdf(&far, "far.urdf", &between("a", "e"))
        .expect_err("refused")
        .to_string();
    assert!(said.contains("the value is 1e300"), "{said}");
}
